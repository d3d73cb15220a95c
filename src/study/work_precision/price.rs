//! What a spacing costs in time: pairs, which a spacing tells to a few per cent, times what a pair takes.
//! A law of times alone takes what small runs spend beside their pairs for the growth of the large ones.
//!
//! Runs at finenesses x (one over the spacing) have counted pairs P and taken time T. Between runs both are straight in
//! logarithms. Beyond the finest run, with q the order of P between the two finest,
//!
//! ```text
//! T(x) = (T/P)ₙ · Pₙ (x/xₙ)^q
//! ```
//!
//! and before the coarsest in the same way. Its 90 % are t √(s² + Δq² ln²(x/xₙ)): s is the scatter of T/P over the last three
//! runs, as if two more had been seen, each 5 % off; Δq how far q differs from the order between the second and the third
//! finest; t Student's quantile. Where no pairs are counted, times stand for them.

use super::fit::{Estimate, REACH, student_90};
use super::refusal::Refusal;
use super::report::Row;

/// Scatter of the time of a pair that is presumed before any is seen, and the weight of that in runs.
const PRESUMED: (f64, f64) = (0.05, 2.0);
/// Runs whose times of a pair tell its scatter.
const LAST: usize = 3;

/// A run: logarithms of fineness, pairs and time.
#[derive(Clone, Copy, Debug)]
struct Point {
    x: f64,
    pairs: f64,
    time: f64,
}

/// The time \[s\] of runs of a method by their fineness, one over the spacing \[1/m\].
#[derive(Clone, Debug)]
pub struct Price {
    /// From coarse to fine, three at least.
    points: Vec<Point>,
    /// Variance of the logarithm of the time of a pair, and Student's quantile for it.
    scatter: (f64, f64),
    order: Estimate,
    /// How far the order has changed on the way to the finest runs.
    bend: f64,
}

impl Price {
    pub(super) fn of(rows: &[&Row]) -> Result<Self, Refusal> {
        let counted = rows.iter().all(|row| row.work.pairs > 0);
        let mut points: Vec<_> = (rows.iter())
            .map(|row| Point {
                x: -row.spacing.ln(),
                pairs: if counted {
                    (row.work.pairs as f64).ln()
                } else {
                    row.seconds.ln()
                },
                time: row.seconds.ln(),
            })
            .collect();
        let is_finite = |own: &Point| own.x.is_finite() && own.time.is_finite();
        if let Some(at) = points.iter().position(|own| !is_finite(own)) {
            return Err(Refusal::NoLogarithm {
                what: "time",
                unit: " s",
                spacing: rows[at].spacing,
                value: rows[at].seconds,
            });
        }
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        points.dedup_by(|a, b| a.x == b.x);
        let &[.., before, middle, last] = points.as_slice() else {
            return Err(Refusal::FewSpacings { have: points.len() });
        };
        let slope = |a: Point, b: Point| (b.pairs - a.pairs) / (b.x - a.x);
        let (q, bend) = (
            slope(middle, last),
            slope(middle, last) - slope(before, middle),
        );
        let of_a_pair = points
            .iter()
            .rev()
            .take(LAST)
            .map(|own| own.time - own.pairs);
        let mean = of_a_pair.clone().sum::<f64>() / LAST as f64;
        let sum: f64 = of_a_pair.map(|own| (own - mean).powi(2)).sum();
        let freedom = LAST as f64 - 1.0 + PRESUMED.1;
        let variance = (sum + PRESUMED.1 * PRESUMED.0.powi(2)) / freedom;
        Ok(Self {
            points,
            scatter: (variance, student_90(freedom as usize)),
            order: Estimate {
                value: q,
                low: q - bend.abs(),
                high: q + bend.abs(),
            },
            bend,
        })
    }

    /// The order q of the work in the fineness at the finest runs, by as much as it changed on the way there.
    #[must_use]
    pub fn order(&self) -> Estimate {
        self.order
    }

    /// Least and largest fineness of the runs \[1/m\].
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        let ends = [0, self.points.len() - 1];
        let [least, most] = ends.map(|k| self.points[k].x.exp());
        (least, most)
    }

    /// The time \[s\] of a run of this fineness \[1/m\].
    ///
    /// # Errors
    /// If it is more than four times below or above those that were run.
    pub fn at(&self, fineness: f64) -> Result<Estimate, Refusal> {
        let (least, most) = self.range();
        if !(least / REACH * 0.999_999..=most * REACH * 1.000_001).contains(&fineness) {
            return Err(Refusal::TooFar {
                what: "fineness",
                unit: "1/m",
                wanted: fineness,
                from: least / REACH,
                to: most * REACH,
            });
        }
        let x = fineness.ln();
        let value = self.logarithm(x);
        let beyond = (x - most.ln()).max(least.ln() - x).max(0.0);
        let (variance, quantile) = self.scatter;
        let off = quantile * (variance + (self.bend * beyond).powi(2)).sqrt();
        let [value, low, high] = [value, value - off, value + off].map(f64::exp);
        Ok(Estimate { value, low, high })
    }

    /// The fineness \[1/m\] of a run of so many seconds.
    ///
    /// # Errors
    /// If it is more than four times below or above those that were run.
    pub fn inverse(&self, seconds: f64) -> Result<f64, Refusal> {
        let (least, most) = self.range();
        let ends = [least / REACH, most * REACH];
        let [mut low, mut high] = ends.map(f64::ln);
        let wanted = seconds.ln();
        let beyond = |wanted| Refusal::TooFar {
            what: "fineness",
            unit: "1/m",
            wanted,
            from: ends[0],
            to: ends[1],
        };
        if self.logarithm(high) < wanted {
            return Err(beyond(f64::INFINITY));
        }
        if self.logarithm(low) > wanted {
            return Err(beyond(0.0));
        }
        // The finest that takes no longer: times that scatter need not rise with every run.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.logarithm(middle) > wanted {
                high = middle;
            } else {
                low = middle;
            }
        }
        Ok(low.exp())
    }

    /// Logarithm of the time at a logarithm of fineness.
    fn logarithm(&self, x: f64) -> f64 {
        let last = self.points.len() - 1;
        let after = self.points.partition_point(|own| own.x < x).clamp(1, last);
        let (a, b) = (self.points[after - 1], self.points[after]);
        let share = (x - a.x) / (b.x - a.x);
        if (0.0..=1.0).contains(&share) {
            return a.time + share * (b.time - a.time);
        }
        let pairs = a.pairs + share * (b.pairs - a.pairs);
        let near = if share > 1.0 { b } else { a };
        near.time - near.pairs + pairs
    }
}
