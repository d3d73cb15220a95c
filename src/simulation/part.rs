//! What a rank has of a group between two list builds: the particles of its chunks, and ghosts that their lists name.
//! It follows from the lists alone. Ghosts are records that their ranks send before each sweep.

use super::neighborhood::Neighborhood;
use crate::neighbors::{Block, CHUNK};
use crate::ranks::{Division, Letters, Taken, Team, put_numbers, put_words};
use crate::scalar::{Real, width};
use crate::sweep::{Ghosts, Image};
use std::ops::Range;
use std::sync::Arc;

/// Slots of a chunk.
pub(super) fn chunk_slots<T: Real>() -> usize {
    CHUNK * width::<T>()
}

/// The slots of a rank, of so many: of particles that move by forces, and of all others.
pub(super) fn runs_of<T: Real>(
    division: &Division,
    rank: usize,
    slots: usize,
) -> [Range<usize>; 2] {
    let size = chunk_slots::<T>();
    let own = division.of(rank);
    own.map(|chunks| (chunks.start * size).min(slots)..(chunks.end * size).min(slots))
}

/// How many slots of these runs stand before a slot.
pub(super) fn place_in(runs: &[Range<usize>; 2], slot: usize) -> usize {
    let before = |run: &Range<usize>| slot.clamp(run.start, run.end) - run.start;
    runs.iter().map(before).sum()
}

/// The part of a rank in a group. Its own particles stand in the first slots, in their order; ghosts have the next numbers of its
/// lists, and images those behind.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Its own slots among those of the group.
    pub runs: [Range<usize>; 2],
    pub chunks: [Range<usize>; 2],
    /// Slots of ghosts in the group.
    pub ghosts: Vec<u32>,
    /// Images that its lists name, by their numbers in the group, and what they are here.
    pub images: Vec<u32>,
    pub shown: Vec<Image>,
    /// All images of its own particles in the group.
    pub of_own: Vec<Image>,
    /// Slots here of chunks whose lists name its own particles alone, and of all others.
    inner_and_outer: [Vec<Range<usize>>; 2],
    pub halo: Arc<Halo>,
}

/// Own slots, those of ghosts, and images behind so many slots.
fn named(
    runs: &[Range<usize>; 2],
    ghosts: &[u32],
    images: &[u32],
    slots: usize,
) -> impl Iterator<Item = usize> {
    let ghosts = ghosts.iter().map(|&slot| slot as usize);
    let images = images.iter().map(move |&k| slots + k as usize);
    runs.iter().cloned().flatten().chain(ghosts).chain(images)
}

/// Adds a run of slots that begins where the last one ends, or behind it.
fn add_run(runs: &mut Vec<Range<usize>>, run: Range<usize>) {
    match runs.last_mut() {
        Some(last) if last.end == run.start => last.end = run.end,
        _ => runs.push(run),
    }
}

impl Part {
    /// The part of this rank by the lists of the group, which all ranks ask for at once.
    pub fn of<T: Real, const D: usize>(
        team: &Arc<Team>,
        division: &Division,
        group: &Neighborhood<T, D>,
    ) -> Self {
        let slots = group.listed.len() - group.images.len();
        let (rank, ranks) = (team.rank(), team.count());
        let (runs, chunks) = (runs_of::<T>(division, rank, slots), division.of(rank));
        let mut is_named = vec![false; group.listed.len()];
        let mut inner_and_outer = [Vec::new(), Vec::new()];
        let mut next = 0;
        for chunk in chunks.iter().cloned().flatten() {
            let mut is_outer = false;
            for &j in &group.lists.chunks()[chunk].neighbors {
                is_named[j as usize] = true;
                is_outer |= !runs.iter().any(|run| run.contains(&(j as usize)));
            }
            let size = chunk_slots::<T>();
            add_run(
                &mut inner_and_outer[usize::from(is_outer)],
                next..next + size,
            );
            next += size;
        }
        let images = (0..group.images.len() as u32).filter(|k| is_named[slots + *k as usize]);
        let images: Vec<u32> = images.collect();
        for &k in &images {
            is_named[group.images[k as usize].source as usize] = true;
        }
        for run in &runs {
            is_named[run.clone()].fill(false);
        }
        let (mut ghosts, mut from) = (Vec::new(), vec![0; ranks]);
        for (other, count) in from.iter_mut().enumerate() {
            let named = runs_of::<T>(division, other, slots).into_iter().flatten();
            ghosts.extend(named.filter(|&slot| is_named[slot]).map(|slot| slot as u32));
            *count = ghosts.len();
        }
        for other in (1..ranks).rev() {
            from[other] -= from[other - 1];
        }
        let mut numbers = vec![u32::MAX; group.listed.len()];
        for (number, own) in named(&runs, &ghosts, &images, slots).enumerate() {
            numbers[own] = number as u32;
        }
        let here = |own: &Image| Image {
            source: numbers[own.source as usize],
            ..*own
        };
        let shown = images.iter().map(|&k| here(&group.images[k as usize]));
        let count = runs.iter().map(Range::len).sum();
        let of_own = group.images.iter().map(here);
        let of_own = of_own.filter(|own| (own.source as usize) < count);
        let (shown, of_own) = (shown.collect(), of_own.collect());
        let halo = Halo::new(team, (&ghosts, from), |slot| numbers[slot as usize]);
        Self {
            runs,
            chunks,
            ghosts,
            images,
            shown,
            of_own,
            inner_and_outer,
            halo: Arc::new(halo),
        }
    }

    /// How many of its own stand before a slot of the group: the slot here of one of its own.
    pub fn at(&self, slot: usize) -> usize {
        place_in(&self.runs, slot)
    }

    /// Its own of a run of slots.
    pub fn within(&self, slots: &Range<usize>) -> Range<usize> {
        self.at(slots.start)..self.at(slots.end)
    }

    /// Slots here of a sweep over these: of chunks whose lists name its own particles alone, and of all others.
    pub fn inner_and_outer(&self, targets: &Range<usize>) -> [Vec<Range<usize>>; 2] {
        self.inner_and_outer.each_ref().map(|runs| {
            let within =
                |run: &Range<usize>| run.start.max(targets.start)..run.end.min(targets.end);
            runs.iter()
                .map(within)
                .filter(|run| !run.is_empty())
                .collect()
        })
    }

    /// How many are its own.
    pub fn count(&self) -> usize {
        self.runs.iter().map(Range::len).sum()
    }

    /// The slot in the group of one of its own.
    pub fn slot_in_group(&self, slot: usize) -> usize {
        let first = self.runs[0].len();
        match slot.checked_sub(first) {
            None => self.runs[0].start + slot,
            Some(behind) => self.runs[1].start + behind,
        }
    }

    /// What it has of a block of a group with so many slots.
    pub fn block(&self, block: &Block, slots: usize) -> Block {
        let own = if block.slots.start < slots {
            self.within(&block.slots)
        } else {
            let first = self.count() + self.ghosts.len();
            let before = |slot: usize| {
                self.images
                    .partition_point(|&k| (k as usize) < slot - slots)
            };
            first + before(block.slots.start)..first + before(block.slots.end)
        };
        Block {
            slots: own,
            ..block.clone()
        }
    }

    /// What its lists name, by their numbers in a group with so many slots, in the order of its own numbers.
    pub fn named(&self, slots: usize) -> impl Iterator<Item = usize> {
        named(&self.runs, &self.ghosts, &self.images, slots)
    }

    /// Its own numbers of a column of the group; none of a column that is not there.
    pub fn of_column<T: Real>(&self, column: &[T], slots: usize) -> Vec<T> {
        let width = column.len().checked_div(slots).unwrap_or(0);
        let mut own = Vec::with_capacity(width * self.count());
        for run in &self.runs {
            own.extend_from_slice(&column[width * run.start..width * run.end]);
        }
        own
    }
}

/// Who needs which particles of this rank, and how many of each it needs itself.
#[derive(Debug)]
pub(crate) struct Halo {
    team: Arc<Team>,
    /// Own slots that others need, rank by rank, and how many of these each needs.
    sends: Vec<u32>,
    to: Vec<usize>,
    from: Vec<usize>,
}

impl Halo {
    /// Asks the others for ghosts, rank by rank and so many of each, by their slots in the group.
    fn new(
        team: &Arc<Team>,
        (ghosts, from): (&[u32], Vec<usize>),
        number: impl Fn(u32) -> u32,
    ) -> Self {
        let ranks = team.count();
        let (mut asked, mut counts) = (Vec::new(), vec![0; 8 * ranks]);
        put_counts(&from, &mut asked);
        let each = vec![8; ranks];
        let told = team.exchange(Letters::Each(8), (&asked, &each), (&mut counts, &each));
        let to: Vec<usize> = counts.chunks_exact(8).map(count_of).collect();
        asked.clear();
        put_words(ghosts, &mut asked);
        let bytes = |counts: &[usize]| -> Vec<usize> { counts.iter().map(|n| 4 * n).collect() };
        let mut wanted = vec![
            0;
            if told {
                4 * to.iter().sum::<usize>()
            } else {
                0
            }
        ];
        let slots = Letters::Ghosts(4);
        let told =
            told && team.exchange(slots, (&asked, &bytes(&from)), (&mut wanted, &bytes(&to)));
        let mut sends = Vec::new();
        if told {
            let _ = Taken(&wanted).words(wanted.len() / 4, &mut sends);
        }
        for slot in &mut sends {
            *slot = number(*slot);
        }
        Self {
            team: team.clone(),
            sends,
            to,
            from,
        }
    }
}

fn put_counts(counts: &[usize], to: &mut Vec<u8>) {
    for count in counts {
        crate::ranks::put_number(*count as u64, to);
    }
}

fn count_of(bytes: &[u8]) -> usize {
    Taken(bytes).number().unwrap_or(0) as usize
}

impl<T: Real> Ghosts<T> for Halo {
    fn count(&self) -> usize {
        self.from.iter().sum()
    }

    fn fill(&self, own: &[T], stride: usize, ghosts: &mut [T], meanwhile: &mut dyn FnMut()) {
        let size = stride * size_of::<T>();
        let mut letters = Vec::with_capacity(size * self.sends.len());
        for &slot in &self.sends {
            let first = slot as usize * stride;
            put_numbers(&own[first..first + stride], &mut letters);
        }
        let bytes = |counts: &[usize]| -> Vec<usize> { counts.iter().map(|n| size * n).collect() };
        let mut come = vec![0; size_of_val(ghosts)];
        let (to, from) = (bytes(&self.to), bytes(&self.from));
        let records = Letters::Ghosts(size);
        let (own, all) = ((&letters[..], &to[..]), (&mut come[..], &from[..]));
        if self.team.exchange_beside(records, own, all, meanwhile) {
            let _ = Taken(&come).numbers(ghosts);
        }
    }
}
