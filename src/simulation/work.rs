//! The work of a run in numbers that do not depend on the machine, beside the time that it took.
//! Sweeps count what their lists hold, so a number of pairs is the same on any machine and number of threads.

use super::Simulation;
use crate::scalar::Real;
use std::time::Duration;

/// What a run has done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Work {
    /// Particles of bodies.
    pub particles: usize,
    /// Steps.
    pub steps: u64,
    /// Evaluations of the rates.
    pub evaluations: u64,
    /// Builds of neighbour lists.
    pub list_builds: u64,
    /// Pairs that sweeps have evaluated: entries of the lists times the rows of lanes, once for each sweep. Both
    /// directions of a pair count, and so do pairs that the lists hold beyond the support.
    pub pairs: u64,
    /// Bytes held for particles, lists and records.
    pub bytes: usize,
    /// Time of all steps.
    pub time: Duration,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// The work of the run so far: what a [study of accuracy against cost](crate::study::work_precision) is made of.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .build()?;
    /// simulation.run_until(1e-7)?;
    /// let work = simulation.work();
    /// assert_eq!((work.particles, work.steps), (50, simulation.steps()));
    /// // A sweep sees at least the particle and two neighbours at either side.
    /// assert!(work.pairs >= 50 * 5 * work.evaluations);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn work(&self) -> Work {
        Work {
            particles: self.particles(),
            steps: self.steps(),
            evaluations: self.evaluations(),
            list_builds: self.list_builds(),
            pairs: {
                let groups = self.after_step().groups.iter();
                groups.map(|group| group.work.spent.pairs).sum()
            },
            bytes: self.bytes(),
            time: self.phases().total(),
        }
    }
}
