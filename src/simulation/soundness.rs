//! Whether a step has left a state that can be stepped on: finite numbers, and walls that did not jump.
//! Looked at after every step, the last of a run included.

use super::Simulation;
use super::limits::are_finite;
use super::population::Particles;
use crate::effect::StepProgram;
use crate::error::{Error, Problem, Result};
use crate::parallel::{GRAIN, reduce, runs};
use crate::particles::{Columns, Field};
use crate::scalar::Real;
use std::ops::Range;

/// Share of a full neighbourhood below which a particle has no neighbours to be measured by.
const ALONE: f64 = 1e-6;

/// The name under which gas of negative energy is counted.
pub(super) const NEGATIVE_ENERGY: &str = "negative internal energy";

/// Share of the spacing by which a wall may move beside what its velocity gives.
const JUMP: f64 = 0.5;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Refuses a state in which a number is not finite.
    pub(super) fn check_state(&mut self) -> Result<()> {
        for group in &mut self.groups {
            group.count(NEGATIVE_ENERGY, negative_energies(&group.particles));
        }
        for group in &self.groups {
            if let Some(slot) = unsound(&group.particles, &group.scheme.program) {
                return Err(self.broken(group, slot));
            }
        }
        let impulse = self.impulses.values().find(|impulse| !impulse.is_finite());
        let work = self.work.iter().flat_map(|work| [work.load, work.wall]);
        let mut sums = impulse.into_iter().chain(work);
        if let Some(value) = sums.find(|value| !value.is_finite()) {
            return Err(Error::NotFinite {
                quantity: "impulse or work",
                value,
                body: "all".into(),
                particle: 0,
                position: Vec::new(),
                time: self.time,
                step: self.steps,
            });
        }
        Ok(())
    }

    /// Particles without neighbours, where density is measured from the reference configuration: one for each body.
    pub(crate) fn isolated(&self) -> Vec<Problem> {
        let measured = self.groups.iter().filter(|group| {
            group.scheme.density.has_reference() && group.scheme.consistent_at_rest
        });
        measured
            .flat_map(|group| {
                let reach = group.scheme.kernel.support * group.neighborhood.smoothing_length;
                isolated(&group.particles, reach)
            })
            .collect()
    }

    /// Refuses a step of `dt` \[s\] in which a wall moves beside its own velocity, as one that jumps does.
    pub(super) fn check_walls(&self, dt: f64) -> Result<()> {
        let (time, end) = (self.time, self.time + dt);
        let spacing = self.spacing();
        for wall in self.groups.iter().flat_map(|group| &group.walls) {
            let Some(motion) = &wall.motion else {
                continue;
            };
            let (before, after) = (motion.pose(time), motion.pose(end));
            let beside = |x: &[f64; D]| {
                let [from, to] = [&before, &after].map(|pose| (pose.of(0, x), pose.of(1, x)));
                let off = (0..D).map(|d| to.0[d] - from.0[d] - 0.5 * dt * (from.1[d] + to.1[d]));
                off.map(|off| off * off).sum::<f64>().sqrt()
            };
            // What is not a number is the farthest of all.
            let farther = |most: f64, x: &[f64; D]| {
                let off = beside(x);
                if off <= most { most } else { off }
            };
            let off = wall.rest.iter().fold(0.0, farther);
            if off.is_nan() || off > JUMP * spacing {
                return Err(Error::WallJump {
                    wall: wall.name.clone(),
                    distance: off,
                    time,
                    end,
                });
            }
        }
        Ok(())
    }
}

/// Kinetic and internal energy \[J\], by mass \[kg\], velocity \[m/s\] and specific internal energy \[J/kg\].
pub(super) fn energy_of<T: Real, const D: usize>(mass: T, v: &[T; D], internal: Option<&T>) -> f64 {
    let internal = internal.map_or(0.0, |energy| energy.to_f64());
    mass.to_f64() * (0.5 * v.iter().map(|v| v.to_f64().powi(2)).sum::<f64>() + internal)
}

/// The first particle of each body that has no neighbours, by its moment at rest; `reach` \[m\] is how far it looks.
fn isolated<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    reach: f64,
) -> impl Iterator<Item = Problem> {
    let moments = particles.columns.raw(Field::CONSISTENCY_FACTOR);
    let alone = |slot: &usize| {
        let moment = moments.get(*slot).map_or(1.0, |moment| moment.to_f64());
        moment <= ALONE
    };
    particles.bodies.iter().filter_map(move |body| {
        let slot = body.slots.clone().find(alone)?;
        Some(Problem::Isolated {
            body: body.name.clone(),
            particle: particles.ids[slot] as usize - body.ids.start,
            position: particles.position(slot).to_vec(),
            reach,
        })
    })
}

/// How many particles of gas have a negative internal energy: its law takes it as none
/// ([`IdealGas::minimum_energy`](crate::material::eos::IdealGas::minimum_energy)), and the ledger as it is.
fn negative_energies<T: Real, const D: usize>(particles: &Particles<T, D>) -> u64 {
    let energy = particles.columns.raw(Field::ENERGY);
    let mut negative = 0;
    for body in &particles.bodies {
        let own = energy.get(body.slots.clone()).unwrap_or_default();
        if !own.is_empty() && body.material.is_gas() {
            let below = |_, run: Range<usize>| {
                let energies = own[run].iter();
                energies.filter(|energy| **energy < T::zero()).count() as u64
            };
            let all = runs(0..own.len(), GRAIN);
            negative = reduce(all, negative, below, |a, b| a + b);
        }
    }
    negative
}

/// The first slot whose state is not finite, or whose density is not positive.
fn unsound<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    program: &StepProgram<T, D>,
) -> Option<usize> {
    let sound = |run: Range<usize>| {
        is_sound(&particles.columns, run.clone()) && are_finite(program, &particles.columns, run)
    };
    particles.bodies.iter().find_map(|body| {
        let unsound = |_, run: Range<usize>| {
            // Nearly always all are sound, and nobody asks which is not.
            if sound(run.clone()) {
                return usize::MAX;
            }
            let mut slots = run.into_iter();
            let first = slots.find(|&slot| !sound(slot..slot + 1));
            first.unwrap_or(usize::MAX)
        };
        let chunks = runs(body.slots.clone(), GRAIN);
        let first = reduce(chunks, usize::MAX, unsound, usize::min);
        (first < usize::MAX).then_some(first)
    })
}

/// Whether place, density and energy are finite in all of a run, and densities positive.
fn is_sound<T: Real, const D: usize>(columns: &Columns<T, D>, run: Range<usize>) -> bool {
    let [x, v] =
        [Field::POSITION, Field::VELOCITY].map(|field| &columns.vectors(field)[run.clone()]);
    let [density, mass] =
        [Field::DENSITY, Field::MASS].map(|field| &columns.raw(field)[run.clone()]);
    let internal = columns.raw(Field::ENERGY).get(run).unwrap_or_default();
    let mut sound = true;
    for (n, density) in density.iter().enumerate() {
        let energy = energy_of(mass[n], &v[n], internal.get(n));
        let place: f64 = x[n].iter().map(|x| x.to_f64()).sum();
        let density = density.to_f64();
        sound &= (place + density + energy).is_finite() && density > 0.0;
    }
    sound
}
