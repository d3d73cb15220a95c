//! A group that has the particles of its rank alone, and the way back to that of all particles.
//! Copies of columns, sums and records: no number changes.

use super::divided::Share;
use super::group::Group;
use super::migration::Leaving;
use super::neighborhood::Neighborhood;
use super::part::{Part, runs_of};
use super::population::{BodyState, Moves, Particles};
use super::soundness::NEGATIVE_ENERGY;
use super::walls::WallState;
use super::workspace::{Saved, Workspace};
use crate::material::eos::GuardCounts;
use crate::particles::{Columns, Field};
use crate::ranks::{Taken, What, put_number};
use crate::scalar::Real;
use crate::sweep::{Pass, Records, Results};
use crate::term::Stage;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// What a group has of all particles while a rank steps its own: all but columns, sums, records and lists.
#[derive(Clone, Debug)]
pub(crate) struct All<T: Real, const D: usize> {
    pub part: Arc<Part>,
    particles: Particles<T, D>,
    neighborhood: Neighborhood<T, D>,
    walls: Vec<WallState<T, D>>,
    guards: GuardCounts,
    limited: Vec<(&'static str, u64)>,
    /// Pairs summed before.
    pairs: u64,
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

impl<T: Real, const D: usize> Own<T, D> {
    /// Gets numbers of all particles, `width` a slot, from those that ranks have.
    fn gather(&self, own: &[T], all: &mut [T], width: usize) {
        let numbers = |run: &Range<usize>| width * run.start..width * run.end;
        let mut rest = own;
        for run in &self.part.runs {
            let (own, behind) = rest.split_at(width * run.len());
            all[numbers(run)].copy_from_slice(own);
            rest = behind;
        }
        let runs_of = |rank: usize| self.runs[rank].each_ref().map(numbers);
        let team = &self.share.team;
        team.gather_numbers(What::State, all, runs_of, Vec::new(), |_, _| Some(()));
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
            particles: core::mem::replace(&mut self.particles, own),
            neighborhood: core::mem::replace(&mut self.neighborhood, neighborhood),
            walls: core::mem::replace(&mut self.walls, walls),
            guards: core::mem::take(&mut self.guards),
            limited: core::mem::take(&mut self.limited),
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
            pairs,
        } = *all;
        let counts = self.counts(pairs);
        let own = core::mem::replace(&mut self.particles, particles);
        let near = core::mem::replace(&mut self.neighborhood, neighborhood);
        let work = core::mem::take(&mut self.work);
        (self.walls, self.guards, self.limited) = (walls, guards, limited);
        let slots = self.particles.columns.slots();
        self.neighborhood.take_back(&part, near, slots);
        let runs = (0..share.team.count())
            .map(|rank| runs_of::<T>(share.division(), rank, slots))
            .collect();
        self.work.go_on(&work, pairs);
        let mut all = vec![0; counts.len()];
        let put = |to: &mut Vec<u8>| counts.iter().for_each(|own| put_number(*own, to));
        share.team.gather(What::State, put, |_, from| {
            let mut from = Taken(from);
            for count in &mut all {
                *count += from.number()?;
            }
            from.0.is_empty().then_some(())
        });
        self.add_counts(&all);
        Some(Own {
            part,
            share,
            runs,
            columns: own.columns,
            work,
        })
    }

    /// Gets columns of all particles.
    fn gather_columns(&mut self, own: &mut Own<T, D>, fields: impl Iterator<Item = Field>) {
        let slots = self.particles.columns.slots();
        for field in fields {
            let width = field.components(D);
            let here = core::mem::take(own.columns.column_mut(field));
            let column = self.particles.columns.column_mut(field);
            // Where a rank has failed its particles are where they were listed, and the error is told where the call ends.
            *column = if field == Field::POSITION {
                self.neighborhood.listed[..slots].as_flattened().to_vec()
            } else {
                vec![T::zero(); width * slots]
            };
            own.gather(&here, column, width);
        }
    }

    /// Goes on with places and smoothing lengths of all particles, from which lists are built. All else, of which ranks send to others
    /// what is theirs after that.
    pub(super) fn leave(&mut self) -> Option<Leaving<T, D>> {
        let mut own = self.open()?;
        let fields = self.particles.columns.fields();
        let places = [Field::POSITION, Field::SMOOTHING_LENGTH].into_iter();
        self.gather_columns(&mut own, places.filter(|field| fields.contains(*field)));
        own.forget_records();
        Some(Leaving {
            division: own.share.division().clone(),
            columns: own.columns,
            work: own.work,
        })
    }

    /// Goes on with all particles, which all ranks give each other at once, column by column; without their records where lists are
    /// built next.
    pub(super) fn bring_together(&mut self, for_lists: bool) {
        let Some(mut own) = self.open() else {
            return;
        };
        if for_lists {
            own.forget_records();
        }
        let fields = self.particles.columns.fields();
        self.gather_columns(&mut own, fields.iter());
        let slots = self.particles.columns.slots();
        self.work.expect_saved(&own.work, &self.particles, slots);
        for ((_, here), (field, all)) in own.work.saved().zip(self.work.saved_mut()) {
            if !all.is_empty() {
                own.gather(here, all, field.components(D));
            }
        }
        let (team, division) = (own.share.team.clone(), own.share.division());
        let chunks: Vec<_> = (0..team.count()).map(|rank| division.of(rank)).collect();
        let mobile = self.particles.mobile;
        let count = self.neighborhood.lists.chunks().len();
        for (sums, all) in own.work.sums_mut().into_iter().zip(self.work.sums_mut()) {
            let moving =
                |runs: &[Range<usize>; 2]| runs[0].start.min(mobile)..runs[0].end.min(mobile);
            let (sums, here) = (core::mem::take(sums), (&moving(&own.part.runs), mobile));
            *all = Results::among(sums, here, (&own.part.chunks, count));
            let rows = |runs: &[Range<usize>; 2]| [all.rows_of(&moving(runs)), 0..0];
            let rows: Vec<_> = own.runs.iter().map(rows).collect();
            all.gather((&team, What::State), &rows, &chunks);
        }
        if !for_lists {
            self.work
                .expect_records(&own.work, slots + self.neighborhood.images.len());
            for (here, all) in own.work.records().into_iter().zip(self.work.records_mut()) {
                if !all.data().is_empty() {
                    let stride = all.stride();
                    own.gather(here.data(), all.data_mut(), stride);
                }
            }
            self.show_images_again();
        }
    }

    /// What guards and limits have counted, and how many pairs were summed beside some.
    fn counts(&self, pairs: u64) -> Vec<u64> {
        let GuardCounts {
            compression,
            expansion,
            cut_off,
        } = self.guards;
        let mut counts = vec![
            compression,
            expansion,
            cut_off,
            self.work.spent.pairs - pairs,
        ];
        counts.extend(self.names_of_limits().into_iter().map(|name| {
            let own = self.limited.iter().find(|own| own.0 == name);
            own.map_or(0, |own| own.1)
        }));
        counts
    }

    fn add_counts(&mut self, counts: &[u64]) {
        let [compression, expansion, cut_off, pairs, limited @ ..] = counts else {
            return;
        };
        self.guards += GuardCounts {
            compression: *compression,
            expansion: *expansion,
            cut_off: *cut_off,
        };
        self.work.spent.pairs += pairs;
        for (name, count) in self.names_of_limits().into_iter().zip(limited) {
            self.count(name, *count);
        }
    }

    /// Makes the records of images, of which no rank has all.
    fn show_images_again(&mut self) {
        let scheme = self.scheme.clone();
        let Some(sweep) = scheme.sweep(Stage::Rates) else {
            return;
        };
        let mut records = core::mem::take(&mut self.work.records);
        if self.work.records_of_rates {
            sweep.show_images(Pass::Rates, &self.input(), &mut records);
        }
        self.work.records = records;
        let mut records = core::mem::take(&mut self.work.work_records);
        if !records.data().is_empty() {
            sweep.show_images(Pass::Work, &self.input(), &mut records);
        }
        self.work.work_records = records;
    }

    /// Names of all limits that may be counted, in the order of the scheme.
    fn names_of_limits(&self) -> Vec<&'static str> {
        let program = &self.scheme.program;
        let laws = program.laws.iter().flatten().map(|law| law.name());
        let updates = program.evolved.iter().map(|own| program.name_of(own.field));
        let mut names = Vec::new();
        for name in laws.chain(updates).chain([NEGATIVE_ENERGY]) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
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
            listed: self.named(slots).map(|other| all.listed[other]).collect(),
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
        let named: Vec<u32> = part.named(slots).map(|own| own as u32).collect();
        let lists = Arc::unwrap_or_clone(own.lists);
        let number = |j: u32| named[j as usize];
        Arc::make_mut(&mut self.lists).put_runs(lists, &part.chunks, number);
        (self.served, self.placed_time) = (own.served, own.placed_time);
        self.chains = own.chains;
    }
}

impl<T: Real, const D: usize> Workspace<T, D> {
    /// Columns of saved states that count.
    fn saved(&self) -> impl Iterator<Item = &(Field, Vec<T>)> {
        let predicted = self.predicted.iter().filter(|_| self.is_predicted);
        self.kept.iter().flatten().chain(predicted)
    }

    fn saved_mut(&mut self) -> impl Iterator<Item = &mut (Field, Vec<T>)> {
        let is_predicted = self.is_predicted;
        let predicted = self.predicted.iter_mut().filter(move |_| is_predicted);
        self.kept.iter_mut().flatten().chain(predicted)
    }

    /// Sums that the next step reads.
    fn sums_mut(&mut self) -> [&mut Results<T, D>; 2] {
        [&mut self.rates, &mut self.worked]
    }

    fn records(&self) -> [&Records<T>; 2] {
        [&self.records, &self.work_records]
    }

    fn records_mut(&mut self) -> [&mut Records<T>; 2] {
        [&mut self.records, &mut self.work_records]
    }

    /// Goes on from the work of a rank, after so many pairs.
    fn go_on(&mut self, own: &Self, pairs: u64) {
        (self.phases, self.spent) = (own.phases, own.spent);
        self.spent.pairs = pairs;
        self.records_of_rates = own.records_of_rates;
        self.evaluated_time = own.evaluated_time;
        self.evaluated_gravity = own.evaluated_gravity;
        self.first_kick = own.first_kick;
        self.lengths_time = own.lengths_time;
        self.is_predicted = own.is_predicted;
    }

    /// Makes room for so many records of the kinds that a rank has.
    fn expect_records(&mut self, own: &Self, count: usize) {
        let room = |own: &Records<T>| {
            let stride = own.stride();
            Records::of_stored(vec![T::zero(); stride * count], stride)
        };
        if own.records_of_rates {
            self.records = room(&own.records);
        }
        self.work_records = room(&own.work_records);
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
