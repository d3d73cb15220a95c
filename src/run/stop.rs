//! Criteria that end a run before its time: a steady state, rest, a drift of energy, the clock on the wall.
//! They are asked after steps and never at readings, so where a run ends does not depend on who reads it.

use super::Failure;
use crate::clock::Instant;
use crate::error::{Problem, Result};
use crate::output::table::significant;
use crate::particles::Field;
use crate::scalar::Real;
use crate::simulation::Simulation;
use core::fmt;
use std::collections::VecDeque;
use std::time::Duration;

/// Whether a run ends here, and why, in words.
type Criterion<'r, T, const D: usize> =
    Box<dyn FnMut(&Simulation<T, D>) -> std::result::Result<Option<String>, Failure> + 'r>;

/// A criterion that ends a run.
///
/// All are asked after every step. What a criterion remembers, such as the values in its window, is that of one
/// [`Run`](super::Run): a run that is resumed from a file fills it anew, and may end later than one without the stop.
pub struct Stop<'r, T: Real, const D: usize> {
    pub(super) name: String,
    pub(super) criterion: Criterion<'r, T, D>,
    /// A number that makes no criterion.
    pub(super) problem: Option<Problem>,
    /// Whether it needs internal energy.
    needs_energy: bool,
}

impl<T: Real, const D: usize> fmt::Debug for Stop<'_, T, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Stop({})", self.name)
    }
}

impl<'r, T: Real, const D: usize> Stop<'r, T, D> {
    /// Ends the run when `criterion` gives a reason. It may fail, as an observer may.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::run::{Run, Stop};
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .boundary(MirrorPlane::wall([0.01], [1.0]))
    ///     .build()?;
    /// let halted = |now: &Simulation<f64, 1>| now.all().last().is_some_and(|own| own.velocity()[0] < 10.0);
    /// let stop = Stop::when("halted", |now| Ok(halted(now).then(|| "the end has halted".into())));
    /// let summary = Run::new(&mut rod, 1e-5).stop(stop).go()?;
    /// assert_eq!(summary.end.to_string(), "halted: the end has halted");
    /// # Ok::<(), Error>(())
    /// ```
    pub fn when(
        name: impl Into<String>,
        criterion: impl FnMut(&Simulation<T, D>) -> std::result::Result<Option<String>, Failure> + 'r,
    ) -> Self {
        Self {
            name: name.into(),
            criterion: Box::new(criterion),
            problem: None,
            needs_energy: false,
        }
    }

    /// Ends the run after so much time on the wall. Where that is depends on the machine; the bits up to there do not.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::run::{Run, Stop};
    /// use std::time::Duration;
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .build()?;
    /// let summary = Run::new(&mut rod, 1e3).stop(Stop::wall_clock(Duration::from_millis(20))).go()?;
    /// assert!(rod.time() < 1e3 && summary.end.to_string().starts_with("wall-clock time"));
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn wall_clock(limit: Duration) -> Self {
        let mut started = None;
        Self::when("wall-clock time", move |_| {
            let started: &mut Instant = started.get_or_insert_with(Instant::now);
            let taken = started.elapsed();
            Ok((taken >= limit).then(|| {
                let [taken, limit] = [taken, limit].map(|own| own.as_secs_f64());
                format!(
                    "{} s of {} s have gone",
                    significant(taken, 3),
                    significant(limit, 3)
                )
            }))
        })
    }

    /// Ends the run when the kinetic energy is steady.
    ///
    /// That is when the kinetic energy K of the last `over` seconds has
    ///
    /// ```text
    /// max K − min K ≤ share · largest K of the run,
    /// ```
    ///
    /// so that its mean rate there is at most share/over of the largest. Take `over` longer than the slowest swing of what is to come to
    /// rest: a window that is shorter finds a turning point steady.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::run::{Run, Stop};
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .build()?;
    /// // It flies on and on.
    /// let summary = Run::new(&mut rod, 1.0).stop(Stop::steady(0.01, 1e-6)).go()?;
    /// assert!(rod.time() >= 1e-6 && rod.time() < 1.1e-6);
    /// assert!(summary.end.to_string().starts_with("steady"), "{}", summary.end);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn steady(share: f64, over: f64) -> Self {
        let mut window = Window::new(over);
        let mut largest = 0.0_f64;
        let stop = Self::when("steady", move |now| {
            let kinetic = now.kinetic_energy();
            largest = largest.max(kinetic);
            let range = window.range(now.time(), kinetic);
            Ok(range.filter(|[low, high]| high - low <= share * largest).map(|[low, high]| {
                let percent = if largest > 0.0 { 100.0 * (high - low) / largest } else { 0.0 };
                format!(
                    "the kinetic energy varied by {} % of its largest, {} J, in the last {over} s, at most {} %",
                    significant(percent, 2),
                    significant(largest, 3),
                    significant(100.0 * share, 2)
                )
            }))
        });
        stop.checked(&[("share of the kinetic energy", share), ("window", over)])
    }

    /// Ends the run when `probe` is steady: when its values of the last `over` seconds differ by `change` at most, which has
    /// the unit of the probe.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::run::{Run, Stop};
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .boundary(MirrorPlane::wall([0.01], [1.0]))
    ///     .build()?;
    /// // The plateau behind a shock: 709 MPa.
    /// let at_wall = |now: &Simulation<f64, 1>| now.all().last().map_or(0.0, |own| own.pressure());
    /// Run::new(&mut rod, 1e-5).stop(Stop::steady_probe("pressure", at_wall, 1e6, 3e-7)).go()?;
    /// assert!((at_wall(&rod) / 709e6 - 1.0).abs() < 0.02);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn steady_probe(
        name: impl Into<String>,
        mut probe: impl FnMut(&Simulation<T, D>) -> f64 + 'r,
        change: f64,
        over: f64,
    ) -> Self {
        let mut window = Window::new(over);
        let stop = Self::when(name, move |now| {
            let range = window.range(now.time(), probe(now));
            Ok(range.filter(|[low, high]| high - low <= change).map(|[low, high]| {
                let [low, high] = [low, high].map(|own| significant(own, 4));
                format!("it was between {low} and {high} in the last {over} s, no wider than {change}")
            }))
        });
        stop.checked(&[("change of the probe", change), ("window", over)])
    }

    /// Ends the run when all has come to rest: when over the last `over` seconds the kinetic energy was at most `share` of the
    /// largest of the run.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::run::{Run, Stop};
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .boundary(MirrorPlane::wall([0.01], [1.0]))
    ///     .build()?;
    /// // The wave has met all of it, and it has yet to fly back.
    /// let summary = Run::new(&mut rod, 1e-5).stop(Stop::at_rest(0.05, 1e-7)).go()?;
    /// assert!((rod.time() / (0.01 / 3940.0) - 1.0).abs() < 0.15, "{} at {}", summary.end, rod.time());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn at_rest(share: f64, over: f64) -> Self {
        let mut window = Window::new(over);
        let mut largest = 0.0_f64;
        let stop = Self::when("at rest", move |now| {
            let kinetic = now.kinetic_energy();
            largest = largest.max(kinetic);
            let range = window.range(now.time(), kinetic);
            Ok(range.filter(|[_, high]| *high <= share * largest).map(|[_, high]| {
                let [high, largest] = [high, largest].map(|own| significant(own, 3));
                format!("the kinetic energy was {high} J at most in the last {over} s, of {largest} J before")
            }))
        });
        stop.checked(&[("share of the kinetic energy", share), ("window", over)])
    }

    /// Ends the run when the sum of kinetic and internal energy differs by more than `share` from that at its beginning.
    ///
    /// What nothing from outside works on conserves that sum, so its drift is an error of the run. Loads, moving walls and
    /// couplings that store energy change it too. LS-DYNA ends a run so by `ENDENG` of `*CONTROL_TERMINATION` (Keyword User's
    /// Manual, Vol. I).
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::run::{Run, Stop};
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .boundary(MirrorPlane::wall([0.01], [1.0]))
    ///     .build()?;
    /// // Compatible energy drifts by rounding alone.
    /// Run::new(&mut rod, 3e-6).stop(Stop::energy_drift(1e-9)).go()?;
    /// assert_eq!(rod.time(), 3e-6);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn energy_drift(share: f64) -> Self {
        let mut first = None;
        let stop = Self::when("drift of energy", move |now| {
            let energy = now.ledger().whole.total_energy();
            let first = *first.get_or_insert(energy);
            let drift = (energy - first) / first.abs().max(f64::MIN_POSITIVE);
            Ok((drift.abs() > share).then(|| {
                format!(
                    "kinetic and internal energy are {} J, {} % off the {} J of the beginning, more than {} %",
                    significant(energy, 4),
                    significant(100.0 * drift, 2),
                    significant(first, 4),
                    significant(100.0 * share, 2)
                )
            }))
        });
        let needs_energy = true;
        Self {
            needs_energy,
            ..stop.checked(&[("share of the energy", share)])
        }
    }

    /// Refuses numbers that are not positive.
    fn checked(mut self, numbers: &[(&str, f64)]) -> Self {
        let bad = numbers
            .iter()
            .find(|(_, value)| !(value.is_finite() && *value > 0.0));
        self.problem = bad.map(|(what, value)| Problem::Parameter {
            what: format!("{what} of the criterion `{}`", self.name),
            value: *value,
            must_be: "it must be positive and finite",
        });
        self
    }

    /// Refuses what makes no criterion of this run, and looks at its beginning.
    pub(super) fn begin(&mut self, now: &Simulation<T, D>) -> Result<()> {
        if let Some(problem) = self.problem.take() {
            return Err(problem.into());
        }
        if self.needs_energy && now.all().any(|own| own.scalar(Field::ENERGY).is_none()) {
            let what = format!(
                "the criterion `{}` for bodies without internal energy",
                self.name
            );
            let remedy =
                "their sum is not conserved: take Stop::steady, Stop::at_rest or Stop::when";
            return Err(Problem::Incompatible { what, remedy }.into());
        }
        self.ask(now).map(|_| ())
    }

    /// Why the run ends here, if it does.
    pub(super) fn ask(&mut self, now: &Simulation<T, D>) -> Result<Option<String>> {
        (self.criterion)(now).map_err(|cause| crate::error::Error::Observer {
            observer: format!("the criterion `{}`", self.name),
            time: now.time(),
            cause,
        })
    }
}

/// Values over a window of time \[s\].
#[derive(Debug)]
struct Window {
    over: f64,
    values: VecDeque<(f64, f64)>,
}

impl Window {
    fn new(over: f64) -> Self {
        Self {
            over,
            values: VecDeque::new(),
        }
    }

    /// Adds a value; the least and the largest of the window, once that is as long as it is to be.
    fn range(&mut self, time: f64, value: f64) -> Option<[f64; 2]> {
        self.values.push_back((time, value));
        // The one before the window stays, so that the whole of it is covered.
        while self
            .values
            .get(1)
            .is_some_and(|own| time - own.0 >= self.over)
        {
            self.values.pop_front();
        }
        let is_full = self
            .values
            .front()
            .is_some_and(|own| time - own.0 >= self.over);
        is_full.then(|| {
            let start = [f64::INFINITY, f64::NEG_INFINITY];
            let values = self.values.iter();
            values.fold(start, |[low, high], (_, own)| {
                [low.min(*own), high.max(*own)]
            })
        })
    }
}
