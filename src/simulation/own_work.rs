//! The work of pair forces in a kick without a sweep: from their power in the rates, and the own force of each particle.
//! Total-Lagrangian schemes heat with it; the work of others is in `state`.

use super::group::Group;
use crate::clock::Instant;
use crate::parallel::{GRAIN, cut, for_each};
use crate::particles::{Field, Output};
use crate::scalar::{MOST_LANES, Real};
use crate::scheme::EnergyForm;
use crate::sweep::Results;

/// The power P of the rates is that of the velocities u with which they were summed. P − Fᵢ·(v̄ᵢ − uᵢ) adds up to −Σ Fᵢ·v̄ᵢ over
/// all particles, whatever u is, as the work of all pairs with v̄ does. Neighbours stay, so slots do from evaluation to kick.
impl<T: Real, const D: usize> Group<T, D> {
    /// Whether work is that of the pair forces of the rates.
    pub(super) fn keeps_rates_of_pairs(&self) -> bool {
        self.scheme.energy == EnergyForm::Compatible && !self.scheme.sweeps_work()
    }

    /// Keeps forces and power of pairs, before others add forces, and the velocities that they were summed with.
    pub(super) fn keep_rates_of_pairs(&mut self) {
        let start = Instant::now();
        let [summed, v] =
            (self.particles.columns).many_mut([Field::MEAN_VELOCITY, Field::VELOCITY]);
        summed.copy_from_slice(v);
        self.work.worked.copy(&self.work.rates);
        self.work.phases.work += start.elapsed();
    }

    /// e ← e + dt (P − Fᵢ·(v̄ᵢ − uᵢ))/m with the mean velocities v̄ of a kick.
    pub(super) fn heat_by_own_forces(&mut self, dt: f64) {
        let gravity = self.work.evaluated_gravity;
        let (rates, worked) = (&self.work.rates, &self.work.worked);
        let (half, dt) = (T::from_f64(0.5 * dt), T::from_f64(dt));
        let [energy, mass, v, summed] = self.particles.columns.many_mut([
            Field::ENERGY,
            Field::MASS,
            Field::VELOCITY,
            Field::MEAN_VELOCITY,
        ]);
        let (mass, v, summed) = (&*mass, &*v, &*summed);
        let row = Results::<T, D>::WIDTH;
        for_each(cut(energy, GRAIN), |piece, energy| {
            for (n, energy) in energy.chunks_exact_mut(row).enumerate() {
                let first = piece * GRAIN + n * row;
                let (Some(forces), Some(own), Some(power)) = (
                    rates.row(Output::FORCE, first),
                    worked.row(Output::FORCE, first),
                    worked.row(Output::POWER, first),
                ) else {
                    continue;
                };
                let mass = &mass[first..][..row];
                let [v, summed] = [v, summed].map(|column| &column[first * D..][..row * D]);
                let mut spent = [T::zero(); MOST_LANES];
                for d in 0..D {
                    let [forces, own] = [forces, own].map(|sums| &sums[d * row..][..row]);
                    for lane in 0..row {
                        let a = forces[lane] / mass[lane] + gravity[d];
                        let since = v[lane * D + d] + half * a - summed[lane * D + d];
                        spent[lane] += own[lane] * since;
                    }
                }
                for lane in 0..row {
                    energy[lane] += dt * (power[lane] - spent[lane]) / mass[lane];
                }
            }
        });
    }
}
