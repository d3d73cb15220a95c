//! The law error = floor + C xᵖ through measured errors, with intervals, and the refusal to say more than they support.
//! Intervals are of the profile likelihood.
//!
//! With logarithms yᵢ of n measured values, the best floor F ≥ 0, factor C > 0 and order p in \[0.1, 6\] make
//! S = Σ (yᵢ − ln(F + C xᵢᵖ))² least. A parameter, or a prediction, lies within 90 % in the range that it takes over all
//! laws with S ≤ S₀ + t² s² (profile likelihood; Venzon & Moolgavkar 1988), where S₀ is the least sum, ν = n − 3 + 2, t Student's quantile for ν
//! degrees of freedom, and
//!
//! ```text
//! s² = (S₀ + 2 · 0.05²) / ν
//! ```
//!
//! As if two more values had been seen, each 5 % off: three values leave no scatter to judge by, and no law
//! of this form is better than that before its spacings are fine. With 3 % for 5 %, 83 of 100 finest runs of
//! [accuracy and cost](crate#pages) were in the intervals of the laws through the coarser ones, and now 93 are. The search runs over
//! grids of p and F/C, the last just around the laws within 90 %, so the same values give the same answer to the bit.
//!
//! What is coarse follows other laws: there an error has parts of several orders. So values at the largest x are left out, one
//! x after another, as long as the rest scatter by more than 3 % about their law and have four x or more. An order at the
//! edge of what is tried is none, and refused.

use super::refusal::Refusal;

/// Scatter that is presumed before any is seen, as a part of the value, and the weight of that in values.
const PRESUMED: (f64, f64) = (0.05, 2.0);
/// Scatter beyond which the values at the largest x are left out, while as many different x are left as parameters.
const DESCRIBED: (f64, usize) = (0.03, 3);
/// Scatter about the law beyond which it says nothing.
const MOST_SCATTER: f64 = 0.25;
/// How far beyond the values a law is followed.
pub(super) const REACH: f64 = 4.0;
/// Orders that are tried.
const ORDERS: [f64; 2] = [0.1, 6.0];
/// F/C that are tried with x over its largest: from nothing, below which size it is told apart linearly, and the most.
const FLOORS: [f64; 2] = [1e-4, 1e2];
/// The least span of x that shows an order: two, but for rounding.
const LEAST_SPAN: f64 = 1.999;
/// Points of a grid along order and floor.
const GRID: usize = 60;

/// A value with the interval that holds it with 90 %.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Estimate {
    /// The best value.
    pub value: f64,
    /// The lower end.
    pub low: f64,
    /// The upper end, infinite where nothing bounds it.
    pub high: f64,
}

impl Estimate {
    fn of(value: f64) -> Self {
        Self {
            value,
            low: value,
            high: value,
        }
    }
    fn include(&mut self, value: f64) {
        self.low = self.low.min(value);
        self.high = self.high.max(value);
    }
}

/// value = F + C (x/X)ᵖ, X being the largest x.
#[derive(Clone, Copy, Debug)]
struct Law {
    order: f64,
    /// F/C.
    floor: f64,
    /// ln C.
    factor: f64,
    sum: f64,
}

impl Law {
    /// ln of the value at x/X.
    fn at(&self, x: f64) -> f64 {
        self.factor + (self.floor + x.powf(self.order)).ln()
    }
}

/// A law with floor through values, and what it supports.
///
/// ```
/// use meshfree::study::work_precision::PowerFit;
/// let spacings = [0.8, 0.4, 0.2, 0.1, 0.05];
/// let errors = spacings.map(|dx: f64| 0.001 + 0.5 * dx.powi(2));
/// let fit = PowerFit::of(&spacings, &errors)?;
/// assert!((fit.order().value - 2.0).abs() < 0.01 && (fit.floor().value - 0.001).abs() < 2e-5);
/// // Twice as fine as the finest: hardly more than the floor.
/// assert!((fit.at(0.025)?.value - 0.0013).abs() < 2e-5);
/// // And nothing eight times as fine, nor from two spacings.
/// assert!(fit.at(0.006).is_err() && PowerFit::of(&spacings[..2], &errors[..2]).is_err());
/// # Ok::<(), meshfree::study::work_precision::Refusal>(())
/// ```
#[derive(Clone, Debug)]
pub struct PowerFit {
    /// x/X and ln of the values.
    points: Vec<(f64, f64)>,
    /// Least and largest x.
    range: (f64, f64),
    best: Law,
    /// Laws within 90 %, each with its least and its largest factor.
    all: Vec<Law>,
    order: Estimate,
    floor: Estimate,
    factor: Estimate,
}

impl PowerFit {
    /// The law through `values` at `x`: errors, as parts of the scale of their quantity, on spacings \[m\].
    ///
    /// # Errors
    /// If there are fewer than three different x, they span less than a factor of two, a value is not positive and
    /// finite, values grow by more than a fifth where x falls to its least, they scatter about the law by more than a
    /// quarter, or its order is at the edge of what is tried, 0.1 to 6.
    pub fn of(x: &[f64], values: &[f64]) -> Result<Self, Refusal> {
        let good = |v: &f64| v.is_finite() && *v > 0.0;
        for k in 0..x.len().max(values.len()) {
            let [spacing, value] = [x, values].map(|own| own.get(k).copied().unwrap_or(f64::NAN));
            if !good(&spacing) || !good(&value) {
                return Err(Refusal::NoLogarithm {
                    what: "error",
                    unit: "",
                    spacing,
                    value,
                });
            }
        }
        let mut sorted = x.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted.dedup();
        if sorted.len() < 3 {
            return Err(Refusal::FewSpacings { have: sorted.len() });
        }
        let range = (sorted[0], sorted[sorted.len() - 1]);
        if range.1 < LEAST_SPAN * range.0 {
            return Err(Refusal::NarrowSpacings {
                span: range.1 / range.0,
            });
        }
        let mean_at = |at: f64| {
            let own = x.iter().zip(values).filter(|(x, _)| **x == at);
            let (sum, count) = own.fold((0.0, 0.0), |(s, n), (_, v)| (s + v, n + 1.0));
            sum / count
        };
        let (coarse, fine) = (mean_at(range.1), mean_at(range.0));
        if fine > 1.2 * coarse {
            return Err(Refusal::Grows {
                coarse,
                fine,
                spacings: [range.1, range.0],
            });
        }
        let (mut range, mut largest) = (range, sorted.len());
        let (points, best) = loop {
            let points: Vec<_> = (x.iter().zip(values))
                .filter(|(x, _)| **x <= range.1)
                .map(|(x, v)| (x / range.1, v.ln()))
                .collect();
            let best = best(&points);
            let scatter = (best.sum / points.len() as f64).sqrt();
            // Without the largest of them.
            let fewer = largest - 1;
            if scatter <= DESCRIBED.0
                || fewer < DESCRIBED.1
                || sorted[fewer - 1] < LEAST_SPAN * range.0
            {
                break (points, best);
            }
            (range.1, largest) = (sorted[fewer - 1], fewer);
        };
        let n = points.len() as f64;
        let scatter = (best.sum / n).sqrt();
        if scatter > MOST_SCATTER {
            return Err(Refusal::Scatter { scatter });
        }
        // Where the floor is all that is seen no order matters.
        let edge = 1e-3 * (ORDERS[1] - ORDERS[0]);
        let at_edge = best.order < ORDERS[0] + edge || best.order > ORDERS[1] - edge;
        if at_edge && (points.iter()).any(|(x, _)| (best.at(*x) - best.at(0.0)).abs() > DESCRIBED.0)
        {
            return Err(Refusal::NoOrder { order: best.order });
        }
        let freedom = n - 3.0 + PRESUMED.1;
        let variance = (best.sum + PRESUMED.1 * PRESUMED.0 * PRESUMED.0) / freedom;
        let most = best.sum + variance * student_90(freedom as usize).powi(2);
        let all = laws_within(&points, &best, most);
        let over = |read: &dyn Fn(&Law) -> f64| {
            let mut estimate = Estimate::of(read(&best));
            for law in &all {
                estimate.include(read(law));
            }
            estimate
        };
        Ok(Self {
            range,
            best,
            order: over(&|law| law.order),
            floor: over(&|law| law.floor * law.factor.exp()),
            factor: over(&|law| law.factor.exp() / range.1.powf(law.order)),
            points,
            all,
        })
    }

    /// The order p.
    #[must_use]
    pub fn order(&self) -> Estimate {
        self.order
    }
    /// The floor F, in the unit of the values.
    #[must_use]
    pub fn floor(&self) -> Estimate {
        self.floor
    }
    /// The factor C.
    #[must_use]
    pub fn factor(&self) -> Estimate {
        self.factor
    }
    /// Root mean square of the values about the law, as a part of them.
    #[must_use]
    pub fn scatter(&self) -> f64 {
        (self.best.sum / self.points.len() as f64).sqrt()
    }
    /// Least and largest x of the values that the law is of: of what is coarser it says nothing.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        self.range
    }

    /// The value at `x`.
    ///
    /// # Errors
    /// If `x` is more than four times below or above those that were measured.
    pub fn at(&self, x: f64) -> Result<Estimate, Refusal> {
        self.within_reach(x)?;
        let x = x / self.range.1;
        let mut log = Estimate::of(self.best.at(x));
        for law in &self.all {
            log.include(law.at(x));
        }
        Ok(Estimate {
            value: log.value.exp(),
            low: log.low.exp(),
            high: log.high.exp(),
        })
    }

    /// The x at which the law has this value. The lower end of its interval is zero if a floor above the value is within
    /// the bounds.
    ///
    /// # Errors
    /// If the floor is not below the value, or x is more than four times below or above those that were measured.
    pub fn inverse(&self, value: f64) -> Result<Estimate, Refusal> {
        let at = |law: &Law| {
            let rest = value / law.factor.exp() - law.floor;
            if rest > 0.0 {
                self.range.1 * rest.powf(1.0 / law.order)
            } else {
                0.0
            }
        };
        let mut x = Estimate::of(at(&self.best));
        if x.value == 0.0 {
            return Err(Refusal::Floor {
                wanted: value,
                floor: self.floor,
            });
        }
        self.within_reach(x.value)?;
        for law in &self.all {
            x.include(at(law));
        }
        Ok(x)
    }

    fn within_reach(&self, x: f64) -> Result<(), Refusal> {
        let (least, most) = self.range;
        // What is written as a quarter may be a little less by rounding.
        if x * REACH < least * 0.999_999 || x > most * REACH * 1.000_001 || !x.is_finite() {
            return Err(Refusal::TooFar {
                what: "spacing",
                unit: "m",
                wanted: x,
                from: least / REACH,
                to: most * REACH,
            });
        }
        Ok(())
    }
}

/// The law of this order and floor with the factor that suits it best.
fn with(points: &[(f64, f64)], order: f64, floor: f64) -> Law {
    let n = points.len() as f64;
    let off = |&(x, y): &(f64, f64)| y - (floor + x.powf(order)).ln();
    let (sum, squares) = points
        .iter()
        .map(off)
        .fold((0.0, 0.0), |(s, q), d| (s + d, q + d * d));
    let factor = sum / n;
    Law {
        order,
        floor,
        factor,
        sum: (squares - n * factor * factor).max(0.0),
    }
}

/// Order, and floor on a scale that is linear below the first of [`FLOORS`] and logarithmic above.
type Place = [f64; 2];

fn bounds() -> [Place; 2] {
    [
        [ORDERS[0], 0.0],
        [ORDERS[1], (FLOORS[1] / FLOORS[0]).asinh()],
    ]
}

fn law_at(points: &[(f64, f64)], [order, floor]: Place) -> Law {
    with(points, order, FLOORS[0] * floor.sinh())
}

fn place_of(law: &Law) -> Place {
    [law.order, (law.floor / FLOORS[0]).asinh()]
}

/// The places of a grid, its edges among them.
fn grid([low, high]: [Place; 2]) -> impl Iterator<Item = Place> {
    let along = move |d: usize, k: usize| low[d] + (high[d] - low[d]) * k as f64 / GRID as f64;
    (0..=GRID).flat_map(move |j| (0..=GRID).map(move |k| [along(0, j), along(1, k)]))
}

/// The best law: of the grid, then by steps that halve.
fn best(points: &[(f64, f64)]) -> Law {
    let [low, high] = bounds();
    let mut best = with(points, 1.0, 0.0);
    for place in grid([low, high]) {
        let law = law_at(points, place);
        // A floor that improves nothing is none.
        if law.sum < best.sum * (1.0 - 1e-9) {
            best = law;
        }
    }
    let mut step = [0, 1].map(|d| (high[d] - low[d]) / GRID as f64);
    while step[0] > 1e-7 {
        let [order, floor] = place_of(&best);
        let mut better = false;
        for (o, f) in [-1.0, 0.0, 1.0]
            .into_iter()
            .flat_map(|o| [-1.0, 0.0, 1.0].map(|f| (o, f)))
        {
            let law = law_at(
                points,
                [
                    (order + o * step[0]).clamp(low[0], high[0]),
                    (floor + f * step[1]).clamp(low[1], high[1]),
                ],
            );
            if law.sum < best.sum * (1.0 - 1e-12) {
                (best, better) = (law, true);
            }
        }
        if !better {
            step = step.map(|step| 0.5 * step);
        }
    }
    best
}

/// All laws whose sum is at most this, on a grid that is fitted around them.
fn laws_within(points: &[(f64, f64)], best: &Law, most: f64) -> Vec<Law> {
    let [low, high] = bounds();
    let centre = place_of(best);
    let mut edges = [
        [0, 1].map(|d| (centre[d] - 0.05 * (high[d] - low[d])).max(low[d])),
        [0, 1].map(|d| (centre[d] + 0.05 * (high[d] - low[d])).min(high[d])),
    ];
    for _ in 0..12 {
        // What of the grid is within, and one more of its steps to every side; twice the width where it touches an edge.
        let mut inside = [centre; 2];
        for place in grid(edges) {
            if law_at(points, place).sum <= most {
                for d in 0..2 {
                    inside[0][d] = inside[0][d].min(place[d]);
                    inside[1][d] = inside[1][d].max(place[d]);
                }
            }
        }
        let mut next = edges;
        for d in 0..2 {
            let width = edges[1][d] - edges[0][d];
            let step = width / GRID as f64;
            let room = |touches: bool| if touches { 0.5 * width } else { step };
            next[0][d] = (inside[0][d] - room(inside[0][d] - edges[0][d] < 0.5 * step)).max(low[d]);
            next[1][d] =
                (inside[1][d] + room(edges[1][d] - inside[1][d] < 0.5 * step)).min(high[d]);
        }
        edges = next;
    }
    let n = points.len() as f64;
    let laws = grid(edges)
        .map(|place| law_at(points, place))
        .chain([*best]);
    let within = laws.filter(|law| law.sum <= most);
    let both = within.flat_map(|law| {
        let off = ((most - law.sum) / n).sqrt();
        [-off, off].map(|off| Law {
            factor: law.factor + off,
            ..law
        })
    });
    both.collect()
}

/// Two-sided 90 % quantile of Student's t.
pub(in crate::study) fn student_90(freedom: usize) -> f64 {
    const TABLE: [f64; 10] = [
        6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833, 1.812,
    ];
    match TABLE.get(freedom.wrapping_sub(1)) {
        Some(&quantile) => quantile,
        None => 1.645 + 1.67 / freedom as f64,
    }
}

#[cfg(test)]
mod tests;
