//! Wave gauges: the height of the free surface along a line.
//! The surface is where the liquid fills half of the kernel.

use super::place::{Place, refused};
use super::{normalisation, weight};
use crate::error::Result;
use crate::scalar::Real;
use crate::simulation::Simulation;

/// A gauge that measures from its foot along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct WaveGauge<const D: usize> {
    foot: Place<D>,
    axis: usize,
}

impl<const D: usize> WaveGauge<D> {
    /// From `foot` \[m\] along `axis` (2 is z), upwards. Keep it a support away from walls, which take
    /// away part of the liquid's side.
    ///
    /// # Errors
    /// If the foot is not finite, the axis not below the dimension, or the line
    /// [outside of the scene](super#places).
    pub fn upwards<T: Real>(
        simulation: &Simulation<T, D>,
        name: &str,
        foot: [f64; D],
        axis: usize,
    ) -> Result<Self> {
        if axis >= D {
            let must_be = "it must be below the dimension: 0 is x, 1 is y, 2 is z";
            return Err(refused(name, "axis", axis as f64, must_be));
        }
        let foot = Place::new(simulation, name, foot, Some(axis))?;
        Ok(Self { foot, axis })
    }

    /// Fixes its foot to a wall, by its index; the axis keeps its direction.
    ///
    /// # Errors
    /// If the scene does not have that wall.
    pub fn on_wall(self, wall: usize) -> Result<Self> {
        let foot = self.foot.on_wall(wall)?;
        Ok(Self { foot, ..self })
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.foot.name
    }

    /// Height \[m\] above the foot of the highest point at which liquid fills half of the kernel, zero
    /// where there is none: drops thinner than a kernel are not seen.
    #[must_use]
    pub fn height<T: Real>(&self, simulation: &Simulation<T, D>) -> f64 {
        let foot = self.foot.pose(simulation).of(0, &self.foot.point);
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
