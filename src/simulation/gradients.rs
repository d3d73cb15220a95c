//! Gradients that are exact for linear fields, and viscosities that follow the shear rate.
//! Both need a sweep of their own, and run only for schemes that name them.

use super::evaluate::GRAIN;
use super::group::Group;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::sweep::Rows;
use crate::tensor::{Matrix, inverse};
use rayon::prelude::*;

impl<T: Real, const D: usize> Group<T, D> {
    /// Gradients, corrections and viscosities at `time` \[s\], where the scheme has them and they are due.
    pub(super) fn follow_flow(&mut self, time: f64) {
        let dual = (self.scheme.liquid.as_ref()).is_some_and(|liquid| liquid.dual_criteria);
        let kept = dual && self.renewed == self.rebuilds && time < self.renewed_until;
        // Gradients of density follow sound.
        if !kept || self.columns.fields().contains(Field::DENSITY_GRADIENT) {
            self.find_gradients();
        }
        if kept {
            return;
        }
        self.find_viscosities();
        if dual {
            self.renewed = self.rebuilds;
            self.renewed_until = time + self.diffusion_time();
        }
    }

    /// A quarter of h²/ν \[s\] of the most viscous particle: the time in which a creeping flow changes that
    /// moves no particle far.
    fn diffusion_time(&self) -> f64 {
        let viscosity = self.columns.raw(Field::DYNAMIC_VISCOSITY);
        let density = self.columns.raw(Field::DENSITY);
        let kinematic = viscosity.iter().zip(density).take(self.mobile);
        let most = kinematic.fold(0.0_f64, |most, (mu, rho)| most.max((*mu / *rho).to_f64()));
        0.25 * self.smoothing_length * self.smoothing_length / most
    }

    fn find_gradients(&mut self) {
        if self.scheme.gradient.is_none() {
            return;
        }
        self.scratch_sweep(|group| group.scheme.gradient.as_deref());
        let rows = &self.scratch_rows;
        let mobile = self.mobile;
        let [velocity, pressure, density, corrections] = self.columns.many_mut([
            Field::VELOCITY_GRADIENT,
            Field::PRESSURE_GRADIENT,
            Field::DENSITY_GRADIENT,
            Field::CORRECTION,
        ]);
        let with_velocity = !velocity.is_empty();
        let correction = |slot: usize| correction(rows, slot);
        if with_velocity {
            velocity[..mobile * D * D]
                .par_chunks_mut(D * D)
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(slot, out)| {
                    let gradient = velocity_gradient(rows, slot);
                    for (k, value) in out.iter_mut().enumerate() {
                        *value = gradient[(k / D, k % D)];
                    }
                });
        }
        if !corrections.is_empty() {
            corrections[..mobile * D * D]
                .par_chunks_mut(D * D)
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(slot, out)| {
                    let correction = correction(slot);
                    for (k, value) in out.iter_mut().enumerate() {
                        *value = correction[(k / D, k % D)];
                    }
                });
        }
        let vectors = [
            (pressure, Output::PRESSURE_GRADIENT),
            (density, Output::DENSITY_GRADIENT),
        ];
        for (column, sum) in vectors {
            if column.is_empty() {
                continue;
            }
            column[..mobile * D]
                .par_chunks_mut(D)
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(slot, out)| {
                    let correction = correction(slot);
                    for (b, value) in out.iter_mut().enumerate() {
                        *value = (0..D).fold(T::zero(), |total, a| {
                            total + rows.get(sum, a, slot) * correction[(a, b)]
                        });
                    }
                });
        }
    }

    /// Dynamic viscosities from shear rates by the materials' laws. Walls show what sticks to them, and
    /// the viscosity of the last evaluation.
    fn find_viscosities(&mut self) {
        let shear = |group: &Self| {
            group
                .scheme
                .liquid
                .as_ref()
                .is_some_and(|liquid| liquid.shear.is_some())
        };
        if !shear(self) {
            return;
        }
        self.scratch_sweep(|group| group.scheme.liquid.as_ref()?.shear.as_deref());
        let rows = &self.scratch_rows;
        let viscosity = self.columns.raw_mut(Field::DYNAMIC_VISCOSITY);
        for body in &self.bodies {
            let Some(law) = body.material.rheology() else {
                continue;
            };
            let own = body.run();
            viscosity[own.clone()]
                .par_chunks_mut(SHEARED)
                .enumerate()
                .with_min_len(GRAIN / SHEARED)
                .for_each(|(chunk, viscosity)| {
                    let first = own.start + chunk * SHEARED;
                    let mut rates = [T::zero(); SHEARED];
                    for (k, rate) in rates[..viscosity.len()].iter_mut().enumerate() {
                        *rate = shear_rate(rows, first + k);
                    }
                    law.viscosities(&rates[..viscosity.len()], viscosity);
                });
        }
    }
}

/// The inverse of a particle's moment matrix.
fn correction<T: Real, const D: usize>(rows: &Rows<T, D>, slot: usize) -> Matrix<T, D> {
    let moment = Matrix::<T, D>::from_fn(|a, b| rows.get(Output::MOMENT_MATRIX, a * D + b, slot));
    // A thin jet has no gradient across itself: leave the sum uncorrected there.
    inverse(&moment, SINGULAR).unwrap_or_else(Matrix::identity)
}

/// ∇v of a particle from the sums of its sweep \[1/s\].
fn velocity_gradient<T: Real, const D: usize>(rows: &Rows<T, D>, slot: usize) -> Matrix<T, D> {
    let sum = Matrix::<T, D>::from_fn(|a, b| rows.get(Output::VELOCITY_GRADIENT, a * D + b, slot));
    sum * correction(rows, slot)
}

/// √(2 D:D) \[1/s\] with D the symmetric part of ∇v without its trace.
fn shear_rate<T: Real, const D: usize>(rows: &Rows<T, D>, slot: usize) -> T {
    let gradient = velocity_gradient(rows, slot);
    let half = T::from_f64(0.5);
    let mean = gradient.trace() / T::from_f64(D as f64);
    let mut square = T::zero();
    for a in 0..D {
        for b in 0..D {
            let own = (gradient[(a, b)] + gradient[(b, a)]) * half;
            let own = if a == b { own - mean } else { own };
            square += own * own;
        }
    }
    (square + square).sqrt()
}

/// Particles whose shear rates are on the stack at a time.
const SHEARED: usize = 64;

/// Smallest pivot of a moment matrix that is inverted, relative to its largest entry.
const SINGULAR: f64 = 1e-3;
