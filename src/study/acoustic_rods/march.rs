//! The march from event to event: what a joint does when a wave arrives or a gap closes.
//! It fills an [`AcousticSolution`]; the equations are those of the parent module.

use super::solution::{AcousticSolution, JointState, Steps};
use super::{AcousticRods, Agenda, Event, STEP_LIMIT};
use crate::study::{Contact, End, StudyError};

/// What touches the material at one side of a joint.
#[derive(Clone, Copy)]
enum Side {
    /// A segment: its impedance, and the characteristic variable that arrives from it.
    Rod(f64, f64),
    /// A rigid wall at rest.
    Wall,
    /// Nothing.
    Void,
}

pub(super) struct March {
    pub(super) solution: AcousticSolution,
    bonds: Vec<Option<Contact>>,
    ends: [End; 2],
    agenda: Agenda,
    stress_tolerance: f64,
    gap_tolerance: f64,
    steps: usize,
}

impl March {
    pub(super) fn new(rods: &AcousticRods, until: f64) -> Self {
        let segments = rods.segments.clone();
        let mut starts = vec![rods.start];
        let mut x = rods.start;
        for segment in &segments {
            x += segment.length;
            starts.push(x);
        }
        let bond_of = |end: End| match end {
            End::Free => None,
            End::Wall => Some(Contact::Unilateral),
            End::Bonded => Some(Contact::Bonded),
        };
        let mut bonds = vec![bond_of(rods.ends[0])];
        bonds.extend(rods.contacts.iter().map(|&contact| Some(contact)));
        bonds.push(bond_of(rods.ends[1]));

        let shortest = segments
            .iter()
            .map(super::RodSegment::transit)
            .fold(f64::INFINITY, f64::min);
        let speed = segments
            .iter()
            .map(|s| s.velocity.abs())
            .fold(0.0, f64::max);
        let impedance = segments
            .iter()
            .map(super::RodSegment::impedance)
            .fold(0.0, f64::max);
        let tolerance = 1e-10 * shortest;
        let steps_from = |sign: f64| {
            let carried = segments.iter().map(|s| sign * s.impedance() * s.velocity);
            let empty = |initial| Steps {
                initial,
                times: Vec::new(),
                values: Vec::new(),
            };
            carried.map(empty).collect::<Vec<Steps>>()
        };
        let solution = AcousticSolution {
            until,
            tolerance,
            rightward: steps_from(-1.0),
            leftward: steps_from(1.0),
            joints: vec![Vec::new(); segments.len() + 1],
            starts,
            segments,
        };
        Self {
            solution,
            bonds,
            ends: rods.ends,
            agenda: Agenda::new(),
            stress_tolerance: 1e-12 * impedance * speed,
            gap_tolerance: 2.0 * speed * tolerance,
            steps: 0,
        }
    }

    pub(super) fn run(&mut self) -> Result<(), StudyError> {
        for joint in 0..self.solution.joints.len() {
            self.agenda.push(Event { time: 0.0, joint });
        }
        while let Some(event) = self.agenda.pop() {
            if event.time > self.solution.until {
                break;
            }
            self.act(event.joint, event.time);
            if self.steps > STEP_LIMIT {
                return Err(StudyError::TooManyEvents {
                    limit: STEP_LIMIT,
                    time: event.time,
                });
            }
        }
        Ok(())
    }

    fn sides(&self, joint: usize, time: f64) -> (Side, Side) {
        let solution = &self.solution;
        let count = solution.segments.len();
        let beyond = |end: End| match end {
            End::Free => Side::Void,
            End::Wall | End::Bonded => Side::Wall,
        };
        let heard = |steps: &Steps, k: usize| {
            steps.at(time - solution.segments[k].transit() + solution.tolerance)
        };
        let left = match joint.checked_sub(1) {
            Some(k) => Side::Rod(
                solution.segments[k].impedance(),
                heard(&solution.rightward[k], k),
            ),
            None => beyond(self.ends[0]),
        };
        let right = if joint < count {
            Side::Rod(
                solution.segments[joint].impedance(),
                heard(&solution.leftward[joint], joint),
            )
        } else {
            beyond(self.ends[1])
        };
        (left, right)
    }

    /// Brings a joint to its state at `time`, sends out what it emits and plans the closing of a gap.
    fn act(&mut self, joint: usize, time: f64) {
        let (left, right) = self.sides(joint, time);
        let before = self.solution.joints[joint].last().copied();
        let (was_closed, gap) = match before {
            None => (true, 0.0),
            Some(state) => {
                let rate = state.right_velocity - state.left_velocity;
                let grown = state.gap + rate * (time - state.time);
                (state.closed, if state.closed { 0.0 } else { grown })
            }
        };
        let free_left = match left {
            Side::Rod(z, r) => -r / z,
            Side::Wall | Side::Void => 0.0,
        };
        let free_right = match right {
            Side::Rod(z, l) => l / z,
            Side::Wall | Side::Void => 0.0,
        };
        let (stress, velocity) = match (left, right) {
            (Side::Rod(z1, r), Side::Rod(z2, l)) => {
                ((z2 * r + z1 * l) / (z1 + z2), (l - r) / (z1 + z2))
            }
            (Side::Rod(_, r), Side::Wall) => (r, 0.0),
            (Side::Wall, Side::Rod(_, l)) => (l, 0.0),
            _ => (0.0, 0.0),
        };
        let closed = match self.bonds[joint] {
            None => false,
            Some(Contact::Bonded) => true,
            Some(Contact::Unilateral) if was_closed => stress <= self.stress_tolerance,
            Some(Contact::Unilateral) => gap <= self.gap_tolerance && free_right < free_left,
        };
        let is_end = matches!(left, Side::Void) || matches!(right, Side::Void);
        let state = if closed {
            JointState {
                time,
                stress,
                left_velocity: velocity,
                right_velocity: velocity,
                gap: 0.0,
                closed,
            }
        } else {
            JointState {
                time,
                stress: 0.0,
                left_velocity: if is_end && joint == 0 {
                    free_right
                } else {
                    free_left
                },
                right_velocity: if is_end && joint > 0 {
                    free_left
                } else {
                    free_right
                },
                gap: if is_end { 0.0 } else { gap },
                closed,
            }
        };
        let unchanged = before.is_some_and(|old| {
            let same_velocity = |a: f64, b: f64, side: Side| match side {
                Side::Rod(z, _) => z * (a - b).abs() <= self.stress_tolerance,
                Side::Wall | Side::Void => true,
            };
            old.closed == state.closed
                && (old.stress - state.stress).abs() <= self.stress_tolerance
                && same_velocity(old.left_velocity, state.left_velocity, left)
                && same_velocity(old.right_velocity, state.right_velocity, right)
        });
        if unchanged {
            return;
        }
        if !closed && !is_end {
            let rate = state.right_velocity - state.left_velocity;
            if rate < 0.0 {
                let wait = (state.gap / -rate).max(0.0);
                self.agenda.push(Event {
                    time: time + wait,
                    joint,
                });
            }
        }
        self.emit(joint, &state, left, right);
        self.solution.joints[joint].push(state);
    }

    fn emit(&mut self, joint: usize, state: &JointState, left: Side, right: Side) {
        let tolerance = self.stress_tolerance;
        let solution = &mut self.solution;
        if let Side::Rod(z, _) = left {
            let value = state.stress + z * state.left_velocity;
            let steps = &mut solution.leftward[joint - 1];
            if (value - steps.last()).abs() > tolerance {
                steps.times.push(state.time);
                steps.values.push(value);
                self.steps += 1;
                self.agenda.push(Event {
                    time: state.time + solution.segments[joint - 1].transit(),
                    joint: joint - 1,
                });
            }
        }
        if let Side::Rod(z, _) = right {
            let value = state.stress - z * state.right_velocity;
            let steps = &mut solution.rightward[joint];
            if (value - steps.last()).abs() > tolerance {
                steps.times.push(state.time);
                steps.values.push(value);
                self.steps += 1;
                self.agenda.push(Event {
                    time: state.time + solution.segments[joint].transit(),
                    joint: joint + 1,
                });
            }
        }
    }
}
