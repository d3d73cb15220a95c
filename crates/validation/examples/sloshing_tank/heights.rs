//! The height of water in the tank: where a kernel sum of its volumes in the plane of mid width falls to a half.
//! On a slice and in space, at any place along the tank.

use super::tank::{Case, H_OVER_DX};
use meshfree::effect::FiveEquations;
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree::prelude::*;

/// Where the water is: Σ V W in the plane of mid width.
pub struct Surface<const D: usize> {
    /// Places \[m\] and volumes.
    water: Vec<([f64; D], f64)>,
    width: f64,
    height: f64,
    h: f64,
    spacing: f64,
}

impl<const D: usize> Surface<D>
where
    WendlandC2: Kernel<D>,
{
    pub fn of(case: &Case, now: &Simulation<f64, D>) -> Self {
        // Particles that share their volume with air count by the water's part.
        let share = |p: &meshfree::simulation::ParticleView<'_, f64, D>| {
            p.scalar(FiveEquations::FRACTION).unwrap_or(1.0)
        };
        let water = now.all();
        Self {
            water: water
                .map(|p| (p.position(), share(&p) * p.mass() / p.density()))
                .collect(),
            width: case.size[1],
            height: case.size[2],
            h: H_OVER_DX * case.spacing,
            spacing: case.spacing,
        }
    }
    /// The share of the kernel that water fills at (x, z), less what walls would below, above and at the sides: those are beyond its reach
    /// at all heights and places that are read, or count as half.
    fn share(&self, x: f64, z: f64) -> f64 {
        let mut at = [0.5 * self.width; D];
        (at[0], at[D - 1]) = (x, z);
        let reach = self.h * Kernel::<D>::support(&WendlandC2);
        let mut sum = 0.0;
        for (place, volume) in &self.water {
            if (place[0] - x).abs() < reach {
                let r2: f64 = (0..D).map(|d| (place[d] - at[d]).powi(2)).sum();
                if r2 < reach * reach {
                    sum += volume * Kernel::<D>::shape(&WendlandC2, r2.sqrt() / self.h);
                }
            }
        }
        sum * Kernel::<D>::normalisation(&WendlandC2) / self.h.powi(D as i32)
    }
    /// Height \[m\] of the water at x: the highest place at which its share is a half; zero where it is less all the way down, and at most
    /// the tank's.
    pub fn height(&self, x: f64) -> f64 {
        let step = 0.25 * self.spacing;
        let (mut z, mut above) = (self.height, self.share(x, self.height));
        while z > 0.0 {
            let share = self.share(x, z);
            if share >= 0.5 {
                let part = (share - 0.5) / (share - above).max(f64::MIN_POSITIVE);
                return self.height.min(z + step * part.min(1.0));
            }
            (z, above) = (z - step, share);
        }
        0.0
    }
}
