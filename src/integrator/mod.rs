//! Time integrators: the trait, and one file for each family.
//! An integrator sees a system as a handful of operations on all particles at once.
//!
//! | integrator | order | evaluations a step | stable step | compatible energy | use it for |
//! |---|---|---|---|---|---|
//! | [`KickDriftKick`] | 2 | 1 | 1 | yes | the default |
//! | [`DriftKickDrift`] | 2 | 1 | 1 | yes | the same with forces at half steps |
//! | [`PositionVerlet`] | 2 | 2 | 1 | yes | forces that change fast with velocity |
//! | [`LamLeapfrog`] | 2 | 2, or 1 if lagged | 0.71, or 0.58 | yes | repeating Lam, Shen & Gong (2002) |
//! | [`Midpoint`] | 2 | 2 | 0.5 | no | comparison |
//! | [`StrongStabilityPreserving3`] | 3 | 3 | 0.87 | no | damped flow at third order |
//! | [`RungeKutta4`] | 4 | 4 | 1.41 | no | reference in time |
//!
//! The two leapfrogs have the same error. Where density is summed and work is done in kicks (`schemes::impact`) drift–kick–drift
//! evaluates fewer pairs; where density is integrated (`schemes::weakly_compressible`), more ([accuracy and cost](crate#pages)).
//!
//! The stable step is on an undamped oscillator, relative to the leapfrog's ω dt = 2; the time step of
//! a simulation is multiplied by it. Midpoint has none without damping and is kept short. An integrator
//! that kicks changes velocity by [`System::kick`] alone, which is where the compatible energy form sums
//! its work; one that combines states ([`System::combine`]) needs
//! [`EnergyForm::Symmetric`](crate::scheme::EnergyForm), and takes no liquid, whose density is summed in drifts.

mod lam;
mod leapfrog;
pub(crate) mod oscillator;
mod runge_kutta;

pub use lam::{LamLeapfrog, Predictor};
pub use leapfrog::{DriftKickDrift, KickDriftKick, PositionVerlet};
pub use runge_kutta::{Midpoint, RungeKutta4, StrongStabilityPreserving3};

use crate::error::Result;
use core::fmt::Debug;

/// What an integrator can ask of a simulation.
///
/// The state Y is position, velocity, density where it is integrated, internal energy where it is
/// carried, and smoothing length where it follows the divergence. Every operation acts on all
/// particles. Viscosity coefficients are no part of it: they follow the flow once a step.
pub trait System {
    /// Evaluates all rates at the present state, for the time t + `offset` \[s\] with t the time at
    /// the start of the step.
    ///
    /// # Errors
    /// If a number is no longer finite.
    fn evaluate(&mut self, offset: f64) -> Result<()>;
    /// v ← v + `dt` a, and what pair forces work during it into internal energy.
    fn kick(&mut self, dt: f64);
    /// x ← x + `dt` v, and with it the density where it is integrated, at the midpoint of the drift.
    /// `offset` \[s\] is the time of the start of the drift after the start of the step.
    ///
    /// # Errors
    /// If a number is no longer finite.
    fn drift(&mut self, dt: f64, offset: f64) -> Result<()>;
    /// x ← x + `dv` v + `da` a, and nothing else.
    fn shift(&mut self, dv: f64, da: f64);
    /// Sets what a kick changes `dt` \[s\] ahead with the last rates, for the forces that need them;
    /// [`restore`](System::restore) takes it back.
    fn predict(&mut self, dt: f64);
    /// Takes the last prediction back.
    fn restore(&mut self);
    /// Keeps the present state in a slot.
    fn save(&mut self, slot: usize);
    /// Brings a kept state back; the last rates stay.
    fn load(&mut self, slot: usize);
    /// Y ← `a` · kept + `b` · Y + `dt` · dY/dt, with the last rates.
    fn combine(&mut self, slot: usize, a: f64, b: f64, dt: f64);
    /// kept ← kept + `dt` · dY/dt, with the last rates.
    fn accumulate(&mut self, slot: usize, dt: f64);
    /// Whether rates at the present state are at hand from the step before.
    fn has_rates(&self) -> bool;
}

/// An integrator in time.
///
/// ```
/// use meshfree::error::Result;
/// use meshfree::integrator::{Integrator, System};
///
/// /// Symplectic Euler: kick, then drift. First order.
/// #[derive(Clone, Debug)]
/// struct SymplecticEuler;
///
/// impl Integrator for SymplecticEuler {
///     fn name(&self) -> String { "symplectic Euler".into() }
///     fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
///         system.evaluate(0.0)?;
///         system.kick(dt);
///         system.drift(dt, 0.0)
///     }
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an integrator",
    note = "implement `Integrator`: a name and `step`, which composes the operations of `System`"
)]
pub trait Integrator: Debug + Send + Sync {
    /// Its name in reports.
    fn name(&self) -> String;
    /// Advances the system by `dt` \[s\].
    ///
    /// # Errors
    /// Passes on what an evaluation reports.
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<()>;
    /// Largest stable ω dt on an undamped oscillator, relative to the leapfrog's 2. A scene tries it on one, and is refused if
    /// that grows.
    fn stability(&self) -> f64 {
        1.0
    }
    /// How many states it keeps ([`System::save`] slots).
    fn slots(&self) -> usize {
        0
    }
    /// What is wrong with its parameters, as `(field, value, what it must be)`; empty if nothing.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
    /// Whether it advances a density that is integrated in time.
    fn integrates_density(&self) -> bool {
        true
    }
    /// Whether positions change by drifts alone, as sub-cycling needs, and what acts in the middle of drifts: shifting, pairing control,
    /// plastic flow, failure, elastic stress.
    fn drifts(&self) -> bool {
        self.kicks()
    }
    /// Whether velocity changes by kicks alone, as the compatible energy form needs.
    fn kicks(&self) -> bool {
        true
    }
}
