//! The Jones–Wilkins–Lee law for the products of a detonation.
//! p = A (1 − ω/(R₁V)) e^{−R₁V} + B (1 − ω/(R₂V)) e^{−R₂V} + ω ρ e, with V = ρ₀/ρ.

use super::guard::{LEAST_RATIO, Problems, speed};
use super::{EosState, EquationOfState, Guards};
use crate::scalar::Lane;

/// The Jones–Wilkins–Lee law.
///
#[doc = include_str!("../../../docs/equations/jwl.html")]
///
/// Source: Lee, Hornig & Kury (1968). The law is that of the products alone: it has no reaction and no detonation front, which
/// [`ProgrammedBurn`](crate::effect::ProgrammedBurn) adds. What has burnt starts with the specific energy
/// e = [`detonation_energy`](Self::detonation_energy), which [`Body::energy`](crate::scene::Body::energy) gives it; a body without it is cold gas at ρ₀, whose pressure is a part of that.
/// With the whole charge lit at once (a constant-volume explosion) work and impulse on what is around are right once the wave
/// has run through it, and the pressure at the start is about half of p_CJ.
///
/// ```
/// use meshfree::material::eos::Jwl;
/// use meshfree::prelude::*;
/// // A charge of TNT of 20 mm, lit.
/// let charge = |energy| {
///     let tnt = Material::new("TNT", Jwl::tnt());
///     let body = Body::block("charge", tnt, [0.0], [0.02], 2e-4).energy(energy);
///     Scene::<f64, 1>::new(schemes::gas()).body(body).build()
/// };
/// let pressure = |simulation: &Simulation<f64, 1>| {
///     simulation.body("charge").map(|mut all| all.nth(50).map_or(0.0, |particle| particle.pressure()))
/// };
/// let lit = charge(Jwl::tnt().detonation_energy)?;
/// assert!((pressure(&lit)? / 8.38e9 - 1.0).abs() < 0.01);
/// // Unlit it lacks ω ρ₀ e = 2.1 GPa.
/// assert!((pressure(&charge(0.0)?)? / 6.28e9 - 1.0).abs() < 0.01);
/// # Ok::<(), Error>(())
/// ```
///
/// Guards: below V = 0.3 the law goes on along its tangent in ρ
/// (`compression`); c stays above a hundredth of its cold value at V = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Jwl {
    /// Density ρ₀ \[kg/m³\] of the unreacted explosive.
    pub reference_density: f64,
    /// A \[Pa\].
    pub a: f64,
    /// B \[Pa\].
    pub b: f64,
    /// R₁ \[1\].
    pub r1: f64,
    /// R₂ \[1\].
    pub r2: f64,
    /// ω \[1\]: Grüneisen parameter of the products.
    pub omega: f64,
    /// Specific energy of detonation \[J/kg\], from which the products start.
    pub detonation_energy: f64,
}

impl Jwl {
    /// The least V = ρ₀/ρ of the plain law.
    pub const LEAST_VOLUME: f64 = 0.3;

    /// TNT: ρ₀ 1630 kg/m³, A 371.2 GPa, B 3.231 GPa, R₁ 4.15, R₂ 0.95, ω 0.30, E₀ 7 GJ/m³, with
    /// D = 6930 m/s and p_CJ = 21 GPa (Dobratz & Crawford 1985).
    #[must_use]
    pub const fn tnt() -> Self {
        Self {
            reference_density: 1630.0,
            a: 371.2e9,
            b: 3.231e9,
            r1: 4.15,
            r2: 0.95,
            omega: 0.30,
            detonation_energy: 7e9 / 1630.0,
        }
    }

    /// The part without energy, and ρ₀ times its derivative with density, at relative volume V.
    #[inline(always)]
    fn cold<L: Lane>(&self, volume: L) -> (L, L) {
        let term = |factor: f64, rate: f64| {
            let decay = (volume * L::of(-rate)).exp() * L::of(factor);
            let value = decay * (L::one() - L::of(self.omega / rate) / volume);
            let slope = volume
                .mul_add(L::of(rate), L::of(-self.omega))
                .mul_add(volume, L::of(-self.omega / rate));
            (value, decay * slope)
        };
        let (first, second) = (term(self.a, self.r1), term(self.b, self.r2));
        (first.0 + second.0, first.1 + second.1)
    }
}

impl EquationOfState for Jwl {
    fn name(&self) -> &'static str {
        "Jones-Wilkins-Lee"
    }
    fn reference_density(&self) -> f64 {
        self.reference_density
    }
    fn uses_energy(&self) -> bool {
        true
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, energy: L) -> EosState<L> {
        let least = L::of(LEAST_RATIO * self.reference_density);
        let limit = L::of(self.reference_density / Self::LEAST_VOLUME);
        let rho = density.max(least);
        let held = rho.min(limit);
        let (cold, slope) = self.cold(L::of(self.reference_density) / held);
        let slope = slope * L::of(1.0 / self.reference_density);
        let omega = L::of(self.omega);
        let pressure = (rho - held).mul_add(slope, (rho * energy).mul_add(omega, cold));
        let squared = (energy + pressure / rho).mul_add(omega, slope);
        let at_rest = (self.cold(1.0).1 / self.reference_density).max(0.0).sqrt();
        let (sound_speed, slow) = speed(squared, at_rest);
        let squeezed = density.gt(L::of(self.reference_density));
        let mut guards = Guards::none();
        guards.compression = density.gt(limit) | (slow & squeezed);
        guards.expansion = density.lt(least) | (slow & !squeezed);
        EosState {
            pressure,
            sound_speed,
            guards,
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .positive("reference_density", self.reference_density)
            .positive("a", self.a)
            .finite("b", self.b)
            .positive("r1", self.r1)
            .positive("r2", self.r2)
            .positive("omega", self.omega)
            .positive("detonation_energy", self.detonation_energy)
            .list()
    }
}
