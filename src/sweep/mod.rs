//! The hot loop: every sum over neighbours in the crate runs here.
//! Rows of particles against one broadcast neighbour, in fixed order, over fixed chunks of clusters.

mod program;
mod records;
mod rows;

pub use program::{PairSweep, Pass, Program, SweepInput};
pub(crate) use records::two_sum;
pub use records::{Image, Records, Transform};
pub use rows::{Reaction, Rows};

/// What a pair of blocks does to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Interaction {
    /// As particles of one body: carries compression and tension.
    #[default]
    Bonded,
    /// Carries compression only, and opens.
    ///
    /// A particle touches the other side where its kernel sum across the contact exceeds what it was
    /// when the two sides just met: what a full neighbourhood lacks there, or, where the bodies lie
    /// against each other in the scene, exactly what is found.
    ///
    #[doc = include_str!("../../docs/equations/contact_touch.html")]
    ///
    /// A pair across the contact acts as far as its members touch, and shows only pressure that
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

/// The instruction set that the pair loop runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// What every machine of the target has; no fused multiply-add, the same bits everywhere.
    Baseline,
    /// x86-64 with AVX2 and FMA.
    Avx2,
    /// x86-64 with AVX-512 F, VL and DQ.
    Avx512,
}

impl InstructionSet {
    /// The best that this machine has.
    #[must_use]
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("fma")
            {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }

    /// Whether this machine has it.
    #[must_use]
    pub fn available(self) -> bool {
        self <= Self::detect()
    }
}
