//! Runs on ranks of which each steps its own particles: which scenes do, when all particles are brought together, and what ranks join.
//! Whatever is seen from outside is seen of all particles.

use super::Simulation;
use super::divided::Share;
use super::group::Group;
use super::own_group::Lists;
use super::part::Part;
use super::run_state::State;
use super::settle::PIECE;
use super::vote::{Criterion, NO_VOTE, Vote};
use crate::collective::Join;
use crate::error::{Error, Problem, Result};
use crate::once::once;
use crate::particles::Field;
use crate::ranks::{Asked, Team};
use crate::scalar::{Real, width};
use std::sync::Arc;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Lets ranks step their own particles from now on, where the scene allows it.
    ///
    /// # Errors
    /// If ranks are not at the same state, which their particles would not tell later.
    pub(crate) fn begin_parts(&mut self) -> Result<()> {
        if self.steps_parts || self.team.is_none() {
            return Ok(());
        }
        self.agree(Ok(()))?;
        self.steps_parts = true;
        Ok(())
    }

    /// Evaluates all rates when a scene is built, by parts where the scene allows it. Returns the largest fixed step.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    pub(crate) fn evaluate_by_parts(&mut self) -> Result<Vote> {
        self.begin_parts()?;
        for group in 0..self.state.groups.len() {
            // The reference has built lists and sorted particles.
            self.follow_moves(group);
        }
        self.keep_own();
        let evaluated = self.evaluate();
        let vote = evaluated.and_then(|()| self.found(Self::largest_fixed_step));
        self.end_parts();
        vote
    }

    /// Ends a call in which ranks may have had their own particles alone.
    pub(crate) fn end_parts(&mut self) {
        self.steps_parts = false;
        self.show_all();
    }

    /// Offers the particles of each rank, so that methods can read all of them.
    pub(crate) fn show_all(&mut self) {
        if let Some(team) = self.team.clone().filter(|_| self.is_parted()) {
            self.join_counts();
            self.state.offer(&team);
        }
    }

    /// Whether the state has the particles of this rank only.
    pub(super) fn is_parted(&self) -> bool {
        self.state.is_hidden()
    }

    /// Leaves each rank its own particles before a step, where nothing in the scene looks at others than neighbours.
    pub(super) fn keep_own(&mut self) {
        if !self.steps_parts || !self.may_part() {
            return;
        }
        for group in &mut self.state.groups {
            group.keep_own();
        }
    }

    /// Brings all particles together again.
    pub(crate) fn bring_together(&mut self) {
        self.state.bring_together();
    }

    /// Adds up what ranks have counted, so that each can say what all have done.
    pub(super) fn join_counts(&mut self) {
        for group in &mut self.state.groups {
            group.join_counts();
        }
    }

    /// Whether a step of this scene needs a particle, its neighbours, and what is joined over all. Not so of couplings, joints, rigid
    /// bodies, clamps, structures, loads, events, inlets and outlets, sub-cycles, forces of laws, contacts, and books of energy and
    /// stability.
    pub(super) fn may_part(&self) -> bool {
        let state = &self.state;
        state.couples.is_empty()
            && state.joints.is_empty()
            && state.work.is_none()
            && state.watch.is_none()
            && self.events.is_empty()
            && self.loads.is_empty()
            && self.team.as_ref().is_some_and(|team| !team.is_broken())
            && state.groups.iter().all(Group::may_part)
    }

    /// Problems of all particles: where ranks have their own alone and one finds some, all of them come together and find them.
    pub(crate) fn problems_of_all(&mut self, find: impl Fn(&Self) -> Vec<Problem>) -> Vec<Problem> {
        let own = find(self);
        let Some(team) = self.team.clone().filter(|_| self.is_parted()) else {
            return own;
        };
        let [found] = team.largest([own.len() as f64]);
        if found == 0.0 {
            return own;
        }
        self.bring_together();
        find(self)
    }

    /// A vote of ranks; one of all particles together where these find what they tell as an error.
    pub(super) fn found(&mut self, vote: impl Fn(&Self) -> Result<Vote>) -> Result<Vote> {
        match vote(self) {
            Err(_) if self.is_parted() => {
                self.bring_together();
                vote(self)
            }
            found => found,
        }
    }
}

impl<T: Real, const D: usize> State<T, D> {
    /// Whether ranks have their own particles alone.
    pub(super) fn is_parted(&self) -> bool {
        self.groups.iter().any(|group| group.all.is_some())
    }

    /// Gathers all particles, or asks for those of an offer.
    pub(super) fn bring_together(&mut self, lists: Lists, offer: Option<&Asked<'_>>) {
        once!(self => &mut State, |own, lists: Lists, offer: Option<&Asked<'_>>| -> () {
            for group in &mut own.groups {
                group.bring_together(lists, offer);
            }
        });
    }
}

/// What stands for the error that all particles together tell.
pub(super) fn told_by_all() -> Error {
    Error::Failed {
        cause: "a particle of a rank".into(),
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Whether ranks may have their own particles alone, once all of them have some.
    pub(super) fn is_of_neighbors_alone(&self) -> bool {
        let walls = &self.walls;
        let settles = self.scheme.program.laws.iter().flatten();
        let settles = settles.into_iter().any(|law| law.repeats().is_some());
        let bodies = &self.particles.bodies;
        self.exchanges.is_empty()
            && self.outlets.is_empty()
            && self.emitters.is_empty()
            && self.sources.is_empty()
            && self.drains.is_empty()
            && !self.sub_cycles()
            && self.held.is_empty()
            && !self.is_met
            && !self.has_contacts()
            && !self.particles.columns.fields().contains(Field::FORCE)
            // What repeats the last particle of a body is in its cluster, unless some have left.
            && bodies.iter().all(|body| body.end - body.slots.end < width::<T>())
            && walls
                .iter()
                .all(|wall| wall.structure.is_none() && wall.inflow.is_none())
            // What settles together is cut from the first slot of a body on.
            && (!settles || bodies.iter().all(|body| body.slots.start % PIECE == 0))
    }

    fn may_part(&self) -> bool {
        let is_cut = |share: &Share| {
            share.division().is_full() && share.is_divided(&self.neighborhood.lists)
        };
        self.is_of_neighbors_alone()
            && (self.share.as_ref()).is_some_and(|own| !own.team.is_broken() && is_cut(own))
    }

    /// Builds lists in a step of own particles, which go to their next ranks before. Kept states follow.
    pub(super) fn rebuild_apart(&mut self, time: f64) {
        let boundaries = self.boundaries.iter();
        let mut transforms = boundaries
            .flat_map(|own| (0..own.images()).map(|k| own.transform(k, time).to_scalar::<T>()));
        self.joins_given |= transforms.any(|own| own.turns());
        self.re_enter(time);
        self.follow_wraps();
        let first = (self.neighborhood.rebuilds == 0).then_some(time);
        let (Some(all), Some((team, _))) = (&self.all, self.apart()) else {
            return;
        };
        let sort = self.neighborhood.wants_sort(all.entries);
        let [reach] = team.largest([self.neighborhood.reach(&self.particles)]);
        self.begin_rebuild(time);
        self.work.forget_records();
        if sort {
            self.sort_own(first);
        }
        self.neighborhood.remember(&self.particles);
        self.list_own((time, reach));
        if self.balance() {
            self.neighborhood.remember(&self.particles);
            self.list_own((time, reach));
        }
        if let Some(all) = self.all.as_ref().filter(|_| sort) {
            self.neighborhood.sorted_entries = all.entries;
        }
    }

    fn follow_wraps(&mut self) {
        let time_of = |slot: usize| self.kept_times.get(slot).copied().unwrap_or(0.0);
        let given = self.work.follow(&mut self.particles.moved, time_of);
        self.given.extend(given);
    }

    /// The ranks, if this one has its own particles alone.
    pub(super) fn apart(&self) -> Option<(&Arc<Team>, &Part)> {
        let (all, share) = (self.all.as_ref()?, self.share.as_ref()?);
        Some((&share.team, &all.part))
    }

    /// The shortest of the steps that ranks ask for, whose particle is its number in the whole simulation.
    pub(super) fn shortest(&self, own: Vote) -> Vote {
        let Some((team, part)) = self.apart() else {
            return own;
        };
        let limits = &self.scheme.program.limits;
        let (mut slot, mut id) = (usize::MAX, usize::MAX);
        if let Some(own_id) = self.particles.ids.get(own.particle) {
            slot = part.slot_in_group(own.particle);
            id = self.particles.first_id + *own_id as usize;
        }
        let kinds = [
            Criterion::Acoustic,
            Criterion::Force,
            Criterion::Viscous,
            Criterion::Approach,
        ];
        let kind = match own.criterion {
            Criterion::Effect(name) => {
                let at = limits.iter().position(|limit| limit.name() == name);
                kinds.len() + at.unwrap_or(0)
            }
            own => kinds.iter().position(|kind| *kind == own).unwrap_or(0),
        };
        let (mut shortest, mut found) = (NO_VOTE, usize::MAX);
        let own = [own.step.to_bits(), slot as u64, kind as u64, id as u64];
        team.numbers(own, |[step, slot, kind, id]| {
            let kind = kind as usize;
            let criterion = kinds.get(kind).copied().unwrap_or_else(|| {
                Criterion::Effect(limits.get(kind - kinds.len()).map_or("", |own| own.name()))
            });
            let other = Vote {
                step: f64::from_bits(step),
                criterion,
                particle: slot as usize,
            };
            let first = shortest.and(other);
            if first == other && first != shortest {
                found = id as usize;
            }
            shortest = first;
        });
        Vote {
            particle: found,
            ..shortest
        }
    }
}
