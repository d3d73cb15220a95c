//! Rows of scalars, and of the outcomes of comparing them.
//! Arithmetic acts element by element, in loops of fixed length that become vector instructions.

use super::{Lane, Mask, Real, power};
use core::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Index, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};
use num_traits::{One, Zero};

/// A row of `W` scalars. With `FUSED`, [`Lane::mul_add`] rounds once; a loop over such lanes belongs
/// into code compiled for a machine that has the instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<T, const W: usize, const FUSED: bool>([T; W]);

/// The element-wise comparison of two [`Lanes`].
#[derive(Clone, Copy, Debug)]
pub struct LaneMask<const W: usize>([bool; W]);

impl<const W: usize> Mask for LaneMask<W> {
    const WIDTH: usize = W;
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
    type Broadcast = T;
    type Mask = LaneMask<W>;
    const WIDTH: usize = W;
    const FUSED: bool = FUSED;
    #[inline(always)]
    fn splat(value: T) -> Self {
        Self([value; W])
    }
    #[inline(always)]
    fn broadcast(value: T) -> Self {
        Self::splat(value)
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
    fn load(from: &[T]) -> Self {
        let mut row = [T::default(); W];
        row.copy_from_slice(&from[..W]);
        Self(row)
    }
    #[inline(always)]
    fn store(self, to: &mut [T]) {
        to[..W].copy_from_slice(&self.0);
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
    fn powf(mut self, exponent: f64) -> Self {
        power::of_row(&mut self.0, exponent);
        self
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(Lane::abs)
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
    fn masks_combine_and_count() {
        let row = Lanes::<f32, 16, true>::from_fn(|k| k as f32);
        let mask = row.ge(Lanes::of(4.0)) & !row.gt(Lanes::of(9.0));
        assert_eq!(mask.count(), 6);
        assert!(mask.test(4) && !mask.test(10) && mask.any());
    }
}
