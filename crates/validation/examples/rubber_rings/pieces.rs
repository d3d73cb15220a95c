//! Pieces of a body: particles that are near others, counted.
//! Cells as wide as the reach, and a walk from one particle to the next.

use std::collections::HashMap;

/// The numbers of particles of each piece, the largest first; within `reach` \[m\] two particles hold together.
pub fn pieces(places: &[[f64; 2]], reach: f64) -> Vec<usize> {
    let cell = |place: &[f64; 2]| place.map(|x| (x / reach).floor() as i64);
    let mut cells = HashMap::<[i64; 2], Vec<usize>>::new();
    for (k, place) in places.iter().enumerate() {
        cells.entry(cell(place)).or_default().push(k);
    }
    let mut seen = vec![false; places.len()];
    let mut sizes = Vec::new();
    for first in 0..places.len() {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let (mut open, mut size) = (vec![first], 0);
        while let Some(k) = open.pop() {
            size += 1;
            let [a, b] = cell(&places[k]);
            for near in (-1..=1).flat_map(|i| (-1..=1).map(move |j| [a + i, b + j])) {
                for &other in cells.get(&near).into_iter().flatten() {
                    let [x, y] = [0, 1].map(|d| places[k][d] - places[other][d]);
                    if !seen[other] && x.hypot(y) < reach {
                        seen[other] = true;
                        open.push(other);
                    }
                }
            }
        }
        sizes.push(size);
    }
    sizes.sort_by(|a, b| b.cmp(a));
    sizes
}

#[cfg(test)]
mod tests {
    use super::pieces;

    #[test]
    fn two_heaps_and_a_loner_are_three_pieces() {
        let places = [
            [0.0, 0.0],
            [0.9, 0.0],
            [5.0, 5.0],
            [1.7, 0.4],
            [5.0, 5.9],
            [-3.0, 0.0],
        ];
        assert_eq!(pieces(&places, 1.0), [3, 2, 1]);
    }
}
