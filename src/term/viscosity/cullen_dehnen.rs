//! Viscosity with a coefficient for every particle, which jumps up where the flow steepens.
//! Cullen & Dehnen 2010, with the converging-flow condition of Borrow et al. 2022.

use super::{
    ArtificialViscosity, Surroundings, Switch, SwitchObject, Viscous, between_own, closing_speed,
};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;
use crate::term::{Layout, Pair, Sums, TermDoc};

/// Monaghan–Gingold with ᾱ = ½ (αᵢ + αⱼ) and β = 2 ᾱ, whose α rises ahead of shocks.
///
/// Each α is at least
///
/// α_loc = α_max H² A/(v² + H² A), A = ξ max(−d(∇·v)/dt, 0) where ∇·v < 0,
///
/// and decays to it as dα/dt = (α_loc − α) 2ℓ v/H. H is the radius of the support and v the largest
/// signal speed c̄ − min(0, vᵢⱼ·rᵢⱼ/|rᵢⱼ|) within it. The limiter
/// ξ = s²/(s² + tr S Sᵀ), s = 2 (1 − R)⁴ ∇·v, with the traceless shear S and R the mean sign of ∇·v
/// around the particle, is one in a shock and small in shear and noise.
///
/// A is large ahead of a shock, where ∇·v itself is still small, so α is up before the shock arrives.
/// Scaled with v² it is made for shocks of Mach 1.1 and more: weaker ones, as of an impact at some
/// metres a second, it takes for sound. Two numbers a particle, and in 2D and 3D the velocity
/// gradient. Velocities that a scene starts with count as having just appeared.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct CullenDehnen {
    /// Largest coefficient α_max; 2.
    pub maximum: f64,
    /// Decay length ℓ; 0.05, so that a coefficient lives for ten support radii behind a shock.
    pub decay: f64,
    /// β/α; 2.
    pub beta_over_alpha: f64,
}

impl CullenDehnen {
    /// α_max = 2, ℓ = 0.05, β = 2 α.
    pub const STANDARD: Self = Self {
        maximum: 2.0,
        decay: 0.05,
        beta_over_alpha: 2.0,
    };
}

impl Default for CullenDehnen {
    fn default() -> Self {
        Self::STANDARD
    }
}

impl<const D: usize> ArtificialViscosity<D> for CullenDehnen {
    const READS: Fields = if D == 1 {
        Fields::of(&[Field::VISCOSITY_COEFFICIENT])
    } else {
        Fields::of(&[Field::VISCOSITY_COEFFICIENT, Field::DIVERGENCE])
    };
    const NEEDS: Fields = if D == 1 {
        <Self as ArtificialViscosity<D>>::READS
    } else {
        // The switch tells shear from shocks.
        <Self as ArtificialViscosity<D>>::READS.union(Fields::of(&[Field::VELOCITY_GRADIENT]))
    };
    const WRITES: Outputs = if D == 1 {
        Outputs::of(&[Output::SIGNAL_SPEED])
    } else {
        Outputs::of(&[Output::SIGNAL_SPEED, Output::DIVERGENCE_SIGN, Output::UNITY])
    };
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        between_own(pair, self.beta_over_alpha)
    }
    #[inline(always)]
    fn sums<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let sound_speeds = pair.i(Field::SOUND_SPEED) + pair.j(Field::SOUND_SPEED);
        let speed = sound_speeds.mul_add(L::of(0.5), closing_speed(pair));
        let inside = pair.f.lt(L::zero());
        sums.raise(Output::SIGNAL_SPEED, L::select(inside, speed, L::zero()));
        if const { D > 1 } {
            let weight = pair.j(Field::MASS) / pair.j(Field::DENSITY) * pair.w;
            let divergence = pair.j(Field::DIVERGENCE);
            let positive = L::select(divergence.gt(L::zero()), weight, L::zero());
            let negative = L::select(divergence.lt(L::zero()), weight, L::zero());
            sums.add(Output::DIVERGENCE_SIGN, positive - negative);
            sums.add(Output::UNITY, weight);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!(
                "Cullen–Dehnen viscosity, α up to {}, ℓ = {}, β = {} α",
                self.maximum, self.decay, self.beta_over_alpha
            ),
            equation: "Π as Monaghan–Gingold with ½ (αᵢ + αⱼ), α ≥ α_max H²A/(v² + H²A), A = ξ max(−d(∇·v)/dt, 0), dα/dt = (α_loc − α) 2ℓ v/H",
            source: "Cullen & Dehnen 2010, sect. 3; condition ∇·v < 0 Borrow et al. 2022",
        }
    }
    fn switch(&self) -> Option<Box<dyn SwitchObject>> {
        Some(Box::new(*self))
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = super::not_negative(&[
            ("maximum", self.maximum),
            ("beta/alpha", self.beta_over_alpha),
        ]);
        if !(self.decay.is_finite() && self.decay > 0.0) {
            problems.push(("decay", self.decay, "must be finite and positive"));
        }
        problems
    }
}

impl Switch for CullenDehnen {
    fn start(&self) -> f64 {
        0.0
    }
    fn keeps(&self) -> Fields {
        Fields::of(&[Field::DIVERGENCE])
    }
    #[inline(always)]
    fn next<L: Lane>(&self, alpha: L, around: &Surroundings<L>, dt: L) -> L {
        let zero = L::zero();
        let rate = (around.divergence_before - around.divergence) / dt;
        let converges = around.divergence.lt(zero);
        let steepening = L::select(converges, rate.positive_part(), zero);
        let strength = around.support * around.support * limiter(around) * steepening;
        let speed2 = around.signal_speed * around.signal_speed;
        let local = L::of(self.maximum) * strength / (speed2 + strength);
        let local = L::select(strength.gt(zero), local, zero);
        let rate = L::of(self.decay) * L::of(2.0) * around.signal_speed / around.support;
        let decayed = local + (alpha - local) * (-(rate * dt)).exp();
        L::select(local.ge(alpha), local, decayed)
    }
}

/// ξ of the surroundings.
#[inline(always)]
fn limiter<L: Lane>(around: &Surroundings<L>) -> L {
    let apart = (L::one() - around.divergence_sign).positive_part();
    let closing = L::of(2.0) * apart.powi(4) * around.divergence;
    let closing2 = closing * closing;
    let share = closing2 / (closing2 + around.shear2);
    L::select(around.shear2.gt(L::zero()), share, L::one())
}
