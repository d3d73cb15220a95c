//! All that lies behind a plane, in 2D behind a line.
//! d(x) = (x − p)·n.

use super::Shape;
use crate::tensor::{Vector, length};

/// All that lies behind the plane through p \[m\] with unit normal n: d(x) = (x − p)·n.
///
/// ```
/// use meshfree::geometry::{HalfSpace, Shape};
/// let below = HalfSpace::new([0.0, 1.0], [0.0, 3.0]);
/// assert_eq!(below.signed_distance(&[5.0, 0.25]), -0.75);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace<const D: usize> {
    point: [f64; D],
    normal: [f64; D],
}

impl<const D: usize> HalfSpace<D> {
    /// What lies behind the plane through `point` \[m\]; `normal` points out of the shape and need
    /// not have unit length.
    #[must_use]
    pub fn new(point: [f64; D], normal: [f64; D]) -> Self {
        let size = length(&Vector::from(normal));
        Self {
            point,
            normal: normal.map(|n| n / size),
        }
    }
}

impl<const D: usize> Shape<D> for HalfSpace<D> {
    fn signed_distance(&self, x: &[f64; D]) -> f64 {
        (Vector::from(*x) - Vector::from(self.point)).dot(&Vector::from(self.normal))
    }
    /// Ends along an axis only if the normal is that axis.
    fn bounds(&self) -> ([f64; D], [f64; D]) {
        let across = |d: usize, sign: f64| self.normal[d] == sign;
        let end = |d: usize, sign: f64| {
            if across(d, sign) {
                self.point[d]
            } else {
                sign * f64::INFINITY
            }
        };
        (
            core::array::from_fn(|d| end(d, -1.0)),
            core::array::from_fn(|d| end(d, 1.0)),
        )
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut all = self.normal.iter().chain(&self.point);
        all.find(|x| !x.is_finite()).map_or_else(Vec::new, |&bad| {
            vec![(
                "point or normal of the half-space",
                bad,
                "both must be finite and the normal not zero",
            )]
        })
    }
}
