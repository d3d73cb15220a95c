//! Couplings by forces: kernels in which a particle adds up what those of the other side do to it.
//! A thread writes what no other does, and takes its partners in the order of the host.

use crate::device::{Bound, Buffer, Device, Extent, Kernel};
use crate::follow::around;
use crate::fuse::Around;
use crate::kernel::{Array, pack, pack_indices};
use crate::reduce::{Find, Reduction};
use crate::run::Group;
use crate::{Error, Precision, emit};
use meshfree::simulation::device::{ContactStep, PairStep, Partners, Summed};

/// A coupling, bound to the memory of its groups.
#[derive(Debug)]
pub(crate) struct Contact {
    step: ContactStep,
    sides: Vec<Side>,
    /// What is found of all sides, one after the other.
    pub found: Buffer,
    between: [Buffer; 2],
    pub bound: Vec<Bound>,
    precision: Precision,
}

/// The kernels of a side: sums, what follows them, and forces.
#[derive(Debug)]
struct Side {
    gather: Option<Kernel>,
    own: Kernel,
    act: Kernel,
    find: Reduction,
}

/// The text of what pairs give the particles of a side.
fn pairs(contact: &ContactStep, step: &PairStep, side: usize, around: [&Around<'_>; 2]) -> String {
    let (own, other) = (
        &contact.sides[side],
        &contact.sides[contact.sides.len() - 1 - side],
    );
    let is_self = contact.sides.len() == 1;
    let dialect = around[0].dialect;
    let from = if own.group == other.group {
        ""
    } else {
        "from_"
    };
    let width = own.given.len();
    // Whether this particle is the first of its pairs.
    let is_first = side == 0 || !step.ordered;
    let text = emit(&step.record, dialect, &|k| {
        if k == 2 * width {
            return if contact.as_built {
                ("rest[q]".into(), true)
            } else {
                (dialect.constant(0.0), false)
            };
        }
        let is_second = k >= width;
        let k = k % width;
        if is_self && step.ordered {
            let slot = if is_second { "second" } else { "first" };
            (around[0].read(own.given[k], ["", slot]), true)
        } else if is_second == is_first {
            (around[1].read(other.given[k], [from, "j"]), true)
        } else {
            (around[0].read(own.given[k], ["", "i"]), false)
        }
    });
    let (zero, mut body) = (dialect.constant(0.0), text.before);
    for (k, (_, summed)) in step.made.iter().enumerate() {
        let start = match summed {
            Summed::Least => dialect.constant(f64::INFINITY),
            _ => zero.clone(),
        };
        body += &dialect.variable(&format!("s{k}"), &start);
    }
    body += &dialect.each("q", "starts[n]", "starts[n + 1u]");
    let entry = if is_self { "list[q] >> 1u" } else { "list[q]" };
    body += &dialect.index("j", entry);
    let flipped = "(list[q] & 1u) == 1u";
    if is_self && step.ordered {
        body += &dialect.index("first", &dialect.select(flipped, "j", "i"));
        body += &dialect.index("second", &dialect.select(flipped, "i", "j"));
    }
    body += &text.within;
    for (k, ((_, summed), value)) in step.made.iter().zip(&text.results).enumerate() {
        let to = format!("s{k}");
        // What the second of a pair is given.
        let second = match summed {
            Summed::Opposite => format!("(-{value})"),
            _ => zero.clone(),
        };
        let one = match summed {
            Summed::Opposite | Summed::First if is_self => dialect.select(flipped, &second, value),
            Summed::Opposite | Summed::First if side == 1 => second,
            _ => value.clone(),
        };
        let new = match summed {
            Summed::Most => dialect.select(&format!("{one} > {to}"), &one, &to),
            Summed::Least => dialect.select(&format!("{one} < {to}"), &one, &to),
            _ => format!("{to} + {one}"),
        };
        body += &format!("{to} = {new};\n");
    }
    body += "}\n";
    for (k, (column, _)) in step.made.iter().enumerate() {
        let at = (own.first + column) * around[0].layout.slots;
        body += &format!("columns[{at}u + i] = s{k};\n");
    }
    body
}

/// The arrays of such a kernel.
fn arrays(contact: &ContactStep) -> Vec<Array> {
    let numbers = Array::numbers;
    let mut all = vec![numbers("state"), numbers("columns").written()];
    if is_between(contact) {
        all.extend([numbers("from_state"), numbers("from_columns")]);
    }
    all.extend([
        Array::indices("starts"),
        Array::indices("list"),
        numbers("rest"),
    ]);
    all
}

/// Whether the sides are of two groups.
fn is_between(contact: &ContactStep) -> bool {
    contact.sides[0].group != contact.sides[contact.sides.len() - 1].group
}

impl Contact {
    pub fn new(
        device: &Device,
        groups: &[Group],
        step: &ContactStep,
        precision: Precision,
    ) -> Result<Self, Error> {
        let count = step.sides.len();
        let side = |side: usize| {
            let around = [side, count - 1 - side]
                .map(|k| around(&groups[step.sides[k].group], device.dialect(precision)));
            let [own, other] = &around;
            let kernel = |what: &PairStep| {
                let body = pairs(step, what, side, [own, other]);
                let frame = (own.dialect, &arrays(step)[..]);
                device.kernel(("coupling", step.name), frame, &body)
            };
            let first = step.sides[side].first;
            let finds = step.found.iter().map(|(column, summed)| match summed {
                Summed::Most => Find::Most(first + column),
                Summed::Least => Find::Least(first + column),
                _ => Find::Sum(first + column),
            });
            Ok(Side {
                gather: step.gather.as_ref().map(kernel).transpose()?,
                own: own.kernel(device, &step.sides[side].own)?,
                act: kernel(&step.act)?,
                find: Reduction::new(device, &finds.collect::<Vec<_>>(), precision)?,
            })
        };
        let sides = (0..count).map(side).collect::<Result<Vec<_>, Error>>()?;
        let bytes = precision.bytes();
        let levels = sides.iter().zip(&step.sides);
        let levels = levels.map(|(own, of)| own.find.between(of.slots[1].len()) * bytes);
        let levels = levels.max().unwrap_or(0);
        let between = || device.room("what levels of sums pass on", levels);
        Ok(Self {
            found: device.room("what couplings ask for", step.found.len() * count * bytes)?,
            between: [between()?, between()?],
            step: step.clone(),
            sides,
            bound: Vec::new(),
            precision,
        })
    }

    /// Whether it acts on a group.
    pub fn has(&self, group: usize) -> bool {
        self.step.sides.iter().any(|side| side.group == group)
    }

    /// How many numbers are found of a side.
    pub fn width(&self) -> usize {
        self.step.found.len()
    }

    /// The groups of its sides.
    pub fn groups(&self) -> Vec<usize> {
        let mut all: Vec<_> = self.step.sides.iter().map(|side| side.group).collect();
        all.dedup();
        all
    }

    /// Takes the pairs of all sides to the device.
    pub fn send(
        &mut self,
        device: &Device,
        groups: &[Group],
        all: &[Partners],
    ) -> Result<(), Error> {
        let [mut gathers, mut owns, mut acts, mut finds] = [const { Vec::new() }; 4];
        for (side, (kernels, partners)) in self.sides.iter().zip(all).enumerate() {
            let own = &self.step.sides[side];
            let other = &self.step.sides[all.len() - 1 - side];
            let (m, o) = (&groups[own.group].memory, &groups[other.group].memory);
            let what = "the pairs of couplings";
            let starts = device.upload(what, &pack_indices(&partners.starts))?;
            let list = device.upload(what, &pack_indices(&partners.list))?;
            let rest = partners.rest.iter().copied();
            let rest = device.upload(what, &pack(rest, self.precision))?;
            let [run, live] = &own.slots;
            let extent = || Extent::of(run.clone());
            let mut buffers = vec![&m.state, &m.columns];
            if is_between(&self.step) {
                buffers.extend([&o.state, &o.columns]);
            }
            buffers.extend([&starts, &list, &rest]);
            let gather = kernels.gather.iter();
            gathers.extend(gather.map(|own| device.bind_over(own, &buffers, extent())));
            acts.push(device.bind_over(&kernels.act, &buffers, extent()));
            let buffers = [&m.state, &m.rates, &m.sums, &m.shared, &m.walls, &m.columns];
            owns.push(device.bind_over(&kernels.own, &buffers, extent()));
            finds.extend(kernels.find.bind(
                device,
                (&m.columns, groups[own.group].sizes.layout.slots),
                (live.start, live.len()),
                [&self.between[0], &self.between[1]],
                (&self.found, side * self.width()),
            ));
        }
        self.bound = [gathers, owns, acts, finds].into_iter().flatten().collect();
        Ok(())
    }
}
