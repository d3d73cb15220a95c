//! Laws of points as objects: loops over rows of a chunk, the same for all of them.
//! Numbers of a row are loaded and stored here, so that a law compiles to its own arithmetic alone.

use super::access::Access;
use super::point::{AtWall, CONSTANTS, OfLaw};
use super::shifting::PLACE;
use super::{Around, Chunk, Law, Point, PointLaw, Rung, Tally};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, MOST_LANES, OnOwnRows, Real, on_wide_registers};
use crate::sweep::{Results, add_compensated};
use crate::tensor::{Matrix, Vector};
use crate::term::{MOST_READS, MOST_SUMS};
use core::ops::Range;

/// Most fields and most sums of a law, rate or limit.
pub(super) const MOST: usize = 32;

/// A number of the precision of a column as one of a law, or the other way round.
#[inline(always)]
pub(super) fn convert<A: Real, B: Real>(value: A) -> B {
    B::from_f64(value.to_f64())
}

/// The numbers of the particles at the start of a column, of `width` each; of a row that is not full the last particle is repeated.
#[inline(always)]
pub(super) fn load<T: Real, L: Lane>(column: &[T], width: usize, numbers: &mut [L]) {
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
pub(super) fn load_sums<T: Real, L: Lane, const D: usize>(
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
pub(super) fn places_of_sums<const D: usize>(
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
        on_wide_registers(OnChunk { law: self, chunk })
    }
    fn repeats(&self) -> Option<(usize, f64)> {
        self.repeated()
    }
    #[cfg(any(test, feature = "devices"))]
    fn record(&self, around: &Around<'_, T, D>, there: Fields) -> Option<super::PointRecord> {
        Some(super::recorded::law(self, around, there))
    }
}

/// A law that is due on a chunk.
struct OnChunk<'a, 'c, T: Real, A, const D: usize> {
    law: &'a A,
    chunk: &'a mut Chunk<'c, T, D>,
}

impl<T: Real, const D: usize, A: PointLaw<D>> OnOwnRows for OnChunk<'_, '_, T, A, D> {
    type Output = Tally;
    #[inline(always)]
    fn run(self) -> Tally {
        if A::DOUBLE {
            rows::<T, <f64 as Real>::Wide<false>, A, D>(self.law, self.chunk)
        } else {
            rows::<T, T::Wide<false>, A, D>(self.law, self.chunk)
        }
    }
}

/// A law over a chunk, row by row.
#[inline(always)]
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
pub(super) const fn assert_few<const D: usize>(fields: Fields, sums: Outputs) {
    assert!(
        fields.width(D) <= MOST_READS && fields.width(1) <= MOST,
        "a law, rate or limit of points declares more numbers than `meshfree::term::MOST_READS`, or more than 32 fields"
    );
    assert!(
        sums.width(D) <= MOST_SUMS && sums.width(1) <= MOST,
        "a law, rate or limit of points declares more sums than `meshfree::term::MOST_SUMS` numbers, or more than 32"
    );
}
