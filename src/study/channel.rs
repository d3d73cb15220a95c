//! Flow between parallel plates: Couette and Poiseuille flow from rest, and a power-law liquid.
//! Exact, and with no convection, so that they test viscous forces and walls alone.
//!
//! The plates lie at y = 0 and y = L \[m\]; v is the velocity along them \[m/s\], ν the kinematic
//! viscosity \[m²/s\]. A liquid that is at rest at t = 0 follows ∂v/∂t = ν ∂²v/∂y² + F. In Couette
//! flow the plate at y = L moves with V from then on, and F = 0:
//!
//! ```text
//! v = V y/L + Σₙ (2V/(nπ)) (−1)ⁿ sin(nπy/L) exp(−ν n²π² t/L²)                         n = 1, 2, …
//! ```
//!
//! In Poiseuille flow both plates rest and a force per mass F \[m/s²\] drives the liquid:
//!
//! ```text
//! v = F y(L − y)/(2ν) − Σₙ (4FL²/(νπ³m³)) sin(mπy/L) exp(−ν m²π² t/L²)     m = 2n + 1, n = 0, 1, …
//! ```
//!
//! J. P. Morris, P. J. Fox, Y. Zhu, *Journal of Computational Physics* 136 (1997) 214–226, with L = 1
//! mm, ν = 10⁻⁶ m²/s, V = 12.5 µm/s and F = 10⁻⁴ m/s². A liquid with the shear stress K|v'|ⁿ⁻¹v'
//! \[Pa\], driven by a force per volume G \[N/m³\], runs steadily with
//!
//! ```text
//! v = n/(n + 1) (G/K)^(1/n) [(L/2)^(1 + 1/n) − |y − L/2|^(1 + 1/n)]
//! ```
//!
//! which is the balance of shear stress and force, G(L/2 − y) = K|v'|ⁿ⁻¹v', integrated from the
//! plates (R. B. Bird, R. C. Armstrong, O. Hassager, *Dynamics of Polymeric Liquids*, vol. 1, 2nd
//! ed., 1987, Chapter 4).
//!
//! ```
//! use meshfree::study::channel::Poiseuille;
//! let flow = Poiseuille::new(1e-3, 1e-4, 1e-6)?;
//! assert!((flow.steady(0.5e-3)? - 12.5e-6).abs() < 1e-12);
//! assert!((flow.velocity(0.5e-3, 0.1)? / 12.5e-6 - 0.615).abs() < 1e-3);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::{StudyError, finite, positive, within};
use std::f64::consts::PI;

/// Smallest time νt/L² that the series answer, beside zero: they need 2/√(νt/L²) terms.
const SHORTEST: f64 = 1e-12;

/// What plates and liquid of the two Newtonian flows have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Channel {
    width: f64,
    kinematic_viscosity: f64,
}

impl Channel {
    fn new(width: f64, kinematic_viscosity: f64) -> Result<Self, StudyError> {
        Ok(Self {
            width: positive("the distance of the plates [m]", width)?,
            kinematic_viscosity: positive("kinematic viscosity [m²/s]", kinematic_viscosity)?,
        })
    }
    /// νt/L².
    fn spread(&self, t: f64) -> Result<f64, StudyError> {
        let unit = self.width.powi(2) / self.kinematic_viscosity;
        if t != 0.0 {
            within(
                "time after the start [s]",
                t,
                SHORTEST * unit,
                f64::INFINITY,
            )?;
        }
        Ok(t / unit)
    }
}

/// y/L, or an error where there is no liquid.
fn place(y: f64, width: f64) -> Result<f64, StudyError> {
    within("distance y from the plate [m]", y, 0.0, width)?;
    Ok(y / width)
}

/// Σ c(m) sin(mπ y/L) exp(−m²π² νt/L²) over m = 1, 2, …, until the exponential is below rounding.
fn series(place: f64, spread: f64, coefficient: impl Fn(f64) -> f64) -> f64 {
    let terms = (2.1 / spread.sqrt()) as u32 + 1;
    (1..=terms)
        .map(|m| {
            let wave = f64::from(m) * PI;
            coefficient(f64::from(m)) * (wave * place).sin() * (-wave * wave * spread).exp()
        })
        .sum()
}

/// Liquid between a plate at rest and one that starts to move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Couette {
    channel: Channel,
    wall_speed: f64,
}

impl Couette {
    /// Plates `width` \[m\] apart, that at y = `width` moving with `wall_speed` \[m/s\], and a liquid
    /// of `kinematic_viscosity` \[m²/s\].
    ///
    /// # Errors
    /// If the width or the viscosity is not larger than zero, or the speed is not finite.
    pub fn new(width: f64, wall_speed: f64, kinematic_viscosity: f64) -> Result<Self, StudyError> {
        Ok(Self {
            channel: Channel::new(width, kinematic_viscosity)?,
            wall_speed: finite("speed of the plate [m/s]", wall_speed)?,
        })
    }
    /// Velocity Vy/L \[m/s\] at the distance `y` \[m\] after a long time.
    ///
    /// # Errors
    /// If `y` is outside the channel.
    pub fn steady(&self, y: f64) -> Result<f64, StudyError> {
        Ok(self.wall_speed * place(y, self.channel.width)?)
    }
    /// Velocity \[m/s\] at the distance `y` \[m\] and time `t` \[s\].
    ///
    /// # Errors
    /// If `y` is outside the channel, or `t` is negative or so small, below 10⁻¹² L²/ν but not 0, that
    /// the series would take millions of terms.
    pub fn velocity(&self, y: f64, t: f64) -> Result<f64, StudyError> {
        let (place, spread) = (place(y, self.channel.width)?, self.channel.spread(t)?);
        if t == 0.0 {
            return Ok(if place < 1.0 { 0.0 } else { self.wall_speed });
        }
        let sign = |m: f64| if m % 2.0 == 0.0 { 1.0 } else { -1.0 };
        let rest = series(place, spread, |m| 2.0 * sign(m) / (m * PI));
        Ok(self.wall_speed * (place + rest))
    }
}

/// Liquid between plates at rest that a force starts to drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Poiseuille {
    channel: Channel,
    acceleration: f64,
}

impl Poiseuille {
    /// Plates `width` \[m\] apart, a force per mass `acceleration` \[m/s²\], which may also be a
    /// pressure gradient −(dp/dx)/ρ, and a liquid of `kinematic_viscosity` \[m²/s\].
    ///
    /// # Errors
    /// If the width or the viscosity is not larger than zero, or the acceleration is not finite.
    pub fn new(
        width: f64,
        acceleration: f64,
        kinematic_viscosity: f64,
    ) -> Result<Self, StudyError> {
        Ok(Self {
            channel: Channel::new(width, kinematic_viscosity)?,
            acceleration: finite("acceleration of the liquid [m/s²]", acceleration)?,
        })
    }
    /// Velocity Fy(L − y)/(2ν) \[m/s\] at the distance `y` \[m\] after a long time.
    ///
    /// # Errors
    /// If `y` is outside the channel.
    pub fn steady(&self, y: f64) -> Result<f64, StudyError> {
        let place = place(y, self.channel.width)?;
        Ok(0.5 * self.unit() * place * (1.0 - place))
    }
    /// Velocity \[m/s\] at the distance `y` \[m\] and time `t` \[s\].
    ///
    /// # Errors
    /// As [`Couette::velocity`].
    pub fn velocity(&self, y: f64, t: f64) -> Result<f64, StudyError> {
        let (place, spread) = (place(y, self.channel.width)?, self.channel.spread(t)?);
        if t == 0.0 {
            return Ok(0.0);
        }
        let odd = |m: f64| {
            if m % 2.0 == 0.0 {
                0.0
            } else {
                4.0 / (m * PI).powi(3)
            }
        };
        Ok(self.steady(y)? - self.unit() * series(place, spread, odd))
    }
    /// FL²/ν \[m/s\].
    fn unit(&self) -> f64 {
        self.acceleration * self.channel.width.powi(2) / self.channel.kinematic_viscosity
    }
}

/// Steady flow of a power-law liquid between plates at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLawPoiseuille {
    width: f64,
    force: f64,
    consistency: f64,
    index: f64,
}

impl PowerLawPoiseuille {
    /// Plates `width` \[m\] apart, a force per volume `force` \[N/m³\], which may also be a pressure
    /// gradient −dp/dx, and a liquid of `consistency` K \[Pa sⁿ\] and flow `index` n: below 1 it
    /// thins with shear, at 1 it is Newtonian with viscosity K, above 1 it thickens.
    ///
    /// # Errors
    /// If a value is not larger than zero.
    pub fn new(width: f64, force: f64, consistency: f64, index: f64) -> Result<Self, StudyError> {
        Ok(Self {
            width: positive("the distance of the plates [m]", width)?,
            force: positive("force per volume [N/m³]", force)?,
            consistency: positive("consistency [Pa sⁿ]", consistency)?,
            index: positive("the flow index", index)?,
        })
    }
    /// Velocity \[m/s\] at the distance `y` \[m\].
    ///
    /// # Errors
    /// If `y` is outside the channel.
    pub fn velocity(&self, y: f64) -> Result<f64, StudyError> {
        let from_middle = (2.0 * place(y, self.width)? - 1.0).abs();
        Ok(self.greatest() * (1.0 - from_middle.powf(1.0 + 1.0 / self.index)))
    }
    /// Mean velocity over the width, (n + 1)/(2n + 1) of that in the middle \[m/s\].
    #[must_use]
    pub fn mean_velocity(&self) -> f64 {
        self.greatest() * (self.index + 1.0) / (2.0 * self.index + 1.0)
    }
    /// Velocity in the middle \[m/s\].
    fn greatest(&self) -> f64 {
        let half = 0.5 * self.width;
        let slope_at_wall = (self.force * half / self.consistency).powf(1.0 / self.index);
        self.index / (self.index + 1.0) * slope_at_wall * half
    }
}

#[cfg(test)]
mod tests {
    use super::super::check::{curvature, slope};
    use super::*;

    const WIDTH: f64 = 2.0;
    const VISCOSITY: f64 = 0.5;

    /// Residual of ∂v/∂t = ν ∂²v/∂y² + F.
    fn residual(velocity: impl Fn(f64, f64) -> f64, force: f64, y: f64, t: f64) -> f64 {
        let rate = slope(|t| velocity(y, t), t, 1e-4 * t);
        let spread = curvature(|y| velocity(y, t), y, 1e-3);
        rate - VISCOSITY * spread - force
    }

    #[test]
    fn couette_flow_satisfies_its_equation_and_conditions() {
        let flow = Couette::new(WIDTH, 3.0, VISCOSITY).unwrap();
        let velocity = |y, t| flow.velocity(y, t).unwrap();
        for t in [0.05, 0.3, 2.0] {
            for y in [0.2, 1.0, 1.7] {
                let left = residual(velocity, 0.0, y, t);
                assert!(left.abs() < 1e-4, "{left} at {y}, {t}");
            }
            assert!(velocity(0.0, t).abs() < 1e-12 && (velocity(WIDTH, t) - 3.0).abs() < 1e-12);
        }
        for y in [0.0, 0.5, 1.9] {
            assert_eq!(velocity(y, 0.0), 0.0);
            assert!(velocity(y, 1e-4).abs() < 1e-12);
            assert!((velocity(y, 100.0) - flow.steady(y).unwrap()).abs() < 1e-12);
        }
        // While the other plate is far, the plate drags as in Stokes's first problem: V/√(πνt).
        let t = 1e-4;
        let drag = (3.0 - velocity(WIDTH - 1e-6, t)) / 1e-6;
        assert!((drag * (PI * VISCOSITY * t).sqrt() / 3.0 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn poiseuille_flow_satisfies_its_equation_and_conditions() {
        let flow = Poiseuille::new(WIDTH, 4.0, VISCOSITY).unwrap();
        let velocity = |y, t| flow.velocity(y, t).unwrap();
        for t in [0.05, 0.3, 2.0] {
            for y in [0.2, 1.0, 1.7] {
                let left = residual(velocity, 4.0, y, t);
                assert!(left.abs() < 1e-4, "{left} at {y}, {t}");
            }
            assert!(velocity(0.0, t).abs() < 1e-12 && velocity(WIDTH, t).abs() < 1e-12);
        }
        for y in [0.0, 0.5, 1.0] {
            assert_eq!(velocity(y, 0.0), 0.0);
            assert!((velocity(y, 100.0) - flow.steady(y).unwrap()).abs() < 1e-12);
        }
        // The steady flow: 4·2²/(8·0.5) in the middle. At first nothing but the force acts there.
        assert!((flow.steady(1.0).unwrap() - 4.0).abs() < 1e-12);
        assert!((velocity(1.0, 1e-3) / 4e-3 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_power_law_liquid_balances_force_and_shear_stress() {
        for index in [0.5, 1.0, 1.6] {
            let (force, consistency) = (6.0, 0.7);
            let flow = PowerLawPoiseuille::new(WIDTH, force, consistency, index).unwrap();
            let velocity = |y| flow.velocity(y).unwrap();
            let stress = |y| {
                let shear: f64 = slope(velocity, y, 1e-4);
                consistency * shear.abs().powf(index - 1.0) * shear
            };
            for y in [0.1, 0.6, 1.5] {
                let left = slope(stress, y, 1e-3) + force;
                assert!(left.abs() < 1e-4 * force, "{left} at {y}, n = {index}");
            }
            assert!(velocity(0.0).abs() < 1e-12 && velocity(WIDTH).abs() < 1e-12);
            let n = 10_000;
            let mean: f64 = (0..n)
                .map(|k| velocity(WIDTH * (f64::from(k) + 0.5) / f64::from(n)) / f64::from(n))
                .sum();
            assert!((mean / flow.mean_velocity() - 1.0).abs() < 1e-6);
        }
        // With n = 1 it is the Newtonian liquid.
        let thin = PowerLawPoiseuille::new(WIDTH, 6.0, 3.0, 1.0).unwrap();
        let newton = Poiseuille::new(WIDTH, 6.0 / 1000.0, 3.0 / 1000.0).unwrap();
        let (a, b) = (thin.velocity(0.3).unwrap(), newton.steady(0.3).unwrap());
        assert!((a / b - 1.0).abs() < 1e-12);
    }

    #[test]
    fn values_without_an_answer_are_refused() {
        let flow = Couette::new(WIDTH, 3.0, VISCOSITY).unwrap();
        for (y, t) in [
            (-0.1, 1.0),
            (2.1, 1.0),
            (1.0, -1.0),
            (1.0, 1e-20),
            (1.0, f64::NAN),
        ] {
            assert!(flow.velocity(y, t).is_err(), "{y} {t}");
        }
        assert!(Couette::new(0.0, 1.0, 1.0).is_err());
        assert!(Poiseuille::new(1.0, f64::INFINITY, 1.0).is_err());
        assert!(PowerLawPoiseuille::new(1.0, 1.0, 1.0, 0.0).is_err());
    }
}
