//! The exact solution of a chain of rods, as steps that leave the joints, and the questions to it.
//! Every answer is a look-up; none of them interpolates.

use super::RodSegment;
use crate::study::{ContactInterval, Joint, StudyError};

/// A value that jumps at known times.
#[derive(Clone, Debug)]
pub(super) struct Steps {
    pub initial: f64,
    pub times: Vec<f64>,
    pub values: Vec<f64>,
}

impl Steps {
    pub fn at(&self, time: f64) -> f64 {
        match self.times.partition_point(|&t| t <= time) {
            0 => self.initial,
            k => self.values[k - 1],
        }
    }
    pub fn last(&self) -> f64 {
        self.values.last().copied().unwrap_or(self.initial)
    }
}

/// State of a material point from a time on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Arrival {
    /// When the state begins \[s\].
    pub time: f64,
    /// Stress from then on \[Pa\], tension positive.
    pub stress: f64,
    /// Velocity from then on \[m/s\].
    pub velocity: f64,
}

/// State of a joint from a time on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct JointState {
    /// When the state begins \[s\].
    pub time: f64,
    /// Stress in the joint \[Pa\], tension positive; zero while open.
    pub stress: f64,
    /// Velocity of the material, or wall, on its left \[m/s\].
    pub left_velocity: f64,
    /// Velocity of the material, or wall, on its right \[m/s\].
    pub right_velocity: f64,
    /// Gap when the state begins \[m\].
    pub gap: f64,
    /// Whether the joint is closed. A free end counts as open.
    pub closed: bool,
}

/// A stretch of rod with one stress and one velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Piece {
    /// Left end in the undeformed chain \[m\].
    pub from: f64,
    /// Right end in the undeformed chain \[m\].
    pub to: f64,
    /// Segment to which it belongs.
    pub segment: usize,
    /// Stress \[Pa\], tension positive.
    pub stress: f64,
    /// Velocity \[m/s\].
    pub velocity: f64,
}

/// The exact solution of a chain of rods; see [`AcousticRods`](super::AcousticRods).
#[derive(Clone, Debug)]
pub struct AcousticSolution {
    pub(super) until: f64,
    pub(super) tolerance: f64,
    pub(super) starts: Vec<f64>,
    pub(super) segments: Vec<RodSegment>,
    pub(super) rightward: Vec<Steps>,
    pub(super) leftward: Vec<Steps>,
    pub(super) joints: Vec<Vec<JointState>>,
}

impl AcousticSolution {
    /// The time \[s\] until which the solution is known.
    #[must_use]
    pub fn until(&self) -> f64 {
        self.until
    }

    fn check_time(&self, t: f64) -> Result<(), StudyError> {
        if (0.0..=self.until).contains(&t) {
            return Ok(());
        }
        Err(StudyError::OutOfRange {
            quantity: "time [s]",
            value: t,
            from: 0.0,
            to: self.until,
        })
    }

    fn locate(&self, x0: f64) -> Result<(usize, f64), StudyError> {
        let last = self.segments.len();
        let (from, to) = (self.starts[0], self.starts[last]);
        let slack = 1e-12 * (to - from);
        if !(from - slack..=to + slack).contains(&x0) {
            return Err(StudyError::OutOfRange {
                quantity: "position in the undeformed chain [m]",
                value: x0,
                from,
                to,
            });
        }
        let k = self.starts[1..last].partition_point(|&start| start <= x0);
        let offset = (x0 - self.starts[k]).clamp(0.0, self.segments[k].length);
        Ok((k, offset))
    }

    fn state(&self, k: usize, offset: f64, t: f64) -> (f64, f64) {
        let segment = &self.segments[k];
        let (c, z) = (segment.sound_speed, segment.impedance());
        let right = self.rightward[k].at(t - offset / c + self.tolerance);
        let left = self.leftward[k].at(t - (segment.length - offset) / c + self.tolerance);
        (0.5 * (right + left), 0.5 * (left - right) / z)
    }

    /// Stress σ \[Pa\], tension positive, at material point `x0` \[m\] and time `t` \[s\].
    /// On a front it is the stress behind; on a joint it is that of the segment on the right.
    ///
    /// # Errors
    /// If the point is not in the chain or the time not in the solution.
    pub fn stress(&self, x0: f64, t: f64) -> Result<f64, StudyError> {
        self.check_time(t)?;
        let (k, offset) = self.locate(x0)?;
        Ok(self.state(k, offset, t).0)
    }

    /// Velocity v \[m/s\] at material point `x0` \[m\] and time `t` \[s\], as [`stress`](Self::stress).
    ///
    /// # Errors
    /// If the point is not in the chain or the time not in the solution.
    pub fn velocity(&self, x0: f64, t: f64) -> Result<f64, StudyError> {
        self.check_time(t)?;
        let (k, offset) = self.locate(x0)?;
        Ok(self.state(k, offset, t).1)
    }

    /// All states of material point `x0` \[m\], from time zero to the end, one for each arrival.
    ///
    /// # Errors
    /// If the point is not in the chain.
    pub fn history(&self, x0: f64) -> Result<Vec<Arrival>, StudyError> {
        let (k, offset) = self.locate(x0)?;
        let segment = &self.segments[k];
        let delay = offset / segment.sound_speed;
        let rest = (segment.length - offset) / segment.sound_speed;
        let mut times = vec![0.0];
        times.extend(self.rightward[k].times.iter().map(|t| t + delay));
        times.extend(self.leftward[k].times.iter().map(|t| t + rest));
        times.retain(|&t| t <= self.until);
        times.sort_by(f64::total_cmp);
        times.dedup_by(|later, earlier| *later - *earlier <= self.tolerance);
        Ok(times
            .into_iter()
            .map(|time| {
                let (stress, velocity) = self.state(k, offset, time);
                Arrival {
                    time,
                    stress,
                    velocity,
                }
            })
            .collect())
    }

    /// Displacement \[m\] of material point `x0` \[m\] at time `t` \[s\]: the integral of its velocity.
    ///
    /// # Errors
    /// If the point is not in the chain or the time not in the solution.
    pub fn displacement(&self, x0: f64, t: f64) -> Result<f64, StudyError> {
        self.check_time(t)?;
        let history = self.history(x0)?;
        let ends = history.iter().skip(1).map(|step| step.time);
        Ok(history
            .iter()
            .zip(ends.chain([self.until]))
            .map(|(step, end)| step.velocity * (end.min(t) - step.time).max(0.0))
            .sum())
    }

    /// The chain at time `t` \[s\] as an exact step function, from left to right.
    ///
    /// # Errors
    /// If the time is not in the solution.
    pub fn snapshot(&self, t: f64) -> Result<Vec<Piece>, StudyError> {
        self.check_time(t)?;
        let mut pieces: Vec<Piece> = Vec::new();
        for (k, segment) in self.segments.iter().enumerate() {
            let (length, c) = (segment.length, segment.sound_speed);
            let mut fronts = vec![0.0, length];
            fronts.extend(self.rightward[k].times.iter().map(|s| c * (t - s)));
            fronts.extend(self.leftward[k].times.iter().map(|s| length - c * (t - s)));
            fronts.retain(|front| (0.0..=length).contains(front));
            fronts.sort_by(f64::total_cmp);
            let width = c * self.tolerance;
            fronts.dedup_by(|right, left| *right - *left <= width && *right < length);
            for ends in fronts.windows(2) {
                let (stress, velocity) = self.state(k, 0.5 * (ends[0] + ends[1]), t);
                pieces.push(Piece {
                    from: self.starts[k] + ends[0],
                    to: self.starts[k] + ends[1],
                    segment: k,
                    stress,
                    velocity,
                });
            }
        }
        Ok(pieces)
    }

    /// All states of a joint, from time zero to the end.
    ///
    /// # Errors
    /// If there is no such joint.
    pub fn joint_history(&self, joint: Joint) -> Result<&[JointState], StudyError> {
        Ok(&self.joints[joint.number(self.segments.len())?])
    }

    /// The times during which a joint was closed. A contact that only just touches is closed.
    ///
    /// # Errors
    /// If there is no such joint.
    pub fn contact_intervals(&self, joint: Joint) -> Result<Vec<ContactInterval>, StudyError> {
        let mut intervals: Vec<ContactInterval> = Vec::new();
        let mut was_closed = false;
        for state in self.joint_history(joint)? {
            if state.closed && !was_closed {
                intervals.push(ContactInterval {
                    from: state.time,
                    until: None,
                });
            } else if was_closed
                && !state.closed
                && let Some(interval) = intervals.last_mut()
            {
                interval.until = Some(state.time);
            }
            was_closed = state.closed;
        }
        Ok(intervals)
    }

    /// Impulse ∫ −σ dt \[N·s/m²\] that a joint has passed on in compression until time `t` \[s\].
    ///
    /// # Errors
    /// If there is no such joint or the time is not in the solution.
    pub fn impulse(&self, joint: Joint, t: f64) -> Result<f64, StudyError> {
        self.check_time(t)?;
        let states = self.joint_history(joint)?;
        let ends = states.iter().skip(1).map(|state| state.time);
        Ok(states
            .iter()
            .zip(ends.chain([self.until]))
            .map(|(state, end)| -state.stress * (end.min(t) - state.time).max(0.0))
            .sum())
    }

    /// Momentum of the chain for each unit of cross-section \[kg·m/s/m²\] at time `t` \[s\].
    ///
    /// # Errors
    /// If the time is not in the solution.
    pub fn momentum(&self, t: f64) -> Result<f64, StudyError> {
        let pieces = self.snapshot(t)?;
        let of = |piece: &Piece| {
            self.segments[piece.segment].density * piece.velocity * (piece.to - piece.from)
        };
        Ok(pieces.iter().map(of).sum())
    }

    /// Kinetic and elastic energy ∫ ½ρ₀v² + σ²/(2ρ₀c₀²) dx \[J/m²\] at time `t` \[s\].
    ///
    /// # Errors
    /// If the time is not in the solution.
    pub fn energy(&self, t: f64) -> Result<f64, StudyError> {
        let pieces = self.snapshot(t)?;
        let of = |piece: &Piece| {
            let segment = &self.segments[piece.segment];
            let stiffness = segment.impedance() * segment.sound_speed;
            let density_of_energy =
                segment.density * piece.velocity.powi(2) + piece.stress.powi(2) / stiffness;
            0.5 * density_of_energy * (piece.to - piece.from)
        };
        Ok(pieces.iter().map(of).sum())
    }
}
