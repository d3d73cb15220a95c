//! The exact Riemann problem of ideal and stiffened gases, vacuum included.
//! Two uniform states meet at x = 0; the solution depends on ξ = x/t alone.
//!
//! With P = p + p∞ and the sound speed a² = γP/ρ the pressure of the star region is the root of
//!
#![doc = include_str!("../../docs/equations/riemann.html")]
//!
//! and u* = ½(u_l + u_r) + ½(f_r − f_l): E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid
//! Dynamics*, 3rd ed. 2009, Eqs 4.5–4.9; the sampling and the vacuum follow his Sections 4.5 and 4.6.
//! A stiffened gas differs from an ideal one only in P for p (R. Menikoff and B. Plohr, 1989).
//!
//! ```
//! use meshfree::study::riemann::{Gas, GasState, RiemannProblem};
//! let air = Gas::ideal(1.4);
//! let left = GasState { density: 1.0, velocity: 0.0, pressure: 1.0 };
//! let right = GasState { density: 0.125, velocity: 0.0, pressure: 0.1 };
//! let tube = RiemannProblem::new(air, left, air, right)?;
//! assert!((tube.star_pressure() - 0.30313).abs() < 1e-5);
//! assert!((tube.sample(1.0).density - 0.26557).abs() < 1e-5);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::{StudyError, finite};

/// A gas with p = (γ − 1)ρe − γp∞.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gas {
    /// Ratio of specific heats γ > 1.
    pub gamma: f64,
    /// Stiffening pressure p∞ ≥ 0 \[Pa\]; 0 for an ideal gas.
    pub stiffness: f64,
}

impl Gas {
    /// An ideal gas, p∞ = 0.
    #[must_use]
    pub fn ideal(gamma: f64) -> Self {
        Self {
            gamma,
            stiffness: 0.0,
        }
    }
    /// Sound speed a = √(γ(p + p∞)/ρ) \[m/s\]; 0 in vacuum.
    #[must_use]
    pub fn sound_speed(&self, state: &GasState) -> f64 {
        if state.density > 0.0 {
            let stiffened = (state.pressure + self.stiffness).max(0.0);
            (self.gamma * stiffened / state.density).sqrt()
        } else {
            0.0
        }
    }
    /// Specific internal energy e = (p + γp∞)/((γ − 1)ρ) \[J/kg\]; 0 in vacuum.
    #[must_use]
    pub fn energy(&self, state: &GasState) -> f64 {
        if state.density > 0.0 {
            (state.pressure + self.gamma * self.stiffness) / ((self.gamma - 1.0) * state.density)
        } else {
            0.0
        }
    }
    fn vacuum(&self) -> GasState {
        GasState {
            density: 0.0,
            velocity: 0.0,
            pressure: -self.stiffness,
        }
    }
}

/// Density, velocity and pressure. A density of zero is vacuum; its other values are then unused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GasState {
    /// Density ρ \[kg/m³\].
    pub density: f64,
    /// Velocity u \[m/s\].
    pub velocity: f64,
    /// Pressure p \[Pa\].
    pub pressure: f64,
}

/// One side of the problem, seen so that its wave runs outwards.
#[derive(Clone, Copy, Debug)]
struct Half {
    gas: Gas,
    state: GasState,
    sound_speed: f64,
    /// −1 on the left, +1 on the right.
    sign: f64,
}

impl Half {
    fn new(gas: Gas, state: GasState, sign: f64) -> Self {
        Self {
            gas,
            state,
            sound_speed: gas.sound_speed(&state),
            sign,
        }
    }
    fn is_vacuum(&self) -> bool {
        self.state.density <= 0.0
    }
    /// Change of velocity across the wave that brings the pressure to `p`, and its derivative.
    fn jump(&self, p: f64) -> (f64, f64) {
        let g = self.gas.gamma;
        let before = self.state.pressure + self.gas.stiffness;
        let after = p + self.gas.stiffness;
        if p > self.state.pressure {
            let a = 2.0 / ((g + 1.0) * self.state.density);
            let b = (g - 1.0) / (g + 1.0) * before;
            let root = (a / (after + b)).sqrt();
            let excess = after - before;
            (excess * root, root * (1.0 - 0.5 * excess / (after + b)))
        } else {
            let ratio = (after / before).max(0.0);
            let value =
                2.0 * self.sound_speed / (g - 1.0) * (ratio.powf((g - 1.0) / (2.0 * g)) - 1.0);
            let slope =
                ratio.powf(-(g + 1.0) / (2.0 * g)) / (self.state.density * self.sound_speed);
            (value, slope)
        }
    }
    /// Largest gain of velocity: expansion into vacuum.
    fn escape(&self) -> f64 {
        2.0 * self.sound_speed / (self.gas.gamma - 1.0)
    }
    /// Density behind the wave that brings the pressure to `p`.
    fn density_behind(&self, p: f64) -> f64 {
        let g = self.gas.gamma;
        let ratio = (p + self.gas.stiffness) / (self.state.pressure + self.gas.stiffness);
        if p > self.state.pressure {
            let m = (g - 1.0) / (g + 1.0);
            self.state.density * (ratio + m) / (m * ratio + 1.0)
        } else {
            self.state.density * ratio.powf(1.0 / g)
        }
    }
    /// Inside the rarefaction, at `xi`.
    fn fan(&self, xi: f64) -> GasState {
        let g = self.gas.gamma;
        let outward = self.sign * (xi - self.state.velocity);
        let c = (2.0 * self.sound_speed + (g - 1.0) * outward) / (g + 1.0);
        let ratio = (c / self.sound_speed).max(0.0);
        let before = self.state.pressure + self.gas.stiffness;
        GasState {
            density: self.state.density * ratio.powf(2.0 / (g - 1.0)),
            velocity: xi - self.sign * c,
            pressure: before * ratio.powf(2.0 * g / (g - 1.0)) - self.gas.stiffness,
        }
    }
}

/// How fast the edges of the outward wave of one side move \[m/s\].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Wave {
    /// A shock.
    Shock {
        /// Speed of the shock.
        speed: f64,
    },
    /// A rarefaction fan.
    Rarefaction {
        /// Speed of the edge to the undisturbed gas.
        head: f64,
        /// Speed of the edge to the star region, or to the vacuum.
        tail: f64,
    },
    /// None: that side is vacuum.
    None,
}

/// The solved Riemann problem; see the [module](self).
#[derive(Clone, Debug)]
pub struct RiemannProblem {
    left: Half,
    right: Half,
    star: Option<(f64, f64)>,
}

impl RiemannProblem {
    /// Solves for the states on the two sides. Each side may have a gas of its own.
    ///
    /// # Errors
    /// If γ ≤ 1, p∞ < 0, a density is negative, a value is not finite, p + p∞ ≤ 0 where there is gas, or
    /// gases with different p∞ part so fast that a void opens between them.
    pub fn new(
        left_gas: Gas,
        left: GasState,
        right_gas: Gas,
        right: GasState,
    ) -> Result<Self, StudyError> {
        for (gas, state) in [(&left_gas, &left), (&right_gas, &right)] {
            check(gas, state)?;
        }
        let left = Half::new(left_gas, left, -1.0);
        let right = Half::new(right_gas, right, 1.0);
        let closing = left.state.velocity - right.state.velocity;
        let parts = left.is_vacuum()
            || right.is_vacuum()
            || left.escape() + right.escape() + closing <= 0.0;
        let gas_on_both = !left.is_vacuum() && !right.is_vacuum();
        if gas_on_both && left_gas.stiffness != right_gas.stiffness {
            // Gases of different p∞ can run out of pressure on one side before the other is a vacuum.
            let floor = -left_gas.stiffness.min(right_gas.stiffness);
            if left.jump(floor).0 + right.jump(floor).0 - closing >= 0.0 {
                return Err(StudyError::Parameter {
                    quantity: "the velocity of approach [m/s]",
                    value: closing,
                    requirement: "larger, or the two stiffening pressures equal: a void opens here",
                });
            }
        }
        let star = if parts {
            None
        } else {
            Some(solve(&left, &right))
        };
        Ok(Self { left, right, star })
    }

    /// Pressure p* between the waves \[Pa\]; −p∞ of the left gas if a vacuum lies there.
    #[must_use]
    pub fn star_pressure(&self) -> f64 {
        self.star
            .map_or(-self.left.gas.stiffness, |(pressure, _)| pressure)
    }
    /// Velocity u* of the contact \[m/s\]; `None` if a vacuum lies between the waves.
    #[must_use]
    pub fn star_velocity(&self) -> Option<f64> {
        self.star.map(|(_, velocity)| velocity)
    }
    /// Densities ρ* left and right of the contact \[kg/m³\]; zero if a vacuum lies there.
    #[must_use]
    pub fn star_densities(&self) -> (f64, f64) {
        self.star.map_or((0.0, 0.0), |(p, _)| {
            (self.left.density_behind(p), self.right.density_behind(p))
        })
    }
    /// The wave that runs to the left.
    #[must_use]
    pub fn left_wave(&self) -> Wave {
        self.wave(&self.left)
    }
    /// The wave that runs to the right.
    #[must_use]
    pub fn right_wave(&self) -> Wave {
        self.wave(&self.right)
    }

    fn wave(&self, half: &Half) -> Wave {
        if half.is_vacuum() {
            return Wave::None;
        }
        let (u, c, sign) = (half.state.velocity, half.sound_speed, half.sign);
        let head = u + sign * c;
        match self.star {
            Some((p, _)) if p > half.state.pressure => {
                let behind = half.density_behind(p);
                let flux =
                    ((p - half.state.pressure) / (1.0 / half.state.density - 1.0 / behind)).sqrt();
                let weak = half.state.density * c;
                let flux = if flux.is_finite() { flux } else { weak };
                Wave::Shock {
                    speed: u + sign * flux / half.state.density,
                }
            }
            Some((p, velocity)) => {
                let stiff = half.gas.stiffness;
                let g = half.gas.gamma;
                let ratio = (p + stiff) / (half.state.pressure + stiff);
                let behind = c * ratio.powf((g - 1.0) / (2.0 * g));
                Wave::Rarefaction {
                    head,
                    tail: velocity + sign * behind,
                }
            }
            None => Wave::Rarefaction {
                head,
                tail: u - sign * half.escape(),
            },
        }
    }

    /// The state at ξ = x/t \[m/s\].
    #[must_use]
    pub fn sample(&self, xi: f64) -> GasState {
        let half = match self.star {
            Some((_, velocity)) if xi < velocity => &self.left,
            Some(_) => &self.right,
            None if self.left.is_vacuum() => &self.right,
            None if self.right.is_vacuum() => &self.left,
            None => {
                let edge = self.left.state.velocity + self.left.escape();
                if xi <= edge { &self.left } else { &self.right }
            }
        };
        if half.is_vacuum() {
            return half.gas.vacuum();
        }
        let outside = |speed: f64| half.sign * (xi - speed) >= 0.0;
        match self.wave(half) {
            Wave::None => half.gas.vacuum(),
            Wave::Shock { speed } if outside(speed) => half.state,
            Wave::Rarefaction { head, .. } if outside(head) => half.state,
            Wave::Rarefaction { tail, .. } if outside(tail) => half.fan(xi),
            _ => match self.star {
                Some((pressure, velocity)) => GasState {
                    density: half.density_behind(pressure),
                    velocity,
                    pressure,
                },
                None => half.gas.vacuum(),
            },
        }
    }
}

fn check(gas: &Gas, state: &GasState) -> Result<(), StudyError> {
    let wrong = |quantity, value, requirement| {
        Err(StudyError::Parameter {
            quantity,
            value,
            requirement,
        })
    };
    finite("density [kg/m³]", state.density)?;
    finite("velocity [m/s]", state.velocity)?;
    finite("pressure [Pa]", state.pressure)?;
    if !(gas.gamma > 1.0 && gas.gamma.is_finite()) {
        return wrong("the ratio of specific heats", gas.gamma, "larger than 1");
    }
    if !(gas.stiffness >= 0.0 && gas.stiffness.is_finite()) {
        return wrong("the stiffening pressure [Pa]", gas.stiffness, "0 or more");
    }
    if state.density < 0.0 {
        return wrong("density [kg/m³]", state.density, "0 (vacuum) or more");
    }
    if state.density > 0.0 && state.pressure + gas.stiffness <= 0.0 {
        return wrong(
            "pressure [Pa]",
            state.pressure,
            "larger than minus the stiffening pressure",
        );
    }
    Ok(())
}

/// Newton's method for p*, kept inside a bracket.
fn solve(left: &Half, right: &Half) -> (f64, f64) {
    let opening = right.state.velocity - left.state.velocity;
    let residual = |p: f64| {
        let ((fl, dl), (fr, dr)) = (left.jump(p), right.jump(p));
        (fl + fr + opening, dl + dr)
    };
    let floor = -left.gas.stiffness.min(right.gas.stiffness);
    let scale = (left.state.pressure - floor).max(right.state.pressure - floor);
    let (mut low, mut high) = (floor, floor + 2.0 * scale);
    while residual(high).0 < 0.0 && high.is_finite() {
        low = high;
        high = floor + 4.0 * (high - floor);
    }
    let (zl, zr) = (
        left.state.density * left.sound_speed,
        right.state.density * right.sound_speed,
    );
    let acoustic =
        (zr * left.state.pressure + zl * right.state.pressure - zl * zr * opening) / (zl + zr);
    let mut p = if acoustic > low && acoustic < high {
        acoustic
    } else {
        0.5 * (low + high)
    };
    for _ in 0..200 {
        let (value, slope) = residual(p);
        if value < 0.0 {
            low = p;
        } else {
            high = p;
        }
        let newton = p - value / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        let done = (next - p).abs() <= 1e-15 * (next - floor).abs();
        p = next;
        if done {
            break;
        }
    }
    let mean = 0.5 * (left.state.velocity + right.state.velocity);
    (p, mean + 0.5 * (right.jump(p).0 - left.jump(p).0))
}

#[cfg(test)]
mod tests;
