//! The time step: every criterion votes, and the simulation remembers which one set the step.
//! Reductions have a fixed order, so the step is the same on any number of threads.

use super::Simulation;
use crate::error::{Error, Result};
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::tensor::{Vector, length};
use rayon::prelude::*;

/// How the time step is chosen.
///
#[doc = include_str!("../../docs/equations/time_step.html")]
///
/// κ is what the integrator bears relative to a leapfrog
/// ([`stability`](crate::integrator::Integrator::stability)), and sᵢⱼ the signal that the viscosity in
/// use adds to the sound speed of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepControl {
    /// Factor C on h/(c + signal), where the signal is what the artificial viscosity in use adds;
    /// taken from the scheme by default (0.55).
    pub courant: f64,
    /// Factor C_a on √(h/|a|); 0.25 by default (Monaghan 1992).
    pub force: f64,
    /// Factor C_v on h² ρ/μ where a physical viscosity acts; 0.125 by default (Morris, Fox & Zhu 1997).
    pub viscous: f64,
    /// A fixed step \[s\], checked against the limit in every step.
    pub fixed: Option<f64>,
    /// Smallest step \[s\] before the run stops with [`Error::StepCollapsed`]; by default 10⁻⁶ of the
    /// first.
    pub smallest: Option<f64>,
}

impl Default for StepControl {
    fn default() -> Self {
        Self {
            courant: crate::scheme::DEFAULT_STEP_FACTOR,
            force: 0.25,
            viscous: 0.125,
            fixed: None,
            smallest: None,
        }
    }
}

/// What limits the step of a particle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// h/(c + signal): sound, with what the viscosity adds.
    Acoustic,
    /// √(h/|a|): forces.
    Force,
    /// h² ρ/μ: physical viscosity.
    Viscous,
    /// The step was given.
    Fixed,
    /// The step was cut to end at the time asked for.
    End,
}

impl Criterion {
    /// Its name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Acoustic => "acoustic: h/(c + viscous signal)",
            Self::Force => "force: sqrt(h/|a|)",
            Self::Viscous => "viscous: h² ρ/mu",
            Self::Fixed => "fixed",
            Self::End => "end of the run",
        }
    }
}

/// A vote on the time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vote {
    /// The step \[s\].
    pub step: f64,
    /// What set it.
    pub criterion: Criterion,
    /// The particle that set it, by its number in the whole simulation.
    pub particle: usize,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// The largest stable step at the present state, and what sets it.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if a particle's state is no longer finite, or its density not positive.
    pub fn vote(&self) -> Result<Vote> {
        let group = &self.group;
        let columns = &group.columns;
        let factor = self.control.courant * self.integrator.stability();
        let (c, rho) = (columns.raw(Field::SoundSpeed), columns.raw(Field::Density));
        let viscosity = columns.raw(Field::DynamicViscosity);
        let (mass, h) = (
            columns.raw(Field::Mass),
            columns.raw(Field::SmoothingLength),
        );
        let velocity = columns.vectors(Field::Velocity);
        let uniform = group.smoothing_length;
        let bad = Vote {
            step: -1.0,
            criterion: Criterion::Fixed,
            particle: usize::MAX,
        };
        let none = Vote {
            step: f64::INFINITY,
            criterion: Criterion::Acoustic,
            particle: usize::MAX,
        };
        // The lower slot wins a tie, whatever the order of reduction.
        let least = |a: Vote, b: Vote| {
            if b.step < a.step || (b.step == a.step && b.particle < a.particle) {
                b
            } else {
                a
            }
        };
        let gravity = Vector::<T, D>::from(self.gravity);
        let best = (0..group.mobile)
            .into_par_iter()
            .with_min_len(4096)
            .map(|slot| {
                let h = h.get(slot).map_or(uniform, |h| h.to_f64());
                let signal = group.rows.get(Output::Signal, 0, slot).to_f64();
                let acoustic = factor * h / (c[slot].to_f64() + signal);
                let force: Vector<T, D> = group.rows.vector(Output::Force, slot).into();
                let a = length(&(force / mass[slot] + gravity)).to_f64();
                let by_force = self.control.force * (h / a.max(f64::MIN_POSITIVE)).sqrt();
                let speed = velocity[slot].iter().fold(0.0, |s, v| s + v.to_f64().abs());
                let density = rho[slot].to_f64();
                let sound = (acoustic + a + speed).is_finite() && density > 0.0;
                if !sound {
                    return Vote {
                        particle: slot,
                        ..bad
                    };
                }
                let by_viscosity = viscosity.get(slot).map_or(f64::INFINITY, |mu| {
                    self.control.viscous * h * h * density / mu.to_f64()
                });
                let vote = |step, criterion| Vote {
                    step,
                    criterion,
                    particle: slot,
                };
                let by_force = vote(by_force, Criterion::Force);
                let acoustic = vote(acoustic, Criterion::Acoustic);
                least(
                    acoustic,
                    least(by_force, vote(by_viscosity, Criterion::Viscous)),
                )
            })
            .reduce(|| none, least);
        if best.step < 0.0 {
            return Err(self.broken(best.particle));
        }
        let particle = group
            .ids
            .get(best.particle)
            .map_or(usize::MAX, |&id| id as usize);
        Ok(Vote { particle, ..best })
    }

    /// The error that describes a particle whose state is no longer finite.
    fn broken(&self, slot: usize) -> Error {
        let group = &self.group;
        let columns = &group.columns;
        let number = |field: Field| columns.raw(field)[slot].to_f64();
        let force = group.rows.get(Output::Force, 0, slot).to_f64();
        let candidates = [
            ("density", number(Field::Density)),
            ("pressure", number(Field::Pressure)),
            ("sound speed", number(Field::SoundSpeed)),
            (
                "velocity",
                columns.vectors(Field::Velocity)[slot][0].to_f64(),
            ),
            ("force", force),
        ];
        let wrong = |&(name, value): &(&str, f64)| {
            !value.is_finite() || (name == "density" && value <= 0.0)
        };
        let (quantity, value) = candidates.into_iter().find(wrong).unwrap_or(candidates[0]);
        let body = &group.bodies[group.body_of(slot)];
        Error::NotFinite {
            quantity,
            value,
            body: body.name.clone(),
            particle: group.ids[slot] as usize - body.slots.start,
            position: columns.vectors(Field::Position)[slot]
                .iter()
                .map(|x| x.to_f64())
                .collect(),
            time: self.time,
            step: self.steps,
        }
    }
}
