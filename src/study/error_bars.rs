//! Error bars: a result with the interval that its spacing leaves, from companions of coarser spacings.
//! Laws after Richardson 1911 by least squares as in Eça & Hoekstra 2014 (J. Comput. Phys. 262, 104); intervals of Venzon & Moolgavkar 1988.

use super::work_precision::student_90;
use crate::output::table::significant;
use core::fmt;

/// What can end a run.
type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Orders that are tried, and into how many steps their range is cut.
const ORDERS: [f64; 2] = [0.5, 2.0];
const STEPS: usize = 60;
/// Fewest spacings: one more than the law has parameters.
const FEWEST: usize = 4;
/// The least span of spacings that shows an order: two, but for rounding.
const LEAST_SPAN: f64 = 1.999;
/// Scatter that is presumed before any is seen, as a part of the mean change from one spacing to the next.
const PRESUMED: f64 = 0.1;

/// A result with its error bar.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ErrorBar {
    /// The result on the finest spacing, in its unit.
    pub value: f64,
    /// Half of the interval, in the same unit: the result for spacings that vanish is within it with 90 %.
    pub uncertainty: f64,
    /// Where the law through all results goes for spacings that vanish.
    pub limit: f64,
    /// The order p of the best law; none where that is at the edge of what is tried, 0.5 to 2.
    pub order: Option<f64>,
    /// Standard deviation of the results about the law.
    pub scatter: f64,
    /// All spacings \[m\] with their results, coarse to fine.
    pub results: Vec<[f64; 2]>,
}

impl fmt::Display for ErrorBar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [value, by] = [self.value, self.uncertainty].map(|x| significant(x, 3));
        write!(f, "{value} ± {by}")?;
        match self.order {
            Some(order) => write!(f, ", order {order:.1}"),
            None => write!(f, ", no clear order"),
        }
    }
}

/// Why a result has no error bar.
#[derive(Debug, thiserror::Error)]
pub enum NoErrorBar {
    /// Too few spacings that differ.
    #[error(
        "{have} spacings that differ: give at least four, which is one more than the law has parameters"
    )]
    FewSpacings {
        /// How many there are.
        have: usize,
    },
    /// Spacings too close to each other.
    #[error("spacings span a factor of {span:.2}: give at least two")]
    NarrowSpacings {
        /// The largest over the least.
        span: f64,
    },
    /// A spacing, or the result of one, that is no number.
    #[error(
        "the spacing {spacing} m has the result {value}: both have to be finite, and the spacing larger than 0"
    )]
    NotFinite {
        /// The spacing \[m\].
        spacing: f64,
        /// The result.
        value: f64,
    },
    /// A run that ended early.
    #[error("the run with the spacing {spacing} m failed")]
    Failed {
        /// The spacing \[m\].
        spacing: f64,
        /// Why.
        source: Failure,
    },
}

/// Runs a scene on all of these spacings \[m\], coarse to fine, and puts an error bar on the result of the finest.
///
/// With n results φₖ on spacings dxₖ, laws φ₀ + C dxᵖ of orders p from 0.5 to 2 leave sums of squares S. The limit φ₀ is within the
/// uncertainty with 90 %: that is how far it is from the finest result at most, over all laws with S ≤ S₀ + t² s² (profile likelihood), where
/// S₀ is the least sum, ν = n − 3 + 2, t Student's quantile for ν degrees of freedom, and
///
/// ```text
/// s² = (S₀ + 2 (0.1 Δ)²)/ν,   Δ = (max φ − min φ)/(n − 1)
/// ```
///
/// as if two more results had been seen, each a tenth of the mean change off: few results leave no scatter to judge by.
///
/// It is what the spacing leaves: errors of models, of the step, and of kernels that do not reach far enough are no part of it.
/// Companions of 1.26, 1.6 and 2 times the spacing take 0.6 of the time of the finest run in 3D, where time goes with the fourth power of the
/// spacing (0.40 + 0.15 + 0.06), and 1.3 in 1D.
///
/// ```
/// use meshfree::prelude::*;
/// use meshfree::study::with_error_bar;
///
/// // The momentum that a copper rod has given to another after two microseconds [kg m/s, per m² of section].
/// let given = with_error_bar([4e-4, 3.2e-4, 2.5e-4, 2e-4], |dx| {
///     let rod = |name, x| Body::block(name, catalogue::copper(), [x], [x + 0.01], dx);
///     let scene = Scene::<f64, 1>::new(schemes::impact());
///     let scene = scene.body(rod("striker", 0.0).velocity([20.0])).body(rod("target", 0.01));
///     let mut rods = scene.build()?;
///     rods.run_until(2e-6)?;
///     Ok(rods.body("target")?.map(|p| p.mass() * p.velocity()[0]).sum::<f64>())
/// })?;
/// println!("{given} kg/(m s)");
/// assert!(given.uncertainty < 0.1 * given.value);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If fewer than four spacings differ, if they span less than a factor of two, and if a run fails or gives no number.
pub fn with_error_bar(
    spacings: impl IntoIterator<Item = f64>,
    mut run: impl FnMut(f64) -> Result<f64, Failure>,
) -> Result<ErrorBar, NoErrorBar> {
    let mut spacings: Vec<f64> = spacings.into_iter().collect();
    spacings.sort_by(|a, b| b.total_cmp(a));
    spacings.dedup();
    if let Some(&spacing) = spacings.iter().find(|x| !(x.is_finite() && **x > 0.0)) {
        return Err(NoErrorBar::NotFinite {
            spacing,
            value: f64::NAN,
        });
    }
    let have = spacings.len();
    if have < FEWEST {
        return Err(NoErrorBar::FewSpacings { have });
    }
    let span = spacings[0] / spacings[have - 1];
    if span < LEAST_SPAN {
        return Err(NoErrorBar::NarrowSpacings { span });
    }
    let mut results = Vec::with_capacity(have);
    for spacing in spacings {
        let value = run(spacing).map_err(|source| NoErrorBar::Failed { spacing, source })?;
        if !value.is_finite() {
            return Err(NoErrorBar::NotFinite { spacing, value });
        }
        results.push([spacing, value]);
    }
    Ok(of(results))
}

/// The law limit + C (dx/X)ᵖ of one order p, X being the largest spacing.
#[derive(Clone, Copy, Debug)]
struct Law {
    order: f64,
    limit: f64,
    /// The sum of squares that it leaves, and what the square of a change of the limit adds to it.
    left: f64,
    stiffness: f64,
}

/// The law of an order through results, by least squares.
fn law(results: &[[f64; 2]], order: f64) -> Law {
    let (count, largest) = (results.len() as f64, results[0][0]);
    let powers = || results.iter().map(|[dx, _]| (dx / largest).powf(order));
    let (sum, squares) = powers().fold((0.0, 0.0), |(s, q), g| (s + g, q + g * g));
    let mean = results.iter().map(|[_, value]| value).sum::<f64>() / count;
    // About the means, so that nothing is lost where results hardly differ.
    let spread = squares - sum * sum / count;
    let along = powers()
        .zip(results)
        .map(|(g, [_, value])| (g - sum / count) * (value - mean));
    let factor = along.sum::<f64>() / spread;
    let limit = mean - factor * sum / count;
    let off = powers()
        .zip(results)
        .map(|(g, [_, value])| value - limit - factor * g);
    Law {
        order,
        limit,
        left: off.map(|off| off * off).sum(),
        stiffness: count * spread / squares,
    }
}

/// The error bar of results, coarse to fine.
fn of(results: Vec<[f64; 2]>) -> ErrorBar {
    let count = results.len();
    let value = results[count - 1][1];
    let [first, last] = ORDERS;
    let laws: Vec<Law> = (0..=STEPS)
        .map(|k| law(&results, first + (last - first) * k as f64 / STEPS as f64))
        .collect();
    let best = laws
        .iter()
        .copied()
        .reduce(|best, own| if own.left < best.left { own } else { best });
    let best = best.unwrap_or_else(|| law(&results, first));
    let values = || results.iter().map(|[_, value]| *value);
    let range = values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min);
    let step = range / (count - 1) as f64;
    let freedom = count - 3 + 2;
    let variance = (best.left + 2.0 * (PRESUMED * step).powi(2)) / freedom as f64;
    let most = best.left + variance * student_90(freedom).powi(2);
    let uncertainty = laws
        .iter()
        .filter(|law| law.left <= most)
        .fold(0.0, |bar: f64, law| {
            bar.max((value - law.limit).abs() + ((most - law.left) / law.stiffness).sqrt())
        });
    ErrorBar {
        value,
        uncertainty,
        limit: best.limit,
        order: (first < best.order && best.order < last).then_some(best.order),
        scatter: (best.left / (count - 3) as f64).sqrt(),
        results,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const SPACINGS: [f64; 5] = [0.2, 0.16, 0.125, 0.1, 0.08];

    fn bar(law: impl Fn(f64) -> f64) -> ErrorBar {
        with_error_bar(SPACINGS, |dx| Ok(law(dx))).expect("five spacings")
    }

    #[test]
    fn an_order_is_found_with_its_limit() {
        for order in [0.6, 1.0, 1.7] {
            let own = bar(|dx| 3.0 - 2.0 * dx.powf(order));
            assert_relative_eq!(own.order.expect("an order"), order, epsilon = 0.013);
            assert_relative_eq!(own.limit, 3.0, epsilon = 0.01);
            let left = 2.0 * 0.08f64.powf(order);
            assert!((1.0..4.0).contains(&(own.uncertainty / left)), "{own}");
        }
        // Of third order: no law faster than the second is tried, and the interval holds.
        let own = bar(|dx| 3.0 - 2.0 * dx.powi(3));
        assert!(own.order.is_none() && (own.value - 3.0).abs() < own.uncertainty);
    }

    /// All signs of a scatter, from much less than the change of 0.12 to half of it.
    #[test]
    fn nine_of_ten_intervals_hold_the_limit_under_scatter() {
        let (mut held, mut all) = (0, 0);
        for noise in [0.0005, 0.002, 0.005, 0.01, 0.02, 0.05] {
            for signs in 0..32u32 {
                let own = bar(|dx| {
                    let k = SPACINGS
                        .iter()
                        .position(|own| *own == dx)
                        .expect("one of them");
                    let sign = if signs >> k & 1 == 1 { 1.0 } else { -1.0 };
                    1.0 + dx + noise * sign
                });
                held += u32::from((own.value - 1.0).abs() <= own.uncertainty);
                all += 1;
            }
        }
        println!("{held} of {all}");
        assert!(held * 10 >= all * 9, "{held} of {all}");
        // A control: the difference of the two finest results is no error bar.
        let own = bar(|dx| 1.0 + dx);
        let [before, last] = [own.results[3][1], own.results[4][1]];
        assert!((before - last).abs() < own.value - 1.0 && own.value - 1.0 < own.uncertainty);
    }

    #[test]
    fn what_does_not_change_has_no_error_and_what_scatters_a_large_one() {
        assert_eq!(bar(|_| 2.0).uncertainty, 0.0);
        let own = bar(|dx| if dx == 0.125 { 1.3 } else { 1.0 });
        assert!(own.uncertainty > 0.3, "{own}");
    }

    #[test]
    fn reasons_are_told() {
        let few = with_error_bar([0.2, 0.1, 0.1], |_| Ok(1.0));
        assert!(matches!(few, Err(NoErrorBar::FewSpacings { have: 2 })));
        let narrow = with_error_bar([0.2, 0.19, 0.18, 0.17], |_| Ok(1.0));
        assert!(matches!(narrow, Err(NoErrorBar::NarrowSpacings { .. })));
        for spacing in [-0.1, 0.0, f64::NAN] {
            let bad = with_error_bar([0.2, 0.1, 0.05, spacing], |_| Ok(1.0));
            assert!(matches!(bad, Err(NoErrorBar::NotFinite { .. })));
        }
        let lost = with_error_bar(SPACINGS, |dx| Ok(if dx < 0.1 { f64::NAN } else { 1.0 }));
        assert!(lost.is_err_and(|why| why.to_string().contains("0.08")));
        let failed = with_error_bar(
            SPACINGS,
            |dx| if dx < 0.15 { Err("no".into()) } else { Ok(1.0) },
        );
        assert!(matches!(failed, Err(NoErrorBar::Failed { spacing, .. }) if spacing == 0.125));
    }
}
