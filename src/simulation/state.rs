//! What integrators do to the state of a group: move, kick, predict, save and combine it.
//! Position, velocity and energy are the driver's own; other evolved fields say how they change.

use super::evolve::{POSITIONS, RATES, add_scaled, combine_positions, rates, state, update};
use super::group::Group;
use super::loads::heat_by_sources;
use super::population::BodyState;
use super::stages::Moment;
use super::workspace::Saved;
use crate::collective::over_pieces;
use crate::effect::{Around, Evolved, View, When};
use crate::parallel::{GRAIN, cut, for_each, runs};
use crate::particles::{Field, Output};
use crate::scalar::{MOST_LANES, Real};
use crate::scheme::EnergyForm;
use crate::sweep::{Results, add_compensated};
use std::ops::Range;

impl<T: Real, const D: usize> Group<T, D> {
    /// x ← x + dt v with v the present velocity, where particles move.
    pub(super) fn move_particles(&mut self, dt: f64) {
        if !self.scheme.program.moves {
            return;
        }
        let dt = T::from_f64(dt);
        let mobile = self.particles.mobile * D;
        let [x, residual, v] = self.particles.columns.many_mut([
            Field::POSITION,
            Field::POSITION_RESIDUAL,
            Field::VELOCITY,
        ]);
        let residual = residual.get_mut(..mobile).unwrap_or_default();
        add_scaled(&mut x[..mobile], residual, v, dt);
        self.held.move_rigid(&mut self.particles, dt.to_f64());
    }

    /// x ← x + da a with the accelerations of the last evaluation.
    pub(super) fn move_by_rates(&mut self, da: f64) {
        if !self.scheme.program.moves {
            return;
        }
        let gravity = self.work.evaluated_gravity;
        let da = T::from_f64(da);
        let rates = &self.work.rates;
        let [x, residual, mass] = self.particles.columns.many_mut([
            Field::POSITION,
            Field::POSITION_RESIDUAL,
            Field::MASS,
        ]);
        for slot in 0..self.particles.mobile {
            for d in 0..D {
                let change = da * (rates.get(Output::FORCE, d, slot) / mass[slot] + gravity[d]);
                let k = slot * D + d;
                add_compensated(&mut x[k], residual.get_mut(k), change);
            }
        }
    }

    /// What pair forces work during a kick over `dt`, into internal energy.
    pub(super) fn heat_in_kick(&mut self, dt: f64) {
        if self.scheme.energy != EnergyForm::Compatible {
            if self.carries_energy() {
                self.heat(dt, None);
            }
            return;
        }
        if !self.scheme.sweeps_work() {
            self.heat_by_own_forces(dt);
            self.heat_by_sources(dt);
            return;
        }
        // Every evaluation serves two kicks, the second of which may take its work from the first.
        let first = self.work.first_kick.take();
        let later = first.and_then(|first| self.later(first, 0.5 * dt));
        if later.is_none() {
            self.set_mean_velocities(0.5 * dt);
            self.sum_work();
            self.work.first_kick = Some([0.5 * dt, self.neighborhood.placed_time]);
        }
        self.heat(dt, Some(later.unwrap_or(0.0)));
        self.heat_by_sources(dt);
    }

    /// The mean velocities v + a dt/2 and accelerations of a kick of which this is `half` the time \[s\].
    fn set_mean_velocities(&mut self, half: f64) {
        let half = T::from_f64(half);
        let gravity = self.work.evaluated_gravity;
        let rates = &self.work.rates;
        let [mean, acceleration, v, mass] = self.particles.columns.many_mut([
            Field::MEAN_VELOCITY,
            Field::MEAN_ACCELERATION,
            Field::VELOCITY,
            Field::MASS,
        ]);
        let (v, mass) = (&*v, &*mass);
        let pieces = (cut(mean, GRAIN * D), cut(acceleration, GRAIN * D));
        for_each(pieces, |piece, (mean, acceleration)| {
            let own = mean
                .chunks_exact_mut(D)
                .zip(acceleration.chunks_exact_mut(D));
            for (n, (mean, acceleration)) in own.enumerate() {
                let slot = piece * GRAIN + n;
                for d in 0..D {
                    let a = rates.get(Output::FORCE, d, slot) / mass[slot] + gravity[d];
                    mean[d] = v[slot * D + d] + half * a;
                    acceleration[d] = a;
                }
            }
        });
    }

    /// The time τ \[s\] after which the mean velocities of a kick of which `half` is half the time are those of the first
    /// kick with the same forces and τ times its accelerations: to rounding, or there is none. Whatever has changed
    /// velocities or forces but the first kick itself takes a sum of its own. Ahead of a front numbers fall below the
    /// smallest of full precision, where rounding is no part of the number any more.
    fn later(&mut self, [first, placed]: [f64; 2], half: f64) -> Option<f64> {
        if placed != self.neighborhood.placed_time {
            return None;
        }
        let after = first + half;
        let (half, tau) = (T::from_f64(half), T::from_f64(after));
        let gravity = self.work.evaluated_gravity;
        let rates = &self.work.rates;
        let columns = &self.particles.columns;
        let [mean, accelerations, v] = [
            Field::MEAN_VELOCITY,
            Field::MEAN_ACCELERATION,
            Field::VELOCITY,
        ]
        .map(|field| columns.vectors(field));
        let mass = columns.raw(Field::MASS);
        let [rounding, smallest] = if T::COMPENSATED {
            [f32::EPSILON, f32::MIN_POSITIVE].map(f64::from)
        } else {
            [f64::EPSILON, f64::MIN_POSITIVE]
        };
        let (rounding, smallest) = (T::from_f64(16.0 * rounding), T::from_f64(smallest));
        let follows = |_, run: Range<usize>| {
            run.into_iter().all(|slot| {
                (0..D).all(|d| {
                    let a = rates.get(Output::FORCE, d, slot) / mass[slot] + gravity[d];
                    let now = v[slot][d] + half * a;
                    let gained = tau * accelerations[slot][d];
                    let size = now.abs() + mean[slot][d].abs() + gained.abs();
                    (now - (mean[slot][d] + gained)).abs() <= rounding * size + smallest
                })
            })
        };
        let follow = over_pieces(runs(0..mass.len(), GRAIN), follows);
        let parts = self.apart().map(|(team, _)| !team.any(!follow));
        parts.unwrap_or(follow).then_some(after)
    }

    /// v ← v + dt a.
    pub(super) fn kick(&mut self, dt: f64) {
        let gravity = self.work.evaluated_gravity;
        let step = T::from_f64(dt);
        let (rates, mobile) = (&self.work.rates, self.particles.mobile);
        let [v, mass] = self
            .particles
            .columns
            .many_mut([Field::VELOCITY, Field::MASS]);
        let mass = &*mass;
        let row = Results::<T, D>::WIDTH;
        for_each(cut(&mut v[..mobile * D], GRAIN * D), |piece, v| {
            for (n, v) in v.chunks_exact_mut(row * D).enumerate() {
                let first = piece * GRAIN + n * row;
                let forces = rates.row(Output::FORCE, first);
                kick_row(v, &mass[first..], forces, (step, &gravity));
            }
        });
    }

    /// The first half of a drift, or all of it where the group needs no evaluation in its middle.
    pub(super) fn begin_drift(&mut self, dt: f64) {
        if self.scheme.acts_in_drift() {
            self.predict_weights(0.5 * dt);
        }
        let whole = self.drifts_at_once();
        self.move_particles(if whole { dt } else { 0.5 * dt });
    }

    /// Evolved fields other than energy over the time of a moment, by the rates of that moment.
    pub(super) fn advance(&mut self, when: When, moment: Moment) {
        let scheme = self.scheme.clone();
        for own in &scheme.program.evolved {
            if own.when != when || own.field == Field::ENERGY {
                continue;
            }
            let mut column = self.take(own.field);
            let mut residual = own
                .residual
                .map_or(Vec::new(), |residual| self.take(residual));
            let width = own.field.components(D);
            let mut limited = 0;
            for (body, view) in self.views(moment) {
                let run = body.run();
                let numbers = run.start * width..run.end * width;
                let lost = residual.get_mut(numbers.clone()).unwrap_or_default();
                let values = (&mut column[numbers], lost);
                limited += update(own, &view, run.start, values, T::from_f64(moment.dt));
            }
            *self.particles.columns.column_mut(own.field) = column;
            if let Some(kept) = own.residual {
                *self.particles.columns.column_mut(kept) = residual;
            }
            self.count(scheme.program.name_of(own.field), limited);
        }
    }

    /// The last evaluation, as a change over `dt` \[s\] sees it.
    pub(super) fn of_rates(&self, dt: f64) -> Moment {
        Moment {
            dt,
            of_rates: true,
            ..Moment::at(self.work.evaluated_time)
        }
    }

    /// Bodies, with the columns and what is around their particles.
    pub(super) fn views(
        &self,
        moment: Moment,
    ) -> impl Iterator<Item = (&BodyState<T>, View<'_, T, D>)> {
        let sums = if moment.of_rates {
            &self.work.rates
        } else {
            &self.work.sums
        };
        self.particles.bodies.iter().map(move |body| {
            let around = Around {
                sums,
                material: &body.material,
                wall: None,
                smoothing_length: self.scheme.h_over_dx() * body.spacing,
                lattice_consistency_factor: self.scheme.lattice_consistency_factor,
                dt: moment.dt,
                time: moment.time,
                gravity: self.gravity,
                origin: self.particles.origin,
                in_drift: moment.in_drift,
            };
            (body, View::new(&self.particles.columns, around))
        })
    }

    /// e ← e + dt P/m with P from the rates, or from the work of the first kick, `later` \[s\] after its middle.
    fn heat(&mut self, dt: f64, later: Option<f64>) {
        let (dt, tau) = (T::from_f64(dt), later.map(T::from_f64));
        let (rates, worked) = (&self.work.rates, &self.work.worked);
        let power = |slot: usize| match tau {
            None => rates.get(Output::POWER, 0, slot),
            Some(tau) if tau == T::zero() => worked.get(Output::POWER, 0, slot),
            Some(tau) => {
                worked.get(Output::POWER, 0, slot)
                    + tau * worked.get(Output::POWER_OF_ACCELERATION, 0, slot)
            }
        };
        let [energy, mass] = self
            .particles
            .columns
            .many_mut([Field::ENERGY, Field::MASS]);
        let mass = &*mass;
        for_each(cut(energy, GRAIN), |piece, energy| {
            for (n, energy) in energy.iter_mut().enumerate() {
                let slot = piece * GRAIN + n;
                *energy += dt * power(slot) / mass[slot];
            }
        });
    }

    fn heat_by_sources(&mut self, dt: f64) {
        let of_laws = &self.scheme.program.heating;
        heat_by_sources(&mut self.particles.columns, of_laws, dt);
    }

    fn carries_energy(&self) -> bool {
        self.scheme.energy != EnergyForm::None
    }

    /// What a kick changes, and a prediction takes back.
    pub(super) fn kicked(&self) -> impl Iterator<Item = Field> {
        let evolved = self.scheme.program.evolved.iter();
        let kicked = evolved.filter(|own| own.when == When::Kick);
        core::iter::once(Field::VELOCITY)
            .chain(kicked.flat_map(|own| core::iter::once(own.field).chain(own.residual)))
    }

    /// Sets what a kick changes `dt` \[s\] ahead with the last rates.
    pub(super) fn predict(&mut self, dt: f64) {
        let mut predicted = core::mem::take(&mut self.work.predicted);
        if predicted.is_empty() {
            predicted.extend(self.kicked().map(|field| (field, Vec::new())));
        }
        for (field, saved) in &mut predicted {
            let column = self.particles.columns.raw(*field);
            saved.resize(column.len(), T::zero());
            for_each(cut(saved, GRAIN), |piece, saved| {
                let now = &column[piece * GRAIN..][..saved.len()];
                saved.copy_from_slice(now);
            });
        }
        self.work.predicted = predicted;
        self.work.is_predicted = true;
        self.kick(dt);
        self.advance(When::Kick, self.of_rates(dt));
        if self.carries_energy() {
            self.heat(dt, None);
        }
    }

    /// Takes the last prediction back.
    pub(super) fn restore(&mut self) {
        self.work.is_predicted = false;
        for (field, saved) in &mut self.work.predicted {
            core::mem::swap(self.particles.columns.column_mut(*field), saved);
        }
    }

    /// Keeps the present state in a slot.
    pub(super) fn save(&mut self, slot: usize) {
        if self.work.kept.len() <= slot {
            self.work.kept.resize_with(slot + 1, Saved::default);
        }
        let mut kept = core::mem::take(&mut self.work.kept[slot]);
        if kept.is_empty() {
            kept.extend(state(&self.scheme.program).map(|field| (field, Vec::new())));
        }
        for (field, kept) in &mut kept {
            kept.clear();
            kept.extend_from_slice(self.particles.columns.raw(*field));
        }
        self.work.kept[slot] = kept;
    }

    /// Brings a saved state back.
    pub(super) fn load(&mut self, slot: usize) {
        let Some(kept) = self.work.kept.get(slot) else {
            return;
        };
        for (field, kept) in kept {
            self.particles.columns.raw_mut(*field).copy_from_slice(kept);
        }
    }

    /// Y ← a · saved + b · Y + dt · dY/dt.
    pub(super) fn combine(&mut self, slot: usize, a: f64, b: f64, dt: f64) {
        let Some(kept) = self.work.kept.get_mut(slot).map(core::mem::take) else {
            return;
        };
        let of = |field: Field| kept.iter().find(|own| own.0 == field).map(|own| &own.1[..]);
        let columns = self.particles.columns.many_mut([
            Field::POSITION,
            Field::POSITION_RESIDUAL,
            Field::VELOCITY,
        ]);
        let before = POSITIONS.map(|field| of(field).unwrap_or_default());
        combine_positions(columns, before, [a, b, dt]);
        let (a_t, b_t, dt_t) = (T::from_f64(a), T::from_f64(b), T::from_f64(dt));
        let before = of(Field::VELOCITY).unwrap_or_default();
        let mut v = self.take(Field::VELOCITY);
        let (work, mass) = (&self.work, self.particles.columns.raw(Field::MASS));
        for_each(cut(&mut v, GRAIN), |piece, v| {
            for (n, v) in v.iter_mut().enumerate() {
                let k = piece * GRAIN + n;
                *v = a_t * before[k] + b_t * *v + dt_t * work.acceleration(mass, k);
            }
        });
        *self.particles.columns.column_mut(Field::VELOCITY) = v;
        let scheme = self.scheme.clone();
        for own in &scheme.program.evolved {
            let before = of(own.field).unwrap_or_default();
            let mut column = self.take(own.field);
            match own.residual {
                None => {
                    self.for_each_rate(own, &mut column, |at, y, rate| {
                        *y = a_t * before[at] + b_t * *y + dt_t * rate;
                    });
                }
                // The sum is made in `f64`, and what does not fit the scalar is kept.
                Some(field) => {
                    let lost = of(field).unwrap_or_default();
                    let mut residual = self.take(field);
                    self.for_each_rate(own, &mut column, |at, y, rate| {
                        let sum = a * (before[at].to_f64() + lost[at].to_f64())
                            + b * (y.to_f64() + residual[at].to_f64())
                            + dt * rate.to_f64();
                        *y = T::from_f64(sum);
                        residual[at] = T::from_f64(sum - y.to_f64());
                    });
                    *self.particles.columns.column_mut(field) = residual;
                }
            }
            *self.particles.columns.column_mut(own.field) = column;
        }
        self.work.kept[slot] = kept;
    }

    /// saved ← saved + dt · dY/dt.
    pub(super) fn accumulate(&mut self, slot: usize, dt: f64) {
        let Some(mut kept) = self.work.kept.get_mut(slot).map(core::mem::take) else {
            return;
        };
        let dt_t = T::from_f64(dt);
        let [(_, position), (_, residual), (_, velocity), others @ ..] = kept.as_mut_slice() else {
            return;
        };
        let v = self.particles.columns.raw(Field::VELOCITY);
        add_scaled(position, residual, v, dt_t);
        let (work, mass) = (&self.work, self.particles.columns.raw(Field::MASS));
        for_each(cut(velocity, GRAIN), |piece, saved| {
            for (n, saved) in saved.iter_mut().enumerate() {
                *saved += dt_t * work.acceleration(mass, piece * GRAIN + n);
            }
        });
        let scheme = self.scheme.clone();
        let mut others = others.iter_mut();
        for own in &scheme.program.evolved {
            let Some((_, saved)) = others.next() else {
                break;
            };
            let lost = own.residual.and_then(|_| others.next());
            let mut now = self.take(own.field);
            let lost = lost.map(|own| &mut own.1[..]).unwrap_or_default();
            self.for_each_rate(own, &mut now, |at, _, rate| {
                add_compensated(&mut saved[at], lost.get_mut(at), dt_t * rate);
            });
            *self.particles.columns.column_mut(own.field) = now;
        }
        self.work.kept[slot] = kept;
    }

    /// Shows every number of a column with its place and its rate dY/dt.
    fn for_each_rate(
        &self,
        own: &Evolved<T, D>,
        column: &mut [T],
        mut act: impl FnMut(usize, &mut T, T),
    ) {
        let width = own.field.components(D);
        let piece = RATES / width * width;
        let mut buffer = [T::zero(); RATES];
        for (body, view) in self.views(self.of_rates(0.0)) {
            let run = body.run();
            let numbers = &mut column[run.start * width..run.end * width];
            for (k, values) in numbers.chunks_mut(piece).enumerate() {
                let first = run.start * width + k * piece;
                rates(own, &view, first / width, values, &mut buffer);
                for (n, y) in values.iter_mut().enumerate() {
                    act(first + n, y, buffer[n]);
                }
            }
        }
    }
}

/// v ← v + dt (F/m + g) of a row of particles; forces stand component by component, and are none where there are none.
#[inline]
fn kick_row<T: Real, const D: usize>(
    v: &mut [T],
    mass: &[T],
    forces: Option<&[T]>,
    (dt, gravity): (T, &[T; D]),
) {
    const { assert!(Results::<T, D>::WIDTH <= MOST_LANES) }
    let row = Results::<T, D>::WIDTH;
    let mass = &mass[..row];
    for d in 0..D {
        // Quotients of a row are vector instructions if they are not scattered at once.
        let mut gained = [T::zero(); MOST_LANES];
        if let Some(forces) = forces {
            let (forces, gained) = (&forces[d * row..][..row], &mut gained[..row]);
            for lane in 0..row {
                gained[lane] = forces[lane] / mass[lane];
            }
        }
        for (lane, v) in v.chunks_exact_mut(D).enumerate() {
            v[d] += dt * (gained[lane] + gravity[d]);
        }
    }
}
