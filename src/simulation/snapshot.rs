//! Particles as they are now, for files: positions and whatever the scene carries as its state.
//! Fields that effects declare are there under their names: the full one where two have the same.

use super::{ParticleView, ParticleViews, Simulation};
use crate::output::hash::Hash;
use crate::output::vtu::Vtu;
use crate::particles::Field;
use crate::scalar::Real;

/// What every particle has beside its place and velocity.
const COMMON: [Field; 3] = [Field::DENSITY, Field::PRESSURE, Field::ENERGY];

/// A particle, the number of its body or wall, and its spacing \[m\].
type Written<'a, T, const D: usize> = (ParticleView<'a, T, D>, usize, f64);

impl<T: Real, const D: usize> Simulation<T, D> {
    /// All particles of bodies now, as a VTK file: position, velocity, density, pressure, internal energy where it
    /// is carried, mass, smoothing length, spacing as built, body, number, and every field that an effect declares or integrates,
    /// under its name. A symmetric tensor is written as VTK reads it: xx, yy, zz, xy, yz, xz. Where the scheme of a body does not
    /// carry a field that another's does, it is not a number.
    ///
    /// In ParaView choose the representation *Point Gaussian* and let `spacing` scale it: each particle has its size then.
    ///
    /// ```no_run
    /// # use meshfree::prelude::*;
    /// # fn write(simulation: &Simulation<f64, 2>) -> Result<(), Error> {
    /// simulation.vtu().write("out/now.vtu")
    /// # }
    /// ```
    #[must_use]
    pub fn vtu(&self) -> Vtu {
        let all = self.of_bodies();
        self.file_of(&all, &all)
    }

    /// The same with the particles of walls behind those of bodies: `wall` is 1 for them and 0 for bodies, and `body` goes on
    /// counting with the walls.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let water = catalogue::weakly_compressible_water(2.0);
    /// let tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
    ///     .body(Body::block("water", water, [0.0; 2], [0.3, 0.2], 0.02))
    ///     .wall(Wall::around("tank", [0.0; 2], [0.3, 0.3], 0.02, 3, [[true, true], [true, false]]))
    ///     .build()?;
    /// let walls = tank.wall("tank")?.count();
    /// assert_eq!(tank.vtu_with_walls().len(), tank.particles() + walls);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn vtu_with_walls(&self) -> Vtu {
        let all = self.with_walls();
        self.file_with_walls(&all, &all)
    }

    /// The same of the particles that this rank writes, with the columns of all.
    pub(super) fn piece(&self) -> Vtu {
        let all = self.with_walls();
        let is_own = |own: &&Written<'_, T, D>| own.0.group.is_written_here(own.0.slot);
        let own: Vec<_> = all.iter().filter(is_own).copied().collect();
        self.file_with_walls(&all, &own)
    }

    /// Particles of bodies, and those of walls behind them.
    fn with_walls(&self) -> Vec<Written<'_, T, D>> {
        let mut all = self.of_bodies();
        let bodies = self.body_count();
        for (k, (group, wall)) in self.all_walls().enumerate() {
            // The mass as built is that of a spacing to the power D of the first liquid at rest.
            let density = group.particles.bodies.first();
            let density = density.map_or(1.0, |body| body.material.reference_density());
            let spacing = (wall.mass / density).powf(1.0 / D as f64);
            let own = ParticleViews::new(group, wall.slots.clone());
            all.extend(own.map(|particle| (particle, bodies + k, spacing)));
        }
        all
    }

    fn file_with_walls(&self, all: &[Written<'_, T, D>], own: &[Written<'_, T, D>]) -> Vtu {
        let is_wall = own
            .iter()
            .map(|(particle, ..)| u8::from(!particle.is_mobile()));
        self.file_of(all, own).scalar("wall", is_wall)
    }

    /// Particles of bodies, with the numbers of these and spacings \[m\].
    fn of_bodies(&self) -> Vec<Written<'_, T, D>> {
        let bodies = self.all_bodies().enumerate();
        let each = bodies.flat_map(|(k, (group, body))| {
            let own = ParticleViews::of_body((group, body));
            own.map(move |particle| (particle, k, body.spacing))
        });
        each.collect()
    }

    /// Some of all particles, with the columns of all.
    fn file_of(&self, all: &[Written<'_, T, D>], written: &[Written<'_, T, D>]) -> Vtu {
        let particles = || written.iter().map(|own| own.0);
        let mut vtu = Vtu::new(particles().map(|own| own.position()))
            .time(self.time())
            .scalar("body", written.iter().map(|own| own.1 as i32))
            .scalar("number", particles().map(|own| own.id() as i64))
            .scalar("mass", particles().map(|own| own.mass()))
            .scalar(
                "smoothing_length",
                particles().map(|own| own.smoothing_length()),
            )
            .scalar("spacing", written.iter().map(|own| own.2))
            .vector("velocity", particles().map(|own| own.velocity()));
        for field in self.written() {
            if all.iter().any(|own| own.0.numbers(field).is_some()) {
                let tuple = |particle: ParticleView<'_, T, D>| {
                    let mut numbers = particle.values(field).into_iter().flatten();
                    core::array::from_fn(|_| numbers.next().unwrap_or(f64::NAN))
                };
                let name = self.name_of(field);
                vtu = vtu.field::<D>(name, field.shape(), particles().map(tuple));
            }
        }
        vtu
    }

    /// A hash of all particles of bodies now, by which two runs are the same to the bit or are not: time, steps and, of each
    /// particle in the order of its identity, place, velocity and all fields of [`vtu`](Self::vtu). It is the 64-bit FNV-1a (Fowler,
    /// Noll & Vo 1991), and does not depend on threads.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let rod = || Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .build();
    /// let (mut one, mut other) = (rod()?, rod()?);
    /// one.run_until(1e-7)?;
    /// other.run_until(5e-8)?;
    /// assert_ne!(one.bits_hash(), other.bits_hash());
    /// // A reading on the way changes no bit.
    /// other.run_until(1e-7)?;
    /// assert_eq!(one.bits_hash(), other.bits_hash());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn bits_hash(&self) -> u64 {
        let mut hash = Hash::new();
        hash.bytes(&self.steps().to_le_bytes());
        hash.numbers([&self.time()]);
        let fields = self.written();
        for particle in self.all() {
            hash.bytes(&(particle.id() as u64).to_le_bytes());
            hash.numbers(&particle.position());
            hash.numbers(&particle.velocity());
            hash.numbers([&particle.mass(), &particle.smoothing_length()]);
            for field in &fields {
                let values: Vec<f64> = particle.values(*field).into_iter().flatten().collect();
                hash.numbers(&values);
            }
        }
        hash.value()
    }

    /// The fields that files have of particles under their own names.
    fn written(&self) -> Vec<Field> {
        let mut fields = COMMON.to_vec();
        for group in &self.state.groups {
            let new = group.scheme.program.state();
            let own = [Field::MASS, Field::SMOOTHING_LENGTH];
            let new = new.filter(|field| !fields.contains(field) && !own.contains(field));
            let new: Vec<Field> = new.collect();
            fields.extend(new);
        }
        fields
    }
}
