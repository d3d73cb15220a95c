//! Rates and limits of points as objects: loops over rows of columns that nothing writes.
//! Rows are loaded as those of laws are.

use super::point::{AtWall, CONSTANTS, OfLimit, OfRate};
use super::rows::{MOST, assert_few, convert, load, load_sums};
use super::{Around, Limit, Point, PointLimit, PointRate, Rate, View};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{MOST_READS, MOST_SUMS};

impl<T: Real, const D: usize, A: PointRate<D>> Rate<T, D> for A {
    fn reads(&self) -> Fields {
        A::READS
    }
    fn sums(&self) -> Outputs {
        A::SUMS
    }
    fn optional(&self) -> Fields {
        A::OPTIONAL
    }
    fn growth(&self, at: &View<'_, T, D>, first: usize, present: &[T], growth: &mut [T]) {
        if A::GROWTH {
            rates::<T, T::Wide<false>, A, D>(self, at, first, present, growth, 1);
        }
    }
    fn source(&self, at: &View<'_, T, D>, first: usize, source: &mut [T]) {
        if !A::GROWTH {
            let width = at.access.components::<D>();
            rates::<T, T::Wide<false>, A, D>(self, at, first, &[], source, width);
        }
    }
    #[cfg(any(test, feature = "devices"))]
    fn record(&self, view: &View<'_, T, D>) -> Option<super::PointRecord> {
        Some(super::recorded::rate(self, view))
    }
}

/// The fields and sums of a rate or limit, and where their numbers stand in a row; found when it is compiled.
struct Places {
    all: Fields,
    fields: [(Field, usize); MOST],
    fields_count: usize,
    sums: [(Output, usize); MOST],
    sums_count: usize,
}

impl Places {
    const fn of<const D: usize>(reads: Fields, sums: Outputs) -> Self {
        let mut own = Self {
            all: reads,
            fields: [(Field::POSITION, 0); MOST],
            fields_count: 0,
            sums: [(Output::FORCE, 0); MOST],
            sums_count: 0,
        };
        let mut place = 0;
        while let Some((field, next)) = reads.from(place) {
            own.fields[own.fields_count] = (field, reads.offset(field, D));
            own.fields_count += 1;
            place = next;
        }
        place = 0;
        while let Some((output, next)) = sums.from(place) {
            own.sums[own.sums_count] = (output, sums.offset(output, D));
            own.sums_count += 1;
            place = next;
        }
        own
    }
}

/// Columns that are read from a slot on, with where their numbers stand, and sums.
struct Given<'a, T: Real, const D: usize> {
    columns: [(&'a [T], usize, usize); MOST],
    count: usize,
    /// The fields that are there, where some are not.
    fewer: Option<Fields>,
    places: &'static Places,
}

impl<'a, T: Real, const D: usize> Given<'a, T, D> {
    fn new(at: &View<'a, T, D>, places: &'static Places) -> Self {
        let mut columns = [([].as_slice(), 1, 0); MOST];
        let (mut count, mut fewer) = (0, None);
        for &(field, offset) in &places.fields[..places.fields_count] {
            let column = at.columns.raw(field);
            if column.is_empty() {
                fewer = Some(fewer.unwrap_or(places.all).without(field));
            } else {
                columns[count] = (column, field.components(D), offset);
                count += 1;
            }
        }
        Self {
            columns,
            count,
            fewer,
            places,
        }
    }
    /// The fields that are there.
    fn there(&self) -> &Fields {
        self.fewer.as_ref().unwrap_or(&self.places.all)
    }
    /// The numbers of the row that starts with a slot.
    #[inline(never)]
    fn load<L: Lane>(
        &self,
        around: &Around<'_, T, D>,
        slot: usize,
        (numbers, sums): (&mut [L; MOST_READS], &mut [L; MOST_SUMS]),
    ) {
        for &(column, width, start) in &self.columns[..self.count] {
            load(&column[slot * width..], width, &mut numbers[start..]);
        }
        let list = &self.places.sums[..self.places.sums_count];
        load_sums(around.sums, list, slot, sums);
    }
}

/// A rate over particles from slot `first` on, row by row.
fn rates<T: Real, L: Lane, A: PointRate<D>, const D: usize>(
    rate: &A,
    at: &View<'_, T, D>,
    first: usize,
    present: &[T],
    values: &mut [T],
    width: usize,
) {
    const { assert_few::<D>(A::READS, A::SUMS) }
    let mut constants = [0.0; CONSTANTS];
    if !PointRate::prepare(rate, &at.around, &mut constants) {
        return;
    }
    let constants = constants.map(L::of);
    let given = Given::new(at, const { &Places::of::<D>(A::READS, A::SUMS) });
    let (mut numbers, mut sums) = ([L::zero(); MOST_READS], [L::zero(); MOST_SUMS]);
    let wall = AtWall::none();
    for (n, values) in values.chunks_mut(L::WIDTH * width).enumerate() {
        let start = n * L::WIDTH;
        given.load(&at.around, first + start, (&mut numbers, &mut sums));
        let mut before = [L::zero()];
        if A::GROWTH {
            load(&present[start..], 1, &mut before);
        }
        let mut own = [L::zero(); 9];
        let point = Point::<L, D, OfRate<T, A, D>> {
            numbers: &mut numbers,
            sums: &sums,
            there: given.there(),
            access: &at.access,
            limited: None,
            change: None,
            dt: L::of(at.around.dt),
            constants,
            displacement: [L::zero(); D],
            wall: &wall,
            around: &at.around,
        };
        rate.point(&point, before[0], &mut own[..width]);
        for (e, values) in values.chunks_exact_mut(width).enumerate() {
            for (k, value) in values.iter_mut().enumerate() {
                *value += convert(own[k].extract(e));
            }
        }
    }
}

impl<T: Real, const D: usize, A: PointLimit<D>> Limit<T, D> for A {
    fn name(&self) -> &'static str {
        A::NAME
    }
    fn reads(&self) -> Fields {
        A::READS
    }
    fn sums(&self) -> Outputs {
        A::SUMS
    }
    fn step(&self, at: &View<'_, T, D>, slot: usize) -> f64 {
        const { assert_few::<D>(A::READS, A::SUMS) }
        let given = Given::new(at, const { &Places::of::<D>(A::READS, A::SUMS) });
        let (mut numbers, mut sums) = ([0.0; MOST_READS], [0.0; MOST_SUMS]);
        given.load(&at.around, slot, (&mut numbers, &mut sums));
        PointLimit::step(
            self,
            &Point::<f64, D, OfLimit<T, A, D>> {
                numbers: &mut numbers,
                sums: &sums,
                there: given.there(),
                access: &at.access,
                limited: None,
                change: None,
                dt: at.around.dt,
                constants: [0.0; CONSTANTS],
                displacement: [0.0; D],
                wall: &AtWall::none(),
                around: &at.around,
            },
        )
    }
    #[cfg(any(test, feature = "devices"))]
    fn record(&self, view: &View<'_, T, D>) -> Option<super::PointRecord> {
        Some(super::recorded::limit(self, view))
    }
}
