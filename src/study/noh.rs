//! Noh's problem: cold gas runs onto a wall, an axis or a point and stops behind an outward shock.
//! Exact in one, two and three dimensions.
//!
//! With initial density ρ₀, inward speed V, vanishing pressure and ν = 1, 2, 3 dimensions
//!
#![doc = include_str!("../../docs/equations/noh.html")]
//!
//! W. F. Noh, *Journal of Computational Physics* 72 (1987) 78–120. Defaults are his: γ = 5/3, ρ₀ = 1,
//! V = 1, so that ρ behind is 4, 16 or 64.
//!
//! ```
//! use meshfree::study::noh::Noh;
//! let problem = Noh::new(3)?;
//! assert!((problem.state(0.1, 0.6)?.density - 64.0).abs() < 1e-12);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::riemann::GasState;
use super::{StudyError, positive};

/// Noh's problem in ν dimensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noh {
    dimension: u8,
    gamma: f64,
    density: f64,
    speed: f64,
}

impl Noh {
    /// The values of the 1987 paper in `dimension` = 1 (planar), 2 (cylindrical) or 3 (spherical).
    ///
    /// # Errors
    /// If the dimension is not 1, 2 or 3.
    pub fn new(dimension: u8) -> Result<Self, StudyError> {
        Self::with(dimension, 5.0 / 3.0, 1.0, 1.0)
    }
    /// Values of your own: γ > 1, density ρ₀ \[kg/m³\] and inward speed V \[m/s\].
    ///
    /// # Errors
    /// If the dimension is not 1, 2 or 3 or a value is out of range.
    pub fn with(dimension: u8, gamma: f64, density: f64, speed: f64) -> Result<Self, StudyError> {
        check_dimension(dimension)?;
        positive("γ − 1", gamma - 1.0)?;
        Ok(Self {
            dimension,
            gamma,
            density: positive("density [kg/m³]", density)?,
            speed: positive("inward speed [m/s]", speed)?,
        })
    }
    /// Radius of the shock \[m\] at time `t` \[s\].
    #[must_use]
    pub fn shock_radius(&self, t: f64) -> f64 {
        0.5 * (self.gamma - 1.0) * self.speed * t
    }
    /// Density \[kg/m³\] behind the shock.
    #[must_use]
    pub fn density_behind(&self) -> f64 {
        let ratio = (self.gamma + 1.0) / (self.gamma - 1.0);
        self.density * ratio.powi(i32::from(self.dimension))
    }
    /// State at radius `r` ≥ 0 \[m\] and time `t` ≥ 0 \[s\]; the velocity is positive outwards.
    ///
    /// # Errors
    /// If the radius or the time is negative.
    pub fn state(&self, r: f64, t: f64) -> Result<GasState, StudyError> {
        for (quantity, value) in [("radius [m]", r), ("time [s]", t)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(StudyError::Parameter {
                    quantity,
                    value,
                    requirement: "0 or more",
                });
            }
        }
        if r < self.shock_radius(t) {
            let density = self.density_behind();
            return Ok(GasState {
                density,
                velocity: 0.0,
                pressure: 0.5 * (self.gamma - 1.0) * self.speed.powi(2) * density,
            });
        }
        let gathered = if t > 0.0 {
            1.0 + self.speed * t / r
        } else {
            1.0
        };
        Ok(GasState {
            density: self.density * gathered.powi(i32::from(self.dimension) - 1),
            velocity: -self.speed,
            pressure: 0.0,
        })
    }
}

/// An error unless the dimension is 1, 2 or 3.
pub(super) fn check_dimension(dimension: u8) -> Result<(), StudyError> {
    if (1..=3).contains(&dimension) {
        return Ok(());
    }
    Err(StudyError::Parameter {
        quantity: "the dimension",
        value: f64::from(dimension),
        requirement: "1, 2 or 3",
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plateaus_and_conservation_of_mass() {
        for (dimension, behind) in [(1, 4.0), (2, 16.0), (3, 64.0)] {
            let problem = Noh::new(dimension).unwrap();
            let inside = problem.state(0.1, 0.6).unwrap();
            assert!((inside.density / behind - 1.0).abs() < 1e-12);
            assert!((inside.pressure * 3.0 / behind - 1.0).abs() < 1e-12);
            assert!((problem.shock_radius(0.6) - 0.2).abs() < 1e-15);
            // What lay within r = 1 + t at the start lies within r = 1 now.
            let (n, t, nu) = (100_000, 0.6, i32::from(dimension));
            let dr = 1.0 / f64::from(n);
            let mass: f64 = (0..n)
                .map(|k| (f64::from(k) + 0.5) * dr)
                .map(|r| problem.state(r, t).unwrap().density * r.powi(nu - 1) * dr)
                .sum();
            let before = (1.0 + t).powi(nu) / f64::from(nu);
            assert!((mass / before - 1.0).abs() < 1e-4, "{mass} {before}");
        }
        assert!(Noh::new(4).is_err());
        assert!(Noh::with(1, 1.0, 1.0, 1.0).is_err());
        assert!(Noh::new(1).unwrap().state(-1.0, 1.0).is_err());
    }
}
