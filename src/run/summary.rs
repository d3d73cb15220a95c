//! What a run took, and why it ended.

use crate::scalar::Real;
use crate::simulation::{Simulation, Work};
use core::fmt;
use std::time::Duration;

/// Why a run ended.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum End {
    /// Its time was over.
    Time {
        /// The end that the run was given \[s\].
        end: f64,
    },
    /// A criterion held.
    Criterion {
        /// Its name.
        name: String,
        /// Why, in words.
        why: String,
    },
}

impl End {
    /// Whether a criterion has ended the run before its time.
    ///
    /// ```
    /// # use meshfree::run::End;
    /// assert!(!End::Time { end: 1.0 }.is_early());
    /// ```
    #[must_use]
    pub fn is_early(&self) -> bool {
        matches!(self, Self::Criterion { .. })
    }
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Time { end } => write!(f, "t = {end} s was reached"),
            Self::Criterion { name, why } => write!(f, "{name}: {why}"),
        }
    }
}

/// What a run took, and why it ended. Printed it is one line.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Summary {
    /// Particles of bodies at the end.
    pub particles: usize,
    /// Steps of this run.
    pub steps: u64,
    /// Pairs that its sweeps have evaluated; see [`Work::pairs`].
    pub pairs: u64,
    /// Time on the wall \[s\], observers included.
    pub seconds: f64,
    /// Why it ended.
    pub end: End,
}

impl Summary {
    pub(super) fn of<T: Real, const D: usize>(
        now: &Simulation<T, D>,
        first: &Work,
        taken: Duration,
        end: End,
    ) -> Self {
        let work = now.work();
        Self {
            particles: work.particles,
            steps: work.steps - first.steps,
            pairs: work.pairs - first.pairs,
            seconds: taken.as_secs_f64(),
            end,
        }
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let each = 1e6 * self.seconds / (self.steps.max(1) as f64 * self.particles.max(1) as f64);
        write!(
            f,
            "{} particles, {} steps in {:.1} s ({each:.2} µs a particle and step)",
            self.particles, self.steps, self.seconds
        )?;
        if self.end.is_early() {
            write!(f, ", ended early by {}", self.end)?;
        }
        Ok(())
    }
}
