//! A group that has the particles of its rank alone, and the way back to that of all particles.
//! Copies of columns, sums and records: no number changes.

use super::group::Group;
use super::part::{Part, chunk_slots, runs_of};
use super::population::{BodyState, Moves, Particles};
use super::settle::Settling;
use super::walls::WallState;
use super::workspace::{Saved, Workspace};
use crate::material::eos::GuardCounts;
use crate::neighbors::ClusterLists;
use crate::particles::{Columns, Field};
use crate::ranks::{Asked, Division, Plain, Source, What};
use crate::scalar::{Real, width};
use crate::scheme::DensityForm;
use crate::sweep::{Pass, Records, Results};
use crate::term::Stage;
use core::mem::{replace, take};
use std::ops::Range;
use std::sync::Arc;

/// What a group has of all particles while a rank steps its own: which bodies and walls there are, and what they have in common.
#[derive(Clone, Debug)]
pub(crate) struct All<T: Real, const D: usize> {
    pub part: Arc<Part>,
    /// Bodies, without columns and identities. Shared by a state and its copies.
    pub particles: Arc<Particles<T, D>>,
    pub walls: Vec<WallState<T, D>>,
    pub guards: GuardCounts,
    pub limited: Vec<(&'static str, u64)>,
    /// Pairs summed before.
    pub pairs: u64,
    /// Entries of all lists.
    pub entries: usize,
}

/// What becomes of the lists of own chunks where all particles come together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lists {
    /// They are made again, for steps.
    Made,
    /// There are none, for readings.
    None,
}

/// The way of numbers of all ranks to one.
pub(super) struct Gathering<'a> {
    source: Source<'a>,
    /// Slots and chunks of each rank.
    runs: Vec<[Range<usize>; 2]>,
    chunks: Vec<[Range<usize>; 2]>,
}

impl<'a> Gathering<'a> {
    /// Of so many slots, which are cut as said.
    pub fn new<T: Real>(source: Source<'a>, division: &Division, slots: usize) -> Self {
        let ranks = || 0..source.team().count();
        Self {
            source,
            runs: ranks().map(|k| runs_of::<T>(division, k, slots)).collect(),
            chunks: ranks().map(|k| division.of(k)).collect(),
        }
    }

    /// Sums over the first `mobile` particles of all.
    pub fn sums<T: Real, const D: usize>(
        &self,
        own: Results<T, D>,
        mobile: usize,
    ) -> Results<T, D> {
        let rank = self.source.team().rank();
        let moving = |runs: &[Range<usize>; 2]| runs[0].start.min(mobile)..runs[0].end.min(mobile);
        let ends = self.chunks.iter().flatten().map(|own| own.end);
        let count = ends.max().unwrap_or(0);
        let here = (&moving(&self.runs[rank]), mobile);
        let mut sums = Results::among(own, here, (&self.chunks[rank], count));
        let rows = |runs: &[Range<usize>; 2]| [sums.rows_of(&moving(runs)), 0..0];
        let rows: Vec<_> = self.runs.iter().map(rows).collect();
        sums.gather(self.source, &rows, &self.chunks);
        sums
    }

    /// So many numbers of all particles, in the memory of those that this rank has, which grows where it must; of a slot those from
    /// `at` of it to `at` of the next. Those of others are empty where a rank has failed.
    pub fn of<V: Plain>(
        &self,
        mut own: Vec<V>,
        at: impl Fn(usize) -> usize,
        count: usize,
    ) -> Vec<V> {
        let runs_of = |rank: usize| {
            let numbers = |run: &Range<usize>| at(run.start)..at(run.end);
            self.runs[rank].each_ref().map(numbers)
        };
        let runs = runs_of(self.source.team().rank());
        let (mut end, mut behind) = (runs.iter().map(Range::len).sum(), count);
        own.truncate(end);
        own.reserve_exact(count - end);
        own.resize(count, V::empty());
        // No run goes to a lower place, so the last goes first.
        for run in runs.iter().rev() {
            let first = end - run.len();
            own.copy_within(first..end, run.start);
            own[run.end.min(behind)..behind].fill(V::empty());
            (end, behind) = (first, run.start);
        }
        own[..behind].fill(V::empty());
        self.source
            .numbers(&mut own, runs_of, Vec::new(), |_, _| Some(()));
        own
    }

    pub fn columns<V: Plain>(&self, own: Vec<V>, width: usize, slots: usize) -> Vec<V> {
        self.of(own, |slot| width * slot, width * slots)
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
        let Some(share) = self.share.as_ref().filter(|_| self.all.is_none()) else {
            return;
        };
        let slots = self.particles.columns.slots();
        let part = Part::of::<T>(&share.team, share.division(), slots);
        let own = self.particles.columns.take_runs(&part.runs);
        let whole = take(&mut self.work);
        let near = &mut self.neighborhood;
        let (chunks, mobile) = (near.lists.chunks().len(), self.particles.mobile);
        self.work = part.work(&whole, (slots, chunks), [part.at(mobile), mobile]);
        near.listed = Arc::new(part.of_column(&near.listed[..slots], slots));
        near.listed_h.truncate(slots);
        near.listed_h = part.of_column(&near.listed_h, slots);
        let (at, placed) = ((near.listed_time, near.listed_reach), near.placed_time);
        let entries = near.lists.entries();
        self.leave(part, own, (whole.spent.pairs, entries));
        let ghosts = self.list_own(at);
        self.neighborhood.place_transforms(&self.boundaries, placed);
        let records = [
            (
                &whole.records,
                &mut self.work.records,
                whole.records_of_rates,
            ),
            (&whole.work_records, &mut self.work.work_records, true),
        ];
        if let Some(all) = &self.all {
            for (whole, own, _) in records.into_iter().filter(|own| own.2) {
                *own = all.part.records(whole, &ghosts);
            }
        }
        self.show_images_again();
    }

    /// Begins with the particles of this rank alone, if a step looks at neighbours alone and each rank has some; whether it does. Until the
    /// first list build sorts them, the particles of a rank are those of an even part of the chunks.
    pub(crate) fn begin_apart(
        &mut self,
        fill: impl FnOnce(&Self, &[Range<usize>]) -> Columns<T, D>,
    ) -> bool {
        let ranks = self.share.as_ref().map_or(1, |share| share.team.count());
        let (Some(division), Some(share)) = (self.first_division(ranks), &mut self.share) else {
            return false;
        };
        let part = Part::of::<T>(&share.team, &division, self.particles.columns.slots());
        share.set_division(division);
        let own = fill(self, &part.runs);
        self.leave(part, own, (0, 0));
        true
    }

    /// How chunks are cut where each of so many ranks begins with its own particles.
    pub(crate) fn first_division(&self, ranks: usize) -> Option<Division> {
        // The densities of ends by Lam, Shen & Gong are repeated until the largest change of all particles is small.
        let is_alone = self.is_of_neighbors_alone() && self.scheme.density != DensityForm::Lam;
        let [chunks, mobile] = [self.particles.columns.slots(), self.particles.mobile]
            .map(|slots| slots.div_ceil(chunk_slots::<T>()));
        let even = Division::new(&vec![1; chunks], mobile, ranks);
        Some(even).filter(|own| is_alone && own.is_full())
    }

    /// Lists the neighbours of particles that were read with all records, where they are.
    #[cfg(feature = "checkpoint")]
    pub(super) fn list_read(&mut self, at: (f64, f64)) {
        if self.all.is_none() {
            self.list(at.0, at.1);
            return;
        }
        self.neighborhood.remember(&self.particles);
        let ghosts = self.list_own(at);
        let (Some(all), Some(share)) = (&mut self.all, &self.share) else {
            return;
        };
        all.entries = 0;
        let own = [self.neighborhood.lists.entries() as u64];
        (share.team).numbers(own, |[own]| all.entries += own as usize);
        for records in self.work.records_mut() {
            *records = all.part.records(records, &ghosts);
        }
    }

    /// Leaves this rank the particles of a part, whose columns are `own`, where so many pairs were summed and all lists have so many
    /// entries.
    fn leave(&mut self, part: Part, own: Columns<T, D>, (pairs, entries): (u64, usize)) {
        let particles = &mut self.particles;
        let (ids, _) = (take(&mut particles.ids), take(&mut particles.slot_of));
        let own = Particles {
            bodies: Vec::new(),
            mobile: part.at(particles.mobile),
            ids: part.of_column(&ids, particles.columns.slots()),
            slot_of: Vec::new(),
            moved: Moves::default(),
            columns: own,
            ..*particles
        };
        self.all = Some(Box::new(All {
            part: Arc::new(part),
            pairs,
            entries,
            particles: Arc::new(replace(&mut self.particles, own)),
            walls: take(&mut self.walls),
            guards: take(&mut self.guards),
            limited: take(&mut self.limited),
        }));
        self.place_own();
    }

    /// Places bodies and walls among the slots of this rank.
    pub(super) fn place_own(&mut self) {
        let Some(all) = &self.all else {
            return;
        };
        let part = &all.part;
        let bodies = all.particles.bodies.iter().map(|body| BodyState {
            slots: part.within(&body.slots),
            end: part.at(body.end),
            ..body.clone()
        });
        self.particles.bodies = bodies.collect();
        self.particles.mobile = part.at(all.particles.mobile);
        part.number_walls(&mut self.particles.ids, &all.walls, true);
        let walls = all.walls.iter().map(|wall| WallState {
            slots: part.within(&wall.slots),
            end: part.at(wall.end),
            ..wall.clone()
        });
        self.walls = walls.collect();
    }

    /// Gets all particles, column by column: all ranks gather them, or this rank asks for those of an `offer`.
    pub(super) fn bring_together(&mut self, lists: Lists, offer: Option<&Asked<'_>>) {
        if offer.is_none() {
            // Counts are joined before an offer is made.
            self.join_counts();
        }
        let (Some(all), Some(share)) = (self.all.take(), &self.share) else {
            return;
        };
        let (all, team) = (*all, share.team.clone());
        let slots = all.slots();
        let source = offer.map_or(Source::All(&team, What::State), Source::Offer);
        let gathering = Gathering::new::<T>(source, share.division(), slots);
        let part = &all.part;
        part.number_walls(&mut self.particles.ids, &all.walls, false);
        let mut own = replace(&mut self.particles, Arc::unwrap_or_clone(all.particles));
        (self.walls, self.guards, self.limited) = (all.walls, all.guards, all.limited);
        for field in self.particles.columns.fields().iter() {
            let (here, width) = (take(own.columns.column_mut(field)), field.components(D));
            *self.particles.columns.column_mut(field) = gathering.columns(here, width, slots);
        }
        self.particles.ids = gathering.columns(own.ids, 1, slots);
        let walls = self.walls.iter().map(|wall| wall.slots.clone());
        self.particles.find_slots(walls);
        let near = &mut self.neighborhood;
        near.listed = Arc::new(gathering.columns(near.listed.to_vec(), 1, slots));
        if !near.listed_h.is_empty() {
            near.listed_h = gathering.columns(take(&mut near.listed_h), 1, slots);
        }
        let (counts, lanes) = (near.lists.counts().to_vec(), width::<T>());
        let counts = gathering.of(counts, |slot| slot / lanes, slots / lanes);
        near.lists = Arc::new(ClusterLists::of_counts(counts));
        let (at, placed) = ((near.listed_time, near.listed_reach), near.placed_time);
        near.place_blocks(&self.particles, &self.walls, &self.boundaries, at);
        near.place_transforms(&self.boundaries, placed);
        if lists == Lists::Made {
            near.search_some(self.instructions, &part.chunks);
        }
        self.work.forget_taken_back();
        let mut work = take(&mut self.work);
        for (field, column) in work.saved_mut().filter(|own| !own.1.is_empty()) {
            *column = gathering.columns(take(column), field.components(D), slots);
        }
        for sums in work.sums_mut() {
            *sums = gathering.sums(take(sums), self.particles.mobile);
        }
        let are_there = [work.records_of_rates, true];
        for (own, is_there) in work.records_mut().into_iter().zip(are_there) {
            let stride = own.stride();
            let here = take(own);
            if is_there && stride > 0 {
                let all = gathering.columns(here.into_data(), stride, slots);
                *own = Records::of_stored(all, stride);
            }
        }
        // Each sweep and each search for a common state begins anew.
        (work.sums, work.settling) = (Results::default(), Settling::default());
        self.work = work;
        self.show_images_again();
    }

    /// Makes the records of images, of which no rank has all.
    pub(super) fn show_images_again(&mut self) {
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
    /// The work of this rank, without records.
    fn work<T: Real, const D: usize>(
        &self,
        all: &Workspace<T, D>,
        (slots, chunks): (usize, usize),
        [own_mobile, mobile]: [usize; 2],
    ) -> Workspace<T, D> {
        let first = self.runs[0].start.min(mobile);
        let run = first..first + own_mobile;
        let saved = |all: &Saved<T>| -> Saved<T> {
            let own = |(field, column): &(Field, Vec<T>)| (*field, self.of_column(column, slots));
            all.iter().map(own).collect()
        };
        Workspace {
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

    /// The records of this rank and of its ghosts, of those of all particles.
    fn records<T: Real>(&self, all: &Records<T>, ghosts: &[u32]) -> Records<T> {
        if all.data().is_empty() {
            return Records::default();
        }
        let stride = all.stride();
        let ghosts = ghosts.iter().map(|slot| *slot as usize);
        let slots = self.runs.iter().cloned().flatten().chain(ghosts);
        let data = slots.flat_map(|slot| &all.data()[stride * slot..stride * (slot + 1)]);
        Records::of_stored(data.copied().collect(), stride)
    }
}

impl<T: Real, const D: usize> Workspace<T, D> {
    /// Columns of saved states that count.
    pub(super) fn saved_mut(&mut self) -> impl Iterator<Item = &mut (Field, Vec<T>)> {
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
    pub(super) fn sums_mut(&mut self) -> [&mut Results<T, D>; 2] {
        [&mut self.rates, &mut self.worked]
    }

    fn records_mut(&mut self) -> [&mut Records<T>; 2] {
        [&mut self.records, &mut self.work_records]
    }
}
