//! Limits of the time step that an effect asks for.
//! Each is a name and the largest step that a particle bears.

use super::View;
use crate::scalar::Real;
use core::fmt::Debug;

/// The largest step that an effect bears.
pub trait Limit<T: Real, const D: usize>: Debug + Send + Sync {
    /// Its name in reports, with the formula: `"conduction: h² ρ c/k"`.
    fn name(&self) -> &'static str;
    /// The largest step \[s\] of the particle in a slot; infinity if it does not limit. What is negative or no
    /// number ends the run.
    fn step(&self, at: &View<'_, T, D>, slot: usize) -> f64;
}
