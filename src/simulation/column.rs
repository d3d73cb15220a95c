//! Columns without copies: the numbers of a field as they lie in memory, and which particle each is of.
//! For other programs that read a state as a whole: couplers, viewers, analyses.

use super::{Simulation, Which, find};
use crate::error::{Error, Problem, Result};
use crate::particles::Field;
use crate::scalar::Real;

/// A field of the particles of a body, in the order in which they lie in memory.
///
/// List builds sort particles anew, so that order holds until the next step.
#[derive(Clone, Copy, Debug)]
pub struct Column<'a, T> {
    values: &'a [T],
    components: usize,
    ids: &'a [u32],
    first: u32,
}

impl<'a, T> Column<'a, T> {
    /// The numbers, [`components`](Self::components) for each particle one after another.
    #[must_use]
    pub fn values(&self) -> &'a [T] {
        self.values
    }
    /// How many numbers a particle has.
    #[must_use]
    pub fn components(&self) -> usize {
        self.components
    }
    /// The particle of each place: its number in the body, in the order in which the scene placed them.
    #[must_use]
    pub fn numbers(&self) -> impl ExactSizeIterator<Item = usize> + use<'a, T> {
        let first = self.first;
        self.ids.iter().map(move |id| (id - first) as usize)
    }
    /// Each particle's number in the body with its numbers of the field.
    #[must_use]
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (usize, &'a [T])> + use<'a, T> {
        self.numbers()
            .zip(self.values.chunks_exact(self.components))
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// A field of a body without a copy, in the scalar of the simulation.
    ///
    /// Places count from [`origin`](Self::origin), and in `f32` keep their rounding error in
    /// [`Field::POSITION_RESIDUAL`]; [`ParticleView::position`](super::ParticleView::position) adds both.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .boundary(MirrorPlane::wall([0.01], [1.0]))
    ///     .build()?;
    /// rod.run_until(1e-6)?;
    /// let pressure = rod.column("rod", Field::PRESSURE)?;
    /// // In 1 µs the wave has gone from the wall through 3.9 mm of 10.
    /// let highest = pressure.iter().max_by(|a, b| a.1[0].total_cmp(&b.1[0]));
    /// assert!(highest.is_some_and(|(number, own)| number >= 30 && own[0] > 700e6), "{highest:?}");
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// If there is no such body, or its scheme does not carry the field; the error lists the bodies, or names the field.
    pub fn column(&self, body: impl Which, field: Field) -> Result<Column<'_, T>> {
        let all = self.all_bodies().map(|own| (&own.1.name, own));
        let (_, (group, own)) = find(&body, "body", all)?;
        let components = field.components(D);
        let slots = own.slots.clone();
        let values = group.particles.columns.raw(field);
        let values = values.get(slots.start * components..slots.end * components);
        let Some(values) = values else {
            return Err(Error::Argument(Problem::Incompatible {
                what: format!(
                    "the particles of `{}` do not carry {}",
                    own.name,
                    self.name_of(field)
                ),
                remedy: "ask for a field of their scheme, as Simulation::field finds by name, or name the effect that declares it",
            }));
        };
        Ok(Column {
            values,
            components,
            ids: &group.particles.ids[slots],
            first: own.ids.start as u32,
        })
    }
}
