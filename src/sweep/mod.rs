//! The hot loop: every sum over neighbours in the crate runs here.
//! Rows of particles against one broadcast neighbour, in fixed order, over fixed chunks of clusters.
//!
//! A fused pair kernel is a smoothing kernel and a tuple of [terms](crate::term), compiled into one loop. A scheme
//! holds it behind a trait that forgets its type; that costs one indirect call a sweep, and none a pair.
//!
//! # How the loop works
//!
//! - **Records.** Before a sweep the fields that its terms read are packed side by side, one
//!   record a particle. Images behind boundaries are records too, made from their
//!   source by a [`Transform`], so the loop does not know that there are boundaries.
//! - **Clusters.** W consecutive particles, 8 in `f64` and 16 in `f32`, form a cluster with one list of
//!   neighbours. Particles are sorted along a space-filling curve, so a cluster is compact.
//! - **Lanes.** The cluster is a row of W lanes. Each neighbour is loaded once and broadcast to all of
//!   them; lanes need arithmetic only, no gathering and no sum across. Where one smoothing length serves
//!   all, a first look at the distances leaves out neighbours that no lane reaches; lists have those first
//!   that need no look, because the skin cannot carry them so far. The other pairs beyond the support are
//!   computed too and add zero, because W and F vanish there.
//! - **Once for both.** A pair of particles of one chunk and block is evaluated when the earlier of their clusters meets it.
//!   The forces on the other side are the opposite ones, and its other sums the same terms with i and j exchanged; they
//!   are kept lane by lane, and added up when the chunk is done. A third of all rows is saved, at a third of the price of one.
//!   It takes a second loop, so it is done for sweeps of liquids on wide instructions; in all others, and across contacts, each side
//!   is evaluated by itself.
//! - **Two pairs under way.** The distance of the next pair is begun before the terms of this one: a root
//!   takes longer than a processor looks ahead. In `f64` some processors make it faster of products
//!   ([`Root`]).
//! - **Directions last.** A term adds to the force along rᵢⱼ and along vᵢⱼ as two numbers, or as a vector where
//!   it has another direction. The loop turns them into one vector for all terms, so a tuple of terms costs
//!   what one written-out loop costs, and makes power and work of it, so no term can lose its own.
//! - **Instruction sets.** In 2D and 3D the loop exists for the baseline of the target, AVX2 and
//!   AVX-512, and the machine chooses at run time ([`InstructionSet::detect`]). In 1D, and for a kernel
//!   that is itself chosen at run time, the baseline serves.
//!
//! # The same bits on any number of threads
//!
//! Each particle sums over its own neighbours in the order of its list, which is the same whoever made
//! it; no thread adds to what belongs to
//! another, so there are no locks and no atomics. Threads take chunks of 64 clusters,
//! a number that depends on nothing, and reductions have a fixed
//! shape. Another instruction set, another [`Root`], or another skin of the lists, changes rounding.
//!
//! # Positions in `f32`
//!
//! A strain of 0.25 % at a spacing of 0.05 mm in 50 mm is 125 nm, and the last bit of 50 mm in `f32` is
//! 3.7 nm: a plain coordinate loses some per cent of the stress. Positions in `f32` therefore carry the
//! rounding error of their updates as a second number ([`Field::POSITION_RESIDUAL`]), and the loop adds
//! the difference of the residuals to the difference of the positions. The price is D numbers a record
//! and 2D additions a pair. `f64` has neither.
//!
//! [`Field::POSITION_RESIDUAL`]: crate::particles::Field::POSITION_RESIDUAL

mod fused_kernel;
mod message;
#[cfg(feature = "devices")]
mod pair_record;
mod records;
mod results;
mod task;
#[cfg(test)]
mod tests;
mod work;

// For the crate's own benches: no part of its interface.
#[doc(hidden)]
pub use fused_kernel::{FusedKernel, PairSweep, Pass, SweepInput};
#[cfg(feature = "devices")]
#[doc(hidden)]
pub use pair_record::PairRecord;
pub use records::Transform;
#[doc(hidden)]
pub use records::{Ghosts, Records};
pub(crate) use records::{Image, add_compensated, two_sum};
#[cfg(any(feature = "checkpoint", feature = "devices"))]
pub(crate) use results::Reaction;
#[doc(hidden)]
pub use results::Results;

pub use crate::scalar::{InstructionSet, Root};

/// What a pair of blocks does to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Interaction {
    /// As particles of one body: carries compression and tension.
    #[default]
    Bonded,
    /// Carries compression only, and opens.
    ///
    /// A particle is active in a contact where its kernel sum across the contact exceeds what it was
    /// when the two sides just met: what a full neighbourhood lacks there, or, where the bodies abut
    /// in the scene, exactly what is found.
    ///
    #[doc = include_str!("../../docs/equations/contact_activity.html")]
    ///
    /// A pair across the contact acts as far as its members are active, and shows only pressure that
    /// compresses. Viscosity carries the mean of the two θ, so a gap has neither force nor friction.
    ///
    #[doc = include_str!("../../docs/equations/contact_force.html")]
    Unilateral,
    /// Nothing.
    None,
}

/// How the kernel of a pair gets its smoothing length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SmoothingMode {
    /// One smoothing length for the whole group: no field, no division in the loop.
    #[default]
    Uniform,
    /// The mean of the two.
    Mean,
    /// Each side its own (Springel & Hernquist 2002).
    Own,
}

impl SmoothingMode {
    /// The bits of all modes.
    pub const ALL: u8 = 0b111;

    /// The mode's bit in a set of modes.
    #[must_use]
    pub const fn bit(self) -> u8 {
        1 << self as u8
    }
}
