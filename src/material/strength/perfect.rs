//! Perfect plasticity: a yield stress that nothing changes.
//! Y = Y₀.

use super::{PlasticState, Strength};
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// Perfect plasticity with the condition of von Mises (1913).
///
/// ```text
/// Y = Y₀
/// ```
///
/// What a material with a [`yield_stress`](crate::material::Material::yield_stress) alone has.
///
/// ```
/// use meshfree::material::strength::{PerfectPlasticity, PlasticState, Strength};
/// // PMMA of the rod impacts (Lam, Shen & Gong 2002, table 2).
/// let pmma = PerfectPlasticity::new(70e6);
/// assert_eq!(pmma.yield_stress(&PlasticState::default()), 70e6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct PerfectPlasticity {
    /// Yield stress Y₀ \[Pa\] in simple tension.
    pub yield_stress: f64,
}

impl PerfectPlasticity {
    /// Y₀ \[Pa\].
    #[must_use]
    pub const fn new(yield_stress: f64) -> Self {
        Self { yield_stress }
    }
}

impl Strength for PerfectPlasticity {
    fn name(&self) -> &'static str {
        "perfect plasticity"
    }
    fn source(&self) -> &'static str {
        "von Mises 1913"
    }
    #[inline(always)]
    fn yield_stress<L: Lane>(&self, _state: &PlasticState<L>) -> L {
        L::of(self.yield_stress)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .not_negative("yield_stress", self.yield_stress)
            .list()
    }
}
