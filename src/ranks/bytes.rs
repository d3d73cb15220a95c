//! Numbers as bytes of a message, and back.
//! Ranks are of one program, so bytes have the order of the machine.

use crate::scalar::Real;

/// Adds an integer to a message.
pub(crate) fn put_number(number: u64, to: &mut Vec<u8>) {
    to.extend_from_slice(&number.to_ne_bytes());
}

/// Adds integers to a message.
pub(crate) fn put_words(words: &[u32], to: &mut Vec<u8>) {
    to.reserve(4 * words.len());
    to.extend(words.iter().flat_map(|word| word.to_ne_bytes()));
}

/// Adds numbers to a message.
pub(crate) fn put_numbers<T: Real>(numbers: &[T], to: &mut Vec<u8>) {
    let bytes = size_of_val(numbers);
    // SAFETY: scalars are `f32` and `f64` alone, whose bytes are all set.
    to.extend_from_slice(unsafe {
        core::slice::from_raw_parts(numbers.as_ptr().cast::<u8>(), bytes)
    });
}

/// What is left of a message that is read from its front; nothing is read beyond its end.
pub(crate) struct Taken<'a>(pub &'a [u8]);

impl<'a> Taken<'a> {
    fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (own, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(own)
    }

    /// An integer.
    pub fn number(&mut self) -> Option<u64> {
        let own = self.bytes(8)?;
        Some(u64::from_ne_bytes(own.try_into().ok()?))
    }

    /// So many integers, behind those that are there.
    pub fn words(&mut self, count: usize, to: &mut Vec<u32>) -> Option<()> {
        let own = self.bytes(count.checked_mul(4)?)?;
        to.reserve(count);
        to.extend(
            own.chunks_exact(4)
                .map(|word| u32::from_ne_bytes([word[0], word[1], word[2], word[3]])),
        );
        Some(())
    }

    /// Numbers into a slice of them.
    pub fn numbers<T: Real>(&mut self, to: &mut [T]) -> Option<()> {
        let own = self.bytes(size_of_val(to))?;
        // SAFETY: scalars are `f32` and `f64` alone, which any bytes are; as many as there are in the slice.
        unsafe {
            core::ptr::copy_nonoverlapping(own.as_ptr(), to.as_mut_ptr().cast::<u8>(), own.len());
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_and_a_short_message_gives_none() {
        let mut bytes = Vec::new();
        put_number(u64::MAX - 3, &mut bytes);
        put_words(&[1, u32::MAX], &mut bytes);
        put_numbers(&[1.5, f64::MIN_POSITIVE], &mut bytes);
        put_numbers(&[-0.25_f32], &mut bytes);
        let mut taken = Taken(&bytes);
        assert_eq!(taken.number(), Some(u64::MAX - 3));
        let mut words = vec![9];
        assert_eq!(taken.words(2, &mut words), Some(()));
        assert_eq!(words, [9, 1, u32::MAX]);
        let (mut wide, mut narrow) = ([0.0; 2], [0.0_f32]);
        assert_eq!(taken.numbers(&mut wide), Some(()));
        assert_eq!(wide, [1.5, f64::MIN_POSITIVE]);
        assert_eq!(taken.numbers(&mut narrow), Some(()));
        assert_eq!(narrow, [-0.25]);
        assert!(taken.0.is_empty());
        assert_eq!(taken.number(), None);
        assert_eq!(taken.words(1, &mut words), None);
        assert_eq!(taken.numbers(&mut narrow), None);
    }
}
