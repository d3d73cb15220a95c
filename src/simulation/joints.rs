//! Joints at work: impulses that hold them through drifts and after kicks, and the forces of springs, dampers and motors.
//! RATTLE (Andersen 1983, J. Comput. Phys. 52, 24) for rigid bodies; `joint_rows` has the kinematics.

use super::Simulation;
use super::joint_rows::{Frame, Geometry};
use super::joint_system::{Line, Mover, drift_impulses, factored, matrix, solve, with};
use super::run_state::State;
use crate::coupling::{Joint, Kind, Motor};
use crate::error::{BuildError, Error, Problem, Result};
use crate::scalar::Real;
use nalgebra::Vector3;
use std::sync::Arc;

type V = Vector3<f64>;

/// What motors must give.
const NUMBER: &str = "it must be finite";

/// A joint and how it stands.
#[derive(Clone, Debug)]
pub(crate) struct Jointing<const D: usize> {
    pub joint: Arc<Joint<D>>,
    /// Its number in the scene.
    pub number: usize,
    /// Its two bodies, by group and number of the rigid body there; the ground is none.
    pub bodies: [Option<[usize; 2]>; 2],
    pub names: [Option<String>; 2],
    pub geometry: Geometry,
    /// q, where the spring is at rest, and where a motor of given speed has brought it.
    pub value: f64,
    pub rest: f64,
    pub target: f64,
    /// The force along q at the last evaluation, and the share of it that is the motor's and the damper's.
    pub acting: f64,
    pub driving: f64,
    pub damping: f64,
    /// The multipliers of what it holds, which are in the forces of the last evaluation.
    pub holding: Vec<f64>,
    /// Impulse and its moment about the place of the joint on the first body, by constraints in this step, and the force and moment by
    /// those of the last step.
    pub pending: [V; 2],
    pub held: [V; 2],
    /// Momentum \[kg m/s\] given to the first body, work \[J\] on both, work of the motor, and heat, since the start.
    pub impulse: [f64; D],
    pub work: f64,
    pub motor_work: f64,
    pub heat: f64,
}

impl<const D: usize> Jointing<D> {
    /// Energy in its spring \[J\].
    pub fn stored(&self) -> f64 {
        let stretch = self.value - self.rest;
        0.5 * self.joint.stiffness * stretch * stretch
    }

    /// Brings an angle to the turn that it is in.
    pub(super) fn unwound(&self, angle: f64) -> f64 {
        match self.joint.kind {
            Kind::Hinge { .. } => self.value + wrapped(angle - self.value),
            _ => angle,
        }
    }

    /// The joint in words.
    pub fn described(&self) -> String {
        let name = |side: usize| match &self.names[side] {
            Some(name) => format!("`{name}`"),
            None => "the ground".into(),
        };
        format!("{} of {} and {}", self.joint.name(), name(0), name(1))
    }
}

/// An angle less whole turns, between −π and π.
fn wrapped(angle: f64) -> f64 {
    use core::f64::consts::{PI, TAU};
    angle - TAU * ((angle + PI) / TAU).floor()
}

/// All joints, in the order in which they are solved.
#[derive(Clone, Debug, Default)]
pub(crate) struct Joints<const D: usize> {
    pub all: Vec<Jointing<D>>,
    /// What could not be held since the last look.
    fault: Option<Fault>,
}

/// A joint that could not be held.
#[derive(Clone, Debug)]
struct Fault {
    joint: String,
    time: f64,
    cause: &'static str,
}

/// Frames of the two bodies of a joint among those of all movers.
fn ends<'a>(frames: &'a [Frame], ground: &'a Frame, ends: [Option<usize>; 2]) -> [&'a Frame; 2] {
    ends.map(|end| end.map_or(ground, |k| &frames[k]))
}

impl<const D: usize> Joints<D> {
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Momentum \[kg m/s\] that the ground has given since the start.
    pub fn given_by_ground(&self) -> [f64; D] {
        let grounded = self.all.iter().filter(|own| own.bodies[1].is_none());
        grounded.fold([0.0; D], |sum, own| {
            core::array::from_fn(|d| sum[d] + own.impulse[d])
        })
    }

    /// What joints have worked on bodies since the start \[J\].
    pub fn work(&self) -> f64 {
        self.all.iter().map(|own| own.work).sum()
    }

    /// Notes that a joint cannot be held at `time` \[s\].
    pub(super) fn fail(&mut self, joint: usize, time: f64) {
        let joint = self.all[joint].described();
        self.fault.get_or_insert(Fault {
            joint,
            time,
            cause: SINGULAR,
        });
    }

    /// Its rigid bodies, by group and number there, each once.
    pub(super) fn bodies(&self) -> Vec<[usize; 2]> {
        let mut all: Vec<[usize; 2]> = Vec::new();
        for body in self.all.iter().flat_map(|own| own.bodies).flatten() {
            if !all.contains(&body) {
                all.push(body);
            }
        }
        all
    }

    /// Which of some bodies the two of a joint are.
    fn ends_of(own: &Jointing<D>, bodies: &[[usize; 2]]) -> [Option<usize>; 2] {
        own.bodies
            .map(|body| body.and_then(|body| bodies.iter().position(|other| *other == body)))
    }

    /// What holds at `time` \[s\] where the movers are in `frames`: constraints, and motors of given speed.
    pub(super) fn lines(&self, bodies: &[[usize; 2]], frames: &[Frame], time: f64) -> Vec<Line> {
        let ground = Frame::ground();
        let mut all = Vec::new();
        for (joint, own) in self.all.iter().enumerate() {
            let of = Self::ends_of(own, bodies);
            let frames = ends(frames, &ground, of);
            let rows = own.geometry.constraints(&own.joint.kind, frames);
            let line = |row, drive, is_motor| Line {
                row,
                joint,
                ends: of,
                drive,
                is_motor,
            };
            all.extend(rows.into_iter().map(|row| line(row, 0.0, false)));
            if let Motor::Speed(speed) = &own.joint.motor
                && let Some(mut row) = own.geometry.coordinate(&own.joint.kind, frames)
            {
                row.value -= own.target;
                if let Kind::Hinge { .. } = own.joint.kind {
                    row.value = wrapped(row.value);
                }
                all.push(line(row, speed(time), true));
            }
        }
        all
    }

    /// The coordinates of joints that have a spring, a damper or a motor.
    pub(super) fn coordinates(&self, bodies: &[[usize; 2]], frames: &[Frame]) -> Vec<Line> {
        let ground = Frame::ground();
        let all = self.all.iter().enumerate().filter_map(|(joint, own)| {
            let of = Self::ends_of(own, bodies);
            let row = (own.geometry).coordinate(&own.joint.kind, ends(frames, &ground, of))?;
            Some(Line {
                row,
                joint,
                ends: of,
                drive: 0.0,
                is_motor: false,
            })
        });
        all.collect()
    }
}

impl<T: Real, const D: usize> State<T, D> {
    pub(super) fn movers(&self, bodies: &[[usize; 2]]) -> Vec<Mover<'_, D>> {
        let of = |&[group, number]: &[usize; 2]| {
            let group = &self.groups[group];
            let rigid = &group.held.rigid[number];
            Mover {
                rigid,
                frame: rigid.frame(),
                momenta: rigid.momenta(&group.particles),
                driven: group.held.driver(rigid.body).is_some(),
                moves: if group.drifts_at_once() { 1 } else { 2 },
            }
        };
        bodies.iter().map(of).collect()
    }

    /// The same motions with those that clamps prescribe at `time` \[s\]. Work is booked with them: between kicks a clamped body has
    /// the velocity of another time than that of its place, and what that makes of the work of a constraint does not cancel.
    pub(super) fn as_clamped(
        &self,
        bodies: &[[usize; 2]],
        movers: &[Mover<'_, D>],
        time: f64,
        mut motions: Vec<[V; 2]>,
    ) -> Vec<[V; 2]> {
        for ((&[group, number], mover), motion) in bodies.iter().zip(movers).zip(&mut motions) {
            let group = &self.groups[group];
            let momenta = group.held.driven_momenta(number, &group.particles, time);
            if let Some(momenta) = momenta {
                *motion = mover.motion_with(momenta);
            }
        }
        motions
    }

    /// Gives bodies the impulses of some lines where they are at `time` \[s\], and joints and clamps what these did, if it counts.
    fn give(
        &mut self,
        bodies: &[[usize; 2]],
        lines: &[Line],
        impulses: &[f64],
        (time, counts): (f64, bool),
    ) {
        let movers = self.movers(bodies);
        let given = with(lines, impulses, movers.len());
        let before = movers.iter().map(Mover::motion).collect();
        let before = self.as_clamped(bodies, &movers, time, before);
        let momenta: Vec<_> = movers
            .iter()
            .zip(&given)
            .map(|(own, given)| own.pushed(*given))
            .collect();
        let after = movers.iter().zip(&momenta);
        let after = after.map(|(own, momenta)| own.motion_with(*momenta));
        let after = self.as_clamped(bodies, &movers, time, after.collect());
        let driven: Vec<bool> = movers.iter().map(|own| own.driven).collect();
        let arms: Vec<V> = lines
            .iter()
            .map(|line| {
                let own = &self.joints.all[line.joint];
                line.ends[0].map_or(V::zeros(), |k| own.geometry.arm(&movers[k].frame))
            })
            .collect();
        for (k, &[group, number]) in bodies.iter().enumerate() {
            let group = &mut self.groups[group];
            let rigid = &group.held.rigid[number];
            if !driven[k] {
                rigid.place(&mut group.particles, momenta[k]);
            } else if counts {
                group.held.take(number, given[k], after[k]);
            }
        }
        if !counts {
            return;
        }
        for ((line, &impulse), arm) in lines.iter().zip(impulses).zip(arms) {
            let work = 0.5 * impulse * (line.rate(&before) + line.rate(&after));
            let own = &mut self.joints.all[line.joint];
            let [n, a] = line.on(0).map(|one| impulse * one);
            own.pending[0] += n;
            own.pending[1] += a - arm.cross(&n);
            for d in 0..D {
                own.impulse[d] += n[d];
            }
            own.work += work;
            if line.is_motor {
                own.motor_work += work;
            }
        }
    }

    /// Gives the impulses with which joints hold at the end of a drift over `dt` \[s\] from `begin` \[s\].
    pub(super) fn hold_drift(&mut self, begin: f64, dt: f64) -> Result<()> {
        if self.joints.is_empty() {
            return Ok(());
        }
        self.check_joints()?;
        for own in &mut self.joints.all {
            if let Motor::Speed(speed) = &own.joint.motor {
                own.target += dt * finite_motor(own.described(), speed(begin + 0.5 * dt), begin)?;
            }
        }
        let bodies = self.joints.bodies();
        let movers = self.movers(&bodies);
        let now: Vec<Frame> = movers.iter().map(|own| own.frame).collect();
        let lines = self.joints.lines(&bodies, &now, begin);
        let at = |frames: &[Frame]| self.joints.lines(&bodies, frames, begin);
        let (impulses, then) =
            drift_impulses(&movers, &lines, at, dt).map_err(|(line, cause)| {
                let joint = self.joints.all[lines[line].joint].described();
                Error::Joint {
                    joint,
                    time: begin,
                    cause,
                }
            })?;
        let values = self.joints.coordinates(&bodies, &then);
        self.give(&bodies, &lines, &impulses, (begin, true));
        for line in values {
            let own = &mut self.joints.all[line.joint];
            own.value = own.unwound(line.row.value);
        }
        Ok(())
    }

    /// Gives bodies velocities that joints allow at `time` \[s\]; what that takes is booked if it `counts`.
    pub(super) fn hold_motions(&mut self, time: f64, counts: bool) {
        if self.joints.is_empty() {
            return;
        }
        let bodies = self.joints.bodies();
        let movers = self.movers(&bodies);
        let frames: Vec<Frame> = movers.iter().map(|own| own.frame).collect();
        let lines = self.joints.lines(&bodies, &frames, time);
        let a = matrix([&lines, &lines], &movers, &frames);
        let factor = match factored(a) {
            Ok(factor) => factor,
            Err(line) => return self.joints.fail(lines[line].joint, time),
        };
        let motions: Vec<_> = movers.iter().map(Mover::motion).collect();
        let missing = lines.iter().map(|line| line.drive - line.rate(&motions));
        let impulses = solve(&factor, missing.collect());
        self.give(&bodies, &lines, &impulses, (time, counts));
    }

    /// Refuses to go on where joints could not be held.
    pub(super) fn check_joints(&mut self) -> Result<()> {
        match self.joints.fault.take() {
            None => Ok(()),
            Some(Fault { joint, time, cause }) => Err(Error::Joint { joint, time, cause }),
        }
    }

    /// Of each joint that has a coordinate, what a unit along it does to the first body, as a force and a moment about its place, and how fast it changes.
    pub(super) fn lines_of_joints(&self) -> Vec<Option<([V; 2], f64)>> {
        let bodies = self.joints.bodies();
        let movers = self.movers(&bodies);
        let frames: Vec<Frame> = movers.iter().map(|own| own.frame).collect();
        let motions: Vec<_> = movers.iter().map(Mover::motion).collect();
        let mut all = vec![None; self.joints.all.len()];
        for line in self.joints.coordinates(&bodies, &frames) {
            let own = &self.joints.all[line.joint];
            let arm = line.ends[0].map_or(V::zeros(), |k| own.geometry.arm(&frames[k]));
            let [n, a] = line.on(0);
            all[line.joint] = Some(([n, a - arm.cross(&n)], line.rate(&motions)));
        }
        all
    }

    /// Begins to collect what joints take in a step, or ends it after `dt` \[s\].
    pub(super) fn turn_joints(&mut self, ended: Option<f64>) {
        for own in &mut self.joints.all {
            let pending = core::mem::take(&mut own.pending);
            if let Some(dt) = ended {
                own.held = pending.map(|impulse| impulse / dt);
            }
        }
    }
}

/// A number that a motor gives, refused if it is none.
pub(super) fn finite_motor(joint: String, value: f64, time: f64) -> Result<f64> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(Error::Function {
        what: format!("motor of the joint {joint}"),
        value,
        time,
        must_be: NUMBER,
    })
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// The same with joints of rigid bodies as built.
    ///
    /// # Errors
    /// [`Error::Build`] if one holds what those before it hold, or nothing that can move.
    pub(crate) fn with_joints(mut self, joints: Vec<Jointing<D>>) -> Result<Self> {
        self.state.joints = Joints {
            all: joints,
            fault: None,
        };
        let state = &self.state;
        let bodies = state.joints.bodies();
        let movers = state.movers(&bodies);
        let frames: Vec<Frame> = movers.iter().map(|own| own.frame).collect();
        let lines = state.joints.lines(&bodies, &frames, 0.0);
        match factored(matrix([&lines, &lines], &movers, &frames)) {
            Ok(_) => {
                drop(movers);
                Ok(self)
            }
            Err(line) => {
                let what = format!(
                    "the joint {} holds, with the {} constraints of joints before it, a motion twice or one that no body has",
                    state.joints.all[lines[line].joint].described(),
                    line
                );
                let remedy = "leave it out, or take one that holds less: a ball or a distance for a second hinge on one axis, and \
                              nothing between bodies that are clamped";
                let problems = vec![Problem::Incompatible { what, remedy }];
                Err(Error::Build(BuildError { problems }))
            }
        }
    }
}

/// Why joints cannot be held where constraints have come to depend on each other.
const SINGULAR: &str =
    "its constraints depend on those of others there, as in a linkage that is stretched straight";
