//! Power hardening: a yield stress that rises with a power of plastic strain.
//! Y = A + B εⁿ, the law of Ludwik.

use super::{PlasticState, Strength};
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// The law of Ludwik (1909).
///
/// ```text
/// Y = A + B εⁿ
/// ```
///
/// Below n = 1 its slope is infinite at ε = 0, as is that of annealed metals very nearly.
///
/// ```
/// use meshfree::material::strength::{PlasticState, PowerHardening, Strength};
/// let law = PowerHardening::new(100e6, 300e6, 0.5);
/// let strained = PlasticState { strain: 0.25, ..PlasticState::default() };
/// assert_eq!(law.yield_stress(&strained), 250e6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct PowerHardening {
    /// Yield stress A \[Pa\] at zero plastic strain.
    pub yield_stress: f64,
    /// Its rise B \[Pa\] at a plastic strain of one.
    pub hardening: f64,
    /// Exponent n, between 0 and 1.
    pub exponent: f64,
}

impl PowerHardening {
    /// A and B \[Pa\], and n.
    #[must_use]
    pub const fn new(yield_stress: f64, hardening: f64, exponent: f64) -> Self {
        Self {
            yield_stress,
            hardening,
            exponent,
        }
    }

    /// What is wrong with the three parameters.
    pub(super) fn checks(&self) -> Problems {
        Problems::default()
            .not_negative("yield_stress", self.yield_stress)
            .not_negative("hardening", self.hardening)
            .must(
                self.exponent > 0.0 && self.exponent <= 1.0,
                "exponent",
                self.exponent,
                "above 0 and at most 1",
            )
    }
}

impl Strength for PowerHardening {
    fn name(&self) -> &'static str {
        "power hardening"
    }
    fn source(&self) -> &'static str {
        "Ludwik 1909"
    }
    #[inline(always)]
    fn yield_stress<L: Lane>(&self, state: &PlasticState<L>) -> L {
        // A strain that rounding has made negative has no power.
        let power = state.strain.positive_part().powf(self.exponent);
        L::of(self.hardening).fused(power, L::of(self.yield_stress))
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        self.checks().list()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_rises_with_a_power_from_zero_strain_on() {
        let law = PowerHardening::new(90e6, 292e6, 0.31);
        let at = |strain| {
            law.yield_stress(&PlasticState {
                strain,
                ..PlasticState::default()
            })
        };
        assert_eq!([at(0.0), at(1.0)], [90e6, 382e6]);
        // 0.1^0.31 = 0.48978.
        assert!((at(0.1) / 233.015e6 - 1.0).abs() < 1e-5, "{}", at(0.1));
        assert_eq!(at(-1e-20), 90e6);
        let problems = PowerHardening::new(90e6, 292e6, 1.5).problems();
        assert_eq!(problems[0].0, "exponent");
    }
}
