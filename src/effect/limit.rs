//! Limits of the time step that an effect asks for.
//! Each is a name and the largest stable step of a particle.

use super::View;
use crate::particles::{Fields, Outputs};
use crate::scalar::Real;
use core::fmt::Debug;

/// The largest stable step of an effect.
pub trait Limit<T: Real, const D: usize>: Debug + Send + Sync {
    /// Its name in reports, with the formula: `"conduction: h² ρ c/k"`.
    fn name(&self) -> &'static str;
    /// Fields that it reads; it reaches no others.
    fn reads(&self) -> Fields;
    /// Sums of the rates that it reads.
    fn sums(&self) -> Outputs {
        Outputs::NONE
    }
    /// The largest step \[s\] of the particle in a slot; infinity if it does not limit. What is negative or no
    /// number ends the run.
    fn step(&self, at: &View<'_, T, D>, slot: usize) -> f64;
    /// Its record, if it is lane text.
    #[cfg(any(test, feature = "devices"))]
    fn record(&self, _view: &View<'_, T, D>) -> Option<super::PointRecord> {
        None
    }
}
