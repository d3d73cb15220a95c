//! Equation 22 of Lam, Shen & Gong (2002) with the sign that is printed: a control, not a remedy.
//! Its linear term pushes approaching particles together and feeds energy into the flow.

use super::{ArtificialViscosity, Viscous, approach, between, coefficients};
use crate::particles::Fields;
use crate::scalar::Lane;
use crate::term::{Layout, Pair, TermDoc};

/// Πᵢⱼ = (+α c̄ μ + β μ²)/ρ̄ for approaching pairs, as printed.
///
/// With μ < 0 on approach Π is negative as long as |μ| < α c̄/β, so the pair attracts. In rods
/// that collide pressure grows without bound, where [`MonaghanGingold`](super::MonaghanGingold) stays at the exact plateau
/// (`tests/solids/misprints.rs`).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct LamPrinted {
    /// Linear coefficient α.
    pub alpha: f64,
    /// Quadratic coefficient β.
    pub beta: f64,
}

impl<const D: usize> ArtificialViscosity<D> for LamPrinted {
    const READS: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        let corrected = between(pair, approach(pair), L::of(self.alpha), L::of(self.beta));
        let printed = between(pair, approach(pair), L::of(-self.alpha), L::of(self.beta));
        Viscous {
            pi: printed.pi,
            signal: corrected.signal,
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!(
                "viscosity as printed by Lam, Shen & Gong, α = {}, β = {}",
                self.alpha, self.beta
            ),
            equation: "Π = (+α c̄ μ + β μ²)/ρ̄, μ = h v·r/(r² + ε h²), v·r < 0",
            source: "Lam, Shen & Gong 2002, eq. 22 as printed; the sign of α is a misprint",
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        coefficients(self.alpha, self.beta)
    }
}
