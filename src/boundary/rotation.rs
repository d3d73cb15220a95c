//! Rotations about an axis that stays, by an angle as a function of time.
//! The axis is any in three dimensions; in two it stands on the plane.

use super::{Motion, Pose};
use crate::error::{Error, Problem, Result};
use crate::origin::local;
use crate::scalar::Lane;
use crate::tensor::{Matrix, Vector, length};

/// A rotation about a fixed point in the plane of the first two axes, or about any axis in three dimensions, by an angle
/// given with its rate and its acceleration.
///
/// With the unit vector n of the axis and K y = n × y it is R = 1 + K² + sin θ K − cos θ K² (Rodrigues 1840), and
/// x = c + R (X − c).
pub struct Rotation<const D: usize> {
    centre: [f64; D],
    axis: [f64; 3],
    angle: Box<dyn Fn(f64) -> [f64; 3] + Send + Sync>,
}

impl<const D: usize> Rotation<D> {
    /// About `centre` \[m\]; `angle` gives θ \[rad\], dθ/dt \[rad/s\] and d²θ/dt² \[rad/s²\], positive
    /// from the first axis towards the second.
    #[must_use]
    pub fn about(
        centre: [f64; D],
        angle: impl Fn(f64) -> [f64; 3] + Send + Sync + 'static,
    ) -> Self {
        Self {
            centre,
            axis: [0.0, 0.0, 1.0],
            angle: Box::new(angle),
        }
    }
}

impl Rotation<3> {
    /// About the line through `point` \[m\] along `axis`, of any length; positive by the rule of the right hand. `angle` as
    /// in [`about`](Self::about).
    ///
    /// ```
    /// use meshfree::boundary::{Motion, Rotation};
    /// // A flap that is hinged along y.
    /// let flap = Rotation::about_axis([0.0; 3], [0.0, 2.0, 0.0], |t| [0.1 * t, 0.1, 0.0])?;
    /// let [x, _, z] = flap.pose(1.0).of(0, &[0.0, 0.5, 1.0]);
    /// assert!((x - 0.1_f64.sin()).abs() < 1e-15 && (z - 0.1_f64.cos()).abs() < 1e-15);
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] if the axis has no direction.
    pub fn about_axis(
        point: [f64; 3],
        axis: [f64; 3],
        angle: impl Fn(f64) -> [f64; 3] + Send + Sync + 'static,
    ) -> Result<Self> {
        let size = length(&Vector::from(axis));
        if !(size.is_finite() && size > 0.0) {
            return Err(Error::Argument(Problem::Parameter {
                what: "length of the axis of a rotation".into(),
                value: size,
                must_be: "it must be finite and not zero: give the direction of the axis",
            }));
        }
        Ok(Self {
            axis: axis.map(|n| n / size),
            ..Self::about(point, angle)
        })
    }

    /// The unit vector of its axis.
    pub(super) fn axis(&self) -> [f64; 3] {
        self.axis
    }

    /// About the direction of another.
    pub(super) fn along(self, other: &Self) -> Self {
        let axis = other.axis;
        Self { axis, ..self }
    }
}

impl<const D: usize> Motion<D> for Rotation<D> {
    fn name(&self) -> String {
        "rotation".into()
    }
    fn pose(&self, time: f64) -> Pose<D> {
        self.pose_from(&[0.0; D], time)
    }
    fn pose_from(&self, origin: &[f64; D], time: f64) -> Pose<D> {
        let [angle, rate, growth] = (self.angle)(time);
        let (sine, cosine) = (Lane::sin(angle), Lane::cos(angle));
        let n = &self.axis;
        let cross = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]];
        // a + b K + c K², with K² = n nᵀ − 1.
        let of = |one: f64, first: f64, second: f64| {
            Matrix::<f64, D>::from_fn(|a, b| {
                let unit = if a == b { 1.0 } else { 0.0 };
                let square = n[a] * n[b] - unit;
                one * (unit + square) + first * cross[a][b] + second * square
            })
        };
        let turn = of(1.0, sine, -cosine);
        let (first, second) = (of(0.0, cosine, sine), of(0.0, -sine, cosine));
        let linear = [turn, first * rate, first * growth + second * (rate * rate)];
        let centre = Vector::from(local(&self.centre, origin));
        Pose {
            shift: [
                centre - linear[0] * centre,
                -(linear[1] * centre),
                -(linear[2] * centre),
            ],
            linear,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::motion::tests::derivatives_agree;
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn an_axis_stays_and_what_is_around_it_turns() {
        let wave = |t: f64| [t.sin(), t.cos(), -t.sin()];
        let (point, axis) = ([0.2, -0.1, 3.0], [1.0, 2.0, -2.0]);
        let turned = Rotation::about_axis(point, axis, wave).unwrap();
        derivatives_agree(&turned, [1.0, 0.5, 2.0]);
        let on_axis = core::array::from_fn(|d| point[d] + 0.7 * axis[d]);
        let x = turned.pose(0.9).of(0, &on_axis);
        assert_relative_eq!(x.as_slice(), on_axis.as_slice(), max_relative = 1e-14);
        // By nalgebra, which builds the same from a quaternion.
        let axis = nalgebra::Unit::new_normalize(nalgebra::Vector3::from(axis));
        let other = nalgebra::Rotation3::from_axis_angle(&axis, 0.9_f64.sin());
        let own: nalgebra::Matrix3<f64> = turned.pose(0.9).linear[0];
        assert_relative_eq!(own, *other.matrix(), epsilon = 1e-14);
        assert!(Rotation::about_axis(point, [0.0; 3], wave).is_err());
        assert!(Rotation::about_axis(point, [f64::NAN; 3], wave).is_err());
    }

    #[test]
    fn the_third_axis_is_that_of_the_plane() {
        let wave = |t: f64| [t.sin(), t.cos(), -t.sin()];
        let plane = Rotation::about([0.2, -0.1, 3.0], wave);
        let axis = Rotation::about_axis([0.2, -0.1, 3.0], [0.0, 0.0, 5.0], wave).unwrap();
        assert_eq!(plane.pose(0.7), axis.pose(0.7));
        let (sin, cos) = 0.7_f64.sin().sin_cos();
        let turn = plane.pose(0.7).linear[0];
        assert_relative_eq!(turn[(0, 0)], cos, max_relative = 1e-15);
        assert_relative_eq!(turn[(1, 0)], sin, max_relative = 1e-15);
    }
}
