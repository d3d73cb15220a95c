//! What a sweep leaves behind: the sums of every row, and the forces between blocks.
//! Sums are stored row by row (component, then lane), so each store is a full vector.

use crate::particles::{Output, Outputs};
use crate::scalar::{Lane, Real};

/// The force that the particles of one cluster felt from another block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reaction<const D: usize> {
    /// The block that felt the force.
    pub on: u32,
    /// The block that exerted it.
    pub from: u32,
    /// The force \[N\].
    pub force: [f64; D],
}

/// The sums of a sweep.
#[derive(Clone, Debug)]
pub struct Rows<T, const D: usize> {
    pub(super) data: Vec<T>,
    pub(super) outputs: Outputs,
    pub(super) reactions: Vec<Vec<Reaction<D>>>,
}

impl<T: Real, const D: usize> Default for Rows<T, D> {
    fn default() -> Self {
        Self {
            data: Vec::new(),
            outputs: Outputs::NONE,
            reactions: Vec::new(),
        }
    }
}

impl<T: Real, const D: usize> Rows<T, D> {
    const WIDTH: usize = <T::Wide<false> as Lane>::WIDTH;

    /// The sums that are here.
    #[must_use]
    pub fn outputs(&self) -> Outputs {
        self.outputs
    }

    /// Component `k` of a sum of the particle in `slot`; zero if the sum was not asked for.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, output: Output, k: usize, slot: usize) -> T {
        if !self.outputs.contains(output) {
            return T::zero();
        }
        let stride = self.outputs.width(D);
        let offset = self.outputs.offset(output, D) + k;
        self.data[(slot / Self::WIDTH * stride + offset) * Self::WIDTH + slot % Self::WIDTH]
    }

    /// A vector sum of the particle in `slot`.
    #[inline(always)]
    #[must_use]
    pub fn vector(&self, output: Output, slot: usize) -> [T; D] {
        core::array::from_fn(|d| self.get(output, d, slot))
    }

    /// Rearranges the slots: slot k gets the sums of what slot `order[k]` was.
    pub(crate) fn permute(&mut self, order: &[u32]) {
        let stride = self.outputs.width(D);
        if stride == 0 || self.data.len() < stride * order.len() {
            return;
        }
        let at = |slot: usize, k: usize| {
            (slot / Self::WIDTH * stride + k) * Self::WIDTH + slot % Self::WIDTH
        };
        let before = self.data[..stride * order.len()].to_vec();
        for (slot, &from) in order.iter().enumerate() {
            for k in 0..stride {
                self.data[at(slot, k)] = before[at(from as usize, k)];
            }
        }
    }

    /// Forces between blocks, cluster by cluster in order.
    pub fn reactions(&self) -> impl Iterator<Item = &Reaction<D>> {
        self.reactions.iter().flatten()
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.data.capacity() * size_of::<T>()
    }
}
