//! The clock of a study: time on the wall, or time that the process had processors for.
//! The latter is what a machine takes that does other things as well.

use crate::clock::Instant;
use std::time::Duration;

/// What the time of a run is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Clock {
    /// That of all steps on the wall: what one waits for.
    #[default]
    Wall,
    /// That which all threads of the process were on a processor for, from the begin of a run to its end: on one thread what
    /// one would wait for on a machine that does nothing else, and it repeats better. Of systems without
    /// `/proc/self/task/*/schedstat` it is that of the wall.
    Processor,
}

impl Clock {
    /// What it counts, in words.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Wall => "the steps on the wall",
            Self::Processor => "the run on processors",
        }
    }
}

/// When a run began.
pub(super) struct Begin {
    wall: Instant,
    processor: Option<Duration>,
}

impl Begin {
    pub fn now() -> Self {
        Self {
            wall: Instant::now(),
            processor: processor_time(),
        }
    }

    /// Since then, on the wall.
    pub fn wall(&self) -> Duration {
        self.wall.elapsed()
    }

    /// Since then, on processors.
    pub fn processor(&self) -> Duration {
        let spent = self
            .processor
            .and_then(|before| processor_time()?.checked_sub(before));
        spent.unwrap_or_else(|| self.wall())
    }
}

/// Time of all threads that live on processors.
fn processor_time() -> Option<Duration> {
    let mut sum = 0;
    for task in std::fs::read_dir("/proc/self/task").ok()? {
        let text = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        sum += text.split_whitespace().next()?.parse::<u64>().ok()?;
    }
    (sum > 0).then_some(Duration::from_nanos(sum))
}
