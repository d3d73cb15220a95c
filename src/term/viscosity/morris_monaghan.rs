//! Viscosity with a coefficient for every particle, which compression raises and time lowers.
//! Morris & Monaghan 1997, with the source of Rosswog et al. 2000.

use super::{ArtificialViscosity, Surroundings, Switch, SwitchObject, Viscous, between_own};
use crate::particles::{Field, Fields};
use crate::scalar::Lane;
use crate::term::{Layout, Pair, TermDoc};

/// Monaghan–Gingold with ᾱ = ½ (αᵢ + αⱼ) and β = 2 ᾱ, whose α rises in shocks and decays behind them.
///
/// dα/dt = −(α − α_min) ℓ c/h + max(−∇·v, 0) (α_max − α).
///
/// Away from shocks viscosity is a tenth of the usual. What a shock of jump Δv adds is about
/// α_max Δv/c, so it serves shocks with Δv of the order of c, and not the weak shocks of an impact at
/// some metres a second. One number a particle, and the rate of compression in the rates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct MorrisMonaghan {
    /// Coefficient far from shocks; 0.1, which keeps particles in order.
    pub minimum: f64,
    /// Largest coefficient; 1.5 for shocks.
    pub maximum: f64,
    /// Decay rate ℓ in units of c/h; 0.2, so that a shock is forgotten five h behind it.
    pub decay: f64,
    /// β/α; 2.
    pub beta_over_alpha: f64,
}

impl MorrisMonaghan {
    /// α from 0.1 to 1.5, ℓ = 0.2, β = 2 α.
    pub const STANDARD: Self = Self {
        minimum: 0.1,
        maximum: 1.5,
        decay: 0.2,
        beta_over_alpha: 2.0,
    };
}

impl Default for MorrisMonaghan {
    fn default() -> Self {
        Self::STANDARD
    }
}

impl<const D: usize> ArtificialViscosity<D> for MorrisMonaghan {
    const READS: Fields = Fields::of(&[Field::VISCOSITY_COEFFICIENT]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        between_own(pair, self.beta_over_alpha)
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!(
                "Morris–Monaghan viscosity, α from {} to {}, ℓ = {}, β = {} α",
                self.minimum, self.maximum, self.decay, self.beta_over_alpha
            ),
            equation: "Π as Monaghan–Gingold with ½ (αᵢ + αⱼ), dα/dt = −(α − α_min) ℓ c/h + max(−∇·v, 0) (α_max − α)",
            source: "Morris & Monaghan 1997; source term Rosswog et al. 2000",
        }
    }
    fn switch(&self) -> Option<Box<dyn SwitchObject>> {
        Some(Box::new(*self))
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = super::not_negative(&[
            ("minimum", self.minimum),
            ("beta/alpha", self.beta_over_alpha),
        ]);
        if !(self.maximum.is_finite() && self.maximum >= self.minimum) {
            let must_be = "must be finite and not below the minimum";
            problems.push(("maximum", self.maximum, must_be));
        }
        if !(self.decay.is_finite() && self.decay > 0.0) {
            problems.push(("decay", self.decay, "must be finite and positive"));
        }
        problems
    }
}

impl Switch for MorrisMonaghan {
    fn start(&self) -> f64 {
        self.minimum
    }
    /// The exact solution at constant rates, which stays between its bounds.
    #[inline(always)]
    fn next<L: Lane>(&self, alpha: L, around: &Surroundings<L>, dt: L) -> L {
        let [minimum, maximum, decay] = [self.minimum, self.maximum, self.decay].map(L::of);
        let decay_rate = decay * around.sound_speed / around.h;
        let source = (-around.divergence).positive_part();
        let rate = decay_rate + source;
        let equilibrium = (decay_rate * minimum + source * maximum) / rate;
        let next = equilibrium + (alpha - equilibrium) * (-(rate * dt)).exp();
        L::select(rate.le(L::zero()), alpha, next)
    }
}
