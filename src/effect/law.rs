//! A law: what an effect does to single particles between sweeps over pairs.
//! Consecutive laws of a stage run chunk by chunk, in one pass over the particles.

use super::{Chunk, Rung};
use crate::particles::{Fields, Outputs};
use crate::scalar::Real;
use core::fmt::Debug;

/// What a law reports of a chunk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Tally {
    /// Particles at which it applied a limit.
    pub limited: u64,
    /// Largest relative change, of a law that is repeated until that is small.
    pub change: f64,
}

/// Most laws of a stage.
pub const MOST_LAWS: usize = 32;

/// What a law reads and writes in a scheme that carries some fields: what it declares, without what is optional and not there.
pub(crate) fn reads_and_writes<T: Real, const D: usize>(
    law: &dyn Law<T, D>,
    carried: Fields,
) -> [Fields; 2] {
    let absent = law.optional().minus(carried);
    [law.reads(), law.writes()].map(|own| own.minus(absent))
}

/// What an effect does to single particles at a stage. Where that is arithmetic, a [`PointLaw`](super::PointLaw) is written instead, and
/// is one of these; a law that implements this trait itself loops over columns.
///
/// A law sees a [`Chunk`]: some particles of one body, with their columns and sums. It must treat each particle
/// by itself, so that results do not depend on where chunks end. It reaches the fields and sums that it declares and no
/// others: one that asks for more ends the run with a panic that names both.
///
/// Laws of a stage run in an order that follows from their declarations, whatever the order of the effects: a law that reads
/// a field comes after those that write it, unless it asks for the value [before](Self::before); of those that change one
/// field the lower [rung](Self::rung) comes first; laws that have nothing to do with each other, or that both [add](Self::adds) to a
/// field, run in the order of their names. A scheme in which this leaves two laws without an order, or sends them in a circle, is
/// refused.
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
    /// Fields that it writes. What it also reads it changes, what it [adds](Self::adds) to keeps what others have added, and all else
    /// it makes anew for every particle.
    fn writes(&self) -> Fields;
    /// Those of `writes` to which it adds what does not depend on their values, as a force or a shift: laws that only add to a field
    /// may follow each other in any order.
    fn adds(&self) -> Fields {
        Fields::NONE
    }
    /// Those of `reads` and `writes` that it uses where the scheme has them for other reasons, and does without elsewhere.
    fn optional(&self) -> Fields {
        Fields::NONE
    }
    /// Those of `reads` whose value it takes as it is before other laws of its stage write it, as what the step before has left.
    /// Of all others it takes the value after them.
    fn before(&self) -> Fields {
        Fields::NONE
    }
    /// Where it stands among laws of its stage that change the same field.
    fn rung(&self) -> Option<Rung> {
        None
    }
    /// Acts on some particles.
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally;
    /// Largest number of times, and the largest relative change at which to stop, of a law that is repeated with
    /// its sweep; it runs once if not given. Particles that it has changed by less are left alone while others go on (64 at a
    /// time), so what it changes must enter the sums of the particle itself, and of no other.
    fn repeats(&self) -> Option<(usize, f64)> {
        None
    }
    /// Its record in a scheme that has some fields, if it is lane text.
    #[cfg(any(test, feature = "devices"))]
    fn record(
        &self,
        _around: &super::Around<'_, T, D>,
        _there: Fields,
    ) -> Option<super::PointRecord> {
        None
    }
}
