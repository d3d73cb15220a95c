//! Density from positions: kernel sums, what contacts add to them, and a smoothing length that follows.
//! Price 2012, section 2.3, for the last.

use super::evaluate::GRAIN;
use super::group::Group;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::{DensityForm, Smoothing};
use rayon::prelude::*;

impl<T: Real, const D: usize> Group<T, D> {
    pub(super) fn find_density(&mut self, time: f64) {
        let form = self.scheme.density;
        if form.is_integrated() {
            if self.unilateral {
                self.scratch_sweep(|group| group.scheme.reference.as_deref());
                self.find_touching();
            }
            return;
        }
        if let Smoothing::Consistent { smallest, largest } = self.scheme.smoothing {
            self.solve_smoothing(time, smallest, largest);
            return;
        }
        self.scratch_sweep(|group| group.scheme.sums.as_deref());
        if self.unilateral {
            self.find_touching();
        }
        let rows = &self.scratch_rows;
        let unilateral = self.unilateral;
        let [density, rest, sum, moment, touching] = self.columns.many_mut([
            Field::DENSITY,
            Field::REFERENCE_DENSITY,
            Field::REFERENCE_SUM,
            Field::NORMALISATION,
            Field::TOUCHING_SUM,
        ]);
        let at = |column: &[T], slot: usize| column.get(slot).copied().unwrap_or(T::zero());
        let (rest, sum, moment, touching) = (&*rest, &*sum, &*moment, &*touching);
        density
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, density)| {
                let own = rows.get(Output::KERNEL_SUM, 0, slot);
                let across = rows.get(Output::CONTACT_SUM, 0, slot);
                *density = match form {
                    DensityForm::NumberDensity => {
                        // The other side of a contact compresses; it never pulls apart.
                        let pressed = (across - at(touching, slot)).positive_part();
                        let pressed = if unilateral { pressed } else { T::zero() };
                        let compression = (own - at(sum, slot) + pressed) / at(moment, slot);
                        at(rest, slot) * (T::one() + compression)
                    }
                    DensityForm::Normalised => (own + across) / rows.get(Output::UNITY, 0, slot),
                    DensityForm::Lam if at(sum, slot) > T::zero() => {
                        (own + across) / rows.get(Output::UNITY, 0, slot)
                    }
                    _ => own + across,
                };
            });
    }

    /// Marks particles that the other side of a contact presses against.
    fn find_touching(&mut self) {
        let rows = &self.scratch_rows;
        let [touching, sum] = self
            .columns
            .many_mut([Field::TOUCHING, Field::TOUCHING_SUM]);
        let sum = &*sum;
        touching
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, touching)| {
                let pressed = rows.get(Output::CONTACT_SUM, 0, slot) > sum[slot];
                *touching = if pressed { T::one() } else { T::zero() };
            });
    }

    /// h = η (m/ρ)^(1/D) with ρ = Σ m W(h), by Newton's method (Price 2012, sect. 2.3).
    fn solve_smoothing(&mut self, time: f64, smallest: f64, largest: f64) {
        let eta = T::from_f64(self.scheme.h_over_dx);
        let first = self.smoothing_length;
        let (low, high) = (T::from_f64(smallest * first), T::from_f64(largest * first));
        let d = T::from_f64(D as f64);
        for _ in 0..SMOOTHING_STEPS {
            self.refresh(time);
            self.scratch_sweep(|group| group.scheme.sums.as_deref());
            let rows = &self.scratch_rows;
            let [h, density, mass, omega] = self.columns.many_mut([
                Field::SMOOTHING_LENGTH,
                Field::DENSITY,
                Field::MASS,
                Field::GRAD_H,
            ]);
            let mass = &*mass;
            let change = h
                .par_iter_mut()
                .zip(density.par_iter_mut())
                .zip(omega.par_iter_mut())
                .enumerate()
                .with_min_len(GRAIN)
                .map(|(slot, ((h, density), omega))| {
                    let summed = rows.get(Output::KERNEL_SUM, 0, slot);
                    let slope = rows.get(Output::SLOPE_IN_H, 0, slot);
                    *density = summed;
                    let wanted = mass[slot] * (eta / *h).powi(D as u32);
                    // f = ρ(h) − m (η/h)^D and f′ = ∂ρ/∂h + D m η^D/h^(D+1).
                    let step = (summed - wanted) / (slope + d * wanted / *h);
                    let bounded = step.max(*h * T::from_f64(-0.5)).min(*h * T::from_f64(0.5));
                    let next = (*h - bounded).max(low).min(high);
                    let free = next > low && next < high;
                    *omega = if free {
                        T::one() + *h * slope / (d * summed)
                    } else {
                        T::one()
                    };
                    let change = ((next - *h) / *h).abs().to_f64();
                    *h = next;
                    change
                })
                .reduce(|| 0.0, f64::max);
            if change < SMOOTHING_TOLERANCE {
                break;
            }
        }
        let h = self.columns.raw(Field::SMOOTHING_LENGTH);
        let at_limit = h.iter().filter(|&&h| h <= low || h >= high).count();
        self.limited_h += at_limit as u64;
    }
}

/// Relative change of the smoothing length at which its iteration with the density stops.
const SMOOTHING_TOLERANCE: f64 = 1e-6;

/// Newton steps of that iteration at most.
const SMOOTHING_STEPS: usize = 12;
