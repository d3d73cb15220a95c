//! Norms and features of profiles and histories: the error of a run in numbers.
//! Differences, plateau mean, rise time, overshoot, arrival, and the observed order of convergence.
//!
//! Of samples aᵢ against bᵢ with weights wᵢ (cell widths, masses or times between samples)
//!
#![doc = include_str!("../../docs/equations/norms.html")]
//!
//! The observed order q of an error C hᵠ is the slope of the least-squares line of ln(error) on ln(h).
//!
//! ```
//! use meshfree::study::norms::{Norms, observed_order};
//! let error = Norms::of_difference(&[1.0, 2.0, 3.0], &[1.0, 2.5, 3.0])?;
//! assert_eq!(error.linf, 0.5);
//! let order = observed_order(&[0.1, 0.05, 0.025], &[4e-3, 1e-3, 2.5e-4])?;
//! assert!((order.order - 2.0).abs() < 1e-12);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::{StudyError, finite, positive};

/// The three usual norms of a difference, in the unit of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Norms {
    /// Weighted mean of |a − b|.
    pub l1: f64,
    /// Weighted root mean square of a − b.
    pub l2: f64,
    /// Largest |a − b|.
    pub linf: f64,
}

impl Norms {
    /// Norms of `values − expected` with equal weights.
    ///
    /// # Errors
    /// If the lists are empty, differ in length or hold a value that is not finite.
    pub fn of_difference(values: &[f64], expected: &[f64]) -> Result<Self, StudyError> {
        Self::weighted(values, expected, &vec![1.0; values.len()])
    }

    /// Norms of `values − expected` with the given weights.
    ///
    /// # Errors
    /// As [`of_difference`](Self::of_difference), or if the weights do not add up to more than zero.
    pub fn weighted(values: &[f64], expected: &[f64], weights: &[f64]) -> Result<Self, StudyError> {
        same_length("values", values, "expected values", expected)?;
        same_length("values", values, "weights", weights)?;
        let total = positive("the sum of the weights", weights.iter().sum())?;
        let (mut l1, mut l2, mut linf) = (0.0, 0.0, 0.0f64);
        for ((value, expected), weight) in values.iter().zip(expected).zip(weights) {
            let difference = finite("a difference of samples", value - expected)?.abs();
            l1 += weight * difference;
            l2 += weight * difference * difference;
            linf = linf.max(difference);
        }
        Ok(Self {
            l1: l1 / total,
            l2: (l2 / total).sqrt(),
            linf,
        })
    }
}

fn same_length(
    first: &'static str,
    a: &[f64],
    second: &'static str,
    b: &[f64],
) -> Result<(), StudyError> {
    if a.len() == b.len() {
        return Ok(());
    }
    Err(StudyError::Lengths {
        first,
        first_count: a.len(),
        second,
        second_count: b.len(),
    })
}

fn missing<T>(feature: &'static str, action: &'static str) -> Result<T, StudyError> {
    Err(StudyError::Missing { feature, action })
}

/// Mean of a sampled function over \[`from`, `to`\] by the trapezoidal rule, with linear interpolation
/// at the two ends. `positions` (places or times) must increase.
///
/// # Errors
/// If the lists differ in length or the interval is empty or not covered.
pub fn plateau_mean(
    positions: &[f64],
    values: &[f64],
    from: f64,
    to: f64,
) -> Result<f64, StudyError> {
    same_length("positions", positions, "values", values)?;
    positive("the length of the interval", to - from)?;
    let (Some(&first), Some(&last)) = (positions.first(), positions.last()) else {
        return missing("interval", "give at least two samples");
    };
    for end in [from, to] {
        if !(first..=last).contains(&end) {
            return Err(StudyError::OutOfRange {
                quantity: "end of the averaging interval",
                value: end,
                from: first,
                to: last,
            });
        }
    }
    let mut integral = 0.0;
    for k in 1..positions.len() {
        let (a, b) = (positions[k - 1], positions[k]);
        let (low, high) = (a.max(from), b.min(to));
        if high > low {
            let slope = (values[k] - values[k - 1]) / (b - a);
            let middle = 0.5 * (low + high);
            integral += (values[k - 1] + slope * (middle - a)) * (high - low);
        }
    }
    Ok(integral / (to - from))
}

/// Position of the first crossing of `level`, in either direction, by linear interpolation.
///
/// # Errors
/// If the lists differ in length or the level is not crossed.
pub fn first_crossing(positions: &[f64], values: &[f64], level: f64) -> Result<f64, StudyError> {
    same_length("positions", positions, "values", values)?;
    for k in 1..positions.len() {
        let (a, b) = (values[k - 1] - level, values[k] - level);
        if (a < 0.0) != (b < 0.0) {
            return Ok(positions[k - 1] + (positions[k] - positions[k - 1]) * a / (a - b));
        }
    }
    missing(
        "crossing of the level",
        "widen the samples or choose another level",
    )
}

/// Arrival of a front: where the samples first reach half way from `before` to `plateau`.
///
/// # Errors
/// As [`first_crossing`].
pub fn arrival(
    positions: &[f64],
    values: &[f64],
    before: f64,
    plateau: f64,
) -> Result<f64, StudyError> {
    first_crossing(positions, values, 0.5 * (before + plateau))
}

/// Rise from 10 % to 90 % of the way from `before` to `plateau`, as a distance of positions (of times
/// for a history): the last crossing of 10 % ahead of the first crossing of 90 %.
///
/// # Errors
/// If the lists differ in length or the two levels are not crossed.
pub fn rise_10_90(
    positions: &[f64],
    values: &[f64],
    before: f64,
    plateau: f64,
) -> Result<f64, StudyError> {
    same_length("positions", positions, "values", values)?;
    let level = |part: f64| before + part * (plateau - before);
    let high = first_crossing(positions, values, level(0.9))?;
    let mut low = None;
    for k in 1..positions.len() {
        if positions[k - 1] > high {
            break;
        }
        let pair = &values[k - 1..=k];
        let crossing = first_crossing(&positions[k - 1..=k], pair, level(0.1));
        low = crossing.ok().filter(|&c| c <= high).or(low);
    }
    match low {
        Some(low) => Ok(high - low),
        None => missing("10 % crossing", "begin the samples ahead of the front"),
    }
}

/// How far the samples go beyond `plateau` on the side away from `before`, as a part of the step;
/// 0 if they do not. Restrict the samples to the plateau that is meant.
///
/// # Errors
/// If there are no samples or `before` equals `plateau`.
pub fn overshoot(values: &[f64], before: f64, plateau: f64) -> Result<f64, StudyError> {
    let step = plateau - before;
    positive("the height of the step", step.abs())?;
    if values.is_empty() {
        return missing("overshoot", "give at least one sample");
    }
    let beyond = values.iter().map(|value| (value - plateau) / step);
    Ok(beyond.fold(0.0, f64::max))
}

/// The observed order of convergence.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Order {
    /// The order q in error = C hᵠ.
    pub order: f64,
    /// Half width of the 95 % confidence interval of q from the scatter about the line (Student's t
    /// with n − 2 degrees of freedom); infinite for two resolutions, which leave no scatter.
    pub half_width: f64,
    /// The constant C.
    pub constant: f64,
}

/// Least-squares fit of error = C hᵠ to errors at several resolutions h.
///
/// # Errors
/// If there are fewer than two resolutions, all are equal, or a value is not positive.
pub fn observed_order(resolutions: &[f64], errors: &[f64]) -> Result<Order, StudyError> {
    same_length("resolutions", resolutions, "errors", errors)?;
    let count = resolutions.len();
    if count < 2 {
        return Err(StudyError::Count {
            quantity: "the number of resolutions needed",
            value: 2,
            available: count,
            action: "give more",
        });
    }
    for (&h, &error) in resolutions.iter().zip(errors) {
        positive("a resolution", h)?;
        positive("an error", error)?;
    }
    let n = count as f64;
    let x: Vec<f64> = resolutions.iter().map(|h| h.ln()).collect();
    let y: Vec<f64> = errors.iter().map(|e| e.ln()).collect();
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let sxx: f64 = x.iter().map(|x| (x - mx).powi(2)).sum();
    positive("the spread of the resolutions", sxx)?;
    let sxy: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum();
    let order = sxy / sxx;
    let intercept = my - order * mx;
    let scatter: f64 = x
        .iter()
        .zip(&y)
        .map(|(x, y)| (y - intercept - order * x).powi(2))
        .sum();
    let half_width = if count > 2 {
        student_95(count - 2) * (scatter / ((n - 2.0) * sxx)).sqrt()
    } else {
        f64::INFINITY
    };
    Ok(Order {
        order,
        half_width,
        constant: intercept.exp(),
    })
}

/// Two-sided 95 % quantile of Student's t; beyond ten degrees of freedom to 0.5 %.
fn student_95(degrees: usize) -> f64 {
    const TABLE: [f64; 10] = [
        12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
    ];
    match TABLE.get(degrees.wrapping_sub(1)) {
        Some(&quantile) => quantile,
        None => 1.95996 + 2.4 / degrees as f64 + 3.0 / (degrees as f64).powi(2),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms_of_known_differences() {
        let norms = Norms::weighted(&[1.0, 0.0], &[0.0, 3.0], &[3.0, 1.0]).unwrap();
        assert_eq!(norms.l1, 1.5);
        assert!((norms.l2 - 3.0f64.sqrt()).abs() < 1e-15);
        assert_eq!(norms.linf, 3.0);
        assert!(Norms::of_difference(&[1.0], &[]).is_err());
        assert!(Norms::of_difference(&[], &[]).is_err());
        assert!(Norms::of_difference(&[f64::NAN], &[0.0]).is_err());
    }

    #[test]
    fn features_of_a_ramp() {
        let t: Vec<f64> = (0..=100).map(|k| 0.1 * f64::from(k)).collect();
        let ramp: Vec<f64> = t
            .iter()
            .map(|t| -((t - 3.0) / 2.0).clamp(0.0, 1.0))
            .collect();
        assert!((arrival(&t, &ramp, 0.0, -1.0).unwrap() - 4.0).abs() < 1e-12);
        assert!((rise_10_90(&t, &ramp, 0.0, -1.0).unwrap() - 1.6).abs() < 1e-12);
        assert!((plateau_mean(&t, &ramp, 6.05, 9.0).unwrap() + 1.0).abs() < 1e-12);
        assert!((plateau_mean(&t, &ramp, 3.0, 5.0).unwrap() + 0.5).abs() < 1e-12);
        assert_eq!(overshoot(&ramp, 0.0, -1.0).unwrap(), 0.0);
        assert!((overshoot(&ramp, 0.0, -0.8).unwrap() - 0.25).abs() < 1e-12);
        assert!(first_crossing(&t, &ramp, -2.0).is_err());
        assert!(plateau_mean(&t, &ramp, 5.0, 11.0).is_err());
    }

    #[test]
    fn order_and_its_interval() {
        let h = [0.1f64, 0.05, 0.025, 0.0125];
        let exact: Vec<f64> = h.iter().map(|h| 3.0 * h.powf(1.5)).collect();
        let fit = observed_order(&h, &exact).unwrap();
        assert!((fit.order - 1.5).abs() < 1e-12 && (fit.constant - 3.0).abs() < 1e-10);
        assert!(fit.half_width < 1e-10);
        let scattered: Vec<f64> = exact
            .iter()
            .zip([1.1, 0.9, 1.1, 0.9])
            .map(|(e, f)| e * f)
            .collect();
        let fit = observed_order(&h, &scattered).unwrap();
        assert!((fit.order - 1.5).abs() < fit.half_width && fit.half_width < 0.6);
        assert!(
            observed_order(&h[..2], &exact[..2])
                .unwrap()
                .half_width
                .is_infinite()
        );
        assert!(observed_order(&h, &[0.0; 4]).is_err());
        assert!((student_95(11) - 2.201).abs() < 0.011 && (student_95(30) - 2.042).abs() < 0.01);
    }
}
