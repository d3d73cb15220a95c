//! A box along the axes, in 2D a rectangle, in 1D an interval.
//! With e = max(low − x, x − high): d(x) = |max(e, 0)| outside, max(e) inside.

use super::{POSITIVE, SWAPPED, Shape, product};

/// A box from its lowest to its highest corner \[m\].
///
/// With e = max(low − x, x − high) component by component, d(x) = |max(e, 0)| outside and the
/// largest component of e inside. A corner may be infinite: a slab, or a channel without ends.
///
/// ```
/// use meshfree::geometry::{Cuboid, Shape};
/// let tank = Cuboid::new([0.0; 2], [4.0, 2.0]);
/// assert_eq!(tank.signed_distance(&[7.0, 6.0]), 5.0);
/// assert_eq!(tank.signed_distance(&[1.5, 1.5]), -0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid<const D: usize> {
    low: [f64; D],
    high: [f64; D],
}

impl<const D: usize> Cuboid<D> {
    /// A box from `low` to `high` \[m\].
    #[must_use]
    pub fn new(low: [f64; D], high: [f64; D]) -> Self {
        Self { low, high }
    }
}

impl<const D: usize> Shape<D> for Cuboid<D> {
    fn signed_distance(&self, x: &[f64; D]) -> f64 {
        product::<D>(core::array::from_fn(|d| {
            (self.low[d] - x[d]).max(x[d] - self.high[d])
        }))
    }
    fn bounds(&self) -> ([f64; D], [f64; D]) {
        (self.low, self.high)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let size = |d: usize| self.high[d] - self.low[d];
        let empty = (0..D).map(size).find(|s| s.is_nan() || *s <= 0.0);
        empty.map_or_else(Vec::new, |bad| {
            let must_be = if bad < 0.0 { SWAPPED } else { POSITIVE };
            vec![("size of the box", bad, must_be)]
        })
    }
}
