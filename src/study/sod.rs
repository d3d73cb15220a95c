//! Sod's shock tube: rarefaction, contact and shock from a burst diaphragm.
//! The exact profile of density, velocity and pressure at any time.
//!
#![doc = include_str!("../../docs/equations/sod.html")]
//!
//! with γ = 1.4. Then p* = 0.30313, u* = 0.92745, ρ* = 0.42632 left and 0.26557 right of the contact,
//! and the shock runs at 1.75216.
//!
//! G. A. Sod, *Journal of Computational Physics* 27 (1978) 1–31; solved by [`riemann`](super::riemann).
//!
//! ```
//! use meshfree::study::sod::Sod;
//! let tube = Sod::new()?;
//! let profile = tube.profile(&[-0.4, 0.0, 0.1, 0.3, 0.4], 0.2)?;
//! assert!((profile[3].density - 0.26557).abs() < 1e-5);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::riemann::{Gas, GasState, RiemannProblem};
use super::{StudyError, positive};

/// Sod's shock tube with its diaphragm at x = 0.
#[derive(Clone, Debug)]
pub struct Sod {
    problem: RiemannProblem,
    gas: Gas,
}

impl Sod {
    /// The tube with the values of the 1978 paper.
    ///
    /// # Errors
    /// None with these values; the type is that of [`with_states`](Self::with_states).
    pub fn new() -> Result<Self, StudyError> {
        let rest = |density, pressure| GasState {
            density,
            velocity: 0.0,
            pressure,
        };
        Self::with_states(1.4, rest(1.0, 1.0), rest(0.125, 0.1))
    }
    /// A tube with one ideal gas and states of your own.
    ///
    /// # Errors
    /// As [`RiemannProblem::new`].
    pub fn with_states(gamma: f64, left: GasState, right: GasState) -> Result<Self, StudyError> {
        let gas = Gas::ideal(gamma);
        Ok(Self {
            problem: RiemannProblem::new(gas, left, gas, right)?,
            gas,
        })
    }
    /// The solved Riemann problem, for its star values and wave speeds.
    #[must_use]
    pub fn problem(&self) -> &RiemannProblem {
        &self.problem
    }
    /// The gas, for internal energy and sound speed of a state.
    #[must_use]
    pub fn gas(&self) -> &Gas {
        &self.gas
    }
    /// The states at the positions `x` at time `t` > 0.
    ///
    /// # Errors
    /// If the time is not larger than zero.
    pub fn profile(&self, x: &[f64], t: f64) -> Result<Vec<GasState>, StudyError> {
        positive("time [s]", t)?;
        Ok(x.iter().map(|x| self.problem.sample(x / t)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::super::riemann::Wave;
    use super::*;

    #[test]
    fn star_values_and_shock_speed() {
        let tube = Sod::new().unwrap();
        let problem = tube.problem();
        assert!((problem.star_pressure() - 0.30313).abs() < 5e-6);
        assert!((problem.star_velocity().unwrap() - 0.92745).abs() < 5e-6);
        let (left, right) = problem.star_densities();
        assert!((left - 0.42632).abs() < 5e-6 && (right - 0.26557).abs() < 5e-6);
        let Wave::Shock { speed } = problem.right_wave() else {
            panic!("no shock");
        };
        assert!((speed - 1.75216).abs() < 5e-6);
    }

    #[test]
    fn mass_momentum_and_energy_balance() {
        let tube = Sod::new().unwrap();
        let (n, t) = (200_000, 0.2);
        let dx = 1.0 / f64::from(n);
        let x: Vec<f64> = (0..n).map(|k| -0.5 + (f64::from(k) + 0.5) * dx).collect();
        let states = tube.profile(&x, t).unwrap();
        let sum = |f: &dyn Fn(&GasState) -> f64| states.iter().map(f).sum::<f64>() * dx;
        let energy = |s: &GasState| s.density * (tube.gas().energy(s) + 0.5 * s.velocity.powi(2));
        assert!((sum(&|s| s.density) - 0.5625).abs() < 1e-5);
        assert!((sum(&|s| s.density * s.velocity) - 0.9 * t).abs() < 1e-5);
        assert!((sum(&energy) - 1.375).abs() < 1e-5);
        assert!(tube.profile(&x, 0.0).is_err());
    }
}
