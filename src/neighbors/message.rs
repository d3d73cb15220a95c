//! Lists as messages between ranks: those of some chunks, as they are.
//! Lists follow from positions alone, so what one rank finds is what all would find.

use super::SearchInput;
use super::clusters::{CHUNK, ChunkList, ClusterLists, Order, Segment};
use crate::ranks::{Taken, put_number, put_words};
use crate::scalar::Real;
use std::ops::Range;

/// In a message the order of a segment stands behind its block.
const ORDERS: [Order; 3] = [Order::Apart, Order::Later, Order::Earlier];

/// Numbers of a segment.
const NUMBERS: usize = 4;

impl ClusterLists {
    /// The lists of some chunks, whose neighbours get other numbers.
    pub(crate) fn of_chunks(
        &self,
        chunks: impl Iterator<Item = usize>,
        number: impl Fn(u32) -> u32,
    ) -> Self {
        let of = |chunk: usize| {
            let list = &self.chunks[chunk];
            ChunkList {
                neighbors: list.neighbors.iter().map(|&j| number(j)).collect(),
                segments: list.segments.clone(),
                starts: list.starts.clone(),
            }
        };
        Self {
            chunks: chunks.map(of).collect(),
        }
    }

    /// Adds the lists of some chunks to a message.
    pub(crate) fn put(&self, chunks: Range<usize>, to: &mut Vec<u8>) {
        for list in &self.chunks[chunks] {
            let lengths = [list.neighbors.len(), list.segments.len(), list.starts.len()];
            for length in lengths {
                put_number(length as u64, to);
            }
            put_words(&list.neighbors, to);
            put_words(&list.starts, to);
            for own in &list.segments {
                let order = ORDERS.iter().position(|order| *order == own.order);
                let order = order.unwrap_or(0) as u32;
                let kind = own.block * ORDERS.len() as u32 + order;
                put_words(&[own.start, own.near_end, own.end, kind], to);
            }
        }
    }

    /// Takes the lists of some chunks from a message, if they are these, and of these particles.
    pub(crate) fn take<T: Real, const D: usize>(
        &mut self,
        chunks: Range<usize>,
        input: &SearchInput<'_, T, D>,
        from: &mut Taken<'_>,
    ) -> Option<()> {
        let (mut numbers, all) = (Vec::new(), input.slots.div_ceil(input.width));
        for (chunk, list) in chunks.clone().zip(self.chunks.get_mut(chunks)?) {
            let mut length = || from.number().map(|length| length as usize);
            let [neighbors, segments, starts] = [length()?, length()?, length()?];
            let ChunkList {
                neighbors: own,
                segments: runs,
                starts: begins,
            } = list;
            own.clear();
            from.words(neighbors, own)?;
            begins.clear();
            from.words(starts, begins)?;
            numbers.clear();
            from.words(segments.checked_mul(NUMBERS)?, &mut numbers)?;
            runs.clear();
            runs.extend(numbers.chunks_exact(NUMBERS).map(|own| Segment {
                start: own[0],
                near_end: own[1],
                end: own[2],
                block: own[3] / ORDERS.len() as u32,
                order: ORDERS[own[3] as usize % ORDERS.len()],
            }));
            let clusters = CHUNK.min(all.saturating_sub(chunk * CHUNK));
            let named = [input.positions.len(), input.blocks.len()];
            list.fits(clusters, named).then_some(())?;
        }
        Some(())
    }
}

impl ChunkList {
    /// Whether it is of so many clusters and names nothing beyond so many particles and blocks: that of another scene is not.
    fn fits(&self, clusters: usize, [particles, blocks]: [usize; 2]) -> bool {
        let entries = self.neighbors.len() as u32;
        let is_run = |own: &Segment| {
            own.start <= own.near_end && own.near_end <= own.end && own.end <= entries
        };
        self.starts.len() == clusters + 1
            && self.starts.is_sorted()
            && self.starts.last() == Some(&(self.segments.len() as u32))
            && self
                .segments
                .iter()
                .all(|own| is_run(own) && (own.block as usize) < blocks)
            && self.neighbors.iter().all(|&j| (j as usize) < particles)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::neighbors::{Block, Radii, SearchInput};
    use crate::scalar::InstructionSet;

    #[test]
    fn lists_of_parts_are_those_of_the_whole() {
        let place = |k: usize| [(k as f64 * 0.618).fract(), (k as f64 * 0.414).fract()];
        let mut positions: Vec<[f64; 2]> = (0..2400).map(place).collect();
        positions[..1600].sort_by(|a, b| a[0].total_cmp(&b[0]));
        let block = |slots, wall| Block { slots, wall };
        let input = SearchInput {
            positions: &positions,
            radii: Radii::Uniform(0.06),
            blocks: &[block(0..1600, false), block(1600..2400, true)],
            listed: &[],
            width: 8,
            slots: 2400,
            skin: 0.01,
            instructions: InstructionSet::detect(),
        };
        let mut whole = ClusterLists::default();
        whole.rebuild(&input);
        let chunks = whole.chunks().len();
        assert_eq!(chunks, 5);
        let mut all = ClusterLists::default();
        for part in [0..2, 2..2, 2..5] {
            let mut own = ClusterLists::default();
            own.rebuild_some(&input, |_| part.clone());
            assert!(own.entries() < whole.entries());
            all.chunks.resize_with(chunks, ChunkList::default);
            let mut message = Vec::new();
            own.put(part.clone(), &mut message);
            let mut taken = Taken(&message);
            assert_eq!(all.take(part.clone(), &input, &mut taken), Some(()));
            assert!(taken.0.is_empty());
            if !part.is_empty() {
                let short = &message[..message.len() - 1];
                assert_eq!(own.take(part.clone(), &input, &mut Taken(short)), None);
                // Of a scene that has more particles.
                let few = SearchInput {
                    positions: &positions[..1200],
                    ..input
                };
                assert_eq!(own.take(part, &few, &mut Taken(&message)), None);
            }
        }
        for (own, other) in all.chunks().iter().zip(whole.chunks()) {
            assert_eq!(own.neighbors, other.neighbors);
            assert_eq!(own.segments, other.segments);
            assert_eq!(own.starts, other.starts);
        }
    }
}
