//! The operations that integrators compose: kicks, drifts, predictions, and combinations of states.
//! Each is a loop over particles; `f32` positions and densities keep their rounding error.

use super::Simulation;
use super::evaluate::GRAIN;
use super::ledger::Impulses;
use crate::error::Result;
use crate::integrator::System;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::{EnergyForm, Smoothing};
use crate::sweep::two_sum;
use rayon::prelude::*;

/// A kept state.
#[derive(Clone, Debug, Default)]
pub(super) struct Kept<T> {
    columns: Vec<Vec<T>>,
    impulses: Impulses,
}

/// What a state consists of, beside position and its rounding error.
const STATE: [Field; 7] = [
    Field::Position,
    Field::PositionResidual,
    Field::Velocity,
    Field::Density,
    Field::DensityResidual,
    Field::Energy,
    Field::SmoothingLength,
];

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Acceleration of the particle in `slot` by pair forces.
    #[inline(always)]
    fn pair_acceleration(&self, slot: usize) -> [T; D] {
        let mass = self.group.columns.raw(Field::Mass)[slot];
        self.group
            .rows
            .vector(Output::Force, slot)
            .map(|force| force / mass)
    }

    /// x ← x + dt v with v the present velocity.
    fn move_particles(&mut self, dt: f64) {
        let dt = T::from_f64(dt);
        let [x, residual, v] = self.group.columns.many_mut([
            Field::Position,
            Field::PositionResidual,
            Field::Velocity,
        ]);
        add_scaled(x, residual, v, dt);
    }

    /// Velocity kick without energy.
    fn kick_velocity(&mut self, dt: f64) {
        let gravity = self.body_acceleration();
        let dt = T::from_f64(dt);
        let rows = &self.group.rows;
        let [v, mass] = self.group.columns.many_mut([Field::Velocity, Field::Mass]);
        let mass = &*mass;
        v.par_chunks_mut(D)
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, v)| {
                for (d, v) in v.iter_mut().enumerate() {
                    *v += dt * (rows.get(Output::Force, d, slot) / mass[slot] + gravity[d]);
                }
            });
    }

    /// e ← e + dt P/m with P from `work` rows or from the rates.
    fn heat(&mut self, dt: f64, work: bool) {
        let dt = T::from_f64(dt);
        let rows = if work {
            &self.group.scratch_rows
        } else {
            &self.group.rows
        };
        let [energy, mass] = self.group.columns.many_mut([Field::Energy, Field::Mass]);
        let mass = &*mass;
        energy
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, energy)| {
                *energy += dt * rows.get(Output::Power, 0, slot) / mass[slot];
            });
    }

    fn carries_energy(&self) -> bool {
        self.group.scheme.energy != EnergyForm::None
    }

    /// Density and smoothing length over `dt` from the compression at hand.
    fn compress(&mut self, dt: f64) {
        let step = T::from_f64(dt);
        let group = &mut self.group;
        let integrated = group.scheme.density.is_integrated();
        let rows = &group.scratch_rows;
        let form = group.scheme.density;
        let [density, residual, moment, h] = group.columns.many_mut([
            Field::Density,
            Field::DensityResidual,
            Field::Normalisation,
            Field::SmoothingLength,
        ]);
        let dimension = T::from_f64(D as f64);
        let limits = match group.scheme.smoothing {
            Smoothing::Divergence { smallest, largest } => {
                let first = group.smoothing_length;
                Some((T::from_f64(smallest * first), T::from_f64(largest * first)))
            }
            _ => None,
        };
        let mut limited = 0;
        for slot in 0..density.len() {
            let moment = moment.get(slot).copied().unwrap_or(T::one());
            let sum = rows.get(Output::Compression, 0, slot);
            let rate = form.compression(sum, density[slot], moment);
            if let Some((low, high)) = limits {
                let next = h[slot] * (-rate * step / dimension).exp();
                let bounded = next.max(low).min(high);
                limited += u64::from(bounded != next);
                h[slot] = bounded;
            }
            if integrated {
                let change = density[slot] * expm1(rate * step);
                match residual.get_mut(slot) {
                    Some(residual) => {
                        (density[slot], *residual) = two_sum(density[slot], *residual + change);
                    }
                    None => density[slot] += change,
                }
            }
        }
        group.limited_h += limited;
    }
}

/// eˣ − 1 for the small x of a time step, without cancellation.
#[inline(always)]
fn expm1<T: Real>(x: T) -> T {
    if x.abs() > T::from_f64(0.01) {
        return x.exp() - T::one();
    }
    let term = |n: f64| T::from_f64(1.0 / n);
    x * (T::one() + x * (term(2.0) + x * (term(6.0) + x * (term(24.0) + x * term(120.0)))))
}

/// x ← x + dt v, with the rounding error kept where there is a column for it.
fn add_scaled<T: Real>(x: &mut [T], residual: &mut [T], v: &[T], dt: T) {
    if residual.is_empty() {
        x.par_iter_mut()
            .zip(v)
            .with_min_len(GRAIN)
            .for_each(|(x, v)| *x += dt * *v);
        return;
    }
    x.par_iter_mut()
        .zip(residual.par_iter_mut())
        .zip(v)
        .with_min_len(GRAIN)
        .for_each(|((x, residual), v)| {
            (*x, *residual) = two_sum(*x, *residual + dt * *v);
        });
}

impl<T: Real, const D: usize> System for Simulation<T, D> {
    fn evaluate(&mut self, offset: f64) -> Result<()> {
        self.evaluation_time = self.time + offset;
        self.group.evaluate(self.evaluation_time);
        self.evaluations += 1;
        self.rates_at_hand = true;
        // Here the sums stand in the same order as the particles.
        let elapsed = core::mem::take(&mut self.switch_due);
        if elapsed > 0.0 {
            self.group.follow_switch(elapsed);
        }
        Ok(())
    }

    fn kick(&mut self, dt: f64) {
        if self.group.scheme.energy == EnergyForm::Compatible {
            let half = T::from_f64(0.5 * dt);
            let gravity = self.body_acceleration();
            let rows = &self.group.rows;
            let [mean, v, mass] =
                self.group
                    .columns
                    .many_mut([Field::MeanVelocity, Field::Velocity, Field::Mass]);
            let (v, mass) = (&*v, &*mass);
            mean.par_chunks_mut(D)
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(slot, mean)| {
                    for d in 0..D {
                        let a = rows.get(Output::Force, d, slot) / mass[slot] + gravity[d];
                        mean[d] = v[slot * D + d] + half * a;
                    }
                });
            self.group.sum_work();
            self.heat(dt, true);
        } else if self.carries_energy() {
            self.heat(dt, false);
        }
        self.record_impulses(dt);
        self.kick_velocity(dt);
    }

    fn drift(&mut self, dt: f64, offset: f64) -> Result<()> {
        if self.group.scheme.compression.is_none() {
            self.move_particles(dt);
            return Ok(());
        }
        self.move_particles(0.5 * dt);
        self.group.refresh(self.time + offset + 0.5 * dt);
        self.group.sum_compression();
        self.compress(dt);
        self.move_particles(0.5 * dt);
        Ok(())
    }

    fn shift(&mut self, dv: f64, da: f64) {
        self.move_particles(dv);
        let gravity = self.body_acceleration();
        for slot in 0..self.group.columns.slots() {
            let pair = self.pair_acceleration(slot);
            let [x, residual] = self
                .group
                .columns
                .many_mut([Field::Position, Field::PositionResidual]);
            for d in 0..D {
                let change = T::from_f64(da) * (pair[d] + gravity[d]);
                let k = slot * D + d;
                match residual.get_mut(k) {
                    Some(residual) => (x[k], *residual) = two_sum(x[k], *residual + change),
                    None => x[k] += change,
                }
            }
        }
    }

    fn predict(&mut self, dt: f64) {
        let columns = &self.group.columns;
        self.predicted.columns.resize_with(2, Vec::new);
        for (kept, field) in self
            .predicted
            .columns
            .iter_mut()
            .zip([Field::Velocity, Field::Energy])
        {
            kept.clear();
            kept.extend_from_slice(columns.raw(field));
        }
        self.kick_velocity(dt);
        if self.carries_energy() {
            self.heat(dt, false);
        }
    }

    fn retract(&mut self) {
        for (kept, field) in self
            .predicted
            .columns
            .iter_mut()
            .zip([Field::Velocity, Field::Energy])
        {
            self.group.columns.raw_mut(field).copy_from_slice(kept);
        }
    }

    fn save(&mut self, slot: usize) {
        if self.kept.len() <= slot {
            self.kept.resize_with(slot + 1, Kept::default);
        }
        let kept = &mut self.kept[slot];
        kept.columns.resize_with(STATE.len(), Vec::new);
        for (kept, field) in kept.columns.iter_mut().zip(STATE) {
            kept.clear();
            kept.extend_from_slice(self.group.columns.raw(field));
        }
        kept.impulses = self.impulses.clone();
    }

    fn load(&mut self, slot: usize) {
        let Some(kept) = self.kept.get(slot) else {
            return;
        };
        for (kept, field) in kept.columns.iter().zip(STATE) {
            self.group.columns.raw_mut(field).copy_from_slice(kept);
        }
        self.impulses = kept.impulses.clone();
    }

    fn combine(&mut self, slot: usize, a: f64, b: f64, dt: f64) {
        let rates = self.rates();
        let Some(kept) = self.kept.get(slot) else {
            return;
        };
        let (a_t, b_t, dt_t) = (T::from_f64(a), T::from_f64(b), T::from_f64(dt));
        for ((field, kept), rate) in STATE.iter().zip(&kept.columns).zip(&rates.columns) {
            let column = self.group.columns.raw_mut(*field);
            for (k, (y, kept)) in column.iter_mut().zip(kept).enumerate() {
                let rate = rate.get(k).copied().unwrap_or(T::zero());
                *y = a_t * *kept + b_t * *y + dt_t * rate;
            }
        }
        self.impulses = kept
            .impulses
            .combine(a, &self.impulses, b, &rates.impulses, dt);
    }

    fn accumulate(&mut self, slot: usize, dt: f64) {
        let rates = self.rates();
        let Some(kept) = self.kept.get_mut(slot) else {
            return;
        };
        let dt_t = T::from_f64(dt);
        for (kept, rate) in kept.columns.iter_mut().zip(&rates.columns) {
            for (kept, rate) in kept.iter_mut().zip(rate) {
                *kept += dt_t * *rate;
            }
        }
        kept.impulses = kept
            .impulses
            .combine(1.0, &rates.impulses, dt, &rates.impulses, 0.0);
    }

    fn has_rates(&self) -> bool {
        self.rates_at_hand
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// dY/dt with the last rates, column by column as in `STATE`; an empty column has no rate.
    fn rates(&self) -> Kept<T> {
        let group = &self.group;
        let columns = &group.columns;
        let gravity = self.body_acceleration();
        let slots = columns.slots();
        let density = columns.raw(Field::Density);
        let moment = columns.raw(Field::Normalisation);
        let compression = |slot: usize| {
            let moment = moment.get(slot).copied().unwrap_or(T::one());
            let sum = group.rows.get(Output::Compression, 0, slot);
            group.scheme.density.compression(sum, density[slot], moment)
        };
        let rates = STATE.map(|field| match field {
            Field::Position => columns.raw(Field::Velocity).to_vec(),
            Field::Velocity => (0..slots)
                .flat_map(|slot| {
                    let pair = self.pair_acceleration(slot);
                    core::array::from_fn::<T, D, _>(|d| pair[d] + gravity[d])
                })
                .collect(),
            Field::Density if group.scheme.density.is_integrated() => (0..slots)
                .map(|slot| density[slot] * compression(slot))
                .collect(),
            Field::Energy if self.carries_energy() => (0..slots)
                .map(|slot| group.rows.get(Output::Power, 0, slot) / columns.raw(Field::Mass)[slot])
                .collect(),
            Field::SmoothingLength
                if matches!(group.scheme.smoothing, Smoothing::Divergence { .. }) =>
            {
                let h = columns.raw(Field::SmoothingLength);
                let d = T::from_f64(D as f64);
                (0..slots)
                    .map(|slot| -h[slot] * compression(slot) / d)
                    .collect()
            }
            _ => Vec::new(),
        });
        Kept {
            columns: rates.into(),
            impulses: self.impulse_rates(),
        }
    }
}
