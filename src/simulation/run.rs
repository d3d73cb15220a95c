//! Steps in time: one, or as many as it takes to an end.
//! A step that fails is the last one.

use super::Simulation;
use super::control::{self, Criterion, Vote};
use crate::error::{Error, Problem, Result};
use crate::once::once;
use crate::scalar::Real;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Takes one step, and returns its size \[s\].
    ///
    /// # Errors
    /// As [`run_until`](Simulation::run_until).
    pub fn step(&mut self) -> Result<f64> {
        self.step_at_most(f64::INFINITY)
    }

    /// Takes one step of at most `limit` \[s\], which may be infinite.
    ///
    /// # Errors
    /// As [`run_until`](Simulation::run_until), and [`Error::Argument`] if the limit is not positive.
    pub fn step_at_most(&mut self, limit: f64) -> Result<f64> {
        once!(self => &mut Simulation, step_here(limit: f64) -> Result<f64>)
    }

    fn step_here(&mut self, limit: f64) -> Result<f64> {
        self.check_failure()?;
        if limit.is_nan() || limit <= 0.0 {
            return Err(Error::Argument(Problem::Parameter {
                what: "limit of the step".into(),
                value: limit,
                must_be: "it must be positive, in seconds",
            }));
        }
        self.take_up();
        for k in 0..self.groups.len() {
            let entered = self.groups[k].emit(self.time);
            if self.keep_failure(entered)? {
                self.rates_at_hand = false;
            }
        }
        let taken = self.take_step(limit);
        let kept = |error: &Error| {
            matches!(
                error,
                Error::NotFinite { .. }
                    | Error::Load { .. }
                    | Error::WallJump { .. }
                    | Error::SoundSpeedTooLow { .. }
            )
        };
        match taken {
            Err(error) if kept(&error) => self.keep_failure(Err(error)),
            taken => taken,
        }
    }

    /// The error that describes a step in which time does not go on, by the last vote.
    pub(super) fn collapsed(&self, step: f64) -> Error {
        let vote = self.last_vote.unwrap_or(control::NO_VOTE);
        let (body, particle) = self.locate(vote.particle);
        Error::StepCollapsed {
            step,
            time: self.time,
            criterion: vote.criterion.name(),
            body,
            particle,
        }
    }

    /// Remembers an error after which the state is not to be trusted.
    fn keep_failure<R>(&mut self, outcome: Result<R>) -> Result<R> {
        if let Err(error) = &outcome {
            self.failed = Some(error.to_string());
        }
        outcome
    }

    fn take_step(&mut self, limit: f64) -> Result<f64> {
        let (start, before) = (crate::clock::Instant::now(), self.phases());
        let changed = !self.rates_at_hand;
        if changed {
            crate::integrator::System::evaluate(self, 0.0)?;
        }
        self.begin_stores(changed);
        let mut vote = self.vote()?;
        if let Some(fixed) = self.control.fixed {
            let limit = self.largest_fixed_step()?;
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
        let first = *self.first_step.get_or_insert(vote.step);
        let step = vote.step.min(limit);
        // A step that time does not feel would be taken for ever.
        let lost = self.time + step <= self.time;
        if lost || vote.step < self.control.smallest.unwrap_or(1e-6 * first) {
            self.last_vote = Some(vote);
            return Err(self.collapsed(step));
        }
        if vote.step > limit {
            vote = Vote {
                step: limit,
                criterion: Criterion::End,
                ..vote
            };
        }
        self.check_walls(vote.step)?;
        self.last_vote = Some(vote);
        self.due += vote.step;
        self.impulses.time = self.time;
        // The integrator sees the simulation as a system, and is shared with it while it steps.
        let integrator = self.integrator.clone();
        let stepped = crate::parallel::inside(|| integrator.step(self, vote.step));
        self.keep_failure(stepped)?;
        self.time += vote.step;
        self.steps += 1;
        let name = vote.criterion.name();
        match self.votes.iter_mut().find(|own| own.0 == name) {
            Some(own) => own.1 += 1,
            None => self.votes.push((name, 1)),
        }
        self.check_state()?;
        let looked = self.look_at_stores();
        self.keep_failure(looked)?;
        self.watch_step();
        self.watch_events();
        let followed = self.follow_events();
        self.keep_failure(followed)?;
        self.book_step(start, before);
        Ok(vote.step)
    }

    /// Steps until `end` \[s\]; the last step is shortened to end there.
    ///
    /// # Errors
    /// [`Error::NotFinite`] when the run has broken, [`Error::StoredEnergy`] when it gains energy from nowhere, [`Error::Load`] when a load has, [`Error::StepCollapsed`] when the
    /// step has become tiny, [`Error::SoundSpeedTooLow`] when a liquid meets something faster than its sound, [`Error::WallJump`]
    /// when a wall leaves its velocity, [`Error::Failed`] after any of these, and [`Error::Argument`] if a fixed step
    /// exceeds the stability limit.
    pub fn run_until(&mut self, end: f64) -> Result<()> {
        self.run_with(end, |_| {})
    }

    /// Steps until `end` \[s\] and shows the simulation to `observe` after every step.
    ///
    /// # Errors
    /// As [`run_until`](Simulation::run_until).
    pub fn run_with(&mut self, end: f64, mut observe: impl FnMut(&Self)) -> Result<()> {
        if !end.is_finite() {
            return Err(Error::Argument(Problem::Parameter {
                what: "end of the run".into(),
                value: end,
                must_be: "must be a finite time in seconds",
            }));
        }
        self.check_failure()?;
        // Steps shorter than this are rounding, not time.
        let rounding = 1e-12 * end.abs();
        while end - self.time > rounding {
            let left = end - self.time;
            // Two equal last steps instead of a full one and a sliver. What is left after the first of
            // them is one step to rounding, and is not halved again.
            let limit = match self.last_vote {
                Some(vote) if left < 2.0 * vote.step && left > 1.000_001 * vote.step => 0.5 * left,
                _ => left,
            };
            let taken = self.step_at_most(limit)?;
            if taken < rounding && end - self.time > rounding {
                return Err(self.collapsed(taken));
            }
            if end - self.time <= rounding {
                self.time = end;
            }
            observe(self);
        }
        Ok(())
    }
}
