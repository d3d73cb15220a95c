//! Continuity: densities and smoothing lengths that follow the rate of compression.
//! Monaghan 1992; Vesenjak & Ren 2007, eq. 6, for smoothing lengths.

use super::{DensityForm, Rate, View};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;

/// The rate of compression (1/ρ) dρ/dt of a particle from its sum over neighbours: the growth of an integrated
/// density.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Compression {
    /// The form whose weights the sum of a drift has.
    pub density: DensityForm,
    /// The form whose weights the rates were summed with.
    pub pressure: DensityForm,
}

/// What particles know of their neighbourhood at rest; those of liquids know nothing.
const AT_REST: Fields = Fields::of(&[Field::REFERENCE_DENSITY, Field::CONSISTENCY_FACTOR]);

impl Compression {
    /// Adds `sign` times the rate to every number of `growth`.
    fn add<T: Real, const D: usize>(
        self,
        at: &View<'_, T, D>,
        first: usize,
        density: &[T],
        growth: &mut [T],
        sign: T,
    ) {
        let form = if at.around.in_drift {
            self.density
        } else {
            self.pressure
        };
        let [rest, moment] =
            [Field::REFERENCE_DENSITY, Field::CONSISTENCY_FACTOR].map(|field| at.column(field));
        let compression = at.sum(Output::COMPRESSION);
        let lattice = T::from_f64(at.around.lattice_consistency_factor);
        for (n, growth) in growth.iter_mut().enumerate() {
            let slot = first + n;
            let sum = compression.get(0, slot);
            let rest = rest.get(slot).copied().unwrap_or(T::one());
            let moment = moment.get(slot).copied().unwrap_or(lattice);
            *growth += sign * form.compression(sum, density[n], rest, moment);
        }
    }
}

impl<T: Real, const D: usize> Rate<T, D> for Compression {
    fn reads(&self) -> Fields {
        AT_REST
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[Output::COMPRESSION])
    }
    fn optional(&self) -> Fields {
        AT_REST
    }
    fn growth(&self, at: &View<'_, T, D>, first: usize, present: &[T], growth: &mut [T]) {
        self.add(at, first, present, growth, T::one());
    }
    fn source(&self, _at: &View<'_, T, D>, _first: usize, _source: &mut [T]) {}
}

/// The divergence of the velocity, by which the volume that a smoothing length spans grows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Divergence(pub Compression);

impl<T: Real, const D: usize> Rate<T, D> for Divergence {
    fn reads(&self) -> Fields {
        Fields::of(&[Field::DENSITY]).union(AT_REST)
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[Output::COMPRESSION])
    }
    fn optional(&self) -> Fields {
        AT_REST
    }
    fn growth(&self, at: &View<'_, T, D>, first: usize, present: &[T], growth: &mut [T]) {
        let density = &at.column(Field::DENSITY)[first..first + present.len()];
        self.0.add(at, first, density, growth, -T::one());
    }
    fn source(&self, _at: &View<'_, T, D>, _first: usize, _source: &mut [T]) {}
}
