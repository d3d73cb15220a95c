//! Linear hardening: a yield stress that rises with plastic strain at one rate.
//! Y = Y₀ + H ε.

use super::{PlasticState, Strength};
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// Linear isotropic hardening (Odqvist 1933, with Y a linear function of the length ε of the plastic path).
///
/// ```text
/// Y = Y₀ + H ε
/// ```
///
/// H is the slope of true stress against plastic strain in simple tension. With the tangent modulus E_t of a curve
/// against total strain it is H = E E_t/(E − E_t).
///
/// ```
/// use meshfree::material::strength::{LinearHardening, PlasticState, Strength};
/// // Copper of the Taylor bar benchmark (Simo 1992).
/// let copper = LinearHardening::new(400e6, 100e6);
/// let strained = PlasticState { strain: 0.5, ..PlasticState::default() };
/// assert_eq!(copper.yield_stress(&strained), 450e6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct LinearHardening {
    /// Yield stress Y₀ \[Pa\] at zero plastic strain.
    pub yield_stress: f64,
    /// Hardening modulus H \[Pa\].
    pub modulus: f64,
}

impl LinearHardening {
    /// Y₀ and H \[Pa\].
    #[must_use]
    pub const fn new(yield_stress: f64, modulus: f64) -> Self {
        Self {
            yield_stress,
            modulus,
        }
    }
}

impl Strength for LinearHardening {
    fn name(&self) -> &'static str {
        "linear hardening"
    }
    fn source(&self) -> &'static str {
        "Odqvist 1933"
    }
    #[inline(always)]
    fn yield_stress<L: Lane>(&self, state: &PlasticState<L>) -> L {
        L::of(self.modulus).fused(state.strain, L::of(self.yield_stress))
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .not_negative("yield_stress", self.yield_stress)
            .not_negative("modulus", self.modulus)
            .list()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_rises_along_a_line_and_says_what_is_wrong() {
        let law = LinearHardening::new(300e6, 2e9);
        let at = |strain| {
            law.yield_stress(&PlasticState {
                strain,
                ..PlasticState::default()
            })
        };
        assert_eq!([at(0.0), at(0.1), at(1.0)], [300e6, 500e6, 2.3e9]);
        let fields: Vec<_> = LinearHardening::new(-1.0, f64::NAN)
            .problems()
            .iter()
            .map(|problem| problem.0)
            .collect();
        assert_eq!(fields, ["yield_stress", "modulus"]);
    }
}
