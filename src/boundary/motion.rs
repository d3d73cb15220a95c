//! Prescribed motion of walls: where a point of a rigid or affinely deforming wall is at a time.
//! A motion is evaluated once a wall and step, and applied to all of its particles.

use crate::error::{Error, Problem, Result};
use crate::tensor::{Matrix, Vector, inverse};
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
    /// That of a time at which there is none: no number.
    pub(crate) fn nowhere() -> Self {
        let mut pose = Self::rest();
        for own in &mut pose.shift {
            own.fill(f64::NAN);
        }
        pose
    }
    /// Position (`order` 0), velocity (1) or acceleration (2) of the point that was at `x` \[m\].
    #[must_use]
    pub fn of(&self, order: usize, x: &[f64; D]) -> [f64; D] {
        (self.linear[order] * Vector::from(*x) + self.shift[order]).into()
    }
    /// Place \[m\] and velocity \[m/s\] of what is at `x` and moves with `v` in the frame that the pose carries.
    pub(crate) fn carries(&self, x: &[f64; D], v: &[f64; D]) -> [[f64; D]; 2] {
        let relative = self.linear[0] * Vector::from(*v);
        let own = self.of(1, x);
        [
            self.of(0, x),
            core::array::from_fn(|d| own[d] + relative[d]),
        ]
    }
    /// The same for places that are counted from `origin` o \[m\]: x − o = A (X − o) + b + A o − o.
    #[must_use]
    pub fn seen_from(mut self, origin: &[f64; D]) -> Self {
        let origin = Vector::from(*origin);
        let [place, rates @ ..] = &mut self.shift;
        *place += self.linear[0] * origin - origin;
        for (shift, linear) in rates.iter_mut().zip(&self.linear[1..]) {
            *shift += linear * origin;
        }
        self
    }
    /// What follows when `next` moves what this pose has moved: x = A₂ (A₁ X + b₁) + b₂, with its derivatives by the product
    /// rule.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let ([a, a1, a2], [b, b1, b2]) = (&next.linear, &self.linear);
        let ([s, s1, s2], [t, t1, t2]) = (&next.shift, &self.shift);
        Self {
            linear: [a * b, a1 * b + a * b1, a2 * b + a1 * b1 * 2.0 + a * b2],
            shift: [
                a * t + s,
                a1 * t + a * t1 + s1,
                a2 * t + a1 * t1 * 2.0 + a * t2 + s2,
            ],
        }
    }
    /// ∇v \[1/s\] of a frame that turns or deforms: v = A′ X + b′ at x = A X + b, so ∂v/∂x = A′ A⁻¹.
    pub(crate) fn velocity_gradient(&self) -> Option<Matrix<f64, D>> {
        if self.linear[1] == Matrix::<f64, D>::zeros() {
            return None;
        }
        Some(self.linear[1] * inverse(&self.linear[0], 0.0)?)
    }
    /// This pose with place and velocity of the middle of a straight way between two poses at two
    /// times \[s\], as particles go in a drift.
    pub(crate) fn on_chord(mut self, [from, to]: [Self; 2], [begin, end]: [f64; 2]) -> Self {
        if end != begin {
            let per_time = 1.0 / (end - begin);
            self.linear[0] = (from.linear[0] + to.linear[0]) * 0.5;
            self.linear[1] = (to.linear[0] - from.linear[0]) * per_time;
            self.shift[0] = (from.shift[0] + to.shift[0]) * 0.5;
            self.shift[1] = (to.shift[0] - from.shift[0]) * per_time;
        }
        self
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
/// assert_eq!(braked.pose(0.5).of(1, &[0.3, 0.2]), [-147.1, 0.0]);
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
    /// The same for places that are counted from `origin` \[m\], as a simulation [counts them](crate::scene#place).
    ///
    /// By default it follows from the pose, and is right to the rounding of `f64` there. A motion about a place that
    /// it knows takes that place less `origin`, and so has the same bits wherever the scene is.
    fn pose_from(&self, origin: &[f64; D], time: f64) -> Pose<D> {
        self.pose(time).seen_from(origin)
    }
    /// The times \[s\] between which there is a pose; always by default. A run that goes beyond ends with an error.
    fn span(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }
    /// An estimate of how far the motion is from what its rows were taken from, over its amplitude, if it is
    /// [made of rows](super::Recorded). [`Scene::advise`](crate::scene::Scene::advise) judges it.
    fn resolution(&self) -> Option<f64> {
        None
    }
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

    /// From a record of acceleration: times \[s\], which increase, with acceleration \[m/s²\].
    ///
    /// It is a straight line between two rows and zero before the first and after the last. Velocity and
    /// displacement are its integrals without any error of a quadrature: with s = t − tₖ and the slope
    /// j = (aₖ₊₁ − aₖ)/(tₖ₊₁ − tₖ) they are v = vₖ + aₖ s + j s²/2 and x = xₖ + vₖ s + aₖ s²/2 + j s³/6,
    /// both zero at the first row.
    ///
    /// ```
    /// use meshfree::boundary::{Motion, Translation};
    /// // Up to 30 g in 5 ms, and held.
    /// let ramp = [(0.0, [0.0]), (0.005, [294.2]), (0.080, [294.2])];
    /// let sled = Translation::from_acceleration(&ramp)?;
    /// let velocity = sled.pose(0.080).of(1, &[0.0]);
    /// assert!((velocity[0] - 294.2 * (0.0025 + 0.075)).abs() < 1e-12);
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] if there are fewer than two rows, a number is not finite, or a time is not
    /// later than the one before; it names the row, the first being 1.
    pub fn from_acceleration(record: &[(f64, [f64; D])]) -> Result<Self> {
        let refuse = |what: String, value: f64, must_be: &'static str| {
            let what = format!("{what} of the record of acceleration");
            Err(Error::Argument(Problem::Parameter {
                what,
                value,
                must_be,
            }))
        };
        if record.len() < 2 {
            let rows = record.len() as f64;
            return refuse("number of rows".into(), rows, "it must be at least two");
        }
        let mut pieces: Vec<Piece<D>> = Vec::with_capacity(record.len());
        for (k, &(time, acceleration)) in record.iter().enumerate() {
            let row = k + 1;
            let wrong = |a: &f64| !a.is_finite() || a.abs() >= MOST;
            if let Some(bad) = acceleration.into_iter().find(wrong) {
                let must_be = "it must be a finite number in m/s², below 1e100: correct the row, or leave it out";
                return refuse(format!("acceleration in row {row}"), bad, must_be);
            }
            if !time.is_finite() || pieces.last().is_some_and(|last| time <= last.time) {
                let must_be =
                    "it must be finite, in seconds, and later than that of the row before";
                return refuse(format!("time in row {row}"), time, must_be);
            }
            let mut piece = Piece {
                time,
                state: [[0.0; D], [0.0; D], acceleration],
                slope: [0.0; D],
            };
            if let Some(last) = pieces.last_mut() {
                let span = time - last.time;
                let slope = core::array::from_fn(|d| (acceleration[d] - last.state[2][d]) / span);
                last.slope = slope;
                piece.state[0] = last.at(0, time);
                piece.state[1] = last.at(1, time);
            }
            let slope = pieces.last().map(|last| last.slope);
            let mut numbers = piece.state.iter().chain(&slope).flatten();
            if let Some(&bad) = numbers.find(|x| !x.is_finite() || x.abs() >= MOST * MOST) {
                let must_be = "it must be finite: check that times are in seconds and not too close to each other";
                return refuse(format!("integral up to row {row}"), bad, must_be);
            }
            pieces.push(piece);
        }
        let path = move |order: usize| {
            let pieces = pieces.clone();
            move |time: f64| {
                let passed = pieces.partition_point(|piece| piece.time <= time);
                match passed.checked_sub(1) {
                    None => [0.0; D],
                    Some(k) if k + 1 == pieces.len() && time > pieces[k].time => {
                        let mut free = pieces[k];
                        free.state[2] = [0.0; D];
                        free.at(order, time)
                    }
                    Some(k) => pieces[k].at(order, time),
                }
            }
        };
        Ok(Self::new(path(0), path(1), path(2)))
    }
}

/// What no acceleration \[m/s²\] reaches, so that its integrals are numbers.
const MOST: f64 = 1e100;

/// A stretch of straight acceleration.
#[derive(Clone, Copy)]
struct Piece<const D: usize> {
    /// Where it begins \[s\].
    time: f64,
    /// Displacement, velocity and acceleration there.
    state: [[f64; D]; 3],
    /// Slope of the acceleration \[m/s³\].
    slope: [f64; D],
}

impl<const D: usize> Piece<D> {
    /// Displacement, velocity or acceleration at a time.
    fn at(&self, order: usize, time: f64) -> [f64; D] {
        let s = time - self.time;
        let [x, v, a] = self.state;
        let j = self.slope;
        core::array::from_fn(|d| match order {
            0 => x[d] + s * (v[d] + s * (a[d] / 2.0 + s * j[d] / 6.0)),
            1 => v[d] + s * (a[d] + s * j[d] / 2.0),
            _ => a[d] + s * j[d],
        })
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
        self.pose_from(&[0.0; D], time)
    }
    fn pose_from(&self, origin: &[f64; D], time: f64) -> Pose<D> {
        let strain = (self.strain)(time);
        let mut pose = Pose::<D>::rest();
        for (order, strain) in strain.into_iter().enumerate() {
            // An axis that the dimension does not have leaves the wall at rest.
            if self.axis < D {
                pose.linear[order][(self.axis, self.axis)] -= strain;
                pose.shift[order][self.axis] = strain * (self.fixed - origin[self.axis]);
            }
        }
        pose
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::Rotation;
    use super::*;

    /// Velocity and acceleration are the differences of position and velocity.
    pub(crate) fn derivatives_agree<const D: usize>(motion: &dyn Motion<D>, x: [f64; D]) {
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
        let rows = [(0.1, [1.0, 0.0]), (0.3, [-3.0, 2.0]), (0.5, [4.0, 1.0])];
        let recorded = Translation::from_acceleration(&rows).unwrap();
        derivatives_agree(&recorded, [0.7, 0.0]);
        let plane = Crush::along(1, 0.4, wave).pose(0.9).of(0, &[2.0, 0.4]);
        assert!((plane[1] - 0.4).abs() < 1e-15 && plane[0] == 2.0);
    }

    /// A half sine by straight lines has the speed and the travel of the sine to the square of the step.
    #[test]
    fn a_recorded_half_sine_is_the_half_sine() {
        use core::f64::consts::PI;
        let (peak, length) = (294.2, 0.08);
        let rows: Vec<_> = (0..=800)
            .map(|k| f64::from(k) / 800.0)
            .map(|s| (length * s, [peak * (PI * s).sin()]))
            .collect();
        let pulse = Translation::from_acceleration(&rows).unwrap();
        for t in [0.0, 0.0101, 0.038, 0.07996, 0.08] {
            let (w, pose) = (PI / length, pulse.pose(t));
            let speed = peak / w * (1.0 - (w * t).cos());
            let travel = peak / w * (t - (w * t).sin() / w);
            let [x] = pose.of(0, &[0.0]);
            let [v] = pose.of(1, &[0.0]);
            assert!((v - speed).abs() < 2e-6 * 14.98 && (x - travel).abs() < 2e-6 * 0.6);
        }
        // Afterwards it goes on as it was, before it rests.
        let [x] = pulse.pose(0.09).of(0, &[0.0]);
        let [end] = pulse.pose(0.08).of(0, &[0.0]);
        let speed = 2.0 * peak * length / PI;
        assert!(((x - end) / (0.01 * speed) - 1.0).abs() < 2e-6);
        assert_eq!(pulse.pose(0.09).of(2, &[0.0]), [0.0]);
        assert_eq!(pulse.pose(-0.01), Pose::rest());
    }

    #[test]
    fn a_bad_record_is_refused_with_its_row() {
        let message = |rows: &[(f64, [f64; 1])]| {
            Translation::from_acceleration(rows)
                .err()
                .map(|error| error.to_string())
        };
        let wrong = [
            (vec![(0.0, [1.0])], "number of rows"),
            (
                vec![(0.0, [1.0]), (1.0, [f64::NAN])],
                "acceleration in row 2",
            ),
            (vec![(0.0, [1.0]), (0.0, [1.0])], "time in row 2"),
            (vec![(0.0, [1.0]), (f64::INFINITY, [1.0])], "time in row 2"),
            (vec![(f64::NAN, [1.0]), (1.0, [1.0])], "time in row 1"),
        ];
        for (rows, part) in wrong {
            assert!(
                message(&rows).is_some_and(|text| text.contains(part)),
                "{part}"
            );
        }
    }
}
