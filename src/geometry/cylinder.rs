//! A circular cylinder in space, with ends or without.
//! With s along the axis and q across it: the box of |q| − r and max(from − s, s − to).

use super::{Shape, product};
use crate::tensor::{Vector, length};

/// A circular cylinder about an axis, with flat ends or without end.
///
/// With p a point of the axis, n its unit direction, s = (x − p)·n and q = x − p − s n, the distance
/// is that to the product of the disc |q| ≤ r and the length from ≤ s ≤ to, all in metres.
///
/// ```
/// use meshfree::geometry::{Cylinder, Shape};
/// let bar = Cylinder::between([0.0; 3], [0.0, 0.0, 8.0], 1.0);
/// assert_eq!(bar.signed_distance(&[4.0, 0.0, 12.0]), 5.0);
/// assert_eq!(Cylinder::infinite([0.0; 3], [0.0, 0.0, 2.0], 1.0).signed_distance(&[4.0, 0.0, 12.0]), 3.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    point: [f64; 3],
    axis: [f64; 3],
    radius: f64,
    /// Where the ends are along the axis, seen from `point` \[m\].
    ends: (f64, f64),
}

impl Cylinder {
    /// A cylinder of `radius` \[m\] without ends; its axis goes through `point` \[m\] along `axis`,
    /// which need not have unit length.
    #[must_use]
    pub fn infinite(point: [f64; 3], axis: [f64; 3], radius: f64) -> Self {
        let size = length(&Vector::from(axis));
        Self {
            point,
            axis: axis.map(|a| a / size),
            radius,
            ends: (f64::NEG_INFINITY, f64::INFINITY),
        }
    }

    /// A cylinder of `radius` \[m\] whose flat ends have their centres at `start` and `end` \[m\].
    #[must_use]
    pub fn between(start: [f64; 3], end: [f64; 3], radius: f64) -> Self {
        let along = Vector::from(end) - Vector::from(start);
        Self {
            ends: (0.0, length(&along)),
            ..Self::infinite(start, along.into(), radius)
        }
    }
}

impl Shape<3> for Cylinder {
    fn signed_distance(&self, x: &[f64; 3]) -> f64 {
        let from = Vector::from(*x) - Vector::from(self.point);
        let axis = Vector::from(self.axis);
        let s = from.dot(&axis);
        let across = length(&(from - axis * s)) - self.radius;
        product([across, (self.ends.0 - s).max(s - self.ends.1)])
    }
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let side = |d: usize, sign: f64| {
            let n = self.axis[d];
            // Where the axis is at right angles to a direction an infinite end does not count.
            let reach = |end: f64| if n == 0.0 { 0.0 } else { n * end };
            let (a, b) = (reach(self.ends.0), reach(self.ends.1));
            let end = if sign > 0.0 { a.max(b) } else { a.min(b) };
            self.point[d] + end + sign * self.radius * (1.0 - n * n).max(0.0).sqrt()
        };
        (
            core::array::from_fn(|d| side(d, -1.0)),
            core::array::from_fn(|d| side(d, 1.0)),
        )
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = Vec::new();
        let mut all = self.axis.iter().chain(&self.point);
        if let Some(&bad) = all.find(|x| !x.is_finite()) {
            problems.push((
                "point or axis of the cylinder",
                bad,
                "both must be finite and the axis not zero",
            ));
        }
        if !(self.radius.is_finite() && self.radius > 0.0) {
            problems.push(("radius of the cylinder", self.radius, super::POSITIVE));
        }
        problems
    }
}
