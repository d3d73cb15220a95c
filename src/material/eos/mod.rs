//! Equations of state: the trait, its guards, and one file for each law.
//! Pressure and sound speed follow from density ρ \[kg/m³\] and specific internal energy e \[J/kg\].

//!
//! | law | form | use it for |
//! |---|---|---|
//! | [`IdealGas`] | (γ−1) ρ e | gases |
//! | [`StiffenedGas`] | (γ−1) ρ e + γ p∞ η | shocks in liquids |
//! | [`Linear`] | c₀² (ρ−ρ₀) | acoustics, elastic solids |
//! | [`Tait`] | B \[(ρ/ρ₀)^γ − 1\] | weakly compressible liquids |
//! | [`Murnaghan`] | (K₀/n) \[(ρ/ρ₀)ⁿ − 1\] | static compression |
//! | [`Polynomial`] | cubic in μ, linear in e | tabulated constants |
//! | [`MieGruneisen`] | (1−Γη/2) p_H + Γρe | shocked solids and liquids |
//! | [`Tillotson`] | solid and vapour branch | hypervelocity impact |
//! | [`Jwl`] | two exponentials + ωρe | detonation products |
//! | [`TensionCutOff`] | max(p, p_min) | any of them, in tension |
//!
//! Choose by validity, not by cost: a law costs a few per cent of a step at most. Each law has a
//! range; outside it a guard steps in, and every such evaluation is counted, so a result that left
//! the range says so. Pressure and sound speed stay finite, and the sound speed positive, for any
//! finite density and energy.
//!
//! # A law of your own
//!
//! ```
//! use meshfree::material::eos::{EosState, EquationOfState, Guards};
//! use meshfree::{material::Material, scalar::Lane};
//!
//! /// Isothermal gas, p = c² ρ.
//! #[derive(Clone, Debug)]
//! struct Isothermal { sound_speed: f64 }
//!
//! impl EquationOfState for Isothermal {
//!     fn name(&self) -> &'static str { "isothermal gas" }
//!     fn reference_density(&self) -> f64 { 1.0 }
//!     fn uses_energy(&self) -> bool { false }
//!     fn state<L: Lane>(&self, density: L, _energy: L) -> EosState<L> {
//!         let c = L::of(self.sound_speed);
//!         EosState { pressure: density * c * c, sound_speed: c, guards: Guards::none() }
//!     }
//! }
//! let cloud = Material::<f32>::new("molecular cloud", Isothermal { sound_speed: 200.0 });
//! assert_eq!(cloud.state(2.0, 0.0), (80_000.0, 200.0));
//! ```

pub(super) mod guard;
mod ideal_gas;
mod jwl;
mod linear;
mod mie_gruneisen;
mod murnaghan;
mod polynomial;
mod power_law;
mod stiffened_gas;
mod tait;
mod tension_cut_off;
#[cfg(test)]
mod tests;
mod tillotson;

pub use ideal_gas::IdealGas;
pub use jwl::Jwl;
pub use linear::Linear;
pub use mie_gruneisen::{Hugoniot, MieGruneisen};
pub use murnaghan::Murnaghan;
pub use polynomial::Polynomial;
pub use stiffened_gas::StiffenedGas;
pub use tait::Tait;
pub use tension_cut_off::TensionCutOff;
pub use tillotson::Tillotson;

use crate::collective::Join;
use crate::scalar::{Lane, Mask};
use core::fmt::Debug;
use core::ops::AddAssign;

/// Pressure, sound speed and the guards that acted.
#[derive(Clone, Copy, Debug)]
pub struct EosState<L: Lane> {
    /// Pressure p \[Pa\], positive in compression.
    pub pressure: L,
    /// Adiabatic sound speed c \[m/s\].
    ///
    #[doc = include_str!("../../../docs/equations/sound_speed.html")]
    pub sound_speed: L,
    /// Where a guard replaced what the plain formula gives.
    pub guards: Guards<L>,
}

/// Where an equation of state left its range of validity and a guard stepped in.
/// The simulation counts them by kind ([`GuardCounts`]) and reports them; none acts in silence.
#[derive(Clone, Copy, Debug)]
pub struct Guards<L: Lane> {
    /// Compression beyond the fit: the pole of the Hugoniot is near.
    pub compression: L::Mask,
    /// Expansion or cold states in which the plain law is no longer hyperbolic (c² ≤ 0).
    pub expansion: L::Mask,
    /// Tension beyond the cut-off pressure.
    pub cut_off: L::Mask,
}

impl<L: Lane> Guards<L> {
    /// No guard acted.
    #[must_use]
    pub fn none() -> Self {
        let none = L::Mask::all_of(false);
        Self {
            compression: none,
            expansion: none,
            cut_off: none,
        }
    }
}

/// How often each kind of guard acted, in particle evaluations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GuardCounts {
    /// Evaluations beyond the compression limit.
    pub compression: u64,
    /// Evaluations beyond the expansion limit.
    pub expansion: u64,
    /// Evaluations beyond the tension cut-off.
    pub cut_off: u64,
}

impl GuardCounts {
    /// The sum over all kinds.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.compression + self.expansion + self.cut_off
    }

    /// Adds the elements of a row in which a guard acted.
    #[inline(always)]
    pub fn record<L: Lane>(&mut self, guards: &Guards<L>) {
        self.compression += guards.compression.count() as u64;
        self.expansion += guards.expansion.count() as u64;
        self.cut_off += guards.cut_off.count() as u64;
    }
}

impl AddAssign for GuardCounts {
    fn add_assign(&mut self, other: Self) {
        self.compression += other.compression;
        self.expansion += other.expansion;
        self.cut_off += other.cut_off;
    }
}

impl Join for GuardCounts {
    const NONE: Self = Self {
        compression: 0,
        expansion: 0,
        cut_off: 0,
    };
    fn and(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

/// An equation of state p(ρ, e).
///
/// Parameters are plain `f64` in SI units; `L::of(parameter)` brings one into the arithmetic.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an equation of state",
    note = "implement `EquationOfState`: `state` returns pressure and sound speed for density and energy"
)]
pub trait EquationOfState: Clone + Debug + Send + Sync + 'static {
    /// The law's name in reports.
    fn name(&self) -> &'static str;
    /// Density ρ₀ \[kg/m³\] at zero pressure and energy; for a gas the density it starts with.
    fn reference_density(&self) -> f64;
    /// Whether the pressure depends on internal energy; if not, a scene need not carry it.
    fn uses_energy(&self) -> bool;
    /// Pressure, sound speed and guards at density ρ \[kg/m³\] and internal energy e \[J/kg\].
    fn state<L: Lane>(&self, density: L, energy: L) -> EosState<L>;
    /// Energy over mass \[J/kg\] that the material stores at density ρ \[kg/m³\] and internal energy e \[J/kg\], where
    /// it is a function of these: ∫ p/ρ² dρ from the density at rest where the pressure depends on density alone, and e
    /// of a gas. `None` by default: a law that does not [use energy](Self::uses_energy) is then integrated by
    /// quadrature, and of one that does nothing can be said.
    ///
    /// [`Simulation::stored_energy`](crate::simulation::Simulation::stored_energy) holds it against the work of forces.
    fn stored_energy(&self, _density: f64, _energy: f64) -> Option<f64> {
        None
    }
    /// What is wrong with the parameters, as `(field, value, what it must be)`; empty if nothing.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}

/// Calls a macro with the list of all laws, as `name: value` pairs separated by semicolons, each
/// value with the constants of a real material. Tests and benchmarks over all laws take them here.
///
/// ```
/// macro_rules! count {
///     ($($name:ident: $law:expr);*) => { [$(stringify!($name)),*].len() };
/// }
/// assert!(meshfree::for_each_eos!(count) >= 11);
/// ```
#[macro_export]
macro_rules! for_each_eos {
    ($callback:ident) => {
        $callback! {
            ideal_gas: $crate::material::eos::IdealGas::new(1.4, 1.2);
            stiffened_gas: $crate::material::eos::StiffenedGas::water();
            linear: $crate::material::eos::Linear::new(1000.0, 1480.0);
            tait: $crate::material::eos::Tait::new(1000.0, 1480.0);
            tait_fraction: $crate::material::eos::Tait::new(1000.0, 1480.0).with_gamma(7.15);
            murnaghan: $crate::material::eos::Murnaghan::new(8930.0, 137e9, 5.0);
            polynomial: $crate::material::eos::Polynomial::new(
                8930.0, [0.0, 138.6e9, 274.5e9, 235.0e9, 2.02, 2.02, 0.0]);
            mie_gruneisen_cubic: $crate::material::eos::MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02)
                .with_form($crate::material::eos::Hugoniot::LamCubic);
            mie_gruneisen_full: $crate::material::eos::MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02);
            mie_gruneisen_ls_dyna: $crate::material::eos::MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02)
                .with_form($crate::material::eos::Hugoniot::LsDyna { s2: 0.1, s3: -0.05, a: 0.47 });
            tillotson: $crate::material::eos::Tillotson::aluminium();
            jwl: $crate::material::eos::Jwl::tnt();
            tension_cut_off: $crate::material::eos::TensionCutOff::new(
                $crate::material::eos::MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02), -1e9)
        }
    };
}
