//! A group that has the particles of its rank alone, and the way back to that of all particles.
//! Copies of columns, sums and records: no number changes.

use super::divided::Share;
use super::group::Group;
use super::migration::Leaving;
use super::neighborhood::Neighborhood;
use super::part::{Part, runs_of};
use super::population::{BodyState, Moves, Particles};
use super::walls::WallState;
use super::workspace::{Saved, Workspace};
use crate::material::eos::GuardCounts;
use crate::neighbors::ClusterLists;
use crate::particles::{Columns, Field};
use crate::ranks::{Asked, Source, What};
use crate::scalar::Real;
use crate::sweep::{Pass, Records, Results};
use crate::term::Stage;
use core::mem::take;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// What a group has of all particles while a rank steps its own: all but columns, sums, records and lists.
#[derive(Clone, Debug)]
pub(crate) struct All<T: Real, const D: usize> {
    pub part: Arc<Part>,
    /// Shared by a state and its copies.
    pub particles: Arc<Particles<T, D>>,
    neighborhood: Neighborhood<T, D>,
    walls: Vec<WallState<T, D>>,
    pub guards: GuardCounts,
    pub limited: Vec<(&'static str, u64)>,
    /// Pairs summed before.
    pub pairs: u64,
}

/// What a group has of this rank alone, on the way to all.
struct Own<T: Real, const D: usize> {
    part: Arc<Part>,
    share: Share,
    /// Slots of each rank.
    runs: Vec<[Range<usize>; 2]>,
    columns: Columns<T, D>,
    work: Workspace<T, D>,
}

/// What becomes of the lists of own chunks where all particles come together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lists {
    Kept,
    /// Lists are built next, for which records are of no use either.
    BuiltNext,
    /// Another state has them.
    Elsewhere,
}

impl<T: Real, const D: usize> Own<T, D> {
    /// Numbers of all particles, `width` a slot and so many, in the memory of those that this rank has, which grows where it must. Others
    /// stay as they were `before`, or zero, where a rank has failed.
    fn gather(
        &self,
        source: Source<'_>,
        mut own: Vec<T>,
        (width, count): (usize, usize),
        before: &[T],
    ) -> Vec<T> {
        let (mut end, mut behind) = (width * self.part.count(), count);
        own.truncate(end);
        own.reserve_exact(count - end);
        own.resize(count, T::zero());
        let fill = |own: &mut [T], run: Range<usize>| match before.get(run.clone()) {
            Some(before) => own[run].copy_from_slice(before),
            None => own[run].fill(T::zero()),
        };
        // No run goes to a lower place, so the last goes first.
        for run in self.part.runs.iter().rev() {
            let (first, place) = (end - width * run.len(), width * run.start);
            own.copy_within(first..end, place);
            fill(&mut own, (place + end - first).min(behind)..behind);
            (end, behind) = (first, place);
        }
        fill(&mut own, 0..behind);
        let numbers = |run: &Range<usize>| width * run.start..width * run.end;
        let runs_of = |rank: usize| self.runs[rank].each_ref().map(numbers);
        source.numbers(&mut own, runs_of, Vec::new(), |_, _| Some(()));
        own
    }

    fn forget_records(&mut self) {
        let work = &mut self.work;
        (work.records, work.work_records) = <(Records<T>, Records<T>)>::default();
        work.records_of_rates = false;
    }
}

impl<T: Real, const D: usize> All<T, D> {
    /// Slots of all particles.
    pub fn slots(&self) -> usize {
        self.particles.columns.slots()
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Goes on with the particles of this rank alone. All ranks do so at once.
    pub(super) fn keep_own(&mut self) {
        let Some(share) = &mut self.share else {
            return;
        };
        if self.all.is_some() {
            return;
        }
        let part = share.part(&self.neighborhood);
        let slots = self.particles.columns.slots();
        let mobile = self.particles.mobile;
        let own = part.particles(&mut self.particles, &self.walls);
        let walls = self.walls.iter().map(|wall| WallState {
            slots: part.within(&wall.slots),
            end: part.at(wall.end),
            ..wall.clone()
        });
        let walls = walls.collect();
        let neighborhood = part.neighborhood(&mut self.neighborhood, slots);
        let chunks = self.neighborhood.lists.chunks().len();
        let work = part.work(&self.work, (slots, chunks), [own.mobile, mobile]);
        let pairs = work.spent.pairs;
        self.work = work;
        self.all = Some(Box::new(All {
            part,
            particles: Arc::new(core::mem::replace(&mut self.particles, own)),
            neighborhood: core::mem::replace(&mut self.neighborhood, neighborhood),
            walls: core::mem::replace(&mut self.walls, walls),
            guards: take(&mut self.guards),
            limited: take(&mut self.limited),
            pairs,
        }));
    }

    /// Goes on with room for all particles. What was of this rank alone.
    fn open(&mut self) -> Option<Own<T, D>> {
        let (all, share) = (self.all.take()?, self.share.clone()?);
        let All {
            part,
            particles,
            neighborhood,
            walls,
            guards,
            limited,
            pairs: _,
        } = *all;
        let particles = Arc::unwrap_or_clone(particles);
        let own = core::mem::replace(&mut self.particles, particles);
        let near = core::mem::replace(&mut self.neighborhood, neighborhood);
        let mut work = take(&mut self.work);
        work.forget_taken_back();
        (self.walls, self.guards, self.limited) = (walls, guards, limited);
        let slots = self.particles.columns.slots();
        self.neighborhood.take_back(&part, near, slots);
        let runs = (0..share.team.count())
            .map(|rank| runs_of::<T>(share.division(), rank, slots))
            .collect();
        self.work.go_on(&work);
        Some(Own {
            part,
            share,
            runs,
            columns: own.columns,
            work,
        })
    }

    /// Gets columns of all particles.
    fn gather_columns(
        &mut self,
        source: Source<'_>,
        own: &mut Own<T, D>,
        fields: impl Iterator<Item = Field>,
    ) {
        let slots = self.particles.columns.slots();
        for field in fields {
            let width = field.components(D);
            let here = take(own.columns.column_mut(field));
            // Where a rank has failed its particles are where they were listed, and the error is told where the call ends.
            let before = if field == Field::POSITION {
                self.neighborhood.listed[..slots].as_flattened()
            } else {
                &[]
            };
            let all = own.gather(source, here, (width, width * slots), before);
            *self.particles.columns.column_mut(field) = all;
        }
    }

    /// Goes on with places and smoothing lengths of all particles, from which lists are built. All else, of which ranks send to others
    /// what is theirs after that.
    pub(super) fn leave(&mut self) -> Option<Leaving<T, D>> {
        self.join_counts();
        let mut own = self.open()?;
        let fields = self.particles.columns.fields();
        let places = [Field::POSITION, Field::SMOOTHING_LENGTH].into_iter();
        let places = places.filter(|field| fields.contains(*field));
        let team = own.share.team.clone();
        self.gather_columns(Source::All(&team, What::State), &mut own, places);
        own.forget_records();
        Some(Leaving {
            division: own.share.division().clone(),
            columns: own.columns,
            work: own.work,
        })
    }

    /// Gets all particles, column by column: all ranks gather them, or this rank asks for those of an `offer`.
    pub(super) fn bring_together(&mut self, lists: Lists, offer: Option<&Asked<'_>>) {
        let Some(share) = self.share.as_ref().filter(|_| self.all.is_some()) else {
            return;
        };
        let team = share.team.clone();
        let source = offer.map_or(Source::All(&team, What::State), Source::Offer);
        let for_lists = lists == Lists::BuiltNext;
        if lists == Lists::Elsewhere {
            self.neighborhood.lists = Arc::default();
        }
        if offer.is_none() {
            // Counts are joined before an offer is made.
            self.join_counts();
        }
        let Some(mut own) = self.open() else {
            return;
        };
        if for_lists {
            own.forget_records();
        }
        let fields = self.particles.columns.fields();
        self.gather_columns(source, &mut own, fields.iter());
        let slots = self.particles.columns.slots();
        self.work.expect_saved(&own.work, &self.particles, slots);
        let mut work = take(&mut own.work);
        for ((_, here), (field, all)) in work.saved_mut().zip(self.work.saved_mut()) {
            if !all.is_empty() {
                *all = own.gather(source, take(here), (field.components(D), all.len()), &[]);
            }
        }
        let division = own.share.division();
        let chunks: Vec<_> = (0..team.count()).map(|rank| division.of(rank)).collect();
        let mobile = self.particles.mobile;
        let count = self.neighborhood.lists.chunks().len();
        for (sums, all) in work.sums_mut().into_iter().zip(self.work.sums_mut()) {
            let moving =
                |runs: &[Range<usize>; 2]| runs[0].start.min(mobile)..runs[0].end.min(mobile);
            let (sums, here) = (take(sums), (&moving(&own.part.runs), mobile));
            *all = Results::among(sums, here, (&own.part.chunks, count));
            let rows = |runs: &[Range<usize>; 2]| [all.rows_of(&moving(runs)), 0..0];
            let rows: Vec<_> = own.runs.iter().map(rows).collect();
            all.gather(source, &rows, &chunks);
        }
        if !for_lists {
            let count = slots + self.neighborhood.images.len();
            let are_there = [work.records_of_rates, true];
            let all = work.records_mut().into_iter().zip(self.work.records_mut());
            for ((here, all), is_there) in all.zip(are_there) {
                let stride = here.stride();
                if is_there && stride > 0 {
                    let (here, all_of_them) = (take(here).into_data(), (stride, stride * count));
                    let own = own.gather(source, here, all_of_them, &[]);
                    *all = Records::of_stored(own, stride);
                }
            }
            self.show_images_again();
        }
    }

    /// Takes lists of own chunks that were left to a state with the same, if they were.
    pub(super) fn take_lists(&mut self, last: &Self) {
        let Some(share) = &self.share else {
            return;
        };
        let runs = share.division().of(share.team.rank());
        let slots = self.particles.columns.slots();
        let near = &mut self.neighborhood;
        if runs
            .into_iter()
            .all(|own| near.lists.missing(own).is_empty())
        {
            return;
        }
        let lists = last.neighborhood.lists.clone();
        match &last.all {
            None => near.lists = lists,
            Some(all) => near.put_lists(&all.part, lists, slots),
        }
    }

    /// Makes the records of images, of which no rank has all.
    fn show_images_again(&mut self) {
        let scheme = self.scheme.clone();
        let Some(sweep) = scheme.sweep(Stage::Rates) else {
            return;
        };
        let mut records = take(&mut self.work.records);
        if self.work.records_of_rates {
            sweep.show_images(Pass::Rates, &self.input(), &mut records);
        }
        self.work.records = records;
        let mut records = take(&mut self.work.work_records);
        if !records.data().is_empty() {
            sweep.show_images(Pass::Work, &self.input(), &mut records);
        }
        self.work.work_records = records;
    }
}

impl Part {
    /// The particles of this rank.
    fn particles<T: Real, const D: usize>(
        &self,
        all: &mut Particles<T, D>,
        walls: &[WallState<T, D>],
    ) -> Particles<T, D> {
        let bodies = all.bodies.iter().map(|body| BodyState {
            slots: self.within(&body.slots),
            end: self.at(body.end),
            ..body.clone()
        });
        let mut ids = Vec::with_capacity(self.count());
        for run in &self.runs {
            ids.extend_from_slice(&all.ids[run.clone()]);
        }
        // Particles of walls are known by how far they are from the first slot of the wall.
        for wall in walls {
            let first = self.at(wall.slots.start);
            for slot in first..self.at(wall.end) {
                ids[slot] = ids[slot] - wall.slots.start as u32 + first as u32;
            }
        }
        Particles {
            columns: all.columns.take_runs(&self.runs),
            bodies: bodies.collect(),
            mobile: self.at(all.mobile),
            ids,
            slot_of: Vec::new(),
            removed: all.removed,
            entered: all.entered,
            first_id: all.first_id,
            origin: all.origin,
            moved: Moves::default(),
        }
    }

    fn neighborhood<T: Real, const D: usize>(
        &self,
        all: &mut Neighborhood<T, D>,
        slots: usize,
    ) -> Neighborhood<T, D> {
        let mut numbers = vec![u32::MAX; all.listed.len()];
        for (number, own) in self.named(slots).enumerate() {
            numbers[own] = number as u32;
        }
        let mut listed = Vec::with_capacity(self.count() + self.ghosts.len() + self.images.len());
        listed.extend(self.named(slots).map(|other| all.listed[other]));
        let lists = Arc::make_mut(&mut all.lists);
        let lists = lists.take_runs(&self.chunks, |j| numbers[j as usize]);
        let listed_h = if all.listed_h.is_empty() {
            Vec::new()
        } else {
            self.of_column(&all.listed_h[..slots], slots)
        };
        Neighborhood {
            blocks: all
                .blocks
                .iter()
                .map(|block| self.block(block, slots))
                .collect(),
            mirrored: all.mirrored.clone(),
            interactions: all.interactions.clone(),
            images: self.shown.clone(),
            chains: all.chains.clone(),
            lists: Arc::new(lists),
            whole: OnceLock::new(),
            listed: Arc::new(listed),
            listed_h,
            ..*all
        }
    }

    fn work<T: Real, const D: usize>(
        &self,
        all: &Workspace<T, D>,
        (slots, chunks): (usize, usize),
        [own_mobile, mobile]: [usize; 2],
    ) -> Workspace<T, D> {
        let first = self.runs[0].start.min(mobile);
        let run = first..first + own_mobile;
        let records = |records: &Records<T>, at_hand: bool| {
            if !at_hand || records.data().is_empty() {
                return Records::default();
            }
            self.records(records, slots)
        };
        let saved = |all: &Saved<T>| -> Saved<T> {
            let own = |(field, column): &(Field, Vec<T>)| (*field, self.of_column(column, slots));
            all.iter().map(own).collect()
        };
        Workspace {
            records: records(&all.records, all.records_of_rates),
            work_records: records(&all.work_records, true),
            records_of_rates: all.records_of_rates,
            rates: all.rates.of_run(&run, (&self.chunks, chunks)),
            worked: all.worked.of_run(&run, (&self.chunks, chunks)),
            evaluated_time: all.evaluated_time,
            evaluated_gravity: all.evaluated_gravity,
            first_kick: all.first_kick,
            lengths_time: all.lengths_time,
            predicted: saved(&all.predicted),
            is_predicted: all.is_predicted,
            kept: all.kept.iter().map(saved).collect(),
            phases: all.phases,
            spent: all.spent,
            ..Workspace::default()
        }
    }

    /// The records of this rank, of its ghosts and of its images.
    fn records<T: Real>(&self, all: &Records<T>, slots: usize) -> Records<T> {
        let stride = all.stride();
        let mut data = Vec::new();
        for other in self.named(slots) {
            data.extend_from_slice(&all.data()[stride * other..stride * (other + 1)]);
        }
        Records::of_stored(data, stride)
    }
}

impl<T: Real, const D: usize> Neighborhood<T, D> {
    /// Goes on from the lists and images of a rank, of a group with so many slots.
    fn take_back(&mut self, part: &Part, own: Self, slots: usize) {
        self.put_lists(part, own.lists, slots);
        (self.served, self.placed_time) = (own.served, own.placed_time);
        self.chains = own.chains;
    }

    fn put_lists(&mut self, part: &Part, own: Arc<ClusterLists>, slots: usize) {
        let named: Vec<u32> = part.named(slots).map(|own| own as u32).collect();
        let number = |j: u32| named[j as usize];
        let lists = Arc::unwrap_or_clone(own);
        Arc::make_mut(&mut self.lists).put_runs(lists, &part.chunks, number);
    }
}

impl<T: Real, const D: usize> Workspace<T, D> {
    /// Columns of saved states that count.
    fn saved_mut(&mut self) -> impl Iterator<Item = &mut (Field, Vec<T>)> {
        let is_predicted = self.is_predicted;
        let predicted = self.predicted.iter_mut().filter(move |_| is_predicted);
        self.kept.iter_mut().flatten().chain(predicted)
    }

    /// Columns of saved states that count, to read.
    pub(super) fn saved(&self) -> impl Iterator<Item = &(Field, Vec<T>)> {
        let predicted = self.predicted.iter().filter(|_| self.is_predicted);
        self.kept.iter().flatten().chain(predicted)
    }

    /// Sums that the next step reads.
    fn sums_mut(&mut self) -> [&mut Results<T, D>; 2] {
        [&mut self.rates, &mut self.worked]
    }

    fn records_mut(&mut self) -> [&mut Records<T>; 2] {
        [&mut self.records, &mut self.work_records]
    }

    /// Goes on from the work of a rank.
    fn go_on(&mut self, own: &Self) {
        (self.phases, self.spent) = (own.phases, own.spent);
        self.records_of_rates = own.records_of_rates;
        self.evaluated_time = own.evaluated_time;
        self.evaluated_gravity = own.evaluated_gravity;
        self.first_kick = own.first_kick;
        self.lengths_time = own.lengths_time;
        self.is_predicted = own.is_predicted;
    }

    /// Makes room for the states that a rank keeps.
    pub(super) fn expect_saved(&mut self, own: &Self, all: &Particles<T, D>, slots: usize) {
        let room = |own: &Saved<T>| -> Saved<T> {
            let whole = |(field, _): &(Field, Vec<T>)| {
                let is_there = !all.columns.raw(*field).is_empty();
                let width = if is_there { field.components(D) } else { 0 };
                (*field, vec![T::zero(); width * slots])
            };
            own.iter().map(whole).collect()
        };
        self.kept = own.kept.iter().map(room).collect();
        if own.is_predicted {
            self.predicted = room(&own.predicted);
        }
    }
}
