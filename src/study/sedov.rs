//! Sedov's blast: energy released on a plane, a line or a point into cold uniform gas.
//! The self-similar solution, by integrating its ordinary differential equations.
//!
//! With λ = r/R, R ∝ t^(2/(ν+2)), u = Ṙ λV(λ), ρ = ρ₀ G(λ), p = ρ₀Ṙ² H(λ), s = ln λ and ν = 1, 2, 3
//!
#![doc = include_str!("../../docs/equations/sedov.html")]
//!
//! with the energy integral (γV − 1) H = ½(γ − 1) λ²G V²(1 − V), onto which each step is projected;
//! primes are d/ds and S_ν is 1, 2π, 4π: for ν = 1, E is the energy per area on **one** side of
//! the plane; for ν = 2 it is that per length. L. I. Sedov, *Similarity and Dimensional Methods in
//! Mechanics*, 1959, Chapter IV; J. R. Kamm and F. X. Timmes, LA-UR-07-2849, 2007. The equations are
//! integrated from the shock inwards by the classical Runge–Kutta method with steps of 5·10⁻⁴ in s,
//! which leaves mass wrong by 4·10⁻¹¹ at γ = 1.4 and by 5·10⁻⁸ at γ = 1.1.
//!
//! ```
//! use meshfree::study::sedov::Sedov;
//! let blast = Sedov::new(3, 1.4, 1.0, 1.0)?;
//! assert!((blast.alpha() - 0.85107).abs() < 1e-5);
//! let behind = blast.state(0.9 * blast.shock_radius(1.0), 1.0)?;
//! assert!(behind.density < 6.0 && behind.velocity > 0.0);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::noh::check_dimension;
use super::riemann::GasState;
use super::{StudyError, positive};

/// Step in s = ln λ.
const STEP: f64 = 5e-4;
/// The integration ends at λ = e^−10, where V and H are constant and G is a power of λ.
const STEPS: usize = 20_000;

/// The similarity solution of a blast; see the [module](self).
#[derive(Clone, Debug)]
pub struct Sedov {
    dimension: u8,
    gamma: f64,
    density: f64,
    energy: f64,
    alpha: f64,
    /// (V, ln G, ln H) at s = −k·STEP.
    table: Vec<[f64; 3]>,
}

impl Sedov {
    /// A blast of energy `energy` \[J, J/m or J/m²\] in `dimension` = 1, 2 or 3 into gas of density
    /// `density` \[kg/m³\] at zero pressure, with 1 < γ < 7 in three dimensions (beyond, the solution
    /// has a hollow core and is not covered).
    ///
    /// # Errors
    /// If the dimension is not 1, 2 or 3, or a value is out of range.
    pub fn new(dimension: u8, gamma: f64, density: f64, energy: f64) -> Result<Self, StudyError> {
        check_dimension(dimension)?;
        let nu = f64::from(dimension);
        positive("γ − 1", gamma - 1.0)?;
        positive("density [kg/m³]", density)?;
        positive("energy [J]", energy)?;
        if dimension > 1 && gamma >= (nu + 4.0) / (nu - 2.0).max(1e-12) {
            return Err(StudyError::Parameter {
                quantity: "the ratio of specific heats",
                value: gamma,
                requirement: "less than 7 in three dimensions",
            });
        }
        let mut y = [
            2.0 / (gamma + 1.0),
            ((gamma + 1.0) / (gamma - 1.0)).ln(),
            (2.0 / (gamma + 1.0)).ln(),
        ];
        let mut table = Vec::with_capacity(STEPS + 1);
        table.push(y);
        for k in 0..STEPS {
            y = runge_kutta(nu, gamma, -(k as f64) * STEP, y);
            table.push(y);
        }
        let mut blast = Self {
            dimension,
            gamma,
            density,
            energy,
            alpha: 0.0,
            table,
        };
        let surface = [1.0, std::f64::consts::TAU, 2.0 * std::f64::consts::TAU];
        let rate = 2.0 / (nu + 2.0);
        blast.alpha = rate * rate * surface[usize::from(dimension) - 1] * blast.integral();
        Ok(blast)
    }

    /// ∫ (½GV²λ² + H/(γ−1)) λ^ν ds by Simpson's rule, and the rest to the centre analytically.
    fn integral(&self) -> f64 {
        let nu = f64::from(self.dimension);
        let energy = |k: usize| {
            let s = -(k as f64) * STEP;
            let [v, g, h] = self.table[k];
            let kinetic = 0.5 * (g + 2.0 * s).exp() * v * v;
            (kinetic + h.exp() / (self.gamma - 1.0)) * (nu * s).exp()
        };
        let weight = |k: usize| match k {
            0 | STEPS => 1.0,
            k if k % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let sum: f64 = (0..=STEPS).map(|k| weight(k) * energy(k)).sum();
        sum * STEP / 3.0 + energy(STEPS) / nu
    }

    /// The energy integral α of R = (E t²/(α ρ₀))^(1/(ν+2)).
    #[must_use]
    pub fn alpha(&self) -> f64 {
        self.alpha
    }
    /// Radius of the shock \[m\] at time `t` ≥ 0 \[s\].
    #[must_use]
    pub fn shock_radius(&self, t: f64) -> f64 {
        let nu = f64::from(self.dimension);
        (self.energy * t * t / (self.alpha * self.density)).powf(1.0 / (nu + 2.0))
    }
    /// Speed of the shock \[m/s\] at time `t` > 0 \[s\].
    #[must_use]
    pub fn shock_speed(&self, t: f64) -> f64 {
        2.0 / (f64::from(self.dimension) + 2.0) * self.shock_radius(t) / t
    }

    /// (V, G, H) at λ in \[0, 1\].
    fn similarity(&self, lambda: f64) -> [f64; 3] {
        let depth = -lambda.ln() / STEP;
        let k = depth.floor();
        if k >= STEPS as f64 {
            let [v, g, h] = self.table[STEPS];
            let fall = f64::from(self.dimension) / (self.gamma - 1.0);
            return [v, (g - fall * (depth - STEPS as f64) * STEP).exp(), h.exp()];
        }
        // One Runge–Kutta step of part length from the last entry: as exact as the table.
        let k = k.max(0.0) as usize;
        let (nu, s) = (f64::from(self.dimension), -(k as f64) * STEP);
        let y = runge_kutta_by(nu, self.gamma, s, self.table[k], lambda.ln() - s);
        [y[0], y[1].exp(), y[2].exp()]
    }

    /// State at radius `r` ≥ 0 \[m\] and time `t` > 0 \[s\]; the velocity is positive outwards.
    ///
    /// # Errors
    /// If the radius is negative or the time is not larger than zero.
    pub fn state(&self, r: f64, t: f64) -> Result<GasState, StudyError> {
        positive("time [s]", t)?;
        if !(r >= 0.0 && r.is_finite()) {
            return Err(StudyError::Parameter {
                quantity: "radius [m]",
                value: r,
                requirement: "0 or more",
            });
        }
        let lambda = r / self.shock_radius(t);
        if lambda > 1.0 {
            return Ok(GasState {
                density: self.density,
                velocity: 0.0,
                pressure: 0.0,
            });
        }
        let speed = self.shock_speed(t);
        let [v, g, h] = self.similarity(lambda);
        Ok(GasState {
            density: self.density * g,
            velocity: speed * lambda * v,
            pressure: self.density * speed * speed * h,
        })
    }
}

/// (V′, (ln G)′, (ln H)′).
fn slopes(nu: f64, gamma: f64, s: f64, [v, ln_g, ln_h]: [f64; 3]) -> [f64; 3] {
    // Eliminating G′ and H′ leaves  V′ ((V−1)² − γθ) = −V(V−1)² + ½νV(V−1) − θν(1 − γV),  θ = H/(λ²G).
    let theta = (ln_h - ln_g - 2.0 * s).exp();
    let w = v - 1.0;
    let numerator = w * (0.5 * nu * v - v * w) - theta * nu * (1.0 - gamma * v);
    let dv = numerator / (w * w - gamma * theta);
    [
        dv,
        -(nu * v + dv) / w,
        (nu - gamma * nu * v - gamma * dv) / w,
    ]
}

fn runge_kutta(nu: f64, gamma: f64, s: f64, y: [f64; 3]) -> [f64; 3] {
    runge_kutta_by(nu, gamma, s, y, -STEP)
}

fn runge_kutta_by(nu: f64, gamma: f64, s: f64, y: [f64; 3], ds: f64) -> [f64; 3] {
    let moved = |k: [f64; 3], part: f64| std::array::from_fn(|i| y[i] + part * k[i]);
    let k1 = slopes(nu, gamma, s, y);
    let k2 = slopes(nu, gamma, s + 0.5 * ds, moved(k1, 0.5 * ds));
    let k3 = slopes(nu, gamma, s + 0.5 * ds, moved(k2, 0.5 * ds));
    let k4 = slopes(nu, gamma, s + ds, moved(k3, ds));
    let y: [f64; 3] =
        std::array::from_fn(|i| y[i] + ds / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    // Back onto the energy integral: errors in V would grow as λ^−ν, those in G and H do not.
    let share = 0.5 * (gamma - 1.0) * (y[1] - y[2] + 2.0 * (s + ds)).exp();
    let mut v = y[0];
    for _ in 0..4 {
        let excess = gamma * v - 1.0 - share * v * v * (1.0 - v);
        v -= excess / (gamma - share * v * (2.0 - 3.0 * v));
    }
    [v, y[1], y[2]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_integrals() {
        let cases = [
            (3, 1.4, 0.851072, 1e-5),
            (3, 5.0 / 3.0, 0.49359, 1e-5),
            (2, 1.4, 0.984074, 1e-5),
            (1, 1.4, 0.5386, 2e-4),
        ];
        for (dimension, gamma, alpha, tolerance) in cases {
            let blast = Sedov::new(dimension, gamma, 1.0, 1.0).unwrap();
            println!("alpha {dimension} {gamma:.4} {:.9}", blast.alpha());
            assert!(
                (blast.alpha() - alpha).abs() < tolerance,
                "{}",
                blast.alpha()
            );
        }
        assert!(Sedov::new(3, 7.5, 1.0, 1.0).is_err() && Sedov::new(0, 1.4, 1.0, 1.0).is_err());
    }

    #[test]
    fn mass_and_the_first_integral() {
        for dimension in 1..=3u8 {
            for gamma in [1.1, 1.4, 5.0 / 3.0, 2.0, 3.0] {
                let blast = Sedov::new(dimension, gamma, 1.0, 1.0).unwrap();
                let nu = f64::from(dimension);
                let mass = |k: usize| {
                    let s = -(k as f64) * STEP;
                    (blast.table[k][1] + nu * s).exp()
                };
                let sum: f64 = (0..STEPS / 2)
                    .map(|k| mass(2 * k) + 4.0 * mass(2 * k + 1) + mass(2 * k + 2))
                    .sum();
                let inner = mass(STEPS) / (nu + nu / (gamma - 1.0));
                let total = nu * (sum * STEP / 3.0 + inner);
                println!("mass {dimension} {gamma:.3} {:.1e}", total - 1.0);
                assert!((total - 1.0).abs() < 1e-7, "{dimension} {gamma} {total}");
                // Energy within a similarity surface is constant (Landau and Lifshitz, § 106).
                for k in (0..STEPS).step_by(500) {
                    let [v, g, h] = blast.table[k];
                    let lambda_squared = (-2.0 * k as f64 * STEP).exp();
                    let kinetic = 0.5 * g.exp() * v * v * lambda_squared;
                    let flux = (v - 1.0) * (kinetic + h.exp() / (gamma - 1.0)) + v * h.exp();
                    assert!(
                        flux.abs() < 1e-9 * h.exp(),
                        "{dimension} {gamma} {k} {flux}"
                    );
                }
            }
        }
    }

    #[test]
    fn planar_momentum_grows_by_the_pressure_on_the_plane() {
        let blast = Sedov::new(1, 1.4, 1.0, 1.0).unwrap();
        let density = |k: usize| {
            let [v, g, _] = blast.table[k];
            v * (g - 2.0 * k as f64 * STEP).exp()
        };
        let momentum: f64 = (0..STEPS / 2)
            .map(|k| density(2 * k) + 4.0 * density(2 * k + 1) + density(2 * k + 2))
            .sum::<f64>()
            * STEP
            / 3.0;
        let pressure = blast.table[STEPS][2].exp();
        assert!((0.5 * momentum / pressure - 1.0).abs() < 1e-6);
    }

    #[test]
    fn profile_near_the_centre_and_at_the_shock() {
        let blast = Sedov::new(3, 1.4, 1.0, 1.0).unwrap();
        let radius = blast.shock_radius(0.3);
        let at = |lambda: f64| blast.state(lambda * radius, 0.3).unwrap();
        let unit = radius / 0.3;
        assert!((at(1.0).density - 6.0).abs() < 1e-9);
        assert!(
            (at(0.06).density / 1.27827e-9 - 1.0).abs() < 1e-4,
            "{}",
            at(0.06).density
        );
        assert!((at(0.06).pressure / (unit * unit) / 4.87284e-2 - 1.0).abs() < 1e-5);
        assert!((at(0.02).velocity / unit / 5.71429e-3 - 1.0).abs() < 1e-5);
        assert_eq!(at(1.01).pressure, 0.0);
        assert_eq!(at(0.0).density, 0.0);
        assert!(at(0.0).pressure.is_finite());
        assert!(blast.state(0.1, 0.0).is_err());
    }
}
