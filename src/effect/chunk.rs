//! What a law sees: a run of particles of one body, its columns, and the sums of the stage.
//! The driver owns the loop over particles: its threads, its order and its memory.

use crate::boundary::WallSurface;
use crate::material::Material;
use crate::particles::{Columns, Field, Output};
use crate::scalar::Real;
use crate::sweep::Results;
use std::ops::Range;

/// What is around a particle beside its own columns.
#[derive(Clone, Copy, Debug)]
pub struct Around<'a, T: Real, const D: usize> {
    /// The sums of the stage's own sweep; of the rates where they were summed with those.
    pub sums: &'a Results<T, D>,
    /// The rates of the last evaluation.
    pub rates: &'a Results<T, D>,
    /// The material of the body; of the first body for walls.
    pub material: &'a Material<T>,
    /// The wall, at [`Stage::Walls`](crate::term::Stage).
    pub wall: Option<&'a WallSurface<'a, T, D>>,
    /// The smoothing length η dx \[m\] with the spacing dx of the body, which is that of its particles as built; of walls the
    /// largest of the bodies in the group.
    pub smoothing_length: f64,
    /// First moment −Σ V r·∇W/D of the lattice; one in schemes whose particles carry their own.
    pub lattice_consistency_factor: f64,
    /// The step \[s\] over which the stage acts: of the drift, or since the law last ran in an earlier step;
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
pub const MOST_COLUMNS: usize = 48;

/// A run of particles of one body, or of a wall.
#[derive(Debug)]
pub struct Chunk<'a, T: Real, const D: usize> {
    columns: Slices<'a, T>,
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
            first: slots.start,
            count: slots.len(),
            live: live.saturating_sub(slots.start).min(slots.len()),
            around,
        }
    }

    /// Several different columns of these particles, `components` numbers each; empty where the scheme does
    /// not carry a field, all empty if one is named twice.
    #[must_use]
    pub fn columns<const N: usize>(&mut self, fields: [Field; N]) -> [&mut [T]; N] {
        const { assert!(N <= ABSENT, "no more columns at once than may be absent") };
        let mut missing = 0;
        let places = fields.map(|field| {
            self.columns.place(field).unwrap_or_else(|| {
                missing += 1;
                MOST_COLUMNS + missing - 1
            })
        });
        match self.columns.all.get_disjoint_mut(places) {
            Ok(columns) => columns.map(|column| &mut **column),
            Err(_) => core::array::from_fn(|_| [].as_mut_slice()),
        }
    }

    /// Component `k` of a sum of the n-th particle, from the stage's own sweep.
    #[inline(always)]
    #[must_use]
    pub fn sum(&self, output: Output, k: usize, n: usize) -> T {
        self.around.sums.get(output, k, self.first + n)
    }
}

/// Slices of the columns of a group, in the order of their fields; the last places stay empty, for what is
/// absent.
#[derive(Debug)]
pub(crate) struct Slices<'a, T> {
    all: [&'a mut [T]; MOST_COLUMNS + ABSENT],
    widths: [u8; MOST_COLUMNS],
    fields: [u8; MOST_COLUMNS],
    count: usize,
}

fn empty<'a, T>() -> [&'a mut [T]; MOST_COLUMNS + ABSENT] {
    core::array::from_fn(|_| [].as_mut_slice())
}

/// Most absent columns that can be asked for at once.
const ABSENT: usize = 12;

impl<'a, T: Real> Slices<'a, T> {
    /// All columns.
    pub fn of<const D: usize>(columns: &'a mut Columns<T, D>) -> Self {
        let (mut widths, mut fields, mut count) = ([0; MOST_COLUMNS], [0; MOST_COLUMNS], 0);
        let mut all = empty();
        for (field, column) in columns.iter_mut().take(MOST_COLUMNS) {
            all[count] = column;
            widths[count] = field.components(D) as u8;
            fields[count] = field.place() as u8;
            count += 1;
        }
        Self {
            all,
            widths,
            fields,
            count,
        }
    }

    fn place(&self, field: Field) -> Option<usize> {
        let fields = &self.fields[..self.count];
        fields.iter().position(|&own| own as usize == field.place())
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
