//! The artificial viscosity of Monaghan and Gingold: linear and quadratic in the approach of a pair.
//! Monaghan & Gingold 1983; Lam, Shen & Gong 2002, equations 22–24 with the sign of α corrected.

use super::{ArtificialViscosity, Viscous, approach, between, coefficients};
use crate::particles::Fields;
use crate::scalar::Lane;
use crate::term::{Layout, Pair, TermDoc};

/// Πᵢⱼ = (−α c̄ μ + β μ²)/ρ̄ for approaching pairs, μ = h vᵢⱼ·rᵢⱼ/(r² + 0.01 h²).
///
/// Lam, Shen & Gong print +α c̄ μ: with μ < 0 on approach that feeds energy into the flow.
///
/// In smooth flow it acts as a viscosity: ½ α h c times the strain rate along a plane compression,
/// whatever D, and α h c/(4 (D + 2)) in shear, half of what Monaghan (2005) gives for a form that acts
/// on receding pairs too. It reads no field of its own, and no law is cheaper.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct MonaghanGingold {
    /// Linear coefficient α; 1 for shocks.
    pub alpha: f64,
    /// Quadratic coefficient β; 2 for shocks, which keeps particles from passing through each other.
    pub beta: f64,
}

impl MonaghanGingold {
    /// α = 1, β = 2: what Monaghan & Gingold found enough for shocks of any strength.
    pub const STANDARD: Self = Self {
        alpha: 1.0,
        beta: 2.0,
    };
}

impl Default for MonaghanGingold {
    fn default() -> Self {
        Self::STANDARD
    }
}

impl<const D: usize> ArtificialViscosity<D> for MonaghanGingold {
    const READS: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        between(pair, approach(pair), L::of(self.alpha), L::of(self.beta))
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!(
                "Monaghan–Gingold viscosity, α = {}, β = {}",
                self.alpha, self.beta
            ),
            equation: "Π = (−α c̄ μ + β μ²)/ρ̄, μ = h v·r/(r² + 0.01 h²), v·r < 0",
            source: "Monaghan & Gingold 1983; Lam, Shen & Gong 2002, eq. 22",
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        coefficients(self.alpha, self.beta)
    }
}
