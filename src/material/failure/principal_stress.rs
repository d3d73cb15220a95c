//! Failure at a largest principal stress.
//! σ₁ ≥ σ_f (Rankine).

use super::{Failure, FailureState, not_positive};
use crate::scalar::Lane;

/// Failure where the largest principal stress, positive in tension, reaches σ_f: brittle solids.
///
/// ```
/// use meshfree::material::failure::{Failure, FailureState, PrincipalStressLimit};
/// let glass = PrincipalStressLimit::new(50e6);
/// let pulled = FailureState { principal_stress: 60e6, ..FailureState::default() };
/// assert_eq!(glass.damage(&pulled), 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct PrincipalStressLimit {
    /// Principal stress σ_f \[Pa\] at which it fails.
    pub stress: f64,
}

impl PrincipalStressLimit {
    /// With this limit.
    #[must_use]
    pub const fn new(stress: f64) -> Self {
        Self { stress }
    }
}

impl Failure for PrincipalStressLimit {
    fn name(&self) -> &'static str {
        "limit of principal stress"
    }
    fn source(&self) -> &'static str {
        "Rankine 1857"
    }
    #[inline(always)]
    fn damage<L: Lane>(&self, state: &FailureState<L>) -> L {
        L::select(
            state.principal_stress.ge(L::of(self.stress)),
            L::one(),
            L::zero(),
        )
    }

    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_positive(&[("stress", self.stress)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_fails_at_its_limit_and_not_before() {
        let law = PrincipalStressLimit::new(5e7);
        let at = |value: f64| FailureState {
            principal_stress: value,
            ..FailureState::default()
        };
        assert_eq!(law.damage(&at(5e7)), 1.0);
        assert_eq!(law.damage(&at(5e7 * (1.0 - 1e-12))), 0.0);
        assert_eq!(law.damage(&at(-5e7)), 0.0);
        assert!(law.problems().is_empty());
        assert_eq!(PrincipalStressLimit::new(0.0).problems()[0].0, "stress");
    }
}
