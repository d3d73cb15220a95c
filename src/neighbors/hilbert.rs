//! The order of cells along a Hilbert curve, in which neighbours in space are neighbours in memory.
//! Skilling's transpose form (J. Skilling, 2004, AIP Conf. Proc. 707, 381), any dimension.

/// Index along the Hilbert curve of a cell with `bits` bits a coordinate.
///
/// ```
/// use meshfree::neighbors::hilbert_index;
/// let order = [[0, 0], [0, 1], [1, 1], [1, 0]].map(|cell| hilbert_index(cell, 1));
/// assert_eq!(order, [0, 1, 2, 3]);
/// ```
#[must_use]
pub fn hilbert_index<const D: usize>(cell: [u32; D], bits: u32) -> u64 {
    if D == 1 {
        return u64::from(cell[0]);
    }
    let mut x = cell;
    let top = 1_u32 << (bits - 1);
    let mut q = top;
    while q > 1 {
        let p = q - 1;
        for k in 0..D {
            if x[k] & q != 0 {
                x[0] ^= p;
            } else {
                let t = (x[0] ^ x[k]) & p;
                x[0] ^= t;
                x[k] ^= t;
            }
        }
        q >>= 1;
    }
    for k in 1..D {
        x[k] ^= x[k - 1];
    }
    let mut t = 0;
    q = top;
    while q > 1 {
        if x[D - 1] & q != 0 {
            t ^= q - 1;
        }
        q >>= 1;
    }
    for value in &mut x {
        *value ^= t;
    }
    let mut index = 0;
    for bit in (0..bits).rev() {
        for value in x {
            index = index << 1 | u64::from(value >> bit & 1);
        }
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve_is_connected<const D: usize>(bits: u32, cells: impl Iterator<Item = [u32; D]>) {
        let mut order: Vec<_> = cells
            .map(|cell| (hilbert_index(cell, bits), cell))
            .collect();
        order.sort_unstable();
        for (k, pair) in order.windows(2).enumerate() {
            assert_eq!(pair[0].0, k as u64);
            let step: u32 = (0..D).map(|d| pair[0].1[d].abs_diff(pair[1].1[d])).sum();
            assert_eq!(step, 1);
        }
    }

    #[test]
    fn curve_visits_every_cell_once_in_unit_steps() {
        curve_is_connected(3, (0..64).map(|k| [k % 8, k / 8]));
        curve_is_connected(2, (0..64).map(|k| [k % 4, k / 4 % 4, k / 16]));
    }
}
