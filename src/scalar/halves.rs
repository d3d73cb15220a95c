//! All elements of a row as one, by halves: its second half to the first, and so on, in the same order on every machine.
//! On x86-64 in registers, which the compiler does not find by itself.

use super::Lane;

/// The sum of a row's elements, or the largest of them.
#[cfg_attr(target_arch = "x86_64", allow(dead_code))]
pub(super) fn portable<L: Lane>(row: &[L], largest: bool) -> L {
    let mut halves = row.to_vec();
    while halves.len() > 1 {
        let half = halves.len() / 2;
        for k in 0..half {
            let (a, b) = (halves[k], halves[k + half]);
            halves[k] = if largest { a.max(b) } else { a + b };
        }
        halves.truncate(half);
    }
    halves[0]
}

/// The same of a row of eight.
#[inline(always)]
pub(super) fn of_eight(row: &[f64], largest: bool) -> f64 {
    #[cfg(target_arch = "x86_64")]
    {
        use core::arch::x86_64::{
            __m128d, _mm_add_pd, _mm_cvtsd_f64, _mm_loadu_pd, _mm_max_pd, _mm_unpackhi_pd,
        };
        let row: &[f64; 8] = row.first_chunk().expect("a row of eight");
        // SAFETY: every processor of this target has the instructions, and the row has eight elements.
        unsafe {
            let with = |a: __m128d, b: __m128d| {
                if largest {
                    _mm_max_pd(a, b)
                } else {
                    _mm_add_pd(a, b)
                }
            };
            let at = |k: usize| _mm_loadu_pd(row.as_ptr().add(k));
            let two = with(with(at(0), at(4)), with(at(2), at(6)));
            _mm_cvtsd_f64(with(two, _mm_unpackhi_pd(two, two)))
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    portable(row, largest)
}

/// The same of a row of sixteen.
#[inline(always)]
pub(super) fn of_sixteen(row: &[f32], largest: bool) -> f32 {
    #[cfg(target_arch = "x86_64")]
    {
        use core::arch::x86_64::{
            __m128, _mm_add_ps, _mm_cvtss_f32, _mm_loadu_ps, _mm_max_ps, _mm_movehl_ps,
            _mm_shuffle_ps,
        };
        let row: &[f32; 16] = row.first_chunk().expect("a row of sixteen");
        // SAFETY: every processor of this target has the instructions, and the row has sixteen elements.
        unsafe {
            let with = |a: __m128, b: __m128| {
                if largest {
                    _mm_max_ps(a, b)
                } else {
                    _mm_add_ps(a, b)
                }
            };
            let at = |k: usize| _mm_loadu_ps(row.as_ptr().add(k));
            let four = with(with(at(0), at(8)), with(at(4), at(12)));
            let two = with(four, _mm_movehl_ps(four, four));
            _mm_cvtss_f32(with(two, _mm_shuffle_ps::<1>(two, two)))
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    portable(row, largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_take_halves_in_the_order_that_is_stated() {
        for seed in 0..100 {
            let element = |k: i32| (f64::from(17 * seed + k) * 0.618_034).fract() - 0.5;
            let eight: [f64; 8] = core::array::from_fn(|k| element(k as i32));
            let sixteen: [f32; 16] = core::array::from_fn(|k| element(k as i32) as f32);
            for largest in [false, true] {
                assert_eq!(of_eight(&eight, largest), portable(&eight, largest));
                assert_eq!(of_sixteen(&sixteen, largest), portable(&sixteen, largest));
            }
        }
    }
}
