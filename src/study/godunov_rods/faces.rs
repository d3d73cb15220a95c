//! Face states: two states meet, one meets a wall, one meets nothing; and the joints that choose.
//! The equations are those of the parent module.

use super::cells::Cells;
use crate::study::{Contact, End};

/// Gradient of a cell from those of its two faces.
#[inline(always)]
pub(super) fn monotonized_central(a: f64, b: f64) -> f64 {
    let steep = 2.0 * a.abs().min(b.abs());
    let size = steep.min(0.5 * (a + b).abs());
    if a * b > 0.0 { size.copysign(a) } else { 0.0 }
}

/// The smaller of the two gradients, 0 where they disagree in sign.
#[inline(always)]
pub(super) fn minmod(a: f64, b: f64) -> f64 {
    let size = a.abs().min(b.abs());
    if a * b > 0.0 { size.copysign(a) } else { 0.0 }
}

/// What a face sees of the cell beside it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trace {
    pub pressure: f64,
    pub velocity: f64,
    /// ρc.
    pub impedance: f64,
    /// ρA.
    pub stiffening: f64,
}

impl Trace {
    /// Shock impedance W for a velocity that changes by `compression` (negative in expansion).
    #[inline(always)]
    fn shock_impedance(&self, compression: f64) -> f64 {
        (self.impedance + self.stiffening * compression).max(0.25 * self.impedance)
    }
}

/// Pressure and velocity where two states meet.
#[inline(always)]
pub(super) fn meet(left: &Trace, right: &Trace) -> (f64, f64) {
    let (mut wl, mut wr) = (left.impedance, right.impedance);
    let mut velocity = 0.0;
    for _ in 0..3 {
        let push = left.pressure - right.pressure;
        velocity = (wl * left.velocity + wr * right.velocity + push) / (wl + wr);
        wl = left.shock_impedance(left.velocity - velocity);
        wr = right.shock_impedance(velocity - right.velocity);
    }
    let from_left = left.pressure + wl * (left.velocity - velocity);
    let from_right = right.pressure + wr * (velocity - right.velocity);
    (0.5 * (from_left + from_right), velocity)
}

/// Velocity gained outwards by a free surface (negative if it is pulled in).
fn free_gain(trace: &Trace) -> f64 {
    let mut gain = trace.pressure / trace.impedance;
    for _ in 0..4 {
        gain = trace.pressure / trace.shock_impedance(-gain);
    }
    gain
}

/// What happens in a face on average over a step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Face {
    pub pressure: f64,
    /// Pressure times velocity.
    pub power: f64,
    pub left_velocity: f64,
    pub right_velocity: f64,
}

/// A face between segments, or at an end of the chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointFace {
    /// The cell on the left, if any.
    pub left: Option<usize>,
    /// The cell on the right, if any.
    pub right: Option<usize>,
    /// `None` for a free end.
    bond: Option<Contact>,
    pub closed: bool,
    pub gap: f64,
}

impl JointFace {
    pub(super) fn new(left: Option<usize>, right: Option<usize>, bond: Option<Contact>) -> Self {
        Self {
            left,
            right,
            bond,
            closed: bond.is_some(),
            gap: 0.0,
        }
    }
    pub(super) fn bond_of(end: End) -> Option<Contact> {
        match end {
            End::Free => None,
            End::Wall => Some(Contact::Unilateral),
            End::Bonded => Some(Contact::Bonded),
        }
    }

    /// Gradients of (p, u) in mass across the joint, as the cell on the left and on the right see them.
    pub(super) fn gradients(&self, cells: &Cells) -> [(f64, f64); 2] {
        let half = |j: usize| 0.5 * cells.mass[j];
        if let (true, Some(l), Some(r)) = (self.closed, self.left, self.right) {
            let gp = (cells.pressure[r] - cells.pressure[l]) / (half(l) + half(r));
            let (zl, zr) = (cells.impedance[l].powi(2), cells.impedance[r].powi(2));
            let q = (cells.velocity[r] - cells.velocity[l]) / (half(l) / zl + half(r) / zr);
            return [(gp, q / zl), (gp, q / zr)];
        }
        // Mirror: at a wall p is even and u odd, at a free surface p is odd and u even.
        let one_sided = |cell: Option<usize>, sign: f64| match cell {
            None => (0.0, 0.0),
            Some(j) if self.closed => (0.0, sign * cells.velocity[j] / half(j)),
            Some(j) => (sign * cells.pressure[j] / half(j), 0.0),
        };
        [one_sided(self.left, -1.0), one_sided(self.right, 1.0)]
    }

    fn closed_face(&self, left: Option<Trace>, right: Option<Trace>) -> (f64, f64) {
        match (left, right) {
            (Some(left), Some(right)) => meet(&left, &right),
            (Some(left), None) => {
                let u = left.velocity;
                (left.pressure + left.shock_impedance(u) * u, 0.0)
            }
            (None, Some(right)) => {
                let u = -right.velocity;
                (right.pressure + right.shock_impedance(u) * u, 0.0)
            }
            (None, None) => (0.0, 0.0),
        }
    }

    /// Moves the joint through a step: opens it, or closes it part way.
    pub(super) fn act(
        &mut self,
        left: Option<Trace>,
        right: Option<Trace>,
        dt: f64,
        tolerance: f64,
    ) -> Face {
        let joined = |(pressure, velocity): (f64, f64)| Face {
            pressure,
            power: pressure * velocity,
            left_velocity: velocity,
            right_velocity: velocity,
        };
        let free_left = left.map_or(0.0, |trace| trace.velocity + free_gain(&trace));
        let free_right = right.map_or(0.0, |trace| trace.velocity - free_gain(&trace));
        let parted = Face {
            pressure: 0.0,
            power: 0.0,
            left_velocity: free_left,
            right_velocity: free_right,
        };
        match self.bond {
            None => return parted,
            Some(Contact::Bonded) => return joined(self.closed_face(left, right)),
            Some(Contact::Unilateral) => {}
        }
        let together = self.closed_face(left, right);
        if self.closed {
            if together.0 >= -tolerance {
                return joined(together);
            }
            self.closed = false;
            self.gap = 0.0;
        }
        let rate = free_right - free_left;
        let gap = self.gap + rate * dt;
        if gap > 0.0 {
            self.gap = gap;
            return parted;
        }
        // The gap is used up within the step: free for a part of it, joined for the rest.
        let open = if rate < 0.0 {
            (self.gap / (-rate * dt)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        self.closed = true;
        self.gap = 0.0;
        let face = joined(together);
        let mean = |free: f64, joined: f64| open * free + (1.0 - open) * joined;
        Face {
            pressure: (1.0 - open) * face.pressure,
            power: (1.0 - open) * face.power,
            left_velocity: mean(free_left, face.left_velocity),
            right_velocity: mean(free_right, face.right_velocity),
        }
    }
}
