//! A group that has the particles of its rank alone, and the way back to that of all particles.
//! Copies of columns, sums and records: no number changes.

use super::group::Group;
use super::neighborhood::Neighborhood;
use super::part::{Part, runs_of};
use super::population::{BodyState, Moves, Particles};
use super::soundness::NEGATIVE_ENERGY;
use super::walls::WallState;
use super::workspace::{Saved, Workspace};
use crate::material::eos::GuardCounts;
use crate::particles::Field;
use crate::ranks::{Taken, What, put_number, put_numbers};
use crate::scalar::Real;
use crate::sweep::{Pass, Records};
use crate::term::Stage;
use std::ops::Range;
use std::sync::Arc;

/// The group of all particles, whose numbers are old, while a rank steps its own.
#[derive(Clone, Debug)]
pub(crate) struct All<T: Real, const D: usize> {
    pub part: Arc<Part>,
    particles: Particles<T, D>,
    neighborhood: Neighborhood<T, D>,
    work: Workspace<T, D>,
    walls: Vec<WallState<T, D>>,
    guards: GuardCounts,
    limited: Vec<(&'static str, u64)>,
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
        let own = part.particles(&self.particles, &self.walls);
        let slots = self.particles.columns.slots();
        let walls = self.walls.iter().map(|wall| WallState {
            slots: part.within(&wall.slots),
            end: part.at(wall.end),
            ..wall.clone()
        });
        let walls = walls.collect();
        let neighborhood = part.neighborhood(&self.neighborhood, slots);
        let chunks = self.neighborhood.lists.chunks().len();
        let work = part.work(
            &self.work,
            (slots, chunks),
            [own.mobile, self.particles.mobile],
        );
        self.all = Some(Box::new(All {
            part,
            particles: core::mem::replace(&mut self.particles, own),
            neighborhood: core::mem::replace(&mut self.neighborhood, neighborhood),
            work: core::mem::replace(&mut self.work, work),
            walls: core::mem::replace(&mut self.walls, walls),
            guards: core::mem::take(&mut self.guards),
            limited: core::mem::take(&mut self.limited),
        }));
    }

    /// Goes on with all particles, which all ranks give each other at once.
    pub(super) fn bring_together(&mut self) {
        let (Some(all), Some(share)) = (self.all.take(), self.share.clone()) else {
            return;
        };
        let All {
            part,
            particles,
            neighborhood,
            work,
            walls,
            guards,
            limited,
        } = *all;
        let names = self.names_of_limits();
        let mut message = Vec::new();
        self.put_own((&part, work.spent.pairs), &names, &mut message);
        let is_broken = share.team.is_broken();
        let own_particles = core::mem::replace(&mut self.particles, particles);
        let own_neighborhood = core::mem::replace(&mut self.neighborhood, neighborhood);
        let own_work = core::mem::replace(&mut self.work, work);
        self.walls = walls;
        self.guards = guards;
        self.limited = limited;
        drop(own_particles);
        if is_broken {
            // The others cannot be asked, and an error is told where the call ends.
            return;
        }
        self.neighborhood.served = own_neighborhood.served;
        self.neighborhood.placed_time = own_neighborhood.placed_time;
        self.neighborhood.chains = own_neighborhood.chains;
        let slots = self.particles.columns.slots();
        self.work.go_on(
            &own_work,
            self.particles.mobile,
            self.neighborhood.lists.chunks().len(),
        );
        let images = self.neighborhood.images.len();
        self.work.expect_records(&own_work, slots + images);
        self.work.expect_saved(&own_work, &self.particles, slots);
        let mut counts = vec![0; names.len()];
        let take = |rank: usize, from: &[u8]| {
            let runs = runs_of::<T>(share.division(), rank, slots);
            let chunks = share.division().of(rank);
            let mut from = Taken(from);
            self.take_own(&runs, &chunks, &mut counts, &mut from)?;
            from.0.is_empty().then_some(())
        };
        share
            .team
            .gather(What::State, |to| to.append(&mut message), take);
        for (name, count) in names.into_iter().zip(counts) {
            self.count(name, count);
        }
        self.show_images_again();
    }

    /// What a rank gives of its particles; before these were its own, so many pairs had been summed.
    fn put_own(&mut self, (part, pairs): (&Part, u64), names: &[&'static str], to: &mut Vec<u8>) {
        let pairs = self.work.spent.pairs - pairs;
        let GuardCounts {
            compression,
            expansion,
            cut_off,
        } = self.guards;
        for number in [compression, expansion, cut_off, pairs] {
            put_number(number, to);
        }
        for name in names {
            let own = self.limited.iter().find(|own| own.0 == *name);
            put_number(own.map_or(0, |own| own.1), to);
        }
        for (_, column) in self.particles.columns.iter_mut() {
            put_numbers(column, to);
        }
        for (_, column) in self.work.saved() {
            put_numbers(column, to);
        }
        let chunks = part.chunks.iter().map(Range::len).sum();
        for sums in [&self.work.rates, &self.work.worked] {
            sums.put_all(self.particles.mobile, chunks, to);
        }
        for records in self.work.records_at_hand() {
            let own = records.stride() * part.count();
            put_numbers(&records.data()[..own], to);
        }
    }

    /// Takes what a rank has given of its slots and chunks.
    fn take_own(
        &mut self,
        runs: &[Range<usize>; 2],
        chunks: &[Range<usize>; 2],
        counts: &mut [u64],
        from: &mut Taken<'_>,
    ) -> Option<()> {
        let guards = GuardCounts {
            compression: from.number()?,
            expansion: from.number()?,
            cut_off: from.number()?,
        };
        self.guards += guards;
        self.work.spent.pairs += from.number()?;
        for count in counts {
            *count += from.number()?;
        }
        let slots = self.particles.columns.slots();
        for (_, column) in self.particles.columns.iter_mut() {
            take_column(column, slots, runs, from)?;
        }
        for (_, column) in self.work.saved_mut() {
            take_column(column, slots, runs, from)?;
        }
        let mobile = self.particles.mobile;
        let own = runs[0].start..runs[0].end.min(mobile).max(runs[0].start);
        let Workspace { rates, worked, .. } = &mut self.work;
        rates.take_run(&own, chunks, from)?;
        worked.take_run(&own, chunks, from)?;
        for records in self.work.records_at_hand_mut() {
            let stride = records.stride();
            for run in runs {
                let own = stride * run.start..stride * run.end;
                from.numbers(records.data_mut().get_mut(own)?)?;
            }
        }
        Some(())
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

/// Takes a rank's numbers of a column of all slots.
fn take_column<T: Real>(
    column: &mut [T],
    slots: usize,
    runs: &[Range<usize>; 2],
    from: &mut Taken<'_>,
) -> Option<()> {
    let width = column.len().checked_div(slots).unwrap_or(0);
    for run in runs {
        from.numbers(column.get_mut(width * run.start..width * run.end)?)?;
    }
    Some(())
}

impl Part {
    /// The particles of this rank.
    fn particles<T: Real, const D: usize>(
        &self,
        all: &Particles<T, D>,
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
            columns: all.columns.of_runs(&self.runs),
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
        all: &Neighborhood<T, D>,
        slots: usize,
    ) -> Neighborhood<T, D> {
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
            lists: self.lists.clone(),
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

    fn records_at_hand(&self) -> impl Iterator<Item = &Records<T>> {
        let of_rates = self.records_of_rates.then_some(&self.records);
        of_rates.into_iter().chain([&self.work_records])
    }

    fn records_at_hand_mut(&mut self) -> impl Iterator<Item = &mut Records<T>> {
        let of_rates = self.records_of_rates.then_some(&mut self.records);
        of_rates.into_iter().chain([&mut self.work_records])
    }

    /// Goes on from the work of a rank, with room for the sums of so many slots and chunks.
    fn go_on(&mut self, own: &Self, mobile: usize, chunks: usize) {
        let pairs = self.spent.pairs;
        (self.phases, self.spent) = (own.phases, own.spent);
        self.spent.pairs = pairs;
        self.records_of_rates = own.records_of_rates;
        self.evaluated_time = own.evaluated_time;
        self.evaluated_gravity = own.evaluated_gravity;
        self.first_kick = own.first_kick;
        self.lengths_time = own.lengths_time;
        self.is_predicted = own.is_predicted;
        self.rates.expect(&own.rates, mobile, chunks);
        self.worked.expect(&own.worked, mobile, chunks);
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
    fn expect_saved(&mut self, own: &Self, all: &Particles<T, D>, slots: usize) {
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
