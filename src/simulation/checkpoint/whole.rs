//! Columns of all particles for a checkpoint, one after another: those of a group, or, where each rank has its own alone, of all ranks.
//! A rank has no more than one of them at a time.

use crate::ranks::{Plain, Source, What};
use crate::scalar::Real;
use crate::simulation::group::Group;
use crate::simulation::own_group::{All, Gathering};
use crate::simulation::population::BodyState;
use crate::sweep::Results;
use std::borrow::Cow;

/// A group as a checkpoint has it.
pub(super) struct Whole<'a, T: Real, const D: usize> {
    group: &'a Group<T, D>,
    /// What it has of all particles and how it gets the rest, where its rank has its own alone.
    apart: Option<(&'a All<T, D>, Gathering<'a>)>,
    none: Results<T, D>,
}

impl<'a, T: Real, const D: usize> Whole<'a, T, D> {
    pub fn new(group: &'a Group<T, D>) -> Self {
        let apart = group.all.as_deref().zip(group.share.as_ref());
        let apart = apart.map(|(all, share)| {
            let source = Source::All(&share.team, What::State);
            let gathering = Gathering::new::<T>(source, share.division(), all.slots());
            (all, gathering)
        });
        Self {
            group,
            apart,
            none: Results::default(),
        }
    }

    /// A column with so many numbers a slot.
    pub fn column<'b, V: Plain>(&self, own: &'b [V], width: usize) -> Cow<'b, [V]> {
        match &self.apart {
            Some((all, gathering)) if !own.is_empty() => {
                let own = own[..width * all.part.count()].to_vec();
                Cow::Owned(gathering.columns(own, width, all.slots()))
            }
            _ => Cow::Borrowed(own),
        }
    }

    /// The particle in each slot.
    pub fn ids(&self) -> Cow<'a, [u32]> {
        let ids = &self.group.particles.ids;
        let Some((all, _)) = &self.apart else {
            return Cow::Borrowed(ids);
        };
        let mut own = ids.clone();
        all.part.number_walls(&mut own, &all.walls, false);
        Cow::Owned(self.column(&own, 1).into_owned())
    }

    /// The slot of each particle, of those in all slots.
    pub fn slot_of(&self, ids: &[u32]) -> Cow<'a, [u32]> {
        match &self.apart {
            None => Cow::Borrowed(&self.group.particles.slot_of),
            Some((all, _)) => {
                let walls = all.walls.iter().map(|wall| wall.slots.clone());
                Cow::Owned(all.particles.slots_of_ids(ids, walls))
            }
        }
    }

    /// Its bodies.
    pub fn bodies(&self) -> &[BodyState<T>] {
        let all = self.apart.as_ref().map(|own| &own.0.particles);
        all.map_or(&self.group.particles.bodies, |own| &own.bodies)
    }

    /// Sums over all that moves by forces.
    pub fn sums<'b>(&self, own: &'b Results<T, D>) -> Cow<'b, Results<T, D>> {
        match &self.apart {
            None => Cow::Borrowed(own),
            Some((all, gathering)) => Cow::Owned(gathering.sums(own.clone(), all.particles.mobile)),
        }
    }

    /// Sums of an evaluation, which no step reads later: none where ranks have their own particles alone.
    pub fn of_evaluation<'b>(&'b self, own: &'b Results<T, D>) -> &'b Results<T, D> {
        if self.apart.is_some() {
            &self.none
        } else {
            own
        }
    }
}
