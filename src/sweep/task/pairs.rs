//! The loop over pairs: one row of particles against one neighbour after the other.
//! All terms share its distances and kernel values, and it turns their scalar forces into vectors.

use super::shown::Shown;
use super::{Composed, MEAN, OWN, Row, Task};
use crate::kernel::Kernel;
use crate::particles::{Field, Output};
use crate::scalar::{Lane, Real};
use crate::term::{Layout, MOST_READS, Pair, Sums, Terms};
use core::marker::PhantomData;

impl<T: Real, K, P, const D: usize> Task<'_, T, K, P, D> {
    /// Which members of a lane row are active in a contact; `None` before contacts are known.
    #[inline(always)]
    fn active<L: Lane<Scalar = T, Broadcast = T>>(&self, first: usize) -> Option<L> {
        let row = self.contact_activity.get(first..first + L::WIDTH)?;
        Some(L::from_fn(|lane| row[lane]))
    }

    /// The slot of a neighbour, or of the particle that it is an image of.
    #[inline(always)]
    fn source(&self, j: u32) -> usize {
        let j = j as usize;
        let image = j
            .checked_sub(self.contact_activity.len())
            .and_then(|k| self.images.get(k));
        image.map_or(j, |image| image.source as usize)
    }

    /// A distance of its square. The choice is the same for all pairs of a run, so a processor foresees it.
    #[inline(always)]
    fn root<L: Lane<Scalar = T>>(&self, square: L) -> L {
        if self.by_divider {
            square.sqrt()
        } else {
            square.root()
        }
    }

    /// Where the row stands from a neighbour: rᵢⱼ, its square, and the distance that kernels see, which is |Xᵢⱼ| in the
    /// reference configuration where a term reads that.
    #[inline(always)]
    fn separation<L: Lane<Scalar = T, Broadcast = T>, const HOW: u8>(
        &self,
        own: &[L; MOST_READS],
        j: u32,
    ) -> ([L; D], L, L)
    where
        P: Terms<D>,
    {
        let reads = const { &Composed::<T, P, D, HOW>::READS };
        let stride = const { Composed::<T, P, D, HOW>::READS.width(D) };
        let position = reads.offset(Field::POSITION, D);
        let residual = reads.offset(Field::POSITION_RESIDUAL, D);
        let record = &self.records[j as usize * stride..j as usize * stride + stride];
        let mut r = [L::zero(); D];
        for d in 0..D {
            r[d] = own[position + d] - L::splat(record[position + d]);
            if reads.contains(Field::POSITION_RESIDUAL) {
                r[d] += own[residual + d] - L::splat(record[residual + d]);
            }
        }
        let mut r2 = r[0] * r[0];
        for d in 1..D {
            r2 = r[d].mul_add(r[d], r2);
        }
        if const { Composed::<T, P, D, HOW>::READS.contains(Field::REFERENCE_POSITION) } {
            let reference = reads.offset(Field::REFERENCE_POSITION, D);
            let mut square = L::zero();
            for d in 0..D {
                let apart = own[reference + d] - L::splat(record[reference + d]);
                square = apart.mul_add(apart, square);
            }
            return (r, r2, self.root(square));
        }
        (r, r2, self.root(r2))
    }

    /// One cluster against some neighbours.
    ///
    /// Across a contact that may open a pair acts only where one of the two is active, shows the
    /// other side only pressure that compresses, and its kernel sum is kept apart.
    ///
    /// A neighbour that the row meets for both gets its own sums in `later`, lane by lane, from the same distance, kernel and
    /// forces.
    #[inline(always)]
    pub(super) fn pairs<L: Lane<Scalar = T, Broadcast = T>, const HOW: u8, const BOTH: bool>(
        &self,
        row: Row<'_, L>,
        neighbors: &[u32],
        later: &mut [T],
        sums: &mut Sums<L, D, Composed<T, P, D, HOW>>,
    ) where
        K: Kernel<D>,
        P: Terms<D>,
    {
        let Row {
            first,
            own,
            contact,
            mobile,
            chunk_first,
            ..
        } = row;
        let width_out = const { Composed::<T, P, D, HOW>::WRITES.width(D) };
        let reads = const { &Composed::<T, P, D, HOW>::READS };
        let stride = const { Composed::<T, P, D, HOW>::READS.width(D) };
        let velocity = reads.offset(Field::VELOCITY, D);
        let h_at = reads.offset(Field::SMOOTHING_LENGTH, D);
        let norm = L::splat(self.kernel_norm);
        let uniform = Scale::new(L::splat(self.h), norm, D);
        let own_scale = if HOW & (MEAN | OWN) == 0 {
            uniform
        } else {
            Scale::new(own[h_at], norm, D)
        };
        let mut body_force = [L::zero(); D];
        for d in 0..D {
            body_force[d] = L::splat(self.body_force[d]);
        }
        let lattice_consistency_factor = L::splat(self.lattice_consistency_factor);
        let mut shown = [T::zero(); MOST_READS];
        // A copy that nothing else points to stays in registers.
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
            if reads.contains(Field::VELOCITY) {
                for d in 0..D {
                    v[d] = own[velocity + d] - L::splat(record[velocity + d]);
                }
            }
            let mut v_dot_r = v[0] * r[0];
            for d in 1..D {
                v_dot_r = v[d].mul_add(r[d], v_dot_r);
            }
            let (h, h_j, w, w_j, f, f_i, f_j);
            if HOW & OWN != 0 {
                let other = Scale::new(L::splat(record[h_at]), norm, D);
                h = (own_scale.h + other.h) * L::of(0.5);
                h_j = other.h;
                w = own_scale.value(self.kernel, distance);
                w_j = other.value(self.kernel, distance);
                f_i = own_scale.gradient(self.kernel, distance);
                f_j = other.gradient(self.kernel, distance);
                f = (f_i + f_j) * L::of(0.5);
            } else {
                let scale = if HOW & MEAN != 0 {
                    h_j = L::splat(record[h_at]);
                    Scale::new((own_scale.h + h_j) * L::of(0.5), norm, D)
                } else {
                    h_j = uniform.h;
                    uniform
                };
                h = scale.h;
                w = scale.value(self.kernel, distance);
                w_j = w;
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
                w_j,
                f,
                f_i,
                f_j,
                mobile: mobile[1],
                mobile_i: mobile[0],
                body_force,
                lattice_consistency_factor,
                gated: false,
                swapped: false,
                i: own,
                j: record,
                layout: PhantomData,
            };
            // A pair that is summed for both is across no contact.
            if !BOTH && contact {
                if let Some(active) = self.active::<L>(first) {
                    pair.gated = true;
                    pair.f_i *= active;
                    pair.f_j *= L::splat(self.contact_activity[self.source(j)]);
                    pair.f = (pair.f_i + pair.f_j) * L::of(0.5);
                }
                shown[..stride].copy_from_slice(record);
                Shown::across::<T, P, D, HOW, T>(&mut shown);
                pair.j = &shown[..stride];
            }
            sums.next_pair();
            self.terms.pair(&pair, sums);
            sums.settle(pair.f);
            apply::<_, D, _, false>(&pair, sums);
            if BOTH {
                let mut back = sums.opposite();
                let other = pair.swapped(h_j, w_j);
                let at = (j as usize - chunk_first) * width_out * L::WIDTH;
                let kept = &mut later[at..at + width_out * L::WIDTH];
                for k in 0..width_out {
                    back.kept[k] = L::load(&kept[k * L::WIDTH..]);
                }
                self.terms.pair(&other, &mut back);
                back.settle(pair.f);
                apply::<_, D, _, true>(&pair, &mut back);
                for k in 0..width_out {
                    back.kept[k].store(&mut kept[k * L::WIDTH..]);
                }
            }
        }
        total.take(&kept);
    }
}

/// Turns the pair's forces along directions into vectors, and adds them with the free one to the kept force; `OPPOSITE` are those
/// on j.
#[inline(always)]
pub(in crate::sweep) fn apply<L: Lane, const D: usize, C: Layout, const OPPOSITE: bool>(
    pair: &Pair<'_, L, D, C>,
    sums: &mut Sums<L, D, C>,
) {
    let writes = const { &C::WRITES };
    if !writes.contains(Output::FORCE) {
        return;
    }
    let (radial, shear) = if OPPOSITE {
        (sums.radial.reversed(), sums.shear.reversed())
    } else {
        (sums.radial, sums.shear)
    };
    for d in 0..D {
        let kept = &mut sums.kept[const { C::WRITES.offset(Output::FORCE, D) } + d];
        // The free one of the other side has been turned when it was taken over.
        *kept = sums.force.plus(d, *kept);
        *kept = radial.mul_add(pair.r[d], *kept);
        *kept = shear.mul_add(pair.v[d], *kept);
    }
    if writes.contains(Output::POWER) {
        let free = sums.force.dot(&pair.v);
        let free = if OPPOSITE { -free } else { free };
        let along = sums.shear.mul_add(pair.v2(), free);
        let power = sums.radial.mul_add(pair.v_dot_r, along);
        sums.add(Output::POWER, power * L::of(-0.5));
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
