//! Sub-cycling: a group in steps of its own, between the kicks that it shares with the others.
//! The integrator of the simulation takes these steps too.

use super::Simulation;
use super::group::Group;
use crate::error::Result;
use crate::integrator::System;
use crate::scalar::Real;

/// How many more steps than were asked for a group may need before its step has collapsed.
const RUNAWAY: f64 = 64.0;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Steps of all groups that sub-cycle since the start; see [`Scene::sub_cycle`](crate::scene::Scene::sub_cycle).
    #[must_use]
    pub fn sub_steps(&self) -> u64 {
        let groups = self.groups_after_step().iter();
        let apart = groups.filter_map(|group| group.sub_cycle.as_ref());
        apart.map(|apart| apart.steps).sum()
    }

    /// Takes groups that sub-cycle through `span` \[s\] from `begin` \[s\], in as many equal steps as each needs.
    pub(super) fn sub_cycle(&mut self, begin: f64, span: f64) -> Result<()> {
        for group in 0..self.groups.len() {
            let Some(most) = self.groups[group]
                .sub_cycle
                .as_ref()
                .map(|apart| apart.most)
            else {
                continue;
            };
            let own = self.vote_of(group, self.control.courant)?;
            let own = self.approach_of(group, own)?;
            let count = (span / own.step).ceil().max(1.0);
            let dt = span / count;
            // A limit of zero or no number of steps at all is a step that has collapsed.
            if count.is_nan() || count > RUNAWAY * f64::from(most) {
                self.last_vote = Some(own);
                return Err(self.collapsed(dt));
            }
            let integrator = self.integrator.clone();
            for step in 0..count as u64 {
                let mut alone = Alone {
                    start: begin + step as f64 * dt,
                    due: dt,
                    group,
                    simulation: self,
                };
                integrator.step(&mut alone, dt)?;
            }
            if let Some(apart) = &mut self.groups[group].sub_cycle {
                apart.steps += count as u64;
            }
        }
        Ok(())
    }
}

/// One group in a step of its own.
struct Alone<'a, T: Real, const D: usize> {
    simulation: &'a mut Simulation<T, D>,
    group: usize,
    /// The time \[s\] at the start of its step.
    start: f64,
    /// The time \[s\] over which what follows the flow once a step has yet to act.
    due: f64,
}

impl<T: Real, const D: usize> Alone<'_, T, D> {
    fn own(&mut self) -> &mut Group<T, D> {
        &mut self.simulation.groups[self.group]
    }
}

impl<T: Real, const D: usize> System for Alone<'_, T, D> {
    fn evaluate(&mut self, offset: f64) -> Result<()> {
        let time = self.start + offset;
        let elapsed = core::mem::take(&mut self.due);
        let gravity = self.simulation.body_acceleration(time);
        let group = self.own();
        group.gravity = gravity;
        group.work.evaluated_gravity = gravity.map(T::from_f64);
        group.evaluate(time, elapsed);
        self.simulation.follow_moves(self.group);
        self.simulation.apply_loads(self.group, time)?;
        self.own().hold(time, false);
        Ok(())
    }

    fn kick(&mut self, dt: f64) {
        self.own().heat_in_kick(dt);
        self.simulation.record_kick(Some(self.group), dt);
        let time = self.start;
        self.own().kick_all(dt, time);
    }

    fn drift(&mut self, dt: f64, offset: f64) -> Result<()> {
        let begin = self.start + offset;
        self.own().begin_drift(dt);
        if !self.own().drifts_at_once() {
            let gravity = self.simulation.body_acceleration(begin + 0.5 * dt);
            self.own().gravity = gravity;
            self.simulation.end_drift(self.group, begin, dt);
        }
        Ok(())
    }

    fn shift(&mut self, dv: f64, da: f64) {
        self.own().move_particles(dv);
        self.own().move_by_rates(da);
    }

    fn predict(&mut self, dt: f64) {
        self.own().predict(dt);
    }

    fn restore(&mut self) {
        self.own().restore();
    }

    fn save(&mut self, slot: usize) {
        self.own().save(slot);
    }

    fn load(&mut self, slot: usize) {
        self.own().load(slot);
    }

    fn combine(&mut self, slot: usize, a: f64, b: f64, dt: f64) {
        self.own().combine(slot, a, b, dt);
    }

    fn accumulate(&mut self, slot: usize, dt: f64) {
        self.own().accumulate(slot, dt);
    }

    fn has_rates(&self) -> bool {
        true
    }
}
