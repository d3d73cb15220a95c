//! Tillotson's law for hypervelocity impact, from shocked solid to vapour.
//! A compressed and a vapour branch, blended between incipient and complete vaporisation.

use super::guard::{LEAST_RATIO, Problems, compression, speed};
use super::{EosState, EquationOfState, Guards};
use crate::scalar::Lane;

/// The Tillotson law.
///
#[doc = include_str!("../../../docs/equations/tillotson.html")]
///
/// Source: Tillotson (1962); the blend as in Melosh (1989). The pressure is continuous; c² jumps at
/// e_iv and e_cv in expansion, because the published blend is linear in e. Use it where impact melts
/// or vaporises. Guards, all under `expansion`: a negative energy counts as zero inside r; c stays
/// above a hundredth of √(A/ρ₀) (under `compression` if μ ≥ 0).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Tillotson {
    /// Density ρ₀ \[kg/m³\] of the cold solid.
    pub reference_density: f64,
    /// a \[1\]: Grüneisen parameter of the hot gas, about 0.5.
    pub a: f64,
    /// b \[1\]: a + b is the Grüneisen parameter of the cold solid.
    pub b: f64,
    /// A \[Pa\]: bulk modulus.
    pub bulk_modulus: f64,
    /// B \[Pa\]: coefficient of μ².
    pub second_modulus: f64,
    /// E₀ \[J/kg\]: energy at which the Grüneisen parameter has lost half of b.
    pub characteristic_energy: f64,
    /// α \[1\]: how fast the vapour becomes an ideal gas, customarily 5.
    pub alpha: f64,
    /// β \[1\]: how fast the cold term fades in vapour, customarily 5.
    pub beta: f64,
    /// e_iv \[J/kg\]: incipient vaporisation.
    pub incipient_vaporisation: f64,
    /// e_cv \[J/kg\]: complete vaporisation.
    pub complete_vaporisation: f64,
}

impl Tillotson {
    /// Aluminium: ρ₀ 2700 kg/m³, a 0.5, b 1.63, A 75.2 GPa, B 65 GPa, E₀ 5 MJ/kg, α = β = 5,
    /// e_iv 3 MJ/kg, e_cv 13.9 MJ/kg (Tillotson 1962, as tabulated by Melosh 1989).
    #[must_use]
    pub const fn aluminium() -> Self {
        Self {
            reference_density: 2700.0,
            a: 0.5,
            b: 1.63,
            bulk_modulus: 75.2e9,
            second_modulus: 65e9,
            characteristic_energy: 5e6,
            alpha: 5.0,
            beta: 5.0,
            incipient_vaporisation: 3e6,
            complete_vaporisation: 13.9e6,
        }
    }
}

impl EquationOfState for Tillotson {
    fn name(&self) -> &'static str {
        "Tillotson"
    }
    fn reference_density(&self) -> f64 {
        self.reference_density
    }
    fn uses_energy(&self) -> bool {
        true
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, energy: L) -> EosState<L> {
        let (zero, one, two) = (L::zero(), L::one(), L::of(2.0));
        let least = L::of(LEAST_RATIO - 1.0);
        let plain = compression(density, self.reference_density);
        let mu = plain.max(least);
        let w = mu + one;
        let rho = w * L::of(self.reference_density);
        let per_density = L::of(1.0 / self.reference_density);
        let (a, b) = (L::of(self.a), L::of(self.b));
        let (modulus, second) = (L::of(self.bulk_modulus), L::of(self.second_modulus));

        let inverse_square = one / (w * w);
        let phi = energy.positive_part() * inverse_square * L::of(1.0 / self.characteristic_energy);
        let r = one / (one + phi);
        // b r and what its derivatives add: ρ ∂r/∂ρ = 2φr², e ∂r/∂e = −φr².
        let br = b * r;
        let lost = br * r * phi;

        let cold = (a + br) * rho * energy + second.mul_add(mu, modulus) * mu;
        let cold_by_energy = rho * (a + br - lost);
        let cold_by_density =
            energy * (a + br + two * lost) + (second * two).mul_add(mu, modulus) * per_density;

        let x = (one / w - one).positive_part();
        let alpha = L::of(self.alpha);
        let fade = (-(alpha * x * x)).exp();
        let elastic = (-(L::of(self.beta) * x)).exp() * modulus;
        let thinning = inverse_square * per_density;
        let bracket = br * rho * energy + mu * elastic;
        let bracket_by_density =
            energy * (br + two * lost) + elastic * (per_density + mu * L::of(self.beta) * thinning);
        let hot = a * rho * energy + bracket * fade;
        let hot_by_energy = rho * (a + (br - lost) * fade);
        let hot_by_density =
            a * energy + fade * (bracket_by_density + bracket * two * alpha * x * thinning);

        let width = 1.0 / (self.complete_vaporisation - self.incipient_vaporisation);
        let progress = (energy - L::of(self.incipient_vaporisation)) * L::of(width);
        let expanded = mu.lt(zero);
        let t = L::select(expanded, progress.positive_part().min(one), zero);
        let blending = expanded & progress.gt(zero) & progress.lt(one);
        let rise = L::select(blending, (hot - cold) * L::of(width), zero);

        let pressure = (hot - cold).mul_add(t, cold);
        let by_density = (hot_by_density - cold_by_density).mul_add(t, cold_by_density);
        let by_energy = (hot_by_energy - cold_by_energy).mul_add(t, cold_by_energy) + rise;
        let squared = pressure / rho * (by_energy / rho) + by_density;
        let (sound_speed, slow) =
            speed(squared, (self.bulk_modulus / self.reference_density).sqrt());
        let mut guards = Guards::none();
        guards.compression = slow & !expanded;
        guards.expansion = (slow & expanded) | energy.lt(zero) | plain.lt(least);
        EosState {
            pressure,
            sound_speed,
            guards,
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let ordered = self.complete_vaporisation > self.incipient_vaporisation;
        Problems::default()
            .positive("reference_density", self.reference_density)
            .positive("a", self.a)
            .positive("b", self.b)
            .positive("bulk_modulus", self.bulk_modulus)
            .finite("second_modulus", self.second_modulus)
            .positive("characteristic_energy", self.characteristic_energy)
            .positive("alpha", self.alpha)
            .positive("beta", self.beta)
            .positive("incipient_vaporisation", self.incipient_vaporisation)
            .must(
                ordered && self.complete_vaporisation.is_finite(),
                "complete_vaporisation",
                self.complete_vaporisation,
                "finite and above incipient_vaporisation",
            )
            .list()
    }
}
