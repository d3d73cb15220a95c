//! Prescribed motion of walls: where a point of a rigid or affinely deforming wall is at a time.
//! A motion is evaluated once a wall and step, and applied to all of its particles.

use crate::tensor::{Matrix, Vector};
use core::fmt;

/// Where the points of a moving frame are: x = A X + b, with first and second derivatives in time.
///
/// X \[m\] is the place in the scene as it was built.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose<const D: usize> {
    /// A, dA/dt \[1/s\] and d²A/dt² \[1/s²\].
    pub linear: [Matrix<f64, D>; 3],
    /// b \[m\], db/dt \[m/s\] and d²b/dt² \[m/s²\].
    pub shift: [Vector<f64, D>; 3],
}

impl<const D: usize> Pose<D> {
    /// The pose in which nothing has moved.
    #[must_use]
    pub fn rest() -> Self {
        Self {
            linear: [Matrix::identity(), Matrix::zeros(), Matrix::zeros()],
            shift: [Vector::zeros(), Vector::zeros(), Vector::zeros()],
        }
    }
    /// Position (`order` 0), velocity (1) or acceleration (2) of the point that was at `x` \[m\].
    #[must_use]
    pub fn of(&self, order: usize, x: &[f64; D]) -> [f64; D] {
        (self.linear[order] * Vector::from(*x) + self.shift[order]).into()
    }
}

/// A prescribed motion.
///
/// ```
/// use meshfree::boundary::{Motion, Translation};
/// // A tank that is braked at 30 g from rest.
/// let braked = Translation::new(
///     |t| [-0.5 * 294.2 * t * t, 0.0],
///     |t| [-294.2 * t, 0.0],
///     |_| [-294.2, 0.0],
/// );
/// assert_eq!(braked.pose(0.01).of(1, &[0.3, 0.2]), [-2.942, 0.0]);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a motion in {D} dimensions",
    note = "implement `Motion<{D}>`: the pose of the wall at a time"
)]
pub trait Motion<const D: usize>: Send + Sync {
    /// Its name in reports.
    fn name(&self) -> String;
    /// The pose at `time` \[s\].
    fn pose(&self, time: f64) -> Pose<D>;
}

impl<const D: usize> fmt::Debug for dyn Motion<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())
    }
}

type Path<const D: usize> = Box<dyn Fn(f64) -> [f64; D] + Send + Sync>;

/// A translation s(t), given with its velocity and acceleration.
pub struct Translation<const D: usize> {
    path: [Path<D>; 3],
}

impl<const D: usize> Translation<D> {
    /// From displacement \[m\], velocity \[m/s\] and acceleration \[m/s²\] as functions of time \[s\].
    #[must_use]
    pub fn new(
        displacement: impl Fn(f64) -> [f64; D] + Send + Sync + 'static,
        velocity: impl Fn(f64) -> [f64; D] + Send + Sync + 'static,
        acceleration: impl Fn(f64) -> [f64; D] + Send + Sync + 'static,
    ) -> Self {
        Self {
            path: [
                Box::new(displacement),
                Box::new(velocity),
                Box::new(acceleration),
            ],
        }
    }

    /// At a constant velocity \[m/s\].
    #[must_use]
    pub fn steady(velocity: [f64; D]) -> Self {
        Self::new(
            move |t| velocity.map(|v| v * t),
            move |_| velocity,
            |_| [0.0; D],
        )
    }
}

impl<const D: usize> Motion<D> for Translation<D> {
    fn name(&self) -> String {
        "translation".into()
    }
    fn pose(&self, time: f64) -> Pose<D> {
        Pose {
            shift: [0, 1, 2].map(|order: usize| Vector::from(self.path[order](time))),
            ..Pose::rest()
        }
    }
}

/// A rotation about a fixed point in the plane of the first two axes, by an angle given with its rate
/// and its acceleration.
pub struct Rotation<const D: usize> {
    centre: [f64; D],
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
            angle: Box::new(angle),
        }
    }
}

impl<const D: usize> Motion<D> for Rotation<D> {
    fn name(&self) -> String {
        "rotation".into()
    }
    fn pose(&self, time: f64) -> Pose<D> {
        let [angle, rate, growth] = (self.angle)(time);
        let (sine, cosine) = angle.sin_cos();
        // In the plane: R, R′ = dR/dθ, R″ = −R; elsewhere the identity does not change.
        let plane = |m: [f64; 4], rest: f64| {
            Matrix::<f64, D>::from_fn(|a, b| match (a, b) {
                (0 | 1, 0 | 1) => m[2 * a + b],
                _ if a == b => rest,
                _ => 0.0,
            })
        };
        let turn = plane([cosine, -sine, sine, cosine], 1.0);
        let first = plane([-sine, -cosine, cosine, -sine], 0.0);
        let second = plane([-cosine, sine, -sine, -cosine], 0.0);
        let linear = [turn, first * rate, first * growth + second * (rate * rate)];
        let centre = Vector::from(self.centre);
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

/// A uniform compression along one axis towards a plane that stays: x = X₀ + (1 − ε(t)) (X − X₀).
pub struct Crush<const D: usize> {
    axis: usize,
    fixed: f64,
    strain: Box<dyn Fn(f64) -> [f64; 3] + Send + Sync>,
}

impl<const D: usize> Crush<D> {
    /// Along `axis` towards the plane at `fixed` \[m\]; `strain` gives ε, dε/dt \[1/s\] and d²ε/dt²
    /// \[1/s²\], positive in compression.
    #[must_use]
    pub fn along(
        axis: usize,
        fixed: f64,
        strain: impl Fn(f64) -> [f64; 3] + Send + Sync + 'static,
    ) -> Self {
        Self {
            axis,
            fixed,
            strain: Box::new(strain),
        }
    }
}

impl<const D: usize> Motion<D> for Crush<D> {
    fn name(&self) -> String {
        format!("crush along axis {}", self.axis)
    }
    fn pose(&self, time: f64) -> Pose<D> {
        let strain = (self.strain)(time);
        let mut pose = Pose::<D>::rest();
        for (order, strain) in strain.into_iter().enumerate() {
            // An axis that the dimension does not have leaves the wall at rest.
            if self.axis < D {
                pose.linear[order][(self.axis, self.axis)] -= strain;
                pose.shift[order][self.axis] = strain * self.fixed;
            }
        }
        pose
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Velocity and acceleration are the differences of position and velocity.
    fn derivatives_agree<const D: usize>(motion: &dyn Motion<D>, x: [f64; D]) {
        let (time, dt) = (0.37, 1e-5);
        for order in 0..2 {
            let before = motion.pose(time - dt).of(order, &x);
            let after = motion.pose(time + dt).of(order, &x);
            let given = motion.pose(time).of(order + 1, &x);
            for d in 0..D {
                let difference = (after[d] - before[d]) / (2.0 * dt);
                assert!((difference - given[d]).abs() < 1e-7, "{}", motion.name());
            }
        }
    }

    #[test]
    fn motions_carry_their_own_derivatives() {
        let wave = |t: f64| [t.sin(), t.cos(), -t.sin()];
        derivatives_agree(&Rotation::about([0.2, -0.1], wave), [1.0, 0.5]);
        derivatives_agree(&Rotation::about([0.2, -0.1, 3.0], wave), [1.0, 0.5, 2.0]);
        derivatives_agree(&Crush::along(1, 0.4, wave), [1.0, 0.5, 2.0]);
        let swing = Translation::new(|t| [t.sin()], |t| [t.cos()], |t| [-t.sin()]);
        derivatives_agree(&swing, [0.7]);
        let plane = Crush::along(1, 0.4, wave).pose(0.9).of(0, &[2.0, 0.4]);
        assert!((plane[1] - 0.4).abs() < 1e-15 && plane[0] == 2.0);
    }
}
