//! The driver of couplings: brings structures to the liquids that they are walls of, and hands forces over.
//! What a coupling does is its own; the order, the search, the ledger and the opposite forces are here.

use super::Simulation;
use super::group::Group;
use super::population::{BodyState, Particles};
use super::spin::Spins;
use super::walls::WallState;
use super::workspace::Workspace;
use crate::boundary::Boundary;
use crate::coupling::{CoupledParticle, Coupling};
use crate::error::{Error, Result};
use crate::particles::{Columns, Field, Output};
use crate::scalar::Real;
use crate::term::TermDoc;
use std::sync::Arc;

/// The body of another group whose particles a wall is made of.
#[derive(Clone, Debug)]
pub(crate) struct Structure<T, const D: usize> {
    pub coupling: Arc<dyn Coupling<T, D>>,
    /// The group of the body, and its index there.
    pub group: usize,
    pub body: usize,
    /// What its particles have been accelerated by at the last evaluation \[m/s²\], in the order of the
    /// scene: the pressure of a wall follows from it. The mean since the evaluation before where the body sub-cycles.
    pub accelerations: Vec<[f64; D]>,
    /// How it turns at each of its particles at that evaluation, where liquid sticks to it.
    pub spins: Spins<D>,
    /// Velocities \[m/s\] at that evaluation where the body sub-cycles; else none.
    pub before: Vec<[f64; D]>,
    /// The time \[s\] of that evaluation; no number before the first.
    pub evaluated: f64,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// What its groups do to each other: every coupling that acts, with its equation and source, once.
    #[must_use]
    pub fn couplings(&self) -> Vec<TermDoc> {
        let walls = self.state.groups.iter().flat_map(|group| &group.walls);
        let walls = walls.filter_map(|wall| Some(&wall.structure.as_ref()?.coupling));
        let mut all: Vec<TermDoc> = Vec::new();
        for coupling in walls.chain(self.state.couples.iter().map(|couple| &couple.coupling)) {
            let own = coupling.document();
            if !all.contains(&own) {
                all.push(own);
            }
        }
        all
    }

    /// Brings the walls that structures are to where their particles are now, at `time` \[s\]; whether all rates are
    /// about to be evaluated.
    pub(super) fn place_structures(&mut self, time: f64, evaluated: bool) {
        self.for_each_structure(|liquid, wall, group| {
            let (own, boundaries) = (&mut liquid.particles, &liquid.boundaries);
            let others = (&group.particles, &group.work);
            liquid.walls[wall].follow(own, boundaries, others, (time, evaluated));
        });
    }

    /// Gives bodies of other groups the forces of couplings, with the rates at hand.
    pub(super) fn couple(&mut self) {
        for group in &mut self.state.groups {
            if let Some(apart) = &mut group.sub_cycle {
                apart.forces.clear();
                apart.forces.resize(group.particles.mobile, [T::zero(); D]);
            }
            group.sum_on_structures();
        }
        // What the liquids feel with the opposite sign, pair by pair.
        self.for_each_structure(|liquid, wall, group| {
            let wall = &liquid.walls[wall];
            for slot in wall.slots.clone() {
                let at = wall.rest_of(&liquid.particles.ids, slot);
                if let Some(own) = wall.slot_in(&group.particles, at) {
                    group.push(own, liquid.work.coupling.vector(Output::FORCE, slot));
                }
            }
        });
        self.act_in_pairs();
    }

    fn for_each_structure(
        &mut self,
        mut act: impl FnMut(&mut Group<T, D>, usize, &mut Group<T, D>),
    ) {
        for k in 0..self.state.groups.len() {
            for wall in 0..self.state.groups[k].walls.len() {
                let Some(structure) = &self.state.groups[k].walls[wall].structure else {
                    continue;
                };
                let of = structure.group;
                if let Ok([liquid, group]) = self.state.groups.get_disjoint_mut([k, of]) {
                    act(liquid, wall, group);
                }
            }
        }
    }

    /// Refuses forces of couplings that are no numbers.
    pub(super) fn check_couples(&self, time: f64) -> Result<()> {
        for own in &self.state.couples {
            let forces = own.acting.forces.iter().flatten();
            let numbers = forces.flat_map(|(_, force)| force.iter().map(|f| f.to_f64()));
            let more = [own.acting.stored, own.acting.heat];
            if let Some(value) = numbers.chain(more).find(|x| !x.is_finite()) {
                let [first, second] = own
                    .sides
                    .each_ref()
                    .map(|side| side.name(&self.state.groups));
                return Err(Error::Function {
                    what: format!(
                        "coupling {} of `{first}` and `{second}`",
                        own.coupling.name()
                    ),
                    value,
                    time,
                    must_be: "forces, stored energy and heat of pairs must be finite wherever two particles are",
                });
            }
        }
        Ok(())
    }

    /// Forces between blocks at the last evaluation, with their scene indices: which feels, which exerts, and the
    /// force \[N\]; of a group that sub-cycles alone, or of all others together with what couples them.
    pub(super) fn reactions(
        &self,
        alone: Option<usize>,
    ) -> impl Iterator<Item = (usize, usize, [f64; D])> {
        let own = self.stepping(alone).flat_map(Group::reactions);
        let couples = self.state.couples.iter().filter(move |_| alone.is_none());
        let first_boundary = self.body_count() + self.wall_count();
        own.chain(couples.flat_map(move |couple| {
            let [first, second] = couple.indices;
            let force = couple.acting.force;
            let back = force.map(|force| -force);
            let images = couple.acting.images.iter().zip(couple.indices);
            let images = images.flat_map(move |(forces, on)| {
                let forces = forces.iter().enumerate();
                forces.map(move |(b, force)| (on, first_boundary + b, *force))
            });
            [(first, second, force), (second, first, back)]
                .into_iter()
                .chain(images)
        }))
    }

    /// A group that sub-cycles alone, or all others.
    pub(super) fn stepping(&self, alone: Option<usize>) -> impl Iterator<Item = &Group<T, D>> {
        let groups = self.state.groups.iter().enumerate();
        let groups = groups.filter(move |(k, group)| group.steps_with(alone, *k));
        groups.map(|(_, group)| group)
    }

    /// The bodies of these.
    pub(super) fn bodies_that_step(
        &self,
        alone: Option<usize>,
    ) -> impl Iterator<Item = (&Group<T, D>, &BodyState<T>)> {
        let groups = self.stepping(alone);
        groups.flat_map(|group| group.particles.bodies.iter().map(move |body| (group, body)))
    }
}

/// What couplings see of the particle in a slot.
pub(super) fn coupled_particle<T: Real, const D: usize>(
    columns: &Columns<T, D>,
    slot: usize,
    spacing: T,
) -> CoupledParticle<T, D> {
    CoupledParticle {
        position: columns.vectors(Field::POSITION)[slot],
        velocity: columns.vectors(Field::VELOCITY)[slot],
        mass: columns.raw(Field::MASS)[slot],
        density: columns.raw(Field::DENSITY)[slot],
        spacing,
        stiffness: T::zero(),
        sum: T::zero(),
        gradient: [T::zero(); D],
        pressure: T::zero(),
    }
}

/// Walls that are structures.
impl<T: Real, const D: usize> WallState<T, D> {
    /// The slot, in the group of the structure, of the particle that is the wall's with that number as built; none if it has
    /// left.
    fn slot_in(&self, others: &Particles<T, D>, at: usize) -> Option<usize> {
        let body = self.structure.as_ref()?.body;
        let slot = others.slot_of[others.bodies[body].ids.start + at];
        (slot != u32::MAX).then_some(slot as usize)
    }

    /// Moves it to the particles of the body that it is, as these are at `time` \[s\].
    fn follow(
        &mut self,
        own: &mut Particles<T, D>,
        boundaries: &[Arc<dyn Boundary<D>>],
        (others, work): (&Particles<T, D>, &Workspace<T, D>),
        (time, evaluated): (f64, bool),
    ) {
        for slot in self.slots.start..self.end {
            let at = self.rest_of(&own.ids, slot);
            let Some(other) = self.slot_in(others, at) else {
                own.columns.raw_mut(Field::MASS)[slot] = T::zero();
                continue;
            };
            if let Some(structure) = &mut self.structure {
                let spacing = T::from_f64(others.bodies[structure.body].spacing);
                let particle = coupled_particle(&others.columns, other, spacing);
                let rest = own.columns.raw(Field::DENSITY)[slot];
                let mass = structure.coupling.wall_mass(rest, &particle);
                own.columns.raw_mut(Field::MASS)[slot] = mass;
                let elapsed = if evaluated {
                    time - structure.evaluated
                } else {
                    0.0
                };
                structure.accelerate(at, other, (others, work), elapsed);
            }
            for field in [Field::POSITION, Field::POSITION_RESIDUAL, Field::VELOCITY] {
                let from = others.columns.vectors(field).get(other);
                let to = own.columns.vectors_mut(field).get_mut(slot);
                if let (Some(from), Some(to)) = (from, to) {
                    *to = *from;
                }
            }
            let [x, residual, v] =
                own.columns
                    .many_mut([Field::POSITION, Field::POSITION_RESIDUAL, Field::VELOCITY]);
            // The group of the structure lets particles re-enter a period when its lists are built.
            for boundary in boundaries {
                let now = core::array::from_fn(|d| x[slot * D + d].to_f64());
                if let Some(back) = boundary.wrap(&now, time) {
                    back.to_scalar().re_enter(slot, x, residual, v);
                }
            }
        }
        let first = self.slots.start;
        if let Some(structure) = self.structure.as_mut().filter(|_| evaluated) {
            structure.evaluated = time;
            let columns = &own.columns;
            let (x, v) = (
                columns.vectors(Field::POSITION),
                columns.vectors(Field::VELOCITY),
            );
            let mass = columns.raw(Field::MASS);
            structure.spins.find(|at| {
                let slot = own.slot_of[first + at] as usize;
                let is_there = mass[slot] > T::zero();
                is_there.then(|| (x[slot].map(Real::to_f64), v[slot].map(Real::to_f64)))
            });
        }
    }
}

impl<T: Real, const D: usize> Structure<T, D> {
    /// What has accelerated its particle in a slot of its group, `elapsed` \[s\] after the evaluation before.
    fn accelerate(
        &mut self,
        at: usize,
        own: usize,
        (particles, work): (&Particles<T, D>, &Workspace<T, D>),
        elapsed: f64,
    ) {
        let velocity = particles.columns.vectors(Field::VELOCITY)[own].map(Real::to_f64);
        match self.before.get_mut(at) {
            // A stiff body swings many times in a step of the liquid, which feels the mean.
            Some(before) if !self.evaluated.is_nan() => {
                if elapsed > 0.0 {
                    self.accelerations[at] =
                        core::array::from_fn(|d| (velocity[d] - before[d]) / elapsed);
                    *before = velocity;
                }
            }
            before => {
                let mass = particles.columns.raw(Field::MASS);
                self.accelerations[at] =
                    core::array::from_fn(|d| work.acceleration(mass, own * D + d).to_f64());
                if let Some(before) = before {
                    *before = velocity;
                }
            }
        }
    }
}
