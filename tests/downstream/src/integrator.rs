//! An integrator: symplectic Euler, a kick and then a drift; first order, but its energy does not drift.
//! E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), section I.1.

use meshfree::error::Result;
use meshfree::integrator::{Integrator, System};

/// Symplectic Euler.
#[derive(Clone, Copy, Debug)]
pub struct SymplecticEuler;

impl Integrator for SymplecticEuler {
    fn name(&self) -> String {
        "symplectic Euler".into()
    }
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
        system.evaluate(0.0)?;
        system.kick(dt);
        system.drift(dt, 0.0)
    }
    fn stability(&self) -> f64 {
        1.0
    }
}
