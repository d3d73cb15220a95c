//! A drop that a straining flow draws out to twice its height, with the exact semi-axes of Monaghan (1994).
//! Others lose its area and its evenness: lattices that are squeezed along an axis pair or fold.

use super::harness::{Cures, Row, Varied, seed};
use meshfree::material::SoundSpeed;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::simulation::Thresholds;

const RATE: f64 = 100.0;
const END: f64 = 0.0076;
const RHO: f64 = 1000.0;

/// Semi-axes \[m\] along x and y at the end, of the ordinary differential equations of an incompressible drop of radius 1 m
/// with v = (−A x, A y) and no pressure at its rim: ȧ = −A a, ḃ = A b, Ȧ = A² (a² − b²)/(a² + b²).
fn exact() -> [f64; 2] {
    let rates = |[a, b, s]: [f64; 3]| {
        let ratio = (a * a - b * b) / (a * a + b * b);
        [-s * a, s * b, s * s * ratio]
    };
    let steps = 1000;
    let dt = END / f64::from(steps);
    let moved = |y: [f64; 3], by: [f64; 3], dt: f64| [0, 1, 2].map(|k| y[k] + dt * by[k]);
    let mut y = [1.0, 1.0, RATE];
    for _ in 0..steps {
        let k1 = rates(y);
        let k2 = rates(moved(y, k1, 0.5 * dt));
        let k3 = rates(moved(y, k2, 0.5 * dt));
        let k4 = rates(moved(y, k3, dt));
        let mean = [0, 1, 2].map(|k| (k1[k] + 2.0 * (k2[k] + k3[k]) + k4[k]) / 6.0);
        y = moved(y, mean, dt);
    }
    [y[0], y[1]]
}

/// Errors of the semi-axis along y and of the product of both at the end, and the least quantile of nearest neighbours.
fn drop(cures: Cures, count: usize) -> [f64; 3] {
    let spacing = 2.0 / count as f64;
    let water = catalogue::water_at(SoundSpeed::Chosen(1400.0));
    // The pressure of the incompressible drop: p = ρ A² (1 − r²)/2 at first.
    let strained = |[x, y]: [f64; 2], start| Start {
        velocity: [-RATE * x, RATE * y],
        density: RHO + 0.5 * RHO * RATE * RATE * (1.0 - x * x - y * y) / 1400.0_f64.powi(2),
        ..start
    };
    let body = Body::fill("drop", water, &Ball::new([0.0; 2], 1.0), spacing)
        .jitter(0.01, seed(3))
        .start(strained);
    let scene = Scene::new(cures.liquid()).body(body);
    let mut simulation = scene.varied().build().expect("a drop");
    simulation.keep_stability(Thresholds::default());
    simulation.run_until(END).expect("a run");
    // Of an ellipse the mean square of a coordinate is a quarter of the square of its semi-axis.
    let axis = |d: usize| {
        let squares = simulation.all().map(|p| p.position()[d].powi(2));
        2.0 * (squares.sum::<f64>() / simulation.particles() as f64).sqrt()
    };
    let report = simulation.stability();
    println!("{report}");
    let [a, b] = exact();
    println!("axes {} {}, exact {a} {b}", axis(0), axis(1));
    [
        (axis(1) / b - 1.0).abs(),
        (axis(0) * axis(1) / (a * b) - 1.0).abs(),
        report.quantile.unwrap_or(0.0),
    ]
}

#[test]
fn an_elliptic_drop_keeps_its_axes_and_its_particles_apart() {
    let [axis, area, apart] = drop(Cures::EVEN, 60);
    let [plain_axis, plain_area, plain_apart] = drop(Cures::NONE, 60);
    println!("error of the long axis {axis}, control {plain_axis}");
    assert!(axis < 0.01, "{axis}");
    let row = |criterion, value, control| Row {
        case: "elliptic drop, 60 across",
        criterion,
        value,
        control,
    };
    row("error of the product of the axes", area, plain_area).at_most(0.02);
    row("closest 0.1 %", apart, plain_apart).at_least(0.5);
}
