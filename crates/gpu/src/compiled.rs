//! The step program of a simulation as kernels, with the memory that they work on.
//! Kernels are made once; they are bound anew when lists have another size.

use crate::device::{Bound, Device, Extent, Kernel};
use crate::fuse::{Around, Layout, by_run};
use crate::kernel::{Array, Frame, pack_indices};
use crate::pairs::sweep_of_run;
use crate::reduce::{Find, Reduction};
use crate::{Dialect, Error, PairLists, Part, Precision};
use meshfree::particles::{Field, Fields, Outputs, Shape};
use meshfree::simulation::device::{Action, PointStep, Program, SweepStep};
use std::ops::Range;

/// A piece of a list of the program.
#[derive(Clone, Copy, Debug)]
pub enum Piece {
    /// Walls, images and lists.
    Lists,
    /// A kernel, by its number.
    Kernel(usize),
}

/// What a kernel is bound to.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Points,
    Pack,
    PackImages,
    Sweep { of_rates: bool, of_approach: bool },
}

#[derive(Debug)]
struct Own {
    kernel: Kernel,
    kind: Kind,
    slots: Range<usize>,
}

/// The lists of a program, piece by piece.
#[derive(Debug, Default)]
pub struct Lists {
    pub evaluation: Vec<Piece>,
    pub kick: Vec<Piece>,
    pub drift_begins: Vec<Piece>,
    pub drift_middle: Vec<Piece>,
    pub drift_ends: Vec<Piece>,
    pub shift: Vec<Piece>,
    pub predict: Vec<Piece>,
    pub restore: Vec<Piece>,
    pub vote: Vec<Piece>,
    pub approach: Vec<Piece>,
    pub moved: Vec<Piece>,
}

/// The memory of a run on the device.
#[derive(Debug)]
pub struct Memory {
    pub state: wgpu::Buffer,
    pub rates: wgpu::Buffer,
    pub sums: wgpu::Buffer,
    pub shared: wgpu::Buffer,
    pub walls: wgpu::Buffer,
    pub columns: wgpu::Buffer,
    pub records: wgpu::Buffer,
    pub settings: wgpu::Buffer,
    pub approach: wgpu::Buffer,
    pub reactions: wgpu::Buffer,
    pub between: [wgpu::Buffer; 2],
    /// What votes, with forces between blocks, displacements and approaching pairs have come to.
    pub votes: wgpu::Buffer,
    pub moves: wgpu::Buffer,
    pub meetings: wgpu::Buffer,
    clusters: wgpu::Buffer,
    segments: wgpu::Buffer,
    list: wgpu::Buffer,
    /// Of which slot each image is, and its shift.
    images: wgpu::Buffer,
    shifts: wgpu::Buffer,
    /// How many images the records have room for.
    imaged: usize,
}

/// The sizes that do not change in a run.
#[derive(Clone, Debug)]
pub struct Sizes {
    pub layout: Layout,
    pub rates: Outputs,
    /// Bodies and walls, and the slots of each body without repeats.
    pub blocks: usize,
    pub bodies: Vec<Range<usize>>,
    pub cluster: usize,
    /// Whether there are images.
    pub has_images: bool,
    /// Numbers that all particles share, and of each pair.
    pub shared: usize,
    pub settings: usize,
}

/// Kernels of a program, and what they are bound to.
#[derive(Debug)]
pub struct Compiled {
    kernels: Vec<Own>,
    bound: Vec<Bound>,
    pub lists: Lists,
    pub vote: Reduction,
    pub moved: Reduction,
    pub approach: Reduction,
    pub forces: Reduction,
    pub of_vote: Vec<Bound>,
    pub of_moved: Vec<Bound>,
    pub of_approach: Vec<Bound>,
    pub support: f64,
    widths: [usize; 2],
    precision: Precision,
}

const PACK: [Array; 2] = [Array::numbers("state"), Array::numbers("records").written()];

fn pack(
    reads: Fields,
    layout: &Layout,
    dialect: Dialect,
    device: &Device,
) -> Result<Kernel, Error> {
    let (d, mut at, mut body) = (layout.dimensions, 0, String::new());
    let stride = reads.width(d);
    for field in reads.iter() {
        for k in 0..field.components(d) {
            let from = layout.field(field, k);
            body += &format!("records[i * {stride}u + {at}u] = state[{from}u + i];\n");
            at += 1;
        }
    }
    let frame = Frame {
        dialect,
        name: "pack",
        buffers: &PACK,
    };
    let part = Part {
        kind: "records",
        name: "fields".into(),
    };
    device.kernel(&part, &frame, &body)
}

const PACK_IMAGES: [Array; 4] = [
    Array::numbers("state"),
    Array::indices("images"),
    Array::numbers("shifts"),
    Array::numbers("records").written(),
];

/// Records of images, which are shifted; what rounding loses of their places goes where that is kept.
fn pack_images(
    reads: Fields,
    layout: &Layout,
    dialect: Dialect,
    device: &Device,
) -> Result<Kernel, Error> {
    let (d, mut at) = (layout.dimensions, 0);
    let stride = reads.width(d);
    let mut body = dialect.index("source", "images[n]");
    for field in reads.iter() {
        for k in 0..field.components(d) {
            let from = format!("state[{}u + source]", layout.field(field, k));
            let to = format!("records[i * {stride}u + {at}u]");
            at += 1;
            if field.shape() == Shape::Point {
                let [x, by, sum, part] = ["x", "by", "sum", "part"].map(|own| {
                    let name = field.name();
                    format!("{own}_{name}_{k}")
                });
                let shift = format!("shifts[{k}u * scene.count + n]");
                for (name, value) in [
                    (&x, from),
                    (&by, shift),
                    (&sum, dialect.opaque(&format!("{x} + {by}"))),
                    (&part, dialect.opaque(&format!("{sum} - {x}"))),
                ] {
                    body += &(dialect.declare(false, name, &value) + "\n");
                }
                body += &format!("{to} = {sum};\n");
            } else if field == Field::POSITION_RESIDUAL {
                let [x, by, sum, part] = ["x", "by", "sum", "part"].map(|own| {
                    let name = Field::POSITION.name();
                    format!("{own}_{name}_{k}")
                });
                body += &format!("{to} = {from} + (({x} - ({sum} - {part})) + ({by} - {part}));\n");
            } else {
                body += &format!("{to} = {from};\n");
            }
        }
    }
    let frame = Frame {
        dialect,
        name: "pack_images",
        buffers: &PACK_IMAGES,
    };
    let part = Part {
        kind: "records",
        name: "images".into(),
    };
    device.kernel(&part, &frame, &body)
}

/// Makes kernels of the lists of a program.
struct Compiler<'a> {
    device: &'a Device,
    sizes: &'a Sizes,
    precision: Precision,
    kernels: Vec<Own>,
    support: f64,
    widths: [usize; 2],
}

impl Compiler<'_> {
    fn own(&mut self, kernel: Kernel, kind: Kind, slots: Range<usize>) -> Piece {
        self.kernels.push(Own {
            kernel,
            kind,
            slots,
        });
        Piece::Kernel(self.kernels.len() - 1)
    }

    fn points(
        &mut self,
        steps: &mut Vec<&PointStep>,
        sums: Outputs,
        pieces: &mut Vec<Piece>,
    ) -> Result<(), Error> {
        let layout = &self.sizes.layout;
        for (slots, own) in by_run(steps) {
            let around = Around {
                layout,
                rates: self.sizes.rates,
                sums,
                dialect: Dialect::wgsl(self.precision),
            };
            let kernel = around.kernel(self.device, &own)?;
            pieces.push(self.own(kernel, Kind::Points, slots));
        }
        steps.clear();
        Ok(())
    }

    fn sweep(&mut self, sweep: &SweepStep, of_approach: bool) -> Result<Vec<Piece>, Error> {
        let (device, sizes, precision) = (self.device, self.sizes, self.precision);
        let (layout, pair) = (&sizes.layout, &sweep.pair);
        let d = layout.dimensions;
        let dialect = Dialect::wgsl(precision);
        let packing = pack(pair.reads, layout, dialect, device)?;
        let blocks = sweep.of_rates.then_some(sizes.blocks);
        let shape = (d, sizes.cluster);
        let kernel = sweep_of_run(device, sweep.name, pair, shape, precision, blocks)?;
        self.support = pair.support;
        let widths = [pair.reads.width(d), pair.writes.width(d)];
        self.widths = [0, 1].map(|k| self.widths[k].max(widths[k]));
        let kind = Kind::Sweep {
            of_rates: sweep.of_rates,
            of_approach,
        };
        let mut pieces = vec![self.own(packing, Kind::Pack, 0..layout.slots)];
        if sizes.has_images {
            let packing = pack_images(pair.reads, layout, dialect, device)?;
            pieces.push(self.own(packing, Kind::PackImages, 0..0));
        }
        pieces.push(self.own(kernel, kind, sweep.slots.clone()));
        Ok(pieces)
    }

    fn list(&mut self, actions: &[Action], of_approach: bool) -> Result<Vec<Piece>, Error> {
        let (mut pieces, mut steps, mut sums) = (Vec::new(), Vec::new(), Outputs::NONE);
        for action in actions {
            match action {
                Action::Points(step) => steps.push(step),
                Action::Lists => {
                    self.points(&mut steps, sums, &mut pieces)?;
                    pieces.push(Piece::Lists);
                }
                Action::Sweep(sweep) => {
                    self.points(&mut steps, sums, &mut pieces)?;
                    pieces.extend(self.sweep(sweep, of_approach)?);
                    if !sweep.of_rates {
                        sums = sweep.pair.writes;
                    }
                }
            }
        }
        self.points(&mut steps, sums, &mut pieces)?;
        Ok(pieces)
    }
}

impl Compiled {
    pub fn new(
        device: &Device,
        program: &Program,
        sizes: &Sizes,
        precision: Precision,
    ) -> Result<Self, Error> {
        device.can(precision)?;
        let mut own = Compiler {
            device,
            sizes,
            precision,
            kernels: Vec::new(),
            support: 0.0,
            widths: [1, 1],
        };
        let lists = Lists {
            evaluation: own.list(&program.evaluation, false)?,
            kick: own.list(&program.kick, false)?,
            drift_begins: own.list(&program.drift_begins, false)?,
            drift_middle: own.list(&program.drift_middle, false)?,
            drift_ends: own.list(&program.drift_ends, false)?,
            shift: own.list(&program.shift, false)?,
            predict: own.list(&program.predict, false)?,
            restore: own.list(&program.restore, false)?,
            vote: own.list(&program.vote, false)?,
            approach: own.list(&program.approach, true)?,
            moved: own.list(&program.moved, false)?,
        };
        let d = sizes.layout.dimensions;
        let ranges = |first: usize| {
            let least = (first..first + d).map(Find::Least);
            least.chain((first..first + d).map(Find::Most))
        };
        let find = |finds: Vec<Find>| Reduction::new(device, &finds, precision);
        let votes = [Find::LeastAt(0, 1), Find::Most(2)];
        Ok(Self {
            vote: find(votes.into_iter().chain(ranges(3)).collect())?,
            moved: find([Find::Most(0)].into_iter().chain(ranges(1)).collect())?,
            approach: find(vec![Find::LeastAt(0, 0), Find::LeastAt(1, 1)])?,
            forces: find((0..sizes.blocks * d).map(Find::Sum).collect())?,
            of_vote: Vec::new(),
            of_moved: Vec::new(),
            of_approach: Vec::new(),
            bound: Vec::new(),
            kernels: own.kernels,
            lists,
            support: own.support,
            widths: own.widths,
            precision,
        })
    }

    /// Room for all that a run holds, with its lists.
    pub fn room(&self, device: &Device, sizes: &Sizes) -> Result<Memory, Error> {
        let precision = self.precision;
        let layout = &sizes.layout;
        let (d, slots) = (layout.dimensions, layout.slots);
        let numbers = |what, count: usize| device.room(what, count * precision.bytes());
        let all = [&self.vote, &self.moved, &self.approach, &self.forces];
        let between = all.map(|own| own.between(slots)).into_iter().max();
        let between = || numbers("what levels of sums pass on", between.unwrap_or(1));
        let walls = (2 * d + d * d) * (slots - layout.mobile);
        let none = || device.room("the lists of neighbours", 0);
        let votes = self.vote.outputs + sizes.bodies.len() * self.forces.outputs;
        Ok(Memory {
            state: numbers("the columns of particles", layout.numbers())?,
            rates: numbers("the rates", sizes.rates.width(d) * slots)?,
            sums: numbers("the sums", self.widths[1] * slots)?,
            shared: numbers("what particles share", sizes.shared)?,
            walls: numbers("what is known of walls", walls)?,
            columns: numbers("what is voted on", Program::columns(d) * slots)?,
            records: numbers("the records of particles", self.widths[0] * slots)?,
            settings: numbers("what pairs share", sizes.settings)?,
            approach: numbers("what pairs share", sizes.settings)?,
            reactions: numbers("forces between blocks", sizes.blocks * d * slots)?,
            between: [between()?, between()?],
            votes: numbers("votes", votes)?,
            moves: numbers("displacements", self.moved.outputs)?,
            meetings: numbers("approaching pairs", self.approach.outputs)?,
            clusters: none()?,
            segments: none()?,
            list: none()?,
            images: none()?,
            shifts: none()?,
            imaged: 0,
        })
    }

    /// Takes lists to the device with the images that they have, and binds all kernels.
    pub fn bind(
        &mut self,
        device: &Device,
        memory: &mut Memory,
        sizes: &Sizes,
        (lists, images, shifts): (&PairLists, &[u32], &[u8]),
    ) -> Result<(), Error> {
        let indices = |all: &[u32]| device.upload("the lists of neighbours", &pack_indices(all));
        memory.clusters = indices(&lists.clusters)?;
        memory.segments = indices(&lists.segments)?;
        memory.list = indices(&lists.list)?;
        memory.images = indices(images)?;
        memory.shifts = device.upload("the images of particles", shifts)?;
        if images.len() > memory.imaged {
            memory.imaged = images.len() + images.len() / 8;
            let count = self.widths[0] * (sizes.layout.slots + memory.imaged);
            let bytes = count * self.precision.bytes();
            memory.records = device.room("the records of particles", bytes)?;
        }
        let m = &*memory;
        let slots = sizes.layout.slots;
        let bind = |own: &Own| {
            let buffers = match own.kind {
                Kind::Points => vec![&m.state, &m.rates, &m.sums, &m.shared, &m.walls, &m.columns],
                Kind::Pack => vec![&m.state, &m.records],
                Kind::PackImages => vec![&m.state, &m.images, &m.shifts, &m.records],
                Kind::Sweep {
                    of_rates,
                    of_approach,
                } => {
                    let settings = if of_approach {
                        &m.approach
                    } else {
                        &m.settings
                    };
                    let mut all = vec![&m.records, settings, &m.clusters, &m.segments, &m.list];
                    all.push(if of_rates { &m.rates } else { &m.sums });
                    all.extend(of_rates.then_some(&m.reactions));
                    all
                }
            };
            let slots_of = match own.kind {
                Kind::PackImages => slots..slots + images.len(),
                _ => own.slots.clone(),
            };
            let extent = Extent {
                count: slots_of.len(),
                first: slots_of.start,
                stride: slots,
                ..Extent::default()
            };
            device.bind_over(&own.kernel, &buffers, extent)
        };
        self.bound = self.kernels.iter().map(bind).collect();
        let between = [&m.between[0], &m.between[1]];
        let columns = (&m.columns, slots);
        let over = |own: &Reduction, count, answers| {
            own.bind(device, columns, (0, count), between, (answers, 0))
        };
        self.of_vote = over(&self.vote, slots, &m.votes);
        self.of_moved = over(&self.moved, slots, &m.moves);
        self.of_approach = over(&self.approach, sizes.layout.mobile, &m.meetings);
        for (k, body) in sizes.bodies.iter().enumerate() {
            let target = self.vote.outputs + k * self.forces.outputs;
            self.of_vote.extend(self.forces.bind(
                device,
                (&m.reactions, slots),
                (body.start, body.len()),
                between,
                (&m.votes, target),
            ));
        }
        Ok(())
    }

    /// The kernels of some pieces without those that bring lists up to date.
    pub fn of(&self, pieces: &[Piece]) -> Vec<&Bound> {
        let bound = pieces.iter().filter_map(|piece| match piece {
            Piece::Kernel(k) => Some(&self.bound[*k]),
            Piece::Lists => None,
        });
        bound.collect()
    }
}
