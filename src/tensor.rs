//! Small vectors and symmetric tensors.
//! Vectors are nalgebra's; symmetric tensors keep all six components whatever the dimension.

mod square;

use crate::scalar::{Lane, Real};
pub use square::Square;

/// A vector in `D` dimensions.
pub type Vector<T, const D: usize> = nalgebra::SVector<T, D>;

/// A square matrix in `D` dimensions.
pub type Matrix<T, const D: usize> = nalgebra::SMatrix<T, D, D>;

/// A symmetric tensor with all six components of space, xx, yy, zz, yz, xz, xy (Voigt's order), in
/// whatever dimension: plane strain and uniaxial stress need those out of the plane.
///
/// ```
/// use meshfree::tensor::{Matrix, Symmetric};
/// // A tension along x, seen after a quarter turn, is one along y.
/// let stress = Symmetric::diagonal([5.0, 0.0, 1.0]);
/// let turned = stress.rotated(&Matrix::<f64, 2>::new(0.0, -1.0, 1.0, 0.0));
/// assert_eq!(turned, Symmetric::diagonal([0.0, 5.0, 1.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Symmetric<T>([T; 6]);

/// Row and column of each component.
const PLACES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)];

impl<L: Lane> Symmetric<L> {
    /// The tensor that is zero.
    #[must_use]
    #[inline(always)]
    pub fn zero() -> Self {
        Self([L::zero(); 6])
    }
    /// From its components xx, yy, zz, yz, xz, xy.
    #[must_use]
    #[inline(always)]
    pub fn new(components: [L; 6]) -> Self {
        Self(components)
    }
    /// With these principal values along the axes.
    #[must_use]
    #[inline(always)]
    pub fn diagonal([xx, yy, zz]: [L; 3]) -> Self {
        let zero = L::zero();
        Self([xx, yy, zz, zero, zero, zero])
    }
    /// Its components xx, yy, zz, yz, xz, xy.
    #[must_use]
    #[inline(always)]
    pub fn components(&self) -> &[L; 6] {
        &self.0
    }
    /// The component in row `r` and column `c`, each below 3.
    #[must_use]
    #[inline(always)]
    pub fn at(&self, r: usize, c: usize) -> L {
        self.0[place(r, c)]
    }
    /// xx + yy + zz.
    #[must_use]
    #[inline(always)]
    pub fn trace(&self) -> L {
        self.0[0] + self.0[1] + self.0[2]
    }
    /// Without a third of its trace on the diagonal.
    #[must_use]
    #[inline(always)]
    pub fn deviator(&self) -> Self {
        let mean = self.trace() * L::of(1.0 / 3.0);
        let mut deviator = *self;
        for value in &mut deviator.0[..3] {
            *value -= mean;
        }
        deviator
    }
    /// The double contraction with another, Σ aᵣ꜀ bᵣ꜀.
    #[must_use]
    #[inline(always)]
    pub fn contract(&self, other: &Self) -> L {
        let product = |k: usize| self.0[k] * other.0[k];
        let normal = product(0) + product(1) + product(2);
        let shear = product(3) + product(4) + product(5);
        normal + shear + shear
    }
    /// The stress of von Mises of a deviatoric stress, √(3/2 S:S).
    ///
    /// ```
    /// use meshfree::tensor::Symmetric;
    /// // Simple tension.
    /// let stress = Symmetric::<f64>::diagonal([3.0, 0.0, 0.0]);
    /// assert!((stress.deviator().von_mises() - 3.0).abs() < 1e-15);
    /// ```
    #[must_use]
    #[inline(always)]
    pub fn von_mises(&self) -> L {
        (L::of(1.5) * self.contract(self)).sqrt()
    }
    /// The product with a vector of the first `D` axes, as pair terms have it: σ·n is the traction of a
    /// stress on a face.
    ///
    /// ```
    /// use meshfree::tensor::Symmetric;
    /// let stress = Symmetric::new([1.0, 2.0, 3.0, 0.0, 0.0, 0.5]);
    /// assert_eq!(stress.dot(&[2.0, 4.0]), [4.0, 9.0]);
    /// ```
    #[must_use]
    #[inline(always)]
    pub fn dot<const D: usize>(&self, vector: &[L; D]) -> [L; D] {
        // A loop, because a closure may be compiled without the instructions of the pair loop.
        let mut product = [L::zero(); D];
        for r in 0..D {
            product[r] = self.at(r, 0) * vector[0];
            for c in 1..D {
                product[r] = self.at(r, c).mul_add(vector[c], product[r]);
            }
        }
        product
    }
    /// The sum with `factor` times another.
    #[must_use]
    #[inline(always)]
    pub fn plus(&self, factor: L, other: &Self) -> Self {
        let mut sum = *self;
        for k in 0..6 {
            sum.0[k] += factor * other.0[k];
        }
        sum
    }
    /// `factor` times it.
    #[must_use]
    #[inline(always)]
    pub fn scaled(&self, factor: L) -> Self {
        let mut scaled = *self;
        for value in &mut scaled.0 {
            *value *= factor;
        }
        scaled
    }
    /// Of a stress, positive in tension, what presses: Σ min(λ, 0) e ⊗ e over principal values λ and
    /// directions e (the split of Miehe, Hofacker & Welschinger 2010, eq. 15). On no face does it pull.
    ///
    /// By Jacobi's rotations.
    ///
    /// ```
    /// use meshfree::tensor::Symmetric;
    /// let stress = Symmetric::<f64>::diagonal([5.0, -2.0, 0.0]);
    /// assert_eq!(stress.compressive_part(), Symmetric::diagonal([0.0, -2.0, 0.0]));
    /// ```
    #[must_use]
    pub fn compressive_part(&self) -> Self {
        let (zero, one) = (L::zero(), L::one());
        let mut turned = *self;
        let mut axes = [[zero; 3]; 3];
        for (k, axis) in axes.iter_mut().enumerate() {
            axis[k] = one;
        }
        for _ in 0..JACOBI_SWEEPS {
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                let third = 3 - p - q;
                let off = turned.at(p, q);
                let (gap, twice) = (turned.at(q, q) - turned.at(p, p), off + off);
                let reach = gap.abs() + (gap * gap + twice * twice).sqrt();
                let tangent = twice / L::select(reach.gt(zero), reach, one);
                let tangent = L::select(gap.lt(zero), -tangent, tangent);
                let cosine = (tangent * tangent + one).sqrt().recip();
                let sine = tangent * cosine;
                turned.0[p] -= tangent * off;
                turned.0[q] += tangent * off;
                turned.0[place(p, q)] = zero;
                let (a, b) = (turned.at(third, p), turned.at(third, q));
                turned.0[place(third, p)] = cosine * a - sine * b;
                turned.0[place(third, q)] = cosine * b + sine * a;
                for axis in &mut axes {
                    let (a, b) = (axis[p], axis[q]);
                    axis[p] = cosine * a - sine * b;
                    axis[q] = cosine * b + sine * a;
                }
            }
        }
        let mut part = [zero; 6];
        for k in 0..3 {
            let value = turned.0[k].min(zero);
            for (component, (r, c)) in part.iter_mut().zip(PLACES) {
                *component += value * axes[r][k] * axes[c][k];
            }
        }
        Self(part)
    }
}

/// Each squares what is left off the diagonal: after the fourth it is below rounding.
const JACOBI_SWEEPS: usize = 5;

/// Where row `r` and column `c` stand, each below 3.
const fn place(r: usize, c: usize) -> usize {
    if r == c { r } else { 6 - r - c }
}

impl<T: Real> Symmetric<T> {
    /// From the first six numbers of a slice; what is missing is zero.
    #[must_use]
    pub fn from_slice(values: &[T]) -> Self {
        Self(core::array::from_fn(|k| {
            values.get(k).copied().unwrap_or(T::zero())
        }))
    }
    /// The same in `f64`, in which laws of materials are evaluated.
    #[must_use]
    pub fn to_f64(&self) -> Symmetric<f64> {
        Symmetric::new(self.0.map(Real::to_f64))
    }
    /// The symmetric part of a matrix, zero out of its plane.
    #[must_use]
    pub fn symmetric_part<const D: usize>(matrix: &Matrix<T, D>) -> Self {
        let half = T::from_f64(0.5);
        let at = |r: usize, c: usize| {
            let inside = r < D && c < D;
            if inside { matrix[(r, c)] } else { T::zero() }
        };
        Self(PLACES.map(|(r, c)| (at(r, c) + at(c, r)) * half))
    }
    /// R S Rᵀ with a rotation or reflection of the first `D` axes.
    #[must_use]
    pub fn rotated<const D: usize>(&self, rotation: &Matrix<T, D>) -> Self {
        let rows = |r: usize| core::array::from_fn(|c| rotation[(r, c)]);
        Square::<T, D>(core::array::from_fn(rows)).turned(self)
    }
    /// W S − S W with a spin W of the first `D` axes: the rate at which a rotation turns it.
    #[must_use]
    pub fn spun<const D: usize>(&self, spin: &Matrix<T, D>) -> Self {
        let rows = |r: usize| core::array::from_fn(|c| spin[(r, c)]);
        Square::<T, D>(core::array::from_fn(rows)).spun(self)
    }
    /// The product with a vector of the first `D` axes.
    #[must_use]
    pub fn times<const D: usize>(&self, vector: &Vector<T, D>) -> Vector<T, D> {
        Vector::from_fn(|r, _| (0..D).fold(T::zero(), |sum, c| sum + self.at(r, c) * vector[c]))
    }
}

/// The rotation by a spin times a time step, e^W with W antisymmetric, by Rodrigues' formula; the identity in one
/// dimension.
///
/// ```
/// use meshfree::tensor::{Matrix, rotation};
/// let quarter = std::f64::consts::FRAC_PI_2;
/// let turn = rotation(&Matrix::<f64, 2>::new(0.0, -quarter, quarter, 0.0));
/// assert!((turn - Matrix::<f64, 2>::new(0.0, -1.0, 1.0, 0.0)).norm() < 1e-15);
/// ```
#[must_use]
pub fn rotation<T: Real, const D: usize>(spin: &Matrix<T, D>) -> Matrix<T, D> {
    // Half of the sum of squares is the squared angle.
    let angle2 = spin.iter().fold(T::zero(), |sum, w| sum + *w * *w) * T::from_f64(0.5);
    let angle = angle2.sqrt().to_f64();
    // sin(a)/a and (1 − cos(a))/a², by their series where those would cancel.
    let (first, second) = if angle < 1e-3 {
        (1.0 - angle * angle / 6.0, 0.5 - angle * angle / 24.0)
    } else {
        (
            Lane::sin(angle) / angle,
            (1.0 - Lane::cos(angle)) / (angle * angle),
        )
    };
    let square = *spin * *spin;
    Matrix::from_fn(|r, c| {
        let one = if r == c { T::one() } else { T::zero() };
        one + T::from_f64(first) * spin[(r, c)] + T::from_f64(second) * square[(r, c)]
    })
}

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
    // Rows of arrays: what a row operation touches lies side by side.
    let mut a: [[T; D]; D] = core::array::from_fn(|r| core::array::from_fn(|c| matrix[(r, c)]));
    let one = |r: usize, c: usize| if r == c { T::one() } else { T::zero() };
    let mut inverse: [[T; D]; D] = core::array::from_fn(|r| core::array::from_fn(|c| one(r, c)));
    let largest = matrix.iter().fold(T::zero(), |m, x| m.max(x.abs()));
    let floor = largest * T::from_f64(floor);
    for column in 0..D {
        let mut pivot = column;
        for row in column + 1..D {
            if a[row][column].abs() > a[pivot][column].abs() {
                pivot = row;
            }
        }
        if a[pivot][column].abs() <= floor {
            return None;
        }
        if pivot != column {
            a.swap(pivot, column);
            inverse.swap(pivot, column);
        }
        let scale = T::one() / a[column][column];
        for k in 0..D {
            a[column][k] *= scale;
            inverse[column][k] *= scale;
        }
        let (from_a, from_inverse) = (a[column], inverse[column]);
        for row in 0..D {
            if row != column {
                let factor = a[row][column];
                for k in 0..D {
                    a[row][k] -= factor * from_a[k];
                    inverse[row][k] -= factor * from_inverse[k];
                }
            }
        }
    }
    Some(Matrix::from_fn(|r, c| inverse[r][c]))
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
    let mut a: [[T; D]; D] = core::array::from_fn(|r| core::array::from_fn(|c| matrix[(r, c)]));
    let mut product = T::one();
    for column in 0..D {
        let mut pivot = column;
        for row in column + 1..D {
            if a[row][column].abs() > a[pivot][column].abs() {
                pivot = row;
            }
        }
        if a[pivot][column] == T::zero() {
            return T::zero();
        }
        if pivot != column {
            a.swap(pivot, column);
            product = -product;
        }
        let from = a[column];
        product *= from[column];
        for row in column + 1..D {
            let factor = a[row][column] / from[column];
            for k in column..D {
                a[row][k] -= factor * from[k];
            }
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_tensor_keeps_its_invariants_and_turns_back() {
        let tensor = Symmetric::<f64>::new([1.0, -2.0, 0.5, 3.0, -1.0, 0.25]);
        let (s, c) = 0.7_f64.sin_cos();
        let turn = Matrix::<f64, 3>::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
        let turned = tensor.rotated(&turn);
        assert!((turned.trace() - tensor.trace()).abs() < 1e-15);
        assert!((turned.contract(&turned) - tensor.contract(&tensor)).abs() < 1e-14);
        let back = turned.rotated(&turn.transpose());
        for (a, b) in back.components().iter().zip(tensor.components()) {
            assert!((a - b).abs() < 1e-15);
        }
        // R (S v) = (R S Rᵀ) (R v), against nalgebra's product.
        let v = Vector::<f64, 3>::new(0.3, -1.0, 2.0);
        let full = Matrix::<f64, 3>::from_fn(|r, c| tensor.at(r, c));
        assert!((turned.times(&(turn * v)) - turn * (full * v)).norm() < 1e-14);
        assert!(tensor.deviator().trace().abs() < 1e-15);
    }

    #[test]
    fn lanes_take_the_product_with_a_vector_of_their_axes() {
        use crate::scalar::Lanes;
        type Row = Lanes<f64, 8, true>;
        let tensor = Symmetric::<f64>::new([1.0, -2.0, 0.5, 3.0, -1.0, 0.25]);
        let row = Symmetric::new(tensor.components().map(Row::splat));
        let v = [0.3, -1.0, 2.0];
        for d in 0..3 {
            let expected = (0..3).map(|c| tensor.at(d, c) * v[c]).sum::<f64>();
            assert!((tensor.dot(&v)[d] - expected).abs() < 1e-15);
            let lane = row.dot(&v.map(Row::splat))[d].extract(5);
            assert!((lane - expected).abs() < 1e-15);
        }
        // In one and two dimensions only what acts in them.
        assert_eq!(tensor.dot(&[2.0]), [2.0]);
        assert_eq!(tensor.dot(&[2.0, 4.0]), [3.0, -7.5]);
    }

    #[test]
    fn a_stress_parts_into_what_presses_and_what_pulls() {
        let (mut pressing, mut pulling) = (0, 0);
        for k in 0..200 {
            let noise = |n: usize| (1e4 * ((7 * k + n) as f64).sin()).fract();
            let stress = Symmetric::<f64>::new(core::array::from_fn(noise));
            let presses = stress.compressive_part();
            let pulls = stress.scaled(-1.0).compressive_part().scaled(-1.0);
            for (k, whole) in stress.components().iter().enumerate() {
                let sum = presses.components()[k] + pulls.components()[k];
                assert!((whole - sum).abs() < 1e-14, "{stress:?}");
            }
            assert!(presses.contract(&pulls).abs() < 1e-14);
            for n in 0..20 {
                let normal = [noise(n), noise(n + 1), noise(n + 2)];
                let traction = presses.dot(&normal);
                let along: f64 = (0..3).map(|d| traction[d] * normal[d]).sum();
                assert!(along < 1e-15, "{stress:?} pulls on {normal:?}");
            }
            pressing += usize::from(presses.trace() < -0.1);
            pulling += usize::from(pulls.trace() > 0.1);
        }
        assert!(pressing > 100 && pulling > 100);
        // Equal principal values have no directions of their own, and none are needed.
        let even = Symmetric::<f64>::diagonal([-3.0; 3]);
        assert_eq!(even.compressive_part(), even);
        assert_eq!(
            Symmetric::<f32>::zero().compressive_part(),
            Symmetric::zero()
        );
    }

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
