//! Viscosity coefficients of particles, which follow the flow once a step.
//! The sums of the last evaluation give the flow; the law is the viscosity's own.

use super::evaluate::GRAIN;
use super::group::Group;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::term::viscosity::Surroundings;
use rayon::prelude::*;

impl<T: Real, const D: usize> Group<T, D> {
    /// Lets the coefficients follow the flow of the last evaluation over `dt` \[s\].
    pub fn follow_switch(&mut self, dt: f64) {
        let Some(switch) = self.scheme.switch else {
            return;
        };
        let form = self.scheme.density;
        let reach = T::from_f64(self.scheme.kernel.support);
        let uniform = T::from_f64(self.smoothing_length);
        let dt = T::from_f64(dt);
        let rows = &self.rows;
        let [
            alpha,
            divergence,
            density,
            rest,
            moment,
            h,
            sound_speed,
            gradient,
        ] = self.columns.many_mut([
            Field::VISCOSITY_COEFFICIENT,
            Field::DIVERGENCE,
            Field::DENSITY,
            Field::REFERENCE_DENSITY,
            Field::NORMALISATION,
            Field::SMOOTHING_LENGTH,
            Field::SOUND_SPEED,
            Field::VELOCITY_GRADIENT,
        ]);
        let (density, rest, moment, h) = (&*density, &*rest, &*moment, &*h);
        let (sound_speed, gradient) = (&*sound_speed, &*gradient);
        let at = |column: &[T], slot: usize, absent: T| column.get(slot).copied().unwrap_or(absent);
        let around = |slot: usize, before: T| {
            let sum = rows.get(Output::COMPRESSION, 0, slot);
            let (rest, moment) = (at(rest, slot, T::one()), at(moment, slot, T::one()));
            let h = at(h, slot, uniform);
            let unity = rows.get(Output::UNITY, 0, slot);
            Surroundings {
                divergence: -form.compression(sum, density[slot], rest, moment),
                divergence_before: before,
                divergence_sign: if unity > T::zero() {
                    rows.get(Output::DIVERGENCE_SIGN, 0, slot) / unity
                } else {
                    T::zero()
                },
                shear2: shear2::<T, D>(gradient.get(slot * D * D..(slot + 1) * D * D)),
                sound_speed: sound_speed[slot],
                signal_speed: rows
                    .get(Output::SIGNAL_SPEED, 0, slot)
                    .max(sound_speed[slot]),
                h,
                support: reach * h,
            }
        };
        if divergence.is_empty() {
            alpha
                .par_iter_mut()
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(slot, alpha)| {
                    *alpha = switch.next(*alpha, &around(slot, T::zero()), dt);
                });
            return;
        }
        alpha
            .par_iter_mut()
            .zip(divergence.par_iter_mut())
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, (alpha, divergence))| {
                let around = around(slot, *divergence);
                *alpha = switch.next(*alpha, &around, dt);
                *divergence = around.divergence;
            });
    }
}

/// tr S Sᵀ of the traceless symmetric part of a velocity gradient; zero in one dimension.
fn shear2<T: Real, const D: usize>(gradient: Option<&[T]>) -> T {
    let Some(gradient) = gradient.filter(|_| D > 1) else {
        return T::zero();
    };
    let half = T::from_f64(0.5);
    let mean = (0..D).fold(T::zero(), |sum, a| sum + gradient[a * D + a]) / T::from_f64(D as f64);
    let mut sum = T::zero();
    for a in 0..D {
        for b in 0..D {
            let mut s = (gradient[a * D + b] + gradient[b * D + a]) * half;
            if a == b {
                s -= mean;
            }
            sum += s * s;
        }
    }
    sum
}
