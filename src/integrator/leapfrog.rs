//! Leapfrogs: kick–drift–kick, drift–kick–drift, and the two-evaluation position Verlet.
//! Second order; without dissipation reversible in time, with bounded energy error.

use super::{Integrator, System};
use crate::error::Result;

/// Kick–drift–kick (velocity Verlet): one evaluation a step.
///
#[doc = include_str!("../../docs/equations/kick_drift_kick.html")]
///
/// Forces that depend on velocity or
/// energy see both predicted to the end of the step with the last rates, without which the step is
/// first order in them.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct KickDriftKick;

impl Integrator for KickDriftKick {
    fn name(&self) -> String {
        "kick-drift-kick".into()
    }
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
        if !system.has_rates() {
            system.evaluate(0.0)?;
        }
        system.kick(0.5 * dt);
        system.drift(dt, 0.0)?;
        system.predict(0.5 * dt);
        system.evaluate(dt)?;
        system.restore();
        system.kick(0.5 * dt);
        Ok(())
    }
}

/// Drift–kick–drift: forces at half steps, velocity and energy predicted there.
///
#[doc = include_str!("../../docs/equations/drift_kick_drift.html")]
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DriftKickDrift;

impl Integrator for DriftKickDrift {
    fn name(&self) -> String {
        "drift-kick-drift".into()
    }
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
        if !system.has_rates() {
            system.evaluate(0.0)?;
        }
        system.drift(0.5 * dt, 0.0)?;
        system.predict(0.5 * dt);
        system.evaluate(0.5 * dt)?;
        system.restore();
        system.kick(dt);
        system.drift(0.5 * dt, 0.5 * dt)
    }
}

/// Position Verlet with two evaluations: the half step is taken with fresh rates, so velocity-dependent
/// forces are second order even where rates change fast.
///
/// a evaluated at tₙ predicts v½ and e½; then as [`DriftKickDrift`].
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PositionVerlet;

impl Integrator for PositionVerlet {
    fn name(&self) -> String {
        "position-verlet".into()
    }
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
        system.evaluate(0.0)?;
        system.drift(0.5 * dt, 0.0)?;
        system.predict(0.5 * dt);
        system.evaluate(0.5 * dt)?;
        system.restore();
        system.kick(dt);
        system.drift(0.5 * dt, 0.5 * dt)
    }
}
