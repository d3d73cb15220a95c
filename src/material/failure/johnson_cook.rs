//! The law of Johnson and Cook for the failure of ductile metals.
//! D = Σ Δε/ε_f, ε_f = (D₁ + D₂ e^(D₃ σ*))(1 + D₄ ln ε̇*)(1 + D₅ T*).

use super::{Failure, FailureState};
use crate::material::strength::{ROOM_TEMPERATURE, heat};
use crate::scalar::Lane;

/// The law of Johnson & Cook (1985), equations 4 and 5.
///
/// ```text
/// D = Σ Δε/ε_f,   ε_f = (D₁ + D₂ e^(D₃ σ*)) (1 + D₄ ln ε̇*) (1 + D₅ T*)
/// σ* = −p/σ,   ε̇* = ε̇/ε̇₀,   T* = (T − T_r)/(T_m − T_r)
/// ```
///
/// with the stress σ of von Mises and the equivalent plastic strain ε. D₃ is negative for what pressure makes tougher
/// (the paper prints the sign of the pressure in σ*). The paper gives the equation to σ* = 1.5 and another form up to
/// spall; here σ* is held at 1.5 from above, and [`SpallStrength`](super::SpallStrength) is for what lies beyond. ε̇* is
/// held at one from below and T* between zero and one, as in the
/// [law of strength](crate::material::strength::JohnsonCook). Where ε_f is not positive any plastic strain fails.
///
/// ```
/// use meshfree::material::failure::{Failure, FailureState, JohnsonCookFailure};
/// // OFHC copper: half of the strain that simple tension bears.
/// let copper = JohnsonCookFailure::new(0.54, 4.89, -3.03).with_rate_sensitivity(0.014);
/// let fails = 0.54 + 4.89 * (-1.01_f64).exp();
/// let pulled = FailureState {
///     increment: 0.5 * fails, rate: 1.0, pressure: -1e8, von_mises: 3e8, ..FailureState::default()
/// };
/// assert!((copper.damage(&pulled) - 0.5).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct JohnsonCookFailure {
    /// D₁, the strain at failure under large tension.
    pub least: f64,
    /// D₂, what triaxiality changes.
    pub triaxial: f64,
    /// D₃, how fast it does.
    pub exponent: f64,
    /// D₄, what the strain gains with each factor e of rate; 0 unless set.
    pub rate_sensitivity: f64,
    /// Reference rate ε̇₀ \[1/s\]; 1 as in the paper.
    pub reference_rate: f64,
    /// D₅, what it gains up to the melting point; 0 unless set.
    pub heat_sensitivity: f64,
    /// Reference temperature T_r \[K\]; [`ROOM_TEMPERATURE`].
    pub reference_temperature: f64,
    /// Melting temperature T_m \[K\]; infinite, which is no effect, unless set.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub melting_temperature: f64,
}

/// The largest triaxiality to which the equation holds.
const MOST_TRIAXIAL: f64 = 1.5;

impl JohnsonCookFailure {
    /// D₁, D₂ and D₃, without effects of rate and temperature.
    #[must_use]
    pub const fn new(least: f64, triaxial: f64, exponent: f64) -> Self {
        Self {
            least,
            triaxial,
            exponent,
            rate_sensitivity: 0.0,
            reference_rate: 1.0,
            heat_sensitivity: 0.0,
            reference_temperature: ROOM_TEMPERATURE,
            melting_temperature: f64::INFINITY,
        }
    }
    /// With D₄.
    #[must_use]
    pub const fn with_rate_sensitivity(mut self, rate_sensitivity: f64) -> Self {
        self.rate_sensitivity = rate_sensitivity;
        self
    }
    /// With D₅, and T_m \[K\].
    #[must_use]
    pub const fn with_heat_sensitivity(
        mut self,
        heat_sensitivity: f64,
        melting_temperature: f64,
    ) -> Self {
        self.heat_sensitivity = heat_sensitivity;
        self.melting_temperature = melting_temperature;
        self
    }

    /// The plastic strain ε_f at which it fails under constant conditions.
    ///
    /// ```
    /// use meshfree::material::failure::{FailureState, JohnsonCookFailure};
    /// let law = JohnsonCookFailure::new(0.1, 0.9, -1.0);
    /// assert_eq!(law.strain_at_failure(&FailureState::default()), 1.0);
    /// ```
    #[must_use]
    #[inline(always)]
    pub fn strain_at_failure<L: Lane>(&self, state: &FailureState<L>) -> L {
        let triaxial = state.triaxiality().min(L::of(MOST_TRIAXIAL));
        let triaxial = (L::of(self.exponent) * triaxial).exp();
        let rate = (state.rate / L::of(self.reference_rate)).max(L::one()).ln();
        let range = [self.reference_temperature, self.melting_temperature];
        let heat = heat(state.temperature, range);
        L::of(self.triaxial).fused(triaxial, L::of(self.least))
            * L::of(self.rate_sensitivity).fused(rate, L::one())
            * L::of(self.heat_sensitivity).fused(heat, L::one())
    }
}

impl Failure for JohnsonCookFailure {
    fn name(&self) -> &'static str {
        "Johnson–Cook failure"
    }
    fn source(&self) -> &'static str {
        "Johnson & Cook 1985, eqs. 4 and 5"
    }
    #[inline(always)]
    fn damage<L: Lane>(&self, state: &FailureState<L>) -> L {
        let (zero, bears) = (L::zero(), self.strain_at_failure(state));
        let share = L::select(bears.gt(zero), state.increment / bears, L::one());
        L::select(state.increment.le(zero), zero, share)
    }
    fn uses_plastic_strain(&self) -> bool {
        true
    }
    fn uses_temperature(&self) -> bool {
        self.melting_temperature.is_finite() && self.heat_sensitivity != 0.0
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let finite = [
            ("least", self.least),
            ("triaxial", self.triaxial),
            ("exponent", self.exponent),
            ("rate_sensitivity", self.rate_sensitivity),
            ("heat_sensitivity", self.heat_sensitivity),
        ];
        let wrong = finite.into_iter().filter(|(_, value)| !value.is_finite());
        let mut problems: Vec<_> = wrong
            .map(|(name, value)| (name, value, "it must be finite"))
            .collect();
        problems.extend(super::not_positive(&[
            ("reference_rate", self.reference_rate),
            ("reference_temperature", self.reference_temperature),
        ]));
        if self.melting_temperature <= self.reference_temperature
            || self.melting_temperature.is_nan()
        {
            let above = "it must be above the reference temperature";
            problems.push(("melting_temperature", self.melting_temperature, above));
        }
        problems
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each factor by itself against its closed form, and the sum over a path of constant conditions.
    #[test]
    fn damage_is_the_integral_of_strain_over_strain_at_failure() {
        let law = JohnsonCookFailure::new(0.05, 3.44, -2.12)
            .with_rate_sensitivity(0.002)
            .with_heat_sensitivity(0.61, 1793.0);
        let state = FailureState {
            increment: 1e-3,
            rate: 1e4,
            temperature: 0.5 * (1793.0 + ROOM_TEMPERATURE),
            pressure: -2e8,
            von_mises: 4e8,
            ..FailureState::default()
        };
        let exact =
            (0.05 + 3.44 * (-1.06_f64).exp()) * (1.0 + 0.002 * 1e4_f64.ln()) * (1.0 + 0.5 * 0.61);
        assert!((law.strain_at_failure(&state) / exact - 1.0).abs() < 1e-14);
        let steps = (exact / 1e-3).floor();
        let sum: f64 = (0..steps as usize).map(|_| law.damage(&state)).sum();
        assert!((sum - steps * 1e-3 / exact).abs() < 1e-12 && sum < 1.0);
        // No plastic strain, no damage; tension beyond the range is held.
        let elastic = FailureState {
            increment: 0.0,
            ..state
        };
        assert_eq!(law.damage(&elastic), 0.0);
        let beyond = FailureState {
            pressure: -9e9,
            ..state
        };
        let at = FailureState {
            pressure: -1.5 * 4e8,
            ..state
        };
        assert_eq!(law.damage(&beyond), law.damage(&at));
        assert!(law.damage(&beyond) > law.damage(&state));
    }

    #[test]
    fn wrong_constants_are_named() {
        let law = JohnsonCookFailure::new(f64::NAN, 1.0, -1.0).with_heat_sensitivity(0.1, 200.0);
        let names: Vec<_> = law.problems().iter().map(|own| own.0).collect();
        assert_eq!(names, ["least", "melting_temperature"]);
        assert!(
            JohnsonCookFailure::new(0.5, 1.0, -1.0)
                .problems()
                .is_empty()
        );
    }
}
