//! Sums as messages between ranks: those of some chunks, with the forces between blocks.
//! Sums of a chunk stand together, so they are copied as they are.

use super::results::{Reaction, Results};
use crate::neighbors::CHUNK;
use crate::particles::Output;
use crate::ranks::{Taken, put_number, put_numbers};
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
    /// The numbers of some chunks, of sums over slots that end at `end`.
    fn numbers_of(&self, chunks: &Range<usize>, end: usize) -> Range<usize> {
        let cluster = self.outputs.width(D) * Self::WIDTH;
        let skipped = self.first / (CHUNK * Self::WIDTH);
        let length = cluster * end.saturating_sub(self.first).div_ceil(Self::WIDTH);
        let at = |chunk: usize| (chunk.saturating_sub(skipped) * CHUNK * cluster).min(length);
        at(chunks.start)..at(chunks.end)
    }

    /// Adds the sums of some chunks, made over slots that end at `end`, to a message.
    pub(crate) fn put(&self, chunks: Range<usize>, end: usize, to: &mut Vec<u8>) {
        put_numbers(&self.data[self.numbers_of(&chunks, end)], to);
        if !self.outputs.contains(Output::FORCE) {
            return;
        }
        for own in self.reactions.get(chunks).unwrap_or_default() {
            put_reactions(own, to);
        }
    }

    /// Takes the sums of some chunks from a message, if they are these.
    pub(crate) fn take(
        &mut self,
        chunks: Range<usize>,
        end: usize,
        from: &mut Taken<'_>,
    ) -> Option<()> {
        let own = self.numbers_of(&chunks, end);
        from.numbers(self.data.get_mut(own)?)?;
        if !self.outputs.contains(Output::FORCE) {
            return Some(());
        }
        for own in self.reactions.get_mut(chunks).unwrap_or_default() {
            own.clear();
            take_reactions(own, from)?;
        }
        Some(())
    }
}

/// Sums over all particles that move by forces, of which a rank has those of a run of whole chunks.
impl<T: Real, const D: usize> Results<T, D> {
    /// Where the numbers of a run of slots stand.
    fn rows_of(&self, slots: &Range<usize>) -> Range<usize> {
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

    /// Gets ready for the sums of so many slots and chunks that ranks have.
    pub(crate) fn expect(&mut self, own: &Self, slots: usize, chunks: usize) {
        self.lay_out(own.outputs);
        self.first = 0;
        self.data.clear();
        self.data.resize(self.rows_of(&(0..slots)).end, T::zero());
        self.reactions.resize_with(chunks, Vec::new);
        self.reactions.iter_mut().for_each(Vec::clear);
    }

    /// Adds all sums of so many slots and chunks to a message.
    pub(crate) fn put_all(&self, slots: usize, chunks: usize, to: &mut Vec<u8>) {
        put_numbers(
            self.data.get(self.rows_of(&(0..slots))).unwrap_or_default(),
            to,
        );
        for chunk in 0..chunks {
            let own = self.reactions.get(chunk).map_or(&[][..], Vec::as_slice);
            put_reactions(own, to);
        }
    }

    /// Takes the sums of a run of slots and the forces on some chunks, which a rank had as all of its own.
    pub(crate) fn take_run(
        &mut self,
        slots: &Range<usize>,
        chunks: &[Range<usize>],
        from: &mut Taken<'_>,
    ) -> Option<()> {
        let rows = self.rows_of(slots);
        from.numbers(self.data.get_mut(rows)?)?;
        for own in chunks.iter().cloned().flatten() {
            let own = self.reactions.get_mut(own)?;
            take_reactions(own, from)?;
        }
        Some(())
    }
}
