//! Vortices without walls at high Reynolds numbers: Taylor and Green's at 10⁴, and Gresho's.
//! Others open voids along the strained lattice and lose the vortex; shifting with held volumes closes them.

use super::harness::{Cures, Row, Varied, seed};
use meshfree::material::SoundSpeed;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::simulation::{StabilityReport, Thresholds};
use std::f64::consts::TAU;

const SOUND: f64 = 10.0;
const RHO: f64 = 1000.0;

const CLOSED: Cures = Cures {
    shifting: Shifting::CLOSED,
    volume: 0.05,
    ..Cures::NONE
};

/// A periodic square of liquid with a flow and its pressure; voids are looked for away from the period alone.
fn vortex(
    cures: Cures,
    count: usize,
    flow: impl Fn([f64; 2]) -> ([f64; 2], f64),
) -> Simulation<f64, 2> {
    let water = catalogue::water_at(SoundSpeed::Chosen(SOUND));
    let body = Body::block("water", water, [0.0; 2], [1.0; 2], 1.0 / count as f64)
        .jitter(0.01, seed(9))
        .start(|x, start| {
            let (velocity, pressure) = flow(x);
            Start {
                velocity,
                density: RHO + pressure / (SOUND * SOUND),
                ..start
            }
        });
    let mut own = Scene::new(cures.liquid())
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .varied()
        .build()
        .expect("a vortex");
    own.keep_stability(Thresholds::default());
    own
}

/// ν = α h c/8 of the artificial viscosity in the plane, solved for α.
fn alpha(viscosity: f64, count: usize) -> f64 {
    8.0 * viscosity / (1.5 / count as f64 * SOUND)
}

/// Kinetic energy at 1 s over the exact one less one, and the report.
fn taylor_green(cures: Cures, count: usize) -> (f64, StabilityReport) {
    let reynolds = 1e4;
    let cures = Cures {
        alpha: alpha(1.0 / reynolds, count),
        ..cures
    };
    let mut own = vortex(cures, count, |[x, y]| {
        let ([sx, cx], [sy, cy]) = ((TAU * x).sin_cos().into(), (TAU * y).sin_cos().into());
        let pressure = 0.25 * RHO * ((2.0 * TAU * x).cos() + (2.0 * TAU * y).cos());
        ([sx * cy, -cx * sy], pressure)
    });
    let before = own.ledger().whole.kinetic;
    own.run_until(1.0).expect("a run");
    let exact = (-4.0 * TAU * TAU / reynolds).exp();
    let report = own.stability();
    println!("{cures:?}\n{report}");
    (own.ledger().whole.kinetic / before / exact - 1.0, report)
}

#[test]
fn taylor_greens_vortices_keep_their_energy_at_reynolds_10000() {
    let (value, report) = taylor_green(CLOSED, 50);
    let (control, plain) = taylor_green(Cures::NONE, 50);
    assert!(report.verdict.is_stable(), "{report}");
    let row = |criterion, value, control| Row {
        case: "Taylor–Green, Re 10⁴, 50²",
        criterion,
        value,
        control,
    };
    row(
        "energy at 1 s over the exact less one",
        value.abs(),
        control.abs(),
    )
    .at_most(0.1);
    let void = |report: &StabilityReport| report.void.as_ref().map_or(0.0, |void| void.0);
    println!("voids {} {}", void(&report), void(&plain));
}

/// L1 error of the azimuthal velocity of Gresho's vortex at 1 s over its peak.
fn gresho(cures: Cures, count: usize) -> f64 {
    let azimuthal = |r: f64| (5.0 * r).min(2.0 - 5.0 * r).max(0.0);
    let pressure = |r: f64| {
        let inner = 12.5 * r * r;
        let outer = |r: f64| 12.5 * r * r - 20.0 * r + 4.0 * (5.0 * r).ln() + 4.0;
        let far = outer(0.4);
        RHO * (if r < 0.2 {
            inner
        } else if r < 0.4 {
            outer(r)
        } else {
            far
        } - far)
    };
    let mut own = vortex(cures, count, |[x, y]| {
        let (dx, dy) = (x - 0.5, y - 0.5);
        let r = dx.hypot(dy).max(1e-9);
        let speed = azimuthal(r);
        ([-speed * dy / r, speed * dx / r], pressure(r))
    });
    own.run_until(1.0).expect("a run");
    println!("{}", own.stability());
    let mut sum = 0.0;
    for p in own.all() {
        let [dx, dy] = p.position().map(|x| x - 0.5);
        let ([u, v], r) = (p.velocity(), dx.hypot(dy).max(1e-9));
        sum += ((v * dx - u * dy) / r - azimuthal(r)).abs();
    }
    sum / own.particles() as f64
}

#[test]
fn greshos_vortex_keeps_its_shape() {
    Row {
        case: "Gresho's vortex, 50²",
        criterion: "L1 error of the azimuthal velocity at 1 s",
        value: gresho(CLOSED, 50),
        control: gresho(Cures::NONE, 50),
    }
    .at_most(0.03);
}
