//! What integrators do to the state of a group: move, kick, predict, keep and combine it.
//! Each is a loop over particles; `f32` positions and densities keep their rounding error.

use super::continuity::{Reference, rate};
use super::evaluate::GRAIN;
use super::group::Group;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::{EnergyForm, Scheme, Smoothing};
use crate::sweep::two_sum;
use crate::tensor::Vector;
use rayon::prelude::*;

/// Columns of a kept state.
pub(super) type Kept<T> = Vec<Vec<T>>;

/// What a state consists of; the first two are positions.
const POSITION_FIELDS: usize = 2;
const STATE: [Field; 7] = [
    Field::POSITION,
    Field::POSITION_RESIDUAL,
    Field::VELOCITY,
    Field::DENSITY,
    Field::DENSITY_RESIDUAL,
    Field::ENERGY,
    Field::SMOOTHING_LENGTH,
];
/// Densities, and what their rounding has lost.
const DENSITIES: [Field; 2] = [Field::DENSITY, Field::DENSITY_RESIDUAL];

impl<T: Real, const D: usize> Group<T, D> {
    /// x ← x + dt v with v the present velocity.
    pub(super) fn move_particles(&mut self, dt: f64) {
        let dt = T::from_f64(dt);
        let [x, residual, v] =
            self.columns
                .many_mut([Field::POSITION, Field::POSITION_RESIDUAL, Field::VELOCITY]);
        let mobile = self.mobile * D;
        let residual = residual.get_mut(..mobile).unwrap_or_default();
        add_scaled(&mut x[..mobile], residual, v, dt);
    }

    /// x ← x + da a with the accelerations of the last evaluation.
    pub(super) fn move_by_rates(&mut self, da: f64) {
        let gravity = self.evaluated_gravity;
        let da = T::from_f64(da);
        let rows = &self.rows;
        let [x, residual, mass] =
            self.columns
                .many_mut([Field::POSITION, Field::POSITION_RESIDUAL, Field::MASS]);
        for slot in 0..self.mobile {
            for d in 0..D {
                let change = da * (rows.get(Output::FORCE, d, slot) / mass[slot] + gravity[d]);
                let k = slot * D + d;
                match residual.get_mut(k) {
                    Some(residual) => (x[k], *residual) = two_sum(x[k], *residual + change),
                    None => x[k] += change,
                }
            }
        }
    }

    /// What pair forces work during a kick over `dt`, into internal energy.
    pub(super) fn heat_in_kick(&mut self, dt: f64) {
        if self.scheme.energy != EnergyForm::Compatible {
            if self.carries_energy() {
                self.heat(dt, false);
            }
            return;
        }
        let half = T::from_f64(0.5 * dt);
        let gravity = self.evaluated_gravity;
        let rows = &self.rows;
        let [mean, v, mass] =
            self.columns
                .many_mut([Field::MEAN_VELOCITY, Field::VELOCITY, Field::MASS]);
        let (v, mass) = (&*v, &*mass);
        mean.par_chunks_mut(D)
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, mean)| {
                for d in 0..D {
                    let a = rows.get(Output::FORCE, d, slot) / mass[slot] + gravity[d];
                    mean[d] = v[slot * D + d] + half * a;
                }
            });
        self.sum_work();
        self.heat(dt, true);
    }

    /// v ← v + dt a, and the density where it is kicked, but no energy.
    pub(super) fn kick(&mut self, dt: f64) {
        let gravity = self.evaluated_gravity;
        let step = T::from_f64(dt);
        let (rows, mobile) = (&self.rows, self.mobile);
        let [v, mass] = self.columns.many_mut([Field::VELOCITY, Field::MASS]);
        let mass = &*mass;
        v[..mobile * D]
            .par_chunks_mut(D)
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, v)| {
                for (d, v) in v.iter_mut().enumerate() {
                    *v += step * (rows.get(Output::FORCE, d, slot) / mass[slot] + gravity[d]);
                }
            });
        if self.scheme.kicks_density() {
            self.compress(dt);
        }
    }

    /// e ← e + dt P/m with P from `work` rows or from the rates.
    fn heat(&mut self, dt: f64, work: bool) {
        let dt = T::from_f64(dt);
        let rows = if work { &self.scratch_rows } else { &self.rows };
        let [energy, mass] = self.columns.many_mut([Field::ENERGY, Field::MASS]);
        let mass = &*mass;
        energy
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, energy)| {
                *energy += dt * rows.get(Output::POWER, 0, slot) / mass[slot];
            });
    }

    fn carries_energy(&self) -> bool {
        self.scheme.energy != EnergyForm::None
    }

    /// Sets what a kick changes `dt` \[s\] ahead with the last rates.
    pub(super) fn predict(&mut self, dt: f64) {
        let kicked = kicked(&self.scheme);
        self.predicted.resize_with(kicked.len(), Vec::new);
        for (kept, &field) in self.predicted.iter_mut().zip(kicked) {
            let column = self.columns.raw(field);
            kept.resize(column.len(), T::zero());
            kept.par_chunks_mut(GRAIN)
                .zip(column.par_chunks(GRAIN))
                .for_each(|(kept, now)| kept.copy_from_slice(now));
        }
        self.kick(dt);
        if self.carries_energy() {
            self.heat(dt, false);
        }
    }

    /// Takes the last prediction back.
    pub(super) fn retract(&mut self) {
        let kicked = kicked(&self.scheme);
        for (kept, &field) in self.predicted.iter_mut().zip(kicked) {
            core::mem::swap(self.columns.column_mut(field), kept);
        }
    }

    /// Keeps the present state in a slot.
    pub(super) fn save(&mut self, slot: usize) {
        if self.kept.len() <= slot {
            self.kept.resize_with(slot + 1, Kept::default);
        }
        let kept = &mut self.kept[slot];
        kept.resize_with(STATE.len(), Vec::new);
        for (kept, field) in kept.iter_mut().zip(STATE) {
            kept.clear();
            if is_state(&self.scheme, field) {
                kept.extend_from_slice(self.columns.raw(field));
            }
        }
    }

    /// Brings a kept state back.
    pub(super) fn load(&mut self, slot: usize) {
        let Some(kept) = self.kept.get(slot) else {
            return;
        };
        for (kept, field) in kept.iter().zip(STATE) {
            if is_state(&self.scheme, field) {
                self.columns.raw_mut(field).copy_from_slice(kept);
            }
        }
    }

    /// Y ← a · kept + b · Y + dt · dY/dt.
    pub(super) fn combine(&mut self, slot: usize, a: f64, b: f64, dt: f64) {
        let Some(kept) = self.kept.get_mut(slot).map(core::mem::take) else {
            return;
        };
        let (a_t, b_t, dt_t) = (T::from_f64(a), T::from_f64(b), T::from_f64(dt));
        self.combine_positions(&kept, a, b, dt);
        let compensated = self.combine_densities(&kept, a, b, dt);
        for (field, kept) in STATE.into_iter().zip(&kept).skip(POSITION_FIELDS) {
            if compensated && DENSITIES.contains(&field) {
                continue;
            }
            let mut column = core::mem::take(self.columns.column_mut(field));
            column
                .par_iter_mut()
                .zip(kept)
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(k, (y, kept))| {
                    *y = a_t * *kept + b_t * *y + dt_t * self.rate_of(field, k, *y);
                });
            *self.columns.column_mut(field) = column;
        }
        self.kept[slot] = kept;
    }

    /// kept ← kept + dt · dY/dt.
    pub(super) fn accumulate(&mut self, slot: usize, dt: f64) {
        let Some(mut kept) = self.kept.get_mut(slot).map(core::mem::take) else {
            return;
        };
        let dt_t = T::from_f64(dt);
        let [position, residual, others @ ..] = kept.as_mut_slice() else {
            return;
        };
        add_scaled(position, residual, self.columns.raw(Field::VELOCITY), dt_t);
        let mut compensated = false;
        if let [_, density, lost, ..] = &mut *others {
            compensated = !lost.is_empty();
            let now = self.columns.raw(Field::DENSITY);
            density
                .par_iter_mut()
                .zip(lost.par_iter_mut())
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(k, (kept, lost))| {
                    let change = dt_t * self.rate_of(Field::DENSITY, k, now[k]);
                    (*kept, *lost) = two_sum(*kept, *lost + change);
                });
        }
        for (field, kept) in STATE.into_iter().skip(POSITION_FIELDS).zip(others) {
            if compensated && DENSITIES.contains(&field) {
                continue;
            }
            let now = self.columns.raw(field);
            kept.par_iter_mut()
                .zip(now)
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(k, (kept, now))| *kept += dt_t * self.rate_of(field, k, *now));
        }
        self.kept[slot] = kept;
    }

    /// Brings kept states into the order of the particles after a list build, and through the boundaries that
    /// particles have crossed. Gives what these gave: the number of a kept state, or none for the present one,
    /// which felt, which exerted, and the momentum \[kg m/s\].
    pub(super) fn follow_moves(&mut self) -> Vec<(Option<usize>, [usize; 2], [f64; D])> {
        let moved = &mut self.moved;
        let mut given = Vec::new();
        let at = |v: &[T], slot: usize| Vector::from_row_slice(&v[slot * D..(slot + 1) * D]);
        for (number, kept) in self.kept.iter_mut().enumerate() {
            let Ok([x, residual, v]) = kept.get_disjoint_mut([0, 1, 2]) else {
                continue;
            };
            if !x.is_empty() {
                for entry in &moved.wraps {
                    let impulse = entry.impulse(&at(v, entry.slot));
                    given.extend(entry.seats.map(|seats| (Some(number), seats, impulse)));
                    entry.through.re_enter(entry.slot, x, residual, v);
                }
            }
        }
        // A prediction is taken back: what it started from is the present state.
        let mut start = self.predicted.first_mut().filter(|v| !v.is_empty());
        for entry in &moved.wraps {
            let velocity = start.as_ref().map_or(entry.velocity, |v| at(v, entry.slot));
            let impulse = entry.impulse(&velocity);
            given.extend(entry.seats.map(|seats| (None, seats, impulse)));
            if let Some(v) = &mut start {
                entry.through.turn(entry.slot, v);
            }
        }
        if !moved.order.is_empty() {
            let columns = self.kept.iter_mut().flatten();
            for column in columns.chain(&mut self.predicted) {
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
        given
    }

    /// Rate of entry `k` of a column of the state, whose present value is `y`.
    #[inline(always)]
    fn rate_of(&self, field: Field, k: usize, y: T) -> T {
        // The rates were summed with the weights of the force.
        let form = self.scheme.pressure_form;
        let [rest, moment] =
            [Field::REFERENCE_DENSITY, Field::NORMALISATION].map(|f| self.columns.raw(f));
        let lattice = T::from_f64(self.scheme.lattice_moment);
        let rest: Reference<'_, T> = (rest, moment, lattice);
        match field {
            Field::VELOCITY => {
                let (slot, d) = (k / D, k % D);
                let mass = self.columns.raw(Field::MASS)[slot];
                self.rows.get(Output::FORCE, d, slot) / mass + self.evaluated_gravity[d]
            }
            Field::DENSITY if self.scheme.density.is_integrated() => {
                let diffusion = self.rows.get(Output::DENSITY_DIFFUSION, 0, k);
                y * rate(form, &self.rows, rest, k, y) + diffusion
            }
            Field::ENERGY => self.rows.get(Output::POWER, 0, k) / self.columns.raw(Field::MASS)[k],
            Field::SMOOTHING_LENGTH
                if matches!(self.scheme.smoothing, Smoothing::Divergence { .. }) =>
            {
                let density = self.columns.raw(Field::DENSITY)[k];
                -y * rate(form, &self.rows, rest, k, density) / T::from_f64(D as f64)
            }
            _ => T::zero(),
        }
    }

    /// Densities and what their rounding has lost, in `f64`; whether they are integrated and keep it.
    fn combine_densities(&mut self, kept: &[Vec<T>], a: f64, b: f64, dt: f64) -> bool {
        let [_, _, _, before, lost, ..] = kept else {
            return false;
        };
        if lost.is_empty() {
            return false;
        }
        let [mut density, mut residual] =
            DENSITIES.map(|field| core::mem::take(self.columns.column_mut(field)));
        density
            .par_iter_mut()
            .zip(residual.par_iter_mut())
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(k, (y, residual))| {
                let rate = self.rate_of(Field::DENSITY, k, *y).to_f64();
                let sum = a * (before[k].to_f64() + lost[k].to_f64())
                    + b * (y.to_f64() + residual.to_f64())
                    + dt * rate;
                *y = T::from_f64(sum);
                *residual = T::from_f64(sum - y.to_f64());
            });
        for (field, column) in DENSITIES.into_iter().zip([density, residual]) {
            *self.columns.column_mut(field) = column;
        }
        true
    }

    /// Positions and what their rounding has lost, in `f64` where the scalar keeps the loss.
    fn combine_positions(&mut self, kept: &[Vec<T>], a: f64, b: f64, dt: f64) {
        let [x, residual, v] =
            self.columns
                .many_mut([Field::POSITION, Field::POSITION_RESIDUAL, Field::VELOCITY]);
        let (before, lost, v) = (&kept[0], &kept[1], &*v);
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

/// Whether a column of [`STATE`] is advanced in time, and does not follow from positions.
fn is_state<T: Real, const D: usize>(scheme: &Scheme<T, D>, field: Field) -> bool {
    match field {
        Field::DENSITY | Field::DENSITY_RESIDUAL => scheme.density.is_integrated(),
        Field::SMOOTHING_LENGTH => matches!(scheme.smoothing, Smoothing::Divergence { .. }),
        _ => true,
    }
}

/// What a kick changes, and a prediction takes back.
fn kicked<T: Real, const D: usize>(scheme: &Scheme<T, D>) -> &'static [Field] {
    const KICKED: [Field; 4] = [
        Field::VELOCITY,
        Field::ENERGY,
        Field::DENSITY,
        Field::DENSITY_RESIDUAL,
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
