//! The linear law: constant sound speed, for small changes of density.
//! p = c₀² (ρ − ρ₀).

use super::guard::Problems;
use super::{EosState, EquationOfState, Guards};
use crate::scalar::Lane;

/// The linear law of acoustics and of elastic solids.
///
#[doc = include_str!("../../../docs/equations/linear.html")]
///
/// For a solid c₀² = K/ρ₀ with the bulk modulus K \[Pa\]. Valid within some 2 % of ρ₀. It needs no
/// guard: pressure and sound speed are finite everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Linear {
    /// Density ρ₀ \[kg/m³\] at zero pressure.
    pub reference_density: f64,
    /// Sound speed c₀ \[m/s\].
    pub sound_speed: f64,
}

impl Linear {
    /// ρ₀ \[kg/m³\] and c₀ \[m/s\].
    #[must_use]
    pub const fn new(reference_density: f64, sound_speed: f64) -> Self {
        Self {
            reference_density,
            sound_speed,
        }
    }

    /// From the bulk modulus K \[Pa\]: c₀ = √(K/ρ₀).
    #[must_use]
    pub fn from_bulk_modulus(reference_density: f64, bulk_modulus: f64) -> Self {
        Self::new(reference_density, (bulk_modulus / reference_density).sqrt())
    }

    /// From Young's modulus E \[Pa\] and Poisson's ratio ν: K = E / (3 (1 − 2ν)).
    #[must_use]
    pub fn from_elastic_constants(
        reference_density: f64,
        youngs_modulus: f64,
        poisson: f64,
    ) -> Self {
        Self::from_bulk_modulus(
            reference_density,
            youngs_modulus / (3.0 * (1.0 - 2.0 * poisson)),
        )
    }
}

impl EquationOfState for Linear {
    fn name(&self) -> &'static str {
        "linear"
    }
    fn reference_density(&self) -> f64 {
        self.reference_density
    }
    fn uses_energy(&self) -> bool {
        false
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, _energy: L) -> EosState<L> {
        let excess = density - L::of(self.reference_density);
        EosState {
            pressure: excess * L::of(self.sound_speed * self.sound_speed),
            sound_speed: L::of(self.sound_speed),
            guards: Guards::none(),
        }
    }
    /// c₀² (ln(ρ/ρ₀) + ρ₀/ρ − 1).
    fn stored_energy(&self, density: f64, _energy: f64) -> Option<f64> {
        let strain = density / self.reference_density - 1.0;
        let c2 = self.sound_speed * self.sound_speed;
        (strain > -1.0).then(|| c2 * (strain.ln_1p() - strain / (1.0 + strain)))
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .positive("reference_density", self.reference_density)
            .must(
                self.sound_speed.is_finite() && self.sound_speed > 0.0,
                "sound_speed",
                self.sound_speed,
                "finite and positive; of elastic constants: moduli above 0, and a Poisson ratio above -1 and below 0.5",
            )
            .list()
    }
}
