//! What is wrong with a kernel: numbers that no lattice can have, and a shape that does not integrate to one.
//! Asked once, when a scheme is composed.

use super::{Kernel, lattice};

/// Support in smoothing lengths beyond which neighbours are too many for any purpose.
const WIDEST: f64 = 10.0;

/// Share by which the integrals may differ from one: a truncated Gaussian ends at e⁻⁹.
const EXACT: f64 = 0.01;

/// What a stable step may be over that of one kind of wave, which was rounded.
const LONGER: f64 = 1.05;

/// All that is wrong with a kernel, as `(what, value, what it must be)`.
pub(crate) fn problems_of<K: Kernel<D>, const D: usize>(
    kernel: &K,
) -> Vec<(&'static str, f64, &'static str)> {
    let mut problems = kernel.problems();
    let (support, norm) = (kernel.support(), kernel.normalisation());
    if !(support > 0.0 && support <= WIDEST) {
        let must_be = "it must be positive and at most 10 smoothing lengths";
        problems.push(("support", support, must_be));
    }
    if !(norm.is_finite() && norm > 0.0) {
        problems.push(("normalisation", norm, "it must be finite and positive"));
    }
    for (what, value) in [
        ("recommended h/dx", kernel.h_over_dx()),
        ("lowest h/dx", kernel.h_over_dx_range().0),
        ("highest h/dx", kernel.h_over_dx_range().1),
        ("stable step", kernel.stable_step()),
    ] {
        if !(value.is_finite() && value > 0.0) {
            problems.push((what, value, "it must be finite and positive"));
        }
    }
    if !problems.is_empty() {
        return problems;
    }
    for q in [support, 1.5 * support] {
        let (shape, slope) = (kernel.shape(q), kernel.slope_over_q(q));
        if shape != 0.0 || slope != 0.0 {
            let beyond = if shape == 0.0 { slope } else { shape };
            problems.push(("shape beyond the support", beyond, "it must be zero"));
            break;
        }
    }
    // ∫ W = 1, and by parts −∫ r·∇W/D = 1.
    let count = 2000;
    let step = support / f64::from(count);
    let (mut whole, mut moment) = (0.0, 0.0);
    for k in 0..count {
        let q = (f64::from(k) + 0.5) * step;
        let shell = match D {
            1 => 2.0,
            2 => core::f64::consts::TAU * q,
            _ => 2.0 * core::f64::consts::TAU * q * q,
        };
        whole += norm * kernel.shape(q) * shell * step;
        moment -= norm * kernel.slope_over_q(q) * q * q * shell * step / D as f64;
    }
    let must_be = "it must be one within a hundredth: look at the normalisation and at the shape";
    if whole.is_nan() || (whole - 1.0).abs() >= EXACT {
        problems.push(("integral", whole, must_be));
    }
    let must_be =
        "it must be one within a hundredth: look at whether the slope is that of the shape";
    if moment.is_nan() || (moment - 1.0).abs() >= EXACT {
        problems.push(("first moment of the slope", moment, must_be));
    }
    let longest = lattice::longest_step(kernel, kernel.h_over_dx());
    if kernel.stable_step() > LONGER * longest {
        problems.push((
            "stable step",
            kernel.stable_step(),
            "waves along an axis of a cubic lattice grow with that: it must be 2h/(c ω) for the highest frequency ω",
        ));
    }
    let value: f64 = kernel.shape(0.0) + kernel.slope_over_q(0.0);
    if !value.is_finite() {
        problems.push((
            "shape or slope over q at the centre",
            value,
            "it must be finite",
        ));
    }
    problems
}

#[cfg(test)]
mod tests {
    use super::*;

    macro_rules! faultless {
        ($($Kernel:ident $name:literal),*) => {
            $(
                assert_eq!(problems_of::<_, 1>(&super::super::$Kernel), []);
                assert_eq!(problems_of::<_, 2>(&super::super::$Kernel), []);
                assert_eq!(problems_of::<_, 3>(&super::super::$Kernel), []);
            )*
        };
    }

    #[test]
    fn the_crates_own_kernels_have_no_problem() {
        crate::for_each_kernel!(faultless);
    }
}
