//! One chunk of rows against its lists of neighbours, compiled for each way it can run.
//! It allocates nothing, and sums in an order that no number of threads changes.

mod meetings;
mod pairs;
mod shown;

use super::records::Image;
use super::results::Reaction;
use super::{InstructionSet, Interaction, SmoothingMode};
use crate::kernel::Kernel;
use crate::neighbors::{Block, CHUNK, ChunkList};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, MOST_LANES, Mask, Real};
#[cfg(target_arch = "x86_64")]
use crate::scalar::{OnAvx2, OnAvx512};
use crate::term::{Layout, MOST_READS, Sums, Terms};
use core::marker::PhantomData;
use meetings::{Meeting, Meetings, block_of};
#[cfg(feature = "devices")]
pub(super) use pairs::apply;
pub(super) use shown::Shown;
use std::ops::Range;

/// Ways of running: bits of [`SmoothingMode`].
pub(super) const MEAN: u8 = SmoothingMode::Mean.bit();
pub(super) const OWN: u8 = SmoothingMode::Own.bit();

/// The layout of a sweep: what its terms name, and what the way of running adds.
pub(super) struct Composed<T, P, const D: usize, const HOW: u8>(PhantomData<(T, P)>);

impl<T: Real, P: Terms<D>, const D: usize, const HOW: u8> Layout for Composed<T, P, D, HOW> {
    const READS: Fields = reads::<T, P, D>(HOW);
    const WRITES: Outputs = P::WRITES;
    const ONE_GRADIENT: bool = HOW & OWN == 0;
}

pub(super) const fn reads<T: Real, P: Terms<D>, const D: usize>(how: u8) -> Fields {
    let mut fields = P::READS.union(Fields::of(&[Field::POSITION]));
    if !T::COMPENSATED {
        fields = fields.without(Field::POSITION_RESIDUAL);
    }
    if how & (MEAN | OWN) != 0 {
        fields = fields.union(Fields::of(&[Field::SMOOTHING_LENGTH]));
    }
    fields
}

/// Everything that the loop over one chunk reads.
pub(super) struct Task<'a, T, K, P, const D: usize> {
    pub kernel: &'a K,
    pub terms: &'a P,
    pub records: &'a [T],
    pub blocks: &'a [Block],
    pub interactions: &'a [Interaction],
    /// Which slots are active in a contact; empty without contacts.
    pub contact_activity: &'a [T],
    pub images: &'a [Image],
    pub targets: &'a Range<usize>,
    pub body_force: [T; D],
    pub lattice_consistency_factor: T,
    /// Whether roots are the machine's.
    pub by_divider: bool,
    pub h: T,
    /// Square of the distance beyond which nothing acts where there is one smoothing length.
    pub reach2: T,
    pub kernel_norm: T,
}

/// What the square of the support is multiplied with before pairs are left out, so that rounding
/// (of `f32` positions without their residuals, too) leaves out none that acts.
pub(super) const BEYOND: f64 = 1.001;

/// A row of particles, as it meets one segment of its neighbours.
#[derive(Clone, Copy)]
struct Row<'a, L> {
    /// Its first slot.
    first: usize,
    /// What the terms read of it.
    own: &'a [L; MOST_READS],
    /// Whether the segment lies across a contact that may open.
    contact: bool,
    /// One where the row, and where the segment, moves by forces; zero where it belongs to a wall.
    mobile: [L; 2],
    /// Whether pairs are summed for both sides.
    both: bool,
    /// The first slot of the chunk.
    chunk_first: usize,
}

/// Most numbers of a particle that are summed for both sides of a pair at once: a force in space and a maximum.
const MOST_FOR_BOTH: usize = 4;

/// Whether a sweep sums a pair of particles of one chunk for both of them when it meets it the first time.
///
/// It is a second loop, with the terms twice in it, so it is compiled for the sweeps that gain most and have most to do: those
/// of liquids, with one smoothing length, on wide instructions. In one dimension there is little to gain.
pub(super) const fn summed_for_both<C: Layout, L: Lane, const D: usize>() -> bool {
    D > 1
        && L::FUSED
        && C::WRITES.width(D) > 0
        && C::WRITES.width(D) <= MOST_FOR_BOTH
        && !C::WRITES.contains(Output::POWER)
        && !C::READS.contains(Field::SMOOTHING_LENGTH)
}

/// How many numbers the other sides of the pairs of a chunk take.
pub(super) const fn room_for_both<C: Layout, L: Lane, const D: usize>() -> usize {
    if summed_for_both::<C, L, D>() {
        CHUNK * L::WIDTH * L::WIDTH * C::WRITES.width(D)
    } else {
        0
    }
}

/// Neighbours that are looked through at once.
const BATCH: usize = 256;

impl<T: Real, K, P, const D: usize> Task<'_, T, K, P, D> {
    #[inline(always)]
    pub fn dispatch<const HOW: u8>(
        &self,
        instructions: InstructionSet,
        (chunk, list): (usize, &ChunkList),
        later: &mut [T],
        out: &mut [T],
        reactions: &mut Vec<Reaction<D>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        // A kernel chosen at run time branches in the loop: wider instructions are not worth a copy there. In one
        // dimension one copy serves both wide sets, since a row has a dozen neighbours and each copy takes time to compile.
        #[cfg(target_arch = "x86_64")]
        if const { !K::CHOSEN_AT_RUN_TIME } {
            // SAFETY: `go` passes only what `InstructionSet::or_detected` found on this machine.
            match instructions {
                InstructionSet::Avx512 if const { D > 1 } => unsafe {
                    return self.chunk_avx512::<HOW>(
                        self.kernel,
                        self.terms,
                        (chunk, list),
                        later,
                        out,
                        reactions,
                    );
                },
                InstructionSet::Avx2 | InstructionSet::Avx512
                    if const { InstructionSet::Avx2.compiled() || D == 1 } =>
                unsafe {
                    return self.chunk_avx2::<HOW>(
                        self.kernel,
                        self.terms,
                        (chunk, list),
                        later,
                        out,
                        reactions,
                    );
                },
                _ => {}
            }
            // A build for machines that have more leaves no loop behind.
            if const { !InstructionSet::Baseline.compiled() } {
                unreachable!(
                    "a build without loops of the baseline is for machines that have more"
                );
            }
        }
        let _ = instructions;
        self.chunk::<T::Wide<false>, HOW>((chunk, list), later, out, reactions);
    }

    // Kernel and terms come as arguments: what those point to nothing else changes, so constants of a term are read and
    // converted once, and not for every pair.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512vl,avx512dq,fma")]
    fn chunk_avx512<const HOW: u8>(
        &self,
        kernel: &K,
        terms: &P,
        (chunk, list): (usize, &ChunkList),
        later: &mut [T],
        out: &mut [T],
        reactions: &mut Vec<Reaction<D>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        let own = Task {
            kernel,
            terms,
            ..*self
        };
        own.chunk::<T::In<OnAvx512>, HOW>((chunk, list), later, out, reactions);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn chunk_avx2<const HOW: u8>(
        &self,
        kernel: &K,
        terms: &P,
        (chunk, list): (usize, &ChunkList),
        later: &mut [T],
        out: &mut [T],
        reactions: &mut Vec<Reaction<D>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        let own = Task {
            kernel,
            terms,
            ..*self
        };
        own.chunk::<T::In<OnAvx2>, HOW>((chunk, list), later, out, reactions);
    }

    /// All clusters of one chunk.
    #[inline(always)]
    fn chunk<L: Lane<Scalar = T, Broadcast = T>, const HOW: u8>(
        &self,
        (chunk, list): (usize, &ChunkList),
        later: &mut [T],
        out: &mut [T],
        reactions: &mut Vec<Reaction<D>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        let stride = const { Composed::<T, P, D, HOW>::READS.width(D) };
        let row_out = const { Composed::<T, P, D, HOW>::WRITES.width(D) } * L::WIDTH;
        let one_sided = const {
            P::WRITES.contains(Output::MOMENT_MATRIX) && !P::WRITES.contains(Output::COMPRESSION)
        };
        let forces = const { Composed::<T, P, D, HOW>::WRITES.contains(Output::FORCE) };
        // Made once a chunk: they have room for any terms, and clearing it for each row costs a twelfth of the time.
        let mut own = [L::zero(); MOST_READS];
        let mut sums = Sums::<L, D, Composed<T, P, D, HOW>>::new();
        let mut near = [0; BATCH];
        let first = chunk * CHUNK * L::WIDTH;
        let meetings = Meetings {
            blocks: self.blocks,
            interactions: self.interactions,
            targets: self.targets,
            inside: first..first + (list.starts.len() - 1) * L::WIDTH,
            for_both: const { summed_for_both::<Composed<T, P, D, HOW>, L, D>() },
            one_sided,
        };
        for c in 0..list.starts.len() - 1 {
            let first = first + c * L::WIDTH;
            if !self.targets.contains(&first) {
                continue;
            }
            let row = &mut out[c * row_out..(c + 1) * row_out];
            let Some(block) = block_of(self.blocks, first) else {
                // Slots that no particle owns any more feel nothing.
                row.fill(T::zero());
                continue;
            };
            read(self.records, first, stride, &mut own);
            sums.clear();
            for segment in list.segments_of(c) {
                let Some(Meeting { contact, both }) = meetings.of(block, segment) else {
                    continue;
                };
                let other = segment.block as usize;
                let foreign = forces && other != block;
                let before = if foreign {
                    sums.kept_force()
                } else {
                    [L::zero(); D]
                };
                let mut kept = L::zero();
                if contact {
                    Shown::across::<T, P, D, HOW, L>(&mut own);
                    kept = sums.take_kernel_sum();
                }
                let mobile = [
                    L::splat(mobility(&self.blocks[block])),
                    L::splat(mobility(&self.blocks[other])),
                ];
                let row = Row {
                    first,
                    own: &own,
                    contact,
                    mobile,
                    both,
                    chunk_first: meetings.inside.start,
                };
                self.segment::<L, HOW>(row, list.listed(segment), &mut near, later, &mut sums);
                if contact {
                    read(self.records, first, stride, &mut own);
                    sums.divert_kernel_sum(kept);
                }
                if foreign {
                    let members = self.blocks[block].slots.end.saturating_sub(first);
                    reactions.push(Reaction {
                        on: block as u32,
                        from: segment.block,
                        force: gained(members.min(L::WIDTH), &before, &sums.kept_force()),
                    });
                }
            }
            for (k, values) in row.chunks_exact_mut(L::WIDTH).enumerate() {
                sums.kept[k].store(values);
            }
        }
        if const { summed_for_both::<Composed<T, P, D, HOW>, L, D>() } {
            meetings.add_later::<T, L>(later, out, row_out, sums.raised);
        }
    }

    /// Those of some neighbours that are within the support of any of the row, in their order; returns
    /// how many there are. The first `staying` were so near when they were listed that they still are.
    ///
    /// What a skin lists and what a row of several particles lists for only one of them is mostly too
    /// far away, and finding that out costs less than the terms would.
    #[inline(always)]
    fn within_reach<L: Lane<Scalar = T, Broadcast = T>, const HOW: u8>(
        &self,
        own: &[L; MOST_READS],
        neighbors: &[u32],
        staying: usize,
        near: &mut [u32; BATCH],
    ) -> usize
    where
        P: Terms<D>,
    {
        let reads = const { &Composed::<T, P, D, HOW>::READS };
        let stride = const { Composed::<T, P, D, HOW>::READS.width(D) };
        let listed = if reads.contains(Field::REFERENCE_POSITION) {
            Field::REFERENCE_POSITION
        } else {
            Field::POSITION
        };
        let position = reads.offset(listed, D);
        let reach2 = L::splat(self.reach2);
        let (staying, leaving) = neighbors.split_at(staying);
        let mut count = staying.len();
        near[..count].copy_from_slice(staying);
        for &j in leaving {
            let record = &self.records[j as usize * stride..j as usize * stride + stride];
            let mut r2 = L::zero();
            for d in 0..D {
                let r = own[position + d] - L::splat(record[position + d]);
                r2 = r.mul_add(r, r2);
            }
            near[count % BATCH] = j;
            count += usize::from(r2.lt(reach2).any());
        }
        count
    }

    /// One cluster against the neighbours of one segment, as far as they are within reach, which the number
    /// of them that comes with the list need not be asked.
    #[inline(always)]
    fn segment<L: Lane<Scalar = T, Broadcast = T>, const HOW: u8>(
        &self,
        row: Row<'_, L>,
        (neighbors, staying): (&[u32], usize),
        near: &mut [u32; BATCH],
        later: &mut [T],
        sums: &mut Sums<L, D, Composed<T, P, D, HOW>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        // In one dimension a list has few entries too many, and with several smoothing lengths the
        // reach is not known before the pair is.
        if HOW & (MEAN | OWN) != 0 || D == 1 {
            self.of_sides::<L, HOW>(row, neighbors, later, sums);
            return;
        }
        for (k, batch) in neighbors.chunks(BATCH).enumerate() {
            let staying = staying.saturating_sub(k * BATCH).min(batch.len());
            let count = self.within_reach::<L, HOW>(row.own, batch, staying, near);
            self.of_sides::<L, HOW>(row, &near[..count], later, sums);
        }
    }

    /// Some neighbours for one side or for both. A loop for each: with a branch inside the compiler loses the rows.
    #[inline(always)]
    fn of_sides<L: Lane<Scalar = T, Broadcast = T>, const HOW: u8>(
        &self,
        row: Row<'_, L>,
        neighbors: &[u32],
        later: &mut [T],
        sums: &mut Sums<L, D, Composed<T, P, D, HOW>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        if const { summed_for_both::<Composed<T, P, D, HOW>, L, D>() } && row.both {
            self.pairs::<L, HOW, true>(row, neighbors, later, sums);
        } else {
            self.pairs::<L, HOW, false>(row, neighbors, later, sums);
        }
    }
}

/// Reads the records of a row.
///
/// Never inlined: what a call has written comes from memory a row at a time, while numbers that the compiler
/// follows one by one it may also compute one by one, without vector instructions.
#[inline(never)]
fn read<L: Lane>(records: &[L::Scalar], first: usize, stride: usize, own: &mut [L; MOST_READS]) {
    let rows = &records[first * stride..(first + L::WIDTH) * stride];
    let mut of: [&[L::Scalar]; MOST_LANES] = [&[]; MOST_LANES];
    for (of, row) in of.iter_mut().zip(rows.chunks_exact(stride)) {
        *of = row;
    }
    for (k, value) in own.iter_mut().enumerate().take(stride) {
        *value = L::from_fn(|lane| of[lane][k]);
    }
}

/// One where particles move by forces, zero where they belong to a wall.
#[inline(always)]
fn mobility<T: Real>(block: &Block) -> T {
    if block.wall { T::zero() } else { T::one() }
}

/// The force that the real particles of a row felt between two moments. Never inlined, as [`read`].
#[inline(never)]
fn gained<L: Lane, const D: usize>(members: usize, before: &[L; D], after: &[L; D]) -> [f64; D] {
    let mut force = [0.0; D];
    for d in 0..D {
        for lane in 0..members {
            force[d] += (after[d].extract(lane) - before[d].extract(lane)).to_f64();
        }
    }
    force
}
