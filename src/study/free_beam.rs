//! A free beam that bends: the shape and the period of its first swing, by Euler and by Timoshenko.
//! What structures of particles are compared with, with the shear and the rotation that a thick beam has.
//!
//! Of length L, height H and unit width \[m\], density ρ \[kg/m³\], Young's modulus E \[Pa\] and Poisson's ratio ν, in plane strain, with
//! k the first root of cosh(kL) cos(kL) = 1 and s the share that leaves both ends free of moment and shear,
//!
//! ```text
//! w(x) = cosh(kx) + cos(kx) − s (sinh(kx) + sin(kx)),     kL = 4.73004, s = 0.98250
//! ω²   = k⁴ EI/(ρH),     EI = E H³/(12 (1 − ν²))          Euler
//! ```
//!
//! Timoshenko's beam has the rotary inertia H²/12 and the shear stiffness 5/6 G H beside it; its frequency is the first root of
//! the equation of T. C. Huang, *Journal of Applied Mechanics* 28 (1961) 579, for free ends.
//!
//! ```
//! use meshfree::study::free_beam::FreeBeam;
//! // Ten times as long as high: shear and rotation make it 4 % slower.
//! let beam = FreeBeam::new(0.2, 0.02, 1000.0, 2e6, 0.3975)?;
//! assert!((beam.period() / beam.thin_period() - 1.04).abs() < 0.01);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::{StudyError, positive};
use std::f64::consts::TAU;

/// First root of cosh(x) cos(x) = 1 beyond zero, and the share of the antisymmetric part in its shape.
const ROOT: f64 = 4.730_040_744_862_704;
const SHARE: f64 = 0.982_502_214_576_238;
/// Shear coefficient of a rectangle.
const SHEAR: f64 = 5.0 / 6.0;

/// A beam without supports; see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBeam {
    length: f64,
    height: f64,
    density: f64,
    youngs: f64,
    poisson: f64,
}

impl FreeBeam {
    /// A beam of `length` and `height` \[m\], `density` \[kg/m³\], Young's modulus `youngs` \[Pa\] and Poisson's ratio `poisson`, in plane
    /// strain.
    ///
    /// # Errors
    /// If a value is not larger than zero, Poisson's ratio is not between −1 and ½, or the beam is less than three times as long as high.
    pub fn new(
        length: f64,
        height: f64,
        density: f64,
        youngs: f64,
        poisson: f64,
    ) -> Result<Self, StudyError> {
        positive("length of the beam [m]", length)?;
        positive("height of the beam [m]", height)?;
        let refuse = |quantity, value, requirement| {
            Err(StudyError::Parameter {
                quantity,
                value,
                requirement,
            })
        };
        if !(poisson > -1.0 && poisson < 0.5) {
            return refuse("Poisson's ratio of the beam", poisson, "between −1 and 0.5");
        }
        // Shorter ones are no beams, and the root is sought within what longer ones have.
        if length < 3.0 * height {
            return refuse(
                "length over height of the beam",
                length / height,
                "3 or more",
            );
        }
        Ok(Self {
            length,
            height,
            density: positive("density of the beam [kg/m³]", density)?,
            youngs: positive("Young's modulus of the beam [Pa]", youngs)?,
            poisson,
        })
    }

    /// The first shape of bending at `x` \[m\] from an end: 2 at the ends.
    #[must_use]
    pub fn shape(&self, x: f64) -> f64 {
        let k = ROOT / self.length * x;
        k.cosh() + k.cos() - SHARE * (k.sinh() + k.sin())
    }

    /// EI \[N m\], of unit width.
    fn stiffness(&self) -> f64 {
        self.youngs / (1.0 - self.poisson * self.poisson) * self.height.powi(3) / 12.0
    }

    /// Angular frequency of the thin beam \[1/s\].
    fn thin(&self) -> f64 {
        let mass = self.density * self.height;
        (ROOT / self.length).powi(2) * (self.stiffness() / mass).sqrt()
    }

    /// Period \[s\] of a thin beam, without shear and rotary inertia (Euler).
    #[must_use]
    pub fn thin_period(&self) -> f64 {
        TAU / self.thin()
    }

    /// Period \[s\] with shear and rotary inertia (Timoshenko).
    #[must_use]
    pub fn period(&self) -> f64 {
        let (height, square) = (self.height, self.length * self.length);
        let stiffness = self.stiffness();
        let shear = SHEAR * height * self.youngs / (2.0 * (1.0 + self.poisson));
        let rotary = height * height / 12.0 / square;
        let sheared = stiffness / (shear * square);
        let unbalance = |omega: f64| {
            let b = omega * square * (self.density * height / stiffness).sqrt();
            let root = ((rotary - sheared).powi(2) + 4.0 / (b * b)).sqrt();
            let [low, high] =
                [-1.0, 1.0].map(|sign| b * (0.5 * (sign * (rotary + sheared) + root)).sqrt());
            let third = b * b * rotary * (rotary - sheared).powi(2) + 3.0 * rotary - sheared;
            2.0 - 2.0 * low.cosh() * high.cos()
                + b / (1.0 - b * b * rotary * sheared).sqrt() * third * low.sinh() * high.sin()
        };
        // Slower than the thin beam, and by less than half where it is three times as long as high.
        let [mut low, mut high] = [0.5 * self.thin(), 1.001 * self.thin()];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if unbalance(low) * unbalance(middle) <= 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        TAU / low
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::check::{curvature, slope};

    fn beam(slenderness: f64) -> FreeBeam {
        FreeBeam::new(1.0, 1.0 / slenderness, 7800.0, 2e11, 0.3).unwrap()
    }

    #[test]
    fn ends_are_free_of_moment_and_shear() {
        let beam = beam(10.0);
        let bent = |x: f64| curvature(|x| beam.shape(x), x, 1e-3);
        let middle = bent(0.5).abs();
        for end in [0.0, 1.0] {
            assert!(bent(end).abs() < 1e-4 * middle, "{}", bent(end));
            let shear = slope(bent, end, 1e-2);
            assert!(shear.abs() < 2e-2 * middle, "{shear}");
        }
        // Neither momentum nor spin.
        let cells = 10_000;
        let sums = (0..cells).fold([0.0; 2], |[sum, moment], k| {
            let x = (f64::from(k) + 0.5) / f64::from(cells);
            let w = beam.shape(x) / f64::from(cells);
            [sum + w, moment + (x - 0.5) * w]
        });
        assert!(sums.iter().all(|sum| sum.abs() < 1e-7), "{sums:?}");
    }

    /// To first order in (H/L)² shear and rotary inertia slow a beam by what Rayleigh's quotient gives of them, with the
    /// integrals of its shape.
    #[test]
    fn shear_and_rotation_slow_it_as_they_should() {
        for slenderness in [30.0, 100.0] {
            let beam = beam(slenderness);
            let cells = 20_000;
            let [mut w, mut turned, mut sheared] = [0.0; 3];
            for k in 0..cells {
                let x = (f64::from(k) + 0.5) / f64::from(cells) * ROOT;
                let own = |x: f64| x.cosh() + x.cos() - SHARE * (x.sinh() + x.sin());
                let first = x.sinh() - x.sin() - SHARE * (x.cosh() + x.cos());
                let third = x.sinh() + x.sin() - SHARE * (x.cosh() - x.cos());
                w += own(x).powi(2);
                turned += (ROOT * first).powi(2);
                sheared += (ROOT.powi(3) * third).powi(2);
            }
            let rotary = 1.0 / (12.0 * slenderness * slenderness);
            // EI/(κGA) = E/(1 − ν²)/(κ G) H²/12.
            let shear = 2.0 * 1.3 / (1.0 - 0.09) / SHEAR * rotary;
            // Energy of shear V²/(2κGA) with V = EI w‴, over that of bending, k⁴ w²/2.
            let expected = 0.5 * (rotary * turned / w + shear * sheared / (w * ROOT.powi(4)));
            let found = beam.period() / beam.thin_period() - 1.0;
            assert!((found / expected - 1.0).abs() < 0.03, "{found} {expected}");
        }
    }

    #[test]
    fn what_is_no_beam_is_refused() {
        for (length, height, poisson) in [(1.0, 0.5, 0.3), (1.0, 0.1, 0.5), (0.0, 0.1, 0.3)] {
            assert!(FreeBeam::new(length, height, 1.0, 1.0, poisson).is_err());
        }
    }
}
