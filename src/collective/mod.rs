//! Every reduction over particles: sums, smallest and largest values, counts, and whether all of them are so.
//! No result depends on how particles are shared out: sums have a fixed shape within a chunk and are exact over chunks.

mod exact;

use crate::parallel::{GRAIN, Pieces, for_each, runs};
pub(crate) use exact::ExactSum;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// What is reduced: a number of type `f64` is summed, the others join as they say.
pub(crate) trait Part: Copy + Send {
    /// The parts of all chunks together.
    type Whole: Clone + Send;
    /// That of no particle.
    const NONE: Self;
    /// Joins two parts of a chunk, which are joined in the order of the particles.
    fn and(self, other: Self) -> Self;
    /// A whole without any part.
    fn begin() -> Self::Whole;
    /// Joins the part of a chunk to the whole, in any order.
    fn add_to(self, whole: &mut Self::Whole);
    /// Joins two wholes.
    fn join(whole: &mut Self::Whole, other: &Self::Whole);
    /// What the whole is.
    fn of(whole: &Self::Whole) -> Self;
}

/// What joins without rounding, in any order and grouping.
pub(crate) trait Join: Copy + Send {
    /// That of no particle.
    const NONE: Self;
    /// Both.
    fn and(self, other: Self) -> Self;
}

impl<J: Join> Part for J {
    type Whole = Self;
    const NONE: Self = J::NONE;
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Join::and(self, other)
    }
    fn begin() -> Self {
        J::NONE
    }
    fn add_to(self, whole: &mut Self) {
        *whole = Join::and(*whole, self);
    }
    fn join(whole: &mut Self, other: &Self) {
        other.add_to(whole);
    }
    fn of(whole: &Self) -> Self {
        *whole
    }
}

impl Part for f64 {
    type Whole = ExactSum;
    const NONE: Self = 0.0;
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self + other
    }
    fn begin() -> ExactSum {
        ExactSum::ZERO
    }
    fn add_to(self, whole: &mut ExactSum) {
        whole.add(self);
    }
    fn join(whole: &mut ExactSum, other: &ExactSum) {
        whole.join(other);
    }
    fn of(whole: &ExactSum) -> Self {
        whole.value()
    }
}

impl<P: Part, const N: usize> Part for [P; N] {
    type Whole = [P::Whole; N];
    const NONE: Self = [P::NONE; N];
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        core::array::from_fn(|k| self[k].and(other[k]))
    }
    fn begin() -> Self::Whole {
        core::array::from_fn(|_| P::begin())
    }
    fn add_to(self, whole: &mut Self::Whole) {
        for (part, whole) in self.into_iter().zip(whole) {
            part.add_to(whole);
        }
    }
    fn join(whole: &mut Self::Whole, other: &Self::Whole) {
        for (whole, other) in whole.iter_mut().zip(other) {
            P::join(whole, other);
        }
    }
    fn of(whole: &Self::Whole) -> Self {
        core::array::from_fn(|k| P::of(&whole[k]))
    }
}

macro_rules! tuples {
    ($($($part:ident $k:tt)*,)*) => {$(
        impl<$($part: Part),*> Part for ($($part,)*) {
            type Whole = ($($part::Whole,)*);
            const NONE: Self = ($($part::NONE,)*);
            #[inline(always)]
            fn and(self, other: Self) -> Self {
                ($(self.$k.and(other.$k),)*)
            }
            fn begin() -> Self::Whole {
                ($($part::begin(),)*)
            }
            fn add_to(self, whole: &mut Self::Whole) {
                $(self.$k.add_to(&mut whole.$k);)*
            }
            fn join(whole: &mut Self::Whole, other: &Self::Whole) {
                $($part::join(&mut whole.$k, &other.$k);)*
            }
            fn of(whole: &Self::Whole) -> Self {
                ($($part::of(&whole.$k),)*)
            }
        }
    )*};
}
tuples!(A 0 B 1, A 0 B 1 C 2, A 0 B 1 C 2 E 3,);

impl Join for u64 {
    const NONE: Self = 0;
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self + other
    }
}

/// Whether all are.
impl Join for bool {
    const NONE: Self = true;
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self && other
    }
}

/// The smaller value and, of equal ones, the lower number. NaN is not smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Least(pub f64, pub usize);

impl Join for Least {
    const NONE: Self = Self(f64::INFINITY, usize::MAX);
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        if other.0 < self.0 || (other.0 == self.0 && other.1 < self.1) {
            other
        } else {
            self
        }
    }
}

/// The lower number, with what goes with it.
impl<V: Copy + Send> Join for Option<(usize, V)> {
    const NONE: Self = None;
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Some(a), Some(b)) if a.0 <= b.0 => Some(a),
            (a, b) => b.or(a),
        }
    }
}

/// The least and the largest of each component of vectors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners<const D: usize>(pub [[f64; D]; 2]);

impl<const D: usize> Corners<D> {
    /// Those of one vector.
    pub fn at(x: [f64; D]) -> Self {
        Self([x; 2])
    }
    /// How far they are apart along each axis.
    pub fn extent(&self) -> [f64; D] {
        core::array::from_fn(|d| self.0[1][d] - self.0[0][d])
    }
}

impl<const D: usize> Join for Corners<D> {
    const NONE: Self = Self([[f64::INFINITY; D], [f64::NEG_INFINITY; D]]);
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        let ([low, high], [least, most]) = (self.0, other.0);
        Self([
            core::array::from_fn(|d| low[d].min(least[d])),
            core::array::from_fn(|d| high[d].max(most[d])),
        ])
    }
}

/// A reduction over particles.
#[derive(Clone, Debug)]
pub(crate) struct Collective<P: Part>(P::Whole);

impl<P: Part> Collective<P> {
    /// Of no particle.
    pub fn new() -> Self {
        Self(P::begin())
    }

    /// Adds the part of a chunk, or of a particle that is a chunk of its own.
    pub fn add(&mut self, part: P) {
        part.add_to(&mut self.0);
    }

    /// Adds the parts of pieces.
    pub fn add_pieces<Q: Pieces>(&mut self, pieces: Q, of: impl Fn(usize, Q::Piece) -> P + Sync) {
        let whole = Mutex::new(&mut self.0);
        for_each(pieces, |number, piece| {
            let part = of(number, piece);
            part.add_to(&mut whole.lock().unwrap_or_else(PoisonError::into_inner));
        });
    }

    /// Adds the particles of a range in chunks of [`GRAIN`].
    pub fn add_range(&mut self, range: Range<usize>, of: impl Fn(usize) -> P + Sync) {
        self.add_pieces(runs(range, GRAIN), |_, run| {
            run.fold(P::NONE, |all, n| all.and(of(n)))
        });
    }

    /// Adds another reduction.
    pub fn join(&mut self, other: &Self) {
        P::join(&mut self.0, &other.0);
    }

    /// What it consists of, as messages between ranks have it.
    pub fn parts(&self) -> &P::Whole {
        &self.0
    }

    /// That of such parts.
    pub fn of_parts(parts: P::Whole) -> Self {
        Self(parts)
    }

    /// The result.
    pub fn value(&self) -> P {
        P::of(&self.0)
    }
}

/// A reduction over a range of particles in chunks of [`GRAIN`].
pub(crate) fn over<P: Part>(range: Range<usize>, of: impl Fn(usize) -> P + Sync) -> P {
    let mut all = Collective::new();
    all.add_range(range, of);
    all.value()
}

/// A reduction over pieces.
pub(crate) fn over_pieces<P: Part, Q: Pieces>(
    pieces: Q,
    of: impl Fn(usize, Q::Piece) -> P + Sync,
) -> P {
    let mut all = Collective::new();
    all.add_pieces(pieces, of);
    all.value()
}

/// The largest value of a range of particles; zero, if none is larger.
pub(crate) fn largest(range: Range<usize>, of: impl Fn(usize) -> f64 + Sync) -> f64 {
    over(range, |n| Largest(of(n))).0
}

/// The larger value, by a comparison, which leaves NaN out as `f64::max` does, in a third of its time.
#[derive(Clone, Copy)]
struct Largest(f64);

impl Join for Largest {
    const NONE: Self = Self(0.0);
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        if other.0 > self.0 { other } else { self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of both signs whose plain sum depends on its order.
    fn number(n: usize) -> f64 {
        ((n as f64 * 0.618_033_988_7).fract() - 0.3) * 10_f64.powi((n % 5) as i32)
    }

    #[test]
    fn chunks_may_be_shared_out_in_any_way() {
        let count = 9 * GRAIN + 5;
        let whole = over(3..count, |n| (number(n), [1_u64, 2]));
        let chunks: Vec<_> = (3..count).step_by(GRAIN).collect();
        let add = |all: &mut Collective<_>, first: usize| {
            let run = first..count.min(first + GRAIN);
            all.add_range(run, |n| (number(n), [1_u64, 2]));
        };
        for ranks in [1, 2, 3, 7] {
            let mut own: Vec<_> = (0..ranks).map(|_| Collective::new()).collect();
            for (k, first) in chunks.iter().enumerate() {
                add(&mut own[k % ranks], *first);
            }
            for turn in 0..ranks {
                let mut all = Collective::new();
                own.rotate_left(turn);
                own.iter().rev().for_each(|part| all.join(part));
                assert_eq!(all.value(), whole);
            }
        }
        assert_eq!(whole.1, [(count - 3) as u64, 2 * (count - 3) as u64]);
        // A chunk is a plain sum, and plain sums of chunks depend on their order.
        let chunk = |first: &usize| (*first..count.min(first + GRAIN)).map(number).sum::<f64>();
        let shared = |ranks: usize| {
            let own = |k: usize| chunks.iter().skip(k).step_by(ranks).map(chunk).sum::<f64>();
            (0..ranks).map(own).sum::<f64>()
        };
        assert!(
            [2, 3, 7]
                .into_iter()
                .any(|ranks| shared(ranks) != shared(1))
        );
        let mut exact = Collective::new();
        for first in &chunks {
            exact.add(chunk(first));
        }
        assert_eq!(exact.value(), whole.0);
    }

    #[test]
    fn the_lower_number_wins_a_tie() {
        let value = |n: usize| ((n + 4000) % 5000) as f64;
        assert_eq!(over(0..9999, |n| Least(value(n), n)), Least(0.0, 1000));
        let none = Least(f64::INFINITY, usize::MAX);
        assert_eq!(over(0..0, |n| Least(0.0, n)), none);
        assert_eq!(over(7..9, |n| Least(f64::NAN, n)), none);
        let first = over(5..9999, |n| (n % 4000 > 3000).then_some((n, 0.5)));
        assert_eq!(first, Some((3001, 0.5)));
    }

    #[test]
    fn corners_flags_and_largest_values_are_of_all() {
        assert_eq!(largest(0..9999, |k| (k % 5000) as f64), 4999.0);
        assert_eq!(largest(0..0, |_| 1.0), 0.0);
        assert_eq!(largest(0..2, |k| [f64::NAN, 3.0][k]), 3.0);
        let corners = over(0..9999, |n| Corners::at([n as f64, -(n as f64)]));
        assert_eq!(corners.0, [[0.0, -9998.0], [9998.0, 0.0]]);
        assert_eq!(corners.extent(), [9998.0; 2]);
        assert!(over(0..9999, |n| n < 9999) && !over(0..9999, |n| n != 5000));
    }
}
