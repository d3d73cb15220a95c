//! The Newtonian law: a viscosity that does not depend on the shear rate.
//! μ(γ̇) = μ.

use super::ViscosityLaw;
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// The Newtonian law, τ = μ γ̇ (Newton 1687).
///
/// [`Material::with_dynamic_viscosity`](crate::material::Material::with_dynamic_viscosity) is a
/// shorter way to the same liquid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Newtonian {
    /// Dynamic viscosity μ \[Pa s\]; water at 20 °C has 10⁻³.
    pub dynamic_viscosity: f64,
}

impl Newtonian {
    /// μ \[Pa s\].
    #[must_use]
    pub const fn new(dynamic_viscosity: f64) -> Self {
        Self { dynamic_viscosity }
    }
}

impl ViscosityLaw for Newtonian {
    fn name(&self) -> &'static str {
        "Newtonian"
    }
    #[inline(always)]
    fn viscosity<L: Lane>(&self, _shear_rate: L) -> L {
        L::of(self.dynamic_viscosity)
    }
    fn greatest_viscosity(&self) -> f64 {
        self.dynamic_viscosity
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .not_negative("dynamic_viscosity", self.dynamic_viscosity)
            .list()
    }
}
