//! The largest void that particles enclose: an empty ball that nothing connects with the outside.
//! Found on a grid by flooding from the outside, when it is asked for.

use crate::neighbors::Cells;

/// Edge of a cell in spacings: a row of particles at their spacing leaves no gap that a face of an empty cell shows.
const EDGE: f64 = 1.2;
/// Most cells that are looked at, 32 MB.
const MOST: f64 = 32e6;

/// The radius in spacings of the largest ball without particles in a void that they enclose, and its centre \[m\]; zero
/// where there is none, and `None` where the box around the particles has more cells than memory is taken for.
pub(super) fn largest<const D: usize>(
    points: &[[f64; D]],
    spacing: f64,
) -> Option<(f64, [f64; D])> {
    let edge = EDGE * spacing;
    let bound = |least: f64, pick: fn(f64, f64) -> f64| -> [f64; D] {
        core::array::from_fn(|d| points.iter().fold(least, |most, x| pick(most, x[d])))
    };
    let low = bound(f64::INFINITY, f64::min);
    let high = bound(f64::NEG_INFINITY, f64::max);
    // A layer of empty cells all around.
    let counts: [f64; D] = core::array::from_fn(|d| ((high[d] - low[d]) / edge).floor() + 3.0);
    let total: f64 = counts.iter().product();
    if points.is_empty() || total.is_nan() || total > MOST {
        return None;
    }
    let counts = counts.map(|count| count as usize);
    let mut strides = [1; D];
    for d in 1..D {
        strides[d] = strides[d - 1] * counts[d - 1];
    }
    const EMPTY: u8 = 0;
    const FULL: u8 = 1;
    const OUTSIDE: u8 = 2;
    let mut cells = vec![EMPTY; total as usize];
    for x in points {
        let cell = (0..D).map(|d| (((x[d] - low[d]) / edge) as usize + 1) * strides[d]);
        cells[cell.sum::<usize>()] = FULL;
    }
    let mut front = vec![0];
    cells[0] = OUTSIDE;
    while let Some(cell) = front.pop() {
        for d in 0..D {
            let k = cell / strides[d] % counts[d];
            let mut visit = |next: usize| {
                if cells[next] == EMPTY {
                    cells[next] = OUTSIDE;
                    front.push(next);
                }
            };
            if k > 0 {
                visit(cell - strides[d]);
            }
            if k + 1 < counts[d] {
                visit(cell + strides[d]);
            }
        }
    }
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let buckets = Cells::build(points, &all, 2.0 * spacing);
    let mut largest = (0.0, low);
    for (cell, _) in cells.iter().enumerate().filter(|(_, own)| **own == EMPTY) {
        let centre: [f64; D] = core::array::from_fn(|d| {
            low[d] + ((cell / strides[d] % counts[d]) as f64 - 0.5) * edge
        });
        let mut reach = 2.0 * spacing;
        let radius = loop {
            let mut least = f64::INFINITY;
            let [from, to] = [-reach, reach].map(|by| centre.map(|x| x + by));
            buckets.for_each_run(from, to, |run| {
                for &k in run {
                    let r2 = (0..D).map(|d| (points[k as usize][d] - centre[d]).powi(2));
                    least = least.min(r2.sum());
                }
            });
            if least.sqrt() <= reach {
                break least.sqrt();
            }
            reach *= 2.0;
        };
        if radius > largest.0 {
            largest = (radius, centre);
        }
    }
    Some((largest.0 / spacing, largest.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hole_is_found_and_a_bay_is_none() {
        let square = |keep: fn(f64, f64) -> bool| -> Vec<[f64; 2]> {
            let place = |k: i32| [f64::from(k % 40) * 0.1, f64::from(k / 40) * 0.1];
            (0..1600).map(place).filter(|[x, y]| keep(*x, *y)).collect()
        };
        assert_eq!(
            largest(&square(|_, _| true), 0.1).map(|own| own.0),
            Some(0.0)
        );
        let hole = square(|x, y| (x - 2.0).hypot(y - 2.0) > 0.55);
        let (radius, centre) = largest(&hole, 0.1).expect("few cells");
        assert!((radius - 6.0).abs() < 0.8, "{radius}");
        assert!(
            (centre[0] - 2.0).hypot(centre[1] - 2.0) < 0.12,
            "{centre:?}"
        );
        let bay = square(|x, y| (x - 2.0).abs() > 0.35 || y < 1.0);
        assert_eq!(largest(&bay, 0.1).map(|own| own.0), Some(0.0));
        assert!(largest(&[[0.0; 3], [1e9; 3]], 1e-3).is_none());
    }
}
