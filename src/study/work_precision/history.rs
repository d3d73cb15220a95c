//! A quantity over time, as a run is watched, and the numbers that are read from it.
//! Plateau, peak, impulse and the time of an event.

use crate::study::StudyError;
use crate::study::norms::{first_crossing, overshoot, plateau_mean, rise_10_90};

/// Samples of a quantity over time.
///
/// ```
/// use meshfree::study::work_precision::History;
/// let mut force = History::new();
/// for k in 0..=100 {
///     let t = 0.01 * f64::from(k);
///     force.push(t, 4.0 * t.min(1.0 - t));
/// }
/// assert!((force.peak() - 2.0).abs() < 1e-12 && (force.impulse() - 1.0).abs() < 1e-12);
/// assert!((force.event(1.0)? - 0.25).abs() < 1e-12);
/// # Ok::<(), meshfree::study::StudyError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct History {
    times: Vec<f64>,
    values: Vec<f64>,
}

impl History {
    /// Without samples.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a sample; times \[s\] must increase.
    pub fn push(&mut self, time: f64, value: f64) {
        self.times.push(time);
        self.values.push(value);
    }

    /// The times \[s\].
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The values.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The mean between two times \[s\].
    ///
    /// # Errors
    /// If the samples do not cover them.
    pub fn plateau(&self, from: f64, to: f64) -> Result<f64, StudyError> {
        plateau_mean(&self.times, &self.values, from, to)
    }

    /// The largest value; negative infinity without samples.
    #[must_use]
    pub fn peak(&self) -> f64 {
        self.values
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The integral over time, by the trapezoidal rule.
    #[must_use]
    pub fn impulse(&self) -> f64 {
        let steps = self.times.windows(2).zip(self.values.windows(2));
        steps
            .map(|(t, v)| 0.5 * (t[1] - t[0]) * (v[0] + v[1]))
            .sum()
    }

    /// The first time \[s\] at which the level is crossed, in either direction.
    ///
    /// # Errors
    /// If it is not.
    pub fn event(&self, level: f64) -> Result<f64, StudyError> {
        first_crossing(&self.times, &self.values, level)
    }

    /// The rise from 10 % to 90 % of a step \[s\].
    ///
    /// # Errors
    /// If it is not there.
    pub fn rise(&self, before: f64, plateau: f64) -> Result<f64, StudyError> {
        rise_10_90(&self.times, &self.values, before, plateau)
    }

    /// How far values go beyond the plateau, as a part of the step.
    ///
    /// # Errors
    /// If there are no samples, or no step.
    pub fn overshoot(&self, before: f64, plateau: f64) -> Result<f64, StudyError> {
        overshoot(&self.values, before, plateau)
    }

    /// Values at these times \[s\], linear between samples and constant beyond them: two runs compare at the same times.
    /// Without samples no number, which a quantity takes as an error.
    #[must_use]
    pub fn at(&self, times: &[f64]) -> Vec<f64> {
        let one = |time: f64| {
            let next = self.times.partition_point(|t| *t < time);
            match (next.checked_sub(1), self.times.get(next)) {
                (Some(k), Some(end)) => {
                    let share = (time - self.times[k]) / (end - self.times[k]);
                    self.values[k] + share * (self.values[next] - self.values[k])
                }
                (None, Some(_)) => self.values[0],
                (Some(k), None) => self.values[k],
                (None, None) => f64::NAN,
            }
        };
        times.iter().map(|&time| one(time)).collect()
    }
}
