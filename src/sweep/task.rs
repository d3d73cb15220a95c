//! The loop over pairs: one chunk of rows against its neighbours, compiled for each way it can run.
//! It allocates nothing, and sums in an order that no number of threads changes.

use super::records::Image;
use super::rows::Reaction;
use super::{InstructionSet, Interaction};
use crate::kernel::Kernel;
use crate::neighbors::{Block, CHUNK, ChunkList, Segment};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Mask, Real};
use crate::term::{Along, Layout, MOST_READS, MOST_SUMS, Pair, Sums, Terms};
use core::marker::PhantomData;
use std::ops::Range;

pub(super) const UNIFORM: u8 = 0;
pub(super) const MEAN: u8 = 1;
pub(super) const OWN: u8 = 2;
pub(super) const WORK: u8 = 4;

/// The layout of a sweep: what its terms name, and what the way of running adds.
pub(super) struct Composed<T, P, const D: usize, const HOW: u8>(PhantomData<(T, P)>);

impl<T: Real, P: Terms<D>, const D: usize, const HOW: u8> Layout for Composed<T, P, D, HOW> {
    const READS: Fields = reads::<T, P, D>(HOW);
    const WRITES: Outputs = if HOW & WORK == 0 {
        P::WRITES
    } else {
        Outputs::of(&[Output::Power])
    };
}

pub(super) const fn reads<T: Real, P: Terms<D>, const D: usize>(how: u8) -> Fields {
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

/// Everything that the loop over one chunk reads.
pub(super) struct Task<'a, T, K, P, const D: usize> {
    pub kernel: &'a K,
    pub terms: &'a P,
    pub records: &'a [T],
    pub blocks: &'a [Block],
    pub interactions: &'a [Interaction],
    /// Which slots touch the other side of a contact; empty without contacts.
    pub touching: &'a [T],
    pub images: &'a [Image],
    pub targets: &'a Range<usize>,
    pub body_force: [T; D],
    pub lattice_moment: T,
    pub h: T,
    /// Square of the distance beyond which nothing acts where there is one smoothing length.
    pub reach2: T,
    pub kernel_norm: T,
}

/// What the square of the support is multiplied with before pairs are left out, so that rounding
/// (of `f32` positions without their residuals, too) leaves out none that acts.
pub(super) const BEYOND: f64 = 1.001;

/// Neighbours that are looked through at once.
const BATCH: usize = 256;

impl<T: Real, K, P, const D: usize> Task<'_, T, K, P, D> {
    #[inline(always)]
    pub fn dispatch<const HOW: u8>(
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
