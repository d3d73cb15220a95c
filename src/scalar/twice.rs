//! Two rows side by side as one that is twice as wide.
//! For instructions whose registers hold half of a block of particles.

use super::{Lane, Mask};
use core::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};
use num_traits::{One, Zero};

/// The first half of a row and the second; of masks too.
#[derive(Clone, Copy, Debug)]
pub struct Twice<L>(L, L);

macro_rules! operators {
    ($Bound:ident: $($Op:ident $op:ident),*) => { $(
        impl<L: $Bound> $Op for Twice<L> {
            type Output = Self;
            #[inline(always)]
            fn $op(self, other: Self) -> Self {
                Self($Op::$op(self.0, other.0), $Op::$op(self.1, other.1))
            }
        }
    )* };
}
operators!(Lane: Add add, Sub sub, Mul mul, Div div);
operators!(Mask: BitAnd bitand, BitOr bitor);

macro_rules! assigning {
    ($($Assign:ident $assign:ident),*) => { $(
        impl<L: Lane> $Assign for Twice<L> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                $Assign::$assign(&mut self.0, other.0);
                $Assign::$assign(&mut self.1, other.1);
            }
        }
    )* };
}
assigning!(AddAssign add_assign, SubAssign sub_assign, MulAssign mul_assign, DivAssign div_assign);

impl<L: Neg<Output = L>> Neg for Twice<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}
impl<M: Mask> Not for Twice<M> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0, !self.1)
    }
}
impl<L: Lane> Zero for Twice<L> {
    #[inline(always)]
    fn zero() -> Self {
        Self(L::zero(), L::zero())
    }
    fn is_zero(&self) -> bool {
        self.0.is_zero() && self.1.is_zero()
    }
}
impl<L: Lane> One for Twice<L> {
    #[inline(always)]
    fn one() -> Self {
        Self(L::one(), L::one())
    }
}

impl<M: Mask> Mask for Twice<M> {
    const WIDTH: usize = 2 * M::WIDTH;
    #[inline(always)]
    fn all_of(value: bool) -> Self {
        Self(M::all_of(value), M::all_of(value))
    }
    #[inline(always)]
    fn count(self) -> usize {
        self.0.count() + self.1.count()
    }
    #[inline(always)]
    fn test(self, k: usize) -> bool {
        if k < M::WIDTH {
            self.0.test(k)
        } else {
            self.1.test(k - M::WIDTH)
        }
    }
    #[inline(always)]
    fn any(self) -> bool {
        (self.0 | self.1).any()
    }
}

impl<L: Lane<Broadcast = <L as Lane>::Scalar>> Lane for Twice<L> {
    type Scalar = L::Scalar;
    type Broadcast = L::Scalar;
    type Mask = Twice<L::Mask>;
    const WIDTH: usize = 2 * L::WIDTH;
    const FUSED: bool = L::FUSED;
    #[inline(always)]
    fn splat(value: L::Scalar) -> Self {
        Self(L::splat(value), L::splat(value))
    }
    #[inline(always)]
    fn broadcast(value: L::Scalar) -> Self {
        Self::splat(value)
    }
    #[inline(always)]
    fn from_fn(mut f: impl FnMut(usize) -> L::Scalar) -> Self {
        let first = L::from_fn(&mut f);
        Self(first, L::from_fn(|k| f(k + L::WIDTH)))
    }
    #[inline(always)]
    fn extract(self, k: usize) -> L::Scalar {
        if k < L::WIDTH {
            self.0.extract(k)
        } else {
            self.1.extract(k - L::WIDTH)
        }
    }
    #[inline(always)]
    fn load(from: &[L::Scalar]) -> Self {
        Self(L::load(from), L::load(&from[L::WIDTH..]))
    }
    #[inline(always)]
    fn store(self, to: &mut [L::Scalar]) {
        self.0.store(to);
        self.1.store(&mut to[L::WIDTH..]);
    }
    #[inline(always)]
    fn map(self, f: impl Fn(L::Scalar) -> L::Scalar) -> Self {
        Self(self.0.map(&f), self.1.map(&f))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        Self(
            self.0.mul_add(factor.0, summand.0),
            self.1.mul_add(factor.1, summand.1),
        )
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn root(self) -> Self {
        Self(self.0.root(), self.1.root())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0), self.1.min(other.1))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1.max(other.1))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        Twice(self.0.lt(other.0), self.1.lt(other.1))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Self::Mask {
        Twice(self.0.le(other.0), self.1.le(other.1))
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Self(
            L::select(mask.0, yes.0, no.0),
            L::select(mask.1, yes.1, no.1),
        )
    }
}
