//! The scalars, `f32` and `f64`: what particles are stored in, and lanes of one element.
//! In what the two differ is in the two lines at the end.

use super::instructions::Instructions;
use super::root::{root_by_divider, root_of_lanes};
use super::{Lane, Lanes, elementary, halves};
use core::fmt::{Display, LowerExp};
use core::iter::Sum;
use num_traits::NumAssign;
use std::cell::RefCell;

/// A floating-point type that particles can be stored in: `f32` or `f64`.
///
/// Sealed. What the two differ in, besides their digits: `f32` keeps the rounding error of positions
/// and densities in columns of its own ([`COMPENSATED`](Real::COMPENSATED)), because a plain `f32`
/// coordinate loses some per cent of a strain of 0.25 % at a spacing of 0.05 mm in 50 mm.
pub trait Real:
    Lane<Scalar = Self, Broadcast = Self, Mask = bool>
    + NumAssign
    + Sum
    + Default
    + Display
    + LowerExp
    + PartialOrd
    + sealed::Sealed
{
    /// Whether positions and densities carry a second number that holds their rounding error.
    const COMPENSATED: bool;
    /// The distance of one to the next number: twice the relative rounding error.
    const EPSILON: f64;
    /// The name in files and on command lines: `f32` or `f64`.
    const NAME: &'static str;
    /// The block of particles that the pair loop takes at once; its width depends on the scalar
    /// alone, so sums have the same order on every machine.
    type Wide<const FUSED: bool>: Lane<Scalar = Self, Broadcast = Self>;
    /// The same block in the registers of an instruction set.
    #[doc(hidden)]
    type In<S: Instructions>: Lane<Scalar = Self, Broadcast = Self>;

    /// The root of a row ([`Lane::root`]).
    fn root_of_row<const W: usize, const FUSED: bool>(
        row: Lanes<Self, W, FUSED>,
    ) -> Lanes<Self, W, FUSED>;

    /// The sum of the elements of a row, or the largest of them.
    #[doc(hidden)]
    fn halves(row: &[Self], largest: bool) -> Self;
    /// Room for so many numbers that the thread keeps, aligned for rows: zeros, which `work` has to leave behind again. It
    /// must not ask for room. What unwinds takes its room with it.
    #[doc(hidden)]
    fn with_room(length: usize, work: &mut dyn FnMut(&mut [Self]));
    /// Rounded from `f64`.
    fn from_f64(value: f64) -> Self;
    /// Widened to `f64`.
    fn to_f64(self) -> f64;
}

/// Lanes of a row, by the scalar alone.
pub(crate) fn width<T: Real>() -> usize {
    <T::Wide<false> as Lane>::WIDTH
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

macro_rules! real {
    ($T:ident, $width:literal, $compensated:literal, $root:ident, $halves:ident, $In:ident) => {
        impl Lane for $T {
            type Scalar = $T;
            type Broadcast = $T;
            type Mask = bool;
            const WIDTH: usize = 1;
            #[inline(always)]
            fn splat(value: $T) -> $T {
                value
            }
            #[inline(always)]
            fn broadcast(value: $T) -> $T {
                value
            }
            #[inline(always)]
            fn from_fn(mut f: impl FnMut(usize) -> $T) -> $T {
                f(0)
            }
            #[inline(always)]
            fn extract(self, _k: usize) -> $T {
                self
            }
            #[inline(always)]
            fn map(self, f: impl Fn($T) -> $T) -> $T {
                f(self)
            }
            #[inline(always)]
            fn mul_add(self, factor: $T, summand: $T) -> $T {
                self * factor + summand
            }
            #[inline(always)]
            fn fused(self, factor: $T, summand: $T) -> $T {
                $T::mul_add(self, factor, summand)
            }
            #[inline(always)]
            fn sqrt(self) -> $T {
                $T::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> $T {
                $T::abs(self)
            }
            #[inline(always)]
            fn powf(self, exponent: f64) -> $T {
                elementary::powf::<false>(f64::from(self), exponent) as $T
            }
            #[inline(always)]
            fn exp(self) -> $T {
                elementary::exp(f64::from(self)) as $T
            }
            #[inline(always)]
            fn ln(self) -> $T {
                elementary::ln(f64::from(self)) as $T
            }
            #[inline(always)]
            fn cbrt(self) -> $T {
                elementary::cbrt(f64::from(self)) as $T
            }
            #[inline(always)]
            fn sin(self) -> $T {
                elementary::sin(f64::from(self)) as $T
            }
            #[inline(always)]
            fn cos(self) -> $T {
                elementary::cos(f64::from(self)) as $T
            }
            #[inline(always)]
            fn acos(self) -> $T {
                elementary::acos(f64::from(self)) as $T
            }
            #[inline(always)]
            fn atan(self) -> $T {
                elementary::atan(f64::from(self)) as $T
            }
            #[inline(always)]
            fn min(self, other: $T) -> $T {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn max(self, other: $T) -> $T {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn lt(self, other: $T) -> bool {
                self < other
            }
            #[inline(always)]
            fn le(self, other: $T) -> bool {
                self <= other
            }
            #[inline(always)]
            fn select(mask: bool, yes: $T, no: $T) -> $T {
                if mask { yes } else { no }
            }
        }

        impl Real for $T {
            const COMPENSATED: bool = $compensated;
            const EPSILON: f64 = $T::EPSILON as f64;
            const NAME: &'static str = stringify!($T);
            type Wide<const FUSED: bool> = Lanes<$T, $width, FUSED>;
            type In<S: Instructions> = S::$In;
            #[inline(always)]
            fn root_of_row<const W: usize, const FUSED: bool>(
                row: Lanes<Self, W, FUSED>,
            ) -> Lanes<Self, W, FUSED> {
                $root(row)
            }
            #[inline(always)]
            fn halves(row: &[$T], largest: bool) -> $T {
                halves::$halves(row, largest)
            }
            fn with_room(length: usize, work: &mut dyn FnMut(&mut [$T])) {
                // The bytes of a row of either scalar.
                const ROW: usize = 64;
                thread_local! {
                    static ROOM: RefCell<Vec<$T>> = const { RefCell::new(Vec::new()) };
                }
                let mut room = ROOM.take();
                let spare = ROW / size_of::<$T>();
                if room.len() < length + spare {
                    room.resize(length + spare, 0.0);
                }
                let start = room.as_ptr().align_offset(ROW);
                work(&mut room[start..start + length]);
                ROOM.set(room);
            }
            #[inline(always)]
            fn from_f64(value: f64) -> $T {
                value as $T
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
        }
    };
}
real!(f64, 8, false, root_of_lanes, of_eight, Double);
real!(f32, 16, true, root_by_divider, of_sixteen, Single);
