//! What a sweep leaves behind: the sums of every row, and the forces between blocks.
//! Sums are stored row by row (component, then lane), so each store is a full vector.

use crate::parallel::{cut, for_each};
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

/// Clusters that a thread takes at a time.
const CLUSTERS: usize = 512;

/// The place of a sum that is not here.
const ABSENT: u32 = u32::MAX;

/// The sums of a sweep.
#[derive(Clone, Debug)]
pub struct Results<T, const D: usize> {
    pub(super) data: Vec<T>,
    /// The slot that the sums start with.
    pub(super) first: usize,
    pub(super) outputs: Outputs,
    /// Where each sum of the crate starts among the numbers of a particle, [`ABSENT`] if it is not here. To count the
    /// bits of `outputs` for every number that is read costs more than to read it.
    offsets: [u32; Output::ALL.len()],
    /// Numbers a particle.
    stride: usize,
    pub(super) reactions: Vec<Vec<Reaction<D>>>,
}

impl<T: Real, const D: usize> Default for Results<T, D> {
    fn default() -> Self {
        Self {
            data: Vec::new(),
            first: 0,
            outputs: Outputs::NONE,
            offsets: [ABSENT; Output::ALL.len()],
            stride: 0,
            reactions: Vec::new(),
        }
    }
}

impl<T: Real, const D: usize> Results<T, D> {
    /// Particles a row.
    pub(crate) const WIDTH: usize = <T::Wide<false> as Lane>::WIDTH;

    /// Prepares for other sums.
    pub(super) fn lay_out(&mut self, outputs: Outputs) {
        self.outputs = outputs;
        self.stride = outputs.width(D);
        self.offsets = [ABSENT; Output::ALL.len()];
        for output in outputs.iter() {
            if let Some(index) = output.index() {
                self.offsets[index] = outputs.offset(output, D) as u32;
            }
        }
    }

    /// Where a sum starts among the numbers of a particle, if it is here: one of an effect is looked up by name, so ask
    /// once for many particles.
    #[inline(always)]
    pub(crate) fn offset(&self, output: Output) -> Option<usize> {
        match output.index() {
            Some(index) => Some(self.offsets[index])
                .filter(|own| *own != ABSENT)
                .map(|own| own as usize),
            None => (self.outputs.contains(output)).then(|| self.outputs.offset(output, D)),
        }
    }

    /// Takes over the sums of others, without the forces between blocks.
    pub(crate) fn copy(&mut self, from: &Self) {
        self.lay_out(from.outputs);
        self.first = from.first;
        self.data.clone_from(&from.data);
    }

    /// The sums that are here.
    #[must_use]
    pub fn outputs(&self) -> Outputs {
        self.outputs
    }

    /// Component `k` of a sum of the particle in `slot`; zero if the sum was not asked for, or not of
    /// that particle.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, output: Output, k: usize, slot: usize) -> T {
        (self.offset(output)).map_or(T::zero(), |offset| self.number(offset + k, slot))
    }

    /// The number at an offset among those of the particle in `slot`; zero for particles that were not summed over.
    #[inline(always)]
    pub(crate) fn number(&self, offset: usize, slot: usize) -> T {
        if slot < self.first {
            return T::zero();
        }
        let at = self.at(slot - self.first, offset);
        self.data.get(at).copied().unwrap_or(T::zero())
    }

    /// A sum of the particles of the row that starts with `slot`, component by component, if it is here.
    #[inline]
    pub(crate) fn row(&self, output: Output, slot: usize) -> Option<&[T]> {
        let offset = self.offset(output).filter(|_| slot >= self.first)?;
        let start = self.at(slot - self.first, offset);
        self.data
            .get(start..start + output.components(D) * Self::WIDTH)
    }

    /// A vector sum of the particle in `slot`.
    #[inline(always)]
    #[must_use]
    pub fn vector(&self, output: Output, slot: usize) -> [T; D] {
        core::array::from_fn(|d| self.get(output, d, slot))
    }

    /// Adds to a vector sum of the particle in `slot`, where it is requested.
    pub(crate) fn add(&mut self, output: Output, slot: usize, vector: [T; D]) {
        self.change(output, slot, |sum, d| *sum += vector[d]);
    }

    /// Sets a vector sum of the particle in `slot`, where it is requested.
    pub(crate) fn set(&mut self, output: Output, slot: usize, vector: [T; D]) {
        self.change(output, slot, |sum, d| *sum = vector[d]);
    }

    fn change(&mut self, output: Output, slot: usize, with: impl Fn(&mut T, usize)) {
        let Some(offset) = self.offset(output).filter(|_| slot >= self.first) else {
            return;
        };
        for d in 0..D {
            let at = self.at(slot - self.first, offset + d);
            if let Some(sum) = self.data.get_mut(at) {
                with(sum, d);
            }
        }
    }

    /// Adds a value, times a weight if there are any, to a sum of every particle, where it is requested; values stand slot
    /// by slot with all of their components.
    pub(crate) fn add_all(&mut self, output: Output, weights: Option<&[T]>, values: &[T]) {
        let Some(offset) = self.offset(output) else {
            return;
        };
        let width = output.components(D);
        let (first, cluster) = (self.first, self.stride * Self::WIDTH);
        for_each(cut(&mut self.data, CLUSTERS * cluster), |piece, sums| {
            for (n, sums) in sums.chunks_exact_mut(cluster).enumerate() {
                for lane in 0..Self::WIDTH {
                    let slot = first + (piece * CLUSTERS + n) * Self::WIDTH + lane;
                    for d in 0..width {
                        let value = values[slot * width + d];
                        let value = weights.map_or(value, |weights| weights[slot] * value);
                        sums[(offset + d) * Self::WIDTH + lane] += value;
                    }
                }
            }
        });
    }

    /// Where component `offset` of the n-th particle stands.
    #[inline(always)]
    fn at(&self, n: usize, offset: usize) -> usize {
        (n / Self::WIDTH * self.stride + offset) * Self::WIDTH + n % Self::WIDTH
    }

    /// Rearranges the slots of sums that start with the first: slot k gets the sums of what slot
    /// `order[k]` was.
    pub(crate) fn permute(&mut self, order: &[u32]) {
        let stride = self.stride;
        let held = self.data.len().checked_div(stride).unwrap_or(0);
        let Some(last) = order.iter().rposition(|&from| (from as usize) < held) else {
            return;
        };
        let slots = (last + 1).next_multiple_of(Self::WIDTH);
        let mut sorted = vec![T::zero(); stride * slots];
        for (slot, &from) in order.iter().enumerate().take(last + 1) {
            let from = from as usize;
            if from < held {
                for k in 0..stride {
                    sorted[self.at(slot, k)] = self.data[self.at(from, k)];
                }
            }
        }
        self.data = sorted;
    }

    /// Forces between blocks, cluster by cluster in order.
    pub fn reactions(&self) -> impl Iterator<Item = &Reaction<D>> {
        self.reactions.iter().flatten()
    }

    /// All numbers as they are stored, and the slot that they start with.
    #[cfg(feature = "checkpoint")]
    pub(crate) fn stored(&self) -> (&[T], usize) {
        (&self.data, self.first)
    }

    /// The sums that were [`stored`](Self::stored), with the forces between blocks.
    pub(crate) fn of_stored(
        outputs: Outputs,
        (data, first): (Vec<T>, usize),
        reactions: Vec<Reaction<D>>,
    ) -> Self {
        let mut rows = Self {
            data,
            first,
            reactions: vec![reactions],
            ..Self::default()
        };
        rows.lay_out(outputs);
        rows
    }

    /// The sums of some slots from the first on, whose numbers stand slot by slot, with the forces between blocks.
    pub(crate) fn of_rows(outputs: Outputs, numbers: &[T], reactions: Vec<Reaction<D>>) -> Self {
        let width = outputs.width(D);
        let slots = numbers.len() / width.max(1);
        let data = vec![T::zero(); width * slots.next_multiple_of(Self::WIDTH)];
        let mut rows = Self::of_stored(outputs, (data, 0), reactions);
        for slot in 0..slots {
            for k in 0..width {
                let at = rows.at(slot, k);
                rows.data[at] = numbers[slot * width + k];
            }
        }
        rows
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.data.capacity() * size_of::<T>()
    }
}
