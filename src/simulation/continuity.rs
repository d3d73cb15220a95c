//! Continuity: what the rate of compression does to densities and smoothing lengths in a drift or kick.
//! Densities of torn liquid are held, and `f32` keeps their rounding error.

use super::evaluate::GRAIN;
use super::group::Group;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::{DensityForm, Scheme, Smoothing};
use crate::sweep::{Rows, two_sum};
use rayon::prelude::*;

impl<T: Real, const D: usize> Group<T, D> {
    /// Density and smoothing length over `dt` from the compression at hand: of the sweep for it, or of the rates.
    pub(super) fn compress(&mut self, dt: f64) {
        let dt = T::from_f64(dt);
        self.follow_divergence(dt);
        if !self.scheme.density.is_integrated() {
            return;
        }
        let form = self.scheme.density;
        let lattice = T::from_f64(self.scheme.lattice_moment);
        let rows = compression_sums(&self.scheme, &self.rows, &self.scratch_rows);
        let mobile = self.mobile;
        let consistency =
            (self.scheme.liquid.as_ref()).and_then(|liquid| liquid.volume_consistency);
        let h = self.smoothing_length;
        let [density, residual, rest, moment, sound_speed] = self.columns.many_mut([
            Field::DENSITY,
            Field::DENSITY_RESIDUAL,
            Field::REFERENCE_DENSITY,
            Field::NORMALISATION,
            Field::SOUND_SPEED,
        ]);
        let rest: Reference<'_, T> = (rest, moment, lattice);
        let sound_speed = &*sound_speed;
        let overlap = |slot: usize| {
            consistency.map_or(T::zero(), |(strength, unity)| {
                let excess = rows.get(Output::UNITY, 0, slot) / T::from_f64(unity) - T::one();
                T::from_f64(strength / h) * sound_speed[slot] * excess
            })
        };
        let change = |slot: usize, density: T| {
            let rate = rate(form, rows, rest, slot, density) + overlap(slot);
            density * expm1(rate * dt) + dt * rows.get(Output::DENSITY_DIFFUSION, 0, slot)
        };
        let density = &mut density[..mobile];
        if residual.is_empty() {
            density
                .par_iter_mut()
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(slot, density)| {
                    *density += change(slot, *density);
                });
            return;
        }
        density
            .par_iter_mut()
            .zip(residual.par_iter_mut())
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, (density, residual))| {
                (*density, *residual) = two_sum(*density, *residual + change(slot, *density));
            });
    }

    /// Keeps a liquid that has torn at its [cut-off](crate::material::Material::with_pressure_cut_off) from
    /// thinning out: spray is still water, and volumes m/ρ weigh its forces. Where tearing is reversible, how
    /// far it would have thinned is kept beside.
    pub(super) fn hold_densities(&mut self) {
        let Some(liquid) = &self.scheme.liquid else {
            return;
        };
        let share = if liquid.reversible_tearing { 1.0 } else { TORN };
        let [density, residual, tear] =
            self.columns
                .many_mut([Field::DENSITY, Field::DENSITY_RESIDUAL, Field::TEAR]);
        let mut held = 0;
        for body in &self.bodies {
            let eos = body.material.eos();
            let torn = eos
                .pressure_cut_off()
                .and_then(|pressure| eos.density_at(pressure, 0.0));
            let Some(torn) = torn else {
                continue;
            };
            let least = T::from_f64(share * torn);
            let run = body.slots.clone();
            let hold = |density: &mut T, tear: &mut T| {
                if *tear < T::zero() {
                    *density *= tear.exp();
                }
                // What is no number stays one, and ends the run.
                let low = *density < least;
                *tear = T::zero();
                if low {
                    let thinned = (*density / least).to_f64().ln();
                    *tear = T::from_f64(thinned.max(FARTHEST));
                    *density = least;
                }
                usize::from(low)
            };
            let own = density[run.clone()].par_iter_mut().with_min_len(GRAIN);
            held += match tear.get_mut(run.clone()) {
                Some(tear) => own.zip(tear).map(|(own, tear)| hold(own, tear)).sum(),
                None => own.map(|own| hold(own, &mut T::zero())).sum::<usize>(),
            };
            // What rounding has left belongs to the density that was.
            if let Some(residual) = residual.get_mut(run.clone()) {
                residual
                    .par_iter_mut()
                    .zip(&density[run])
                    .with_min_len(GRAIN)
                    .for_each(|(residual, density)| {
                        if *density == least {
                            *residual = T::zero();
                        }
                    });
            }
        }
        self.held_densities += held as u64;
    }

    /// dh/dt = h ∇·v / D within limits, over `dt`.
    fn follow_divergence(&mut self, dt: T) {
        let Smoothing::Divergence { smallest, largest } = self.scheme.smoothing else {
            return;
        };
        let low = T::from_f64(smallest * self.smoothing_length);
        let high = T::from_f64(largest * self.smoothing_length);
        let dimension = T::from_f64(D as f64);
        let form = self.scheme.density;
        let lattice = T::from_f64(self.scheme.lattice_moment);
        let (rows, mobile) = (&self.scratch_rows, self.mobile);
        let [h, density, rest, moment] = self.columns.many_mut([
            Field::SMOOTHING_LENGTH,
            Field::DENSITY,
            Field::REFERENCE_DENSITY,
            Field::NORMALISATION,
        ]);
        let density = &*density;
        let rest: Reference<'_, T> = (rest, moment, lattice);
        let limited: usize = h[..mobile]
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .map(|(slot, h)| {
                let divergence = -rate(form, rows, rest, slot, density[slot]);
                let next = *h * (divergence * dt / dimension).exp();
                *h = next.max(low).min(high);
                usize::from(*h != next)
            })
            .sum();
        self.limited_h += limited as u64;
    }
}

/// Share of the density at which a liquid tears that it keeps however far it is torn. Spray otherwise
/// fell to a fifth of it, struck walls with five times its volume, and its diffusion made densities
/// negative; at nine tenths volumes are at most a ninth too large, and what was drawn apart a little
/// still closes without pressure.
const TORN: f64 = 0.9;

/// Farthest that torn liquid is torn, as the logarithm of what its density would be: that of a particle
/// which has lost all of its neighbourhood, Σ V W = 1.
const FARTHEST: f64 = -1.0;

/// Where the compression is summed: with the rates in a step of one evaluation, or in a sweep of its own.
pub(super) fn compression_sums<'a, T: Real, const D: usize>(
    scheme: &Scheme<T, D>,
    rates: &'a Rows<T, D>,
    own: &'a Rows<T, D>,
) -> &'a Rows<T, D> {
    if scheme.kicks_density() { rates } else { own }
}

/// Rate of compression (1/ρ) dρ/dt of a particle from its sum over neighbours.
#[inline(always)]
pub(super) fn rate<T: Real, const D: usize>(
    form: DensityForm,
    rows: &Rows<T, D>,
    (rest, moment, lattice): Reference<'_, T>,
    slot: usize,
    density: T,
) -> T {
    let sum = rows.get(Output::COMPRESSION, 0, slot);
    let rest = rest.get(slot).copied().unwrap_or(T::one());
    let moment = moment.get(slot).copied().unwrap_or(lattice);
    form.compression(sum, density, rest, moment)
}

/// Densities and first moments at rest, and the moment of those that do not carry their own.
pub(super) type Reference<'a, T> = (&'a [T], &'a [T], T);

/// eˣ − 1 for the small x of a time step, without cancellation.
#[inline(always)]
fn expm1<T: Real>(x: T) -> T {
    if x.abs() > T::from_f64(0.01) {
        return x.exp() - T::one();
    }
    let term = |n: f64| T::from_f64(1.0 / n);
    x * (T::one() + x * (term(2.0) + x * (term(6.0) + x * (term(24.0) + x * term(120.0)))))
}
