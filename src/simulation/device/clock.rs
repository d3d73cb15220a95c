//! When the operations of a step act, and what they share: the step, gravity, numbers of laws; and readings between steps.
//! It is the host's own order of a step, without the particles.

use super::Offloaded;
use super::clamps;
use super::laws::{Acting, record_law};
use crate::effect::Smoothing;
use crate::error::{Error, Result};
use crate::scalar::Real;
use crate::simulation::Group;
use crate::simulation::run::check_end;
use crate::simulation::stored::EVERY;
use crate::simulation::view::{Reading, rounding};
use crate::simulation::vote::{Criterion, Vote};

/// When an operation acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The time \[s\].
    pub time: f64,
    /// The two numbers that its actions start with: of most a time \[s\] over which they act, and half of it.
    pub over: [f64; 2],
    /// Of a combination with a state that is kept the shares of that and of the present one, and by how much both are more than one.
    pub shares: [f64; 3],
    /// The ends \[s\] of the drift under way, along which walls go straight.
    pub chord: Option<[f64; 2]>,
}

impl Moment {
    fn over(time: f64, dt: f64) -> Self {
        Self {
            time,
            over: [dt, 0.5 * dt],
            shares: [0.0; 3],
            chord: None,
        }
    }
}

/// How far a run goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Advance {
    /// It has reached its end.
    Done,
    /// By a step of this size \[s\].
    Step(f64),
    /// By a reading: a step of this size \[s\] of a copy, from which the run does not go on.
    Reading(f64),
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// Whether rates at the present state are at hand.
    #[must_use]
    pub fn has_rates(&self) -> bool {
        self.simulation.state.rates_at_hand
    }

    /// Refuses an end of a run \[s\] that is no finite time.
    ///
    /// # Errors
    /// [`Error::Argument`].
    pub fn check_end(&self, end: f64) -> Result<()> {
        check_end(end)
    }

    /// Remembers an error after which the state is not to be trusted.
    pub fn fail(&mut self, error: Error) -> Error {
        self.simulation.failed = Some(error.to_string());
        error
    }

    /// Refuses to go on after a failure.
    ///
    /// # Errors
    /// [`Error::Failed`] with its cause.
    pub fn check(&self) -> Result<()> {
        self.simulation.check_failure()
    }

    /// Begins an evaluation of the rates, `offset` \[s\] after the start of the step.
    ///
    /// # Errors
    /// If a uniform load gives no number.
    pub fn begin_evaluation(&mut self, offset: f64) -> Result<Moment> {
        let time = self.simulation.state.time + offset;
        let gravity = self.simulation.uniform_loads(time)?;
        let state = &mut self.simulation.state;
        let elapsed = core::mem::take(&mut state.due);
        (state.evaluated, state.impulses.time) = (time, time);
        state.evaluations += 1;
        state.rates_at_hand = true;
        for (group, own) in state.groups.iter_mut().zip(&mut self.recorded) {
            own.travel.evaluate();
            group.gravity = gravity;
            group.work.evaluated_gravity = gravity.map(T::from_f64);
            group.work.evaluated_time = time;
            let structures = group.walls.iter_mut().filter_map(|w| w.structure.as_mut());
            structures.for_each(|structure| structure.evaluated = time);
            if matches!(group.scheme.smoothing, Smoothing::Consistent(_)) {
                let since = time - group.work.lengths_time;
                let known = since.is_finite() && since != 0.0;
                let [since, inverse] = if known {
                    [since, since.recip()]
                } else {
                    [0.0; 2]
                };
                let any = group.work.lengths_time != time;
                own.since_lengths = [since, inverse, f64::from(u8::from(any))];
                group.work.lengths_time = time;
            }
        }
        Ok(Moment::over(time, elapsed))
    }

    /// A kick over `dt` \[s\].
    pub fn begin_kick(&mut self, dt: f64) -> Moment {
        let all = self.recorded.iter_mut();
        all.for_each(|own| own.travel.kick(dt));
        Moment::over(self.simulation.state.time, dt)
    }

    /// A prediction over `dt` \[s\], or the end of one.
    pub fn begin_prediction(&mut self, dt: Option<f64>) -> Moment {
        self.is_predicted = dt.is_some();
        self.begin_kick(dt.unwrap_or(0.0))
    }

    /// Begins a drift over `dt` \[s\], `offset` \[s\] after the start of the step.
    ///
    /// # Errors
    /// If a uniform load gives no number.
    pub fn begin_drift(&mut self, dt: f64, offset: f64) -> Result<Moment> {
        let begin = self.simulation.state.time + offset;
        let middle = begin + 0.5 * dt;
        self.simulation.state.impulses.time = begin + dt;
        let all = self.recorded.iter_mut();
        all.for_each(|own| own.travel.drift(dt));
        let groups = &self.simulation.state.groups;
        if !groups.iter().all(Group::drifts_at_once) {
            let gravity = self.simulation.uniform_loads(middle)?;
            for group in &mut self.simulation.state.groups {
                group.gravity = gravity;
            }
        }
        Ok(Moment {
            chord: Some([begin, begin + dt]),
            ..Moment::over(middle, dt)
        })
    }

    /// A shift by `dv` \[s\] times the velocity and `da` \[s²\] times the acceleration.
    pub fn begin_shift(&mut self, dv: f64, da: f64) -> Moment {
        self.simulation.state.impulses.time += dv;
        self.forget_travel();
        Moment {
            over: [dv, da],
            ..Moment::over(self.simulation.state.time, dv)
        }
    }

    /// A look at the particles after the last step.
    #[must_use]
    pub fn begin_vote(&self) -> Moment {
        Moment::over(self.simulation.state.time, 0.0)
    }

    /// The numbers that all particles of a group share at a moment.
    #[must_use]
    pub fn shared(&self, number: usize, moment: &Moment) -> Vec<f64> {
        let group = &self.simulation.state.groups[number];
        let recorded = &self.recorded[number];
        let mut all = moment.over.to_vec();
        all.extend(group.gravity);
        all.extend(group.work.evaluated_gravity.map(Real::to_f64));
        all.extend(&recorded.range);
        all.extend(group.carried_since_listed(moment.time));
        if matches!(group.scheme.smoothing, Smoothing::Consistent(_)) {
            all.extend(recorded.since_lengths);
        }
        if self.simulation.integrator.slots() > 0 {
            all.extend(moment.shares);
        }
        for own in &recorded.timed {
            let law = &group.scheme.program.laws[own.stage.number()][own.law];
            let acting = Acting {
                time: moment.time,
                dt: moment.over[0],
                gravity: group.gravity,
                in_drift: own.in_drift,
            };
            match record_law(group, &**law, own.part, acting) {
                Some(record) => {
                    all.push(f64::from(u8::from(record.acts)));
                    all.extend(record.constants);
                }
                None => all.extend([0.0; 5]),
            }
        }
        all.extend(clamps::shared(group, moment.time));
        all
    }

    /// What is to be done next on the way to `end` \[s\], which may be infinite for one step. The last vote is of the present state.
    ///
    /// # Errors
    /// As [`Simulation::run_until`](crate::simulation::Simulation::run_until).
    pub fn advance(&mut self, end: f64) -> Result<Advance> {
        self.check()?;
        let rounding = if end == f64::INFINITY {
            0.0
        } else {
            check_end(end)?;
            rounding(end)
        };
        let left = end - self.simulation.state.time;
        if left <= rounding {
            return Ok(Advance::Done);
        }
        let next = self.next()?;
        let is_reading = next.step > left + rounding;
        let vote = if is_reading {
            Vote {
                step: left,
                criterion: Criterion::End,
                ..next
            }
        } else {
            next
        };
        self.under_way = Some([vote, next]);
        Ok(if is_reading {
            Advance::Reading(vote.step)
        } else {
            Advance::Step(vote.step)
        })
    }

    /// Begins the step that [`advance`](Self::advance) has found.
    ///
    /// # Errors
    /// As [`Simulation::run_until`](crate::simulation::Simulation::run_until).
    pub fn begin_step(&mut self) -> Result<()> {
        if let Some([vote, next]) = self.under_way {
            self.simulation.open_step(vote, next)?;
            self.simulation.state.due += vote.step;
        }
        Ok(())
    }

    /// Whether stored energy is looked at after the last step, for which the host must have the state.
    #[must_use]
    pub fn looks_at_energy(&self) -> bool {
        let state = &self.simulation.state;
        state.steps.is_multiple_of(EVERY) && state.stores.accounts.iter().any(Option::is_some)
    }

    /// Looks at stored energy.
    ///
    /// # Errors
    /// [`Error::StoredEnergy`] where the time integration creates energy.
    pub fn look_at_energy(&mut self) -> Result<()> {
        let looked = self.simulation.look_at_stores();
        self.simulation.keep_failure(looked)
    }

    /// Ends the step that [`advance`](Self::advance) has begun.
    pub fn end_step(&mut self) {
        self.keeps_states = false;
        if let Some([vote, next]) = self.under_way.take() {
            self.simulation.close_step(vote, next);
            self.last_vote = None;
        }
    }

    /// Sets the state that is shown aside, and steps a copy for a reading. The host must have the state ([`columns_mut`](Self::columns_mut)).
    pub fn begin_reading(&mut self) {
        self.last_step = Some((self.simulation.keep(), self.last_vote));
    }

    /// Shows the state after the step of a copy as that at `end` \[s\].
    pub fn show(&mut self, end: f64) {
        if let Some((last, vote)) = self.last_step.take() {
            self.simulation.state.time = end;
            self.simulation.shown = Reading::Between(Box::new(last));
            self.last_vote = vote;
        }
    }

    /// Shows the state after the last step as that at `end` \[s\], from which its time differs by rounding.
    pub fn show_rounded(&mut self, end: f64) {
        if end - self.simulation.state.time <= rounding(end) && end.is_finite() {
            self.simulation.show_at(end);
        }
    }

    /// Goes back to the state after the last step; whether another was shown, which the device has.
    pub fn return_to_last_step(&mut self) -> bool {
        let between = self.simulation.last_step().is_some();
        if between {
            self.forget_travel();
        }
        self.simulation.return_to_last_step();
        between
    }
}
