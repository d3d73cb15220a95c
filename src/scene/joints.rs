//! Joints of a scene: between two rigid bodies, or one and the ground.
//! Checked, and brought into the order in which they are solved.

use super::Scene;
use crate::coupling::{Joint, Kind};
use crate::error::Problem;
use crate::scalar::Real;
use crate::simulation::{Frame, Geometry, Group, Jointing};
use nalgebra::Vector3;
use std::sync::Arc;

/// A joint and the bodies that it is of.
#[derive(Clone, Debug)]
pub(super) struct JointOf<const D: usize> {
    pub first: String,
    pub second: Option<String>,
    pub joint: Joint<D>,
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// Joins two [rigid](Self::rigid) bodies: by a hinge, a slider, a ball, a rod of fixed distance or a spring, which may have a damper and a
    /// motor ([`Joint`]). The coordinate of the joint is that of the first relative to the second. Velocities that a joint does not allow are
    /// taken at the start; momentum stays.
    ///
    /// Coordinates, forces, impulses and work of joints are in [`Simulation::joints`](crate::simulation::Simulation::joints),
    /// and the whole [`Ledger`](crate::simulation::Ledger) has `work of joints`, `energy of joints`, `heat of joints` and `work of motors`.
    /// The order in which joints are added changes no bit.
    ///
    /// ```
    /// use meshfree::coupling::Joint;
    /// use meshfree::prelude::*;
    /// // Two bars that hinge on each other fold as they fly: momentum and energy stay.
    /// let bar = |name, x: f64, length: f64| {
    ///     let steel = Material::new("steel", Linear::new(7800.0, 20.0));
    ///     Body::block(name, steel, [x, 0.0], [x + length, 0.1], 0.05)
    /// };
    /// let mut simulation = Scene::<f64, 2>::new(schemes::impact_by_continuity())
    ///     .body(bar("left", -0.4, 0.4).velocity([0.0, 1.0]))
    ///     .body(bar("right", 0.0, 0.8))
    ///     .rigid("left")
    ///     .rigid("right")
    ///     .between("left", "right", Interaction::None)
    ///     .joint("left", "right", Joint::hinge([0.0, 0.05], [0.0, 0.0, 1.0]))
    ///     .build()?;
    /// let before = simulation.ledger().whole;
    /// simulation.run_until(0.2)?;
    /// let after = simulation.ledger().whole;
    /// assert!((after.momentum[1] / before.momentum[1] - 1.0).abs() < 1e-12);
    /// assert!((after.kinetic / before.kinetic - 1.0).abs() < 1e-4);
    /// assert!(simulation.joints()[0].value < -0.1);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn joint(self, first: &str, second: &str, joint: Joint<D>) -> Self {
        self.joined(first, Some(second), joint)
    }

    /// Joins a [rigid](Self::rigid) body to the ground, which stays where it is. What the ground gives is in
    /// [`Ledger::joint_impulse`](crate::simulation::Ledger::joint_impulse).
    ///
    /// ```
    /// use meshfree::coupling::Joint;
    /// use meshfree::prelude::*;
    /// // A pendulum that is let go level: at its lowest point its hinge holds m g (1 + 2 m L²/(m L² + I)), here with L = 1 m.
    /// let bob = Material::new("bob", Linear::new(1000.0, 20.0));
    /// let mut simulation = Scene::<f64, 2>::new(schemes::impact_by_continuity())
    ///     .body(Body::block("bob", bob, [0.9, -0.1], [1.1, 0.1], 0.05))
    ///     .rigid("bob")
    ///     .joint_to_ground("bob", Joint::hinge([0.0; 2], [0.0, 0.0, 1.0]))
    ///     .acceleration(|_| [0.0, -9.81])
    ///     .build()?;
    /// let own = simulation.rigid_body("bob")?;
    /// let share = own.mass / (own.mass + own.inertia[2][2]);
    /// let mut most = 0.0_f64;
    /// simulation.run_with(1.0, |now| most = most.max(now.joints()[0].force[1]))?;
    /// assert!((most / (own.mass * 9.81 * (1.0 + 2.0 * share)) - 1.0).abs() < 1e-3);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn joint_to_ground(self, body: &str, joint: Joint<D>) -> Self {
        self.joined(body, None, joint)
    }

    fn joined(mut self, first: &str, second: Option<&str>, joint: Joint<D>) -> Self {
        self.joints.push(JointOf {
            first: first.into(),
            second: second.map(Into::into),
            joint,
        });
        self
    }

    pub(super) fn check_joints(&self, problems: &mut Vec<Problem>) {
        for own in &self.joints {
            let name = own.joint.name();
            let whose =
                |second: &str| format!("the joint ({name}) of `{}` and {second}", own.first);
            let whose = match &own.second {
                Some(second) => whose(&format!("`{second}`")),
                None => whose("the ground"),
            };
            for (what, value, must_be) in own.joint.problems() {
                problems.push(Problem::Parameter {
                    what: format!("{what} of {whose}"),
                    value,
                    must_be,
                });
            }
            if own.second.as_ref() == Some(&own.first) {
                problems.push(Problem::Incompatible {
                    what: format!("{whose} joins a body to itself"),
                    remedy: "name two bodies, or take Scene::joint_to_ground",
                });
            }
            for body in [Some(&own.first), own.second.as_ref()]
                .into_iter()
                .flatten()
            {
                let Some((group, _)) = self.place_of(body) else {
                    problems.push(self.unknown_body(body));
                    continue;
                };
                if !self.rigid.contains(body) {
                    problems.push(Problem::Incompatible {
                        what: format!("body `{body}` of {whose} is not rigid"),
                        remedy: "make it rigid (Scene::rigid); a deformable body is held by Scene::couple with \
                        Tied",
                    });
                }
                let bodies = &self.parts[group].bodies;
                let mut apart = self.sub_cycled.iter();
                if apart.any(|(name, _)| bodies.iter().any(|body| body.name == *name)) {
                    problems.push(Problem::Incompatible {
                        what: format!("body `{body}` of {whose} is in a group that sub-cycles"),
                        remedy: "leave Scene::sub_cycle out for its group: joints are solved for all bodies at once",
                    });
                }
            }
        }
    }

    /// Joints in the order in which they are solved, between bodies of these groups.
    pub(super) fn joints_of(&self, groups: &[Group<T, D>], origin: &[f64; D]) -> Vec<Jointing<D>> {
        let find = |name: &String| {
            let (group, body) = self.place_of(name)?;
            let mut rigid = groups[group].held.rigid.iter();
            Some([group, rigid.position(|own| own.body == body)?])
        };
        let frame = |body: Option<[usize; 2]>| {
            body.map_or_else(Frame::ground, |[group, own]| {
                groups[group].held.rigid[own].frame()
            })
        };
        let all = self.joints.iter().enumerate().map(|(number, own)| {
            let bodies = [find(&own.first), own.second.as_ref().and_then(find)];
            let [first, second] = bodies.map(frame);
            let geometry = Geometry::new(&own.joint, [&first, &second], origin);
            let value = match own.joint.kind {
                Kind::Distance { .. } | Kind::Spring { .. } => geometry.length,
                _ => 0.0,
            };
            Jointing {
                joint: Arc::new(own.joint.clone()),
                number,
                bodies,
                names: [Some(own.first.clone()), own.second.clone()],
                value,
                rest: own.joint.rest.unwrap_or(value),
                target: 0.0,
                acting: 0.0,
                driving: 0.0,
                damping: 0.0,
                holding: Vec::new(),
                pending: [Vector3::zeros(); 2],
                held: [Vector3::zeros(); 2],
                impulse: [0.0; D],
                work: 0.0,
                motor_work: 0.0,
                heat: 0.0,
                geometry,
            }
        });
        let mut all: Vec<_> = all.collect();
        // Places are counted from the origin, so that where the scene is changes no order.
        all.sort_by(|a, b| {
            let names = a
                .names
                .cmp(&b.names)
                .then(a.joint.name().cmp(b.joint.name()));
            names.then_with(|| {
                let [a, b] = [a, b].map(|own| {
                    let Joint {
                        stiffness, damping, ..
                    } = *own.joint;
                    let mut all = own.geometry.numbers();
                    all.extend([stiffness, damping, own.rest]);
                    all
                });
                let mut pairs = a.iter().zip(&b).map(|(a, b)| a.total_cmp(b));
                pairs
                    .find(|own| own.is_ne())
                    .unwrap_or(core::cmp::Ordering::Equal)
            })
        });
        all
    }
}
