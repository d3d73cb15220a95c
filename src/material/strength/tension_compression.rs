//! A pair of yield stresses, in tension and in compression, for polymers.
//! Y_t at negative pressure, Y_c at positive, and a smooth passage between.

use super::{PlasticState, Strength};
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// Two yield stresses by the sign of pressure, as polymers have them in hydrocodes (LS-DYNA's material 124).
///
/// ```text
/// Y = ½ (Y_c + Y_t) + ½ (Y_c − Y_t) s(p/p₀),   s(x) = x (3 − x²)/2 within ±1, and ±1 beyond
/// ```
///
/// Without the passage of half width p₀ the yield stress would jump where the pressure of a wave passes zero. Half a
/// tenth of the mean yield stress, which is the default, lies well within the pressures Y_t/3 and Y_c/3 of the tests.
///
/// ```
/// use meshfree::material::strength::{PlasticState, Strength, TensionCompression};
/// // FullCure M730 (Vesenjak & Ren 2007).
/// let law = TensionCompression::new(49e6, 91e6);
/// let at = |pressure| law.yield_stress(&PlasticState { pressure, ..PlasticState::default() });
/// assert_eq!([at(-10e6), at(0.0), at(10e6)], [49e6, 70e6, 91e6]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct TensionCompression {
    /// Yield stress Y_t \[Pa\] in simple tension.
    pub tension: f64,
    /// Yield stress Y_c \[Pa\] in simple compression.
    pub compression: f64,
    /// Half width p₀ \[Pa\] of the passage.
    pub passage: f64,
}

impl TensionCompression {
    /// Y_t and Y_c \[Pa\], both positive.
    #[must_use]
    pub const fn new(tension: f64, compression: f64) -> Self {
        Self {
            tension,
            compression,
            passage: 0.025 * (tension + compression),
        }
    }
    /// With another half width p₀ \[Pa\].
    #[must_use]
    pub const fn with_passage(mut self, passage: f64) -> Self {
        self.passage = passage;
        self
    }
}

impl Strength for TensionCompression {
    fn name(&self) -> &'static str {
        "tension and compression"
    }
    fn source(&self) -> &'static str {
        "the two curves of LS-DYNA's material 124, with a smooth passage"
    }
    #[inline(always)]
    fn yield_stress<L: Lane>(&self, state: &PlasticState<L>) -> L {
        let x = (state.pressure / L::of(self.passage)).max(-L::one());
        let x = x.min(L::one());
        let smooth = L::of(0.5) * x * (L::of(3.0) - x * x);
        let [mean, half] =
            [1.0, -1.0].map(|sign: f64| 0.5 * sign.mul_add(self.tension, self.compression));
        L::of(half).fused(smooth, L::of(mean))
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .not_negative("tension", self.tension)
            .not_negative("compression", self.compression)
            .positive("passage", self.passage)
            .list()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_passes_smoothly_from_one_to_the_other() {
        let law = TensionCompression::new(49e6, 91e6).with_passage(1e6);
        let at = |pressure| {
            law.yield_stress(&PlasticState {
                pressure,
                ..PlasticState::default()
            })
        };
        // s(½) = 11/16.
        assert!((at(0.5e6) / (70e6 + 21e6 * 0.6875) - 1.0).abs() < 1e-15);
        // No kink at the ends, and monotone.
        assert!(at(1e6) - at(0.999e6) < 100.0);
        let mut last = 0.0;
        for k in -120..=120 {
            let value = at(1e4 * f64::from(k));
            assert!(value >= last);
            last = value;
        }
        assert_eq!([at(-2e6), at(2e6)], [49e6, 91e6]);
        let problems = law.with_passage(0.0).problems();
        assert_eq!(problems[0].0, "passage");
    }
}
