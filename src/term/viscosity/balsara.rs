//! Monaghan–Gingold viscosity, taken back where the flow turns instead of closing in.
//! Balsara 1995.

use super::{ArtificialViscosity, Viscous, approach, between, coefficients};
use crate::particles::{Field, Fields};
use crate::scalar::Lane;
use crate::term::{Layout, Pair, TermDoc};

/// Monaghan–Gingold times ½ (fᵢ + fⱼ), f = |∇·v|/(|∇·v| + |∇×v| + 10⁻⁴ c/h).
///
/// In shear and rotation f falls to zero and angular momentum stays where it is; in a shock it is
/// one. Where a shock and a shear layer coincide it fails the shock. In 1D nothing turns and f = 1.
/// In 2D and 3D it needs the velocity gradient: a sweep before the rates, and D² numbers a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
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
        let mut viscous = between(pair, approach(pair), L::of(self.alpha), L::of(self.beta));
        if const { D > 1 } {
            let noise = L::of(NOISE) / pair.h;
            let at_i = factor::<L, D>(
                |k| pair.i_at(Field::VELOCITY_GRADIENT, k),
                pair.i(Field::SOUND_SPEED) * noise,
            );
            let at_j = factor::<L, D>(
                |k| pair.j_at(Field::VELOCITY_GRADIENT, k),
                pair.j(Field::SOUND_SPEED) * noise,
            );
            let mean = (at_i + at_j) * L::of(0.5);
            viscous.pi *= mean;
            viscous.signal *= mean;
        }
        viscous
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

/// |∇·v|/(|∇·v| + |∇×v| + noise) from the velocity gradient, row by row.
#[inline(always)]
fn factor<L: Lane, const D: usize>(gradient: impl Fn(usize) -> L, noise: L) -> L {
    let mut divergence = L::zero();
    let mut curl2 = L::zero();
    for a in 0..D {
        divergence += gradient(a * D + a);
        for b in a + 1..D {
            let turn = gradient(a * D + b) - gradient(b * D + a);
            curl2 = turn.mul_add(turn, curl2);
        }
    }
    let divergence = divergence.abs();
    // Without flow and without sound there is nothing to damp: 0/(0 + tiny).
    let whole = divergence + curl2.sqrt() + noise.max(L::of(1e-30));
    divergence / whole
}
