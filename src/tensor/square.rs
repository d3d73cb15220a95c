//! Square matrices of lanes, for laws that act on rows of particles.
//! Sums run in the order of nalgebra's, and pivots are chosen as in [`inverse`](super::inverse), to the same bits.

use super::Symmetric;
use crate::scalar::{Lane, Mask};

/// A `D × D` matrix of lanes, row by row.
///
/// ```
/// use meshfree::tensor::Square;
/// let matrix = Square([[0.0_f64, 2.0], [4.0, 0.0]]);
/// let (inverse, singular) = matrix.inverse(0.0);
/// assert_eq!(inverse, Square([[0.0, 0.25], [0.5, 0.0]]));
/// assert!(!singular && matrix.determinant() == -8.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Square<L, const D: usize>(pub [[L; D]; D]);

impl<L: Lane, const D: usize> Square<L, D> {
    /// All zero.
    #[must_use]
    #[inline(always)]
    pub fn zero() -> Self {
        Self([[L::zero(); D]; D])
    }
    /// One on the diagonal.
    #[must_use]
    #[inline(always)]
    pub fn identity() -> Self {
        let mut one = Self::zero();
        for a in 0..D {
            one.0[a][a] = L::one();
        }
        one
    }
    /// Rows for columns.
    #[must_use]
    #[inline(always)]
    pub fn transposed(&self) -> Self {
        let mut turned = Self::zero();
        for a in 0..D {
            for b in 0..D {
                turned.0[a][b] = self.0[b][a];
            }
        }
        turned
    }
    /// The sum with `factor` times another.
    #[must_use]
    #[inline(always)]
    pub fn plus(&self, factor: L, other: &Self) -> Self {
        let mut sum = *self;
        for a in 0..D {
            for b in 0..D {
                sum.0[a][b] += factor * other.0[a][b];
            }
        }
        sum
    }
    /// `factor` times it.
    #[must_use]
    #[inline(always)]
    pub fn scaled(&self, factor: L) -> Self {
        let mut scaled = *self;
        for a in 0..D {
            for b in 0..D {
                scaled.0[a][b] *= factor;
            }
        }
        scaled
    }
    /// The product with another.
    #[must_use]
    #[inline(always)]
    pub fn times(&self, other: &Self) -> Self {
        let mut product = Self::zero();
        for a in 0..D {
            for b in 0..D {
                let mut sum = self.0[a][0] * other.0[0][b];
                for k in 1..D {
                    sum += self.0[a][k] * other.0[k][b];
                }
                product.0[a][b] = sum;
            }
        }
        product
    }
    /// The product with a vector.
    #[must_use]
    #[inline(always)]
    pub fn dot(&self, vector: &[L; D]) -> [L; D] {
        let mut product = [L::zero(); D];
        for a in 0..D {
            product[a] = self.0[a][0] * vector[0];
            for k in 1..D {
                product[a] += self.0[a][k] * vector[k];
            }
        }
        product
    }
    /// The rotation by a spin times a time step, e^W with W antisymmetric, as [`rotation`](super::rotation).
    #[must_use]
    #[inline(always)]
    pub fn rotation(spin: &Self) -> Self {
        let one = L::one();
        let angle2 = spin.square() * L::of(0.5);
        let angle = angle2.sqrt();
        let squared = angle * angle;
        let mut first = one - squared / L::of(6.0);
        let mut second = L::of(0.5) - squared / L::of(24.0);
        let large = !angle.lt(L::of(1e-3));
        if L::somewhere(large) {
            first = L::select(large, angle.sin() / angle, first);
            second = L::select(large, (one - angle.cos()) / squared, second);
        }
        let square = spin.times(spin);
        let mut turn = Self::identity();
        for a in 0..D {
            for b in 0..D {
                turn.0[a][b] += first * spin.0[a][b];
                turn.0[a][b] += second * square.0[a][b];
            }
        }
        turn
    }
    /// R S Rᵀ with this rotation or reflection R of the first `D` axes.
    #[must_use]
    #[inline(always)]
    pub fn turned(&self, tensor: &Symmetric<L>) -> Symmetric<L> {
        let turn = |r: usize, c: usize| {
            if r < D && c < D {
                self.0[r][c]
            } else if r == c {
                L::one()
            } else {
                L::zero()
            }
        };
        let mut turned = [L::zero(); 6];
        for (sum, (r, c)) in turned.iter_mut().zip(super::PLACES) {
            for a in 0..3 {
                for b in 0..3 {
                    *sum += turn(r, a) * tensor.at(a, b) * turn(c, b);
                }
            }
        }
        Symmetric::new(turned)
    }
    /// W S − S W with this spin W of the first `D` axes: the rate at which a rotation turns a tensor.
    #[inline(always)]
    pub(crate) fn spun(&self, tensor: &Symmetric<L>) -> Symmetric<L> {
        let at = |r: usize, c: usize| {
            let inside = r < D && c < D;
            if inside { self.0[r][c] } else { L::zero() }
        };
        Symmetric::new(super::PLACES.map(|(r, c)| {
            (0..3).fold(L::zero(), |sum, k| {
                sum + at(r, k) * tensor.at(k, c) - tensor.at(r, k) * at(k, c)
            })
        }))
    }
    /// The sum of the diagonal.
    #[must_use]
    #[inline(always)]
    pub fn trace(&self) -> L {
        let mut sum = L::zero();
        for a in 0..D {
            sum += self.0[a][a];
        }
        sum
    }
    /// The symmetric part, zero out of the plane.
    #[must_use]
    #[inline(always)]
    pub fn symmetric_part(&self) -> Symmetric<L> {
        let mut part = [L::zero(); 6];
        for (k, (r, c)) in super::PLACES.into_iter().enumerate() {
            if r < D && c < D {
                part[k] = (self.0[r][c] + self.0[c][r]) * L::of(0.5);
            }
        }
        Symmetric::new(part)
    }
    /// The sum of squares, column by column.
    #[must_use]
    #[inline(always)]
    pub fn square(&self) -> L {
        let mut sum = L::zero();
        for b in 0..D {
            for a in 0..D {
                sum += self.0[a][b] * self.0[a][b];
            }
        }
        sum
    }
    /// Brings the row with the largest number of a column, of those from the diagonal on, to the diagonal, and with it the row of another
    /// matrix; where a row has moved.
    #[inline(always)]
    fn pivot(&mut self, other: &mut Self, column: usize) -> L::Mask {
        let mut most = self.0[column][column].abs();
        let mut best = [L::Mask::all_of(false); D];
        for row in column + 1..D {
            let own = self.0[row][column].abs();
            let larger = own.gt(most);
            most = L::select(larger, own, most);
            for before in column + 1..row {
                best[before] = best[before] & !larger;
            }
            best[row] = larger;
        }
        let mut moved = L::Mask::all_of(false);
        for row in column + 1..D {
            moved = moved | best[row];
            for k in 0..D {
                for matrix in [&mut *self, &mut *other] {
                    let (upper, lower) = (matrix.0[column][k], matrix.0[row][k]);
                    matrix.0[column][k] = L::select(best[row], lower, upper);
                    matrix.0[row][k] = L::select(best[row], upper, lower);
                }
            }
        }
        moved
    }
    /// The inverse by Gauss–Jordan elimination with row pivoting, and where a pivot is not larger than `floor` times the largest entry; the
    /// identity there.
    #[must_use]
    #[inline(always)]
    pub fn inverse(&self, floor: f64) -> (Self, L::Mask) {
        let (mut own, mut inverse) = (*self, Self::identity());
        let mut largest = L::zero();
        for b in 0..D {
            for a in 0..D {
                largest = largest.max(self.0[a][b].abs());
            }
        }
        let floor = largest * L::of(floor);
        let mut singular = L::Mask::all_of(false);
        for column in 0..D {
            own.pivot(&mut inverse, column);
            singular = singular | own.0[column][column].abs().le(floor);
            let scale = L::one() / own.0[column][column];
            for k in 0..D {
                own.0[column][k] *= scale;
                inverse.0[column][k] *= scale;
            }
            for row in 0..D {
                if row != column {
                    let factor = own.0[row][column];
                    for k in 0..D {
                        let (a, b) = (own.0[column][k], inverse.0[column][k]);
                        own.0[row][k] -= factor * a;
                        inverse.0[row][k] -= factor * b;
                    }
                }
            }
        }
        for a in 0..D {
            for b in 0..D {
                let one = if a == b { L::one() } else { L::zero() };
                inverse.0[a][b] = L::select(singular, one, inverse.0[a][b]);
            }
        }
        (inverse, singular)
    }
    /// The determinant by elimination with row pivoting, as [`determinant`](super::determinant).
    #[must_use]
    #[inline(always)]
    pub fn determinant(&self) -> L {
        let (mut own, mut rest) = (*self, Self::zero());
        let (mut product, mut zero) = (L::one(), L::Mask::all_of(false));
        for column in 0..D {
            let moved = own.pivot(&mut rest, column);
            let pivot = own.0[column][column];
            zero = zero | pivot.abs().le(L::zero());
            product = L::select(moved, -product, product) * pivot;
            for row in column + 1..D {
                let factor = own.0[row][column] / pivot;
                for k in column..D {
                    let above = own.0[column][k];
                    own.0[row][k] -= factor * above;
                }
            }
        }
        L::select(zero, L::zero(), product)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Lanes;
    use crate::tensor::{Matrix, determinant, inverse, rotation};
    use num_traits::One;

    fn same_as_scalars<const D: usize>() {
        type Row = Lanes<f64, 8, false>;
        let noise = |n: usize, lane: usize, k: usize| {
            let own = (1e4 * ((97 * n + 13 * lane + k) as f64).sin()).fract();
            // Some zeros, and some matrices without an inverse.
            if own.abs() < 0.2 { 0.0 } else { own }
        };
        let mut singular = 0;
        for n in 0..200 {
            let mut rows = Square::<Row, D>::zero();
            for k in 0..D * D {
                rows.0[k / D][k % D] = Lane::from_fn(|lane| noise(n, lane, k));
            }
            let (back, none) = rows.inverse(1e-3);
            let (product, size) = (rows.times(&back), rows.determinant());
            for lane in 0..8 {
                let own = Matrix::<f64, D>::from_fn(|a, b| noise(n, lane, a * D + b));
                let expected = inverse(&own, 1e-3);
                assert_eq!(none.test(lane), expected.is_none());
                singular += usize::from(expected.is_none());
                let expected = expected.unwrap_or_else(Matrix::identity);
                let bits = |x: f64| (x + 0.0).to_bits();
                for a in 0..D {
                    for b in 0..D {
                        let found = back.0[a][b].extract(lane);
                        assert_eq!(bits(found), bits(expected[(a, b)]));
                        let found = product.0[a][b].extract(lane);
                        assert_eq!(bits(found), bits((own * expected)[(a, b)]));
                    }
                }
                assert_eq!(bits(size.extract(lane)), bits(determinant(&own)));
                let turned = Square::rotation(&rows.plus(-Row::one(), &rows.transposed()));
                let expected = rotation(&(own - own.transpose()));
                for a in 0..D {
                    for b in 0..D {
                        let found = turned.0[a][b].extract(lane);
                        assert_eq!(bits(found), bits(expected[(a, b)]));
                    }
                }
            }
        }
        assert!(singular > 0);
    }

    #[test]
    fn rows_have_the_bits_of_scalars() {
        same_as_scalars::<1>();
        same_as_scalars::<2>();
        same_as_scalars::<3>();
    }
}
