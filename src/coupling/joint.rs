//! Joints of rigid bodies: what holds two of them, or one and the ground, and the springs, dampers and motors on that.
//! What is described here the simulation solves for (`simulation/joints`).

use core::fmt;
use std::sync::Arc;

/// A number as a function of time \[s\].
type OfTime = Arc<dyn Fn(f64) -> f64 + Send + Sync>;

/// How two [rigid](crate::scene::Scene::rigid) bodies hold each other, or one the ground; for
/// [`Scene::joint`](crate::scene::Scene::joint) and [`Scene::joint_to_ground`](crate::scene::Scene::joint_to_ground).
///
/// Places \[m\] and axes are those of the scene as built. A joint leaves the first body free to move relative to the second
/// along one coordinate q, or to turn about a point:
///
/// | joint | holds | q |
/// |---|---|---|
/// | [`ball`](Self::ball) | a point of both | none |
/// | [`hinge`](Self::hinge) | a point and an axis | the angle \[rad\] about the axis, zero as built |
/// | [`slider`](Self::slider) | all but the way along an axis | that way \[m\], zero as built |
/// | [`distance`](Self::distance) | the distance of two points | none |
/// | [`spring`](Self::spring) | nothing | the distance \[m\] of two points |
///
/// On q act a spring, a damper and a motor, F = −k (q − q₀) − c dq/dt + F_m(t) \[N, or N m at a hinge\]; or a motor gives dq/dt.
///
/// # Method
///
/// Holding is a constraint g(x) = 0. Its impulses λ, Lagrange multipliers, follow from the linear system of all joints
/// together, with the matrix J M⁻¹ Jᵀ of J = ∂g/∂x and the mass matrix M, which is solved directly. Before a drift they are chosen
/// such that g = 0 at its end, by Newton's method to rounding, and after a kick such that J v = 0 (RATTLE, Andersen 1983, J. Comput.
/// Phys. 52, 24). The share of them that balances the forces of an evaluation is in the kicks, Jᵀ λ with J M⁻¹ (F + Jᵀ λ) = 0, so that kicks
/// do no work against joints. With the free rotation of rigid bodies this is reversible and symplectic (Leimkuhler & Skeel 1994, J. Comput. Phys. 112, 117),
/// so energy oscillates and does not drift, and no constraint has a stiffness or a correction rate to choose. Impulses are opposite and act
/// along one line, so momentum and angular momentum stay to rounding.
///
/// An engine of rigid bodies is not used: those in use iterate to a tolerance and damp what is left (Baumgarte 1972), so energy and bits would
/// be theirs, and it would be a dependency.
///
/// Joints are solved in an order of their own, by names, kinds and places. The system is dense: its cost grows as the cube of
/// the number of constraints, and it is meant for tens of them.
///
/// # Requirements
///
/// Constraints must not repeat each other: of two hinges in space on one axis the second is a [`ball`](Self::ball) or
/// a [`distance`](Self::distance). A scene with such joints is not built. A body whose particles are all
/// [clamped](crate::scene::Scene::clamp) holds others as ground that moves. Bodies of one group meet at a joint by their
/// kernels where they are near; [`Interaction::None`](crate::sweep::Interaction::None) leaves the joint alone. Of a body that has left by an
/// outlet the others are held as by one at rest.
///
/// Springs and dampers limit the step: 0.1/(√(k/m) + c/m), with the mass m that the bodies have along q, where the leapfrog has the
/// period of a spring to 0.05 %.
#[derive(Clone)]
pub struct Joint<const D: usize> {
    pub(crate) kind: Kind<D>,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    pub(crate) rest: Option<f64>,
    pub(crate) motor: Motor,
}

/// What a joint holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind<const D: usize> {
    Ball { at: [f64; D] },
    Hinge { at: [f64; D], axis: [f64; 3] },
    Slider { at: [f64; D], axis: [f64; D] },
    Distance { at: [[f64; D]; 2] },
    Spring { at: [[f64; D]; 2] },
}

/// What drives a joint.
#[derive(Clone)]
pub(crate) enum Motor {
    None,
    /// dq/dt.
    Speed(OfTime),
    /// The force along q.
    Force(OfTime),
}

impl<const D: usize> fmt::Debug for Joint<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Joint")
            .field("kind", &self.kind)
            .field("stiffness", &self.stiffness)
            .field("damping", &self.damping)
            .field("rest", &self.rest)
            .field("motor", &self.motor.name())
            .finish()
    }
}

impl Motor {
    fn name(&self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Speed(_) => "speed",
            Self::Force(_) => "force",
        }
    }
}

impl<const D: usize> Joint<D> {
    fn of(kind: Kind<D>) -> Self {
        Self {
            kind,
            stiffness: 0.0,
            damping: 0.0,
            rest: None,
            motor: Motor::None,
        }
    }

    /// Holds the point of both bodies that is at a place \[m\] as built; they turn about it freely.
    ///
    /// ```
    /// use meshfree::coupling::Joint;
    /// use meshfree::prelude::*;
    /// // A pendulum in space.
    /// let bob = Material::new("bob", Linear::new(1000.0, 20.0));
    /// let mut simulation = Scene::<f64, 3>::new(schemes::impact_by_continuity())
    ///     .body(Body::block("bob", bob, [-0.1; 3], [0.1; 3], 0.05).velocity([0.5, 0.2, 0.0]))
    ///     .rigid("bob")
    ///     .joint_to_ground("bob", Joint::ball([0.0, 0.0, 1.0]))
    ///     .acceleration(|_| [0.0, 0.0, -9.81])
    ///     .build()?;
    /// simulation.run_until(0.5)?;
    /// // One metre from the point as built, and so now.
    /// let [x, y, z] = simulation.rigid_body("bob")?.centre;
    /// assert!((x * x + y * y + (z - 1.0) * (z - 1.0) - 1.0).abs() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn ball(at: [f64; D]) -> Self {
        Self::of(Kind::Ball { at })
    }

    /// Holds a point \[m\] and an axis of both bodies, about which the first turns. The axis need not have length one; in a plane it is
    /// \[0, 0, 1\] or its opposite. The angle grows as a right hand turns about it.
    ///
    /// ```
    /// use meshfree::coupling::Joint;
    /// use meshfree::prelude::*;
    /// // A plate turns at 2 rad/s about its corner.
    /// let steel = Material::new("steel", Linear::new(7800.0, 20.0));
    /// let mut simulation = Scene::<f64, 2>::new(schemes::impact_by_continuity())
    ///     .body(Body::block("plate", steel, [0.0; 2], [0.4, 0.2], 0.05))
    ///     .rigid("plate")
    ///     .joint_to_ground("plate", Joint::hinge([0.0; 2], [0.0, 0.0, 1.0]).speed(|_| 2.0))
    ///     .build()?;
    /// simulation.run_until(0.5)?;
    /// let hinge = &simulation.joints()[0];
    /// assert!((hinge.value - 1.0).abs() < 1e-12 && (hinge.rate - 2.0).abs() < 1e-12);
    /// assert!((simulation.rigid_body("plate")?.angular_velocity[2] - 2.0).abs() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn hinge(at: [f64; D], axis: [f64; 3]) -> Self {
        Self::of(Kind::Hinge { at, axis })
    }

    /// Lets the first body slide along an axis of the second through a place \[m\], without turning against it. The axis need not
    /// have length one.
    ///
    /// ```
    /// use meshfree::coupling::Joint;
    /// use meshfree::prelude::*;
    /// // A block slides down a slope of 30 degrees.
    /// let wood = Material::new("wood", Linear::new(600.0, 20.0));
    /// let slope = [-(3.0_f64.sqrt()) / 2.0, -0.5];
    /// let mut simulation = Scene::<f64, 2>::new(schemes::impact_by_continuity())
    ///     .body(Body::block("block", wood, [-0.1; 2], [0.1; 2], 0.05))
    ///     .rigid("block")
    ///     .joint_to_ground("block", Joint::slider([0.0; 2], slope))
    ///     .acceleration(|_| [0.0, -9.81])
    ///     .build()?;
    /// simulation.run_until(0.5)?;
    /// assert!((simulation.joints()[0].value / (0.5 * 9.81 * 0.5 * 0.25) - 1.0).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn slider(at: [f64; D], axis: [f64; D]) -> Self {
        Self::of(Kind::Slider { at, axis })
    }

    /// Holds the distance that a point of the first body and one of the second have as built \[m\]: a rod without mass.
    ///
    /// ```
    /// use meshfree::coupling::Joint;
    /// // A rod of half a metre.
    /// let rod = Joint::distance([0.0, 0.0], [0.3, 0.4]);
    /// # let _ = rod;
    /// ```
    #[must_use]
    pub fn distance(first: [f64; D], second: [f64; D]) -> Self {
        let at = [first, second];
        Self::of(Kind::Distance { at })
    }

    /// A spring of stiffness k \[N/m\] between a point \[m\] of the first body and one of the second. It is at rest as built
    /// unless [`rest`](Self::rest) says otherwise.
    ///
    /// ```
    /// use meshfree::coupling::Joint;
    /// use meshfree::prelude::*;
    /// // A mass on a spring: q = q₀ + v/ω sin ω t with ω² = k/m.
    /// let lead = Material::new("lead", Linear::new(100.0, 20.0));
    /// let mut simulation = Scene::<f64, 2>::new(schemes::impact_by_continuity())
    ///     .body(Body::block("mass", lead, [0.9, -0.1], [1.1, 0.1], 0.05).velocity([0.1, 0.0]))
    ///     .rigid("mass")
    ///     .joint_to_ground("mass", Joint::spring([1.0, 0.0], [0.0, 0.0], 100.0))
    ///     .build()?;
    /// simulation.run_until(0.2)?;
    /// let omega = (100.0_f64 / 4.0).sqrt();
    /// let exact = 1.0 + 0.1 / omega * (omega * 0.2).sin();
    /// assert!((simulation.joints()[0].value - exact).abs() < 1e-4 * 0.1 / omega);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn spring(first: [f64; D], second: [f64; D], stiffness: f64) -> Self {
        let at = [first, second];
        Self {
            stiffness,
            ..Self::of(Kind::Spring { at })
        }
    }

    /// A spring on q: of stiffness k \[N/m\], at a hinge \[N m/rad\]. Zero by default.
    #[must_use]
    pub fn stiffness(mut self, stiffness: f64) -> Self {
        self.stiffness = stiffness;
        self
    }

    /// A damper on q: of constant c \[N s/m\], at a hinge \[N m s/rad\]. Zero by default. What it takes is heat in the
    /// [ledger](crate::simulation::Ledger), and in no body's internal energy.
    #[must_use]
    pub fn damping(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }

    /// Where the spring is at rest, q₀ \[m, or rad at a hinge\]; by default q as built.
    #[must_use]
    pub fn rest(mut self, rest: f64) -> Self {
        self.rest = Some(rest);
        self
    }

    /// A motor that gives the speed dq/dt \[m/s, or rad/s at a hinge\] as a function of time \[s\], whatever it takes.
    #[must_use]
    pub fn speed(mut self, speed: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        self.motor = Motor::Speed(Arc::new(speed));
        self
    }

    /// A motor that gives a force along q \[N\], or a torque at a hinge \[N m\], as a function of time \[s\]. The last of
    /// `speed` and `force` counts.
    #[must_use]
    pub fn force(mut self, force: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        self.motor = Motor::Force(Arc::new(force));
        self
    }

    /// Its name in reports.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self.kind {
            Kind::Ball { .. } => "ball",
            Kind::Hinge { .. } => "hinge",
            Kind::Slider { .. } => "slider",
            Kind::Distance { .. } => "distance",
            Kind::Spring { .. } => "spring",
        }
    }

    /// What is wrong with it by its own numbers: what, its value, and what it must be.
    pub(crate) fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut all = Vec::new();
        let finite = "it must be finite, in metres";
        let mut finite_places = |at: &[[f64; D]]| {
            let wrong = at.iter().flatten().find(|x| !x.is_finite());
            all.extend(wrong.map(|x| ("place", *x, finite)));
        };
        match &self.kind {
            Kind::Ball { at } | Kind::Hinge { at, .. } | Kind::Slider { at, .. } => {
                finite_places(&[*at]);
            }
            Kind::Distance { at } | Kind::Spring { at } => finite_places(at),
        }
        let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let positive = |length: f64| length.is_finite() && length > 0.0;
        match &self.kind {
            Kind::Hinge { axis, .. } => {
                if !positive(length(axis)) {
                    let must_be = "it must have a length: name the direction about which the first body turns";
                    all.push(("length of the axis", length(axis), must_be));
                } else if D < 3 && length(&axis[..2]) > 0.0 {
                    let must_be = "in a plane a hinge turns about [0, 0, 1] or [0, 0, -1]";
                    all.push(("axis in the plane", length(&axis[..2]), must_be));
                }
                if D < 2 {
                    all.push((
                        "dimension",
                        1.0,
                        "in one dimension nothing turns: take a ball",
                    ));
                }
            }
            Kind::Slider { axis, .. } if !positive(length(axis)) => {
                let must_be =
                    "it must have a length: name the direction along which the first body slides";
                all.push(("length of the axis", length(axis), must_be));
            }
            Kind::Distance { at: [a, b] } => {
                let between: [f64; D] = core::array::from_fn(|d| a[d] - b[d]);
                if length(&between) == 0.0 {
                    let must_be = "the two points must be apart: for one point of both take a ball";
                    all.push(("distance", 0.0, must_be));
                }
            }
            _ => {}
        }
        for (what, value) in [("stiffness", self.stiffness), ("damping", self.damping)] {
            if !(value.is_finite() && value >= 0.0) {
                all.push((what, value, "it must be finite and not negative"));
            }
        }
        let free = matches!(self.kind, Kind::Ball { .. } | Kind::Distance { .. });
        for (what, value) in [("stiffness", self.stiffness), ("damping", self.damping)] {
            if free && value != 0.0 {
                let must_be =
                    "the joint has no coordinate to act on: take a hinge, a slider or a spring";
                all.push((what, value, must_be));
            }
        }
        if let Some(rest) = self.rest
            && (free || !rest.is_finite())
        {
            all.push((
                "rest",
                rest,
                "it must be finite, and of a joint with a coordinate",
            ));
        }
        let must_be =
            "a motor of given speed or force is for a hinge, a slider, or as a force for a spring";
        match &self.motor {
            Motor::Speed(of) if free || matches!(self.kind, Kind::Spring { .. }) => {
                all.push(("speed of the motor at t = 0", of(0.0), must_be));
            }
            Motor::Force(of) if free => all.push(("force of the motor at t = 0", of(0.0), must_be)),
            _ => {}
        }
        all
    }
}
