//! Curves in pixels: cut to the panel and thinned to what can be seen.
//! Every column of pixels keeps its first, lowest, highest and last point.

use std::collections::HashSet;
use std::fmt::Write as _;

type Point = (f64, f64);

/// Two decimals are enough for a pixel.
pub(in crate::output) fn px(value: f64) -> f64 {
    (value * 100.0).round() / 100.0 + 0.0
}

/// Splits at gaps.
fn stretches(points: &[Point]) -> impl Iterator<Item = &[Point]> {
    points
        .split(|p| !p.0.is_finite() || !p.1.is_finite())
        .filter(|stretch| !stretch.is_empty())
}

/// Keeps, of each run of points in one column of half a pixel, those that show its extent.
pub(super) fn thin(points: &[Point]) -> Vec<Point> {
    let column = |p: &Point| (p.0 * 2.0).floor();
    let mut kept = Vec::new();
    for run in points.chunk_by(|a, b| column(a) == column(b)) {
        if run.len() <= 4 {
            kept.extend_from_slice(run);
            continue;
        }
        let by_height = |a: &usize, b: &usize| run[*a].1.total_cmp(&run[*b].1);
        let lowest = (0..run.len()).min_by(by_height).unwrap_or(0);
        let highest = (0..run.len()).max_by(by_height).unwrap_or(0);
        let mut indices = [0, lowest.min(highest), lowest.max(highest), run.len() - 1].to_vec();
        indices.dedup();
        kept.extend(indices.into_iter().map(|index| run[index]));
    }
    kept
}

/// The part of a segment inside the rectangle from (-m, -m) to (w + m, h + m).
fn cut(a: Point, b: Point, w: f64, h: f64) -> Option<(Point, Point)> {
    const M: f64 = 8.0;
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (step, room) in [
        (-dx, a.0 + M),
        (dx, w + M - a.0),
        (-dy, a.1 + M),
        (dy, h + M - a.1),
    ] {
        if step == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if step < 0.0 {
            from = from.max(room / step);
        } else {
            to = to.min(room / step);
        }
    }
    let at = |t: f64| match t {
        0.0 => a,
        1.0 => b,
        t => (a.0 + t * dx, a.1 + t * dy),
    };
    (from <= to).then(|| (at(from), at(to)))
}

/// The curve as the data of an SVG path, in a panel of `w` by `h` pixels.
pub(super) fn curve(points: &[Point], w: f64, h: f64) -> String {
    let mut data = String::new();
    for stretch in stretches(points) {
        let thinned = thin(stretch);
        let mut pen = None;
        for pair in thinned.windows(2) {
            let Some((a, b)) = cut(pair[0], pair[1], w, h) else {
                continue;
            };
            let [a, b] = [a, b].map(|p| (px(p.0), px(p.1)));
            if pen != Some(a) {
                let _ = write!(data, "M{} {}", a.0, a.1);
            }
            if pen != Some(b) {
                let _ = write!(data, "L{} {}", b.0, b.1);
            }
            pen = Some(b);
        }
    }
    data
}

/// The points inside the panel, one for each place that can be told apart.
pub(super) fn distinct(points: &[Point], w: f64, h: f64) -> Vec<Point> {
    let mut taken = HashSet::new();
    let inside = |p: &&Point| (-0.5..=w + 0.5).contains(&p.0) && (-0.5..=h + 0.5).contains(&p.1);
    points
        .iter()
        .filter(inside)
        .filter(|p| taken.insert(((p.0 * 2.0).round() as i64, (p.1 * 2.0).round() as i64)))
        .copied()
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_extremes_and_ends() {
        let n = 100_000;
        let mut points: Vec<Point> = (0..n)
            .map(|i| (300.0 * f64::from(i) / f64::from(n), 50.0))
            .collect();
        points[33_333].1 = -3.0;
        points[77_777].1 = 99.0;
        let thinned = thin(&points);
        assert!(thinned.len() < 2_500, "{}", thinned.len());
        assert!(thinned.contains(&points[33_333]) && thinned.contains(&points[77_777]));
        assert_eq!(thinned.first(), points.first());
        assert_eq!(thinned.last(), points.last());
    }

    #[test]
    fn curves_are_cut_where_they_leave() {
        assert_eq!(curve(&[(0.0, 5.0), (1e9, 5.0)], 10.0, 10.0), "M0 5L18 5");
        assert_eq!(curve(&[(-50.0, 50.0), (50.0, 50.0)], 10.0, 10.0), "");
        let gap = [
            (0.0, 0.0),
            (1.0, 1.0),
            (f64::NAN, 1.0),
            (2.0, 2.0),
            (3.0, 3.0),
        ];
        assert_eq!(curve(&gap, 10.0, 10.0), "M0 0L1 1M2 2L3 3");
    }

    #[test]
    fn markers_on_one_place_are_drawn_once() {
        let points = [
            (1.0, 1.0),
            (1.01, 1.0),
            (5.0, 5.0),
            (50.0, 5.0),
            (f64::NAN, 1.0),
        ];
        assert_eq!(distinct(&points, 10.0, 10.0), [(1.0, 1.0), (5.0, 5.0)]);
    }
}
