//! Walls of particles: their places, by their motions or by the bodies that they are.
//! How they answer a liquid is the wall law's of its scheme.

use super::couplings::Structure;
use super::group::Group;
use crate::boundary::{Motion, Pose, Slip};
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
    /// Velocity of its surface beside its motion \[m/s\].
    pub sliding: [f64; D],
    pub container_frame: bool,
    /// Mass of a particle as built, in the liquid's density \[kg\].
    pub mass: f64,
    /// Its number among the walls of the scene; of no meaning for a structure.
    pub index: usize,
    /// The body of another group that its particles are, if it is not a wall of the scene.
    pub structure: Option<Structure<T, D>>,
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Brings walls that move to their places, and gives all walls their own velocity. `chord` \[s\] are the ends
    /// of the drift under way, along which they go straight.
    pub(super) fn place_walls(&mut self, time: f64, chord: Option<[f64; 2]>) {
        self.body_force = self.gravity.map(T::from_f64);
        for wall in self.walls.iter().filter(|wall| wall.structure.is_none()) {
            let pose = wall.motion.as_ref().map(|motion| match chord {
                Some(ends) => motion
                    .pose(time)
                    .on_chord(ends.map(|end| motion.pose(end)), ends),
                None => motion.pose(time),
            });
            if wall.container_frame {
                let acceleration = pose
                    .as_ref()
                    .map_or([0.0; D], |pose| pose.of(2, &wall.rest[0]));
                for d in 0..D {
                    self.body_force[d] -= T::from_f64(acceleration[d]);
                }
            }
            // What sticks to a wall at rest has overwritten its velocity.
            if pose.is_none() && self.neighborhood.rebuilds > 0 {
                if wall.slip == Slip::None {
                    let own = wall.slots.start..wall.end;
                    let v = wall.sliding.map(T::from_f64);
                    self.particles.columns.vectors_mut(Field::VELOCITY)[own].fill(v);
                }
                continue;
            }
            let pose = pose.unwrap_or_else(Pose::rest);
            // A wall that is crushed has its particles closer, and each stands for less volume.
            let mass = T::from_f64(wall.mass * determinant(&pose.linear[0]).abs());
            if let Some(masses) = self
                .particles
                .columns
                .raw_mut(Field::MASS)
                .get_mut(wall.slots.start..wall.end)
            {
                masses.fill(mass);
            }
            for slot in wall.slots.start..wall.end {
                let at =
                    (self.particles.ids[slot] as usize - wall.slots.start).min(wall.rest.len() - 1);
                let (x, own) = (pose.of(0, &wall.rest[at]), pose.of(1, &wall.rest[at]));
                let v: [f64; D] = core::array::from_fn(|d| own[d] + wall.sliding[d]);
                let rounded = x.map(T::from_f64);
                self.particles.columns.vectors_mut(Field::POSITION)[slot] = rounded;
                self.particles.columns.vectors_mut(Field::VELOCITY)[slot] = v.map(T::from_f64);
                if let Some(residual) = self
                    .particles
                    .columns
                    .vectors_mut(Field::POSITION_RESIDUAL)
                    .get_mut(slot)
                {
                    *residual = core::array::from_fn(|d| T::from_f64(x[d] - rounded[d].to_f64()));
                }
                for boundary in &self.boundaries {
                    if let Some(back) = boundary.wrap(&rounded, time) {
                        let [x, residual, v] = self.particles.columns.many_mut([
                            Field::POSITION,
                            Field::POSITION_RESIDUAL,
                            Field::VELOCITY,
                        ]);
                        back.re_enter(slot, x, residual, v);
                    }
                }
            }
        }
    }

    /// How far the wall that carries the liquid has gone since the last list build \[m\].
    pub(super) fn carried(&self, time: f64) -> [f64; D] {
        let Some(wall) = self.walls.iter().find(|wall| wall.container_frame) else {
            return [0.0; D];
        };
        let Some(motion) = &wall.motion else {
            return [0.0; D];
        };
        let now = motion.pose(time).of(0, &wall.rest[0]);
        let then = motion
            .pose(self.neighborhood.listed_time)
            .of(0, &wall.rest[0]);
        core::array::from_fn(|d| now[d] - then[d])
    }
}
