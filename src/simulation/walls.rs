//! Walls of particles: their places, their pressure, and the velocity that makes a liquid stick to them.
//! Adami, Hu & Adams 2012; a wall floor keeps separating liquid from being held.

use super::evaluate::GRAIN;
use super::group::Group;
use super::structures::Structure;
use crate::boundary::{Motion, Pose, Slip};
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::tensor::{Vector, determinant, inverse, length};
use crate::term::viscosity::Riemann;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// A wall in a simulation: particles that a motion places.
#[derive(Clone, Debug)]
pub(crate) struct WallState<const D: usize> {
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
    pub carries: bool,
    /// Mass of a particle as built, in the liquid's density \[kg\].
    pub mass: f64,
    /// Its number among the walls of the scene; of no meaning for a structure.
    pub index: usize,
    /// The body of another group that its particles are, if it is not a wall of the scene.
    pub structure: Option<Structure<D>>,
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Brings walls that move to their places, and gives all walls their own velocity.
    pub(super) fn place_walls(&mut self, time: f64) {
        self.body_force = self.gravity.map(T::from_f64);
        for wall in self.walls.iter().filter(|wall| wall.structure.is_none()) {
            let pose = wall.motion.as_ref().map(|motion| match self.chord {
                Some(ends) => motion
                    .pose(time)
                    .on_chord(ends.map(|end| motion.pose(end)), ends),
                None => motion.pose(time),
            });
            if wall.carries {
                let acceleration = pose
                    .as_ref()
                    .map_or([0.0; D], |pose| pose.of(2, &wall.rest[0]));
                for d in 0..D {
                    self.body_force[d] -= T::from_f64(acceleration[d]);
                }
            }
            // What sticks to a wall at rest has overwritten its velocity.
            if pose.is_none() && self.rebuilds > 0 {
                if wall.slip == Slip::None {
                    let own = wall.slots.start..wall.end;
                    let v = wall.sliding.map(T::from_f64);
                    self.columns.vectors_mut(Field::VELOCITY)[own].fill(v);
                }
                continue;
            }
            let pose = pose.unwrap_or_else(Pose::rest);
            // A wall that is crushed has its particles closer, and each stands for less volume.
            let mass = T::from_f64(wall.mass * determinant(&pose.linear[0]).abs());
            if let Some(masses) = self
                .columns
                .raw_mut(Field::MASS)
                .get_mut(wall.slots.start..wall.end)
            {
                masses.fill(mass);
            }
            for slot in wall.slots.start..wall.end {
                let at = (self.ids[slot] as usize - wall.slots.start).min(wall.rest.len() - 1);
                let (x, own) = (pose.of(0, &wall.rest[at]), pose.of(1, &wall.rest[at]));
                let v: [f64; D] = core::array::from_fn(|d| own[d] + wall.sliding[d]);
                let rounded = x.map(T::from_f64);
                self.columns.vectors_mut(Field::POSITION)[slot] = rounded;
                self.columns.vectors_mut(Field::VELOCITY)[slot] = v.map(T::from_f64);
                if let Some(residual) = self
                    .columns
                    .vectors_mut(Field::POSITION_RESIDUAL)
                    .get_mut(slot)
                {
                    *residual = core::array::from_fn(|d| T::from_f64(x[d] - rounded[d].to_f64()));
                }
                for boundary in &self.boundaries {
                    if let Some(back) = boundary.wrap(&rounded) {
                        let [x, residual, v] = self.columns.many_mut([
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
        let Some(wall) = self.walls.iter().find(|wall| wall.carries) else {
            return [0.0; D];
        };
        let Some(motion) = &wall.motion else {
            return [0.0; D];
        };
        let now = motion.pose(time).of(0, &wall.rest[0]);
        let then = motion.pose(self.listed_time).of(0, &wall.rest[0]);
        core::array::from_fn(|d| now[d] - then[d])
    }

    /// Gives wall particles the pressure of the liquid before them, and where it sticks to them the
    /// mirrored velocity and the viscosity.
    pub fn fill_walls(&mut self, time: f64) {
        let Some(liquid) = &self.scheme.liquid else {
            return;
        };
        if self.walls.is_empty() {
            return;
        }
        let floor = T::from_f64(liquid.wall_floor);
        self.scratch_sweep_over(self.mobile..self.columns.slots(), |group| {
            group.scheme.liquid.as_ref().map(|liquid| &*liquid.wall)
        });
        let rows = &self.scratch_rows;
        let [pressure, velocity, viscosity, density, sound_speed] = self.columns.many_mut([
            Field::PRESSURE,
            Field::VELOCITY,
            Field::DYNAMIC_VISCOSITY,
            Field::DENSITY,
            Field::SOUND_SPEED,
        ]);
        let (density, sound_speed) = (&*density, &*sound_speed);
        for wall in &self.walls {
            let run = wall.slots.start..wall.end;
            let pose = wall.motion.as_ref().map(|motion| motion.pose(time));
            let (ids, first) = (&self.ids, wall.slots.start);
            let gravity = self.gravity;
            let normals = &wall.normals;
            // Normals turn with the inverse transpose, which a crush has other than a rotation.
            let turn = pose
                .as_ref()
                .filter(|_| !normals.is_empty())
                .and_then(|pose| inverse(&pose.linear[0], 0.0))
                .map(|back| back.transpose());
            let own_velocity = &*velocity;
            pressure[run.clone()]
                .par_iter_mut()
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(k, pressure)| {
                    let slot = first + k;
                    let unity = rows.get(Output::UNITY, 0, slot);
                    if unity <= T::from_f64(DRY) {
                        *pressure = T::zero();
                        return;
                    }
                    let at = (ids[slot] as usize - first).min(wall.rest.len() - 1);
                    let own = match (&wall.structure, &pose) {
                        (Some(structure), _) => structure.accelerations[at],
                        (None, Some(pose)) => pose.of(2, &wall.rest[at]),
                        (None, None) => [0.0; D],
                    };
                    let sum = (0..D).fold(rows.get(Output::LIQUID_PRESSURE, 0, slot), |sum, d| {
                        let arm = rows.get(Output::LIQUID_MOMENT, d, slot);
                        sum + arm * T::from_f64(gravity[d] - own[d])
                    });
                    let push = normals.get(at).map_or(T::zero(), |normal| {
                        let normal = Vector::from(*normal);
                        let normal = turn.map_or(normal, |turn| {
                            let turned = turn * normal;
                            turned / length(&turned).max(f64::MIN_POSITIVE)
                        });
                        let inwards = (0..D).fold(T::zero(), |sum, d| {
                            let liquid = rows.get(Output::LIQUID_VELOCITY, d, slot) / unity;
                            sum + (liquid - own_velocity[slot * D + d]) * T::from_f64(normal[d])
                        });
                        riemann_push(inwards, density[slot], sound_speed[slot])
                    });
                    *pressure = (sum / unity + push).max(floor);
                });
            let sticks = wall.slip == Slip::None && !viscosity.is_empty();
            if sticks {
                velocity[run.start * D..run.end * D]
                    .par_chunks_mut(D)
                    .enumerate()
                    .with_min_len(GRAIN)
                    .for_each(|(k, v)| {
                        let unity = rows.get(Output::UNITY, 0, first + k);
                        if unity > T::from_f64(DRY) {
                            for (d, v) in v.iter_mut().enumerate() {
                                let liquid = rows.get(Output::LIQUID_VELOCITY, d, first + k);
                                *v = *v + *v - liquid / unity;
                            }
                        }
                    });
            }
            if viscosity.is_empty() {
                continue;
            }
            for slot in run {
                let unity = rows.get(Output::UNITY, 0, slot);
                viscosity[slot] = if sticks && unity > T::from_f64(DRY) {
                    rows.get(Output::LIQUID_VISCOSITY, 0, slot) / unity
                } else {
                    T::zero()
                };
            }
        }
    }
}

/// What liquid that moves into a wall at the speed u adds to the pressure of its particles \[Pa\]: 2ρβu.
///
/// Pairs take the mean of both sides, so liquid feels p* = p + ρβu: the pressure between it and its mirror image of
/// speed −u, p + ½ρβ(u − (−u)), with the limiter β = min(3 (u − (−u)), c) of Zhang, Hu & Adams 2017, eqs. 13, 14.
/// Theirs is zero where liquid leaves; here it acts down to the floor of walls, or what has struck still bounces.
fn riemann_push<T: Real>(inwards: T, density: T, sound_speed: T) -> T {
    let closing = inwards + inwards;
    let limited = (T::from_f64(Riemann::STANDARD.limiter) * closing.abs()).min(sound_speed);
    density * limited * closing
}

/// Share of a full neighbourhood below which a wall particle sees no liquid.
const DRY: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::riemann_push;

    #[test]
    fn a_fast_impact_is_a_water_hammer_and_a_gentle_one_is_quadratic() {
        // Joukowsky 1898: what is stopped at once feels ρ c u; pairs take half of what a wall particle gets.
        let (density, sound_speed, fast) = (1000.0, 20.0, 4.0);
        let hammer = density * sound_speed * fast;
        assert_eq!(0.5 * riemann_push(fast, density, sound_speed), hammer);
        assert_eq!(0.5 * riemann_push(-fast, density, sound_speed), -hammer);
        // By hand from the paper's p* with states of 0.1 and −0.1 m/s: ½ · 1000 · (3 · 0.2) · 0.2 = 60 Pa.
        let gentle: f64 = 0.5 * riemann_push(0.1, density, sound_speed);
        assert!((gentle - 60.0).abs() < 1e-12, "{gentle}");
    }
}
