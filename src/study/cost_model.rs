//! What a run will cost before it runs, and better while it runs: time, steps, pairs and memory.
//! Counts and rates from steps of the scene itself on this machine, and corrections from the run.
//!
//! **Before a run** [`CostModel::predict`] rehearses it: [`Simulation::expected_work`] takes the first steps of the scene as it
//! is built, counts and times them, and takes them back. So it needs no table of rates, which could not tell what loops
//! that are compiled for these effects take where the scene fills a cache, or does not. List builds are predicted from speeds
//! and accelerations, since first steps may show none.
//!
//! **While it runs** the model corrects itself: the rest of the run is taken to be like what was watched,
//!
//! ```text
//! steps = (end − t)/dt,   time = steps · τ,   pairs = steps · π
//! ```
//!
//! with the step dt, the time τ and the pairs π of a step as means over the later half of what was watched. What a scene
//! does later, when a front has formed or a dam has broken, is in neither: [`CostModel::watch`] or [`CostModel::see`] it again
//! from time to time.
//!
//! `cargo bench --bench cost_model` holds the prediction against ten scenes, and `cargo validate work_precision --
//! --forecast` what first steps predict against whole runs.

use crate::clock::Instant;
use crate::error::{Error, Problem, Result};
use crate::scalar::Real;
use crate::simulation::{Simulation, Work};
use std::time::Duration;

/// Steps that are taken at least, of which the first, which fills memory, does not count.
const LEAST: usize = 9;

/// A prediction of what is left of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Forecast {
    /// Steps.
    pub steps: f64,
    /// Time of these steps \[s\].
    pub seconds: f64,
    /// Pairs that sweeps will evaluate; see [`Work::pairs`].
    pub pairs: f64,
    /// Bytes held for particles, lists and records.
    pub bytes: usize,
}

/// Where a run was when it was looked at.
#[derive(Clone, Copy, Debug)]
struct Mark {
    time: f64,
    work: Work,
}

impl Mark {
    fn of<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> Self {
        Self {
            time: simulation.time(),
            work: simulation.work(),
        }
    }
}

/// A prediction, for what is left of it at a later time.
#[derive(Clone, Copy, Debug)]
struct Ahead {
    time: f64,
    end: f64,
    all: Forecast,
}

/// What the steps of a run cost.
///
/// ```
/// use meshfree::prelude::*;
/// use meshfree::study::cost_model::CostModel;
/// use std::time::Duration;
/// let rod = |spacing| Scene::<f64, 1>::new(schemes::impact())
///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], spacing).velocity([20.0]))
///     .boundary(MirrorPlane::wall([0.01], [1.0]))
///     .build();
/// let mut model = CostModel::new();
/// // Before it runs.
/// let mut rod = rod(1e-4)?;
/// let expected = model.predict(&mut rod, 3e-6)?;
/// // And from its first steps.
/// model.watch(&mut rod, 3e-6, Duration::from_millis(1))?;
/// let rest = model.forecast(3e-6)?;
/// let before = rod.steps();
/// rod.run_until(3e-6)?;
/// let taken = (rod.steps() - before) as f64;
/// assert!((rest.steps / taken - 1.0).abs() < 0.1, "{} of {taken}", rest.steps);
/// assert!((expected.steps / rod.steps() as f64 - 1.0).abs() < 0.1, "{}", expected.steps);
/// assert!((expected.bytes as f64 / rod.bytes() as f64 - 1.0).abs() < 0.05);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct CostModel {
    marks: Vec<Mark>,
    ahead: Option<Ahead>,
}

impl CostModel {
    /// A model that has watched nothing.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// What a run from now until `end` \[s\] will cost, before it runs: by a [rehearsal](Simulation::expected_work) of a
    /// twentieth of it or half a second, which changes nothing of what comes. [`forecast`](Self::forecast) repeats what is left
    /// of it until the run has been watched.
    ///
    /// # Errors
    /// As [`Simulation::expected_work`].
    pub fn predict<T: Real, const D: usize>(
        &mut self,
        simulation: &mut Simulation<T, D>,
        end: f64,
    ) -> Result<Forecast> {
        let expected = simulation.expected_work(end)?;
        let all = Forecast {
            steps: expected.steps as f64,
            seconds: expected.time.as_secs_f64(),
            pairs: expected.pairs as f64,
            bytes: expected.bytes,
        };
        self.marks.clear();
        self.ahead = Some(Ahead {
            time: simulation.time(),
            end,
            all,
        });
        Ok(all)
    }

    /// Takes steps of a simulation for so long, nine at least, and watches them; not beyond `end` \[s\]. A second or two is
    /// enough; until lists have been built again their price is not in it.
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn watch<T: Real, const D: usize>(
        &mut self,
        simulation: &mut Simulation<T, D>,
        end: f64,
        time: Duration,
    ) -> Result<()> {
        self.marks.clear();
        let start = Instant::now();
        let mut steps = 0;
        while simulation.time() < end && (steps < LEAST || start.elapsed() < time) {
            simulation.step_until(end)?;
            steps += 1;
            self.see(simulation);
        }
        Ok(())
    }

    /// Looks at a simulation that runs by itself, in the closure of [`Simulation::run_with`] for instance.
    pub fn see<T: Real, const D: usize>(&mut self, simulation: &Simulation<T, D>) {
        self.marks.push(Mark::of(simulation));
        // Half of what it was, so that a long run does not fill memory.
        if self.marks.len() > 4096 {
            let mut keep = false;
            self.marks.retain(|_| {
                keep = !keep;
                keep
            });
        }
    }

    /// What is left from where it last looked until `end` \[s\]: from what it has seen of the run or, before that, from what was
    /// predicted.
    ///
    /// # Errors
    /// If it has seen fewer than three steps, and predicted nothing.
    pub fn forecast(&self, end: f64) -> Result<Forecast> {
        let predicted = || {
            let ahead = self.ahead?;
            let now = self.marks.last().map_or(ahead.time, |mark| mark.time);
            let left = ((end - now) / (ahead.end - ahead.time)).max(0.0);
            Some(Forecast {
                steps: left * ahead.all.steps,
                seconds: left * ahead.all.seconds,
                pairs: left * ahead.all.pairs,
                bytes: ahead.all.bytes,
            })
        };
        let Some(last) = self.marks.last() else {
            return predicted().ok_or_else(|| unseen(0));
        };
        let middle = &self.marks[self.marks.len() / 2];
        let from = if middle.work.steps + 4 > last.work.steps {
            &self.marks[0]
        } else {
            middle
        };
        let steps = last.work.steps - from.work.steps;
        if steps < 2 || last.time <= from.time {
            return predicted().ok_or_else(|| unseen(self.marks.len()));
        }
        let left = ((end - last.time) / (last.time - from.time)).max(0.0);
        Ok(Forecast {
            steps: left * steps as f64,
            seconds: left * last.work.time.saturating_sub(from.work.time).as_secs_f64(),
            pairs: left * (last.work.pairs - from.work.pairs) as f64,
            bytes: last.work.bytes,
        })
    }
}

fn unseen(seen: usize) -> Error {
    Error::Argument(Problem::Incompatible {
        what: format!("a forecast from {seen} looks at a run"),
        remedy: "let the model watch the run for three steps at least, or predict it",
    })
}
