//! Failure at a plastic strain.
//! ε ≥ ε_f, whatever the stress.

use super::{Failure, FailureState, not_positive};
use crate::scalar::Lane;

/// Failure where the equivalent plastic strain ε reaches ε_f, whatever the stress.
///
/// ```
/// use meshfree::material::failure::{Failure, FailureState, PlasticStrainLimit};
/// let law = PlasticStrainLimit::new(0.5);
/// assert_eq!(law.damage(&FailureState { strain: 0.4, ..FailureState::default() }), 0.0);
/// assert_eq!(law.damage(&FailureState { strain: 0.5, ..FailureState::default() }), 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct PlasticStrainLimit {
    /// Plastic strain ε_f at which it fails.
    pub strain: f64,
}

impl PlasticStrainLimit {
    /// With this limit.
    #[must_use]
    pub const fn new(strain: f64) -> Self {
        Self { strain }
    }
}

impl Failure for PlasticStrainLimit {
    fn name(&self) -> &'static str {
        "limit of plastic strain"
    }
    fn source(&self) -> &'static str {
        "equivalent plastic strain"
    }
    #[inline(always)]
    fn damage<L: Lane>(&self, state: &FailureState<L>) -> L {
        L::select(state.strain.ge(L::of(self.strain)), L::one(), L::zero())
    }
    fn uses_plastic_strain(&self) -> bool {
        true
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_positive(&[("strain", self.strain)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_fails_at_its_limit_and_not_before() {
        let law = PlasticStrainLimit::new(0.5);
        let at = |value: f64| FailureState {
            strain: value,
            ..FailureState::default()
        };
        assert_eq!(law.damage(&at(0.5)), 1.0);
        assert_eq!(law.damage(&at(0.5 * (1.0 - 1e-12))), 0.0);
        assert_eq!(law.damage(&at(-0.5)), 0.0);
        assert!(law.problems().is_empty());
        assert_eq!(PlasticStrainLimit::new(0.0).problems()[0].0, "strain");
    }
}
