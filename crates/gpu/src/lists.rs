//! Neighbour lists that the device builds: particles in the order of a curve, and for each cluster who is within reach and skin.
//! The host is told how many entries there are and, after a sort, which particle is where.

use crate::cells::{Around, folded, numbers};
use crate::compile::Sizes;
use crate::device::{Bound, Buffer, Extent, Kernel};
use crate::kernel::{Array, pack_indices};
use crate::pairs::PairLists;
use crate::reduce::{Find, Reduction};
use crate::run::Run;
use crate::sort::{Scan, Sort, Sorted, digits};
use crate::{Device, Error, Precision};
use meshfree::scalar::Real;
use meshfree::simulation::device::{Bounds, Search};

/// Cells of the table for each slot.
const CELLS: usize = 4;
/// Digits of a word of keys, and the word that has the block.
const WORD: usize = 4;
const BLOCK: usize = 2;

const LISTS: &str = "the lists of neighbours";

/// Kernels that build the lists of a group, and their memory.
#[derive(Debug)]
pub(crate) struct Builder {
    kernels: Kernels,
    sort: Sort,
    bounds: Reduction,
    /// What comes before entries are counted, with that.
    counted: Vec<Bound>,
    keys: Buffer,
    orders: [Buffer; 2],
    counts: Buffer,
    members: Buffer,
    cells: Buffer,
    /// Which of the orders has particles by their cells.
    sorted: usize,
    grid: Buffer,
    clusters: Buffer,
    segments: Buffer,
    list: Buffer,
    /// Entries that the list has room for.
    room: usize,
    /// Cells of the table for a block, and clusters times blocks.
    table: usize,
    pairs: usize,
}

#[derive(Debug)]
struct Kernels {
    remember: Kernel,
    keys: Kernel,
    starts: Kernel,
    count: Kernel,
    fill: Kernel,
    curve: Option<Kernel>,
    repeats: Kernel,
    gather: Kernel,
    copy: Kernel,
}

impl Kernels {
    fn new(device: &Device, around: &Around<'_>) -> Result<Self, Error> {
        let kernel = |name: &str, buffers: &[Array], body: &str| {
            device.kernel(("lists", name), (around.dialect, buffers), body)
        };
        let [state, grid] = ["state", "grid"].map(Array::numbers);
        let [members, sorted, cells] = ["members", "sorted", "cells"].map(Array::indices);
        let [keys, order, counts] = ["keys", "order", "counts"].map(Array::indices);
        let [other, segments, list] = ["other", "segments", "list"].map(Array::indices);
        let [given, room, made] = ["given", "room", "made"].map(Array::numbers);
        let near = [state, members, sorted, cells, grid];
        let count = [&near[..], &[counts.written()]].concat();
        let fill = [&near[..], &[counts, segments.written(), list.written()]].concat();
        let of_keys = [state, members, grid, keys.written(), order.written()];
        let curve = [&of_keys[..], &[other.written()]].concat();
        Ok(Self {
            remember: kernel("places", &[state.written()], &around.remember())?,
            keys: kernel("cells", &of_keys, &around.keys())?,
            starts: kernel("starts", &[keys, sorted, cells.written()], &around.starts())?,
            count: kernel("counts", &count, &around.neighbours(false))?,
            fill: kernel("neighbours", &fill, &around.neighbours(true))?,
            curve: match around.layout.dimensions {
                1 => None,
                _ => Some(kernel("curve", &curve, &around.curve())?),
            },
            repeats: kernel("repeats", &[members, order.written()], &around.repeats())?,
            gather: kernel("order", &[given, order, room.written()], &around.gather())?,
            copy: kernel("copy", &[room, made.written()], "made[i] = room[n];\n")?,
        })
    }
}

impl Builder {
    pub fn new(
        device: &Device,
        (sizes, members): (&Sizes, &[u32]),
        (state, precision): (&Buffer, Precision),
    ) -> Result<Self, Error> {
        let (layout, blocks) = (&sizes.layout, sizes.blocks);
        let around = Around {
            dialect: device.dialect(precision),
            layout,
            blocks,
            cluster: sizes.cluster,
        };
        let slots = layout.slots;
        let pairs = slots / sizes.cluster * blocks;
        // At least so many that small scenes have all of their cells.
        let table = (CELLS * slots + 1024) / blocks;
        let kernels = Kernels::new(device, &around)?;
        let sort = Sort::new(device, around.dialect)?;
        let words = |count: usize| device.room(LISTS, 4 * count);
        let keys = words(3 * slots)?;
        let orders = [words(slots)?, words(slots)?];
        let counts = words(Sort::room(slots).max(Scan::room(pairs + 1) + 1))?;
        let cells = words(table * blocks + 1)?;
        let grid = device.room(LISTS, around.numbers() * precision.bytes())?;
        // What of lists does not change: each cluster has a segment for each block.
        let firsts = members[..slots].iter().step_by(sizes.cluster);
        let block = |own: u32| if own < blocks as u32 { own } else { 0 };
        let all = firsts.enumerate();
        let all = all.flat_map(|(k, own)| [(k * blocks) as u32, block(*own)]);
        let clusters: Vec<u32> = all.chain([pairs as u32, 0]).collect();
        let segments = (0..pairs).flat_map(|own| [0, 0, (own % blocks) as u32]);
        let segments: Vec<u32> = segments.collect();
        let members = device.upload(LISTS, &pack_indices(members))?;
        let of_sort = Sorted {
            keys: &keys,
            orders: [&orders[0], &orders[1]],
            counts: &counts,
            slots,
            count: slots,
        };
        let buffers = [state, &members, &grid, &keys, &orders[0]];
        let mut counted = vec![device.bind(&kernels.keys, &buffers, slots)];
        let bits = usize::BITS - (table * blocks).leading_zeros();
        let passes: Vec<_> = (0..digits(bits as usize)).map(|k| (0, k)).collect();
        let (passes, sorted) = sort.bind(device, of_sort, &passes);
        counted.extend(passes);
        let extent = Extent {
            count: table * blocks + 1,
            length: slots,
            ..Extent::default()
        };
        let by_cell = &orders[sorted];
        counted.push(device.bind_over(&kernels.starts, &[&keys, by_cell, &cells], extent));
        let buffers = [state, &members, by_cell, &cells, &grid, &counts];
        counted.push(device.bind(&kernels.count, &buffers, pairs));
        counted.extend(sort.scan.bind(device, &counts, pairs + 1));
        let first = layout.listed(0) / slots;
        let last = first + layout.dimensions + usize::from(layout.varies());
        let finds = (first..last).map(Find::Least);
        let finds: Vec<_> = finds.chain((first..last).map(Find::Most)).collect();
        Ok(Self {
            bounds: Reduction::new(device, &finds, precision)?,
            clusters: device.upload(LISTS, &pack_indices(&clusters))?,
            segments: device.upload(LISTS, &pack_indices(&segments))?,
            list: words(0)?,
            room: 0,
            kernels,
            sort,
            counted,
            keys,
            orders,
            counts,
            members,
            cells,
            sorted,
            grid,
            table,
            pairs,
        })
    }
}

impl<T: Real, const D: usize> Run<T, D> {
    /// Builds the lists of a group anew for places at a time \[s\], and sorts particles if that pays; whether the device does that.
    pub(crate) fn rebuild(&mut self, group: usize, time: f64) -> Result<bool, Error> {
        let own = &self.groups[group];
        let Some(builder) = &own.builder else {
            return Ok(false);
        };
        let (state, slots) = (&own.memory.state, own.sizes.layout.slots);
        let remember = self.device.bind(&builder.kernels.remember, &[state], slots);
        self.device.launch(&[&remember]);
        let bounds = self.bounds(group, builder)?;
        if !self.host.can_list(&bounds) {
            return Ok(false);
        }
        let sorts = self.host.begin_lists(group, time);
        let search = self.host.search(group, &bounds);
        self.list(group, &search, sorts)?;
        Ok(true)
    }

    /// Builds lists for the places for which the host has listed; whether the device does that.
    pub(crate) fn list_as_sent(&mut self, group: usize) -> Result<bool, Error> {
        let Some(builder) = &self.groups[group].builder else {
            return Ok(false);
        };
        let bounds = self.bounds(group, builder)?;
        if !self.host.can_list(&bounds) {
            return Ok(false);
        }
        let search = self.host.search(group, &bounds);
        self.list(group, &search, false)?;
        Ok(true)
    }

    /// What bounds places for which lists are built.
    fn bounds(&self, group: usize, builder: &Builder) -> Result<Bounds<D>, Error> {
        let (m, slots) = (
            &self.groups[group].memory,
            self.groups[group].sizes.layout.slots,
        );
        let between = [&m.between[0], &m.between[1]];
        let (state, answers) = ((&m.state, slots), (&m.moves, 0));
        let own = &builder.bounds;
        let all = own.bind(&self.device, state, (0, slots), between, answers);
        self.device.launch(&all.iter().collect::<Vec<_>>());
        let found = self.read(&m.moves, own.outputs)?;
        let (low, high) = found.split_at(own.outputs / 2);
        let range = [low, high].map(|own| core::array::from_fn(|d| own[d]));
        let lengths = (low.len() > D).then(|| [low[D], high[D]]);
        Ok(Bounds { range, lengths })
    }

    /// Sorts particles of a group if asked to, and lists neighbours.
    fn list(&mut self, group: usize, search: &Search<D>, sorts: bool) -> Result<(), Error> {
        let own = &self.groups[group];
        let Some(builder) = &own.builder else {
            return Ok(());
        };
        let table = folded(search.cells.counts, builder.table);
        let all = numbers(search, table, self.precision);
        self.device
            .write(&builder.grid, &self.numbers(all.into_iter()));
        if sorts {
            let order = self.sort(group, builder, D * search.order.bits as usize)?;
            self.host.sorted(group, &order);
            self.follow();
        }
        let Self {
            device,
            groups,
            host,
            ..
        } = self;
        let own = &mut groups[group];
        let Some(builder) = &mut own.builder else {
            return Ok(());
        };
        device.launch(&builder.counted.iter().collect::<Vec<_>>());
        let entries = device.download(&builder.counts, 4 * builder.pairs, 4)?;
        let entries = entries.iter().rev();
        let entries = entries.fold(0, |sum, byte| sum << 8 | usize::from(*byte));
        host.listed_there(group, entries, sorts);
        if entries > builder.room {
            builder.room = entries + entries / 8;
            builder.list = device.room(LISTS, 4 * builder.room)?;
        }
        let m = &mut own.memory;
        if !m.list.is(&builder.list) {
            m.list = builder.list.clone();
            m.clusters = builder.clusters.clone();
            m.segments = builder.segments.clone();
            own.compiled
                .bind(device, m, (&own.sizes, &own.program), (None, &[], &[]))?;
        }
        let sorted = &builder.orders[builder.sorted];
        let near = [&m.state, &builder.members, sorted, &builder.cells];
        let rest = [&builder.grid, &builder.counts, &m.segments, &m.list];
        let buffers = [near, rest].concat();
        let fill = device.bind(&builder.kernels.fill, &buffers, builder.pairs);
        device.launch(&[&fill]);
        Ok(())
    }

    /// Sorts particles by their place along the curve, and moves all that the device has of them. Gives their order.
    fn sort(&self, group: usize, builder: &Builder, bits: usize) -> Result<Vec<u32>, Error> {
        let Some(curve) = &builder.kernels.curve else {
            return Ok(Vec::new());
        };
        let (own, device) = (&self.groups[group], &self.device);
        let (m, layout) = (&own.memory, &own.sizes.layout);
        let (slots, mobile) = (layout.slots, layout.mobile);
        let [first, second] = &builder.orders;
        let buffers = [&m.state, &builder.members, &builder.grid, &builder.keys];
        let buffers = [&buffers[..], &[first, second]].concat();
        let mut all = vec![device.bind(curve, &buffers, slots)];
        let passes = (0..digits(bits)).map(|k| (k / WORD, k % WORD));
        let bodies = self.host.blocks(group).iter().filter(|own| !own.wall);
        let by_body = (bodies.count() > 1).then_some((BLOCK, 0));
        let passes: Vec<_> = passes.chain(by_body).collect();
        let of_sort = Sorted {
            keys: &builder.keys,
            orders: [first, second],
            counts: &builder.counts,
            slots,
            count: mobile,
        };
        let (passes, at) = builder.sort.bind(device, of_sort, &passes);
        all.extend(passes);
        let order = &builder.orders[at];
        all.push(device.bind(&builder.kernels.repeats, &[&builder.members, order], mobile));
        // Records are packed before each sweep: their room is free.
        let room = own.compiled.widths[0];
        let columns = [
            (&m.state, layout.numbers() / slots, 1),
            (&m.columns, own.program.columns, 1),
            (&m.rates, 1, own.sizes.rates.width(D)),
        ];
        for (array, count, length) in columns {
            for column in (0..count).step_by(room) {
                let columns = room.min(count - column);
                let extent = Extent {
                    count: columns * slots * length,
                    first: column * slots,
                    length,
                    stride: slots,
                    ..Extent::default()
                };
                let buffers = [array, order, &m.records];
                all.push(device.bind_over(&builder.kernels.gather, &buffers, extent));
                let buffers = [&m.records, array];
                all.push(device.bind_over(&builder.kernels.copy, &buffers, extent));
            }
        }
        device.launch(&all.iter().collect::<Vec<_>>());
        let bytes = device.download(order, 0, 4 * mobile)?;
        let order = bytes.as_chunks::<4>().0.iter();
        let order = order.map(|own| u32::from_ne_bytes(*own));
        Ok(order.chain(mobile as u32..slots as u32).collect())
    }

    /// The neighbour lists of a group as the device has them. Groups are numbered as in
    /// [`Offloaded`](meshfree::simulation::device::Offloaded::groups), zero where all bodies obey one scheme.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if there is no such group, [`Error::Lost`] if the device fails.
    pub fn lists(&self, group: usize) -> Result<PairLists, Error> {
        let there = self.groups.len();
        Error::unless(group < there, "groups of the scene", [there, group + 1])?;
        let own = &self.groups[group];
        let (m, width) = (&own.memory, own.sizes.cluster);
        let words = |from: &Buffer, count: usize| -> Result<Vec<u32>, Error> {
            let bytes = self.device.download(from, 0, 4 * count)?;
            let words = bytes.as_chunks::<4>().0.iter();
            Ok(words.map(|own| u32::from_ne_bytes(*own)).collect())
        };
        let clusters = words(&m.clusters, 2 * (own.sizes.layout.slots / width) + 2)?;
        let segments = clusters.get(clusters.len() - 2).copied().unwrap_or(0);
        let segments = words(&m.segments, 3 * segments as usize)?;
        let ends = segments.chunks_exact(3).map(|own| own[1]);
        let entries = ends.max().unwrap_or(0);
        let list = words(&m.list, entries as usize)?;
        Ok(PairLists::of_parts([clusters, segments, list], width))
    }
}
