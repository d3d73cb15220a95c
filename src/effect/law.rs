//! A law: what an effect does to single particles between sweeps over pairs.
//! Consecutive laws of a stage run chunk by chunk, in one pass over the particles.

use super::Chunk;
use crate::particles::{Fields, Outputs};
use crate::scalar::Real;
use core::fmt::Debug;

/// What a law reports of a chunk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Particles at which it applied a limit.
    pub limited: u64,
    /// Largest relative change, of a law that is repeated until that is small.
    pub change: f64,
}

/// Most laws of a stage.
pub const MOST_LAWS: usize = 16;

/// What an effect does to single particles at a stage.
///
/// A law sees a [`Chunk`]: some particles of one body, with their columns and sums. It must treat each particle
/// by itself, so that results do not depend on where chunks end.
///
/// A law of [`Stage::Rates`](crate::term::Stage::Rates) that adds to [`Field::FORCE`](crate::particles::Field::FORCE) gives particles a force \[N\]. It acts
/// with every integrator as forces of pairs do; what it works and the momentum that it gives are in the
/// [ledger](crate::simulation::Ledger). Work of a law is no heat. An effect whose force stores energy says how much
/// ([`StepProgram::store`](super::StepProgram::store)), and one whose force is from outside does not say that it
/// [books energy](super::Effect::BOOKS_ENERGY).
pub trait Law<T: Real, const D: usize>: Debug + Send + Sync {
    /// Its name, where a scheme prints its step.
    fn name(&self) -> &'static str;
    /// Fields that it reads, and that must have been written before.
    fn reads(&self) -> Fields;
    /// Sums of its stage that it reads, and that a term must write.
    fn sums(&self) -> Outputs {
        Outputs::NONE
    }
    /// Fields that it writes.
    fn writes(&self) -> Fields;
    /// Acts on some particles.
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally;
    /// Largest number of times, and the largest relative change at which to stop, of a law that is repeated with
    /// its sweep; it runs once if not given. Particles that it has changed by less are left alone while others go on (64 at a
    /// time), so what it changes must enter the sums of the particle itself, and of no other.
    fn repeats(&self) -> Option<(usize, f64)> {
        None
    }
}
