//! The cubic B-spline M4: the cheapest kernel, and the one of the rod-impact literature.
//! f(q) = ¼(2−q)₊³ − (1−q)₊³, support 2h.

use super::family;
use crate::scalar::Lane;

/// The cubic B-spline M4.
///
#[doc = include_str!("../../docs/equations/cubic_spline.html")]
///
/// Source: Schoenberg (1946) for the splines, Monaghan & Lattanzio (1985) for its use here; it is
/// eq. 14 of Lam, Shen & Gong on rod impact.
///
/// Use it in one dimension, for strong shocks, and to reproduce older work: it has the fewest
/// neighbours (58 in 3D at h/dx = 1.2). Its Fourier transform has negative lobes, so in 2D and 3D
/// particles pair above h/dx ≈ 1.25 and the builder refuses more. In 1D a uniform row is not
/// unstable up to h/dx = 2, and at h/dx = 1 and 2 the sum over it is exactly one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CubicSpline;

family! {
    CubicSpline, "cubic spline", support 2.0;
    1 => { normalisation: 2.0 / 3.0, h_over_dx: 1.2, range: (1.0, 2.0), stable_step: 1.29 };
    2 => { normalisation: 10.0 / (7.0 * PI), h_over_dx: 1.2, range: (1.0, 1.25), stable_step: 1.22 };
    3 => { normalisation: 1.0 / PI, h_over_dx: 1.2, range: (1.0, 1.25), stable_step: 1.18 };
}

#[inline(always)]
fn shape<L: Lane>(q: L) -> L {
    let outer = (L::of(2.0) - q).positive_part();
    let inner = (L::one() - q).positive_part();
    (outer * outer).mul_add(outer * L::of(0.25), -(inner * inner * inner))
}

/// f′/q is −3 + 9/4 q inside and −3/4 (2−q)²/q outside. With u = max(q, 1) both are
/// −3/4 (2−u)₊²/u − 9/4 (1−q)₊: no cancellation near q = 0 and no branch.
#[inline(always)]
fn slope_over_q<L: Lane>(q: L) -> L {
    let u = q.max(L::one());
    let outer = (L::of(2.0) - u).positive_part();
    let inner = (L::one() - q).positive_part();
    (outer * outer / u).mul_add(L::of(-0.75), inner * L::of(-2.25))
}
