//! Particles that sleep: those outside of the box in which a simulation is awake. Their places and states are held, and they go
//! on serving as neighbours. Forces on them are replaced as those of a clamp are, and what kicks and drifts change is taken back.

use super::Simulation;
use super::evolve::state;
use super::forces::Forces;
use super::held::Held;
use super::population::Particles;
use crate::error::{Error, Result};
use crate::origin::local;
use crate::particles::Field;
use crate::scalar::Real;
use crate::scheme::{EnergyForm, Scheme};
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
        let groups = self.state.groups.iter();
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
        let groups = self.state.groups.iter();
        let own = groups.filter_map(|group| group.held.asleep.as_ref());
        own.map(|own| own.energy).sum()
    }

    /// The same, awake in a box alone.
    pub(crate) fn awake_inside(mut self, awake: Option<Awake<T, D>>) -> Self {
        if awake.is_some() {
            for group in &mut self.state.groups {
                group.held.asleep = Some(Asleep::default());
            }
        }
        self.awake = awake;
        self
    }

    /// Puts to sleep what is outside of the box now, and wakes what is inside: between steps.
    pub(crate) fn put_to_sleep(&mut self) -> Result<()> {
        let Some(awake) = self.awake.clone() else {
            return Ok(());
        };
        let bounds = awake(self);
        let extents = (0..D).map(|d| bounds[1][d] - bounds[0][d]);
        // From one infinity to the same one nothing lies, which is no number either.
        if let Some(value) = extents.into_iter().find(|own| own.is_nan() || *own < 0.0) {
            return Err(Error::Function {
                what: "box in which the scene is awake (Scene::awake_inside), along an axis,"
                    .into(),
                value,
                time: self.state.time,
                must_be: "it must not be negative: the low corner comes first, in metres",
            });
        }
        for group in &mut self.state.groups {
            let (held, particles) = (&mut group.held, &mut group.particles);
            let bounds = bounds.map(|corner| local(&corner, &particles.origin));
            let now = held.outside(particles, &bounds);
            let asleep = held.asleep.as_mut();
            if let Some(own) = asleep.filter(|own| own.particles != now) {
                let forces = Forces::all(&mut group.work, &mut group.sub_cycle);
                own.change(now, particles, forces);
                own.keep_rows(particles, &group.scheme);
            }
        }
        Ok(())
    }
}

impl<const D: usize> Held<D> {
    /// Who is outside of a box, by body and number. A bound that is no number does not bound, and what is clamped is held
    /// already.
    fn outside<T: Real>(
        &self,
        particles: &Particles<T, D>,
        [low, high]: &[[f64; D]; 2],
    ) -> Vec<(usize, u32)> {
        let positions = particles.columns.vectors(Field::POSITION);
        let mut all = Vec::new();
        for (k, body) in particles.bodies.iter().enumerate() {
            let clamps = self.clamps.iter();
            let clamps = clamps.filter(|own| own.body == k && !own.released);
            let mut clamped = vec![false; body.ids.len()];
            for (id, _) in clamps.flat_map(|own| &own.particles) {
                clamped[*id as usize] = true;
            }
            for (id, clamped) in clamped.into_iter().enumerate() {
                let slot = particles.slot_of[body.ids.start + id];
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

    /// The force \[N\] that holds all sleepers now.
    pub(super) fn force_on_sleepers(&self) -> [f64; D] {
        let own = self.asleep.iter().flat_map(|own| &own.forces);
        own.flatten().fold([0.0; D], |sum, force| {
            core::array::from_fn(|d| sum[d] + force[d])
        })
    }

    /// Takes back what has changed of the state of sleepers; books the energy of it if that was a kick or a drift, and
    /// no prediction.
    pub(super) fn keep_asleep<T: Real>(&mut self, particles: &mut Particles<T, D>, books: bool) {
        if let Some(own) = &mut self.asleep {
            own.keep(particles, books);
        }
    }
}

impl<const D: usize> Asleep<D> {
    /// Lets these sleep from now on and wakes all others, with all forces on them.
    fn change<T: Real>(
        &mut self,
        now: Vec<(usize, u32)>,
        particles: &mut Particles<T, D>,
        all: [Option<Forces<'_, T, D>>; 2],
    ) {
        let before = core::mem::replace(&mut self.particles, now);
        fn sleeps(all: &[(usize, u32)], own: &(usize, u32)) -> Option<usize> {
            all.binary_search(own).ok()
        }
        for own in &before {
            let there = !particles.slots_of(own.0, own.1).is_empty();
            self.woken += u64::from(there && sleeps(&self.particles, own).is_none());
        }
        for k in 0..self.particles.len() {
            if sleeps(&before, &self.particles[k]).is_none() {
                self.stop(particles, self.particles[k]);
            }
        }
        for (held, forces) in self.forces.iter_mut().zip(all) {
            let given = core::mem::take(held);
            let Some(mut forces) = forces else {
                continue;
            };
            // Those that sleep no longer have the forces back that they had.
            for (own, given) in before.iter().zip(&given) {
                if sleeps(&self.particles, own).is_none() {
                    for slot in particles.slots_of(own.0, own.1) {
                        let held = forces.on(slot);
                        let free = core::array::from_fn(|d| held[d] - T::from_f64(given[d]));
                        forces.set(slot, free);
                    }
                }
            }
            for own in &self.particles {
                held.extend(match sleeps(&before, own) {
                    Some(n) => given.get(n).copied(),
                    None => Some(hold_still(particles, &mut forces, *own)),
                });
            }
        }
    }

    /// Takes the velocity of a particle that falls asleep.
    fn stop<T: Real>(&mut self, particles: &mut Particles<T, D>, (body, id): (usize, u32)) {
        let slots = particles.slots_of(body, id);
        let mass = particles.columns.raw(Field::MASS)[slots.start].to_f64();
        let velocities = particles.columns.vectors_mut(Field::VELOCITY);
        let v = velocities[slots.start].map(Real::to_f64);
        self.fallen += 1;
        for (impulse, v) in self.impulse.iter_mut().zip(v) {
            *impulse -= mass * v;
            self.energy -= 0.5 * mass * v * v;
        }
        velocities[slots].fill([T::zero(); D]);
    }

    /// Replaces the forces on all of them by what leaves them at rest, after an evaluation.
    pub(super) fn hold<T: Real>(
        &mut self,
        particles: &Particles<T, D>,
        forces: &mut Forces<'_, T, D>,
    ) {
        let held = &mut self.forces[usize::from(forces.are_apart())];
        held.clear();
        if forces.are_there() {
            let own = self.particles.iter();
            held.extend(own.map(|own| hold_still(particles, forces, *own)));
        }
    }

    /// Books what holds them in a kick over `dt` \[s\].
    pub(super) fn record(&mut self, coupled: bool, dt: f64) {
        for force in &self.forces[usize::from(coupled)] {
            for (impulse, force) in self.impulse.iter_mut().zip(force) {
                *impulse += dt * force;
            }
        }
    }

    /// Notes their present state as what is held.
    pub(super) fn keep_rows<T: Real>(
        &mut self,
        particles: &Particles<T, D>,
        scheme: &Scheme<T, D>,
    ) {
        let energy = (scheme.energy != EnergyForm::None).then_some(Field::ENERGY);
        let all = state(&scheme.program)
            .chain(energy)
            .chain(scheme.program.state());
        self.state.clear();
        for field in all {
            let (width, column) = (field.components(D), particles.columns.raw(field));
            if column.is_empty() || self.state.iter().any(|other| other.0 == field) {
                continue;
            }
            let mut rows = Vec::with_capacity(width * self.particles.len());
            for &(body, id) in &self.particles {
                let slot = particles.slots_of(body, id).start;
                let row = column[slot * width..(slot + 1) * width].iter();
                rows.extend(row.map(|value| value.to_f64()));
            }
            self.state.push((field, rows));
        }
    }

    /// Takes back what has changed of their state, and books the energy of it if asked for.
    fn keep<T: Real>(&mut self, particles: &mut Particles<T, D>, books: bool) {
        for (n, &(body, id)) in self.particles.iter().enumerate() {
            let slots = particles.slots_of(body, id);
            if slots.is_empty() {
                continue;
            }
            if books {
                let held = |field: Field| {
                    let rows = self.state.iter().find(|rows| rows.0 == field);
                    rows.map(|rows| rows.1[n])
                };
                self.energy -= gained(particles, body, slots.start, held);
            }
            for (field, rows) in &self.state {
                let width = field.components(D);
                let row = &rows[n * width..(n + 1) * width];
                let column = particles.columns.raw_mut(*field);
                for slot in slots.clone() {
                    for (now, held) in column[slot * width..].iter_mut().zip(row) {
                        *now = T::from_f64(*held);
                    }
                }
            }
        }
    }
}

/// Replaces the force on a sleeper by what leaves it at rest, and says what that gives.
fn hold_still<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    forces: &mut Forces<'_, T, D>,
    own: (usize, u32),
) -> [f64; D] {
    let gravity = forces.gravity();
    forces.replace(particles, own, |mass| gravity.map(|g| -(mass * g)))
}

/// What the particle in a slot has gained over the state that is held \[J\]: internal energy, or that of compression in a
/// scheme that carries none.
fn gained<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    body: usize,
    slot: usize,
    held: impl Fn(Field) -> Option<f64>,
) -> f64 {
    let columns = &particles.columns;
    let mass = columns.raw(Field::MASS)[slot].to_f64();
    let now = |field: Field| columns.raw(field).get(slot).map_or(0.0, |e| e.to_f64());
    if let Some(before) = held(Field::ENERGY) {
        return mass * (now(Field::ENERGY) - before);
    }
    match held(Field::DENSITY) {
        Some(before) if before != now(Field::DENSITY) => {
            let law = particles.bodies[body].material.eos();
            let of = |density| law.compression_energy(density);
            mass * (of(now(Field::DENSITY)) - of(before))
        }
        _ => 0.0,
    }
}
