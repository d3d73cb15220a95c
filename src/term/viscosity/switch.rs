//! How a particle's own coefficient of viscosity follows the flow around it.
//! Each law's equation is in the law's file; here they have one face for the simulation.

use super::{cullen_dehnen, morris_monaghan};
use crate::scalar::Real;

/// How a particle's own viscosity coefficient α follows the flow, once a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Switch {
    /// dα/dt = −(α − α_min) ℓ c/h + max(−∇·v, 0) (α_max − α); see
    /// [`MorrisMonaghan`](super::MorrisMonaghan).
    MorrisMonaghan {
        /// Coefficient far from shocks.
        minimum: f64,
        /// Largest coefficient.
        maximum: f64,
        /// Decay rate ℓ in units of c/h.
        decay: f64,
    },
    /// α jumps up where the flow steepens, and decays behind; see
    /// [`CullenDehnen`](super::CullenDehnen).
    CullenDehnen {
        /// Largest coefficient.
        maximum: f64,
        /// Decay length ℓ.
        decay: f64,
    },
}

/// What a switch sees of the flow around a particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surroundings<T> {
    /// ∇·v \[1/s\].
    pub divergence: T,
    /// ∇·v of the step before \[1/s\].
    pub divergence_before: T,
    /// Mean sign of ∇·v, from −1 to 1.
    pub divergence_sign: T,
    /// tr S Sᵀ of the traceless shear \[1/s²\].
    pub shear2: T,
    /// Sound speed \[m/s\].
    pub sound_speed: T,
    /// Largest signal speed towards a neighbour \[m/s\].
    pub signal_speed: T,
    /// Smoothing length \[m\].
    pub h: T,
    /// Radius of the support \[m\].
    pub support: T,
}

impl Switch {
    /// The coefficient that a particle starts with: that of a fluid long at rest.
    #[must_use]
    pub fn start(&self) -> f64 {
        match *self {
            Self::MorrisMonaghan { minimum, .. } => minimum,
            Self::CullenDehnen { .. } => 0.0,
        }
    }

    /// The coefficient after `dt`.
    pub(crate) fn next<T: Real>(&self, alpha: T, around: &Surroundings<T>, dt: T) -> T {
        let of = T::from_f64;
        match *self {
            Self::MorrisMonaghan {
                minimum,
                maximum,
                decay,
            } => {
                let decay_rate = of(decay) * around.sound_speed / around.h;
                let bounds = (of(minimum), of(maximum));
                morris_monaghan::next(bounds, alpha, decay_rate, around.divergence, dt)
            }
            Self::CullenDehnen { maximum, decay } => {
                cullen_dehnen::next(of(maximum), of(decay), alpha, around, dt)
            }
        }
    }
}
