//! The Wendland C4 kernel: for gases and convergence at many neighbours.
//! f(q) = t⁶(1 + 3q + 35/12 q²) in 2D and 3D, t⁵(1 + 5/2 q + 2q²) in 1D, t = (1 − q/2)₊.

use super::{family, inside};
use crate::scalar::Lane;

/// The Wendland C4 kernel.
///
#[doc = include_str!("../../docs/equations/wendland_c4.html")]
///
/// Source: Wendland (1995), Dehnen & Aly (2012).
///
/// Use it for gases and for convergence studies. It is narrow for its support (standard deviation
/// 0.453 h in 3D against 0.548 h of the cubic spline), so it needs a larger h/dx: 1.8, that is 196
/// neighbours in 3D.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WendlandC4;

family! {
    WendlandC4, "Wendland C4", support 2.0;
    1 => { normalisation: 3.0 / 4.0, h_over_dx: 1.8, range: (1.0, 2.3), stable_step: 1.15,
           shape: shape_1d, slope_over_q: slope_over_q_1d };
    2 => { normalisation: 9.0 / (4.0 * PI), h_over_dx: 1.8, range: (1.3, 2.3), stable_step: 1.01 };
    3 => { normalisation: 495.0 / (256.0 * PI), h_over_dx: 1.8, range: (1.3, 2.3), stable_step: 1.0 };
}

#[inline(always)]
fn shape<L: Lane>(q: L) -> L {
    let (q, t) = inside(q);
    let t2 = t * t;
    let polynomial = q
        .mul_add(L::of(35.0 / 12.0), L::of(3.0))
        .mul_add(q, L::one());
    t2 * t2 * t2 * polynomial
}

#[inline(always)]
fn slope_over_q<L: Lane>(q: L) -> L {
    let (q, t) = inside(q);
    let t2 = t * t;
    t2 * t2 * t * q.mul_add(L::of(-35.0 / 3.0), L::of(-14.0 / 3.0))
}

#[inline(always)]
fn shape_1d<L: Lane>(q: L) -> L {
    let (q, t) = inside(q);
    let t2 = t * t;
    t2 * t2 * t * q.mul_add(L::of(2.0), L::of(2.5)).mul_add(q, L::one())
}

#[inline(always)]
fn slope_over_q_1d<L: Lane>(q: L) -> L {
    let (q, t) = inside(q);
    let t2 = t * t;
    t2 * t2 * q.mul_add(L::of(-7.0), L::of(-3.5))
}
