//! A shape in another place and direction.
//! d(x) = a(Rᵀ (x − s)), with rotation R and shift s.

use super::{Flaw, Shape};
use crate::tensor::{Matrix, Vector};

/// Most by which the product of a rotation with its transpose may differ from one: rotations made in
/// `f64`, or printed with ten digits.
const ORTHONORMAL: f64 = 1e-9;

/// A shape turned and moved, by [`Shape::moved`]: d(x) = a(Rᵀ (x − s)).
///
/// ```
/// use meshfree::geometry::{Cuboid, Shape};
/// use meshfree::tensor::Matrix;
/// // A beam of 6 m along x, stood upright.
/// let quarter = Matrix::<f64, 2>::new(0.0, -1.0, 1.0, 0.0);
/// let beam = Cuboid::new([0.0, -1.0], [6.0, 1.0]).moved(quarter, [3.0, 0.0]);
/// assert_eq!(beam.bounds(), ([2.0, 0.0], [4.0, 6.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved<S, const D: usize> {
    shape: S,
    rotation: Matrix<f64, D>,
    shift: [f64; D],
}

impl<S, const D: usize> Moved<S, D> {
    pub(super) fn new(shape: S, rotation: Matrix<f64, D>, shift: [f64; D]) -> Self {
        Self {
            shape,
            rotation,
            shift,
        }
    }
}

impl<const D: usize, S: Shape<D>> Shape<D> for Moved<S, D> {
    fn signed_distance(&self, x: &[f64; D]) -> f64 {
        let from = Vector::from(*x) - Vector::from(self.shift);
        self.shape
            .signed_distance(&self.rotation.tr_mul(&from).into())
    }
    /// The box around the turned box of the shape.
    fn bounds(&self) -> ([f64; D], [f64; D]) {
        let (low, high) = self.shape.bounds();
        let (mut lowest, mut highest) = (self.shift, self.shift);
        for d in 0..D {
            for e in 0..D {
                let turn = self.rotation[(d, e)];
                // Zero times an infinite bound would be no number.
                if turn != 0.0 {
                    let (a, b) = (turn * low[e], turn * high[e]);
                    lowest[d] += a.min(b);
                    highest[d] += a.max(b);
                }
            }
        }
        (lowest, highest)
    }
    fn problems(&self) -> Vec<Flaw> {
        let mut problems = self.shape.problems();
        problems.extend(problems_of(&self.rotation, &self.shift));
        problems
    }
}

/// What is wrong with a rotation and a shift.
pub(super) fn problems_of<const D: usize>(
    rotation: &Matrix<f64, D>,
    shift: &[f64; D],
) -> Vec<Flaw> {
    let mut problems = Vec::new();
    let error = rotation.tr_mul(rotation) - Matrix::identity();
    let mut entries = error.iter();
    if let Some(&bad) = entries.find(|x| x.is_nan() || x.abs() > ORTHONORMAL) {
        problems.push((
            "an entry of RᵀR − 1 of the rotation",
            bad,
            "it must be zero: the columns must be orthonormal, or distances would be stretched",
        ));
    }
    if let Some(&bad) = shift.iter().find(|s| !s.is_finite()) {
        problems.push(("shift of the shape", bad, "it must be finite, in metres"));
    }
    problems
}
