//! What a run will cost before it runs, and better while it runs: time, steps, pairs and memory.
//! Counts from the scene as it is built, rates from this machine, and corrections from the run itself.
//!
//! **Before a run** [`CostModel::predict`] evaluates the scene as it is built, a few times if that is quick. It takes counts from
//! it (particles, pairs by neighbours, the step by its criteria, list builds by speeds and accelerations; they are
//! [`Simulation::expected_work`]), and what its own loops take on this machine, which no table of rates can tell: they are
//! compiled for its effects, and their speed depends on how much of the scene a cache holds.
//!
//! ```text
//! time = steps · (E τ + B λ + s (P σ/p + N μ))
//! ```
//!
//! with E evaluations a step of τ seconds each, B list builds of λ seconds, and what a step does beside its evaluations: P pairs
//! (sums in drifts, work of kicks) at the time σ/p of a pair in the sweeps of the evaluation, and N μ, as long as the part of the
//! evaluation that is no sweep. What that takes in truth over this estimate is s, a number of the scheme:
//! [`CostModel::calibrate`] measures it, with the correction of λ, on a second or two of a small pilot of the scheme; without one
//! they are 1.
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
//! `cargo bench --bench cost_model` holds the prediction against ten scenes, and `cargo run --release --example work_precision --
//! --forecast` what first steps foretell against whole runs.

use crate::clock::Instant;
use crate::error::{Error, Problem, Result};
use crate::scalar::Real;
use crate::simulation::{Outlook, Simulation, Work};
use std::time::Duration;

/// Steps that are taken at least, of which the first, which fills memory, does not count.
const LEAST: usize = 9;
/// Steps of a pilot before its time counts.
const WARM: u64 = 3;
/// Time over which evaluations are repeated to be timed.
const TIMING: Duration = Duration::from_millis(50);

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

/// What a pilot has told of its scheme on this machine.
#[derive(Clone, Debug)]
struct Rates {
    scheme: String,
    dimensions: usize,
    bytes: usize,
    /// What a step takes beside evaluations and list builds, over the estimate.
    beside: f64,
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
/// // A second or two of a small pilot; here less.
/// model.calibrate(&mut rod(2e-4)?, Duration::from_millis(20))?;
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
    rates: Vec<Rates>,
    ahead: Option<Ahead>,
}

impl CostModel {
    /// A model that has watched nothing.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes steps of a pilot for so long, and learns from them what a step of its scheme takes on this machine beside its
    /// evaluations. A second or two of some thousand particles is enough; the pilot is used up. What it learns serves all
    /// scenes of this scheme, dimension and scalar, until it is calibrated again; give each scheme a pilot of its own.
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn calibrate<T: Real, const D: usize>(
        &mut self,
        pilot: &mut Simulation<T, D>,
        time: Duration,
    ) -> Result<()> {
        for _ in 0..WARM {
            pilot.step()?;
        }
        let begin = Instant::now();
        let from = pilot.work();
        while pilot.steps() < from.steps + LEAST as u64 || begin.elapsed() < time {
            pilot.step()?;
        }
        let work = pilot.work();
        let steps = (work.steps - from.steps) as f64;
        let taken = work.time.saturating_sub(from.time).as_secs_f64() / steps;
        let builds = (work.list_builds - from.list_builds) as f64 / steps;
        // Evaluations are timed where the pilot has come to: from its own phases.
        let phases = pilot.phases();
        let outlook = pilot.outlook(pilot.time() + 1.0, TIMING)?;
        let counted = phases.lists.as_secs_f64() / pilot.steps() as f64;
        let builds_and_checks = if builds > 0.0 {
            counted
        } else {
            outlook.check * outlook.evaluations
        };
        let known = outlook.evaluations * outlook.evaluation + builds_and_checks;
        let beside = ((taken - known) / beside(&outlook)).clamp(0.1, 10.0);
        let rates = Rates {
            beside,
            ..Rates::named(pilot)
        };
        self.rates.retain(|own| !own.is_of(&rates));
        self.rates.push(rates);
        Ok(())
    }

    /// What a run from now until `end` \[s\] will cost, before it runs. It evaluates the scene for a few hundredths of a second,
    /// twice at least, which changes nothing of what comes. [`forecast`](Self::forecast) repeats what is left of it until the run
    /// has been watched.
    ///
    /// # Errors
    /// As [`Simulation::evaluate`], and if the end is not finite.
    pub fn predict<T: Real, const D: usize>(
        &mut self,
        simulation: &mut Simulation<T, D>,
        end: f64,
    ) -> Result<Forecast> {
        let outlook = simulation.outlook(end, TIMING)?;
        let wanted = Rates::named(simulation);
        let known = self.rates.iter().find(|own| own.is_of(&wanted));
        let factor = known.map_or(1.0, |own| own.beside);
        let step = outlook.evaluations * (outlook.evaluation + outlook.check)
            + outlook.builds * outlook.build
            + factor * beside(&outlook);
        let time = simulation.time();
        let steps = ((end - time) / outlook.step).max(0.0);
        let all = Forecast {
            steps,
            seconds: steps * step,
            pairs: steps * (outlook.evaluations * outlook.pairs + outlook.beside),
            bytes: outlook.bytes,
        };
        self.marks.clear();
        self.ahead = Some(Ahead { time, end, all });
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

impl Rates {
    fn named<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> Self {
        Self {
            scheme: simulation.scheme().name().into(),
            dimensions: D,
            bytes: size_of::<T>(),
            beside: 1.0,
        }
    }

    fn is_of(&self, other: &Self) -> bool {
        self.scheme == other.scheme
            && self.dimensions == other.dimensions
            && self.bytes == other.bytes
    }
}

/// The time \[s\] of what a step does beside evaluations and list builds, by those of its evaluations.
fn beside(outlook: &Outlook) -> f64 {
    let each = outlook.sweeps / outlook.pairs.max(1.0);
    let no_sweep = (outlook.evaluation - outlook.sweeps).max(0.0);
    (outlook.beside * each + no_sweep).max(f64::MIN_POSITIVE)
}

fn unseen(seen: usize) -> Error {
    Error::Argument(Problem::Incompatible {
        what: format!("a forecast from {seen} looks at a run"),
        remedy: "let the model watch the run for three steps at least, or predict it",
    })
}
