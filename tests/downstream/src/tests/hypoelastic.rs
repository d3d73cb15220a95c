//! The hypoelastic solid against the speed of elastic waves, what must be conserved, and a rotation.

use crate::hypoelastic::{Hypoelastic, STRESS};
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::scheme::Start;
use meshfree::tensor::{Matrix, Symmetric};
use meshfree::term::viscosity::Inviscid;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Density \[kg/m³\], bulk sound speed \[m/s\] and shear modulus \[Pa\].
const RHO: f64 = 1000.0;
const C: f64 = 100.0;
const G: f64 = 5e6;

fn scene<const D: usize>(
    low: [f64; D],
    high: [f64; D],
    start: impl Fn([f64; D]) -> [f64; D],
) -> Scene<f64, D>
where
    CubicSpline: Kernel<D>,
{
    let scheme = SchemeBuilder::new(CubicSpline, Inviscid)
        .density(DensityForm::Continuity)
        .energy(EnergyForm::Compatible)
        .with(Hypoelastic { shear_modulus: G });
    let body = Body::block(
        "bar",
        Material::new("soft", Linear::new(RHO, C)),
        low,
        high,
        0.02,
    );
    let body = body.start(|x, own: Start<D>| Start {
        velocity: start(x),
        ..own
    });
    Scene::new(scheme).body(body)
}
/// The period \[s\] of what swings as cos(ωt), from its first and fifth passage through zero.
fn period<const D: usize>(mut simulation: Simulation<f64, D>, estimate: f64, axis: usize) -> f64 {
    let amplitude = |now: &Simulation<f64, D>| -> f64 {
        now.all()
            .map(|p| p.velocity()[axis] * (TAU * p.position()[0]).sin())
            .sum()
    };
    let mut before = (0.0, amplitude(&simulation));
    let mut zeros = Vec::new();
    simulation
        .run_with(1.3 * estimate, |now| {
            let (time, a) = (now.time(), amplitude(now));
            if a * before.1 < 0.0 {
                zeros.push(before.0 + (time - before.0) * before.1 / (before.1 - a));
            }
            before = (time, a);
        })
        .unwrap();
    zeros[2] - zeros[0]
}

#[test]
fn longitudinal_and_transverse_waves_run_at_their_speeds() {
    // 50 spacings a wavelength, periodic: plane strain, and uniaxial strain in one dimension.
    let longitudinal = (C * C + 4.0 / 3.0 * G / RHO).sqrt();
    let transverse = (G / RHO).sqrt();
    let line = scene([0.0], [1.0], |[x]| [1e-3 * (TAU * x).sin()]);
    let line = line.boundary(Periodic::along(0, 0.0, 1.0)).build().unwrap();
    let plane = |axis: usize| {
        let start = move |[x, _]: [f64; 2]| {
            core::array::from_fn(|d| {
                if d == axis {
                    1e-3 * (TAU * x).sin()
                } else {
                    0.0
                }
            })
        };
        let strip = scene([0.0; 2], [1.0, 0.24], start);
        let strip = strip.boundary(Periodic::along(0, 0.0, 1.0));
        strip
            .boundary(Periodic::along(1, 0.0, 0.24))
            .build()
            .unwrap()
    };
    let speeds = [
        1.0 / period(line, 1.0 / longitudinal, 0) / longitudinal,
        1.0 / period(plane(0), 1.0 / longitudinal, 0) / longitudinal,
        1.0 / period(plane(1), 1.0 / transverse, 1) / transverse,
    ];
    println!("speeds over exact {speeds:?}");
    assert!(
        speeds.iter().all(|speed| (speed - 1.0).abs() < 0.005),
        "{speeds:?}"
    );
}

#[test]
fn a_free_bar_keeps_momentum_and_energy_to_rounding() {
    // It stretches, shears and turns, and sheds waves at its free ends.
    let bar = scene([0.0; 2], [0.8, 0.2], |[x, y]| {
        [
            8.0 * (x - 0.2) - 6.0 * (y - 0.1),
            6.0 * (x - 0.4) + 10.0 * (9.0 * x).sin(),
        ]
    });
    let mut bar = bar.build().unwrap();
    let before = bar.ledger().whole;
    let size: f64 = bar.all().map(|p| p.mass() * p.velocity()[1].abs()).sum();
    let mut exchanged: f64 = 0.0;
    bar.run_with(2e-2, |now| {
        exchanged = exchanged.max(now.ledger().whole.internal);
    })
    .unwrap();
    let after = bar.ledger().whole;
    let drift = (after.total_energy() / before.total_energy() - 1.0).abs();
    let lost = [0, 1].map(|d| (after.momentum[d] - before.momentum[d]).abs() / size);
    let pull = bar
        .all()
        .map(|p| p.tensor(STRESS).unwrap().components()[0].abs());
    let pull = pull.fold(0.0, f64::max);
    println!(
        "{} steps, energy {drift:e}, momentum {lost:?}, stress {pull} Pa, work {exchanged} J",
        bar.steps()
    );
    assert!(exchanged > 0.1 * before.kinetic && pull > 1e4);
    assert!(
        drift < 1e-12 && lost.iter().all(|lost| *lost < 1e-12),
        "{drift} {lost:?}"
    );
}

#[test]
fn a_rigid_rotation_turns_the_stress_and_leaves_it_as_it_was() {
    let stress = Symmetric::new([3.0, -1.0, 0.5, 0.0, 0.0, 2.0]);
    let scheme = SchemeBuilder::new(CubicSpline, Inviscid)
        .density(DensityForm::Continuity)
        .energy(EnergyForm::None)
        .with(Hypoelastic {
            shear_modulus: 100.0,
        });
    let soft = Material::new("soft", Linear::new(RHO, 1.0));
    let body = Body::block("plate", soft, [-0.2; 2], [0.2; 2], 0.02);
    let mut plate = Scene::<f64, 2>::new(scheme)
        .body(body.field(STRESS, |_| *stress.components()))
        .build()
        .unwrap();
    // A quarter turn in steps along chords, which a leapfrog follows exactly.
    let steps = 400;
    let (sine, cosine) = (FRAC_PI_2 / f64::from(steps)).sin_cos();
    let dt = 1e-5;
    for _ in 0..steps {
        plate.set_velocities(|[x, y], _| {
            [
                ((cosine - 1.0) * x - sine * y) / dt,
                (sine * x + (cosine - 1.0) * y) / dt,
            ]
        });
        assert_eq!(plate.step_at_most(dt).unwrap(), dt);
    }
    let turned = stress.rotated(&Matrix::<f64, 2>::new(0.0, -1.0, 1.0, 0.0));
    let size = stress.contract(&stress).sqrt();
    let error = plate.all().map(|p| {
        let off = p.tensor(STRESS).unwrap().plus(-1.0, &turned);
        off.contract(&off).sqrt() / size
    });
    let error = error.fold(0.0, f64::max);
    println!("largest change {error:e}");
    assert!(error < 1e-3, "{error}");
}
