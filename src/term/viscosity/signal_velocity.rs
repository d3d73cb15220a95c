//! The artificial viscosity that scales with the speed at which the waves of a pair meet.
//! Monaghan 1997, after the dissipation of a Riemann solver.

use super::{ArtificialViscosity, Viscous, closing_speed, coefficients};
use crate::particles::{Field, Fields};
use crate::scalar::Lane;
use crate::term::{Layout, Pair, TermDoc};

/// Πᵢⱼ = ½ α v_sig w/ρ̄ for approaching pairs, v_sig = cᵢ + cⱼ + β w, w = −vᵢⱼ·rᵢⱼ/|rᵢⱼ|.
///
/// Unlike [`MonaghanGingold`](super::MonaghanGingold) it has no factor h/r, so particles that come
/// very close are not held apart more than the jump of their velocities asks for, and the step does
/// not shrink there. With equal sound speeds α is that of Monaghan–Gingold, and β = 3 is its β of
/// 1.5 α. It reads no field of its own; a square root a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct SignalVelocity {
    /// Strength α = 2K; 1 for shocks (Monaghan 1997: K = 0.5).
    pub alpha: f64,
    /// Share β of the closing speed in the signal velocity; 3 keeps the estimate above the shock speed
    /// of a strong shock in a gas (Springel 2005, eq. 13).
    pub beta: f64,
}

impl SignalVelocity {
    /// α = 1, β = 3.
    pub const STANDARD: Self = Self {
        alpha: 1.0,
        beta: 3.0,
    };
}

impl Default for SignalVelocity {
    fn default() -> Self {
        Self::STANDARD
    }
}

impl<const D: usize> ArtificialViscosity<D> for SignalVelocity {
    const READS: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        let closing = closing_speed(pair);
        let sound_speeds = pair.i(Field::SOUND_SPEED) + pair.j(Field::SOUND_SPEED);
        let densities = pair.i(Field::DENSITY) + pair.j(Field::DENSITY);
        let half_signal = closing.mul_add(L::of(self.beta), sound_speeds) * L::of(0.5 * self.alpha);
        Viscous {
            pi: (half_signal + half_signal) * closing / densities,
            signal: half_signal * L::of(0.6),
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!(
                "signal-velocity viscosity, α = {}, β = {}",
                self.alpha, self.beta
            ),
            equation: "Π = ½ α (cᵢ + cⱼ + β w) w/ρ̄, w = −v·r/|r| > 0",
            source: "Monaghan 1997, sect. 4",
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        coefficients(self.alpha, self.beta)
    }
}
