//! Walls of particles: their places, by their motions or by the bodies that they are.
//! How they answer a liquid is the wall law's of its scheme.

use super::population::Particles;
use super::spin::Spins;
use super::workspace::Workspace;
use crate::boundary::{Boundary, Inflow, Motion, Pose, Slip, WallSurface, motion_from};
use crate::coupling::{CoupledParticle, Coupling};
use crate::particles::Field;
use crate::scalar::Real;
use crate::sweep::add_compensated;
use crate::tensor::determinant;
use std::ops::Range;
use std::sync::Arc;

/// A wall in a simulation: particles that a motion places.
#[derive(Clone, Debug)]
pub(crate) struct WallState<T, const D: usize> {
    pub name: String,
    /// Slots of its particles; the rest of the last cluster repeats the last of them.
    pub slots: Range<usize>,
    pub end: usize,
    /// Where its particles were in the scene, by identity.
    pub rest: Arc<[[f64; D]]>,
    /// Unit vectors from the liquid into it, by identity; none if the scheme does not ask for them.
    pub normals: Arc<[[f64; D]]>,
    pub motion: Option<Arc<dyn Motion<D>>>,
    /// What moves it if it is the buffer of an inlet whose velocity differs by place or time.
    pub inflow: Option<Inflow<D>>,
    pub slip: Slip,
    /// Velocity of its surface in addition to its motion \[m/s\].
    pub sliding: [f64; D],
    pub container_frame: bool,
    /// Mass of a particle as built, in the liquid's density \[kg\].
    pub mass: f64,
    /// Its number among the walls of the scene; of no meaning for a structure.
    pub index: usize,
    /// The body of another group that its particles are, if it is not a wall of the scene.
    pub structure: Option<Structure<T, D>>,
}

/// The body of another group whose particles a wall is made of.
#[derive(Clone, Debug)]
pub(crate) struct Structure<T, const D: usize> {
    pub coupling: Arc<dyn Coupling<T, D>>,
    /// The group of the body, and its index there.
    pub group: usize,
    pub body: usize,
    /// What its particles have been accelerated by at the last evaluation \[m/s²\], in the order of the
    /// scene: the pressure of a wall follows from it. The mean since the evaluation before where the body sub-cycles.
    pub accelerations: Vec<[f64; D]>,
    /// How it turns at each of its particles at that evaluation, where liquid sticks to it.
    pub spins: Spins<D>,
    /// Velocities \[m/s\] at that evaluation where the body sub-cycles; else none.
    pub before: Vec<[f64; D]>,
    /// The time \[s\] of that evaluation; no number before the first.
    pub evaluated: f64,
    /// Whether it moves as a rigid body.
    pub rigid: bool,
}

impl<T: Real, const D: usize> WallState<T, D> {
    /// Where it is at `time` \[s\], if it moves; `chord` \[s\] are the ends of the drift under way, along which it goes
    /// straight.
    pub fn pose(&self, time: f64, chord: Option<[f64; 2]>) -> Option<Pose<D>> {
        let motion = self.motion.as_ref()?;
        let pose = motion.pose(time);
        Some(match chord {
            Some(ends) => pose.on_chord(ends.map(|end| motion.pose(end)), ends),
            None => pose,
        })
    }

    /// Lets it move otherwise, in places that are counted from an origin \[m\].
    pub fn set_motion(&mut self, motion: impl Motion<D> + 'static, origin: &[f64; D]) {
        let motion: Arc<dyn Motion<D>> = Arc::new(motion);
        self.motion = Some(motion_from(&motion, origin));
    }

    /// What a wall law sees of it at `time` \[s\], by the identities of the particles in all slots; `flows` if it is the buffer of an
    /// inlet.
    pub fn surface<'a>(&'a self, ids: &'a [u32], time: f64, flows: bool) -> WallSurface<'a, T, D> {
        let accelerations = match (&self.structure, &self.inflow) {
            (Some(structure), _) => Some(structure.accelerations.as_slice()),
            (None, Some(inflow)) => Some(inflow.accelerations()),
            (None, None) => None,
        };
        let pose = self.motion.as_ref().map(|motion| motion.pose(time));
        let gradients = self.structure.as_ref();
        WallSurface::new(
            (ids, self.slots.start),
            (&*self.rest, &*self.normals),
            (pose, self.slip),
            accelerations,
            gradients.map_or(&[], |structure| &structure.spins.gradients),
        )
        .that_flows(flows)
    }

    /// Gives its particles, which rest, the velocity of its surface.
    pub fn stand(&self, particles: &mut Particles<T, D>) {
        let own = self.slots.start..self.end;
        let v = self.sliding.map(T::from_f64);
        particles.columns.vectors_mut(Field::VELOCITY)[own].fill(v);
    }

    /// Brings its particles to where it is, with its velocity.
    pub fn place(
        &self,
        pose: &Pose<D>,
        particles: &mut Particles<T, D>,
        boundaries: &[Arc<dyn Boundary<D>>],
        time: f64,
    ) {
        // A wall that is crushed has its particles closer, and each stands for less volume.
        let mass = self.mass * determinant(&pose.linear[0]).abs();
        let at = |_: usize, rest: &[f64; D]| [pose.of(0, rest), pose.of(1, rest)];
        self.place_by(at, mass, particles, boundaries, time);
    }

    /// Moves the buffer of an inlet to where it is at `time` \[s\]; `chord` \[s\] are the ends of the drift under way.
    pub fn flow(
        &mut self,
        particles: &mut Particles<T, D>,
        boundaries: &[Arc<dyn Boundary<D>>],
        time: f64,
        chord: Option<[f64; 2]>,
    ) {
        if let Some(inflow) = &mut self.inflow {
            inflow.move_to(time, chord);
        }
        if let Some(inflow) = &self.inflow {
            let at = |number: usize, rest: &[f64; D]| inflow.place(number, rest);
            self.place_by(at, self.mass, particles, boundaries, time);
        }
    }

    /// Brings its particles, of a mass \[kg\], to places \[m\] with velocities \[m/s\], by their numbers and where they were built.
    fn place_by(
        &self,
        at: impl Fn(usize, &[f64; D]) -> [[f64; D]; 2],
        mass: f64,
        particles: &mut Particles<T, D>,
        boundaries: &[Arc<dyn Boundary<D>>],
        time: f64,
    ) {
        let run = self.slots.start..self.end;
        let mass = T::from_f64(mass);
        let columns = &mut particles.columns;
        if let Some(masses) = columns.raw_mut(Field::MASS).get_mut(run.clone()) {
            masses.fill(mass);
        }
        for slot in run {
            let number = self.rest_of(&particles.ids, slot);
            let [x, residual, v] = self.entered(at(number, &self.rest[number]), boundaries, time);
            columns.vectors_mut(Field::POSITION)[slot] = x;
            columns.vectors_mut(Field::VELOCITY)[slot] = v;
            let residuals = columns.vectors_mut(Field::POSITION_RESIDUAL);
            if let Some(own) = residuals.get_mut(slot) {
                *own = residual;
            }
        }
    }

    /// Place, its residual and velocity of a particle at a place \[m\] with a velocity \[m/s\], within the boundaries.
    fn entered(
        &self,
        [x, own]: [[f64; D]; 2],
        boundaries: &[Arc<dyn Boundary<D>>],
        time: f64,
    ) -> [[T; D]; 3] {
        let rounded = x.map(T::from_f64);
        let mut residual = core::array::from_fn(|d| T::from_f64(x[d] - rounded[d].to_f64()));
        let mut v = core::array::from_fn(|d| T::from_f64(own[d] + self.sliding[d]));
        let mut place = rounded;
        for boundary in boundaries {
            if let Some(back) = boundary.wrap(&rounded.map(Real::to_f64), time) {
                let back = back.to_scalar();
                back.re_enter(0, &mut place, &mut residual, &mut v);
            }
        }
        [place, residual, v]
    }

    /// Places \[m\] of all of its particles as built, where `pose` brings them.
    pub fn places(
        &self,
        pose: &Pose<D>,
        boundaries: &[Arc<dyn Boundary<D>>],
        time: f64,
    ) -> Vec<[T; D]> {
        let at = |rest: &[f64; D]| [pose.of(0, rest), pose.of(1, rest)];
        let place = |rest| self.entered(at(rest), boundaries, time)[0];
        self.rest.iter().map(place).collect()
    }

    /// How far it has gone between two times \[m\], by its first particle.
    pub fn carried(&self, [then, now]: [f64; 2]) -> [f64; D] {
        let Some(motion) = &self.motion else {
            return [0.0; D];
        };
        let [now, then] = [now, then].map(|time| motion.pose(time).of(0, &self.rest[0]));
        core::array::from_fn(|d| now[d] - then[d])
    }

    /// Whether its particles take the mirrored velocity by which a liquid sticks to them, which differs from that of the
    /// liquid twice as much as their own.
    pub fn is_mirrored(&self) -> bool {
        self.slip == Slip::None
    }

    /// The number of the particle in a slot among those of the wall as built.
    pub fn rest_of(&self, ids: &[u32], slot: usize) -> usize {
        (ids[slot] as usize - self.slots.start).min(self.rest.len() - 1)
    }
}

/// Walls that are structures.
impl<T: Real, const D: usize> WallState<T, D> {
    /// The slot, in the group of the structure, of the particle that is the wall's with that number as built; none if it has
    /// left.
    pub fn slot_in(&self, others: &Particles<T, D>, at: usize) -> Option<usize> {
        let body = self.structure.as_ref()?.body;
        let slot = others.slot_of[others.bodies[body].ids.start + at];
        (slot != u32::MAX).then_some(slot as usize)
    }

    /// Moves it to the particles of the body that it is, as these are at `time` \[s\], from which they are `ahead` \[s\] in a step
    /// of their own.
    pub fn follow(
        &mut self,
        own: &mut Particles<T, D>,
        boundaries: &[Arc<dyn Boundary<D>>],
        (others, work): (&Particles<T, D>, &Workspace<T, D>),
        (time, evaluated, ahead): (f64, bool, f64),
    ) {
        for slot in self.slots.start..self.end {
            let at = self.rest_of(&own.ids, slot);
            let Some(other) = self.slot_in(others, at) else {
                own.columns.raw_mut(Field::MASS)[slot] = T::zero();
                continue;
            };
            if let Some(structure) = &mut self.structure {
                let spacing = T::from_f64(others.bodies[structure.body].spacing);
                let particle = CoupledParticle::of(&others.columns, other, spacing);
                let rest = own.columns.raw(Field::DENSITY)[slot];
                let mass = structure.coupling.wall_mass(rest, &particle);
                own.columns.raw_mut(Field::MASS)[slot] = mass;
                let elapsed = if evaluated {
                    time - structure.evaluated
                } else {
                    0.0
                };
                structure.accelerate(at, other, (others, work), elapsed);
            }
            for field in [Field::POSITION, Field::POSITION_RESIDUAL, Field::VELOCITY] {
                let from = others.columns.vectors(field).get(other);
                let to = own.columns.vectors_mut(field).get_mut(slot);
                if let (Some(from), Some(to)) = (from, to) {
                    *to = *from;
                }
            }
            let [x, residual, v] =
                own.columns
                    .many_mut([Field::POSITION, Field::POSITION_RESIDUAL, Field::VELOCITY]);
            if ahead != 0.0 {
                let (mass, ahead) = (others.columns.raw(Field::MASS), T::from_f64(ahead));
                for d in 0..D {
                    let k = slot * D + d;
                    v[k] -= ahead * work.acceleration(mass, other * D + d);
                    add_compensated(&mut x[k], residual.get_mut(k), -ahead * v[k]);
                }
            }
            // The group of the structure lets particles re-enter a period when its lists are built.
            for boundary in boundaries {
                let now = core::array::from_fn(|d| x[slot * D + d].to_f64());
                if let Some(back) = boundary.wrap(&now, time) {
                    back.to_scalar().re_enter(slot, x, residual, v);
                }
            }
        }
        let first = self.slots.start;
        if let Some(structure) = self.structure.as_mut().filter(|_| evaluated) {
            structure.evaluated = time;
            let columns = &own.columns;
            let (x, v) = (
                columns.vectors(Field::POSITION),
                columns.vectors(Field::VELOCITY),
            );
            let mass = columns.raw(Field::MASS);
            structure.spins.find(|at| {
                let slot = own.slot_of[first + at] as usize;
                let is_there = mass[slot] > T::zero();
                is_there.then(|| (x[slot].map(Real::to_f64), v[slot].map(Real::to_f64)))
            });
        }
    }
}

impl<T: Real, const D: usize> Structure<T, D> {
    /// What has accelerated its particle in a slot of its group, `elapsed` \[s\] after the evaluation before.
    fn accelerate(
        &mut self,
        at: usize,
        own: usize,
        (particles, work): (&Particles<T, D>, &Workspace<T, D>),
        elapsed: f64,
    ) {
        let velocity = particles.columns.vectors(Field::VELOCITY)[own].map(Real::to_f64);
        match self.before.get_mut(at) {
            // A stiff body swings many times in a step of the liquid, which feels the mean.
            Some(before) if !self.evaluated.is_nan() => {
                if elapsed > 0.0 {
                    self.accelerations[at] =
                        core::array::from_fn(|d| (velocity[d] - before[d]) / elapsed);
                    *before = velocity;
                }
            }
            before => {
                let mass = particles.columns.raw(Field::MASS);
                self.accelerations[at] =
                    core::array::from_fn(|d| work.acceleration(mass, own * D + d).to_f64());
                if let Some(before) = before {
                    *before = velocity;
                }
            }
        }
    }
}
