//! The plateau of an impact by matching shock Hugoniots of condensed materials.
//! Each material has a linear relation between shock and particle velocity.
//!
//! Behind a shock that raises the particle velocity of a material at rest and at zero pressure by u,
//!
#![doc = include_str!("../../docs/equations/shock_match.html")]
//!
//! with the Rankine–Hugoniot conditions from M. A. Meyers, *Dynamic Behavior of Materials*, 1994,
//! Section 4.3 and impedance matching from his Section 7.2. The contact velocity u* is the root of a
//! quadratic.
//!
//! ```
//! use meshfree::study::hugoniot::{Hugoniot, impact};
//! let copper = Hugoniot { density: 8930.0, sound_speed: 3940.0, slope: 1.49 };
//! let pmma = Hugoniot { density: 1190.0, sound_speed: 2600.0, slope: 1.52 };
//! let plateau = impact(&copper, 20.0, &pmma, 0.0)?;
//! assert!((plateau.pressure - 57.442e6).abs() < 1e3);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::{StudyError, finite, positive};

/// Shock Hugoniot U_s = C₀ + S u of a condensed material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hugoniot {
    /// Density ρ₀ at zero pressure \[kg/m³\].
    pub density: f64,
    /// Sound speed C₀ \[m/s\].
    pub sound_speed: f64,
    /// Slope S ≥ 0.
    pub slope: f64,
}

/// Pressure and velocity between the two shocks of an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Plateau {
    /// Pressure p* \[Pa\].
    pub pressure: f64,
    /// Velocity u* of the contact \[m/s\].
    pub velocity: f64,
}

impl Hugoniot {
    /// Pressure p = ρ₀(C₀ + S u)u \[Pa\] behind a shock with velocity jump `u` \[m/s\].
    #[must_use]
    pub fn pressure(&self, u: f64) -> f64 {
        self.density * self.shock_speed(u) * u
    }
    /// Shock speed C₀ + S u \[m/s\] into the material at rest.
    #[must_use]
    pub fn shock_speed(&self, u: f64) -> f64 {
        self.sound_speed + self.slope * u
    }
    /// Density ρ₀U_s/(U_s − u) \[kg/m³\] behind a shock with velocity jump `u` \[m/s\].
    #[must_use]
    pub fn density_behind(&self, u: f64) -> f64 {
        let speed = self.shock_speed(u);
        self.density * speed / (speed - u)
    }
    fn check(&self) -> Result<(), StudyError> {
        positive("density [kg/m³]", self.density)?;
        positive("sound speed [m/s]", self.sound_speed)?;
        if self.slope.is_finite() && self.slope >= 0.0 {
            return Ok(());
        }
        Err(StudyError::Parameter {
            quantity: "the slope of the Hugoniot",
            value: self.slope,
            requirement: "0 or more",
        })
    }
}

/// Plateau between two bodies that meet with velocities `left_velocity` ≥ `right_velocity` \[m/s\].
///
/// # Errors
/// If a parameter is out of range or the bodies do not approach each other.
pub fn impact(
    left: &Hugoniot,
    left_velocity: f64,
    right: &Hugoniot,
    right_velocity: f64,
) -> Result<Plateau, StudyError> {
    left.check()?;
    right.check()?;
    let approach = finite("approach velocity [m/s]", left_velocity - right_velocity)?;
    if approach < 0.0 {
        return Err(StudyError::Parameter {
            quantity: "approach velocity [m/s]",
            value: approach,
            requirement: "0 or more",
        });
    }
    // With y = u* − u_right:  q y² + l y = p_left(approach), in the form without cancellation.
    let (zl, zr) = (
        left.density * left.sound_speed,
        right.density * right.sound_speed,
    );
    let (sl, sr) = (left.density * left.slope, right.density * right.slope);
    let quadratic = sr - sl;
    let linear = zr + zl + 2.0 * sl * approach;
    let total = left.pressure(approach);
    let root = (linear * linear + 4.0 * quadratic * total).max(0.0).sqrt();
    let gained = 2.0 * total / (linear + root);
    Ok(Plateau {
        pressure: right.pressure(gained),
        velocity: right_velocity + gained,
    })
}

/// Plateau between a body with velocity `velocity` ≥ 0 \[m/s\] and a rigid wall at rest on its right.
///
/// # Errors
/// If a parameter is out of range or the body moves away from the wall.
pub fn wall_impact(body: &Hugoniot, velocity: f64) -> Result<Plateau, StudyError> {
    body.check()?;
    finite("velocity [m/s]", velocity)?;
    if velocity < 0.0 {
        return Err(StudyError::Parameter {
            quantity: "velocity [m/s]",
            value: velocity,
            requirement: "0 or more",
        });
    }
    Ok(Plateau {
        pressure: body.pressure(velocity),
        velocity: 0.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(density: f64, sound_speed: f64, slope: f64) -> Hugoniot {
        Hugoniot {
            density,
            sound_speed,
            slope,
        }
    }

    #[test]
    fn plateaus_of_the_rods() {
        let copper = material(8930.0, 3940.0, 1.49);
        let targets = [
            (copper, 353.173e6, 10.0),
            (material(7850.0, 3570.0, 1.92), 313.491e6, 11.1198),
            (material(2700.0, 5350.0, 1.34), 205.460e6, 14.1733),
            (material(1190.0, 2600.0, 1.52), 57.442e6, 18.3684),
        ];
        for (target, pressure, velocity) in targets {
            let plateau = impact(&copper, 20.0, &target, 0.0).unwrap();
            assert!((plateau.pressure - pressure).abs() < 1e3, "{plateau:?}");
            assert!((plateau.velocity - velocity).abs() < 1e-4, "{plateau:?}");
            let other = copper.pressure(20.0 - plateau.velocity);
            assert!((plateau.pressure / other - 1.0).abs() < 1e-12);
            let moving = impact(&target, 105.0, &copper, 85.0).unwrap();
            assert!((moving.pressure / plateau.pressure - 1.0).abs() < 1e-10);
        }
        let wall = wall_impact(&copper, 20.0).unwrap();
        assert!((wall.pressure - 709.006e6).abs() < 1e3);
        let compression = copper.density_behind(10.0) / 8930.0 - 1.0;
        assert!((compression - 0.002535).abs() < 1e-5);
        assert!(impact(&copper, 0.0, &copper, 1.0).is_err());
        assert!(wall_impact(&copper, -1.0).is_err());
        assert!(wall_impact(&material(1.0, 1.0, -1.0), 1.0).is_err());
    }
}
