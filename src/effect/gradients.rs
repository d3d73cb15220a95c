//! Gradients that are exact for linear fields, from the sums of their sweep.
//! Randles & Libersky 1996; Bonet & Lok 1999.

use super::access::Summed;
use super::{Point, PointLaw, Reach};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::tensor::{Matrix, Square, inverse};

/// Gradients and corrections, as far as the scheme carries them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CorrectedGradients {
    /// What the sweep has to sum.
    pub wanted: Fields,
    /// Whether kernels are the [weights](crate::term::Pair::weight_i), and their scale belongs to the correction.
    pub by_kernel: bool,
}

/// The gradients that are sums before they are corrected.
const SUMMED: [(Field, Output); 3] = [
    (Field::VELOCITY_GRADIENT, Output::VELOCITY_GRADIENT),
    (Field::PRESSURE_GRADIENT, Output::PRESSURE_GRADIENT),
    (Field::DENSITY_GRADIENT, Output::DENSITY_GRADIENT),
];

impl<const D: usize> PointLaw<D> for CorrectedGradients {
    const NAME: &'static str = "corrected gradients";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[SUMMED[0].0, SUMMED[1].0, SUMMED[2].0, Field::CORRECTION]);
    const SUMS: Outputs =
        Outputs::of(&[SUMMED[0].1, SUMMED[1].1, SUMMED[2].1, Output::MOMENT_MATRIX]);
    fn summed(&self) -> Outputs {
        let wanted = SUMMED
            .iter()
            .filter(|(field, _)| self.wanted.contains(*field));
        let moments = Outputs::of(&[Output::MOMENT_MATRIX]);
        wanted.fold(moments, |all, (_, sum)| all.union(Outputs::of(&[*sum])))
    }
    fn written(&self) -> Fields {
        self.wanted
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        // Once for all that it corrects.
        let correction = if self.by_kernel {
            scaled_correction(at)
        } else {
            at.correction()
        };
        if self.wanted.contains(Field::CORRECTION) {
            at.set_matrix(Field::CORRECTION, &correction);
        }
        if self.wanted.contains(Field::VELOCITY_GRADIENT) {
            let gradient = at.sum_matrix(Output::VELOCITY_GRADIENT).times(&correction);
            at.set_matrix(Field::VELOCITY_GRADIENT, &gradient);
        }
        for (field, sum) in [SUMMED[1], SUMMED[2]] {
            if self.wanted.contains(field) {
                for b in 0..D {
                    let mut total = L::zero();
                    for a in 0..D {
                        total += at.sum_at(sum, a) * correction.0[a][b];
                    }
                    at.set_at(field, b, total);
                }
            }
        }
    }
}

/// The inverse of the moment matrix whatever its scale. Where neighbours lie along a line or in a sheet, by a pivot below
/// [`SINGULAR`], it is that of the mean over directions: the uncorrected gradient. Such particles are counted.
#[inline(always)]
fn scaled_correction<L: Lane, const D: usize, P: Reach>(
    at: &mut Point<'_, L, D, P>,
) -> Square<L, D> {
    let moments = at.sum_matrix(Output::MOMENT_MATRIX);
    let (mut correction, singular) = moments.inverse(SINGULAR);
    let mut trace = L::zero();
    for a in 0..D {
        trace += moments.0[a][a];
    }
    let alone = trace.le(L::zero());
    let mean = L::select(alone, L::zero(), L::of(D as f64) / trace);
    for a in 0..D {
        for b in 0..D {
            let uncorrected = if a == b { mean } else { L::zero() };
            correction.0[a][b] = L::select(singular, uncorrected, correction.0[a][b]);
        }
    }
    at.limited(singular & !alone);
    correction
}

/// The inverse of a particle's moment matrix, from the sum of it.
pub(super) fn correction<T: Real, const D: usize>(
    moments: Summed<'_, T, D>,
    n: usize,
) -> Matrix<T, D> {
    let moment = Matrix::<T, D>::from_fn(|a, b| moments.get(a * D + b, n));
    // A thin jet has no gradient across itself: leave the sum uncorrected there.
    inverse(&moment, SINGULAR).unwrap_or_else(Matrix::identity)
}

/// The sums of a corrected velocity gradient.
pub(crate) const GRADIENT_SUMS: [Output; 2] = [Output::VELOCITY_GRADIENT, Output::MOMENT_MATRIX];

/// ∇v of a particle \[1/s\] from the [sums](GRADIENT_SUMS) of its sweep.
pub(super) fn velocity_gradient<T: Real, const D: usize>(
    [gradients, moments]: [Summed<'_, T, D>; 2],
    n: usize,
) -> Matrix<T, D> {
    gradient_of(gradients, n) * correction(moments, n)
}

/// The sum of a velocity gradient before it is corrected.
fn gradient_of<T: Real, const D: usize>(gradients: Summed<'_, T, D>, n: usize) -> Matrix<T, D> {
    Matrix::from_fn(|a, b| gradients.get(a * D + b, n))
}

/// Smallest pivot of a moment matrix that is inverted, relative to its largest entry.
pub(crate) const SINGULAR: f64 = 1e-3;
