//! The driver of couplings: brings structures to the liquids that they are walls of, hands forces over, and reports them.
//! What a coupling does is its own; the order, the search, the ledger and the opposite forces are here.

use super::Simulation;
use super::contact::Couple;
use super::group::Group;
use super::population::BodyState;
use crate::error::{Error, Problem, Result};
use crate::particles::Output;
use crate::scalar::Real;
use crate::term::TermDoc;

/// How a coupling by forces stands; see [couplings](crate::coupling#energy).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Contact {
    /// The name of the coupling.
    pub name: &'static str,
    /// The bodies; a body that meets itself is there twice, and a wall second.
    pub bodies: [String; 2],
    /// Pairs that act.
    pub pairs: usize,
    /// The force on the first body \[N\]; zero for a body that meets itself.
    pub force: Vec<f64>,
    /// Energy that it stores \[J\].
    pub stored: f64,
    /// Heat of friction since the start \[J\].
    pub heat: f64,
    /// What it has worked on both since the start \[J\]; what a wall that moves has worked on the body is the opposite of
    /// the second.
    pub work: [f64; 2],
    /// How much nearer than a mean spacing the nearest pair is, in spacings; zero if none is nearer.
    pub penetration: f64,
    /// The largest since the start.
    pub largest_penetration: f64,
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

    /// How all couplings by forces stand, in the order of the scene.
    #[must_use]
    pub fn contacts(&self) -> Vec<Contact> {
        let contact = |own: &Couple<T, D>| Contact {
            name: own.coupling.name(),
            bodies: (own.sides.each_ref()).map(|side| side.name(&self.state.groups).to_owned()),
            pairs: own.acting.pairs,
            force: own.acting.force.to_vec(),
            stored: own.acting.stored,
            heat: own.acting.heat,
            work: own.work,
            penetration: own.acting.penetration[0],
            largest_penetration: own.acting.penetration[1],
        };
        self.state.couples.iter().map(contact).collect()
    }

    /// The largest penetration since the start, in mean spacings, of all couplings with a name.
    ///
    /// # Errors
    /// If no coupling by forces has that name; the error lists those that there are.
    pub fn largest_penetration(&self, coupling: &str) -> Result<f64> {
        let own = (self.state.couples.iter()).filter(|own| own.coupling.name() == coupling);
        let own = own.map(|own| own.acting.penetration[1]).reduce(f64::max);
        own.ok_or_else(|| {
            let known: Vec<_> = self
                .state
                .couples
                .iter()
                .map(|own| own.coupling.name())
                .collect();
            Error::Argument(Problem::UnknownName {
                kind: "coupling by forces",
                name: coupling.into(),
                known: known.join(", "),
            })
        })
    }

    /// Brings the walls that structures are to where their particles are at `time` \[s\]; whether all rates are about to be
    /// evaluated. In the middle of a `drift` \[s\], and its share of a step, groups that sub-cycle may be half a step of theirs
    /// further.
    pub(super) fn place_structures(&mut self, time: f64, evaluated: bool, drift: [f64; 2]) {
        self.for_each_structure(|liquid, wall, group| {
            let (own, boundaries) = (&mut liquid.particles, &liquid.boundaries);
            let others = (&group.particles, &group.work);
            let ahead = group.ahead(drift);
            liquid.walls[wall].follow(own, boundaries, others, (time, evaluated, ahead));
        });
    }

    /// Gives bodies of other groups the forces of couplings, with the rates at hand.
    pub(super) fn couple(&mut self) {
        for group in &mut self.state.groups {
            group.forget_forces_apart();
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

    /// Gives bodies the forces of couplings between pairs, with the rates at hand.
    pub(super) fn act_in_pairs(&mut self) {
        let state = &mut *self.state;
        for couple in &mut state.couples {
            couple.act(&mut state.groups, self.control.approach, state.evaluated);
        }
    }

    /// Books what couplings by forces work in a kick over `dt` \[s\].
    pub(super) fn record_couples(&mut self, dt: f64) {
        let state = &mut *self.state;
        for couple in &mut state.couples {
            for side in 0..2 {
                couple.work[side] += couple.work_in_kick(side, &state.groups, dt);
            }
        }
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
            let more = [own.acting.stored, own.acting.heat].into_iter();
            let more = more.chain(own.acting.force);
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
