//! The law of Johnson and Cook for metals under impact.
//! Y = (A + B εⁿ)(1 + C ln ε̇*)(1 − T*ᵐ).

use super::{PlasticState, PowerHardening, ROOM_TEMPERATURE, Strength};
use crate::scalar::Lane;

/// The law of Johnson & Cook (1983), equation 1.
///
/// ```text
/// Y = (A + B εⁿ) (1 + C ln ε̇*) (1 − T*ᵐ),   ε̇* = ε̇/ε̇₀,   T* = (T − T_r)/(T_m − T_r)
/// ```
///
/// The rate ratio ε̇* is held at one from below: slower flow was not measured, and the logarithm has no floor. T* is
/// held between zero and one, so a metal below T_r is no stronger than there, and one above its melting point T_m
/// supports no shear.
///
/// The material needs a [`PlasticHeating`](super::PlasticHeating), for temperature comes from plastic work.
///
/// ```
/// use meshfree::material::strength::{JohnsonCook, PlasticState, Strength};
/// // OFHC copper.
/// let copper = JohnsonCook::new(90e6, 292e6, 0.31)
///     .with_rate_sensitivity(0.025)
///     .with_softening(1.09, 1356.0);
/// let strained = PlasticState { strain: 1.0, rate: 1.0, ..PlasticState::default() };
/// assert!((copper.yield_stress(&strained) - 382e6).abs() < 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct JohnsonCook {
    /// A + B εⁿ.
    pub hardening: PowerHardening,
    /// C, what the yield stress gains with each factor e of rate; 0 unless set.
    pub rate_sensitivity: f64,
    /// Reference rate ε̇₀ \[1/s\]; 1 as in the paper unless set.
    pub reference_rate: f64,
    /// Exponent m of softening; 1 unless set.
    pub softening: f64,
    /// Reference temperature T_r \[K\]; [`ROOM_TEMPERATURE`] unless set.
    pub reference_temperature: f64,
    /// Melting temperature T_m \[K\]; infinite, which is no softening, unless set.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub melting_temperature: f64,
}

impl JohnsonCook {
    /// A and B \[Pa\], and n, without effects of rate and temperature.
    #[must_use]
    pub const fn new(yield_stress: f64, hardening: f64, exponent: f64) -> Self {
        Self {
            hardening: PowerHardening::new(yield_stress, hardening, exponent),
            rate_sensitivity: 0.0,
            reference_rate: 1.0,
            softening: 1.0,
            reference_temperature: ROOM_TEMPERATURE,
            melting_temperature: f64::INFINITY,
        }
    }
    /// With C.
    #[must_use]
    pub const fn with_rate_sensitivity(mut self, rate_sensitivity: f64) -> Self {
        self.rate_sensitivity = rate_sensitivity;
        self
    }
    /// With another reference rate ε̇₀ \[1/s\].
    #[must_use]
    pub const fn with_reference_rate(mut self, reference_rate: f64) -> Self {
        self.reference_rate = reference_rate;
        self
    }
    /// With m, and T_m \[K\].
    #[must_use]
    pub const fn with_softening(mut self, softening: f64, melting_temperature: f64) -> Self {
        self.softening = softening;
        self.melting_temperature = melting_temperature;
        self
    }
    /// With another reference temperature T_r \[K\].
    #[must_use]
    pub const fn with_reference_temperature(mut self, reference_temperature: f64) -> Self {
        self.reference_temperature = reference_temperature;
        self
    }
}

impl Strength for JohnsonCook {
    fn name(&self) -> &'static str {
        "Johnson–Cook"
    }
    fn source(&self) -> &'static str {
        "Johnson & Cook 1983, eq. 1"
    }
    #[inline(always)]
    fn yield_stress<L: Lane>(&self, state: &PlasticState<L>) -> L {
        let rate = (state.rate / L::of(self.reference_rate)).max(L::one()).ln();
        let faster = L::of(self.rate_sensitivity).fused(rate, L::one());
        let range = [self.reference_temperature, self.melting_temperature];
        let softened = L::one() - heat(state.temperature, range).powf(self.softening);
        self.hardening.yield_stress(state) * faster * softened
    }
    fn uses_temperature(&self) -> bool {
        self.melting_temperature.is_finite()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        self.hardening
            .checks()
            .not_negative("rate_sensitivity", self.rate_sensitivity)
            .positive("reference_rate", self.reference_rate)
            .positive("softening", self.softening)
            .positive("reference_temperature", self.reference_temperature)
            .must(
                self.melting_temperature > self.reference_temperature,
                "melting_temperature",
                self.melting_temperature,
                "above the reference temperature",
            )
            .list()
    }
}

/// T* = (T − T_r)/(T_m − T_r), held between zero and one.
#[inline(always)]
pub(in crate::material) fn heat<L: Lane>(temperature: L, [reference, melting]: [f64; 2]) -> L {
    let heat = (temperature - L::of(reference)) / L::of(melting - reference);
    // In this order what is no number stays so.
    L::one().min(L::zero().max(heat))
}

#[cfg(test)]
mod tests {
    use super::*;

    const COPPER: JohnsonCook = JohnsonCook::new(90e6, 292e6, 0.31)
        .with_rate_sensitivity(0.025)
        .with_softening(1.09, 1356.0);

    fn at(strain: f64, rate: f64, temperature: f64) -> f64 {
        COPPER.yield_stress(&PlasticState {
            strain,
            rate,
            temperature,
            ..PlasticState::default()
        })
    }

    #[test]
    fn its_limits_are_those_of_the_three_factors() {
        let room = ROOM_TEMPERATURE;
        assert_eq!(at(0.0, 1.0, room), 90e6);
        // The floor of the rate, and that of the temperature.
        assert_eq!(at(0.0, 0.0, room), 90e6);
        assert_eq!(at(0.0, 1e-3, 77.0), 90e6);
        // A melt bears nothing.
        assert_eq!(at(1.0, 1e4, 1356.0), 0.0);
        assert_eq!(at(1.0, 1e4, 5000.0), 0.0);
        // Without softening temperature does nothing, and none is asked for.
        let cold = JohnsonCook::new(90e6, 292e6, 0.31);
        let hot = PlasticState {
            temperature: 2000.0,
            ..PlasticState::default()
        };
        assert_eq!(cold.yield_stress(&hot), 90e6);
        assert!(COPPER.uses_temperature() && !cold.uses_temperature());
    }

    /// By hand: (90 + 292 · 0.2^0.31) MPa = 267.29 MPa, 1 + 0.025 ln 10⁴ = 1.23026, and at 600 K
    /// 1 − 0.28533^1.09 = 0.74515.
    #[test]
    fn it_has_the_value_computed_by_hand() {
        let value = at(0.2, 1e4, 600.0);
        let hardened = 90e6 + 292e6 * (0.31 * 0.2f64.ln()).exp();
        let fast = 1.0 + 0.025 * 4.0 * std::f64::consts::LN_10;
        let heat = (600.0 - 298.15) / (1356.0 - 298.15);
        let by_logarithms = hardened * fast * (1.0 - (1.09 * f64::ln(heat)).exp());
        assert!((value / by_logarithms - 1.0).abs() < 1e-14);
        assert!((value / 245.0e6 - 1.0).abs() < 2e-3, "{value}");
    }

    #[test]
    fn a_melting_point_below_the_reference_is_named() {
        let wrong = COPPER.with_softening(1.0, 200.0).with_reference_rate(0.0);
        let fields: Vec<_> = wrong.problems().iter().map(|problem| problem.0).collect();
        assert_eq!(fields, ["reference_rate", "melting_temperature"]);
        assert!(COPPER.problems().is_empty());
        assert!(JohnsonCook::new(1.0, 0.0, 1.0).problems().is_empty());
    }
}
