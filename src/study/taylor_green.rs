//! Taylor–Green vortices: a periodic array of eddies that only viscosity slows.
//! An exact solution of the incompressible Navier–Stokes equations in two dimensions.
//!
//! With period L \[m\], speed U \[m/s\], density ρ \[kg/m³\], kinematic viscosity ν = UL/Re \[m²/s\]
//! and b = −8π²ν/L² = −8π²U/(Re L) \[1/s\],
//!
//! ```text
//! u = −U exp(b t) cos(2πx/L) sin(2πy/L)
//! v =  U exp(b t) sin(2πx/L) cos(2πy/L)
//! p = −(ρU²/4) exp(2b t) [cos(4πx/L) + cos(4πy/L)]
//! ```
//!
//! Convection is a gradient, and pressure balances it; what is left is diffusion. SPH shows in this
//! flow what it loses by disorder of particles. G. I. Taylor, A. E. Green, *Proceedings of the Royal
//! Society A* 158 (1937) 499–521; the decaying plane array is G. I. Taylor's, *Philosophical
//! Magazine* 46 (1923) 671–674.
//!
//! ```
//! use meshfree::study::taylor_green::TaylorGreen;
//! let vortices = TaylorGreen::new(100.0)?;
//! let [u, v] = vortices.velocity([0.0, 0.25], 0.0);
//! assert!((u + 1.0).abs() < 1e-15 && v.abs() < 1e-15);
//! assert!((vortices.greatest_speed(1.0) - 0.454).abs() < 1e-3);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::{StudyError, positive};
use std::f64::consts::PI;

/// A periodic array of decaying vortices, four in a square of side L.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaylorGreen {
    length: f64,
    speed: f64,
    density: f64,
    reynolds: f64,
}

impl TaylorGreen {
    /// L = 1 m, U = 1 m/s and ρ = 1 kg/m³, at the Reynolds number UL/ν; 100 is customary.
    ///
    /// # Errors
    /// If the Reynolds number is not larger than zero.
    pub fn new(reynolds: f64) -> Result<Self, StudyError> {
        Self::with(1.0, 1.0, 1.0, reynolds)
    }
    /// Values of your own: period L \[m\], speed U \[m/s\], density ρ \[kg/m³\], Reynolds number UL/ν.
    ///
    /// # Errors
    /// If a value is not larger than zero.
    pub fn with(length: f64, speed: f64, density: f64, reynolds: f64) -> Result<Self, StudyError> {
        Ok(Self {
            length: positive("the period of the vortices [m]", length)?,
            speed: positive("the speed of the vortices [m/s]", speed)?,
            density: positive("density [kg/m³]", density)?,
            reynolds: positive("the Reynolds number", reynolds)?,
        })
    }
    /// Kinematic viscosity ν = UL/Re \[m²/s\].
    #[must_use]
    pub fn kinematic_viscosity(&self) -> f64 {
        self.speed * self.length / self.reynolds
    }
    /// Rate −b = 8π²ν/L² \[1/s\] at which the speed decays; the kinetic energy decays at twice this.
    #[must_use]
    pub fn decay_rate(&self) -> f64 {
        8.0 * PI.powi(2) * self.speed / (self.reynolds * self.length)
    }
    /// Velocity (u, v) \[m/s\] at the place (x, y) \[m\] and time `t` \[s\].
    #[must_use]
    pub fn velocity(&self, [x, y]: [f64; 2], t: f64) -> [f64; 2] {
        let speed = self.greatest_speed(t);
        let (sin_x, cos_x) = (2.0 * PI * x / self.length).sin_cos();
        let (sin_y, cos_y) = (2.0 * PI * y / self.length).sin_cos();
        [-speed * cos_x * sin_y, speed * sin_x * cos_y]
    }
    /// Pressure \[Pa\], zero in the mean, at the place (x, y) \[m\] and time `t` \[s\].
    #[must_use]
    pub fn pressure(&self, [x, y]: [f64; 2], t: f64) -> f64 {
        let cosine = |s: f64| (4.0 * PI * s / self.length).cos();
        -0.25 * self.density * self.greatest_speed(t).powi(2) * (cosine(x) + cosine(y))
    }
    /// Largest speed U exp(b t) \[m/s\] at time `t` \[s\].
    #[must_use]
    pub fn greatest_speed(&self, t: f64) -> f64 {
        self.speed * (-self.decay_rate() * t).exp()
    }
    /// Kinetic energy ρU²L² exp(2b t)/4 \[J/m\] of one period, a square of side L, at time `t` \[s\].
    #[must_use]
    pub fn kinetic_energy(&self, t: f64) -> f64 {
        0.25 * self.density * (self.greatest_speed(t) * self.length).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::super::check::{curvature, slope};
    use super::*;

    #[test]
    fn the_vortices_satisfy_the_navier_stokes_equations() {
        let flow = TaylorGreen::with(2.0, 3.0, 5.0, 10.0).unwrap();
        let (dx, dt) = (1e-3, 1e-4);
        // Largest acceleration of convection.
        let scale = 3.0 * 3.0 * PI;
        for (place, t) in [([0.13, 0.41], 0.0), ([1.7, 0.9], 0.05), ([-0.3, 5.2], 0.2)] {
            let along = |axis: usize, s: f64| {
                let mut there = place;
                there[axis] = s;
                there
            };
            let gradient = |component: usize, axis: usize| {
                slope(
                    |s| flow.velocity(along(axis, s), t)[component],
                    place[axis],
                    dx,
                )
            };
            let [u, v] = flow.velocity(place, t);
            assert!((gradient(0, 0) + gradient(1, 1)).abs() < 1e-9 * scale);
            for i in 0..2 {
                let rate = slope(|t| flow.velocity(place, t)[i], t, dt);
                let convection = u * gradient(i, 0) + v * gradient(i, 1);
                let push = slope(|s| flow.pressure(along(i, s), t), place[i], dx) / 5.0;
                let spread: f64 = (0..2)
                    .map(|axis| curvature(|s| flow.velocity(along(axis, s), t)[i], place[axis], dx))
                    .sum();
                let friction = flow.kinematic_viscosity() * spread;
                let residual = rate + convection + push - friction;
                assert!(residual.abs() < 1e-4 * scale, "{residual} at {place:?}");
                assert!(
                    friction.abs() > 1e-2 * scale,
                    "no test of viscosity there: {friction}"
                );
            }
        }
    }

    #[test]
    fn the_energy_is_that_of_the_velocities() {
        let flow = TaylorGreen::with(2.0, 3.0, 5.0, 100.0).unwrap();
        let (n, t) = (64, 0.3);
        let dx = 2.0 / f64::from(n);
        let (mut energy, mut fastest) = (0.0, 0.0f64);
        for i in 0..n {
            for j in 0..n {
                let [u, v] = flow.velocity([f64::from(i) * dx, f64::from(j) * dx], t);
                energy += 0.5 * 5.0 * (u * u + v * v) * dx * dx;
                fastest = fastest.max(u.hypot(v));
            }
        }
        assert!((energy / flow.kinetic_energy(t) - 1.0).abs() < 1e-12);
        assert!((fastest / flow.greatest_speed(t) - 1.0).abs() < 1e-12);
        // At Re = 100 and L = U = 1 the speed halves every ln 2 Re/(8π²) = 0.8779 s.
        let half = TaylorGreen::new(100.0).unwrap().greatest_speed(0.8779);
        assert!((half - 0.5).abs() < 1e-4, "{half}");
        assert!(TaylorGreen::new(0.0).is_err());
        assert!(TaylorGreen::with(1.0, f64::NAN, 1.0, 1.0).is_err());
    }
}
