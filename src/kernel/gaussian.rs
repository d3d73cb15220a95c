//! The Gaussian, cut off at 3h, less the parabola that takes its value and slope there to zero.
//! f(q) = exp(−q²) − e⁻⁹ (10 − q²) for q < 3.

use super::family;
use crate::scalar::Lane;

/// The Gaussian, cut off at 3h without a jump.
///
#[doc = include_str!("../../docs/equations/gaussian.html")]
///
/// Source: Gingold & Monaghan (1977) for the Gaussian. Cut without the parabola it ends with a jump
/// of 1.2·10⁻⁴ f(0): where a lattice has neighbours at the edge (h/dx 1 and 2) they flicker in and
/// out, and the noise drowns a sound wave.
///
/// Use it for comparison with theory only: it needs an exponential for every pair and gains nothing
/// over the quintic spline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gaussian;

family! {
    Gaussian, "Gaussian", support 3.0;
    1 => { normalisation: 0.565_856_826_698_022_7, h_over_dx: 1.1, range: (1.0, 2.0), stable_step: 1.5 };
    2 => { normalisation: 0.320_306_096_269_504_3, h_over_dx: 1.1, range: (1.0, 1.5), stable_step: 1.5 };
    3 => { normalisation: 0.181_762_823_550_946_45, h_over_dx: 1.1, range: (1.0, 1.5), stable_step: 1.53 };
}

/// e⁻⁹
const EDGE: f64 = 1.234_098_040_866_795_5e-4;

#[inline(always)]
fn shape<L: Lane>(q: L) -> L {
    let q2 = q * q;
    let parabola = (q2 - L::of(10.0)) * L::of(EDGE);
    L::select(q.lt(L::of(3.0)), (-q2).exp() + parabola, L::zero())
}

#[inline(always)]
fn slope_over_q<L: Lane>(q: L) -> L {
    let slope = (L::of(EDGE) - (-(q * q)).exp()) * L::of(2.0);
    L::select(q.lt(L::of(3.0)), slope, L::zero())
}
