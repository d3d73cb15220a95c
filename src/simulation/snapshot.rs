//! Particles as they are now, for files: positions and whatever the scene carries as its state.
//! Fields that effects declare are there under their names: the full one where two have the same.

use super::{ParticleView, ParticleViews, Simulation};
use crate::output::vtu::Vtu;
use crate::particles::Field;
use crate::scalar::Real;

/// What every particle has beside its place and velocity.
const COMMON: [Field; 3] = [Field::DENSITY, Field::PRESSURE, Field::ENERGY];

impl<T: Real, const D: usize> Simulation<T, D> {
    /// All particles of bodies now, as a VTK file: position, velocity, density, pressure, internal energy where it
    /// is carried, body, number, and every field that an effect declares or integrates, under its name. A symmetric
    /// tensor is written as VTK reads it: xx, yy, zz, xy, yz, xz. Where the scheme of a body does not carry a field
    /// that another's does, it is not a number.
    ///
    /// ```no_run
    /// # use meshfree::prelude::*;
    /// # fn write(simulation: &Simulation<f64, 2>) -> Result<(), Error> {
    /// simulation.vtu().write("out/now.vtu")
    /// # }
    /// ```
    #[must_use]
    pub fn vtu(&self) -> Vtu {
        let bodies = self.all_bodies().map(ParticleViews::of_body).enumerate();
        let owners = bodies.flat_map(|(k, own)| own.map(move |_| k as i32));
        let mut vtu = Vtu::new(self.all().map(|particle| particle.position()))
            .time(self.time())
            .scalar("body", owners)
            .scalar("number", self.all().map(|particle| particle.id() as i64))
            .vector("velocity", self.all().map(|particle| particle.velocity()));
        let mut fields = COMMON.to_vec();
        for group in &self.state.groups {
            let new = group.scheme.program.state();
            let new: Vec<Field> = new.filter(|own| !fields.contains(own)).collect();
            fields.extend(new);
        }
        for field in fields {
            if self.all().any(|particle| particle.numbers(field).is_some()) {
                vtu = self.with(vtu, field);
            }
        }
        vtu
    }

    /// With a field under its name.
    fn with(&self, vtu: Vtu, field: Field) -> Vtu {
        let tuple = |particle: ParticleView<'_, T, D>| {
            let mut numbers = particle.values(field).into_iter().flatten();
            core::array::from_fn(|_| numbers.next().unwrap_or(f64::NAN))
        };
        let name = self.name_of(field);
        vtu.field::<D>(name, field.shape(), self.all().map(tuple))
    }
}
