//! The power law of Ostwald and de Waele, between two bounds.
//! μ(γ̇) = K γ̇ⁿ⁻¹.

use super::{ViscosityLaw, at_most};
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// The power law of Ostwald (1925) and de Waele (1923), held between two viscosities.
///
/// ```text
/// μ(γ̇) = min(max(K γ̇ⁿ⁻¹, μ_least), μ_greatest)
/// ```
///
/// n < 1 thins under shear, n > 1 thickens. The plain law is infinite at γ̇ = 0 if n < 1, and vanishes
/// there if n > 1; the bounds have no default because they are the ends of the measured range.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct PowerLaw {
    /// Consistency K \[Pa sⁿ\]: the stress at γ̇ = 1/s.
    pub consistency: f64,
    /// Index n \[1\]; 1 is Newtonian.
    pub index: f64,
    /// Least viscosity \[Pa s\].
    pub least: f64,
    /// Greatest viscosity \[Pa s\]; it sets the viscous time step.
    pub greatest: f64,
}

impl PowerLaw {
    /// K \[Pa sⁿ\], n \[1\], and the least and greatest viscosity \[Pa s\].
    #[must_use]
    pub const fn new(consistency: f64, index: f64, least: f64, greatest: f64) -> Self {
        Self {
            consistency,
            index,
            least,
            greatest,
        }
    }
}

impl ViscosityLaw for PowerLaw {
    fn name(&self) -> &'static str {
        "power law"
    }
    #[inline(always)]
    fn viscosity<L: Lane>(&self, shear_rate: L) -> L {
        let plain = L::of(self.consistency) * shear_rate.powf(self.index - 1.0);
        let least = L::of(self.least);
        at_most(L::select(plain.lt(least), least, plain), self.greatest)
    }
    fn greatest_viscosity(&self) -> f64 {
        self.greatest
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .positive("consistency", self.consistency)
            .must(
                self.index > 0.0 && self.index <= 5.0,
                "index",
                self.index,
                "above 0 and at most 5",
            )
            .not_negative("least", self.least)
            .must(
                self.greatest.is_finite() && self.greatest >= self.least,
                "greatest",
                self.greatest,
                "finite and not below the least viscosity",
            )
            .list()
    }
}
