//! Couplings: how two bodies act on each other, or one body on itself, one file each.
//! Both sides keep schemes of their own; a coupling says what one is to the other.
//!
//! | coupling | what the second body is to the first | use it for |
//! |---|---|---|
//! | [`LiquidStructure`] | a wall that moves, and takes the reaction of the liquid | liquid and structure; the default between them |
//! | [`ContactDensity`] | what presses, by kernel sums across the contact | contact of solids, sliding, self-contact |
//! | [`Penalty`] | what presses, by springs between near particles | contact of thin bodies, of single layers |
//! | [`Tied`] | what it is tied to, by springs between what is near as built | bodies of unlike schemes that never part |
//! | a [`Coupling`] of your own | a wall, or a pair force | |
//! | a [`Joint`] | what a rigid body is hinged to, slides along or is driven by | mechanisms of rigid bodies |
//!
//! A coupling acts in one of two ways, or in both:
//!
//! - **As a wall**: particles of the second body stand among those of the liquid that the first one is, with the mass
//!   that [`Coupling::wall_mass`] gives. The liquid's own pair terms and wall law act on them, and the body gets each
//!   pair force with the opposite sign.
//! - **By a force**: [`Coupling::act`] between every two particles nearer than [`Coupling::reach`], opposite on both
//!   sides to the bit, after sums of its own over the pairs ([`Coupling::gather`]) if it names any. It acts between
//!   bodies of different groups, between two of one group, whose kernels then do not meet
//!   ([`Scene::between`](crate::scene::Scene::between) ties them nevertheless), and within a body
//!   ([`Scene::couple_self`](crate::scene::Scene::couple_self)).
//!
//! The second side of a force may also be a [wall of particles](crate::scene::Scene::wall), which stands where its motion has
//! it and does not yield.
//!
//! Images count in both: what stands behind a [plane of symmetry](crate::boundary::MirrorPlane::symmetry), or one
//! [period](crate::boundary::Periodic) on, presses and holds as if it were there. A pair with an image is half of one, so half of
//! what it stores is booked, and its force is the boundary's. Images of a wall count as the wall.
//!
//! Either way momentum is kept to rounding, and the ledger knows what the two gave each other
//! ([`Simulation::force_between`](crate::simulation::Simulation::force_between)).
//!
//! # Energy
//!
//! What forces of couplings work on a body in kicks is in its ledger as `work of couplings`: kinetic and internal energy
//! less that work is constant to rounding. Of the work the coupling stores a part, which comes back, and the rest is
//! gone to friction, to damping, and to the error of the steps. The whole ledger has the first two as
//! `energy of couplings` and `heat of couplings`, and
//! [`Simulation::contacts`](crate::simulation::Simulation::contacts) has them coupling by coupling, with forces and the
//! penetration. That heat is in no body's internal energy. Integrators without kicks keep no work.
//!
//! # Sub-cycling
//!
//! A stiff body asks for shorter steps than the liquid around it. With
//! [`Scene::sub_cycle`](crate::scene::Scene::sub_cycle) its group takes several steps in each of the others', and
//! what couplings do to it comes in impulses at the kicks of the others, with the forces that these feel: the
//! reversible multiple-step method of Tuckerman, Berne & Martyna 1992 (J. Chem. Phys. 97, 1990, eq. 2.25), which keeps
//! momentum to rounding. What the impulses have worked is in the ledger of each body, as `work of couplings`.
//!
//! A mode of the body that swings by a whole number of halves in a step of the others resonates with the impulses
//! (Biesiadecki & Skeel 1993, J. Comput. Phys. 109, 318), the more the larger the share of a coupling in its stiffness.
//! Liquids give little of that, yet walls of acrylic around water rang where four, six and eight steps were set, and
//! not where five were ([sloshing](crate#pages)). Artificial viscosity in the body, α = 0.2, damps it up to eight steps; where
//! `work of couplings` grows without cause, ask for fewer.

mod contact_density;
mod friction;
mod joint;
mod liquid_structure;
mod penalty;
#[cfg(feature = "devices")]
mod record;
mod spring;
mod tied;

pub use contact_density::ContactDensity;
pub use friction::{Anchor, Coulomb, Touch};
pub use joint::Joint;
pub(crate) use joint::{Kind, Motor};
pub use liquid_structure::LiquidStructure;
pub use penalty::Penalty;
#[cfg(feature = "devices")]
pub use record::CouplingRecord;
pub use tied::Tied;

use crate::particles::{Columns, Field, Fields};
#[cfg(feature = "devices")]
use crate::scalar::Record;
use crate::scalar::{Lane, Real};
use crate::term::TermDoc;
use core::fmt::Debug;

/// A particle of a body that is coupled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledParticle<T, const D: usize> {
    /// Position \[m\], counted from the [origin](crate::scene#place) of the scene: differences are places apart.
    pub position: [T; D],
    /// Velocity \[m/s\].
    pub velocity: [T; D],
    /// Mass \[kg\]; infinite of a wall of particles, which no force moves.
    pub mass: T,
    /// Density \[kg/m³\]; infinite of a wall of particles.
    pub density: T,
    /// Spacing of its body as built \[m\].
    pub spacing: T,
    /// Stiffness \[Pa\] of what lies between the two bodies: the harmonic mean of the ρc² of both as built, which is
    /// the same for particles of both. Before a wall of particles, which does not yield, it is twice that of the body.
    pub stiffness: T,
    /// What [`Coupling::gather`] has summed over the particles of the other side.
    pub sum: T,
    /// Its gradient \[1/m\].
    pub gradient: [T; D],
    /// What [`Coupling::pressure`] has made of these \[Pa\].
    pub pressure: T,
}

impl<T: Real, const D: usize> CoupledParticle<T, D> {
    /// The fields that couplings see of a particle, which must be at hand where they act.
    pub const READS: Fields = Fields::of(&[
        Field::POSITION,
        Field::VELOCITY,
        Field::MASS,
        Field::DENSITY,
    ]);
    /// What couplings see of the particle in a slot.
    pub(crate) fn of(columns: &Columns<T, D>, slot: usize, spacing: T) -> Self {
        Self {
            position: columns.vectors(Field::POSITION)[slot],
            velocity: columns.vectors(Field::VELOCITY)[slot],
            mass: columns.raw(Field::MASS)[slot],
            density: columns.raw(Field::DENSITY)[slot],
            spacing,
            stiffness: T::zero(),
            sum: T::zero(),
            gradient: [T::zero(); D],
            pressure: T::zero(),
        }
    }
}

/// Two particles within reach of each other, and what the coupling remembers of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledPair<T, const D: usize> {
    /// Of the first body.
    pub on: CoupledParticle<T, D>,
    /// Of the second.
    pub from: CoupledParticle<T, D>,
    /// Their distance as built \[m\], where the coupling acts [as built](Coupling::as_built); else zero.
    pub rest: T,
    /// The anchor of the pair that the last evaluation has left, if it has left one.
    pub anchor: Option<Anchor<T, D>>,
}

impl<L: Lane, const D: usize> CoupledPair<L, D> {
    /// From the second to the first \[m\].
    pub fn apart(&self) -> [L; D] {
        core::array::from_fn(|d| self.on.position[d] - self.from.position[d])
    }
    /// The reduced mass m₁m₂/(m₁ + m₂) \[kg\]; before a wall that of the first.
    pub fn reduced_mass(&self) -> L {
        let (on, from) = (self.on.mass, self.from.mass);
        let moves = from.lt(L::of(f64::INFINITY));
        L::select(moves, on * from / (on + from), on)
    }
    /// Half the sum of both spacings \[m\].
    pub fn spacing(&self) -> L {
        spacing(&self.on, &self.from)
    }
}

/// Half the sum of both spacings \[m\].
fn spacing<L: Lane, const D: usize>(on: &CoupledParticle<L, D>, from: &CoupledParticle<L, D>) -> L {
    L::of(0.5) * (on.spacing + from.spacing)
}

/// The length of a vector.
fn length<L: Lane, const D: usize>(vector: &[L; D]) -> L {
    vector.iter().fold(L::zero(), |sum, x| sum + *x * *x).sqrt()
}

/// What a pair does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairForce<T, const D: usize> {
    /// The force \[N\] on the first; that on the second is its opposite.
    pub force: [T; D],
    /// Energy that the pair stores \[J\].
    pub stored: f64,
    /// Heat \[J\] since the last evaluation.
    pub heat: f64,
    /// What the pair remembers for the next evaluation: it must not change when a state is evaluated twice.
    pub anchor: Option<Anchor<T, D>>,
}

impl<T: Real, const D: usize> PairForce<T, D> {
    /// A force that stores, heats and remembers nothing.
    pub fn of(force: [T; D]) -> Self {
        Self {
            force,
            stored: 0.0,
            heat: 0.0,
            anchor: None,
        }
    }
}

/// Stiffness M s^(D−2) \[N/m\] of what a particle stands for along an axis.
fn link<L: Lane, const D: usize>(stiffness: L, spacing: L) -> L {
    stiffness * spacing.powi(D as u32) / (spacing * spacing)
}

/// How two bodies act on each other.
///
/// A penalty force, as your own coupling:
///
/// ```
/// use meshfree::coupling::{CoupledParticle, Coupling};
/// use meshfree::prelude::*;
/// use meshfree::term::TermDoc;
///
/// /// Pushes apart what is nearer than a mean spacing, by k per metre.
/// #[derive(Clone, Copy, Debug)]
/// struct Penalty { stiffness: f64 }
///
/// impl<T: Real, const D: usize> Coupling<T, D> for Penalty {
///     fn name(&self) -> &'static str { "penalty" }
///     fn document(&self) -> TermDoc {
///         TermDoc { name: "penalty".into(), equation: "F = k (s − |r|) r/|r|", source: "this example" }
///     }
///     fn reach(&self, spacings: [f64; 2]) -> f64 { 0.5 * (spacings[0] + spacings[1]) }
///     fn force(&self, on: &CoupledParticle<T, D>, from: &CoupledParticle<T, D>) -> [T; D] {
///         let r: [T; D] = core::array::from_fn(|d| on.position[d] - from.position[d]);
///         let distance = r.iter().fold(T::zero(), |sum, x| sum + *x * *x).sqrt();
///         let spacing = T::from_f64(0.5) * (on.spacing + from.spacing);
///         r.map(|x| T::from_f64(self.stiffness) * (spacing - distance) * x / distance)
///     }
///     fn step(&self, on: &CoupledParticle<T, D>, from: &CoupledParticle<T, D>) -> f64 {
///         let mass = on.mass.to_f64().min(from.mass.to_f64());
///         0.5 * (mass / self.stiffness).sqrt()
///     }
/// }
///
/// // A copper ball of the first scheme strikes a steel plate of another.
/// let ball = Body::block("ball", catalogue::copper(), [0.0], [0.01], 5e-4).velocity([-10.0]);
/// let plate = Body::block("plate", catalogue::steel(), [-0.01], [0.0], 5e-4);
/// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
///     .body(ball)
///     .group(schemes::impact_by_continuity(), [plate])
///     .couple("ball", "plate", Penalty { stiffness: 1e14 })
///     .build()?;
/// let before = simulation.ledger().whole.momentum[0];
/// simulation.run_until(2e-6)?;
/// let ledger = simulation.ledger();
/// assert!(ledger.bodies[1].1.momentum[0] < 0.1 * before, "the plate is pushed");
/// assert!((ledger.whole.momentum[0] / before - 1.0).abs() < 1e-12);
/// assert_eq!(simulation.couplings()[0].name, "penalty");
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a coupling in {D} dimensions",
    note = "implement `Coupling<{T}, {D}>`: what it is, and how particles of the two bodies act on each other"
)]
pub trait Coupling<T: Real, const D: usize>: Debug + Send + Sync {
    /// Its name in reports, and of its limit of the step.
    fn name(&self) -> &'static str;
    /// What it is, with its equation and source; [`Simulation::couplings`] lists it.
    ///
    /// [`Simulation::couplings`]: crate::simulation::Simulation::couplings
    fn document(&self) -> TermDoc;
    /// Whether particles of the second body stand among those of the first, a liquid, as walls.
    fn is_wall(&self) -> bool {
        false
    }
    /// The mass \[kg\] with which they do, where the liquid has a density at rest of `rest` \[kg/m³\].
    fn wall_mass(&self, _rest: T, particle: &CoupledParticle<T, D>) -> T {
        particle.mass
    }
    /// The same as a record for a device, of the density at rest, the mass and the density of the particle. A scene whose walls have
    /// none is refused there.
    #[cfg(feature = "devices")]
    fn wall_mass_record(&self) -> Option<Record> {
        None
    }
    /// How near \[m\] two particles must be to act on each other by [`force`](Self::force), for bodies of these
    /// spacings \[m\]; zero if none do.
    fn reach(&self, _spacings: [f64; 2]) -> f64 {
        0.0
    }
    /// The force \[N\] on a particle of the first body by one of the second; that on the second is its opposite.
    fn force(&self, _on: &CoupledParticle<T, D>, _from: &CoupledParticle<T, D>) -> [T; D] {
        [T::zero(); D]
    }
    /// Whether it sums over pairs before forces, by [`gather`](Self::gather).
    fn gathers(&self) -> bool {
        false
    }
    /// What a particle adds to the sum of one of the other side, and to its gradient \[1/m\]; asked for both sides.
    fn gather(&self, _on: &CoupledParticle<T, D>, _from: &CoupledParticle<T, D>) -> (T, [T; D]) {
        (T::zero(), [T::zero(); D])
    }
    /// The pressure \[Pa\] of a particle by its sums, and the energy that it stores \[J\]; `spacing` \[m\] is the mean of both
    /// bodies.
    fn pressure(&self, _on: &CoupledParticle<T, D>, _spacing: T) -> (T, f64) {
        (T::zero(), 0.0)
    }
    /// What a pair does: by default [`force`](Self::force), and no more.
    fn act(&self, pair: &CoupledPair<T, D>) -> PairForce<T, D> {
        PairForce::of(self.force(&pair.on, &pair.from))
    }
    /// Whether [`act`](Self::act) and [`pressure`](Self::pressure) say all energy that it stores, so that the ledger may hold it
    /// against its work ([`StoredEnergy`](crate::simulation::StoredEnergy)); not so by default.
    fn books_energy(&self) -> bool {
        false
    }
    /// [`gather`](Self::gather), [`pressure`](Self::pressure), [`act`](Self::act) and [`step`](Self::step) as records for a device, which
    /// [`CouplingRecord::of`] makes of texts that are generic over lanes. A scene with a coupling by forces that has none is refused there.
    #[cfg(feature = "devices")]
    fn record(&self) -> Option<CouplingRecord> {
        None
    }
    /// Whether it acts on the pairs that are within reach as built, however far they move, and on no others.
    fn as_built(&self) -> bool {
        false
    }
    /// The largest stable step \[s\] of a pair within reach.
    fn step(&self, _on: &CoupledParticle<T, D>, _from: &CoupledParticle<T, D>) -> f64 {
        f64::INFINITY
    }
    /// What is wrong with its parameters, as `(field, value, what it must be)`; empty if nothing.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of columns for what couplings declare, and no others; without one of them there is nothing to see.
    #[test]
    fn couplings_see_what_they_declare() {
        let reads = CoupledParticle::<f64, 2>::READS;
        let mut columns = Columns::<f64, 2>::new(reads, 3);
        for (n, (_, column)) in columns.iter_mut().enumerate() {
            column.fill(1.0 + n as f64);
        }
        let own = CoupledParticle::of(&columns, 2, 0.1);
        let seen = [own.position[1], own.velocity[0], own.mass, own.density];
        assert!(seen.iter().all(|value| *value >= 1.0) && own.spacing == 0.1);
        for field in reads.iter() {
            let columns = Columns::<f64, 2>::new(reads.minus(Fields::of(&[field])), 3);
            let seen = std::panic::catch_unwind(|| CoupledParticle::of(&columns, 2, 0.1));
            assert!(seen.is_err(), "{field:?}");
        }
    }
}
