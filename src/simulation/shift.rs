//! Shifting: keeps the particles of a liquid evenly spread, and leaves its free surface alone.
//! Lind et al. 2012, Skillen et al. 2013; the transport velocity of Adami, Hu & Adams 2013.

use super::evaluate::GRAIN;
use super::group::Group;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::Shifting;
use crate::sweep::two_sum;
use rayon::prelude::*;

/// First moment −Σ V r·∇W/D of the neighbourhood at and below which a particle lies at a free
/// surface and is not shifted, and from which on it is shifted in full. A flat surface has a half.
const SURFACE: [f64; 2] = [0.75, 0.95];
/// Largest coefficient of the concentration's gradient in h²: shifting diffuses particles in explicit
/// steps, and overshoots beyond about a half (Skillen et al. 2013).
const STABLE: f64 = 0.3;
/// Longest shift in units of the smoothing length: larger ones come from pairs that have collapsed.
const LONGEST: f64 = 0.1;

impl<T: Real, const D: usize> Group<T, D> {
    /// Shifts particles with the sums of the last sweep for compression, over `dt` \[s\].
    pub fn shift(&mut self, dt: f64) {
        let Some(shifting) = self
            .scheme
            .liquid
            .as_ref()
            .and_then(|liquid| liquid.shifting)
        else {
            return;
        };
        let (rows, h, mobile) = (&self.scratch_rows, self.smoothing_length, self.mobile);
        let [x, residual, v, c] = self.columns.many_mut([
            Field::POSITION,
            Field::POSITION_RESIDUAL,
            Field::VELOCITY,
            Field::SOUND_SPEED,
        ]);
        let (v, c) = (&*v, &*c);
        let displacement = |slot: usize| -> [T; D] {
            let factor = match shifting {
                Shifting::Concentration {
                    strength,
                    free_surface,
                } => {
                    let v = &v[slot * D..(slot + 1) * D];
                    let speed = v.iter().fold(0.0, |s, v| s + v.to_f64().powi(2)).sqrt();
                    let moment = rows.get(Output::MOMENT, 0, slot).to_f64();
                    let inside = (moment - SURFACE[0]) / (SURFACE[1] - SURFACE[0]);
                    let share = if free_surface {
                        inside.clamp(0.0, 1.0)
                    } else {
                        1.0
                    };
                    (strength * h * speed * dt).min(STABLE * h * h) * share
                }
                // Σ (Vᵢ² + Vⱼ²) ∇W with nearly equal volumes, over the mass ρ V.
                Shifting::TransportVelocity { background } => {
                    let c = c[slot].to_f64();
                    background * c * c * dt * dt
                }
            };
            let longest = LONGEST * h;
            let sum: [f64; D] =
                core::array::from_fn(|d| rows.get(Output::CROWDING, d, slot).to_f64());
            let size = factor * sum.iter().fold(0.0, |s, g| s + g * g).sqrt();
            let factor = if size > longest {
                factor * longest / size
            } else {
                factor
            };
            sum.map(|g| T::from_f64(-factor * g))
        };
        if residual.is_empty() {
            x[..mobile * D]
                .par_chunks_mut(D)
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(slot, x)| {
                    let by = displacement(slot);
                    for d in 0..D {
                        x[d] += by[d];
                    }
                });
            return;
        }
        x[..mobile * D]
            .par_chunks_mut(D)
            .zip(residual.par_chunks_mut(D))
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, (x, residual))| {
                let by = displacement(slot);
                for d in 0..D {
                    (x[d], residual[d]) = two_sum(x[d], residual[d] + by[d]);
                }
            });
    }
}
