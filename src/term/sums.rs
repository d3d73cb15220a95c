//! Sums of a row of particles over their neighbours: what the terms of a sweep add to.
//! Forces stand by their directions until a pair is settled; all else is kept by name.

use super::{Along, FreeForce, Layout, MOST_SUMS, Pair};
use crate::particles::{Field, Output};
use crate::scalar::Lane;
use crate::tensor::Symmetric;
use core::marker::PhantomData;

/// The sums of a row of particles over their neighbours.
#[derive(Debug)]
pub struct Sums<L: Lane, const D: usize, P: Layout> {
    /// This pair's force on i along rᵢⱼ, divided by rᵢⱼ \[N/m\]: symmetric in i and j.
    pub radial: Along<L>,
    /// This pair's force on i along ∇ᵢWᵢⱼ = F rᵢⱼ, divided by it \[N m⁴ in space\]: symmetric in i and j. What is a multiple
    /// of F goes here, and terms share the product with it.
    pub gradient: Along<L>,
    /// This pair's force on i along vᵢⱼ, divided by vᵢⱼ \[N s/m\]: symmetric in i and j.
    pub shear: Along<L>,
    /// This pair's force on i in any other direction \[N\]: antisymmetric in i and j.
    pub force: FreeForce<L, D>,
    pub(crate) kept: [L; MOST_SUMS],
    /// The forces along r and v and the free one, where the other side of the pair has found them.
    known: Option<(Along<L>, Along<L>, FreeForce<L, D>)>,
    /// Which of the kept numbers are maxima.
    pub(crate) raised: u128,
    layout: PhantomData<P>,
}

impl<L: Lane, const D: usize, P: Layout> Sums<L, D, P> {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        let zero = L::zero();
        Self {
            radial: Along::NOTHING,
            gradient: Along::NOTHING,
            shear: Along::NOTHING,
            force: FreeForce::NOTHING,
            kept: [zero; MOST_SUMS],
            known: None,
            raised: 0,
            layout: PhantomData,
        }
    }
    /// The sums that are kept, copied.
    #[inline(always)]
    pub(crate) fn copied(&self) -> Self {
        let mut copy = Self::new();
        copy.take(self);
        copy
    }
    /// Takes over the sums that are kept.
    #[inline(always)]
    pub(crate) fn take(&mut self, from: &Self) {
        let width = const { P::WRITES.width(D) };
        self.kept[..width].copy_from_slice(&from.kept[..width]);
        self.raised |= from.raised;
    }
    /// Sets the sums that are kept to zero.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.kept[..const { P::WRITES.width(D) }].fill(L::zero());
    }
    /// Forgets the forces of the pair before.
    #[inline(always)]
    pub(crate) fn next_pair(&mut self) {
        self.radial = Along::NOTHING;
        self.gradient = Along::NOTHING;
        self.shear = Along::NOTHING;
        self.force = FreeForce::NOTHING;
    }
    /// Adds a force of which each side has a part with its own gradient factor: A (aᵢ Fᵢ + aⱼ Fⱼ) rᵢⱼ on i, with A symmetric in
    /// i and j.
    #[inline(always)]
    pub fn add_along_gradients(&mut self, pair: &Pair<'_, L, D, P>, factor: L, a_i: L, a_j: L) {
        if !P::ONE_GRADIENT {
            let sides = a_i.mul_add(pair.f_i, a_j * pair.f_j);
            self.radial.add_product(factor, sides);
            return;
        }
        let sides = if pair.gated {
            let sides = a_i.mul_add(pair.f_i, a_j * pair.f_j) / pair.f;
            L::select(pair.f.lt(L::zero()), sides, L::zero())
        } else {
            a_i + a_j
        };
        self.gradient.add_product(factor, sides);
    }
    /// Adds the force A (σᵢ Fᵢ/sᵢ + σⱼ Fⱼ/sⱼ)·rᵢⱼ on i of symmetric stresses σ, with the particles' own first moments s and A
    /// symmetric in i and j.
    #[inline(always)]
    pub fn add_tractions(&mut self, pair: &Pair<'_, L, D, P>, factor: L, stress: Field) {
        let over_own = pair.i(Field::CONSISTENCY_FACTOR).recip();
        let over_other = pair.j(Field::CONSISTENCY_FACTOR).recip();
        if P::ONE_GRADIENT && !pair.gated {
            // The row's stress over its moment is made once for all of its neighbours, and one product serves both sides.
            let mut both = [L::zero(); 6];
            for k in 0..6 {
                let own = pair.i_at(stress, k) * over_own;
                both[k] = pair.j_at(stress, k).mul_add(over_other, own);
            }
            let traction = Symmetric::new(both).dot(&pair.r);
            let factor = factor * pair.f;
            for d in 0..D {
                self.force.add(d, factor * traction[d]);
            }
            return;
        }
        let own = factor * pair.f_i * over_own;
        let other = factor * pair.f_j * over_other;
        let of_own = pair.i_tensor(stress).dot(&pair.r);
        let of_other = pair.j_tensor(stress).dot(&pair.r);
        for d in 0..D {
            self.force.add(d, own * of_own[d] + other * of_other[d]);
        }
    }
    /// Sums for the other side of a pair, on which the opposite forces act.
    #[inline(always)]
    pub(crate) fn opposite(&self) -> Self {
        Self {
            known: Some((self.radial, self.shear, self.force.reversed())),
            ..Self::new()
        }
    }
    /// Counts what terms have set along the gradient of the kernel among the forces along rᵢⱼ. Where the other side of the pair
    /// has found the forces they are taken from there, so that momentum is kept whatever terms round.
    #[inline(always)]
    pub(crate) fn settle(&mut self, f: L) {
        if let Some((radial, shear, force)) = self.known {
            (self.radial, self.shear, self.force) = (radial, shear, force);
            return;
        }
        if let Some(gradient) = self.gradient.take() {
            self.radial.add_product(gradient, f);
        }
    }
    /// The kept force; zero where no term sets one.
    #[inline(always)]
    pub(crate) fn kept_force(&self) -> [L; D] {
        if const { !P::WRITES.contains(Output::FORCE) } {
            return [L::zero(); D];
        }
        let at = const { P::WRITES.offset(Output::FORCE, D) };
        let mut force = [L::zero(); D];
        force.copy_from_slice(&self.kept[at..at + D]);
        force
    }
    /// Adds to a scalar sum.
    ///
    /// Power that is added here ([`Output::POWER`]) is energy that no force has done, such as heat that is
    /// conducted; the power of forces the sweep adds by itself.
    #[inline(always)]
    pub fn add(&mut self, output: Output, value: L) {
        self.add_at(output, 0, value);
    }
    /// Adds a product to a scalar sum, with one rounding where lanes are fused.
    #[inline(always)]
    pub fn add_product(&mut self, output: Output, a: L, b: L) {
        self.add_product_at(output, 0, a, b);
    }
    /// Adds a product to component `k` of a sum, with one rounding where lanes are fused.
    #[inline(always)]
    pub fn add_product_at(&mut self, output: Output, k: usize, a: L, b: L) {
        if output.is(Output::FORCE) {
            self.force.add(k, a * b);
        } else if const { &P::WRITES }.contains(output) {
            let kept = &mut self.kept[const { &P::WRITES }.offset(output, D) + k];
            *kept = a.mul_add(b, *kept);
        }
    }
    /// Adds to component `k` of a sum.
    ///
    /// What is added to [`Output::FORCE`] is a [free force](Self::force) of the pair: its power and its work
    /// count as those of any other.
    #[inline(always)]
    pub fn add_at(&mut self, output: Output, k: usize, value: L) {
        if output.is(Output::FORCE) {
            self.force.add(k, value);
        } else if const { &P::WRITES }.contains(output) {
            self.kept[const { &P::WRITES }.offset(output, D) + k] += value;
        }
    }
    /// Sets the kernel sum to zero and returns what it was.
    #[inline(always)]
    pub(crate) fn take_kernel_sum(&mut self) -> L {
        if const { P::WRITES.contains(Output::KERNEL_SUM) } {
            let at = const { P::WRITES.offset(Output::KERNEL_SUM, D) };
            core::mem::replace(&mut self.kept[at], L::zero())
        } else {
            L::zero()
        }
    }
    /// Moves the kernel sum to the contact sum, and restores what was taken.
    #[inline(always)]
    pub(crate) fn divert_kernel_sum(&mut self, taken: L) {
        let across = self.take_kernel_sum();
        self.add(Output::KERNEL_SUM, taken);
        self.add(Output::CONTACT_SUM, across);
    }
    /// Raises a maximum.
    #[inline(always)]
    pub fn raise(&mut self, output: Output, value: L) {
        if const { &P::WRITES }.contains(output) {
            let at = const { &P::WRITES }.offset(output, D);
            self.kept[at] = self.kept[at].max(value);
            self.raised |= 1 << at;
        }
    }
}
