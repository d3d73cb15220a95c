//! Kernels on a uniform row: the first moment by which uncorrected waves run too fast or too slow,
//! and the speed of waves with it and with its cure.

use crate::common::AnyKernel;
use meshfree::boundary::Periodic;
use meshfree::kernel::{CubicSpline, Kernel, KernelKind};
use meshfree::material::Material;
use meshfree::material::eos::Linear;
use meshfree::scene::{Body, Scene, Start};
use meshfree::scheme::{DensityForm, EnergyForm, Scheme, SchemeBuilder};
use meshfree::simulation::{Simulation, StepControl};
use meshfree::term::MidpointReconstruction;
use meshfree::term::viscosity::Inviscid;
use std::f64::consts::PI;

const RATIOS: [f64; 6] = [1.0, 1.1, 1.2, 1.3, 1.5, 2.0];

/// s = −Σ r W′ / Σ W on a row of unit spacing.
fn first_moment<K: Kernel<1>>(kernel: &K, h: f64) -> f64 {
    let (mut moment, mut sum) = (0.0, 0.0);
    for k in -20..=20_i32 {
        let q = f64::from(k.abs()) / h;
        moment -= f64::from(k * k) / (h * h) * kernel.slope_over_q(q);
        sum += kernel.shape(q);
    }
    moment / sum
}

#[test]
fn the_cubic_splines_first_moment_is_off_by_up_to_two_per_cent() {
    let expected = [1.000, 1.010, 1.0205, 1.019, 0.984, 1.000];
    for (h, expected) in RATIOS.into_iter().zip(expected) {
        let s = first_moment(&CubicSpline, h);
        println!("cubic spline at h/dx {h}: s = {s:.5}");
        assert!(
            (s - expected).abs() < 6e-4,
            "h/dx {h}: {s} instead of {expected}"
        );
    }
}

/// Amplitude of the wave's velocity \[m/s\]: small enough for theory that is linear.
const AMPLITUDE: f64 = 1e-4;
const SOUND_SPEED: f64 = 1000.0;

/// A row of one wavelength on which a standing wave swings.
fn standing_wave(
    kernel: KernelKind,
    ratio: f64,
    spacings: usize,
    cure: Cure,
) -> Simulation<f64, 1> {
    let length = spacings as f64;
    let k = 2.0 * PI / length;
    let scheme = SchemeBuilder::new(AnyKernel(kernel), Inviscid)
        .density(DensityForm::NumberDensity)
        .energy(EnergyForm::Compatible)
        .h_over_dx(ratio);
    let scheme: Scheme<f64, 1> = match cure {
        Cure::Nothing => scheme.without_consistency_factor().compose(),
        Cure::Normalisation => scheme.compose(),
        Cure::Both => scheme.with(MidpointReconstruction::STANDARD).compose(),
    };
    let solid = Material::new("linear", Linear::new(1000.0, SOUND_SPEED));
    let row = Body::block("row", solid, [0.0], [length], 1.0).start(|x, start| Start {
        velocity: [AMPLITUDE * (k * x[0]).sin()],
        ..start
    });
    Scene::new(scheme)
        .body(row)
        .boundary(Periodic::along(0, 0.0, length))
        // Errors of the step in the phase, (ω dt)²/24, stay below 10⁻⁶.
        .steps(|control| StepControl {
            fixed: Some(0.03 / SOUND_SPEED),
            ..control
        })
        .build()
        .unwrap()
}

#[derive(Clone, Copy, PartialEq)]
enum Cure {
    Nothing,
    Normalisation,
    Both,
}

/// Speed of a standing wave over that of the material, from the time of its second zero.
fn wave_speed(kernel: KernelKind, ratio: f64, spacings: usize, cure: Cure) -> f64 {
    let mut simulation = standing_wave(kernel, ratio, spacings, cure);
    let k = 2.0 * PI / spacings as f64;
    let start: Vec<f64> = simulation
        .all()
        .map(|p| (k * p.position()[0]).sin())
        .collect();
    let amplitude = |s: &Simulation<f64, 1>| {
        let sum: f64 = s
            .all()
            .zip(&start)
            .map(|(p, sin)| p.velocity()[0] * sin)
            .sum();
        2.0 * sum / spacings as f64
    };
    let (mut zeros, mut before) = (Vec::new(), (0.0, amplitude(&simulation)));
    while zeros.len() < 2 {
        simulation.step().unwrap();
        let now = (simulation.time(), amplitude(&simulation));
        if (now.1 < 0.0) != (before.1 < 0.0) {
            zeros.push(before.0 + (now.0 - before.0) * before.1 / (before.1 - now.1));
        }
        before = now;
    }
    // The velocity goes as cos(c k t): its zeros are half a period apart.
    PI / (zeros[1] - zeros[0]) / (k * SOUND_SPEED)
}

#[test]
fn waves_of_fifty_spacings_run_at_the_sound_speed_for_every_kernel() {
    let mut worst: (f64, String) = (0.0, String::new());
    for &kernel in KernelKind::ALL {
        let (low, high) = Kernel::<1>::h_over_dx_range(&kernel);
        for ratio in RATIOS.into_iter().filter(|r| (low..=high).contains(r)) {
            let error = wave_speed(kernel, ratio, 50, Cure::Both) - 1.0;
            println!("{kernel} at h/dx {ratio}: {:+.4} %", 100.0 * error);
            if error.abs() > worst.0.abs() {
                worst = (error, format!("{kernel} at h/dx {ratio}"));
            }
        }
    }
    assert!(
        worst.0.abs() < 0.002,
        "{}: {:+.4} %",
        worst.1,
        100.0 * worst.0
    );
}

#[test]
fn without_midpoint_reconstruction_they_lag() {
    let error = wave_speed(KernelKind::CubicSpline, 1.2, 50, Cure::Normalisation) - 1.0;
    println!(
        "cubic spline at h/dx 1.2 without curvature: {:+.4} %",
        100.0 * error
    );
    assert!((-0.0043..-0.0033).contains(&error), "{error}");
}

#[test]
fn without_consistency_factor_they_run_at_the_first_moment_times_the_sound_speed() {
    for ratio in RATIOS {
        let speed = wave_speed(KernelKind::CubicSpline, ratio, 400, Cure::Nothing);
        let s = first_moment(&CubicSpline, ratio);
        println!("cubic spline at h/dx {ratio}: {speed:.5} for s = {s:.5}");
        assert!(
            (speed / s - 1.0).abs() < 2e-4,
            "h/dx {ratio}: {speed} for s = {s}"
        );
    }
}

#[test]
fn with_midpoint_reconstruction_the_error_is_of_fourth_order() {
    for kernel in [
        KernelKind::CubicSpline,
        KernelKind::WendlandC2,
        KernelKind::QuinticSpline,
    ] {
        let spacings = [16, 24, 32];
        let errors = spacings.map(|n| (wave_speed(kernel, 1.2, n, Cure::Both) - 1.0).abs());
        let widths = spacings.map(|n| 1.0 / n as f64);
        let order = meshfree::study::norms::observed_order(&widths, &errors)
            .unwrap()
            .order;
        println!("{kernel}: {errors:?}, order {order:.2}");
        assert!(order > 3.5, "{kernel}: {errors:?}, order {order}");
    }
}
