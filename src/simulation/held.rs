//! What does not follow forces particle by particle: clamped particles, and bodies that move as rigid ones.
//! Forces are replaced after they are summed, so kicks, work and ledgers need not know.

use super::Simulation;
use super::forces::Forces;
use super::population::{BodyState, Particles};
use super::rigid::Rigid;
use super::spin::raised;
use super::workspace::Workspace;
use crate::boundary::{Boundary, Motion};
use crate::collective::{Collective, over};
use crate::particles::Field;
use crate::scalar::Real;
use nalgebra::Vector3;
use std::sync::Arc;

/// Clamped particles and rigid bodies of a group.
#[derive(Clone, Debug, Default)]
pub(crate) struct Held<const D: usize> {
    pub clamps: Vec<Clamp<D>>,
    pub rigid: Vec<Rigid<D>>,
}

impl<const D: usize> Held<D> {
    /// Whether nothing is held.
    pub fn is_empty(&self) -> bool {
        self.clamps.is_empty() && self.rigid.is_empty()
    }
}

/// Particles of a body whose motion is prescribed.
#[derive(Clone, Debug)]
pub(crate) struct Clamp<const D: usize> {
    /// The body in its group.
    pub body: usize,
    /// The numbers of its particles there, and where they are as built \[m\].
    pub particles: Vec<(u32, [f64; D])>,
    /// How they move; not at all if not given.
    pub motion: Option<Arc<dyn Motion<D>>>,
    /// The numbers of the events that begin and end it, and whether it holds nothing by them.
    pub since: Option<usize>,
    pub until: Option<usize>,
    pub is_free: bool,
    /// What holds each of them \[N\] against forces of its group, and against those of couplings where it sub-cycles.
    pub forces: [Vec<[f64; D]>; 2],
    /// Momentum \[kg m/s\] and work \[J\] that these have given since the start.
    pub impulse: [f64; D],
    pub work: f64,
}

/// How a clamp stands.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Clamped {
    /// The body.
    pub body: String,
    /// How many of its particles it holds.
    pub particles: usize,
    /// The force \[N\] that it exerts on them at the last evaluation.
    pub force: Vec<f64>,
    /// The momentum \[kg m/s\] that it has given since the start.
    pub impulse: Vec<f64>,
    /// The work \[J\] that it has done since the start.
    pub work: f64,
}

impl<const D: usize> Clamp<D> {
    pub fn new(
        body: usize,
        particles: Vec<(u32, [f64; D])>,
        motion: Option<Arc<dyn Motion<D>>>,
    ) -> Self {
        Self {
            body,
            particles,
            motion,
            since: None,
            until: None,
            is_free: false,
            forces: [Vec::new(), Vec::new()],
            impulse: [0.0; D],
            work: 0.0,
        }
    }
}

impl<const D: usize> Held<D> {
    /// Replaces forces on what is held.
    pub fn hold<T: Real>(
        &mut self,
        particles: &Particles<T, D>,
        forces: &mut Forces<'_, T, D>,
        time: f64,
    ) {
        let (coupled, gravity) = (forces.are_apart(), forces.gravity());
        for own in &mut self.clamps {
            let motion = own.motion.as_ref().filter(|_| !coupled);
            let pose = motion.map(|motion| motion.pose(time));
            let given = &mut own.forces[usize::from(coupled)];
            given.clear();
            if own.is_free {
                continue;
            }
            for (id, rest) in &own.particles {
                let a = pose.as_ref().map_or([0.0; D], |pose| pose.of(2, rest));
                given.push(forces.replace(particles, (own.body, *id), |mass| {
                    core::array::from_fn(|d| mass * (a[d] - gravity[d]))
                }));
            }
        }
        for own in &self.rigid {
            own.share_forces(particles, forces);
        }
    }

    /// Books what clamps give in a kick over `dt` \[s\].
    fn record<T: Real>(
        &mut self,
        particles: &Particles<T, D>,
        work: &Workspace<T, D>,
        coupled: bool,
        dt: f64,
    ) {
        // Couplings alone do not accelerate what is clamped.
        let half = if coupled { 0.0 } else { 0.5 * dt };
        for own in &mut self.clamps {
            let forces = &own.forces[usize::from(coupled)];
            let (force, power) = over(0..forces.len(), |k| {
                let mut slots = particles.slots_of(own.body, own.particles[k].0);
                let power = |slot| work.power(&particles.columns, &forces[k], slot, half);
                slots
                    .next()
                    .map_or(([0.0; D], 0.0), |slot| (forces[k], power(slot)))
            });
            for d in 0..D {
                own.impulse[d] += dt * force[d];
            }
            own.work += dt * power;
        }
    }

    /// Gives what one of its clamps takes hold of at `time` \[s\] the velocity that it has there, and books what that gives.
    pub fn take_hold<T: Real>(&mut self, clamp: usize, particles: &mut Particles<T, D>, time: f64) {
        let own = &mut self.clamps[clamp];
        let pose = own.motion.as_ref().map(|motion| motion.pose(time));
        let after = |rest: &[f64; D]| pose.as_ref().map_or([0.0; D], |pose| pose.of(1, rest));
        let (momentum, energy) = over(0..own.particles.len(), |k| {
            let (id, rest) = &own.particles[k];
            let Some(slot) = particles.slots_of(own.body, *id).next() else {
                return ([0.0; D], 0.0);
            };
            let before = particles.columns.vectors(Field::VELOCITY)[slot].map(Real::to_f64);
            let mass = particles.columns.raw(Field::MASS)[slot].to_f64();
            let after = after(rest);
            let squared = |v: &[f64; D]| v.iter().map(|v| v * v).sum::<f64>();
            (
                core::array::from_fn(|d| mass * (after[d] - before[d])),
                0.5 * mass * (squared(&after) - squared(&before)),
            )
        });
        for (sum, given) in own.impulse.iter_mut().zip(momentum) {
            *sum += given;
        }
        own.work += energy;
        for (id, rest) in &own.particles {
            let slots = particles.slots_of(own.body, *id);
            let v = after(rest).map(T::from_f64);
            particles.columns.vectors_mut(Field::VELOCITY)[slots].fill(v);
        }
    }

    /// Lets rigid bodies know what periods are about to bring back of them at `time` \[s\].
    pub fn note_periods<T: Real>(
        &mut self,
        particles: &Particles<T, D>,
        boundaries: &[Arc<dyn Boundary<D>>],
        time: f64,
    ) {
        if boundaries.is_empty() {
            return;
        }
        for own in &mut self.rigid {
            own.note_periods(particles, boundaries, time);
        }
    }

    /// The clamp that moves a body now, if one does.
    pub fn driver(&self, body: usize) -> Option<usize> {
        let mut clamps = self.clamps.iter();
        clamps.position(|own| own.body == body && !own.is_free)
    }

    /// The momenta that the clamp of a rigid body, if one moves it, prescribes where the body is, at `time` \[s\].
    pub fn driven_momenta<T: Real>(
        &self,
        rigid: usize,
        particles: &Particles<T, D>,
        time: f64,
    ) -> Option<[Vector3<f64>; 2]> {
        let rigid = &self.rigid[rigid];
        let clamp = &self.clamps[self.driver(rigid.body)?];
        let pose = clamp.motion.as_ref().map(|motion| motion.pose(time));
        let masses = particles.columns.raw(Field::MASS);
        let sums: [[f64; 3]; 2] = over(0..clamp.particles.len(), |k| {
            let (id, rest) = &clamp.particles[k];
            let v = pose.as_ref().map_or([0.0; D], |pose| pose.of(1, rest));
            let mut slots = particles.slots_of(rigid.body, *id);
            let mass = slots.next().map_or(0.0, |slot| masses[slot].to_f64());
            let momentum = mass * raised(&v);
            let place = rigid.turn * rigid.places[*id as usize];
            [momentum.into(), place.cross(&momentum).into()]
        });
        Some(sums.map(Vector3::from))
    }

    /// Lets the clamp that moves a rigid body take an impulse and its moment on it, at its velocity and spin.
    pub fn take(&mut self, rigid: usize, [n, a]: [Vector3<f64>; 2], [v, w]: [Vector3<f64>; 2]) {
        if let Some(clamp) = self.driver(self.rigid[rigid].body) {
            let clamp = &mut self.clamps[clamp];
            (0..D).for_each(|d| clamp.impulse[d] -= n[d]);
            clamp.work -= n.dot(&v) + a.dot(&w);
        }
    }

    /// Whether a body of the group leaves as a whole, or not at all.
    pub fn is_rigid(&self, body: usize) -> bool {
        self.rigid.iter().any(|own| own.body == body)
    }

    /// Moves rigid bodies over `dt` \[s\] as such.
    pub fn move_rigid<T: Real>(&mut self, particles: &mut Particles<T, D>, dt: f64) {
        for own in &mut self.rigid {
            let [momentum, spin] = own.momenta(particles);
            for d in 0..D {
                own.centre[d] += dt * momentum[d] / own.mass;
            }
            own.turn = own.rotated(own.turn, &spin, dt);
            own.place(particles, [momentum, spin]);
        }
    }

    /// Gives what is held velocities that it can have.
    fn hold_velocities<T: Real>(&self, particles: &mut Particles<T, D>, time: f64) {
        for own in self.clamps.iter().filter(|own| !own.is_free) {
            let pose = own.motion.as_ref().map(|motion| motion.pose(time));
            for (id, rest) in &own.particles {
                let v = pose.as_ref().map_or([0.0; D], |pose| pose.of(1, rest));
                let slots = particles.slots_of(own.body, *id);
                particles.columns.vectors_mut(Field::VELOCITY)[slots].fill(v.map(T::from_f64));
            }
        }
        for own in &self.rigid {
            let momenta = own.momenta(particles);
            own.place(particles, momenta);
        }
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// How all clamps stand, group by group in the order of the scene.
    #[must_use]
    pub fn clamps(&self) -> Vec<Clamped> {
        let groups = self.state.groups.iter();
        let clamps = groups.flat_map(|group| {
            let bodies = &group.particles.bodies;
            group.held.clamps.iter().map(move |own| (bodies, own))
        });
        let of = |(bodies, own): (&Vec<BodyState<T>>, &Clamp<D>)| {
            let mut force = Collective::new();
            own.forces.iter().flatten().for_each(|own| force.add(*own));
            Clamped {
                body: bodies[own.body].name.clone(),
                particles: own.particles.len(),
                force: force.value().to_vec(),
                impulse: own.impulse.to_vec(),
                work: own.work,
            }
        };
        clamps.map(of).collect()
    }

    /// Replaces forces on what is held at `time` \[s\], after all of them are summed; of groups that sub-cycle those of
    /// couplings alone.
    pub(super) fn hold(&mut self, time: f64) {
        for group in &mut self.state.groups {
            group.hold(time, group.sub_cycles());
        }
    }

    /// Books what clamps give in a kick over `dt` \[s\]: of a group that sub-cycles alone, or of all others and of
    /// couplings on those that do.
    pub(super) fn record_clamps(&mut self, alone: Option<usize>, dt: f64) {
        for (k, group) in self.state.groups.iter_mut().enumerate() {
            if alone.is_none_or(|alone| alone == k) {
                let coupled = alone.is_none() && group.sub_cycles();
                (group.held).record(&group.particles, &group.work, coupled, dt);
            }
        }
    }

    /// Gives clamped particles and rigid bodies velocities that they can have.
    pub(crate) fn hold_velocities(&mut self) {
        let time = self.state.time;
        for group in &mut self.state.groups {
            group.held.hold_velocities(&mut group.particles, time);
        }
        self.state.hold_motions(time, false);
    }
}
