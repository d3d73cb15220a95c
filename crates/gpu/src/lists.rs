//! Neighbour lists that the device builds: particles in the order of a curve, and for each cluster who is within reach and skin.
//! The host is told how many entries there are and, after a sort, which particle is where.

use crate::cells::{Around, folded, numbers};
use crate::compile::Sizes;
use crate::device::{Bound, Buffer, Extent, Kernel};
use crate::kernel::{Array, pack_indices, unpack_indices};
use crate::pairs::PairLists;
use crate::reduce::{Find, Reduction};
use crate::run::Run;
use crate::sort::{Scan, Sort, Sorted, digits};
use crate::{Device, Error, Precision};
use meshfree::scalar::Real;
use meshfree::simulation::device::{Bounds, Offloaded, Search};

/// Cells of the table for each slot.
const CELLS: usize = 4;
/// Digits of a word of keys, and the word that has the block.
const WORD: usize = 4;
const BLOCK: usize = 2;

/// Most particles that a thread may look at on a driver in software, which leaves it in silence after 65 535 rounds of loops.
const MOST_SEEN: f64 = 4e4;

const LISTS: &str = "the lists of neighbours";

/// Kernels that build the lists of a group, and their memory.
#[derive(Debug)]
pub(crate) struct Builder {
    kernels: Kernels,
    sort: Sort,
    bounds: Reduction,
    /// What is known of each slot, and rooms for slots with images.
    of_slots: Vec<u32>,
    rooms: Rooms,
    cells: Buffer,
    grid: Buffer,
    clusters: Buffer,
    segments: Buffer,
    list: Buffer,
    /// Entries that the list has room for.
    room: usize,
    /// Cells of the table for a block, and how many blocks there are.
    table: usize,
    blocks: usize,
    /// Clusters times blocks.
    pairs: usize,
}

/// Memory for slots and images.
#[derive(Debug)]
struct Rooms {
    /// How many it is for.
    size: usize,
    keys: Buffer,
    orders: [Buffer; 2],
    counts: Buffer,
    members: Buffer,
    places: Buffer,
}

impl Rooms {
    /// For so many slots and images, with `width` bytes a place.
    fn new(
        device: &Device,
        (slots, size): (usize, usize),
        (pairs, of_slots, width): (usize, &[u32], usize),
    ) -> Result<Self, Error> {
        let words = |count: usize| device.room(LISTS, 4 * count);
        let members = words(of_slots.len() + size - slots)?;
        device.write(&members, &pack_indices(of_slots));
        Ok(Self {
            size,
            // Along a curve three words of a slot.
            keys: words(size.max(3 * slots))?,
            orders: [words(size)?, words(size)?],
            counts: words(Sort::room(size).max(Scan::room(pairs + 1) + 1))?,
            members,
            places: device.room(LISTS, width * size)?,
        })
    }
}

#[derive(Debug)]
struct Kernels {
    remember: Kernel,
    /// What lets particles re-enter, where they have images.
    re_enter: Option<Kernel>,
    places: Kernel,
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
    fn new(device: &Device, around: &Around<'_>, re_entry: Option<String>) -> Result<Self, Error> {
        let kernel = |name: &str, buffers: &[Array], body: &str| {
            device.kernel(("lists", name), (around.dialect, buffers), body)
        };
        let [state, grid, places] = ["state", "grid", "places"].map(Array::numbers);
        let [members, sorted, cells] = ["members", "sorted", "cells"].map(Array::indices);
        let [keys, order, counts] = ["keys", "order", "counts"].map(Array::indices);
        let [other, segments, list] = ["other", "segments", "list"].map(Array::indices);
        let [given, room, made] = ["given", "room", "made"].map(Array::numbers);
        let (images, transforms) = (Array::indices("images"), Array::numbers("transforms"));
        let near = [places, members, sorted, cells, grid];
        let count = [&near[..], &[counts.written()]].concat();
        let fill = [&near[..], &[counts, segments.written(), list.written()]].concat();
        let of_keys = [members, grid, keys.written(), order.written()];
        let cell = [&[places][..], &of_keys].concat();
        let curve = [&[state][..], &of_keys, &[other.written()]].concat();
        let through = [state.written(), images, transforms];
        let re_enter = re_entry.map(|text| kernel("re-entry", &through, &text));
        Ok(Self {
            remember: kernel("places", &[state.written()], &around.remember())?,
            re_enter: re_enter.transpose()?,
            places: kernel("of slots", &[state, places.written()], &around.places())?,
            keys: kernel("cells", &cell, &around.keys())?,
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
    pub fn new<T: Real, const D: usize>(
        device: &Device,
        (host, group, sizes): (&Offloaded<T, D>, usize, &Sizes),
        precision: Precision,
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
        let shows_images = host.shows_images(group);
        let re_entry = shows_images.then(|| host.re_entry(group)).transpose();
        let re_entry = re_entry.map_err(|error| Error::recorded("lists", "re-entry", &error))?;
        let re_entry = re_entry.map(|(fields, record)| around.re_entry(fields, &record));
        let kernels = Kernels::new(device, &around, re_entry)?;
        let sort = Sort::new(device, around.dialect)?;
        let words = |count: usize| device.room(LISTS, 4 * count);
        let of_slots = host.members(group);
        let bytes = around.width() * precision.bytes();
        let rooms = Rooms::new(device, (slots, slots), (pairs, &of_slots, bytes))?;
        // What of lists does not change: each cluster has a segment for each block.
        let firsts = of_slots[blocks * blocks..].iter().step_by(sizes.cluster);
        let block = |own: u32| if own < blocks as u32 { own } else { 0 };
        let all = firsts.enumerate();
        let all = all.flat_map(|(k, own)| [(k * blocks) as u32, block(*own)]);
        let clusters: Vec<u32> = all.chain([pairs as u32, 0]).collect();
        let segments = (0..pairs).flat_map(|own| [0, 0, (own % blocks) as u32]);
        let segments: Vec<u32> = segments.collect();
        let first = layout.listed(0) / slots;
        let finds = (first..first + around.width()).map(Find::Least);
        let finds = finds.chain((first..first + around.width()).map(Find::Most));
        Ok(Self {
            bounds: Reduction::new(device, &finds.collect::<Vec<_>>(), precision)?,
            clusters: device.upload(LISTS, &pack_indices(&clusters))?,
            segments: device.upload(LISTS, &pack_indices(&segments))?,
            list: words(0)?,
            room: 0,
            kernels,
            sort,
            of_slots,
            rooms,
            cells: words(table * blocks + 1)?,
            grid: device.room(LISTS, around.numbers() * precision.bytes())?,
            table,
            blocks,
            pairs,
        })
    }

    /// Kernels that count the neighbours of slots, with some images behind them; and the order of both by their cells.
    fn counted(
        &self,
        device: &Device,
        state: &Buffer,
        (slots, count): (usize, usize),
    ) -> (Vec<Bound>, Buffer) {
        let (r, kernels, cells) = (&self.rooms, &self.kernels, self.table * self.blocks);
        let [first, second] = &r.orders;
        let buffers = [&r.places, &r.members, &self.grid, &r.keys, first];
        let mut all = vec![
            device.bind(&kernels.places, &[state, &r.places], slots),
            device.bind(&kernels.keys, &buffers, count),
        ];
        let bits = usize::BITS - cells.leading_zeros();
        let passes: Vec<_> = (0..digits(bits as usize)).map(|k| (0, k)).collect();
        let of_sort = Sorted {
            keys: &r.keys,
            orders: [first, second],
            counts: &r.counts,
            slots,
            count,
        };
        let (passes, sorted) = self.sort.bind(device, of_sort, &passes);
        all.extend(passes);
        let extent = Extent {
            count: cells + 1,
            length: count,
            ..Extent::default()
        };
        let sorted = &r.orders[sorted];
        all.push(device.bind_over(&kernels.starts, &[&r.keys, sorted, &self.cells], extent));
        let near = [&r.places, &r.members, sorted, &self.cells];
        let buffers = [&near[..], &[&self.grid, &r.counts]].concat();
        all.push(device.bind(&kernels.count, &buffers, self.pairs));
        all.extend(self.sort.scan.bind(device, &r.counts, self.pairs + 1));
        (all, sorted.clone())
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
        self.device.launch([&remember]);
        let mut places = None;
        if self.host.shows_images(group) {
            let Some(own) = self.re_enter(group, builder, time)? else {
                return Ok(false);
            };
            places = Some(own);
        }
        let bounds = self.bounds(group, builder)?;
        if !self.can_list(group, &bounds) {
            return Ok(false);
        }
        let sorts = self.host.begin_lists(group, time);
        let search = self.host.search(group, &bounds);
        let order = if sorts {
            self.sort(group, &search)?
        } else {
            Vec::new()
        };
        if let Some(places) = places {
            self.host.show_images(group, (&places, &order), &bounds);
        }
        self.list(group, bounds, sorts)?;
        Ok(true)
    }

    /// Lets what has left a period re-enter. Gives places, with smoothing lengths where they vary; none if the host has to do that.
    fn re_enter(
        &self,
        group: usize,
        builder: &Builder,
        time: f64,
    ) -> Result<Option<Vec<f64>>, Error> {
        let (own, device) = (&self.groups[group], &self.device);
        let (layout, state) = (&own.sizes.layout, &own.memory.state);
        let first = layout.listed(0);
        let mut places = self.read_at(state, first, layout.numbers() - first)?;
        let Some(found) = self.host.re_entered(group, &mut places, time) else {
            return Ok(None);
        };
        if let (Some(kernel), false) = (&builder.kernels.re_enter, found.entries.is_empty()) {
            let entries = device.upload(LISTS, &pack_indices(&found.entries))?;
            let transforms = self.numbers(found.transforms.into_iter());
            let transforms = device.upload(LISTS, &transforms)?;
            let buffers = [state, &entries, &transforms];
            let count = found.entries.len() / 2;
            device.launch([&device.bind(kernel, &buffers, count)]);
        }
        Ok(Some(places))
    }

    /// Builds lists for the places for which the host has listed; whether the device does that.
    pub(crate) fn list_as_sent(&mut self, group: usize) -> Result<bool, Error> {
        let Some(builder) = &self.groups[group].builder else {
            return Ok(false);
        };
        let bounds = self.bounds(group, builder)?;
        if !self.can_list(group, &bounds) {
            return Ok(false);
        }
        self.list(group, bounds, false)?;
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
        self.device.launch(&all);
        let found = self.read(&m.moves, own.outputs)?;
        let (low, high) = found.split_at(own.outputs / 2);
        let range = [low, high].map(|own| core::array::from_fn(|d| own[d]));
        let lengths = (low.len() > D).then(|| [low[D], high[D]]);
        Ok(Bounds { range, lengths })
    }

    /// Whether a thread can list what is near within some bounds.
    fn can_list(&self, group: usize, bounds: &Bounds<D>) -> bool {
        let is_software = self.device.adapter().kind == "Cpu";
        let seen = self.host.looks_at(group, bounds);
        self.host.can_list(bounds) && (!is_software || seen <= MOST_SEEN)
    }

    /// Tells the device where neighbours are looked for.
    fn look_in(&self, builder: &Builder, search: &Search<D>) {
        let table = folded(search.cells.counts, builder.table);
        let all = numbers(search, table, self.precision);
        self.device
            .write(&builder.grid, &self.numbers(all.into_iter()));
    }

    /// Lists the neighbours of a group, images of which the host has found among them.
    fn list(&mut self, group: usize, bounds: Bounds<D>, sorts: bool) -> Result<(), Error> {
        let bounds = self.host.bounds_with_images(group, bounds);
        let search = self.host.search(group, &bounds);
        let shows_images = self.host.shows_images(group);
        let (images, transforms) = (self.host.images(group), self.host.transforms(group));
        let transforms = self.numbers(transforms.into_iter());
        let (places, blocks) = self.host.listed_images(group);
        let places = self.numbers(places.into_iter());
        if let Some(builder) = &self.groups[group].builder {
            self.look_in(builder, &search);
        }
        let (own, device) = (&mut self.groups[group], &self.device);
        let Some(builder) = &mut own.builder else {
            return Ok(());
        };
        let slots = own.sizes.layout.slots;
        let count = slots + blocks.len();
        if !blocks.is_empty() {
            let width = places.len() / blocks.len();
            if count > builder.rooms.size {
                let size = (slots, count + blocks.len() / 8);
                let of = (builder.pairs, &builder.of_slots[..], width);
                builder.rooms = Rooms::new(device, size, of)?;
            }
            let (rooms, at) = (&builder.rooms, 4 * builder.of_slots.len());
            device.write_at(&rooms.members, at, &pack_indices(&blocks));
            device.write_at(&rooms.places, slots * width, &places);
        }
        let (counted, sorted) = builder.counted(device, &own.memory.state, (slots, count));
        device.launch(&counted);
        let rooms = &builder.rooms;
        let entries = device.download(&rooms.counts, 4 * builder.pairs, 4)?;
        let entries = unpack_indices(&entries)[0] as usize;
        self.host.listed_there(group, entries, sorts);
        if entries > builder.room {
            builder.room = entries + entries / 8;
            builder.list = device.room(LISTS, 4 * builder.room)?;
        }
        let m = &mut own.memory;
        if shows_images || !m.list.is(&builder.list) {
            m.list = builder.list.clone();
            m.clusters = builder.clusters.clone();
            m.segments = builder.segments.clone();
            let of = (None, &images[..], &transforms[..]);
            own.compiled
                .bind(device, m, (&own.sizes, &own.program), of)?;
        }
        let near = [&rooms.places, &rooms.members, &sorted, &builder.cells];
        let rest = [&builder.grid, &rooms.counts, &m.segments, &m.list];
        let buffers = [near, rest].concat();
        let fill = device.bind(&builder.kernels.fill, &buffers, builder.pairs);
        device.launch([&fill]);
        Ok(())
    }

    /// Sorts particles by their place along the curve, and moves all that the device has of them. Gives their order.
    fn sort(&mut self, group: usize, search: &Search<D>) -> Result<Vec<u32>, Error> {
        let order = self.sorted(group, search)?;
        self.host.sorted(group, &order);
        self.follow();
        Ok(order)
    }

    fn sorted(&self, group: usize, search: &Search<D>) -> Result<Vec<u32>, Error> {
        let (own, device) = (&self.groups[group], &self.device);
        let builder = own.builder.as_ref();
        let of = builder.and_then(|own| Some((own, own.kernels.curve.as_ref()?)));
        let Some((builder, curve)) = of else {
            return Ok(Vec::new());
        };
        self.look_in(builder, search);
        let bits = D * search.order.bits as usize;
        let (m, layout) = (&own.memory, &own.sizes.layout);
        let (slots, mobile) = (layout.slots, layout.mobile);
        let rooms = &builder.rooms;
        let [first, second] = &rooms.orders;
        let buffers = [&m.state, &rooms.members, &builder.grid, &rooms.keys];
        let buffers = [&buffers[..], &[first, second]].concat();
        let mut all = vec![device.bind(curve, &buffers, slots)];
        let passes = (0..digits(bits)).map(|k| (k / WORD, k % WORD));
        let bodies = self.host.blocks(group).iter().filter(|own| !own.wall);
        let by_body = (bodies.count() > 1).then_some((BLOCK, 0));
        let passes: Vec<_> = passes.chain(by_body).collect();
        let of_sort = Sorted {
            keys: &rooms.keys,
            orders: [first, second],
            counts: &rooms.counts,
            slots,
            count: mobile,
        };
        let (passes, at) = builder.sort.bind(device, of_sort, &passes);
        all.extend(passes);
        let order = &rooms.orders[at];
        all.push(device.bind(&builder.kernels.repeats, &[&rooms.members, order], mobile));
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
        device.launch(&all);
        let order = unpack_indices(&device.download(order, 0, 4 * mobile)?);
        let rest = mobile as u32..slots as u32;
        Ok(order.into_iter().chain(rest).collect())
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
            Ok(unpack_indices(&bytes))
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
