//! Scenes on ranks: liquids, gases and solids, with walls, images, other groups, couplings, inlets and outlets.
//! Each has at least four chunks of 64 clusters, so that every rank has particles.

use super::one_set_of_bits;
use meshfree::boundary::{Crush, Inlet, Outlet, Wall};
use meshfree::coupling::ContactDensity;
use meshfree::effect::{FiniteStrainPlasticity, Hypoelastic, NeoHookean};
use meshfree::material::eos::{IdealGas, Linear};
use meshfree::material::{Material, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::term::CentralViscosity;
use std::f64::consts::PI;

pub(super) const DX: f64 = 0.01;

pub(super) fn down<const D: usize>(_time: f64) -> [f64; D] {
    core::array::from_fn(|d| if d + 1 == D { -9.81 } else { 0.0 })
}

/// A dam break in a tank of particles.
pub(super) fn dam_break() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(4.0);
    let open = [[true; 2], [true, false]];
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.8, 0.4], DX))
        .wall(Wall::around("tank", [0.0; 2], [1.2, 0.6], DX, 4, open))
        .acceleration(down)
}

#[test]
fn a_dam_breaks_in_a_plane() {
    one_set_of_bits("dam break", (400, 6), dam_break);
}

/// Viscous water that sloshes in a tank.
pub(super) fn tank_in_space() -> Scene<f32, 3> {
    let water = catalogue::weakly_compressible_water(3.0).with_dynamic_viscosity(0.5);
    Scene::new(schemes::weakly_compressible().with(Laminar(CentralViscosity)))
        .body(
            Body::block("water", water, [0.0; 3], [0.16, 0.16, 0.16], DX).velocity([2.0, 1.0, 0.0]),
        )
        .wall(Wall::around(
            "tank",
            [0.0; 3],
            [0.16, 0.16, 0.2],
            DX,
            3,
            [[true; 2], [true; 2], [true, false]],
        ))
        .acceleration(down)
}

#[test]
fn water_sloshes_in_a_tank_in_space() {
    one_set_of_bits("tank in space, f32", (150, 6), tank_in_space);
}

/// Gas that streams through two periods, with lengths that follow its density.
pub(super) fn periodic_gas() -> Scene<f64, 2> {
    gas_in_periods(EnergyForm::Compatible)
}

/// The same with a form of the energy that an integrator can follow.
pub(super) fn gas_in_periods(energy: EnergyForm) -> Scene<f64, 2> {
    let gas = IdealGas::new(1.4, 1.0);
    let square = Body::block("gas", Material::new("gas", gas), [0.0; 2], [1.0; 2], 0.02);
    let start = move |x: [f64; 2], start: Start<2>| Start {
        velocity: [2.0 + (2.0 * PI * x[1]).sin(), (2.0 * PI * x[0]).sin()],
        energy: gas.energy(1.0, 1.0),
        ..start
    };
    Scene::new(schemes::gas().energy(energy))
        .body(square.start(start))
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
}

#[test]
fn a_gas_flows_through_periods() {
    one_set_of_bits("periodic gas", (120, 6), periodic_gas);
}

/// A rod that streams through a period.
pub(super) fn rod(velocity: f64) -> Scene<f64, 1> {
    let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 5e-6);
    Scene::new(schemes::impact())
        .body(rod.start(move |x, start| Start {
            velocity: [velocity + 50.0 * (200.0 * PI * x[0]).sin()],
            ..start
        }))
        .boundary(Periodic::along(0, 0.0, 0.01))
}

#[test]
fn a_rod_flows_through_a_period() {
    one_set_of_bits("rod", (300, 6), || rod(400.0));
}

/// A rubber plate that swings, free.
pub(super) fn bent_plate() -> Scene<f64, 2> {
    let rubber = Material::new("rubber", Linear::new(1100.0, 40.0)).with_shear_modulus(5e5);
    let plate = Body::block("plate", rubber, [0.0; 2], [1.0, 0.4], DX);
    Scene::new(schemes::total_lagrangian().with(NeoHookean)).body(plate.start(|[x, _], start| {
        Start {
            velocity: [0.0, 2.0 * x * x],
            ..start
        }
    }))
}

#[test]
fn a_plate_bends_by_its_reference_neighbours() {
    one_set_of_bits("total-Lagrangian plate", (100, 1), || {
        bent_plate().fix("plate", |[x, _]| *x < 0.05)
    });
}

/// A steel plate that strikes a wall.
pub(super) fn plate_at_wall() -> Scene<f64, 2> {
    let steel = catalogue::steel().with_shear_modulus(77e9);
    let plate = Body::block("plate", steel, [0.0; 2], [0.08, 0.04], 1e-3);
    Scene::new(schemes::impact_by_continuity().with(Hypoelastic))
        .body(plate.velocity([-150.0, 30.0]))
        .boundary(MirrorPlane::wall([-0.0005, 0.0], [-1.0, 0.0]))
}

#[test]
fn a_plate_that_yields_strikes_a_wall_by_continuity() {
    one_set_of_bits("elastic plate that turns", (100, 2), plate_at_wall);
}

/// A striker of copper on a target of PMMA.
pub(super) fn impact() -> Scene<f32, 2> {
    let [copper, pmma] = [catalogue::copper::<f32>(), catalogue::pmma::<f32>()];
    Scene::<f32, 2>::new(schemes::impact())
        .body(Body::block("striker", copper, [0.0; 2], [0.05, 0.05], 1e-3).velocity([900.0, 100.0]))
        .body(Body::block("target", pmma, [0.05, 0.0], [0.1, 0.06], 1e-3))
}

#[test]
fn bodies_in_contact_that_heat() {
    one_set_of_bits("impact", (150, 3), impact);
}

/// Water that enters a channel at one end and leaves it at the other.
pub(super) fn channel() -> Scene<f64, 2> {
    let opening = (0..40).map(|k| [0.0, DX * (f64::from(k) + 0.5)]).collect();
    let water = catalogue::weakly_compressible_water(2.0);
    let closed = [[false; 2], [true; 2]];
    let (low, high) = ([-0.06, 0.0], [0.8, 0.4]);
    Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.6, 0.4], DX).velocity([1.0, 0.0]))
        .inlet(Inlet::new("water", opening, [1.0, 0.0], DX, 400))
        .outlet(Outlet::plane([0.62, 0.0], [1.0, 0.0]))
        .wall(Wall::around("floors", low, high, DX, 4, closed))
}

#[test]
fn what_enters_and_leaves() {
    one_set_of_bits("channel", (300, 6), channel);
}

/// Water on an elastic plate, which sub-cycles, on a plastic block.
pub(super) fn mixed() -> Scene<f64, 2> {
    let water = catalogue::water_at(SoundSpeed::artificial(2.0));
    let soft = |name: &str| {
        Material::new(name, Linear::new(1100.0, 40.0))
            .with_shear_modulus(5e5)
            .with_yield_stress(2e3)
    };
    let plate = Body::block("plate", soft("plate"), [-0.03, -0.05], [0.53, 0.0], DX);
    let block = Body::block("block", soft("block"), [0.02, -0.305], [0.48, -0.055], DX);
    Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.5, 0.4], DX).velocity([0.0, -1.0]))
        .group(schemes::total_lagrangian().with(NeoHookean), [plate])
        .group(
            schemes::total_lagrangian().with(FiniteStrainPlasticity),
            [block.velocity([0.0, 2.0])],
        )
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [0.5; 2],
            DX,
            4,
            [[true; 2], [false; 2]],
        ))
        .fix("plate", |[x, _]| !(0.0..0.5).contains(x))
        .couple("plate", "block", ContactDensity::new())
        .between("water", "block", Interaction::None)
        .between("plate", "tank", Interaction::None)
        .between("block", "tank", Interaction::None)
        .sub_cycle("plate", 8)
        .acceleration(down)
}

#[test]
fn liquid_wall_elastic_and_plastic_bodies() {
    one_set_of_bits("mixed", (60, 2), mixed);
}

/// A block of wood that falls into water.
pub(super) fn floating() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(3.0);
    let wood = Material::new("wood", Linear::new(500.0, 40.0));
    let tank = Wall::around(
        "tank",
        [0.0; 2],
        [0.9, 0.6],
        DX,
        4,
        [[true; 2], [true, false]],
    );
    Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.9, 0.3], DX))
        .group(
            schemes::impact_by_continuity(),
            [Body::block("block", wood, [0.3, 0.305], [0.5, 0.405], DX).velocity([0.5, -1.5])],
        )
        .rigid("block")
        .couple("block", "tank", ContactDensity::new())
        .wall(tank)
        .acceleration(down)
}

#[test]
fn a_rigid_block_floats_in_a_tank() {
    one_set_of_bits("floating", (200, 4), floating);
}

/// Water in a tank that is crushed.
pub(super) fn crushed_tank() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(3.0);
    let tank = Wall::around("tank", [0.0; 2], [0.8, 0.5], DX, 4, [[true; 2]; 2]);
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.8, 0.4], DX))
        .wall(tank.motion(Crush::along(1, 0.0, |t| [0.5 * t, 0.5, 0.0])))
        .acceleration(down)
}

#[test]
fn a_tank_is_crushed() {
    one_set_of_bits("crushed", (200, 4), crushed_tank);
}

/// Water that falls into a corner of mirror planes.
pub(super) fn corner() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(4.0);
    let drop = Body::block("water", water, [0.0; 2], [0.7, 0.4], DX).velocity([-1.0, -0.5]);
    Scene::new(schemes::weakly_compressible())
        .body(drop)
        .boundary(MirrorPlane::wall([0.0; 2], [-1.0, 0.0]))
        .boundary(MirrorPlane::wall([0.0; 2], [0.0, -1.0]))
        .acceleration(down)
}

#[test]
fn water_falls_into_a_corner_of_mirrors() {
    one_set_of_bits("corner", (250, 6), corner);
}

/// The same between periods, by drift-kick-drift.
pub(super) fn channel_of_period() -> Scene<f64, 2> {
    let opening = (0..40).map(|k| [0.0, DX * (f64::from(k) + 0.5)]).collect();
    let water = catalogue::weakly_compressible_water(2.0);
    Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.6, 0.4], DX).velocity([1.0, 0.0]))
        .inlet(Inlet::new("water", opening, [1.0, 0.0], DX, 400))
        .outlet(Outlet::plane([0.62, 0.0], [1.0, 0.0]))
        .boundary(Periodic::along(1, 0.0, 0.4))
        .integrator(DriftKickDrift)
}

#[test]
fn water_enters_between_periods_by_another_integrator() {
    one_set_of_bits("period, drift-kick-drift", (250, 6), channel_of_period);
}

/// A rod that streams through a period, by an integrator that keeps states.
pub(super) fn rod_by_runge_kutta() -> Scene<f64, 1> {
    let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 5e-6);
    Scene::new(schemes::impact().energy(EnergyForm::Symmetric))
        .body(rod.start(|x, start| Start {
            velocity: [900.0 + 50.0 * (200.0 * PI * x[0]).sin()],
            ..start
        }))
        .boundary(Periodic::along(0, 0.0, 0.01))
        .integrator(RungeKutta4)
}

#[test]
fn a_rod_flows_by_runge_kutta() {
    one_set_of_bits("Runge-Kutta", (60, 4), rod_by_runge_kutta);
}

/// A stone that falls into a tank that is shaken.
pub(super) fn shaken_block() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(4.0);
    let stone = Material::new("stone", Linear::new(2000.0, 40.0));
    let block = Body::block("block", stone, [0.3, 0.405], [0.5, 0.505], DX);
    let shaken = Translation::new(
        |t| [0.02 * (30.0 * t).sin() - 0.6 * t, 0.0],
        |t| [0.6 * (30.0 * t).cos() - 0.6, 0.0],
        |t| [-18.0 * (30.0 * t).sin(), 0.0],
    );
    let open = [[true; 2], [true, false]];
    let tank = Wall::around("tank", [0.0; 2], [0.8, 0.6], DX, 4, open);
    Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.8, 0.4], DX))
        .group(
            schemes::impact_by_continuity(),
            [block.velocity([0.0, -2.0])],
        )
        .rigid("block")
        .couple("block", "tank", ContactDensity::new().friction(0.3))
        .wall(tank.motion(shaken))
        .acceleration(down)
}

#[test]
fn a_rigid_block_falls_into_a_tank_that_is_shaken() {
    one_set_of_bits("shaken block", (150, 4), shaken_block);
}
