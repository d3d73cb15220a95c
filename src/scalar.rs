//! Scalars and lanes: the only place that knows machine types.
//! One text of physics serves `f32` and `f64`, one particle at a time or a block of them.

mod instructions;

pub use instructions::InstructionSet;

use core::fmt::{Debug, Display, LowerExp};
use core::iter::Sum;
use core::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Index, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};
use num_traits::{NumAssign, One, Zero};

/// The outcome of comparing two lanes, element by element.
pub trait Mask:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + Not<Output = Self>
{
    /// A mask that is `value` in every element.
    fn all_of(value: bool) -> Self;
    /// The number of elements that are true.
    fn count(self) -> usize;
    /// Whether element `k` is true.
    fn test(self, k: usize) -> bool;
    /// Whether any element is true.
    fn any(self) -> bool {
        self.count() > 0
    }
}

impl Mask for bool {
    fn all_of(value: bool) -> Self {
        value
    }
    #[inline(always)]
    fn count(self) -> usize {
        self as usize
    }
    #[inline(always)]
    fn test(self, _k: usize) -> bool {
        self
    }
}

/// One value, or a short row of values on which arithmetic acts element by element.
///
/// The traits that a user can implement ([`Kernel`](crate::kernel::Kernel),
/// [`EquationOfState`](crate::material::eos::EquationOfState), …) have methods that are generic over
/// a lane. A plain `f32` or `f64` is the lane of one element, so such a method is written once, reads
/// like scalar code, and runs vectorised:
///
/// ```
/// use meshfree::scalar::{Lane, Lanes};
/// fn kinetic_energy<L: Lane>(mass: L, speed: L) -> L {
///     L::of(0.5) * mass * speed * speed
/// }
/// assert_eq!(kinetic_energy(2.0, 3.0), 9.0);
/// let speeds = Lanes::<f64, 4, false>::from_fn(|k| k as f64);
/// assert_eq!(kinetic_energy(Lanes::splat(2.0), speeds).extract(3), 9.0);
/// ```
pub trait Lane:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + Zero
    + One
{
    /// The type of one element.
    type Scalar: Real;
    /// The type of an element-wise comparison.
    type Mask: Mask;
    /// The number of elements.
    const WIDTH: usize;

    /// The same value in every element.
    fn splat(value: Self::Scalar) -> Self;
    /// Element `k` is `f(k)`.
    fn from_fn(f: impl FnMut(usize) -> Self::Scalar) -> Self;
    /// Element `k`.
    fn extract(self, k: usize) -> Self::Scalar;
    /// `f` applied to every element.
    fn map(self, f: impl Fn(Self::Scalar) -> Self::Scalar) -> Self;
    /// `self * factor + summand`, with one rounding on a fused lane and two elsewhere.
    fn mul_add(self, factor: Self, summand: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Square root of what is finite and not negative, within twice the machine epsilon, by whichever of
    /// divider and multiplications is faster. Zero gives zero, and a number too small for all its digits
    /// a root that is too small.
    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }
    /// Absolute value.
    fn abs(self) -> Self;
    /// The smaller of the two.
    fn min(self, other: Self) -> Self;
    /// The larger of the two.
    fn max(self, other: Self) -> Self;
    /// `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// `yes` where the mask holds, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// A constant, rounded to the scalar and the same in every element.
    #[must_use]
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self::splat(Self::Scalar::from_f64(value))
    }
    /// `self > other`.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// `self >= other`.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }
    /// `1 / self`.
    #[inline(always)]
    fn recip(self) -> Self {
        Self::one() / self
    }
    /// `self` to a whole power, by repeated squaring.
    #[inline(always)]
    fn powi(self, exponent: u32) -> Self {
        let (mut result, mut base, mut rest) = (Self::one(), self, exponent);
        while rest > 0 {
            if rest & 1 == 1 {
                result *= base;
            }
            base *= base;
            rest >>= 1;
        }
        result
    }
    /// `self` to a real power.
    fn powf(self, exponent: f64) -> Self;
    /// The exponential function.
    fn exp(self) -> Self;
    /// The natural logarithm.
    fn ln(self) -> Self;
    /// The larger of the value and zero.
    #[inline(always)]
    fn positive_part(self) -> Self {
        self.max(Self::zero())
    }
}

/// A floating-point type that particles can be stored in: `f32` or `f64`.
///
/// Sealed. What the two differ in, besides their digits: `f32` keeps the rounding error of positions
/// and densities in columns of its own ([`COMPENSATED`](Real::COMPENSATED)), because a plain `f32`
/// coordinate loses some per cent of a strain of 0.25 % at a spacing of 0.05 mm in 50 mm.
pub trait Real:
    Lane<Scalar = Self, Mask = bool>
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
    /// The name in files and on command lines: `f32` or `f64`.
    const NAME: &'static str;
    /// The block of particles that the pair loop takes at once; its width depends on the scalar
    /// alone, so sums have the same order on every machine.
    type Wide<const FUSED: bool>: Lane<Scalar = Self>;

    /// The root of a row ([`Lane::root`]).
    fn root_of_row<const W: usize, const FUSED: bool>(
        row: Lanes<Self, W, FUSED>,
    ) -> Lanes<Self, W, FUSED>;

    /// Rounded from `f64`.
    fn from_f64(value: f64) -> Self;
    /// Widened to `f64`.
    fn to_f64(self) -> f64;
    /// `self * factor + summand` with one rounding; slow where the machine lacks the instruction.
    fn fused(self, factor: Self, summand: Self) -> Self;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

macro_rules! real {
    ($T:ident, $width:literal, $compensated:literal, $root:ident) => {
        impl Lane for $T {
            type Scalar = $T;
            type Mask = bool;
            const WIDTH: usize = 1;
            #[inline(always)]
            fn splat(value: $T) -> $T {
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
            fn sqrt(self) -> $T {
                $T::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> $T {
                $T::abs(self)
            }
            #[inline(always)]
            fn powf(self, exponent: f64) -> $T {
                $T::powf(self, exponent as $T)
            }
            #[inline(always)]
            fn exp(self) -> $T {
                $T::exp(self)
            }
            #[inline(always)]
            fn ln(self) -> $T {
                $T::ln(self)
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
            const NAME: &'static str = stringify!($T);
            type Wide<const FUSED: bool> = Lanes<$T, $width, FUSED>;
            #[inline(always)]
            fn root_of_row<const W: usize, const FUSED: bool>(
                row: Lanes<Self, W, FUSED>,
            ) -> Lanes<Self, W, FUSED> {
                $root(row)
            }
            #[inline(always)]
            fn from_f64(value: f64) -> $T {
                value as $T
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn fused(self, factor: $T, summand: $T) -> $T {
                $T::mul_add(self, factor, summand)
            }
        }
    };
}
real!(f64, 8, false, root_by_products);
real!(f32, 16, true, root_by_divider);

/// The machine's square root.
#[inline(always)]
fn root_by_divider<T: Real, const W: usize, const FUSED: bool>(
    x: Lanes<T, W, FUSED>,
) -> Lanes<T, W, FUSED> {
    x.sqrt()
}

/// Half the exponent makes a first guess y of 1/√x: x y² is between 0.8504 and 0.9619 for all x.
const ROOT_GUESS: u64 = 0x5fe5_9b71_8c50_dd8e;
/// The polynomial of fourth degree that comes closest to c/√t there, within 1.4·10⁻⁸, with c = 2^(−1/3).
const ROOT_QUARTIC: [f64; 5] = [
    2.0539037422873667,
    -3.0269843671106877,
    3.0098049359910237,
    -1.582702103636881,
    0.3396796705325368,
];
/// 3 c²: with g = c √x and y = c/√x a step of Newton's for the inverse root, times x, is g (3 c² − g y).
/// The last digit is chosen so that errors of either sign are as large, 4.4·10⁻¹⁶.
const ROOT_STEP: f64 = 1.88988157484231;

/// A square root without the divider, which takes 18 cycles for eight numbers where these products take
/// six. Without a fused multiply-add it is not worth it.
#[inline(always)]
fn root_by_products<const W: usize, const FUSED: bool>(
    x: Lanes<f64, W, FUSED>,
) -> Lanes<f64, W, FUSED> {
    if !FUSED {
        return x.sqrt();
    }
    let of = Lanes::<f64, W, FUSED>::of;
    let guess = x.map(|x| f64::from_bits(ROOT_GUESS.wrapping_sub(x.to_bits() >> 1)));
    let [a, b, c, d, e] = ROOT_QUARTIC.map(of);
    let product = x * guess;
    let t = product * guess;
    let refined = t.mul_add(e, d).mul_add(t, c).mul_add(t, b).mul_add(t, a);
    let (root, inverse) = (product * refined, guess * refined);
    root * (-root).mul_add(inverse, of(ROOT_STEP))
}

/// A row of `W` scalars. With `FUSED`, [`Lane::mul_add`] rounds once; a loop over such lanes belongs
/// into code compiled for a machine that has the instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<T, const W: usize, const FUSED: bool>([T; W]);

/// The element-wise comparison of two [`Lanes`].
#[derive(Clone, Copy, Debug)]
pub struct LaneMask<const W: usize>([bool; W]);

impl<const W: usize> Mask for LaneMask<W> {
    #[inline(always)]
    fn all_of(value: bool) -> Self {
        Self([value; W])
    }
    #[inline(always)]
    fn count(self) -> usize {
        self.0.iter().map(|&set| set as usize).sum()
    }
    #[inline(always)]
    fn test(self, k: usize) -> bool {
        self.0[k]
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().fold(false, |any, &set| any | set)
    }
}

macro_rules! mask_operator {
    ($Op:ident, $op:ident, $symbol:tt) => {
        impl<const W: usize> $Op for LaneMask<W> {
            type Output = Self;
            #[inline(always)]
            fn $op(mut self, other: Self) -> Self {
                for k in 0..W {
                    self.0[k] = self.0[k] $symbol other.0[k];
                }
                self
            }
        }
    };
}
mask_operator!(BitAnd, bitand, &);
mask_operator!(BitOr, bitor, |);
impl<const W: usize> Not for LaneMask<W> {
    type Output = Self;
    #[inline(always)]
    fn not(mut self) -> Self {
        for set in &mut self.0 {
            *set = !*set;
        }
        self
    }
}

macro_rules! operator {
    ($Op:ident, $op:ident, $Assign:ident, $assign:ident, $symbol:tt) => {
        impl<T: Real, const W: usize, const FUSED: bool> $Op for Lanes<T, W, FUSED> {
            type Output = Self;
            #[inline(always)]
            fn $op(mut self, other: Self) -> Self {
                for k in 0..W {
                    self.0[k] = self.0[k] $symbol other.0[k];
                }
                self
            }
        }
        impl<T: Real, const W: usize, const FUSED: bool> $Assign for Lanes<T, W, FUSED> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = *self $symbol other;
            }
        }
    };
}
operator!(Add, add, AddAssign, add_assign, +);
operator!(Sub, sub, SubAssign, sub_assign, -);
operator!(Mul, mul, MulAssign, mul_assign, *);
operator!(Div, div, DivAssign, div_assign, /);

impl<T: Real, const W: usize, const FUSED: bool> Neg for Lanes<T, W, FUSED> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for x in &mut self.0 {
            *x = -*x;
        }
        self
    }
}

impl<T: Real, const W: usize, const FUSED: bool> Zero for Lanes<T, W, FUSED> {
    #[inline(always)]
    fn zero() -> Self {
        Self([T::zero(); W])
    }
    fn is_zero(&self) -> bool {
        self.0.iter().all(Zero::is_zero)
    }
}

impl<T: Real, const W: usize, const FUSED: bool> One for Lanes<T, W, FUSED> {
    #[inline(always)]
    fn one() -> Self {
        Self([T::one(); W])
    }
}

impl<T, const W: usize, const FUSED: bool> Index<usize> for Lanes<T, W, FUSED> {
    type Output = T;
    #[inline(always)]
    fn index(&self, k: usize) -> &T {
        &self.0[k]
    }
}

impl<T: Real, const W: usize, const FUSED: bool> Lanes<T, W, FUSED> {
    #[inline(always)]
    fn zip(mut self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        for k in 0..W {
            self.0[k] = f(self.0[k], other.0[k]);
        }
        self
    }
    #[inline(always)]
    fn compare(self, other: Self, f: impl Fn(T, T) -> bool) -> LaneMask<W> {
        let mut mask = [false; W];
        for k in 0..W {
            mask[k] = f(self.0[k], other.0[k]);
        }
        LaneMask(mask)
    }
}

impl<T: Real, const W: usize, const FUSED: bool> Lane for Lanes<T, W, FUSED> {
    type Scalar = T;
    type Mask = LaneMask<W>;
    const WIDTH: usize = W;
    #[inline(always)]
    fn splat(value: T) -> Self {
        Self([value; W])
    }
    #[inline(always)]
    fn from_fn(mut f: impl FnMut(usize) -> T) -> Self {
        let mut row = [T::default(); W];
        for (k, x) in row.iter_mut().enumerate() {
            *x = f(k);
        }
        Self(row)
    }
    #[inline(always)]
    fn extract(self, k: usize) -> T {
        self.0[k]
    }
    #[inline(always)]
    fn map(mut self, f: impl Fn(T) -> T) -> Self {
        for x in &mut self.0 {
            *x = f(*x);
        }
        self
    }
    #[inline(always)]
    fn mul_add(mut self, factor: Self, summand: Self) -> Self {
        for k in 0..W {
            self.0[k] = if FUSED {
                self.0[k].fused(factor.0[k], summand.0[k])
            } else {
                self.0[k] * factor.0[k] + summand.0[k]
            };
        }
        self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(Lane::sqrt)
    }
    #[inline(always)]
    fn root(self) -> Self {
        T::root_of_row(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(Lane::abs)
    }
    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        self.map(|x| Lane::powf(x, exponent))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        self.map(Lane::exp)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.map(Lane::ln)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, Lane::min)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, Lane::max)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> LaneMask<W> {
        self.compare(other, |a, b| a < b)
    }
    #[inline(always)]
    fn le(self, other: Self) -> LaneMask<W> {
        self.compare(other, |a, b| a <= b)
    }
    #[inline(always)]
    fn select(mask: LaneMask<W>, mut yes: Self, no: Self) -> Self {
        for k in 0..W {
            yes.0[k] = if mask.0[k] { yes.0[k] } else { no.0[k] };
        }
        yes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial<L: Lane>(x: L) -> L {
        let inside = x.lt(L::one());
        L::select(
            inside,
            x.powi(3).mul_add(L::of(0.5), L::one()),
            x.sqrt().abs().max(L::of(1.25)),
        )
    }

    #[test]
    fn lanes_equal_scalars() {
        let row = Lanes::<f64, 8, false>::from_fn(|k| 0.3 * k as f64);
        let result = polynomial(row);
        for k in 0..8 {
            assert_eq!(result.extract(k), polynomial(0.3 * k as f64));
        }
    }

    #[test]
    fn roots_of_rows_are_good_to_two_roundings() {
        let mut worst = 0.0_f64;
        for k in 0..40_000 {
            let x = Lanes::<f64, 8, true>::from_fn(|lane| {
                let mantissa =
                    1.0 + (0.618_033_988_749_894_9 * f64::from(8 * k + lane as i32)).fract();
                mantissa * 2.0_f64.powi(k % 2045 - 1022)
            });
            let root = x.root();
            for lane in 0..8 {
                let (x, found) = (x.extract(lane), root.extract(lane));
                let rounded = x.sqrt();
                // What rounding took from the machine's root.
                let lost = (-rounded).fused(rounded, x) / (2.0 * rounded);
                worst = worst.max((((found - rounded) - lost) / rounded).abs());
            }
        }
        assert!(worst < 2.0 * f64::EPSILON, "{worst:e}");
    }

    #[test]
    fn a_root_of_zero_is_zero_and_of_next_to_nothing_is_finite() {
        for x in [0.0, 5e-324, 1e-310, f64::MIN_POSITIVE] {
            let root = Lanes::<f64, 8, true>::splat(x).root().extract(3);
            assert!(
                (0.0..=x.sqrt() * 1.000_001).contains(&root),
                "{x:e}: {root:e}"
            );
        }
        assert_eq!(
            Lanes::<f32, 16, true>::splat(2.0).root().extract(5),
            2.0_f32.sqrt()
        );
    }

    #[test]
    fn masks_combine_and_count() {
        let row = Lanes::<f32, 16, true>::from_fn(|k| k as f32);
        let mask = row.ge(Lanes::of(4.0)) & !row.gt(Lanes::of(9.0));
        assert_eq!(mask.count(), 6);
        assert!(mask.test(4) && !mask.test(10) && mask.any());
    }
}
