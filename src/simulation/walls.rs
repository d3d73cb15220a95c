//! Walls of particles: their pressure, and the velocity that makes a liquid stick to them.
//! Adami, Hu & Adams 2012; a wall floor keeps separating liquid from being held.

use super::evaluate::GRAIN;
use super::group::Group;
use crate::boundary::Slip;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use rayon::prelude::*;

impl<T: Real, const D: usize> Group<T, D> {
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
        let [pressure, velocity, viscosity] =
            self.columns
                .many_mut([Field::Pressure, Field::Velocity, Field::DynamicViscosity]);
        for wall in &self.walls {
            let run = wall.slots.start..wall.end;
            let pose = wall.motion.as_ref().map(|motion| motion.pose(time));
            let (ids, first) = (&self.ids, wall.slots.start);
            let gravity = self.gravity;
            pressure[run.clone()]
                .par_iter_mut()
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(k, pressure)| {
                    let slot = first + k;
                    let unity = rows.get(Output::Unity, 0, slot);
                    if unity <= T::from_f64(DRY) {
                        *pressure = T::zero();
                        return;
                    }
                    let at = (ids[slot] as usize - first).min(wall.rest.len() - 1);
                    let own = pose
                        .as_ref()
                        .map_or([0.0; D], |pose| pose.of(2, &wall.rest[at]));
                    let sum = (0..D).fold(rows.get(Output::LiquidPressure, 0, slot), |sum, d| {
                        let arm = rows.get(Output::LiquidMoment, d, slot);
                        sum + arm * T::from_f64(gravity[d] - own[d])
                    });
                    *pressure = (sum / unity).max(floor);
                });
            let sticks = wall.slip == Slip::None && !viscosity.is_empty();
            if sticks {
                velocity[run.start * D..run.end * D]
                    .par_chunks_mut(D)
                    .enumerate()
                    .with_min_len(GRAIN)
                    .for_each(|(k, v)| {
                        let unity = rows.get(Output::Unity, 0, first + k);
                        if unity > T::from_f64(DRY) {
                            for (d, v) in v.iter_mut().enumerate() {
                                let liquid = rows.get(Output::LiquidVelocity, d, first + k);
                                *v = *v + *v - liquid / unity;
                            }
                        }
                    });
            }
            if viscosity.is_empty() {
                continue;
            }
            for slot in run {
                let unity = rows.get(Output::Unity, 0, slot);
                viscosity[slot] = if sticks && unity > T::from_f64(DRY) {
                    rows.get(Output::LiquidViscosity, 0, slot) / unity
                } else {
                    T::zero()
                };
            }
        }
    }
}

/// Share of a full neighbourhood below which a wall particle sees no liquid.
const DRY: f64 = 1e-6;
