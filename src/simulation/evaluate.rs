//! One evaluation: density from positions, pressure from the materials, and all sums over pairs.
//! Everything is done in place; nothing is allocated between two builds of the neighbour lists.

use super::group::Group;
use crate::material::eos::GuardCounts;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::{DensityForm, EnergyForm, Smoothing};
use crate::sweep::{PairSweep, Pass, Rows, SweepInput};
use crate::tensor::{Matrix, inverse};
use rayon::prelude::*;
use std::ops::Range;
use std::time::Instant;

/// Particles that a thread takes at a time in loops over particles.
pub(crate) const GRAIN: usize = 4096;

/// Relative change of the smoothing length at which its iteration with the density stops.
const SMOOTHING_TOLERANCE: f64 = 1e-6;
/// Newton steps of that iteration at most.
const SMOOTHING_STEPS: usize = 12;
/// Repetitions of equation 25 at rest at most; each brings the ends closer by a third or more.
const SETTLING_STEPS: usize = 200;
/// Relative change at which the ends have settled; in `f32` they do when nothing changes any more.
const SETTLED: f64 = 1e-15;

impl<T: Real, const D: usize> Group<T, D> {
    /// Runs a sweep into the scratch rows.
    fn scratch_sweep(&mut self, choose: impl Fn(&Self) -> Option<&dyn PairSweep<T, D>>) {
        self.scratch_sweep_over(0..self.mobile, choose);
    }

    /// Runs a sweep over some slots into the scratch rows.
    pub fn scratch_sweep_over(
        &mut self,
        targets: Range<usize>,
        choose: impl Fn(&Self) -> Option<&dyn PairSweep<T, D>>,
    ) {
        let mut records = core::mem::take(&mut self.records);
        self.records_of_rates = false;
        let mut rows = core::mem::take(&mut self.scratch_rows);
        if let Some(sweep) = choose(self) {
            let input = SweepInput {
                targets,
                ..self.input()
            };
            let start = Instant::now();
            sweep.pack(Pass::Rates, &input, &mut records);
            let packed = Instant::now();
            sweep.run(Pass::Rates, &input, &records, &mut rows);
            self.phases.packing += packed - start;
            self.phases.pairs += packed.elapsed();
        }
        self.records = records;
        self.scratch_rows = rows;
    }

    /// Takes the sums at rest from which stress is measured. Called once, when the scene is built.
    pub fn take_reference(&mut self) {
        // At rest the two sides of a contact lie against each other, and count as one neighbourhood.
        self.columns.raw_mut(Field::Touching).fill(T::one());
        self.set_weights(self.scheme.density);
        self.refresh(0.0);
        self.scratch_sweep(|group| group.scheme.reference.as_deref());
        let form = self.scheme.density;
        if form == DensityForm::Lam {
            self.smooth_reference();
        } else if form.has_reference() && self.scheme.reference.is_some() {
            let normalised = self.scheme.normalised;
            let rows = &self.scratch_rows;
            let [moment, sum, rest, density] = self.columns.many_mut([
                Field::Normalisation,
                Field::ReferenceSum,
                Field::ReferenceDensity,
                Field::Density,
            ]);
            for slot in 0..density.len() {
                sum[slot] = rows.get(Output::KernelSum, 0, slot);
                rest[slot] = density[slot];
                let all = sum[slot] + rows.get(Output::ContactSum, 0, slot);
                moment[slot] = if normalised {
                    rows.get(Output::Moment, 0, slot)
                } else {
                    all
                };
            }
            if form == DensityForm::Continuity && !normalised {
                moment.fill(T::one());
            }
        }
        if !form.has_reference() {
            self.columns.raw_mut(Field::Normalisation).fill(T::one());
        }
        self.take_touching();
        if self.columns.fields().contains(Field::GradH) {
            self.columns.raw_mut(Field::GradH).fill(T::one());
        }
    }

    /// Kernel sum across each contact at which the two sides touch: what a particle lacks to a full
    /// neighbourhood, or, where the bodies lie against each other, exactly what is there.
    fn take_touching(&mut self) {
        if !self.columns.fields().contains(Field::TouchingSum) {
            return;
        }
        let rows = &self.scratch_rows;
        let [touching] = self.columns.many_mut([Field::TouchingSum]);
        for body in &self.bodies {
            let own = |slot: usize| rows.get(Output::KernelSum, 0, slot);
            let full = body
                .slots
                .clone()
                .fold(T::zero(), |most, slot| most.max(own(slot)));
            for slot in body.run() {
                let across = rows.get(Output::ContactSum, 0, slot);
                let lacking = (full - own(slot)).positive_part();
                let lies_against = across >= lacking * T::from_f64(0.9);
                touching[slot] = if lies_against { across } else { lacking };
            }
        }
    }

    /// Lam, Shen & Gong 2002, section 4.1: the first summed density, with equation 25 at end
    /// particles, is kept as the density at rest.
    fn smooth_reference(&mut self) {
        let rows = &self.scratch_rows;
        let [end, rest, density, moment] = self.columns.many_mut([
            Field::ReferenceSum,
            Field::ReferenceDensity,
            Field::Density,
            Field::Normalisation,
        ]);
        for slot in 0..density.len() {
            let unity = rows.get(Output::Unity, 0, slot);
            let summed =
                rows.get(Output::KernelSum, 0, slot) + rows.get(Output::ContactSum, 0, slot);
            // An end particle lacks a side of its neighbourhood; a joint does not lack volume.
            let is_end = unity < T::from_f64(END_UNITY);
            end[slot] = if is_end { T::one() } else { T::zero() };
            rest[slot] = if is_end { summed / unity } else { summed };
            density[slot] = rest[slot];
            moment[slot] = T::one();
        }
        self.settle_ends();
    }

    /// Equation 25 reads the densities of the neighbours, which the first sum has changed. It is
    /// repeated at rest until it returns what it was given, or the ends would start under stress.
    fn settle_ends(&mut self) {
        for _ in 0..SETTLING_STEPS {
            self.scratch_sweep(|group| group.scheme.reference.as_deref());
            let rows = &self.scratch_rows;
            let [end, rest, density] = self.columns.many_mut([
                Field::ReferenceSum,
                Field::ReferenceDensity,
                Field::Density,
            ]);
            let mut change = T::zero();
            for slot in (0..density.len()).filter(|&slot| end[slot] > T::zero()) {
                let summed =
                    rows.get(Output::KernelSum, 0, slot) + rows.get(Output::ContactSum, 0, slot);
                let next = summed / rows.get(Output::Unity, 0, slot);
                change = change.max((next / rest[slot] - T::one()).abs());
                rest[slot] = next;
                density[slot] = next;
            }
            if change <= T::from_f64(SETTLED) {
                break;
            }
        }
    }

    /// Weights of pair sums by a density form.
    fn set_weights(&mut self, form: DensityForm) {
        let [weight, mass, density, rest] = self.columns.many_mut([
            Field::Weight,
            Field::Mass,
            Field::Density,
            Field::ReferenceDensity,
        ]);
        let (mass, density, rest) = (&*mass, &*density, &*rest);
        weight
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, weight)| {
                let rest = rest.get(slot).copied().unwrap_or(density[slot]);
                *weight = form.weight(mass[slot], density[slot], rest);
            });
    }

    /// Volumes `dt` \[s\] ahead with the last rates of compression, for sums at the middle of a drift.
    pub fn predict_weights(&mut self, dt: f64) {
        // The rates of a liquid do not sum compression, and its volumes change by little in a step;
        // masses do not change at all.
        let by_mass = self.scheme.density == DensityForm::ContinuityByMass;
        if self.scheme.liquid.is_some() || by_mass {
            return;
        }
        if !self.scheme.density.is_integrated()
            || !self.rows.outputs().contains(Output::Compression)
        {
            if self.scheme.pressure_form != self.scheme.density {
                self.set_weights(self.scheme.density);
            }
            return;
        }
        // The last rates were summed with the weights of the force.
        let form = self.scheme.pressure_form;
        let (rows, dt) = (&self.rows, T::from_f64(dt));
        let [weight, mass, density, rest, moment] = self.columns.many_mut([
            Field::Weight,
            Field::Mass,
            Field::Density,
            Field::ReferenceDensity,
            Field::Normalisation,
        ]);
        let (mass, density) = (&*mass, &*density);
        let (rest, moment) = (&*rest, &*moment);
        weight
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, weight)| {
                let sum = rows.get(Output::Compression, 0, slot);
                let rate = form.compression(sum, density[slot], rest[slot], moment[slot]);
                *weight = mass[slot] / (density[slot] * (T::one() + dt * rate));
            });
    }

    /// Evaluates all rates at the present positions, velocities, densities and energies.
    pub fn evaluate(&mut self, time: f64) {
        self.refresh(time);
        if self.scheme.pressure_form != self.scheme.density {
            self.set_weights(self.scheme.density);
        }
        self.find_density(time);
        let start = Instant::now();
        self.close_materials();
        self.damp_sound();
        self.phases.materials += start.elapsed();
        // The sweep over walls is booked with them.
        let (start, before) = (Instant::now(), self.phases);
        self.fill_walls(time);
        self.phases = super::Phases {
            walls: before.walls + start.elapsed(),
            ..before
        };
        let start = Instant::now();
        self.set_coefficients();
        self.phases.materials += start.elapsed();
        self.find_gradients();
        self.find_viscosities();
        self.sum_rates();
    }

    fn find_density(&mut self, time: f64) {
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
            Field::Density,
            Field::ReferenceDensity,
            Field::ReferenceSum,
            Field::Normalisation,
            Field::TouchingSum,
        ]);
        let at = |column: &[T], slot: usize| column.get(slot).copied().unwrap_or(T::zero());
        let (rest, sum, moment, touching) = (&*rest, &*sum, &*moment, &*touching);
        density
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, density)| {
                let own = rows.get(Output::KernelSum, 0, slot);
                let across = rows.get(Output::ContactSum, 0, slot);
                *density = match form {
                    DensityForm::NumberDensity => {
                        // The other side of a contact compresses; it never pulls apart.
                        let pressed = (across - at(touching, slot)).positive_part();
                        let pressed = if unilateral { pressed } else { T::zero() };
                        let compression = (own - at(sum, slot) + pressed) / at(moment, slot);
                        at(rest, slot) * (T::one() + compression)
                    }
                    DensityForm::Normalised => (own + across) / rows.get(Output::Unity, 0, slot),
                    DensityForm::Lam if at(sum, slot) > T::zero() => {
                        (own + across) / rows.get(Output::Unity, 0, slot)
                    }
                    _ => own + across,
                };
            });
    }

    /// Marks particles that the other side of a contact presses against.
    fn find_touching(&mut self) {
        let rows = &self.scratch_rows;
        let [touching, sum] = self.columns.many_mut([Field::Touching, Field::TouchingSum]);
        let sum = &*sum;
        touching
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, touching)| {
                let pressed = rows.get(Output::ContactSum, 0, slot) > sum[slot];
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
                Field::SmoothingLength,
                Field::Density,
                Field::Mass,
                Field::GradH,
            ]);
            let mass = &*mass;
            let change = h
                .par_iter_mut()
                .zip(density.par_iter_mut())
                .zip(omega.par_iter_mut())
                .enumerate()
                .with_min_len(GRAIN)
                .map(|(slot, ((h, density), omega))| {
                    let summed = rows.get(Output::KernelSum, 0, slot);
                    let slope = rows.get(Output::SlopeInH, 0, slot);
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
        let h = self.columns.raw(Field::SmoothingLength);
        let at_limit = h.iter().filter(|&&h| h <= low || h >= high).count();
        self.limited_h += at_limit as u64;
    }

    /// Pressure and sound speed from the materials, body by body.
    pub fn close_materials(&mut self) {
        let carries_energy = self.scheme.energy != EnergyForm::None;
        let scaled = self.scheme.density == DensityForm::Lam;
        let [density, energy, pressure, sound_speed, rest] = self.columns.many_mut([
            Field::Density,
            Field::Energy,
            Field::Pressure,
            Field::SoundSpeed,
            Field::ReferenceDensity,
        ]);
        let mut guards = GuardCounts::default();
        for body in &self.bodies {
            let own = body.run();
            let material = body.material.eos();
            let reference = T::from_f64(material.reference_density());
            let energy = if carries_energy {
                &energy[own.clone()]
            } else {
                &[]
            };
            guards += density[own.clone()]
                .par_chunks(GRAIN)
                .zip(pressure[own.clone()].par_chunks_mut(GRAIN))
                .zip(sound_speed[own.clone()].par_chunks_mut(GRAIN))
                .enumerate()
                .map(|(chunk, ((density, pressure), sound_speed))| {
                    let first = chunk * GRAIN;
                    let energy = carries_energy.then(|| &energy[first..first + density.len()]);
                    if !scaled {
                        return material.close(density, energy, pressure, sound_speed);
                    }
                    // Compression is measured from the smoothed density at rest.
                    let mut counts = GuardCounts::default();
                    for k in 0..density.len() {
                        let rest = rest[own.start + first + k];
                        let compressed = [reference * (density[k] / rest)];
                        let energy = energy.map(|energy| &energy[k..=k]);
                        counts += material.close(
                            &compressed,
                            energy,
                            &mut pressure[k..=k],
                            &mut sound_speed[k..=k],
                        );
                    }
                    counts
                })
                .reduce(GuardCounts::default, |mut a, b| {
                    a += b;
                    a
                });
        }
        self.guards += guards;
    }

    /// Weights and pressure coefficients of the pair force.
    fn set_coefficients(&mut self) {
        let form = self.scheme.pressure_form;
        // A pressure form that does not belong to the density has weights of its own.
        if form.is_integrated() || form != self.scheme.density {
            self.set_weights(form);
        }
        let [coefficient, pressure, density, rest, moment, omega] = self.columns.many_mut([
            Field::PressureCoefficient,
            Field::Pressure,
            Field::Density,
            Field::ReferenceDensity,
            Field::Normalisation,
            Field::GradH,
        ]);
        let (pressure, density) = (&*pressure, &*density);
        let (rest, moment, omega) = (&*rest, &*moment, &*omega);
        let one = |column: &[T], slot: usize| column.get(slot).copied().unwrap_or(T::one());
        let lattice = T::from_f64(self.scheme.lattice_moment);
        coefficient
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, x)| {
                let p = pressure[slot] / one(omega, slot);
                let moment = moment.get(slot).copied().unwrap_or(lattice);
                *x = form.coefficient(p, density[slot], one(rest, slot), moment);
            });
    }

    fn find_gradients(&mut self) {
        if self.scheme.gradient.is_none() {
            return;
        }
        self.scratch_sweep(|group| group.scheme.gradient.as_deref());
        let rows = &self.scratch_rows;
        let mobile = self.mobile;
        let [velocity, pressure, density, corrections] = self.columns.many_mut([
            Field::VelocityGradient,
            Field::PressureGradient,
            Field::DensityGradient,
            Field::Correction,
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
            (pressure, Output::PressureGradient),
            (density, Output::DensityGradient),
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
        let viscosity = self.columns.raw_mut(Field::DynamicViscosity);
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

    fn sum_rates(&mut self) {
        let mut records = core::mem::take(&mut self.records);
        let mut rows = core::mem::take(&mut self.rows);
        self.records_of_rates = true;
        let input = self.input();
        let sweep = self.scheme.rates.as_ref();
        let start = Instant::now();
        sweep.pack(Pass::Rates, &input, &mut records);
        let packed = Instant::now();
        sweep.run(Pass::Rates, &input, &records, &mut rows);
        self.phases.packing += packed - start;
        self.phases.pairs += packed.elapsed();
        self.records = records;
        self.rows = rows;
        if self.scheme.energy == EnergyForm::Compatible {
            let mut records = core::mem::take(&mut self.work_records);
            self.scheme
                .rates
                .pack(Pass::Work, &self.input(), &mut records);
            self.work_records = records;
        }
    }

    /// The work of all pair forces of the last evaluation with the present mean velocities, into the
    /// scratch rows.
    pub fn sum_work(&mut self) {
        let mut records = core::mem::take(&mut self.work_records);
        let mut rows = core::mem::take(&mut self.scratch_rows);
        let sweep = self.scheme.rates.as_ref();
        sweep.renew_mean_velocity(&self.input(), &mut records);
        sweep.run(Pass::Work, &self.input(), &records, &mut rows);
        self.work_records = records;
        self.scratch_rows = rows;
    }

    /// The rate of compression (1/ρ) dρ/dt \[1/s\] of every particle, into the scratch rows.
    pub fn sum_compression(&mut self) {
        self.scratch_sweep(|group| group.scheme.compression.as_deref());
    }
}

/// The inverse of a particle's moment matrix.
fn correction<T: Real, const D: usize>(rows: &Rows<T, D>, slot: usize) -> Matrix<T, D> {
    let moment = Matrix::<T, D>::from_fn(|a, b| rows.get(Output::MomentMatrix, a * D + b, slot));
    // A thin jet has no gradient across itself: leave the sum uncorrected there.
    inverse(&moment, SINGULAR).unwrap_or_else(Matrix::identity)
}

/// ∇v of a particle from the sums of its sweep \[1/s\].
fn velocity_gradient<T: Real, const D: usize>(rows: &Rows<T, D>, slot: usize) -> Matrix<T, D> {
    let sum = Matrix::<T, D>::from_fn(|a, b| rows.get(Output::VelocityGradient, a * D + b, slot));
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
/// Partition of unity below which a particle counts as an end: the last of a row has 0.78, the next 0.97.
const END_UNITY: f64 = 0.9;
/// Smallest pivot of a moment matrix that is inverted, relative to its largest entry.
const SINGULAR: f64 = 1e-3;
