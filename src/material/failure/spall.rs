//! Spall: failure at a tension.
//! −p ≥ σ_s.

use super::{Failure, FailureState, not_positive};
use crate::scalar::Lane;

/// Failure where the tension −p reaches the spall strength σ_s: plates that break inside when waves of release meet.
///
/// A material whose pressure is [cut off](crate::material::Material::with_pressure_cut_off) above −σ_s never reaches
/// it, and is refused.
///
/// ```
/// use meshfree::material::failure::{Failure, FailureState, SpallStrength};
/// let copper = SpallStrength::new(1.2e9);
/// assert_eq!(copper.damage(&FailureState { pressure: -1.1e9, ..FailureState::default() }), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct SpallStrength {
    /// Spall strength σ_s \[Pa\], positive.
    pub tension: f64,
}

impl SpallStrength {
    /// With this limit.
    #[must_use]
    pub const fn new(tension: f64) -> Self {
        Self { tension }
    }
}

impl Failure for SpallStrength {
    fn name(&self) -> &'static str {
        "spall"
    }
    fn source(&self) -> &'static str {
        "tension limit"
    }
    #[inline(always)]
    fn damage<L: Lane>(&self, state: &FailureState<L>) -> L {
        L::select(state.pressure.le(L::of(-self.tension)), L::one(), L::zero())
    }
    fn pressure_at_failure(&self) -> Option<f64> {
        Some(-self.tension)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_positive(&[("tension", self.tension)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_fails_at_its_limit_and_not_before() {
        let law = SpallStrength::new(1.2e9);
        let at = |value: f64| FailureState {
            pressure: -value,
            ..FailureState::default()
        };
        assert_eq!(law.damage(&at(1.2e9)), 1.0);
        assert_eq!(law.damage(&at(1.2e9 * (1.0 - 1e-12))), 0.0);
        assert_eq!(law.damage(&at(-1.2e9)), 0.0);
        assert!(law.problems().is_empty());
        assert_eq!(SpallStrength::new(0.0).problems()[0].0, "tension");
    }
}
