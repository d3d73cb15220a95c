//! Gradients that are exact for linear fields, from the sums of their sweep.
//! Randles & Libersky 1996; Bonet & Lok 1999.

use super::{Chunk, Law, Tally};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
use crate::sweep::Results;
use crate::tensor::{Matrix, inverse};

/// Gradients and corrections, as far as the scheme carries them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CorrectedGradients {
    /// What the sweep was asked for.
    pub wanted: Fields,
}

impl<T: Real, const D: usize> Law<T, D> for CorrectedGradients {
    fn name(&self) -> &'static str {
        "corrected gradients"
    }
    fn reads(&self) -> Fields {
        Fields::NONE
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[Output::MOMENT_MATRIX])
    }
    fn writes(&self) -> Fields {
        self.wanted
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let (sums, first) = (chunk.around.sums, chunk.first);
        let [velocity, pressure, density, corrections] = chunk.columns([
            Field::VELOCITY_GRADIENT,
            Field::PRESSURE_GRADIENT,
            Field::DENSITY_GRADIENT,
            Field::CORRECTION,
        ]);
        for (n, out) in velocity.chunks_exact_mut(D * D).enumerate() {
            let gradient = velocity_gradient(sums, first + n);
            for (k, value) in out.iter_mut().enumerate() {
                *value = gradient[(k / D, k % D)];
            }
        }
        for (n, out) in corrections.chunks_exact_mut(D * D).enumerate() {
            let correction = correction(sums, first + n);
            for (k, value) in out.iter_mut().enumerate() {
                *value = correction[(k / D, k % D)];
            }
        }
        let vectors = [
            (pressure, Output::PRESSURE_GRADIENT),
            (density, Output::DENSITY_GRADIENT),
        ];
        for (column, sum) in vectors {
            for (n, out) in column.chunks_exact_mut(D).enumerate() {
                let correction = correction(sums, first + n);
                for (b, value) in out.iter_mut().enumerate() {
                    *value = (0..D).fold(T::zero(), |total, a| {
                        total + sums.get(sum, a, first + n) * correction[(a, b)]
                    });
                }
            }
        }
        Tally::default()
    }
}

/// The inverse of a particle's moment matrix.
pub(super) fn correction<T: Real, const D: usize>(
    sums: &Results<T, D>,
    slot: usize,
) -> Matrix<T, D> {
    let moment = Matrix::<T, D>::from_fn(|a, b| sums.get(Output::MOMENT_MATRIX, a * D + b, slot));
    // A thin jet has no gradient across itself: leave the sum uncorrected there.
    inverse(&moment, SINGULAR).unwrap_or_else(Matrix::identity)
}

/// ∇v of a particle from the sums of its sweep \[1/s\].
pub(super) fn velocity_gradient<T: Real, const D: usize>(
    sums: &Results<T, D>,
    slot: usize,
) -> Matrix<T, D> {
    let sum = Matrix::<T, D>::from_fn(|a, b| sums.get(Output::VELOCITY_GRADIENT, a * D + b, slot));
    sum * correction(sums, slot)
}

/// Smallest pivot of a moment matrix that is inverted, relative to its largest entry.
const SINGULAR: f64 = 1e-3;
