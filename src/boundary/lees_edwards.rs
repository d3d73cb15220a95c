//! Lees–Edwards boundaries: homogeneous shear of a liquid or a solid without walls.
//! Periodic along the flow, and across it with copies that slide past each other.

use super::{Boundary, Periodic};
use crate::sweep::Transform;
use crate::tensor::Vector;
use std::sync::Arc;

/// Periods of a homogeneous shear flow (Lees & Edwards 1972, J. Phys. C 5, 1921).
///
#[doc = include_str!("../../docs/equations/lees_edwards.html")]
///
/// x is along the flow, y along the gradient of its velocity, L \[m\] are the periods and γ̇ \[1/s\] the shear rate.
/// The copy m periods up the gradient, and n along the flow, has slid by m U t since the start and is faster by m U.
/// What leaves up the gradient becomes its copy a period below: it enters behind by U t, and slower by U.
/// So no place differs from another, and the linear profile v = γ̇ y eₓ, which bodies should start with, stays as it is.
///
/// The slide is taken within half a period of the flow; that makes both directions one boundary, in which no
/// order can be wrong. A third direction is a [`Periodic`] of its own. The momentum that the jumps give is in
/// the [ledger](crate::simulation::Ledger::boundary_impulse); the work that drives the flow is not in the
/// [energy ledger](crate::simulation::EnergyLedger), which shows less dissipated by as much.
///
/// Every list of neighbours outdates as copies slide by the skin: a fast shear costs a list every few steps.
///
/// ```
/// use meshfree::prelude::*;
/// use meshfree::scene::Start;
/// let (rate, dx) = (2.0, 1.0 / 16.0);
/// let unit = |axis| Periodic::along(axis, 0.0, 1.0);
/// let shear = LeesEdwards::new(unit(0), unit(1), rate);
/// // What leaves at the top after 0.1 s was as fast as the top, and enters at the bottom as fast as that.
/// let back = Boundary::<2>::wrap(&shear, &[0.5, 1.25], 0.1).expect("it has left");
/// let [x, y] = back.point(&[0.5, 1.25]);
/// assert!((x - 0.3).abs() < 1e-15 && (y, back.velocity[0]) == (0.25, -2.0));
///
/// let liquid = catalogue::weakly_compressible_water(2.0);
/// let body = Body::block("liquid", liquid, [0.0; 2], [1.0; 2], dx);
/// let scene = Scene::<f64, 2>::new(schemes::weakly_compressible())
///     .body(body.start(|x, start| Start { velocity: [rate * x[1], 0.0], ..start }))
///     .boundary(shear);
/// assert!(scene.problems().is_empty());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LeesEdwards {
    flow: Periodic,
    gradient: Periodic,
    shear_rate: f64,
}

/// Periods up the gradient and along the flow of each copy. A slide of half a period needs no farther ones.
const COPIES: [[f64; 2]; 8] = [
    [0.0, 1.0],
    [0.0, -1.0],
    [1.0, 0.0],
    [-1.0, 0.0],
    [1.0, 1.0],
    [1.0, -1.0],
    [-1.0, 1.0],
    [-1.0, -1.0],
];

impl LeesEdwards {
    /// The periods along the flow and along the gradient of its velocity, and the shear rate \[1/s\]: positive
    /// where velocity grows along the axis of the gradient.
    #[must_use]
    pub fn new(flow: Periodic, gradient: Periodic, shear_rate: f64) -> Self {
        Self {
            flow,
            gradient,
            shear_rate,
        }
    }

    /// How much faster the copy a period up the gradient is \[m/s\].
    fn speed(&self) -> f64 {
        self.shear_rate * self.gradient.length()
    }

    /// How far that copy has slid at `time` \[s\], less whole periods of the flow \[m\].
    fn slide(&self, time: f64) -> f64 {
        let (slide, period) = (self.speed() * time, self.flow.length());
        slide - period * (slide / period).round()
    }

    /// The transform to a copy some periods up the gradient and along the flow.
    fn copy<const D: usize>(&self, [up, along]: [f64; 2], time: f64) -> Transform<f64, D> {
        let shift = |d: usize| {
            if d == self.flow.axis() {
                up * self.slide(time) + along * self.flow.length()
            } else if d == self.gradient.axis() {
                up * self.gradient.length()
            } else {
                0.0
            }
        };
        let velocity = |d: usize| {
            if d == self.flow.axis() {
                up * self.speed()
            } else {
                0.0
            }
        };
        Transform {
            shift: Vector::from_fn(|d, _| shift(d)),
            velocity: Vector::from_fn(|d, _| velocity(d)),
            ..Transform::identity()
        }
    }
}

impl<const D: usize> Boundary<D> for LeesEdwards {
    fn name(&self) -> String {
        let [flow, gradient] = [&self.flow, &self.gradient].map(Periodic::axis);
        format!("sheared period along axes {flow} and {gradient}")
    }
    fn images(&self) -> usize {
        COPIES.len()
    }
    fn transform(&self, image: usize, time: f64) -> Transform<f64, D> {
        self.copy(COPIES[image], time)
    }
    fn reaches(&self, image: usize, x: &[f64; D], reach: f64, time: f64) -> bool {
        let [up, along] = COPIES[image];
        let [x, y] = [&self.flow, &self.gradient].map(|own| x[own.axis()]);
        let y = y + up * self.gradient.length();
        let x = x + up * self.slide(time) + along * self.flow.length();
        self.gradient.nears(y, reach) && self.flow.nears(x, reach)
    }
    fn moves(&self) -> bool {
        self.shear_rate != 0.0
    }
    fn wrap(&self, x: &[f64; D], time: f64) -> Option<Transform<f64, D>> {
        let [x, y] = [&self.flow, &self.gradient].map(|own| x[own.axis()]);
        let up = -self.gradient.periods(y);
        let along = -self.flow.periods(x + up * self.slide(time));
        // NaN and points inside both stay where they are.
        let left = up != 0.0 || along != 0.0;
        (left && up.is_finite() && along.is_finite()).then(|| self.copy([up, along], time))
    }
    fn seen_from(&self, origin: &[f64; D]) -> Option<Arc<dyn Boundary<D>>> {
        let [flow, gradient] = [&self.flow, &self.gradient].map(|own| own.counted_from(origin));
        Some(Arc::new(Self::new(flow, gradient, self.shear_rate)))
    }
    fn problems(&self, reach: f64) -> Vec<(&'static str, f64, &'static str)> {
        let of = |own: &Periodic, names: [&'static str; 2]| {
            let problems = Boundary::<D>::problems(own, reach).into_iter();
            let named = move |(what, value, must_be)| {
                (names[usize::from(what == "period")], value, must_be)
            };
            problems.map(named).collect::<Vec<_>>()
        };
        let mut problems = of(&self.flow, ["axis of the flow", "period of the flow"]);
        problems.extend(of(
            &self.gradient,
            ["axis of the gradient", "period of the gradient"],
        ));
        if self.flow.axis() == self.gradient.axis() {
            problems.push((
                "axis of the gradient",
                self.gradient.axis() as f64,
                "must differ from that of the flow",
            ));
        }
        if !self.shear_rate.is_finite() {
            problems.push(("shear rate", self.shear_rate, "must be finite, in 1/s"));
        }
        problems
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REACH: f64 = 0.2;

    /// 2 m along the flow (y), 1 m along the gradient (x), 0.5 m/s from copy to copy.
    fn shear() -> LeesEdwards {
        let flow = Periodic::along(1, -1.0, 1.0);
        LeesEdwards::new(flow, Periodic::along(0, 0.0, 1.0), 0.5)
    }

    #[test]
    fn what_leaves_enters_where_its_copy_is_and_as_fast() {
        // At 7 s copies have slid by 3.5 m: 0.5 m behind two periods.
        let through: Transform<f64, 2> = shear().wrap(&[1.125, 0.25], 7.0).unwrap();
        assert_eq!(through.point(&[1.125, 0.25]), [0.125, 0.75]);
        assert_eq!(through.velocity, Vector::<f64, 2>::new(0.0, -0.5));
        // Two periods down at once, and out along the flow by the slide.
        let through: Transform<f64, 2> = shear().wrap(&[-1.5, -0.25], 7.0).unwrap();
        assert_eq!(through.point(&[-1.5, -0.25]), [0.5, 0.75]);
        assert_eq!(through.velocity, Vector::<f64, 2>::new(0.0, 1.0));
        // Along the flow nothing is given, and inside nothing is moved.
        let through: Transform<f64, 2> = shear().wrap(&[0.5, 1.25], 7.0).unwrap();
        assert_eq!(through.point(&[0.5, 1.25]), [0.5, -0.75]);
        assert!(!through.turns());
        assert!(Boundary::<2>::wrap(&shear(), &[0.5, 0.5], 7.0).is_none());
        assert!(Boundary::<2>::wrap(&shear(), &[f64::NAN, 0.5], 7.0).is_none());
    }

    /// Every point around the domain is the image of just one point in it, at any slide.
    #[test]
    fn copies_fill_all_within_reach() {
        for time in [0.0, 0.3, 1.9, 2.0, 3.7, 4.1, 1e6 + 0.2] {
            for (x, y) in (-2..12).flat_map(|a| (-12..12).map(move |b| (a, b))) {
                let around = [f64::from(x) * 0.1 + 0.05, f64::from(y) * 0.1 + 0.05];
                let inside = (0..10).contains(&x) && (-10..10).contains(&y);
                let Some(home) = Boundary::<2>::wrap(&shear(), &around, time) else {
                    assert!(inside);
                    continue;
                };
                let home = home.point(&around);
                let images = (0..COPIES.len())
                    .filter(|&k| Boundary::<2>::reaches(&shear(), k, &home, REACH, time))
                    .map(|k| Boundary::<2>::transform(&shear(), k, time).point(&home));
                let near = |image: &[f64; 2]| (0..2).all(|d| (image[d] - around[d]).abs() < 1e-9);
                assert_eq!(images.filter(near).count(), 1, "{around:?} at {time} s");
            }
        }
    }

    #[test]
    fn what_is_wrong_is_named() {
        let period = |axis, high| Periodic::along(axis, 0.0, high);
        let names = |shear: LeesEdwards| -> Vec<&str> {
            let problems = Boundary::<2>::problems(&shear, REACH);
            problems.iter().map(|problem| problem.0).collect()
        };
        let wrong = LeesEdwards::new(period(0, 0.3), period(2, 1.0), f64::NAN);
        let expected = ["period of the flow", "axis of the gradient", "shear rate"];
        assert_eq!(names(wrong), expected);
        let same = LeesEdwards::new(period(0, 1.0), period(0, 1.0), 1.0);
        assert_eq!(names(same), ["axis of the gradient"]);
        assert!(names(shear()).is_empty());
    }
}
