//! A jet of three spacings that strikes a wall and leaves along it as two films of one and a half.
//! Others break thin water up into beads, or stick it to the wall; the momentum that it brings must arrive.

use super::harness::{Cures, Row, Varied, largest_piece, seed};
use meshfree::material::SoundSpeed;
use meshfree::prelude::*;

const SPEED: f64 = 1.0;
const DX: f64 = 0.01;

/// Mean force on the wall over ρ U² b, and the share of the largest piece of the water.
fn strike(cures: Cures) -> [f64; 2] {
    let water: Material<f64> = catalogue::water_at(SoundSpeed::Chosen(20.0));
    let water = water.with_pressure_cut_off(0.0);
    let half = 1.5 * DX;
    let body = Body::block("jet", water, [-1.0, -half], [0.0, half], DX)
        .jitter(0.01, seed(8))
        .velocity([SPEED, 0.0]);
    let sides = [[false, true], [false; 2]];
    let wall = Wall::around("wall", [-0.2, -1.2], [0.0, 1.2], DX, 5, sides);
    let mut jet = Scene::new(cures.liquid())
        .body(body)
        .wall(wall)
        .varied()
        .build()
        .expect("a jet");
    let [from, to] = [0.2, 0.8];
    jet.run_until(from).expect("a run");
    let first = jet.wall_impulse("wall").expect("a wall")[0];
    jet.run_until(to).expect("a run");
    let force = (jet.wall_impulse("wall").expect("a wall")[0] - first) / (to - from);
    let all = jet
        .all()
        .all(|p| p.position().iter().all(|x| x.is_finite()));
    assert!(all, "a place is no number");
    [
        force / (1000.0 * SPEED * SPEED * 3.0 * DX),
        largest_piece(&jet, 2.0 * DX),
    ]
}

/// Five times the viscosity of the ready liquid, and memory of torn water: what water in thin sheets wants.
const THIN: Cures = Cures {
    alpha: 0.1,
    memory: true,
    ..Cures::NONE
};

#[test]
fn a_thin_jet_brings_its_momentum() {
    let [[force, whole], [ready, torn]] = [THIN, Cures::NONE].map(strike);
    println!("largest piece {whole}, ready liquid {torn}");
    Row {
        case: "jet of 3 spacings on a wall",
        criterion: "error of the force, ρ U² b; α = 0.1 and expansion memory, control: ready liquid",
        value: (force - 1.0).abs(),
        control: (ready - 1.0).abs(),
    }
    .at_most(0.02);
}
