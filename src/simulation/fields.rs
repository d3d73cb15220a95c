//! Fields of particles by name and by shape: read from a particle, and set for a body between steps.
//! What is asked for and is not there is an error that lists what is.

use super::which::{Which, find};
use super::{ParticleView, ParticleViews, Simulation};
use crate::error::{Error, Problem, Result};
use crate::particles::{Field, Shape};
use crate::scalar::Real;
use crate::tensor::Symmetric;

impl<T: Real, const D: usize> ParticleView<'_, T, D> {
    /// The length \[m\] of kernels that sample it: the smoothing length, and more where that reaches too few others.
    pub(crate) fn sampling_length(&self) -> f64 {
        self.smoothing_length() * self.group.scheme.widening()
    }
    /// All components of a field, or `None` if the particle does not carry it.
    pub(crate) fn numbers(&self, field: Field) -> Option<&[T]> {
        let width = field.components(D);
        let column = self.group.particles.columns.raw(field);
        column.get(self.slot * width..(self.slot + 1) * width)
    }
    /// The same in `f64`, with places as those of the scene.
    pub(crate) fn values(&self, field: Field) -> Option<impl Iterator<Item = f64>> {
        let origin = &self.group.particles.origin;
        let is_place = field.shape() == Shape::Point;
        let numbers = self.numbers(field)?.iter().enumerate();
        Some(numbers.map(move |(k, value)| match value.to_f64() {
            place if is_place => place + origin[k],
            value => value,
        }))
    }
    /// A vector field, or `None` if the particle does not carry it or it is no vector.
    #[must_use]
    pub fn vector(&self, field: Field) -> Option<[f64; D]> {
        let is_vector = matches!(
            field.shape(),
            Shape::Point | Shape::Velocity | Shape::Vector
        );
        let mut values = self.values(field).filter(|_| is_vector)?;
        Some(core::array::from_fn(|_| values.next().unwrap_or(f64::NAN)))
    }
    /// A symmetric tensor, or `None` if the particle does not carry it or it is none.
    #[must_use]
    pub fn tensor(&self, field: Field) -> Option<Symmetric<f64>> {
        let is_tensor = field.shape() == Shape::Tensor;
        let numbers = self.numbers(field).filter(|_| is_tensor)?;
        Some(Symmetric::new(core::array::from_fn(|k| {
            numbers[k].to_f64()
        })))
    }
    /// A matrix, row by row, or `None` if the particle does not carry it or it is none.
    #[must_use]
    pub fn matrix(&self, field: Field) -> Option<[[f64; D]; D]> {
        let is_matrix = field.shape() == Shape::Matrix;
        let numbers = self.numbers(field).filter(|_| is_matrix)?;
        let at = |a: usize, b: usize| numbers[a * D + b].to_f64();
        Some(core::array::from_fn(|a| core::array::from_fn(|b| at(a, b))))
    }
    /// All components of the field with a name, that an effect has declared or the crate knows; `None` if the
    /// particle does not carry it. The full name, as `meshfree::damage`, does for all, and has to where two have one name.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<Vec<f64>> {
        let program = &self.group.scheme.program;
        let carried = self.group.particles.columns.fields();
        let is = |field: &Field| program.name_of(*field) == name || field.full_name() == name;
        let field = carried.iter().find(is)?;
        self.values(field).map(Iterator::collect)
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// The length \[m\] of kernels that sample the group of [`smoothing_length`](Self::smoothing_length).
    pub(crate) fn sampling_length(&self) -> f64 {
        let group = self.observed().next();
        let widening = group.map_or(1.0, |group| group.scheme.widening());
        self.smoothing_length() * widening
    }

    /// The field with a name, that an effect has declared or the crate knows, of those that particles carry. The full
    /// name, as `meshfree::damage`, does for all, and has to where two have one name.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let simulation = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
    ///     .build()?;
    /// assert_eq!(simulation.field("density")?, Field::DENSITY);
    /// assert!(simulation.field("temperature").unwrap_err().to_string().contains("density"));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// If no particle carries a field of that name; the error lists those that there are.
    pub fn field(&self, name: &str) -> Result<Field> {
        let carried = self.carried();
        let is = |field: &Field| {
            field.name_among(carried.iter().copied()) == name || field.full_name() == name
        };
        let found = carried.iter().copied().find(is);
        found.ok_or_else(|| self.unknown_field(name))
    }

    /// The fields that particles carry, each once.
    fn carried(&self) -> Vec<Field> {
        let mut all: Vec<Field> = Vec::new();
        for group in &self.state.groups {
            let columns = &group.particles.columns;
            let fields = columns.fields().iter();
            let there = fields.filter(|&field| !columns.raw(field).is_empty());
            let new: Vec<Field> = there.filter(|field| !all.contains(field)).collect();
            all.extend(new);
        }
        all
    }

    /// The name of a field in files and messages about all particles: the full one if another has the same name.
    pub(crate) fn name_of(&self, field: Field) -> &'static str {
        field.name_among(self.carried())
    }

    /// The error that lists the fields that there are.
    fn unknown_field(&self, name: &str) -> Error {
        let carried = self.carried();
        let known = carried.iter();
        let known = known.map(|field| field.name_among(carried.iter().copied()));
        Error::Argument(Problem::UnknownName {
            kind: "field",
            name: name.into(),
            known: known.collect::<Vec<_>>().join(", "),
        })
    }

    /// The name of a field, and all particles of bodies that carry it.
    pub(crate) fn carriers(
        &self,
        field: Field,
    ) -> Result<(&'static str, impl Iterator<Item = ParticleView<'_, T, D>>)> {
        if !self.carried().contains(&field) {
            return Err(self.unknown_field(&format!("{field:?}")));
        }
        let bodies = self.all_bodies();
        let own = bodies.filter(move |(group, _)| !group.particles.columns.raw(field).is_empty());
        Ok((self.name_of(field), own.flat_map(ParticleViews::of_body)))
    }

    /// Sets a field of all particles of a body between steps, as a function of position \[m\] and present value;
    /// `N` is the number of its components: 1, D, 6 for a symmetric tensor.
    ///
    /// It must be the velocity, a field that is integrated in time, or one that an effect declares: all others
    /// follow from these.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
    ///     .build()?;
    /// // A spot is heated by 1 kJ/kg.
    /// simulation.set_field("rod", Field::ENERGY, |[x], [e]| [if x < 0.001 { e + 1000.0 } else { e }])?;
    /// let energy: Vec<_> = simulation.body("rod")?.map(|particle| particle.energy()).collect();
    /// assert_eq!((energy[0], energy[49]), (1000.0, 0.0));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// If there is no such body, its particles do not keep the field, it has another number of components, or a
    /// value is not finite; nothing is changed then.
    pub fn set_field<const N: usize>(
        &mut self,
        body: impl Which,
        field: Field,
        value: impl Fn([f64; D], [f64; N]) -> [f64; N],
    ) -> Result<()> {
        let all = self
            .state
            .groups
            .iter()
            .enumerate()
            .flat_map(|(group, own)| {
                let bodies = own.particles.bodies.iter().enumerate();
                bodies.map(move |(own, body)| (&body.name, (group, own)))
            });
        let (_, (group, own)) = find(&body, "body", all)?;
        let group = &mut self.state.groups[group];
        let program = &group.scheme.program;
        if let Some(problem) = program.cannot_set(field, N) {
            return Err(Error::Argument(problem));
        }
        let run = group.particles.bodies[own].run();
        let mut next = Vec::with_capacity(run.len() * N);
        for slot in run.clone() {
            let now = ParticleView { group, slot };
            let x = now.position();
            let present = now.numbers(field).unwrap_or_default();
            let values = value(x, core::array::from_fn(|k| present[k].to_f64()));
            if let Some(wrong) = values.iter().find(|value| !value.is_finite()) {
                let (name, unit) = (program.name_of(field), field.unit());
                return Err(Error::Argument(Problem::Parameter {
                    what: format!(
                        "{name} [{unit}] of body `{}` at {x:?} m",
                        group.particles.bodies[own].name
                    ),
                    value: *wrong,
                    must_be: "it must be finite",
                }));
            }
            next.extend(values.map(T::from_f64));
        }
        let evolved = program.evolved.iter().find(|own| own.field == field);
        let residual = evolved.and_then(|own| own.residual);
        let columns = &mut group.particles.columns;
        columns.raw_mut(field)[run.start * N..run.end * N].copy_from_slice(&next);
        if let Some(residual) = residual {
            columns.raw_mut(residual)[run.start * N..run.end * N].fill(T::zero());
        }
        self.forget_rates();
        Ok(())
    }
}
