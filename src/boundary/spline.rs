//! Cubic splines through rows of a time and some numbers, whose second derivatives are continuous.
//! They are exact for cubics, or end at rest.

/// How a spline ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ends {
    /// The outermost two intervals share one cubic ("not a knot").
    Free,
    /// With zero slope.
    AtRest,
}

/// A cubic spline in W numbers (de Boor 1978, A Practical Guide to Splines, chapter IV).
///
/// With h = tₖ₊₁ − tₖ and s = t − tₖ it is x = xₖ + c s + Mₖ s²/2 + (Mₖ₊₁ − Mₖ) s³/(6 h),
/// c = (xₖ₊₁ − xₖ)/h − h (2 Mₖ + Mₖ₊₁)/6, and slopes that agree at the rows give the second derivatives M.
#[derive(Clone, Debug)]
pub(super) struct Spline<const W: usize> {
    times: Vec<f64>,
    values: Vec<[f64; W]>,
    /// M.
    curvatures: Vec<[f64; W]>,
}

impl<const W: usize> Spline<W> {
    /// Through four rows or more, whose times increase.
    pub fn new(rows: &[(f64, [f64; W])], ends: Ends) -> Self {
        let (times, values): (Vec<f64>, Vec<[f64; W]>) = rows.iter().copied().unzip();
        let last = rows.len() - 1;
        let span = |k: usize| times[k + 1] - times[k];
        let slope = |k: usize, w: usize| (values[k + 1][w] - values[k][w]) / span(k);
        // Equations of three neighbours each, and right sides.
        let mut system: Vec<[f64; 3]> = vec![[0.0, 1.0, 0.0]; rows.len()];
        let mut right = vec![[0.0; W]; rows.len()];
        for k in 1..last {
            let (before, after) = (span(k - 1), span(k));
            system[k] = [before, 2.0 * (before + after), after];
            right[k] = core::array::from_fn(|w| 6.0 * (slope(k, w) - slope(k - 1, w)));
        }
        // Of a free end: M₀ = M₁ + r (M₁ − M₂) with r the ratio of the first two intervals.
        let (low, high) = (span(0) / span(1), span(last - 1) / span(last - 2));
        match ends {
            Ends::Free => {
                system[1][1] += span(0) * (1.0 + low);
                system[1][2] -= span(0) * low;
                system[1][0] = 0.0;
                system[last - 1][1] += span(last - 1) * (1.0 + high);
                system[last - 1][0] -= span(last - 1) * high;
                system[last - 1][2] = 0.0;
            }
            Ends::AtRest => {
                system[0] = [0.0, 2.0 * span(0), span(0)];
                right[0] = core::array::from_fn(|w| 6.0 * slope(0, w));
                system[last] = [span(last - 1), 2.0 * span(last - 1), 0.0];
                right[last] = core::array::from_fn(|w| -6.0 * slope(last - 1, w));
            }
        }
        let mut curvatures = solve(&system, right);
        if ends == Ends::Free {
            let beyond = |at: usize, next: usize, ratio: f64, m: &[[f64; W]]| {
                core::array::from_fn(|w| m[at][w] + ratio * (m[at][w] - m[next][w]))
            };
            curvatures[0] = beyond(1, 2, low, &curvatures);
            curvatures[last] = beyond(last - 1, last - 2, high, &curvatures);
        }
        Self {
            times,
            values,
            curvatures,
        }
    }

    /// The spline (`order` 0) or its first or second derivative at a time; beyond the rows that of the outermost cubics.
    pub fn at(&self, order: usize, time: f64) -> [f64; W] {
        let passed = self.times.partition_point(|own| *own <= time);
        let k = passed.clamp(1, self.times.len() - 1) - 1;
        let (s, h) = (time - self.times[k], self.times[k + 1] - self.times[k]);
        core::array::from_fn(|w| {
            let [x, next] = [k, k + 1].map(|k| self.values[k][w]);
            let [m, m_next] = [k, k + 1].map(|k| self.curvatures[k][w]);
            let (c, j) = (
                (next - x) / h - h * (2.0 * m + m_next) / 6.0,
                (m_next - m) / h,
            );
            match order {
                0 => x + s * (c + s * (m / 2.0 + s * j / 6.0)),
                1 => c + s * (m + s * j / 2.0),
                _ => m + s * j,
            }
        })
    }

    /// Whether all of it is numbers.
    pub fn is_finite(&self) -> bool {
        let all = self.values.iter().chain(&self.curvatures).flatten();
        all.into_iter().all(|x| x.is_finite())
    }
}

/// Solves a system of three diagonals in which each middle outweighs the sides, by elimination without exchanges.
fn solve<const W: usize>(system: &[[f64; 3]], mut right: Vec<[f64; W]>) -> Vec<[f64; W]> {
    let mut upper = vec![0.0; system.len()];
    for k in 0..system.len() {
        let [low, middle, high] = system[k];
        let above = if k == 0 { 0.0 } else { upper[k - 1] };
        let pivot = middle - low * above;
        upper[k] = high / pivot;
        for w in 0..W {
            let before = if k == 0 { 0.0 } else { right[k - 1][w] };
            right[k][w] = (right[k][w] - low * before) / pivot;
        }
    }
    for k in (0..system.len() - 1).rev() {
        for w in 0..W {
            right[k][w] -= upper[k] * right[k + 1][w];
        }
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    /// Times that are not even.
    fn uneven(count: u32) -> impl Iterator<Item = f64> {
        (0..count).map(|k| f64::from(k) + 0.3 * f64::from(k * k % 3))
    }

    #[test]
    fn cubics_are_exact_to_the_second_derivative() {
        let cubic = |t: f64| {
            let x = 1.0 + t * (-2.0 + t * (0.5 - 0.1 * t));
            [x, -2.0 + t * (1.0 - 0.3 * t), 1.0 - 0.6 * t]
        };
        for count in [4, 5, 9] {
            let rows: Vec<_> = uneven(count).map(|t| (t, [cubic(t)[0], 3.0])).collect();
            let spline = Spline::new(&rows, Ends::Free);
            for t in [-0.2, 0.0, 0.7, 1.9, 2.5, 3.0] {
                for (order, exact) in cubic(t).into_iter().enumerate() {
                    assert_abs_diff_eq!(spline.at(order, t)[0], exact, epsilon = 1e-13);
                }
                assert_abs_diff_eq!(spline.at(0, t)[1], 3.0, epsilon = 1e-14);
            }
        }
    }

    #[test]
    fn place_converges_at_fourth_order_and_acceleration_at_second() {
        let error = |count: u32, ends: Ends| {
            // One sine from rest to rest, so that both ends fit it.
            let h = 2.0 / f64::from(count);
            let pi = core::f64::consts::PI;
            let exact = |t: f64| {
                let (sin, cos) = (pi * t).sin_cos();
                [1.0 - cos, pi * sin, pi * pi * cos]
            };
            let times = (0..=count).map(|k| h * f64::from(k));
            let rows: Vec<_> = times.map(|t| (t, [exact(t)[0]])).collect();
            let spline = Spline::new(&rows, ends);
            let off = |order: usize| {
                let times = (0..1000).map(|k| 2e-3 * f64::from(k));
                let off = times.map(|t| (spline.at(order, t)[0] - exact(t)[order]).abs());
                off.fold(0.0, f64::max)
            };
            [0, 1, 2].map(off)
        };
        for ends in [Ends::Free, Ends::AtRest] {
            let (coarse, fine) = (error(40, ends), error(80, ends));
            let orders: Vec<f64> = (0..3).map(|k| (coarse[k] / fine[k]).log2()).collect();
            println!("{ends:?}: orders {orders:?}");
            for (order, expected) in orders.into_iter().zip([4.0, 3.0, 2.0]) {
                assert_abs_diff_eq!(order, expected, epsilon = 0.25);
            }
        }
    }

    #[test]
    fn derivatives_are_continuous_and_ends_at_rest_rest() {
        let rows: Vec<_> = uneven(8).map(|t| (t, [(1.3 * t).sin(), t])).collect();
        for ends in [Ends::Free, Ends::AtRest] {
            let spline = Spline::new(&rows, ends);
            for &(t, x) in &rows[1..7] {
                for order in 0..3 {
                    let [before, after] = [t - 1e-9, t + 1e-9].map(|t| spline.at(order, t));
                    assert_abs_diff_eq!(before[0], after[0], epsilon = 1e-7);
                }
                assert_relative_eq!(spline.at(0, t)[0], x[0], max_relative = 1e-14);
            }
        }
        let spline = Spline::new(&rows, Ends::AtRest);
        for (t, _) in [rows[0], rows[7]] {
            assert_abs_diff_eq!(spline.at(1, t)[0], 0.0, epsilon = 1e-14);
            assert_abs_diff_eq!(spline.at(1, t)[1], 0.0, epsilon = 1e-14);
        }
    }
}
