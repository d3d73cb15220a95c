//! A ball: a sphere with what is inside, in 2D a disc, in 1D an interval.
//! d(x) = |x − c| − r.

use super::Shape;
use crate::tensor::{Vector, length};

/// A ball of radius r \[m\] about the centre c \[m\], with d(x) = |x − c| − r.
///
/// ```
/// use meshfree::geometry::{Ball, Shape};
/// assert_eq!(Ball::new([1.0, 0.0], 2.0).signed_distance(&[1.0, 5.0]), 3.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball<const D: usize> {
    centre: [f64; D],
    radius: f64,
}

impl<const D: usize> Ball<D> {
    /// A ball of `radius` \[m\] about `centre` \[m\].
    #[must_use]
    pub fn new(centre: [f64; D], radius: f64) -> Self {
        Self { centre, radius }
    }
}

impl<const D: usize> Shape<D> for Ball<D> {
    fn signed_distance(&self, x: &[f64; D]) -> f64 {
        length(&(Vector::from(*x) - Vector::from(self.centre))) - self.radius
    }
    fn bounds(&self) -> ([f64; D], [f64; D]) {
        let r = self.radius;
        (self.centre.map(|c| c - r), self.centre.map(|c| c + r))
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = Vec::new();
        if let Some(&bad) = self.centre.iter().find(|c| !c.is_finite()) {
            problems.push(("centre of the ball", bad, "it must be finite, in metres"));
        }
        if !(self.radius.is_finite() && self.radius > 0.0) {
            problems.push(("radius of the ball", self.radius, super::POSITIVE));
        }
        problems
    }
}
