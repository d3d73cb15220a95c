//! Lattice rows with a random offset, so that the first particles of a column do not strike a wall all at once.
//! The tip of a wave that comes from a column is the first particles of its rows.

use meshfree::prelude::*;
use std::collections::HashMap;

/// How many particles before an end that may not move a row moves less and less.
const TAPER: f64 = 4.0;

/// Moves each lattice row along `axis` by its own share of up to half a spacing \[m\], at random, the same for the same
/// `seed`. `free` says of the low and the high end of the rows whether they may move.
pub fn offset<T: Real, const D: usize>(
    body: Body<T, D>,
    axis: usize,
    spacing: f64,
    free: [bool; 2],
    seed: u64,
) -> Body<T, D> {
    let row = move |x: &[f64; D]| {
        // Adding zero makes one of the two zeros.
        let mut across = x.map(|x| (x + 0.0).to_bits());
        across[axis] = 0;
        across
    };
    // Of each row its number, and its ends.
    let mut rows = HashMap::new();
    for x in body.points() {
        let number = rows.len() as u64;
        let (_, ends) = rows.entry(row(x)).or_insert((number, [x[axis]; 2]));
        *ends = [ends[0].min(x[axis]), ends[1].max(x[axis])];
    }
    body.displace(|mut x| {
        let (number, ends): (u64, [f64; 2]) = rows[&row(&x)];
        let freedom = |end: usize| {
            let particles = (x[axis] - ends[end]).abs() / spacing;
            if free[end] {
                1.0
            } else {
                (particles / TAPER).min(1.0)
            }
        };
        x[axis] += freedom(0) * freedom(1) * 0.5 * spacing * random(seed, number);
        x
    })
}

/// The number of a sequence at `index`, even between −1 and 1 (SplitMix64; Steele, Lea & Flood 2014).
fn random(seed: u64, index: u64) -> f64 {
    let mut z = index
        .wrapping_add(1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(seed);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

#[cfg(test)]
mod tests {
    use super::offset;
    use meshfree::prelude::*;

    const DX: f64 = 0.04;

    #[test]
    fn a_row_moves_as_one_and_less_towards_an_end_that_may_not() {
        let column = || Body::<f64, 2>::block("column", catalogue::water(), [0.0; 2], [0.4; 2], DX);
        let shifts = |free: [bool; 2]| -> Vec<Vec<f64>> {
            let (even, moved) = (column(), offset(column(), 0, DX, free, 1));
            let pairs = even.points().iter().zip(moved.points());
            let shifts: Vec<f64> = pairs.map(|(a, b)| (b[0] - a[0]) / DX).collect();
            // Ten particles a row, along the first axis first.
            shifts.chunks(10).map(<[f64]>::to_vec).collect()
        };
        let rows = shifts([true, true]);
        for (k, row) in rows.iter().enumerate() {
            assert!(
                row.iter().all(|own| (own - row[0]).abs() < 1e-12),
                "{row:?}"
            );
            assert!(row[0].abs() <= 0.5, "{row:?}");
            assert!(
                rows[..k]
                    .iter()
                    .all(|other| (other[0] - row[0]).abs() > 1e-6)
            );
        }
        for (free, held) in rows.iter().zip(shifts([true, false])) {
            for (k, own) in held.iter().enumerate() {
                let share = ((9 - k) as f64 / 4.0).min(1.0);
                assert!((own - share * free[0]).abs() < 1e-12, "{held:?}");
            }
        }
    }
}
