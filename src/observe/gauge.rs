//! Wave gauges: the height of the free surface along a line.
//! The surface is where the liquid fills half of the kernel.

use super::{normalisation, weight};
use crate::scalar::Real;
use crate::simulation::Simulation;

/// A gauge that measures from its foot along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct WaveGauge<const D: usize> {
    name: String,
    foot: [f64; D],
    axis: usize,
    wall: Option<usize>,
}

impl<const D: usize> WaveGauge<D> {
    /// From `foot` \[m\] along `axis` (2 is z), upwards. Keep it a support away from walls, which take
    /// away part of the liquid's side.
    #[must_use]
    pub fn upwards(name: &str, foot: [f64; D], axis: usize) -> Self {
        Self {
            name: name.into(),
            foot,
            axis: axis.min(D - 1),
            wall: None,
        }
    }

    /// Fixes its foot to a wall, by its index; the axis keeps its direction.
    #[must_use]
    pub fn on_wall(mut self, wall: usize) -> Self {
        self.wall = Some(wall);
        self
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Height \[m\] above the foot of the highest point at which liquid fills half of the kernel, zero
    /// where there is none: drops thinner than a kernel are not seen.
    #[must_use]
    pub fn height<T: Real>(&self, simulation: &Simulation<T, D>) -> f64 {
        let foot = simulation.wall_pose(self.wall).of(0, &self.foot);
        let h = simulation.smoothing_length();
        let norm = normalisation(D) / h.powi(D as i32);
        let mut column: Vec<(f64, f64, f64)> = Vec::new();
        for particle in simulation.all() {
            let x = particle.position();
            let aside2: f64 = (0..D)
                .filter(|&d| d != self.axis)
                .map(|d| (x[d] - foot[d]).powi(2))
                .sum();
            if aside2 < 4.0 * h * h {
                let volume = particle.mass() / particle.density();
                column.push((x[self.axis] - foot[self.axis], aside2, volume));
            }
        }
        column.sort_by(|a, b| a.0.total_cmp(&b.0));
        let filled = |z: f64| {
            let first = column.partition_point(|p| p.0 < z - 2.0 * h);
            let near = column[first..].iter().take_while(|p| p.0 < z + 2.0 * h);
            let sum: f64 = near
                .map(|(zj, aside2, volume)| {
                    let q = ((zj - z).powi(2) + aside2).sqrt() / h;
                    volume * norm * weight(q)
                })
                .sum();
            sum >= 0.5
        };
        let Some(&(top, ..)) = column.last() else {
            return 0.0;
        };
        // Down from above all liquid in steps that no kernel fits between, then halve.
        let step = 0.25 * h;
        let mut z = top + h;
        while z > 0.0 && !filled(z) {
            z -= step;
        }
        if z <= 0.0 {
            return 0.0;
        }
        let (mut low, mut high) = (z, z + step);
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            if filled(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
}
