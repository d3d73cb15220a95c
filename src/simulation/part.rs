//! What a rank has of a group between two list builds: the particles of its chunks, and ghosts that their lists name.
//! Ghosts are records that their ranks send before each sweep.

use super::walls::WallState;
use crate::neighbors::CHUNK;
use crate::ranks::{Division, Letters, Taken, Team, put_numbers};
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
    /// All images of its own particles.
    pub of_own: Vec<Image>,
    /// Slots here of chunks whose lists name its own particles alone, and of all others.
    pub inner_and_outer: [Vec<Range<usize>>; 2],
    pub halo: Arc<Halo>,
}

impl Part {
    /// The part of this rank in a group with so many slots, before its lists are made.
    pub fn of<T: Real>(team: &Arc<Team>, division: &Division, slots: usize) -> Self {
        let rank = team.rank();
        Self {
            runs: runs_of::<T>(division, rank, slots),
            chunks: division.of(rank),
            of_own: Vec::new(),
            inner_and_outer: [Vec::new(), Vec::new()],
            halo: Arc::new(Halo::none(team)),
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

    /// Lets particles of walls be known by how far they are from the first slot of the wall here, or in the group.
    pub fn number_walls<T, const D: usize>(
        &self,
        ids: &mut [u32],
        walls: &[WallState<T, D>],
        is_here: bool,
    ) {
        for wall in walls {
            let (here, in_group) = (self.at(wall.slots.start), wall.slots.start);
            let (before, after) = if is_here {
                (in_group, here)
            } else {
                (here, in_group)
            };
            for id in &mut ids[here..self.at(wall.end)] {
                *id = *id - before as u32 + after as u32;
            }
        }
    }

    /// Its own of a column of the group; none of a column that is not there.
    pub fn of_column<V: Copy>(&self, column: &[V], slots: usize) -> Vec<V> {
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
    /// That of a rank alone.
    fn none(team: &Arc<Team>) -> Self {
        Self {
            team: team.clone(),
            sends: Vec::new(),
            to: vec![0; team.count()],
            from: vec![0; team.count()],
        }
    }

    /// Asks the others for ghosts, rank by rank and so many of each, by their slots in the group; `number` is that of one of its own.
    pub fn new(
        team: &Arc<Team>,
        (ghosts, from): (&[u32], Vec<usize>),
        number: impl Fn(usize) -> usize,
    ) -> Self {
        let (mut sends, to) = team.letters((ghosts, &from), Letters::Ghosts(size_of::<u32>()));
        for slot in &mut sends {
            *slot = number(*slot as usize) as u32;
        }
        Self {
            team: team.clone(),
            sends,
            to,
            from,
        }
    }
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
