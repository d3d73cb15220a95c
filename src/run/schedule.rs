//! Schedules: at which times, after which steps and on which events an observer is shown a run.
//! Times are readings of the state there, and cut no step.

use crate::error::{Problem, Result};
use crate::scalar::Real;
use crate::simulation::{Simulation, rounding};
use core::fmt;

/// One rule of a schedule.
#[derive(Clone, Debug, PartialEq)]
enum Rule {
    Every(f64),
    At(Vec<f64>),
    Evenly(usize),
    Steps(u64),
    On(String),
    End,
}

/// When an observer is shown a run.
///
/// | rule | shown |
/// |---|---|
/// | [`every`](Self::every), [`at`](Self::at), [`evenly`](Self::evenly) | at these times exactly: between two steps a [reading](crate::simulation#readings), the state after a shortened step of a copy |
/// | [`steps`](Self::steps) | the state after every n-th step |
/// | [`on`](Self::on) | the state after the step in which an event first held |
/// | [`end`](Self::end) | the last state of the run, whatever has ended it |
///
/// Of the times those from the beginning of the run to its end are shown, both among them. The beginning is left out where the
/// simulation has taken steps before, so a run in several parts shows no time twice. What falls on one instant is shown once.
/// A reading costs a step and a copy of the state.
///
/// ```
/// use meshfree::prelude::*;
/// use meshfree::run::{Run, Schedule};
/// let mut rod = Scene::<f64, 1>::new(schemes::impact())
///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
///     .build()?;
/// let mut times = Vec::new();
/// let schedule = Schedule::every(4e-7).and(Schedule::at([3e-7])).and(Schedule::end());
/// Run::new(&mut rod, 1e-6).observe(schedule, |now| { times.push(now.time()); Ok(()) }).go()?;
/// assert_eq!(times, [0.0, 3e-7, 4e-7, 8e-7, 1e-6]);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule(Vec<Rule>);

impl Schedule {
    /// At the times k·`interval` \[s\], k = 0, 1, 2, ...
    ///
    /// ```
    /// # use meshfree::run::Schedule;
    /// assert_eq!(Schedule::every(0.1).to_string(), "every 0.1 s");
    /// ```
    #[must_use]
    pub fn every(interval: f64) -> Self {
        Self(vec![Rule::Every(interval)])
    }

    /// At these times \[s\], in any order.
    ///
    /// ```
    /// # use meshfree::run::Schedule;
    /// assert_eq!(Schedule::at([0.5, 0.25]).to_string(), "at 2 times");
    /// ```
    #[must_use]
    pub fn at(times: impl IntoIterator<Item = f64>) -> Self {
        let mut times: Vec<f64> = times.into_iter().collect();
        times.sort_by(f64::total_cmp);
        Self(vec![Rule::At(times)])
    }

    /// At `count` times, two at least, evenly from the beginning of the run to its end, both among them.
    ///
    /// ```
    /// # use meshfree::run::Schedule;
    /// assert_eq!(Schedule::evenly(21).to_string(), "at 21 times of the run");
    /// ```
    #[must_use]
    pub fn evenly(count: usize) -> Self {
        Self(vec![Rule::Evenly(count)])
    }

    /// After every `count`-th step, by [`Simulation::steps`].
    ///
    /// ```
    /// # use meshfree::run::Schedule;
    /// assert_eq!(Schedule::steps(1).to_string(), "every 1 steps");
    /// ```
    #[must_use]
    pub fn steps(count: u64) -> Self {
        Self(vec![Rule::Steps(count)])
    }

    /// When an [event](crate::scene::Scene::event) of the scene has happened, after that step. One that had happened before the run
    /// is not shown.
    ///
    /// ```
    /// # use meshfree::run::Schedule;
    /// assert_eq!(Schedule::on("contact").to_string(), "on `contact`");
    /// ```
    #[must_use]
    pub fn on(event: impl Into<String>) -> Self {
        Self(vec![Rule::On(event.into())])
    }

    /// At the end of the run, be it by time or by a [criterion](super::Stop). A run that fails has none.
    ///
    /// ```
    /// # use meshfree::run::Schedule;
    /// assert_eq!(Schedule::end().to_string(), "at the end");
    /// ```
    #[must_use]
    pub fn end() -> Self {
        Self(vec![Rule::End])
    }

    /// When this one or `other` says.
    ///
    /// ```
    /// # use meshfree::run::Schedule;
    /// let both = Schedule::every(0.1).and(Schedule::on("contact"));
    /// assert_eq!(both.to_string(), "every 0.1 s and on `contact`");
    /// ```
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    /// Refuses numbers that make no schedule of a run until `end` \[s\], and events that the scene lacks.
    pub(super) fn check<T: Real, const D: usize>(
        &self,
        simulation: &Simulation<T, D>,
        end: f64,
    ) -> Result<()> {
        let refuse = |what: &str, value: f64, must_be| {
            let what = what.into();
            Err(Problem::Parameter {
                what,
                value,
                must_be,
            }
            .into())
        };
        let least = 1e3 * rounding(end.abs().max(simulation.time().abs()));
        for rule in &self.0 {
            match rule {
                Rule::Every(dt) if !(dt.is_finite() && *dt > least) => {
                    return refuse(
                        "interval of a schedule",
                        *dt,
                        "it must be positive, above rounding of the times of the run, and finite, in seconds",
                    );
                }
                Rule::At(times) => {
                    if let Some(time) = times.iter().find(|time| !time.is_finite()) {
                        return refuse(
                            "time of a schedule",
                            *time,
                            "it must be finite, in seconds",
                        );
                    }
                }
                Rule::Evenly(count) if *count < 2 => {
                    return refuse(
                        "number of times of a schedule",
                        *count as f64,
                        "take two at least, for beginning and end, or Schedule::end()",
                    );
                }
                Rule::Steps(0) => {
                    return refuse(
                        "number of steps of a schedule",
                        0.0,
                        "take one at least, which is every step",
                    );
                }
                Rule::On(event) => {
                    simulation.event(event)?;
                }
                _ => {}
            }
        }
        Ok(())
    }
}

impl fmt::Display for Schedule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, rule) in self.0.iter().enumerate() {
            if k > 0 {
                f.write_str(" and ")?;
            }
            match rule {
                Rule::Every(dt) => write!(f, "every {dt} s")?,
                Rule::At(times) => write!(f, "at {} times", times.len())?,
                Rule::Evenly(count) => write!(f, "at {count} times of the run")?,
                Rule::Steps(count) => write!(f, "every {count} steps")?,
                Rule::On(event) => write!(f, "on `{event}`")?,
                Rule::End => f.write_str("at the end")?,
            }
        }
        Ok(())
    }
}

/// A schedule in a run: what of it is still to come.
#[derive(Clone, Debug)]
pub(super) struct Clock {
    rules: Vec<Pending>,
}

/// A rule, and what of it was served.
#[derive(Clone, Debug)]
enum Pending {
    /// The interval \[s\], and the number of the next time.
    Every(f64, f64),
    /// Times \[s\] that are still to come, the next one last.
    At(Vec<f64>),
    Steps(u64),
    /// An event, and whether it has happened.
    On(String, bool),
    End,
}

/// Where a run is when observers are shown it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moment {
    Begin,
    /// After a step, which may end at a time that is due.
    Step,
    /// Between two steps.
    Reading,
}

impl Clock {
    /// That of a schedule in a run from now until `end` \[s\].
    pub fn new<T: Real, const D: usize>(
        schedule: &Schedule,
        simulation: &Simulation<T, D>,
        end: f64,
    ) -> Self {
        let begin = simulation.time();
        let is_new = simulation.steps() == 0;
        let ahead = |time: f64| {
            let left = time - begin;
            left > rounding(time) || (is_new && left >= -rounding(time))
        };
        let pending = |rule: &Rule| match rule {
            Rule::Every(dt) => {
                let mut next = (begin / dt).floor();
                while !ahead(next * dt) {
                    next += 1.0;
                }
                Pending::Every(*dt, next)
            }
            Rule::At(times) => {
                let mut times = times.clone();
                times.retain(|time| ahead(*time));
                times.reverse();
                Pending::At(times)
            }
            Rule::Evenly(count) => {
                let last = count - 1;
                let time = |k: usize| begin + (end - begin) * k as f64 / last as f64;
                let times = (0..last).map(time).chain([end]);
                let mut times: Vec<f64> = times.filter(|time| ahead(*time)).collect();
                times.reverse();
                Pending::At(times)
            }
            Rule::Steps(count) => Pending::Steps(*count),
            Rule::On(event) => {
                let happened = simulation.event(event).is_ok_and(|at| at.is_some());
                Pending::On(event.clone(), happened)
            }
            Rule::End => Pending::End,
        };
        Self {
            rules: schedule.0.iter().map(pending).collect(),
        }
    }

    /// The next time \[s\] of the schedule.
    pub fn next(&self) -> f64 {
        let times = self.rules.iter().map(|rule| match rule {
            Pending::Every(dt, next) => next * dt,
            Pending::At(times) => times.last().copied().unwrap_or(f64::INFINITY),
            _ => f64::INFINITY,
        });
        times.fold(f64::INFINITY, f64::min)
    }

    /// Whether the observer is shown this moment of a run, which may be its end; what is served is over.
    pub fn strikes<T: Real, const D: usize>(
        &mut self,
        now: &Simulation<T, D>,
        moment: Moment,
        is_end: bool,
    ) -> bool {
        let is_due = |time: f64| time - now.time() <= rounding(time);
        let mut any = false;
        for rule in &mut self.rules {
            any |= match rule {
                Pending::Every(dt, next) => {
                    let due = is_due(*next * *dt);
                    while is_due(*next * *dt) {
                        *next += 1.0;
                    }
                    due
                }
                Pending::At(times) => {
                    let before = times.len();
                    while times.last().is_some_and(|next| is_due(*next)) {
                        times.pop();
                    }
                    times.len() < before
                }
                Pending::Steps(count) => {
                    moment == Moment::Step && now.steps().is_multiple_of(*count)
                }
                Pending::On(event, happened) => {
                    let new = !*happened && now.event(event).is_ok_and(|at| at.is_some());
                    *happened |= new;
                    new
                }
                Pending::End => is_end,
            };
        }
        any
    }
}
