//! Powers of rows, in the widest registers that the machine has.
//! They have the bits of single powers: sums and products round alike in all registers.

use super::{Real, elementary};

/// xʸ of each number of a row, in its place. A function of its own, so that laws and equations of state share one text of it.
#[inline(never)]
pub(super) fn of_row<T: Real, const W: usize>(row: &mut [T; W], exponent: f64) {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("fma")
        {
            // SAFETY: this machine has the instructions.
            return unsafe { on_avx512(row, exponent) };
        }
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: as above.
            return unsafe { on_avx2(row, exponent) };
        }
    }
    of_each::<T, W, false>(row, exponent);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,fma")]
fn on_avx512<T: Real, const W: usize>(row: &mut [T; W], exponent: f64) {
    of_each::<T, W, true>(row, exponent);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn on_avx2<T: Real, const W: usize>(row: &mut [T; W], exponent: f64) {
    of_each::<T, W, true>(row, exponent);
}

#[inline(always)]
fn of_each<T: Real, const W: usize, const FUSED: bool>(row: &mut [T; W], exponent: f64) {
    for x in row {
        *x = T::from_f64(elementary::powf::<FUSED>(x.to_f64(), exponent));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::{Lane, Lanes};

    /// In the registers of the machine and one by one, with what is special.
    fn same<T: Real, const W: usize>() {
        let special = [
            0.0,
            -0.0,
            1.0,
            -1.5,
            5e-324,
            1e-310,
            1e308,
            f64::INFINITY,
            f64::NAN,
        ];
        let mut numbers: Vec<f64> = special.into();
        numbers.extend((0..4000).map(|k| 10f64.powf(0.15 * f64::from(k) - 300.0)));
        numbers.extend((0..4000).map(|k| 1.0 + 1e-4 * f64::from(k - 2000)));
        numbers.extend((0..100).map(|k| 1.0 + f64::EPSILON * f64::from(k - 50)));
        for exponent in [
            0.26,
            6.0,
            -1.0 / 3.0,
            1.03,
            150.0,
            -2.0,
            3.0,
            1e-300,
            1e30,
            0.0,
            0.5,
        ] {
            for row in numbers.chunks_exact(W) {
                let own = Lanes::<T, W, false>::from_fn(|k| T::from_f64(row[k])).powf(exponent);
                for (k, x) in row.iter().enumerate() {
                    let alone = Lane::powf(T::from_f64(*x), exponent);
                    let bits = |x: T| (x.to_f64().to_bits(), x.to_f64().is_nan());
                    let (own, alone) = (bits(own.extract(k)), bits(alone));
                    assert!(own == alone || (own.1 && alone.1), "{x:e} to {exponent}");
                }
            }
        }
    }

    #[test]
    fn rows_have_the_bits_of_single_powers() {
        same::<f64, 8>();
        same::<f32, 16>();
    }
}
