//! Laws of the rates as records: forces and heat that they add to those of pairs, and what forces give in kicks.
//! What they give is added up on the device, particle by particle, until the host asks for it.

use super::Offloaded;
use super::program::{Action, Given, Made};
use super::record::{DT, HALF, Recorder, Sums, evaluated};
use crate::particles::{Field, Output};
use crate::scalar::{Lane, Real, Traced};
use crate::scheme::EnergyForm;
use crate::term::Stage;

impl<T: Real, const D: usize> Recorder<'_, T, D> {
    /// The laws of the rates, and what they add to the sums of pairs.
    pub(super) fn laws_of_rates(&mut self, sums: Sums) -> Vec<Action> {
        let forces = self.has(Field::FORCE) && sums.there.contains(Output::FORCE);
        let heats = self.group.scheme.energy != EnergyForm::None;
        let heats = heats && sums.there.contains(Output::POWER);
        let mut all = Vec::new();
        if self.has(Field::FORCE) {
            let none = vec![Given::Constant(0.0); D];
            let made = (0..D).map(|d| Made::Field(Field::FORCE, d)).collect();
            let io = (none, made);
            all.extend(self.on_each("no forces of laws", self.bodies(), io, <[_]>::to_vec));
        }
        all.extend(self.laws_of_bodies(Stage::Rates, sums));
        if forces {
            let mut given: Vec<_> = (0..D).map(|d| Given::Rate(Output::FORCE, d)).collect();
            given.extend((0..D).map(|d| Given::Field(Field::FORCE, d)));
            let made = (0..D).map(|d| Made::Rate(Output::FORCE, d)).collect();
            all.extend(
                self.on_each("forces of laws", self.bodies(), (given, made), |x| {
                    (0..D).map(|d| x[d] + x[D + d]).collect()
                }),
            );
        }
        for field in self.group.scheme.program.heating.clone() {
            let power = Given::Rate(Output::POWER, 0);
            let given = vec![power, Given::Field(Field::MASS, 0), Given::Field(field, 0)];
            let made = vec![Made::Rate(Output::POWER, 0)];
            if heats {
                let heated = |x: &[Traced]| vec![x[0] + x[1] * x[2]];
                all.extend(self.on_each("heat of laws", self.bodies(), (given, made), heated));
            }
        }
        all
    }

    /// Heat of laws in a kick whose work is summed over pairs alone.
    pub(super) fn heat_of_laws(&mut self) -> Vec<Action> {
        let mut all = Vec::new();
        for field in self.group.scheme.program.heating.clone() {
            let given = vec![Given::Field(Field::ENERGY, 0), DT, Given::Field(field, 0)];
            let made = vec![Made::Field(Field::ENERGY, 0)];
            let heated = |x: &[Traced]| vec![x[0] + x[1] * x[2]];
            all.extend(self.on_each("heat of laws", self.bodies(), (given, made), heated));
        }
        all
    }

    /// Momentum and work that forces of laws give in kicks.
    pub(super) fn book_laws(&mut self) {
        let sums = self.group.scheme.sums(Stage::Rates);
        if !(self.has(Field::FORCE) && sums.contains(Output::FORCE)) {
            return;
        }
        let first = self.program.columns;
        self.program.columns += D + 1;
        self.program.given = Some(first);
        let mut reads = vec![DT, HALF, Given::Field(Field::MASS, 0)];
        for d in 0..D {
            reads.extend([Given::Field(Field::FORCE, d), Given::Column(first + d)]);
            reads.extend([
                Given::Field(Field::VELOCITY, d),
                Given::Rate(Output::FORCE, d),
            ]);
            reads.push(evaluated::<D>(d));
        }
        reads.push(Given::Column(first + D));
        let made = (first..=first + D).map(Made::Column).collect();
        let booked = self.on_each("what laws give", self.bodies(), (reads, made), |x| {
            let (mut results, mut power) = (Vec::new(), Traced::of(0.0));
            for own in x[3..3 + 5 * D].chunks_exact(5) {
                results.push(own[1] + x[0] * own[0]);
                power += own[0] * (own[2] + x[1] * (own[3] / x[2] + own[4]));
            }
            results.push(x[3 + 5 * D] + x[0] * power);
            results
        });
        let at = self.of_work;
        self.program.kick.splice(at..at, booked);
    }
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// Takes what laws have given since it was last taken: momentum and work, column by column.
    pub(super) fn take_given(&mut self, group: usize, numbers: &[f64]) {
        let own = &self.simulation.state.groups[group];
        let slots = own.particles.columns.slots();
        let bodies = own.particles.bodies.iter().zip(&own.indices);
        let bodies: Vec<_> = bodies.map(|(body, on)| (*on, body.slots.clone())).collect();
        for (on, live) in bodies {
            for k in 0..=D {
                let sum = live.clone().map(|slot| numbers[k * slots + slot]).sum();
                let index = self.simulation.law_index(on, k);
                self.simulation.state.impulses.add(index, sum);
            }
        }
    }
}
