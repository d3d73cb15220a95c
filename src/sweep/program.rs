//! A kernel and a tuple of terms, compiled into one loop for each way it can run.
//! Behind [`PairSweep`] it is an object that is called a handful of times a step.

use super::records::{Image, Records, Transform};
use super::rows::{Reaction, Rows};
use super::{InstructionSet, Interaction, SmoothingMode};
use crate::kernel::Kernel;
use crate::neighbors::{Block, CHUNK, ChunkList, ClusterLists, Segment};
use crate::particles::{Columns, Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Mask, Real};
use crate::term::{Along, Layout, MOST_READS, MOST_SUMS, Pair, Sums, TermDoc, Terms};
use core::fmt::Debug;
use core::marker::PhantomData;
use rayon::prelude::*;
use std::ops::Range;

/// What a sweep is run for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// The sums that the terms write.
    Rates,
    /// The work of all pair forces with the mean velocity of a kick (Owen 2014).
    Work,
}

/// What a sweep works on.
#[derive(Debug)]
pub struct SweepInput<'a, T, const D: usize> {
    /// Particle data.
    pub columns: &'a Columns<T, D>,
    /// Images of particles behind boundaries.
    pub images: &'a [Image],
    /// The transforms that make them.
    pub transforms: &'a [Transform<T, D>],
    /// Neighbour lists.
    pub lists: &'a ClusterLists,
    /// Bodies, then boundaries.
    pub blocks: &'a [Block],
    /// What block `a` and block `b` do to each other, at `a * blocks.len() + b`.
    pub interactions: &'a [Interaction],
    /// The smoothing length where it is the same for all \[m\].
    pub smoothing_length: f64,
    /// The slots whose sums are wanted; others are left as they were.
    pub targets: Range<usize>,
    /// The acceleration that acts on all particles \[m/s²\], in the frame of their container.
    pub body_force: [T; D],
    /// First moment of the kernel gradient on the lattice, by which sums of gradients are divided.
    pub lattice_moment: f64,
    /// The instruction set to run on.
    pub instructions: InstructionSet,
}

/// A sweep over pairs, whatever its kernel and terms.
pub trait PairSweep<T: Real, const D: usize>: Debug + Send + Sync {
    /// Fields that the particles must carry.
    fn fields(&self) -> Fields;
    /// Sums that it makes in a [`Pass::Rates`].
    fn outputs(&self) -> Outputs;
    /// Its terms, for people.
    fn document(&self) -> Vec<TermDoc>;
    /// Packs what a pass reads. `records` keeps its memory between calls.
    fn pack(&self, pass: Pass, input: &SweepInput<'_, T, D>, records: &mut Records<T>);
    /// Renews the mean velocities in records packed for [`Pass::Work`].
    fn renew_mean_velocity(&self, input: &SweepInput<'_, T, D>, records: &mut Records<T>);
    /// Runs the loop over packed records. `rows` keeps its memory between calls.
    fn run(
        &self,
        pass: Pass,
        input: &SweepInput<'_, T, D>,
        records: &Records<T>,
        rows: &mut Rows<T, D>,
    );
}

/// A kernel and the terms that share a sweep.
///
/// `MODES` says which [`SmoothingMode`]s the loop is compiled for, as a union of their bits; all if
/// not given.
#[derive(Clone, Debug)]
pub struct Program<K, P, const MODES: u8 = { SmoothingMode::ALL }> {
    kernel: K,
    terms: P,
    mode: SmoothingMode,
}

impl<K, P, const MODES: u8> Program<K, P, MODES> {
    /// The program of `terms` under `kernel`. `mode` must be one that the loop is compiled for.
    #[must_use]
    pub fn new(kernel: K, terms: P, mode: SmoothingMode) -> Self {
        debug_assert!(MODES & mode.bit() != 0);
        Self {
            kernel,
            terms,
            mode,
        }
    }
}

const UNIFORM: u8 = 0;
const MEAN: u8 = 1;
const OWN: u8 = 2;
const WORK: u8 = 4;

/// The layout of a sweep: what its terms name, and what the way of running adds.
struct Composed<T, P, const D: usize, const HOW: u8>(PhantomData<(T, P)>);

impl<T: Real, P: Terms<D>, const D: usize, const HOW: u8> Layout for Composed<T, P, D, HOW> {
    const READS: Fields = reads::<T, P, D>(HOW);
    const WRITES: Outputs = if HOW & WORK == 0 {
        P::WRITES
    } else {
        Outputs::of(&[Output::Power])
    };
}

const fn reads<T: Real, P: Terms<D>, const D: usize>(how: u8) -> Fields {
    let mut fields = P::READS.union(Fields::of(&[Field::Position]));
    if !T::COMPENSATED {
        fields = fields.without(Field::PositionResidual);
    }
    if how & (MEAN | OWN) != 0 {
        fields = fields.union(Fields::of(&[Field::SmoothingLength]));
    }
    if how & WORK != 0 {
        fields = fields.union(Fields::of(&[Field::MeanVelocity]));
    }
    fields
}

impl<T: Real, const D: usize, K: Kernel<D>, P: Terms<D>, const MODES: u8> PairSweep<T, D>
    for Program<K, P, MODES>
{
    fn fields(&self) -> Fields {
        reads::<T, P, D>(if self.mode == SmoothingMode::Uniform {
            UNIFORM
        } else {
            MEAN
        })
    }

    fn outputs(&self) -> Outputs {
        P::WRITES
    }

    fn document(&self) -> Vec<TermDoc> {
        self.terms.document()
    }

    fn pack(&self, pass: Pass, input: &SweepInput<'_, T, D>, records: &mut Records<T>) {
        let layout = self.layout::<T, D>(pass);
        records.pack(layout, input.columns, input.images, input.transforms);
    }

    fn renew_mean_velocity(&self, input: &SweepInput<'_, T, D>, records: &mut Records<T>) {
        records.renew_velocity(
            Field::MeanVelocity,
            self.layout::<T, D>(Pass::Work),
            input.columns,
            input.images,
            input.transforms,
        );
    }

    fn run(
        &self,
        pass: Pass,
        input: &SweepInput<'_, T, D>,
        records: &Records<T>,
        rows: &mut Rows<T, D>,
    ) {
        // A mode that the program is not compiled for leaves no loop behind.
        match self.mode {
            SmoothingMode::Uniform => {
                if const { MODES & SmoothingMode::Uniform.bit() != 0 } {
                    self.pass::<T, D, UNIFORM, { UNIFORM | WORK }>(pass, input, records, rows);
                }
            }
            SmoothingMode::Mean => {
                if const { MODES & SmoothingMode::Mean.bit() != 0 } {
                    self.pass::<T, D, MEAN, { MEAN | WORK }>(pass, input, records, rows);
                }
            }
            SmoothingMode::Own => {
                if const { MODES & SmoothingMode::Own.bit() != 0 } {
                    self.pass::<T, D, OWN, { OWN | WORK }>(pass, input, records, rows);
                }
            }
        }
    }
}

impl<K, P, const MODES: u8> Program<K, P, MODES> {
    fn layout<T: Real, const D: usize>(&self, pass: Pass) -> Fields
    where
        P: Terms<D>,
    {
        let work = if pass == Pass::Work { WORK } else { 0 };
        let mode = if self.mode == SmoothingMode::Uniform {
            UNIFORM
        } else {
            MEAN
        };
        reads::<T, P, D>(mode | work)
    }

    fn pass<T: Real, const D: usize, const RATES: u8, const WORKS: u8>(
        &self,
        pass: Pass,
        input: &SweepInput<'_, T, D>,
        records: &Records<T>,
        rows: &mut Rows<T, D>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        match pass {
            Pass::Rates => self.go::<T, D, RATES>(input, records, rows),
            // Work is only ever asked of sweeps that carry energy.
            Pass::Work => {
                if const { P::WRITES.contains(Output::Power) } {
                    self.go::<T, D, WORKS>(input, records, rows);
                }
            }
        }
    }

    fn go<T: Real, const D: usize, const HOW: u8>(
        &self,
        input: &SweepInput<'_, T, D>,
        records: &Records<T>,
        rows: &mut Rows<T, D>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        let width = <T::Wide<false> as Lane>::WIDTH;
        rows.lay_out(Composed::<T, P, D, HOW>::WRITES);
        let row = rows.outputs.width(D) * width;
        // Only chunks with wanted slots have rows.
        let slots = CHUNK * width;
        let skipped = input.targets.start / slots;
        rows.first = skipped * slots;
        let wanted = input.targets.end.saturating_sub(rows.first);
        let length = row * wanted.div_ceil(width);
        // Sweeps take turns on the same rows: only growth costs.
        if rows.data.len() < length {
            rows.data.resize(length, T::zero());
        }
        rows.reactions
            .resize_with(input.lists.chunks().len(), Vec::new);
        let h = T::from_f64(input.smoothing_length);
        let instructions = input.instructions.or_baseline();
        let task = Task {
            kernel: &self.kernel,
            terms: &self.terms,
            records: records.data(),
            blocks: input.blocks,
            interactions: input.interactions,
            touching: input.columns.raw(Field::Touching),
            images: input.images,
            targets: &input.targets,
            body_force: input.body_force,
            lattice_moment: T::from_f64(input.lattice_moment),
            h,
            reach2: T::from_f64((self.kernel.support() * input.smoothing_length).powi(2) * BEYOND),
            kernel_norm: T::from_f64(self.kernel.normalisation()),
        };
        rows.reactions.iter_mut().for_each(Vec::clear);
        rows.data[..length]
            .par_chunks_mut((row * CHUNK).max(1))
            .zip(rows.reactions[skipped..].par_iter_mut())
            .zip(input.lists.chunks()[skipped..].par_iter())
            .enumerate()
            .for_each(|(chunk, ((out, reactions), list))| {
                task.dispatch::<HOW>(instructions, skipped + chunk, list, out, reactions);
            });
    }
}

/// Everything that the loop over one chunk reads.
struct Task<'a, T, K, P, const D: usize> {
    kernel: &'a K,
    terms: &'a P,
    records: &'a [T],
    blocks: &'a [Block],
    interactions: &'a [Interaction],
    /// Which slots touch the other side of a contact; empty without contacts.
    touching: &'a [T],
    images: &'a [Image],
    targets: &'a Range<usize>,
    body_force: [T; D],
    lattice_moment: T,
    h: T,
    /// Square of the distance beyond which nothing acts where there is one smoothing length.
    reach2: T,
    kernel_norm: T,
}

/// What the square of the support is multiplied with before pairs are left out, so that rounding
/// (of `f32` positions without their residuals, too) leaves out none that acts.
const BEYOND: f64 = 1.001;

/// Neighbours that are looked through at once.
const BATCH: usize = 256;

impl<T: Real, K, P, const D: usize> Task<'_, T, K, P, D> {
    #[inline(always)]
    fn dispatch<const HOW: u8>(
        &self,
        instructions: InstructionSet,
        chunk: usize,
        list: &ChunkList,
        out: &mut [T],
        reactions: &mut Vec<Reaction<D>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        // In one dimension a row has a dozen neighbours, and a kernel chosen at run time branches in
        // the loop: wider instructions are not worth a copy there.
        #[cfg(target_arch = "x86_64")]
        if const { D > 1 && !K::CHOSEN_AT_RUN_TIME } {
            // SAFETY: `go` passes only what `InstructionSet::or_baseline` found on this machine.
            match instructions {
                InstructionSet::Avx512 => unsafe {
                    return self.chunk_avx512::<HOW>(chunk, list, out, reactions);
                },
                InstructionSet::Avx2 => unsafe {
                    return self.chunk_avx2::<HOW>(chunk, list, out, reactions);
                },
                InstructionSet::Baseline => {}
            }
        }
        let _ = instructions;
        self.chunk::<T::Wide<false>, HOW>(chunk, list, out, reactions);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512vl,avx512dq,fma")]
    fn chunk_avx512<const HOW: u8>(
        &self,
        chunk: usize,
        list: &ChunkList,
        out: &mut [T],
        reactions: &mut Vec<Reaction<D>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        self.chunk::<T::Wide<true>, HOW>(chunk, list, out, reactions);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn chunk_avx2<const HOW: u8>(
        &self,
        chunk: usize,
        list: &ChunkList,
        out: &mut [T],
        reactions: &mut Vec<Reaction<D>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        self.chunk::<T::Wide<true>, HOW>(chunk, list, out, reactions);
    }

    /// All clusters of one chunk.
    #[inline(always)]
    fn chunk<L: Lane<Scalar = T>, const HOW: u8>(
        &self,
        chunk: usize,
        list: &ChunkList,
        out: &mut [T],
        reactions: &mut Vec<Reaction<D>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        let reads = const { Composed::<T, P, D, HOW>::READS };
        let stride = const { Composed::<T, P, D, HOW>::READS.width(D) };
        let width_out = const { Composed::<T, P, D, HOW>::WRITES.width(D) };
        let one_sided = const { P::WRITES.contains(Output::MomentMatrix) };
        for (c, bounds) in list.starts.windows(2).enumerate() {
            let first = (chunk * CHUNK + c) * L::WIDTH;
            let block = self.blocks.partition_point(|b| b.slots.end <= first);
            let live = self
                .blocks
                .get(block)
                .is_some_and(|b| b.slots.contains(&first));
            if !self.targets.contains(&first) {
                continue;
            }
            if !live {
                // Slots that no particle owns any more feel nothing.
                let row = c * width_out * L::WIDTH..(c + 1) * width_out * L::WIDTH;
                out[row].fill(T::zero());
                continue;
            }
            let mut own = [L::zero(); MOST_READS];
            for (k, value) in own.iter_mut().enumerate().take(stride) {
                *value = L::from_fn(|lane| self.records[(first + lane) * stride + k]);
            }
            let mut sums = Sums::<L, D, Composed<T, P, D, HOW>>::new();
            for segment in &list.segments[bounds[0] as usize..bounds[1] as usize] {
                let other = segment.block as usize;
                let interaction = self.interactions[block * self.blocks.len() + other];
                let contact = interaction == Interaction::Unilateral;
                // A gradient does not look across a contact that may open.
                if interaction == Interaction::None || (contact && one_sided) {
                    continue;
                }
                let foreign = other != block;
                let before = if foreign {
                    sums.kept
                } else {
                    [L::zero(); MOST_SUMS]
                };
                let full = own;
                let mut kept = L::zero();
                if contact {
                    compressive(reads, &mut own, D);
                    kept = sums.take_kernel_sum();
                }
                let listed = (
                    &list.neighbors[segment.start as usize..segment.end as usize],
                    (segment.near_end - segment.start) as usize,
                );
                let mobile = [block, other]
                    .map(|block| L::of(f64::from(u8::from(!self.blocks[block].wall))));
                self.segment::<L, HOW>(contact, mobile, &own, first, listed, &mut sums);
                if contact {
                    own = full;
                    sums.divert_kernel_sum(kept);
                }
                if foreign && const { Composed::<T, P, D, HOW>::WRITES.contains(Output::Force) } {
                    let end = self.blocks[block].slots.end;
                    let members = end.saturating_sub(first).min(L::WIDTH);
                    reactions.push(reaction::<L, D, _>(block, segment, members, &before, &sums));
                }
            }
            let row = &mut out[c * width_out * L::WIDTH..(c + 1) * width_out * L::WIDTH];
            for (k, values) in row.chunks_exact_mut(L::WIDTH).enumerate() {
                for (lane, value) in values.iter_mut().enumerate() {
                    *value = sums.kept[k].extract(lane);
                }
            }
        }
    }

    /// Which members of a row touch the other side of a contact; `None` before contacts are known.
    #[inline(always)]
    fn touches<L: Lane<Scalar = T>>(&self, first: usize) -> Option<L> {
        let row = self.touching.get(first..first + L::WIDTH)?;
        Some(L::from_fn(|lane| row[lane]))
    }

    /// The slot of a neighbour, or of the particle that it is an image of.
    #[inline(always)]
    fn source(&self, j: u32) -> usize {
        let j = j as usize;
        let image = j
            .checked_sub(self.touching.len())
            .and_then(|k| self.images.get(k));
        image.map_or(j, |image| image.source as usize)
    }

    /// Those of some neighbours that are within the support of any of the row, in their order; returns
    /// how many there are. The first `staying` were so near when they were listed that they still are.
    ///
    /// What a skin lists and what a row of several particles lists for only one of them is mostly too
    /// far away, and finding that out costs less than the terms would.
    #[inline(always)]
    fn within_reach<L: Lane<Scalar = T>, const HOW: u8>(
        &self,
        own: &[L; MOST_READS],
        neighbors: &[u32],
        staying: usize,
        near: &mut [u32; BATCH],
    ) -> usize
    where
        P: Terms<D>,
    {
        let reads = const { Composed::<T, P, D, HOW>::READS };
        let stride = const { Composed::<T, P, D, HOW>::READS.width(D) };
        let position = reads.offset(Field::Position, D);
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
    fn segment<L: Lane<Scalar = T>, const HOW: u8>(
        &self,
        contact: bool,
        mobile: [L; 2],
        own: &[L; MOST_READS],
        first: usize,
        (neighbors, staying): (&[u32], usize),
        sums: &mut Sums<L, D, Composed<T, P, D, HOW>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        // In one dimension a list has few entries too many, and with several smoothing lengths the
        // reach is not known before the pair is.
        if HOW & (MEAN | OWN) != 0 || D == 1 {
            self.pairs::<L, HOW>(contact, mobile, own, first, neighbors, sums);
            return;
        }
        let mut near = [0; BATCH];
        for (k, batch) in neighbors.chunks(BATCH).enumerate() {
            let staying = staying.saturating_sub(k * BATCH).min(batch.len());
            let count = self.within_reach::<L, HOW>(own, batch, staying, &mut near);
            self.pairs::<L, HOW>(contact, mobile, own, first, &near[..count], sums);
        }
    }

    /// Where the row stands from a neighbour: rᵢⱼ, its square and its length.
    #[inline(always)]
    fn separation<L: Lane<Scalar = T>, const HOW: u8>(
        &self,
        own: &[L; MOST_READS],
        j: u32,
    ) -> ([L; D], L, L)
    where
        P: Terms<D>,
    {
        let reads = const { Composed::<T, P, D, HOW>::READS };
        let stride = const { Composed::<T, P, D, HOW>::READS.width(D) };
        let position = reads.offset(Field::Position, D);
        let residual = reads.offset(Field::PositionResidual, D);
        let record = &self.records[j as usize * stride..j as usize * stride + stride];
        let mut r = [L::zero(); D];
        for d in 0..D {
            r[d] = own[position + d] - L::splat(record[position + d]);
            if reads.contains(Field::PositionResidual) {
                r[d] += own[residual + d] - L::splat(record[residual + d]);
            }
        }
        let mut r2 = r[0] * r[0];
        for d in 1..D {
            r2 = r[d].mul_add(r[d], r2);
        }
        (r, r2, r2.root())
    }

    /// One cluster against some neighbours.
    ///
    /// Across a contact that may open (`contact`) a pair acts only where one of the two touches, shows the
    /// other side only pressure that compresses, and its kernel sum is kept apart.
    #[inline(always)]
    fn pairs<L: Lane<Scalar = T>, const HOW: u8>(
        &self,
        contact: bool,
        mobile: [L; 2],
        own: &[L; MOST_READS],
        first: usize,
        neighbors: &[u32],
        sums: &mut Sums<L, D, Composed<T, P, D, HOW>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        let reads = const { Composed::<T, P, D, HOW>::READS };
        let stride = const { Composed::<T, P, D, HOW>::READS.width(D) };
        let velocity = reads.offset(Field::Velocity, D);
        let h_at = reads.offset(Field::SmoothingLength, D);
        let norm = L::splat(self.kernel_norm);
        let uniform = Scale::new(L::splat(self.h), norm, D);
        let own_scale = if HOW & (MEAN | OWN) == 0 {
            uniform
        } else {
            Scale::new(own[h_at], norm, D)
        };
        let body_force = self.body_force.map(L::splat);
        let lattice_moment = L::splat(self.lattice_moment);
        let mut shown = [T::zero(); MOST_READS];
        // Copies that nothing else points to stay in registers.
        let terms = self.terms.clone();
        let mut kept = sums.copied();
        let (total, sums) = (sums, &mut kept);
        let Some(&first_j) = neighbors.first() else {
            return;
        };
        // The distance of the next pair is under way while the terms of this one are summed.
        let mut next = self.separation::<L, HOW>(own, first_j);
        for (k, &j) in neighbors.iter().enumerate() {
            let (r, r2, distance) = next;
            next = self.separation::<L, HOW>(own, *neighbors.get(k + 1).unwrap_or(&j));
            let record = &self.records[j as usize * stride..j as usize * stride + stride];
            let mut v = [L::zero(); D];
            if reads.contains(Field::Velocity) {
                for d in 0..D {
                    v[d] = own[velocity + d] - L::splat(record[velocity + d]);
                }
            }
            let mut v_dot_r = v[0] * r[0];
            for d in 1..D {
                v_dot_r = v[d].mul_add(r[d], v_dot_r);
            }
            let (h, w, f, f_i, f_j);
            if HOW & OWN != 0 {
                let other = Scale::new(L::splat(record[h_at]), norm, D);
                h = (own_scale.h + other.h) * L::of(0.5);
                w = own_scale.value(self.kernel, distance);
                f_i = own_scale.gradient(self.kernel, distance);
                f_j = other.gradient(self.kernel, distance);
                f = (f_i + f_j) * L::of(0.5);
            } else {
                let scale = if HOW & MEAN != 0 {
                    Scale::new((own_scale.h + L::splat(record[h_at])) * L::of(0.5), norm, D)
                } else {
                    uniform
                };
                h = scale.h;
                w = scale.value(self.kernel, distance);
                f = scale.gradient(self.kernel, distance);
                f_i = f;
                f_j = f;
            }
            let mut pair = Pair {
                r,
                r2,
                v,
                v_dot_r,
                h,
                h_i: own_scale.h,
                w,
                f,
                f_i,
                f_j,
                mobile: mobile[1],
                mobile_i: mobile[0],
                body_force,
                lattice_moment,
                i: own,
                j: record,
                layout: PhantomData,
            };
            if contact {
                if let Some(touching) = self.touches::<L>(first) {
                    pair.f_i *= touching;
                    pair.f_j *= L::splat(self.touching[self.source(j)]);
                    pair.f = (pair.f_i + pair.f_j) * L::of(0.5);
                }
                shown[..stride].copy_from_slice(record);
                compressive(reads, &mut shown, D);
                pair.j = &shown[..stride];
            }
            sums.radial = Along::NOTHING;
            sums.shear = Along::NOTHING;
            terms.pair(&pair, sums);
            apply::<L, D, HOW, _>(&pair, sums, &P::WRITES, own, record, reads);
        }
        total.take(&kept);
    }
}

/// Turns the pair's scalar forces into the kept force, or into work.
#[inline(always)]
fn apply<L: Lane, const D: usize, const HOW: u8, C: Layout>(
    pair: &Pair<'_, L, D, C>,
    sums: &mut Sums<L, D, C>,
    writes: &Outputs,
    own: &[L; MOST_READS],
    record: &[L::Scalar],
    reads: Fields,
) {
    if !writes.contains(Output::Force) {
        return;
    }
    if HOW & WORK != 0 {
        let mean = reads.offset(Field::MeanVelocity, D);
        let mut work = L::zero();
        for d in 0..D {
            let force = sums
                .radial
                .mul_add(pair.r[d], sums.shear.mul_add(pair.v[d], L::zero()));
            work = force.mul_add(L::splat(record[mean + d]) - own[mean + d], work);
        }
        sums.add(Output::Power, work * L::of(0.5));
        return;
    }
    for d in 0..D {
        let kept = &mut sums.kept[C::WRITES.offset(Output::Force, D) + d];
        *kept = sums.radial.mul_add(pair.r[d], *kept);
        *kept = sums.shear.mul_add(pair.v[d], *kept);
    }
    if writes.contains(Output::Power) {
        let power = sums
            .radial
            .mul_add(pair.v_dot_r, sums.shear.mul_add(pair.v2(), L::zero()));
        sums.add(Output::Power, power * L::of(-0.5));
    }
}

/// Kernel factors of a smoothing length.
#[derive(Clone, Copy)]
struct Scale<L> {
    h: L,
    inverse: L,
    value: L,
    gradient: L,
}

impl<L: Lane> Scale<L> {
    #[inline(always)]
    fn new(h: L, norm: L, d: usize) -> Self {
        let inverse = h.recip();
        let value = norm * inverse.powi(d as u32);
        Self {
            h,
            inverse,
            value,
            gradient: value * inverse * inverse,
        }
    }
    #[inline(always)]
    fn value<K: Kernel<D>, const D: usize>(&self, kernel: &K, r: L) -> L {
        self.value * kernel.shape(r * self.inverse)
    }
    #[inline(always)]
    fn gradient<K: Kernel<D>, const D: usize>(&self, kernel: &K, r: L) -> L {
        kernel.gradient(r, self.inverse, self.gradient)
    }
}

/// What a particle shows the other side of a contact: pressure only where it compresses, and no
/// curvature of it.
#[inline(always)]
fn compressive<L: Lane>(reads: Fields, shown: &mut [L; MOST_READS], d: usize) {
    if reads.contains(Field::PressureCoefficient) {
        let x = &mut shown[reads.offset(Field::PressureCoefficient, d)];
        *x = x.positive_part();
    }
    if reads.contains(Field::PressureGradient) {
        let at = reads.offset(Field::PressureGradient, d);
        shown[at..at + d].fill(L::zero());
    }
}

/// The force that the real particles of a row felt from one segment.
#[inline(always)]
fn reaction<L: Lane, const D: usize, C: Layout>(
    block: usize,
    segment: &Segment,
    members: usize,
    before: &[L; MOST_SUMS],
    sums: &Sums<L, D, C>,
) -> Reaction<D> {
    let at = C::WRITES.offset(Output::Force, D);
    let force = core::array::from_fn(|d| {
        (0..members)
            .map(|lane| (sums.kept[at + d] - before[at + d]).extract(lane).to_f64())
            .sum()
    });
    Reaction {
        on: block as u32,
        from: segment.block,
        force,
    }
}
