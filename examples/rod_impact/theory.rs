//! The exact solutions of a case: linear waves without a grid, and the Godunov reference.
//! The second has the equation of state of the particles, and so the true heights of plateaus.

use crate::cases::{Case, material};
use meshfree::error::Result;
use meshfree::study::acoustic_rods::{AcousticRods, AcousticSolution, RodSegment};
use meshfree::study::godunov_rods::{self, GodunovRods, GodunovSolution, PressureFn};
use meshfree::study::{Joint, StudyError};
use std::error::Error;
use std::sync::Arc;

/// Both solutions.
#[derive(Clone, Debug)]
pub struct Theory {
    pub acoustic: AcousticSolution,
    pub reference: GodunovSolution,
}

impl Theory {
    /// Solves a case; its probes are the reference's gauges. `cells` are those of the reference.
    pub fn of(
        case: &Case,
        cells: usize,
    ) -> std::result::Result<Self, Box<dyn Error + Send + Sync>> {
        let mut waves = AcousticRods::new();
        let mut chain = GodunovRods::new(cells);
        for (k, rod) in case.rods().iter().enumerate() {
            let material = material::<f64>(&rod.material)?;
            let density = material.reference_density();
            if k == case.head() + 1 {
                waves = waves.contact(case.contact().in_theory());
                chain = chain.contact(case.contact().in_theory());
            }
            waves = waves.segment(RodSegment {
                length: rod.length(),
                density,
                sound_speed: material.impedance() / density,
                velocity: rod.speed,
            });
            let law = PressureFn(move |density: f64, energy: f64| material.state(density, energy));
            let segment = godunov_rods::RodSegment::at_rest(Arc::new(law), rod.length(), density);
            chain = chain.segment(segment.moving(rod.speed));
        }
        if case.target.is_none() {
            waves = waves.right_end(case.contact().wall());
            chain = chain.right_end(case.contact().wall());
        }
        for &x0 in &case.probes {
            chain = chain.gauge(x0.min(case.length()));
        }
        for &time in &case.snapshots {
            chain = chain.snapshot(time.min(case.until));
        }
        Ok(Self {
            acoustic: waves.solve(case.until)?,
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

    /// The states of a material point between the arrivals of linear waves, as
    /// (from, until, stress); states shorter than `shortest` \[s\] are left out.
    pub fn steps(
        &self,
        x0: f64,
        shortest: f64,
    ) -> std::result::Result<Vec<(f64, f64, f64)>, StudyError> {
        let history = self.acoustic.history(x0)?;
        let ends = history.iter().skip(1).map(|step| step.time);
        let steps = history.iter().zip(ends.chain([self.acoustic.until()]));
        Ok(steps
            .map(|(step, end)| (step.time, end, step.stress))
            .filter(|(from, end, _)| end - from >= shortest)
            .collect())
    }
}

/// A step function of time at a material point as points to draw: the linear waves.
pub fn stress_steps(waves: &AcousticSolution, x0: f64, until: f64) -> Result<Vec<(f64, f64)>> {
    let history = waves.history(x0).unwrap_or_default();
    let mut points: Vec<_> = history.iter().map(|s| (s.time, s.stress)).collect();
    points.retain(|point| point.0 <= until);
    if let Some(&(_, last)) = points.last() {
        points.push((until, last));
    }
    Ok(points)
}
