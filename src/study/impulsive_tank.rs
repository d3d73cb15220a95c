//! Pressure in a rigid tank that is accelerated suddenly, before its liquid has moved.
//! The potential solution for a rectangle, with the liquid at the far wall or detached from it.
//!
//! A tank of length L with liquid to the depth h \[m\] is accelerated along x with a \[m/s²\], so
//! that the wall at x = 0 pushes. An incompressible liquid of density ρ \[kg/m³\] answers at once
//! with a pressure p \[Pa\], z being the height over the bottom, that follows
//!
//! ```text
//! ∂²p/∂x² + ∂²p/∂z² = 0      ∂p/∂x = −ρa at x = 0      ∂p/∂z = 0 at z = 0      p = 0 at z = h
//! ```
//!
//! and, at x = L, ∂p/∂x = −ρa where the liquid cannot leave the wall ([`FarWall::Attached`]) or p = 0
//! where it can ([`FarWall::Detached`]). With kₙ = (2n + 1)π/(2h), and Λ = L in the first case and 2L
//! in the second,
//!
//! ```text
//! p/(ρah) = Σₙ 2(−1)ⁿ/(kₙh)² [exp(−kₙx) − exp(−kₙ(Λ − x))]/[1 + exp(−kₙΛ)] cos(kₙz)     n = 0, 1, …
//! ```
//!
//! which is separation of variables with the cosines that vanish on the surface; on the wall the
//! quotient is tanh(kₙΛ/2). In a long tank the coefficient at the foot of the wall is 8G/π² = 0.7425,
//! G being Catalan's constant: the 0.743 of H. M. Westergaard, *Transactions of the American Society
//! of Civil Engineers* 98 (1933) 418–433. Gravity adds ρg(h − z). The solution holds once sound has
//! crossed the tank a few times, and while the surface has moved little, at²/2 ≪ h.
//!
//! ```
//! use meshfree::study::impulsive_tank::{FarWall, ImpulsiveTank};
//! let tank = ImpulsiveTank::new(0.5, 0.18, FarWall::Attached)?;
//! assert!((tank.coefficient([0.0, 0.0])? - 0.7221).abs() < 5e-5);
//! assert!((tank.pressure([0.0, 0.05], 1000.0, 294.2)? - 36.26e3).abs() < 10.0);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::{StudyError, finite, positive, within};
use std::f64::consts::PI;

/// Terms of the series on the walls, where they fall off with 1/n² only.
const TERMS: u32 = 20_000;

/// Whether the liquid stays at the wall opposite to the pushing one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FarWall {
    /// The liquid stays at it, with a pressure below that of the surface.
    Attached,
    /// The liquid has left it; its face there is as free as its surface.
    Detached,
}

/// A rectangular tank that is set in motion at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpulsiveTank {
    length: f64,
    depth: f64,
    far_wall: FarWall,
}

impl ImpulsiveTank {
    /// A tank of `length` \[m\] along the acceleration with liquid to `depth` \[m\].
    ///
    /// # Errors
    /// If a value is not larger than zero.
    pub fn new(length: f64, depth: f64, far_wall: FarWall) -> Result<Self, StudyError> {
        Ok(Self {
            length: positive("length of the tank [m]", length)?,
            depth: positive("depth of the liquid [m]", depth)?,
            far_wall,
        })
    }
    /// Coefficient p/(ρah) at the place (x, z) \[m\]: x from the pushing wall, z from the bottom.
    ///
    /// On a wall it is exact to 10⁻⁹ h/(h − z), elsewhere to rounding.
    ///
    /// # Errors
    /// If the place is outside the liquid.
    pub fn coefficient(&self, [x, z]: [f64; 2]) -> Result<f64, StudyError> {
        within("distance x from the wall [m]", x, 0.0, self.length)?;
        within("height z over the bottom [m]", z, 0.0, self.depth)?;
        let span = match self.far_wall {
            FarWall::Attached => self.length,
            FarWall::Detached => 2.0 * self.length,
        };
        let mut sum = 0.0;
        for n in 0..TERMS {
            let kh = (f64::from(n) + 0.5) * PI;
            let k = kh / self.depth;
            let (near, far) = ((-k * x).exp(), (-k * (span - x)).exp());
            // (−1)ⁿ cos(kz) is sin(k(h − z)), which is exactly zero on the surface.
            let wave = (k * (self.depth - z)).sin();
            let weight = 2.0 / (kh * kh * (1.0 + (-k * span).exp()));
            sum += weight * (near - far) * wave;
            if weight * near.max(far) < 1e-18 {
                break;
            }
        }
        Ok(sum)
    }
    /// Pressure \[Pa\] at the place (x, z) \[m\] in a liquid of `density` \[kg/m³\] under
    /// `acceleration` \[m/s²\] of the tank. That of gravity comes on top.
    ///
    /// # Errors
    /// If the place is outside the liquid, the density is not larger than zero or the acceleration is
    /// not finite.
    pub fn pressure(
        &self,
        place: [f64; 2],
        density: f64,
        acceleration: f64,
    ) -> Result<f64, StudyError> {
        positive("density [kg/m³]", density)?;
        finite("acceleration of the tank [m/s²]", acceleration)?;
        Ok(self.coefficient(place)? * density * acceleration * self.depth)
    }
}

#[cfg(test)]
mod tests {
    use super::super::check::{curvature, reference, slope};
    use super::*;

    const LENGTH: f64 = 0.5;
    const DEPTH: f64 = 0.18;

    fn tank(far_wall: FarWall) -> ImpulsiveTank {
        ImpulsiveTank::new(LENGTH, DEPTH, far_wall).unwrap()
    }

    #[test]
    fn coefficients_on_the_pushing_wall() {
        for (far_wall, bottom, above) in [
            (FarWall::Attached, 0.7221, 0.6848),
            (FarWall::Detached, 0.742, 0.703),
        ] {
            let tank = tank(far_wall);
            let [c0, c1] = [0.0, 0.05].map(|z| tank.coefficient([0.0, z]).unwrap());
            let half_digit = if far_wall == FarWall::Attached {
                5e-5
            } else {
                5e-4
            };
            assert!((c0 - bottom).abs() < half_digit, "{c0}");
            assert!((c1 - above).abs() < half_digit, "{c1}");
        }
        // 8/π² of Catalan's constant for a long tank; none where the tank is short.
        let long = ImpulsiveTank::new(100.0, DEPTH, FarWall::Attached).unwrap();
        let westergaard = 8.0 * 0.915_965_594_177_219 / (PI * PI);
        assert!((long.coefficient([0.0, 0.0]).unwrap() - westergaard).abs() < 1e-9);
        // A liquid column of a narrow tank is pushed as a slab: half of ρaL at each wall, ρaL if it
        // left.
        for (far_wall, share) in [(FarWall::Attached, 0.5), (FarWall::Detached, 1.0)] {
            let narrow = ImpulsiveTank::new(0.01, 1.0, far_wall).unwrap();
            let c = narrow.coefficient([0.0, 0.2]).unwrap();
            assert!((c / (share * 0.01) - 1.0).abs() < 1e-6, "{c}");
        }
    }

    #[test]
    fn the_pressure_satisfies_its_equation_and_conditions() {
        let step = 1e-4;
        for far_wall in [FarWall::Attached, FarWall::Detached] {
            let tank = tank(far_wall);
            // p/(ρa), whose slope on a wall is −1.
            let p = |x, z| tank.coefficient([x, z]).unwrap() * DEPTH;
            for (x, z) in [(0.02, 0.03), (0.21, 0.11), (0.4, 0.16), (0.47, 0.05)] {
                let (xx, zz) = (
                    curvature(|x| p(x, z), x, step),
                    curvature(|z| p(x, z), z, step),
                );
                assert!(xx.abs() > 0.03, "no test there: {xx}");
                assert!((xx + zz).abs() < 1e-5, "{xx} {zz}");
            }
            // One-sided slopes of second order.
            let inwards = |p: &dyn Fn(f64) -> f64| {
                (-3.0 * p(0.0) + 4.0 * p(step) - p(2.0 * step)) / (2.0 * step)
            };
            for s in [0.0, 0.05, 0.1, 0.15] {
                assert!((inwards(&|d| p(d, s)) + 1.0).abs() < 1e-4);
                match far_wall {
                    FarWall::Attached => {
                        assert!((inwards(&|d| p(LENGTH - d, s)) - 1.0).abs() < 1e-4);
                        assert!((p(LENGTH, s) + p(0.0, s)).abs() < 1e-12);
                    }
                    FarWall::Detached => assert!(p(LENGTH, s).abs() < 1e-12),
                }
                let x = 0.01 + 3.0 * s;
                assert_eq!(p(x, DEPTH), 0.0);
                assert!(inwards(&|d| p(x, d)).abs() < 1e-6);
                assert!(slope(|z| p(x, z), 0.1, step) < 0.0 || x > 0.5 * LENGTH);
            }
        }
    }

    #[test]
    fn the_tabulated_wall_pressure() {
        let name = "sloshing_vesenjak/impulsive_wall_pressure.csv";
        let Some(table) = reference("the_tabulated_wall_pressure", name) else {
            return;
        };
        let tank = tank(FarWall::Attached);
        assert_eq!(table.rows.len(), 19);
        for row in &table.rows {
            let c = tank.coefficient([0.0, row[0]]).unwrap();
            assert!((c - row[1]).abs() < 6e-6, "{c} at {}", row[0]);
            let p = tank.pressure([0.0, row[0]], 1000.0, 1.0).unwrap();
            assert!((p / 1000.0 - row[2]).abs() < 2e-6, "{p} at {}", row[0]);
        }
    }

    #[test]
    fn places_outside_the_liquid_are_refused() {
        let tank = tank(FarWall::Detached);
        for place in [[-0.1, 0.0], [0.6, 0.0], [0.1, 0.2], [f64::NAN, 0.0]] {
            assert!(tank.coefficient(place).is_err(), "{place:?}");
        }
        assert!(tank.pressure([0.0, 0.0], 0.0, 1.0).is_err());
        assert!(tank.pressure([0.0, 0.0], 1.0, f64::NAN).is_err());
        assert!(ImpulsiveTank::new(0.0, 1.0, FarWall::Detached).is_err());
    }
}
