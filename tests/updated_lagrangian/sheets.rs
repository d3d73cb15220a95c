//! Sheets in plane stress that are pulled beyond yield, and a square that turns once with its stress.
//! Closed forms of linear hardening in simple and in equal biaxial tension.

use super::{Cure, elastic, plane};
use meshfree::effect::{Hypoelastic, PlaneStress, Plasticity};
use meshfree::material::strength::LinearHardening;
use meshfree::prelude::*;
use std::f64::consts::TAU;

const YOUNG: f64 = 1e9;
const POISSON: f64 = 0.3;
const YIELD: f64 = 1e6;
const HARDENING: f64 = 2e8;

/// Stresses σ_xx, σ_yy, σ_zz over the yield stress, plastic strain and ε_zz of the middle of a sheet that is strained
/// along x to `end`, and along y by what is given of each step's strain.
fn pulled(end: f64, along_y: impl Fn(f64) -> f64) -> [f64; 5] {
    let material = elastic(YOUNG, POISSON).with_strength(LinearHardening::new(YIELD, HARDENING));
    let scheme = schemes::impact_by_continuity()
        .with(Hypoelastic)
        .with(PlaneStress)
        .with(Plasticity);
    let mut sheet = Scene::<f64, 2>::new(scheme)
        .body(Body::block("sheet", material, [0.0; 2], [1.0; 2], 0.1))
        .build()
        .unwrap();
    let mut strain = 0.0;
    const RATE: f64 = 10.0;
    while strain < end {
        let lateral = RATE * along_y(strain);
        sheet
            .set_field("sheet", Field::VELOCITY, |[x, y], [_, _]| {
                [RATE * x, lateral * y]
            })
            .unwrap();
        strain += RATE * sheet.step_at_most(2e-6).unwrap();
    }
    let middle = sheet
        .all()
        .find(|p| p.position().iter().all(|x| (x - 0.55).abs() < 0.04))
        .unwrap();
    let stress = middle.tensor(Hypoelastic::STRESS).unwrap();
    let [xx, yy, zz, ..] = *stress.components();
    let [xx, yy, zz] = [xx, yy, zz].map(|s| (s - middle.pressure()) / YIELD);
    let scalar = |field| middle.scalar(field).unwrap();
    let over = strain / end;
    [
        xx,
        yy,
        zz,
        scalar(Plasticity::STRAIN) / over,
        scalar(PlaneStress::THICKNESS_STRAIN) / over,
    ]
}

/// σ_xx follows the bilinear curve, and the sheet thins as much as it narrows.
#[test]
fn simple_tension_of_a_sheet_follows_the_bilinear_curve() {
    let tangent = YOUNG * HARDENING / (YOUNG + HARDENING);
    let first = YIELD / YOUNG;
    let flow = 1.0 - tangent / YOUNG;
    let narrows = move |strain: f64| {
        if strain < first {
            -POISSON
        } else {
            -POISSON * tangent / YOUNG - 0.5 * flow
        }
    };
    let [xx, yy, zz, plastic, thins] = pulled(0.5 * first, narrows);
    println!("elastic: {xx} {yy} {zz} {plastic} {thins}");
    assert!((xx - 0.5).abs() < 3e-3 && yy.abs() < 1e-3 && zz.abs() < 1e-9);
    assert!(plastic == 0.0 && (thins / (-0.5 * POISSON * first) - 1.0).abs() < 5e-3);
    let end = 5.0 * first;
    let found = pulled(end, narrows);
    let beyond = end - first;
    let exact = [
        1.0 + tangent * beyond / YIELD,
        0.0,
        0.0,
        flow * beyond,
        -POISSON * first + narrows(end) * beyond,
    ];
    println!("plastic: {found:?}, exact {exact:?}");
    assert!((found[0] / exact[0] - 1.0).abs() < 5e-3);
    assert!(found[1].abs() < 1e-2 && found[2].abs() < 1e-9);
    assert!((found[3] / exact[3] - 1.0).abs() < 5e-3);
    assert!((found[4] / exact[4] - 1.0).abs() < 5e-3);
}

/// In equal biaxial tension the sheet thins by all that flows.
#[test]
fn biaxial_tension_of_a_sheet_thins_it() {
    let slope = YOUNG / (1.0 - POISSON);
    let first = YIELD / slope;
    let found = pulled(6.0 * first, |_| 1.0);
    // e = σ/E' + (σ − Y)/2H.
    let beyond = 5.0 * first;
    let stress = YIELD + beyond / (1.0 / slope + 0.5 / HARDENING);
    let plastic = (stress - YIELD) / HARDENING;
    let exact = [
        stress / YIELD,
        stress / YIELD,
        0.0,
        plastic,
        -2.0 * POISSON * stress / YOUNG - plastic,
    ];
    println!("biaxial: {found:?}, exact {exact:?}");
    assert!(found[2].abs() < 1e-9);
    for k in [0, 1, 3, 4] {
        assert!((found[k] / exact[k] - 1.0).abs() < 5e-3, "{k}");
    }
}

/// Particles go round on their circles in chords, so that nothing strains; the stress turns with them.
#[test]
fn a_turn_leaves_the_stress_of_a_square_as_it_was() {
    const STEPS: u32 = 720;
    let stress = [3.0, -1.0, -2.0, 0.0, 0.0, 0.5];
    let body = Body::block("square", elastic(1e3, POISSON), [-0.5; 2], [0.5; 2], 0.1);
    let body = body.field(Hypoelastic::STRESS, |_| stress);
    let mut square = Scene::new(plane(Cure::None)).body(body).build().unwrap();
    let dt = 1e-3;
    let angle = TAU / f64::from(STEPS);
    let [along, across] = [(angle.cos() - 1.0) / dt, angle.sin() / dt];
    for _ in 0..STEPS {
        square
            .set_field("square", Field::VELOCITY, |[x, y], [_, _]| {
                [along * x - across * y, along * y + across * x]
            })
            .unwrap();
        let taken = square.step_at_most(dt).unwrap();
        assert!((taken / dt - 1.0).abs() < 1e-9, "{taken}");
    }
    let mut worst: f64 = 0.0;
    for p in square
        .all()
        .filter(|p| p.position().iter().all(|x| x.abs() < 0.2))
    {
        let now = p.tensor(Hypoelastic::STRESS).unwrap();
        for (a, b) in now.components().iter().zip(stress) {
            worst = worst.max((a - b).abs() / 3.0);
        }
    }
    println!("stress after a turn: {worst:e}");
    assert!(worst < 1e-3, "{worst}");
}
