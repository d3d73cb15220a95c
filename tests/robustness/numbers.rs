//! Numbers of random descriptions: most within the range that is asked for, some at its ends, some that are none.
//! How many are bad varies from case to case, so that some descriptions are good throughout.

use crate::common::Random;

/// Numbers of one description.
pub struct Numbers {
    pub random: Random,
    /// One bad number in so many; none if zero.
    bad: usize,
    /// How much rarer parts of a scene are that one may have.
    rare: usize,
}

/// What nobody should give.
const BAD: [f64; 14] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -0.0,
    -1.0,
    1.0,
    1e300,
    -1e300,
    1e-300,
    f64::MIN_POSITIVE,
    f64::MAX,
    f64::EPSILON,
    1e18,
];

impl Numbers {
    pub fn of(seed: u64) -> Self {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9).wrapping_add(17));
        let bad = [0, 0, 60, 20][random.below(4)];
        let rare = [1, 4, 12, 40][random.below(4)];
        Self { random, bad, rare }
    }
    /// Between two numbers, or bad.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        if self.bad > 0 && self.random.below(self.bad) == 0 {
            return BAD[self.random.below(BAD.len())];
        }
        match self.random.below(12) {
            0 => low,
            1 => high,
            _ => low + (high - low) * self.random.unit(),
        }
    }
    /// Between two positive numbers, evenly by orders of magnitude, or bad.
    pub fn scale(&mut self, low: f64, high: f64) -> f64 {
        let value = self.between(low.ln(), high.ln());
        if (low.ln()..=high.ln()).contains(&value) {
            value.exp()
        } else {
            value
        }
    }
    pub fn pair(&mut self, size: f64) -> [f64; 2] {
        core::array::from_fn(|_| self.between(-size, size))
    }
    /// True once in `n`.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.random.below(n) == 0
    }
    /// True once in `n`, or more rarely: for parts that few scenes have.
    pub fn part(&mut self, n: usize) -> bool {
        self.random.below(n * self.rare) == 0
    }
    pub fn below(&mut self, n: usize) -> usize {
        self.random.below(n)
    }
}
