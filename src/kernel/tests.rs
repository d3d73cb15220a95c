//! Tests that every kernel of the list passes in one, two and three dimensions.
//! Integrals are midpoint sums, derivatives are central differences.

use super::*;
use crate::for_each_kernel;
use crate::scalar::Lanes;
use approx::assert_relative_eq;
use core::f64::consts::PI;

/// Surface of the unit ball.
fn surface(d: usize) -> f64 {
    [2.0, 2.0 * PI, 4.0 * PI][d - 1]
}

/// ∫ f(|x|) g(|x|) dᴰx over the support by Gauss–Legendre with three points on fine panels.
fn integral<const D: usize, K: Kernel<D>>(kernel: K, g: impl Fn(f64) -> f64) -> f64 {
    let panels = 2400;
    let width = kernel.support() / panels as f64;
    let gauss = [
        (0.0, 8.0 / 9.0),
        (-0.6f64.sqrt(), 5.0 / 9.0),
        (0.6f64.sqrt(), 5.0 / 9.0),
    ];
    let mut sum = 0.0;
    for k in 0..panels {
        for (x, weight) in gauss {
            let q = (k as f64 + 0.5 + 0.5 * x) * width;
            sum += 0.5 * weight * width * kernel.shape(q) * g(q) * q.powi(D as i32 - 1);
        }
    }
    sum * surface(D)
}

fn integrates_to_one<const D: usize, K: Kernel<D>>(kernel: K) {
    let sum = kernel.normalisation() * integral(kernel, |_| 1.0);
    assert!(
        (sum - 1.0).abs() < 2e-13,
        "{} in {D}D: {sum}",
        kernel.name()
    );
}

fn is_zero_beyond_support<const D: usize, K: Kernel<D>>(kernel: K) {
    for q in [kernel.support(), kernel.support() + 1e-12, 4.0, 1e3, 1e30] {
        assert_eq!(kernel.shape(q), 0.0);
        assert_eq!(kernel.slope_over_q(q), 0.0);
        assert_eq!(kernel.shape(q as f32), 0.0);
        assert_eq!(kernel.slope_over_q(q as f32), 0.0);
    }
}

fn slope_is_the_derivative<const D: usize, K: Kernel<D>>(kernel: K) {
    for k in 1..300 {
        let q = k as f64 * 0.01 + 0.003;
        let step = 1e-5;
        if q + step >= kernel.support() {
            break;
        }
        let slope = (kernel.shape(q + step) - kernel.shape(q - step)) / (2.0 * step);
        let claimed = q * kernel.slope_over_q(q);
        let scale = kernel.shape(0.0);
        assert!(
            (slope - claimed).abs() < 2e-9 * scale,
            "{} in {D}D at {q}: {slope} against {claimed}",
            kernel.name()
        );
    }
}

fn is_finite_at_zero<const D: usize, K: Kernel<D>>(kernel: K) {
    let at_zero: f64 = kernel.slope_over_q(0.0);
    assert!(kernel.shape(0.0) > 0.0 && at_zero.is_finite() && at_zero < 0.0);
    // Continuous towards zero, in f32 too: no cancellation.
    for q in [1e-30, 1e-6, 1e-4] {
        assert_relative_eq!(
            kernel.slope_over_q(q),
            at_zero,
            epsilon = 0.0,
            max_relative = 3e-4
        );
        assert_relative_eq!(
            kernel.slope_over_q(q as f32) as f64,
            at_zero,
            epsilon = 0.0,
            max_relative = 3e-4
        );
    }
}

fn folds_constants_into_the_same_gradient<const D: usize, K: Kernel<D>>(kernel: K) {
    let (h, scale) = (0.7, 3.0);
    for k in 0..=400 {
        let r = f64::from(k) * 0.01 * h;
        let (folded, plain) = (
            kernel.gradient(r, 1.0 / h, scale),
            scale * kernel.slope_over_q(r / h),
        );
        let largest = scale * kernel.slope_over_q(0.0).abs();
        assert!((folded - plain).abs() < 1e-14 * largest, "r = {r}");
    }
}

fn falls_with_distance<const D: usize, K: Kernel<D>>(kernel: K) {
    for k in 0..1000 {
        let q = kernel.support() * k as f64 / 1000.0;
        assert!(kernel.shape(q) > 0.0 && kernel.slope_over_q(q) < 0.0);
    }
}

fn lanes_equal_scalars<const D: usize, K: Kernel<D>>(kernel: K) {
    for block in 0..50 {
        let at = |k: usize| (block * 8 + k) as f64 * 0.009;
        let plain = Lanes::<f64, 8, false>::from_fn(at);
        let fused = Lanes::<f64, 8, true>::from_fn(at);
        for k in 0..8 {
            let (f, slope) = (kernel.shape(at(k)), kernel.slope_over_q(at(k)));
            assert_eq!(kernel.shape(plain).extract(k), f);
            assert_eq!(kernel.slope_over_q(plain).extract(k), slope);
            let scale = kernel.shape(0.0);
            assert!((kernel.shape(fused).extract(k) - f).abs() < 1e-14 * scale);
            assert!((kernel.slope_over_q(fused).extract(k) - slope).abs() < 1e-13 * scale);
        }
    }
}

fn recommends_what_it_accepts<const D: usize, K: Kernel<D>>(kernel: K) {
    let (low, high) = kernel.h_over_dx_range();
    assert!(low <= kernel.h_over_dx() && kernel.h_over_dx() <= high);
    if D == 1 {
        assert!(low <= 1.0 && high >= 2.0);
    }
}

/// −∇W's slope factor and its derivative: F(r) = f′(q)/q/h² and (dF/dr)/r, both times σ/hᴰ.
fn gradient_factors<const D: usize, K: Kernel<D>>(kernel: K, r: f64, h: f64) -> (f64, f64) {
    let scale = kernel.normalisation() / h.powi(D as i32 + 2);
    let q = r / h;
    let step = 1e-5;
    let derivative = (kernel.slope_over_q(q + step) - kernel.slope_over_q(q - step)) / (2.0 * step);
    (scale * kernel.slope_over_q(q), scale * derivative / (h * r))
}

/// The highest and lowest ω² h²/c² of small waves on a lattice with the primitive vectors `basis`
/// and one particle per unit volume, at pressure p = `ratio` ρ c². Wave vectors run over a grid of
/// the reciprocal cell.
fn lattice_spectrum<const D: usize, K: Kernel<D>>(
    kernel: K,
    basis: [[f64; D]; D],
    reciprocal: [[f64; D]; D],
    h: f64,
    ratio: f64,
) -> (f64, f64) {
    let reach = (2.0 * kernel.support() * h).ceil() as i32 + 1;
    let span = (2 * reach + 1) as usize;
    let mut neighbours = Vec::new();
    for index in 0..span.pow(D as u32) {
        let mut rest = index;
        let mut r = [0.0; D];
        for vector in basis {
            let n = (rest % span) as i32 - reach;
            rest /= span;
            for d in 0..D {
                r[d] += n as f64 * vector[d];
            }
        }
        let distance = r.iter().map(|x| x * x).sum::<f64>().sqrt();
        if distance > 1e-9 && distance < kernel.support() * h {
            neighbours.push((r, gradient_factors(kernel, distance, h)));
        }
    }
    let points: usize = [64, 16, 8][D - 1];
    let (mut highest, mut lowest) = (f64::MIN, f64::MAX);
    for index in 1..points.pow(D as u32) {
        let mut rest = index;
        let mut k = [0.0; D];
        for vector in reciprocal {
            let n = (rest % points) as f64 / points as f64;
            rest /= points;
            for d in 0..D {
                k[d] += 2.0 * PI * n * vector[d];
            }
        }
        let mut matrix = [[0.0; 3]; 3];
        let mut q = [0.0; D];
        for (r, (factor, derivative)) in &neighbours {
            let phase: f64 = (0..D).map(|d| k[d] * r[d]).sum();
            for a in 0..D {
                q[a] += phase.sin() * factor * r[a];
                for b in 0..D {
                    let hessian = derivative * r[a] * r[b] + if a == b { *factor } else { 0.0 };
                    matrix[a][b] += 2.0 * ratio * (1.0 - phase.cos()) * hessian;
                }
            }
        }
        for a in 0..D {
            for b in 0..D {
                matrix[a][b] += (1.0 - 2.0 * ratio) * q[a] * q[b];
            }
        }
        let eigenvalues =
            nalgebra::DMatrix::from_fn(D, D, |a, b| matrix[a][b]).symmetric_eigenvalues();
        highest = highest.max(eigenvalues.max() * h * h);
        lowest = lowest.min(eigenvalues.min() * h * h);
    }
    (highest, lowest)
}

/// The stable step of a leapfrog, 2/ω, over lattices and pressures, at the ratio `h_over_dx`.
fn stable_step<const D: usize, K: Kernel<D>>(kernel: K, h_over_dx: f64) -> f64 {
    let mut step = f64::MAX;
    for close_packed in [false, true] {
        for ratio in [0.0, 0.6] {
            let (basis, reciprocal) = lattice::<D>(close_packed);
            let (highest, _) = lattice_spectrum(kernel, basis, reciprocal, h_over_dx, ratio);
            step = step.min(2.0 / highest.sqrt());
        }
    }
    step
}

/// Primitive vectors, and their reciprocals, of the Cartesian or the close-packed lattice (none
/// other in 1D, hexagonal in 2D, face-centred in 3D) with one particle per unit volume.
fn lattice<const D: usize>(close_packed: bool) -> ([[f64; D]; D], [[f64; D]; D]) {
    let rows: Vec<Vec<f64>> = match (D, close_packed) {
        (2, true) => {
            let a = (2.0 / 3f64.sqrt()).sqrt();
            vec![vec![a, 0.0], vec![0.5 * a, 0.75f64.sqrt() * a]]
        }
        (3, true) => {
            let a = 0.5 * 4f64.cbrt();
            vec![vec![0.0, a, a], vec![a, 0.0, a], vec![a, a, 0.0]]
        }
        _ => (0..D)
            .map(|a| (0..D).map(|b| f64::from(a == b)).collect())
            .collect(),
    };
    let matrix = nalgebra::DMatrix::from_fn(D, D, |a, b| rows[a][b]);
    let inverse = matrix.clone().try_inverse().expect("a lattice").transpose();
    (
        core::array::from_fn(|a| core::array::from_fn(|b| matrix[(a, b)])),
        core::array::from_fn(|a| core::array::from_fn(|b| inverse[(a, b)])),
    )
}

fn states_its_stable_step<const D: usize, K: Kernel<D>>(kernel: K) {
    let step = stable_step(kernel, kernel.h_over_dx());
    let error = kernel.stable_step() / step - 1.0;
    assert!(
        (-0.02..=0.001).contains(&error),
        "{} in {D}D: {} against {step}",
        kernel.name(),
        kernel.stable_step()
    );
}

/// A safety factor below 0.7 covers every ratio that is accepted.
fn steps_hold_over_the_range<const D: usize, K: Kernel<D>>(kernel: K) {
    let (low, high) = kernel.h_over_dx_range();
    let points = [8, 6, 4][D - 1];
    for n in 0..=points {
        let h_over_dx = low + (high - low) * n as f64 / points as f64;
        let step = stable_step(kernel, h_over_dx);
        assert!(
            step > 0.69 * kernel.stable_step(),
            "{} {D}D {h_over_dx}: {step}",
            kernel.name()
        );
    }
}

/// Above its range the cubic spline pairs: the lattice becomes strongly unstable.
#[test]
fn cubic_pairs_beyond_its_range() {
    let (basis, reciprocal) = lattice::<2>(true);
    let lowest =
        |h: f64| lattice_spectrum(CubicSpline, basis, reciprocal, h, 0.6).1 / (PI * h).powi(2);
    assert!(lowest(1.2) > -5e-4, "{}", lowest(1.2));
    assert!(lowest(1.35) < -1e-2, "{}", lowest(1.35));
}

macro_rules! tests_of {
    ($Kernel:ident: $($property:ident)*) => { $(
        #[test]
        fn $property() {
            super::$property::<1, _>($Kernel);
            super::$property::<2, _>($Kernel);
            super::$property::<3, _>($Kernel);
        }
    )* };
}

macro_rules! tests_of_all {
    ($($Kernel:ident $name:literal),*) => { $(
        #[allow(non_snake_case)]
        mod $Kernel {
            use crate::kernel::$Kernel;
            tests_of! { $Kernel:
                integrates_to_one
                is_zero_beyond_support
                slope_is_the_derivative
                is_finite_at_zero
                folds_constants_into_the_same_gradient
                falls_with_distance
                lanes_equal_scalars
                recommends_what_it_accepts
                states_its_stable_step
                steps_hold_over_the_range
            }
        }
    )* };
}
for_each_kernel!(tests_of_all);

/// At whole h/dx the B-splines sum to one on a lattice, wherever it lies.
#[test]
fn splines_partition_unity_in_one_dimension() {
    fn check<K: Kernel<1>>(kernel: K) {
        for h in [1.0, 2.0] {
            for shift in [0.0, 0.1, 0.37, 0.5] {
                let sum: f64 = (-8..=8)
                    .map(|k| {
                        kernel.normalisation() / h * kernel.shape((k as f64 + shift).abs() / h)
                    })
                    .sum();
                assert!(
                    (sum - 1.0).abs() < 1e-15 * 8.0,
                    "{} {h} {sum}",
                    kernel.name()
                );
            }
        }
    }
    check(CubicSpline);
    check(QuarticSpline);
    check(QuinticSpline);
}

/// The Fourier transform in D dimensions, ∫ W(q) [cos kq, J₀(kq), sin(kq)/(kq)] dᴰq.
fn transform<const D: usize, K: Kernel<D>>(kernel: K, k: f64) -> f64 {
    let wave = |x: f64| match D {
        1 => x.cos(),
        // J₀ by its integral over the angle; the midpoint rule converges at once.
        2 => {
            (0..64)
                .map(|j| (x * ((j as f64 + 0.5) * PI / 64.0).sin()).cos())
                .sum::<f64>()
                / 64.0
        }
        _ if x < 1e-9 => 1.0,
        _ => x.sin() / x,
    };
    kernel.normalisation() * integral(kernel, |q| wave(k * q))
}

/// No negative lobe, so no pairing (Dehnen & Aly 2012); the cubic spline in 2D and 3D has one.
#[test]
fn wendland_transforms_are_positive() {
    fn lowest<const D: usize, K: Kernel<D>>(kernel: K) -> f64 {
        (0..60)
            .map(|n| transform(kernel, 0.25 * n as f64))
            .fold(f64::MAX, f64::min)
    }
    macro_rules! positive {
        ($($Kernel:ident)*) => { $(
            assert!(lowest::<1, _>($Kernel) > -1e-12);
            assert!(lowest::<2, _>($Kernel) > -1e-12);
            assert!(lowest::<3, _>($Kernel) > -1e-12);
        )* };
    }
    positive!(WendlandC2 WendlandC4 WendlandC6);
    assert!(lowest::<2, _>(CubicSpline) < -1e-4);
    assert!(lowest::<3, _>(CubicSpline) < -1e-4);
}

/// Standard deviations in units of h, from exact moments of the polynomials.
#[test]
fn second_moments() {
    fn deviation<const D: usize, K: Kernel<D>>(kernel: K) -> f64 {
        (kernel.normalisation() * integral(kernel, |q| q * q) / D as f64).sqrt()
    }
    let table = [
        (deviation::<3, _>(CubicSpline), 0.548),
        (deviation::<3, _>(QuarticSpline), 0.619),
        (deviation::<3, _>(QuinticSpline), 0.683),
        (deviation::<3, _>(WendlandC2), 0.516),
        (deviation::<3, _>(WendlandC4), 0.453),
        (deviation::<3, _>(WendlandC6), 0.408),
        (deviation::<1, _>(WendlandC4), 0.516),
        (deviation::<1, _>(WendlandC6), 0.453),
    ];
    for (computed, stated) in table {
        assert!(
            (computed - stated).abs() < 6e-4,
            "{computed} against {stated}"
        );
    }
    // A B-spline of order n on unit knots has variance n/12.
    assert!((deviation::<1, _>(CubicSpline).powi(2) - 4.0 / 12.0).abs() < 1e-13);
    assert!((deviation::<1, _>(QuarticSpline).powi(2) - 5.0 / 12.0).abs() < 1e-13);
    assert!((deviation::<1, _>(QuinticSpline).powi(2) - 6.0 / 12.0).abs() < 1e-13);
}

#[test]
fn kinds_have_names_and_types() {
    for &kind in KernelKind::ALL {
        assert_eq!(kind.to_string().parse(), Ok(kind));
        let at_zero: f64 = Kernel::<3>::shape(&kind, 0.0);
        assert!(at_zero > 0.0);
    }
    assert_eq!("Wendland_C2".parse(), Ok(KernelKind::WendlandC2));
    let message = "spiky".parse::<KernelKind>().map_err(|e| e.to_string());
    assert!(message.is_err_and(|m| m.contains("`spiky`") && m.contains("quintic")));
}
