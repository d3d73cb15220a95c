//! The tension cut-off: a wrapper that keeps the pressure of any law above a limit.
//! p = max(p_law, p_min).

use super::{EosState, EquationOfState};
use crate::scalar::Lane;

/// Any equation of state with a tension cut-off.
///
#[doc = include_str!("../../../docs/equations/tension_cut_off.html")]
///
/// The sound speed stays that of the law: it sets time steps and viscosity, and the derivative of
/// the cut pressure, which is zero, would serve neither. Customary limits: metals −1 to −5 GPa
/// (spall), PMMA about −0.1 GPa, degassed water 0 to −1 MPa, a liquid with a free surface 0. Each
/// cut is counted under `cut_off`. A material of any law has the same by
/// [`with_pressure_cut_off`](crate::material::Material::with_pressure_cut_off).
///
/// ```
/// use meshfree::material::eos::{EquationOfState, Linear, TensionCutOff};
/// let water = TensionCutOff::new(Linear::new(1000.0, 1480.0), 0.0);
/// let stretched = water.state(999.0_f64, 0.0);
/// assert_eq!(stretched.pressure, 0.0);
/// assert!(stretched.guards.cut_off);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct TensionCutOff<E> {
    /// The law that is cut.
    pub law: E,
    /// Least pressure p_min \[Pa\], zero or negative.
    pub minimum_pressure: f64,
}

impl<E: EquationOfState> TensionCutOff<E> {
    /// A law and its least pressure \[Pa\].
    #[must_use]
    pub const fn new(law: E, minimum_pressure: f64) -> Self {
        Self {
            law,
            minimum_pressure,
        }
    }
}

impl<E: EquationOfState> EquationOfState for TensionCutOff<E> {
    fn name(&self) -> &'static str {
        self.law.name()
    }
    fn reference_density(&self) -> f64 {
        self.law.reference_density()
    }
    fn uses_energy(&self) -> bool {
        self.law.uses_energy()
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, energy: L) -> EosState<L> {
        let mut state = self.law.state(density, energy);
        let least = L::of(self.minimum_pressure);
        let below = state.pressure.lt(least);
        state.guards.cut_off = state.guards.cut_off | below;
        // Not the larger of the two, which is a valid number even where the law gives none.
        state.pressure = L::select(below, least, state.pressure);
        state
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = self.law.problems();
        let limit = self.minimum_pressure;
        if !(limit.is_finite() && limit <= 0.0) {
            problems.push(("minimum_pressure", limit, "zero or negative, and finite"));
        }
        problems
    }
}
