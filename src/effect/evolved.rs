//! Fields that are integrated in time: by which rate, how, when, and whether their rounding is kept.
//! Integrators, prediction, save and combine, insertion, checkpoint and output take it from here.

use super::access::{Access, Summed};
use super::gradients::{GRADIENT_SUMS, velocity_gradient};
use super::{Around, Limit};
use crate::particles::{Columns, Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::tensor::Matrix;
use core::fmt::Debug;

/// When an evolved field changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// With velocity, by the rates of an evaluation; predicted with it.
    Kick,
    /// In the middle of a drift, by sums that are taken there.
    Drift,
}

/// How an evolved field changes over dt by dY/dt = g Y + s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Update {
    /// Y ← Y + dt (g Y + s).
    Increment,
    /// Y ← Y + (e^(g dt) − 1) Y + dt s, for what must stay positive.
    Exponential,
    /// Y ← Y e^(g dt/D) for a length that spans a volume which grows by g, held between two limits; what is held
    /// is counted.
    Within {
        /// Smallest length in units of the smoothing length η dx of the body as built.
        smallest: f64,
        /// Largest length in the same units.
        largest: f64,
    },
    /// Y ← R (Y + dt (g Y + s)) Rᵀ for a symmetric tensor, with R the rotation by the spin ½ (∇v − ∇vᵀ) over dt: the
    /// Jaumann rate, integrated so that a rigid rotation is exact (Hughes & Winget 1980). The spin is that of
    /// [`View::velocity_gradient`].
    Rotated,
}

/// What a rate or a limit sees: the columns as they are, and what is around.
#[derive(Clone, Copy, Debug)]
pub struct View<'a, T: Real, const D: usize> {
    pub(super) columns: &'a Columns<T, D>,
    pub(super) access: Access,
    /// What is around the particles asked about; its material is that of their body.
    pub around: Around<'a, T, D>,
}

impl<'a, T: Real, const D: usize> View<'a, T, D> {
    pub(crate) fn new(columns: &'a Columns<T, D>, around: Around<'a, T, D>) -> Self {
        Self {
            columns,
            access: Access::DRIVER,
            around,
        }
    }
    /// The same for a rate of a field, which reaches what it declares.
    pub(crate) fn of_rate(self, rate: &dyn Rate<T, D>, field: Field) -> Self {
        Self {
            access: Access::of_rate(rate, field),
            ..self
        }
    }
    /// The same for a limit.
    pub(crate) fn of_limit(self, limit: &dyn Limit<T, D>) -> Self {
        Self {
            access: Access::of_limit(limit),
            ..self
        }
    }
    /// The column of a field, `components` numbers a slot; empty for the field that is under way, and where the scheme does
    /// not have a field that is declared [optional](Rate::optional).
    ///
    /// # Panics
    /// If the rate or limit does not declare it.
    #[inline]
    #[track_caller]
    #[must_use]
    pub fn column(&self, field: Field) -> &'a [T] {
        self.access.read(field);
        self.columns.raw(field)
    }
    /// A sum of particles, by their slots.
    ///
    /// # Panics
    /// If the rate or limit does not declare it.
    #[inline]
    #[track_caller]
    #[must_use]
    pub fn sum(&self, output: Output) -> Summed<'a, T, D> {
        self.access.sum(output);
        Summed::new(self.around.sums, output, 0)
    }
    /// The corrected velocity gradient ∂vₐ/∂x_b \[1/s\] of the particle in `slot`: from the sums of a
    /// [term](crate::term::VelocityGradient) in the same sweep, as at the middle of a drift, and else from
    /// [`Field::VELOCITY_GRADIENT`].
    ///
    /// # Panics
    /// If the rate or limit declares neither the sums `VELOCITY_GRADIENT` and `MOMENT_MATRIX` nor the field.
    #[track_caller]
    #[must_use]
    pub fn velocity_gradient(&self, slot: usize) -> Matrix<T, D> {
        let summed = self.around.sums.offset(Output::VELOCITY_GRADIENT);
        let by_field = self.access.reads(Field::VELOCITY_GRADIENT);
        if summed.is_some() || !by_field {
            return velocity_gradient(GRADIENT_SUMS.map(|sum| self.sum(sum)), slot);
        }
        let gradient = self.column(Field::VELOCITY_GRADIENT);
        Matrix::from_fn(|a, b| gradient[slot * D * D + a * D + b])
    }
    /// Its antisymmetric part ½ (∇v − ∇vᵀ) \[1/s\].
    #[track_caller]
    #[must_use]
    pub fn spin(&self, slot: usize) -> Matrix<T, D> {
        let gradient = self.velocity_gradient(slot);
        (gradient - gradient.transpose()) * T::from_f64(0.5)
    }
}

/// A part of dY/dt = g Y + s of an evolved field.
///
/// Several effects may contribute to one field; the parts add.
pub trait Rate<T: Real, const D: usize>: Debug + Send + Sync {
    /// Fields that it reads; it reaches no others.
    fn reads(&self) -> Fields;
    /// Sums that it reads.
    fn sums(&self) -> Outputs;
    /// Those of `reads` that it uses where the scheme has them for other reasons, and does without elsewhere.
    fn optional(&self) -> Fields {
        Fields::NONE
    }
    /// Adds g \[1/s\] of the particles from slot `first` on, one number a particle. `present` are their values.
    fn growth(&self, _at: &View<'_, T, D>, _first: usize, _present: &[T], _growth: &mut [T]) {}
    /// Adds s, `components` numbers a particle from slot `first` on.
    fn source(&self, at: &View<'_, T, D>, first: usize, source: &mut [T]);
    /// What the parts of a rate are ordered by, before their debug text: the name of the type.
    fn name(&self) -> &'static str {
        core::any::type_name::<Self>()
    }
    /// Its record, if it is lane text.
    #[cfg(any(test, feature = "devices"))]
    fn record(&self, _view: &View<'_, T, D>) -> Option<super::PointRecord> {
        None
    }
}

/// The rate that is a sum over neighbours, over another field of the particle if one is named.
#[derive(Clone, Copy, Debug)]
pub struct BySum {
    /// The sum Σⱼ.
    pub sum: Output,
    /// What it is divided by, as [`Field::MASS`].
    pub over: Option<Field>,
}

impl BySum {
    /// A sum over the mass of the particle, as forces and flows of heat are.
    #[must_use]
    pub const fn over_mass(sum: Output) -> Self {
        Self {
            sum,
            over: Some(Field::MASS),
        }
    }
    /// The rate of a particle, of its sum and what that is divided by.
    #[inline(always)]
    pub(super) fn point<L: Lane>(sum: L, over: Option<L>) -> L {
        over.map_or(sum, |over| sum / over)
    }
}

impl<T: Real, const D: usize> Rate<T, D> for BySum {
    fn reads(&self) -> Fields {
        self.over.map_or(Fields::NONE, |field| Fields::of(&[field]))
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[self.sum])
    }
    fn source(&self, at: &View<'_, T, D>, first: usize, source: &mut [T]) {
        let width = self.sum.components(D);
        let over = self.over.map(|field| at.column(field));
        let summed = at.sum(self.sum);
        for (n, values) in source.chunks_exact_mut(width).enumerate() {
            for (k, value) in values.iter_mut().enumerate() {
                *value += Self::point(summed.get(k, first + n), over.map(|over| over[first + n]));
            }
        }
    }
    #[cfg(any(test, feature = "devices"))]
    fn record(&self, _view: &View<'_, T, D>) -> Option<super::PointRecord> {
        Some(super::recorded::by_sum::<T, D>(self))
    }
}

/// The rate that a law has written into another field.
#[derive(Clone, Copy, Debug)]
pub struct ByField(pub Field);

impl<T: Real, const D: usize> Rate<T, D> for ByField {
    fn reads(&self) -> Fields {
        Fields::of(&[self.0])
    }
    fn sums(&self) -> Outputs {
        Outputs::NONE
    }
    fn source(&self, at: &View<'_, T, D>, first: usize, source: &mut [T]) {
        let own = &at.column(self.0)[first * self.0.components(D)..];
        for (value, own) in source.iter_mut().zip(own) {
            *value += *own;
        }
    }
}

/// A field that is integrated in time.
///
/// Of fields that change together, one whose rate reads another changes before it; else they change in the order of their
/// names. Where each reads the other the scheme is refused.
#[derive(Debug)]
pub struct Evolved<T: Real, const D: usize> {
    /// The field.
    pub field: Field,
    /// Where the rounding error of its updates is kept, if it is.
    pub residual: Option<Field>,
    /// When it changes.
    pub when: When,
    /// How it changes.
    pub update: Update,
    /// The parts of its rate.
    pub rates: Vec<Box<dyn Rate<T, D>>>,
}

impl<T: Real, const D: usize> Evolved<T, D> {
    /// A field that is kicked by increments; its rates are added with [`by`](Self::by).
    #[must_use]
    pub fn kicked(field: Field) -> Self {
        Self {
            field,
            residual: None,
            when: When::Kick,
            update: Update::Increment,
            rates: Vec::new(),
        }
    }
    /// With another update.
    #[must_use]
    pub fn updated(self, update: Update) -> Self {
        Self { update, ..self }
    }
    /// That changes at another time.
    #[must_use]
    pub fn at(self, when: When) -> Self {
        Self { when, ..self }
    }
    /// Whose rounding is kept in a field of its own where the scalar is `f32`.
    #[must_use]
    pub fn keeping(self, residual: Field) -> Self {
        Self {
            residual: T::COMPENSATED.then_some(residual),
            ..self
        }
    }
    /// Whether its rate reads another field, which changes at the same time, as it is before that.
    pub(crate) fn precedes(&self, other: &Self) -> bool {
        let mut reads = self.rates.iter().map(|rate| rate.reads());
        self.field != other.field
            && self.when == other.when
            && reads.any(|fields| fields.contains(other.field))
    }
    /// With a part of its rate.
    #[must_use]
    pub fn by(mut self, rate: impl Rate<T, D> + 'static) -> Self {
        self.rates.push(Box::new(rate));
        self
    }
}
