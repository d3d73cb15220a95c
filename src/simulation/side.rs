//! The sides of a coupling by forces: a body, or a wall of particles, which is the second.
//! A wall is where its motion has it, whatever the liquids of a scene have made of its particles.

use super::group::Group;
use super::population::Particles;
use crate::boundary::{Boundary, Motion, Pose};
use crate::collective::{Corners, largest, over};
use crate::coupling::{Anchor, CoupledParticle};
use crate::particles::Field;
use crate::scalar::Real;
use crate::tensor::{Matrix, Vector, inverse};
use std::sync::Arc;

/// What takes part in a coupling by forces.
#[derive(Clone, Debug)]
pub(crate) enum Side<const D: usize> {
    Body { group: usize, body: usize },
    Wall(Arc<MetWall<D>>),
}

/// A wall of particles that bodies meet by a coupling.
#[derive(Clone, Debug)]
pub(crate) struct MetWall<const D: usize> {
    pub name: String,
    /// Where its particles are as built \[m\], by number.
    pub rest: Vec<[f64; D]>,
    pub spacing: f64,
    pub motion: Option<Arc<dyn Motion<D>>>,
    /// Velocity of its surface in addition to its motion \[m/s\].
    pub sliding: [f64; D],
}

impl<const D: usize> MetWall<D> {
    /// Where it is at `time` \[s\].
    pub fn pose(&self, time: f64) -> Pose<D> {
        let motion = self.motion.as_ref();
        motion.map_or_else(Pose::rest, |motion| motion.pose(time))
    }

    /// Where its particles are at `time` \[m\].
    pub fn places(&self, time: f64) -> Vec<[f64; D]> {
        let pose = self.pose(time);
        self.rest.iter().map(|x| pose.of(0, x)).collect()
    }

    /// The velocity of its surface \[m/s\] at one of its particles.
    pub fn velocity(&self, pose: &Pose<D>, id: usize) -> [f64; D] {
        let v = pose.of(1, &self.rest[id]);
        core::array::from_fn(|d| v[d] + self.sliding[d])
    }

    /// The farthest that any of its particles has gone between two times \[m\]: that of a corner of the box around them,
    /// because a pose is affine.
    fn gone(&self, times: [f64; 2]) -> f64 {
        if self.motion.is_none() {
            return 0.0;
        }
        let Corners([low, high]) = over(0..self.rest.len(), |id| Corners::at(self.rest[id]));
        let poses = times.map(|time| self.pose(time));
        let corners = (0..1_usize << D).map(|corner| {
            let x = core::array::from_fn(|d| {
                if corner >> d & 1 == 0 {
                    low[d]
                } else {
                    high[d]
                }
            });
            let [then, now] = poses.each_ref().map(|pose| pose.of(0, &x));
            (0..D).map(|d| (now[d] - then[d]).powi(2)).sum::<f64>()
        });
        corners.fold(0.0, f64::max).sqrt()
    }

    /// What brings places on its surface, seen from it, from one time to another \[s\]: they turn with it, and are carried
    /// by what slides. None where nothing moves.
    pub fn carries(&self, [then, now]: [f64; 2]) -> Option<(Matrix<f64, D>, [f64; D])> {
        let slides = self.sliding.iter().any(|v| *v != 0.0);
        if then == now || !then.is_finite() || (self.motion.is_none() && !slides) {
            return None;
        }
        let [before, after] = [then, now].map(|time| self.pose(time).linear[0]);
        let turn = if before == after {
            Matrix::identity()
        } else {
            after * inverse(&before, 0.0).unwrap_or_else(Matrix::identity)
        };
        Some((turn, self.sliding.map(|v| v * (now - then))))
    }
}

/// Where particles of a side were listed, within periods.
#[derive(Clone, Debug, Default)]
pub(crate) struct Listed<const D: usize> {
    pub places: Vec<[f64; D]>,
    /// By how much boundaries had brought them back \[m\]; empty if by nothing.
    pub back: Vec<[f64; D]>,
}

impl<const D: usize> Side<D> {
    /// The group and the body there, if it is a body.
    pub fn body(&self) -> Option<(usize, usize)> {
        match *self {
            Self::Body { group, body } => Some((group, body)),
            Self::Wall(_) => None,
        }
    }

    pub fn is_wall(&self) -> bool {
        matches!(self, Self::Wall(_))
    }

    pub fn name<'a, T: Real>(&'a self, groups: &'a [Group<T, D>]) -> &'a str {
        match self {
            Self::Body { group, body } => &groups[*group].particles.bodies[*body].name,
            Self::Wall(wall) => &wall.name,
        }
    }

    pub fn spacing<T: Real>(&self, groups: &[Group<T, D>]) -> f64 {
        match self {
            Self::Body { group, body } => groups[*group].particles.bodies[*body].spacing,
            Self::Wall(wall) => wall.spacing,
        }
    }

    /// The number of particles that it has had.
    pub fn count<T: Real>(&self, groups: &[Group<T, D>]) -> usize {
        match self {
            Self::Body { group, body } => groups[*group].particles.bodies[*body].ids.len(),
            Self::Wall(wall) => wall.rest.len(),
        }
    }

    /// The group and the slot there of a particle of a body, if it is there.
    pub fn slot<T: Real>(&self, id: u32, groups: &[Group<T, D>]) -> Option<(usize, usize)> {
        let (group, body) = self.body()?;
        let particles = &groups[group].particles;
        let slot = particles.slot_of[particles.bodies[body].ids.start + id as usize];
        (slot != u32::MAX).then_some((group, slot as usize))
    }

    /// The largest ρc² \[Pa\]; a wall does not yield.
    pub fn stiffness<T: Real>(&self, groups: &[Group<T, D>]) -> f64 {
        match self {
            Self::Body { group, body } => stiffness_of(&groups[*group].particles, *body),
            Self::Wall(_) => f64::INFINITY,
        }
    }

    /// Lists where its particles are at `time` \[s\], by number; those that are not there are no number away.
    pub fn list<T: Real>(&self, listed: &mut Listed<D>, groups: &[Group<T, D>], time: f64) {
        listed.places.clear();
        listed.back.clear();
        match self {
            Self::Body { group, body } => {
                listed.places.resize(self.count(groups), [f64::NAN; D]);
                let particles = &groups[*group].particles;
                let body = &particles.bodies[*body];
                for slot in body.slots.clone() {
                    let id = particles.ids[slot] as usize - body.ids.start;
                    let x = particles.columns.vectors(Field::POSITION)[slot];
                    listed.places[id] = x.map(Real::to_f64);
                }
                // What keeps its neighbours goes on through periods in its group, which does not list again.
                if groups[*group].scheme.density.keeps_neighbors() {
                    listed.come_back(&groups[0].boundaries, time);
                }
            }
            Self::Wall(wall) => {
                listed.places = wall.places(time);
                listed.come_back(&groups[0].boundaries, time);
            }
        }
    }

    /// The farthest that a particle has gone since it was listed, at the first of two times \[s\], to the other \[m\].
    pub fn gone<T: Real>(
        &self,
        listed: &Listed<D>,
        groups: &[Group<T, D>],
        times: [f64; 2],
    ) -> f64 {
        let (group, body) = match self {
            Self::Body { group, body } => (*group, *body),
            Self::Wall(wall) => return wall.gone(times),
        };
        let particles = &groups[group].particles;
        let body = &particles.bodies[body];
        let x = particles.columns.vectors(Field::POSITION);
        let far = |slot: usize| {
            let id = particles.ids[slot] as usize - body.ids.start;
            let (before, back) = (&listed.places[id], listed.back_of(id));
            let square = (0..D).map(|d| (x[slot][d].to_f64() + back[d] - before[d]).powi(2));
            let square = square.sum::<f64>();
            // One that was not there has come from anywhere.
            if square.is_nan() {
                f64::INFINITY
            } else {
                square
            }
        };
        largest(body.slots.clone(), far).sqrt()
    }

    /// Where it is at `time` \[s\], if it is a wall.
    pub fn pose(&self, time: f64) -> Pose<D> {
        match self {
            Self::Body { .. } => Pose::rest(),
            Self::Wall(wall) => wall.pose(time),
        }
    }

    /// What couplings see of one of its particles, in a pose of its.
    pub fn see<T: Real>(
        &self,
        id: u32,
        pose: &Pose<D>,
        listed: &Listed<D>,
        groups: &[Group<T, D>],
    ) -> CoupledParticle<T, D> {
        let spacing = T::from_f64(self.spacing(groups));
        match self {
            Self::Body { group, .. } => {
                let columns = &groups[*group].particles.columns;
                match self.slot(id, groups) {
                    Some((_, slot)) => {
                        let own = CoupledParticle::of(columns, slot, spacing);
                        if listed.back.is_empty() {
                            return own;
                        }
                        let back = listed.back_of(id as usize);
                        let x = own.position;
                        CoupledParticle {
                            position: core::array::from_fn(|d| {
                                T::from_f64(x[d].to_f64() + back[d])
                            }),
                            ..own
                        }
                    }
                    None => CoupledParticle {
                        position: [T::from_f64(f64::NAN); D],
                        ..CoupledParticle::of(columns, 0, spacing)
                    },
                }
            }
            Self::Wall(wall) => {
                let x = pose.of(0, &wall.rest[id as usize]);
                let back = listed.back_of(id as usize);
                let infinite = T::from_f64(f64::INFINITY);
                CoupledParticle {
                    position: core::array::from_fn(|d| T::from_f64(x[d] + back[d])),
                    velocity: wall.velocity(pose, id as usize).map(T::from_f64),
                    mass: infinite,
                    density: infinite,
                    spacing,
                    stiffness: T::zero(),
                    sum: T::zero(),
                    gradient: [T::zero(); D],
                    pressure: T::zero(),
                }
            }
        }
    }
}

impl<const D: usize> Listed<D> {
    /// By how much boundaries had brought one of them back \[m\].
    fn back_of(&self, id: usize) -> [f64; D] {
        self.back.get(id).copied().unwrap_or([0.0; D])
    }

    /// Brings places back through periods, as boundaries bring back particles.
    fn come_back(&mut self, boundaries: &[Arc<dyn Boundary<D>>], time: f64) {
        let count = self.places.len();
        for boundary in boundaries {
            for (id, x) in self.places.iter_mut().enumerate() {
                let Some(through) = boundary.wrap(x, time) else {
                    continue;
                };
                if self.back.is_empty() {
                    self.back = vec![[0.0; D]; count];
                }
                for d in 0..D {
                    let shift = through.shift[d];
                    x[d] += shift;
                    self.back[id][d] += shift;
                }
            }
        }
    }
}

/// The largest ρc² of a body \[Pa\].
fn stiffness_of<T: Real, const D: usize>(particles: &Particles<T, D>, body: usize) -> f64 {
    let columns = &particles.columns;
    let (rho, c) = (columns.raw(Field::DENSITY), columns.raw(Field::SOUND_SPEED));
    let own = particles.bodies[body].slots.clone();
    largest(own, |slot| rho[slot].to_f64() * c[slot].to_f64().powi(2))
}

/// Brings what pairs with a wall remember from one time to another.
pub(super) fn carry<T: Real, const D: usize>(
    anchors: &mut [([u64; 2], Anchor<T, D>)],
    (turn, shift): (Matrix<f64, D>, [f64; D]),
) {
    for (_, anchor) in anchors {
        let turned = |x: [T; D]| turn * Vector::from(x.map(Real::to_f64));
        let (place, force) = (turned(anchor.place), turned(anchor.force));
        anchor.place = core::array::from_fn(|d| T::from_f64(place[d] + shift[d]));
        anchor.force = core::array::from_fn(|d| T::from_f64(force[d]));
    }
}
