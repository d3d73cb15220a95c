//! The operations that integrators compose, on one group that sub-cycles or on all others at once.
//! What one does to the state of a group is in `state`; here is the order among groups.

use super::Simulation;
use super::group::Group;
use super::run_state::State;
use super::stages::Moment;
use crate::error::Result;
use crate::integrator::System;
use crate::scalar::Real;

/// The groups that a step takes with it: one that sub-cycles alone, or all that do not.
pub(super) struct Stepping<'a, T: Real, const D: usize> {
    simulation: &'a mut Simulation<T, D>,
    alone: Option<usize>,
    /// The time \[s\] at the start of the step.
    start: f64,
    /// Its size \[s\]; zero of an evaluation.
    size: f64,
    /// The time \[s\] over which what follows the flow once a step has yet to do so: at the first evaluation.
    due: f64,
}

impl<T: Real, const D: usize> Stepping<'_, T, D> {
    /// Its groups.
    fn groups(&mut self) -> impl Iterator<Item = &mut Group<T, D>> {
        let (alone, groups) = (self.alone, self.simulation.state.groups.iter_mut());
        let groups = groups.enumerate();
        let own = groups.filter(move |(k, group)| group.steps_with(alone, *k));
        own.map(|(_, group)| group)
    }

    /// What no group has alone, if all step that do not sub-cycle.
    fn shared(&mut self) -> Option<&mut State<T, D>> {
        let together = self.alone.is_none();
        together.then_some(&mut self.simulation.state)
    }

    /// Lets groups that sub-cycle take their steps in a drift over `dt` \[s\] from `begin` \[s\]: those before its middle, or the
    /// others.
    fn sub_cycle(&mut self, begin: f64, dt: f64, before_middle: bool) -> Result<()> {
        let (apart, share) = (
            self.shared().map_or(0, |state| state.groups.len()),
            dt / self.size,
        );
        for group in 0..apart {
            let own = &mut self.simulation.state.groups[group];
            let (steps, count) = own.take_steps(share, before_middle);
            let size = dt / count as f64;
            let integrator = self.simulation.integrator.clone();
            for step in steps {
                let mut alone = Stepping {
                    simulation: self.simulation,
                    alone: Some(group),
                    start: begin + step as f64 * size,
                    size,
                    due: size,
                };
                integrator.step(&mut alone, size)?;
            }
        }
        Ok(())
    }

    /// Tells its groups, or all if they step together, what the uniform loads give at `time` \[s\].
    fn load_groups(&mut self, time: f64, evaluated: bool) -> Result<()> {
        let gravity = self.simulation.uniform_loads(time)?;
        let groups = &mut self.simulation.state.groups;
        let own = match self.alone {
            Some(group) => &mut groups[group..=group],
            None => groups,
        };
        for group in own {
            group.gravity = gravity;
            if evaluated {
                group.work.evaluated_gravity = gravity.map(T::from_f64);
            }
        }
        Ok(())
    }

    fn has(&self, group: usize) -> bool {
        self.simulation.state.groups[group].steps_with(self.alone, group)
    }
}

impl<T: Real, const D: usize> System for Stepping<'_, T, D> {
    fn evaluate(&mut self, offset: f64) -> Result<()> {
        let time = self.start + offset;
        let elapsed = core::mem::take(&mut self.due);
        self.load_groups(time, true)?;
        if self.alone.is_none() {
            self.simulation.state.evaluated = time;
            self.simulation.state.impulses.time = time;
            self.simulation.place_structures(time, true, [0.0; 2]);
        }
        // A group that sub-cycles comes with rates of its own, but at the start.
        let all = self.alone.is_none() && !self.simulation.state.rates_at_hand;
        for k in 0..self.simulation.state.groups.len() {
            if !(all || self.has(k)) {
                continue;
            }
            self.simulation.tell_times(k);
            self.simulation.state.groups[k].fill_buffers(time)?;
            self.simulation.state.groups[k].evaluate(time, elapsed);
            self.simulation.follow_moves(k);
            self.simulation.apply_loads(k, time)?;
            let group = &mut self.simulation.state.groups[k];
            group.free_buffers();
            if group.sub_cycles() {
                group.hold(time, false);
            }
        }
        if self.alone.is_none() {
            self.simulation.couple();
            self.simulation.check_couples(time)?;
            self.simulation.state.add_forces_of_joints(time)?;
            self.simulation.hold(time);
            self.simulation.state.hold_forces(time);
            self.simulation.state.evaluations += 1;
            self.simulation.state.rates_at_hand = true;
        }
        Ok(())
    }

    fn kick(&mut self, dt: f64) {
        let moment = Moment {
            dt,
            ..Moment::at(self.start)
        };
        for group in self.groups() {
            group.run_all(|entries| &entries.work, moment);
        }
        self.simulation.record_kick(self.alone, dt);
        for group in self.groups() {
            group.run_all(|entries| &entries.kick, moment);
        }
        let Some(state) = self.shared() else {
            return;
        };
        for group in &mut state.groups {
            group.kick_apart(dt);
        }
        state.hold_motions(state.evaluated, true);
    }

    fn drift(&mut self, dt: f64, offset: f64) -> Result<()> {
        let (begin, half) = (self.start + offset, 0.5 * dt);
        if let Some(state) = self.shared() {
            state.impulses.time = begin + dt;
            state.hold_drift(begin, dt)?;
        }
        self.sub_cycle(begin, dt, true)?;
        for group in self.groups() {
            group.begin_drift(dt);
        }
        if self.groups().all(|group| group.drifts_at_once()) {
            return self.sub_cycle(begin, dt, false);
        }
        // Loads and walls at the middle of the drift, and walls go straight through it as particles do:
        // a tank that moves is then a tank at rest in a frame that does.
        self.load_groups(begin + half, false)?;
        if self.alone.is_none() {
            let drift = [dt, dt / self.size];
            self.simulation.place_structures(begin + half, false, drift);
        }
        // Groups that sub-cycle feel the others in kicks alone, so they may be at the end of the drift already.
        self.sub_cycle(begin, dt, false)?;
        for k in 0..self.simulation.state.groups.len() {
            if self.has(k) {
                self.simulation.end_drift(k, begin, dt);
            }
        }
        Ok(())
    }

    fn shift(&mut self, dv: f64, da: f64) {
        for group in self.groups() {
            group.move_particles(dv);
            group.move_by_rates(da);
        }
        if let Some(state) = self.shared() {
            state.impulses.time += dv;
        }
    }

    fn predict(&mut self, dt: f64) {
        for group in self.groups() {
            group.predict(dt);
        }
        if let Some(state) = self.shared() {
            state.hold_motions(state.impulses.time, false);
        }
    }

    fn restore(&mut self) {
        for group in self.groups() {
            group.restore();
        }
    }

    fn save(&mut self, slot: usize) {
        for group in self.groups() {
            group.save(slot);
        }
        if let Some(state) = self.shared() {
            state.save_impulses(slot);
        }
    }

    fn load(&mut self, slot: usize) {
        for group in self.groups() {
            group.load(slot);
        }
        if let Some(state) = self.shared() {
            state.load_impulses(slot);
        }
    }

    fn combine(&mut self, slot: usize, a: f64, b: f64, dt: f64) {
        let rates = self.simulation.impulse_rates();
        for group in self.groups() {
            group.combine(slot, a, b, dt);
        }
        if let Some(state) = self.shared() {
            state.combine_impulses(slot, [a, b, dt], &rates);
        }
    }

    fn accumulate(&mut self, slot: usize, dt: f64) {
        let rates = self.simulation.impulse_rates();
        for group in self.groups() {
            group.accumulate(slot, dt);
        }
        if let Some(state) = self.shared() {
            state.accumulate_impulses(slot, &rates, dt);
        }
    }

    fn has_rates(&self) -> bool {
        self.alone.is_some() || self.simulation.state.rates_at_hand
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Takes all groups that do not sub-cycle through a step of `dt` \[s\], and the others with them.
    pub(super) fn step_together(&mut self, dt: f64) -> Result<()> {
        let integrator = self.integrator.clone();
        self.keep_own();
        self.state.due += dt;
        self.state.turn_joints(None);
        self.together(dt, |own| integrator.step(own, dt))?;
        self.state.turn_joints(Some(dt));
        self.state.check_joints()
    }

    /// Evaluates all rates at the present state.
    pub(super) fn evaluate_together(&mut self) -> Result<()> {
        self.together(0.0, |own| own.evaluate(0.0))
    }

    fn together(
        &mut self,
        size: f64,
        act: impl FnOnce(&mut Stepping<'_, T, D>) -> Result<()>,
    ) -> Result<()> {
        let mut own = Stepping {
            alone: None,
            start: self.state.time,
            size,
            due: self.state.due,
            simulation: self,
        };
        let acted = act(&mut own);
        let due = own.due;
        self.state.due = due;
        acted
    }

    /// The middle and the second half of a drift of a group that something looks at on its way.
    pub(super) fn end_drift(&mut self, group: usize, begin: f64, dt: f64) {
        let middle = begin + 0.5 * dt;
        if self.state.groups[group].scheme.acts_in_drift() {
            self.tell_times(group);
            self.state.groups[group].refresh(middle, Some([begin, begin + dt]));
            self.follow_moves(group);
            let moment = Moment {
                dt,
                in_drift: true,
                ..Moment::at(middle)
            };
            self.state.groups[group].run_all(|entries| &entries.drift, moment);
        }
        let group = &mut self.state.groups[group];
        if !group.drifts_at_once() {
            group.move_particles(0.5 * dt);
        }
    }
}
