//! Scalars and lanes: the only place that knows machine types.
//! One text of physics serves `f32` and `f64`, one particle at a time or a block of them.

mod elementary;
mod function;
mod halves;
mod instructions;
mod lanes;
mod power;
mod real;
#[cfg(target_arch = "x86_64")]
mod registers;
mod root;
mod traced;
#[cfg(target_arch = "x86_64")]
mod twice;

pub(crate) use function::{Function, OfLanes, call};
pub use instructions::InstructionSet;
use instructions::Instructions;
#[doc(hidden)]
pub use instructions::OnRows;
pub(crate) use instructions::{OnOwnRows, on_wide_registers};
pub use lanes::{LaneMask, Lanes};
pub use real::Real;
pub(crate) use real::width;
#[cfg(target_arch = "x86_64")]
pub(crate) use registers::{OnAvx2, OnAvx512};
pub use root::Root;
pub use traced::{Binary, Operation, Record, Traced, TracedMask, Unary, Unrecordable};

/// [`Lane::iterate`] as a loop in the text around it: a closure that is compiled by itself has the registers of the baseline.
macro_rules! iterate {
    ($L:ty, $most:expr, $first:expr, |$given:pat_param| $step:expr) => {{
        let mut state = $first;
        let mut open = <<$L as $crate::scalar::Lane>::Mask as $crate::scalar::Mask>::all_of(true);
        for _ in 0..$most {
            if !<$L as $crate::scalar::Lane>::somewhere(open) {
                break;
            }
            let $given = state;
            let (next, done) = $step;
            for (own, next) in state.iter_mut().zip(next) {
                *own = <$L as $crate::scalar::Lane>::select(open, next, *own);
            }
            open = open & !done;
        }
        state
    }};
}
pub(crate) use iterate;

use core::fmt::Debug;
use core::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};
use num_traits::{One, Zero};
#[cfg(target_arch = "x86_64")]
use twice::Twice;

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
    /// The number of elements.
    const WIDTH: usize;
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
    /// Puts those of a row's numbers at which it is true first in `to`, in their order, and returns how many they are.
    /// `to` has room for a row; what stands behind them is of no use.
    #[inline(always)]
    fn choose(self, from: &[u32], to: &mut [u32]) -> usize {
        let mut count = 0;
        for k in 0..Self::WIDTH {
            to[count] = from[k];
            count += usize::from(self.test(k));
        }
        count
    }
}

impl Mask for bool {
    const WIDTH: usize = 1;
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

/// Most elements of a row of either scalar.
pub(crate) const MOST_LANES: usize = 16;

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
    /// One number for all elements, as the neighbour of a row of particles has it: the scalar, or where the
    /// lane is [`Traced`], what is recorded.
    type Broadcast: Copy + Debug + Send + Sync + 'static;
    /// The type of an element-wise comparison.
    type Mask: Mask;
    /// The number of elements.
    const WIDTH: usize;
    /// Whether [`mul_add`](Self::mul_add) rounds once.
    const FUSED: bool = false;

    /// The same value in every element.
    fn splat(value: Self::Scalar) -> Self;
    /// The same number in every element.
    fn broadcast(value: Self::Broadcast) -> Self;
    /// Element `k` is `f(k)`.
    fn from_fn(f: impl FnMut(usize) -> Self::Scalar) -> Self;
    /// Element `k`.
    fn extract(self, k: usize) -> Self::Scalar;
    /// The elements that stand at the start of a slice, which has as many.
    #[inline(always)]
    #[must_use]
    fn load(from: &[Self::Scalar]) -> Self {
        Self::from_fn(|k| from[k])
    }
    /// Puts the elements to the start of a slice, which has room for them.
    #[inline(always)]
    fn store(self, to: &mut [Self::Scalar]) {
        for (k, x) in to[..Self::WIDTH].iter_mut().enumerate() {
            *x = self.extract(k);
        }
    }
    /// `f` applied to every element.
    fn map(self, f: impl Fn(Self::Scalar) -> Self::Scalar) -> Self;
    /// `self * factor + summand`, with one rounding on a fused lane and two elsewhere.
    fn mul_add(self, factor: Self, summand: Self) -> Self;
    /// `self * factor + summand` with one rounding on every lane; slow where the machine lacks the instruction.
    #[inline(always)]
    fn fused(self, factor: Self, summand: Self) -> Self {
        Self::from_fn(|k| self.extract(k).fused(factor.extract(k), summand.extract(k)))
    }
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
    /// `self` to a real power, within an ulp, by sums and products that are the same on every machine, as all
    /// elementary functions here.
    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        self.map(|x| Lane::powf(x, exponent))
    }
    /// The exponential function, within an ulp.
    #[inline(always)]
    fn exp(self) -> Self {
        self.map(Lane::exp)
    }
    /// The natural logarithm, within an ulp.
    #[inline(always)]
    fn ln(self) -> Self {
        self.map(Lane::ln)
    }
    /// The cube root, within an ulp.
    #[inline(always)]
    fn cbrt(self) -> Self {
        self.map(Lane::cbrt)
    }
    /// The sine, within two ulps up to |x| = 8·10⁵, and within the rounding of x beyond.
    #[inline(always)]
    fn sin(self) -> Self {
        self.map(Lane::sin)
    }
    /// The cosine, as the [sine](Self::sin).
    #[inline(always)]
    fn cos(self) -> Self {
        self.map(Lane::cos)
    }
    /// The angle between 0 and π with a cosine, within three ulps.
    #[inline(always)]
    fn acos(self) -> Self {
        self.map(Lane::acos)
    }
    /// The angle between −π/2 and π/2 with a tangent, within two ulps.
    #[inline(always)]
    fn atan(self) -> Self {
        self.map(Lane::atan)
    }
    /// The larger of the value and zero.
    #[inline(always)]
    fn positive_part(self) -> Self {
        self.max(Self::zero())
    }
    /// Whether a mask holds anywhere, so that what it chooses is worth computing. In a [`Record`] all is computed.
    #[inline(always)]
    fn somewhere(mask: Self::Mask) -> bool {
        mask.any()
    }
    /// Repeats `step`, which returns the next state and where it is the last, at most `most` times. Each element has the state that it
    /// would have alone: one that is done stays as it is while others go on. A [`Record`] holds all `most` steps.
    ///
    /// ```
    /// use meshfree::scalar::{Lane, Lanes};
    /// /// √a by Newton's method.
    /// fn root<L: Lane>(a: L) -> L {
    ///     let [x] = L::iterate(60, [a], |[x]| {
    ///         let next = (x + a / x) * L::of(0.5);
    ///         ([next], (next - x).abs().le(next * L::of(1e-15)))
    ///     });
    ///     x
    /// }
    /// let both = root(Lanes::<f64, 2, false>::from_fn(|k| [2.0, 1e6][k]));
    /// assert_eq!([both.extract(0), both.extract(1)], [root(2.0), root(1e6)]);
    /// ```
    #[inline(always)]
    #[must_use]
    fn iterate<const N: usize>(
        most: usize,
        mut state: [Self; N],
        step: impl Fn([Self; N]) -> ([Self; N], Self::Mask),
    ) -> [Self; N] {
        state = iterate!(Self, most, state, |given| step(given));
        state
    }
}
