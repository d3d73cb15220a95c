//! Murnaghan's law, for liquids and solids under static pressure.
//! p = (K₀/n) [(ρ/ρ₀)ⁿ − 1].

use super::{EosState, EquationOfState, power_law};
use crate::scalar::Lane;

/// The Murnaghan law.
///
#[doc = include_str!("../../../docs/equations/murnaghan.html")]
///
/// Source: Murnaghan (1944), from a bulk modulus that grows linearly with pressure, K = K₀ + n p.
/// Valid up to about p = K₀/2. Guards: beyond ρ/ρ₀ = 2 the law goes on along its tangent
/// (`compression`); c stays above a hundredth of √(K₀/ρ₀) (`expansion`).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Murnaghan {
    /// Density ρ₀ \[kg/m³\] at zero pressure.
    pub reference_density: f64,
    /// Bulk modulus K₀ \[Pa\] at zero pressure.
    pub bulk_modulus: f64,
    /// Its derivative with pressure n = dK/dp \[1\]: about 4 for metals, 7 for water.
    pub derivative: f64,
}

impl Murnaghan {
    /// ρ₀ \[kg/m³\], K₀ \[Pa\] and n \[1\].
    #[must_use]
    pub const fn new(reference_density: f64, bulk_modulus: f64, derivative: f64) -> Self {
        Self {
            reference_density,
            bulk_modulus,
            derivative,
        }
    }
}

impl EquationOfState for Murnaghan {
    fn name(&self) -> &'static str {
        "Murnaghan"
    }
    fn reference_density(&self) -> f64 {
        self.reference_density
    }
    fn uses_energy(&self) -> bool {
        false
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, _energy: L) -> EosState<L> {
        power_law::state(
            density,
            self.reference_density,
            self.bulk_modulus,
            self.derivative,
        )
    }
    /// K₀/(n ρ₀) ((wⁿ⁻¹ − 1)/(n − 1) + 1/w − 1) with w = ρ/ρ₀, up to twice the density at rest.
    fn stored_energy(&self, density: f64, _energy: f64) -> Option<f64> {
        let c2 = self.bulk_modulus / self.reference_density;
        power_law::stored_energy(density / self.reference_density, c2, self.derivative)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let derivative = self.derivative;
        power_law::problems(self.reference_density)
            .positive("bulk_modulus", self.bulk_modulus)
            .must(
                (1.0..=20.0).contains(&derivative),
                "derivative",
                derivative,
                "between 1 and 20",
            )
            .list()
    }
}
