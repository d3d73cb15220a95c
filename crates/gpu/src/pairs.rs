//! Sums over neighbours, from the record of one pair: one thread a particle, along the list of its cluster.
//! Lists are those of the host, or of `lists.rs`; what depends on i alone stands before the loop.

use crate::device::Kernel;
use crate::emit::{Text, emit_as};
use crate::kernel::{Array, Frame, THREADS, pack, pack_indices, unpack};
use crate::points::inputs;
use crate::{Device, Dialect, Error, Precision};
use core::cell::RefCell;
use meshfree::neighbors::{Block, ChunkList};
use meshfree::particles::Output;
use meshfree::sweep::PairRecord;
use std::collections::BTreeSet;

const BUFFERS: [Array; 6] = [
    Array::numbers("records"),
    Array::numbers("settings"),
    Array::indices("clusters"),
    Array::indices("segments"),
    Array::indices("list"),
    Array::numbers("rows").written(),
];

/// What all pairs of a sweep share.
#[derive(Clone, Debug)]
pub struct Shared {
    /// The smoothing length \[m\] where it is one for all.
    pub smoothing_length: f64,
    /// First moment of the kernel gradient on the lattice.
    pub lattice_consistency_factor: f64,
    /// The acceleration that acts on all particles \[m/s²\]; as many numbers as there are dimensions.
    pub body_force: Vec<f64>,
}

/// The neighbours of clusters of particles, as a device reads them.
#[derive(Clone, Debug, Default)]
pub struct PairLists {
    /// Where the segments of each cluster start, and its block; then the end of the last.
    pub(crate) clusters: Vec<u32>,
    /// Start, end and block of each segment.
    pub(crate) segments: Vec<u32>,
    pub(crate) list: Vec<u32>,
    /// One where the particles of a block move by forces.
    pub(crate) mobile: Vec<f64>,
    width: usize,
}

impl PairLists {
    /// Lists of the host with `width` particles a cluster, and the blocks that its segments name.
    #[must_use]
    pub fn new(chunks: &[ChunkList], blocks: &[Block], width: usize) -> Self {
        let mut own = Self {
            mobile: blocks
                .iter()
                .map(|block| f64::from(u8::from(!block.wall)))
                .collect(),
            width,
            ..Self::default()
        };
        for chunk in chunks {
            for bounds in chunk.starts.windows(2) {
                let first = own.clusters.len() / 2 * width;
                let block = blocks.partition_point(|block| block.slots.end <= first);
                own.clusters.push((own.segments.len() / 3) as u32);
                own.clusters
                    .push(block.min(blocks.len().saturating_sub(1)) as u32);
                for segment in &chunk.segments[bounds[0] as usize..bounds[1] as usize] {
                    let listed = &chunk.neighbors[segment.start as usize..segment.end as usize];
                    let start = own.list.len() as u32;
                    own.list.extend_from_slice(listed);
                    own.segments
                        .extend([start, own.list.len() as u32, segment.block]);
                }
            }
        }
        own.clusters.extend([(own.segments.len() / 3) as u32, 0]);
        own
    }

    /// Those that a device has built.
    pub(crate) fn of_parts([clusters, segments, list]: [Vec<u32>; 3], width: usize) -> Self {
        Self {
            clusters,
            segments,
            list,
            width,
            ..Self::default()
        }
    }

    /// The neighbours of the cluster of a slot, segment by segment: their block, and their slots. None of a slot that no cluster has.
    pub fn of(&self, slot: usize) -> impl Iterator<Item = (u32, &[u32])> {
        let bound = |cluster: usize| self.clusters.get(2 * cluster).map(|own| 3 * *own as usize);
        let bounds = slot.checked_div(self.width);
        let bounds = bounds.and_then(|own| Some(bound(own)?..bound(own + 1)?));
        let segments = self.segments[bounds.unwrap_or(0..0)].chunks_exact(3);
        segments.map(|own| (own[2], &self.list[own[0] as usize..own[1] as usize]))
    }

    /// How many neighbours are listed.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.list.len()
    }
}

/// A sweep whose buffers are those of a run: the six of a [`PairKernel`], and the forces between blocks if it `reacts`.
pub(crate) fn sweep_of_run(
    device: &Device,
    name: &str,
    pair: &PairRecord,
    shape: (usize, usize),
    precision: Precision,
    (blocks, reacts): (usize, bool),
) -> Result<Kernel, Error> {
    let dialect = device.dialect(precision);
    let mut buffers = BUFFERS.to_vec();
    buffers.extend(reacts.then_some(Array::numbers("reactions").written()));
    let body = body(pair, shape, dialect, (blocks, reacts));
    device.kernel(("sweep", name), (dialect, &buffers), &body)
}

/// The numbers of [`BUFFERS`] that all pairs of a sweep share.
pub(crate) fn settings(support: f64, shared: &Shared, of_blocks: &[f64]) -> Vec<f64> {
    let reach = support * shared.smoothing_length;
    let mut all = vec![reach * reach, shared.smoothing_length];
    all.push(shared.lattice_consistency_factor);
    all.extend(&shared.body_force);
    all.extend(of_blocks);
    all
}

/// The sums over the pairs of a sweep, compiled for a device.
#[derive(Debug)]
pub struct PairKernel {
    kernel: Kernel,
    stride: usize,
    sums: usize,
    support: f64,
    dimensions: usize,
    width: usize,
    precision: Precision,
}

/// A text with numbers of j that are not `there` loaded where they are first used: loads before the text would all hold registers.
fn late_loads(text: &str, there: &[usize], load: &dyn Fn(usize) -> String) -> String {
    let mut loaded: BTreeSet<usize> = there.iter().copied().collect();
    let mut all = String::new();
    for line in text.split_inclusive('\n') {
        let words = line.split(|c: char| !c.is_ascii_alphanumeric());
        let numbers = words.filter_map(|word| word.strip_prefix('j')?.parse().ok());
        all.extend(numbers.filter(|k| loaded.insert(*k)).map(load));
        all.push_str(line);
    }
    all
}

impl Shared {
    /// Refuses what no sweep can be of.
    fn check(&self) -> Result<(), Error> {
        let factor = self.lattice_consistency_factor;
        let positive = [
            ("the smoothing length", self.smoothing_length),
            ("the lattice consistency factor", factor),
        ];
        let wrong = positive
            .into_iter()
            .find(|own| !(own.1.is_finite() && own.1 > 0.0));
        let forces = self.body_force.iter().map(|own| ("the body force", *own));
        let endless = || forces.clone().find(|own| !own.1.is_finite());
        let must_be = if wrong.is_some() {
            "it must be finite and positive"
        } else {
            "it must be finite"
        };
        match wrong.or_else(endless) {
            None => Ok(()),
            Some((what, value)) => Err(Error::Value {
                what,
                value,
                must_be,
            }),
        }
    }
}

/// The text of a sweep over particles of some blocks. If it `reacts` it also writes the force of each block that is not the particle's
/// own, a column for each component.
fn body(
    pair: &PairRecord,
    (dimensions, width): (usize, usize),
    dialect: Dialect,
    (all_blocks, reacts): (usize, bool),
) -> String {
    let force = pair.writes.offset(Output::FORCE, dimensions);
    let has_force = pair.writes.contains(Output::FORCE);
    let apart = (reacts && has_force).then_some(all_blocks);
    let is_force = |k: usize| apart.is_some() && (force..force + dimensions).contains(&k);
    let (stride, sums) = (pair.reads.width(dimensions), pair.writes.width(dimensions));
    let x = pair.reads.offset(pair.listed, dimensions);
    let used = RefCell::new(BTreeSet::new());
    let emit = |letter, record| {
        emit_as(letter, record, dialect, &|k| {
            if k < stride {
                used.borrow_mut().insert(k);
            }
            match k.checked_sub(2 * stride) {
                None if k < stride => (format!("i{k}"), false),
                None => (format!("j{}", k - stride), true),
                Some(0) => ("mobile_i".into(), false),
                Some(1) => ("mobile_j".into(), true),
                Some(n) => (format!("settings[{}u]", n - 1), false),
            }
        })
    };
    let text = emit('t', &pair.record);
    let across = pair.across.as_ref().map(|record| emit('u', record));
    let mut used = used.into_inner();
    let far: Vec<_> = (0..dimensions)
        .filter(|_| pair.uniform)
        .map(|d| x + d)
        .collect();
    used.extend(&far);
    // Behind the reach stand the numbers that all share, then the blocks.
    let blocks = dimensions + 3;
    let load = |side: &str, k: usize| {
        let value = format!("records[{side} * {stride}u + {k}u]");
        dialect.declare(false, &format!("{side}{k}"), &value) + "\n"
    };
    let mut body = String::new();
    let mut add = |text: &str| body.push_str(text);
    for &k in &used {
        add(&load("i", k));
    }
    add(&dialect.index("cluster", &format!("i / {width}u * 2u")));
    let mobile = |at: &str| format!("settings[{blocks}u + {at}]");
    add(&(dialect.declare(false, "mobile_i", &mobile("clusters[cluster + 1u]")) + "\n"));
    add(&text.before);
    if let Some(across) = &across {
        add(&across.before);
    }
    for k in 0..sums {
        add(&dialect.variable(&format!("s{k}"), &dialect.constant(0.0)));
    }
    if let Some(blocks) = apart {
        add(&dialect.index("own_block", "clusters[cluster + 1u]"));
        add(&dialect.each("k", "0u", &format!("{}u", blocks * dimensions)));
        let zero = dialect.constant(0.0);
        add(&format!("reactions[k * scene.stride + i] = {zero};\n}}\n"));
    }
    add(&dialect.index("last_segment", "clusters[cluster + 2u]"));
    add(&dialect.each("segment", "clusters[cluster]", "last_segment"));
    for k in (0..sums).filter(|&k| is_force(k)) {
        add(&dialect.variable(&format!("f{k}"), &dialect.constant(0.0)));
    }
    add(&(dialect.declare(false, "mobile_j", &mobile("segments[segment * 3u + 2u]")) + "\n"));
    if across.is_some() {
        // The table of contacts stands behind that of blocks, and has a row for each block.
        let row = format!("{blocks}u + (clusters[cluster + 1u] + 1u) * {all_blocks}u");
        let at = format!("settings[{row} + segments[segment * 3u + 2u]]");
        let half = dialect.constant(0.5);
        add(&(dialect.declare(true, "opens", &format!("{at} > {half}")) + "\n"));
    }
    add(&dialect.index("end", "segments[segment * 3u + 1u]"));
    add(&dialect.each("entry", "segments[segment * 3u]", "end"));
    add(&dialect.index("j", "list[entry]"));
    for &k in &far {
        add(&load("j", k));
    }
    if !far.is_empty() {
        let squares = far.iter().map(|k| format!("(i{k} - j{k}) * (i{k} - j{k})"));
        let square = squares.collect::<Vec<_>>().join(" + ");
        add(&format!("if ({square} >= settings[0]) {{ continue; }}\n"));
    }
    let sum_up = |text: &Text| {
        let mut own = text.within.clone();
        for (k, value) in text.results.iter().enumerate() {
            let to = format!("{}{k}", if is_force(k) { "f" } else { "s" });
            let sum = if pair.maxima[k] {
                dialect.select(&format!("{value} > {to}"), value, &to)
            } else {
                format!("{to} + {value}")
            };
            own += &format!("{to} = {sum};\n");
        }
        late_loads(&own, &far, &|k| load("j", k))
    };
    match &across {
        Some(across) => add(&format!(
            "if (opens) {{\n{}}} else {{\n{}}}\n",
            sum_up(across),
            sum_up(&text)
        )),
        None => add(&sum_up(&text)),
    }
    add("}\n");
    for k in (0..sums).filter(|&k| is_force(k)) {
        add(&format!("s{k} = s{k} + f{k};\n"));
    }
    if apart.is_some() {
        add(&dialect.index("block", "segments[segment * 3u + 2u]"));
        add("if (block != own_block) {\n");
        for d in 0..dimensions {
            let at = format!("reactions[(block * {dimensions}u + {d}u) * scene.stride + i]");
            add(&format!("{at} = {at} + f{};\n", force + d));
        }
        add("}\n");
    }
    add("}\n");
    for k in 0..sums {
        add(&format!("rows[i * {sums}u + {k}u] = s{k};\n"));
    }
    body
}

impl PairKernel {
    /// Compiles a sweep in some dimensions over lists with `width` particles a cluster.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if the pair is not of so many dimensions, or a cluster has no particle; [`Error::NoDouble`] if the adapter has no
    /// `f64`, [`Error::Kernel`] if its driver does not take the text.
    pub fn new(
        device: &Device,
        name: &str,
        pair: &PairRecord,
        (dimensions, width): (usize, usize),
        precision: Precision,
    ) -> Result<Self, Error> {
        let fits = (1..=3).contains(&dimensions);
        Error::unless(fits, "dimensions, from one to three", [dimensions, 3])?;
        Error::unless(width > 0, "particles of a cluster", [width, 1])?;
        let (stride, sums) = (pair.reads.width(dimensions), pair.writes.width(dimensions));
        let (read, made) = (inputs(&pair.record), pair.record.results().len());
        let there = 2 * stride + PairRecord::shared(dimensions);
        Error::unless(read <= there, "numbers of a pair", [there, read])?;
        Error::unless(made == sums, "sums of a pair", [made, sums])?;
        let shape = (dimensions, width);
        Ok(Self {
            kernel: sweep_of_run(device, name, pair, shape, precision, (0, false))?,
            stride,
            sums,
            support: pair.support,
            dimensions,
            width,
            precision,
        })
    }

    /// The text of the kernel in a language.
    #[must_use]
    pub fn source(
        pair: &PairRecord,
        (dimensions, width): (usize, usize),
        dialect: Dialect,
    ) -> String {
        let frame = Frame {
            dialect,
            name: "sweep",
            buffers: &BUFFERS,
        };
        let body = body(pair, (dimensions, width), dialect, (0, false));
        frame.source(&body, THREADS)
    }

    /// The sums of the first `count` particles, side by side for each. `records` has the fields that the sweep
    /// [reads](PairRecord::reads), side by side for each particle, those of images behind.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if records, lists or the body force are of another size; [`Error::Value`] for a smoothing length or factor that is
    /// not positive, or a body force that is no number; [`Error::TooLarge`] and [`Error::OutOfMemory`] if they do not fit;
    /// [`Error::Lost`] if the device fails, [`Error::OtherDevice`] for one of another device.
    pub fn run(
        &self,
        device: &Device,
        (records, count): (&[f64], usize),
        lists: &PairLists,
        shared: &Shared,
    ) -> Result<Vec<f64>, Error> {
        device.owns(&self.kernel)?;
        let size = |what, found, wanted| Error::unless(found == wanted, what, [found, wanted]);
        let force = shared.body_force.len();
        size("numbers of the body force", force, self.dimensions)?;
        shared.check()?;
        size(
            "particles of a cluster of the lists",
            lists.width,
            self.width,
        )?;
        let named = lists.segments.iter().skip(2).step_by(3).max();
        let named = named.map_or(0, |block| *block as usize + 1);
        let blocks = lists.mobile.len();
        Error::unless(named <= blocks, "blocks of the lists", [blocks, named])?;
        let (listed, clusters) = (lists.clusters.len() / 2 - 1, count.div_ceil(lists.width));
        size("clusters that have lists", listed, clusters)?;
        let last = lists.list.iter().max().map_or(0, |last| *last as usize + 1);
        let (there, wanted) = (records.len(), last.max(count) * self.stride);
        Error::unless(there >= wanted, "numbers of records", [there, wanted])?;
        let all = settings(self.support, shared, &lists.mobile);
        let numbers = |all: &[f64]| pack(all.iter().copied(), self.precision);
        let records = device.upload("the records of particles", &numbers(records))?;
        let shared = device.upload("what pairs share", &numbers(&all))?;
        let indices = |all: &[u32]| device.upload("the lists of neighbours", &pack_indices(all));
        let clusters = indices(&lists.clusters)?;
        let segments = indices(&lists.segments)?;
        let list = indices(&lists.list)?;
        let bytes = count * self.sums * self.precision.bytes();
        let rows = device.room("the sums", bytes)?;
        let buffers = [&records, &shared, &clusters, &segments, &list, &rows];
        device.launch([&device.bind(&self.kernel, &buffers, count)]);
        Ok(unpack(&device.download(&rows, 0, bytes)?, self.precision))
    }
}
