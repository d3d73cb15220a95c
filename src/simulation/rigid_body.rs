//! Readings of rigid bodies and joints: how each stands and moves, its inertia, and what acts on it.
//! All follow from the state.

use super::Simulation;
use super::group::Group;
use super::joint_rows::Frame;
use super::joints::Jointing;
use super::rigid::{Rigid, lowered};
use super::spin::raised;
use super::which::{Which, find};
use crate::error::Result;
use crate::origin::global;
use crate::particles::Output;
use crate::scalar::Real;
use nalgebra::{Matrix3, Vector3};
use std::borrow::Cow;

/// How a [rigid](crate::scene::Scene::rigid) body stands, moves, and what acts on it. In a plane rotation is about the third axis, in
/// one dimension there is none.
///
/// ```
/// use meshfree::prelude::*;
/// // A box that falls and turns.
/// let wood = Material::new("wood", Linear::new(600.0, 10.0));
/// let turns = |[x, y]: [f64; 2], start| meshfree::scheme::Start { velocity: [-y, x], ..start };
/// let mut simulation = Scene::<f64, 2>::new(schemes::impact_by_continuity())
///     .body(Body::block("box", wood, [-0.1; 2], [0.1; 2], 0.02).start(turns))
///     .rigid("box")
///     .acceleration(|_| [0.0, -9.81])
///     .build()?;
/// simulation.run_until(0.5)?;
/// let own = simulation.rigid_body("box")?;
/// assert!((own.velocity[1] + 9.81 * 0.5).abs() < 1e-9 && (own.angular_velocity[2] - 1.0).abs() < 1e-9);
/// assert!((own.orientation[1][0] - 0.5_f64.sin()).abs() < 1e-9);
/// assert!((own.mass - 600.0 * 0.04).abs() < 1e-9);
/// assert_eq!(own.mass_matrix()[5][5], own.inertia[2][2]);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RigidBody<const D: usize> {
    /// Mass \[kg\].
    pub mass: f64,
    /// The inertia tensor about the centre of mass, I = Σ m (r² − r ⊗ r) \[kg m²\], in the axes of space. Particles count as
    /// points: a lattice of n of them a side has (1 − 1/n²) of the moment of a solid.
    pub inertia: [[f64; 3]; 3],
    /// The centre of mass \[m\]. It goes on where [periods](crate::boundary::Periodic) bring particles back.
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::components"))]
    pub centre: [f64; D],
    /// The rotation R since it was built: what was at X from the centre is at R X.
    pub orientation: [[f64; 3]; 3],
    /// Velocity of the centre of mass \[m/s\].
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::components"))]
    pub velocity: [f64; D],
    /// Angular velocity \[rad/s\].
    pub angular_velocity: [f64; 3],
    /// Angular momentum about the centre of mass \[kg m²/s\].
    pub angular_momentum: [f64; 3],
    /// The force \[N\] of all that acts on it at the last evaluation: liquids, contacts, loads, springs, dampers and motors; without the
    /// weight by [`Scene::acceleration`](crate::scene::Scene::acceleration), and without what holds joints.
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::components"))]
    pub force: [f64; D],
    /// The moment of the same about the centre of mass \[N m\].
    pub moment: [f64; 3],
    /// The force \[N\] that holds its [joints](crate::coupling::Joint), the mean of the last step.
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::components"))]
    pub joint_force: [f64; D],
    /// The moment of the same about the centre of mass \[N m\].
    pub joint_moment: [f64; 3],
}

impl<const D: usize> RigidBody<D> {
    /// The mass matrix of its velocity and angular velocity in space: m, m, m and the inertia tensor.
    #[must_use]
    pub fn mass_matrix(&self) -> [[f64; 6]; 6] {
        let of = |row: usize, column: usize| match (row, column) {
            (0..3, 0..3) if row == column => self.mass,
            (3.., 3..) => self.inertia[row - 3][column - 3],
            _ => 0.0,
        };
        core::array::from_fn(|row| core::array::from_fn(|column| of(row, column)))
    }
}

/// How a [joint](crate::coupling::Joint) stands.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Jointed<const D: usize> {
    /// What it is, as `hinge`.
    pub name: &'static str,
    /// The two bodies; the ground is none.
    pub bodies: [Option<String>; 2],
    /// Its coordinate q \[m, or rad at a hinge, turns included\]; zero where it has none.
    pub value: f64,
    /// dq/dt \[m/s or rad/s\].
    pub rate: f64,
    /// The force \[N\] on the first body: of what holds, the mean of the last step, and of spring, damper and motor at the last evaluation.
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::components"))]
    pub force: [f64; D],
    /// The moment of the same about the place of the joint \[N m\].
    pub moment: [f64; 3],
    /// Momentum \[kg m/s\] given to the first body since the start; the second, or the ground, got the opposite.
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::components"))]
    pub impulse: [f64; D],
    /// Energy in the spring \[J\].
    pub stored: f64,
    /// What the joint has worked on both bodies since the start \[J\]: the work of the motor, less heat and what the spring stores. The
    /// difference is the error of the steps, which oscillates.
    pub work: f64,
    /// What the motor has worked since the start \[J\].
    pub motor_work: f64,
    /// What the damper has taken since the start \[J\].
    pub heat: f64,
}

impl<const D: usize> Rigid<D> {
    pub(crate) fn frame(&self) -> Frame {
        Frame {
            centre: raised(&self.centre),
            turn: self.turn,
        }
    }

    /// The sum of the forces at hand on its particles \[N\], and their moment about its centre \[N m\].
    pub(super) fn forces<T: Real>(&self, group: &Group<T, D>) -> [Vector3<f64>; 2] {
        let rates = &group.work.rates;
        self.sums(&group.particles, |slot| {
            raised(&rates.vector(Output::FORCE, slot).map(Real::to_f64))
        })
    }

    /// What uniform loads give it \[N\].
    pub(super) fn weight<T: Real>(&self, group: &Group<T, D>) -> Vector3<f64> {
        self.mass * raised(&group.work.evaluated_gravity.map(Real::to_f64))
    }
}

/// The rows of a matrix.
fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    core::array::from_fn(|row| core::array::from_fn(|column| matrix[(row, column)]))
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// How a [rigid](crate::scene::Scene::rigid) body stands and moves, its inertia, and what acts on it. Forces are those of the last
    /// evaluation ([`evaluate`](Self::evaluate) makes one).
    ///
    /// # Errors
    /// If the scene has no such body, or it is not rigid; the error lists those that are.
    pub fn rigid_body(&self, which: impl Which) -> Result<RigidBody<D>> {
        let groups = self.state.groups.iter().enumerate();
        let all = groups.flat_map(|(k, group)| {
            let of = move |(number, own): (usize, &Rigid<D>)| {
                let name = Cow::Borrowed(group.particles.bodies[own.body].name.as_str());
                (name, [k, number])
            };
            group.held.rigid.iter().enumerate().map(of)
        });
        let all: Vec<(Cow<'_, str>, [usize; 2])> = all.collect();
        let (_, [number, rigid]) = find(&which, "rigid body", all.iter().cloned())?;
        let group = &self.state.groups[number];
        let own = &group.held.rigid[rigid];
        let [momentum, spin] = own.momenta(&group.particles);
        let [all, holding] = [own.forces(group), self.state.holding_on([number, rigid])];
        let [force, moment] = [all[0] - holding[0], all[1] - holding[1]];
        let axes = own.turn.to_rotation_matrix();
        let inertia = axes * Matrix3::from_diagonal(&own.inertia) * axes.transpose();
        let mut held = [Vector3::zeros(); 2];
        for joint in &self.state.joints.all {
            let ([n, a], place) = (joint.held, joint.place(&self.state.groups));
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                if joint.bodies[side] == Some([number, rigid]) {
                    let arm = place - raised(&own.centre);
                    held[0] += sign * n;
                    held[1] += sign * (a + arm.cross(&n));
                }
            }
        }
        Ok(RigidBody {
            mass: own.mass,
            inertia: rows(&inertia),
            centre: global(&own.centre, &group.particles.origin),
            orientation: rows(
                (own.turn * own.built.inverse())
                    .to_rotation_matrix()
                    .matrix(),
            ),
            velocity: lowered(&(momentum / own.mass)),
            angular_velocity: own.answer_in_space(&spin).into(),
            angular_momentum: spin.into(),
            force: lowered(&force),
            moment: moment.into(),
            joint_force: lowered(&held[0]),
            joint_moment: held[1].into(),
        })
    }

    /// How all joints stand, in the order of the scene.
    #[must_use]
    pub fn joints(&self) -> Vec<Jointed<D>> {
        let lines = self.state.lines_of_joints();
        let mut all: Vec<(usize, Jointed<D>)> = (self.state.joints.all.iter().zip(lines))
            .map(|(own, line)| (own.number, own.reading(line)))
            .collect();
        all.sort_by_key(|own| own.0);
        all.into_iter().map(|own| own.1).collect()
    }
}

impl<const D: usize> Jointing<D> {
    /// Where it is on its first body \[m\], from the origin.
    fn place<T: Real>(&self, groups: &[Group<T, D>]) -> Vector3<f64> {
        let frame = self.bodies[0].map(|[group, own]| groups[group].held.rigid[own].frame());
        let frame = frame.unwrap_or_else(Frame::ground);
        frame.centre + self.geometry.arm(&frame)
    }

    /// How it stands, with what a unit along q does to the first body, and dq/dt.
    fn reading(&self, line: Option<([Vector3<f64>; 2], f64)>) -> Jointed<D> {
        let ([n, a], rate) = line.unwrap_or_default();
        Jointed {
            name: self.joint.name(),
            bodies: self.names.clone(),
            value: line.map_or(0.0, |_| self.value),
            rate,
            force: lowered(&(self.held[0] + self.acting * n)),
            moment: (self.held[1] + self.acting * a).into(),
            impulse: self.impulse,
            stored: self.stored(),
            work: self.work,
            motor_work: self.motor_work,
            heat: self.heat,
        }
    }
}
