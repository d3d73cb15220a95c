//! A kernel behind a trait object, for what looks at few pairs and is compiled once for all schemes.
//! Loops over pairs take the kernel by its type instead.

use super::Kernel;
use core::fmt;

/// What a profile gives at a distance: W hᴰ, and W′/q · hᴰ, at q = r/h.
type At = dyn Fn(f64) -> [f64; 2] + Send + Sync;

/// The shape and the slope of a kernel with its normalisation.
pub(crate) struct Profile {
    at: Box<At>,
    /// ∫ r²/D W dV in h²: the second moment along an axis.
    pub spread: f64,
}

impl fmt::Debug for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Profile")
            .field("spread", &self.spread)
            .finish_non_exhaustive()
    }
}

impl Profile {
    pub fn of<K: Kernel<D>, const D: usize>(kernel: K) -> Self {
        let norm = kernel.normalisation();
        let at = move |q: f64| {
            [
                norm * Kernel::<D>::shape(&kernel, q),
                norm * Kernel::<D>::slope_over_q(&kernel, q),
            ]
        };
        const SHELLS: u32 = 256;
        let step = kernel.support() / f64::from(SHELLS);
        let shell = |k: u32| {
            let q = (f64::from(k) + 0.5) * step;
            let weight = at(q)[0] * q.powi(D as i32 - 1);
            [weight, weight * q * q]
        };
        let sum = (0..SHELLS).map(shell);
        let [all, second] = sum.fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        Self {
            at: Box::new(at),
            spread: second / all / D as f64,
        }
    }

    /// W hᴰ and W′/q · hᴰ at q = r/h.
    pub fn at(&self, q: f64) -> [f64; 2] {
        (self.at)(q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::{CubicSpline, WendlandC2};

    #[test]
    fn second_moments_are_those_of_the_polynomials() {
        // ∫ q² W of the cubic spline in 1D is 1/3, and of Wendland's C2 in 3D over three 0.3 (by hand).
        let cubic = Profile::of::<_, 1>(CubicSpline).spread;
        assert!((cubic - 1.0 / 3.0).abs() < 1e-4, "{cubic}");
        let wendland = Profile::of::<_, 3>(WendlandC2).spread;
        let exact = {
            // ∫ q⁴ f over ∫ q² f with f = (1 − q/2)⁴ (1 + 2q), by Beta functions: q = 2t.
            let beta = |a: f64, n: i32| {
                // B(a, n + 1) = n!/(a (a+1) … (a+n))
                (0..=n).fold(1.0, |b, k| b / (a + f64::from(k)))
                    * f64::from((1..=n).product::<i32>())
            };
            let moment = |m: f64| beta(m + 1.0, 4) + 4.0 * beta(m + 2.0, 4);
            4.0 * moment(4.0) / moment(2.0) / 3.0
        };
        assert!((wendland - exact).abs() < 1e-4, "{wendland} {exact}");
    }
}
