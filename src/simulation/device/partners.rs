//! The pairs of couplings by forces, which the host finds, and what goes between it and a device of them.
//! A device adds up what forces work, particle by particle, until the host asks for it.

use super::Offloaded;
use super::contacts::{ContactStep, force, listed, moved, stored, width, work};
use super::transfer::{Array, Numbers};
use crate::error::Result;
use crate::scalar::Real;

/// The pairs of a side, particle by particle.
#[derive(Clone, Debug, Default)]
pub struct Partners {
    /// Where those of each slot start in the list, and where the last ends.
    pub starts: Vec<u32>,
    /// Slots of the other side; of a body that meets itself twice that, and one more where the particle is the second of the pair.
    pub list: Vec<u32>,
    /// Distances as built \[m\], if these are read.
    pub rest: Vec<f64>,
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// The couplings by forces, in the order of the scene. What others take as a contact is a number among these.
    #[must_use]
    pub fn couplings(&self) -> &[ContactStep] {
        &self.contacts
    }

    /// The pairs of a side of a coupling as they were last [listed](Self::list_contact).
    #[must_use]
    pub fn partners(&self, contact: usize, side: usize) -> Partners {
        let state = &self.simulation.state;
        let (couple, groups) = (&state.couples[contact], &state.groups);
        let (is_self, as_built) = (couple.is_self(), couple.coupling.as_built());
        let [run, _] = &self.contacts[contact].sides[side].slots;
        let list = &couple.list;
        let side_of = |place: usize| if is_self { 0 } else { place };
        let mut entries = Vec::new();
        for pair in &list.pairs {
            let ids = pair.map(|row| list.rows[row as usize]);
            let mut rest = 0.0;
            if as_built {
                let [x, y] = [0, 1].map(|k| list.listed[side_of(k)].places[ids[k] as usize]);
                let square = x.iter().zip(&y).map(|(x, y)| (x - y).powi(2));
                rest = square.sum::<f64>().sqrt();
            }
            let places = if is_self { 0..2 } else { side..side + 1 };
            for place in places {
                let other = 1 - place;
                let [own, partner] = [place, other].map(|place| {
                    let slot = couple.sides[side_of(place)].slot(ids[place], groups);
                    slot.unwrap_or_default()
                });
                let body = &groups[own.0].particles;
                let body = &body.bodies[body.body_of(own.1)];
                let entry = if is_self {
                    2 * partner.1 + place
                } else {
                    partner.1
                };
                let slots = body.with_repeats(own.1);
                entries.extend(slots.map(|slot| (slot - run.start, entry as u32, rest)));
            }
        }
        entries.sort_by_key(|own| own.0);
        let start = |slot| entries.partition_point(|own| own.0 < slot) as u32;
        Partners {
            starts: (0..=run.len()).map(start).collect(),
            list: entries.iter().map(|own| own.1).collect(),
            rest: entries
                .iter()
                .filter(|_| as_built)
                .map(|own| own.2)
                .collect(),
        }
    }

    /// Lists the pairs of a coupling anew at a time \[s\], for which the host must have the state of both groups; what a device is told
    /// then, with the groups.
    pub fn list_contact(&mut self, contact: usize, time: f64) -> Vec<(usize, Numbers)> {
        let state = &mut *self.simulation.state;
        state.couples[contact].list(&state.groups, time);
        let sides = 0..self.contacts[contact].sides.len();
        let of = |side: usize| {
            (
                self.contacts[contact].sides[side].group,
                self.contact_sent(contact, side),
            )
        };
        sides.map(of).collect()
    }

    /// Takes what has been [found](ContactStep::found) of the particles of the sides of a coupling, and whether its list has served.
    /// If not, what was found does not count.
    ///
    /// # Errors
    /// As [`Simulation::run_until`], where forces are no numbers.
    pub fn take_contact(&mut self, contact: usize, found: &[&[f64]]) -> Result<bool> {
        let time = self.simulation.state.evaluated;
        let couple = &mut self.simulation.state.couples[contact];
        let of = |column: usize| found.iter().map(move |side| side[column - stored::<D>()]);
        let gone = of(moved::<D>()).map(f64::sqrt).sum::<f64>();
        let gone = if couple.is_self() { 2.0 * gone } else { gone };
        let listed = !couple.list.listed[0].places.is_empty();
        if !listed || (!couple.coupling.as_built() && gone > couple.list.skin) {
            return Ok(false);
        }
        let is_self = couple.is_self();
        let acting = &mut couple.acting;
        let at = stored::<D>();
        acting.stored = of(at).chain(of(at + 1)).sum();
        acting.pairs = of(at + 2).sum::<f64>().round() as usize;
        let deepest = of(at + 3).fold(0.0, f64::max);
        acting.penetration = [deepest, acting.penetration[1].max(deepest)];
        acting.step = of(at + 4).fold(f64::INFINITY, f64::min);
        let first = &found[0][force::<D>() - at..];
        acting.force = core::array::from_fn(|d| if is_self { 0.0 } else { first[d] });
        acting.time = time;
        self.simulation.check_couples(time)?;
        Ok(true)
    }

    /// Sides of couplings in a group: the number of the coupling, and that of the side.
    fn sides_in(&self, group: usize) -> Vec<[usize; 2]> {
        let contacts = self.contacts.iter().enumerate();
        let sides = contacts.flat_map(|(k, own)| {
            let sides = own.sides.iter().enumerate();
            sides
                .filter(|(_, own)| own.group == group)
                .map(move |own| [k, own.0])
        });
        sides.collect()
    }

    /// The forces of a side, no work yet, and where its particles were listed.
    fn contact_sent(&self, contact: usize, side: usize) -> Numbers {
        let (couple, own) = (
            &self.simulation.state.couples[contact],
            &self.contacts[contact].sides[side],
        );
        let particles = &self.simulation.state.groups[own.group].particles;
        let slots = particles.columns.slots();
        let mut all = vec![0.0; (width::<D>() - force::<D>()) * slots];
        let body = particles.body_of(own.slots[0].start);
        let mut put = |id: u32, at: usize, numbers: [f64; D]| {
            for slot in particles.slots_of(body, id) {
                for d in 0..D {
                    all[(at - force::<D>() + d) * slots + slot] = numbers[d];
                }
            }
        };
        for (id, own) in &couple.acting.forces[side] {
            put(*id, force::<D>(), own.map(Real::to_f64));
        }
        for (id, place) in couple.list.listed[side].places.iter().enumerate() {
            put(id as u32, listed::<D>(), *place);
        }
        Numbers {
            array: Array::Columns,
            at: (own.first + force::<D>()) * slots,
            numbers: all,
        }
    }

    /// What a device is told of the couplings of a group.
    pub(super) fn contacts_sent(&self, group: usize) -> Vec<Numbers> {
        let sides = self.sides_in(group).into_iter();
        sides
            .map(|[contact, side]| self.contact_sent(contact, side))
            .collect()
    }

    /// What the host takes of the couplings of a group: forces, and their work.
    pub(super) fn contacts_wanted(&self, group: usize) -> Vec<(Array, usize, usize)> {
        let slots = self.columns(group).slots();
        let sides = self.sides_in(group).into_iter();
        let of = |[contact, side]: [usize; 2]| {
            let first = self.contacts[contact].sides[side].first + force::<D>();
            (Array::Columns, first * slots, (D + 1) * slots)
        };
        sides.map(of).collect()
    }

    /// Takes that back, side by side; what a device is told then.
    pub(super) fn contacts_taken<'a>(
        &mut self,
        group: usize,
        mut next: impl FnMut() -> &'a [f64],
    ) -> Vec<Numbers> {
        let mut rest = Vec::new();
        for [contact, side] in self.sides_in(group) {
            let (numbers, own) = (next(), &self.contacts[contact].sides[side]);
            let state = &mut *self.simulation.state;
            let particles = &state.groups[group].particles;
            let slots = particles.columns.slots();
            let couple = &mut state.couples[contact];
            let body = particles.body_of(own.slots[0].start);
            let forces = &mut couple.acting.forces[side];
            forces.clear();
            let ids = 0..particles.bodies[body].ids.len() as u32;
            for id in ids {
                let slot = particles.slots_of(body, id).start;
                let force: [T; D] =
                    core::array::from_fn(|d| T::from_f64(numbers[d * slots + slot]));
                if force.iter().any(|own| *own != T::zero()) {
                    forces.push((id, force));
                }
                couple.work[side] += numbers[D * slots + slot];
            }
            // Sums that were taken are not taken again.
            rest.push(Numbers {
                array: Array::Columns,
                at: (own.first + work::<D>()) * slots,
                numbers: vec![0.0; slots],
            });
        }
        rest
    }
}
