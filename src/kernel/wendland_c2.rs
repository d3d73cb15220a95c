//! The Wendland C2 kernel: the default for liquids and fluid–structure scenes.
//! f(q) = t⁴(1 + 2q) in 2D and 3D, t³(1 + 3/2 q) in 1D, t = (1 − q/2)₊.

use super::{family, inside};
use crate::scalar::Lane;

/// The Wendland C2 kernel.
///
#[doc = include_str!("../../docs/equations/wendland_c2.html")]
///
/// Source: Wendland (1995); Dehnen & Aly (2012) show that a Fourier transform without negative
/// lobes excludes pairing. That property belongs to a polynomial in a dimension, which is why 1D
/// has one of its own.
///
/// Use it for liquids and for fluid with structure (113 neighbours in 3D at h/dx = 1.5). A density
/// summed over a lattice is 0.35 % too high at h/dx = 1.5 in 3D; in a stiff liquid use the
/// continuity equation or calibrated masses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WendlandC2;

family! {
    WendlandC2, "Wendland C2", support 2.0;
    1 => { normalisation: 5.0 / 8.0, h_over_dx: 1.5, range: (1.0, 2.0), stable_step: 1.44,
           shape: shape_1d, slope_over_q: slope_over_q_1d };
    2 => { normalisation: 7.0 / (4.0 * PI), h_over_dx: 1.5, range: (1.2, 2.0), stable_step: 1.15,
           gradient: gradient };
    3 => { normalisation: 21.0 / (16.0 * PI), h_over_dx: 1.5, range: (1.2, 2.0), stable_step: 1.14,
           gradient: gradient };
}

#[inline(always)]
fn shape<L: Lane>(q: L) -> L {
    let (q, t) = inside(q);
    let t2 = t * t;
    t2 * t2 * q.mul_add(L::of(2.0), L::one())
}

#[inline(always)]
fn slope_over_q<L: Lane>(q: L) -> L {
    let (_, t) = inside(q);
    t * t * t * L::of(-5.0)
}

/// The same with the constants of a pair folded into those of the kernel.
#[inline(always)]
fn gradient<L: Lane>(r: L, inverse_h: L, scale: L) -> L {
    let t = r.mul_add(inverse_h * L::of(-0.5), L::one()).positive_part();
    t * t * t * (scale * L::of(-5.0))
}

#[inline(always)]
fn shape_1d<L: Lane>(q: L) -> L {
    let (q, t) = inside(q);
    t * t * t * q.mul_add(L::of(1.5), L::one())
}

#[inline(always)]
fn slope_over_q_1d<L: Lane>(q: L) -> L {
    let (_, t) = inside(q);
    t * t * L::of(-3.0)
}
