//! The operations that integrators compose, on all groups at once.
//! What one does to the state of a group is in `state`; here is the order among groups.

use super::Simulation;
use super::group::Group;
use super::stages::Moment;
use crate::effect::When;
use crate::error::{Error, Result};
use crate::integrator::System;
use crate::scalar::Real;
use crate::term::Stage;

impl<T: Real, const D: usize> System for Simulation<T, D> {
    fn evaluate(&mut self, offset: f64) -> Result<()> {
        let time = self.state.time + offset;
        self.state.evaluated = time;
        self.load_groups(time)?;
        for group in &mut self.state.groups {
            group.work.evaluated_gravity = group.gravity.map(T::from_f64);
        }
        self.place_structures(time, true);
        self.state.impulses.time = time;
        // What follows the flow once a step does so at the first evaluation.
        let elapsed = core::mem::take(&mut self.state.due);
        for k in 0..self.state.groups.len() {
            // A group that sub-cycles comes with rates of its own.
            if self.state.groups[k].sub_cycle.is_none() || !self.state.rates_at_hand {
                self.state.groups[k].evaluate(time, elapsed);
                self.follow_moves(k);
                self.apply_loads(k, time)?;
                if self.state.groups[k].sub_cycle.is_some() {
                    self.state.groups[k].hold(time, false);
                }
            }
        }
        self.couple();
        self.check_couples(time)?;
        self.hold(time);
        self.state.evaluations += 1;
        self.state.rates_at_hand = true;
        Ok(())
    }

    fn kick(&mut self, dt: f64) {
        for group in self.together() {
            group.heat_in_kick(dt);
        }
        self.record_kick(None, dt);
        let time = self.state.time;
        for group in &mut self.state.groups {
            if let Some(apart) = &mut group.sub_cycle {
                apart.kick(&mut group.particles, dt);
            } else {
                group.kick_all(dt, time);
            }
        }
    }

    fn drift(&mut self, dt: f64, offset: f64) -> Result<()> {
        let (begin, half) = (self.state.time + offset, 0.5 * dt);
        self.state.impulses.time = begin + dt;
        self.sub_cycle(begin, half)?;
        for group in self.together() {
            group.begin_drift(dt);
        }
        if self.together().all(|group| group.drifts_at_once()) {
            self.sub_cycle(begin + half, half)?;
            return Ok(());
        }
        // Loads and walls at the middle of the drift, and walls go straight through it as particles do:
        // a tank that moves is then a tank at rest in a frame that does.
        self.load_groups(begin + half)?;
        self.place_structures(begin + half, false);
        // Groups that sub-cycle feel the others in kicks alone, so they may be at the end of the drift already.
        self.sub_cycle(begin + half, half)?;
        for k in 0..self.state.groups.len() {
            if self.state.groups[k].sub_cycle.is_none() {
                self.end_drift(k, begin, dt);
            }
        }
        Ok(())
    }

    fn shift(&mut self, dv: f64, da: f64) {
        for group in self.together() {
            group.move_particles(dv);
            group.move_by_rates(da);
        }
        self.state.impulses.time += dv;
    }

    fn predict(&mut self, dt: f64) {
        for group in self.together() {
            group.predict(dt);
        }
    }

    fn restore(&mut self) {
        for group in self.together() {
            group.restore();
        }
    }

    fn save(&mut self, slot: usize) {
        for group in &mut self.state.groups {
            group.save(slot);
        }
        if self.state.kept_impulses.len() <= slot {
            self.state
                .kept_impulses
                .resize_with(slot + 1, Default::default);
        }
        self.state.kept_impulses[slot].clone_from(&self.state.impulses);
    }

    fn load(&mut self, slot: usize) {
        for group in &mut self.state.groups {
            group.load(slot);
        }
        if let Some(kept) = self.state.kept_impulses.get(slot) {
            self.state.impulses.clone_from(kept);
        }
    }

    fn combine(&mut self, slot: usize, a: f64, b: f64, dt: f64) {
        let rates = self.impulse_rates();
        for group in &mut self.state.groups {
            group.combine(slot, a, b, dt);
        }
        if let Some(kept) = self.state.kept_impulses.get(slot) {
            self.state.impulses = kept.combine(a, &self.state.impulses, b, &rates, dt);
        }
    }

    fn accumulate(&mut self, slot: usize, dt: f64) {
        let rates = self.impulse_rates();
        for group in &mut self.state.groups {
            group.accumulate(slot, dt);
        }
        if let Some(kept) = self.state.kept_impulses.get_mut(slot) {
            *kept = kept.combine(1.0, &rates, dt, &rates, 0.0);
        }
    }

    fn has_rates(&self) -> bool {
        self.state.rates_at_hand
    }
}

/// What an acceleration of all particles must be.
pub(crate) const ACCELERATION: &str =
    "it must be a finite number whose square is one of the scalar too, in m/s²";

/// Whether the square of a number is finite in the scalar.
pub(crate) fn is_square_finite<T: Real>(value: f64) -> bool {
    T::from_f64(value * value).to_f64().is_finite()
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Groups that do not sub-cycle.
    fn together(&mut self) -> impl Iterator<Item = &mut Group<T, D>> {
        let groups = self.state.groups.iter_mut();
        groups.filter(|group| group.sub_cycle.is_none())
    }

    /// The middle and the second half of a drift of a group that something looks at on its way.
    pub(super) fn end_drift(&mut self, group: usize, begin: f64, dt: f64) {
        let middle = begin + 0.5 * dt;
        if self.state.groups[group].scheme.sums_in_drift() {
            self.state.groups[group].refresh(middle, Some([begin, begin + dt]));
            self.follow_moves(group);
            let group = &mut self.state.groups[group];
            group.sum_stage(Stage::Continuity);
            group.advance(When::Drift, dt);
            let moment = Moment {
                dt,
                in_drift: true,
                ..Moment::at(middle)
            };
            group.apply_laws(Stage::Continuity, moment);
            group.apply_laws(Stage::Bounds, moment);
        }
        let group = &mut self.state.groups[group];
        if !group.drifts_at_once() {
            group.move_particles(0.5 * dt);
        }
    }

    /// Tells the kept states of a group what list builds did to its particles, and the ledger what boundaries gave.
    pub(super) fn follow_moves(&mut self, number: usize) {
        let kept = &self.state.kept_impulses;
        let time_of = |slot: usize| kept.get(slot).map_or(0.0, |kept| kept.time);
        let group = &mut self.state.groups[number];
        let given = group.work.follow(&mut group.particles.moved, time_of);
        let first_boundary = group.particles.bodies.len() + group.walls.len();
        for (kept, [body, boundary], impulse) in given {
            let group = &self.state.groups[number];
            let on = group.indices[body];
            let from = group.indices[first_boundary + boundary];
            for (d, value) in impulse.into_iter().enumerate() {
                let index = self.impulse_index(on, from, d);
                match kept {
                    None => self.state.impulses.add(index, value),
                    Some(slot) => self.state.kept_impulses[slot].add(index, value),
                }
            }
        }
    }

    /// Refuses forces of couplings that are no numbers.
    fn check_couples(&self, time: f64) -> Result<()> {
        for own in &self.state.couples {
            let forces = own.acting.forces.iter().flatten();
            let numbers = forces.flat_map(|(_, force)| force.iter().map(|f| f.to_f64()));
            let more = [own.acting.stored, own.acting.heat];
            if let Some(value) = numbers.chain(more).find(|x| !x.is_finite()) {
                let [first, second] = own
                    .sides
                    .each_ref()
                    .map(|side| side.name(&self.state.groups));
                return Err(Error::Function {
                    what: format!(
                        "coupling {} of `{first}` and `{second}`",
                        own.coupling.name()
                    ),
                    value,
                    time,
                    must_be: "forces, stored energy and heat of pairs must be finite wherever two particles are",
                });
            }
        }
        Ok(())
    }

    /// Tells groups what the uniform loads give at `time` \[s\].
    fn load_groups(&mut self, time: f64) -> Result<()> {
        let gravity = self.body_acceleration(time);
        if let Some(value) = gravity.into_iter().find(|a| !is_square_finite::<T>(*a)) {
            return Err(Error::Function {
                what: "acceleration of the scene (Scene::acceleration)".into(),
                value,
                time,
                must_be: ACCELERATION,
            });
        }
        for group in &mut self.state.groups {
            group.gravity = gravity;
        }
        Ok(())
    }
}
