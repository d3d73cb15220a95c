//! Elementary functions for WGSL, which has none in `f64`, and in `f32` leaves their accuracy to the driver.
//! Reductions as in Cody & Waite 1980 and series as `meshfree` has them on the host; drivers may reassociate, so no step relies on lost digits.

use crate::{Dialect, Precision};
use core::fmt::Write;

/// Σ c[n] xⁿ, nested.
fn polynomial(d: Dialect, x: &str, coefficients: impl DoubleEndedIterator<Item = f64>) -> String {
    coefficients.rev().fold(String::new(), |sum, c| {
        let c = d.constant(c);
        if sum.is_empty() {
            c
        } else {
            format!("fma({sum}, {x}, {c})")
        }
    })
}

/// 1/n! and so on, with signs that alternate from the first.
fn alternating(first: u32, step: u32, count: u32) -> impl DoubleEndedIterator<Item = f64> {
    (0..count).map(move |n| {
        let factorial: f64 = (1..=first + step * n).map(f64::from).product();
        if n.is_multiple_of(2) {
            -1.0 / factorial
        } else {
            1.0 / factorial
        }
    })
}

/// The text of the functions, each of which is called `…_of`.
pub fn functions(d: Dialect) -> String {
    let double = d.precision == Precision::Double;
    let t = d.scalar();
    let c = |value: f64| d.constant(value);
    let (u, i, digits, bias) = if double {
        ("u64", "i64", 52, 1023)
    } else {
        ("u32", "i32", 23, 127)
    };
    let suffix = if double { "lu" } else { "u" };
    // Terms of the series of e^r, ln, sine and cosine, and arctan.
    let [exp, log, turn, atan] = if double {
        [12, 10, 8, 22]
    } else {
        [6, 4, 4, 9]
    };
    let (ln_2, half_pi, [low, high], least, lift) = if double {
        (
            [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10],
            [
                1.570_796_326_734_125_6,
                6.077_100_506_303_966e-11,
                2.022_266_248_795_950_7e-21,
            ],
            [-746.0, 710.0],
            f64::MIN_POSITIVE,
            54,
        )
    } else {
        // The first of 9 and of 8 bits.
        (
            [0.693_359_375, -2.121_944_400_546_905_8e-4],
            [
                1.570_312_5,
                4.837_512_969_970_703e-4,
                7.549_789_948_768_648e-8,
            ],
            [-104.0, 89.0],
            f64::from(f32::MIN_POSITIVE),
            25,
        )
    };
    let factorials = (2..2 + exp).map(|n| 1.0 / (1..=n).map(f64::from).product::<f64>());
    let odd = (0..log).map(|n| 2.0 / f64::from(2 * n + 3));
    let series = (0..atan).map(|n: u32| {
        let sign = if n.is_multiple_of(2) { -1.0 } else { 1.0 };
        sign / f64::from(2 * n + 3)
    });
    let root_half = if double {
        core::f64::consts::FRAC_1_SQRT_2.to_bits()
    } else {
        u64::from(core::f32::consts::FRAC_1_SQRT_2.to_bits())
    };
    let one = if double {
        1f64.to_bits()
    } else {
        u64::from(1f32.to_bits())
    };
    let mut text = String::new();
    let mut line = |own: String| writeln!(text, "{own}").expect("a string");
    line(format!(
        "fn two_to(k: {i}) -> {t} {{ return bitcast<{t}>({u}(k + {i}({bias})) << {digits}u); }}"
    ));
    // By its bits, since drivers differ in whether what is no number differs from itself.
    line(format!(
        "fn exp_of(x: {t}) -> {t} {{
    let bounded = min(max(x, {low}), {high});
    let k = round(bounded * {per});
    let r = fma(-k, {second}, fma(-k, {first}, bounded));
    let power = {unit} + (r + r * r * {series});
    let whole = {i}(k);
    let half = whole / {i}(2);
    let undefined = (bitcast<{u}>(x) & {all}{suffix}) > {infinity}{suffix};
    return select(power * two_to(half) * two_to(whole - half), x, undefined);
}}",
        all = if double {
            u64::MAX >> 1
        } else {
            u64::from(u32::MAX >> 1)
        },
        infinity = if double {
            f64::INFINITY.to_bits()
        } else {
            u64::from(f32::INFINITY.to_bits())
        },
        low = c(low),
        high = c(high),
        per = c(core::f64::consts::LOG2_E),
        first = c(ln_2[0]),
        second = c(ln_2[1]),
        unit = c(1.0),
        series = polynomial(d, "r", factorials),
    ));
    // As k ln 2 + 2 artanh s of m = (1 + s)/(1 − s): f − s (f − s² …) with f = m − 1 loses no digits.
    line(format!(
        "fn log_of(x: {t}) -> {t} {{
    let tiny = x < {least};
    let bits = bitcast<{u}>(select(x, x * {lift}, tiny)) + {shift}{suffix};
    let k = {t}({i}(bits >> {digits}u) - {i}({bias})) - select({zero}, {lifted}, tiny);
    let f = bitcast<{t}>((bits & {mask}{suffix}) + {root}{suffix}) - {unit};
    let s = f / ({two} + f);
    let square = s * s;
    let known = fma(k, {first}, f - s * (f - square * {series})) + k * {second};
    let positive = select(known, x, x > {most});
    return select(select((x - x) / (x - x), positive, x > {zero}), {minus} / abs(x), x == {zero});
}}",
        least = c(least),
        lift = c(f64::from(lift).exp2()),
        lifted = c(f64::from(lift)),
        shift = one - root_half,
        mask = (1u64 << digits) - 1,
        root = root_half,
        zero = c(0.0),
        unit = c(1.0),
        two = c(2.0),
        minus = c(-1.0),
        first = c(ln_2[0]),
        second = c(ln_2[1]),
        series = polynomial(d, "square", odd),
        most = c(if double {
            f64::MAX
        } else {
            f64::from(f32::MAX)
        }),
    ));
    // By one step of Newton from e^(ln/3).
    line(format!(
        "fn cbrt_of(x: {t}) -> {t} {{
    let size = abs(x);
    let root = exp_of(log_of(size) * {third});
    let better = root - (root * root * root - size) / ({three} * root * root);
    let known = select(size, better, size > {zero} && size <= {most});
    return select(known, -known, x < {zero});
}}",
        third = c(1.0 / 3.0),
        three = c(3.0),
        zero = c(0.0),
        most = c(if double {
            f64::MAX
        } else {
            f64::from(f32::MAX)
        }),
    ));
    line(format!(
        "fn quarters(given: {t}, n: i32) -> {t} {{
    let x = select(given, given % {turn}, abs(given) > {most});
    let k = round(x * {per});
    let r = fma(-k, {p2}, fma(-k, {p1}, fma(-k, {p0}, x)));
    let square = r * r;
    let sine = r + r * square * {sine};
    let cosine = {unit} - ({half} * square + square * square * {cosine});
    let quarter = (i32(k) + n) & 3;
    let value = select(sine, cosine, (quarter & 1) == 1);
    return select(value, -value, (quarter & 2) == 2);
}}
fn sin_of(x: {t}) -> {t} {{ return quarters(x, 0); }}
fn cos_of(x: {t}) -> {t} {{ return quarters(x, 1); }}",
        turn = c(core::f64::consts::TAU),
        most = c(if double { 8e5 } else { 1e4 }),
        per = c(core::f64::consts::FRAC_2_PI),
        p0 = c(half_pi[0]),
        p1 = c(half_pi[1]),
        p2 = c(half_pi[2]),
        sine = polynomial(d, "square", alternating(3, 2, turn)),
        cosine = polynomial(d, "square", alternating(4, 2, turn)),
        unit = c(1.0),
        half = c(0.5),
    ));
    line(format!(
        "fn atan_of(x: {t}) -> {t} {{
    let size = abs(x);
    let large = size > {steep};
    let middle = size > {flat} && !large;
    let z = select(select(size, (size - {unit}) / (size + {unit}), middle), {minus} / size, large);
    let from_ = select(select({zero}, {eighth}, middle), {quarter}, large);
    let square = z * z;
    let known = from_ + (z + z * square * {series});
    return select(known, -known, x < {zero});
}}
fn acos_of(x: {t}) -> {t} {{ return {two} * atan_of(sqrt(({unit} - x) / ({unit} + x))); }}",
        steep = c(1.0 + core::f64::consts::SQRT_2),
        flat = c(core::f64::consts::SQRT_2 - 1.0),
        unit = c(1.0),
        minus = c(-1.0),
        two = c(2.0),
        zero = c(0.0),
        eighth = c(core::f64::consts::FRAC_PI_4),
        quarter = c(core::f64::consts::FRAC_PI_2),
        series = polynomial(d, "square", series),
    ));
    text
}
