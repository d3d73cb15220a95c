//! Monaghan–Gingold viscosity, taken back where the flow turns instead of closing in.
//! Balsara 1995.

use super::{ArtificialViscosity, Viscous, approach, below, between, coefficients, from_quotient};
use crate::particles::{Field, Fields};
use crate::scalar::Lane;
use crate::term::{Layout, Pair, TermDoc};

/// Monaghan–Gingold times ½ (fᵢ + fⱼ), f = |∇·v|/(|∇·v| + |∇×v| + 10⁻⁴ c/h).
///
/// In shear and rotation f falls to zero and angular momentum stays where it is; in a shock it is
/// one. Where a shock and a shear layer coincide it fails the shock. In 1D nothing turns and f = 1.
/// In 2D and 3D it needs the velocity gradient: a sweep before the rates, and D² numbers a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Balsara {
    /// Linear coefficient α; 1 for shocks.
    pub alpha: f64,
    /// Quadratic coefficient β; 2 for shocks.
    pub beta: f64,
}

impl Balsara {
    /// α = 1, β = 2, as Monaghan–Gingold.
    pub const STANDARD: Self = Self {
        alpha: 1.0,
        beta: 2.0,
    };
}

impl Default for Balsara {
    fn default() -> Self {
        Self::STANDARD
    }
}

/// Rates below this share of c/h are noise, and do not tell a shock from a shear.
const NOISE: f64 = 1e-4;

impl<const D: usize> ArtificialViscosity<D> for Balsara {
    const READS: Fields = if D == 1 {
        Fields::NONE
    } else {
        Fields::of(&[Field::VELOCITY_GRADIENT])
    };
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        let (alpha, beta) = (L::of(self.alpha), L::of(self.beta));
        if const { D == 1 } {
            return between(pair, approach(pair), alpha, beta);
        }
        // The same for both sides, so made once.
        let pair = &pair.forward();
        let noise = L::of(NOISE) / pair.h;
        let (mut of_i, mut of_j) = ([[L::zero(); D]; D], [[L::zero(); D]; D]);
        for a in 0..D {
            for b in 0..D {
                of_i[a][b] = pair.i_at(Field::VELOCITY_GRADIENT, a * D + b);
                of_j[a][b] = pair.j_at(Field::VELOCITY_GRADIENT, a * D + b);
            }
        }
        let (divergence_i, whole_i) = parts(&of_i, pair.i(Field::SOUND_SPEED) * noise);
        let (divergence_j, whole_j) = parts(&of_j, pair.j(Field::SOUND_SPEED) * noise);
        // That of a row is divided once for all of its neighbours; that of a neighbour shares the division of Π.
        let at_i = divergence_i / whole_i;
        let below = below(pair);
        let over = (below * whole_j).recip();
        let at_j = divergence_j * below * over;
        let viscous = from_quotient(pair, approach(pair) * whole_j * over, alpha, beta);
        let mean = (at_i + at_j) * L::of(0.5);
        Viscous {
            pi: viscous.pi * mean,
            signal: viscous.signal * mean,
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("Balsara viscosity, α = {}, β = {}", self.alpha, self.beta),
            equation: "Π as Monaghan–Gingold times ½ (fᵢ + fⱼ), f = |∇·v|/(|∇·v| + |∇×v| + 10⁻⁴ c/h)",
            source: "Balsara 1995",
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        coefficients(self.alpha, self.beta)
    }
}

/// |∇·v| and |∇·v| + |∇×v| + noise of a velocity gradient.
#[inline(always)]
fn parts<L: Lane, const D: usize>(gradient: &[[L; D]; D], noise: L) -> (L, L) {
    let mut divergence = L::zero();
    let mut curl2 = L::zero();
    for a in 0..D {
        divergence += gradient[a][a];
        for b in a + 1..D {
            let turn = gradient[a][b] - gradient[b][a];
            curl2 = turn.mul_add(turn, curl2);
        }
    }
    let divergence = divergence.abs();
    // Without flow and without sound there is nothing to damp: 0/(0 + tiny), whose product with what Π is divided by is in the
    // range of `f32`. A sum, because the compiler does not lift a maximum out of the loop, nor what follows from it.
    let noise = noise + L::of(1e-20);
    (divergence, divergence + curl2.sqrt() + noise)
}
