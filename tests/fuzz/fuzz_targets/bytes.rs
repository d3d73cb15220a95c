//! Numbers of random descriptions that come from a fuzzer's bytes, as far as these go, and from SplitMix64 after them.
//! It stands in the place of the generator of `tests/common`, so that the fuzzer leads the generators of `tests/robustness`.

use std::cell::RefCell;

thread_local! {
    static BYTES: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// What all numbers are made of from now on.
pub fn feed(bytes: &[u8]) {
    BYTES.with(|own| *own.borrow_mut() = bytes.iter().rev().copied().collect());
}

/// The next byte of those fed.
fn next() -> Option<u8> {
    BYTES.with(|own| own.borrow_mut().pop())
}

/// The methods of the generator of `tests/common` that the generators ask for.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// A choice takes a byte where a byte is enough, so that one byte is one choice.
    fn take(&mut self, count: u32) -> u64 {
        let mut bits = 0;
        for _ in 0..count {
            let Some(byte) = next() else {
                self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
                let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
                let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
                return z ^ (z >> 31);
            };
            bits = (bits << 8) | u64::from(byte);
        }
        // Spread over the highest bits too, of which `sign` makes its number.
        bits << (64 - 8 * count) | bits
    }
    pub fn bits(&mut self) -> u64 {
        self.take(8)
    }
    pub fn sign(&mut self) -> f64 {
        (self.take(2) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
    pub fn unit(&mut self) -> f64 {
        0.5 * (self.sign() + 1.0)
    }
    pub fn below(&mut self, n: usize) -> usize {
        (self.take(if n > 256 { 4 } else { 1 }) % n as u64) as usize
    }
}
