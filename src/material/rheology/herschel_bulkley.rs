//! The law of Herschel and Bulkley for liquids with a yield stress, in Papanastasiou's smooth form.
//! μ(γ̇) = K γ̇ⁿ⁻¹ + τ_y (1 − e^(−mγ̇)) / γ̇.

use super::{ViscosityLaw, at_most};
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// The law of Herschel & Bulkley (1926), regularised by Papanastasiou (1987), with n = 1 the
/// law of Bingham (1922).
///
/// ```text
/// μ(γ̇) = min(K γ̇ⁿ⁻¹ + τ_y (1 − e^(−mγ̇)) / γ̇, μ_greatest)
/// ```
///
/// Below the yield stress τ_y \[Pa\] the plain law is rigid; here it is a liquid of viscosity
/// K + m τ_y if n = 1, so what should stand creeps at γ̇ ≈ τ/(m τ_y). The stress is the plain one, to
/// e^(−mγ̇), where γ̇ ≫ 1/m. Choose 1/m as a hundredth of the shear rates that matter; a larger m costs
/// smaller viscous steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct HerschelBulkley {
    /// Yield stress τ_y \[Pa\]; zero gives a power law.
    pub yield_stress: f64,
    /// Consistency K \[Pa sⁿ\]; with n = 1 the plastic viscosity \[Pa s\].
    pub consistency: f64,
    /// Index n \[1\].
    pub index: f64,
    /// Time m \[s\] of the regularisation.
    pub time: f64,
    /// Greatest viscosity \[Pa s\]. It bounds K γ̇ⁿ⁻¹, which is infinite at rest if n < 1, and sets the
    /// viscous time step.
    pub greatest: f64,
}

impl HerschelBulkley {
    /// τ_y \[Pa\], K \[Pa sⁿ\], n \[1\] and m \[s\]. The greatest viscosity is that at γ̇ = 1/m of the
    /// power law plus m τ_y, K m¹⁻ⁿ + m τ_y. For n = 1 the law never exceeds it, for n < 1 only below
    /// γ̇ = 1/m; one that thickens (n > 1) needs [another](Self::with_greatest).
    #[must_use]
    pub fn new(yield_stress: f64, consistency: f64, index: f64, time: f64) -> Self {
        Self {
            yield_stress,
            consistency,
            index,
            time,
            greatest: consistency * Lane::powf(time, 1.0 - index) + time * yield_stress,
        }
    }

    /// Bingham's law: τ_y \[Pa\], the plastic viscosity \[Pa s\] and m \[s\].
    #[must_use]
    pub fn bingham(yield_stress: f64, plastic_viscosity: f64, time: f64) -> Self {
        Self::new(yield_stress, plastic_viscosity, 1.0, time)
    }

    /// The same with another greatest viscosity \[Pa s\].
    #[must_use]
    pub const fn with_greatest(mut self, greatest: f64) -> Self {
        self.greatest = greatest;
        self
    }
}

impl ViscosityLaw for HerschelBulkley {
    fn name(&self) -> &'static str {
        if self.index == 1.0 {
            "Bingham"
        } else {
            "Herschel-Bulkley"
        }
    }
    #[inline(always)]
    fn viscosity<L: Lane>(&self, shear_rate: L) -> L {
        let power = L::of(self.consistency) * shear_rate.powf(self.index - 1.0);
        // (1 − e⁻ˣ)/x, near rest with the logarithm of the rounded exponential in place of x (Kahan, by Higham 2002, sect. 1.14.1).
        let x = shear_rate * L::of(self.time);
        let decayed = (-x).exp();
        let beyond = x.gt(L::one());
        let over = L::select(beyond, -x, L::select(beyond, L::one(), decayed).ln());
        let even = decayed.ge(L::one()) & decayed.le(L::one());
        let share = L::select(even, L::one(), (decayed - L::one()) / over);
        let plain = share.mul_add(L::of(self.yield_stress * self.time), power);
        at_most(plain, self.greatest)
    }
    fn greatest_viscosity(&self) -> f64 {
        self.greatest
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .not_negative("yield_stress", self.yield_stress)
            .positive("consistency", self.consistency)
            .must(
                self.index > 0.0 && self.index <= 5.0,
                "index",
                self.index,
                "above 0 and at most 5",
            )
            .positive("time", self.time)
            .positive("greatest", self.greatest)
            .list()
    }
}
