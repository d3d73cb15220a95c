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
        let (sums, first, count) = (chunk.around.sums, chunk.first, chunk.count);
        let [velocity, pressure, density, corrections] = chunk.columns([
            Field::VELOCITY_GRADIENT,
            Field::PRESSURE_GRADIENT,
            Field::DENSITY_GRADIENT,
            Field::CORRECTION,
        ]);
        let mut vectors = [
            (pressure, Output::PRESSURE_GRADIENT),
            (density, Output::DENSITY_GRADIENT),
        ];
        for n in 0..count {
            // Once for all that it corrects.
            let correction = correction(sums, first + n);
            if let Some(out) = velocity.get_mut(n * D * D..(n + 1) * D * D) {
                let gradient = gradient_of(sums, first + n) * correction;
                for (k, value) in out.iter_mut().enumerate() {
                    *value = gradient[(k / D, k % D)];
                }
            }
            if let Some(out) = corrections.get_mut(n * D * D..(n + 1) * D * D) {
                for (k, value) in out.iter_mut().enumerate() {
                    *value = correction[(k / D, k % D)];
                }
            }
            for (column, sum) in &mut vectors {
                let Some(out) = column.get_mut(n * D..(n + 1) * D) else {
                    continue;
                };
                for (b, value) in out.iter_mut().enumerate() {
                    *value = (0..D).fold(T::zero(), |total, a| {
                        total + sums.get(*sum, a, first + n) * correction[(a, b)]
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
    gradient_of(sums, slot) * correction(sums, slot)
}

/// The sum of a velocity gradient before it is corrected.
fn gradient_of<T: Real, const D: usize>(sums: &Results<T, D>, slot: usize) -> Matrix<T, D> {
    Matrix::from_fn(|a, b| sums.get(Output::VELOCITY_GRADIENT, a * D + b, slot))
}

/// Smallest pivot of a moment matrix that is inverted, relative to its largest entry.
const SINGULAR: f64 = 1e-3;
