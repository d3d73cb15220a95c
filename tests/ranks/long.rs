//! Twenty scenes over three hundred steps with at least five list builds on one to four ranks, with one and two threads each:
//! one set of bits of state, ledgers and history, which is that of a plain run.

use super::one_set_of_bits_on;
use super::parts::turning_plate;
use super::scenes::{
    DX, channel, channel_of_period, corner, crushed_tank, dam_break, down, floating, impact, mixed,
    periodic_gas, plate_at_wall, rod, rod_by_runge_kutta, shaken_block, tank_in_space,
};
use meshfree::boundary::Wall;
use meshfree::effect::{ArbitraryLagrangian, FiveEquations, Hypoelastic};
use meshfree::kernel::WendlandC2;
use meshfree::material::Material;
use meshfree::material::eos::{IdealGas, StiffenedGas};
use meshfree::prelude::*;
use meshfree::scene::Start;
use std::f64::consts::PI;

/// All of one to four ranks with one and two threads.
const ALL: [[usize; 2]; 8] = [
    [1, 1],
    [1, 2],
    [2, 1],
    [2, 2],
    [3, 1],
    [3, 2],
    [4, 1],
    [4, 2],
];

const LEAST: (usize, u64) = (300, 5);

fn long<T: Real, const D: usize>(
    name: &'static str,
    scene: impl Fn() -> Scene<T, D> + Send + Sync + 'static,
) {
    one_set_of_bits_on(&ALL, name, LEAST, scene);
}

/// Water that is thrown about in a closed tank in space.
fn thrown_water() -> Scene<f64, 3> {
    let water = catalogue::weakly_compressible_water(3.0);
    let block = Body::block("water", water, [0.0; 3], [0.12; 3], DX).velocity([2.0, 1.0, 0.5]);
    Scene::new(schemes::weakly_compressible())
        .body(block)
        .wall(Wall::around(
            "tank",
            [0.0; 3],
            [0.16; 3],
            DX,
            3,
            [[true; 2]; 3],
        ))
        .event("late", |now| now.time() > 1e-3)
        .acceleration(down)
}

/// Gas that streams through three periods.
fn gas_in_space() -> Scene<f32, 3> {
    let gas = IdealGas::new(1.4, 1.0);
    let cube = Body::block("gas", Material::new("gas", gas), [0.0; 3], [1.0; 3], 0.08);
    let start = move |x: [f64; 3], start: Start<3>| Start {
        velocity: [2.0 + (2.0 * PI * x[1]).sin(), 1.0, (2.0 * PI * x[0]).sin()],
        energy: gas.energy(1.0, 1.0),
        ..start
    };
    (0..3).fold(
        Scene::new(schemes::gas()).body(cube.start(start)),
        |all, axis| all.boundary(Periodic::along(axis, 0.0, 1.0)),
    )
}

/// A rod in single precision.
fn single_rod() -> Scene<f32, 1> {
    let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 5e-6);
    Scene::new(schemes::impact())
        .body(rod.start(|x, start| Start {
            velocity: [400.0 + 50.0 * (200.0 * PI * x[0]).sin()],
            ..start
        }))
        .boundary(Periodic::along(0, 0.0, 0.01))
}

/// A steel bar that strikes a wall in space.
fn bar_in_space() -> Scene<f64, 3> {
    let steel = catalogue::steel().with_shear_modulus(77e9);
    let bar = Body::block("bar", steel, [0.0; 3], [0.03, 0.01, 0.01], 1e-3);
    Scene::new(schemes::impact_by_continuity().with(Hypoelastic))
        .body(bar.velocity([-300.0, 60.0, 20.0]))
        .boundary(MirrorPlane::wall([-0.0005, 0.0, 0.0], [-1.0, 0.0, 0.0]))
}

/// A dam that breaks, of particles that exchange mass.
fn exchanging() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(4.0);
    let scheme = schemes::weakly_compressible();
    let open = [[true; 2], [true, false]];
    Scene::new(scheme.with(ArbitraryLagrangian::<false>::default()))
        .body(Body::block("water", water, [0.0; 2], [0.4, 0.4], DX))
        .wall(Wall::around("tank", [0.0; 2], [0.8, 0.6], DX, 4, open))
        .acceleration(down)
}

/// Air above water that sloshes.
fn two_fluids() -> Scene<f64, 2> {
    let (water, air) = (StiffenedGas::new(4.4, 1e6, 1000.0), IdealGas::new(1.4, 1.2));
    let scheme = SchemeBuilder::five_equations(WendlandC2, FiveEquations::new(water, air));
    let block = |name, fluid: Material<f64>, low, high, energy| {
        let block = Body::block(name, fluid, [0.0, low], [0.4, high], DX);
        block.energy(energy).velocity([6.0, 0.0])
    };
    let [liquid, gas] = [Material::new("water", water), Material::new("air", air)];
    Scene::new(scheme)
        .body(block("water", liquid, 0.0, 0.2, 1e5 / 3400.0))
        .body(block("air", gas, 0.2, 0.4, 1e5 / 0.48))
        .boundary(Periodic::along(0, 0.0, 0.4))
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [0.4; 2],
            DX,
            3,
            [[false; 2], [true; 2]],
        ))
        .acceleration(|_| [20.0, -9.81])
}

#[test]
#[ignore = "twenty scenes of 300 steps, nine times each: minutes"]
fn twenty_scenes_have_one_set_of_bits_on_one_to_four_ranks() {
    long("dam break", dam_break);
    long("tank in space, f32", tank_in_space);
    long("periodic gas", periodic_gas);
    long("rod", || rod(400.0));
    long("plate at a wall", plate_at_wall);
    long("impact, f32", impact);
    long("channel", channel);
    long("mixed", mixed);
    long("floating", floating);
    long("crushed", crushed_tank);
    long("corner", corner);
    long("period, drift-kick-drift", channel_of_period);
    long("Runge-Kutta", rod_by_runge_kutta);
    long("shaken block", shaken_block);
    long("elastic plate that turns", turning_plate);
    long("thrown water in space", thrown_water);
    long("gas in space, f32", gas_in_space);
    long("rod, f32", single_rod);
    long("bar in space", bar_in_space);
    long("arbitrary Lagrangian", exchanging);
    // Its points stay, and so do its lists.
    one_set_of_bits_on(&ALL, "two fluids", (300, 1), two_fluids);
}
