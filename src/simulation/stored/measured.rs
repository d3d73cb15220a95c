//! The present energies of a part of a scene: stored, dissipated, kinetic, and what work has left for them.
//! One sum over its particles, by the laws of materials and the columns of effects.

use super::parts::has_energy;
use crate::collective::{Collective, Least, over};
use crate::particles::Field;
use crate::scalar::Real;
use crate::simulation::Simulation;
use crate::simulation::contact::Couple;
use crate::simulation::energy::kinetic;
use crate::simulation::group::Group;
use crate::simulation::population::BodyState;
use crate::simulation::side::Side;

/// Roundings of m c² by which a stored energy, and roundings by which an integrated one, may be off.
const ROUNDINGS: [f64; 2] = [4.0, 1e3];

/// The present state of a part.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Measured {
    pub stored: f64,
    pub dissipated: f64,
    pub kinetic: f64,
    /// What work has left for it: internal energy, or minus the work of a coupling, or the work of loads and walls less
    /// kinetic energy. With the kinetic energy it changes by what is outside alone.
    pub work: f64,
    /// By how much rounding may have them off.
    pub rounding: f64,
    pub population: [u64; 2],
    /// The particle with the largest gain of its own, as group and slot.
    pub at: (usize, usize),
}

impl Measured {
    /// Stored energy less the work that is left for it, over what that was when the account was opened.
    pub fn gain(&self, base: f64) -> f64 {
        self.stored + self.dissipated - self.work - base
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Whether all that follows from positions has been evaluated at the present ones.
    pub(super) fn stands(&self) -> bool {
        let step = self.state.last_vote.map_or(0.0, |vote| vote.step);
        let off = (self.state.evaluated - self.state.time).abs();
        self.state.rates_at_hand && off <= 1e-9 * step + 2e-12 * self.state.time.abs()
    }

    /// The present state of a part of which something can be said.
    pub(super) fn measured(&self, k: usize) -> core::result::Result<Measured, &'static str> {
        if !self.stands() {
            return Err("nothing has been evaluated at the present state");
        }
        let lost = "the pressure of a material depends on internal energy";
        let mut sum = Measured::default();
        if let Some(group) = self.state.groups.get(k) {
            add_bodies(&mut sum, group, k).ok_or(lost)?;
            // What laws have worked they have taken from what they store.
            sum.work -= self.work_of_laws(Some(k));
            return Ok(sum);
        }
        if let Some(couple) = self.couple_of(k) {
            for (number, body) in couple.sides.iter().filter_map(Side::body) {
                let group = &self.state.groups[number];
                let body = &group.particles.bodies[body];
                let columns = &group.particles.columns;
                sum.kinetic += over(body.slots.clone(), |slot| kinetic(columns, slot));
                sum.population[0] += body.slots.len() as u64;
                sum.at = (number, body.slots.start);
            }
            sum.stored = couple.acting.stored;
            sum.dissipated = couple.acting.heat;
            sum.work = -couple.work[0] - couple.work[1];
            sum.at = self.strongest(couple).unwrap_or(sum.at);
            // What was taken from what is supplied, if the sides are the same body, is counted once.
            if couple.is_self() {
                sum.kinetic *= 0.5;
            }
            return Ok(sum);
        }
        for (number, group) in self.state.groups.iter().enumerate() {
            add_bodies(&mut sum, group, number).ok_or(lost)?;
        }
        for couple in &self.state.couples {
            sum.stored += couple.acting.stored;
            sum.dissipated += couple.acting.heat;
        }
        let work = self.state.work.unwrap_or_default();
        let removed = self.removed().kinetic;
        sum.work = work.load + work.wall - sum.kinetic - removed;
        Ok(sum)
    }

    /// The particle on which a coupling acts most.
    fn strongest(&self, couple: &Couple<T, D>) -> Option<(usize, usize)> {
        let mut found = (0.0, None);
        for (side, forces) in couple.acting.forces.iter().enumerate() {
            let Some((number, body)) = couple.sides[side].body() else {
                continue;
            };
            let particles = &self.state.groups[number].particles;
            for (id, force) in forces {
                let square: f64 = force.iter().map(|f| f.to_f64().powi(2)).sum();
                if square > found.0 {
                    found = (
                        square,
                        particles
                            .slots_of(body, *id)
                            .next()
                            .map(|slot| (number, slot)),
                    );
                }
            }
        }
        found.1
    }
}

/// What a particle stores and has dissipated by booked means, over its mass \[J/kg\].
pub(super) fn energies<T: Real, const D: usize>(
    group: &Group<T, D>,
    body: &BodyState<T>,
    slot: usize,
) -> Option<[f64; 2]> {
    let (columns, program) = (&group.particles.columns, &group.scheme.program);
    let at = |field: &Field| {
        let value = columns.raw(*field).get(slot);
        value.map_or(0.0, |value| value.to_f64())
    };
    let mut stored: f64 = program.stored.iter().map(at).sum();
    if program.presses {
        let eos = body.material.eos();
        stored += eos.stored_energy(at(&Field::DENSITY), at(&Field::ENERGY))?;
    }
    Some([stored, program.dissipated.iter().map(at).sum()])
}

/// Adds the bodies of a group; `None` if one stores what cannot be said.
fn add_bodies<T: Real, const D: usize>(
    sum: &mut Measured,
    group: &Group<T, D>,
    number: usize,
) -> Option<()> {
    let columns = &group.particles.columns;
    let [mass, internal, sound] =
        [Field::MASS, Field::ENERGY, Field::SOUND_SPEED].map(|field| columns.raw(field));
    let mut all = Collective::new();
    for body in &group.particles.bodies {
        all.add_range(body.slots.clone(), |slot| {
            let m = mass[slot].to_f64();
            let known = energies(group, body, slot);
            let [stored, dissipated] = known.unwrap_or_default().map(|own| m * own);
            let own = m * internal.get(slot).map_or(0.0, |e| e.to_f64());
            let moving = kinetic(columns, slot);
            let stiff = m * sound.get(slot).map_or(0.0, |c| c.to_f64().powi(2));
            let gain = if has_energy(group) {
                stored + dissipated - own
            } else {
                stored + moving
            };
            let sums = [stored, dissipated, own, moving, stiff, own.abs()];
            (sums, known.is_some(), Least(-gain, slot))
        });
        sum.population[0] += body.slots.len() as u64;
    }
    let ([stored, dissipated, work, kinetic, stiff, size], known, Least(_, slot)) = all.value();
    if !known {
        return None;
    }
    sum.stored += stored;
    sum.dissipated += dissipated;
    sum.work += work;
    sum.kinetic += kinetic;
    if slot < usize::MAX {
        sum.at = (number, slot);
    }
    sum.population[1] += group.particles.removed.particles;
    sum.rounding += T::EPSILON * (ROUNDINGS[0] * stiff + ROUNDINGS[1] * size);
    Some(())
}
