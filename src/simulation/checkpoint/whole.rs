//! Columns of all particles between a group and a checkpoint, also where each rank has its own particles alone.
//! A rank has no more than one of these columns at a time.

use crate::particles::{Columns, Field};
use crate::ranks::{Plain, Source, What};
use crate::scalar::Real;
use crate::simulation::group::Group;
use crate::simulation::own_group::{All, Gathering};
use crate::simulation::part::Part;
use crate::simulation::population::BodyState;
use crate::sweep::Results;
use std::borrow::Cow;
use std::sync::Arc;

/// A group as a checkpoint has it: what is written.
pub(super) struct Whole<'a, T: Real, const D: usize> {
    group: &'a Group<T, D>,
    /// What it has of all particles and how it gets the rest, where its rank has its own alone.
    apart: Option<(&'a All<T, D>, Gathering<'a>)>,
}

impl<'a, T: Real, const D: usize> Whole<'a, T, D> {
    pub fn new(group: &'a Group<T, D>) -> Self {
        let apart = group.all.as_deref().zip(group.share.as_ref());
        let apart = apart.map(|(all, share)| {
            let source = Source::All(&share.team, What::State);
            let gathering = Gathering::new::<T>(source, share.division(), all.slots());
            (all, gathering)
        });
        Self { group, apart }
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
}

/// What a rank keeps of columns of all particles that are read: those of its own alone, where it begins with these.
pub(super) struct Kept {
    part: Option<Arc<Part>>,
    /// Slots of all.
    pub slots: usize,
}

impl Kept {
    pub fn new<T: Real, const D: usize>(group: &Group<T, D>) -> Self {
        let all = group.all.as_ref();
        let own = || group.particles.columns.slots();
        Self {
            part: all.map(|all| all.part.clone()),
            slots: all.map_or_else(own, |all| all.slots()),
        }
    }

    /// How many numbers all have of a field; none of one without a column.
    pub fn count_of<T: Real, const D: usize>(&self, own: &Columns<T, D>, field: Field) -> usize {
        if own.fields().contains(field) {
            self.slots * field.components(D)
        } else {
            0
        }
    }

    /// Its own of a column; none of one that is not there.
    pub fn column<V: Copy>(&self, all: Vec<V>) -> Vec<V> {
        match &self.part {
            None => all,
            Some(part) => part.of_column(&all, self.slots),
        }
    }

    /// Its own of sums over all that moves by forces.
    pub fn sums<T: Real, const D: usize>(
        &self,
        all: Results<T, D>,
        mobile: usize,
    ) -> Results<T, D> {
        let Some(part) = &self.part else {
            return all;
        };
        let run = part.runs[0].start.min(mobile)..part.runs[0].end.min(mobile);
        // How many chunks there are no checkpoint tells.
        all.of_run(&run, (&part.chunks, usize::MAX))
    }
}
