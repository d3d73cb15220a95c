//! Rheology: how the viscosity of a liquid follows from its shear rate, one file for each law.
//! A law is evaluated once a particle and step, like an equation of state.
//!
//! A generalised Newtonian liquid has the viscous stress τ = 2 μ(γ̇) D, with D \[1/s\] the symmetric
//! part of the velocity gradient without its trace, γ̇ = √(2 D:D) \[1/s\] the shear rate and μ \[Pa s\]
//! the dynamic viscosity. In plain shear γ̇ is |du/dy| and |τ| = μ(γ̇) γ̇.
//!
//! | law | μ(γ̇) | use it for |
//! |---|---|---|
//! | [`Newtonian`] | μ | water, oil, air |
//! | [`PowerLaw`] | K γ̇ⁿ⁻¹ between a least and a greatest value | a fit over a range of shear rates |
//! | [`Cross`] | μ∞ + (μ₀−μ∞) / (1 + (λγ̇)ᵐ) | suspensions, paints |
//! | [`CarreauYasuda`] | μ∞ + (μ₀−μ∞) (1 + (λγ̇)ᵃ)⁽ⁿ⁻¹⁾ᐟᵃ | polymer solutions and melts, blood |
//! | [`HerschelBulkley`] | K γ̇ⁿ⁻¹ + τ_y (1 − e^(−mγ̇)) / γ̇ | muds, pastes, fresh concrete |
//!
//! Every law is bounded: its [greatest viscosity](ViscosityLaw::greatest_viscosity) sets the viscous
//! time step, about h² ρ/(8 μ). Liquids follow their laws under a scheme with
//! [`GeneralisedNewtonian`](crate::effect::GeneralisedNewtonian).
//!
//! ```
//! use meshfree::material::{Material, catalogue, rheology::CarreauYasuda};
//! // Blood (Cho & Kensey 1991).
//! let law = CarreauYasuda::new(0.056, 3.45e-3, 3.313, 0.3568);
//! let blood: Material<f64> = catalogue::water().with_rheology(law);
//! let rheology = blood.rheology().expect("it has just been given one");
//! assert_eq!(rheology.viscosity(0.0), 0.056);
//! assert!(rheology.viscosity(1e3) < 0.004);
//! ```
//!
//! # A law of your own
//!
//! ```
//! use meshfree::material::{Material, catalogue, rheology::ViscosityLaw};
//! use meshfree::scalar::Lane;
//!
//! /// The Ellis-like law μ = μ₀ / (1 + λγ̇).
//! #[derive(Clone, Debug)]
//! struct Hyperbolic { at_rest: f64, time: f64 }
//!
//! impl ViscosityLaw for Hyperbolic {
//!     fn name(&self) -> &'static str { "hyperbolic" }
//!     #[inline(always)]
//!     fn viscosity<L: Lane>(&self, shear_rate: L) -> L {
//!         L::of(self.at_rest) / shear_rate.mul_add(L::of(self.time), L::one())
//!     }
//!     fn greatest_viscosity(&self) -> f64 { self.at_rest }
//! }
//! let law = Hyperbolic { at_rest: 2.0, time: 0.5 };
//! let slurry: Material<f32> = catalogue::water().with_rheology(law);
//! let rheology = slurry.rheology().expect("it has just been given one");
//! assert_eq!([0.0, 2.0].map(|rate| rheology.viscosity(rate)), [2.0, 1.0]);
//! ```

mod carreau_yasuda;
mod cross;
mod herschel_bulkley;
mod newtonian;
mod power_law;
#[cfg(test)]
mod tests;

pub use carreau_yasuda::CarreauYasuda;
pub use cross::Cross;
pub use herschel_bulkley::HerschelBulkley;
pub use newtonian::Newtonian;
pub use power_law::PowerLaw;

use crate::scalar::Lane;
use core::fmt::Debug;

/// A viscosity that follows from the shear rate, μ(γ̇).
///
/// Parameters are plain `f64` in SI units; `L::of(parameter)` brings one into the arithmetic, which is in the scalar of the
/// simulation. Mark `viscosity` `#[inline(always)]`, as a [`Strength`](super::strength::Strength).
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a viscosity law",
    note = "implement `ViscosityLaw`: `viscosity` returns the dynamic viscosity for a shear rate"
)]
pub trait ViscosityLaw: Clone + Debug + Send + Sync + 'static {
    /// The law's name in reports.
    fn name(&self) -> &'static str;
    /// Dynamic viscosity μ \[Pa s\] at a shear rate γ̇ ≥ 0 \[1/s\]; finite at γ̇ = 0.
    fn viscosity<L: Lane>(&self, shear_rate: L) -> L;
    /// The largest viscosity \[Pa s\] at any shear rate, for the viscous time step.
    fn greatest_viscosity(&self) -> f64;
    /// What is wrong with the parameters, as `(field, value, what it must be)`; empty if nothing.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}

/// A number is a constant viscosity \[Pa s\], so that a material which has only that lends it as a law.
impl ViscosityLaw for f64 {
    fn name(&self) -> &'static str {
        Newtonian::new(*self).name()
    }
    #[inline(always)]
    fn viscosity<L: Lane>(&self, _shear_rate: L) -> L {
        L::of(*self)
    }
    fn greatest_viscosity(&self) -> f64 {
        *self
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Newtonian::new(*self).problems()
    }
}

/// `value`, or `greatest` where it is larger; what is no number stays so, and is found out.
#[inline(always)]
fn at_most<L: Lane>(value: L, greatest: f64) -> L {
    let greatest = L::of(greatest);
    L::select(value.gt(greatest), greatest, value)
}
