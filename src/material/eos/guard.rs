//! What the laws share: the floor of the sound speed and the checks of parameters.
//! Nothing here is public; the laws state in their own pages what they guard.

use crate::scalar::Lane;

/// The sound speed never falls below this fraction of its value at rest.
pub(super) const SPEED_FLOOR: f64 = 0.01;
/// The least ρ/ρ₀ that a division by density sees.
pub(super) const LEAST_RATIO: f64 = 1e-6;

/// √c², held at a hundredth of `speed_at_rest`, and where it was held.
#[inline(always)]
pub(super) fn speed<L: Lane>(squared: L, speed_at_rest: f64) -> (L, L::Mask) {
    let floor = L::of(SPEED_FLOOR * speed_at_rest);
    let held = !squared.ge(floor * floor);
    (L::select(held, floor, squared.sqrt()), held)
}

/// η = (ρ − ρ₀)/ρ₀ by the difference first: near ρ₀ it is exact, where ρ/ρ₀ − 1 loses all digits
/// of a small compression in `f32`.
#[inline(always)]
pub(super) fn compression<L: Lane>(density: L, reference_density: f64) -> L {
    (density - L::of(reference_density)) * L::of(1.0 / reference_density)
}

/// Collects what is wrong with parameters.
#[derive(Default)]
pub(in crate::material) struct Problems(Vec<(&'static str, f64, &'static str)>);

impl Problems {
    /// The value must be finite and above zero.
    pub(in crate::material) fn positive(self, field: &'static str, value: f64) -> Self {
        let fine = value.is_finite() && value > 0.0;
        self.must(fine, field, value, "positive and finite")
    }
    /// The value must be finite and zero or more.
    pub(in crate::material) fn not_negative(self, field: &'static str, value: f64) -> Self {
        let fine = value.is_finite() && value >= 0.0;
        self.must(fine, field, value, "finite and not negative")
    }
    /// The value must be finite.
    pub(in crate::material) fn finite(self, field: &'static str, value: f64) -> Self {
        self.must(value.is_finite(), field, value, "finite")
    }
    /// The condition must hold.
    pub(in crate::material) fn must(
        mut self,
        fine: bool,
        field: &'static str,
        value: f64,
        what: &'static str,
    ) -> Self {
        if !fine {
            self.0.push((field, value, what));
        }
        self
    }
    /// All that was found.
    pub(in crate::material) fn list(self) -> Vec<(&'static str, f64, &'static str)> {
        self.0
    }
}
