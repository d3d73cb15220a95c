//! A motion: a lift, which starts and stops smoothly.
//! Acceleration is zero at both ends, so nothing in it is struck.

use meshfree::boundary::{Motion, Pose};
use std::f64::consts::TAU;

/// Up along the last axis by a height in a time, at rest before and after: H (t/T − sin(2π t/T)/2π).
#[derive(Clone, Copy, Debug)]
pub struct Lift {
    /// H \[m\].
    pub height: f64,
    /// T \[s\].
    pub duration: f64,
}

impl<const D: usize> Motion<D> for Lift {
    fn name(&self) -> String {
        format!("lift by {} m in {} s", self.height, self.duration)
    }
    fn pose(&self, time: f64) -> Pose<D> {
        let part = (time / self.duration).clamp(0.0, 1.0);
        let (sin, cos) = (TAU * part).sin_cos();
        let rate = 1.0 / self.duration;
        let mut pose = Pose::rest();
        pose.shift[0][D - 1] = self.height * (part - sin / TAU);
        pose.shift[1][D - 1] = self.height * rate * (1.0 - cos);
        pose.shift[2][D - 1] = self.height * rate * rate * TAU * sin;
        pose
    }
}
