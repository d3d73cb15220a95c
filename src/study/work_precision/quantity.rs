//! Quantities of interest: what a study measures in every run, and what it is compared with.
//! A quantity is one number, or samples at the same places or times in every run.

use crate::study::norms::Norms;

/// What a quantity is compared with.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Reference {
    /// The run has measured its own error, against an exact or a manufactured solution: the value is the error.
    Measured,
    /// The exact value, or exact samples.
    Exact(Vec<f64>),
    /// The run of the same method on its finest spacing, which then has no error of its own.
    Finest,
    /// The limit that the three finest runs of the same method point to (Richardson 1911): value = limit + C dxᵖ. For single
    /// numbers; refused where differences do not shrink.
    Richardson,
}

/// The norm of samples that are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Norm {
    /// Mean of the absolute.
    L1,
    /// Root mean square.
    #[default]
    L2,
    /// Largest.
    Largest,
}

impl Norm {
    /// The norm of `values − expected`, if they compare.
    pub(super) fn of(self, values: &[f64], expected: &[f64]) -> Option<f64> {
        let norms = Norms::of_difference(values, expected).ok()?;
        Some(match self {
            Self::L1 => norms.l1,
            Self::L2 => norms.l2,
            Self::Largest => norms.linf,
        })
    }
}

/// A quantity of interest. Its error is the norm of its difference from the reference over a scale: the norm of the
/// reference by default, and 1 for [`Reference::Measured`].
///
/// ```
/// use meshfree::study::work_precision::{Norm, Quantity};
/// let plateau = Quantity::exact("plateau", 353.17e6);
/// let profile = Quantity::finest("pressure at 20 places").norm(Norm::L1).scale(353.17e6);
/// # let _ = (plateau, profile);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Quantity {
    pub(super) name: String,
    pub(super) reference: Reference,
    pub(super) norm: Norm,
    pub(super) scale: Option<f64>,
}

impl Quantity {
    fn new(name: &str, reference: Reference) -> Self {
        Self {
            name: name.into(),
            reference,
            norm: Norm::default(),
            scale: None,
        }
    }

    /// One whose run measures the error itself, against an exact or manufactured solution.
    #[must_use]
    pub fn measured(name: &str) -> Self {
        Self::new(name, Reference::Measured)
    }

    /// One with a known value.
    #[must_use]
    pub fn exact(name: &str, value: f64) -> Self {
        Self::new(name, Reference::Exact(vec![value]))
    }

    /// Samples with known values.
    #[must_use]
    pub fn exact_samples(name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, Reference::Exact(values.into_iter().collect()))
    }

    /// One that is compared with the finest run of its method.
    #[must_use]
    pub fn finest(name: &str) -> Self {
        Self::new(name, Reference::Finest)
    }

    /// One that is compared with the limit of its method.
    #[must_use]
    pub fn richardson(name: &str) -> Self {
        Self::new(name, Reference::Richardson)
    }

    /// The norm of samples; L2 by default.
    #[must_use]
    pub fn norm(mut self, norm: Norm) -> Self {
        self.norm = norm;
        self
    }

    /// What errors are divided by, in the unit of the quantity.
    #[must_use]
    pub fn scale(mut self, scale: f64) -> Self {
        self.scale = Some(scale);
        self
    }

    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The errors of the runs of one method, coarse to fine, or why there is none.
    pub(super) fn errors(&self, runs: &[(f64, Option<&[f64]>)]) -> Vec<Result<f64, String>> {
        let (expected, own) = match self.expected(runs) {
            Ok(found) => found,
            Err(why) => return runs.iter().map(|_| Err(why.clone())).collect(),
        };
        let error = |(k, values): (usize, Option<&[f64]>)| {
            let values = values.ok_or_else(|| format!("the run gave no `{}`", self.name))?;
            if let Some(bad) = values.iter().find(|value| !value.is_finite()) {
                return Err(format!("`{}` is {bad}", self.name));
            }
            if own == Some(k) {
                return Err("the reference of its method".into());
            }
            let zeros = vec![0.0; expected.len().max(values.len())];
            let (expected, usual) = if self.reference == Reference::Measured {
                (&zeros[..values.len()], 1.0)
            } else {
                let scale = self.norm.of(&expected, &zeros[..expected.len()]);
                (&expected[..], scale.unwrap_or(f64::NAN))
            };
            let difference = self.norm.of(values, expected).ok_or_else(|| {
                let (own, other) = (values.len(), expected.len());
                format!("{own} samples do not compare with the {other} of the reference")
            })?;
            let scale = self.scale.unwrap_or(usual).abs();
            if scale.is_finite() && scale > 0.0 {
                Ok(difference / scale)
            } else {
                Err(format!(
                    "the reference of `{}` is zero: give it a scale",
                    self.name
                ))
            }
        };
        runs.iter()
            .map(|run| run.1)
            .enumerate()
            .map(error)
            .collect()
    }

    /// The reference, and the run that is it.
    fn expected(
        &self,
        runs: &[(f64, Option<&[f64]>)],
    ) -> Result<(Vec<f64>, Option<usize>), String> {
        let good = |values: &&[f64]| values.iter().all(|value| value.is_finite());
        let finished = runs.iter().enumerate().rev();
        let finished: Vec<_> = finished
            .filter_map(|(k, (dx, values))| Some((k, *dx, values.filter(good)?)))
            .collect();
        match &self.reference {
            Reference::Measured => Ok((Vec::new(), None)),
            Reference::Exact(values) => Ok((values.clone(), None)),
            Reference::Finest => match finished.first() {
                Some((k, _, values)) => Ok((values.to_vec(), Some(*k))),
                None => Err("no run of its method gave a reference".into()),
            },
            Reference::Richardson => match finished.as_slice() {
                [(_, a, x), (_, b, y), (_, c, z), ..]
                    if x.len() == 1 && y.len() == 1 && z.len() == 1 =>
                {
                    limit([*a, *b, *c], [x[0], y[0], z[0]])
                        .map(|limit| (vec![limit], None))
                        .ok_or_else(|| "its three finest runs do not point to a limit".into())
                }
                _ => Err("Richardson's limit needs one number from each of three spacings".into()),
            },
        }
    }
}

/// The limit of v = limit + C dxᵖ through three values, the finest first: p by bisection.
fn limit(dx: [f64; 3], v: [f64; 3]) -> Option<f64> {
    let ratio = (v[2] - v[1]) / (v[1] - v[0]);
    let of = |p: f64| (dx[2].powf(p) - dx[1].powf(p)) / (dx[1].powf(p) - dx[0].powf(p));
    let (mut low, mut high) = (0.05, 8.0);
    if !(of(low)..=of(high)).contains(&ratio) {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if of(middle) < ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    let c = (v[1] - v[0]) / (dx[1].powf(low) - dx[0].powf(low));
    Some(v[0] - c * dx[0].powf(low))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_give_the_errors_that_they_should() {
        let values = [[5.0 + 0.16], [5.0 + 0.04], [5.0 + 0.01]];
        let dx = [0.4, 0.2, 0.1];
        let runs: Vec<_> = dx
            .into_iter()
            .zip(&values)
            .map(|(dx, v)| (dx, Some(&v[..])))
            .collect();
        let errors = |quantity: Quantity| quantity.errors(&runs);
        let near = |found: &Result<f64, String>, error: f64| {
            assert!(
                (found.as_ref().unwrap() - error).abs() < 1e-9,
                "{found:?} {error}"
            );
        };
        for quantity in [Quantity::exact("q", 5.0), Quantity::richardson("q")] {
            let found = errors(quantity);
            near(&found[0], 0.032);
            near(&found[2], 0.002);
        }
        let finest = errors(Quantity::finest("q").scale(1.0));
        near(&finest[1], 0.03);
        assert!(finest[2].is_err());
        near(&errors(Quantity::measured("q").scale(2.0))[0], 2.58);
        assert!(Quantity::richardson("q").errors(&runs[..2])[0].is_err());
        assert!(Quantity::exact("q", 0.0).errors(&runs)[0].is_err());
        assert!(Quantity::exact_samples("q", [1.0, 2.0]).errors(&runs)[0].is_err());
        let broken = [(0.4, None), (0.2, Some(&[f64::NAN][..]))];
        assert!(
            Quantity::exact("q", 1.0)
                .errors(&broken)
                .iter()
                .all(Result::is_err)
        );
    }
}
