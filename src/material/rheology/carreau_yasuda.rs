//! The law of Carreau and Yasuda, for polymers and blood.
//! μ(γ̇) = μ∞ + (μ₀ − μ∞) [1 + (λγ̇)ᵃ]⁽ⁿ⁻¹⁾ᐟᵃ.

use super::ViscosityLaw;
use super::cross::plateaus;
use crate::scalar::Lane;

/// The law of Carreau (1972) with the exponent of Yasuda, Armstrong & Cohen (1981).
///
/// ```text
/// μ(γ̇) = μ∞ + (μ₀ − μ∞) [1 + (λγ̇)ᵃ]^((n−1)/a)
/// ```
///
/// Between the plateaus it thins like a power law of index n.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct CarreauYasuda {
    /// Viscosity μ₀ \[Pa s\] at rest.
    pub at_rest: f64,
    /// Viscosity μ∞ \[Pa s\] at high shear rate, at most μ₀.
    pub at_high_rate: f64,
    /// Time λ \[s\]: thinning begins at γ̇ = 1/λ.
    pub time: f64,
    /// Index n \[1\], above 0 and at most 1.
    pub index: f64,
    /// Exponent a \[1\] of the transition; 2 is Carreau's law.
    pub transition: f64,
}

impl CarreauYasuda {
    /// μ₀ and μ∞ \[Pa s\], λ \[s\] and n \[1\], with a = 2 (Carreau's law).
    #[must_use]
    pub const fn new(at_rest: f64, at_high_rate: f64, time: f64, index: f64) -> Self {
        Self {
            at_rest,
            at_high_rate,
            time,
            index,
            transition: 2.0,
        }
    }

    /// The same with another exponent a \[1\] of the transition: sharper if larger.
    #[must_use]
    pub const fn with_transition(mut self, transition: f64) -> Self {
        self.transition = transition;
        self
    }
}

impl ViscosityLaw for CarreauYasuda {
    fn name(&self) -> &'static str {
        "Carreau-Yasuda"
    }
    #[inline(always)]
    fn viscosity<L: Lane>(&self, shear_rate: L) -> L {
        let power = (shear_rate * L::of(self.time)).powf(self.transition) + L::one();
        let share = power.powf((self.index - 1.0) / self.transition);
        share.mul_add(
            L::of(self.at_rest - self.at_high_rate),
            L::of(self.at_high_rate),
        )
    }
    fn greatest_viscosity(&self) -> f64 {
        self.at_rest
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        plateaus(self.at_rest, self.at_high_rate, self.time)
            .must(
                self.index > 0.0 && self.index <= 1.0,
                "index",
                self.index,
                "above 0 and at most 1",
            )
            .positive("transition", self.transition)
            .list()
    }
}
