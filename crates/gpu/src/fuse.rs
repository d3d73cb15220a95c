//! What happens to single particles between two sweeps, joined to one kernel for each run of slots.
//! Numbers go from step to step in registers; all is read before anything is written.

use crate::device::{Device, Kernel};
use crate::kernel::Array;
use crate::{Dialect, Error, Part, emit};
use core::cell::RefCell;
use meshfree::particles::{Field, Fields, Outputs};
use meshfree::scalar::{Lane, Record, Traced};
use meshfree::simulation::device::{Given, Made, PointStep};
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

/// The buffers of such a kernel, in the order in which they are bound.
pub const BUFFERS: [Array; 6] = [
    Array::numbers("state").written(),
    Array::numbers("rates").written(),
    Array::numbers("sums"),
    Array::numbers("numbers"),
    Array::numbers("walls"),
    Array::numbers("columns").written(),
];

/// Where the columns of the state stand: fields, what a prediction saves, counts, and the places of lists.
#[derive(Clone, Debug)]
pub struct Layout {
    pub fields: Fields,
    pub dimensions: usize,
    pub slots: usize,
    pub mobile: usize,
    pub saved: Vec<Field>,
    pub counts: usize,
}

impl Layout {
    /// Where a component of a field starts.
    pub fn field(&self, field: Field, k: usize) -> usize {
        (self.fields.offset(field, self.dimensions) + k) * self.slots
    }
    fn width_of_saved(&self, fields: &[Field]) -> usize {
        let widths = fields.iter().map(|own| own.components(self.dimensions));
        widths.sum()
    }
    /// Where a component of a field starts as a prediction has saved it.
    pub fn saved(&self, field: Field, k: usize) -> usize {
        let before = self.saved.iter().position(|own| *own == field).unwrap_or(0);
        let before = self.width_of_saved(&self.saved[..before]);
        (self.fields.width(self.dimensions) + before + k) * self.slots
    }
    pub fn count(&self, k: usize) -> usize {
        let before = self.fields.width(self.dimensions) + self.width_of_saved(&self.saved);
        (before + k) * self.slots
    }
    /// Where lists were built for: places, and smoothing lengths where they vary.
    pub fn listed(&self, d: usize) -> usize {
        self.count(self.counts + d)
    }
    pub fn varies(&self) -> bool {
        self.fields.contains(Field::SMOOTHING_LENGTH)
    }
    /// Numbers of all columns.
    pub fn numbers(&self) -> usize {
        self.listed(self.dimensions + usize::from(self.varies()))
    }
}

/// A number that a kernel reads or writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
enum Place {
    /// Of the state, from its first slot on.
    State(usize),
    Rate(usize),
    Sum(usize),
    Wall(usize),
    Shared(usize),
    Column(usize),
}

/// What surrounds the steps of a kernel: where columns are, and what the sweeps before them have summed.
#[derive(Clone, Copy, Debug)]
pub struct Around<'a> {
    pub layout: &'a Layout,
    pub rates: Outputs,
    pub sums: Outputs,
    pub dialect: Dialect,
}

impl Around<'_> {
    fn place(&self, given: Given) -> Result<Place, f64> {
        let (layout, d) = (self.layout, self.layout.dimensions);
        Ok(match given {
            Given::Field(field, k) => Place::State(layout.field(field, k)),
            Given::Saved(field, k) => Place::State(layout.saved(field, k)),
            Given::Listed(k) => Place::State(layout.listed(k)),
            Given::Column(k) => Place::Column(k),
            Given::Rate(sum, k) => Place::Rate(self.rates.offset(sum, d) + k),
            Given::Sum(sum, k) => Place::Sum(self.sums.offset(sum, d) + k),
            Given::Wall(k) => Place::Wall(k),
            Given::Shared(k) => Place::Shared(k),
            Given::Constant(value) => return Err(value),
        })
    }

    fn text(&self, place: Place) -> String {
        self.text_of(place, ["", "i"])
    }

    /// The text of a number of the particle in a slot, in buffers whose names begin otherwise.
    fn text_of(&self, place: Place, [of, i]: [&str; 2]) -> String {
        let d = self.layout.dimensions;
        let mobile = self.layout.mobile;
        let walls = self.layout.slots - mobile;
        match place {
            Place::State(at) => format!("{of}state[{at}u + {i}]"),
            Place::Rate(k) => format!("{of}rates[{i} * {}u + {k}u]", self.rates.width(d)),
            Place::Sum(k) => format!("{of}sums[{i} * {}u + {k}u]", self.sums.width(d)),
            Place::Wall(k) => format!("{of}walls[{}u + {i} - {mobile}u]", k * walls),
            Place::Shared(k) => format!("{of}numbers[{k}u]"),
            Place::Column(k) => format!("{of}columns[{}u + {i}]", k * self.layout.slots),
        }
    }

    /// The same of what is given.
    pub fn read(&self, given: Given, names: [&str; 2]) -> String {
        match self.place(given) {
            Ok(place) => self.text_of(place, names),
            Err(value) => self.dialect.constant(value),
        }
    }

    /// Where a result goes.
    fn goes(&self, made: Made) -> Option<Place> {
        Some(match made {
            Made::Field(field, k) => Place::State(self.layout.field(field, k)),
            Made::Saved(field, k) => Place::State(self.layout.saved(field, k)),
            Made::Column(k) => Place::Column(k),
            Made::Wall(k) => Place::Wall(k),
            Made::Rate(sum, k) => Place::Rate(self.rates.offset(sum, self.layout.dimensions) + k),
            Made::Count(k) => Place::State(self.layout.count(k)),
            Made::Nothing => return None,
        })
    }

    /// The text of where a result goes.
    pub fn write(&self, made: Made) -> Option<String> {
        self.goes(made).map(|place| self.text(place))
    }

    /// The record of all steps, with what it is given and where its results go.
    fn joined(&self, steps: &[&PointStep]) -> Result<(Record, Vec<Place>, Vec<Place>), Error> {
        let all = steps.iter().flat_map(|step| {
            let given = step.given.iter().filter_map(|own| self.place(*own).ok());
            let counts = step.made.iter();
            let counts = counts.filter(|made| matches!(made, Made::Count(_)));
            given.chain(counts.filter_map(|made| self.goes(*made)))
        });
        let all: Vec<Place> = all.collect::<BTreeSet<_>>().into_iter().collect();
        let mut written = Vec::new();
        let record = Record::of(all.len(), |x| {
            let mut now: HashMap<Place, Traced> =
                all.iter().copied().zip(x.iter().copied()).collect();
            for step in steps {
                let given = step.given.iter().map(|own| match self.place(*own) {
                    Ok(place) => now[&place],
                    Err(value) => Traced::of(value),
                });
                let results = step.record.follow(&given.collect::<Vec<_>>());
                for (made, mut value) in step.made.iter().zip(results) {
                    let Some(place) = self.goes(*made) else {
                        continue;
                    };
                    if let Made::Count(_) = made {
                        value += now[&place];
                    }
                    now.insert(place, value);
                    if !written.contains(&place) {
                        written.push(place);
                    }
                }
            }
            written.iter().map(|place| now[place]).collect()
        });
        let record = record.map_err(|error| Error::Recorded {
            part: Part {
                kind: "steps",
                name: names(steps),
            },
            what: error.what,
        })?;
        Ok((record, all, written))
    }

    fn body(&self, steps: &[&PointStep]) -> Result<String, Error> {
        let (record, given, written) = self.joined(steps)?;
        let used = RefCell::new(BTreeSet::new());
        let text = emit(&record, self.dialect, &|k| {
            used.borrow_mut().insert(k);
            (format!("a{k}"), false)
        });
        let mut body = String::new();
        for k in used.into_inner() {
            let own = self.text(given[k]);
            body += &(self.dialect.declare(false, &format!("a{k}"), &own) + "\n");
        }
        body += &text.before;
        for (place, value) in written.iter().zip(&text.results) {
            // What is written as it was is not written.
            let same = given.iter().position(|own| own == place);
            if same.is_none_or(|k| *value != format!("a{k}")) {
                body += &format!("{} = {value};\n", self.text(*place));
            }
        }
        Ok(body)
    }

    /// The kernel of some steps over one run of slots.
    pub fn kernel(&self, device: &Device, steps: &[&PointStep]) -> Result<Kernel, Error> {
        let body = self.body(steps)?;
        device.kernel(("steps", &names(steps)), (self.dialect, &BUFFERS), &body)
    }
}

fn names(steps: &[&PointStep]) -> String {
    let names: Vec<_> = steps.iter().map(|step| step.name.as_str()).collect();
    names.join(", ")
}

/// Steps by the run of slots that they act on, each with its own in their order.
pub fn by_run<'a>(steps: &[&'a PointStep]) -> Vec<(Range<usize>, Vec<&'a PointStep>)> {
    let mut all: Vec<(Range<usize>, Vec<&PointStep>)> = Vec::new();
    for step in steps {
        match all.iter_mut().find(|own| own.0 == step.slots) {
            Some(own) => own.1.push(step),
            None => all.push((step.slots.clone(), vec![step])),
        }
    }
    all
}
