//! The dissipation of a Riemann solver between two particles, limited where the flow is gentle.
//! Zhang, Hu & Adams 2017; impedances of unlike materials as in Rezavand, Zhang & Hu 2020.

use super::{ArtificialViscosity, Viscous, closing_speed, coefficients};
use crate::particles::{Field, Fields};
use crate::scalar::Lane;
use crate::term::{Layout, Pair, TermDoc};

/// Πᵢⱼ = 2 p_d/(ρᵢ ρⱼ) with the dissipative part p_d = α b Z w of the pressure between two states
/// that meet: p* = ½ (pᵢ + pⱼ) + b Z w, Z = ρᵢcᵢ ρⱼcⱼ/(ρᵢcᵢ + ρⱼcⱼ), w = −vᵢⱼ·rᵢⱼ/|rᵢⱼ| > 0.
///
/// In one material Z = ½ ρ c, which is equation 13 of the paper; between two it is the impedance that
/// an impact really meets. The limiter b = min(3 w/c̄, 1) leaves gentle flow almost without
/// dissipation: below w = c/3 the law is quadratic, as Monaghan–Gingold with α = 0 and β = 3. A large
/// limiter gives the full solver, which is close to Monaghan–Gingold with α = 1. It reads no field of
/// its own; a square root and a division a pair more than Monaghan–Gingold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Riemann {
    /// Share α of the solver's dissipation; 1.
    pub alpha: f64,
    /// Factor of the limiter on w/c̄; 3 by the paper's tests with breaking waves.
    pub limiter: f64,
}

impl Riemann {
    /// α = 1, limiter 3.
    pub const STANDARD: Self = Self {
        alpha: 1.0,
        limiter: 3.0,
    };
}

impl Default for Riemann {
    fn default() -> Self {
        Self::STANDARD
    }
}

impl<const D: usize> ArtificialViscosity<D> for Riemann {
    const READS: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        let closing = closing_speed(pair);
        let (c_i, c_j) = (pair.i(Field::SOUND_SPEED), pair.j(Field::SOUND_SPEED));
        let sound_speed = (c_i + c_j) * L::of(0.5);
        let share = closing * L::of(self.limiter) / sound_speed;
        // In a vacuum there is neither sound nor impedance.
        let sounding = sound_speed.gt(L::zero());
        let share = L::select(sounding, share.min(L::one()), L::zero()) * L::of(self.alpha);
        // Z/(ρᵢ ρⱼ) = cᵢ cⱼ/(ρᵢcᵢ + ρⱼcⱼ).
        let impedances = pair
            .i(Field::DENSITY)
            .mul_add(c_i, pair.j(Field::DENSITY) * c_j);
        let impedances = L::select(sounding, impedances, L::one());
        let dissipated = share * closing * c_i * c_j / impedances;
        Viscous {
            pi: dissipated + dissipated,
            signal: share * sound_speed * L::of(0.6),
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!(
                "Riemann viscosity, α = {}, limiter {}",
                self.alpha, self.limiter
            ),
            equation: "Π = 2 α b w cᵢcⱼ/(ρᵢcᵢ + ρⱼcⱼ), b = min(limiter w/c̄, 1), w = −v·r/|r| > 0",
            source: "Zhang, Hu & Adams 2017, eqs. 13, 14",
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = coefficients(self.alpha, 0.0);
        problems.extend(super::not_negative(&[("limiter", self.limiter)]));
        problems
    }
}
