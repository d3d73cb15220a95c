//! The operations that integrators compose: kicks, drifts, predictions, and combinations of states.
//! Each is a loop over particles; `f32` positions and densities keep their rounding error.

use super::Simulation;
use super::continuity::{Reference, rate};
use super::evaluate::GRAIN;
use super::ledger::Impulses;
use crate::error::Result;
use crate::integrator::System;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::{EnergyForm, Scheme, Smoothing};
use crate::sweep::two_sum;
use rayon::prelude::*;

/// A kept state.
#[derive(Clone, Debug, Default)]
pub(super) struct Kept<T> {
    columns: Vec<Vec<T>>,
    impulses: Impulses,
}

/// What a state consists of; the first two are positions.
const POSITION_FIELDS: usize = 2;
const STATE: [Field; 7] = [
    Field::Position,
    Field::PositionResidual,
    Field::Velocity,
    Field::Density,
    Field::DensityResidual,
    Field::Energy,
    Field::SmoothingLength,
];
/// Densities, and what their rounding has lost.
const DENSITIES: [Field; 2] = [Field::Density, Field::DensityResidual];

impl<T: Real, const D: usize> Simulation<T, D> {
    /// x ← x + dt v with v the present velocity.
    fn move_particles(&mut self, dt: f64) {
        let dt = T::from_f64(dt);
        let [x, residual, v] = self.group.columns.many_mut([
            Field::Position,
            Field::PositionResidual,
            Field::Velocity,
        ]);
        let mobile = self.group.mobile * D;
        let residual = residual.get_mut(..mobile).unwrap_or_default();
        add_scaled(&mut x[..mobile], residual, v, dt);
    }

    /// Velocity kick without energy.
    fn kick_velocity(&mut self, dt: f64) {
        let gravity = self.gravity;
        let dt = T::from_f64(dt);
        let (rows, mobile) = (&self.group.rows, self.group.mobile);
        let [v, mass] = self.group.columns.many_mut([Field::Velocity, Field::Mass]);
        let mass = &*mass;
        v[..mobile * D]
            .par_chunks_mut(D)
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
}

/// Whether a column of [`STATE`] is advanced in time, and does not follow from positions.
fn is_state<T: Real, const D: usize>(scheme: &Scheme<T, D>, field: Field) -> bool {
    match field {
        Field::Density | Field::DensityResidual => scheme.density.is_integrated(),
        Field::SmoothingLength => matches!(scheme.smoothing, Smoothing::Divergence { .. }),
        _ => true,
    }
}

/// What a kick changes, and a prediction takes back.
fn kicked<T: Real, const D: usize>(scheme: &Scheme<T, D>) -> &'static [Field] {
    const KICKED: [Field; 4] = [
        Field::Velocity,
        Field::Energy,
        Field::Density,
        Field::DensityResidual,
    ];
    &KICKED[..if scheme.kicks_density() { 4 } else { 2 }]
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
        let time = self.time + offset;
        self.evaluated = time;
        self.group.gravity = self.body_acceleration(time);
        self.gravity = self.group.gravity.map(T::from_f64);
        self.group.evaluate(time);
        if self.group.scheme.kicks_density() {
            self.group.keep_divergence();
        }
        self.follow_moves();
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
            let gravity = self.gravity;
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
        self.record_work(dt);
        self.kick_velocity(dt);
        if self.group.scheme.kicks_density() {
            self.compress(dt);
            self.hold_densities();
        }
    }

    fn drift(&mut self, dt: f64, offset: f64) -> Result<()> {
        if self.group.scheme.compression.is_none() {
            self.move_particles(dt);
            return Ok(());
        }
        self.group.predict_weights(0.5 * dt);
        self.move_particles(0.5 * dt);
        // Loads and walls at the middle of the drift, and walls go straight through it as particles do:
        // a tank that moves is then a tank at rest in a frame that does.
        let begin = self.time + offset;
        self.group.gravity = self.body_acceleration(begin + 0.5 * dt);
        self.group.chord = Some([begin, begin + dt]);
        self.group.refresh(begin + 0.5 * dt);
        self.group.chord = None;
        self.follow_moves();
        self.group.sum_compression();
        self.compress(dt);
        self.group.keep_divergence();
        self.hold_densities();
        self.group.shift(dt);
        self.move_particles(0.5 * dt);
        Ok(())
    }

    fn shift(&mut self, dv: f64, da: f64) {
        self.move_particles(dv);
        let gravity = self.gravity;
        let da = T::from_f64(da);
        let rows = &self.group.rows;
        let [x, residual, mass] =
            self.group
                .columns
                .many_mut([Field::Position, Field::PositionResidual, Field::Mass]);
        for slot in 0..self.group.mobile {
            for d in 0..D {
                let change = da * (rows.get(Output::Force, d, slot) / mass[slot] + gravity[d]);
                let k = slot * D + d;
                match residual.get_mut(k) {
                    Some(residual) => (x[k], *residual) = two_sum(x[k], *residual + change),
                    None => x[k] += change,
                }
            }
        }
    }

    fn predict(&mut self, dt: f64) {
        let kicked = kicked(&self.group.scheme);
        self.predicted.columns.resize_with(kicked.len(), Vec::new);
        for (kept, &field) in self.predicted.columns.iter_mut().zip(kicked) {
            let column = self.group.columns.raw(field);
            kept.resize(column.len(), T::zero());
            kept.par_chunks_mut(GRAIN)
                .zip(column.par_chunks(GRAIN))
                .for_each(|(kept, now)| kept.copy_from_slice(now));
        }
        self.kick_velocity(dt);
        if self.carries_energy() {
            self.heat(dt, false);
        }
        if self.group.scheme.kicks_density() {
            self.compress(dt);
        }
    }

    fn retract(&mut self) {
        let kicked = kicked(&self.group.scheme);
        for (kept, &field) in self.predicted.columns.iter_mut().zip(kicked) {
            core::mem::swap(self.group.columns.column_mut(field), kept);
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
            if is_state(&self.group.scheme, field) {
                kept.extend_from_slice(self.group.columns.raw(field));
            }
        }
        kept.impulses.clone_from(&self.impulses);
    }

    fn load(&mut self, slot: usize) {
        let Some(kept) = self.kept.get(slot) else {
            return;
        };
        for (kept, field) in kept.columns.iter().zip(STATE) {
            if is_state(&self.group.scheme, field) {
                self.group.columns.raw_mut(field).copy_from_slice(kept);
            }
        }
        self.impulses.clone_from(&kept.impulses);
    }

    fn combine(&mut self, slot: usize, a: f64, b: f64, dt: f64) {
        let rates = self.impulse_rates();
        let Some(kept) = self.kept.get_mut(slot).map(core::mem::take) else {
            return;
        };
        let (a_t, b_t, dt_t) = (T::from_f64(a), T::from_f64(b), T::from_f64(dt));
        self.combine_positions(&kept, a, b, dt);
        let compensated = self.combine_densities(&kept, a, b, dt);
        for (field, kept) in STATE.into_iter().zip(&kept.columns).skip(POSITION_FIELDS) {
            if compensated && DENSITIES.contains(&field) {
                continue;
            }
            let mut column = core::mem::take(self.group.columns.column_mut(field));
            column
                .par_iter_mut()
                .zip(kept)
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(k, (y, kept))| {
                    *y = a_t * *kept + b_t * *y + dt_t * self.rate_of(field, k, *y);
                });
            *self.group.columns.column_mut(field) = column;
        }
        self.impulses = kept.impulses.combine(a, &self.impulses, b, &rates, dt);
        self.kept[slot] = kept;
    }

    fn accumulate(&mut self, slot: usize, dt: f64) {
        let rates = self.impulse_rates();
        let Some(mut kept) = self.kept.get_mut(slot).map(core::mem::take) else {
            return;
        };
        let dt_t = T::from_f64(dt);
        let [position, residual, others @ ..] = kept.columns.as_mut_slice() else {
            return;
        };
        add_scaled(
            position,
            residual,
            self.group.columns.raw(Field::Velocity),
            dt_t,
        );
        let mut compensated = false;
        if let [_, density, lost, ..] = &mut *others {
            compensated = !lost.is_empty();
            let now = self.group.columns.raw(Field::Density);
            density
                .par_iter_mut()
                .zip(lost.par_iter_mut())
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(k, (kept, lost))| {
                    let change = dt_t * self.rate_of(Field::Density, k, now[k]);
                    (*kept, *lost) = two_sum(*kept, *lost + change);
                });
        }
        for (field, kept) in STATE.into_iter().skip(POSITION_FIELDS).zip(others) {
            if compensated && DENSITIES.contains(&field) {
                continue;
            }
            let now = self.group.columns.raw(field);
            kept.par_iter_mut()
                .zip(now)
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(k, (kept, now))| *kept += dt_t * self.rate_of(field, k, *now));
        }
        kept.impulses = kept.impulses.combine(1.0, &rates, dt, &rates, 0.0);
        self.kept[slot] = kept;
    }

    fn has_rates(&self) -> bool {
        self.rates_at_hand
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Brings kept states into the order of the particles after a list build, and through the
    /// periods that particles have crossed.
    fn follow_moves(&mut self) {
        let moved = &mut self.group.moved;
        if moved.wraps.is_empty() && moved.order.is_empty() {
            return;
        }
        for kept in &mut self.kept {
            let Ok([x, residual, v]) = kept.columns.get_disjoint_mut([0, 1, 2]) else {
                continue;
            };
            if !x.is_empty() {
                for (slot, back) in &moved.wraps {
                    back.re_enter(*slot as usize, x, residual, v);
                }
            }
        }
        if let Some(v) = self.predicted.columns.first_mut().filter(|v| !v.is_empty()) {
            for (slot, back) in &moved.wraps {
                back.turn(*slot as usize, v);
            }
        }
        if !moved.order.is_empty() {
            let columns = self.kept.iter_mut().flat_map(|kept| &mut kept.columns);
            for column in columns.chain(&mut self.predicted.columns) {
                let width = column.len() / moved.order.len();
                let before = column.clone();
                for (k, &from) in moved.order.iter().enumerate() {
                    let from = from as usize * width;
                    column[k * width..(k + 1) * width].copy_from_slice(&before[from..from + width]);
                }
            }
        }
        moved.wraps.clear();
        moved.order.clear();
    }

    /// Rate of entry `k` of a column of the state, whose present value is `y`.
    #[inline(always)]
    fn rate_of(&self, field: Field, k: usize, y: T) -> T {
        let group = &self.group;
        // The rates were summed with the weights of the force.
        let form = group.scheme.pressure_form;
        let [rest, moment] =
            [Field::ReferenceDensity, Field::Normalisation].map(|f| group.columns.raw(f));
        let lattice = T::from_f64(group.scheme.lattice_moment);
        let rest: Reference<'_, T> = (rest, moment, lattice);
        match field {
            Field::Velocity => {
                let (slot, d) = (k / D, k % D);
                let mass = group.columns.raw(Field::Mass)[slot];
                group.rows.get(Output::Force, d, slot) / mass + self.gravity[d]
            }
            Field::Density if group.scheme.density.is_integrated() => {
                let diffusion = group.rows.get(Output::DensityDiffusion, 0, k);
                y * rate(form, &group.rows, rest, k, y) + diffusion
            }
            Field::Energy => {
                group.rows.get(Output::Power, 0, k) / group.columns.raw(Field::Mass)[k]
            }
            Field::SmoothingLength
                if matches!(group.scheme.smoothing, Smoothing::Divergence { .. }) =>
            {
                let density = group.columns.raw(Field::Density)[k];
                -y * rate(form, &group.rows, rest, k, density) / T::from_f64(D as f64)
            }
            _ => T::zero(),
        }
    }

    /// Densities and what their rounding has lost, in `f64`; whether they are integrated and keep it.
    fn combine_densities(&mut self, kept: &Kept<T>, a: f64, b: f64, dt: f64) -> bool {
        let [_, _, _, before, lost, ..] = kept.columns.as_slice() else {
            return false;
        };
        if lost.is_empty() {
            return false;
        }
        let [mut density, mut residual] =
            DENSITIES.map(|field| core::mem::take(self.group.columns.column_mut(field)));
        density
            .par_iter_mut()
            .zip(residual.par_iter_mut())
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(k, (y, residual))| {
                let rate = self.rate_of(Field::Density, k, *y).to_f64();
                let sum = a * (before[k].to_f64() + lost[k].to_f64())
                    + b * (y.to_f64() + residual.to_f64())
                    + dt * rate;
                *y = T::from_f64(sum);
                *residual = T::from_f64(sum - y.to_f64());
            });
        for (field, column) in DENSITIES.into_iter().zip([density, residual]) {
            *self.group.columns.column_mut(field) = column;
        }
        true
    }

    /// Positions and what their rounding has lost, in `f64` where the scalar keeps the loss.
    fn combine_positions(&mut self, kept: &Kept<T>, a: f64, b: f64, dt: f64) {
        let [x, residual, v] = self.group.columns.many_mut([
            Field::Position,
            Field::PositionResidual,
            Field::Velocity,
        ]);
        let (before, lost, v) = (&kept.columns[0], &kept.columns[1], &*v);
        if residual.is_empty() {
            let (a, b, dt) = (T::from_f64(a), T::from_f64(b), T::from_f64(dt));
            x.par_iter_mut()
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(k, x)| {
                    *x = a * before[k] + b * *x + dt * v[k];
                });
            return;
        }
        x.par_iter_mut()
            .zip(residual.par_iter_mut())
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(k, (x, residual))| {
                let sum = a * (before[k].to_f64() + lost[k].to_f64())
                    + b * (x.to_f64() + residual.to_f64())
                    + dt * v[k].to_f64();
                *x = T::from_f64(sum);
                *residual = T::from_f64(sum - x.to_f64());
            });
    }
}
