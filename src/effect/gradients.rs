//! Gradients that are exact for linear fields, from the sums of their sweep.
//! Randles & Libersky 1996; Bonet & Lok 1999.

use super::access::Summed;
use super::total_lagrangian::put;
use super::{Chunk, Law, Tally};
use crate::particles::{Field, Fields, Output, Outputs, Shape};
use crate::scalar::Real;
use crate::tensor::{Matrix, inverse};

/// Gradients and corrections, as far as the scheme carries them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CorrectedGradients {
    /// What the sweep was asked for.
    pub wanted: Fields,
}

/// The gradients that are sums before they are corrected.
const SUMMED: [(Field, Output); 3] = [
    (Field::VELOCITY_GRADIENT, Output::VELOCITY_GRADIENT),
    (Field::PRESSURE_GRADIENT, Output::PRESSURE_GRADIENT),
    (Field::DENSITY_GRADIENT, Output::DENSITY_GRADIENT),
];

/// Particles whose corrections are on the stack at a time.
const CORRECTED: usize = 64;

impl<T: Real, const D: usize> Law<T, D> for CorrectedGradients {
    fn name(&self) -> &'static str {
        "corrected gradients"
    }
    fn reads(&self) -> Fields {
        Fields::NONE
    }
    fn sums(&self) -> Outputs {
        let wanted = SUMMED
            .iter()
            .filter(|(field, _)| self.wanted.contains(*field));
        let moments = Outputs::of(&[Output::MOMENT_MATRIX]);
        wanted.fold(moments, |all, (_, sum)| all.union(Outputs::of(&[*sum])))
    }
    fn writes(&self) -> Fields {
        self.wanted
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let (moments, count) = (chunk.sum(Output::MOMENT_MATRIX), chunk.count);
        // Once for all that it corrects.
        let mut corrections = [Matrix::<T, D>::identity(); CORRECTED];
        for start in (0..count).step_by(CORRECTED) {
            let corrections = &mut corrections[..CORRECTED.min(count - start)];
            for (n, own) in corrections.iter_mut().enumerate() {
                *own = correction(moments, start + n);
            }
            for field in self.wanted.iter() {
                let own = SUMMED.iter().find(|(own, _)| *own == field);
                let sum = own.map(|(_, sum)| chunk.sum(*sum));
                let ([], [column]) = chunk.columns([], [field]);
                let width = field.components(D);
                let column = column[start * width..].chunks_exact_mut(width);
                for (n, (out, correction)) in column.zip(&*corrections).enumerate() {
                    let Some(sum) = sum else {
                        put(out, correction);
                        continue;
                    };
                    if field.shape() == Shape::Matrix {
                        put(out, &(gradient_of(sum, start + n) * correction));
                        continue;
                    }
                    for (b, value) in out.iter_mut().enumerate() {
                        *value = (0..D).fold(T::zero(), |total, a| {
                            total + sum.get(a, start + n) * correction[(a, b)]
                        });
                    }
                }
            }
        }
        Tally::default()
    }
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
pub(super) const GRADIENT_SUMS: [Output; 2] = [Output::VELOCITY_GRADIENT, Output::MOMENT_MATRIX];

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
const SINGULAR: f64 = 1e-3;
