//! The linear polynomial law: a cubic in compression, linear in energy.
//! p = C₀ + C₁μ + C₂μ² + C₃μ³ + (C₄ + C₅μ + C₆μ²) E, with E = ρ₀ e.

use super::guard::{LEAST_RATIO, Problems, compression, speed};
use super::{EosState, EquationOfState, Guards};
use crate::scalar::Lane;

/// The linear polynomial law of hydrocodes.
///
#[doc = include_str!("../../../docs/equations/polynomial.html")]
///
/// Source: the `*EOS_LINEAR_POLYNOMIAL` card of LS-DYNA. C₀ = C₁ = C₂ = C₃ = C₆ = 0 with
/// C₄ = C₅ = γ − 1 is the ideal gas. Guards: outside the range of the fit the law goes on along its
/// tangent in μ (counted); c stays above a hundredth of √(C₁/ρ₀), and above 10⁻⁶ m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Polynomial {
    /// Density ρ₀ \[kg/m³\].
    pub reference_density: f64,
    /// C₀ … C₃ \[Pa\] and C₄ … C₆ \[1\].
    pub coefficients: [f64; 7],
    /// Least and greatest μ \[1\] of the fit. The default (−0.5, 1) holds any solid or liquid whose
    /// constants come from shock experiments.
    pub fit_range: (f64, f64),
}

impl Polynomial {
    /// ρ₀ \[kg/m³\] and C₀ … C₆ (\[Pa\] up to C₃, then \[1\]).
    #[must_use]
    pub const fn new(reference_density: f64, coefficients: [f64; 7]) -> Self {
        Self {
            reference_density,
            coefficients,
            fit_range: (-0.5, 1.0),
        }
    }

    /// The same with another range of μ.
    #[must_use]
    pub const fn with_fit_range(mut self, least: f64, greatest: f64) -> Self {
        self.fit_range = (least, greatest);
        self
    }
}

impl EquationOfState for Polynomial {
    fn name(&self) -> &'static str {
        "linear polynomial"
    }
    fn reference_density(&self) -> f64 {
        self.reference_density
    }
    fn uses_energy(&self) -> bool {
        self.coefficients[4..].iter().any(|&c| c != 0.0)
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, energy: L) -> EosState<L> {
        let (least, greatest) = (L::of(self.fit_range.0), L::of(self.fit_range.1));
        let mu = compression(density, self.reference_density).max(-L::one());
        let held = mu.min(greatest).max(least);
        let [c0, c1, c2, c3, c4, c5, c6] = self.coefficients.map(L::of);
        let tension = held.lt(L::zero());
        let c2 = L::select(tension, L::zero(), c2);
        let c6 = L::select(tension, L::zero(), c6);
        let volume_energy = energy * L::of(self.reference_density);

        let cold = c3.mul_add(held, c2).mul_add(held, c1).mul_add(held, c0);
        let cold_slope = (c3 * L::of(3.0))
            .mul_add(held, c2 * L::of(2.0))
            .mul_add(held, c1);
        let thermal_slope = c6.mul_add(held * L::of(2.0), c5);
        let thermal = c6.mul_add(held, c5).mul_add(held, c4);
        let slope = thermal_slope.mul_add(volume_energy, cold_slope);
        let beyond = mu - held;
        let pressure = slope.mul_add(beyond, thermal.mul_add(volume_energy, cold));
        let by_energy = thermal_slope.mul_add(beyond, thermal);

        let ratio = (mu + L::one()).max(L::of(LEAST_RATIO));
        let squared =
            (pressure * by_energy / (ratio * ratio) + slope) * L::of(1.0 / self.reference_density);
        let at_rest = (self.coefficients[1].max(0.0) / self.reference_density).sqrt();
        let (sound_speed, slow) = speed(squared, at_rest.max(1e-4));
        let mut guards = Guards::none();
        guards.compression = mu.gt(greatest) | (slow & mu.ge(L::zero()));
        guards.expansion = mu.lt(least) | (slow & mu.lt(L::zero()));
        EosState {
            pressure,
            sound_speed,
            guards,
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        const NAMES: [&str; 7] = ["C0", "C1", "C2", "C3", "C4", "C5", "C6"];
        let mut problems =
            Problems::default().positive("reference_density", self.reference_density);
        for (name, value) in NAMES.into_iter().zip(self.coefficients) {
            problems = problems.finite(name, value);
        }
        let (least, greatest) = self.fit_range;
        problems
            .must(
                (-1.0..=0.0).contains(&least),
                "fit_range.0",
                least,
                "between -1 and 0",
            )
            .must(
                (0.0..1e3).contains(&greatest),
                "fit_range.1",
                greatest,
                "between 0 and 1000",
            )
            .list()
    }
}
