//! The Gaussian, cut off at 3h and normalised to one over what is left.
//! f(q) = exp(−q²) for q < 3.

use super::family;
use crate::scalar::Lane;

/// The Gaussian, cut off at 3h.
///
#[doc = include_str!("../../docs/equations/gaussian.html")]
///
/// Source: Gingold & Monaghan (1977). Normalised without the cut, 4.4·10⁻⁴ of the mass would be
/// lost in 3D. What remains is a jump of 1.2·10⁻⁴ f(0) at the edge.
///
/// Use it for comparison with theory only: it needs an exponential for every pair and gains nothing
/// over the quintic spline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gaussian;

family! {
    Gaussian, "Gaussian", support 3.0;
    1 => { normalisation: 0.564_202_047_051_383_3, h_over_dx: 1.1, range: (1.0, 2.0), stable_step: 1.5 };
    2 => { normalisation: 0.318_349_173_592_934_9, h_over_dx: 1.1, range: (1.0, 1.5), stable_step: 1.5 };
    3 => { normalisation: 0.179_666_148_218_087_18, h_over_dx: 1.1, range: (1.0, 1.5), stable_step: 1.53 };
}

#[inline(always)]
fn shape<L: Lane>(q: L) -> L {
    L::select(q.lt(L::of(3.0)), (-(q * q)).exp(), L::zero())
}

#[inline(always)]
fn slope_over_q<L: Lane>(q: L) -> L {
    shape(q) * L::of(-2.0)
}
