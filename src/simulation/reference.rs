//! The reference configuration from which density forms measure compression, taken when a scene is built.
//! Lam, Shen & Gong 2002, section 4.1, for theirs.

use super::Simulation;
use super::group::Group;
use super::stages::Moment;
use crate::collective::largest;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::DensityForm;
use crate::sweep::Results;
use crate::term::Stage;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Takes the reference configuration of all groups, with structures in their places.
    pub(crate) fn take_references(&mut self) {
        self.place_structures(self.state.time, false, [0.0; 2]);
        for group in &mut self.state.groups {
            group.take_reference();
        }
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Takes the reference configuration from which stress is measured. Called once, when the scene is built.
    pub fn take_reference(&mut self) {
        // At rest the two sides of a contact lie against each other, and count as one neighbourhood.
        self.particles
            .columns
            .raw_mut(Field::CONTACT_ACTIVITY)
            .fill(T::one());
        self.set_weights(self.scheme.density);
        self.refresh(0.0, None);
        self.sum(|scheme| scheme.reference.as_deref());
        let form = self.scheme.density;
        if form == DensityForm::Lam {
            self.smooth_reference();
        } else if form.has_reference() && self.scheme.reference.is_some() {
            let consistent = self.scheme.consistent_at_rest;
            let rows = &self.work.sums;
            let [moment, sum, rest, density] = self.particles.columns.many_mut([
                Field::CONSISTENCY_FACTOR,
                Field::REFERENCE_SUM,
                Field::REFERENCE_DENSITY,
                Field::DENSITY,
            ]);
            for slot in 0..density.len() {
                sum[slot] = rows.get(Output::KERNEL_SUM, 0, slot);
                rest[slot] = density[slot];
                let all = sum[slot] + rows.get(Output::CONTACT_SUM, 0, slot);
                moment[slot] = if consistent {
                    rows.get(Output::MOMENT, 0, slot)
                } else {
                    all
                };
            }
            if form == DensityForm::Continuity && !consistent {
                moment.fill(T::one());
            }
        }
        if !form.has_reference() || self.scheme.reference.is_none() {
            let lattice = T::from_f64(self.scheme.lattice_consistency_factor);
            self.particles
                .columns
                .raw_mut(Field::CONSISTENCY_FACTOR)
                .fill(lattice);
        }
        self.take_contact_thresholds();
        if self.particles.columns.fields().contains(Field::GRAD_H) {
            self.particles.columns.raw_mut(Field::GRAD_H).fill(T::one());
        }
        self.run_stage(Stage::Reference, Moment::at(0.0));
        // Each later stage sums anew.
        self.work.sums = Results::default();
    }

    /// Kernel sum across each contact from which on it is active: what a particle lacks to a full
    /// neighbourhood, or, where the bodies abut, exactly what is there.
    fn take_contact_thresholds(&mut self) {
        if !self
            .particles
            .columns
            .fields()
            .contains(Field::CONTACT_THRESHOLD)
        {
            return;
        }
        let rows = &self.work.sums;
        let [threshold] = self.particles.columns.many_mut([Field::CONTACT_THRESHOLD]);
        for body in &self.particles.bodies {
            let own = |slot: usize| rows.get(Output::KERNEL_SUM, 0, slot);
            let full = T::from_f64(largest(body.slots.clone(), |slot| own(slot).to_f64()));
            for slot in body.run() {
                let across = rows.get(Output::CONTACT_SUM, 0, slot);
                let lacking = (full - own(slot)).positive_part();
                let abuts = across >= lacking * T::from_f64(0.9);
                threshold[slot] = if abuts { across } else { lacking };
            }
        }
    }

    /// Lam, Shen & Gong 2002, section 4.1: the first summed density, with equation 25 at end
    /// particles, is kept as the density at rest.
    fn smooth_reference(&mut self) {
        let rows = &self.work.sums;
        let [end, rest, density, moment] = self.particles.columns.many_mut([
            Field::REFERENCE_SUM,
            Field::REFERENCE_DENSITY,
            Field::DENSITY,
            Field::CONSISTENCY_FACTOR,
        ]);
        for slot in 0..density.len() {
            let unity = rows.get(Output::UNITY, 0, slot);
            let summed =
                rows.get(Output::KERNEL_SUM, 0, slot) + rows.get(Output::CONTACT_SUM, 0, slot);
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
            self.sum(|scheme| scheme.reference.as_deref());
            let rows = &self.work.sums;
            let [end, rest, density] = self.particles.columns.many_mut([
                Field::REFERENCE_SUM,
                Field::REFERENCE_DENSITY,
                Field::DENSITY,
            ]);
            let mut change = T::zero();
            for slot in (0..density.len()).filter(|&slot| end[slot] > T::zero()) {
                let summed =
                    rows.get(Output::KERNEL_SUM, 0, slot) + rows.get(Output::CONTACT_SUM, 0, slot);
                let next = summed / rows.get(Output::UNITY, 0, slot);
                change = change.max((next / rest[slot] - T::one()).abs());
                rest[slot] = next;
                density[slot] = next;
            }
            if change <= T::from_f64(SETTLED) {
                break;
            }
        }
    }
}

/// Repetitions of equation 25 at rest at most; each brings the ends closer by a third or more.
const SETTLING_STEPS: usize = 200;

/// Relative change at which the ends have settled; in `f32` they do when nothing changes any more.
const SETTLED: f64 = 1e-15;

/// Partition of unity below which a particle counts as an end: the last of a row has 0.78, the next 0.97.
const END_UNITY: f64 = 0.9;
