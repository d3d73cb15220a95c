//! A sum whose bits depend on neither the order of its terms nor their grouping: a fixed-point number that holds every `f64`.
//! The small superaccumulator of R. M. Neal, arXiv 1505.05571 (2015), after U. Kulisch & W. L. Miranker (1981).

use crate::ranks::{Taken, put_number};

/// Digits from the smallest subnormal number up to 2^1102.
const DIGITS: usize = 68;
/// Additions after which carries are passed on: digits of so many terms fit an `i64`.
const PENDING: u32 = 1 << 30;

/// An exact sum of numbers: digits of 32 bits in 64-bit integers, which leaves room for carries, rounded once at the end.
#[derive(Clone, Debug)]
pub(crate) struct ExactSum {
    digits: [i64; DIGITS],
    /// Additions since carries were passed on.
    pending: u32,
    /// The sum of the terms that are not finite; zero without any.
    beyond: f64,
}

impl ExactSum {
    pub const ZERO: Self = Self {
        digits: [0; DIGITS],
        pending: 0,
        beyond: 0.0,
    };

    /// Adds a number.
    #[inline]
    pub fn add(&mut self, x: f64) {
        let bits = x.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as usize;
        if exponent == 0x7ff {
            self.beyond += x;
            return;
        }
        // Subnormal numbers have the exponent of the smallest normal one, without its leading bit.
        let leading = u64::from(exponent > 0) << 52;
        let mantissa = bits & ((1 << 52) - 1) | leading;
        let place = exponent.saturating_sub(1);
        let wide = u128::from(mantissa) << (place % 32);
        let sign = 1 - 2 * (bits >> 63) as i64;
        let digits = &mut self.digits[place / 32..][..3];
        for (k, digit) in digits.iter_mut().enumerate() {
            *digit += sign * i64::from((wide >> (32 * k)) as u32);
        }
        self.pending += 1;
        if self.pending == PENDING {
            self.carry();
        }
    }

    /// Adds another sum.
    pub fn join(&mut self, other: &Self) {
        let mut other = other.clone();
        other.carry();
        self.carry();
        for (own, other) in self.digits.iter_mut().zip(other.digits) {
            *own += other;
        }
        self.carry();
        self.beyond += other.beyond;
    }

    /// Brings all digits but the last between 0 and 2^32.
    fn carry(&mut self) {
        let mut carry = 0;
        for digit in &mut self.digits[..DIGITS - 1] {
            let sum = *digit + carry;
            (*digit, carry) = (sum & 0xffff_ffff, sum >> 32);
        }
        self.digits[DIGITS - 1] += carry;
        self.pending = 1;
    }

    /// Adds it to a message.
    pub fn put(&self, to: &mut Vec<u8>) {
        let mut own = self.clone();
        own.carry();
        let first = own.digits.iter().position(|&digit| digit != 0);
        let last = own.digits.iter().rposition(|&digit| digit != 0);
        let (first, last) = (first.unwrap_or(0), last.map_or(0, |last| last + 1));
        put_number((first as u64) << 32 | last as u64, to);
        put_number(own.beyond.to_bits(), to);
        for digit in &own.digits[first..last] {
            put_number(*digit as u64, to);
        }
    }

    /// Adds the one that a message begins with.
    pub fn take(&mut self, from: &mut Taken<'_>) -> Option<()> {
        let (ends, beyond) = (from.number()?, from.number()?);
        let (first, last) = ((ends >> 32) as usize, ends as u32 as usize);
        let mut other = Self {
            beyond: f64::from_bits(beyond),
            ..Self::ZERO
        };
        for digit in other.digits.get_mut(first..last)? {
            *digit = from.number()? as i64;
        }
        self.join(&other);
        Some(())
    }

    /// The nearest `f64`, the even one of two; NaN and infinite terms count as in any sum of `f64`.
    pub fn value(&self) -> f64 {
        if self.beyond.is_nan() {
            return f64::NAN;
        }
        if self.beyond != 0.0 {
            return self.beyond;
        }
        let mut own = self.clone();
        own.carry();
        let sign = if own.digits[DIGITS - 1] < 0 {
            own.digits.iter_mut().for_each(|digit| *digit = -*digit);
            own.carry();
            -1.0
        } else {
            1.0
        };
        let Some(top) = own.digits.iter().rposition(|&digit| digit != 0) else {
            return 0.0;
        };
        // The top three digits in steps of 2^exponent; of all below it matters alone whether there is anything.
        let base = top.saturating_sub(2);
        let exponent = 32 * base as i32 - 1074;
        let digits = own.digits[base..=top].iter().rev();
        let wide = digits.fold(0_u128, |wide, &digit| wide << 32 | digit as u128);
        let below = own.digits[..base].iter().any(|&digit| digit != 0);
        let wide = wide | u128::from(below);
        let drop = 128 - wide.leading_zeros() as i32 - 53;
        let drop = drop.max(0);
        let (whole, rest) = (wide >> drop, wide & ((1 << drop) - 1));
        let half = 1_u128 << drop >> 1;
        let up = rest > half || (rest == half && rest > 0 && whole & 1 == 1);
        let whole = (whole + u128::from(up)) as f64;
        // Two factors, each of which is a normal power of two.
        let power = exponent + drop;
        let first = power.max(-1000);
        sign * (whole * 2_f64.powi(first)) * 2_f64.powi(power - first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_of_messages_is_the_sum_of_all() {
        let all = numbers(500);
        let mut joined = ExactSum::ZERO;
        for part in all.chunks(130) {
            let (mut own, mut message) = (ExactSum::ZERO, Vec::new());
            for x in part {
                own.add(*x);
            }
            own.put(&mut message);
            let mut from = Taken(&message);
            assert_eq!(joined.take(&mut from), Some(()));
            assert!(from.0.is_empty());
            assert_eq!(joined.take(&mut Taken(&message[..8])), None);
        }
        assert_eq!(joined.value().to_bits(), sum(&all).to_bits());
        let mut message = Vec::new();
        ExactSum::ZERO.put(&mut message);
        assert_eq!(message.len(), 16);
        let (mut beyond, mut message) = (ExactSum::ZERO, Vec::new());
        beyond.add(f64::NEG_INFINITY);
        beyond.put(&mut message);
        assert_eq!(joined.take(&mut Taken(&message)), Some(()));
        assert_eq!(joined.value(), f64::NEG_INFINITY);
    }

    fn sum(terms: &[f64]) -> f64 {
        let mut sum = ExactSum::ZERO;
        for x in terms {
            sum.add(*x);
        }
        sum.value()
    }

    /// Numbers of all magnitudes and both signs.
    fn numbers(count: usize) -> Vec<f64> {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005);
            state = state.wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(state ^ state >> 29)
        };
        let finite = core::iter::repeat_with(next).filter(|x| x.abs() < 1e300);
        finite.take(count).collect()
    }

    /// The same by Shewchuk's expansions: no two parts overlap, and their sum is that of the terms. Rounded as the reference of
    /// Python's `math.fsum` is.
    fn by_expansion(terms: &[f64]) -> f64 {
        let mut parts: Vec<f64> = Vec::new();
        for &term in terms {
            let (mut x, mut kept) = (term, 0);
            for k in 0..parts.len() {
                let (big, small) = if x.abs() < parts[k].abs() {
                    (parts[k], x)
                } else {
                    (x, parts[k])
                };
                x = big + small;
                let lost = small - (x - big);
                if lost != 0.0 {
                    parts[kept] = lost;
                    kept += 1;
                }
            }
            parts.truncate(kept);
            parts.push(x);
        }
        let Some(mut sum) = parts.pop() else {
            return 0.0;
        };
        while let Some(part) = parts.pop() {
            let before = sum;
            sum = before + part;
            let lost = part - (sum - before);
            if lost == 0.0 {
                continue;
            }
            // What is below decides a tie.
            let twice = 2.0 * lost;
            let tie = parts.last().is_some_and(|next| next * lost > 0.0);
            if tie && (sum + twice) - sum == twice {
                sum += twice;
            }
            break;
        }
        sum
    }

    #[test]
    fn a_sum_is_that_of_exact_arithmetic() {
        let tiny = f64::from_bits(1);
        let above = 1.0 + f64::EPSILON;
        let half = 0.5 * f64::EPSILON;
        for (terms, expected) in [
            (&[][..], 0.0),
            (&[1e300, 1.0, -1e300], 1.0),
            (&[f64::MAX, 1.0, tiny, -f64::MAX, -1.0], tiny),
            (&[0.1; 10], 1.0),
            (&[tiny, tiny, tiny], 3.0 * tiny),
            (&[f64::MIN_POSITIVE, -tiny], f64::MIN_POSITIVE - tiny),
            (&[-3.5, 1.25], -2.25),
            // A tie goes to the even number, and the smallest term more decides it.
            (&[1.0, half], 1.0),
            (&[above, half], 1.0 + 2.0 * f64::EPSILON),
            (&[1.0, half, tiny], above),
            (&[-1.0, -half, -tiny], -above),
            (&[above, half, -tiny], above),
            (&[f64::MAX, f64::MAX, -f64::MAX], f64::MAX),
            (&[f64::MAX, f64::MAX], f64::INFINITY),
        ] {
            assert_eq!(sum(terms).to_bits(), expected.to_bits(), "{terms:?}");
        }
    }

    #[test]
    fn sums_of_many_terms_are_those_of_expansions() {
        let all = numbers(3000);
        for first in [0, 500, 1000] {
            for count in [1, 2, 3, 10, 100, 2000] {
                let terms = &all[first..first + count];
                assert_eq!(sum(terms).to_bits(), by_expansion(terms).to_bits());
            }
        }
        // Of like magnitudes, and with sums that cancel.
        let like: Vec<f64> = all.iter().map(|x| x.fract() + (x * 1e-3).sin()).collect();
        let back: Vec<f64> = like.iter().rev().map(|x| -x * (1.0 + 1e-9)).collect();
        let both = [like, back].concat();
        assert_eq!(sum(&both).to_bits(), by_expansion(&both).to_bits());
    }

    #[test]
    fn neither_order_nor_grouping_matters() {
        let mut all = numbers(1000);
        let expected = sum(&all).to_bits();
        for parts in [1, 2, 3, 7, 64] {
            let mut sums: Vec<_> = (0..parts)
                .map(|part| {
                    let mut sum = ExactSum::ZERO;
                    let own = all.iter().skip(part).step_by(parts);
                    own.for_each(|x| sum.add(*x));
                    sum
                })
                .collect();
            for _ in 0..parts {
                sums.rotate_left(1);
                let mut whole = ExactSum::ZERO;
                for sum in &sums {
                    whole.join(sum);
                }
                assert_eq!(whole.value().to_bits(), expected);
            }
            all.reverse();
            all.rotate_left(parts);
            assert_eq!(sum(&all).to_bits(), expected);
        }
    }

    #[test]
    fn carries_are_passed_on_before_digits_are_full() {
        let mut sum = ExactSum::ZERO;
        sum.add(f64::MAX);
        sum.add(-1.0);
        sum.pending = PENDING - 1;
        sum.add(0.25);
        assert_eq!(sum.pending, 1);
        sum.add(-f64::MAX);
        assert_eq!(sum.value(), -0.75);
    }

    #[test]
    fn what_is_not_finite_stays_so_in_any_order() {
        let (nan, inf) = (f64::NAN, f64::INFINITY);
        assert_eq!(sum(&[1.0, inf, -1e300]), inf);
        assert_eq!(sum(&[-inf, 1.0]), -inf);
        for terms in [[1.0, nan, 2.0], [inf, 1.0, -inf], [nan, inf, 0.0]] {
            assert!(sum(&terms).is_nan());
        }
    }
}
