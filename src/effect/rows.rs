//! Laws, rates and limits of points as objects: loops over rows of a chunk, the same for all of them.
//! Numbers of a row are loaded and stored here, so that a law compiles to its own arithmetic alone.

use super::access::Access;
use super::point::{AtWall, CONSTANTS, OfLaw, OfLimit, OfRate};
use super::shifting::PLACE;
use super::{
    Around, Chunk, Law, Limit, Point, PointLaw, PointLimit, PointRate, Rate, Rung, Tally, View,
};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, MOST_LANES, Real};
use crate::sweep::{Results, add_compensated};
use crate::tensor::{Matrix, Vector};
use crate::term::{MOST_READS, MOST_SUMS};
use core::ops::Range;

/// Most fields and most sums of a law, rate or limit.
const MOST: usize = 32;

/// A number of the precision of a column as one of a law, or the other way round.
#[inline(always)]
fn convert<A: Real, B: Real>(value: A) -> B {
    B::from_f64(value.to_f64())
}

/// The numbers of the particles at the start of a column, of `width` each; of a row that is not full the last particle is repeated.
#[inline(always)]
fn load<T: Real, L: Lane>(column: &[T], width: usize, numbers: &mut [L]) {
    let Some(row) = column.get(..L::WIDTH * width) else {
        let last = column.len() / width - 1;
        for (k, number) in numbers[..width].iter_mut().enumerate() {
            *number = L::from_fn(|e| convert(column[e.min(last) * width + k]));
        }
        return;
    };
    // Widths that are constants need no check of every place.
    match width {
        1 => strided::<T, L, 1>(row, numbers),
        2 => strided::<T, L, 2>(row, numbers),
        3 => strided::<T, L, 3>(row, numbers),
        4 => strided::<T, L, 4>(row, numbers),
        6 => strided::<T, L, 6>(row, numbers),
        _ => strided::<T, L, 9>(row, numbers),
    }
}

#[inline(always)]
fn strided<T: Real, L: Lane, const N: usize>(row: &[T], numbers: &mut [L]) {
    let row = &row.as_chunks::<N>().0[..L::WIDTH];
    for (k, number) in numbers[..N].iter_mut().enumerate() {
        *number = L::from_fn(|e| convert(row[e][k]));
    }
}

/// The sums of a list of the particles from `slot` on.
#[inline(never)]
fn load_sums<T: Real, L: Lane, const D: usize>(
    results: &Results<T, D>,
    list: &[(Output, usize)],
    slot: usize,
    sums: &mut [L; MOST_SUMS],
) {
    let lane = slot % Results::<T, D>::WIDTH;
    for &(output, start) in list {
        let row = results.row(output, slot - lane);
        let row = row.filter(|_| lane + L::WIDTH <= Results::<T, D>::WIDTH);
        for k in 0..output.components(D) {
            sums[start + k] = match row {
                Some(row) => {
                    let own = &row[k * Results::<T, D>::WIDTH + lane..][..L::WIDTH];
                    L::from_fn(|e| convert(own[e]))
                }
                None => L::from_fn(|e| convert(results.get(output, k, slot + e))),
            };
        }
    }
}

/// Where each sum of those that are used stands among the numbers of a row that has room for all of a set.
fn places_of_sums<const D: usize>(
    sums: Outputs,
    used: Outputs,
) -> ([(Output, usize); MOST], usize) {
    let mut list = [(Output::FORCE, 0); MOST];
    let mut count = 0;
    for (place, output) in list.iter_mut().zip(used.iter()) {
        *place = (output, sums.offset(output, D));
        count += 1;
    }
    (list, count)
}

/// A column of a law, and where its numbers stand.
#[derive(Debug)]
struct Lent<'c, T> {
    field: Field,
    column: &'c mut [T],
    width: usize,
    start: usize,
    loads: bool,
    stores: bool,
}

/// The columns of a law that are there, and the fields that they hold.
fn lend<'c, T: Real, const D: usize>(
    chunk: &'c mut Chunk<'_, T, D>,
    loads: Fields,
    stores: Fields,
    all: Fields,
) -> ([Lent<'c, T>; MOST], usize, Fields) {
    let mut lent: [Lent<'c, T>; MOST] = core::array::from_fn(|_| Lent {
        field: Field::POSITION,
        column: &mut [],
        width: 0,
        start: 0,
        loads: false,
        stores: false,
    });
    let (mut count, mut there) = (0, Fields::NONE);
    for (own, (field, column)) in lent.iter_mut().zip(chunk.lend(loads.union(stores))) {
        *own = Lent {
            field,
            column,
            width: field.components(D),
            start: all.offset(field, D),
            loads: loads.contains(field),
            stores: stores.contains(field) && !PLACE.contains(field),
        };
        count += 1;
        there = there.union(Fields::of(&[field]));
    }
    (lent, count, there)
}

impl<T: Real, const D: usize, A: PointLaw<D>> Law<T, D> for A {
    fn name(&self) -> &'static str {
        A::NAME
    }
    fn reads(&self) -> Fields {
        A::READS
    }
    fn sums(&self) -> Outputs {
        self.summed()
    }
    fn writes(&self) -> Fields {
        self.written()
    }
    fn adds(&self) -> Fields {
        A::ADDS
    }
    fn optional(&self) -> Fields {
        self.spared()
    }
    fn before(&self) -> Fields {
        A::BEFORE
    }
    fn rung(&self) -> Option<Rung> {
        A::RUNG
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        if A::DOUBLE {
            rows::<T, <f64 as Real>::Wide<false>, A, D>(self, chunk)
        } else {
            rows::<T, T::Wide<false>, A, D>(self, chunk)
        }
    }
    fn repeats(&self) -> Option<(usize, f64)> {
        self.repeated()
    }
    #[cfg(any(test, feature = "devices"))]
    fn record(&self, around: &Around<'_, T, D>, there: Fields) -> Option<super::PointRecord> {
        Some(super::recorded::law(self, around, there))
    }
}

/// A law over a chunk, row by row.
fn rows<T: Real, L: Lane, A: PointLaw<D>, const D: usize>(
    law: &A,
    chunk: &mut Chunk<'_, T, D>,
) -> Tally {
    const { assert_few::<D>(A::READS.union(A::WRITES), A::SUMS) }
    let all = const { A::READS.union(A::WRITES) };
    let (list, sums_count) = places_of_sums::<D>(A::SUMS, law.summed());
    let (around, access) = (chunk.around, Access::of_law::<T, D>(law));
    let (first, count, live) = (chunk.first, chunk.count, chunk.live);
    let (mut lent, lent_count, there) = lend(
        chunk,
        A::READS.union(A::ADDS.minus(PLACE)),
        law.written(),
        all,
    );
    let lent = &mut lent[..lent_count];
    let mut constants = [0.0; CONSTANTS];
    if !PointLaw::prepare(law, &around, &mut constants) {
        return Tally::default();
    }
    let constants = constants.map(L::of);
    let (mut numbers, mut sums) = ([L::zero(); MOST_READS], [L::zero(); MOST_SUMS]);
    let mut wall = AtWall::none();
    let mut tally = Tally::default();
    for start in (0..count).step_by(L::WIDTH) {
        load_columns(lent, start, &mut numbers);
        load_sums(around.sums, &list[..sums_count], first + start, &mut sums);
        if A::OF_WALLS {
            load_wall(&around, first + start..first + count, &mut wall);
        }
        let mut point = Point::<L, D, OfLaw<T, A, D>> {
            numbers: &mut numbers,
            sums: &sums,
            there: &there,
            access: &access,
            limited: None,
            change: None,
            dt: L::of(around.dt),
            constants,
            displacement: [L::zero(); D],
            wall: &wall,
            around: &around,
        };
        law.point(&mut point);
        let displacement = point.displacement;
        if let Some(change) = point.change {
            for e in 0..L::WIDTH.min(count - start) {
                tally.change = tally.change.max(change.extract(e).to_f64());
            }
        }
        if let Some(mask) = point.limited {
            let own = L::WIDTH.min(live.saturating_sub(start));
            for e in 0..own {
                tally.limited += u64::from(crate::scalar::Mask::test(mask, e));
            }
        }
        if A::WRITES.contains(Field::POSITION) {
            displace(lent, start, &displacement);
        }
        store_columns(lent, start, &numbers);
    }
    tally
}

/// A row of numbers.
#[inline(always)]
fn row<L: Lane>(own: impl Fn(usize) -> f64) -> L {
    L::from_fn(|e| Real::from_f64(own(e)))
}

/// What the row of particles that starts some slots shows of their wall; of a row that is not full the last particle is repeated.
#[inline(never)]
fn load_wall<T: Real, L: Lane, const D: usize>(
    around: &Around<'_, T, D>,
    slots: Range<usize>,
    all: &mut AtWall<L, D>,
) {
    let Some(wall) = around.wall else {
        return;
    };
    let slot = |e: usize| (slots.start + e).min(slots.end - 1);
    let mut fall = [[0.0; D]; MOST_LANES];
    for (e, fall) in fall[..L::WIDTH].iter_mut().enumerate() {
        let own = wall.acceleration(slot(e));
        for d in 0..D {
            fall[d] = around.gravity[d] - own[d];
        }
    }
    all.fall = core::array::from_fn(|d| row(|e| fall[e][d]));
    if wall.normal(slots.start).is_some() {
        let mut normal = [[0.0; D]; MOST_LANES];
        for (e, normal) in normal[..L::WIDTH].iter_mut().enumerate() {
            let own = wall.normal(slot(e)).unwrap_or_else(Vector::zeros);
            *normal = core::array::from_fn(|d| own[d].to_f64());
        }
        all.normal = core::array::from_fn(|d| row(|e| normal[e][d]));
    }
    if wall.velocity_gradient(slots.start).is_some() {
        let mut gradient = [Matrix::zeros(); MOST_LANES];
        for (e, gradient) in gradient[..L::WIDTH].iter_mut().enumerate() {
            *gradient = wall
                .velocity_gradient(slot(e))
                .unwrap_or_else(Matrix::zeros);
        }
        for a in 0..D {
            for b in 0..D {
                all.gradient.0[a][b] = row(|e| gradient[e][(a, b)]);
            }
        }
    }
}

/// The numbers of the row that starts with a slot of the chunk. Compiled once for all laws, as [`store_columns`].
#[inline(never)]
fn load_columns<T: Real, L: Lane>(
    lent: &[Lent<'_, T>],
    start: usize,
    numbers: &mut [L; MOST_READS],
) {
    for own in lent {
        let numbers = &mut numbers[own.start..own.start + own.width];
        if own.loads {
            load(&own.column[start * own.width..], own.width, numbers);
        } else {
            // What is only written starts as NaN, so that one that is not set is seen.
            numbers.fill(L::of(f64::NAN));
        }
    }
}

/// Stores what the law writes.
#[inline(never)]
fn store_columns<T: Real, L: Lane>(
    lent: &mut [Lent<'_, T>],
    start: usize,
    numbers: &[L; MOST_READS],
) {
    for own in lent.iter_mut().filter(|own| own.stores) {
        let numbers = &numbers[own.start..own.start + own.width];
        store(numbers, &mut own.column[start * own.width..]);
    }
}

/// Moves the particles of a row, with what their places lose where that is kept.
#[inline(always)]
fn displace<T: Real, L: Lane>(lent: &mut [Lent<'_, T>], start: usize, by: &[L]) {
    let [mut x, mut lost] = [[].as_mut_slice(), [].as_mut_slice()];
    let width = by.len();
    for own in lent {
        let column = own.column.get_mut(start * width..).unwrap_or_default();
        if own.field.is(Field::POSITION) {
            x = column;
        } else if own.field.is(Field::POSITION_RESIDUAL) {
            lost = column;
        }
    }
    for (e, x) in x.chunks_exact_mut(width).take(L::WIDTH).enumerate() {
        for (d, x) in x.iter_mut().enumerate() {
            add_compensated(x, lost.get_mut(e * width + d), convert(by[d].extract(e)));
        }
    }
}

/// Stores the components of a row at the start of a column, as far as that goes.
#[inline(always)]
fn store<T: Real, L: Lane>(numbers: &[L], column: &mut [T]) {
    let width = numbers.len();
    let count = (column.len() / width).min(L::WIDTH);
    for (k, number) in numbers.iter().enumerate() {
        if let Some(row) = column.get_mut(..L::WIDTH).filter(|_| width == 1) {
            for e in 0..L::WIDTH {
                row[e] = convert(number.extract(e));
            }
            continue;
        }
        for e in 0..count {
            column[e * width + k] = convert(number.extract(e));
        }
    }
}

/// Fails to compile where what is declared has no room.
const fn assert_few<const D: usize>(fields: Fields, sums: Outputs) {
    assert!(
        fields.width(D) <= MOST_READS && fields.width(1) <= MOST,
        "a law, rate or limit of points declares more numbers than `meshfree::term::MOST_READS`, or more than 32 fields"
    );
    assert!(
        sums.width(D) <= MOST_SUMS && sums.width(1) <= MOST,
        "a law, rate or limit of points declares more sums than `meshfree::term::MOST_SUMS` numbers, or more than 32"
    );
}

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

/// Columns that are read from a slot on, with where their numbers stand, and sums.
struct Given<'a, T: Real, const D: usize> {
    columns: [(&'a [T], usize, usize); MOST],
    count: usize,
    there: Fields,
    list: [(Output, usize); MOST],
    sums_count: usize,
}

impl<'a, T: Real, const D: usize> Given<'a, T, D> {
    fn new(at: &View<'a, T, D>, reads: Fields, sums: Outputs) -> Self {
        let (list, sums_count) = places_of_sums::<D>(sums, sums);
        let mut columns = [([].as_slice(), 1, 0); MOST];
        let (mut count, mut there) = (0, Fields::NONE);
        for field in reads.iter() {
            let column = at.columns.raw(field);
            if !column.is_empty() {
                columns[count] = (column, field.components(D), reads.offset(field, D));
                count += 1;
                there = there.union(Fields::of(&[field]));
            }
        }
        Self {
            columns,
            count,
            there,
            list,
            sums_count,
        }
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
        load_sums(around.sums, &self.list[..self.sums_count], slot, sums);
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
    let given = Given::new(at, A::READS, A::SUMS);
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
            there: &given.there,
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
        let given = Given::new(at, A::READS, A::SUMS);
        let (mut numbers, mut sums) = ([0.0; MOST_READS], [0.0; MOST_SUMS]);
        given.load(&at.around, slot, (&mut numbers, &mut sums));
        PointLimit::step(
            self,
            &Point::<f64, D, OfLimit<T, A, D>> {
                numbers: &mut numbers,
                sums: &sums,
                there: &given.there,
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
