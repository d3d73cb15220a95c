//! Forces of joints in kicks: of springs, dampers and motors, and those with which joints hold; their work, and the step they allow.
//! What is left for impulses is in `joints`.

use super::joint_rows::Frame;
use super::joint_system::{Line, Mover, factored, matrix, solve, with};
use super::joints::{Jointing, finite_motor};
use super::rigid::Rigid;
use super::run_state::State;
use crate::coupling::{Joint, Motor};
use crate::error::Result;
use crate::scalar::Real;
use nalgebra::Vector3;

type V = Vector3<f64>;

/// Share of 1/(√(k/m) + c/m) that a step takes at most.
const STEP: f64 = 0.1;
/// What limits such a step, in reports.
pub(super) const LIMIT: &str = "springs and dampers of joints: 0.1/(sqrt(k/m) + c/m)";

impl<T: Real, const D: usize> State<T, D> {
    /// Adds what springs, dampers and motors do at `time` \[s\] to the forces of an evaluation.
    pub(super) fn add_forces_of_joints(&mut self, time: f64) -> Result<()> {
        if self.joints.is_empty() {
            return Ok(());
        }
        let bodies = self.joints.bodies();
        let movers = self.movers(&bodies);
        let frames: Vec<Frame> = movers.iter().map(|own| own.frame).collect();
        let motions: Vec<_> = movers.iter().map(Mover::motion).collect();
        let lines = self.joints.coordinates(&bodies, &frames);
        drop(movers);
        let mut forces = Vec::with_capacity(lines.len());
        for line in &lines {
            let own = &mut self.joints.all[line.joint];
            let value = own.unwound(line.row.value);
            own.driving = match &own.joint.motor {
                Motor::Force(force) => finite_motor(own.described(), force(time), time)?,
                _ => 0.0,
            };
            own.damping = -own.joint.damping * line.rate(&motions);
            own.acting = own.driving + own.damping - own.joint.stiffness * (value - own.rest);
            forces.push(own.acting);
        }
        let given = with(&lines, &forces, bodies.len());
        for (&[group, number], given) in bodies.iter().zip(given) {
            let (mut forces, particles, held) = self.groups[group].forces(true);
            held.rigid[number].push(particles, &mut forces, given);
        }
        Ok(())
    }

    /// Adds the forces with which joints hold against those at hand to them, so that kicks keep to what joints allow. What is left for
    /// the impulses of drifts is the curvature of ways.
    pub(super) fn hold_forces(&mut self, time: f64) {
        if self.joints.is_empty() {
            return;
        }
        let bodies = self.joints.bodies();
        let movers = self.movers(&bodies);
        let frames: Vec<Frame> = movers.iter().map(|own| own.frame).collect();
        let lines = self.joints.lines(&bodies, &frames, time);
        let factor = match factored(matrix([&lines, &lines], &movers, &frames)) {
            Ok(factor) => factor,
            Err(line) => return self.joints.fail(lines[line].joint, time),
        };
        let accelerations: Vec<_> = (movers.iter().zip(&bodies))
            .map(|(own, body)| own.motion_with(self.forces_on(own.rigid, body)))
            .collect();
        let missing = lines.iter().map(|line| -line.rate(&accelerations));
        let forces = solve(&factor, missing.collect());
        let given = with(&lines, &forces, bodies.len());
        let free: Vec<bool> = movers.iter().map(|own| !own.driven).collect();
        drop(movers);
        for own in &mut self.joints.all {
            own.holding.clear();
        }
        for (line, force) in lines.iter().zip(&forces) {
            self.joints.all[line.joint].holding.push(*force);
        }
        let given = bodies.iter().zip(given).zip(free).filter(|own| own.1);
        for ((&[group, number], given), _) in given {
            let (mut forces, particles, held) = self.groups[group].forces(true);
            held.rigid[number].push(particles, &mut forces, given);
        }
    }

    /// The force with the weight, and the moment, at hand on a body.
    fn forces_on(&self, rigid: &Rigid<D>, &[group, _]: &[usize; 2]) -> [V; 2] {
        let [force, moment] = rigid.forces(&self.groups[group]);
        [force + rigid.weight(&self.groups[group]), moment]
    }

    /// Lines with what acts along them at the last evaluation: what holds, and springs, dampers and motors.
    fn acting(&self, bodies: &[[usize; 2]], frames: &[Frame]) -> Vec<(Line, f64, bool)> {
        let mut all = Vec::new();
        let mut number = vec![0; self.joints.all.len()];
        for line in self.joints.lines(bodies, frames, self.evaluated) {
            let place = &mut number[line.joint];
            let force = self.joints.all[line.joint].holding.get(*place);
            *place += 1;
            all.push((line, force.copied().unwrap_or(0.0), true));
        }
        let own = self.joints.coordinates(bodies, frames).into_iter();
        all.extend(own.map(|line| {
            let force = self.joints.all[line.joint].acting;
            (line, force, false)
        }));
        all
    }

    /// Books what joints give in a kick over `dt` \[s\], with the velocities at its middle.
    pub(super) fn record_joints(&mut self, dt: f64) {
        if self.joints.is_empty() {
            return;
        }
        let bodies = self.joints.bodies();
        let movers = self.movers(&bodies);
        let frames: Vec<Frame> = movers.iter().map(|own| own.frame).collect();
        let acting = self.acting(&bodies, &frames);
        let motions: Vec<_> = (movers.iter().zip(&bodies))
            .map(|(own, body)| {
                let ([p, l], [force, moment]) = (own.momenta, self.forces_on(own.rigid, body));
                own.motion_with([p + 0.5 * dt * force, l + 0.5 * dt * moment])
            })
            .collect();
        let motions = self.as_clamped(&bodies, &movers, self.evaluated, motions);
        let driven: Vec<bool> = movers.iter().map(|own| own.driven).collect();
        drop(movers);
        for (line, force, holds) in &acting {
            let own = &mut self.joints.all[line.joint];
            let arm = line.ends[0].map_or(V::zeros(), |k| own.geometry.arm(&frames[k]));
            let way = dt * line.rate(&motions);
            let [n, a] = line.on(0).map(|one| dt * *force * one);
            own.work += force * way;
            if *holds {
                own.pending[0] += n;
                own.pending[1] += a - arm.cross(&n);
                if line.is_motor {
                    own.motor_work += force * way;
                }
            } else {
                own.motor_work += own.driving * way;
                own.heat -= own.damping * way;
            }
            for d in 0..D {
                own.impulse[d] += n[d];
            }
        }
        // What clamps hold against springs is in their forces; what joints hold is not.
        let (lines, forces): (Vec<Line>, Vec<f64>) = (acting.into_iter())
            .filter_map(|(line, force, holds)| holds.then_some((line, dt * force)))
            .unzip();
        let given = with(&lines, &forces, bodies.len());
        for (k, &[group, number]) in bodies.iter().enumerate().filter(|own| driven[own.0]) {
            let held = &mut self.groups[group].held;
            held.take(number, given[k], motions[k]);
        }
    }

    /// The force and moment \[N, N m\] of what holds on a body, in the forces of the last evaluation.
    pub(super) fn holding_on(&self, body: [usize; 2]) -> [V; 2] {
        let bodies = self.joints.bodies();
        let Some(place) = bodies.iter().position(|own| *own == body) else {
            return [V::zeros(); 2];
        };
        let movers = self.movers(&bodies);
        let frames: Vec<Frame> = movers.iter().map(|own| own.frame).collect();
        let (lines, forces): (Vec<Line>, Vec<f64>) = (self.acting(&bodies, &frames).into_iter())
            .filter_map(|(line, force, holds)| holds.then_some((line, force)))
            .unzip();
        if movers[place].driven {
            return [V::zeros(); 2];
        }
        with(&lines, &forces, bodies.len())[place]
    }

    /// The force \[N\] of the ground by joints in the forces of the last evaluation.
    pub(super) fn forces_of_ground(&self) -> [f64; D] {
        let bodies = self.joints.bodies();
        let frames: Vec<Frame> = (self.movers(&bodies).iter()).map(|own| own.frame).collect();
        let mut sum = [0.0; D];
        for (line, force, _) in self.acting(&bodies, &frames) {
            if line.ends[1].is_none() {
                let [n, _] = line.on(0);
                for d in 0..D {
                    sum[d] += force * n[d];
                }
            }
        }
        sum
    }

    /// The step \[s\] that springs and dampers allow, and a body of one.
    pub(super) fn step_of_joints(&self) -> Option<(f64, [usize; 2])> {
        let acts = |own: &Jointing<D>| own.joint.stiffness + own.joint.damping > 0.0;
        if !self.joints.all.iter().any(acts) {
            return None;
        }
        let bodies = self.joints.bodies();
        let movers = self.movers(&bodies);
        let frames: Vec<Frame> = movers.iter().map(|own| own.frame).collect();
        let lines = self.joints.coordinates(&bodies, &frames);
        let a = matrix([&lines, &lines], &movers, &frames);
        let joint = |k: usize| &self.joints.all[lines[k].joint];
        // No eigenvalue of a matrix is larger than the largest sum of a row.
        let most = |of: fn(&Joint<D>) -> f64| {
            let row = |k: usize| -> f64 {
                (0..lines.len())
                    .map(|l| a[(k, l)].abs() * of(&joint(l).joint))
                    .sum()
            };
            (0..lines.len()).map(row).fold(0.0, f64::max)
        };
        let rate = most(|own| own.stiffness).sqrt() + most(|own| own.damping);
        let body = (0..lines.len()).find(|&k| acts(joint(k)));
        let body = body.and_then(|k| joint(k).bodies.into_iter().flatten().next())?;
        (rate > 0.0).then(|| (STEP / rate, body))
    }
}
