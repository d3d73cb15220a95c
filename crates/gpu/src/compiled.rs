//! The kernels of a step program with the memory that they work on.
//! Kernels are made once; they are bound anew when lists have another size.

use crate::compile::{Compiler, Kind, Lists, Own, Piece, Repeat, Sizes};
use crate::device::{Bound, Buffer, Device, Extent};
use crate::kernel::pack_indices;
use crate::reduce::{Find, Reduction};
use crate::{Error, PairLists, Precision};
use meshfree::particles::Fields;
use meshfree::simulation::device::{Array, Program};

/// The memory of a run on the device.
#[derive(Debug)]
pub struct Memory {
    pub state: Buffer,
    pub rates: Buffer,
    pub sums: Buffer,
    pub shared: Buffer,
    pub walls: Buffer,
    pub columns: Buffer,
    pub records: Buffer,
    /// Records that are kept for the work of kicks.
    pub kept: Buffer,
    pub settings: Buffer,
    pub approach: Buffer,
    pub reactions: Buffer,
    pub between: [Buffer; 2],
    /// What votes, with forces between blocks, displacements and approaching pairs have come to.
    pub votes: Buffer,
    pub moves: Buffer,
    pub meetings: Buffer,
    pub clusters: Buffer,
    pub segments: Buffer,
    pub list: Buffer,
    /// Of which slot each image is and by which transform, and all transforms.
    images: Buffer,
    transforms: Buffer,
    /// How many images the records have room for.
    imaged: usize,
}

/// Kernels of a program, and what they are bound to.
#[derive(Debug)]
pub struct Compiled {
    kernels: Vec<Own>,
    bound: Vec<Bound>,
    pub lists: Lists,
    pub repeats: Vec<Repeat>,
    /// Whether any particle has not settled.
    pub open: Reduction,
    pub vote: Reduction,
    pub moved: Reduction,
    pub approach: Reduction,
    pub forces: Reduction,
    /// Numbers of a record, and of a sum.
    pub widths: [usize; 2],
    /// What records that are kept have.
    pub kept: Fields,
    precision: Precision,
}

impl Memory {
    /// An array by what the host calls it.
    pub fn of(&self, array: Array) -> &Buffer {
        match array {
            Array::State => &self.state,
            Array::Rates => &self.rates,
            Array::Columns => &self.columns,
            Array::Walls => &self.walls,
            Array::Kept => &self.kept,
            Array::Transforms => &self.transforms,
            Array::Settings => &self.settings,
            Array::Approach => &self.approach,
        }
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
        let mut own = Compiler::new(device, sizes, precision);
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
            reacts: own.list(&program.reacts, false)?,
            hold: own.list(&program.hold, false)?,
            states: own.states(program)?,
        };
        let d = sizes.layout.dimensions;
        let ranges = |first: usize| {
            let least = (first..first + d).map(Find::Least);
            least.chain((first..first + d).map(Find::Most))
        };
        let find = |finds: Vec<Find>| Reduction::new(device, &finds, precision);
        let votes = [
            Find::LeastAt(0, 1),
            Find::Most(2),
            Find::Least(3 + d),
            Find::Most(4 + d),
        ];
        let moves = [Find::Most(0), Find::Most(1 + d)];
        Ok(Self {
            vote: find(votes.into_iter().chain(ranges(3)).collect())?,
            moved: find(moves.into_iter().chain(ranges(1)).collect())?,
            open: find(vec![Find::Most(Program::common(d) + 1)])?,
            repeats: own.repeats,
            approach: find(vec![Find::LeastAt(0, 0), Find::LeastAt(1, 1)])?,
            forces: find((0..sizes.blocks * d).map(Find::Sum).collect())?,
            bound: Vec::new(),
            kernels: own.kernels,
            lists,
            // Rates go there, too, when particles are sorted.
            widths: [own.widths[0].max(sizes.rates.width(d)), own.widths[1]],
            kept: own.kept,
            precision,
        })
    }

    /// Room for all that a run holds, with its lists.
    pub fn room(&self, device: &Device, sizes: &Sizes, program: &Program) -> Result<Memory, Error> {
        let precision = self.precision;
        let layout = &sizes.layout;
        let (d, slots) = (layout.dimensions, layout.slots);
        let numbers = |what, count: usize| device.room(what, count * precision.bytes());
        let all = [
            &self.vote,
            &self.moved,
            &self.approach,
            &self.forces,
            &self.open,
        ];
        let between = all.map(|own| own.between(slots)).into_iter().max();
        let between = || numbers("what levels of sums pass on", between.unwrap_or(1));
        let walls = (2 * d + d * d) * (slots - layout.mobile);
        let none = || device.room("the lists of neighbours", 0);
        let votes = self.vote.outputs + program.feels.len() * self.forces.outputs;
        Ok(Memory {
            state: numbers("the columns of particles", layout.numbers())?,
            rates: numbers("the rates", sizes.rates.width(d) * slots)?,
            sums: numbers("the sums", self.widths[1] * slots)?,
            shared: numbers("what particles share", sizes.shared)?,
            walls: numbers("what is known of walls", walls)?,
            columns: numbers("what is voted on", program.columns * slots)?,
            records: numbers("the records of particles", self.widths[0] * slots)?,
            kept: numbers("the records of particles", self.kept.width(d) * slots)?,
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
            transforms: none()?,
            imaged: 0,
        })
    }

    /// Takes lists of the host, if any, to the device with the images that they have, and binds all kernels.
    pub fn bind(
        &mut self,
        device: &Device,
        memory: &mut Memory,
        (sizes, program): (&Sizes, &Program),
        (lists, images, transforms): (Option<&PairLists>, &[u32], &[u8]),
    ) -> Result<(), Error> {
        let indices = |all: &[u32]| device.upload("the lists of neighbours", &pack_indices(all));
        if let Some(lists) = lists {
            memory.clusters = indices(&lists.clusters)?;
            memory.segments = indices(&lists.segments)?;
            memory.list = indices(&lists.list)?;
        }
        memory.images = indices(images)?;
        memory.transforms = device.upload("the images of particles", transforms)?;
        let (count, slots) = (images.len() / 2, sizes.layout.slots);
        if count > memory.imaged {
            memory.imaged = count + count / 8;
            let room = |width: usize| {
                let bytes = width * (slots + memory.imaged) * self.precision.bytes();
                device.room("the records of particles", bytes)
            };
            memory.records = room(self.widths[0])?;
            memory.kept = room(self.kept.width(sizes.layout.dimensions))?;
        }
        let m = &*memory;
        let records = |kept| if kept { &m.kept } else { &m.records };
        let bind = |own: &Own| {
            let buffers = match own.kind {
                Kind::Settle => vec![&m.columns],
                Kind::Points => vec![&m.state, &m.rates, &m.sums, &m.shared, &m.walls, &m.columns],
                Kind::Pack { kept } => vec![&m.state, records(kept)],
                Kind::PackImages { kept } => {
                    vec![&m.state, &m.images, &m.transforms, records(kept)]
                }
                Kind::Sweep {
                    of_rates,
                    of_kept,
                    of_approach,
                    reacts,
                } => {
                    let settings = [&m.settings, &m.approach][usize::from(of_approach)];
                    let records = records(of_kept);
                    let mut all = vec![records, settings, &m.clusters, &m.segments, &m.list];
                    all.push(if of_rates { &m.rates } else { &m.sums });
                    all.extend(reacts.then_some(&m.reactions));
                    all
                }
            };
            let slots_of = match own.kind {
                Kind::PackImages { .. } => slots..slots + count,
                _ => own.slots.clone(),
            };
            let extent = Extent {
                stride: slots,
                ..Extent::of(slots_of)
            };
            device.bind_over(&own.kernel, &buffers, extent)
        };
        self.bound = self.kernels.iter().map(bind).collect();
        let between = [&m.between[0], &m.between[1]];
        let columns = (&m.columns, slots);
        let over = |own: &Reduction, count, answers| {
            own.bind(device, columns, (0, count), between, (answers, 0))
        };
        self.vote.bound = over(&self.vote, slots, &m.votes);
        self.moved.bound = over(&self.moved, slots, &m.moves);
        if !self.repeats.is_empty() {
            self.open.bound = over(&self.open, sizes.layout.mobile, &m.moves);
        }
        self.approach.bound = over(&self.approach, sizes.layout.mobile, &m.meetings);
        for (k, (_, body)) in program.feels.iter().enumerate() {
            let target = self.vote.outputs + k * self.forces.outputs;
            self.vote.bound.extend(self.forces.bind(
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
            Piece::Lists | Piece::Repeat(_) => None,
        });
        bound.collect()
    }
}
