//! Longitudinal and shear waves in uniaxial strain, uniaxial stress, plane strain, plane stress and in space.
//! Speeds of standing waves of 50 spacings, against those of the elastic constants.

use super::{RHO, elastic};
use meshfree::effect::{Hypoelastic, PlaneStress, UniaxialStress};
use meshfree::prelude::*;
use meshfree::scheme::Start;
use std::f64::consts::TAU;

const YOUNG: f64 = 1e7;
const POISSON: f64 = 0.3;
const SHEAR: f64 = YOUNG / (2.0 * (1.0 + POISSON));
const BULK: f64 = YOUNG / (3.0 * (1.0 - 2.0 * POISSON));
const COUNT: usize = 50;

/// The speed of a standing wave along x that moves particles along `axis`, over the one expected \[m/s\].
fn speed<const D: usize>(scheme: Scheme<f64, D>, axis: usize, expected: f64) -> f64 {
    let high = core::array::from_fn(|d| if d == 0 { 1.0 } else { 8.0 / COUNT as f64 });
    let wave = move |x: [f64; D], own: Start<D>| Start {
        velocity: core::array::from_fn(|d| {
            if d == axis {
                1e-3 * (TAU * x[0]).sin()
            } else {
                0.0
            }
        }),
        ..own
    };
    let body = Body::block(
        "box",
        elastic(YOUNG, POISSON),
        [0.0; D],
        high,
        1.0 / COUNT as f64,
    );
    let mut scene = Scene::new(scheme).body(body.start(wave));
    for d in 0..D {
        scene = scene.boundary(Periodic::along(d, 0.0, high[d]));
    }
    let mut scene = scene.build().unwrap();
    let (mut before, mut passed) = ([0.0, 1.0], Vec::new());
    while passed.len() < 2 {
        scene.step().unwrap();
        let amplitude: f64 = scene
            .all()
            .map(|p| p.velocity()[axis] * (TAU * p.position()[0]).sin())
            .sum();
        let now = [scene.time(), amplitude];
        if before[1] * now[1] < 0.0 {
            passed.push(before[0] - before[1] * (now[0] - before[0]) / (now[1] - before[1]));
        }
        before = now;
        assert!(now[0] * expected < 2.0, "no wave");
    }
    0.5 / (passed[1] - passed[0]) / expected
}

#[test]
fn waves_run_at_the_speeds_of_the_elastic_constants() {
    let base = || schemes::impact_by_continuity().with(Hypoelastic);
    let [bulk, bar, sheet, shear] = [
        BULK + 4.0 / 3.0 * SHEAR,
        YOUNG,
        YOUNG / (1.0 - POISSON * POISSON),
        SHEAR,
    ]
    .map(|modulus| (modulus / RHO).sqrt());
    let found = [
        ("uniaxial strain", speed::<1>(base().compose(), 0, bulk)),
        (
            "uniaxial stress",
            speed::<1>(base().with(UniaxialStress).compose(), 0, bar),
        ),
        ("plane strain", speed::<2>(base().compose(), 0, bulk)),
        (
            "plane strain, shear",
            speed::<2>(base().compose(), 1, shear),
        ),
        (
            "plane stress",
            speed::<2>(base().with(PlaneStress).compose(), 0, sheet),
        ),
        (
            "plane stress, shear",
            speed::<2>(base().with(PlaneStress).compose(), 1, shear),
        ),
        (
            "plane strain, corrected",
            speed::<2>(schemes::updated_lagrangian().compose(), 0, bulk),
        ),
        (
            "plane strain, shear, corrected",
            speed::<2>(schemes::updated_lagrangian().compose(), 1, shear),
        ),
        ("space", speed::<3>(base().compose(), 0, bulk)),
        ("space, shear", speed::<3>(base().compose(), 2, shear)),
    ];
    for (name, ratio) in found {
        println!("{name}: {:+.3} %", 100.0 * (ratio - 1.0));
    }
    for (name, ratio) in found {
        assert!((ratio - 1.0).abs() < 0.005, "{name}: {ratio}");
    }
}
