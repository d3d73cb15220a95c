//! Forces on the particles of a group that others than its sweeps change: couplings, and what is held.
//! A group that sub-cycles has those of couplings apart from its own.

use super::population::Particles;
use super::workspace::Workspace;
use crate::particles::{Field, Output};
use crate::scalar::Real;

/// The forces of the last evaluation, or those of couplings where a group sub-cycles.
pub(crate) enum Forces<'a, T: Real, const D: usize> {
    Own(&'a mut Workspace<T, D>),
    Apart(&'a mut [[T; D]]),
}

impl<T: Real, const D: usize> Forces<'_, T, D> {
    /// Whether they are those of couplings alone.
    pub fn are_apart(&self) -> bool {
        matches!(self, Self::Apart(_))
    }

    /// The acceleration \[m/s²\] that goes with them.
    pub fn gravity(&self) -> [f64; D] {
        match self {
            Self::Own(work) => work.evaluated_gravity.map(Real::to_f64),
            Self::Apart(_) => [0.0; D],
        }
    }

    pub fn on(&self, slot: usize) -> [T; D] {
        match self {
            Self::Own(work) => work.rates.vector(Output::FORCE, slot),
            Self::Apart(forces) => forces[slot],
        }
    }

    pub fn set(&mut self, slot: usize, force: [T; D]) {
        match self {
            Self::Own(work) => work.rates.set(Output::FORCE, slot, force),
            Self::Apart(forces) => forces[slot] = force,
        }
    }

    pub fn add(&mut self, slot: usize, force: [T; D]) {
        match self {
            Self::Own(work) => work.rates.add(Output::FORCE, slot, force),
            Self::Apart(forces) => {
                for d in 0..D {
                    forces[slot][d] += force[d];
                }
            }
        }
    }

    /// Replaces the force on a particle of a body by another, by its mass, and says what that gives \[N\].
    pub fn replace(
        &mut self,
        particles: &Particles<T, D>,
        (body, id): (usize, u32),
        by: impl Fn(f64) -> [f64; D],
    ) -> [f64; D] {
        let mut given = [0.0; D];
        for slot in particles.slots_of(body, id).rev() {
            let mass = particles.columns.raw(Field::MASS)[slot].to_f64();
            let (before, after) = (self.on(slot), by(mass).map(T::from_f64));
            given = core::array::from_fn(|d| (after[d] - before[d]).to_f64());
            self.set(slot, after);
        }
        given
    }
}
