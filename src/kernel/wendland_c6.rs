//! The Wendland C6 kernel: for reference solutions at several hundred neighbours.
//! f(q) = t⁸(1 + 4q + 25/4 q² + 4q³) in 2D and 3D, t⁷(1 + 7/2 q + 19/4 q² + 21/8 q³) in 1D.

use super::{family, inside};
use crate::scalar::Lane;

/// The Wendland C6 kernel.
///
#[doc = include_str!("../../docs/equations/wendland_c6.html")]
///
/// Source: Wendland (1995), Dehnen & Aly (2012).
///
/// Use it for reference solutions: at h/dx = 2 it has 268 neighbours in 3D and stays free of
/// pairing however many there are. It is slow, and too narrow for a small h/dx.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WendlandC6;

family! {
    WendlandC6, "Wendland C6", support 2.0;
    1 => { normalisation: 55.0 / 64.0, h_over_dx: 2.0, range: (1.0, 2.5), stable_step: 1.0,
           shape: shape_1d, slope_over_q: slope_over_q_1d };
    2 => { normalisation: 39.0 / (14.0 * PI), h_over_dx: 2.0, range: (1.5, 2.5), stable_step: 0.91 };
    3 => { normalisation: 1365.0 / (512.0 * PI), h_over_dx: 2.0, range: (1.5, 2.5), stable_step: 0.9 };
}

#[inline(always)]
fn shape<L: Lane>(q: L) -> L {
    let (q, t) = inside(q);
    let t2 = t * t;
    let t4 = t2 * t2;
    let polynomial = q
        .mul_add(L::of(4.0), L::of(6.25))
        .mul_add(q, L::of(4.0))
        .mul_add(q, L::one());
    t4 * t4 * polynomial
}

#[inline(always)]
fn slope_over_q<L: Lane>(q: L) -> L {
    let (q, t) = inside(q);
    let t2 = t * t;
    let polynomial = q
        .mul_add(L::of(-22.0), L::of(-19.25))
        .mul_add(q, L::of(-5.5));
    t2 * t2 * t2 * t * polynomial
}

#[inline(always)]
fn shape_1d<L: Lane>(q: L) -> L {
    let (q, t) = inside(q);
    let t2 = t * t;
    let polynomial = q
        .mul_add(L::of(21.0 / 8.0), L::of(4.75))
        .mul_add(q, L::of(3.5))
        .mul_add(q, L::one());
    t2 * t2 * t2 * t * polynomial
}

#[inline(always)]
fn slope_over_q_1d<L: Lane>(q: L) -> L {
    let (q, t) = inside(q);
    let t2 = t * t;
    let polynomial = q
        .mul_add(L::of(-13.125), L::of(-13.5))
        .mul_add(q, L::of(-4.5));
    t2 * t2 * t2 * polynomial
}
