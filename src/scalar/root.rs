//! Square roots of rows, by the machine's divider or by products.
//! Which of the two is faster is a matter of the processor, and they round differently: so a run keeps to one.

use super::{Lane, Lanes, Real};

/// How loops over neighbours take roots in `f64` where rows have a fused multiply-add; in `f32`, and without it, the
/// divider is faster everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
// What is unsafe asks the processor for its maker, whatever the value.
#[cfg_attr(feature = "serde", allow(clippy::unsafe_derive_deserialize))]
pub enum Root {
    /// By the machine's divider, correctly rounded.
    Divider,
    /// By twelve products and sums, within twice the machine epsilon.
    Products,
}

impl Root {
    /// Both of them, which a checkpoint knows by their names.
    #[cfg(feature = "checkpoint")]
    pub(crate) const ALL: [Self; 2] = [Self::Divider, Self::Products];

    /// The faster of the two for this processor, by its maker: a table, and not a measurement, so that two runs on one
    /// machine have the same bits.
    ///
    /// Measured on an AMD EPYC with AVX-512 (family 25, model 17): forces of a liquid take 0.84 and compression 0.78 of the
    /// time with the divider; all of that maker are taken to be alike. On a processor whose divider takes 18 cycles for
    /// eight roots products were 5 % faster, and makers that were not measured get them.
    #[must_use]
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            // SAFETY: every processor of this target has the instruction. Newer compilers take the call for safe.
            #[allow(unused_unsafe)]
            let maker = unsafe { core::arch::x86_64::__cpuid(0) };
            let name = [maker.ebx, maker.edx, maker.ecx].map(u32::to_le_bytes);
            if name.concat() == b"AuthenticAMD" {
                return Self::Divider;
            }
        }
        Self::Products
    }
}

/// The machine's square root.
#[inline(always)]
pub(super) fn root_by_divider<T: Real, const W: usize, const FUSED: bool>(
    x: Lanes<T, W, FUSED>,
) -> Lanes<T, W, FUSED> {
    x.sqrt()
}

/// Half the exponent makes a first guess y of 1/√x: x y² is between 0.8504 and 0.9619 for all x.
pub(super) const GUESS: u64 = 0x5fe5_9b71_8c50_dd8e;
/// The polynomial of fourth degree that comes closest to c/√t there, within 1.4·10⁻⁸, with c = 2^(−1/3).
const ROOT_QUARTIC: [f64; 5] = [
    2.0539037422873667,
    -3.0269843671106877,
    3.0098049359910237,
    -1.582702103636881,
    0.3396796705325368,
];
/// 3 c²: with g = c √x and y = c/√x a step of Newton's for the inverse root, times x, is g (3 c² − g y).
/// The last digit is chosen so that errors of either sign are as large, 4.4·10⁻¹⁶.
const ROOT_STEP: f64 = 1.88988157484231;

/// The same with a first guess from the bits of each element.
#[inline(always)]
pub(super) fn root_of_lanes<const W: usize, const FUSED: bool>(
    x: Lanes<f64, W, FUSED>,
) -> Lanes<f64, W, FUSED> {
    if !FUSED {
        return x.sqrt();
    }
    let guess = x.map(|x| f64::from_bits(GUESS.wrapping_sub(x.to_bits() >> 1)));
    root_by_products(x, guess)
}

/// A square root without the divider, which takes 18 cycles for eight numbers where these products take
/// six. Without a fused multiply-add it is not worth it.
#[inline(always)]
pub(super) fn root_by_products<L: Lane<Scalar = f64>>(x: L, guess: L) -> L {
    let [a, b, c, d, e] = ROOT_QUARTIC;
    let [a, b, c, d, e] = [L::of(a), L::of(b), L::of(c), L::of(d), L::of(e)];
    let product = x * guess;
    let t = product * guess;
    let refined = t.mul_add(e, d).mul_add(t, c).mul_add(t, b).mul_add(t, a);
    let (root, inverse) = (product * refined, guess * refined);
    root * (-root).mul_add(inverse, L::of(ROOT_STEP))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_rows_are_good_to_two_roundings() {
        let mut worst = 0.0_f64;
        for k in 0..40_000 {
            let x = Lanes::<f64, 8, true>::from_fn(|lane| {
                let mantissa =
                    1.0 + (0.618_033_988_749_894_9 * f64::from(8 * k + lane as i32)).fract();
                mantissa * 2.0_f64.powi(k % 2045 - 1022)
            });
            let root = x.root();
            for lane in 0..8 {
                let (x, found) = (x.extract(lane), root.extract(lane));
                let rounded = x.sqrt();
                // What rounding took from the machine's root.
                let lost = (-rounded).fused(rounded, x) / (2.0 * rounded);
                worst = worst.max((((found - rounded) - lost) / rounded).abs());
            }
        }
        assert!(worst < 2.0 * f64::EPSILON, "{worst:e}");
    }

    #[test]
    fn a_root_of_zero_is_zero_and_of_next_to_nothing_is_finite() {
        for x in [0.0, 5e-324, 1e-310, f64::MIN_POSITIVE] {
            let root = Lanes::<f64, 8, true>::splat(x).root().extract(3);
            assert!(
                (0.0..=x.sqrt() * 1.000_001).contains(&root),
                "{x:e}: {root:e}"
            );
        }
        assert_eq!(
            Lanes::<f32, 16, true>::splat(2.0).root().extract(5),
            2.0_f32.sqrt()
        );
    }
}
