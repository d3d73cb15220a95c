//! Where the water is: the share of the kernel that it fills, on a grid of half the spacing.
//! Walls take a share of the kernel away, and the rest is what water is counted against.

use super::run::{shift, walls};
use super::tank::Case;
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree::prelude::*;

/// Share of the kernel that walls must leave for a place to be judged: a quarter in an edge, less
/// rounding; cells in corners have less, and are full or empty as their neighbours are.
const OPEN: f64 = 0.1;

/// How much of each cell's kernel water fills: Σ V W over water / (1 − Σ V W over walls).
pub struct Occupancy {
    counts: [usize; 3],
    cell: [f64; 3],
    share: Vec<f64>,
}

/// Space that water takes against its volume, as differences over it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Space {
    /// Of the cells that are at least half full: drops and a frayed surface are missing.
    pub half_full: f64,
    /// Of the shares of all cells, each at most one: drops count, and water that overlaps is missing.
    pub with_spray: f64,
}

impl Occupancy {
    pub fn of<T: Real>(case: &Case, now: &Simulation<T, 3>) -> Result<Self, Error> {
        let shift = shift(case, now)?[0];
        let water = now.body("water")?.map(|particle| (particle, false));
        let walls = walls(case, now)?.map(|particle| (particle, true));
        let particles = water.chain(walls).map(|(particle, wall)| {
            let x = particle.position();
            let place = core::array::from_fn(|d| x[d] - shift[d]);
            (place, particle.mass() / particle.density(), wall)
        });
        Ok(Self::of_particles(case, now.smoothing_length(), particles))
    }

    /// Of particles with a place in the tank \[m\] and a volume \[m³\], and whether they are of a wall.
    pub fn of_particles(
        case: &Case,
        h: f64,
        particles: impl Iterator<Item = ([f64; 3], f64, bool)>,
    ) -> Self {
        let reach = Kernel::<3>::support(&WendlandC2) * h;
        let counts = case
            .size
            .map(|size| (2.0 * size / case.spacing).round().max(1.0) as usize);
        let cell: [f64; 3] = core::array::from_fn(|d| case.size[d] / counts[d] as f64);
        // Of water and of walls.
        let mut filled = vec![[0.0; 2]; counts.iter().product()];
        for (x, volume, wall) in particles {
            let scale = volume * Kernel::<3>::normalisation(&WendlandC2) / h.powi(3);
            let cells = |d: usize| {
                let first = ((x[d] - reach) / cell[d]).floor().max(0.0) as usize;
                let end = ((x[d] + reach) / cell[d]).ceil().max(0.0) as usize;
                first..end.min(counts[d])
            };
            for k in cells(2) {
                for j in cells(1) {
                    for i in cells(0) {
                        let at = [i, j, k];
                        let r2: f64 = (0..3)
                            .map(|d| (x[d] - (at[d] as f64 + 0.5) * cell[d]).powi(2))
                            .sum();
                        if r2 < reach * reach {
                            let shape = Kernel::<3>::shape(&WendlandC2, r2.sqrt() / h);
                            filled[(k * counts[1] + j) * counts[0] + i][usize::from(wall)] +=
                                scale * shape;
                        }
                    }
                }
            }
        }
        let share = |[water, walls]: [f64; 2]| water / (1.0 - walls).max(OPEN);
        Self {
            counts,
            cell,
            share: filled.into_iter().map(share).collect(),
        }
    }

    /// The space that water of this volume \[m³\] takes.
    pub fn space(&self, water: f64) -> Space {
        let cell = self.cell.iter().product::<f64>() / water;
        let half_full = self.share.iter().filter(|share| **share >= 0.5).count();
        let filled: f64 = self.share.iter().map(|share| share.min(1.0)).sum();
        Space {
            half_full: cell * half_full as f64 - 1.0,
            with_spray: cell * filled - 1.0,
        }
    }

    /// Points (x, z) \[m\] of the surface at mid width, ordered by x and then z: where lines through
    /// the cells cross the share ½.
    pub fn mid_plane(&self) -> Vec<[f64; 2]> {
        let [nx, ny, nz] = self.counts;
        let at =
            |i: usize, k: usize| [(i, 0), (k, 2)].map(|(n, d)| (n as f64 + 0.5) * self.cell[d]);
        let share = |i: usize, k: usize| self.share[(k * ny + ny / 2) * nx + i] - 0.5;
        let mut points = Vec::new();
        for i in 0..nx {
            for k in 0..nz {
                for (j, l) in [(i + 1, k), (i, k + 1)] {
                    if j >= nx || l >= nz {
                        continue;
                    }
                    let (a, b) = (share(i, k), share(j, l));
                    if (a < 0.0) != (b < 0.0) {
                        let ([x, z], [u, v]) = (at(i, k), at(j, l));
                        let s = a / (a - b);
                        points.push([x + s * (u - x), z + s * (v - z)]);
                    }
                }
            }
        }
        points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        points
    }
}
