//! Structures: bodies of one group that a liquid of another meets as walls that move.
//! After Antoci, Gallati & Sibilla 2007, with the wall pressure of Adami, Hu & Adams 2012.

use super::Simulation;
use super::group::Group;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::sweep::{Pass, Records, Rows, SweepInput};
use crate::term::Stage;
use std::ops::Range;

/// The body of another group whose particles a wall is made of.
#[derive(Clone, Debug)]
pub(crate) struct Structure<const D: usize> {
    /// The group of the body, and its index there.
    pub group: usize,
    pub body: usize,
    /// What its particles have been accelerated by at the last evaluation \[m/s²\], in the order of the
    /// scene: the pressure of a wall follows from it.
    pub accelerations: Vec<[f64; D]>,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Brings the walls that structures are to where their particles are now.
    pub(super) fn place_structures(&mut self) {
        self.for_each_structure(|liquid, wall, group, body| liquid.follow(wall, group, body));
    }

    /// Gives the particles of structures the force of the liquids with the rates at hand: what the
    /// liquids feel with the opposite sign, pair by pair.
    pub(super) fn load_structures(&mut self) {
        for liquid in &mut self.groups {
            liquid.sum_on_structures();
        }
        self.for_each_structure(|liquid, wall, group, body| {
            for slot in liquid.walls[wall].slots.clone() {
                if let Some(own) = liquid.slot_of_structure(wall, slot, group, body) {
                    let force = liquid.work.coupling.vector(Output::FORCE, slot);
                    group.work.rates.add(Output::FORCE, own, force);
                }
            }
        });
    }

    fn for_each_structure(
        &mut self,
        mut act: impl FnMut(&mut Group<T, D>, usize, &mut Group<T, D>, usize),
    ) {
        for k in 0..self.groups.len() {
            for wall in 0..self.groups[k].walls.len() {
                let Some(structure) = &self.groups[k].walls[wall].structure else {
                    continue;
                };
                let (group, body) = (structure.group, structure.body);
                if let Ok([liquid, group]) = self.groups.get_disjoint_mut([k, group]) {
                    act(liquid, wall, group, body);
                }
            }
        }
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Slots of walls, from the first that is a structure; these stand behind the walls of the scene.
    fn structure_slots(&self) -> Range<usize> {
        let first = self.walls.iter().find(|wall| wall.structure.is_some());
        let slots = self.particles.columns.slots();
        first.map_or(slots, |wall| wall.slots.start)..slots
    }

    /// The number of a wall particle among those of its wall as built.
    pub(super) fn rest_of(&self, wall: usize, slot: usize) -> usize {
        let wall = &self.walls[wall];
        (self.particles.ids[slot] as usize - wall.slots.start).min(wall.rest.len() - 1)
    }

    /// The slot, in the group of a structure, of the particle that a wall particle is; none if it has left.
    fn slot_of_structure(
        &self,
        wall: usize,
        slot: usize,
        group: &Self,
        body: usize,
    ) -> Option<usize> {
        let id = group.particles.bodies[body].ids.start + self.rest_of(wall, slot);
        let own = group.particles.slot_of[id];
        (own != u32::MAX).then_some(own as usize)
    }

    /// Moves a wall to the particles of the body that it is.
    fn follow(&mut self, wall: usize, group: &Self, body: usize) {
        let run = self.walls[wall].slots.start..self.walls[wall].end;
        let mass = group.particles.columns.raw(Field::MASS);
        let density = group.particles.columns.raw(Field::DENSITY);
        for slot in run {
            let at = self.rest_of(wall, slot);
            let Some(own) = self.slot_of_structure(wall, slot, group, body) else {
                self.particles.columns.raw_mut(Field::MASS)[slot] = T::zero();
                continue;
            };
            // It has the density of the liquid at rest, and the volume of what it is made of.
            let rest = self.particles.columns.raw(Field::DENSITY)[slot];
            self.particles.columns.raw_mut(Field::MASS)[slot] = rest * mass[own] / density[own];
            for field in [Field::POSITION, Field::POSITION_RESIDUAL, Field::VELOCITY] {
                let from = group.particles.columns.vectors(field).get(own);
                let to = self.particles.columns.vectors_mut(field).get_mut(slot);
                if let (Some(from), Some(to)) = (from, to) {
                    *to = *from;
                }
            }
            let [x, residual, v] = self.particles.columns.many_mut([
                Field::POSITION,
                Field::POSITION_RESIDUAL,
                Field::VELOCITY,
            ]);
            // The group of the structure lets particles re-enter a period when its lists are built.
            for boundary in &self.boundaries {
                let now = core::array::from_fn(|d| x[slot * D + d]);
                if let Some(back) = boundary.wrap(&now) {
                    back.re_enter(slot, x, residual, v);
                }
            }
            let force = group.work.rates.vector(Output::FORCE, own);
            if let Some(structure) = &mut self.walls[wall].structure {
                structure.accelerations[at] = core::array::from_fn(|d| {
                    (force[d] / mass[own] + group.evaluated_gravity[d]).to_f64()
                });
            }
        }
    }

    /// The force of the liquid on every particle of a structure with the rates at hand.
    fn sum_on_structures(&mut self) {
        let targets = self.structure_slots();
        if targets.is_empty() {
            return;
        }
        let mut rows = core::mem::take(&mut self.work.coupling);
        self.sum_on_walls(targets, &mut rows);
        self.work.coupling = rows;
    }

    /// The force of the liquid on wall particles with the rates at hand: the forces on the liquid with
    /// the opposite sign.
    pub(super) fn sum_on_walls(&self, targets: Range<usize>, rows: &mut Rows<T, D>) {
        let input = SweepInput {
            targets,
            ..self.input()
        };
        let Some(rates) = self.scheme.sweep(Stage::Rates) else {
            return;
        };
        if self.work.records_of_rates {
            rates.run(Pass::Rates, &input, &self.work.records, rows);
        } else {
            // Another sweep has used the records since.
            let mut records = Records::default();
            rates.pack(Pass::Rates, &input, &mut records);
            rates.run(Pass::Rates, &input, &records, rows);
        }
    }
}
