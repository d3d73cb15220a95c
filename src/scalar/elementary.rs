//! Elementary functions of `f64` from sums, products, quotients and the bits of numbers alone: the same on every machine.
//! Reductions as in Cody & Waite 1980, ln by artanh, pairs of numbers by Dekker 1971. Powers, exponentials and logarithms have no branch, so rows vectorise.

/// What has no digits behind the point, added and taken away again, leaves a whole number; its last bits hold that.
const WHOLE: f64 = 6_755_399_441_055_744.0;
/// ln 2 in two parts, the first of which has 33 bits: whole multiples up to 2²⁰ are exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
/// π/2 in three parts, the first two of 33 bits.
const HALF_PI: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_7e-21,
];
/// 2/3 in two parts.
const TWO_THIRDS: [f64; 2] = [2.0 / 3.0, 3.700_743_415_417_188e-17];
/// The largest |x| of which [`sin`] and [`cos`] know the quarter turns.
const MOST_TURNED: f64 = 8e5;

/// a + b and its rounding error, of |a| ≥ |b|.
#[inline(always)]
fn sum_of_ordered(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    [sum, b - (sum - a)]
}

/// a + b and its rounding error.
#[inline(always)]
fn sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let other = sum - a;
    [sum, (a - (sum - other)) + (b - other)]
}

/// The upper 26 bits of a number, and the rest.
#[inline(always)]
fn split(a: f64) -> [f64; 2] {
    let scaled = 134_217_729.0 * a;
    let high = scaled - (scaled - a);
    [high, a - high]
}

/// a · b and its rounding error, which is the same number with a product that rounds once and without.
#[inline(always)]
fn product<const FUSED: bool>(a: f64, b: f64) -> [f64; 2] {
    let product = a * b;
    if FUSED {
        return [product, a.mul_add(b, -product)];
    }
    let ([ah, al], [bh, bl]) = (split(a), split(b));
    let error = ((ah * bh - product) + ah * bl + al * bh) + al * bl;
    [product, error]
}

/// Σ c[n] xⁿ.
#[inline(always)]
fn polynomial<const N: usize>(x: f64, coefficients: [f64; N]) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// eˣ within an ulp.
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    exp_of([x, 0.0])
}

/// e to a sum of two numbers, of which the second is small: 2ᵏ eʳ with |r| ≤ ½ ln 2.
#[inline(always)]
fn exp_of([x, rest]: [f64; 2]) -> f64 {
    // 1/n! from 2 to 13.
    const FACTORIALS: [f64; 12] = {
        let (mut all, mut n, mut factorial) = ([0.0; 12], 0, 1.0);
        while n < 12 {
            factorial *= (n + 2) as f64;
            all[n] = 1.0 / factorial;
            n += 1;
        }
        all
    };
    // Beyond these it is zero and infinite.
    let bounded = if x < -746.0 { -746.0 } else { x };
    let bounded = if bounded > 710.0 { 710.0 } else { bounded };
    let rest = if bounded == x { rest } else { 0.0 };
    let shifted = bounded * core::f64::consts::LOG2_E + WHOLE;
    let k = shifted - WHOLE;
    let r = (bounded - k * LN_2[0]) - (k * LN_2[1] - rest);
    let power = 1.0 + (r + r * r * polynomial(r, FACTORIALS));
    // By two powers of two, since one may be too small or too large where the result is not.
    let k = shifted.to_bits().wrapping_sub(WHOLE.to_bits());
    let half = (k.wrapping_add(2048) >> 1).wrapping_sub(1024);
    let two_to = |k: u64| f64::from_bits(k.wrapping_add(1023) << 52);
    let scaled = power * two_to(half) * two_to(k.wrapping_sub(half));
    if x.is_nan() { x } else { scaled }
}

/// 2/(2n + 5), of artanh beyond its third power.
const ODD: [f64; 10] = {
    let (mut all, mut n) = ([0.0; 10], 0);
    while n < 10 {
        all[n] = 2.0 / (2 * n + 5) as f64;
        n += 1;
    }
    all
};

/// k and m of finite positive x = 2ᵏ m with √½ ≤ m < √2.
#[inline(always)]
fn parts(x: f64) -> [f64; 2] {
    const SQRT_HALF: u64 = core::f64::consts::FRAC_1_SQRT_2.to_bits();
    const TWO_TO_52: f64 = 4_503_599_627_370_496.0;
    const TWO_TO_54: f64 = 18_014_398_509_481_984.0;
    let is_small = x < f64::MIN_POSITIVE;
    let scaled = if is_small { x * TWO_TO_54 } else { x };
    let shifted = scaled.to_bits().wrapping_add(1f64.to_bits() - SQRT_HALF);
    let k = f64::from_bits((shifted >> 52) | TWO_TO_52.to_bits()) - (TWO_TO_52 + 1023.0);
    let k = if is_small { k - 54.0 } else { k };
    let m = f64::from_bits((shifted & ((1 << 52) - 1)) + SQRT_HALF);
    [k, m]
}

/// ln x within an ulp; minus infinity of zero, and no number of less: with f = m − 1 and s = f/(2 + f) it is
/// k ln 2 + f − (f²/2 − s (f²/2 + ⅔ s² + …)).
#[inline(always)]
pub fn ln(x: f64) -> f64 {
    let [k, m] = parts(x);
    let f = m - 1.0;
    let (s, half) = (f / (2.0 + f), 0.5 * f * f);
    let square = s * s;
    let series = square * (TWO_THIRDS[0] + square * polynomial(square, ODD));
    let known = k * LN_2[0] - ((half - (s * (half + series) + k * LN_2[1])) - f);
    let above = if x < f64::INFINITY { known } else { x };
    let positive = if x > 0.0 { above } else { f64::NAN };
    if x == 0.0 {
        f64::NEG_INFINITY
    } else {
        positive
    }
}

/// ln x as a sum of two numbers, of finite positive x: k ln 2 + 2 artanh s of m = (1 + s)/(1 − s).
#[inline(always)]
fn ln_of<const FUSED: bool>(x: f64) -> [f64; 2] {
    let [k, m] = parts(x);
    // s in two numbers.
    let (above, below) = (m - 1.0, m + 1.0);
    let (lost, inverse) = (m - (below - 1.0), 1.0 / below);
    let s = above * inverse;
    let [back, error] = product::<FUSED>(s, below);
    let more = (((above - back) - error) - s * lost) * inverse;
    // 2 artanh s = 2 s + ⅔ s³ + 2/5 s⁵ + …
    let [square, error] = product::<FUSED>(s, s);
    let [cube, of_cube] = product::<FUSED>(s, square);
    let of_cube = of_cube + s * error;
    let [third, of_third] = product::<FUSED>(cube, TWO_THIRDS[0]);
    let of_third = of_third + (cube * TWO_THIRDS[1] + of_cube * TWO_THIRDS[0]);
    let rest =
        cube * square * polynomial(square, ODD) + (of_third + (more + more) * (1.0 + square));
    let [first, of_first] = sum_of_ordered(s + s, third);
    let [high, of_high] = sum(k * LN_2[0], first);
    sum_of_ordered(high, of_high + of_first + rest + k * LN_2[1])
}

/// xʸ within an ulp, with the special cases of IEEE 754. `FUSED` is for machines that have the instruction.
#[inline(always)]
pub fn powf<const FUSED: bool>(x: f64, y: f64) -> f64 {
    // More than these are zero, one or infinite whatever x is.
    let bounded = y.clamp(-1e25, 1e25);
    let size = x.abs();
    let [high, low] = ln_of::<FUSED>(size);
    let [exponent, error] = product::<FUSED>(bounded, high);
    let power = exp_of([exponent, error + bounded * low]);
    let at_end = if (size == 0.0) == (y > 0.0) {
        0.0
    } else {
        f64::INFINITY
    };
    let power = if size == 0.0 || size == f64::INFINITY {
        at_end
    } else {
        power
    };
    let is_whole = y == y.trunc();
    let is_odd = is_whole && y.abs() < 9e15 && (y as i64) & 1 == 1;
    let signed = if is_odd { power.copysign(x) } else { power };
    let known = if x < 0.0 && !is_whole && size < f64::INFINITY {
        f64::NAN
    } else {
        signed
    };
    let known = if x.is_nan() || y.is_nan() {
        f64::NAN
    } else {
        known
    };
    if y == 0.0 || x == 1.0 { 1.0 } else { known }
}

/// The cube root, within an ulp.
#[must_use]
pub fn cbrt(x: f64) -> f64 {
    let root = powf::<false>(x.abs(), 1.0 / 3.0);
    // By what the exponent is rounded.
    let better = root + root * (1.850_371_707_708_594e-17 * ln(x.abs()));
    let known = if root > 0.0 && root < f64::INFINITY {
        better
    } else {
        root
    };
    known.copysign(x)
}

/// sin x, within two ulps up to |x| = 8·10⁵, and within the rounding of x beyond.
#[must_use]
pub fn sin(x: f64) -> f64 {
    quarters(x, 0)
}

/// cos x, as [`sin`].
#[must_use]
pub fn cos(x: f64) -> f64 {
    quarters(x, 1)
}

/// sin (x + n π/2): by Taylor's series of sine or cosine of what is left of whole quarter turns, in two numbers.
fn quarters(x: f64, n: u64) -> f64 {
    // (−1)ⁿ/(2n + 3)! and (−1)ⁿ/(2n + 4)!, without their first sign.
    const fn series(first: u32) -> [f64; 8] {
        let (mut all, mut n, mut factorial, mut k) = ([0.0; 8], 0, 1.0, 1);
        while n < 8 {
            while k <= first + 2 * n {
                factorial *= k as f64;
                k += 1;
            }
            all[n as usize] = if n % 2 == 0 { -1.0 } else { 1.0 } / factorial;
            n += 1;
        }
        all
    }
    const SINE: [f64; 8] = series(3);
    const COSINE: [f64; 8] = series(4);
    // Of more than these the rounding of x is more than that of whole turns.
    let x = if x.abs() > MOST_TURNED {
        x % core::f64::consts::TAU
    } else {
        x
    };
    let shifted = x * core::f64::consts::FRAC_2_PI + WHOLE;
    let k = shifted - WHOLE;
    let [first, error] = sum(x - k * HALF_PI[0], -(k * HALF_PI[1]));
    let [r, rest] = sum_of_ordered(first, error - k * HALF_PI[2]);
    let square = r * r;
    let quarter = shifted.to_bits().wrapping_add(n) & 3;
    let value = if quarter & 1 == 0 {
        r + (r * square * polynomial(square, SINE) + rest)
    } else {
        let half = 0.5 * square;
        let [one, error] = sum_of_ordered(1.0, -half);
        // Of cos (r + ε) = cos r − ε sin r; the last of the square is its rounding.
        let [_, of_square] = product::<false>(r, r);
        one + (error - 0.5 * of_square - r * rest - square * square * polynomial(square, COSINE))
    };
    if quarter & 2 == 0 { value } else { -value }
}

/// arccos x, within three ulps; no number outside of −1 to 1.
#[must_use]
pub fn acos(x: f64) -> f64 {
    2.0 * atan(((1.0 - x) / (1.0 + x)).sqrt())
}

/// arctan x, within two ulps: by its series, up to tan π/8.
#[must_use]
pub fn atan(x: f64) -> f64 {
    const ODD: [f64; 22] = {
        let (mut all, mut n) = ([0.0; 22], 0);
        while n < 22 {
            all[n] = if n % 2 == 0 { -1.0 } else { 1.0 } / (2 * n + 3) as f64;
            n += 1;
        }
        all
    };
    let series = |z: f64| z + z * z * z * polynomial(z * z, ODD);
    let size = x.abs();
    let (z, from) = if size > 1.0 + core::f64::consts::SQRT_2 {
        (-1.0 / size, core::f64::consts::FRAC_PI_2)
    } else if size > core::f64::consts::SQRT_2 - 1.0 {
        ((size - 1.0) / (size + 1.0), core::f64::consts::FRAC_PI_4)
    } else {
        (size, 0.0)
    };
    (from + series(z)).copysign(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers between 0 and 1 that fill it evenly.
    fn numbers(count: u32) -> impl Iterator<Item = f64> {
        (0..count).map(|k| (f64::from(k) * 0.754_877_666_246_692_7).fract())
    }

    /// How many numbers lie between two.
    fn ulps(a: f64, b: f64) -> f64 {
        if a == b || (a.is_nan() && b.is_nan()) {
            return 0.0;
        }
        (a - b).abs() / (b.next_up() - b).abs().max(f64::from_bits(1))
    }

    fn worst(of: impl Iterator<Item = (f64, f64, f64)>, most: f64) {
        let (x, own, exact) = of.fold((0.0, 0.0, 0.0), |worst, now| {
            if ulps(now.1, now.2) > ulps(worst.1, worst.2) {
                now
            } else {
                worst
            }
        });
        println!("{} ulps at {x}: {own:e}, {exact:e}", ulps(own, exact));
        assert!(ulps(own, exact) <= most, "{x}: {own:e} for {exact:e}");
    }

    #[test]
    fn they_are_those_of_the_standard_library_within_few_ulps() {
        let near = |k: f64| 1.0 + 1e-3 * (k - 0.5);
        worst(
            numbers(200_000)
                .map(|k| 1460.0 * k - 745.0)
                .map(|x| (x, exp(x), x.exp())),
            1.0,
        );
        worst(
            numbers(200_000)
                .map(|k| 2.0 * k - 1.0)
                .map(|x| (x, exp(x), x.exp())),
            1.0,
        );
        let wide = |k: f64| (1400.0 * k - 700.0_f64).exp();
        worst(numbers(200_000).map(wide).map(|x| (x, ln(x), x.ln())), 1.0);
        worst(numbers(200_000).map(near).map(|x| (x, ln(x), x.ln())), 1.0);
        for y in [
            7.15,
            1.4,
            0.31,
            -2.5,
            1.0 / 3.0,
            150.0,
            -800.0,
            2.0,
            3.0,
            1900.0,
        ] {
            let of = |x: f64| (x, powf::<false>(x, y), x.powf(y));
            worst(numbers(50_000).map(|k| 0.7 + 0.7 * k).map(of), 1.0);
            worst(numbers(50_000).map(wide).map(of), 1.0);
            worst(numbers(50_000).map(near).map(of), 1.0);
        }
        worst(
            numbers(50_000).map(wide).map(|x| (x, cbrt(x), x.cbrt())),
            1.0,
        );
        for size in [1.0, 10.0, 1e3, 7e5] {
            let all = || numbers(100_000).map(move |k| size * (2.0 * k - 1.0));
            worst(all().map(|x| (x, sin(x), x.sin())), 2.0);
            worst(all().map(|x| (x, cos(x), x.cos())), 2.0);
            worst(all().map(|x| (x, atan(x), x.atan())), 2.0);
        }
        worst(
            numbers(100_000)
                .map(|k| 2.0 * k - 1.0)
                .map(|x| (x, acos(x), x.acos())),
            3.0,
        );
    }

    #[test]
    fn special_cases_are_those_of_the_standard_library() {
        let (inf, nan) = (f64::INFINITY, f64::NAN);
        let special = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            2.0,
            -2.0,
            3.0,
            -3.0,
            2.5,
            -2.5,
            1e-320,
            5e-324,
            1e308,
            -1e308,
            1e18,
            9_007_199_254_740_993.0,
            f64::MIN_POSITIVE,
            inf,
            -inf,
            nan,
        ];
        let same = |name: &str, x: [f64; 2], own: f64, known: f64| {
            assert!(
                ulps(own, known) <= 1.0,
                "{name} of {x:?}: {own:e} for {known:e}"
            );
        };
        for x in special {
            same("exp", [x; 2], exp(x), x.exp());
            same("ln", [x; 2], ln(x), x.ln());
            same("cbrt", [x; 2], cbrt(x), x.cbrt());
            for y in special {
                same("power", [x, y], powf::<false>(x, y), x.powf(y));
            }
        }
        for x in [
            -746.0, -745.2, -745.1, -745.0, -708.5, 709.7, 709.79, 710.0, 1e4, -1e4,
        ] {
            same("exp", [x; 2], exp(x), x.exp());
        }
        assert!(
            [sin(inf), cos(-inf), sin(nan), acos(1.1), acos(nan)]
                .iter()
                .all(|x| x.is_nan())
        );
        for x in [1e6, -3e8, 1e12_f64] {
            assert!(
                (sin(x) - x.sin()).abs() < (x.next_up() - x).abs()
                    && (cos(x) - x.cos()).abs() < x.abs() * f64::EPSILON
            );
        }
        assert_eq!([acos(1.0), acos(-1.0)], [0.0, core::f64::consts::PI]);
    }
}
