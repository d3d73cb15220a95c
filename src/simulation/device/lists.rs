//! Neighbour lists that a device builds itself: in which cells, how far, and in which order of particles.
//! The host decides when, and knows which particle is in which slot.

use super::Offloaded;
use super::state::Moved;
use crate::neighbors::Grid;
use crate::scalar::Real;
use crate::simulation::Group;
use crate::sweep::Interaction;

/// Most blocks of a group whose lists a device builds: it looks for neighbours in each by itself.
const MOST_BLOCKS: usize = 32;

/// By how much smoothing lengths may differ: cells are as wide as the widest support asks for. At the corner of a gas in a vacuum they are
/// twice those of its middle.
const WIDEST: f64 = 3.0;

/// What bounds all particles of a group.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds<const D: usize> {
    /// The least and the largest coordinate of places along each axis \[m\].
    pub range: [[f64; D]; 2],
    /// The least and the largest smoothing length \[m\], where that varies.
    pub lengths: Option<[f64; 2]>,
}

/// Cubic cells over all particles of a group.
#[derive(Clone, Debug, PartialEq)]
pub struct CellGrid<const D: usize> {
    /// The lowest corner \[m\].
    pub origin: [f64; D],
    /// The inverse of an edge \[1/m\].
    pub inverse: f64,
    /// How many there are along each axis; what is beyond belongs to the last.
    pub counts: [u32; D],
    /// Bits that a coordinate of a cell takes.
    pub bits: u32,
}

impl<const D: usize> CellGrid<D> {
    fn of(grid: &Grid<D>) -> Self {
        Self {
            origin: grid.origin(),
            inverse: 1.0 / grid.size(),
            counts: grid.counts(),
            bits: grid.bits(),
        }
    }
}

/// How neighbours are to be found.
#[derive(Clone, Debug, PartialEq)]
pub struct Search<const D: usize> {
    /// Cells to look in.
    pub cells: CellGrid<D>,
    /// Cells in whose [order](crate::neighbors::hilbert_index) particles are sorted.
    pub order: CellGrid<D>,
    /// The widest support \[m\], and that of a smoothing length of one.
    pub supports: [f64; 2],
    /// What is added to a support \[m\].
    pub skin: f64,
}

/// The least spacing of bodies \[m\].
fn finest<T: Real, const D: usize>(group: &Group<T, D>) -> f64 {
    let spacings = group.particles.bodies.iter().map(|own| own.spacing);
    spacings.fold(f64::INFINITY, f64::min)
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// Whether a device may build the lists of a group: of present neighbours, and in few blocks. It sorts bodies alone: walls that are
    /// bodies of other groups, which the host sorts too, stay as they are.
    #[must_use]
    pub fn builds_lists(&self, group: usize) -> bool {
        let (own, program) = (
            &self.simulation.state.groups[group],
            &self.recorded[group].program,
        );
        own.outlets.is_empty()
            && !program.moved.is_empty()
            && own.neighborhood.blocks.len() <= MOST_BLOCKS
    }

    /// A one for each two blocks `a` and `b` if particles of `a` list those of `b`, at `a * blocks + b`. Behind them of each slot its block;
    /// where it repeats the last particle of one, the number of blocks and the slot of that.
    #[must_use]
    pub fn members(&self, group: usize) -> Vec<u32> {
        let (near, slots) = (
            &self.simulation.state.groups[group].neighborhood,
            self.recorded[group].layout.slots,
        );
        let count = near.blocks.len();
        let listed = near.interactions.iter();
        let mut all: Vec<u32> = listed
            .map(|own| u32::from(*own != Interaction::None))
            .collect();
        all.resize(count * count, 1);
        let table = all.len();
        let repeated = |all: &Vec<u32>| (count + all.len().saturating_sub(table + 1)) as u32;
        let own = near.blocks.iter().enumerate();
        for (number, block) in own.filter(|(_, block)| block.slots.start < slots) {
            all.resize(table + block.slots.start, repeated(&all));
            all.resize(table + block.slots.end, number as u32);
        }
        all.resize(table + slots, repeated(&all));
        all
    }

    /// The identity of the particle in each slot.
    #[must_use]
    pub fn ids(&self, group: usize) -> &[u32] {
        &self.simulation.state.groups[group].particles.ids
    }

    /// Whether a device can build lists within some bounds: they are numbers, and smoothing lengths are not too different.
    #[must_use]
    pub fn can_list(&self, bounds: &Bounds<D>) -> bool {
        let [low, high] = &bounds.range;
        let most = f64::from(f32::MAX).sqrt();
        let fits = |(low, high): (&f64, &f64)| low.abs() < most && high.abs() < most && low <= high;
        low.iter().zip(high).all(fits)
            && bounds
                .lengths
                .is_none_or(|[least, most]| least > 0.0 && most <= WIDEST * least)
    }

    /// How many particles a thread of the device looks at where they are closest within some bounds: those in the cells around each of a
    /// cluster.
    #[must_use]
    pub fn looks_at(&self, group: usize, bounds: &Bounds<D>) -> f64 {
        let group = &self.simulation.state.groups[group];
        let near = &group.neighborhood;
        let [spacing, most] = match bounds.lengths {
            Some([least, most]) => [least / group.scheme.h_over_dx(), most],
            None => [finest(group), near.smoothing_length],
        };
        // A reach to either side, and half a reach for the cells at both ends: in one dimension, where cells are wider, there are few.
        let around = 2.5 * (near.support * most + near.skin) / spacing;
        self.cluster() as f64 * around.powi(D as i32)
    }

    /// How neighbours are found within some bounds.
    #[must_use]
    pub fn search(&self, group: usize, bounds: &Bounds<D>) -> Search<D> {
        let group = &self.simulation.state.groups[group];
        let near = &group.neighborhood;
        let largest = bounds
            .lengths
            .map_or(near.smoothing_length, |[_, most]| most);
        let reach = near.support * largest + near.skin;
        let spacing = finest(group);
        let edge = if D == 1 { reach } else { 0.5 * reach };
        Search {
            cells: CellGrid::of(&Grid::over(&bounds.range, edge)),
            order: CellGrid::of(&Grid::centred(&bounds.range, spacing)),
            supports: [near.support * largest, near.support],
            skin: near.skin,
        }
    }

    /// Begins a list build on the device at a time \[s\]; whether particles are to be sorted before.
    pub fn begin_lists(&mut self, number: usize, time: f64) -> bool {
        let own = &mut self.recorded[number];
        own.is_listed_there = true;
        own.travel.is_at(Moved::none(D));
        let group = &mut self.simulation.state.groups[number];
        group.neighborhood.choose_skin();
        group.begin_rebuild(time);
        group.neighborhood.served = 1;
        group.neighborhood.wants_sort(own.entries)
    }

    /// Notes that slot k of a group has the particle that slot `order[k]` had.
    pub fn sorted(&mut self, group: usize, order: &[u32]) {
        let particles = &mut self.simulation.state.groups[group].particles;
        particles.renumber(order, core::iter::empty());
    }

    /// Notes how many entries lists have that a device has built, after a sort or without.
    pub fn listed_there(&mut self, group: usize, entries: usize, after_sort: bool) {
        self.recorded[group].entries = entries;
        if after_sort {
            let near = &mut self.simulation.state.groups[group].neighborhood;
            near.sorted_entries = entries;
        }
    }

    /// Leaves the lists of the device, of which the host makes none, since it [builds](Self::rebuild) others next.
    pub fn leave_lists(&mut self, group: usize) {
        self.recorded[group].is_listed_there = false;
    }

    /// Lists neighbours for the places for which the device has listed them, if the host has not.
    pub(super) fn take_lists(&mut self, number: usize, state: &[f64]) {
        let own = &mut self.recorded[number];
        if !core::mem::take(&mut own.is_listed_there) {
            return;
        }
        let layout = &own.layout;
        let at = |k: usize, slot: usize| T::from_f64(state[layout.listed(k) + slot]);
        let place = |slot| core::array::from_fn(|d| at(d, slot));
        let listed = (0..layout.slots).map(place).collect();
        let lengths = 0..if layout.varies() { layout.slots } else { 0 };
        let lengths = lengths.map(|slot| at(D, slot)).collect();
        let group = &mut self.simulation.state.groups[number];
        let instructions = group.instructions;
        group
            .neighborhood
            .list_again((listed, lengths), instructions);
    }
}
