//! Cluster lists with a skin: the neighbours of rows of consecutive particles.
//! A row of W particles shares one list, so the pair loop broadcasts each neighbour to full lanes.

use super::cells::Cells;
use crate::scalar::Real;
use rayon::prelude::*;
use std::ops::Range;

/// Clusters that one thread takes at a time; fixed, so sums never depend on the number of threads.
pub const CHUNK: usize = 32;

/// A run of slots that belongs to one body, or a run of images behind one boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The slots of the block's particles; starts at a whole number of clusters.
    pub slots: Range<usize>,
    /// Whether it is a wall, whose particles do not move by forces.
    pub wall: bool,
}

/// A run of a cluster's neighbours that belong to one block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// First entry in the chunk's list.
    pub start: u32,
    /// One past the last entry.
    pub end: u32,
    /// The block that the neighbours belong to.
    pub block: u32,
}

/// The neighbour lists of [`CHUNK`] clusters.
#[derive(Clone, Debug, Default)]
pub struct ChunkList {
    /// Slots of neighbours, cluster after cluster, ascending inside a cluster.
    pub neighbors: Vec<u32>,
    /// Segments, cluster after cluster.
    pub segments: Vec<Segment>,
    /// Where each cluster's segments start, and the end of the last.
    pub starts: Vec<u32>,
}

/// The neighbour lists of all clusters of a group.
#[derive(Clone, Debug, Default)]
pub struct ClusterLists {
    chunks: Vec<ChunkList>,
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
    fn of(&self, k: usize) -> f64 {
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
        self.chunks.iter().map(|chunk| chunk.neighbors.len()).sum()
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
        let points: Vec<u32> = input
            .blocks
            .iter()
            .flat_map(|b| b.slots.start as u32..b.slots.end as u32)
            .collect();
        let largest = match input.radii {
            Radii::Uniform(radius) => radius,
            Radii::Varying(..) => points
                .iter()
                .fold(0.0_f64, |m, &p| m.max(input.radii.of(p as usize))),
        };
        let reach = largest + input.skin;
        // Cells of half the reach fit the boxes of clusters better than cells of the full reach.
        let cells = Cells::build(
            input.positions,
            &points,
            if D == 1 { reach } else { 0.5 * reach },
        );
        let clusters = input.slots / input.width;
        self.chunks
            .resize_with(clusters.div_ceil(CHUNK), ChunkList::default);
        self.chunks
            .par_iter_mut()
            .enumerate()
            .for_each_init(Vec::new, |found, (c, chunk)| {
                chunk.neighbors.clear();
                chunk.segments.clear();
                chunk.starts.clear();
                for cluster in c * CHUNK..clusters.min((c + 1) * CHUNK) {
                    chunk.starts.push(chunk.segments.len() as u32);
                    found.clear();
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
                        search(input, &cells, members, largest, found);
                        found.sort_unstable();
                        append(input, block, found, chunk);
                    }
                }
                chunk.starts.push(chunk.segments.len() as u32);
            });
    }
}

/// Collects every point within reach of any member.
fn search<T: Real, const D: usize>(
    input: &SearchInput<'_, T, D>,
    cells: &Cells<D>,
    members: Range<usize>,
    largest: f64,
    found: &mut Vec<u32>,
) {
    let rows = &input.positions[members.clone()];
    let (mut low, mut high) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    for x in rows {
        for d in 0..D {
            low[d] = low[d].min(x[d].to_f64());
            high[d] = high[d].max(x[d].to_f64());
        }
    }
    let own = members
        .clone()
        .fold(0.0_f64, |m, k| m.max(input.radii.of(k)));
    let uniform = matches!(input.radii, Radii::Uniform(_));
    // A pair acts within the mean of the two supports (or, where each side uses its own smoothing
    // length, within the larger): the larger covers both.
    let reach = own.max(largest) + input.skin;
    let box_low = core::array::from_fn(|d| low[d] - reach);
    let box_high = core::array::from_fn(|d| high[d] + reach);
    cells.for_each_run(box_low, box_high, |run| {
        for &j in run {
            let xj = input.positions[j as usize].map(Real::to_f64);
            let reach = if uniform {
                reach
            } else {
                own.max(input.radii.of(j as usize)) + input.skin
            };
            let reach = reach * reach;
            let outside: f64 = (0..D)
                .map(|d| (low[d] - xj[d]).max(xj[d] - high[d]).max(0.0))
                .map(|gap| gap * gap)
                .sum();
            if outside > reach {
                continue;
            }
            let near = rows.iter().any(|x| {
                let r2: f64 = (0..D).map(|d| (x[d].to_f64() - xj[d]).powi(2)).sum();
                r2 <= reach
            });
            if near {
                found.push(j);
            }
        }
    });
}

fn append<T, const D: usize>(
    input: &SearchInput<'_, T, D>,
    own: usize,
    found: &[u32],
    chunk: &mut ChunkList,
) {
    let blocks = input.blocks;
    let listed = |other: usize| {
        let at = own * blocks.len() + other;
        input.listed.get(at).is_none_or(|&listed| listed)
    };
    let mut rest = found;
    while let Some(&first) = rest.first() {
        let block = blocks.partition_point(|b| b.slots.end <= first as usize);
        let end = blocks.get(block).map_or(usize::MAX, |b| b.slots.end);
        let (here, others) = rest.split_at(rest.partition_point(|&j| (j as usize) < end));
        if listed(block) {
            let start = chunk.neighbors.len() as u32;
            chunk.neighbors.extend_from_slice(here);
            chunk.segments.push(Segment {
                start,
                end: chunk.neighbors.len() as u32,
                block: block as u32,
            });
        }
        rest = others;
    }
}
