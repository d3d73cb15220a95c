//! Further kinds of scenes on the device as on the host, of some 2000 particles over 200 steps each.
//! A user's heat conduction, a dam break with a wall that moves, two phases, gas through periods, and solids that flow.

/// The file of a user's package, which sees what the crate publishes.
#[path = "../../../../tests/downstream/src/heat.rs"]
mod heat;

use crate::common::device;
use crate::compare::{in_both, in_double, on, on_device, on_host};
use heat::{CONDUCTIVITY, HeatConduction, TEMPERATURE};
use meshfree::effect::{
    ExpansionMemory, FiniteStrainPlasticity, SurfaceTension, TwoPhase, WithinPhase,
};
use meshfree::material::eos::{IdealGas, Linear, Tait};
use meshfree::material::strength::PerfectPlasticity;
use meshfree::prelude::*;
use meshfree::scheme::Start;
use meshfree::term::Fourtakas;
use std::f64::consts::TAU;

/// A block of two conductivities that shakes, hot at one end.
fn heated<T: Real>(fused: bool) -> Scene<T, 3> {
    let spacing = 0.01;
    let conduction = HeatConduction {
        conductivity: 4e4,
        specific_heat: 385.0,
        start: 300.0,
    };
    let shakes = |[x, y, z]: [f64; 3], start| Start {
        velocity: [(40.0 * y).sin(), (40.0 * z).sin(), (40.0 * x).sin()],
        ..start
    };
    let metal = Material::new("metal", Linear::new(8900.0, 400.0));
    let body = Body::block("block", metal, [0.0; 3], [0.14, 0.12, 0.12], spacing)
        .start(shakes)
        .field(TEMPERATURE, |[x, _, _]| [300.0 + 200.0 * (20.0 * x).cos()])
        .field(CONDUCTIVITY, |[_, y, _]| [if y < 0.06 { 4e4 } else { 1e4 }]);
    let scheme = schemes::impact_by_continuity().with(conduction);
    on(Scene::new(scheme).body(body), fused)
}

#[test]
fn heat_conduction_of_a_user_is_that_of_the_host() {
    let Some(device) = device("heat conduction of a user") else {
        return;
    };
    in_both(&device, "Heat", heated::<f64>, || heated::<f32>(false), 200);
    let [found, host, fused] = [
        on_device(&device, heated::<f64>(false), 200),
        on_host(heated(false), 200),
        on_host(heated(true), 200),
    ];
    let warm = |own: &Simulation<f64, 3>| -> Vec<f64> {
        own.all().filter_map(|p| p.scalar(TEMPERATURE)).collect()
    };
    let apart = |a: &[f64], b: &[f64]| {
        let all = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        all.fold(0.0, f64::max)
    };
    let [found, host, fused] = [warm(&found), warm(&host), warm(&fused)];
    let (own, most) = (apart(&found, &host), apart(&fused, &host));
    println!("temperatures: {own:e} K, host {most:e} K");
    assert_eq!(host.len(), 2016);
    assert!(own <= 20.0 * most, "{own:e} {most:e}");
    let start = warm(&on_host(heated(false), 0));
    assert!(apart(&start, &host) > 1.0);
}

/// Water that falls from a column towards a wall that comes nearer.
fn dam<T: Real>(fused: bool) -> Scene<T, 2> {
    let (spacing, depth) = (0.01, 0.3);
    let water = catalogue::weakly_compressible_water::<T>((2.0 * 9.81 * depth).sqrt());
    let closed = [[true, false], [true, false]];
    let at = |k: usize| {
        [
            0.605 + spacing * (k % 3) as f64,
            spacing * (0.5 + (k / 3) as f64),
        ]
    };
    let end = Wall::of("piston", (0..120).map(at).collect(), spacing);
    let scene = Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.3, depth], spacing))
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [0.6, 0.5],
            spacing,
            3,
            closed,
        ))
        .wall(end.motion(Translation::steady([-0.8, 0.0])))
        .acceleration(|_| [0.0, -9.81]);
    on(scene, fused)
}

/// Water below a light liquid in a closed tank, let go with a swirl that tears it.
fn phases<T: Real>(fused: bool) -> Scene<T, 2> {
    let (spacing, size, middle) = (0.01, [0.4, 0.36], 0.2);
    let water = Tait::new(1000.0, 15.0);
    let water = Material::<T>::new("water", water).with_pressure_cut_off(-500.0);
    let light = Material::new("light", Tait::new(50.0, 30.0).with_gamma(1.4));
    let swirl = |[x, y]: [f64; 2], start| Start {
        velocity: [-6.0 * (y - 0.18), 6.0 * (x - 0.2)],
        ..start
    };
    let body = |name, material, low: f64, high: f64| {
        Body::block(name, material, [0.0, low], [size[0], high], spacing).start(swirl)
    };
    let scheme = schemes::weakly_compressible()
        .walls(ExtrapolatedPressure {
            floor: f64::NEG_INFINITY,
        })
        .density_diffusion(WithinPhase(Fourtakas::default()))
        .with(TwoPhase::default())
        .with(ExpansionMemory)
        .between_bodies(Interaction::Bonded);
    let scene = Scene::new(scheme)
        .body(body("water", water, 0.0, middle))
        .body(body("light", light, middle, size[1]))
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            size,
            spacing,
            3,
            [[true; 2]; 2],
        ))
        .acceleration(|_| [0.0, -9.81]);
    on(scene, fused)
}

#[test]
fn liquids_before_a_piston_and_of_two_phases_are_those_of_the_host() {
    let Some(device) = device("liquids before a piston and of two phases") else {
        return;
    };
    in_both(&device, "Piston", dam::<f64>, || dam::<f32>(false), 200);
    in_double(&device, "Phases", phases::<f64>, 200);
    // Water is held at the cut-off, and remembers how far it has expanded.
    assert!(
        on_device(&device, phases::<f64>(false), 200)
            .limits()
            .iter()
            .any(|own| own.1 > 0)
    );
}

/// A drop of one liquid in another, not round, with tension between both, in a box that is periodic along one axis.
fn drop<T: Real>(fused: bool) -> Scene<T, 2> {
    let spacing = 0.01;
    let at = |(i, j): (usize, usize)| [i, j].map(|k| (k as f64 + 0.5) * spacing);
    let all = (0..40).flat_map(|i| (0..40).map(move |j| (i, j))).map(at);
    let inside = |[x, y]: &[f64; 2]| (x - 0.2).abs() < 0.12 && (y - 0.2).abs() < 0.07;
    let (oil, water): (Vec<_>, Vec<_>) = all.partition(inside);
    let liquid = |name: &str, density: f64| Material::<T>::new(name, Tait::new(density, 10.0));
    let scheme = schemes::weakly_compressible()
        .density_diffusion(WithinPhase(Fourtakas::default()))
        .with(TwoPhase::default())
        .with(SurfaceTension::between("oil", "water", 5.0))
        .between_bodies(Interaction::Bonded);
    let closed = [[false; 2], [true; 2]];
    let scene = Scene::new(scheme)
        .body(Body::points_of("oil", liquid("oil", 800.0), oil, spacing))
        .body(Body::points_of(
            "water",
            liquid("water", 1000.0),
            water,
            spacing,
        ))
        .boundary(Periodic::along(0, 0.0, 0.4))
        .wall(Wall::around("tank", [0.0; 2], [0.4; 2], spacing, 3, closed));
    on(scene, fused)
}

/// Forces that a law of the rates adds, with their impulse and work in the ledger.
#[test]
fn a_drop_with_surface_tension_is_that_of_the_host() {
    let Some(device) = device("a drop with surface tension") else {
        return;
    };
    in_double(&device, "Drop", drop::<f64>, 200);
    let [found, host] = [
        on_device(&device, drop::<f64>(false), 100).ledger(),
        on_host(drop::<f64>(false), 100).ledger(),
    ];
    let scale = (2.0 * host.whole.kinetic * host.whole.mass).sqrt();
    assert!(host.whole.kinetic > 0.0);
    for ((_, a), (_, b)) in found.bodies.iter().zip(&host.bodies) {
        let [a, b] = [a, b].map(|own| own.total("work of laws").expect("a law"));
        assert!(
            b != 0.0 && (a - b).abs() < 1e-9 * host.whole.kinetic,
            "{a} {b}"
        );
    }
    let impulses = found.law_impulse.iter().zip(&host.law_impulse);
    impulses.for_each(|(a, b)| assert!((a - b).abs() < 1e-11 * scale, "{a} {b}"));
}

/// A wave of sound in a gas that streams through periods along both axes.
fn wave<T: Real>(fused: bool) -> Scene<T, 2> {
    let air = Material::<T>::new("air", IdealGas::new(1.4, 1.0));
    let flow = |[x, y]: [f64; 2], start| Start {
        velocity: [
            1.0 + 0.3 * (TAU * x).sin(),
            0.5 * (TAU * x).cos() * (TAU * y).sin(),
        ],
        energy: 2.5 + 0.2 * (TAU * y).cos(),
        ..start
    };
    let body = Body::block("air", air, [0.0; 2], [1.0; 2], 0.025).start(flow);
    let scene = Scene::new(schemes::gas())
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0));
    on(scene, fused)
}

/// Gas that swirls between four planes, whose images become fewer and more.
fn between_planes(fused: bool) -> Scene<f64, 2> {
    let gas = IdealGas::new(1.4, 1.0);
    let body = Body::block("gas", Material::new("gas", gas), [0.0; 2], [1.0; 2], 0.025);
    let swirl = move |[x, y]: [f64; 2], start: Start<2>| Start {
        velocity: [0.3 * (TAU * y).sin(), 0.3 * (TAU * x).cos()],
        energy: gas.energy(1.0, 1.0),
        ..start
    };
    let mut scene = Scene::new(schemes::gas()).body(body.start(swirl));
    for (at, out) in [(0.0, -1.0), (1.0, 1.0)] {
        scene = scene
            .boundary(MirrorPlane::wall([at, 0.0], [out, 0.0]))
            .boundary(MirrorPlane::wall([0.0, at], [0.0, out]));
    }
    on(scene, fused)
}

#[test]
fn a_gas_through_periods_is_that_of_the_host() {
    let Some(device) = device("a gas through periods") else {
        return;
    };
    in_double(&device, "Wave", wave::<f64>, 200);
    in_both(&device, "Wave", wave::<f64>, || wave::<f32>(false), 40);
    in_double(&device, "Between planes", between_planes, 60);
}

/// Copper that yields.
fn copper<T: Real>() -> Material<T> {
    let copper = catalogue::copper::<T>().with_shear_modulus(46e9);
    copper.with_strength(PerfectPlasticity::new(0.4e9))
}

/// Taylor's bar in space, on a plane that mirrors.
fn bar<T: Real>(fused: bool) -> Scene<T, 3> {
    let body = Body::block("bar", copper(), [0.0; 3], [0.01, 0.004, 0.004], 4e-4);
    let scheme = schemes::impact_by_continuity().with(Hypoelastic);
    let scene = Scene::new(scheme.with(Plasticity))
        .body(body.velocity([-227.0, 0.0, 0.0]))
        .boundary(MirrorPlane::wall([0.0; 3], [-1.0, 0.0, 0.0]));
    on(scene, fused)
}

/// The same in the plane, by its neighbours as built.
fn plate<T: Real>(fused: bool) -> Scene<T, 2> {
    let body = Body::block("bar", copper(), [0.0; 2], [0.03, 0.01], 4e-4);
    let scheme = schemes::total_lagrangian_impact().with(FiniteStrainPlasticity);
    let scene = Scene::new(scheme)
        .body(body.velocity([-200.0, 0.0]))
        .boundary(MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]));
    on(scene, fused)
}

#[test]
fn bars_of_taylor_are_those_of_the_host() {
    let Some(device) = device("bars of Taylor") else {
        return;
    };
    in_double(&device, "Taylor's bar", bar::<f64>, 200);
    in_double(&device, "Bar by its neighbours as built", plate::<f64>, 200);
    let [bar, plate] = [
        on_device(&device, bar::<f64>(false), 200).ledger().whole,
        on_device(&device, plate::<f64>(false), 200).ledger().whole,
    ];
    assert!(
        [bar, plate]
            .iter()
            .all(|own| own.total("plastic work") > Some(0.0))
    );
}
