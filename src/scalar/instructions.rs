//! Instruction sets: which of them the loops over neighbours are compiled for.
//! The machine chooses at run time, or the build, where it is for one machine.

use super::{Lane, Real};
#[cfg(target_arch = "x86_64")]
use super::{OnAvx2, OnAvx512};

/// The instruction set that the loops over neighbours run on.
///
/// A build holds the loops of all of them, and [`detect`](Self::detect) chooses at run time. Sets below what the compiler is told
/// that every machine has are left out: `RUSTFLAGS="-C target-cpu=native"` compiles in less time for this machine alone, to the
/// same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
// Loops run on a set after `or_detected`, so one that the machine lacks is harmless wherever its name was read.
#[cfg_attr(feature = "serde", allow(clippy::unsafe_derive_deserialize))]
pub enum InstructionSet {
    /// What every machine of the target has. It has no fused multiply-add, so sums, products and roots round alike everywhere,
    /// and with them elementary functions.
    Baseline,
    /// x86-64 with AVX2 and FMA.
    Avx2,
    /// x86-64 with AVX-512 F, VL and DQ.
    Avx512,
}

/// Work on rows, which [`InstructionSet::run`] compiles for each instruction set.
///
/// What [`run`](Self::run) calls ought to be `#[inline(always)]`: a function of its own is compiled for what every machine of the
/// target has.
///
/// ```
/// use meshfree::scalar::{InstructionSet, Lane, OnRows};
/// struct Sum<'a>(&'a [f64]);
/// impl OnRows<f64> for Sum<'_> {
///     type Output = f64;
///     #[inline(always)]
///     fn run<L: Lane<Scalar = f64, Broadcast = f64>>(self) -> f64 {
///         let rows = self.0.chunks_exact(L::WIDTH);
///         let sum = rows.fold(L::zero(), |sum, row| sum + L::from_fn(|k| row[k]));
///         (0..L::WIDTH).map(|k| sum.extract(k)).sum()
///     }
/// }
/// assert_eq!(InstructionSet::detect().run(Sum(&[0.5; 64])), 32.0);
/// ```
pub trait OnRows<T: Real> {
    /// What comes of it.
    type Output;
    /// Does it with rows of type `L`, of the width of [`Real::Wide`].
    fn run<L: Lane<Scalar = T, Broadcast = T>>(self) -> Self::Output;
}

/// Rows in the registers of an instruction set. Its instructions are only there on machines that have it, so nothing but loops
/// that [`InstructionSet`] has chosen for such a machine may name these rows: the module of the trait and of its types is private.
pub trait Instructions: 'static {
    /// A block of eight particles.
    type Double: Lane<Scalar = f64, Broadcast = f64>;
    /// A block of sixteen particles.
    type Single: Lane<Scalar = f32, Broadcast = f32>;
}

/// Work on rows of its own, without fused lanes: compiled for wider registers it has the same bits. What [`run`](Self::run)
/// calls ought to be `#[inline(always)]`, as with [`OnRows`].
pub(crate) trait OnOwnRows {
    /// What comes of it.
    type Output;
    /// Does it.
    fn run(self) -> Self::Output;
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn own_on_avx2<W: OnOwnRows>(work: W) -> W::Output {
    work.run()
}

/// Does work on rows of its own in registers that the machine has beyond those of the baseline: rows of the baseline take four
/// instructions for one, and functions of a library for products that round once.
#[inline(always)]
pub(crate) fn on_wide_registers<W: OnOwnRows>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
        // SAFETY: this machine has the instructions.
        return unsafe { own_on_avx2(work) };
    }
    work.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,fma")]
fn on_avx512<T: Real, W: OnRows<T>>(work: W) -> W::Output {
    work.run::<T::In<OnAvx512>>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn on_avx2<T: Real, W: OnRows<T>>(work: W) -> W::Output {
    work.run::<T::In<OnAvx2>>()
}

impl InstructionSet {
    /// All of them, which a checkpoint knows by their names.
    #[cfg(feature = "checkpoint")]
    pub(crate) const ALL: [Self; 3] = [Self::Baseline, Self::Avx2, Self::Avx512];

    /// What the compiler is told that every machine of the target has.
    const LEAST: Self = if cfg!(all(
        target_feature = "avx512f",
        target_feature = "avx512vl",
        target_feature = "avx512dq",
        target_feature = "fma"
    )) {
        Self::Avx512
    } else if cfg!(all(target_feature = "avx2", target_feature = "fma")) {
        Self::Avx2
    } else {
        Self::Baseline
    };

    /// Whether this build holds loops for it.
    #[must_use]
    pub const fn compiled(self) -> bool {
        self as u8 >= Self::LEAST as u8
    }

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

    /// The set itself if this machine and this build have it, the best that they have if not.
    #[must_use]
    pub fn or_detected(self) -> Self {
        if self.available() {
            self
        } else {
            Self::detect()
        }
    }

    /// Does work with rows of this set, or of the best that this machine has where it lacks that.
    #[inline(always)]
    pub fn run<T: Real, W: OnRows<T>>(self, work: W) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        match self.or_detected() {
            // SAFETY: this machine has the instructions.
            Self::Avx512 => return unsafe { on_avx512::<T, W>(work) },
            // SAFETY: as above.
            Self::Avx2 if const { Self::Avx2.compiled() } => {
                return unsafe { on_avx2::<T, W>(work) };
            }
            _ => {}
        }
        if const { !Self::Baseline.compiled() } {
            unreachable!("a build without loops of the baseline is for machines that have more");
        }
        work.run::<T::Wide<false>>()
    }

    /// Whether this machine and this build have it.
    #[must_use]
    pub fn available(self) -> bool {
        self.compiled() && self <= Self::detect()
    }
}
