//! Columns of particle data: one growable row of numbers for each field that a scene names.
//! A field that nobody names is an empty column.

use super::field::{Field, Fields, PLACES};
use crate::scalar::Real;

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
        let mut data = vec![Vec::new(); PLACES];
        for field in fields.iter() {
            data[field.place()] = vec![T::zero(); field.components(D) * slots];
        }
        Self {
            data,
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
        &self.data[field.place()]
    }

    /// The column of a field, mutable.
    #[inline]
    #[must_use]
    pub fn raw_mut(&mut self, field: Field) -> &mut [T] {
        &mut self.data[field.place()]
    }

    /// The column of a field as it is stored, to be taken out for a while and put back.
    pub(crate) fn column_mut(&mut self, field: Field) -> &mut Vec<T> {
        &mut self.data[field.place()]
    }

    /// Every column that is there, with its field, in the order of storage.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = (Field, &mut [T])> {
        let fields = self.fields;
        let columns = self.data.iter_mut().enumerate();
        let present = columns.filter(move |(place, _)| fields.has_place(*place));
        fields
            .iter()
            .zip(present.map(|(_, column)| column.as_mut_slice()))
    }

    /// A vector field as one array a slot.
    #[inline]
    #[must_use]
    pub fn vectors(&self, field: Field) -> &[[T; D]] {
        debug_assert_eq!(field.components(D), D);
        self.data[field.place()].as_chunks::<D>().0
    }

    /// A vector field as one array a slot, mutable.
    #[inline]
    #[must_use]
    pub fn vectors_mut(&mut self, field: Field) -> &mut [[T; D]] {
        debug_assert_eq!(field.components(D), D);
        self.data[field.place()].as_chunks_mut::<D>().0
    }

    /// Several different columns at once, mutable; all empty if a field is named twice.
    #[must_use]
    pub fn many_mut<const N: usize>(&mut self, fields: [Field; N]) -> [&mut [T]; N] {
        match self
            .data
            .get_disjoint_mut(fields.map(|field| field.place()))
        {
            Ok(columns) => columns.map(Vec::as_mut_slice),
            Err(_) => core::array::from_fn(|_| [].as_mut_slice()),
        }
    }

    /// Has columns for `fields` and no others: those that were not there are zero.
    pub(crate) fn set_fields(&mut self, fields: Fields) {
        for field in self.fields.minus(fields).iter() {
            self.data[field.place()] = Vec::new();
        }
        for field in fields.minus(self.fields).iter() {
            self.data[field.place()] = vec![T::zero(); field.components(D) * self.slots];
        }
        self.fields = fields;
    }

    /// Sets all fields of a slot to zero.
    pub(crate) fn clear_slot(&mut self, slot: usize) {
        for field in self.fields.iter() {
            let width = field.components(D);
            self.data[field.place()][slot * width..(slot + 1) * width].fill(T::zero());
        }
    }

    /// Rearranges the slots: slot k becomes what slot `order[k]` was.
    pub fn permute(&mut self, order: &[u32]) {
        self.slots = order.len();
        let mut sorted = Vec::new();
        for field in self.fields.iter() {
            let column = &mut self.data[field.place()];
            let width = field.components(D);
            sorted.clear();
            sorted.reserve(width * order.len());
            for &from in order {
                let from = from as usize * width;
                sorted.extend_from_slice(&column[from..from + width]);
            }
            core::mem::swap(column, &mut sorted);
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
