//! The dissipation of a Riemann solver between two particles, limited where the flow is gentle.
//! Zhang, Hu & Adams 2017; impedances of unlike materials as in Rezavand, Zhang & Hu 2020.

use super::{ArtificialViscosity, Viscous, coefficients, distance};
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
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
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
        let closing = (-pair.v_dot_r).positive_part();
        let (c_i, c_j) = (pair.i(Field::SOUND_SPEED), pair.j(Field::SOUND_SPEED));
        // Twice the mean, and Z/(ρᵢ ρⱼ) = cᵢ cⱼ/(ρᵢcᵢ + ρⱼcⱼ).
        let sound_speeds = c_i + c_j;
        let impedances = pair
            .i(Field::DENSITY)
            .mul_add(c_i, pair.j(Field::DENSITY) * c_j);
        // One division serves the limiter and the impedances. In a vacuum there is neither: what stands above it is zero.
        let below = distance(pair) * sound_speeds * impedances;
        let sounding = below.gt(L::zero());
        let over = closing / L::select(sounding, below, L::one());
        let limited = over * impedances * L::of(2.0 * self.limiter);
        let share = limited.min(L::one()) * L::of(self.alpha);
        Viscous {
            pi: share * over * (c_i * (c_j + c_j) * sound_speeds),
            signal: share * sound_speeds * L::of(0.3),
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
