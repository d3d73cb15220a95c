//! What a law sees: a run of particles of one body, its columns, and the sums of the stage.
//! The driver owns the loop over particles: its threads, its order and its memory.

use super::access::{Access, Summed};
use super::{Law, Tally};
use crate::boundary::WallSurface;
use crate::material::Material;
use crate::particles::{Columns, Field, Fields, Output};
use crate::scalar::Real;
use crate::sweep::Results;
use std::ops::Range;

/// What is around a particle beside its own columns.
#[derive(Clone, Copy, Debug)]
pub struct Around<'a, T: Real, const D: usize> {
    /// The sums of the stage's own sweep; of the rates where they were summed with those.
    pub(crate) sums: &'a Results<T, D>,
    /// The material of the body; of the first body for walls.
    pub material: &'a Material<T>,
    /// The wall, at [`Stage::Walls`](crate::term::Stage).
    pub wall: Option<&'a WallSurface<'a, T, D>>,
    /// The smoothing length η dx \[m\] with the spacing dx of the body, which is that of its particles as built; of walls the
    /// largest of the bodies in the group.
    pub smoothing_length: f64,
    /// First moment −Σ V r·∇W/D of the lattice; one in schemes whose particles carry their own.
    pub lattice_consistency_factor: f64,
    /// The step \[s\] over which the stage acts: of the drift or kick, or since the law last ran in an earlier step;
    /// zero where time does not go on.
    pub dt: f64,
    /// The time \[s\].
    pub time: f64,
    /// What the loads give \[m/s²\].
    pub gravity: [f64; D],
    /// The place \[m\] in the scene from which [`Field::POSITION`] and [`Field::REFERENCE_POSITION`] count.
    pub origin: [f64; D],
    /// Whether the sums are those of a sweep in the middle of a drift, and not of the rates.
    pub in_drift: bool,
}

/// Most columns that a group has.
const MOST_COLUMNS: usize = Field::ALL.len() + Fields::MOST_OF_EFFECTS;

/// A run of particles of one body, or of a wall.
#[derive(Debug)]
pub struct Chunk<'a, T: Real, const D: usize> {
    columns: Slices<'a, T>,
    /// What the law that has it may reach.
    access: Access,
    /// The slot of its first particle.
    pub first: usize,
    /// How many slots there are.
    pub count: usize,
    /// How many of them are particles; the others, of the last cluster of a body, repeat the last particle, and
    /// are treated as it is but not counted.
    pub live: usize,
    /// What is around them.
    pub around: Around<'a, T, D>,
}

impl<'a, T: Real, const D: usize> Chunk<'a, T, D> {
    pub(crate) fn new(
        columns: Slices<'a, T>,
        slots: Range<usize>,
        live: usize,
        around: Around<'a, T, D>,
    ) -> Self {
        Self {
            columns,
            access: Access::DRIVER,
            first: slots.start,
            count: slots.len(),
            live: live.saturating_sub(slots.start).min(slots.len()),
            around,
        }
    }

    /// Runs a law, which reaches what it declares.
    pub(crate) fn run(&mut self, law: &dyn Law<T, D>) -> Tally {
        self.access = Access::of_law(law);
        law.apply(self)
    }

    /// Columns of these particles, `components` numbers each: those that the law reads, and those that it writes, whether or
    /// not it reads them first. A column is empty where the scheme does not have a field that the law declares
    /// [optional](Law::optional).
    ///
    /// # Panics
    /// If the law does not declare a field, or if one is asked for twice, to be written.
    #[track_caller]
    #[must_use]
    pub fn columns<const R: usize, const W: usize>(
        &mut self,
        reads: [Field; R],
        writes: [Field; W],
    ) -> ([&[T]; R], [&mut [T]; W]) {
        for field in reads {
            self.access.read(field);
        }
        for (k, field) in writes.into_iter().enumerate() {
            self.access.write(field);
            let same = |other: &Field| other.is(field);
            let twice = reads.iter().any(same) || writes[..k].iter().any(same);
            assert!(
                !twice,
                "a column that is written is asked for once, {field:?} is not"
            );
        }
        let mut read = [[].as_slice(); R];
        let mut written = core::array::from_fn(|_| [].as_mut_slice());
        let count = self.columns.count;
        let columns = self.columns.all.iter_mut().zip(&self.columns.fields);
        for (column, own) in columns.take(count) {
            let is = |field: &Field| field.is(*own);
            if let Some(k) = writes.iter().position(is) {
                written[k] = &mut **column;
                continue;
            }
            let column: &[T] = column;
            for (read, field) in read.iter_mut().zip(&reads) {
                if is(field) {
                    *read = column;
                }
            }
        }
        (read, written)
    }

    /// The columns of some fields that are there, in the order of storage.
    pub(super) fn lend(&mut self, fields: Fields) -> impl Iterator<Item = (Field, &mut [T])> {
        let all = self.columns.all.iter_mut().zip(&self.columns.fields);
        all.take(self.columns.count)
            .filter_map(move |(column, field)| {
                let is_lent = fields.contains(*field);
                is_lent.then_some((*field, &mut **column))
            })
    }

    /// A sum of these particles, from the stage's own sweep.
    ///
    /// # Panics
    /// If the law does not declare it.
    #[track_caller]
    #[must_use]
    pub fn sum(&self, output: Output) -> Summed<'a, T, D> {
        self.access.sum(output);
        Summed::new(self.around.sums, output, self.first)
    }
}

/// Slices of the columns of a group, in the order of their fields.
#[derive(Debug)]
pub(crate) struct Slices<'a, T> {
    all: [&'a mut [T]; MOST_COLUMNS],
    widths: [u8; MOST_COLUMNS],
    fields: [Field; MOST_COLUMNS],
    count: usize,
}

fn empty<'a, T>() -> [&'a mut [T]; MOST_COLUMNS] {
    core::array::from_fn(|_| [].as_mut_slice())
}

impl<'a, T: Real> Slices<'a, T> {
    /// All columns.
    pub fn of<const D: usize>(columns: &'a mut Columns<T, D>) -> Self {
        let (mut widths, mut count) = ([0; MOST_COLUMNS], 0);
        let mut fields = [Field::POSITION; MOST_COLUMNS];
        let mut all = empty();
        for (field, column) in columns.iter_mut() {
            all[count] = column;
            widths[count] = field.components(D) as u8;
            fields[count] = field;
            count += 1;
        }
        Self {
            all,
            widths,
            fields,
            count,
        }
    }

    /// The first `slots` slots, and the rest.
    pub fn split(self, slots: usize) -> (Self, Self) {
        let mut low = empty();
        let mut high = empty();
        for (k, column) in self.all.into_iter().enumerate().take(self.count) {
            let at = (slots * self.widths[k] as usize).min(column.len());
            (low[k], high[k]) = column.split_at_mut(at);
        }
        let with = |all| Self {
            all,
            widths: self.widths,
            fields: self.fields,
            count: self.count,
        };
        (with(low), with(high))
    }
}
