//! Packed records: what the pair loop reads of a particle, side by side in memory.
//! Images (mirrored, shifted) are records made from their source by a transform.

use crate::parallel::{cut, for_each};
use crate::particles::{Columns, Field, Fields, Shape};
use crate::scalar::{Lane, Real};
use crate::tensor::{Matrix, Symmetric, Vector};

/// How an image follows from its source.
///
#[doc = include_str!("../../docs/equations/image.html")]
///
/// Vectors turn with R, matrices M become R M Rᵀ, scalars stay. A reflection, a shift by a period, a
/// moving wall and any chain of them have this form.
#[derive(Clone, Debug, PartialEq)]
pub struct Transform<T, const D: usize> {
    /// Rotation or reflection R.
    pub rotation: Matrix<T, D>,
    /// Shift s \[m\].
    pub shift: Vector<T, D>,
    /// Velocity shift u \[m/s\].
    pub velocity: Vector<T, D>,
}

impl<T: Real, const D: usize> Transform<T, D> {
    /// The transform that changes nothing.
    #[must_use]
    pub fn identity() -> Self {
        let one = |r, c| if r == c { T::one() } else { T::zero() };
        Self {
            rotation: Matrix::from_fn(one),
            shift: Vector::from_element(T::zero()),
            velocity: Vector::from_element(T::zero()),
        }
    }
    /// The same in another scalar.
    pub(crate) fn to_scalar<U: Real>(&self) -> Transform<U, D> {
        Transform {
            rotation: self.rotation.map(|x| U::from_f64(x.to_f64())),
            shift: self.shift.map(|x| U::from_f64(x.to_f64())),
            velocity: self.velocity.map(|x| U::from_f64(x.to_f64())),
        }
    }
    /// First `self`, then `other`.
    #[must_use]
    pub fn then(&self, other: &Self) -> Self {
        Self {
            rotation: other.rotation * self.rotation,
            shift: other.rotation * self.shift + other.shift,
            velocity: other.rotation * self.velocity + other.velocity,
        }
    }
    /// A number of it that is not finite.
    pub(crate) fn not_finite(&self) -> Option<f64> {
        let rotation = self.rotation.iter();
        let moved = self.shift.iter().chain(self.velocity.iter());
        let numbers = rotation.chain(moved).map(|x| x.to_f64());
        numbers.into_iter().find(|x| !x.is_finite())
    }
    /// Whether it changes velocities.
    pub(crate) fn turns(&self) -> bool {
        let Self {
            rotation, velocity, ..
        } = Self::identity();
        self.rotation != rotation || self.velocity != velocity
    }
    /// The image of a point.
    #[must_use]
    pub fn point(&self, x: &[T; D]) -> [T; D] {
        (self.rotation * Vector::from(*x) + self.shift).into()
    }
    /// The velocity of the image of what moves with `v` \[m/s\].
    #[must_use]
    pub fn velocity_of(&self, v: &[T; D]) -> [T; D] {
        (self.rotation * Vector::from(*v) + self.velocity).into()
    }
    /// Moves the particle in `slot` of columns of positions, their rounding errors (empty where they
    /// are not kept) and velocities.
    pub(crate) fn re_enter(&self, slot: usize, x: &mut [T], residual: &mut [T], v: &mut [T]) {
        let own = slot * D..(slot + 1) * D;
        let turned = self.rotation * Vector::<T, D>::from_row_slice(&x[own.clone()]);
        let mut lost = Vector::<T, D>::from_element(T::zero());
        for d in 0..D {
            (x[own.start + d], lost[d]) = two_sum(turned[d], self.shift[d]);
        }
        if let Some(residual) = residual.get_mut(own.clone()) {
            let turned = self.rotation * Vector::<T, D>::from_row_slice(residual) + lost;
            residual.copy_from_slice(turned.as_slice());
        }
        self.turn(slot, v);
    }
    /// Turns a vector, tensor or matrix field of the particle in `slot`, other than place and velocity.
    pub(crate) fn turn_field(&self, field: Field, slot: usize, column: &mut [T]) {
        let width = field.components(D);
        if let Some(values) = column.get_mut(slot * width..(slot + 1) * width) {
            self.turn_values(field, values);
        }
    }
    /// The numbers of a field of the image.
    pub(crate) fn of_field(
        &self,
        field: Field,
        own: &[T],
    ) -> impl Iterator<Item = f64> + use<T, D> {
        let mut values = own.to_vec();
        match field.shape() {
            Shape::Point => values.copy_from_slice(&self.point(&core::array::from_fn(|d| own[d]))),
            Shape::Velocity => self.turn(0, &mut values),
            _ => self.turn_values(field, &mut values),
        }
        values.into_iter().map(Real::to_f64)
    }
    fn turn_values(&self, field: Field, values: &mut [T]) {
        let rotation = &self.rotation;
        match field.shape() {
            Shape::Scalar => {}
            Shape::Matrix => {
                let matrix = Matrix::<T, D>::from_row_slice(values);
                let turned = rotation * matrix * rotation.transpose();
                for (k, value) in values.iter_mut().enumerate() {
                    *value = turned[(k / D, k % D)];
                }
            }
            Shape::Tensor => {
                let turned = Symmetric::from_slice(values).rotated(rotation);
                values.copy_from_slice(turned.components());
            }
            Shape::Point | Shape::Velocity | Shape::Vector => {
                let turned = rotation * Vector::<T, D>::from_row_slice(values);
                values.copy_from_slice(turned.as_slice());
            }
        }
    }
    /// Turns the velocity of the particle in `slot`.
    pub(crate) fn turn(&self, slot: usize, v: &mut [T]) {
        let v = &mut v[slot * D..(slot + 1) * D];
        let turned = self.rotation * Vector::<T, D>::from_row_slice(v) + self.velocity;
        v.copy_from_slice(turned.as_slice());
    }
}

/// An image: a source slot seen through a transform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Image {
    /// The slot of the particle.
    pub source: u32,
    /// Index into the table of transforms.
    pub transform: u32,
}

/// Particles that another process has: their records stand between those of slots and those of images.
pub trait Ghosts<T>: core::fmt::Debug + Send + Sync {
    /// How many there are.
    fn count(&self) -> usize;
    /// Gives others `stride` numbers a slot of what they have as ghosts, and gets as many of each ghost; meanwhile it does what needs none
    /// of them, once.
    fn fill(&self, own: &[T], stride: usize, ghosts: &mut [T], meanwhile: &mut dyn FnMut());
}

/// The packed records of a sweep.
#[derive(Clone, Debug, Default)]
pub struct Records<T> {
    data: Vec<T>,
    stride: usize,
}

impl<T: Real> Records<T> {
    /// All records, one after another.
    #[must_use]
    pub fn data(&self) -> &[T] {
        &self.data
    }

    /// All records, as of which others may be made.
    pub(crate) fn into_data(self) -> Vec<T> {
        self.data
    }

    /// Numbers a record.
    pub(crate) fn stride(&self) -> usize {
        self.stride
    }

    /// Records of `stride` numbers as they were [stored](Self::data).
    pub(crate) fn of_stored(data: Vec<T>, stride: usize) -> Self {
        Self { data, stride }
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.data.capacity() * size_of::<T>()
    }

    /// Packs `reads` of all slots, of ghosts behind them, and of images; while ghosts come, it shows the others to `meanwhile`. Reuses
    /// memory; grows only when particles were added.
    pub fn pack<const D: usize>(
        &mut self,
        reads: Fields,
        columns: &Columns<T, D>,
        ghosts: Option<&dyn Ghosts<T>>,
        (images, transforms): (&[Image], &[Transform<T, D>]),
        meanwhile: &mut dyn FnMut(&Self),
    ) {
        let (stride, slots) = (reads.width(D), columns.slots());
        let count = ghosts.map_or(0, |ghosts| ghosts.count());
        self.stride = stride;
        let length = stride * (slots + count + images.len());
        if length > self.data.capacity() {
            // Growth by itself takes twice the memory, which is more than a few images are worth; all is packed anew anyhow.
            self.data = Vec::with_capacity(length + length / 32);
        }
        self.data.resize(length, T::zero());
        let own = &mut self.data[..stride * slots];
        for_each(cut(own, GRAIN * stride), |chunk, records| {
            let first = chunk * GRAIN;
            let count = records.len() / stride.max(1);
            let mut offset = 0;
            for field in reads.iter() {
                let width = field.components(D);
                let column = &columns.raw(field)[first * width..(first + count) * width];
                let records = records.chunks_exact_mut(stride);
                // Widths that the compiler knows: a copy of three numbers is not worth a call.
                match field.shape() {
                    Shape::Scalar => {
                        for (record, &value) in records.zip(column) {
                            record[offset] = value;
                        }
                    }
                    Shape::Tensor => copy::<T, 6>(records, offset, column),
                    Shape::Matrix => match width {
                        9 => copy::<T, 9>(records, offset, column),
                        4 => copy::<T, 4>(records, offset, column),
                        _ => copy::<T, 1>(records, offset, column),
                    },
                    _ => copy::<T, D>(records, offset, column),
                }
                offset += width;
            }
        });
        if let Some(ghosts) = ghosts {
            let mut come = vec![T::zero(); stride * count];
            let own = &self.data[..stride * slots];
            ghosts.fill(own, stride, &mut come, &mut || meanwhile(self));
            self.data[stride * slots..][..come.len()].copy_from_slice(&come);
        }
        self.show(reads, slots + count, images, transforms);
    }

    /// Makes the records of images, which stand behind so many others.
    pub(crate) fn show<const D: usize>(
        &mut self,
        reads: Fields,
        slots: usize,
        images: &[Image],
        transforms: &[Transform<T, D>],
    ) {
        let stride = self.stride;
        self.data.resize(stride * (slots + images.len()), T::zero());
        let (own, mirrored) = self.data.split_at_mut(stride * slots);
        let own: &[T] = own;
        for_each(cut(mirrored, GRAIN * stride), |chunk, records| {
            let records = records.chunks_exact_mut(stride.max(1));
            for (record, image) in records.zip(&images[chunk * GRAIN..]) {
                let source = image.source as usize * stride;
                record.copy_from_slice(&own[source..source + stride]);
                let by = &transforms[image.transform as usize];
                // Most images are those of periods, where nothing but the place is another.
                if by.turns() {
                    reflect(record, reads, by);
                } else {
                    shift(record, reads, &by.shift);
                }
            }
        });
    }
}

impl<T: Real> Records<T> {
    /// Renews one velocity or other vector of records packed with `reads`, and leaves the rest as it was.
    pub fn renew<const D: usize>(
        &mut self,
        field: Field,
        reads: Fields,
        columns: &Columns<T, D>,
        ghosts: Option<&dyn Ghosts<T>>,
        (images, transforms): (&[Image], &[Transform<T, D>]),
    ) {
        let (offset, slots) = (reads.offset(field, D), columns.slots());
        let values = columns.vectors(field);
        let count = ghosts.map_or(0, |ghosts| ghosts.count());
        let stride = self.stride;
        let (own, mirrored) = self.data.split_at_mut(stride * (slots + count));
        let (own, others) = own.split_at_mut(stride * slots);
        let mut near = vec![T::zero(); D * count];
        if let Some(ghosts) = ghosts {
            ghosts.fill(values.as_flattened(), D, &mut near, &mut || {});
        }
        let near = near.as_chunks::<D>().0;
        for (record, value) in others.chunks_exact_mut(stride.max(1)).zip(near) {
            record[offset..offset + D].copy_from_slice(value);
        }
        for_each(cut(own, GRAIN * stride), |chunk, records| {
            let records = records.chunks_exact_mut(stride);
            for (record, value) in records.zip(&values[chunk * GRAIN..]) {
                record[offset..offset + D].copy_from_slice(value);
            }
        });
        for (record, image) in mirrored.chunks_mut(self.stride).zip(images) {
            let by = &transforms[image.transform as usize];
            let source = image.source as usize;
            let of = values.get(source).unwrap_or_else(|| &near[source - slots]);
            let mut value = by.rotation * Vector::from(*of);
            if field.shape() == Shape::Velocity {
                value += by.velocity;
            }
            record[offset..offset + D].copy_from_slice(value.as_slice());
        }
    }
}

/// Copies `W` numbers of each particle into its record.
fn copy<'a, T: Real, const W: usize>(
    records: impl Iterator<Item = &'a mut [T]>,
    offset: usize,
    column: &[T],
) {
    for (record, values) in records.zip(column.as_chunks::<W>().0) {
        record[offset..offset + W].copy_from_slice(values);
    }
}

/// Turns a copy of the source's record into the image's.
fn reflect<T: Real, const D: usize>(record: &mut [T], reads: Fields, by: &Transform<T, D>) {
    // What rounding the image's position loses goes into its residual, where there is one.
    let mut lost = [T::zero(); D];
    let mut offset = 0;
    for field in reads.iter() {
        let values = &mut record[offset..offset + field.components(D)];
        match field.shape() {
            Shape::Scalar | Shape::Matrix | Shape::Tensor => by.turn_values(field, values),
            shape => {
                let turned = by.rotation * Vector::<T, D>::from_row_slice(values);
                for d in 0..D {
                    values[d] = match shape {
                        Shape::Point => {
                            let (sum, error) = two_sum(turned[d], by.shift[d]);
                            lost[d] = error;
                            sum
                        }
                        Shape::Velocity => turned[d] + by.velocity[d],
                        _ if field == Field::POSITION_RESIDUAL => turned[d] + lost[d],
                        _ => turned[d],
                    };
                }
            }
        }
        offset += field.components(D);
    }
}

/// Turns a copy of the source's record into that of an image by a shift alone: the same numbers as [`reflect`] makes,
/// without its products.
fn shift<T: Real, const D: usize>(record: &mut [T], reads: Fields, by: &Vector<T, D>) {
    let mut lost = [T::zero(); D];
    let mut offset = 0;
    for field in reads.iter() {
        if field.shape() == Shape::Point {
            for d in 0..D {
                let (sum, error) = two_sum(record[offset + d], by[d]);
                (record[offset + d], lost[d]) = (sum, error);
            }
        } else if field == Field::POSITION_RESIDUAL {
            for d in 0..D {
                record[offset + d] += lost[d];
            }
        }
        offset += field.components(D);
    }
}

/// Particles whose records are packed at once: so few that these stay in the first cache from field to field.
const GRAIN: usize = 256;

/// The rounded sum and its exact rounding error (Knuth 1969).
#[inline(always)]
pub(crate) fn two_sum<L: Lane>(a: L, b: L) -> (L, L) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// y ← y + change, with the rounding error kept where there is a place for it.
#[inline(always)]
pub(crate) fn add_compensated<T: Real>(y: &mut T, residual: Option<&mut T>, change: T) {
    match residual {
        Some(residual) => (*y, *residual) = two_sum(*y, *residual + change),
        None => *y += change,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::name;

    #[test]
    fn an_image_of_an_image_is_the_composed_transform() {
        let turn = Transform::<f64, 2> {
            rotation: Matrix::<f64, 2>::new(0.0, -1.0, 1.0, 0.0),
            shift: Vector::<f64, 2>::new(1.0, 2.0),
            velocity: Vector::zeros(),
        };
        let twice = turn.then(&turn);
        let x = [0.3, -0.7];
        let (composed, stepwise) = (twice.point(&x), turn.point(&turn.point(&x)));
        for d in 0..2 {
            assert!((composed[d] - stepwise[d]).abs() < 1e-15);
        }
    }

    #[test]
    fn a_period_makes_the_same_image_with_and_without_products() {
        let reads = Fields::of(&[
            Field::POSITION,
            Field::REFERENCE_POSITION,
            Field::VELOCITY,
            Field::MASS,
            Field::POSITION_RESIDUAL,
            Field::tensor(name!("stress", "Pa")),
        ]);
        let period = Transform::<f32, 3> {
            shift: Vector::<f32, 3>::new(0.7, -0.3, 0.0),
            ..Transform::identity()
        };
        assert!(!period.turns());
        let record: Vec<f32> = (0..reads.width(3)).map(|k| (k as f32).sin()).collect();
        let (mut by_products, mut by_sums) = (record.clone(), record.clone());
        reflect(&mut by_products, reads, &period);
        shift(&mut by_sums, reads, &period.shift);
        assert_eq!(by_products, by_sums);
        assert_ne!(by_sums, record);
    }

    #[test]
    fn rounding_of_an_image_goes_into_the_residual() {
        let reads = Fields::of(&[Field::POSITION, Field::POSITION_RESIDUAL]);
        let mirror = Transform::<f32, 1> {
            rotation: Matrix::<f32, 1>::new(-1.0),
            shift: Vector::<f32, 1>::new(0.02),
            velocity: Vector::zeros(),
        };
        let mut record = [0.009_987_654, 1e-11];
        let exact = f64::from(0.02_f32) - f64::from(record[0]) - f64::from(record[1]);
        reflect(&mut record, reads, &mirror);
        let image = f64::from(record[0]) + f64::from(record[1]);
        assert!((image - exact).abs() < 1e-17);
    }
}
