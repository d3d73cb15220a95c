//! What a reading is shown between two steps, and what becomes of it: steps follow from the state after the last step alone.
//! Counts of work are those of the run, which the shown state has no part in.

use super::Simulation;
use super::run_state::State;
use super::vote::Vote;
use crate::clock::Instant;
use crate::error::Result;
use crate::scalar::Real;
use core::mem;

/// What readings are shown.
#[derive(Clone, Debug)]
pub(super) enum Reading<T: Real, const D: usize> {
    /// The state after the last step.
    LastStep,
    /// The same, at a time that differs by rounding from its own, which is this \[s\].
    Rounded(f64),
    /// A copy that has taken a shortened step; the state after the last step is kept here, of which ranks that step by parts have
    /// their own particles alone.
    Between(Box<State<T, D>>),
}

/// Times \[s\] that are one, near a time \[s\].
pub(crate) fn rounding(time: f64) -> f64 {
    1e-12 * time.abs()
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Shows the state at `time` \[s\], which is before the end of the next step.
    pub(super) fn show(&mut self, time: f64, next: Vote) -> Result<()> {
        let (start, before) = (Instant::now(), self.phases());
        if self.team.as_ref().is_some_and(|team| team.count() > 1) {
            self.keep_own();
            self.join_counts();
        } else {
            self.end_parts();
        }
        let last = self.keep();
        let stepped = self.advance(next, time - self.state.time);
        self.state.time = time;
        self.forget_taken_back();
        self.book_step(start, before);
        if stepped.is_err() {
            self.put_back(last);
            return stepped;
        }
        self.shown = Reading::Between(Box::new(last));
        Ok(())
    }

    /// Shows the state after the last step at `time` \[s\], from which its own differs by rounding.
    pub(super) fn show_at(&mut self, time: f64) {
        if self.state.time != time {
            self.shown = Reading::Rounded(mem::replace(&mut self.state.time, time));
        }
    }

    /// Goes back to the state after the last step, and to the rates that it has left.
    pub(super) fn return_to_last_step(&mut self) {
        self.state.withdraw();
        self.take_up();
        match mem::replace(&mut self.shown, Reading::LastStep) {
            Reading::LastStep => {}
            Reading::Rounded(time) => self.state.time = time,
            Reading::Between(last) => self.put_back(*last),
        }
        // Where ranks do not step by parts a step shows all particles.
        if !self.steps_parts {
            self.bring_together();
        }
    }

    /// Makes the state that is shown the one from which the next step starts.
    ///
    /// By itself a reading changes nothing of what comes: after [`run_until`](Self::run_until) the next step starts from
    /// where the last one ended, which may be before the time that is shown. Where another program acts on what was read,
    /// by forces that loads take from it or by motions of walls, both go on from the same time after this. It counts as a
    /// step, and [events](crate::scene::Scene::event) are looked at. [`set_velocities`](Self::set_velocities),
    /// [`set_field`](Self::set_field) and [`step_at_most`](Self::step_at_most) do the same.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use std::sync::{Arc, Mutex};
    /// // A force per mass that another program finds from where the rod is, 20 times a microsecond.
    /// let force = Arc::new(Mutex::new(0.0));
    /// let given = force.clone();
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
    ///     .acceleration(move |_| [*given.lock().unwrap()])
    ///     .build()?;
    /// let at_rest = rod.ledger().bodies[0].1.momentum[0];
    /// for k in 1..=20 {
    ///     rod.run_until(5e-8 * f64::from(k))?;
    ///     rod.accept();
    ///     *force.lock().unwrap() = 1e6 * (1.0 - rod.time() / 1e-6);
    /// }
    /// assert!(rod.ledger().bodies[0].1.momentum[0] > at_rest);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn accept(&mut self) {
        self.take_up();
        self.leave_last_step();
    }

    /// The same, with the rates of an evaluation between steps.
    fn leave_last_step(&mut self) {
        if let Reading::Between(last) = mem::replace(&mut self.shown, Reading::LastStep) {
            drop(last);
            self.watch_events();
            let held = self.follow_clamps(true);
            if self.exchange_schemes() || held {
                self.state.rates_at_hand = false;
            }
        }
    }

    /// Forgets rates, after the shown state was changed from outside, which is that of the run then.
    pub(super) fn forget_rates(&mut self) {
        self.aside = None;
        self.leave_last_step();
        self.state.rates_at_hand = false;
    }

    /// Takes up what was there before an evaluation between steps.
    pub(super) fn take_up(&mut self) {
        if let Some(aside) = self.aside.take() {
            self.put_back(*aside);
        }
    }

    /// Acts on the state after the last step, while another is shown: of all particles, which ranks bring together for it.
    pub(super) fn on_last_step<R>(&mut self, act: impl FnOnce(&mut Self) -> R) -> R {
        let (mut aside, mut shown) = (self.aside.take(), Reading::LastStep);
        mem::swap(&mut self.shown, &mut shown);
        let mut exchange = |own: &mut Self| {
            if let Some(aside) = &mut aside {
                mem::swap(&mut *own.state, aside);
            }
        };
        exchange(self);
        self.exchange_shown(&mut shown);
        self.bring_together();
        let result = act(self);
        self.exchange_shown(&mut shown);
        exchange(self);
        (self.aside, self.shown) = (aside, shown);
        result
    }

    fn exchange_shown(&mut self, shown: &mut Reading<T, D>) {
        match shown {
            Reading::LastStep => {}
            Reading::Rounded(time) => mem::swap(&mut self.state.time, time),
            Reading::Between(last) => mem::swap(&mut *self.state, last),
        }
    }

    /// Acts on the state after the last step, and on what is shown where that is another.
    pub(super) fn on_both(&mut self, act: &dyn Fn(&mut Self)) {
        if let Some(mut aside) = self.aside.take() {
            mem::swap(&mut *self.state, &mut aside);
            self.on_both(act);
            mem::swap(&mut *self.state, &mut aside);
            self.aside = Some(aside);
        } else if self.last_step().is_some() {
            self.on_last_step(|own| act(own));
        }
        act(self);
    }

    /// The state after the last step, where another is shown.
    pub(super) fn last_step(&self) -> Option<&State<T, D>> {
        match &self.shown {
            Reading::Between(last) => Some(last),
            _ => self.aside.as_deref(),
        }
    }

    /// The state after the last step, which has counted what it took.
    pub(super) fn after_step(&self) -> &State<T, D> {
        self.last_step().unwrap_or(self.state.own())
    }

    /// Steps taken. A state that is shown between two steps is that of neither.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.after_step().steps
    }

    /// Evaluations of the rates so far, for steps.
    #[must_use]
    pub fn evaluations(&self) -> u64 {
        self.after_step().evaluations
    }

    /// What set the last step.
    #[must_use]
    pub fn last_vote(&self) -> Option<Vote> {
        self.after_step().last_vote
    }
}
