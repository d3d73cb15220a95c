//! Walls of particles: their places, by their motions or by the bodies that they are.
//! How they answer a liquid is the wall law's of its scheme.

use super::couplings::Structure;
use super::population::Particles;
use crate::boundary::{Boundary, Motion, Pose, Slip, motion_from};
use crate::particles::Field;
use crate::scalar::Real;
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
    pub rest: Vec<[f64; D]>,
    /// Unit vectors from the liquid into it, by identity; none if the scheme does not ask for them.
    pub normals: Vec<[f64; D]>,
    pub motion: Option<Arc<dyn Motion<D>>>,
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
        let run = self.slots.start..self.end;
        // A wall that is crushed has its particles closer, and each stands for less volume.
        let mass = T::from_f64(self.mass * determinant(&pose.linear[0]).abs());
        let columns = &mut particles.columns;
        if let Some(masses) = columns.raw_mut(Field::MASS).get_mut(run.clone()) {
            masses.fill(mass);
        }
        for slot in run {
            let rest = &self.rest[self.rest_of(&particles.ids, slot)];
            let (x, own) = (pose.of(0, rest), pose.of(1, rest));
            let v: [f64; D] = core::array::from_fn(|d| own[d] + self.sliding[d]);
            let rounded = x.map(T::from_f64);
            columns.vectors_mut(Field::POSITION)[slot] = rounded;
            columns.vectors_mut(Field::VELOCITY)[slot] = v.map(T::from_f64);
            let residuals = columns.vectors_mut(Field::POSITION_RESIDUAL);
            if let Some(residual) = residuals.get_mut(slot) {
                *residual = core::array::from_fn(|d| T::from_f64(x[d] - rounded[d].to_f64()));
            }
            for boundary in boundaries {
                if let Some(back) = boundary.wrap(&rounded.map(Real::to_f64), time) {
                    let [x, residual, v] = columns.many_mut([
                        Field::POSITION,
                        Field::POSITION_RESIDUAL,
                        Field::VELOCITY,
                    ]);
                    back.to_scalar().re_enter(slot, x, residual, v);
                }
            }
        }
    }

    /// How far it has gone between two times \[m\], by its first particle.
    pub fn carried(&self, [then, now]: [f64; 2]) -> [f64; D] {
        let Some(motion) = &self.motion else {
            return [0.0; D];
        };
        let [now, then] = [now, then].map(|time| motion.pose(time).of(0, &self.rest[0]));
        core::array::from_fn(|d| now[d] - then[d])
    }

    /// Whether its particles wear the mirrored velocity by which a liquid sticks to them, which differs from that of the
    /// liquid twice as much as their own.
    pub fn is_mirrored(&self) -> bool {
        self.slip == Slip::None
    }

    /// The number of the particle in a slot among those of the wall as built.
    pub fn rest_of(&self, ids: &[u32], slot: usize) -> usize {
        (ids[slot] as usize - self.slots.start).min(self.rest.len() - 1)
    }
}
