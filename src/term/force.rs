//! The force of a pair while its terms are summed: along r, along v, and free.
//! What no term of a sweep sets is not even multiplied.

use crate::scalar::Lane;
use core::ops::{AddAssign, SubAssign};

/// A force of a pair along one direction, which costs nothing where no term sets it.
#[derive(Clone, Copy, Debug)]
pub struct Along<L>(Option<L>);

impl<L: Lane> Along<L> {
    pub(crate) const NOTHING: Self = Self(None);

    /// The sum of what terms have set; zero where none has.
    #[inline(always)]
    #[must_use]
    pub fn value(self) -> L {
        self.0.unwrap_or_else(L::zero)
    }
    /// The opposite force.
    #[inline(always)]
    pub(crate) fn reversed(self) -> Self {
        match self.0 {
            Some(force) => Self(Some(-force)),
            None => self,
        }
    }
    /// What terms have set, which is nothing from then on.
    #[inline(always)]
    pub(crate) fn take(&mut self) -> Option<L> {
        self.0.take()
    }
    /// Adds a product, with one rounding where lanes are fused.
    #[inline(always)]
    pub fn add_product(&mut self, a: L, b: L) {
        self.0 = Some(match self.0 {
            Some(sum) => a.mul_add(b, sum),
            None => a * b,
        });
    }
    /// The force times the component `along` of its direction, and `sum`.
    #[inline(always)]
    pub(crate) fn mul_add(self, along: L, sum: L) -> L {
        match self.0 {
            Some(force) => force.mul_add(along, sum),
            None => sum,
        }
    }
    /// The force and `sum`.
    #[inline(always)]
    fn plus(self, sum: L) -> L {
        match self.0 {
            Some(force) => sum + force,
            None => sum,
        }
    }
}

impl<L: Lane> AddAssign<L> for Along<L> {
    #[inline(always)]
    fn add_assign(&mut self, force: L) {
        self.0 = Some(match self.0 {
            Some(sum) => sum + force,
            None => force,
        });
    }
}

impl<L: Lane> SubAssign<L> for Along<L> {
    #[inline(always)]
    fn sub_assign(&mut self, force: L) {
        *self += -force;
    }
}

/// A force of a pair in any direction, which costs nothing where no term sets it.
///
/// It counts wherever the forces along rᵢⱼ and vᵢⱼ count: in the force, in its power −½ F·vᵢⱼ, and in the
/// work of a kick. On exchange of i and j it must change its sign, or momentum and energy are lost.
#[derive(Clone, Copy, Debug)]
pub struct FreeForce<L, const D: usize>([Along<L>; D]);

impl<L: Lane, const D: usize> FreeForce<L, D> {
    pub(crate) const NOTHING: Self = Self([Along::NOTHING; D]);

    /// Adds to component `d`, below D.
    #[inline(always)]
    pub fn add(&mut self, d: usize, force: L) {
        self.0[d] += force;
    }
    /// The sum of what terms have set; zero where none has.
    #[inline(always)]
    #[must_use]
    pub fn value(self) -> [L; D] {
        self.0.map(Along::value)
    }
    /// The opposite force.
    #[inline(always)]
    pub(crate) fn reversed(mut self) -> Self {
        for d in 0..D {
            self.0[d] = self.0[d].reversed();
        }
        self
    }
    /// Component `d` of the force, and `sum`.
    #[inline(always)]
    pub(crate) fn plus(self, d: usize, sum: L) -> L {
        self.0[d].plus(sum)
    }
    /// The product with a vector; zero where no term has set a force.
    #[inline(always)]
    pub(crate) fn dot(self, vector: &[L; D]) -> L {
        let mut sum = L::zero();
        for d in 0..D {
            sum = self.0[d].mul_add(vector[d], sum);
        }
        sum
    }
}

impl<L: Lane, const D: usize> AddAssign<[L; D]> for FreeForce<L, D> {
    #[inline(always)]
    fn add_assign(&mut self, force: [L; D]) {
        for d in 0..D {
            self.add(d, force[d]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_that_no_term_sets_is_not_even_multiplied() {
        let mut force = Along::<f64>::NOTHING;
        assert_eq!(force.value(), 0.0);
        // Zero times this would be no number.
        assert_eq!(force.mul_add(f64::INFINITY, 2.0), 2.0);
        force -= 3.0;
        force.add_product(2.0, 4.0);
        force += 1.0;
        assert_eq!(force.value(), 6.0);
        assert_eq!(force.mul_add(0.5, 2.0), 5.0);
    }

    #[test]
    fn a_free_force_sums_what_terms_set_and_multiplies_nothing_else() {
        let mut force = FreeForce::<f64, 2>::NOTHING;
        assert_eq!(force.dot(&[f64::INFINITY; 2]), 0.0);
        force.add(1, 3.0);
        // Nothing has set the first component.
        assert_eq!(force.dot(&[f64::INFINITY, 2.0]), 6.0);
        force += [0.5, -1.0];
        assert_eq!(force.value(), [0.5, 2.0]);
        assert_eq!((force.plus(0, 1.0), force.dot(&[2.0, 0.25])), (1.5, 1.5));
    }
}
