//! Whether a run is stable: bounds, limits, residuals, arrangement, steps and noise, compared with thresholds.
//! Kept on request, since a look at every particle in every step is not free; off, it costs one question a step.

mod arrangement;
mod compression;
mod print;
mod report;
mod thresholds;
mod voids;
mod watch;

pub use arrangement::Arrangement;
pub use report::{Breach, Extreme, StabilityReport, StepHistory, Verdict};
pub use thresholds::Thresholds;
pub(super) use watch::{Seen, Watch};

use super::Simulation;
use crate::once::once;
use crate::scalar::Real;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Starts to watch the run from the present state on: [`stability`](Self::stability) then reports all of it, with
    /// what first left the thresholds, where and when. Off by default. Observing changes no bit of the run.
    ///
    /// Densities, smoothing lengths and the step are looked at after every step, and the arrangement of the particles every
    /// [`Thresholds::every`] steps; the share of the run's time is in [`StabilityReport::price`]. A checkpoint does not keep
    /// the watch.
    pub fn keep_stability(&mut self, thresholds: Thresholds) {
        self.on_both(&|own| own.state.watch = Some(Box::new(Watch::new(own, thresholds))));
    }

    /// How sound the run is, of all steps since [`keep_stability`](Self::keep_stability). Without these the report is of the
    /// present state alone, and its verdict is unknown, not stable. Voids, momentum and energy are summed when asked for.
    /// Printed it is a short table.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::simulation::Thresholds;
    /// let water = catalogue::weakly_compressible_water(1.0);
    /// let spin = |[x, y]: [f64; 2], start| meshfree::scheme::Start { velocity: [y, -x], ..start };
    /// let mut patch = Scene::<f64, 2>::new(schemes::weakly_compressible())
    ///     .body(Body::block("patch", water, [-0.5; 2], [0.5; 2], 0.05).start(spin))
    ///     .build()?;
    /// // Nothing is known of steps that nobody watched.
    /// assert!(!patch.stability().verdict.is_stable() && patch.stability().verdict.breaches.is_empty());
    /// patch.keep_stability(Thresholds::default());
    /// patch.run_until(0.1)?;
    /// let report = patch.stability();
    /// println!("{report}");
    /// assert!(report.verdict.is_stable(), "{report}");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn stability(&self) -> StabilityReport {
        once!(self => &Simulation, |own| -> StabilityReport { report::of(own) })
    }

    /// Looks at the state after a step, if it is watched.
    pub(super) fn watch_step(&mut self) {
        if let Some(mut watch) = self.state.watch.take() {
            watch.look(self);
            self.state.watch = Some(watch);
        }
    }
}
