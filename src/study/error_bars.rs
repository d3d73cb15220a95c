//! Error bars: a result with the interval that its spacing leaves, from companions of coarser spacings.
//! Eça & Hoekstra 2014 (J. Comput. Phys. 262, 104), least squares of value = limit + C dxᵖ.

use crate::output::table::significant;
use core::fmt;

/// What can end a run.
type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Orders that a fit may find and keep; beyond them the law is one of first and second order.
const ORDERS: [f64; 2] = [0.5, 2.0];
/// Fewest spacings: one more than the law has parameters.
const FEWEST: usize = 4;
/// The least span of spacings that shows an order: two, but for rounding.
const LEAST_SPAN: f64 = 1.999;
/// Factors of safety of a law that follows an order, and of any other.
const SAFETY: [f64; 2] = [1.25, 3.0];

/// A result with its error bar.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorBar {
    /// The result on the finest spacing, in its unit.
    pub value: f64,
    /// Half of the interval, in the same unit: the result for spacings that vanish is within it with about 95 %.
    pub uncertainty: f64,
    /// Where the law through all results goes for spacings that vanish.
    pub limit: f64,
    /// The order p of the law, where the results follow one from 0.5 to 2.
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
/// With n results φₖ on spacings dxₖ the law φ₀ + C dxᵖ makes the sum of squares least, with all results alike or with weights
/// 1/dxₖ, whichever scatters less. Where it finds no order from 0.5 to 2 the law is the best of φ₀ + C dx, φ₀ + C dx² and
/// φ₀ + C₁ dx + C₂ dx². With δ = |φ_law − φ₀| at the finest spacing, σ the standard deviation about the law, and
/// Δ = (max φ − min φ)/(n − 1), the uncertainty is
///
/// ```text
/// U = F δ + σ + |φ − φ_law|             if σ < Δ, F = 1.25 where an order was found and 3 where none was
/// U = 3 (σ/Δ) (δ + σ + |φ − φ_law|)     else: results that scatter more than they converge
/// ```
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

/// A law of the results, and how far they are off it.
#[derive(Clone, Copy, Debug)]
struct Law {
    limit: f64,
    finest: f64,
    scatter: f64,
    order: Option<f64>,
}

/// The law limit + Σ Cₖ (dx/X)^pₖ of one or two powers that makes the weighted sum of squares least.
fn fit(results: &[[f64; 2]], weighted: bool, powers: &[f64]) -> Option<Law> {
    let (count, largest) = (results.len(), results[0][0]);
    let weights: Vec<f64> = results
        .iter()
        .map(|[dx, _]| if weighted { largest / dx } else { 1.0 })
        .collect();
    let whole: f64 = weights.iter().sum();
    let columns = 1 + powers.len();
    let design = nalgebra::DMatrix::from_fn(count, columns, |row, column| {
        let x = results[row][0] / largest;
        let root = (weights[row] / whole).sqrt();
        root * if column == 0 {
            1.0
        } else {
            x.powf(powers[column - 1])
        }
    });
    let values = nalgebra::DVector::from_fn(count, |row, _| {
        (weights[row] / whole).sqrt() * results[row][1]
    });
    let solution = design.clone().svd(true, true).solve(&values, 1e-13).ok()?;
    let left = (&design * &solution - &values).norm_squared();
    let last = count - 1;
    let finest = (design.row(last) * &solution)[0] / (weights[last] / whole).sqrt();
    Some(Law {
        limit: solution[0],
        finest,
        scatter: left * count as f64,
        order: None,
    })
}

/// The standard deviation from the weighted sum of squares, of a law with so many parameters.
fn with_freedom(mut law: Law, count: usize, parameters: usize) -> Law {
    law.scatter = (law.scatter / (count - parameters) as f64).sqrt();
    law
}

/// The best law of a free order, if that is one that can be trusted.
fn free(results: &[[f64; 2]], weighted: bool) -> Option<Law> {
    // The sum of squares is smooth in the order: a grid, and golden sections about its best.
    let sum =
        |order: f64| fit(results, weighted, &[order]).map_or(f64::INFINITY, |law| law.scatter);
    let grid = (1..=80).map(|k| 0.05 * f64::from(k));
    let best = grid.min_by(|a, b| sum(*a).total_cmp(&sum(*b)))?;
    let (mut low, mut high) = (best - 0.05, best + 0.05);
    let golden = 0.5 * (5.0f64.sqrt() - 1.0);
    for _ in 0..60 {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        if sum(a) < sum(b) {
            high = b;
        } else {
            low = a;
        }
    }
    let order = 0.5 * (low + high);
    if !(ORDERS[0]..=ORDERS[1]).contains(&order) {
        return None;
    }
    let law = with_freedom(fit(results, weighted, &[order])?, results.len(), 3);
    Some(Law {
        order: Some(order),
        ..law
    })
}

/// The error bar of results, coarse to fine.
fn of(results: Vec<[f64; 2]>) -> ErrorBar {
    let less = |a: &Law, b: &Law| a.scatter.total_cmp(&b.scatter);
    let both = [false, true];
    let found = both
        .iter()
        .filter_map(|own| free(&results, *own))
        .min_by(less);
    let law = found.or_else(|| {
        let laws = both.iter().flat_map(|own| {
            [&[1.0][..], &[2.0], &[1.0, 2.0]].map(|powers| {
                let law = fit(&results, *own, powers)?;
                Some(with_freedom(law, results.len(), 1 + powers.len()))
            })
        });
        laws.flatten().min_by(less)
    });
    let value = results[results.len() - 1][1];
    let (least, most) = results.iter().fold((value, value), |(low, high), [_, x]| {
        (low.min(*x), high.max(*x))
    });
    let range = (most - least) / (results.len() - 1) as f64;
    // Laws of finite results always have a solution: singular values that vanish are left out.
    let law = law.unwrap_or(Law {
        limit: value,
        finest: value,
        scatter: range,
        order: None,
    });
    let (left, off) = ((law.finest - law.limit).abs(), (value - law.finest).abs());
    let uncertainty = if range == 0.0 {
        0.0
    } else if law.scatter < range {
        let safety = SAFETY[usize::from(law.order.is_none())];
        safety * left + law.scatter + off
    } else {
        3.0 * law.scatter / range * (left + law.scatter + off)
    };
    ErrorBar {
        value,
        uncertainty,
        limit: law.limit,
        order: law.order,
        scatter: law.scatter,
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
            assert_relative_eq!(own.order.expect("an order"), order, epsilon = 1e-4);
            assert_relative_eq!(own.limit, 3.0, epsilon = 1e-4);
            let left = 2.0 * 0.08f64.powf(order);
            assert_relative_eq!(own.uncertainty, 1.25 * left, max_relative = 1e-3);
        }
        // Of third order: no faster law than the second is believed, and the interval holds.
        let own = bar(|dx| 3.0 - 2.0 * dx.powi(3));
        assert!(own.order.is_none() && (own.value - 3.0).abs() < own.uncertainty);
    }

    /// Signs of a scatter decide what is found; the limit is in 19 of 20 intervals or more.
    #[test]
    fn intervals_hold_the_limit_under_scatter() {
        let (mut held, mut all) = (0, 0);
        for signs in 0..32u32 {
            for noise in [0.002, 0.01, 0.05] {
                let own = bar(|dx| {
                    let k = SPACINGS
                        .iter()
                        .position(|own| *own == dx)
                        .expect("one of them");
                    let sign = if signs >> k & 1 == 1 { 1.0 } else { -1.0 };
                    1.0 + dx + noise * sign
                });
                all += 1;
                held += usize::from((own.value - 1.0).abs() <= own.uncertainty);
            }
        }
        assert!(held * 20 >= all * 19, "{held} of {all}");
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
