//! What a run will cost, from its first steps: time, steps, pairs and memory.
//! It corrects itself from the run as far as it has come.
//!
//! A few first steps of the scene itself tell what no table of rates can: the loop that its effects were compiled into, on
//! this machine, with these neighbours, and the step that its criteria ask for. The rest of the run is taken to be like them,
//!
//! ```text
//! steps = (end − t)/dt,   time = steps · τ,   pairs = steps · π
//! ```
//!
//! with the step dt, the time τ and the pairs π of a step as means over the later half of what was watched. What a scene
//! does later, when a front has formed or a dam has broken, is not in them: [`CostModel::watch`] again from time to time.
//! `cargo run --release --example work_precision -- --forecast` holds it against whole runs.

use crate::clock::Instant;
use crate::error::{Error, Problem, Result};
use crate::scalar::Real;
use crate::simulation::{Simulation, Work};
use std::time::Duration;

/// Steps that are taken at least, of which the first, which fills memory, does not count.
const LEAST: usize = 9;

/// A prediction of what is left of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
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

/// What the steps of a run cost.
///
/// ```
/// use meshfree::prelude::*;
/// use meshfree::study::cost_model::CostModel;
/// use std::time::Duration;
/// let mut rods = Scene::<f64, 1>::new(schemes::impact())
///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 1e-4).velocity([20.0]))
///     .boundary(MirrorPlane::wall([0.01], [1.0]))
///     .build()?;
/// let mut model = CostModel::new();
/// model.watch(&mut rods, 3e-6, Duration::from_millis(1))?;
/// let rest = model.forecast(3e-6)?;
/// let before = rods.steps();
/// rods.run_until(3e-6)?;
/// let taken = (rods.steps() - before) as f64;
/// assert!((rest.steps / taken - 1.0).abs() < 0.1, "{} of {taken}", rest.steps);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct CostModel {
    marks: Vec<Mark>,
}

impl CostModel {
    /// A model that has watched nothing.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
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
            simulation.step_at_most(end - simulation.time())?;
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

    /// What is left from where it last looked until `end` \[s\].
    ///
    /// # Errors
    /// If it has seen fewer than three steps.
    pub fn forecast(&self, end: f64) -> Result<Forecast> {
        let Some(last) = self.marks.last() else {
            return Err(unseen(0));
        };
        let middle = &self.marks[self.marks.len() / 2];
        let from = if middle.work.steps + 4 > last.work.steps {
            &self.marks[0]
        } else {
            middle
        };
        let steps = last.work.steps - from.work.steps;
        if steps < 2 || last.time <= from.time {
            return Err(unseen(self.marks.len()));
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
        remedy: "let the model watch the run for three steps at least",
    })
}
