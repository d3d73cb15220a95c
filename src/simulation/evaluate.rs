//! One evaluation: density from positions, pressure from the materials, and all sums over pairs.
//! Everything is done in place; nothing is allocated between two builds of the neighbour lists.

use super::group::Group;
use super::stages::Moment;
use super::walls::WallState;
use crate::clock::Instant;
use crate::collective::Collective;
use crate::effect::{DensityForm, When};
use crate::material::eos::GuardCounts;
use crate::parallel::{GRAIN, cut, for_each};
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::{EnergyForm, Entries, Entry};
use crate::sweep::{PairSweep, Pass, Records, Results, SweepInput};
use crate::term::Stage;
use std::ops::Range;

/// Largest share by which a smoothing length is predicted to change.
pub(super) const MOST_PREDICTED: f64 = 0.2;

impl<T: Real, const D: usize> Group<T, D> {
    /// Weights of pair sums by a density form.
    pub(super) fn set_weights(&mut self, form: DensityForm) {
        let [weight, mass, density, rest] = self.particles.columns.many_mut([
            Field::WEIGHT,
            Field::MASS,
            Field::DENSITY,
            Field::REFERENCE_DENSITY,
        ]);
        let (mass, density, rest) = (&*mass, &*density, &*rest);
        for_each(cut(weight, GRAIN), |piece, weight| {
            for (n, weight) in weight.iter_mut().enumerate() {
                let slot = piece * GRAIN + n;
                let rest = rest.get(slot).copied().unwrap_or(density[slot]);
                *weight = form.weight(mass[slot], density[slot], rest);
            }
        });
    }

    /// Volumes `dt` \[s\] ahead with the last rates of compression, for sums at the middle of a drift.
    pub fn predict_weights(&mut self, dt: f64) {
        // Masses do not change.
        if self.scheme.density == DensityForm::ContinuityByMass {
            return;
        }
        // The rates of a liquid do not sum compression, and its volumes change by little in a step.
        if !self.scheme.density.is_integrated()
            || !self.work.rates.outputs().contains(Output::COMPRESSION)
        {
            if self.scheme.pressure_form != self.scheme.density {
                self.set_weights(self.scheme.density);
            }
            return;
        }
        // The last rates were summed with the weights of the force.
        let form = self.scheme.pressure_form;
        let (rates, dt) = (&self.work.rates, T::from_f64(dt));
        let [weight, mass, density, rest, moment] = self.particles.columns.many_mut([
            Field::WEIGHT,
            Field::MASS,
            Field::DENSITY,
            Field::REFERENCE_DENSITY,
            Field::CONSISTENCY_FACTOR,
        ]);
        let (mass, density) = (&*mass, &*density);
        let (rest, moment) = (&*rest, &*moment);
        // Liquids know nothing of their neighbourhood at rest.
        let or = |column: &[T], slot: usize, own: T| column.get(slot).copied().unwrap_or(own);
        let lattice = T::from_f64(self.scheme.lattice_consistency_factor);
        for_each(cut(weight, GRAIN), |piece, weight| {
            for (n, weight) in weight.iter_mut().enumerate() {
                let slot = piece * GRAIN + n;
                let sum = rates.get(Output::COMPRESSION, 0, slot);
                let [rest, moment] = [or(rest, slot, T::one()), or(moment, slot, lattice)];
                let rate = form.compression(sum, density[slot], rest, moment);
                *weight = mass[slot] / (density[slot] * (T::one() + dt * rate));
            }
        });
    }

    /// Evaluates all rates at the present positions, velocities, densities and energies. `elapsed` \[s\] is the
    /// time over which laws that run once a step have yet to act.
    pub fn evaluate(&mut self, time: f64, elapsed: f64) {
        self.work.evaluated_time = time;
        let moment = Moment {
            dt: elapsed,
            ..Moment::at(time)
        };
        self.run_all(|entries| &entries.evaluation, moment);
    }

    /// Runs entries of the step, in their order.
    pub(super) fn run_all(&mut self, choose: impl Fn(&Entries) -> &[Entry], moment: Moment) {
        let scheme = self.scheme.clone();
        for entry in choose(&scheme.entries) {
            self.run(*entry, moment);
        }
    }

    fn run(&mut self, entry: Entry, moment: Moment) {
        let (start, before) = (Instant::now(), self.work.phases);
        match entry {
            Entry::PredictLengths => self.predict_lengths(moment.time),
            Entry::Lists => self.refresh(moment.time, None),
            Entry::Weights(form) => self.set_weights(form),
            Entry::Stage(Stage::Contacts) if !self.has_contacts() => {}
            Entry::Stage(Stage::Walls) => {
                self.run_walls(moment.time);
                // The sweep over walls is booked with them.
                self.work.phases = before;
                self.work.phases.walls += start.elapsed();
            }
            Entry::Stage(stage) => self.run_stage(stage, moment),
            Entry::Sweep(Stage::Rates) => self.sum_rates(),
            Entry::Sweep(stage) => self.sum_stage(stage),
            Entry::Laws(stage) => self.apply_laws(stage, moment),
            Entry::LengthRates => self.set_length_rates(moment.time),
            Entry::Materials => self.evaluate_materials(),
            Entry::Coefficients => self.set_coefficients(),
            Entry::ForcesOfLaws => self.add_forces_of_laws(Moment {
                of_rates: true,
                ..moment
            }),
            Entry::Energy => self.heat_in_kick(moment.dt),
            Entry::Velocity => self.kick(moment.dt),
            Entry::Evolve(When::Kick) => self.advance(When::Kick, self.of_rates(moment.dt)),
            Entry::Evolve(When::Drift) => self.advance(When::Drift, moment),
        }
        let of_materials = [
            Entry::Materials,
            Entry::Coefficients,
            Entry::Stage(Stage::State),
        ];
        if of_materials.contains(&entry) {
            self.work.phases.materials += start.elapsed();
        }
    }

    /// The laws of the rates, and the forces and the heat that they add to those of pairs.
    fn add_forces_of_laws(&mut self, moment: Moment) {
        self.particles.columns.raw_mut(Field::FORCE).fill(T::zero());
        self.apply_laws(Stage::Rates, moment);
        if self.has_forces_of_laws() {
            let forces = self.particles.columns.raw(Field::FORCE);
            self.work.rates.add_all(Output::FORCE, None, forces);
        }
        if self.scheme.energy != EnergyForm::None {
            let mass = self.particles.columns.raw(Field::MASS);
            for field in &self.scheme.program.heating {
                let heating = self.particles.columns.raw(*field);
                self.work.rates.add_all(Output::POWER, Some(mass), heating);
            }
        }
    }

    /// Smoothing lengths that follow the density, as far ahead as they have changed since: the nearer the search for them
    /// begins, the fewer sums it takes, and the fewer lists.
    fn predict_lengths(&mut self, time: f64) {
        let [h, rate] = self
            .particles
            .columns
            .many_mut([Field::SMOOTHING_LENGTH, Field::SMOOTHING_RATE]);
        let dt = time - self.work.lengths_time;
        if dt != 0.0 && dt.is_finite() {
            let (dt, most) = (T::from_f64(dt), T::from_f64(MOST_PREDICTED));
            for (h, rate) in h.iter_mut().zip(&*rate) {
                *h *= T::one() + (*rate * dt).max(-most).min(most);
            }
        }
    }

    /// The rates by which the next smoothing lengths are predicted, from those found before and now.
    fn set_length_rates(&mut self, time: f64) {
        let dt = time - self.work.lengths_time;
        let [h, before, rate] = self.particles.columns.many_mut([
            Field::SMOOTHING_LENGTH,
            Field::FOUND_SMOOTHING_LENGTH,
            Field::SMOOTHING_RATE,
        ]);
        // An evaluation at the same time, as between steps, tells nothing of rates.
        if dt != 0.0 {
            let dt = T::from_f64(if dt.is_finite() { dt } else { f64::INFINITY });
            for ((rate, before), h) in rate.iter_mut().zip(before.iter_mut()).zip(&*h) {
                // Particles that came since have no length before.
                *rate = if *before > T::zero() {
                    (*h / *before - T::one()) / dt
                } else {
                    T::zero()
                };
                *before = *h;
            }
        }
        self.work.lengths_time = time;
    }

    /// Pressure and sound speed from the materials, body by body.
    pub fn evaluate_materials(&mut self) {
        let carries_energy = self.scheme.energy != EnergyForm::None;
        let scaled = self.scheme.density == DensityForm::Lam;
        let [density, energy, pressure, sound_speed, rest] = self.particles.columns.many_mut([
            Field::DENSITY,
            Field::ENERGY,
            Field::PRESSURE,
            Field::SOUND_SPEED,
            Field::REFERENCE_DENSITY,
        ]);
        let mut guards = Collective::new();
        for body in &self.particles.bodies {
            let own = body.run();
            let material = body.material.eos();
            let reference = T::from_f64(material.reference_density());
            let energy = if carries_energy {
                &energy[own.clone()]
            } else {
                &[]
            };
            let pieces = (
                cut(&mut pressure[own.clone()], GRAIN),
                cut(&mut sound_speed[own.clone()], GRAIN),
            );
            guards.add_pieces(pieces, |chunk, (pressure, sound_speed)| {
                let first = chunk * GRAIN;
                let density = &density[own.start + first..][..pressure.len()];
                let energy = carries_energy.then(|| &energy[first..first + density.len()]);
                if !scaled {
                    return material.evaluate(density, energy, pressure, sound_speed);
                }
                // Compression is measured from the smoothed density at rest.
                let mut counts = GuardCounts::default();
                for k in 0..density.len() {
                    let rest = rest[own.start + first + k];
                    let compressed = [reference * (density[k] / rest)];
                    let energy = energy.map(|energy| &energy[k..=k]);
                    counts += material.evaluate(
                        &compressed,
                        energy,
                        &mut pressure[k..=k],
                        &mut sound_speed[k..=k],
                    );
                }
                counts
            });
        }
        self.guards += guards.value();
    }

    /// Pressure coefficients of the pair force.
    fn set_coefficients(&mut self) {
        let form = self.scheme.pressure_form;
        let [coefficient, pressure, density, rest, moment, omega] =
            self.particles.columns.many_mut([
                Field::PRESSURE_COEFFICIENT,
                Field::PRESSURE,
                Field::DENSITY,
                Field::REFERENCE_DENSITY,
                Field::CONSISTENCY_FACTOR,
                Field::GRAD_H,
            ]);
        let (pressure, density) = (&*pressure, &*density);
        let (rest, moment, omega) = (&*rest, &*moment, &*omega);
        let one = |column: &[T], slot: usize| column.get(slot).copied().unwrap_or(T::one());
        let lattice = T::from_f64(self.scheme.lattice_consistency_factor);
        for_each(cut(coefficient, GRAIN), |piece, coefficient| {
            for (n, x) in coefficient.iter_mut().enumerate() {
                let slot = piece * GRAIN + n;
                let p = pressure[slot] / one(omega, slot);
                let moment = moment.get(slot).copied().unwrap_or(lattice);
                *x = form.coefficient(p, density[slot], one(rest, slot), moment);
            }
        });
    }

    fn sum_rates(&mut self) {
        let scheme = self.scheme.clone();
        let Some(sweep) = scheme.sweep(Stage::Rates) else {
            return;
        };
        let mut records = core::mem::take(&mut self.work.records);
        let mut rates = core::mem::take(&mut self.work.rates);
        self.work.records_of_rates = true;
        self.work.first_kick = None;
        let input = self.input();
        let start = Instant::now();
        let [packed, summed] = self.pack_and_run(sweep, &input, &mut records, &mut rates);
        let pairs = self.neighborhood.pairs_of(input.targets);
        self.work.phases.packing += packed;
        self.work.phases.pairs += summed;
        self.work.spent.sweeps[Stage::Rates.number()] += start.elapsed();
        self.work.spent.pairs += pairs;
        self.work.records = records;
        self.work.rates = rates;
        if self.scheme.sweeps_work() {
            let mut records = core::mem::take(&mut self.work.work_records);
            let start = Instant::now();
            sweep.pack(Pass::Work, &self.input(), &mut records);
            self.work.phases.work += start.elapsed();
            self.work.work_records = records;
        } else if self.keeps_rates_of_pairs() {
            self.keep_rates_of_pairs();
        }
    }

    /// The force of the liquid on every particle of a structure with the rates at hand.
    pub(super) fn sum_on_structures(&mut self) {
        // Structures stand behind the walls of the scene.
        let mut walls = self.walls.iter();
        let Some(first) = walls.find(|wall| wall.structure.is_some()) else {
            return;
        };
        let targets = first.slots.start..self.particles.columns.slots();
        let mut rows = core::mem::take(&mut self.work.coupling);
        self.work.spent.pairs += self.neighborhood.pairs_of(targets.clone());
        self.sum_on_walls(targets, &mut rows, |sweep, input, records, rows| {
            self.run_sweep((sweep, Pass::Rates), input, records, rows);
        });
        self.work.coupling = rows;
    }

    /// The force \[N\] on the particles of each wall by their slots, with the rates at hand: zero where the scheme meets no walls,
    /// as those of solids do, which meet them by contact.
    pub(super) fn forces_on_walls(&self) -> Vec<Vec<(usize, [f64; D])>> {
        let mut rows = Results::default();
        let meets = self.scheme.meets_walls();
        if meets {
            self.sum_on_walls(
                self.particles.mobile..self.particles.columns.slots(),
                &mut rows,
                // A reading is made by every rank for itself.
                |sweep, input, records, rows| {
                    let lists = self.neighborhood.all_lists();
                    let targets = input.targets.clone();
                    let input = SweepInput {
                        lists,
                        targets,
                        ..*input
                    };
                    sweep.run(Pass::Rates, &input, records, rows);
                },
            );
        }
        let force = |slot: usize| {
            if meets {
                rows.vector(Output::FORCE, slot).map(Real::to_f64)
            } else {
                [0.0; D]
            }
        };
        let of =
            |wall: &WallState<T, D>| wall.slots.clone().map(|slot| (slot, force(slot))).collect();
        self.walls.iter().map(of).collect()
    }

    /// The force of the liquid on wall particles with the rates at hand: the forces on the liquid with
    /// the opposite sign.
    fn sum_on_walls(
        &self,
        targets: Range<usize>,
        rows: &mut Results<T, D>,
        run: impl Fn(&dyn PairSweep<T, D>, &SweepInput<'_, T, D>, &Records<T>, &mut Results<T, D>),
    ) {
        let input = SweepInput {
            targets,
            ..self.input()
        };
        let Some(rates) = self.scheme.sweep(Stage::Rates) else {
            return;
        };
        if self.work.records_of_rates {
            run(rates, &input, &self.work.records, rows);
        } else {
            // Another sweep has used the records since.
            let mut records = Records::default();
            rates.pack(Pass::Rates, &input, &mut records);
            run(rates, &input, &records, rows);
        }
    }

    /// The work of all pair forces of the last evaluation with the present mean velocities and accelerations.
    pub fn sum_work(&mut self) {
        let scheme = self.scheme.clone();
        let Some(sweep) = scheme.sweep(Stage::Rates) else {
            return;
        };
        let mut records = core::mem::take(&mut self.work.work_records);
        let mut worked = core::mem::take(&mut self.work.worked);
        let start = Instant::now();
        sweep.renew_mean_velocity(&self.input(), &mut records);
        self.run_sweep((sweep, Pass::Work), &self.input(), &records, &mut worked);
        self.work.phases.work += start.elapsed();
        self.work.spent.pairs += self.neighborhood.pairs_of(self.input().targets);
        self.work.work_records = records;
        self.work.worked = worked;
    }
}
