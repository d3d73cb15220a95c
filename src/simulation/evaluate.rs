//! One evaluation: density from positions, pressure from the materials, and all sums over pairs.
//! Everything is done in place; nothing is allocated between two builds of the neighbour lists.

use super::group::Group;
use crate::material::eos::GuardCounts;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::{DensityForm, EnergyForm};
use crate::sweep::{PairSweep, Pass, SweepInput};
use rayon::prelude::*;
use std::ops::Range;
use std::time::Instant;

/// Particles that a thread takes at a time in loops over particles.
pub(crate) const GRAIN: usize = 4096;

impl<T: Real, const D: usize> Group<T, D> {
    /// Runs a sweep into the scratch rows.
    pub(super) fn scratch_sweep(&mut self, choose: impl Fn(&Self) -> Option<&dyn PairSweep<T, D>>) {
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

    /// Weights of pair sums by a density form.
    pub(super) fn set_weights(&mut self, form: DensityForm) {
        let [weight, mass, density, rest] = self.columns.many_mut([
            Field::WEIGHT,
            Field::MASS,
            Field::DENSITY,
            Field::REFERENCE_DENSITY,
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
            || !self.rows.outputs().contains(Output::COMPRESSION)
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
            Field::WEIGHT,
            Field::MASS,
            Field::DENSITY,
            Field::REFERENCE_DENSITY,
            Field::NORMALISATION,
        ]);
        let (mass, density) = (&*mass, &*density);
        let (rest, moment) = (&*rest, &*moment);
        weight
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, weight)| {
                let sum = rows.get(Output::COMPRESSION, 0, slot);
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
        self.follow_flow(time);
        self.sum_rates();
    }

    /// Pressure and sound speed from the materials, body by body.
    pub fn close_materials(&mut self) {
        let carries_energy = self.scheme.energy != EnergyForm::None;
        let scaled = self.scheme.density == DensityForm::Lam;
        let [density, energy, pressure, sound_speed, rest] = self.columns.many_mut([
            Field::DENSITY,
            Field::ENERGY,
            Field::PRESSURE,
            Field::SOUND_SPEED,
            Field::REFERENCE_DENSITY,
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
            Field::PRESSURE_COEFFICIENT,
            Field::PRESSURE,
            Field::DENSITY,
            Field::REFERENCE_DENSITY,
            Field::NORMALISATION,
            Field::GRAD_H,
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
