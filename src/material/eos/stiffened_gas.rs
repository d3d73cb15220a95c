//! The stiffened gas: an ideal gas under a constant internal pressure, for shocks in liquids.
//! p = (γ − 1) ρ e + γ p∞ (ρ/ρ₀ − 1), with e counted from the state of rest.

use super::guard::{LEAST_RATIO, Problems, SPEED_FLOOR, compression};
use super::{EosState, EquationOfState, Guards};
use crate::scalar::Lane;

/// The stiffened gas.
///
#[doc = include_str!("../../../docs/equations/stiffened_gas.html")]
///
/// The usual form (Harlow & Amsden 1971; Menikoff & Plohr 1989) has E, which is not zero at rest.
/// Here e \[J/kg\] counts from the state of zero pressure at ρ₀, so e = 0 is a liquid at rest, and
/// the difference ρ − ρ₀ keeps its digits in `f32`. Use it for shocks in liquids and for water next
/// to air. Guard: p stays above −(1 − 10⁻⁴) p∞, where c² would vanish; counted under `expansion`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct StiffenedGas {
    /// Exponent γ \[1\], above 1.
    pub gamma: f64,
    /// Internal pressure p∞ \[Pa\].
    pub stiffness: f64,
    /// Density ρ₀ \[kg/m³\] at zero pressure and e = 0.
    pub reference_density: f64,
}

impl StiffenedGas {
    /// γ \[1\], p∞ \[Pa\] and ρ₀ \[kg/m³\].
    #[must_use]
    pub const fn new(gamma: f64, stiffness: f64, reference_density: f64) -> Self {
        Self {
            gamma,
            stiffness,
            reference_density,
        }
    }

    /// Water: γ = 4.4, p∞ = 6·10⁸ Pa, ρ₀ = 1000 kg/m³ (Saurel & Abgrall 1999); c₀ = 1625 m/s.
    #[must_use]
    pub const fn water() -> Self {
        Self::new(4.4, 6e8, 1000.0)
    }
}

impl EquationOfState for StiffenedGas {
    fn name(&self) -> &'static str {
        "stiffened gas"
    }
    fn reference_density(&self) -> f64 {
        self.reference_density
    }
    fn uses_energy(&self) -> bool {
        true
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, energy: L) -> EosState<L> {
        let eta = compression(density, self.reference_density);
        let plain = (density * energy).mul_add(
            L::of(self.gamma - 1.0),
            eta * L::of(self.gamma * self.stiffness),
        );
        let least = L::of(-(1.0 - SPEED_FLOOR * SPEED_FLOOR) * self.stiffness);
        let pressure = plain.max(least);
        let mut guards = Guards::none();
        guards.expansion = plain.lt(least);
        let divisor = density.max(L::of(LEAST_RATIO * self.reference_density));
        let squared = (pressure + L::of(self.stiffness)) * L::of(self.gamma) / divisor;
        EosState {
            pressure,
            sound_speed: squared.sqrt(),
            guards,
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .must(
                self.gamma > 1.0 && self.gamma < 100.0,
                "gamma",
                self.gamma,
                "above 1 and below 100",
            )
            .positive("stiffness", self.stiffness)
            .positive("reference_density", self.reference_density)
            .list()
    }
}
