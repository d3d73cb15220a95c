//! Small vectors and symmetric tensors.
//! Vectors are nalgebra's; symmetric tensors keep all six components whatever the dimension.

use crate::scalar::Real;

/// A vector in `D` dimensions.
pub type Vector<T, const D: usize> = nalgebra::SVector<T, D>;

/// A square matrix in `D` dimensions.
pub type Matrix<T, const D: usize> = nalgebra::SMatrix<T, D, D>;

/// The Euclidean length of a vector.
///
/// ```
/// use meshfree::tensor::{length, Vector};
/// assert_eq!(length(&Vector::<f64, 2>::new(3.0, 4.0)), 5.0);
/// ```
#[must_use]
pub fn length<T: Real, const D: usize>(vector: &Vector<T, D>) -> T {
    vector.dot(vector).sqrt()
}

/// The inverse of a `D × D` matrix by Gauss–Jordan elimination with row pivoting; `None` if a pivot
/// is smaller than `floor` times the largest entry.
#[must_use]
pub fn inverse<T: Real, const D: usize>(matrix: &Matrix<T, D>, floor: f64) -> Option<Matrix<T, D>> {
    let mut a = *matrix;
    let mut inverse = Matrix::<T, D>::from_fn(|r, c| if r == c { T::one() } else { T::zero() });
    let largest = a.iter().fold(T::zero(), |m, x| m.max(x.abs()));
    let floor = largest * T::from_f64(floor);
    for column in 0..D {
        let mut pivot = column;
        for row in column + 1..D {
            if a[(row, column)].abs() > a[(pivot, column)].abs() {
                pivot = row;
            }
        }
        if a[(pivot, column)].abs() <= floor {
            return None;
        }
        a.swap_rows(pivot, column);
        inverse.swap_rows(pivot, column);
        let scale = T::one() / a[(column, column)];
        for k in 0..D {
            a[(column, k)] *= scale;
            inverse[(column, k)] *= scale;
        }
        for row in 0..D {
            if row != column {
                let factor = a[(row, column)];
                for k in 0..D {
                    let (from_a, from_inverse) = (a[(column, k)], inverse[(column, k)]);
                    a[(row, k)] -= factor * from_a;
                    inverse[(row, k)] -= factor * from_inverse;
                }
            }
        }
    }
    Some(inverse)
}

/// The determinant of a `D × D` matrix by elimination with row pivoting: the factor by which a linear
/// map changes volumes.
///
/// ```
/// use meshfree::tensor::{Matrix, determinant};
/// assert_eq!(determinant(&Matrix::<f64, 2>::new(2.0, 1.0, 4.0, 3.0)), 2.0);
/// ```
#[must_use]
pub fn determinant<T: Real, const D: usize>(matrix: &Matrix<T, D>) -> T {
    let mut a = *matrix;
    let mut product = T::one();
    for column in 0..D {
        let mut pivot = column;
        for row in column + 1..D {
            if a[(row, column)].abs() > a[(pivot, column)].abs() {
                pivot = row;
            }
        }
        if a[(pivot, column)] == T::zero() {
            return T::zero();
        }
        if pivot != column {
            a.swap_rows(pivot, column);
            product = -product;
        }
        product *= a[(column, column)];
        for row in column + 1..D {
            let factor = a[(row, column)] / a[(column, column)];
            for k in column..D {
                let from = a[(column, k)];
                a[(row, k)] -= factor * from;
            }
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn determinants_of_products_multiply() {
        let m = Matrix::<f64, 3>::new(0.0, -1.0, 0.5, 2.0, 3.0, 1.0, 4.0, 0.2, -1.0);
        let n = Matrix::<f64, 3>::new(1.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.7, -1.0, 2.0);
        let product = determinant(&m) * determinant(&n);
        assert!((determinant(&(m * n)) - product).abs() < 1e-13 * product.abs());
        // By Sarrus' rule.
        assert!((determinant(&m) - (-4.0 - 2.0 + 0.2 - 6.0)).abs() < 1e-14);
        assert_eq!(determinant(&Matrix::<f64, 2>::new(1.0, 2.0, 2.0, 4.0)), 0.0);
    }

    #[test]
    fn inverse_times_matrix_is_identity() {
        let m = Matrix::<f64, 3>::new(2.0, -1.0, 0.5, 0.0, 3.0, 1.0, 4.0, 0.2, -1.0);
        let product = m * inverse(&m, 1e-12).unwrap();
        for r in 0..3 {
            for c in 0..3 {
                let expected = f64::from(u8::from(r == c));
                assert!((product[(r, c)] - expected).abs() < 1e-14);
            }
        }
        assert!(inverse(&Matrix::<f64, 2>::new(1.0, 2.0, 2.0, 4.0), 1e-12).is_none());
    }
}
