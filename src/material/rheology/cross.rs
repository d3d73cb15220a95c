//! The law of Cross, for suspensions and paints.
//! μ(γ̇) = μ∞ + (μ₀ − μ∞) / (1 + (λγ̇)ᵐ).

use super::ViscosityLaw;
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// The law of Cross (1965).
///
/// ```text
/// μ(γ̇) = μ∞ + (μ₀ − μ∞) / (1 + (λγ̇)ᵐ)
/// ```
///
/// Between the two plateaus it thins like a power law of index 1 − m, and it is halfway at γ̇ = 1/λ.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Cross {
    /// Viscosity μ₀ \[Pa s\] at rest.
    pub at_rest: f64,
    /// Viscosity μ∞ \[Pa s\] at high shear rate, at most μ₀.
    pub at_high_rate: f64,
    /// Time λ \[s\].
    pub time: f64,
    /// Exponent m \[1\]: 2/3 for many suspensions (Cross); beyond 1 the stress would fall with γ̇.
    pub exponent: f64,
}

impl Cross {
    /// μ₀ and μ∞ \[Pa s\], λ \[s\] and m \[1\].
    #[must_use]
    pub const fn new(at_rest: f64, at_high_rate: f64, time: f64, exponent: f64) -> Self {
        Self {
            at_rest,
            at_high_rate,
            time,
            exponent,
        }
    }
}

impl ViscosityLaw for Cross {
    fn name(&self) -> &'static str {
        "Cross"
    }
    #[inline(always)]
    fn viscosity<L: Lane>(&self, shear_rate: L) -> L {
        let power = (shear_rate * L::of(self.time)).powf(self.exponent);
        let range = L::of(self.at_rest - self.at_high_rate);
        range / (power + L::one()) + L::of(self.at_high_rate)
    }
    fn greatest_viscosity(&self) -> f64 {
        self.at_rest
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        plateaus(self.at_rest, self.at_high_rate, self.time)
            .must(
                self.exponent > 0.0 && self.exponent <= 1.0,
                "exponent",
                self.exponent,
                "above 0 and at most 1",
            )
            .list()
    }
}

/// What the laws with two plateaus ask of them.
pub(super) fn plateaus(at_rest: f64, at_high_rate: f64, time: f64) -> Problems {
    Problems::default()
        .positive("at_rest", at_rest)
        .must(
            (0.0..=at_rest).contains(&at_high_rate),
            "at_high_rate",
            at_high_rate,
            "between 0 and the viscosity at rest",
        )
        .positive("time", time)
}
