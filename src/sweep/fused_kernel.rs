//! A kernel and a tuple of terms as one sweep, for each way the loop can run.
//! Behind [`PairSweep`] it is an object that is called a handful of times a step.

use super::records::{Ghosts, Image, Records, Transform};
use super::results::{Reaction, Results};
use super::task::{BEYOND, Composed, Task, reads, room_for_both};
use super::work::Working;
use super::{InstructionSet, Interaction, Root, SmoothingMode};
use crate::kernel::Kernel;
use crate::neighbors::{Block, CHUNK, ChunkList, ClusterLists};
use crate::parallel::{cut, for_each};
use crate::particles::{Columns, Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{Layout, TermDoc, TermUse, Terms, assert_room};
use core::fmt::Debug;
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
    /// Particles that other processes have, if there are any.
    pub ghosts: Option<&'a dyn Ghosts<T>>,
    /// Images of particles behind boundaries, whose sources are slots, or ghosts behind them.
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
    /// Runs of these to which they are narrowed, ascending, each of whole clusters; all of them if not given.
    pub among: Option<&'a [Range<usize>]>,
    /// Whether forces between blocks that are at hand stay, of a sweep that was over others of these runs.
    pub goes_on: bool,
    /// The acceleration that acts on all particles \[m/s²\], in the frame of their container.
    pub body_force: [T; D],
    /// First moment of the kernel gradient on the lattice, by which sums of gradients are divided.
    pub lattice_consistency_factor: f64,
    /// The instruction set to run on.
    pub instructions: InstructionSet,
    /// How it takes roots.
    pub root: Root,
}

/// A sweep over pairs, whatever its kernel and terms.
pub trait PairSweep<T: Real, const D: usize>: Debug + Send + Sync {
    /// Fields that the particles must carry.
    fn fields(&self) -> Fields;
    /// Sums that it makes in a [`Pass::Rates`].
    fn outputs(&self) -> Outputs;
    /// Its terms, for people.
    fn document(&self) -> Vec<TermDoc>;
    /// What each of its terms reads and writes.
    fn uses(&self) -> Vec<TermUse>;
    /// One pair of a pass, recorded for a device; with what it does across contacts that may open, where there are any.
    ///
    /// # Errors
    ///
    /// If a term, or the kernel, does what cannot be recorded.
    #[cfg(feature = "devices")]
    fn record(
        &self,
        pass: Pass,
        contacts: bool,
    ) -> Result<super::PairRecord, crate::scalar::Unrecordable>;
    /// Packs what a pass reads. `records` keeps its memory between calls.
    fn pack(&self, pass: Pass, input: &SweepInput<'_, T, D>, records: &mut Records<T>) {
        self.pack_beside(pass, input, records, &mut |_| {});
    }
    /// The same, and while ghosts are under way, if there are any, `meanwhile` with the records of own particles.
    fn pack_beside(
        &self,
        pass: Pass,
        input: &SweepInput<'_, T, D>,
        records: &mut Records<T>,
        meanwhile: &mut dyn FnMut(&Records<T>),
    );
    /// Renews the mean velocities in records packed for [`Pass::Work`].
    fn renew_mean_velocity(&self, input: &SweepInput<'_, T, D>, records: &mut Records<T>);
    /// Makes the records of images of a pass anew, from those of the particles.
    fn show_images(&self, pass: Pass, input: &SweepInput<'_, T, D>, records: &mut Records<T>);
    /// Runs the loop over packed records. `rows` keeps its memory between calls.
    fn run(
        &self,
        pass: Pass,
        input: &SweepInput<'_, T, D>,
        records: &Records<T>,
        rows: &mut Results<T, D>,
    );
}

/// A kernel and the terms that share a sweep.
///
/// `MODE` is the [`SmoothingMode`] of the loop, as its bit.
#[derive(Clone, Debug)]
pub struct FusedKernel<K, P, const MODE: u8 = { SmoothingMode::Uniform.bit() }> {
    kernel: K,
    terms: P,
}

impl<K, P, const MODE: u8> FusedKernel<K, P, MODE> {
    /// The program of `terms` under `kernel`.
    #[must_use]
    pub fn new(kernel: K, terms: P) -> Self {
        Self { kernel, terms }
    }
}

impl<T: Real, const D: usize, K: Kernel<D>, P: Terms<D>, const MODE: u8> PairSweep<T, D>
    for FusedKernel<K, P, MODE>
{
    fn fields(&self) -> Fields {
        reads::<T, P, D>(MODE)
    }

    fn outputs(&self) -> Outputs {
        P::WRITES
    }

    fn document(&self) -> Vec<TermDoc> {
        self.terms.document()
    }

    fn uses(&self) -> Vec<TermUse> {
        self.terms.uses()
    }

    #[cfg(feature = "devices")]
    fn record(
        &self,
        pass: Pass,
        contacts: bool,
    ) -> Result<super::PairRecord, crate::scalar::Unrecordable> {
        use super::pair_record::record;
        let (kernel, terms) = (&self.kernel, &self.terms);
        if const { sweeps_work::<P, D>() } && pass == Pass::Work {
            return record::<T, K, _, D, MODE>(kernel, Working::of(terms), contacts);
        }
        record::<T, K, P, D, MODE>(kernel, terms, contacts)
    }

    fn pack_beside(
        &self,
        pass: Pass,
        input: &SweepInput<'_, T, D>,
        records: &mut Records<T>,
        meanwhile: &mut dyn FnMut(&Records<T>),
    ) {
        let layout = Self::layout::<T, D>(pass);
        let images = (input.images, input.transforms);
        records.pack(layout, input.columns, input.ghosts, images, meanwhile);
    }

    fn renew_mean_velocity(&self, input: &SweepInput<'_, T, D>, records: &mut Records<T>) {
        let layout = Self::layout::<T, D>(Pass::Work);
        for field in [Field::MEAN_VELOCITY, Field::MEAN_ACCELERATION] {
            let images = (input.images, input.transforms);
            records.renew(field, layout, input.columns, input.ghosts, images);
        }
    }

    fn show_images(&self, pass: Pass, input: &SweepInput<'_, T, D>, records: &mut Records<T>) {
        let layout = Self::layout::<T, D>(pass);
        let ghosts = input.ghosts.map_or(0, |ghosts| ghosts.count());
        let slots = input.columns.slots() + ghosts;
        records.show(layout, slots, input.images, input.transforms);
    }

    fn run(
        &self,
        pass: Pass,
        input: &SweepInput<'_, T, D>,
        records: &Records<T>,
        rows: &mut Results<T, D>,
    ) {
        const {
            assert_room::<Composed<T, P, D, MODE>, D>();
            if sweeps_work::<P, D>() {
                assert_room::<Composed<T, Working<P>, D, MODE>, D>();
            }
        }
        match pass {
            Pass::Rates => self.go::<T, D, P>(&self.terms, input, records, rows),
            // Work is only ever asked of sweeps that carry energy.
            Pass::Work => {
                if const { sweeps_work::<P, D>() } {
                    self.go::<T, D, _>(Working::of(&self.terms), input, records, rows);
                }
            }
        }
    }
}

impl<K, P, const MODE: u8> FusedKernel<K, P, MODE> {
    fn layout<T: Real, const D: usize>(pass: Pass) -> Fields
    where
        P: Terms<D>,
    {
        match pass {
            Pass::Rates => reads::<T, P, D>(MODE),
            Pass::Work => reads::<T, Working<P>, D>(MODE),
        }
    }

    fn go<T: Real, const D: usize, Q: Terms<D>>(
        &self,
        terms: &Q,
        input: &SweepInput<'_, T, D>,
        records: &Records<T>,
        rows: &mut Results<T, D>,
    ) where
        K: Kernel<D>,
    {
        rows.lay_out(Composed::<T, Q, D, MODE>::WRITES);
        let instructions = input.instructions.or_detected();
        let reach = self.kernel.support() * input.smoothing_length;
        let task = Task {
            kernel: &self.kernel,
            terms,
            records: records.data(),
            blocks: input.blocks,
            interactions: input.interactions,
            contact_activity: input.columns.raw(Field::CONTACT_ACTIVITY),
            images: input.images,
            targets: &input.targets,
            body_force: input.body_force,
            lattice_consistency_factor: T::from_f64(input.lattice_consistency_factor),
            by_divider: input.root == Root::Divider,
            h: T::from_f64(input.smoothing_length),
            reach2: T::from_f64(reach.powi(2) * BEYOND),
            kernel_norm: T::from_f64(self.kernel.normalisation()),
        };
        over_chunks(
            const { room_for_both::<Composed<T, Q, D, MODE>, T::Wide<true>, D>() },
            input,
            rows,
            &|targets, list, later, out, reactions| {
                let task = Task { targets, ..task };
                task.dispatch::<MODE>(instructions, list, later, out, reactions);
            },
        );
    }
}

/// Whether terms can be asked for the work of their forces: total-Lagrangian solids have it of the power of the rates.
const fn sweeps_work<P: Terms<D>, const D: usize>() -> bool {
    P::WRITES.contains(Output::POWER) && !P::READS.contains(Field::REFERENCE_POSITION)
}

/// What a loop does with one chunk: the slots that are wanted of it, its number and its lists, room for the other sides of its
/// pairs, its rows and the forces on its blocks.
type OneChunk<'a, T, const D: usize> = dyn Fn(&Range<usize>, (usize, &ChunkList), &mut [T], &mut [T], &mut Vec<Reaction<D>>)
    + Sync
    + 'a;

/// Shares the chunks out over the threads. One indirect call a chunk, and what shares them out is compiled once and
/// not for every loop.
fn over_chunks<T: Real, const D: usize>(
    room: usize,
    input: &SweepInput<'_, T, D>,
    rows: &mut Results<T, D>,
    work: &OneChunk<'_, T, D>,
) {
    let width = <T::Wide<false> as Lane>::WIDTH;
    let row = rows.outputs.width(D) * width;
    // Only chunks with wanted slots have rows.
    let slots = CHUNK * width;
    let skipped = input.targets.start / slots;
    rows.first = skipped * slots;
    let wanted = input.targets.end.saturating_sub(rows.first);
    let length = row * wanted.div_ceil(width);
    // Sweeps take turns on the same rows: only growth costs.
    if rows.data.len() < length {
        rows.data.reserve_exact(length - rows.data.len());
        rows.data.resize(length, T::zero());
    }
    let lists = input.lists.chunks();
    rows.reactions.resize_with(lists.len(), Vec::new);
    if !input.goes_on {
        rows.reactions.iter_mut().for_each(Vec::clear);
    }
    let whole = core::slice::from_ref(&input.targets);
    let runs = input.among.unwrap_or(whole);
    let pieces = (
        cut(&mut rows.data[..length], (row * CHUNK).max(1)),
        cut(&mut rows.reactions[skipped..], 1),
    );
    for_each(pieces, |piece, (out, reactions)| {
        let chunk = skipped + piece;
        let own = chunk * slots..(chunk + 1) * slots;
        T::with_room(room, &mut |later| {
            let from = runs.partition_point(|run| run.end <= own.start);
            for run in runs[from..].iter().take_while(|run| run.start < own.end) {
                work(run, (chunk, &lists[chunk]), later, out, &mut reactions[0]);
            }
        });
    });
}
