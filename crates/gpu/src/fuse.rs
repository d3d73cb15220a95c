//! What happens to single particles between two sweeps, one kernel for each run of slots.
//! All is read before anything is written.

use crate::device::{Device, Kernel};
use crate::kernel::Array;
use crate::{Dialect, Error, emit};
use core::cell::RefCell;
use meshfree::particles::Outputs;
use meshfree::simulation::device::{Given, Layout, Made, PointStep};
use std::collections::BTreeSet;

/// The buffers of such a kernel, in the order in which they are bound.
pub const BUFFERS: [Array; 6] = [
    Array::numbers("state").written(),
    Array::numbers("rates").written(),
    Array::numbers("sums"),
    Array::numbers("numbers"),
    Array::numbers("walls"),
    Array::numbers("columns").written(),
];

/// What surrounds the steps of a kernel: where columns are, and what the sweeps before them have summed.
#[derive(Clone, Copy, Debug)]
pub struct Around<'a> {
    pub layout: &'a Layout,
    pub rates: Outputs,
    pub sums: Outputs,
    pub dialect: Dialect,
}

impl Around<'_> {
    /// The text of a number of the particle in a slot, in buffers whose names begin otherwise.
    pub fn read(&self, given: Given, [of, i]: [&str; 2]) -> String {
        let (layout, d) = (self.layout, self.layout.dimensions);
        let mobile = layout.mobile;
        let walls = layout.slots - mobile;
        let state = |at: usize| format!("{of}state[{at}u + {i}]");
        let row = |of_all: Outputs, name: &str, k: usize| {
            format!("{of}{name}[{i} * {}u + {k}u]", of_all.width(d))
        };
        match given {
            Given::Field(field, k) => state(layout.field(field, k)),
            Given::Saved(field, k) => state(layout.saved(field, k)),
            Given::Listed(k) => state(layout.listed(k)),
            Given::Count(k) => state(layout.count(k)),
            Given::Column(k) => format!("{of}columns[{}u + {i}]", k * layout.slots),
            Given::Rate(sum, k) => row(self.rates, "rates", self.rates.offset(sum, d) + k),
            Given::Sum(sum, k) => row(self.sums, "sums", self.sums.offset(sum, d) + k),
            Given::Wall(k) => format!("{of}walls[{}u + {i} - {mobile}u]", k * walls),
            Given::Shared(k) => format!("{of}numbers[{k}u]"),
            Given::Constant(value) => self.dialect.constant(value),
        }
    }

    /// Stores of results where they go, but for those that are what is there, and that stand in `a0`, `a1`, …
    pub fn write(&self, made: &[Made], results: &[String], there: &[Given]) -> String {
        let all = made.iter().zip(results).filter_map(|(made, value)| {
            let place = made.place()?;
            let same = there.iter().position(|own| *own == place);
            let to = self.read(place, ["", "i"]);
            let is_new = same.is_none_or(|k| *value != format!("a{k}"));
            is_new.then(|| format!("{to} = {value};\n"))
        });
        all.collect()
    }

    /// The kernel of a step over its slots.
    pub fn kernel(&self, device: &Device, step: &PointStep) -> Result<Kernel, Error> {
        let used = RefCell::new(BTreeSet::new());
        let text = emit(&step.record, self.dialect, &|k| {
            used.borrow_mut().insert(k);
            (format!("a{k}"), false)
        });
        let mut body = String::new();
        for k in used.into_inner() {
            let own = self.read(step.given[k], ["", "i"]);
            body += &(self.dialect.declare(false, &format!("a{k}"), &own) + "\n");
        }
        body += &text.before;
        body += &self.write(&step.made, &text.results, &step.given);
        device.kernel(("steps", &step.name), (self.dialect, &BUFFERS), &body)
    }
}
