//! Steps in time: one, or as many as there are before an end.
//! A step that fails is the last one.

use super::Simulation;
use super::view::rounding;
use super::vote::{Criterion, NO_VOTE, Vote};
use crate::error::{Error, Problem, Result};
use crate::once::once;
use crate::scalar::Real;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Takes the next step of the run, and returns its size \[s\].
    ///
    /// It starts from where the last one ended, also where a state after that [is shown](crate::simulation#readings).
    ///
    /// # Errors
    /// As [`run_until`](Simulation::run_until).
    pub fn step(&mut self) -> Result<f64> {
        self.return_to_last_step();
        self.step_to(f64::INFINITY)
    }

    /// Takes one step of at most `limit` \[s\], which may be infinite, from the state that is shown.
    ///
    /// A limit below the step that the state asks for cuts a step of the run, so results depend on it. Equal cuts at equal
    /// intervals excite what is not damped: a leapfrog of steps that vary periodically resonates far below its limit of
    /// stability. To read the state at a time use [`run_until`](Self::run_until), which cuts none.
    ///
    /// # Errors
    /// As [`run_until`](Simulation::run_until), and [`Error::Argument`] if the limit is not positive.
    pub fn step_at_most(&mut self, limit: f64) -> Result<f64> {
        if limit.is_nan() || limit <= 0.0 {
            return self.agree_on(Err(Error::Argument(Problem::Parameter {
                what: "limit of the step".into(),
                value: limit,
                must_be: "it must be positive, in seconds",
            })));
        }
        self.accept();
        self.step_to(limit)
    }

    pub(super) fn step_to(&mut self, limit: f64) -> Result<f64> {
        once!(self => &mut Simulation, |own, limit: f64| -> Result<f64> {
            let next = own.next_step();
            let taken = next.and_then(|next| own.take_step(next, limit));
            own.agree(taken)
        })
    }

    /// The next step, from the state after the last one. Particles have entered, and rates are at hand.
    pub(super) fn next_step(&mut self) -> Result<Vote> {
        self.check_failure()?;
        let (start, before) = (crate::clock::Instant::now(), self.phases());
        let time = self.state.time;
        for k in 0..self.state.groups.len() {
            let entered = self.state.groups[k].emit(time);
            if self.keep_failure(entered)? {
                self.state.rates_at_hand = false;
            }
        }
        let next = self.find_step();
        self.book_step(start, before);
        self.keep_broken(next)
    }

    /// The error that describes a step in which time does not go on, by the last vote.
    pub(super) fn collapsed(&self, step: f64) -> Error {
        let vote = self.state.last_vote.unwrap_or(NO_VOTE);
        let (body, particle) = self.locate(vote.particle);
        Error::StepCollapsed {
            step,
            time: self.state.time,
            criterion: vote.criterion.name(),
            body,
            particle,
        }
    }

    /// Remembers an error after which the state is not to be trusted.
    pub(super) fn keep_failure<R>(&mut self, outcome: Result<R>) -> Result<R> {
        if let Err(error) = &outcome {
            self.failed = Some(error.to_string());
        }
        outcome
    }

    /// The same, of errors that say that the state or what acts on it is broken.
    pub(super) fn keep_broken<R>(&mut self, outcome: Result<R>) -> Result<R> {
        match outcome {
            Err(
                error @ (Error::NotFinite { .. }
                | Error::Load { .. }
                | Error::Function { .. }
                | Error::WallJump { .. }
                | Error::SoundSpeedTooLow { .. }),
            ) => self.keep_failure(Err(error)),
            outcome => outcome,
        }
    }

    fn find_step(&mut self) -> Result<Vote> {
        let changed = !self.state.rates_at_hand;
        if changed {
            self.keep_own();
            self.evaluate_together()?;
        }
        self.begin_stores(changed);
        let vote = self.found(Self::vote)?;
        let fixed = self.control.fixed;
        let limit = fixed
            .map(|_| self.found(Self::largest_fixed_step))
            .transpose()?;
        self.next_by(vote, limit)
    }

    /// The next step by a vote; a fixed one is compared with a limit.
    pub(super) fn next_by(&mut self, mut vote: Vote, limit: Option<Vote>) -> Result<Vote> {
        if let (Some(fixed), Some(limit)) = (self.control.fixed, limit) {
            // A limit that varies by rounding is not a violation.
            if fixed > limit.step * (1.0 + 1e-6) {
                return Err(Error::Argument(Problem::StepAboveLimit {
                    step: fixed,
                    limit: limit.step,
                    criterion: limit.criterion.name(),
                }));
            }
            vote = Vote {
                step: fixed,
                criterion: Criterion::Fixed,
                ..vote
            };
        }
        let first = *self.state.first_step.get_or_insert(vote.step);
        if vote.step < self.control.smallest.unwrap_or(1e-6 * first) {
            self.state.last_vote = Some(vote);
            return Err(self.collapsed(vote.step));
        }
        Ok(self.ending_with_scene(vote))
    }

    /// Takes a step of the run, of at most `limit` \[s\], and looks at what has happened.
    fn take_step(&mut self, next: Vote, limit: f64) -> Result<f64> {
        let (start, before) = (crate::clock::Instant::now(), self.phases());
        self.advance(next, limit)?;
        self.watch_events();
        let followed = self.follow_events();
        self.keep_failure(followed)?;
        self.book_step(start, before);
        Ok(next.step.min(limit))
    }

    /// Takes a step, of at most `limit` \[s\], and looks at the state that it leaves.
    pub(super) fn advance(&mut self, next: Vote, limit: f64) -> Result<()> {
        let vote = if next.step > limit {
            Vote {
                step: limit,
                criterion: Criterion::End,
                ..next
            }
        } else {
            next
        };
        self.open_step(vote, next)?;
        let stepped = crate::parallel::inside(|| self.step_together(vote.step));
        self.keep_failure(stepped)?;
        self.close_step(vote, next);
        let sound = self.check_state();
        self.keep_broken(sound)?;
        let looked = self.look_at_stores();
        self.keep_failure(looked)?;
        self.watch_step();
        Ok(())
    }

    /// Looks at what a step, which may be cut from the next one, begins with.
    pub(super) fn open_step(&mut self, vote: Vote, next: Vote) -> Result<()> {
        self.state.last_vote = Some(vote);
        // A step that time does not feel would be taken for ever.
        if self.state.time + vote.step <= self.state.time {
            self.state.last_vote = Some(next);
            return Err(self.collapsed(vote.step));
        }
        let motions = self.check_motions(vote.step);
        self.keep_failure(motions)?;
        self.state.impulses.time = self.state.time;
        Ok(())
    }

    /// Counts a step that was taken.
    pub(super) fn close_step(&mut self, vote: Vote, next: Vote) {
        self.state.time += vote.step;
        self.state.steps += 1;
        // A step that the scene has shortened says nothing of what the state asks for.
        if next.criterion != Criterion::SceneTime {
            self.state.step_before = Some(next.step);
        }
        let name = vote.criterion.name();
        match self.state.votes.iter_mut().find(|own| own.0 == name) {
            Some(own) => own.1 += 1,
            None => self.state.votes.push((name, 1)),
        }
    }

    /// Takes the next step of the run if it ends by `end` \[s\], and otherwise shows the state at that time; returns by
    /// how much time \[s\] goes on.
    ///
    /// What loops of your own step with, as [`run_with`](Self::run_with) does:
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// # let mut simulation = Scene::<f64, 1>::new(schemes::impact())
    /// #     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    /// #     .build()?;
    /// let end = 1e-6;
    /// while simulation.time() < end {
    ///     simulation.step_until(end)?;
    ///     simulation.evaluate()?;
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`run_until`](Self::run_until).
    pub fn step_until(&mut self, end: f64) -> Result<f64> {
        once!(self => &mut Simulation, |own, end: f64| -> Result<f64> {
            let gone = own.go_to(end);
            own.agree(gone)
        })
    }

    fn go_to(&mut self, end: f64) -> Result<f64> {
        check_end(end)?;
        let (shown, rounding) = (self.time(), rounding(end));
        if end - shown <= rounding {
            return Ok(0.0);
        }
        self.return_to_last_step();
        let next = self.next_step()?;
        if next.step > end - self.state.time + rounding {
            self.show(end, next)?;
        } else {
            let taken = self.take_step(next, f64::INFINITY)?;
            // Steps shorter than this are rounding, not time.
            if taken < rounding && end - self.state.time > rounding {
                return Err(self.collapsed(taken));
            }
            if end - self.state.time <= rounding {
                self.show_at(end);
            }
        }
        Ok(self.state.time - shown)
    }

    /// Steps until `end` \[s\].
    ///
    /// No step is cut: steps follow from the state alone, and the run is the same to the bit whatever ends are asked for,
    /// and how many. Where `end` is between two steps, what is shown is the state after a shortened step on a copy, from
    /// which the next step does not start; see [readings](crate::simulation#readings). To act on what is shown makes it
    /// the state of the run.
    ///
    /// # Errors
    /// [`Error::NotFinite`] when the run has broken, [`Error::StoredEnergy`] when the time integration creates energy,
    /// [`Error::Load`] when a load has, [`Error::Function`] when a function of time has, [`Error::StepCollapsed`] when the
    /// step has become tiny, [`Error::SoundSpeedTooLow`] when a liquid meets something faster than its sound, [`Error::WallJump`]
    /// when a wall leaves its velocity, [`Error::Failed`] after any of these, and [`Error::Argument`] if a fixed step
    /// exceeds the stability limit.
    pub fn run_until(&mut self, end: f64) -> Result<()> {
        if let Err(error) = check_end(end) {
            // The others may be on their way.
            return self.agree_on(Err(error));
        }
        self.check_failure()?;
        let mut outcome = self.begin_parts();
        while outcome.is_ok() && end - self.time() > rounding(end) {
            outcome = self.step_until(end).map(|_| ());
        }
        self.end_parts();
        outcome
    }

    /// Steps until `end` \[s\] and shows the simulation to `observe` after every step, and at the end if that is between
    /// two steps. A run that goes on from there shows the next step, whose end is after what was shown.
    ///
    /// # Errors
    /// As [`run_until`](Simulation::run_until).
    pub fn run_with(&mut self, end: f64, mut observe: impl FnMut(&Self)) -> Result<()> {
        if let Err(error) = check_end(end) {
            // The others may be on their way.
            return self.agree_on(Err(error));
        }
        self.check_failure()?;
        while end - self.state.time > rounding(end) {
            self.step_until(end)?;
            observe(self);
        }
        Ok(())
    }
}

/// Refuses an end that is no time.
pub(crate) fn check_end(end: f64) -> Result<()> {
    if end.is_finite() {
        return Ok(());
    }
    Err(Error::Argument(Problem::Parameter {
        what: "end of the run".into(),
        value: end,
        must_be: "must be a finite time in seconds",
    }))
}
