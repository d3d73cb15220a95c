//! Outlets: where particles leave the simulation, and what they must do to be taken out.
//! What leaves is counted, with its mass and momentum.

use crate::geometry::SWAPPED;
use crate::origin::local;

/// A reason to take particles out.
///
/// They leave when neighbour lists are next made, so put a plane a support behind the place where the
/// flow is looked at.
///
/// ```
/// use meshfree::boundary::Outlet;
/// let end = Outlet::plane([1.0, 0.0], [1.0, 0.0]);
/// assert!(end.takes(&[1.1, 5.0], &[0.0, 0.0]) && !end.takes(&[0.9, 5.0], &[0.0, 0.0]));
/// assert!(Outlet::faster_than(10.0).takes(&[0.0], &[-11.0]));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Outlet<const D: usize>(Reason<D>);

#[derive(Clone, Debug, PartialEq)]
enum Reason<const D: usize> {
    Beyond { point: [f64; D], normal: [f64; D] },
    Outside { low: [f64; D], high: [f64; D] },
    Faster { speed: f64 },
}

impl<const D: usize> Outlet<D> {
    /// Beyond the plane through `point` \[m\]; `normal` points to where particles leave.
    #[must_use]
    pub fn plane(point: [f64; D], normal: [f64; D]) -> Self {
        Self(Reason::Beyond { point, normal })
    }

    /// Outside of the box from `low` to `high` \[m\]: the box in which a simulation is active.
    #[must_use]
    pub fn outside_box(low: [f64; D], high: [f64; D]) -> Self {
        Self(Reason::Outside { low, high })
    }

    /// Faster than `speed` \[m/s\]: particles that a run can do without, as LS-DYNA's MAXV.
    #[must_use]
    pub fn faster_than(speed: f64) -> Self {
        Self(Reason::Faster { speed })
    }

    /// Whether a particle at `x` \[m\] with velocity `v` \[m/s\] leaves.
    #[must_use]
    pub fn takes(&self, x: &[f64; D], v: &[f64; D]) -> bool {
        match &self.0 {
            Reason::Beyond { point, normal } => {
                let height: f64 = (0..D).map(|d| (x[d] - point[d]) * normal[d]).sum();
                height > 0.0
            }
            Reason::Outside { low, high } => (0..D).any(|d| x[d] < low[d] || x[d] > high[d]),
            Reason::Faster { speed } => v.iter().map(|v| v * v).sum::<f64>() > speed * speed,
        }
    }

    /// The same for places that are counted from an origin \[m\].
    pub(crate) fn seen_from(&self, origin: &[f64; D]) -> Self {
        Self(match &self.0 {
            Reason::Beyond { point, normal } => Reason::Beyond {
                point: local(point, origin),
                normal: *normal,
            },
            Reason::Outside { low, high } => Reason::Outside {
                low: local(low, origin),
                high: local(high, origin),
            },
            Reason::Faster { speed } => Reason::Faster { speed: *speed },
        })
    }

    /// What is wrong with it, as `(what, value, what it must be)`.
    pub(crate) fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let finite = |values: &[f64]| values.iter().copied().find(|x| !x.is_finite());
        match &self.0 {
            Reason::Beyond { point, normal } => {
                let bad = finite(point).or(finite(normal));
                let bad = bad.or((normal.iter().all(|&n| n == 0.0)).then_some(0.0));
                bad.map(|bad| {
                    (
                        "plane",
                        bad,
                        "point and normal must be finite, the normal not zero",
                    )
                })
            }
            Reason::Outside { low, high } => (0..D)
                .map(|d| high[d] - low[d])
                .find(|size| size.is_nan() || *size <= 0.0)
                .map(|size| {
                    (
                        "size",
                        size,
                        if size < 0.0 {
                            SWAPPED
                        } else {
                            "the box must have a positive size along every axis"
                        },
                    )
                }),
            Reason::Faster { speed } => (speed.is_nan() || *speed <= 0.0).then_some((
                "speed",
                *speed,
                "must be positive, in m/s",
            )),
        }
        .into_iter()
        .collect()
    }
}
