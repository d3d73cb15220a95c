//! The quartic B-spline M5: between the cubic and the quintic in smoothness and in cost.
//! f(q) = (5/2−q)₊⁴ − 5(3/2−q)₊⁴ + 10(1/2−q)₊⁴, support 5/2 h.

use super::family;
use crate::scalar::Lane;

/// The quartic B-spline M5.
///
#[doc = include_str!("../../docs/equations/quartic_spline.html")]
///
/// Source: Schoenberg (1946); constants as in Price (2012).
///
/// Use it where the noise of the cubic spline shows, as in hypervelocity impact: its second
/// derivative is smooth, at twice the neighbours (113 in 3D at h/dx = 1.2). In 1D at h/dx = 1 and 2
/// the sum over a uniform lattice is exactly one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct QuarticSpline;

family! {
    QuarticSpline, "quartic spline", support 2.5;
    1 => { normalisation: 1.0 / 24.0, h_over_dx: 1.2, range: (1.0, 2.0), stable_step: 1.45 };
    2 => { normalisation: 96.0 / (1199.0 * PI), h_over_dx: 1.2, range: (1.0, 1.5), stable_step: 1.42 };
    3 => { normalisation: 1.0 / (20.0 * PI), h_over_dx: 1.2, range: (1.0, 1.5), stable_step: 1.38 };
}

#[inline(always)]
fn shape<L: Lane>(q: L) -> L {
    let a = (L::of(2.5) - q).positive_part();
    let b = (L::of(1.5) - q).positive_part();
    let c = (L::of(0.5) - q).positive_part();
    let (a, b, c) = (a * a, b * b, c * c);
    (c * c).mul_add(L::of(10.0), (b * b).mul_add(L::of(-5.0), a * a))
}

/// f′/q is 24q² − 30 for q < 1/2. With u = max(q, 1/2) and c = (1/2−q)₊ all pieces are
/// (−4(5/2−u)₊³ + 20(3/2−u)₊³)/u + 24c(c−1): no cancellation near q = 0 and no branch.
#[inline(always)]
fn slope_over_q<L: Lane>(q: L) -> L {
    let u = q.max(L::of(0.5));
    let a = (L::of(2.5) - u).positive_part();
    let b = (L::of(1.5) - u).positive_part();
    let c = (L::of(0.5) - q).positive_part();
    let outer = (b * b).mul_add(b * L::of(20.0), a * a * a * L::of(-4.0)) / u;
    (c * L::of(24.0)).mul_add(c - L::one(), outer)
}
