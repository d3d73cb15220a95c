//! Sums as messages between ranks: those of some chunks, with the forces between blocks.
//! Sums of a chunk stand together, so they are copied as they are.

use super::results::{Reaction, Results};
use crate::neighbors::CHUNK;
use crate::particles::Output;
use crate::ranks::{Source, Taken, put_number, put_numbers};
use crate::scalar::Real;
use std::ops::Range;

/// Adds the forces of a chunk between blocks to a message.
fn put_reactions<const D: usize>(own: &[Reaction<D>], to: &mut Vec<u8>) {
    put_number(own.len() as u64, to);
    for Reaction { on, from, force } in own {
        put_number(u64::from(*on) << 32 | u64::from(*from), to);
        put_numbers(force, to);
    }
}

/// Adds those that a message begins with.
fn take_reactions<const D: usize>(own: &mut Vec<Reaction<D>>, from: &mut Taken<'_>) -> Option<()> {
    for _ in 0..from.number()? {
        let blocks = from.number()?;
        let mut force = [0.0; D];
        from.numbers(&mut force)?;
        own.push(Reaction {
            on: (blocks >> 32) as u32,
            from: blocks as u32,
            force,
        });
    }
    Some(())
}

impl<T: Real, const D: usize> Results<T, D> {
    /// Where the numbers of some chunks stand, of sums over slots that end at `end`.
    pub(crate) fn numbers_of(&self, chunks: &Range<usize>, end: usize) -> Range<usize> {
        let cluster = self.outputs.width(D) * Self::WIDTH;
        let skipped = self.first / (CHUNK * Self::WIDTH);
        let length = cluster * end.saturating_sub(self.first).div_ceil(Self::WIDTH);
        let at = |chunk: usize| (chunk.saturating_sub(skipped) * CHUNK * cluster).min(length);
        at(chunks.start)..at(chunks.end)
    }

    /// Gets the sums of all ranks where their numbers stand, and the forces on their chunks between blocks.
    pub(crate) fn gather(
        &mut self,
        source: Source<'_>,
        numbers: &[[Range<usize>; 2]],
        chunks: &[[Range<usize>; 2]],
    ) {
        let mut forces = self.reactions.as_mut_slice();
        if !self.outputs.contains(Output::FORCE) {
            forces = &mut [];
        }
        let of_rank = |rank: usize| chunks[rank].clone().into_iter().flatten();
        let mut added = Vec::new();
        for chunk in of_rank(source.team().rank()) {
            if let Some(own) = forces.get(chunk) {
                put_reactions(own, &mut added);
            }
        }
        let runs_of = |rank: usize| numbers[rank].clone();
        source.numbers(&mut self.data, runs_of, added, |rank, from| {
            for chunk in of_rank(rank) {
                if let Some(own) = forces.get_mut(chunk) {
                    own.clear();
                    take_reactions(own, from)?;
                }
            }
            Some(())
        });
    }
}

/// Sums over all particles that move by forces, of which a rank has those of a run of whole chunks.
impl<T: Real, const D: usize> Results<T, D> {
    /// Where the numbers of a run of slots stand.
    pub(crate) fn rows_of(&self, slots: &Range<usize>) -> Range<usize> {
        let cluster = self.outputs.width(D) * Self::WIDTH;
        slots.start / Self::WIDTH * cluster..slots.end.div_ceil(Self::WIDTH) * cluster
    }

    /// The sums of a run of slots, and the forces on its chunks and others, among so many chunks.
    pub(crate) fn of_run(
        &self,
        slots: &Range<usize>,
        (chunks, count): (&[Range<usize>], usize),
    ) -> Self {
        let mut own = Self::default();
        own.lay_out(self.outputs);
        let rows = self.data.get(self.rows_of(slots));
        own.data = rows.unwrap_or_default().to_vec();
        if self.reactions.len() == count {
            for run in chunks {
                own.reactions
                    .extend_from_slice(&self.reactions[run.clone()]);
            }
        } else if chunks.iter().any(|run| run.contains(&0)) {
            // A checkpoint does not tell chunks: their sums are those of all, so the first rank has them.
            own.reactions.push(self.reactions().copied().collect());
        }
        own
    }

    /// Adds them to a message as others [gather](Self::gather) them, of a rank with so many chunks.
    pub(crate) fn put(&self, chunks: usize, to: &mut Vec<u8>) {
        put_numbers(&self.data, to);
        if self.outputs.contains(Output::FORCE) {
            for chunk in 0..chunks {
                put_reactions(self.reactions.get(chunk).map_or(&[], Vec::as_slice), to);
            }
        }
    }

    /// The sums of the first slots, slot by slot.
    pub(crate) fn numbers(&self, slots: usize) -> Vec<T> {
        let width = self.outputs.width(D);
        let mut own = Vec::with_capacity(width * slots);
        for slot in 0..slots {
            own.extend((0..width).map(|k| self.number(k, slot)));
        }
        own
    }

    /// The sums of a run of slots and the forces on some chunks, with room for those of so many slots and chunks.
    pub(crate) fn among(
        own: Self,
        (slots, mobile): (&Range<usize>, usize),
        (chunks, count): (&[Range<usize>], usize),
    ) -> Self {
        let mut all = Self::default();
        all.lay_out(own.outputs);
        all.data.resize(all.rows_of(&(0..mobile)).end, T::zero());
        all.reactions.resize_with(count, Vec::new);
        let rows = all.rows_of(slots);
        all.data[rows.start..rows.start + own.data.len()].copy_from_slice(&own.data);
        let places = chunks.iter().cloned().flatten();
        for (chunk, own) in places.zip(own.reactions) {
            all.reactions[chunk] = own;
        }
        all
    }
}
