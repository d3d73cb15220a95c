//! The law of Steinberg, Cochran and Guinan for metals at high rate and pressure.
//! Y = Y₀ f(ε) (1 + A p/η^(1/3) − B (T − 300 K)), whatever the rate.

use super::{PlasticState, Strength};
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// The law of Steinberg, Cochran & Guinan (1980), equation 2.
///
/// ```text
/// Y = min(Y₀ (1 + β (ε + ε₀))ⁿ, Y_max) (1 + A p/η^(1/3) − B (T − 300 K)),   η = ρ/ρ₀
/// ```
///
/// It holds above some 10⁵ 1/s, where the rate no longer matters. A and B are those of the shear modulus too, which is
/// kept constant here: at 10 GPa it is some ten per cent too low. Where the last factor would be negative the metal has
/// molten, and supports no shear. With B the material needs a [`PlasticHeating`](super::PlasticHeating).
///
/// ```
/// use meshfree::material::strength::{PlasticState, SteinbergGuinan, Strength};
/// // 6061-T6 aluminium.
/// let law = SteinbergGuinan::new(0.29e9, 0.68e9, 125.0, 0.10)
///     .with_pressure(6.52e-11)
///     .with_softening(6.16e-4);
/// let room = PlasticState { temperature: 300.0, ..PlasticState::default() };
/// assert_eq!(law.yield_stress(&room), 0.29e9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct SteinbergGuinan {
    /// Yield stress Y₀ \[Pa\] at 300 K, without pressure and strain.
    pub yield_stress: f64,
    /// Largest yield stress Y_max \[Pa\] of hardening, at 300 K and without pressure.
    pub greatest: f64,
    /// Coefficient β of hardening.
    pub hardening: f64,
    /// Exponent n of hardening.
    pub exponent: f64,
    /// Plastic strain ε₀ at the start; 0 unless set.
    pub initial_strain: f64,
    /// A \[1/Pa\]; 0 unless set.
    pub pressure: f64,
    /// B \[1/K\]; 0 unless set.
    pub softening: f64,
}

/// \[K\], at which constants are given.
const REFERENCE_TEMPERATURE: f64 = 300.0;

impl SteinbergGuinan {
    /// Y₀ and Y_max \[Pa\], β and n, without effects of pressure and temperature.
    #[must_use]
    pub const fn new(yield_stress: f64, greatest: f64, hardening: f64, exponent: f64) -> Self {
        Self {
            yield_stress,
            greatest,
            hardening,
            exponent,
            initial_strain: 0.0,
            pressure: 0.0,
            softening: 0.0,
        }
    }
    /// With A \[1/Pa\].
    #[must_use]
    pub const fn with_pressure(mut self, pressure: f64) -> Self {
        self.pressure = pressure;
        self
    }
    /// With B \[1/K\].
    #[must_use]
    pub const fn with_softening(mut self, softening: f64) -> Self {
        self.softening = softening;
        self
    }
    /// With ε₀.
    #[must_use]
    pub const fn with_initial_strain(mut self, initial_strain: f64) -> Self {
        self.initial_strain = initial_strain;
        self
    }
}

impl Strength for SteinbergGuinan {
    fn name(&self) -> &'static str {
        "Steinberg–Guinan"
    }
    fn source(&self) -> &'static str {
        "Steinberg, Cochran & Guinan 1980, eq. 2"
    }
    #[inline(always)]
    fn yield_stress<L: Lane>(&self, state: &PlasticState<L>) -> L {
        let (of, one) = (L::of, L::one());
        let strain = (state.strain + of(self.initial_strain)).positive_part();
        let hardened = (one + of(self.hardening) * strain).powf(self.exponent);
        let hardened = (of(self.yield_stress) * hardened).min(of(self.greatest));
        let pressed = of(self.pressure) * state.pressure / state.density_ratio.cbrt();
        let heated = of(self.softening) * (state.temperature - of(REFERENCE_TEMPERATURE));
        hardened * (one + pressed - heated).positive_part()
    }
    fn uses_temperature(&self) -> bool {
        self.softening > 0.0
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .not_negative("yield_stress", self.yield_stress)
            .must(
                self.greatest >= self.yield_stress,
                "greatest",
                self.greatest,
                "at least the yield stress",
            )
            .not_negative("hardening", self.hardening)
            .not_negative("exponent", self.exponent)
            .not_negative("initial_strain", self.initial_strain)
            .not_negative("pressure", self.pressure)
            .not_negative("softening", self.softening)
            .list()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALUMINIUM: SteinbergGuinan = SteinbergGuinan::new(0.29e9, 0.68e9, 125.0, 0.10)
        .with_pressure(6.52e-11)
        .with_softening(6.16e-4);

    fn near(value: f64, exact: f64) {
        assert!((value / exact - 1.0).abs() < 1e-12, "{value} {exact}");
    }

    #[test]
    fn it_hardens_to_its_cap_and_melts() {
        let room = PlasticState {
            temperature: 300.0,
            ..PlasticState::default()
        };
        let at = |state| ALUMINIUM.yield_stress(&state);
        near(at(room), 0.29e9);
        // (1 + 125 · 0.1)^0.1 = 13.5^0.1 = 1.297279.
        let strained = PlasticState {
            strain: 0.1,
            ..room
        };
        assert!((at(strained) / (0.29e9 * 1.297_279) - 1.0).abs() < 1e-6);
        let far = PlasticState {
            strain: 1e3,
            ..room
        };
        near(at(far), 0.68e9);
        // 10 GPa at η = 1.331, whose cube root is 1.1; the rate does nothing.
        let pressed = PlasticState {
            pressure: 10e9,
            density_ratio: 1.331,
            rate: 1e7,
            ..room
        };
        near(at(pressed), 0.29e9 * (1.0 + 0.652 / 1.1));
        let hot = PlasticState {
            temperature: 800.0,
            ..room
        };
        near(at(hot), 0.29e9 * (1.0 - 0.308));
        let molten = PlasticState {
            temperature: 2500.0,
            ..room
        };
        assert_eq!(at(molten), 0.0);
        let prestrained = ALUMINIUM.with_initial_strain(0.1);
        assert_eq!(prestrained.yield_stress(&room), at(strained));
        let wrong = SteinbergGuinan::new(1e9, 0.5e9, 1.0, 1.0).problems();
        assert_eq!(wrong[0].0, "greatest");
    }
}
