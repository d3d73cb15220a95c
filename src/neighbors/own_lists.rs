//! Lists of some chunks alone, as a rank has them, and what it says of them to the others: how many entries its clusters have.
//! Lists follow from positions, so whoever has these makes those that it lacks.

use super::clusters::{CHUNK, ChunkList, ClusterLists, SearchInput};
use super::sieve::LocalBlock;
use crate::ranks::{Taken, put_numbers};
use crate::scalar::Real;
use std::ops::Range;

/// The cost of a cluster without the entries of its list, in entries.
const CLUSTER: usize = 8;

impl ClusterLists {
    /// Lists of chunks whose clusters have so many entries, none of which is here.
    pub(crate) fn of_counts(counts: Vec<u32>) -> Self {
        let mut chunks = Vec::new();
        chunks.resize_with(counts.len().div_ceil(CHUNK), ChunkList::default);
        Self { chunks, counts }
    }

    /// Finds the neighbours of the clusters of some runs of chunks, and leaves the lists of all others.
    pub(crate) fn rebuild_some<T: Real, const D: usize>(
        &mut self,
        input: &SearchInput<'_, T, D>,
        runs: &[Range<usize>],
    ) {
        self.rebuild_among(input, &[], runs);
    }

    /// Finds the neighbours of all clusters that are here, where each block has other particles elsewhere.
    pub(crate) fn rebuild_local<T: Real, const D: usize>(
        &mut self,
        input: &SearchInput<'_, T, D>,
        blocks: &[LocalBlock<D>],
    ) {
        let chunks = (input.slots / input.width).div_ceil(CHUNK);
        self.rebuild_among(input, blocks, core::slice::from_ref(&(0..chunks)));
    }

    /// Entries of each cluster.
    pub(crate) fn counts(&self) -> &[u32] {
        &self.counts
    }

    /// Gives neighbours other numbers.
    pub(crate) fn renumber(&mut self, number: impl Fn(u32) -> u32) {
        for list in &mut self.chunks {
            list.neighbors.iter_mut().for_each(|j| *j = number(*j));
        }
    }

    /// The clusters of a run of chunks.
    fn clusters_of(&self, chunks: Range<usize>) -> Range<usize> {
        let at = |chunk: usize| (chunk * CHUNK).min(self.counts.len());
        at(chunks.start)..at(chunks.end)
    }

    /// Counts the entries of the clusters of some chunks.
    pub(super) fn count(&mut self, chunks: Range<usize>) {
        let clusters = self.clusters_of(chunks.clone());
        let lists = self.chunks[chunks].iter();
        let of_list = |list: &ChunkList| -> Vec<u32> {
            let of = |own: &[u32]| {
                let own = &list.segments[own[0] as usize..own[1] as usize];
                own.iter().map(|own| own.end - own.start).sum()
            };
            list.starts.windows(2).map(of).collect()
        };
        let counted = lists.flat_map(of_list);
        for (own, counted) in self.counts[clusters].iter_mut().zip(counted) {
            *own = counted;
        }
    }

    /// Whether the lists of all chunks are here.
    pub(crate) fn is_whole(&self) -> bool {
        self.chunks.iter().all(ChunkList::is_here)
    }

    /// Frees the lists of all chunks but some runs.
    pub(crate) fn keep(&mut self, runs: &[Range<usize>]) {
        for (chunk, list) in self.chunks.iter_mut().enumerate() {
            if !runs.iter().any(|own| own.contains(&chunk)) {
                *list = ChunkList::default();
            }
        }
    }

    /// The chunks of a run whose lists are not here, in runs.
    pub(crate) fn missing(&self, run: Range<usize>) -> Vec<Range<usize>> {
        let chunks: Vec<usize> = run.filter(|&own| !self.chunks[own].is_here()).collect();
        let next = |a: &usize, b: &usize| a + 1 == *b;
        let runs = chunks.chunk_by(next);
        runs.map(|own| own[0]..own[own.len() - 1] + 1).collect()
    }

    /// What each chunk costs a sweep, in entries.
    pub(crate) fn costs(&self) -> Vec<usize> {
        let of = |own: &[u32]| own.iter().map(|&own| own as usize + CLUSTER).sum();
        self.counts.chunks(CHUNK).map(of).collect()
    }

    /// Adds how many entries the clusters of some chunks have to a message.
    pub(crate) fn put_counts(&self, chunks: Range<usize>, to: &mut Vec<u8>) {
        put_numbers(&self.counts[self.clusters_of(chunks)], to);
    }

    /// Takes how many entries the clusters of some chunks have from a message.
    pub(crate) fn take_counts(&mut self, chunks: Range<usize>, from: &mut Taken<'_>) -> Option<()> {
        let clusters = self.clusters_of(chunks);
        from.numbers(&mut self.counts[clusters])
    }
}

impl ChunkList {
    /// Whether it was made here.
    pub(crate) fn is_here(&self) -> bool {
        !self.starts.is_empty()
    }

    /// The clusters that it has lists of.
    pub(crate) fn rows(&self) -> usize {
        self.starts.len().saturating_sub(1)
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
        assert!(whole.is_whole());
        let entries = whole.chunks().iter().map(|own| own.neighbors.len());
        assert_eq!(whole.entries(), entries.sum::<usize>());
        let mut all = ClusterLists::default();
        all.rebuild_some(&input, &[]);
        for part in [0..2, 2..2, 2..5] {
            let mut own = ClusterLists::default();
            own.rebuild_some(&input, core::slice::from_ref(&part));
            assert!(own.entries() < whole.entries() && !own.is_whole());
            let mut message = Vec::new();
            own.put_counts(part.clone(), &mut message);
            let mut taken = Taken(&message);
            assert_eq!(all.take_counts(part.clone(), &mut taken), Some(()));
            assert!(taken.0.is_empty());
            if !part.is_empty() {
                let short = &message[..message.len() - 1];
                assert_eq!(all.take_counts(part.clone(), &mut Taken(short)), None);
            }
            for (own, other) in own.chunks[part.clone()].iter().zip(&whole.chunks[part]) {
                assert_eq!(own.neighbors, other.neighbors);
                assert_eq!(own.segments, other.segments);
                assert_eq!(own.starts, other.starts);
            }
        }
        assert_eq!((&all.counts, all.costs()), (&whole.counts, whole.costs()));
        for slots in [0..2400_usize, 40..1333, 512..1024] {
            let rows = slots.start / 8..slots.end.div_ceil(8);
            let of_row = |row: usize| {
                let list = &whole.chunks[row / CHUNK];
                let own = list.segments_of(row % CHUNK).iter();
                own.map(|own| list.listed(own).0.len()).sum::<usize>()
            };
            assert_eq!(all.entries_of(slots, 8), rows.map(of_row).sum::<usize>());
        }
        let known = ClusterLists::of_counts(whole.counts.clone());
        assert_eq!((known.chunks.len(), known.entries()), (5, whole.entries()));
        assert_eq!(known.missing(1..4), core::slice::from_ref(&(1..4)));
        let mut other = whole.clone();
        other.renumber(|j| j + 1);
        assert_eq!(
            other.chunks[4].neighbors[3],
            whole.chunks[4].neighbors[3] + 1
        );
        whole.keep(core::slice::from_ref(&(1..3)));
        let here: Vec<bool> = whole.chunks.iter().map(ChunkList::is_here).collect();
        assert_eq!(here, [false, true, true, false, false]);
    }
}
