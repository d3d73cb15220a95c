//! A jet along a floor that strikes a step: angle and pressures of the steady flow without gravity.
//! Free streamlines by Kirchhoff's hodograph method.
//!
//! A jet of depth d \[m\] and speed U \[m/s\] runs along a floor against a step of height h \[m\], climbs it, and leaves its
//! edge at an angle α to the floor. The liquid is ideal and the pressure of its free surfaces zero, so that their
//! speed is U everywhere. The velocity over U, as u − iv, then fills a quarter of the unit disc: the floor is its real
//! axis, the step its imaginary one, the free surfaces its rim, the jet comes in at 1 and leaves at exp(−iα). Sources and
//! sinks at these points and their images give, with the speed t U up the step, the height z at which it is reached
//!
//! ```text
//! z(t) = (d/π) { 4 atan t + sin α ln[(t² + 2t sin α + 1)/(t² − 2t sin α + 1)]
//!                − 2 cos α [atan((t + sin α)/cos α) + atan((t − sin α)/cos α)] }      h = z(1)
//! ```
//!
//! and by Bernoulli's law the pressure p = ½ρU² (1 − t²) there. It is the half of a jet of width 2d on a plate of width
//! 2h: L. M. Milne-Thomson, *Theoretical Hydrodynamics*, 5th ed. (1968), chapter XI. Its integral over the step is the
//! momentum that the jet has lost, ρU²d (1 − cos α), to which the tests hold it.
//!
//! ```
//! use meshfree::study::jet_on_step::JetOnStep;
//! let jet = JetOnStep::new(0.105, 0.161)?;
//! assert!((jet.angle().to_degrees() - 66.8).abs() < 0.1);
//! assert!((jet.pressure_coefficient(0.141)? - 0.50).abs() < 0.01);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::{StudyError, positive, within};
use std::f64::consts::{FRAC_PI_2, PI};

/// A jet along a floor against a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JetOnStep {
    depth: f64,
    step: f64,
    angle: f64,
}

impl JetOnStep {
    /// A jet of `depth` \[m\] against a step of height `step` \[m\].
    ///
    /// # Errors
    /// If a value is not larger than zero.
    pub fn new(depth: f64, step: f64) -> Result<Self, StudyError> {
        let depth = positive("depth of the jet [m]", depth)?;
        let step = positive("height of the step [m]", step)?;
        let angle = bisect(0.0, FRAC_PI_2, |angle| height(depth, angle, 1.0) < step);
        Ok(Self { depth, step, angle })
    }

    /// The angle α \[rad\] to the floor at which the jet leaves.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.angle
    }

    /// Pressure over ½ρU² on the step at a height \[m\] above the floor.
    ///
    /// # Errors
    /// If the height is not on the step.
    pub fn pressure_coefficient(&self, z: f64) -> Result<f64, StudyError> {
        within("height above the floor [m]", z, 0.0, self.step)?;
        let speed = bisect(0.0, 1.0, |t| height(self.depth, self.angle, t) < z);
        Ok(1.0 - speed * speed)
    }
}

/// Where the step has the speed `t`, for a jet of that depth that leaves at that angle.
fn height(depth: f64, angle: f64, t: f64) -> f64 {
    let (sine, cosine) = angle.sin_cos();
    let [ahead, behind] = [1.0, -1.0].map(|sign| t * t + 2.0 * sign * t * sine + 1.0);
    let arcs = ((t + sine) / cosine).atan() + ((t - sine) / cosine).atan();
    depth / PI * (4.0 * t.atan() + sine * (ahead / behind).ln() - 2.0 * cosine * arcs)
}

/// Where a condition that holds at `low` and not at `high` ceases to hold.
fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_takes_the_momentum_that_the_jet_loses() {
        for (depth, step) in [(0.105, 0.161), (1.0, 0.2), (0.1, 1.0)] {
            let jet = JetOnStep::new(depth, step).unwrap();
            // The pressure ends with a vertical tangent: points crowd there, z = h (1 − s²).
            let n = 20_000;
            let sum: f64 = (0..n)
                .map(|k| (f64::from(k) + 0.5) / f64::from(n))
                .map(|s| {
                    let z = step * (1.0 - s * s);
                    jet.pressure_coefficient(z).unwrap() * 2.0 * step * s / f64::from(n)
                })
                .sum();
            let lost = 2.0 * depth * (1.0 - jet.angle().cos());
            assert!((sum / lost - 1.0).abs() < 1e-6, "{sum} and {lost}");
        }
    }

    #[test]
    fn the_foot_stagnates_and_the_edge_does_not_press() {
        let jet = JetOnStep::new(0.1, 0.15).unwrap();
        assert!((jet.pressure_coefficient(0.0).unwrap() - 1.0).abs() < 1e-12);
        assert!(jet.pressure_coefficient(0.15).unwrap().abs() < 1e-6);
        assert!(jet.pressure_coefficient(0.16).is_err());
        assert!(JetOnStep::new(0.0, 1.0).is_err() && JetOnStep::new(1.0, f64::NAN).is_err());
        // A step that is high turns it all the way up, one that is low hardly.
        assert!(JetOnStep::new(0.1, 2.0).unwrap().angle() > 1.5);
        assert!(JetOnStep::new(0.1, 0.001).unwrap().angle() < 0.2);
    }
}
