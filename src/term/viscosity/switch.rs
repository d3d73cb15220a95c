//! How a particle's own coefficient of viscosity follows the flow around it.
//! Each law's equation is in the law's file; here they have one face for the simulation.

use crate::particles::Fields;
use core::fmt::Debug;

/// What a switch sees of the flow around a particle.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<T> {
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

/// How a particle's own viscosity coefficient α follows the flow, once a step; see [`MorrisMonaghan`](super::MorrisMonaghan) and
/// [`CullenDehnen`](super::CullenDehnen).
pub trait Switch<T>: Debug + Send + Sync {
    /// The coefficient that a particle starts with: that of a fluid long at rest.
    fn start(&self) -> f64;
    /// The coefficient after `dt` \[s\].
    fn next(&self, alpha: T, around: &Surroundings<T>, dt: T) -> T;
    /// Fields that particles keep for it beside the coefficient: ∇·v for that of the step before.
    fn keeps(&self) -> Fields {
        Fields::NONE
    }
}
