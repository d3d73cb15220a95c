//! Rows of scalars as vector registers of x86-64: one instruction for what [`Lanes`](super::Lanes) write as a loop.
//! To the same bits; the compiler has a fraction of the work, and vectors need not be discovered. The baseline keeps arrays.

use super::root::{self, root_by_products};
use super::{Instructions, Lane, Mask, Twice};
// Some hundred names of instructions.
#[allow(clippy::wildcard_imports)]
use core::arch::x86_64::*;
use core::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};
use num_traits::{One, Zero};

/// AVX-512 F, VL and DQ: a row is a register.
#[derive(Clone, Copy, Debug)]
pub struct OnAvx512;
/// AVX2 and FMA: a row is two registers.
#[derive(Clone, Copy, Debug)]
pub struct OnAvx2;

impl Instructions for OnAvx512 {
    type Double = Double8;
    type Single = Single16;
}
impl Instructions for OnAvx2 {
    type Double = Twice<Double4>;
    type Single = Twice<Single8>;
}

macro_rules! operators {
    ($Row:ident: $($Op:ident $op:ident $Assign:ident $assign:ident $instruction:ident),*) => { $(
        impl $Op for $Row {
            type Output = Self;
            #[inline(always)]
            fn $op(self, other: Self) -> Self {
                // SAFETY: only loops for machines with the instruction have such rows (`Instructions`).
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
        impl $Assign for $Row {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = $Op::$op(*self, other);
            }
        }
    )* };
}

/// A register as a row, with the instructions of its arithmetic.
macro_rules! register {
    (
        $Row:ident($V:ident) of $T:ident $width:literal, masks $M:ident($lt:expr, $le:expr),
        select($mask:ident, $yes:ident, $no:ident) $select:expr, root($x:ident) $root:expr,
        $add:ident, $sub:ident, $mul:ident, $div:ident, $mul_add:ident, $sqrt:ident, $min:ident, $max:ident,
        $xor:ident, $andnot:ident, $set:ident, $load:ident, $store:ident
    ) => {
        /// A row in one register.
        #[derive(Clone, Copy, Debug)]
        #[repr(transparent)]
        pub struct $Row($V);

        impl $Row {
            #[inline(always)]
            fn elements(self) -> [$T; $width] {
                // SAFETY: the register holds so many elements, of which all bits are valid.
                unsafe { core::mem::transmute(self.0) }
            }
        }
        impl From<[$T; $width]> for $Row {
            #[inline(always)]
            fn from(row: [$T; $width]) -> Self {
                // SAFETY: as above.
                Self(unsafe { core::mem::transmute::<[$T; $width], $V>(row) })
            }
        }
        operators!($Row: Add add AddAssign add_assign $add, Sub sub SubAssign sub_assign $sub,
            Mul mul MulAssign mul_assign $mul, Div div DivAssign div_assign $div);
        impl Neg for $Row {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: see `Instructions`.
                Self(unsafe { $xor(self.0, $set(-0.0)) })
            }
        }
        impl Zero for $Row {
            #[inline(always)]
            fn zero() -> Self {
                Self::from([0.0; $width])
            }
            fn is_zero(&self) -> bool {
                self.elements().iter().all(Zero::is_zero)
            }
        }
        impl One for $Row {
            #[inline(always)]
            fn one() -> Self {
                Self::from([1.0; $width])
            }
        }
        // SAFETY of all below: see `Instructions`.
        impl Lane for $Row {
            type Scalar = $T;
            type Broadcast = $T;
            type Mask = $M;
            const WIDTH: usize = $width;
            const FUSED: bool = true;
            #[inline(always)]
            fn splat(value: $T) -> Self {
                Self(unsafe { $set(value) })
            }
            #[inline(always)]
            fn broadcast(value: $T) -> Self {
                Self::splat(value)
            }
            #[inline(always)]
            fn from_fn(mut f: impl FnMut(usize) -> $T) -> Self {
                let mut row = [0.0; $width];
                for k in 0..$width {
                    row[k] = f(k);
                }
                Self::from(row)
            }
            #[inline(always)]
            fn extract(self, k: usize) -> $T {
                self.elements()[k]
            }
            #[inline(always)]
            fn load(from: &[$T]) -> Self {
                let row: &[$T; $width] = from.first_chunk().expect("a row");
                Self(unsafe { $load(row.as_ptr()) })
            }
            #[inline(always)]
            fn store(self, to: &mut [$T]) {
                let row: &mut [$T; $width] = to.first_chunk_mut().expect("a row");
                unsafe { $store(row.as_mut_ptr(), self.0) }
            }
            #[inline(always)]
            fn map(self, f: impl Fn($T) -> $T) -> Self {
                let mut row = self.elements();
                for k in 0..$width {
                    row[k] = f(row[k]);
                }
                Self::from(row)
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, summand: Self) -> Self {
                Self(unsafe { $mul_add(self.0, factor.0, summand.0) })
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(unsafe { $sqrt(self.0) })
            }
            #[inline(always)]
            fn root(self) -> Self {
                let $x = self;
                $root
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Self(unsafe { $andnot($set(-0.0), self.0) })
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                Self(unsafe { $min(self.0, other.0) })
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                Self(unsafe { $max(self.0, other.0) })
            }
            #[inline(always)]
            fn lt(self, other: Self) -> $M {
                $M(unsafe { $lt(self.0, other.0) })
            }
            #[inline(always)]
            fn le(self, other: Self) -> $M {
                $M(unsafe { $le(self.0, other.0) })
            }
            #[inline(always)]
            fn select(mask: $M, yes: Self, no: Self) -> Self {
                let ($mask, $yes, $no) = (mask.0, yes.0, no.0);
                Self(unsafe { $select })
            }
        }
    };
}
register! {
    Double8(__m512d) of f64 8,
    masks Bits8(_mm512_cmp_pd_mask::<_CMP_LT_OQ>, _mm512_cmp_pd_mask::<_CMP_LE_OQ>),
    select(mask, yes, no) _mm512_mask_blend_pd(mask, no, yes), root(x) {
        let half = unsafe { _mm512_srli_epi64::<1>(_mm512_castpd_si512(x.0)) };
        let guess = unsafe { _mm512_sub_epi64(_mm512_set1_epi64(root::GUESS as i64), half) };
        root_by_products(x, Self(unsafe { _mm512_castsi512_pd(guess) }))
    },
    _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd, _mm512_fmadd_pd, _mm512_sqrt_pd, _mm512_min_pd,
    _mm512_max_pd, _mm512_xor_pd, _mm512_andnot_pd, _mm512_set1_pd, _mm512_loadu_pd, _mm512_storeu_pd
}
register! {
    Single16(__m512) of f32 16,
    masks Bits16(_mm512_cmp_ps_mask::<_CMP_LT_OQ>, _mm512_cmp_ps_mask::<_CMP_LE_OQ>),
    select(mask, yes, no) _mm512_mask_blend_ps(mask, no, yes), root(x) x.sqrt(),
    _mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps, _mm512_div_ps, _mm512_fmadd_ps, _mm512_sqrt_ps, _mm512_min_ps,
    _mm512_max_ps, _mm512_xor_ps, _mm512_andnot_ps, _mm512_set1_ps, _mm512_loadu_ps, _mm512_storeu_ps
}
register! {
    Double4(__m256d) of f64 4,
    masks Signs4(_mm256_cmp_pd::<_CMP_LT_OQ>, _mm256_cmp_pd::<_CMP_LE_OQ>),
    select(mask, yes, no) _mm256_blendv_pd(no, yes, mask), root(x) {
        let half = unsafe { _mm256_srli_epi64::<1>(_mm256_castpd_si256(x.0)) };
        let guess = unsafe { _mm256_sub_epi64(_mm256_set1_epi64x(root::GUESS as i64), half) };
        root_by_products(x, Self(unsafe { _mm256_castsi256_pd(guess) }))
    },
    _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd, _mm256_fmadd_pd, _mm256_sqrt_pd, _mm256_min_pd,
    _mm256_max_pd, _mm256_xor_pd, _mm256_andnot_pd, _mm256_set1_pd, _mm256_loadu_pd, _mm256_storeu_pd
}
register! {
    Single8(__m256) of f32 8,
    masks Signs8(_mm256_cmp_ps::<_CMP_LT_OQ>, _mm256_cmp_ps::<_CMP_LE_OQ>),
    select(mask, yes, no) _mm256_blendv_ps(no, yes, mask), root(x) x.sqrt(),
    _mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps, _mm256_div_ps, _mm256_fmadd_ps, _mm256_sqrt_ps, _mm256_min_ps,
    _mm256_max_ps, _mm256_xor_ps, _mm256_andnot_ps, _mm256_set1_ps, _mm256_loadu_ps, _mm256_storeu_ps
}

// SAFETY of all below: see `Instructions`.
/// What a comparison gives, by the instructions that combine such outcomes.
macro_rules! mask {
    ($M:ident($V:ty) $width:literal, $and:expr, $or:expr, not($m:ident) $not:expr, bits($n:ident) $bits:expr
    $(, choose($compress:ident, $load:ident, $store:ident))?) => {
        /// The element-wise comparison of two rows.
        #[derive(Clone, Copy, Debug)]
        #[repr(transparent)]
        pub struct $M($V);

        impl BitAnd for $M {
            type Output = Self;
            #[inline(always)]
            fn bitand(self, other: Self) -> Self {
                Self(unsafe { $and(self.0, other.0) })
            }
        }
        impl BitOr for $M {
            type Output = Self;
            #[inline(always)]
            fn bitor(self, other: Self) -> Self {
                Self(unsafe { $or(self.0, other.0) })
            }
        }
        impl Not for $M {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                let $m = self.0;
                Self(unsafe { $not })
            }
        }
        impl Mask for $M {
            const WIDTH: usize = $width;
            #[inline(always)]
            fn all_of(value: bool) -> Self {
                let none = Self(unsafe { core::mem::zeroed() });
                if value { !none } else { none }
            }
            #[inline(always)]
            fn count(self) -> usize {
                let $n = self.0;
                ($bits as u32).count_ones() as usize
            }
            #[inline(always)]
            fn test(self, k: usize) -> bool {
                let $n = self.0;
                ($bits as u32) >> k & 1 == 1
            }
            #[inline(always)]
            fn any(self) -> bool {
                let $n = self.0;
                ($bits as u32) != 0
            }
            $(
                #[inline(always)]
                fn choose(self, from: &[u32], to: &mut [u32]) -> usize {
                    let from: &[u32; $width] = from.first_chunk().expect("a row");
                    let to: &mut [u32; $width] = to.first_chunk_mut().expect("room for a row");
                    unsafe {
                        let chosen = $compress(self.0, $load(from.as_ptr().cast()));
                        $store(to.as_mut_ptr().cast(), chosen);
                    }
                    self.count()
                }
            )?
        }
    };
}
mask!(Bits8(__mmask8) 8, _kand_mask8, _kor_mask8, not(m) _knot_mask8(m), bits(m) m,
    choose(_mm256_maskz_compress_epi32, _mm256_loadu_si256, _mm256_storeu_si256));
mask!(Bits16(__mmask16) 16, _kand_mask16, _kor_mask16, not(m) _knot_mask16(m), bits(m) m,
    choose(_mm512_maskz_compress_epi32, _mm512_loadu_si512, _mm512_storeu_si512));
mask!(Signs4(__m256d) 4, _mm256_and_pd, _mm256_or_pd,
    not(m) _mm256_xor_pd(m, _mm256_castsi256_pd(_mm256_set1_epi64x(-1))), bits(m) (unsafe { _mm256_movemask_pd(m) }));
mask!(Signs8(__m256) 8, _mm256_and_ps, _mm256_or_ps,
    not(m) _mm256_xor_ps(m, _mm256_castsi256_ps(_mm256_set1_epi64x(-1))), bits(m) (unsafe { _mm256_movemask_ps(m) }));

#[cfg(test)]
mod tests {
    use super::super::{InstructionSet, Lane, Mask, OnRows, Real};

    /// Each operation on rows of awkward numbers beside the same on scalars.
    struct BesideScalars;

    impl<T: Real> OnRows<T> for BesideScalars {
        type Output = ();
        fn run<L: Lane<Scalar = T, Broadcast = T>>(self) {
            let numbers = [
                0.0,
                -0.0,
                1.0,
                -1.5,
                3e-310,
                -1e-30,
                1e30,
                7.25,
                f64::INFINITY,
                -2.0,
                1e-3,
                0.7,
                42.0,
                -1e10,
                0.3,
                9.0,
                -0.1,
            ]
            .map(T::from_f64);
            let row = |shift: usize| L::from_fn(|k| numbers[(k + shift) % numbers.len()]);
            let same = |found: L, expected: &dyn Fn(usize) -> T, name: &str| {
                for k in 0..L::WIDTH {
                    let (a, b) = (found.extract(k).to_f64(), expected(k).to_f64());
                    assert!(
                        a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()),
                        "{name} in lane {k}: {a:e}, {b:e}"
                    );
                }
            };
            for shift in 0..numbers.len() {
                let (a, b, c) = (row(0), row(shift), row(2 * shift + 1));
                let of = |k: usize| (a.extract(k), b.extract(k), c.extract(k));
                same(a + b, &|k| of(k).0 + of(k).1, "sum");
                same(a - b, &|k| of(k).0 - of(k).1, "difference");
                same(a * b, &|k| of(k).0 * of(k).1, "product");
                same(a / b, &|k| of(k).0 / of(k).1, "quotient");
                same(-b, &|k| -of(k).1, "negative");
                same(a.min(b), &|k| Lane::min(of(k).0, of(k).1), "smaller");
                same(a.max(b), &|k| Lane::max(of(k).0, of(k).1), "larger");
                same(b.abs(), &|k| Lane::abs(of(k).1), "absolute value");
                same(b.abs().sqrt(), &|k| Lane::sqrt(Lane::abs(of(k).1)), "root");
                same(b.map(|x| x + x), &|k| of(k).1 + of(k).1, "twice");
                let fused = |k: usize| {
                    let (a, b, c) = of(k);
                    if L::FUSED { a.fused(b, c) } else { a * b + c }
                };
                same(a.mul_add(b, c), &fused, "product and sum");
                let (less, most) = (a.lt(b), a.le(c));
                for (mask, holds) in [
                    (less, &(|k| of(k).0 < of(k).1) as &dyn Fn(usize) -> bool),
                    (most, &|k| of(k).0 <= of(k).2),
                    (!less, &|k| !of(k).0.lt(of(k).1)),
                    (less & most, &|k| of(k).0 < of(k).1 && of(k).0 <= of(k).2),
                    (less | most, &|k| of(k).0 < of(k).1 || of(k).0 <= of(k).2),
                    (Mask::all_of(true), &|_| true),
                    (Mask::all_of(false), &|_| false),
                ] {
                    let set = (0..L::WIDTH).filter(|&k| holds(k)).count();
                    assert_eq!((mask.count(), mask.any()), (set, set > 0));
                    assert!((0..L::WIDTH).all(|k| mask.test(k) == holds(k)));
                    let places: Vec<u32> = (7..7 + L::WIDTH as u32).collect();
                    let mut first = vec![0; L::WIDTH];
                    assert_eq!(mask.choose(&places, &mut first), set);
                    let expected = (0..L::WIDTH).filter(|&k| holds(k)).map(|k| places[k]);
                    assert!(expected.eq(first[..set].iter().copied()));
                    let chosen = |k: usize| if holds(k) { of(k).1 } else { of(k).2 };
                    same(L::select(mask, b, c), &chosen, "choice");
                }
                let mut stored = vec![T::zero(); L::WIDTH];
                b.store(&mut stored);
                same(L::load(&stored), &|k| of(k).1, "loaded");
            }
        }
    }

    #[test]
    fn registers_do_what_scalars_do() {
        for set in [
            InstructionSet::Baseline,
            InstructionSet::Avx2,
            InstructionSet::Avx512,
        ] {
            if set.available() {
                set.run::<f64, _>(BesideScalars);
                set.run::<f32, _>(BesideScalars);
            }
        }
    }

    /// Roots by products, of rows.
    struct Roots([f64; 8]);

    impl OnRows<f64> for Roots {
        type Output = [u64; 8];
        fn run<L: Lane<Scalar = f64, Broadcast = f64>>(self) -> [u64; 8] {
            let mut roots = [0.0; 8];
            L::load(&self.0).root().store(&mut roots);
            roots.map(f64::to_bits)
        }
    }

    #[test]
    fn roots_by_products_are_the_same_on_all_that_have_them() {
        let numbers = [0.0, 1e-310, 2.0, 0.1, 1e300, 3.5e-9, 4.0, 123.456];
        let expected = super::super::Lanes::<f64, 8, true>::load(&numbers).root();
        for set in [InstructionSet::Avx2, InstructionSet::Avx512] {
            if set.available() {
                let bits = set.run(Roots(numbers));
                for k in 0..8 {
                    assert_eq!(bits[k], expected.extract(k).to_bits(), "{set:?}, lane {k}");
                }
            }
        }
    }
}
