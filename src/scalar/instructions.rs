//! Instruction sets: which of them the loops over neighbours are compiled for.
//! The machine chooses at run time.

/// The instruction set that the loops over neighbours run on.
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
    /// All of them, which a checkpoint knows by their names.
    #[cfg(feature = "checkpoint")]
    pub(crate) const ALL: [Self; 3] = [Self::Baseline, Self::Avx2, Self::Avx512];

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

    /// The set itself if this machine has it, the baseline if not.
    #[must_use]
    pub fn or_baseline(self) -> Self {
        if self.available() {
            self
        } else {
            Self::Baseline
        }
    }

    /// Whether this machine has it.
    #[must_use]
    pub fn available(self) -> bool {
        self <= Self::detect()
    }
}
