//! Numbers as bytes of a message, and back.
//! Ranks are of one program, so bytes have the order of the machine.

use crate::scalar::Real;

/// What travels as its bytes.
///
/// # Safety
/// All bytes of a value are set, and any bytes are a value.
pub(crate) unsafe trait Plain: Copy {
    /// One to be written over.
    fn empty() -> Self;
}

// SAFETY: scalars are `f32` and `f64` alone.
unsafe impl<T: Real> Plain for T {
    fn empty() -> Self {
        T::zero()
    }
}

// SAFETY: integers have no other bytes than those of their value.
unsafe impl Plain for u32 {
    fn empty() -> Self {
        0
    }
}

// SAFETY: as of `u32`.
unsafe impl Plain for u64 {
    fn empty() -> Self {
        0
    }
}

// SAFETY: an array has the bytes of what is in it and no others.
unsafe impl<V: Plain, const N: usize> Plain for [V; N] {
    fn empty() -> Self {
        [V::empty(); N]
    }
}

/// Adds an integer to a message.
pub(crate) fn put_number(number: u64, to: &mut Vec<u8>) {
    to.extend_from_slice(&number.to_ne_bytes());
}

/// Adds numbers to a message.
pub(crate) fn put_numbers<V: Plain>(numbers: &[V], to: &mut Vec<u8>) {
    let bytes = size_of_val(numbers);
    // SAFETY: all of their bytes are set.
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

    /// So many numbers, behind those that are there.
    pub fn more<V: Plain>(&mut self, count: usize, to: &mut Vec<V>) -> Option<()> {
        if count.checked_mul(size_of::<V>())? > self.0.len() {
            return None;
        }
        let before = to.len();
        to.resize(before + count, V::empty());
        self.numbers(&mut to[before..])
    }

    /// Numbers into a slice of them.
    pub fn numbers<V: Plain>(&mut self, to: &mut [V]) -> Option<()> {
        let own = self.bytes(size_of_val(to))?;
        // SAFETY: any bytes are such numbers; as many as there are in the slice.
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
        put_numbers(&[1_u32, u32::MAX], &mut bytes);
        put_numbers(&[1.5, f64::MIN_POSITIVE], &mut bytes);
        put_numbers(&[-0.25_f32], &mut bytes);
        let mut taken = Taken(&bytes);
        assert_eq!(taken.number(), Some(u64::MAX - 3));
        let mut words = vec![9];
        assert_eq!(taken.more(2, &mut words), Some(()));
        assert_eq!(words, [9_u32, 1, u32::MAX]);
        let (mut wide, mut narrow) = ([0.0; 2], [0.0_f32]);
        assert_eq!(taken.numbers(&mut wide), Some(()));
        assert_eq!(wide, [1.5, f64::MIN_POSITIVE]);
        assert_eq!(taken.numbers(&mut narrow), Some(()));
        assert_eq!(narrow, [-0.25]);
        assert!(taken.0.is_empty());
        assert_eq!(taken.number(), None);
        assert_eq!(taken.more(1, &mut words), None);
        assert_eq!(taken.numbers(&mut narrow), None);
    }
}
