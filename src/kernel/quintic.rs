//! The quintic B-spline M6: the smoothest of the three splines, for waves and viscous flow.
//! f(q) = (3−q)₊⁵ − 6(2−q)₊⁵ + 15(1−q)₊⁵, support 3h.

use super::family;
use crate::scalar::Lane;

/// The quintic B-spline M6.
///
#[doc = include_str!("../../docs/equations/quintic_spline.html")]
///
/// Source: Schoenberg (1946); Morris, Fox & Zhu (1997) brought it to viscous flow.
///
/// Use it where dispersion matters: Taylor–Green vortices, waves, low noise at small Reynolds
/// number. It costs about three times the cubic (195 neighbours in 3D at h/dx = 1.2). In 1D at
/// h/dx = 1 and 2 the sum over a uniform lattice is exactly one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct QuinticSpline;

family! {
    QuinticSpline, "quintic spline", support 3.0;
    1 => { normalisation: 1.0 / 120.0, h_over_dx: 1.2, range: (1.0, 2.0), stable_step: 1.57 };
    2 => { normalisation: 7.0 / (478.0 * PI), h_over_dx: 1.2, range: (1.0, 1.5), stable_step: 1.54 };
    3 => { normalisation: 1.0 / (120.0 * PI), h_over_dx: 1.2, range: (1.0, 1.5), stable_step: 1.51 };
}

#[inline(always)]
fn shape<L: Lane>(q: L) -> L {
    let a = (L::of(3.0) - q).positive_part();
    let b = (L::of(2.0) - q).positive_part();
    let c = (L::one() - q).positive_part();
    let (a2, b2, c2) = (a * a, b * b, c * c);
    (c2 * c2).mul_add(
        c * L::of(15.0),
        (b2 * b2).mul_add(b * L::of(-6.0), a2 * a2 * a),
    )
}

/// f′/q is −120 + 120q² − 50q³ for q < 1. With u = max(q, 1) and c = (1−q)₊ all pieces are
/// (−5(3−u)₊⁴ + 30(2−u)₊⁴)/u − c(90 + 30c − 50c²): no cancellation near q = 0 and no branch.
#[inline(always)]
fn slope_over_q<L: Lane>(q: L) -> L {
    let u = q.max(L::one());
    let a = (L::of(3.0) - u).positive_part();
    let b = (L::of(2.0) - u).positive_part();
    let c = (L::one() - q).positive_part();
    let (a2, b2) = (a * a, b * b);
    let outer = (b2 * b2).mul_add(L::of(30.0), a2 * a2 * L::of(-5.0)) / u;
    let inner = c
        .mul_add(L::of(50.0), L::of(-30.0))
        .mul_add(c, L::of(-90.0));
    inner.mul_add(c, outer)
}
