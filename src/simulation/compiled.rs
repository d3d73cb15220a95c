//! Steps and what is read of a simulation as a whole, which this crate compiles once for `f64`.
//! A driver is as large as the loops of a dozen schemes.

use super::{Cost, Ledger, Simulation};
use crate::error::Result;
use crate::once::compiled_once;
use crate::output::vtu::Vtu;
use crate::scalar::Real;
#[cfg(feature = "checkpoint")]
use std::path::Path;

/// What drives a simulation, and what is read of it.
pub(super) struct Driver<T: Real, const D: usize> {
    pub step: fn(&mut Simulation<T, D>, f64) -> Result<f64>,
    pub evaluate: fn(&mut Simulation<T, D>) -> Result<()>,
    pub ledger: fn(&Simulation<T, D>) -> Ledger,
    pub cost: fn(&Simulation<T, D>) -> Cost,
    pub vtu: fn(&Simulation<T, D>) -> Vtu,
    #[cfg(feature = "checkpoint")]
    pub save: fn(&Simulation<T, D>, &Path) -> Result<()>,
}

impl<T: Real, const D: usize> Driver<T, D> {
    const OWN: Self = Self {
        step: Simulation::advance,
        evaluate: Simulation::evaluate_rates,
        ledger: Simulation::balance,
        cost: Simulation::cost_by_effect,
        vtu: Simulation::as_vtu,
        #[cfg(feature = "checkpoint")]
        save: Simulation::write,
    };
}

compiled_once!(Driver);
