//! Clamps: particles that keep their velocity whatever pulls at them, and what that takes.
//! The clamp bears what acts on them with the opposite sign, so the ledger closes.

use super::Simulation;
use super::group::{CLAMPS, Group};
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::sweep::Reaction;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Whether something is clamped.
    pub(super) fn has_clamps(&self) -> bool {
        self.groups.iter().any(Group::has_clamps)
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    pub(super) fn has_clamps(&self) -> bool {
        !self.particles.columns.raw(Field::CLAMPED).is_empty()
    }

    /// Takes all forces and loads from clamped particles, with the rates at hand, and remembers who bears them.
    pub(super) fn hold(&mut self) {
        if !self.has_clamps() {
            return;
        }
        let columns = &self.particles.columns;
        let (clamped, mass) = (columns.raw(Field::CLAMPED), columns.raw(Field::MASS));
        let rates = &mut self.work.rates;
        for (block, body) in self.particles.bodies.iter().enumerate() {
            let mut force = [0.0; D];
            for slot in body.run().filter(|&slot| clamped[slot] > T::zero()) {
                // What is left makes up for the uniform loads, which are no forces.
                let left = self.evaluated_gravity.map(|gravity| -mass[slot] * gravity);
                let acted = rates.vector(Output::FORCE, slot);
                rates.put(Output::FORCE, slot, left);
                // Slots behind the last particle repeat it.
                if slot < body.slots.end {
                    for d in 0..D {
                        force[d] += (left[d] - acted[d]).to_f64();
                    }
                }
            }
            if force.iter().any(|force| *force != 0.0) {
                rates.react(Reaction {
                    on: block as u32,
                    from: CLAMPS,
                    force,
                });
            }
        }
    }
}
