//! The ideal gas with constant ratio of specific heats.
//! p = (γ − 1) ρ e.

use super::guard::Problems;
use super::{EosState, EquationOfState, Guards};
use crate::scalar::Lane;

/// The calorically perfect ideal gas.
///
#[doc = include_str!("../../../docs/equations/ideal_gas.html")]
///
/// ρ density \[kg/m³\], e specific internal energy \[J/kg\], γ ratio of specific heats. Valid for
/// gases below some thousand kelvin. Guard: an energy below [`minimum_energy`](Self::minimum_energy)
/// is taken as that energy and counted under `expansion`; so is a density that is not positive.
///
/// ```
/// use meshfree::material::eos::{EquationOfState, IdealGas};
/// let air = IdealGas::new(1.4, 1.2);
/// let state = air.state(1.2_f64, 2.11e5);
/// assert!((state.pressure - 1.0128e5).abs() < 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct IdealGas {
    /// Ratio of specific heats γ \[1\], above 1: 1.4 for air, 5/3 for a monatomic gas.
    pub gamma: f64,
    /// Density ρ₀ \[kg/m³\] at the start.
    pub reference_density: f64,
    /// Least specific internal energy \[J/kg\]. The default 10⁻¹² changes no pressure that matters
    /// and keeps the sound speed above zero in cold gas (the Noh problem).
    pub minimum_energy: f64,
}

impl IdealGas {
    /// γ \[1\] and the density at the start \[kg/m³\].
    #[must_use]
    pub const fn new(gamma: f64, reference_density: f64) -> Self {
        Self {
            gamma,
            reference_density,
            minimum_energy: 1e-12,
        }
    }

    /// The specific internal energy \[J/kg\] at a pressure \[Pa\] and density \[kg/m³\].
    #[must_use]
    pub fn energy(&self, pressure: f64, density: f64) -> f64 {
        pressure / ((self.gamma - 1.0) * density)
    }
}

impl EquationOfState for IdealGas {
    fn name(&self) -> &'static str {
        "ideal gas"
    }
    fn reference_density(&self) -> f64 {
        self.reference_density
    }
    fn uses_energy(&self) -> bool {
        true
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, energy: L) -> EosState<L> {
        let floor = L::of(self.minimum_energy);
        let energy_used = energy.max(floor);
        let mut guards = Guards::none();
        guards.expansion = energy.lt(floor) | density.le(L::zero());
        EosState {
            pressure: density.positive_part() * energy_used * L::of(self.gamma - 1.0),
            sound_speed: (energy_used * L::of(self.gamma * (self.gamma - 1.0))).sqrt(),
            guards,
        }
    }
    /// e: a gas stores nothing else.
    fn stored_energy(&self, _density: f64, energy: f64) -> Option<f64> {
        Some(energy)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .must(
                self.gamma > 1.0 && self.gamma < 10.0,
                "gamma",
                self.gamma,
                "above 1 and below 10",
            )
            .positive("reference_density", self.reference_density)
            .positive("minimum_energy", self.minimum_energy)
            .list()
    }
}
