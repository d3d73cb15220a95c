//! The power law through points, by least squares of the logarithms.
//! Its exponent is the order of convergence.

/// `y = factor x^exponent`.
///
/// ```
/// use meshfree::output::svg::PowerLaw;
/// let law = PowerLaw { exponent: 2.0, factor: 3.0 };
/// assert_eq!(law.at(2.0), 12.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PowerLaw {
    /// The exponent.
    pub exponent: f64,
    /// The value at 1.
    pub factor: f64,
}

impl PowerLaw {
    /// The value at `x`.
    ///
    /// ```
    /// # use meshfree::output::svg::PowerLaw;
    /// assert_eq!(PowerLaw { exponent: 1.0, factor: 3.0 }.at(2.0), 6.0);
    /// ```
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        self.factor * x.powf(self.exponent)
    }
}

/// The power law that fits the positive points best; nothing with fewer than two places.
///
/// ```
/// use meshfree::output::svg::power_law;
/// let law = power_law(&[(0.1, 0.03), (0.2, 0.12), (0.4, 0.48)]);
/// assert!(law.is_some_and(|law| (law.exponent - 2.0).abs() < 1e-12));
/// ```
#[must_use]
pub fn power_law(points: &[(f64, f64)]) -> Option<PowerLaw> {
    let usable = |v: f64| v.is_finite() && v > 0.0;
    let logs: Vec<(f64, f64)> = points
        .iter()
        .filter(|&&(x, y)| usable(x) && usable(y))
        .map(|&(x, y)| (x.ln(), y.ln()))
        .collect();
    let n = logs.len() as f64;
    let mean_x = logs.iter().map(|p| p.0).sum::<f64>() / n;
    let mean_y = logs.iter().map(|p| p.1).sum::<f64>() / n;
    let spread: f64 = logs.iter().map(|p| (p.0 - mean_x).powi(2)).sum();
    let common: f64 = logs.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum();
    let exponent = common / spread;
    let factor = (mean_y - exponent * mean_x).exp();
    (spread > 1e-20 && exponent.is_finite()).then_some(PowerLaw { exponent, factor })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_without_a_logarithm_do_not_count() {
        let law = power_law(&[(1.0, 2.0), (2.0, 1.0), (0.0, 5.0), (3.0, f64::NAN)]).unwrap();
        assert!((law.exponent + 1.0).abs() < 1e-12 && (law.factor - 2.0).abs() < 1e-12);
        assert_eq!(power_law(&[]), None);
        assert_eq!(power_law(&[(1.0, 2.0), (1.0, 3.0)]), None);
    }
}
