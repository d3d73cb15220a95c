//! Monaghan–Gingold viscosity on what linear reconstruction leaves of the velocity jump.
//! Christensen 1990; Frontiere, Raskin & Owen 2017; limiter of van Leer 1979.

use super::{ArtificialViscosity, Viscous, between, coefficients};
use crate::particles::{Field, Fields};
use crate::scalar::Lane;
use crate::term::{Layout, Pair, TermDoc, left_of_jump};

/// Monaghan–Gingold with the jump that linear reconstruction leaves: vᵢⱼ − φ ½ (∇vᵢ + ∇vⱼ) rᵢⱼ.
///
/// φ = min(1, 2 min(x, 1/x)) with x the ratio of the two velocity gradients along the pair, zero if
/// they differ in sign. Where the flow is smooth almost no jump is left, and no viscosity: fronts
/// stay three times steeper than with the plain form at the same overshoot.
///
/// It needs the velocity gradient: a sweep before the rates, and D² numbers a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct LimitedMonaghanGingold {
    /// Linear coefficient α; 2 leaves no overshoot behind a front whose dispersion is corrected,
    /// and 5 keeps it under 2 % where it is not. In gases 1, with β = 1: 2 % over in Sod's tube.
    pub alpha: f64,
    /// Quadratic coefficient β.
    pub beta: f64,
}

impl LimitedMonaghanGingold {
    /// α = 2, β = 2: no overshoot behind a weak shock whose dispersion is corrected.
    pub const STANDARD: Self = Self {
        alpha: 2.0,
        beta: 2.0,
    };
}

impl Default for LimitedMonaghanGingold {
    fn default() -> Self {
        Self::STANDARD
    }
}

impl<const D: usize> ArtificialViscosity<D> for LimitedMonaghanGingold {
    const READS: Fields = Fields::of(&[Field::VELOCITY_GRADIENT]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        between(
            pair,
            limited_jump(pair).min(L::zero()),
            L::of(self.alpha),
            L::of(self.beta),
        )
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!(
                "limited Monaghan–Gingold viscosity, α = {}, β = {}",
                self.alpha, self.beta
            ),
            equation: "Π as Monaghan–Gingold with vᵢⱼ − φ ½ (∇vᵢ + ∇vⱼ) rᵢⱼ, φ = min(1, 2 min(x, 1/x))",
            source: "Christensen 1990; Frontiere, Raskin & Owen 2017, sect. 3.4; limiter van Leer 1979",
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        coefficients(self.alpha, self.beta)
    }
}

/// vᵢⱼ·rᵢⱼ less what linear reconstruction from both sides explains; never of the opposite sign.
#[inline(always)]
fn limited_jump<L: Lane, const D: usize, P: Layout>(pair: &Pair<'_, L, D, P>) -> L {
    let (mut at_i, mut at_j) = (L::zero(), L::zero());
    for a in 0..D {
        for b in 0..D {
            let rr = pair.r[a] * pair.r[b];
            at_i = pair
                .i_at(Field::VELOCITY_GRADIENT, a * D + b)
                .mul_add(rr, at_i);
            at_j = pair
                .j_at(Field::VELOCITY_GRADIENT, a * D + b)
                .mul_add(rr, at_j);
        }
    }
    left_of_jump(pair.v_dot_r, at_i, at_j)
}
