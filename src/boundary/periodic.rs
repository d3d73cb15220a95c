//! Periodic directions: what leaves on one side enters on the other.
//! Images shifted by the period close the domain on itself.

use super::Boundary;
use crate::geometry::SWAPPED;
use crate::sweep::Transform;
use crate::tensor::Vector;
use std::sync::Arc;

/// Periodicity along one axis, from `low` to `high` \[m\].
#[derive(Clone, Debug, PartialEq)]
pub struct Periodic {
    axis: usize,
    low: f64,
    high: f64,
}

impl Periodic {
    /// Periodic along `axis` (0 is x) between `low` and `high` \[m\].
    #[must_use]
    pub fn along(axis: usize, low: f64, high: f64) -> Self {
        Self { axis, low, high }
    }

    /// The same for places that are counted from an origin \[m\].
    pub(super) fn counted_from<const D: usize>(&self, origin: &[f64; D]) -> Self {
        // An axis that the dimension does not have is refused elsewhere.
        let origin = origin.get(self.axis).copied().unwrap_or(0.0);
        Self {
            low: self.low - origin,
            high: self.high - origin,
            ..*self
        }
    }

    /// Its axis.
    pub(super) fn axis(&self) -> usize {
        self.axis
    }

    /// Its length \[m\].
    pub(super) fn length(&self) -> f64 {
        self.high - self.low
    }

    /// How many periods on a coordinate \[m\] is; zero inside.
    pub(super) fn periods(&self, x: f64) -> f64 {
        ((x - self.low) / self.length()).floor()
    }

    /// Whether a coordinate \[m\] is within `reach` \[m\] of the period.
    pub(super) fn nears(&self, x: f64, reach: f64) -> bool {
        self.low - reach < x && x < self.high + reach
    }

    fn shift<const D: usize>(&self, periods: f64) -> Transform<f64, D> {
        let period = periods * self.length();
        let component = |d: usize| if d == self.axis { period } else { 0.0 };
        Transform {
            shift: Vector::from_fn(|d, _| component(d)),
            ..Transform::identity()
        }
    }
}

impl<const D: usize> Boundary<D> for Periodic {
    fn name(&self) -> String {
        format!("period along axis {}", self.axis)
    }
    fn images(&self) -> usize {
        2
    }
    fn transform(&self, image: usize, _time: f64) -> Transform<f64, D> {
        self.shift(if image == 0 { 1.0 } else { -1.0 })
    }
    fn reaches(&self, image: usize, x: &[f64; D], reach: f64, _time: f64) -> bool {
        let x = x[self.axis];
        if image == 0 {
            x < self.low + reach
        } else {
            x > self.high - reach
        }
    }
    fn wrap(&self, x: &[f64; D], _time: f64) -> Option<Transform<f64, D>> {
        let periods = self.periods(x[self.axis]);
        // NaN and points inside both stay where they are.
        (periods != 0.0 && periods.is_finite()).then(|| self.shift(-periods))
    }
    fn seen_from(&self, origin: &[f64; D]) -> Option<Arc<dyn Boundary<D>>> {
        Some(Arc::new(self.counted_from(origin)))
    }
    fn problems(&self, reach: f64) -> Vec<(&'static str, f64, &'static str)> {
        let period = self.length();
        if self.axis >= D {
            return vec![("axis", self.axis as f64, "must be below the dimension")];
        }
        if period.is_finite() && period >= 2.0 * reach {
            return Vec::new();
        }
        let must_be = if period < 0.0 && period.is_finite() {
            SWAPPED
        } else {
            "must be finite and at least twice the kernel's reach: enlarge the domain or refine"
        };
        vec![("period", period, must_be)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_leaves_re_enters() {
        let period = Periodic::along(1, -1.0, 1.0);
        let back: Transform<f64, 2> = period.wrap(&[0.3, 1.25], 0.0).unwrap();
        assert_eq!(back.point(&[0.3, 1.25]), [0.3, -0.75]);
        assert!(Boundary::<2>::wrap(&period, &[5.0, 0.5], 0.0).is_none());
    }
}
