//! Cluster lists with a skin: the neighbours of rows of consecutive particles.
//! A row of W particles shares one list, so the pair loop broadcasts each neighbour to full lanes.

use super::sieve::{Candidates, LocalBlock, Sieve, Source};
use crate::parallel::{collect, cut, for_each};
use crate::scalar::{InstructionSet, Real};
use std::ops::Range;

/// Clusters that one thread takes at a time; fixed, so sums never depend on the number of threads.
pub const CHUNK: usize = 64;

/// A run of slots that belongs to one body, or a run of images behind one boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The slots of the block's particles; starts at a whole number of clusters.
    pub slots: Range<usize>,
    /// Whether it is a wall, whose particles do not move by forces.
    pub wall: bool,
}

/// Where the neighbours of a cluster are in the order of its chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// In the cluster itself, in another chunk, or in another block.
    Apart,
    /// In later clusters of its chunk and block: a sweep may sum such a pair for both.
    Later,
    /// In earlier ones, which have the cluster among their later neighbours.
    Earlier,
}

/// A run of a cluster's neighbours that belong to one block, and have one place in the order of its chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// First entry in the chunk's list.
    pub start: u32,
    /// One past the last entry that was nearer to some member than its support less the skin. While the
    /// lists are valid these need no look at their distance before a pair is summed.
    pub near_end: u32,
    /// One past the last entry.
    pub end: u32,
    /// The block that the neighbours belong to.
    pub block: u32,
    /// Where they are in the order of the chunk; in one dimension all are [`Order::Apart`].
    pub order: Order,
}

/// The neighbour lists of [`CHUNK`] clusters.
#[derive(Debug, Default)]
pub struct ChunkList {
    /// Slots of neighbours, cluster after cluster, by block inside a cluster.
    pub neighbors: Vec<u32>,
    /// Segments, cluster after cluster.
    pub segments: Vec<Segment>,
    /// Where each cluster's segments start, and the end of the last.
    pub starts: Vec<u32>,
}

impl Clone for ChunkList {
    /// With the same room to grow: a copy that steps takes the memory that the list itself would take.
    fn clone(&self) -> Self {
        fn roomy<V: Copy>(own: &Vec<V>) -> Vec<V> {
            let mut copy = Vec::with_capacity(own.capacity());
            copy.extend_from_slice(own);
            copy
        }
        Self {
            neighbors: roomy(&self.neighbors),
            segments: roomy(&self.segments),
            starts: roomy(&self.starts),
        }
    }
}

impl ChunkList {
    /// The segments of a cluster.
    #[inline]
    pub(crate) fn segments_of(&self, cluster: usize) -> &[Segment] {
        &self.segments[self.starts[cluster] as usize..self.starts[cluster + 1] as usize]
    }

    /// The neighbours of a segment, and how many of them, first, need not be looked at.
    #[inline]
    pub(crate) fn listed(&self, segment: &Segment) -> (&[u32], usize) {
        (
            &self.neighbors[segment.start as usize..segment.end as usize],
            (segment.near_end - segment.start) as usize,
        )
    }

    /// Ends a run of neighbours of the last cluster, unless it is empty.
    fn close(&mut self, start: usize, near_end: usize, block: usize, order: Order) {
        let end = self.neighbors.len();
        if end > start {
            self.segments.push(Segment {
                start: start as u32,
                near_end: near_end as u32,
                end: end as u32,
                block: block as u32,
                order,
            });
        }
    }
}

/// The neighbour lists of all clusters of a group; on ranks those of some chunks, and the others are empty.
#[derive(Clone, Debug, Default)]
pub struct ClusterLists {
    pub(super) chunks: Vec<ChunkList>,
    /// Entries of each cluster of all chunks.
    pub(super) counts: Vec<u32>,
}

/// What the search needs to know.
#[derive(Clone, Copy, Debug)]
pub struct SearchInput<'a, T, const D: usize> {
    /// Positions of all slots, then of all images.
    pub positions: &'a [[T; D]],
    /// Support radius of each; a pair is listed if its distance is below the mean of the two radii
    /// plus the skin (the larger of the two radii with `widest`).
    pub radii: Radii<'a, T>,
    /// Bodies, then boundaries with images, ascending and without overlap.
    pub blocks: &'a [Block],
    /// Whether members of block `a` list those of block `b`, at `a * blocks.len() + b`; all do if empty.
    pub listed: &'a [bool],
    /// Slots per cluster.
    pub width: usize,
    /// Slots that own a list (images do not).
    pub slots: usize,
    /// Added to the radius so that the lists stay valid while particles move.
    pub skin: f64,
    /// What the search runs on, which this machine must have; lists are the same on all.
    pub instructions: InstructionSet,
}

impl<T, const D: usize> SearchInput<'_, T, D> {
    /// Whether members of block `own` list those of block `other`.
    pub(super) fn lists(&self, own: usize, other: usize) -> bool {
        let at = own * self.blocks.len() + other;
        self.listed.get(at).is_none_or(|&listed| listed)
    }
}

/// Support radii of the particles.
#[derive(Clone, Copy, Debug)]
pub enum Radii<'a, T> {
    /// All equal.
    Uniform(f64),
    /// One a slot, times the factor.
    Varying(&'a [T], f64),
}

impl<T: Real> Radii<'_, T> {
    #[inline(always)]
    pub(super) fn of(&self, k: usize) -> f64 {
        match self {
            Radii::Uniform(radius) => *radius,
            Radii::Varying(h, factor) => h[k].to_f64() * factor,
        }
    }
}

impl ClusterLists {
    /// The lists by chunk.
    #[must_use]
    pub fn chunks(&self) -> &[ChunkList] {
        &self.chunks
    }

    /// Number of list entries.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.counts.iter().map(|&own| own as usize).sum()
    }

    /// Number of list entries of the clusters that hold these slots, `width` slots a cluster.
    #[must_use]
    pub fn entries_of(&self, slots: Range<usize>, width: usize) -> usize {
        let end = slots.end.div_ceil(width).min(self.counts.len());
        let own = &self.counts[(slots.start / width).min(end)..end];
        own.iter().map(|&own| own as usize).sum()
    }

    /// Bytes held by the lists.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let of = |c: &ChunkList| {
            4 * (c.neighbors.capacity() + c.starts.capacity())
                + size_of::<Segment>() * c.segments.capacity()
        };
        self.chunks.iter().map(of).sum()
    }

    /// Finds the neighbours of every cluster.
    pub fn rebuild<T: Real, const D: usize>(&mut self, input: &SearchInput<'_, T, D>) {
        let chunks = (input.slots / input.width).div_ceil(CHUNK);
        self.rebuild_some(input, core::slice::from_ref(&(0..chunks)));
    }

    /// Finds the neighbours of the clusters of some runs of chunks, where blocks may have other particles elsewhere.
    pub(super) fn rebuild_among<T: Real, const D: usize>(
        &mut self,
        input: &SearchInput<'_, T, D>,
        local: &[LocalBlock<D>],
        runs: &[Range<usize>],
    ) {
        let instructions = input.instructions.or_detected();
        // Blocks at once: liquid by one thread and walls by another.
        let source = |block: usize| Source::of_block(input, block, local.get(block));
        let sources = collect(input.blocks.len(), source);
        let clusters = input.slots / input.width;
        self.chunks
            .resize_with(clusters.div_ceil(CHUNK), ChunkList::default);
        self.counts.resize(clusters, 0);
        // So few that threads share them evenly, and so many that scratch memory is not asked for with each.
        const AT_ONCE: usize = 4;
        for own in runs {
            for_each(
                cut(&mut self.chunks[own.clone()], AT_ONCE),
                |piece, chunks| {
                    let mut scratch = Scratch::default();
                    for (n, chunk) in chunks.iter_mut().enumerate() {
                        let c = own.start + piece * AT_ONCE + n;
                        chunk.neighbors.clear();
                        chunk.segments.clear();
                        chunk.starts.clear();
                        for cluster in c * CHUNK..clusters.min((c + 1) * CHUNK) {
                            chunk.starts.push(chunk.segments.len() as u32);
                            let members = cluster * input.width..(cluster + 1) * input.width;
                            let block = input
                                .blocks
                                .partition_point(|b| b.slots.end <= members.start);
                            // Slots that no particle owns any more have no neighbours.
                            let owned = input
                                .blocks
                                .get(block)
                                .is_some_and(|b| b.slots.contains(&members.start));
                            if owned {
                                search(
                                    input,
                                    &sources,
                                    block,
                                    members,
                                    instructions,
                                    &mut scratch,
                                    chunk,
                                );
                            }
                        }
                        chunk.starts.push(chunk.segments.len() as u32);
                        // Vectors double where they grow.
                        let length = chunk.neighbors.len();
                        chunk.neighbors.shrink_to(length + length / 16);
                    }
                },
            );
            self.count(own.clone());
        }
    }
}

/// What a thread's searches use again.
#[derive(Default)]
struct Scratch<T, const D: usize> {
    candidates: Candidates<T, D>,
    /// Neighbours that may leave the support before the lists are built again.
    leaving: Vec<u32>,
    /// What was found, by its order in the chunk: neighbours that stay, and those that may leave. Lists may be longer than
    /// what is in them.
    sorted: [[Vec<u32>; ORDERS.len()]; 2],
}

/// In this order a cluster meets its neighbours.
const ORDERS: [Order; 3] = [Order::Apart, Order::Later, Order::Earlier];

/// Lists every point within reach of any member, block after block: first those that stay in the support.
fn search<T: Real, const D: usize>(
    input: &SearchInput<'_, T, D>,
    sources: &[Vec<Source<T, D>>],
    block: usize,
    members: Range<usize>,
    instructions: InstructionSet,
    scratch: &mut Scratch<T, D>,
    chunk: &mut ChunkList,
) {
    let Scratch {
        candidates,
        leaving,
        sorted,
    } = scratch;
    let row = &input.positions[members.clone()];
    let (mut low, mut high) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    for x in row {
        for d in 0..D {
            low[d] = low[d].min(x[d].to_f64());
            high[d] = high[d].max(x[d].to_f64());
        }
    }
    let radius = members
        .clone()
        .fold(0.0_f64, |m, k| m.max(input.radii.of(k)));
    for (other, parts) in sources.iter().enumerate() {
        if !input.lists(block, other) {
            continue;
        }
        let start = chunk.neighbors.len();
        leaving.clear();
        for source in parts {
            // A pair acts within the mean of the two supports (or, where each side uses its own smoothing
            // length, within the larger): the larger covers both.
            let reach = radius.max(source.largest) + input.skin;
            candidates.choose(source, low, high, reach);
            instructions.run(Sieve {
                input,
                row,
                radius,
                reach,
                source,
                candidates,
                found: &mut chunk.neighbors,
                leaving,
            });
        }
        if D == 1 || other != block {
            let near_end = chunk.neighbors.len();
            chunk.neighbors.extend_from_slice(leaving);
            chunk.close(start, near_end, other, Order::Apart);
            continue;
        }
        let chunk_slots = CHUNK * input.width;
        let first = members.start / chunk_slots * chunk_slots;
        // What is not of this chunk may be numbered behind the last of it.
        let last = (first + chunk_slots).min(input.slots);
        let orders = [first, members.start, members.end, last].map(|slot| slot as u32);
        let [staying, may_leave] = sorted;
        let staying_counts = sort(&chunk.neighbors[start..], orders, staying);
        let leaving_counts = sort(leaving, orders, may_leave);
        chunk.neighbors.truncate(start);
        for (k, order) in ORDERS.into_iter().enumerate() {
            let start = chunk.neighbors.len();
            chunk
                .neighbors
                .extend_from_slice(&staying[k][..staying_counts[k]]);
            let near_end = chunk.neighbors.len();
            chunk
                .neighbors
                .extend_from_slice(&may_leave[k][..leaving_counts[k]]);
            chunk.close(start, near_end, other, order);
        }
    }
}

/// Sorts neighbours by their order in a chunk: `first` and `last` are the slots that it starts and ends with, `own` and `end`
/// those of the cluster. How many there are of each.
fn sort(
    found: &[u32],
    [first, own, end, last]: [u32; 4],
    sorted: &mut [Vec<u32>; ORDERS.len()],
) -> [usize; ORDERS.len()] {
    let count = found.len();
    for list in sorted.iter_mut() {
        if list.len() < count {
            list.resize(count, 0);
        }
    }
    let [apart, later, earlier] = sorted.each_mut().map(|list| &mut list[..count]);
    // Each is put down in all lists and counted in one, by counters in registers: nothing predicts which it will be, and a
    // branch or a counter in memory is waited for.
    let (mut a, mut b, mut c) = (0, 0, 0);
    for &j in found {
        let is_later = usize::from(j >= end && j < last);
        let is_earlier = usize::from(j >= first && j < own);
        apart[a] = j;
        later[b] = j;
        earlier[c] = j;
        a += 1 - is_later - is_earlier;
        b += is_later;
        c += is_earlier;
    }
    [a, b, c]
}

#[cfg(test)]
mod tests {
    use super::super::sieve::{NARROWER, PARTS};
    use super::*;
    use crate::scalar::Lane;

    fn supports_of_many_sizes_miss_none<T: Real>() {
        let width = <T::Wide<false> as Lane>::WIDTH;
        let positions: Vec<[T; 2]> = (0..800)
            .map(|k| {
                let k = f64::from(k);
                [(k * 0.618).fract(), (k * 0.414).fract()].map(T::from_f64)
            })
            .collect();
        // Supports from 0.02 to 0.4, few of them large.
        let radii: Vec<T> = (0..800)
            .map(|k| 0.02 * 20.0_f64.powf((f64::from(k) * 0.271).fract().powi(8)))
            .map(T::from_f64)
            .collect();
        let blocks = [Block {
            slots: 0..800,
            wall: false,
        }];
        let input = SearchInput {
            positions: &positions,
            radii: Radii::Varying(&radii, 1.0),
            blocks: &blocks,
            listed: &[],
            width,
            slots: 800,
            skin: 0.01,
            instructions: InstructionSet::detect(),
        };
        let parts = Source::of_block(&input, 0, None);
        assert_eq!(parts.len(), PARTS);
        assert!(
            parts
                .windows(2)
                .all(|p| p[1].largest < NARROWER * p[0].largest)
        );
        let mut lists = ClusterLists::default();
        lists.rebuild(&input);
        let (mut found, mut missing) = (0, 0);
        for (c, chunk) in lists.chunks().iter().enumerate() {
            for (k, bounds) in chunk.starts.windows(2).enumerate() {
                let segments = &chunk.segments[bounds[0] as usize..bounds[1] as usize];
                let runs = segments.iter().map(|s| s.start as usize..s.end as usize);
                let listed: Vec<u32> = runs
                    .flat_map(|run| &chunk.neighbors[run])
                    .copied()
                    .collect();
                for i in (c * CHUNK + k) * width..(c * CHUNK + k + 1) * width {
                    for (j, y) in positions.iter().enumerate() {
                        let [own, y] = [&positions[i], y].map(|x| x.map(Real::to_f64));
                        let apart = (own[0] - y[0]).hypot(own[1] - y[1]);
                        if apart < radii[i].to_f64().max(radii[j].to_f64()) + 0.01 {
                            found += 1;
                            missing += usize::from(!listed.contains(&(j as u32)));
                        }
                    }
                }
            }
        }
        assert!(found > 10_000 && missing == 0, "{missing} of {found}");
    }

    #[test]
    fn supports_of_many_sizes_miss_no_neighbour_and_search_less() {
        supports_of_many_sizes_miss_none::<f64>();
        supports_of_many_sizes_miss_none::<f32>();
    }

    #[test]
    fn neighbours_that_stay_in_the_support_come_first() {
        let positions: Vec<[f64; 2]> = (0..400)
            .map(|k| {
                let k = f64::from(k);
                [(k * 0.618).fract(), (k * 0.414).fract()]
            })
            .collect();
        let (radius, skin) = (0.12, 0.03);
        let mut lists = ClusterLists::default();
        lists.rebuild(&SearchInput {
            positions: &positions,
            radii: Radii::Uniform(radius),
            blocks: &[Block {
                slots: 0..400,
                wall: false,
            }],
            listed: &[],
            width: 8,
            slots: 400,
            skin,
            instructions: InstructionSet::detect(),
        });
        let (mut near, mut far) = (0, 0);
        for (c, chunk) in lists.chunks().iter().enumerate() {
            for (k, bounds) in chunk.starts.windows(2).enumerate() {
                let first = (c * CHUNK + k) * 8;
                for segment in &chunk.segments[bounds[0] as usize..bounds[1] as usize] {
                    for entry in segment.start..segment.end {
                        let x = positions[chunk.neighbors[entry as usize] as usize];
                        let least = positions[first..first + 8]
                            .iter()
                            .map(|y| (x[0] - y[0]).hypot(x[1] - y[1]))
                            .fold(f64::INFINITY, f64::min);
                        assert_eq!(entry < segment.near_end, least < radius - skin);
                        assert!(least < radius + skin);
                        near += usize::from(entry < segment.near_end);
                        far += usize::from(entry >= segment.near_end);
                    }
                }
            }
        }
        assert!(near > 0 && far > 0);
    }
}
