//! An artificial viscosity: linear and quadratic in the approach, with the larger of the two sound speeds.
//! J. von Neumann, R. D. Richtmyer, Journal of Applied Physics 21 (1950) 232–237, and R. Landshoff (1955).

use meshfree::particles::{Field, Fields};
use meshfree::scalar::Lane;
use meshfree::term::{ArtificialViscosity, Layout, Pair, TermDoc, Viscous};

/// Π = (α c μ + β μ²)/ρ̄ for pairs that approach, with the larger sound speed c.
#[derive(Clone, Copy, Debug)]
pub struct Richtmyer {
    /// Linear coefficient α.
    pub alpha: f64,
    /// Quadratic coefficient β.
    pub beta: f64,
}

impl<const D: usize> ArtificialViscosity<D> for Richtmyer {
    const READS: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        let approach = (-pair.v_dot_r).positive_part();
        let mu = pair.h * approach / pair.h.mul_add(pair.h * L::of(0.01), pair.r2);
        let c = pair.i(Field::SOUND_SPEED).max(pair.j(Field::SOUND_SPEED));
        let strength = mu.mul_add(L::of(self.beta), c * L::of(self.alpha));
        let density = (pair.i(Field::DENSITY) + pair.j(Field::DENSITY)) * L::of(0.5);
        Viscous {
            pi: strength * mu / density,
            signal: strength * L::of(1.2),
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("viscosity α = {}, β = {}", self.alpha, self.beta),
            equation: "Π = (α c μ + β μ²)/ρ̄, μ = h |v·r|/(r² + 0.01 h²), v·r < 0",
            source: "von Neumann & Richtmyer 1950; Landshoff 1955",
        }
    }
}
