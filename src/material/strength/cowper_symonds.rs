//! The factor of Cowper and Symonds, by which another law of strength grows with the strain rate.
//! Y = Y_s (1 + (ε̇/D)^(1/p)).

use super::{PlasticState, Strength};
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// The rate factor of Cowper & Symonds (1957) on the yield stress Y_s of another law.
///
/// ```text
/// Y = Y_s (1 + (ε̇/D)^(1/p))
/// ```
///
/// At ε̇ = D the yield stress has doubled. D 40 1/s and p 5 are customary for mild steel. Polymers have been fitted
/// with D of some thousand 1/s; for FullCure M730 none is published.
///
/// ```
/// use meshfree::material::strength::{CowperSymonds, PerfectPlasticity, PlasticState, Strength};
/// let steel = CowperSymonds::new(PerfectPlasticity::new(250e6), 40.0, 5.0);
/// let fast = PlasticState { rate: 40.0, ..PlasticState::default() };
/// assert_eq!(steel.yield_stress(&fast), 500e6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct CowperSymonds<S> {
    /// The law at vanishing rate.
    pub slow: S,
    /// Rate D \[1/s\] at which the yield stress has doubled.
    pub doubling_rate: f64,
    /// Exponent p, one or more.
    pub exponent: f64,
}

impl<S: Strength> CowperSymonds<S> {
    /// The law at vanishing rate, D \[1/s\] and p.
    #[must_use]
    pub const fn new(slow: S, doubling_rate: f64, exponent: f64) -> Self {
        Self {
            slow,
            doubling_rate,
            exponent,
        }
    }
}

impl<S: Strength> Strength for CowperSymonds<S> {
    fn name(&self) -> &'static str {
        "Cowper–Symonds"
    }
    fn source(&self) -> &'static str {
        "Cowper & Symonds 1957"
    }
    #[inline(always)]
    fn yield_stress<L: Lane>(&self, state: &PlasticState<L>) -> L {
        let ratio = (state.rate / L::of(self.doubling_rate)).positive_part();
        self.slow.yield_stress(state) * (L::one() + ratio.powf(self.exponent.recip()))
    }
    fn uses_temperature(&self) -> bool {
        self.slow.uses_temperature()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let own = Problems::default()
            .positive("doubling_rate", self.doubling_rate)
            .must(
                self.exponent.is_finite() && self.exponent >= 1.0,
                "exponent",
                self.exponent,
                "finite and at least 1",
            )
            .list();
        let mut problems = self.slow.problems();
        problems.extend(own);
        problems
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::strength::LinearHardening;

    #[test]
    fn it_multiplies_the_law_that_it_wraps() {
        let slow = LinearHardening::new(200e6, 1e9);
        let law = CowperSymonds::new(slow, 40.0, 5.0);
        let at = |rate| {
            law.yield_stress(&PlasticState {
                strain: 0.1,
                rate,
                ..PlasticState::default()
            })
        };
        assert_eq!([at(0.0), at(40.0)], [300e6, 600e6]);
        // 32^(1/5) = 2.
        assert!((at(40.0 * 32.0) / 900e6 - 1.0).abs() < 1e-15);
        let wrong = CowperSymonds::new(LinearHardening::new(-1.0, 0.0), 0.0, 0.5);
        let fields: Vec<_> = wrong.problems().iter().map(|problem| problem.0).collect();
        assert_eq!(fields, ["yield_stress", "doubling_rate", "exponent"]);
    }
}
