//! Wave gauges: the height of the free surface along a line.
//! The surface is where the liquid fills half of the kernel.

use super::place::{Place, refused};
use super::{normalisation, weight};
use crate::error::Result;
use crate::scalar::Real;
use crate::simulation::{Simulation, Which};

/// A gauge that measures from its foot along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct WaveGauge<const D: usize> {
    foot: Place<D>,
    axis: usize,
}

impl<const D: usize> WaveGauge<D> {
    /// From `foot` \[m\] along `axis` (2 is z), upwards. A foot on the floor reads thin layers
    /// too, for the floor is mirrored; keep the line a support away from other walls, which take away part of
    /// the liquid's side; by planes and periods it sees images.
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

    /// Fixes its foot to a wall; the axis keeps its direction.
    ///
    /// # Errors
    /// If the scene does not have that wall; the error lists those that it has.
    pub fn on_wall(self, wall: impl Which) -> Result<Self> {
        let foot = self.foot.on_wall(&wall)?;
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
        self.column(simulation).surface().unwrap_or(0.0)
    }

    /// Length \[m\] of the line on which liquid fills half of the kernel: what a wire that measures by
    /// resistance or capacitance reads. Below a crest that breaks, [`height`](Self::height) counts the air in
    /// it, and this does not.
    #[must_use]
    pub fn wetted_length<T: Real>(&self, simulation: &Simulation<T, D>) -> f64 {
        let column = self.column(simulation);
        let (mut length, mut top) = (0.0, column.surface());
        while let Some(surface) = top {
            let bottom = column.next_below(surface, false).unwrap_or(0.0);
            length += surface - bottom;
            top = column.next_below(bottom, true);
        }
        length
    }

    /// The liquid around the line.
    fn column<T: Real>(&self, simulation: &Simulation<T, D>) -> Column<D> {
        let foot = self.foot.pose(simulation).of(0, &self.foot.point);
        let h = simulation.sampling_length();
        let norm = normalisation::<D>() / h.powi(D as i32);
        let mut particles = Vec::new();
        let mut images = Vec::new();
        let mut add = |x: [f64; D], share: f64| {
            let aside2: f64 = (0..D)
                .filter(|&d| d != self.axis)
                .map(|d| (x[d] - foot[d]).powi(2))
                .sum();
            let above = x[self.axis] - foot[self.axis];
            if aside2 < 4.0 * h * h && above >= 0.0 {
                particles.push((above, aside2, share));
                // The floor below the foot is mirrored, or liquid next to it would seem half empty.
                if above < 2.0 * h {
                    particles.push((-above, aside2, share));
                }
            }
        };
        for particle in simulation.all() {
            let (x, share) = (
                particle.position(),
                particle.mass() / particle.density() * norm,
            );
            add(x, share);
            simulation.images_of(&x, 2.0 * h, &mut images);
            for image in &images {
                add(image.at, share);
            }
        }
        particles.sort_by(|a, b| a.0.total_cmp(&b.0));
        Column { h, particles }
    }
}

/// What lies around a gauge's line: heights above the foot, squared distances from the line, and volumes over
/// the integral of the kernel.
struct Column<const D: usize> {
    h: f64,
    particles: Vec<(f64, f64, f64)>,
}

impl<const D: usize> Column<D> {
    /// Whether liquid fills half of the kernel at a height.
    fn filled(&self, z: f64) -> bool {
        let reach = 2.0 * self.h;
        let first = self.particles.partition_point(|p| p.0 < z - reach);
        let near = self.particles[first..]
            .iter()
            .take_while(|p| p.0 < z + reach);
        let sum: f64 = near
            .map(|(zj, aside2, share)| {
                share * weight::<D>(((zj - z).powi(2) + aside2).sqrt() / self.h)
            })
            .sum();
        sum >= 0.5
    }

    /// The highest height at which it is filled.
    fn surface(&self) -> Option<f64> {
        self.next_below(self.particles.last()?.0 + self.h, true)
    }

    /// The next height below `z` at which it gets filled, or empty, looking down.
    fn next_below(&self, mut z: f64, filled: bool) -> Option<f64> {
        // In steps that no kernel fits between, then halve.
        let step = 0.25 * self.h;
        while z > 0.0 {
            z -= step;
            if self.filled(z.max(0.0)) == filled {
                let (mut low, mut high) = (z.max(0.0), z + step);
                for _ in 0..20 {
                    let middle = 0.5 * (low + high);
                    if self.filled(middle) == filled {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                return Some(low);
            }
        }
        None
    }
}
