//! A standing wave in a tank: its period, its velocities, and how viscosity and height change it.
//! Linear theory, with the correction of the period for a finite amplitude.
//!
//! Over a flat, slippery bottom at z = 0, with depth h \[m\], amplitude a \[m\], wavenumber k = 2π/λ
//! \[1/m\], gravity g \[m/s²\], kinematic viscosity ν \[m²/s\] and the decay A = a exp(−2νk²t),
//!
//! ```text
//! ω² = g k tanh(kh)
//! η  =  A cos(kx) cos(ωt)                                 elevation of the surface over z = h
//! u  =  A ω cosh(kz)/sinh(kh) sin(kx) sin(ωt)
//! w  = −A ω sinh(kz)/sinh(kh) cos(kx) sin(ωt)
//! ```
//!
//! Walls may stand wherever sin(kx) = 0: a tank of length L that holds half a wave has λ = 2L. (H.
//! Lamb, *Hydrodynamics*, 6th ed., 1932, Sections 228 for the wave and 348 for the decay, which is
//! the work of viscosity on the potential flow: it leaves out the layers at walls that hold the
//! liquid.)
//!
//! A wave of finite amplitude swings slower in deep liquid and faster in shallow liquid; with ε = ka
//! and T = tanh(kh) the angular frequency is, to third order in ε,
//!
//! ```text
//! Ω = ω [1 + ε²/64 (9/T⁴ − 12/T² − 3 − 2T²)]
//! ```
//!
//! (I. Tadjbakhsh, J. B. Keller, *Journal of Fluid Mechanics* 8 (1960) 442–451.) In deep liquid it is
//! Lord Rayleigh's 1 − ε²/8; it changes sign at kh = 1.058.
//!
//! ```
//! use meshfree::study::standing_wave::StandingWave;
//! let wave = StandingWave::new(2.0, 1.0, 0.1)?;
//! assert!((wave.period() - 1.134).abs() < 5e-4);
//! assert!((wave.finite_amplitude_period()? / wave.period() - 1.012).abs() < 5e-4);
//! assert_eq!(wave.elevation(0.0, 0.0), 0.1);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::{StudyError, finite, positive, within};
use std::f64::consts::PI;

/// A standing wave that is highest at x = 0 and at rest at t = 0.
///
/// A quarter of a period earlier or later the surface is flat and the liquid at its fastest: a run
/// that starts there needs a block of particles and [`velocity`](Self::velocity), no curved surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingWave {
    wavelength: f64,
    depth: f64,
    amplitude: f64,
    gravity: f64,
    kinematic_viscosity: f64,
}

impl StandingWave {
    /// A wave of `wavelength` and `amplitude` \[m\] on a liquid of `depth` \[m\], without viscosity
    /// and under 9.81 m/s².
    ///
    /// # Errors
    /// If the wavelength or the depth is not larger than zero, or the amplitude is not finite.
    pub fn new(wavelength: f64, depth: f64, amplitude: f64) -> Result<Self, StudyError> {
        Ok(Self {
            wavelength: positive("wavelength [m]", wavelength)?,
            depth: positive("depth of the liquid [m]", depth)?,
            amplitude: finite("amplitude of the wave [m]", amplitude)?,
            gravity: 9.81,
            kinematic_viscosity: 0.0,
        })
    }
    /// The wave under another gravity g \[m/s²\].
    ///
    /// # Errors
    /// If it is not larger than zero.
    pub fn with_gravity(self, gravity: f64) -> Result<Self, StudyError> {
        Ok(Self {
            gravity: positive("gravity [m/s²]", gravity)?,
            ..self
        })
    }
    /// The wave on a liquid of kinematic viscosity ν \[m²/s\].
    ///
    /// # Errors
    /// If it is not larger than zero.
    pub fn with_kinematic_viscosity(self, viscosity: f64) -> Result<Self, StudyError> {
        Ok(Self {
            kinematic_viscosity: positive("kinematic viscosity [m²/s]", viscosity)?,
            ..self
        })
    }
    /// Wavenumber k = 2π/λ \[1/m\].
    #[must_use]
    pub fn wavenumber(&self) -> f64 {
        2.0 * PI / self.wavelength
    }
    /// Angular frequency ω = √(g k tanh kh) \[rad/s\] of a low wave.
    #[must_use]
    pub fn angular_frequency(&self) -> f64 {
        let k = self.wavenumber();
        (self.gravity * k * (k * self.depth).tanh()).sqrt()
    }
    /// Period 2π/ω \[s\] of a low wave.
    #[must_use]
    pub fn period(&self) -> f64 {
        2.0 * PI / self.angular_frequency()
    }
    /// Period 2π/Ω \[s\] of a wave of this amplitude, to third order in the steepness ka.
    ///
    /// # Errors
    /// If the correction is more than a tenth, by a steep wave or a shallow liquid: the orders that are
    /// left out are then not small either.
    pub fn finite_amplitude_period(&self) -> Result<f64, StudyError> {
        let k = self.wavenumber();
        let t2 = (k * self.depth).tanh().powi(2);
        let bracket = 9.0 / (t2 * t2) - 12.0 / t2 - 3.0 - 2.0 * t2;
        let correction = (k * self.amplitude).powi(2) / 64.0 * bracket;
        within("Ω/ω − 1 for this amplitude:", correction, -0.1, 0.1)?;
        Ok(self.period() / (1.0 + correction))
    }
    /// Rate 2νk² \[1/s\] at which viscosity takes the amplitude; the energy goes at twice this.
    #[must_use]
    pub fn decay_rate(&self) -> f64 {
        2.0 * self.kinematic_viscosity * self.wavenumber().powi(2)
    }
    /// Elevation η \[m\] of the surface above the depth h at `x` \[m\] and time `t` \[s\].
    #[must_use]
    pub fn elevation(&self, x: f64, t: f64) -> f64 {
        let phase = self.angular_frequency() * t;
        self.amplitude_at(t) * (self.wavenumber() * x).cos() * phase.cos()
    }
    /// Velocity (u, w) \[m/s\] at the place (x, z) \[m\], z from the bottom, at time `t` \[s\].
    #[must_use]
    pub fn velocity(&self, [x, z]: [f64; 2], t: f64) -> [f64; 2] {
        let (k, omega) = (self.wavenumber(), self.angular_frequency());
        let speed = self.amplitude_at(t) * omega * (omega * t).sin();
        // cosh(kz)/sinh(kh) and sinh(kz)/sinh(kh), with exponents that do not overflow in deep liquid.
        let rising = (k * (z - self.depth)).exp();
        let falling = (-k * (z + self.depth)).exp();
        let whole = 1.0 - (-2.0 * k * self.depth).exp();
        let (sin_x, cos_x) = (k * x).sin_cos();
        [
            speed * (rising + falling) / whole * sin_x,
            -speed * (rising - falling) / whole * cos_x,
        ]
    }
    fn amplitude_at(&self, t: f64) -> f64 {
        self.amplitude * (-self.decay_rate() * t).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::super::check::slope;
    use super::*;

    #[test]
    fn the_wave_satisfies_the_equations_of_linear_potential_flow() {
        let wave = StandingWave::new(2.0, 0.4, 0.03)
            .unwrap()
            .with_gravity(3.0)
            .unwrap();
        let step = 1e-4;
        for (x, z, t) in [(0.3, 0.1, 0.2), (1.1, 0.35, 0.9), (-0.4, 0.25, 3.1)] {
            let at = |x, z, t| wave.velocity([x, z], t);
            let (u_x, w_z) = (
                slope(|x| at(x, z, t)[0], x, step),
                slope(|z| at(x, z, t)[1], z, step),
            );
            let (u_z, w_x) = (
                slope(|z| at(x, z, t)[0], z, step),
                slope(|x| at(x, z, t)[1], x, step),
            );
            assert!(u_x.abs() > 1e-3 && u_z.abs() > 1e-3);
            assert!((u_x + w_z).abs() < 1e-6 && (u_z - w_x).abs() < 1e-6);
            assert!(at(x, 0.0, t)[1].abs() < 1e-15 && at(1.0, z, t)[0].abs() < 1e-15);
            // The surface moves with the liquid, and its slope drives it: together, the dispersion.
            let rise = slope(|t| wave.elevation(x, t), t, step);
            assert!((rise - at(x, 0.4, t)[1]).abs() < 1e-6);
            let push = slope(|t| at(x, 0.4, t)[0], t, step);
            let fall = -3.0 * slope(|x| wave.elevation(x, t), x, step);
            assert!(
                (push - fall).abs() < 1e-6 && fall.abs() > 1e-3,
                "{push} {fall}"
            );
        }
        // Deep liquid: far more than the exponential function could hold.
        let deep = StandingWave::new(0.01, 10.0, 1e-4).unwrap();
        let [u, w] = deep.velocity([0.002, 9.999], 0.01);
        assert!(u.is_finite() && w.is_finite() && u != 0.0);
    }

    #[test]
    fn viscosity_dissipates_what_the_wave_loses() {
        let (nu, depth) = (1e-3, 0.4);
        let wave = StandingWave::new(2.0, depth, 0.03)
            .unwrap()
            .with_kinematic_viscosity(nu)
            .unwrap();
        // At the moment of the flat surface all energy is kinetic and dissipation is twice its mean.
        let t = 0.25 * wave.period();
        let (nx, nz, step) = (64, 400, 1e-4);
        let (dx, dz) = (2.0 / f64::from(nx), depth / f64::from(nz));
        let (mut kinetic, mut dissipation) = (0.0, 0.0);
        for i in 0..nx {
            for j in 0..nz {
                let (x, z) = (f64::from(i) * dx, (f64::from(j) + 0.5) * dz);
                let [u, w] = wave.velocity([x, z], t);
                let u_x = slope(|x| wave.velocity([x, z], t)[0], x, step);
                let u_z = slope(|z| wave.velocity([x, z], t)[0], z, step);
                kinetic += 0.5 * (u * u + w * w) * dx * dz;
                // 2ν eᵢⱼeᵢⱼ of a flow without rotation.
                dissipation += 2.0 * nu * 2.0 * (u_x * u_x + u_z * u_z) * dx * dz;
            }
        }
        let rate = 0.5 * (0.5 * dissipation / kinetic);
        assert!((rate / wave.decay_rate() - 1.0).abs() < 1e-4, "{rate}");
        let later = wave.elevation(0.0, 10.0 * wave.period());
        let expected = 0.03 * (-10.0 * wave.decay_rate() * wave.period()).exp();
        assert!((later - expected).abs() < 1e-9);
    }

    /// Nonlinear potential flow in one period of length 2π under g = 1, even in x, by the expansion of
    /// the Dirichlet–Neumann operator to third order (W. Craig, C. Sulem, *Journal of Computational
    /// Physics* 108 (1993) 73–83).
    struct Basin {
        depth: f64,
        cosines: Vec<Vec<f64>>,
    }

    type Field = Vec<f64>;

    fn zip(a: &Field, b: &Field, f: impl Fn(f64, f64) -> f64) -> Field {
        a.iter().zip(b).map(|(&a, &b)| f(a, b)).collect()
    }

    fn times(a: &Field, b: &Field) -> Field {
        zip(a, b, |a, b| a * b)
    }

    impl Basin {
        const POINTS: usize = 16;

        fn new(depth: f64) -> Self {
            let place = |j: usize| PI * (j as f64 + 0.5) / Self::POINTS as f64;
            let row = |m: usize| {
                (0..Self::POINTS)
                    .map(|j| (m as f64 * place(j)).cos())
                    .collect()
            };
            // Half of the modes: products of three stay apart from them.
            let cosines = (0..Self::POINTS / 2).map(row).collect();
            Self { depth, cosines }
        }
        fn mode(&self, f: &Field, m: usize) -> f64 {
            let sum: f64 = times(&self.cosines[m], f).iter().sum();
            sum * if m == 0 { 1.0 } else { 2.0 } / Self::POINTS as f64
        }
        fn operate(&self, f: &Field, symbol: impl Fn(f64) -> f64) -> Field {
            let mut result = vec![0.0; Self::POINTS];
            for (m, cosine) in self.cosines.iter().enumerate() {
                let factor = symbol(m as f64) * self.mode(f, m);
                result = zip(&result, cosine, |sum, cosine| sum + factor * cosine);
            }
            result
        }
        fn second(&self, f: &Field) -> Field {
            self.operate(f, |m| -m * m)
        }
        fn flat(&self, f: &Field) -> Field {
            self.operate(f, |m| m * (m * self.depth).tanh())
        }
        /// ∂a/∂x ∂b/∂x.
        fn slopes(&self, a: &Field, b: &Field) -> Field {
            let both = zip(
                &times(a, &self.second(b)),
                &times(b, &self.second(a)),
                |p, q| p + q,
            );
            zip(&self.second(&times(a, b)), &both, |whole, both| {
                0.5 * (whole - both)
            })
        }
        /// Rates of the surface η and of the potential φ on it.
        fn rates(&self, eta: &Field, phi: &Field) -> (Field, Field) {
            let g0 = self.flat(phi);
            let phi_xx = self.second(phi);
            let carried = zip(&times(eta, &phi_xx), &self.slopes(eta, phi), |a, b| {
                -(a + b)
            });
            let first = self.flat(&times(eta, &g0));
            let eta2 = times(eta, eta);
            let bent = zip(
                &self.second(&times(&eta2, &g0)),
                &self.flat(&times(&eta2, &phi_xx)),
                |a, b| 0.5 * (a + b),
            );
            let third = zip(&bent, &self.flat(&times(eta, &first)), |a, b| a + b);
            let mut rise = zip(&g0, &carried, |a, b| a + b);
            rise = zip(&rise, &first, |a, b| a - b);
            rise = zip(&rise, &third, |a, b| a + b);
            let along = self.slopes(phi, phi);
            let upward = zip(&rise, &self.slopes(eta, phi), |a, b| a + b);
            let steep = self.slopes(eta, eta);
            let head = zip(&times(&upward, &upward), &steep, |a, b| 0.5 * a / (1.0 + b));
            let mut push = zip(&head, &along, |a, b| a - 0.5 * b);
            push = zip(&push, eta, |a, b| a - b);
            (rise, self.operate(&push, |_| 1.0))
        }
        /// Mean angular frequency of the first mode over `periods`, from a crest at rest.
        fn frequency(&self, amplitude: f64, periods: usize) -> f64 {
            let mut eta = self.cosines[1].iter().map(|c| amplitude * c).collect();
            let mut phi = vec![0.0; Self::POINTS];
            let dt = 2.0 * PI / self.depth.tanh().sqrt() / 60.0;
            let ahead = |f: &Field, rate: &Field, dt: f64| zip(f, rate, |f, rate| f + dt * rate);
            let (mut crossings, mut step, mut before) = (0, 0.0, amplitude);
            loop {
                let (a, p) = self.rates(&eta, &phi);
                let (b, q) = self.rates(&ahead(&eta, &a, 0.5 * dt), &ahead(&phi, &p, 0.5 * dt));
                let (c, r) = self.rates(&ahead(&eta, &b, 0.5 * dt), &ahead(&phi, &q, 0.5 * dt));
                let (d, s) = self.rates(&ahead(&eta, &c, dt), &ahead(&phi, &r, dt));
                for (f, stages) in [(&mut eta, [a, b, c, d]), (&mut phi, [p, q, r, s])] {
                    for (stage, weight) in stages.iter().zip([1.0, 2.0, 2.0, 1.0]) {
                        *f = ahead(f, stage, dt * weight / 6.0);
                    }
                }
                step += 1.0;
                let now = self.mode(&eta, 1);
                if now * before < 0.0 {
                    crossings += 1;
                    if crossings == 2 * periods {
                        // The first crossing comes after a quarter, each other after a half.
                        let time = (step - now / (now - before)) * dt;
                        return (periods as f64 - 0.25) * 2.0 * PI / time;
                    }
                }
                before = now;
            }
        }
    }

    #[test]
    fn the_correction_of_the_period_is_that_of_nonlinear_potential_flow() {
        for (depth, sign) in [(PI, -1.0), (1.5, -1.0), (0.8, 1.0)] {
            let amplitude = 0.04;
            let wave = StandingWave::new(2.0 * PI, depth, amplitude)
                .unwrap()
                .with_gravity(1.0)
                .unwrap();
            let basin = Basin::new(depth);
            let computed = basin.frequency(amplitude, 50) / basin.frequency(1e-6, 50) - 1.0;
            let expected = wave.period() / wave.finite_amplitude_period().unwrap() - 1.0;
            println!("kh = {depth}: {computed} computed, {expected} by the formula");
            assert!((computed / expected - 1.0).abs() < 0.01 && expected * sign > 0.0);
        }
        // Rayleigh's limit of deep liquid.
        let deep = StandingWave::new(1.0, 10.0, 0.01).unwrap();
        let change = deep.period() / deep.finite_amplitude_period().unwrap() - 1.0;
        assert!((change / (-(0.02 * PI).powi(2) / 8.0) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn values_without_a_wave_are_refused() {
        assert!(StandingWave::new(0.0, 1.0, 0.1).is_err());
        assert!(StandingWave::new(1.0, -1.0, 0.1).is_err());
        let wave = StandingWave::new(1.0, 1.0, 0.1).unwrap();
        assert!(wave.finite_amplitude_period().is_ok());
        let steep = StandingWave::new(1.0, 1.0, 0.2).unwrap();
        assert!(steep.finite_amplitude_period().is_err());
        assert!(wave.with_gravity(0.0).is_err());
        assert!(wave.with_kinematic_viscosity(f64::NAN).is_err());
    }
}
