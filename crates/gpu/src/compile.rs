//! The step program of a simulation as kernels.
//! Single particles are joined to one kernel between two sweeps; a sweep is preceded by what packs its records.

use crate::device::{Device, Kernel};
use crate::fuse::Around;
use crate::kernel::Array;
use crate::pairs::sweep_of_run;
use crate::{Dialect, Error, Precision, emit};
use meshfree::particles::{Fields, Outputs};
use meshfree::scalar::Record;
use meshfree::simulation::device::{Action, Layout, PointStep, Program, RepeatStep, SweepStep};
use std::ops::Range;

/// A piece of a list of the program.
#[derive(Clone, Copy, Debug)]
pub enum Piece {
    /// Walls, images and lists.
    Lists,
    /// A kernel, by its number.
    Kernel(usize),
    /// What is repeated, by its number.
    Repeat(usize),
}

/// What is repeated, as [`RepeatStep`] says.
#[derive(Debug)]
pub struct Repeat {
    pub times: usize,
    pub begin: Vec<Piece>,
    pub pieces: Vec<Piece>,
    pub end: Vec<Piece>,
}

/// What a kernel is bound to.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    Points,
    /// Which particles have settled.
    Settle,
    /// Into records that are kept, or into those of the next sweep.
    Pack {
        kept: bool,
    },
    PackImages {
        kept: bool,
    },
    Sweep {
        of_rates: bool,
        of_kept: bool,
        of_approach: bool,
        reacts: bool,
    },
}

#[derive(Debug)]
pub(crate) struct Own {
    pub kernel: Kernel,
    pub kind: Kind,
    pub slots: Range<usize>,
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
    pub reacts: Vec<Piece>,
    pub hold: Vec<Piece>,
    /// What happens to the states that an integrator keeps, as `StateStep::lists` has it.
    pub states: Vec<[Vec<Piece>; 4]>,
}

/// The sizes that do not change in a run.
#[derive(Clone, Debug)]
pub struct Sizes {
    pub layout: Layout,
    pub rates: Outputs,
    /// Bodies and walls.
    pub blocks: usize,
    pub cluster: usize,
    /// Numbers that all particles share, and of each pair.
    pub shared: usize,
    pub settings: usize,
}

/// Kernels that write some fields of records of `reads`: of particles, and of images where there are any.
fn pack(
    (reads, fields, image): (Fields, Fields, Option<&Record>),
    layout: &Layout,
    dialect: Dialect,
    device: &Device,
) -> Result<(Kernel, Option<Kernel>), Error> {
    let d = layout.dimensions;
    let kernel = |name: &str, buffers: &[Array], body: &str| {
        device.kernel(("records", name), (dialect, buffers), body)
    };
    let components = fields
        .iter()
        .flat_map(|field| (0..field.components(d)).map(move |k| (field, k)));
    // Where each number comes from, and where it goes.
    let stride = reads.width(d);
    let places = components.map(|(field, k)| {
        let to = reads.offset(field, d) + k;
        (
            layout.field(field, k),
            format!("records[i * {stride}u + {to}u]"),
        )
    });
    let places: Vec<_> = places.collect();
    let state = Array::numbers("state");
    let records = Array::numbers("records").written();
    let copies = places
        .iter()
        .map(|(from, to)| format!("{to} = state[{from}u + i];\n"));
    let own = kernel("fields", &[state, records], &copies.collect::<String>())?;
    let Some(image) = image else {
        return Ok((own, None));
    };
    let body = transformed(&places, image, (d, dialect));
    let (images, transforms) = (Array::indices("images"), Array::numbers("transforms"));
    let of_images = kernel("images", &[state, images, transforms, records], &body)?;
    Ok((own, Some(of_images)))
}

/// The text that takes numbers of the particle `images[n * 2]` from columns of the state through the transform `images[n * 2 + 1]`, by a
/// record. Each stands where a column starts, and goes to a place.
pub(crate) fn transformed(
    places: &[(usize, String)],
    image: &Record,
    (d, dialect): (usize, Dialect),
) -> String {
    let by = d * d + 2 * d;
    let mut body = dialect.index("source", "images[n * 2u]");
    body += &dialect.index("by", &format!("images[n * 2u + 1u] * {by}u"));
    let text = emit(image, dialect, &|k| {
        let name = match places.get(k) {
            Some((from, _)) => format!("state[{from}u + source]"),
            None => format!("transforms[by + {}u]", k - places.len()),
        };
        (name, false)
    });
    body += &text.before;
    for ((_, to), value) in places.iter().zip(&text.results) {
        body += &format!("{to} = {value};\n");
    }
    body
}

/// Makes kernels of the lists of a program.
pub(crate) struct Compiler<'a> {
    device: &'a Device,
    sizes: &'a Sizes,
    precision: Precision,
    pub kernels: Vec<Own>,
    pub repeats: Vec<Repeat>,
    pub widths: [usize; 2],
    pub kept: Fields,
}

impl<'a> Compiler<'a> {
    pub fn new(device: &'a Device, sizes: &'a Sizes, precision: Precision) -> Self {
        Self {
            device,
            sizes,
            precision,
            kernels: Vec::new(),
            repeats: Vec::new(),
            widths: [1, 1],
            kept: Fields::NONE,
        }
    }

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
        let joined = PointStep::joined(steps);
        let joined = joined.map_err(|(name, error)| Error::recorded("steps", &name, &error))?;
        for step in joined {
            let around = Around {
                layout,
                rates: self.sizes.rates,
                sums,
                dialect: self.device.dialect(self.precision),
            };
            let kernel = around.kernel(self.device, &step)?;
            pieces.push(self.own(kernel, Kind::Points, step.slots));
        }
        steps.clear();
        Ok(())
    }

    fn sweep(&mut self, sweep: &SweepStep, of_approach: bool) -> Result<Vec<Piece>, Error> {
        let (device, sizes, precision) = (self.device, self.sizes, self.precision);
        let (d, pair) = (sizes.layout.dimensions, &sweep.pair);
        let reacts = sweep.of_rates || sweep.of_walls;
        let shape = (d, sizes.cluster);
        let of = (sizes.blocks, reacts);
        let kernel = sweep_of_run(device, sweep.name, pair, shape, precision, of)?;
        let widths = [pair.reads.width(d), pair.writes.width(d)];
        self.widths = [0, 1].map(|k| self.widths[k].max(widths[k]));
        let kind = Kind::Sweep {
            of_rates: sweep.of_rates,
            of_kept: sweep.of_kept,
            of_approach,
            reacts,
        };
        let mut pieces = Vec::new();
        if !sweep.of_kept {
            pieces = self.packed((pair.reads, pair.reads, sweep.image.as_ref()), false)?;
        }
        pieces.push(self.own(kernel, kind, sweep.slots.clone()));
        Ok(pieces)
    }

    fn packed(
        &mut self,
        of: (Fields, Fields, Option<&Record>),
        kept: bool,
    ) -> Result<Vec<Piece>, Error> {
        let layout = &self.sizes.layout;
        let dialect = self.device.dialect(self.precision);
        let (own, images) = pack(of, layout, dialect, self.device)?;
        let mut pieces = vec![self.own(own, Kind::Pack { kept }, 0..layout.slots)];
        pieces.extend(images.map(|own| self.own(own, Kind::PackImages { kept }, 0..0)));
        if kept {
            self.kept = of.0;
        }
        Ok(pieces)
    }

    fn repeat(&mut self, repeat: &RepeatStep) -> Result<Piece, Error> {
        let begin = self.list(&repeat.begin, false)?;
        let mut pieces = self.list(&repeat.actions, false)?;
        let end = self.list(&repeat.end, false)?;
        for run in &repeat.runs {
            let kernel = self.settle(repeat, run)?;
            pieces.push(self.own(kernel, Kind::Settle, run.clone()));
        }
        let times = repeat.times;
        self.repeats.push(Repeat {
            times,
            begin,
            pieces,
            end,
        });
        Ok(Piece::Repeat(self.repeats.len() - 1))
    }

    /// A one in the column behind that of changes while any particle of a piece has changed by the tolerance or more.
    fn settle(&self, repeat: &RepeatStep, run: &Range<usize>) -> Result<Kernel, Error> {
        let dialect = self.device.dialect(self.precision);
        let (piece, slots) = (repeat.piece, self.sizes.layout.slots);
        let changes = repeat.changes * slots;
        let mut body = dialect.index("first", &format!("i - (i - {}u) % {piece}u", run.start));
        body += &dialect.variable("open", &dialect.constant(0.0));
        let end = format!("min(first + {piece}u, {}u)", run.end);
        body += &dialect.each("k", "first", &end);
        let tolerance = dialect.constant(repeat.tolerance);
        let one = dialect.constant(1.0);
        body += &format!("if (columns[{changes}u + k] >= {tolerance}) {{ open = {one}; }}\n}}\n");
        body += &format!("columns[{}u + i] = open;\n", changes + slots);
        let buffers = [Array::numbers("columns").written()];
        let part = ("steps", "what has settled");
        self.device.kernel(part, (dialect, &buffers), &body)
    }

    pub fn states(&mut self, program: &Program) -> Result<Vec<[Vec<Piece>; 4]>, Error> {
        let mut all = Vec::new();
        for own in &program.states {
            let mut pieces = [const { Vec::new() }; 4];
            for (pieces, actions) in pieces.iter_mut().zip(own.lists()) {
                *pieces = self.list(actions, false)?;
            }
            all.push(pieces);
        }
        Ok(all)
    }

    pub fn list(&mut self, actions: &[Action], of_approach: bool) -> Result<Vec<Piece>, Error> {
        let (mut pieces, mut steps, mut sums) = (Vec::new(), Vec::new(), Outputs::NONE);
        for action in actions {
            match action {
                Action::Points(step) => steps.push(step),
                Action::Lists => {
                    self.points(&mut steps, sums, &mut pieces)?;
                    pieces.push(Piece::Lists);
                }
                Action::Repeat(repeat) => {
                    self.points(&mut steps, sums, &mut pieces)?;
                    pieces.push(self.repeat(repeat)?);
                }
                Action::Keep(keep) => {
                    self.points(&mut steps, sums, &mut pieces)?;
                    let of = (keep.reads, keep.fields, keep.image.as_ref());
                    pieces.extend(self.packed(of, true)?);
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
