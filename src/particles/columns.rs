//! Columns of particle data: one growable row of numbers for each field that a scene names.
//! A field that no part declares is an empty column.

use super::field::{Field, Fields};
use crate::scalar::Real;
use std::ops::Range;

/// The particles of a group, one column a field.
///
/// Particles stand in slots. Each body owns a run of slots whose length is a whole number of
/// clusters; the slots behind its last particle repeat that particle, so the pair loop always works
/// on full rows. Sums over particles use the body's own range and never see the repeats.
#[derive(Clone, Debug)]
pub struct Columns<T, const D: usize> {
    data: Vec<Vec<T>>,
    fields: Fields,
    slots: usize,
}

impl<T: Real, const D: usize> Columns<T, D> {
    /// Columns for `fields`, all zero.
    #[must_use]
    pub fn new(fields: Fields, slots: usize) -> Self {
        let mut columns = Self {
            data: Vec::new(),
            fields: Fields::NONE,
            slots,
        };
        columns.set_fields(fields);
        columns
    }

    /// Columns that have no numbers yet.
    pub(crate) fn without_numbers(fields: Fields, slots: usize) -> Self {
        Self {
            data: vec![Vec::new(); Fields::PLACES + 1],
            fields,
            slots,
        }
    }

    /// Number of slots, repeats included.
    #[must_use]
    pub fn slots(&self) -> usize {
        self.slots
    }

    /// The fields that have a column.
    #[must_use]
    pub fn fields(&self) -> Fields {
        self.fields
    }

    /// Bytes of a particle in these columns.
    #[must_use]
    pub fn bytes_per_particle(&self) -> usize {
        self.fields.width(D) * size_of::<T>()
    }

    /// The column of a field, `components` numbers a slot; empty if the scene does not name it.
    #[inline]
    #[must_use]
    pub fn raw(&self, field: Field) -> &[T] {
        (self.fields.place(field)).map_or(&[], |place| &self.data[place])
    }

    /// The column of a field, mutable.
    #[inline]
    #[must_use]
    pub fn raw_mut(&mut self, field: Field) -> &mut [T] {
        (self.fields.place(field)).map_or(&mut [], |place| &mut self.data[place])
    }

    /// The column of a field that has one as it is stored, to be taken out for a while and restored.
    pub(crate) fn column_mut(&mut self, field: Field) -> &mut Vec<T> {
        // The last column is of no field.
        let place = self.fields.place(field).unwrap_or(Fields::PLACES);
        &mut self.data[place]
    }

    /// Every column that is there, with its field, in the order of storage.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = (Field, &mut [T])> {
        let (fields, mut columns) = (self.fields, self.data.iter_mut().enumerate());
        fields.iter().filter_map(move |field| {
            let place = fields.place(field);
            let (_, column) = columns.find(|(own, _)| Some(*own) == place)?;
            Some((field, column.as_mut_slice()))
        })
    }

    /// A vector field as one array a slot.
    #[inline]
    #[must_use]
    pub fn vectors(&self, field: Field) -> &[[T; D]] {
        debug_assert_eq!(field.components(D), D);
        self.raw(field).as_chunks::<D>().0
    }

    /// A vector field as one array a slot, mutable.
    #[inline]
    #[must_use]
    pub fn vectors_mut(&mut self, field: Field) -> &mut [[T; D]] {
        debug_assert_eq!(field.components(D), D);
        self.raw_mut(field).as_chunks_mut::<D>().0
    }

    /// Several different columns at once, mutable; one that is named twice is empty the second time.
    #[must_use]
    pub fn many_mut<const N: usize>(&mut self, fields: [Field; N]) -> [&mut [T]; N] {
        let mut found = core::array::from_fn(|_| [].as_mut_slice());
        for (own, column) in self.iter_mut() {
            if let Some(k) = fields.iter().position(|field| field.is(own)) {
                found[k] = column;
            }
        }
        found
    }

    /// Has columns for `fields` and no others: those that were not there are zero.
    pub(crate) fn set_fields(&mut self, fields: Fields) {
        let mut data = vec![Vec::new(); Fields::PLACES + 1];
        for field in fields.iter() {
            let Some(place) = fields.place(field) else {
                continue;
            };
            data[place] = if self.fields.contains(field) {
                core::mem::take(self.column_mut(field))
            } else {
                vec![T::zero(); field.components(D) * self.slots]
            };
        }
        (self.data, self.fields) = (data, fields);
    }

    /// Sets all fields of a slot to zero.
    pub(crate) fn clear_slot(&mut self, slot: usize) {
        for field in self.fields.iter() {
            let width = field.components(D);
            self.raw_mut(field)[slot * width..(slot + 1) * width].fill(T::zero());
        }
    }

    /// Goes on with so many slots, whose columns have been put here.
    pub(crate) fn set_slots(&mut self, slots: usize) {
        self.slots = slots;
    }

    /// Takes the numbers of some runs of slots out, one run after another, and frees all others: the fields are left without numbers.
    pub(crate) fn take_runs(&mut self, runs: &[Range<usize>]) -> Self {
        let mut some = Self {
            data: core::mem::replace(&mut self.data, vec![Vec::new(); Fields::PLACES + 1]),
            fields: self.fields,
            slots: runs.iter().map(Range::len).sum(),
        };
        for field in self.fields.iter() {
            let width = field.components(D);
            let (column, mut end) = (some.column_mut(field), 0);
            let is_here = !column.is_empty();
            for run in runs.iter().filter(|_| is_here) {
                column.copy_within(width * run.start..width * run.end, end);
                end += width * run.len();
            }
            column.truncate(end);
            column.shrink_to_fit();
        }
        some
    }

    /// Rearranges the slots: slot k becomes what slot `order[k]` was.
    pub fn permute(&mut self, order: &[u32]) {
        self.slots = order.len();
        for field in self.fields.iter() {
            let column = self.column_mut(field);
            if column.is_empty() {
                continue;
            }
            let width = field.components(D);
            // Of its own length: what served a vector would keep the memory of one.
            let mut sorted = Vec::with_capacity(width * order.len());
            for &from in order {
                let from = from as usize * width;
                sorted.extend_from_slice(&column[from..from + width]);
            }
            *column = sorted;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absent_fields_take_no_memory_and_permutation_moves_all() {
        let fields = Fields::of(&[Field::POSITION, Field::DENSITY]);
        let mut columns = Columns::<f64, 2>::new(fields, 3);
        assert!(columns.raw(Field::ENERGY).is_empty());
        assert_eq!(columns.bytes_per_particle(), 24);
        for k in 0..3 {
            columns.vectors_mut(Field::POSITION)[k] = [k as f64, -(k as f64)];
            columns.raw_mut(Field::DENSITY)[k] = 10.0 * k as f64;
        }
        columns.permute(&[2, 0, 1]);
        assert_eq!(columns.vectors(Field::POSITION)[0], [2.0, -2.0]);
        assert_eq!(columns.raw(Field::DENSITY), [20.0, 0.0, 10.0]);
    }
}
