//! A raft that floats in a tank with a flap hinged below it: two groups, and joints with springs, dampers and a motor.
//! One scene for restarts with and without ranks.

use meshfree::boundary::Wall;
use meshfree::coupling::Joint;
use meshfree::material::eos::Linear;
use meshfree::material::{Material, SoundSpeed};
use meshfree::prelude::*;

const G: f64 = 9.81;
const WIDTH: f64 = 0.6;
const DEPTH: f64 = 0.24;
/// Lower and upper corners \[m\] of raft and flap.
const RAFT: [[f64; 2]; 2] = [[0.2, 0.2], [0.4, 0.28]];
const FLAP: [[f64; 2]; 2] = [[0.28, 0.08], [0.32, 0.18]];

/// With particles `dx` \[m\] apart, of which 0.02 is a multiple.
pub fn raft_with_flap(dx: f64) -> Scene<f64, 2> {
    let count = |length: f64| (length / dx).round() as u32;
    let at = |k: u32| dx * (f64::from(k) + 0.5);
    let cells = (0..count(DEPTH)).flat_map(|j| (0..count(WIDTH)).map(move |i| [at(i), at(j)]));
    let wet = |x: &[f64; 2]| {
        let within = |[low, high]: [[f64; 2]; 2]| (0..2).all(|d| low[d] < x[d] && x[d] < high[d]);
        !within(RAFT) && !within(FLAP)
    };
    let liquid = catalogue::water_at(SoundSpeed::Chosen(20.0));
    let water = Body::points_of("water", liquid, cells.filter(wet).collect(), dx)
        .hydrostatic([0.0, -G], [0.0, DEPTH]);
    let solid = |name, density, [low, high]: [[f64; 2]; 2]| {
        Body::block(
            name,
            Material::new("wood", Linear::new(density, 20.0)),
            low,
            high,
            dx,
        )
    };
    let sides = [[true; 2], [true, false]];
    let heave = Joint::slider([0.3, 0.24], [0.0, 1.0])
        .stiffness(500.0)
        .damping(5.0);
    let swing = Joint::hinge([0.3, 0.19], [0.0, 0.0, 1.0]);
    let swing = swing
        .stiffness(5.0)
        .damping(0.05)
        .force(|t| 0.5 * (40.0 * t).sin());
    Scene::new(schemes::weakly_compressible())
        .body(water)
        .wall(Wall::around("tank", [0.0; 2], [WIDTH, 0.4], dx, 4, sides))
        .group(
            schemes::impact_by_continuity(),
            [solid("raft", 400.0, RAFT), solid("flap", 700.0, FLAP)],
        )
        .rigid("raft")
        .rigid("flap")
        .between("raft", "flap", Interaction::None)
        .between("raft", "tank", Interaction::None)
        .between("flap", "tank", Interaction::None)
        .joint_to_ground("raft", heave)
        .joint("flap", "raft", swing)
        .acceleration(|_| [0.0, -G])
}
