//! Strength: the yield stress of a solid, the trait and one file for each law.
//! It follows from plastic strain and its rate, temperature, pressure and density.
//!
//! A solid flows plastically where its von Mises stress σ = √(3/2 S:S) \[Pa\], with S the deviatoric stress, would pass
//! the yield stress Y \[Pa\]: the stress in simple tension at which it flows.
//!
//! | law | Y | use it for |
//! |---|---|---|
//! | [`PerfectPlasticity`] | Y₀ | a first answer; exact solutions |
//! | [`LinearHardening`] | Y₀ + H ε | metals at small plastic strain, benchmarks |
//! | [`PowerHardening`] | A + B εⁿ | metals at large plastic strain |
//! | [`JohnsonCook`] | (A + B εⁿ)(1 + C ln ε̇*)(1 − T*ᵐ) | impact of metals |
//! | [`CowperSymonds`] | of another law, times 1 + (ε̇/D)^(1/p) | mild steel, polymers |
//! | [`SteinbergGuinan`] | Y₀ (1 + β ε)ⁿ, with pressure and temperature | metals above 10⁵ 1/s and at high pressure |
//! | [`DruckerPrager`] | k + 3 β p | polymers, soil, concrete |
//! | [`TensionCompression`] | Y_t or Y_c by the sign of pressure | polymers |
//!
//! ε is the equivalent plastic strain ∫ √(2/3 Dᵖ:Dᵖ) dt. Bodies follow their laws under a scheme with the effect
//! [`Plasticity`](crate::effect::Plasticity); flow keeps volume in all of them.
//!
//! ```
//! use meshfree::material::{Material, catalogue, strength::{PlasticState, PowerHardening}};
//! let law = PowerHardening::new(90e6, 292e6, 0.31);
//! let copper: Material<f64> = catalogue::ofhc_copper().with_strength(law);
//! let strained = PlasticState { strain: 1.0, ..PlasticState::default() };
//! let yields = copper.strength().map(|law| law.yield_stress(&strained));
//! assert_eq!(yields, Some(382e6));
//! ```
//!
//! # A law of your own
//!
//! ```
//! use meshfree::material::{Material, catalogue, strength::{PlasticState, Strength}};
//! use meshfree::scalar::Lane;
//!
//! /// Voce's law of saturation, Y = Y∞ − (Y∞ − Y₀) e^(−ε/ε₀).
//! #[derive(Debug)]
//! struct Voce { first: f64, last: f64, strain: f64 }
//!
//! impl Strength for Voce {
//!     fn name(&self) -> &'static str { "Voce" }
//!     fn source(&self) -> &'static str { "Voce 1948" }
//!     #[inline(always)]
//!     fn yield_stress<L: Lane>(&self, state: &PlasticState<L>) -> L {
//!         let left = (-state.strain / L::of(self.strain)).exp();
//!         L::of(self.last) - L::of(self.last - self.first) * left
//!     }
//! }
//! let law = Voce { first: 50e6, last: 200e6, strain: 0.1 };
//! let alloy: Material<f32> = catalogue::aluminium().with_strength(law);
//! assert_eq!(alloy.strength().map(|law| law.name()), Some("Voce"));
//! ```

mod cowper_symonds;
mod drucker_prager;
mod heating;
mod johnson_cook;
mod linear_hardening;
mod perfect;
mod power_hardening;
mod steinberg_guinan;
mod tension_compression;

pub use cowper_symonds::CowperSymonds;
pub use drucker_prager::DruckerPrager;
pub use heating::PlasticHeating;
pub use johnson_cook::JohnsonCook;
pub(super) use johnson_cook::heat;
pub use linear_hardening::LinearHardening;
pub use perfect::PerfectPlasticity;
pub use power_hardening::PowerHardening;
pub use steinberg_guinan::SteinbergGuinan;
pub use tension_compression::TensionCompression;

use crate::scalar::Lane;
use core::fmt::Debug;

/// What a yield stress may follow from, of one particle or of a row of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlasticState<L = f64> {
    /// Equivalent plastic strain ε.
    pub strain: L,
    /// Its rate ε̇ \[1/s\].
    pub rate: L,
    /// Temperature T \[K\].
    pub temperature: L,
    /// Pressure p \[Pa\], positive in compression.
    pub pressure: L,
    /// Density over that at rest, ρ/ρ₀.
    pub density_ratio: L,
}

impl<L: Copy> PlasticState<L> {
    /// From its numbers in their order.
    #[inline(always)]
    pub(super) fn of([strain, rate, temperature, pressure, density_ratio]: [L; 5]) -> Self {
        Self {
            strain,
            rate,
            temperature,
            pressure,
            density_ratio,
        }
    }
    /// Its numbers in their order.
    #[inline(always)]
    pub(super) fn numbers(&self) -> [L; 5] {
        [
            self.strain,
            self.rate,
            self.temperature,
            self.pressure,
            self.density_ratio,
        ]
    }
}

impl Default for PlasticState {
    /// Slow, without strain and pressure, at [`ROOM_TEMPERATURE`].
    fn default() -> Self {
        Self {
            strain: 0.0,
            rate: 0.0,
            temperature: ROOM_TEMPERATURE,
            pressure: 0.0,
            density_ratio: 1.0,
        }
    }
}

/// 298.15 K: 25 °C, at which constants of laws are usually given.
pub const ROOM_TEMPERATURE: f64 = 298.15;

/// A yield stress, in the arithmetic of [lanes](Lane).
///
/// It is asked for a few times a row of particles and step, where one of them yields, in `f64` whatever the scalar of the
/// simulation. It must be finite and not negative for any finite state; zero is a liquid. Where it decides it takes
/// [`Lane::select`], so that it can be [recorded](crate::scalar::Record). Mark `yield_stress` `#[inline(always)]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a law of strength",
    note = "implement `Strength`: `yield_stress` returns the yield stress for a plastic state"
)]
pub trait Strength: Debug + Send + Sync + 'static {
    /// The law's name in reports.
    fn name(&self) -> &'static str;
    /// Author, year and equation.
    fn source(&self) -> &'static str;
    /// Yield stress Y \[Pa\].
    fn yield_stress<L: Lane>(&self, state: &PlasticState<L>) -> L;
    /// Whether it follows from temperature; then the material needs a
    /// [`PlasticHeating`](crate::material::Material::with_plastic_heating).
    fn uses_temperature(&self) -> bool {
        false
    }
    /// What is wrong with the parameters, as `(field, value, what it must be)`; empty if nothing.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}

/// A number is a constant yield stress \[Pa\], so that a material which has only that lends it as a law.
impl Strength for f64 {
    fn name(&self) -> &'static str {
        Strength::name(&PerfectPlasticity::new(*self))
    }
    fn source(&self) -> &'static str {
        Strength::source(&PerfectPlasticity::new(*self))
    }
    #[inline(always)]
    fn yield_stress<L: Lane>(&self, _state: &PlasticState<L>) -> L {
        L::of(*self)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Strength::problems(&PerfectPlasticity::new(*self))
    }
}
