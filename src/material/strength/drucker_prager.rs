//! The condition of Drucker and Prager: a yield stress that rises with pressure.
//! Y = k + 3 β p.

use super::{PlasticState, Strength};
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// The condition of Drucker & Prager (1952), σ + β I₁ = k with the trace I₁ = −3 p of the stress.
///
/// ```text
/// Y = max(k + 3 β p, 0),   k = 2 Y_c Y_t/(Y_c + Y_t),   β = (Y_c − Y_t)/(Y_c + Y_t)
/// ```
///
/// so that simple tension yields at Y_t and simple compression at Y_c. Flow keeps volume (it is not associated). Beyond
/// the tension p = −k/3β nothing is borne in shear; give the material a
/// [cut-off](crate::material::Material::with_pressure_cut_off) there.
///
/// [`TensionCompression`](super::TensionCompression) has the same two values, and differs in shear and where
/// pressure goes beyond that of the two tests.
///
/// ```
/// use meshfree::material::strength::{DruckerPrager, PlasticState, Strength};
/// // FullCure M730 (Vesenjak & Ren 2007).
/// let law = DruckerPrager::from_yield_stresses(49e6, 91e6);
/// assert!((law.cohesion - 63.7e6).abs() < 1.0 && (law.slope - 0.3).abs() < 1e-12);
/// let pressed = PlasticState { pressure: 10e6, ..PlasticState::default() };
/// assert!((law.yield_stress(&pressed) - 72.7e6).abs() < 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct DruckerPrager {
    /// Yield stress k \[Pa\] without pressure.
    pub cohesion: f64,
    /// Slope β.
    pub slope: f64,
}

impl DruckerPrager {
    /// k \[Pa\] and β.
    #[must_use]
    pub const fn new(cohesion: f64, slope: f64) -> Self {
        Self { cohesion, slope }
    }
    /// From the yield stresses Y_t and Y_c \[Pa\] in simple tension and simple compression, both positive.
    #[must_use]
    pub const fn from_yield_stresses(tension: f64, compression: f64) -> Self {
        let sum = tension + compression;
        Self::new(
            2.0 * tension * compression / sum,
            (compression - tension) / sum,
        )
    }
}

impl Strength for DruckerPrager {
    fn name(&self) -> &'static str {
        "Drucker–Prager"
    }
    fn source(&self) -> &'static str {
        "Drucker & Prager 1952"
    }
    #[inline(always)]
    fn yield_stress<L: Lane>(&self, state: &PlasticState<L>) -> L {
        let cohesion = L::of(self.cohesion);
        let yields = L::of(3.0 * self.slope).fused(state.pressure, cohesion);
        yields.positive_part()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .not_negative("cohesion", self.cohesion)
            .must(
                (0.0..1.0).contains(&self.slope),
                "slope",
                self.slope,
                "at least 0 and below 1; the yield stress in tension is at most that in compression",
            )
            .list()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In simple tension p = −σ/3, in simple compression p = σ/3.
    #[test]
    fn it_yields_at_both_values() {
        let law = DruckerPrager::from_yield_stresses(49e6, 91e6);
        let at = |pressure| {
            law.yield_stress(&PlasticState {
                pressure,
                ..PlasticState::default()
            })
        };
        assert!((at(-49e6 / 3.0) / 49e6 - 1.0).abs() < 1e-14);
        assert!((at(91e6 / 3.0) / 91e6 - 1.0).abs() < 1e-14);
        assert_eq!(at(-1e9), 0.0);
        let wrong = DruckerPrager::from_yield_stresses(91e6, 49e6).problems();
        assert_eq!(wrong[0].0, "slope");
    }
}
