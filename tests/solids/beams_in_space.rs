//! Clamped beams of square section, six thicknesses long: what few particles through them cost a frequency in three dimensions.
//! Quadratic bricks of finite elements give 0.989 of Euler and Bernoulli's first frequency, at ν = 0.3.

use meshfree::effect::{HourglassFree, NeoHookean};
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::scene::advice::{Known, Need};
use meshfree::scheme::Start;
use std::f64::consts::TAU;

const RHO: f64 = 1000.0;
const YOUNGS: f64 = 1e6;
const POISSON: f64 = 0.3;
/// Thickness, and length from the last held particles to the free face, in spacings of 1 cm.
const DX: f64 = 0.01;

fn elastic() -> Material<f64> {
    let law = Linear::from_elastic_constants(RHO, YOUNGS, POISSON);
    Material::new("elastic", law).with_shear_modulus(YOUNGS / (2.0 * (1.0 + POISSON)))
}

/// A beam with n × n particles in its section, 6 n columns that are free and three that are held: particles are held at
/// x ≤ 0, and the beam ends half a spacing behind the last.
fn beam(n: usize, start: impl Fn(f64) -> f64 + 'static) -> Body<f64, 3> {
    let size = [(6 * n + 3) as f64 * DX, n as f64 * DX, n as f64 * DX];
    Body::block("beam", elastic(), [0.0; 3], size, DX)
        .displace(|[x, y, z]| [x - 2.5 * DX, y, z])
        .start(move |[x, _, _], own| Start {
            velocity: [0.0, start(x), 0.0],
            ..own
        })
}

/// The first frequency over that of finite elements, less one.
fn error(n: usize, scheme: Scheme<f64, 3>) -> f64 {
    let (thick, long) = (n as f64 * DX, (6.0 * n as f64 + 0.5) * DX);
    let speed = (YOUNGS / RHO).sqrt();
    let omega = 0.989 * 1.875_104_f64.powi(2) * speed * thick / (12.0_f64.sqrt() * long * long);
    // The shape under an even load, which is nearly the first mode.
    let mode = move |x: f64| {
        let share = (x / long).max(0.0);
        share * share * (2.0 - 4.0 / 3.0 * share + share * share / 3.0)
    };
    let mut scene = Scene::new(scheme)
        .body(beam(n, move |x| 0.03 * mode(x)))
        .fix("beam", move |[x, _, _]| *x < 0.25 * DX)
        .build()
        .unwrap();
    let first: Vec<[f64; 3]> = scene.all().map(|p| p.position()).collect();
    let bent = |now: &Simulation<f64, 3>| -> f64 {
        let parts = now.all().map(|p| {
            let x = first[p.id()];
            (p.position()[1] - x[1]) * mode(x[0])
        });
        parts.sum()
    };
    let period = TAU / omega;
    scene.run_until(0.3 * period).unwrap();
    let mut before = [scene.time(), bent(&scene)];
    assert!(before[1] > 0.0);
    loop {
        scene.run_until(before[0] + 0.01 * period).unwrap();
        let now = [scene.time(), bent(&scene)];
        if now[1] < 0.0 {
            let half = before[0] + before[1] * (now[0] - before[0]) / (before[1] - now[1]);
            return 0.5 * period / half - 1.0;
        }
        assert!(now[0] < period, "the beam does not come back");
        before = now;
    }
}

fn total(ratio: f64) -> Scheme<f64, 3> {
    schemes::total_lagrangian()
        .with(NeoHookean)
        .h_over_dx(ratio)
        .compose()
}

/// The table of docs/solids.md at four particles. Its values are eigenvalues of the linear equations of the same particles.
#[test]
fn four_particles_cost_what_the_table_says() {
    let [near, wide] = [0.8, 1.0].map(|ratio| error(4, total(ratio)));
    let updated = schemes::updated_lagrangian()
        .h_over_dx(1.0)
        .with(HourglassFree::default());
    let updated = error(4, updated.compose());
    println!("error of the first frequency, n = 4: {near:.4}, {wide:.4}; updated {updated:.4}");
    assert!((near + 0.069).abs() < 0.002, "{near}");
    assert!((wide + 0.133).abs() < 0.002, "{wide}");
    assert!((updated + 0.129).abs() < 0.003, "{updated}");
}

#[test]
fn advice_says_what_few_particles_cost() {
    let advice = |n| {
        let scene = Scene::new(total(1.0)).body(beam(n, |_| 0.0));
        scene.advise(1.0, &Known::default())
    };
    let lines = [4, 6, 8].map(|n| {
        let advice = advice(n);
        let mut lines = advice.of("spacing across what bends in space");
        lines.next().expect("a line").clone()
    });
    for (line, value) in lines.iter().zip([4.0, 6.0, 8.0]) {
        assert!((line.value - value).abs() < 1e-9, "{line}");
    }
    let needs = lines.map(|line| line.need);
    assert_eq!(needs, [Need::Optional, Need::Optional, Need::Skip]);
}
