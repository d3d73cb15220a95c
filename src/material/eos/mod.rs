//! Equations of state: the trait, its guards, and one file for each law.
//! Pressure and sound speed follow from density ρ \[kg/m³\] and specific internal energy e \[J/kg\].

use crate::scalar::{Lane, Mask};
use core::fmt::Debug;

/// Pressure, sound speed and the guards that acted.
#[derive(Clone, Copy, Debug)]
pub struct EosState<L: Lane> {
    /// Pressure p \[Pa\], positive in compression.
    pub pressure: L,
    /// Adiabatic sound speed c \[m/s\], c² = ∂p/∂ρ|ₑ + (p/ρ²) ∂p/∂e|ᵨ.
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
    /// What is wrong with the parameters, as `(field, value, what it must be)`; empty if nothing.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}
