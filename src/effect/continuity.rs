//! Continuity: densities and smoothing lengths that follow the rate of compression.
//! Monaghan 1992; Vesenjak & Ren 2007, eq. 6, for smoothing lengths.

use super::{DensityForm, Point, PointRate, Reach};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

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
    /// The rate where the density is given.
    #[inline(always)]
    fn rate<L: Lane, P: Reach, const D: usize>(self, at: &Point<'_, L, D, P>, density: L) -> L {
        let form = if at.around.in_drift {
            self.density
        } else {
            self.pressure
        };
        let lattice = L::of(at.around.lattice_consistency_factor);
        let rest = at.get_or(Field::REFERENCE_DENSITY, L::one());
        let moment = at.get_or(Field::CONSISTENCY_FACTOR, lattice);
        form.compression(at.sum(Output::COMPRESSION), density, rest, moment)
    }
}

impl<const D: usize> PointRate<D> for Compression {
    const READS: Fields = AT_REST;
    const SUMS: Outputs = Outputs::of(&[Output::COMPRESSION]);
    const OPTIONAL: Fields = AT_REST;
    const GROWTH: bool = true;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, present: L, rate: &mut [L]) {
        rate[0] += self.rate(at, present);
    }
}

/// The divergence of the velocity, by which the volume that a smoothing length spans grows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Divergence(pub Compression);

impl<const D: usize> PointRate<D> for Divergence {
    const READS: Fields = Fields::of(&[Field::DENSITY]).union(AT_REST);
    const SUMS: Outputs = Outputs::of(&[Output::COMPRESSION]);
    const OPTIONAL: Fields = AT_REST;
    const GROWTH: bool = true;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, _present: L, rate: &mut [L]) {
        rate[0] -= self.0.rate(at, at.get(Field::DENSITY));
    }
}
