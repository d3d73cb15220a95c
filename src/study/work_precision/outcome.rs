//! What one run gives a study: values of quantities by name, and the work that it was.
//! The work is a snapshot of the simulation's own counters.

use crate::scalar::Real;
use crate::simulation::{Simulation, Work};
use std::time::Duration;

/// What a run gave.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Outcome {
    pub(super) values: Vec<(String, Vec<f64>)>,
    pub(super) work: Work,
    pub(super) bits: Option<u64>,
}

impl Outcome {
    /// The work of a simulation so far and the hash of its bits, without values.
    #[must_use]
    pub fn of<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> Self {
        Self {
            bits: Some(simulation.bits_hash()),
            ..Self::from_work(simulation.work())
        }
    }

    /// Work that was counted elsewhere, without values.
    #[must_use]
    pub fn from_work(work: Work) -> Self {
        Self {
            values: Vec::new(),
            work,
            bits: None,
        }
    }

    /// With the value of a quantity.
    #[must_use]
    pub fn value(self, quantity: &str, value: f64) -> Self {
        self.samples(quantity, [value])
    }

    /// With samples of a quantity: at the same places or times in every run.
    #[must_use]
    pub fn samples(mut self, quantity: &str, values: impl IntoIterator<Item = f64>) -> Self {
        self.values
            .push((quantity.into(), values.into_iter().collect()));
        self
    }

    /// With another time than that of all steps, where something else is meant to count.
    #[must_use]
    pub fn time(mut self, time: Duration) -> Self {
        self.work.time = time;
        self
    }
}

/// Mean of |value − exact| with weights (volumes or masses), over the mean of |exact|: the norm L1 of a field on particles.
///
/// ```
/// use meshfree::study::work_precision::relative_l1;
/// assert!((relative_l1([(1.5, 1.0, 2.0), (2.0, 2.0, 1.0)]) - 0.25).abs() < 1e-15);
/// ```
#[must_use]
pub fn relative_l1(samples: impl IntoIterator<Item = (f64, f64, f64)>) -> f64 {
    let (mut error, mut whole) = (0.0, 0.0);
    for (value, exact, weight) in samples {
        error += weight * (value - exact).abs();
        whole += weight * exact.abs();
    }
    error / whole
}

/// Root mean square of value − exact with weights, over that of the exact: the norm L2 of a field on particles.
///
/// ```
/// use meshfree::study::work_precision::relative_l2;
/// assert!((relative_l2([(1.5, 1.0, 1.0), (1.0, 1.0, 3.0)]) - 0.25).abs() < 1e-15);
/// ```
#[must_use]
pub fn relative_l2(samples: impl IntoIterator<Item = (f64, f64, f64)>) -> f64 {
    let (mut error, mut whole) = (0.0, 0.0);
    for (value, exact, weight) in samples {
        error += weight * (value - exact).powi(2);
        whole += weight * exact * exact;
    }
    (error / whole).sqrt()
}

/// What a conserved quantity has lost or gained, as a part of a scale of yours.
///
/// ```
/// use meshfree::study::work_precision::residual;
/// assert_eq!(residual(10.0, 9.0, 10.0), 0.1);
/// ```
#[must_use]
pub fn residual(before: f64, after: f64, scale: f64) -> f64 {
    ((after - before) / scale).abs()
}
