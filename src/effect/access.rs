//! What a part of a step may reach: the fields and sums that it declares, and no others.
//! A law, rate or limit that asks for more ends the run with its own name and that of what it asked for.

use super::{Law, Limit, Rate};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
use crate::sweep::Results;

/// A part of a step.
#[derive(Clone, Copy, Debug)]
enum Part {
    Law(&'static str),
    RateOf(Field),
    Limit(&'static str),
    /// The driver itself, which may reach everything.
    Driver,
}

/// A part of a step, and what it declares.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Access {
    part: Part,
    reads: Fields,
    writes: Fields,
    sums: Outputs,
}

impl Access {
    /// Everything.
    pub(crate) const DRIVER: Self = Self {
        part: Part::Driver,
        reads: Fields::NONE,
        writes: Fields::NONE,
        sums: Outputs::NONE,
    };

    pub(super) fn of_law<T: Real, const D: usize>(law: &dyn Law<T, D>) -> Self {
        Self {
            part: Part::Law(law.name()),
            reads: law.reads(),
            writes: law.writes(),
            sums: law.sums(),
        }
    }

    pub(super) fn of_rate<T: Real, const D: usize>(rate: &dyn Rate<T, D>, of: Field) -> Self {
        Self {
            part: Part::RateOf(of),
            reads: rate.reads(),
            writes: Fields::NONE,
            sums: rate.sums(),
        }
    }

    pub(super) fn of_limit<T: Real, const D: usize>(limit: &dyn Limit<T, D>) -> Self {
        Self {
            part: Part::Limit(limit.name()),
            reads: limit.reads(),
            writes: Fields::NONE,
            sums: limit.sums(),
        }
    }

    /// Numbers of the field whose rate it is.
    pub(super) fn components<const D: usize>(&self) -> usize {
        match self.part {
            Part::RateOf(field) => field.components(D),
            _ => 1,
        }
    }

    fn is_driver(&self) -> bool {
        matches!(self.part, Part::Driver)
    }

    /// Whether it may read a field.
    pub(super) fn reads(&self, field: Field) -> bool {
        self.reads.contains(field) || self.is_driver()
    }

    #[track_caller]
    pub(super) fn read(&self, field: Field) {
        #[cfg(test)]
        super::declared::note(|asked| asked.0 = asked.0.union(Fields::of(&[field])));
        if !self.reads(field) {
            self.refuse("reads the field", field.name(), "reads");
        }
    }

    #[track_caller]
    pub(super) fn write(&self, field: Field) {
        #[cfg(test)]
        super::declared::note(|asked| asked.1 = asked.1.union(Fields::of(&[field])));
        if !self.writes.contains(field) && !self.is_driver() {
            self.refuse("writes the field", field.name(), "writes");
        }
    }

    #[track_caller]
    pub(super) fn sum(&self, sum: Output) {
        #[cfg(test)]
        super::declared::note(|asked| asked.2 = asked.2.union(Outputs::of(&[sum])));
        if !self.sums.contains(sum) && !self.is_driver() {
            self.refuse("reads the sum", sum.name(), "sums");
        }
    }

    /// What it is called in messages.
    pub(super) fn name(&self) -> String {
        match self.part {
            Part::Law(name) => format!("law `{name}`"),
            Part::RateOf(field) => format!("rate of `{}`", field.name()),
            Part::Limit(name) => format!("limit `{name}`"),
            Part::Driver => "driver".into(),
        }
    }

    #[cold]
    #[track_caller]
    fn refuse(&self, does: &str, what: &str, method: &str) -> ! {
        let part = self.name();
        panic!("the {part} {does} `{what}`, which it does not declare: name it in its `{method}`")
    }
}

/// A sum over neighbours, in the hands of a part of a step that declares it.
#[derive(Clone, Copy, Debug)]
pub struct Summed<'a, T: Real, const D: usize> {
    results: &'a Results<T, D>,
    /// Where it starts among the numbers of a particle.
    offset: Option<usize>,
    /// The slot from which particles are counted.
    first: usize,
}

impl<'a, T: Real, const D: usize> Summed<'a, T, D> {
    pub(super) fn new(results: &'a Results<T, D>, output: Output, first: usize) -> Self {
        Self {
            results,
            offset: results.offset(output),
            first,
        }
    }

    /// Component `k` of the sum of the n-th particle of a [`Chunk`](super::Chunk), or of the particle in slot `n` where
    /// a [`View`](super::View) gave it; zero where nothing was summed.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, k: usize, n: usize) -> T {
        let number = |offset| self.results.number(offset + k, self.first + n);
        self.offset.map_or(T::zero(), number)
    }
}
