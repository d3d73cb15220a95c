//! Tait's law in the form of Cole, for weakly compressible liquids.
//! p = B [(ρ/ρ₀)^γ − 1], B = c₀² ρ₀ / γ.

use super::{EosState, EquationOfState, power_law};
use crate::scalar::Lane;

/// The Tait–Cole law.
///
#[doc = include_str!("../../../docs/equations/tait.html")]
///
/// Source: Cole (1948); Monaghan (1994) brought it to free surfaces. With an artificial c₀ of ten
/// times the greatest speed the density stays within 1 %. Guards: beyond ρ/ρ₀ = 2 the law goes on
/// along its tangent (`compression`); c stays above 0.01 c₀ (`expansion`).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Tait {
    /// Density ρ₀ \[kg/m³\] at zero pressure.
    pub reference_density: f64,
    /// Sound speed c₀ \[m/s\] at ρ₀.
    pub sound_speed: f64,
    /// Exponent γ \[1\]; 7 fits water, 1 is the linear law. Whole numbers up to 16 are fastest.
    pub gamma: f64,
}

impl Tait {
    /// ρ₀ \[kg/m³\] and c₀ \[m/s\], with γ = 7 as measured for water by Cole.
    #[must_use]
    pub const fn new(reference_density: f64, sound_speed: f64) -> Self {
        Self {
            reference_density,
            sound_speed,
            gamma: 7.0,
        }
    }

    /// The artificial liquid for flow up to `greatest_speed` \[m/s\]: c₀ is ten times that, so the
    /// density changes by about a hundredth (Monaghan 1994).
    #[must_use]
    pub const fn artificial(reference_density: f64, greatest_speed: f64) -> Self {
        Self::new(reference_density, 10.0 * greatest_speed)
    }

    /// The same with another exponent γ.
    #[must_use]
    pub const fn with_gamma(mut self, gamma: f64) -> Self {
        self.gamma = gamma;
        self
    }
}

impl EquationOfState for Tait {
    fn name(&self) -> &'static str {
        "Tait"
    }
    fn reference_density(&self) -> f64 {
        self.reference_density
    }
    fn uses_energy(&self) -> bool {
        false
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, _energy: L) -> EosState<L> {
        let bulk_modulus = self.reference_density * self.sound_speed * self.sound_speed;
        power_law::state(density, self.reference_density, bulk_modulus, self.gamma)
    }
    /// c₀²/γ ((wᵞ⁻¹ − 1)/(γ − 1) + 1/w − 1) with w = ρ/ρ₀, up to twice the density at rest.
    fn stored_energy(&self, density: f64, _energy: f64) -> Option<f64> {
        let c2 = self.sound_speed * self.sound_speed;
        power_law::stored_energy(density / self.reference_density, c2, self.gamma)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        power_law::problems(self.reference_density)
            .positive("sound_speed", self.sound_speed)
            .must(
                (1.0..=20.0).contains(&self.gamma),
                "gamma",
                self.gamma,
                "between 1 and 20",
            )
            .list()
    }
}
