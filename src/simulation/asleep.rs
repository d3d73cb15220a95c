//! Particles that sleep: those outside of the box in which a simulation is awake. Their places and states are held, and they go
//! on serving as neighbours. Forces on them are replaced as those of a clamp are, and what kicks and drifts change is taken back.

use super::Simulation;
use super::group::Group;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::EnergyForm;
use std::sync::Arc;

/// The box \[m\] in which a simulation is awake, by its state.
pub(crate) type Awake<T, const D: usize> =
    Arc<dyn Fn(&Simulation<T, D>) -> [[f64; D]; 2] + Send + Sync>;

/// The particles of a group that sleep.
#[derive(Clone, Debug)]
pub(crate) struct Asleep<const D: usize> {
    /// Their bodies in the group and their numbers there, in this order.
    pub particles: Vec<(usize, u32)>,
    /// Their state, field by field.
    pub state: Vec<(Field, Vec<f64>)>,
    /// What holds each of them \[N\] against forces of its group, and against those of couplings where it sub-cycles.
    pub forces: [Vec<[f64; D]>; 2],
    /// Momentum \[kg m/s\] and energy \[J\] that they have been given since the start: against the withheld.
    pub impulse: [f64; D],
    pub energy: f64,
    /// How many have fallen asleep and have woken.
    pub fallen: u64,
    pub woken: u64,
}

impl<const D: usize> Default for Asleep<D> {
    fn default() -> Self {
        Self {
            particles: Vec::new(),
            state: Vec::new(),
            forces: [Vec::new(), Vec::new()],
            impulse: [0.0; D],
            energy: 0.0,
            fallen: 0,
            woken: 0,
        }
    }
}

/// How particles outside of the box stand in which a simulation is [awake](crate::scene::Scene::awake_inside).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sleepers {
    /// How many sleep now.
    pub particles: usize,
    /// How often one has fallen asleep since the start, those that started so among them.
    pub fallen: u64,
    /// How often one has woken.
    pub woken: u64,
    /// Momentum \[kg m/s\] that the box has given since the start: what holds the sleepers, and what took their
    /// velocity when they fell asleep.
    pub impulse: Vec<f64>,
    /// Energy \[J\] that it has given: against the kinetic energy that they had, and the work on them that nothing
    /// has received.
    pub energy: f64,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// What sleeps outside of the box of [`Scene::awake_inside`](crate::scene::Scene::awake_inside), and what that has taken;
    /// `None` in a scene that is awake everywhere.
    #[must_use]
    pub fn asleep(&self) -> Option<Sleepers> {
        self.awake.as_ref()?;
        let mut all = Sleepers {
            impulse: vec![0.0; D],
            ..Sleepers::default()
        };
        let groups = self.groups.iter();
        for own in groups.filter_map(|group| group.held.asleep.as_ref()) {
            all.particles += own.particles.len();
            all.fallen += own.fallen;
            all.woken += own.woken;
            all.energy += own.energy;
            for (sum, own) in all.impulse.iter_mut().zip(own.impulse) {
                *sum += own;
            }
        }
        Some(all)
    }

    /// Energy \[J\] that sleepers have been given since the start.
    pub(super) fn given_to_sleepers(&self) -> f64 {
        let groups = self.groups.iter();
        let own = groups.filter_map(|group| group.held.asleep.as_ref());
        own.map(|own| own.energy).sum()
    }

    /// The same, awake in a box alone.
    pub(crate) fn awake_inside(mut self, awake: Option<Awake<T, D>>) -> Self {
        if awake.is_some() {
            for group in &mut self.groups {
                group.held.asleep = Some(Asleep::default());
            }
        }
        self.awake = awake;
        self
    }

    /// Puts to sleep what is outside of the box now, and wakes what is inside: between steps.
    pub(crate) fn put_to_sleep(&mut self) {
        let Some(awake) = self.awake.clone() else {
            return;
        };
        let bounds = awake(self);
        for group in &mut self.groups {
            group.put_to_sleep(&bounds);
        }
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Who sleeps, by body and number. A bound that is no number does not bound, and what is clamped is held already.
    fn outside(&self, [low, high]: &[[f64; D]; 2]) -> Vec<(usize, u32)> {
        let positions = self.particles.columns.vectors(Field::POSITION);
        let mut all = Vec::new();
        for (k, body) in self.particles.bodies.iter().enumerate() {
            let clamps = self.held.clamps.iter();
            let clamps = clamps.filter(|own| own.body == k && !own.released);
            let mut clamped = vec![false; body.ids.len()];
            for (id, _) in clamps.flat_map(|own| &own.particles) {
                clamped[*id as usize] = true;
            }
            for (id, clamped) in clamped.into_iter().enumerate() {
                let slot = self.particles.slot_of[body.ids.start + id];
                if clamped || slot == u32::MAX {
                    continue;
                }
                let x = positions[slot as usize].map(Real::to_f64);
                if (0..D).any(|d| x[d] < low[d] || x[d] > high[d]) {
                    all.push((k, id as u32));
                }
            }
        }
        all
    }

    fn put_to_sleep(&mut self, bounds: &[[f64; D]; 2]) {
        let Some(mut own) = self.held.asleep.take() else {
            return;
        };
        let now = self.outside(bounds);
        if now != own.particles {
            let before = core::mem::replace(&mut own.particles, now);
            let forces = core::mem::take(&mut own.forces);
            self.wake(&mut own, &before, &forces);
            for k in 0..own.particles.len() {
                let particle = own.particles[k];
                let was = before.binary_search(&particle).ok();
                if was.is_none() {
                    self.stop(&mut own, particle);
                }
                for (coupled, before) in [false, true].into_iter().zip(&forces) {
                    let held = match was {
                        Some(n) => before.get(n).copied(),
                        None => self
                            .has_forces(coupled)
                            .then(|| self.hold_still(particle, coupled)),
                    };
                    own.forces[usize::from(coupled)].extend(held);
                }
            }
            self.keep_rows(&mut own);
        }
        self.held.asleep = Some(own);
    }

    /// Whether there are forces that can be replaced: none of couplings where a group does not sub-cycle, and none before
    /// the first evaluation.
    fn has_forces(&self, coupled: bool) -> bool {
        match &self.sub_cycle {
            Some(apart) if coupled => !apart.forces.is_empty(),
            _ => !coupled && self.work.rates.outputs().contains(Output::FORCE),
        }
    }

    /// Gives those of `before` that sleep no longer the forces back that they had.
    fn wake(&mut self, own: &mut Asleep<D>, before: &[(usize, u32)], forces: &[Vec<[f64; D]>; 2]) {
        for (n, particle) in before.iter().enumerate() {
            if own.particles.binary_search(particle).is_ok() {
                continue;
            }
            let slots = self.slots_of(particle.0, particle.1);
            own.woken += u64::from(!slots.is_empty());
            for (coupled, forces) in [false, true].into_iter().zip(forces) {
                let Some(given) = forces.get(n) else {
                    continue;
                };
                for slot in slots.clone() {
                    let held = self.force_on(slot, coupled);
                    let free = core::array::from_fn(|d| held[d] - T::from_f64(given[d]));
                    self.set_force(slot, coupled, free);
                }
            }
        }
    }

    /// Takes the velocity of a particle that falls asleep.
    fn stop(&mut self, own: &mut Asleep<D>, (body, id): (usize, u32)) {
        let slots = self.slots_of(body, id);
        let mass = self.particles.columns.raw(Field::MASS)[slots.start].to_f64();
        let v = self.particles.columns.vectors(Field::VELOCITY)[slots.start].map(Real::to_f64);
        own.fallen += 1;
        for (impulse, v) in own.impulse.iter_mut().zip(v) {
            *impulse -= mass * v;
            own.energy -= 0.5 * mass * v * v;
        }
        self.particles.columns.vectors_mut(Field::VELOCITY)[slots].fill([T::zero(); D]);
    }

    /// Replaces the force on a sleeper by what leaves it at rest, and says what that gives.
    fn hold_still(&mut self, (body, id): (usize, u32), coupled: bool) -> [f64; D] {
        let gravity = self.work.evaluated_gravity.map(Real::to_f64);
        let mut given = [0.0; D];
        for slot in self.slots_of(body, id).rev() {
            let mass = self.particles.columns.raw(Field::MASS)[slot].to_f64();
            let before = self.force_on(slot, coupled);
            let after = core::array::from_fn(|d| {
                let weight = if coupled { 0.0 } else { mass * gravity[d] };
                T::from_f64(-weight)
            });
            given = core::array::from_fn(|d| (after[d] - before[d]).to_f64());
            self.set_force(slot, coupled, after);
        }
        given
    }

    /// The same of all sleepers, after an evaluation.
    pub(super) fn hold_sleepers(&mut self, coupled: bool) {
        let Some(mut own) = self.held.asleep.take() else {
            return;
        };
        let forces = &mut own.forces[usize::from(coupled)];
        forces.clear();
        if self.has_forces(coupled) {
            let held = own.particles.iter();
            forces.extend(held.map(|particle| self.hold_still(*particle, coupled)));
        }
        self.held.asleep = Some(own);
    }

    /// Books what holds them in a kick over `dt` \[s\].
    pub(super) fn record_sleepers(&mut self, coupled: bool, dt: f64) {
        if let Some(own) = &mut self.held.asleep {
            for force in &own.forces[usize::from(coupled)] {
                for (impulse, force) in own.impulse.iter_mut().zip(force) {
                    *impulse += dt * force;
                }
            }
        }
    }

    /// The force \[N\] that holds all of them now.
    pub(super) fn force_on_sleepers(&self) -> [f64; D] {
        let own = self.held.asleep.iter().flat_map(|own| &own.forces);
        own.flatten().fold([0.0; D], |sum, force| {
            core::array::from_fn(|d| sum[d] + force[d])
        })
    }

    /// Notes the present state of sleepers as what is held.
    pub(super) fn keep_rows(&self, own: &mut Asleep<D>) {
        let energy = (self.scheme.energy != EnergyForm::None).then_some(Field::ENERGY);
        let all = self
            .state()
            .chain(energy)
            .chain(self.scheme.program.state());
        own.state.clear();
        for field in all {
            let (width, column) = (field.components(D), self.particles.columns.raw(field));
            if column.is_empty() || own.state.iter().any(|other| other.0 == field) {
                continue;
            }
            let mut rows = Vec::with_capacity(width * own.particles.len());
            for &(body, id) in &own.particles {
                let slot = self.slots_of(body, id).start;
                let row = column[slot * width..(slot + 1) * width].iter();
                rows.extend(row.map(|value| value.to_f64()));
            }
            own.state.push((field, rows));
        }
    }

    /// Takes back what has changed of the state of sleepers; books the energy of it if that was a kick or a drift, and
    /// no prediction.
    pub(super) fn keep_asleep(&mut self, books: bool) {
        let Some(mut own) = self.held.asleep.take() else {
            return;
        };
        for (n, &(body, id)) in own.particles.iter().enumerate() {
            let slots = self.slots_of(body, id);
            if slots.is_empty() {
                continue;
            }
            if books {
                let held = |field: Field| {
                    let rows = own.state.iter().find(|rows| rows.0 == field);
                    rows.map(|rows| rows.1[n])
                };
                own.energy -= self.gained(body, slots.start, held);
            }
            for (field, rows) in &own.state {
                let width = field.components(D);
                let row = &rows[n * width..(n + 1) * width];
                let column = self.particles.columns.raw_mut(*field);
                for slot in slots.clone() {
                    for (now, held) in column[slot * width..].iter_mut().zip(row) {
                        *now = T::from_f64(*held);
                    }
                }
            }
        }
        self.held.asleep = Some(own);
    }

    /// What the particle in a slot has gained over the state that is held \[J\]: internal energy, or that of compression in a
    /// scheme that carries none.
    fn gained(&self, body: usize, slot: usize, held: impl Fn(Field) -> Option<f64>) -> f64 {
        let columns = &self.particles.columns;
        let mass = columns.raw(Field::MASS)[slot].to_f64();
        let now = |field: Field| columns.raw(field).get(slot).map_or(0.0, |e| e.to_f64());
        if let Some(before) = held(Field::ENERGY) {
            return mass * (now(Field::ENERGY) - before);
        }
        match held(Field::DENSITY) {
            Some(before) if before != now(Field::DENSITY) => {
                let law = self.particles.bodies[body].material.eos();
                let of = |density| law.compression_energy(density);
                mass * (of(now(Field::DENSITY)) - of(before))
            }
            _ => 0.0,
        }
    }
}
