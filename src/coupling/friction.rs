//! Friction of Coulomb between pairs that press: it holds below μ F_n, and slides at that.
//! Sticking is a tangential spring that remembers where it was relaxed, after Cundall & Strack 1979.

use super::PairForce;
use crate::scalar::Real;

/// Coulomb friction of a pair with sticking by a spring.
///
/// F_t = −k_t u,  |F_t| ≤ μ F_n
///
/// with F_n \[N\] the normal force of the pair, k_t \[N/m\] its tangential stiffness and u \[m\] its elastic slip, the
/// tangential way since it last slid. What slips beyond slides. Heat is that way times the mean of F_t at the evaluations
/// before and after it, as work is booked, so that work, heat and stored energy balance to second order in the step. The
/// stiffness does not depend on the normal force: a sticking contact whose spring did would gain energy as it vibrates.
///
/// A pair remembers its anchor, the place in which the spring is relaxed (Cundall & Strack 1979, Géotechnique 29, 47).
/// Static friction therefore holds without creep, and evaluating a state twice changes nothing. The anchor does not turn
/// with bodies that roll. What presses no more forgets it.
///
/// The forces on both particles are opposite but not central: what they change of angular momentum is F_t times the
/// distance of the particles, about a spacing. Two bodies that roll on each other exchange energy with nothing by that; a wall
/// that turns does not, since it works at the place of the body's particle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Coulomb {
    /// Coefficient of friction μ.
    pub mu: f64,
}

/// What a pair that presses remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor<T, const D: usize> {
    /// Where the spring is relaxed \[m\].
    pub place: [T; D],
    /// F_t \[N\] on the first particle at the last evaluation.
    pub force: [T; D],
}

/// A pair that presses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch<T, const D: usize> {
    /// From the second particle to the first \[m\].
    pub apart: [T; D],
    /// The unit normal of the contact, towards the first.
    pub normal: [T; D],
    /// Normal force F_n \[N\], positive in compression.
    pub pressing: T,
    /// Tangential stiffness k_t \[N/m\].
    pub stiffness: T,
    /// What the last evaluation has left.
    pub anchor: Option<Anchor<T, D>>,
}

impl Coulomb {
    /// The friction of a pair that presses, with its anchor; heat is that of what has slid since the last evaluation.
    pub fn act<T: Real, const D: usize>(&self, touch: &Touch<T, D>) -> PairForce<T, D> {
        let (x, n) = (touch.apart, touch.normal);
        let Some(before) = touch.anchor else {
            return PairForce {
                anchor: Some(Anchor {
                    place: x,
                    force: [T::zero(); D],
                }),
                ..PairForce::of([T::zero(); D])
            };
        };
        let along = (0..D).fold(T::zero(), |sum, d| sum + (x[d] - before.place[d]) * n[d]);
        let slip: [T; D] = core::array::from_fn(|d| x[d] - before.place[d] - along * n[d]);
        let size = slip.iter().fold(T::zero(), |sum, u| sum + *u * *u).sqrt();
        let limit = T::from_f64(self.mu) * touch.pressing;
        let slides = touch.stiffness * size > limit;
        let kept = if slides {
            limit / (touch.stiffness * size)
        } else {
            T::one()
        };
        let elastic = slip.map(|u| u * kept);
        let force = elastic.map(|u| -touch.stiffness * u);
        let heat = (0..D).fold(0.0, |sum, d| {
            sum - 0.5 * (before.force[d] + force[d]).to_f64() * (slip[d] - elastic[d]).to_f64()
        });
        let size = (size * kept).to_f64();
        PairForce {
            force,
            stored: 0.5 * touch.stiffness.to_f64() * size * size,
            heat: if slides { heat.max(0.0) } else { 0.0 },
            anchor: Some(Anchor {
                place: core::array::from_fn(|d| x[d] - elastic[d]),
                force,
            }),
        }
    }

    /// What is wrong with it.
    pub(super) fn problems(friction: Option<Self>) -> Vec<(&'static str, f64, &'static str)> {
        let wrong = friction.filter(|own| !(own.mu.is_finite() && own.mu >= 0.0));
        let wrong = wrong.map(|own| {
            let must_be = "it must be finite and not negative";
            ("coefficient of friction", own.mu, must_be)
        });
        wrong.into_iter().collect()
    }
}
