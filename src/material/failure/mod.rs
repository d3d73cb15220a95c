//! Failure: how much nearer a step brings a solid to its end, the trait and one file for each law.
//! It follows from stress, plastic strain and its rate, temperature and pressure.
//!
//! Damage D of a particle grows from zero as its material's law says, and at one the particle has failed: it supports no
//! shear and no tension from then on, and its mass stays.
//!
//! | law | D grows | use it for |
//! |---|---|---|
//! | [`JohnsonCookFailure`] | by Δε/ε_f(σ*, ε̇, T) | ductile metals under impact |
//! | [`PlasticStrainLimit`] | to one at a plastic strain | a first answer |
//! | [`PrincipalStressLimit`] | to one at a largest principal stress | brittle solids |
//! | [`SpallStrength`] | to one at a tension −p | plates that spall |
//!
//! Bodies follow their laws under a scheme with the effect [`Damage`](crate::effect::Damage).
//!
//! ```
//! use meshfree::material::{Material, catalogue, failure::{FailureState, SpallStrength}};
//! let copper: Material<f64> = catalogue::ofhc_copper().with_failure(SpallStrength::new(1.2e9));
//! let pulled = FailureState { pressure: -1.3e9, ..FailureState::default() };
//! assert_eq!(copper.failure().map(|law| law.damage(&pulled)), Some(1.0));
//! ```
//!
//! # A law of your own
//!
//! ```
//! use meshfree::material::{Material, catalogue, failure::{Failure, FailureState}};
//! use meshfree::scalar::Lane;
//!
//! /// Cockcroft & Latham: the work of the largest principal stress on the plastic strain.
//! #[derive(Debug)]
//! struct CockcroftLatham { work: f64 }
//!
//! impl Failure for CockcroftLatham {
//!     fn name(&self) -> &'static str { "Cockcroft–Latham" }
//!     fn source(&self) -> &'static str { "Cockcroft & Latham 1968" }
//!     #[inline(always)]
//!     fn damage<L: Lane>(&self, state: &FailureState<L>) -> L {
//!         state.principal_stress.positive_part() * state.increment / L::of(self.work)
//!     }
//!     fn uses_plastic_strain(&self) -> bool { true }
//! }
//! let alloy: Material<f32> = catalogue::aluminium().with_failure(CockcroftLatham { work: 2e8 });
//! assert_eq!(alloy.failure().map(|law| law.name()), Some("Cockcroft–Latham"));
//! ```

mod johnson_cook;
mod plastic_strain;
mod principal_stress;
mod spall;

pub use johnson_cook::JohnsonCookFailure;
pub use plastic_strain::PlasticStrainLimit;
pub use principal_stress::PrincipalStressLimit;
pub use spall::SpallStrength;

use super::strength::ROOM_TEMPERATURE;
use crate::scalar::Lane;
use core::fmt::Debug;

/// What a step may do harm by, of one particle or of a row of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FailureState<L = f64> {
    /// Equivalent plastic strain ε at the end of the step.
    pub strain: L,
    /// What the step has added to it, Δε.
    pub increment: L,
    /// Its rate ε̇ \[1/s\].
    pub rate: L,
    /// Temperature T \[K\].
    pub temperature: L,
    /// Pressure p \[Pa\], positive in compression.
    pub pressure: L,
    /// The stress of von Mises √(3/2 S:S) \[Pa\].
    pub von_mises: L,
    /// The largest principal stress \[Pa\], positive in tension.
    pub principal_stress: L,
}

impl<L: Copy> FailureState<L> {
    /// From its numbers in their order.
    #[inline(always)]
    pub(super) fn of(
        [
            strain,
            increment,
            rate,
            temperature,
            pressure,
            von_mises,
            principal_stress,
        ]: [L; 7],
    ) -> Self {
        Self {
            strain,
            increment,
            rate,
            temperature,
            pressure,
            von_mises,
            principal_stress,
        }
    }
    /// Its numbers in their order.
    #[inline(always)]
    pub(super) fn numbers(&self) -> [L; 7] {
        [
            self.strain,
            self.increment,
            self.rate,
            self.temperature,
            self.pressure,
            self.von_mises,
            self.principal_stress,
        ]
    }
}

impl Default for FailureState {
    /// Without stress and strain, at [`ROOM_TEMPERATURE`].
    fn default() -> Self {
        Self {
            strain: 0.0,
            increment: 0.0,
            rate: 0.0,
            temperature: ROOM_TEMPERATURE,
            pressure: 0.0,
            von_mises: 0.0,
            principal_stress: 0.0,
        }
    }
}

impl<L: Lane> FailureState<L> {
    /// The stress triaxiality σ* = −p/σ of the stress σ of von Mises; infinite where there is pressure alone, zero
    /// without stress.
    ///
    /// ```
    /// use meshfree::material::failure::FailureState;
    /// // Simple tension.
    /// let pulled = FailureState { pressure: -1e8, von_mises: 3e8, ..FailureState::default() };
    /// assert!((pulled.triaxiality() - 1.0 / 3.0).abs() < 1e-15);
    /// ```
    #[must_use]
    #[inline(always)]
    pub fn triaxiality(&self) -> L {
        let none = self.pressure.abs().le(L::zero());
        L::select(none, L::zero(), -self.pressure / self.von_mises)
    }
}

/// What a step adds to damage, in the arithmetic of [lanes](Lane).
///
/// It is asked once a row of particles and step, in `f64` whatever the scalar of the simulation. It must not be negative; one
/// or more is failure at once. Where it decides it takes [`Lane::select`], so that it can be
/// [recorded](crate::scalar::Record). Mark `damage` `#[inline(always)]`, as a [`Strength`](super::strength::Strength).
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a law of failure",
    note = "implement `Failure`: `damage` returns what a step adds to the damage"
)]
pub trait Failure: Debug + Send + Sync + 'static {
    /// The law's name in reports.
    fn name(&self) -> &'static str;
    /// Author, year and equation.
    fn source(&self) -> &'static str;
    /// What the step adds to the damage D.
    fn damage<L: Lane>(&self, state: &FailureState<L>) -> L;
    /// Whether it follows from plastic strain; then the scheme needs [`Plasticity`](crate::effect::Plasticity).
    fn uses_plastic_strain(&self) -> bool {
        false
    }
    /// Whether it follows from temperature; then the material needs a
    /// [`PlasticHeating`](crate::material::Material::with_plastic_heating).
    fn uses_temperature(&self) -> bool {
        false
    }
    /// The pressure \[Pa\], negative, at which it fails, of a law of pressure alone.
    fn pressure_at_failure(&self) -> Option<f64> {
        None
    }
    /// What is wrong with the parameters, as `(field, value, what it must be)`; empty if nothing.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}

/// The parameters that are not finite and positive.
fn not_positive(parameters: &[(&'static str, f64)]) -> Vec<(&'static str, f64, &'static str)> {
    parameters
        .iter()
        .filter(|(_, value)| !(value.is_finite() && *value > 0.0))
        .map(|&(name, value)| (name, value, "it must be finite and positive"))
        .collect()
}
