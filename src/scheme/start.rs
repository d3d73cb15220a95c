//! The state in which particles start: what a body gives, and what the fields of a scheme begin with.
//! Bodies and inlets place particles by the same rules.

use super::Scheme;
use crate::material::Material;
use crate::particles::{Columns, Field, Fields};
use crate::scalar::Real;

/// The state in which a particle starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<const D: usize> {
    /// Velocity \[m/s\].
    pub velocity: [f64; D],
    /// Density \[kg/m³\].
    pub density: f64,
    /// Specific internal energy \[J/kg\].
    pub energy: f64,
}

impl<T: Real, const D: usize> Scheme<T, D> {
    /// Writes a particle of a material, at a place \[m\] and a spacing \[m\], into a slot. What nothing here sets
    /// is zero.
    pub(crate) fn place(
        &self,
        columns: &mut Columns<T, D>,
        slot: usize,
        (material, spacing): (&Material<T>, f64),
        x: [f64; D],
        start: &Start<D>,
    ) {
        columns.clear_slot(slot);
        let rounded = x.map(T::from_f64);
        columns.vectors_mut(Field::POSITION)[slot] = rounded;
        if columns.fields().contains(Field::POSITION_RESIDUAL) {
            columns.vectors_mut(Field::POSITION_RESIDUAL)[slot] =
                core::array::from_fn(|d| T::from_f64(x[d] - rounded[d].to_f64()));
        }
        columns.vectors_mut(Field::VELOCITY)[slot] = start.velocity.map(T::from_f64);
        let mut set = |field: Field, value: f64| {
            let width = field.components(D);
            if let Some(own) = columns
                .raw_mut(field)
                .get_mut(slot * width..(slot + 1) * width)
            {
                own.fill(T::from_f64(value));
            }
        };
        set(Field::DENSITY, start.density);
        set(Field::REFERENCE_DENSITY, start.density);
        set(Field::MASS, start.density * spacing.powi(D as i32));
        set(Field::ENERGY, start.energy);
        set(Field::SMOOTHING_LENGTH, self.h_over_dx * spacing);
        let all = columns.fields();
        self.begin(columns, slot, material, all);
        if columns.fields().contains(Field::REFERENCE_POSITION) {
            columns.vectors_mut(Field::REFERENCE_POSITION)[slot] = rounded;
            // The body is free of stress where its rounded positions are.
            let residuals = columns.vectors_mut(Field::POSITION_RESIDUAL);
            if let Some(residual) = residuals.get_mut(slot) {
                *residual = [T::zero(); D];
            }
        }
    }

    /// Writes what those of `fields` start with that effects declare, into a slot of a particle of a material.
    pub(crate) fn begin(
        &self,
        columns: &mut Columns<T, D>,
        slot: usize,
        material: &Material<T>,
        fields: Fields,
    ) {
        let viscosity = material.rheology().map_or(0.0, |law| law.viscosity(0.0));
        let declared = self.program.declared.iter();
        let all = core::iter::once((Field::DYNAMIC_VISCOSITY, viscosity))
            .chain(declared.map(|own| (own.field, own.start)));
        for (field, value) in all.filter(|own| fields.contains(own.0)) {
            let width = field.components(D);
            columns.raw_mut(field)[slot * width..(slot + 1) * width].fill(T::from_f64(value));
        }
    }
}
