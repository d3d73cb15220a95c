//! A run as a whole: what is shown of it and when, what ends it, and what it leaves.
//!
//! [`Run`] takes a simulation to an end. **Observers** are shown it by a [`Schedule`]; what they return may be an error, which
//! ends the run. **Criteria** ([`Stop`]) end it before its time. The [`Summary`] says what it took and why it ended.
//!
//! ```
//! use meshfree::prelude::*;
//! use meshfree::run::{Run, Schedule, Stop};
//! let mut rod = Scene::<f64, 1>::new(schemes::impact())
//!     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
//!     .boundary(MirrorPlane::wall([0.01], [1.0]))
//!     .build()?;
//! # let folder = std::env::temp_dir().join(format!("meshfree-run-{}", std::process::id()));
//! # let mut table = CsvWriter::create(folder.join("rod.csv"), &["time_s", "pressure_pa"])?;
//! # /*
//! let mut table = CsvWriter::create("out/rod.csv", &["time_s", "pressure_pa"])?;
//! # */
//! let summary = Run::new(&mut rod, 1e-4)
//!     .label("rod")
//!     .observe(Schedule::every(1e-7), |now| {
//!         let at_wall = now.all().last().map_or(0.0, |own| own.pressure());
//!         table.row(&[now.time(), at_wall])?;
//!         Ok(())
//!     })
//!     .stop(Stop::at_rest(0.05, 1e-7))
//!     .go()?;
//! println!("{summary}");
//! assert!(rod.time() < 4e-6 && summary.end.is_early());
//! # std::fs::remove_dir_all(folder).map_err(|cause| Error::File { action: "remove", path: "".into(), cause })?;
//! # Ok::<(), Error>(())
//! ```
//!
//! What is observed, when and how often changes no bit of a run: a time between two steps is shown by a
//! [reading](crate::simulation#readings), observers cannot change what they are shown, and criteria are asked after steps alone.
//!
//! In one instant criteria are asked after observers were shown it, and observers are shown it in the order in which they were
//! given.

mod receipt;
mod schedule;
mod stop;
mod summary;

pub use crate::error::Failure;
pub use schedule::Schedule;
pub use stop::Stop;
pub use summary::{End, Summary};

use crate::clock::Instant;
use crate::error::{Error, Result};
use crate::output::progress::Progress;
use crate::output::pvtu;
use crate::output::vtu::Pvd;
use crate::output::write_whole;
use crate::scalar::Real;
use crate::simulation::{Simulation, check_end, rounding};
use crate::study::cost_model::CostModel;
use core::fmt;
use receipt::Receipt;
use schedule::{Clock, Moment};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What an observer does with what it is shown.
type Show<'r, T, const D: usize> =
    Box<dyn FnMut(&Simulation<T, D>) -> std::result::Result<(), Failure> + 'r>;

/// An observer and its schedule.
struct Observer<'r, T: Real, const D: usize> {
    schedule: Schedule,
    show: Show<'r, T, D>,
}

/// A run of a simulation until an end: see the [module](self) for an example.
pub struct Run<'r, T: Real, const D: usize> {
    simulation: &'r mut Simulation<T, D>,
    end: f64,
    label: Option<String>,
    receipt: Option<PathBuf>,
    observers: Vec<Observer<'r, T, D>>,
    stops: Vec<Stop<'r, T, D>>,
}

impl<T: Real, const D: usize> fmt::Debug for Run<'_, T, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let schedules: Vec<_> = self.observers.iter().map(|own| &own.schedule).collect();
        f.debug_struct("Run")
            .field("simulation", &self.simulation)
            .field("end", &self.end)
            .field("observers", &schedules)
            .field("stops", &self.stops)
            .finish_non_exhaustive()
    }
}

impl<'r, T: Real, const D: usize> Run<'r, T, D> {
    /// A run from now until `end` \[s\].
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::run::Run;
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .build()?;
    /// let summary = Run::new(&mut rod, 1e-6).go()?;
    /// assert_eq!((rod.time(), summary.steps), (1e-6, rod.steps()));
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn new(simulation: &'r mut Simulation<T, D>, end: f64) -> Self {
        Self {
            simulation,
            end,
            label: None,
            receipt: None,
            observers: Vec::new(),
            stops: Vec::new(),
        }
    }

    /// Shows how far the run is by a [progress line](crate::output::progress) that begins with `label`, and predicts its rest by
    /// a [cost model](crate::study::cost_model).
    ///
    /// ```
    /// # use meshfree::prelude::*;
    /// # use meshfree::run::Run;
    /// # fn run(rod: &mut Simulation<f64, 1>) -> Result<(), Error> {
    /// Run::new(rod, 1e-6).label("rod").go()?;
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = Some(label.into());
        self
    }

    /// Shows the run to `show` when `schedule` says. A failure ends the run, as [`Error::Observer`].
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::run::{Run, Schedule};
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .build()?;
    /// let failed = Run::new(&mut rod, 1e-6)
    ///     .observe(Schedule::every(5e-7), |now| {
    ///         if now.time() > 0.0 { Err("the disk is full")? }
    ///         Ok(())
    ///     })
    ///     .go()
    ///     .unwrap_err();
    /// assert!(failed.to_string().contains("every 0.0000005 s failed at t = 0.0000005 s: the disk is full"), "{failed}");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn observe(
        mut self,
        schedule: Schedule,
        show: impl FnMut(&Simulation<T, D>) -> std::result::Result<(), Failure> + 'r,
    ) -> Self {
        let show = Box::new(show);
        self.observers.push(Observer { schedule, show });
        self
    }

    /// Writes a series of particle files for ParaView when `schedule` says: bodies and walls, as
    /// [`vtu_with_walls`](Simulation::vtu_with_walls) has them, listed in the `.pvd` file at `path`. In a run that goes on from a
    /// checkpoint the series goes on too.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::run::{Run, Schedule};
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .build()?;
    /// # let folder = std::env::temp_dir().join(format!("meshfree-paraview-{}", std::process::id()));
    /// # let path = folder.join("rod.pvd");
    /// # /*
    /// let path = "out/rod.pvd";
    /// # */
    /// Run::new(&mut rod, 1e-6).paraview(Schedule::every(5e-7), &path).go()?;
    /// # let list = std::fs::read_to_string(&path).unwrap_or_default();
    /// # assert!(folder.join("rod_00002.vtu").exists() && list.matches("<DataSet").count() == 3);
    /// # let _ = std::fs::remove_dir_all(folder);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn paraview(self, schedule: Schedule, path: impl AsRef<Path>) -> Self {
        let path = path.as_ref().to_path_buf();
        let begin = (self.simulation.steps() > 0).then(|| self.simulation.time());
        let mut series = None;
        self.observe(schedule, move |now| {
            if !now.is_first_rank() {
                return Ok(());
            }
            if series.is_none() {
                series = Some(match begin {
                    Some(time) => Pvd::resume(&path, time)?,
                    None => Pvd::create(&path)?,
                });
            }
            if let Some(series) = &mut series {
                series.frame(now.time(), &now.vtu_with_walls())?;
            }
            Ok(())
        })
    }

    /// The same in pieces, for runs on [ranks](crate::ranks): at each time each rank writes its own particles, as
    /// [`write_pieces`](Simulation::write_pieces) does, and the first one the list of pieces and the `.pvd` file at `path`. All ranks
    /// must see the same folder. Without ranks there is one piece at each time.
    ///
    /// A file that one rank cannot write ends the run on all, with the same error.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::ranks;
    /// use meshfree::run::{Run, Schedule};
    /// # let folder = std::env::temp_dir().join(format!("meshfree-paraview-pieces-{}", std::process::id()));
    /// # let path = folder.join("rod.pvd");
    /// # /*
    /// let path = "out/rod.pvd";
    /// # */
    /// let all = ranks::in_threads(2, 1, |ranks| -> Result<(), Error> {
    ///     let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///         .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 5e-6).velocity([20.0]))
    ///         .on_ranks(ranks)
    ///         .build()?;
    ///     Run::new(&mut rod, 1e-8).paraview_in_pieces(Schedule::every(5e-9), &path).go()?;
    ///     Ok(())
    /// })?;
    /// assert!(all.into_iter().all(|own| own.is_ok()));
    /// # let list = std::fs::read_to_string(&path).unwrap_or_default();
    /// # assert!(folder.join("rod_00002_1.vtu").exists() && list.matches("rod_00002.pvtu").count() == 1);
    /// # let _ = std::fs::remove_dir_all(folder);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn paraview_in_pieces(self, schedule: Schedule, path: impl AsRef<Path>) -> Self {
        let path = path.as_ref().to_path_buf();
        let begin = (self.simulation.steps() > 0).then(|| self.simulation.time());
        // The first rank has it, and says how a frame is named.
        let mut series = None;
        self.observe(schedule, move |now| {
            let mut begun = Ok(());
            if now.is_first_rank() && series.is_none() {
                let started = match begin {
                    Some(time) => Pvd::resume(&path, time),
                    None => Pvd::create(&path),
                };
                begun = started.map(|own| series = Some(own));
            }
            now.of_any_rank(begun)?;
            let name = series
                .as_ref()
                .map(|own| (own.next(pvtu::ENDING), String::new()));
            let Some((name, _)) = now.as_first_rank(name) else {
                // Another rank has failed, which all are told where the call ends.
                return Ok(());
            };
            now.write_pieces(path.with_file_name(&name))?;
            let listed = match &mut series {
                Some(series) => series.list(now.time(), &name),
                None => Ok(()),
            };
            Ok(now.of_any_rank(listed)?)
        })
    }

    /// Ends the run by a criterion, if that holds before its time. There may be several; the first that holds ends it.
    ///
    /// ```
    /// # use meshfree::prelude::*;
    /// # use meshfree::run::{Run, Stop};
    /// # use std::time::Duration;
    /// # fn run(rod: &mut Simulation<f64, 1>) -> Result<(), Error> {
    /// let a_day = Duration::from_secs(86_400);
    /// Run::new(rod, 1e-3).stop(Stop::at_rest(1e-4, 1e-5)).stop(Stop::wall_clock(a_day)).go()?;
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn stop(mut self, stop: Stop<'r, T, D>) -> Self {
        self.stops.push(stop);
        self
    }

    /// Leaves a receipt: one JSON file, also where the run fails.
    ///
    /// | part | what it holds |
    /// |---|---|
    /// | `label`, `version`, `scene`, `machine` | the name of the run, the crate's version; bodies, walls, schemes, integrator; processor, cores, threads, instructions |
    /// | `fingerprint` | the hashes by which [checkpoints](crate::simulation#checkpoint-and-restart) know the scene, part by part; `null` without the feature `checkpoint` |
    /// | `time_s`, `end` | the time that was reached, why it ended, and whether early or by a failure |
    /// | `predicted`, `actual` | [work](crate::simulation::Work) by [rehearsal](Simulation::expected_work) and as it came: steps, evaluations, list builds, pairs, bytes, time of steps |
    /// | `wall_clock_s` | time with observers |
    /// | `indicators`, `limits_applied` | [error indicators](Simulation::indicators) of the last state, and what limits accuracy most; [limits](Simulation::limits) |
    /// | `ledger` | mass, momentum and energy of each body and of all |
    /// | `bits_hash` | [`Simulation::bits_hash`] of the last state |
    ///
    /// The rehearsal takes a twentieth of the run or half a second, and changes no bit.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::run::Run;
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .build()?;
    /// # let folder = std::env::temp_dir().join(format!("meshfree-receipt-{}", std::process::id()));
    /// # let path = folder.join("receipt.json");
    /// # /*
    /// let path = "out/receipt.json";
    /// # */
    /// Run::new(&mut rod, 1e-6).label("rod").receipt(&path).go()?;
    /// # let text = std::fs::read_to_string(&path).unwrap_or_default();
    /// # assert!(text.contains(&format!("\"bits_hash\": \"{:016x}\"", rod.bits_hash())), "{text}");
    /// # let _ = std::fs::remove_dir_all(folder);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn receipt(mut self, path: impl AsRef<Path>) -> Self {
        self.receipt = Some(path.as_ref().to_path_buf());
        self
    }

    /// Runs.
    ///
    /// After a criterion the simulation is at the end of a step, after the end of its time there.
    ///
    /// # Errors
    /// As [`Simulation::run_until`]; [`Error::Observer`] if an observer or a criterion fails; [`Error::Argument`] if a schedule or a
    /// criterion makes no sense, or an event is not of the scene. Observers have been shown all up to there.
    pub fn go(mut self) -> Result<Summary> {
        let end = self.end;
        let clocks = match self.begin() {
            Ok(clocks) => clocks,
            // Other ranks may be on their way.
            Err(error) => return self.simulation.agree_on(Err(error)),
        };
        let Some(path) = self.receipt.take() else {
            return self.drive(clocks);
        };
        let (expected, first) = (self.simulation.expected_work(end)?, self.simulation.work());
        let label = self.label.clone();
        let outcome = self.drive(clocks);
        let receipt = Receipt {
            now: self.simulation,
            label: label.as_deref(),
            expected,
            first,
            outcome: outcome.as_ref(),
        };
        let written = if self.simulation.is_first_rank() {
            write_whole(&path, receipt.json().as_bytes())
        } else {
            Ok(())
        };
        let written = self.simulation.agree_on(written);
        outcome.and_then(|summary| written.map(|()| summary))
    }

    /// Checks what the run is asked for, and sets its clocks.
    fn begin(&mut self) -> Result<Vec<Clock>> {
        let (now, end) = (&*self.simulation, self.end);
        check_end(end)?;
        self.stops.iter_mut().try_for_each(|stop| stop.begin(now))?;
        let clock = |own: &Observer<'_, T, D>| {
            own.schedule.check(now, end)?;
            Ok(Clock::new(&own.schedule, now, end))
        };
        self.observers.iter().map(clock).collect()
    }

    fn drive(&mut self, clocks: Vec<Clock>) -> Result<Summary> {
        let summary = self.drive_on(clocks);
        self.simulation.end_parts();
        summary
    }

    fn drive_on(&mut self, mut clocks: Vec<Clock>) -> Result<Summary> {
        let end = self.end;
        let (started, first) = (Instant::now(), self.simulation.work());
        let label = self.label.take();
        let label = label.filter(|_| self.simulation.is_first_rank());
        let mut line = label.map(|label| Line::new(label, self.simulation, end));
        let mut moment = Moment::Begin;
        let reason = loop {
            let is_over = end - self.simulation.time() <= rounding(end);
            self.show(&mut clocks, moment, is_over)?;
            if moment == Moment::Step
                && let Some((name, why)) = self.asked()?
            {
                // Who waits for the end has not been shown it, unless it is that of the time too.
                if !is_over {
                    self.show(&mut clocks, Moment::Begin, true)?;
                }
                break End::Criterion { name, why };
            }
            if is_over {
                break End::Time { end };
            }
            let next = clocks.iter().map(Clock::next).fold(end, f64::min);
            let steps = self.simulation.steps();
            // Criteria look at all particles after every step.
            if self.stops.is_empty() {
                self.simulation.begin_parts()?;
            }
            self.simulation.step_until(next)?;
            moment = if self.simulation.steps() > steps {
                Moment::Step
            } else {
                Moment::Reading
            };
            if let Some(line) = &mut line {
                line.update(self.simulation);
            }
        };
        self.simulation.show_all();
        Ok(Summary::of(
            self.simulation,
            &first,
            started.elapsed(),
            reason,
        ))
    }

    /// Shows this moment to those who wait for it.
    fn show(&mut self, clocks: &mut [Clock], moment: Moment, is_end: bool) -> Result<()> {
        let now = &*self.simulation;
        let strike = |clock: &mut Clock| clock.strikes(now, moment, is_end);
        let struck: Vec<bool> = clocks.iter_mut().map(strike).collect();
        if struck.contains(&true) {
            self.simulation.show_all();
        }
        let now = &*self.simulation;
        for (observer, is_due) in self.observers.iter_mut().zip(struck) {
            if is_due {
                let shown = (observer.show)(now).map_err(|cause| Error::Observer {
                    observer: format!("the observer {}", observer.schedule),
                    time: now.time(),
                    cause,
                });
                now.agree_on(shown)?;
            }
        }
        Ok(())
    }

    /// The first criterion that holds, and why; on ranks what the first of them finds, for their clocks differ.
    fn asked(&mut self) -> Result<Option<(String, String)>> {
        if self.stops.is_empty() {
            return Ok(None);
        }
        let mut first = None;
        let mut failed = Ok(());
        // All are asked, so that what each remembers has no gaps.
        for stop in &mut self.stops {
            match stop.ask(self.simulation) {
                Ok(why) => first = first.or_else(|| Some((stop.name.clone(), why?))),
                Err(error) => failed = failed.and(Err(error)),
            }
        }
        self.simulation.agree_on(failed)?;
        Ok(self.simulation.as_first_rank(first))
    }
}

/// The progress line of a run.
struct Line {
    progress: Progress,
    model: CostModel,
    begin: f64,
    end: f64,
}

impl Line {
    fn new<T: Real, const D: usize>(label: String, now: &Simulation<T, D>, end: f64) -> Self {
        Self {
            progress: Progress::new(label),
            model: CostModel::new(),
            begin: now.time(),
            end,
        }
    }

    fn update<T: Real, const D: usize>(&mut self, now: &Simulation<T, D>) {
        if self.progress.is_due() {
            self.model.see(now);
            let forecast = self.model.forecast(self.end);
            let left = forecast.map(|left| Duration::try_from_secs_f64(left.seconds));
            if let Ok(Ok(left)) = left {
                self.progress.expect(left);
            }
        }
        let done = (now.time() - self.begin) / (self.end - self.begin);
        self.progress
            .update(done, format_args!("t = {:.4e} s", now.time()));
    }
}
