//! Runge–Kutta methods: midpoint, strong-stability-preserving of order three, and the classical fourth.
//! Every part of the state is advanced by its rate; energy is not conserved to rounding.

use super::{Integrator, System};
use crate::error::Result;

/// The explicit midpoint rule: second order, two evaluations. Undamped waves grow by (ω dt)⁴/8 a step.
///
#[doc = include_str!("../../docs/equations/midpoint.html")]
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Midpoint;

impl Integrator for Midpoint {
    fn name(&self) -> String {
        "midpoint".into()
    }
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
        system.save(0);
        system.evaluate(0.0)?;
        system.combine(0, 0.0, 1.0, 0.5 * dt);
        system.evaluate(0.5 * dt)?;
        system.combine(0, 1.0, 0.0, dt);
        Ok(())
    }
    fn stability(&self) -> f64 {
        0.5
    }
    fn slots(&self) -> usize {
        1
    }
    fn kicks(&self) -> bool {
        false
    }
}

/// Three stages, third order, a convex combination of Euler steps (Shu & Osher 1988, eq. 2.18).
///
#[doc = include_str!("../../docs/equations/ssp_rk3.html")]
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StrongStabilityPreserving3;

impl Integrator for StrongStabilityPreserving3 {
    fn name(&self) -> String {
        "ssp-rk3".into()
    }
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
        system.save(0);
        system.evaluate(0.0)?;
        system.combine(0, 0.0, 1.0, dt);
        system.evaluate(dt)?;
        system.combine(0, 0.75, 0.25, 0.25 * dt);
        system.evaluate(0.5 * dt)?;
        system.combine(0, 1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0 * dt);
        Ok(())
    }
    fn stability(&self) -> f64 {
        0.866
    }
    fn slots(&self) -> usize {
        1
    }
    fn kicks(&self) -> bool {
        false
    }
}

/// The classical method of order four (Kutta 1901).
///
#[doc = include_str!("../../docs/equations/runge_kutta_4.html")]
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RungeKutta4;

impl Integrator for RungeKutta4 {
    fn name(&self) -> String {
        "rk4".into()
    }
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
        system.save(0);
        system.save(1);
        system.evaluate(0.0)?;
        system.accumulate(1, dt / 6.0);
        system.combine(0, 1.0, 0.0, 0.5 * dt);
        system.evaluate(0.5 * dt)?;
        system.accumulate(1, dt / 3.0);
        system.combine(0, 1.0, 0.0, 0.5 * dt);
        system.evaluate(0.5 * dt)?;
        system.accumulate(1, dt / 3.0);
        system.combine(0, 1.0, 0.0, dt);
        system.evaluate(dt)?;
        system.accumulate(1, dt / 6.0);
        system.load(1);
        Ok(())
    }
    fn stability(&self) -> f64 {
        1.414
    }
    fn slots(&self) -> usize {
        2
    }
    fn kicks(&self) -> bool {
        false
    }
}
