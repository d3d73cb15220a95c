//! Sub-cycling: groups that take several steps in each step of the others, and what couplings do to them meanwhile.
//! Tuckerman, Berne & Martyna 1992, J. Chem. Phys. 97, 1990, equation 2.25: impulses outside, own steps inside.

use super::Simulation;
use super::group::Group;
use super::population::Particles;
use crate::error::Result;
use crate::integrator::System;
use crate::particles::Field;
use crate::scalar::Real;

/// How many more steps than were asked for a group may need before its step has collapsed.
const RUNAWAY: f64 = 64.0;

/// What a group that sub-cycles has beside others.
#[derive(Clone, Debug)]
pub(crate) struct SubCycle<T, const D: usize> {
    /// How many steps it may take in one of the others at most.
    pub most: u32,
    /// What couplings do to its particles \[N\], by slot, since the last evaluation.
    pub forces: Vec<[T; D]>,
    /// What these have worked on each body since the start \[J\].
    pub work: Vec<f64>,
    /// Steps taken since the start.
    pub steps: u64,
}

impl<T: Real, const D: usize> SubCycle<T, D> {
    pub fn new(most: u32, bodies: usize) -> Self {
        Self {
            most,
            forces: Vec::new(),
            work: vec![0.0; bodies],
            steps: 0,
        }
    }

    /// v ← v + dt F/m with what couplings do to its particles, and the work of that on each body: the change of kinetic
    /// energy.
    pub fn kick(&mut self, particles: &mut Particles<T, D>, dt: f64) {
        let step = T::from_f64(dt);
        let columns = &mut particles.columns;
        let [v, mass] = columns.many_mut([Field::VELOCITY, Field::MASS]);
        for (body, work) in particles.bodies.iter().zip(&mut self.work) {
            for slot in body.slots.clone() {
                for d in 0..D {
                    let v = &mut v[slot * D + d];
                    let before = v.to_f64();
                    *v += step * self.forces[slot][d] / mass[slot];
                    *work += 0.5 * mass[slot].to_f64() * (v.to_f64().powi(2) - before * before);
                }
            }
            // Slots behind the last particle repeat it, and nothing sorts anew what keeps its neighbours.
            if let Some(last) = body.slots.clone().last() {
                for slot in body.slots.end..body.end {
                    v.copy_within(last * D..(last + 1) * D, slot * D);
                }
            }
        }
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Steps of all groups that sub-cycle since the start; see [`Scene::sub_cycle`](crate::scene::Scene::sub_cycle).
    #[must_use]
    pub fn sub_steps(&self) -> u64 {
        let groups = self.after_step().groups.iter();
        let apart = groups.filter_map(|group| group.sub_cycle.as_ref());
        apart.map(|apart| apart.steps).sum()
    }

    /// Takes groups that sub-cycle through `span` \[s\] from `begin` \[s\], in as many equal steps as each needs.
    pub(super) fn sub_cycle(&mut self, begin: f64, span: f64) -> Result<()> {
        for group in 0..self.state.groups.len() {
            let Some(most) = self.state.groups[group]
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
                self.state.last_vote = Some(own);
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
            if let Some(apart) = &mut self.state.groups[group].sub_cycle {
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
        &mut self.simulation.state.groups[self.group]
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
