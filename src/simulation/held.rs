//! What does not follow forces particle by particle: clamped particles, and bodies that move as rigid ones.
//! Forces are replaced after they are summed, so kicks, work and ledgers need not know.

use super::Simulation;
use super::forces::Forces;
use super::population::{BodyState, Particles};
use super::spin::raised;
use super::workspace::Workspace;
use crate::boundary::{Boundary, Motion};
use crate::collective::{Collective, over};
use crate::particles::Field;
use crate::scalar::Real;
use nalgebra::{Matrix3, SymmetricEigen, UnitQuaternion, Vector3};
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

/// A body that moves as a rigid one.
#[derive(Clone, Debug)]
pub(crate) struct Rigid<const D: usize> {
    /// The body in its group.
    pub body: usize,
    /// Mass \[kg\].
    pub mass: f64,
    /// Where its particles are from the centre of mass \[m\], along principal axes, by number.
    pub places: Vec<Vector3<f64>>,
    /// Principal moments of inertia \[kg m²\].
    pub inertia: Vector3<f64>,
    /// The centre of mass \[m\].
    pub centre: [f64; D],
    /// From principal axes to space, now and as built.
    pub turn: UnitQuaternion<f64>,
    pub built: UnitQuaternion<f64>,
    /// What periods have brought its particles back by \[m\], by number; the centre goes on.
    pub back: Vec<[f64; D]>,
}

/// How a clamp stands.
#[derive(Clone, Debug, PartialEq)]
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

pub(super) fn lowered<const D: usize>(vector: &Vector3<f64>) -> [f64; D] {
    core::array::from_fn(|d| vector[d])
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

impl<const D: usize> Rigid<D> {
    /// Of points \[m\] of equal volume with their masses \[kg\].
    pub fn new(body: usize, points: &[[f64; D]], masses: &[f64]) -> Self {
        let all = 0..masses.len();
        let (mass, moment) = over(all.clone(), |id| {
            (masses[id], points[id].map(|x| masses[id] * x))
        });
        let centre = moment.map(|moment| moment / mass);
        let about: Vec<_> = points.iter().map(|x| raised(x) - raised(&centre)).collect();
        let inertia = Matrix3::from(over(all, |id| -> [[f64; 3]; 3] {
            let r = &about[id];
            let about = Matrix3::identity() * r.norm_squared() - r * r.transpose();
            (masses[id] * about).into()
        }));
        // In a plane the third axis is principal, and any two in the plane serve.
        let (moments, turn) = if D == 3 {
            let axes = SymmetricEigen::new(inertia);
            let mut turn = axes.eigenvectors;
            if turn.determinant() < 0.0 {
                turn.column_mut(2).neg_mut();
            }
            let turn = nalgebra::Rotation3::from_matrix_unchecked(turn);
            (
                axes.eigenvalues,
                UnitQuaternion::from_rotation_matrix(&turn),
            )
        } else {
            (inertia.diagonal(), UnitQuaternion::identity())
        };
        let back = turn.inverse();
        Self {
            body,
            mass,
            places: about.iter().map(|r| back * r).collect(),
            inertia: moments,
            centre,
            turn,
            built: turn,
            back: vec![[0.0; D]; points.len()],
        }
    }

    /// Takes note of what periods are about to bring back at `time` \[s\].
    fn note_periods<T: Real>(
        &mut self,
        particles: &Particles<T, D>,
        boundaries: &[Arc<dyn Boundary<D>>],
        time: f64,
    ) {
        for (id, back) in self.back.iter_mut().enumerate() {
            let slots = particles.slots_of(self.body, id as u32);
            if slots.is_empty() {
                continue;
            }
            let mut x = particles.columns.vectors(Field::POSITION)[slots.start].map(Real::to_f64);
            for boundary in boundaries {
                if let Some(through) = boundary.wrap(&x, time) {
                    x = through.point(&x);
                    for d in 0..D {
                        back[d] += through.shift[d];
                    }
                }
            }
        }
    }

    /// What a moment along principal axes does to the rotation: I⁻¹ of it, and nothing about what has no inertia.
    fn answer(&self, moment: &Vector3<f64>) -> Vector3<f64> {
        let least = 1e-12 * self.inertia.max();
        Vector3::from_fn(|d, _| {
            let turns = D == 3 || (D == 2 && d == 2);
            if turns && self.inertia[d] > least {
                moment[d] / self.inertia[d]
            } else {
                0.0
            }
        })
    }

    /// The same of a moment in space.
    pub fn answer_in_space(&self, moment: &Vector3<f64>) -> Vector3<f64> {
        self.answer_at(&self.turn, moment)
    }

    /// The same where it is turned otherwise.
    pub fn answer_at(&self, turn: &UnitQuaternion<f64>, moment: &Vector3<f64>) -> Vector3<f64> {
        turn * self.answer(&(turn.inverse() * moment))
    }

    /// How it is turned after `dt` \[s\] of free rotation with an angular momentum \[kg m²/s\] that stays: by rotations about the
    /// principal axes, one after the other and back (Dullweber, Leimkuhler & McLachlan 1997, J. Chem. Phys. 107, 5840).
    pub fn rotated(
        &self,
        mut turn: UnitQuaternion<f64>,
        momentum: &Vector3<f64>,
        dt: f64,
    ) -> UnitQuaternion<f64> {
        let axes = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
        for (axis, share) in [(0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)] {
            let own = turn.inverse() * momentum;
            let angle = share * dt * self.answer(&own)[axis];
            if angle != 0.0 {
                turn *= UnitQuaternion::from_axis_angle(&axes[axis], angle);
            }
        }
        turn.renormalize();
        turn
    }

    /// The sum over its particles that are there of a vector in a slot, and of its moment about the centre.
    pub fn sums<T: Real>(
        &self,
        particles: &Particles<T, D>,
        of: impl Fn(usize) -> Vector3<f64> + Sync,
    ) -> [Vector3<f64>; 2] {
        let sums = over(0..self.places.len(), |id| {
            let Some(slot) = particles.slots_of(self.body, id as u32).next() else {
                return [[0.0; 3]; 2];
            };
            let own = of(slot);
            [own.into(), (self.turn * self.places[id]).cross(&own).into()]
        });
        sums.map(Vector3::from)
    }

    /// Gives its particles the forces that accelerate it as one, with the same sum and the same moment.
    fn share_forces<T: Real>(&self, particles: &Particles<T, D>, forces: &mut Forces<'_, T, D>) {
        let force = |slot: usize| raised(&forces.on(slot).map(Real::to_f64));
        let [sum, moment] = self.sums(particles, force);
        let (a, turning) = (sum / self.mass, self.answer_in_space(&moment));
        for (id, place) in self.places.iter().enumerate() {
            let all = a + turning.cross(&(self.turn * place));
            for slot in particles.slots_of(self.body, id as u32) {
                let mass = particles.columns.raw(Field::MASS)[slot].to_f64();
                forces.set(slot, lowered(&(mass * all)).map(T::from_f64));
            }
        }
    }

    /// Adds a force \[N\] and a moment \[N m\] about the centre, shared out as what accelerates it as one.
    pub fn push<T: Real>(
        &self,
        particles: &Particles<T, D>,
        forces: &mut Forces<'_, T, D>,
        [force, moment]: [Vector3<f64>; 2],
    ) {
        let (a, turning) = (force / self.mass, self.answer_in_space(&moment));
        for (id, place) in self.places.iter().enumerate() {
            let all = a + turning.cross(&(self.turn * place));
            for slot in particles.slots_of(self.body, id as u32) {
                let mass = particles.columns.raw(Field::MASS)[slot].to_f64();
                forces.add(slot, lowered(&(mass * all)).map(T::from_f64));
            }
        }
    }

    /// Its momentum \[kg m/s\], and its angular momentum \[kg m²/s\] about its centre.
    pub fn momenta<T: Real>(&self, particles: &Particles<T, D>) -> [Vector3<f64>; 2] {
        let columns = &particles.columns;
        let (mass, v) = (columns.raw(Field::MASS), columns.vectors(Field::VELOCITY));
        self.sums(particles, |slot| {
            mass[slot].to_f64() * raised(&v[slot].map(Real::to_f64))
        })
    }

    /// Brings its particles to where it is, with the velocities that it has.
    pub fn place<T: Real>(
        &self,
        particles: &mut Particles<T, D>,
        [momentum, spin]: [Vector3<f64>; 2],
    ) {
        let (v, turning) = (momentum / self.mass, self.answer_in_space(&spin));
        for (id, place) in self.places.iter().enumerate() {
            let place = self.turn * place;
            let (at, speed) = (raised(&self.centre) + place, v + turning.cross(&place));
            for slot in particles.slots_of(self.body, id as u32) {
                let [x, residual, velocity] = particles.columns.many_mut([
                    Field::POSITION,
                    Field::POSITION_RESIDUAL,
                    Field::VELOCITY,
                ]);
                for d in 0..D {
                    let k = slot * D + d;
                    let at = at[d] + self.back[id][d];
                    x[k] = T::from_f64(at);
                    if let Some(residual) = residual.get_mut(k) {
                        *residual = T::from_f64(at - x[k].to_f64());
                    }
                    velocity[k] = T::from_f64(speed[d]);
                }
            }
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
            group.hold(time, group.sub_cycle.is_some());
        }
    }

    /// Books what clamps give in a kick over `dt` \[s\]: of a group that sub-cycles alone, or of all others and of
    /// couplings on those that do.
    pub(super) fn record_clamps(&mut self, alone: Option<usize>, dt: f64) {
        for (k, group) in self.state.groups.iter_mut().enumerate() {
            if alone.is_none_or(|alone| alone == k) {
                let coupled = alone.is_none() && group.sub_cycle.is_some();
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
