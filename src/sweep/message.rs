//! Sums as messages between ranks: those of some chunks, with the forces between blocks.
//! Sums of a chunk stand together, so they are copied as they are.

use super::results::{Reaction, Results};
use crate::neighbors::CHUNK;
use crate::particles::Output;
use crate::ranks::{Taken, put_number, put_numbers};
use crate::scalar::Real;
use std::ops::Range;

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
            put_number(own.len() as u64, to);
            for Reaction { on, from, force } in own {
                put_number(u64::from(*on) << 32 | u64::from(*from), to);
                put_numbers(force, to);
            }
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
        }
        Some(())
    }
}
