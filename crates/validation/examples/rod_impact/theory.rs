//! The exact solutions of a case: linear waves without a grid, and the Godunov reference.
//! The second has the equation of state of the particles, and so the true heights of plateaus.

use super::Failure;
use super::cases::{Case, material};
use meshfree::study::acoustic_rods::{AcousticRods, AcousticSolution, RodSegment};
use meshfree::study::godunov_rods::{self, GodunovRods, GodunovSolution, PressureFn};
use meshfree::study::{Joint, StudyError};
use std::sync::Arc;

/// Both solutions.
#[derive(Clone, Debug)]
pub struct Theory {
    pub acoustic: AcousticSolution,
    pub reference: GodunovSolution,
}

impl Theory {
    /// Solves a case; its probes are the reference's gauges. `cells` are those of the reference.
    pub fn of(case: &Case, cells: usize) -> Result<Self, Failure> {
        let mut chain = GodunovRods::new(cells);
        for (k, rod) in case.rods().iter().enumerate() {
            let material = material(&rod.material)?;
            let density = material.reference_density();
            if k == case.head() + 1 {
                chain = chain.contact(case.contact().in_theory());
            }
            let law = PressureFn(move |density: f64, energy: f64| material.state(density, energy));
            let segment = godunov_rods::RodSegment::at_rest(Arc::new(law), rod.length(), density);
            chain = chain.segment(segment.moving(rod.speed));
        }
        if case.target.is_none() {
            chain = chain.right_end(case.contact().wall());
        }
        for &x0 in &case.probes {
            chain = chain.gauge(x0.min(case.length()));
        }
        for &time in &case.snapshots {
            chain = chain.snapshot(time.min(case.until));
        }
        Ok(Self {
            acoustic: waves(case)?,
            reference: chain.solve(case.until)?,
        })
    }

    /// Where the striker, or its pad, meets the target or wall.
    pub fn contact(case: &Case) -> Joint {
        if case.target.is_some() {
            Joint::Between(case.head())
        } else {
            Joint::Right
        }
    }
}

/// The states of a material point between the arrivals of linear waves, as (from, until, stress) in
/// SI units; states shorter than `shortest` \[s\] are left out.
pub fn steps_of(
    waves: &AcousticSolution,
    x0: f64,
    shortest: f64,
) -> Result<Vec<(f64, f64, f64)>, StudyError> {
    let history = waves.history(x0)?;
    let ends = history.iter().skip(1).map(|step| step.time);
    let steps = history.iter().zip(ends.chain([waves.until()]));
    Ok(steps
        .map(|(step, end)| (step.time, end, step.stress))
        .filter(|(from, end, _)| end - from >= shortest)
        .collect())
}

/// The exact linear waves of a case.
pub fn waves(case: &Case) -> Result<AcousticSolution, Failure> {
    let mut waves = AcousticRods::new();
    for (k, rod) in case.rods().iter().enumerate() {
        let material = material(&rod.material)?;
        let density = material.reference_density();
        if k == case.head() + 1 {
            waves = waves.contact(case.contact().in_theory());
        }
        waves = waves.segment(RodSegment {
            length: rod.length(),
            density,
            sound_speed: material.impedance() / density,
            velocity: rod.speed,
        });
    }
    if case.target.is_none() {
        waves = waves.right_end(case.contact().wall());
    }
    Ok(waves.solve(case.until)?)
}
