//! Forces and readings by planes and periods: bodies feel each other across them, and observers see both sides.
//! What is half of a symmetric scene, or cut anywhere by a period, reads as the whole.

use meshfree::material::eos::Linear;
use meshfree::observe::{PressureProbe, WaveGauge};
use meshfree::prelude::*;
use meshfree::term::viscosity::MonaghanGingold;

const DX: f64 = 0.01;
const GRAVITY: f64 = 10.0;

/// Sound speed \[m/s\].
const SOUND: f64 = 20.0;

fn water() -> Material<f64> {
    Material::new("water", Linear::new(1000.0, SOUND))
}

/// Pressure \[Pa\] of liquid that fills its place.
const PRESSURE: f64 = 2000.0;

fn pressed(name: &str, low: [f64; 2], high: [f64; 2]) -> Body<f64, 2> {
    let density = 1000.0 + PRESSURE / (SOUND * SOUND);
    Body::block(name, water(), low, high, DX).density(density)
}

/// The force \[N\] of a body on another, and back, without a step.
fn forces(mut simulation: Simulation<f64, 2>, [on, from]: [&str; 2]) -> [[f64; 2]; 2] {
    simulation.evaluate().unwrap();
    [
        simulation.force_between(on, from).unwrap(),
        simulation.force_between(from, on).unwrap(),
    ]
}

#[test]
fn a_plate_across_a_period_carries_the_water_on_it() {
    let (length, depth) = (0.2, 0.1);
    let scene = || {
        Scene::<f64, 2>::new(
            schemes::weakly_compressible().with_viscosity(MonaghanGingold {
                alpha: 0.5,
                beta: 0.0,
            }),
        )
        .body(
            Body::block("water", water(), [0.0; 2], [length, depth], DX)
                .hydrostatic([0.0, -GRAVITY], [0.0, depth]),
        )
        .boundary(Periodic::along(0, 0.0, length))
        .acceleration(|_| [0.0, -GRAVITY])
    };
    let steel = Material::new("steel", Linear::new(8000.0, SOUND));
    let plate = Body::block("plate", steel, [0.0, -4.0 * DX], [length, 0.0], DX);
    let points = plate.points().to_vec();
    let weight = 1000.0 * GRAVITY * length * depth;
    let plate = scene()
        .group(schemes::impact_by_continuity(), [plate])
        .fix("plate", |_| true);
    let floor = scene().wall(Wall::of("plate", points, DX));
    for scene in [plate, floor] {
        let mut simulation = scene.build().unwrap();
        let (mut sum, readings) = (0.0, 40);
        for k in 1..=readings {
            simulation.run_until(0.3 + 0.005 * f64::from(k)).unwrap();
            let on = simulation.force_between("plate", "water").unwrap();
            let back = simulation.force_between("water", "plate").unwrap();
            for d in 0..2 {
                assert!((on[d] + back[d]).abs() < 1e-9 * weight, "{on:?} {back:?}");
            }
            sum -= on[1] / f64::from(readings);
        }
        println!("{sum} of {weight} N");
        assert!((sum / weight - 1.0).abs() < 0.005, "{sum} of {weight} N");
    }
}

#[test]
fn what_touches_at_both_ends_of_a_period_is_pushed_from_both() {
    let scene = || {
        Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(pressed("left", [0.0; 2], [0.1, 0.1]))
            .body(pressed("right", [0.1, 0.0], [0.2, 0.1]))
            .boundary(Periodic::along(0, 0.0, 0.2))
            .boundary(Periodic::along(1, 0.0, 0.1))
    };
    let [on, back] = forces(scene().build().unwrap(), ["left", "right"]);
    let whole = PRESSURE * 0.1;
    assert!(on[0].abs() < 1e-9 * whole, "{on:?} of {whole}");
    assert!((0..2).all(|d| (on[d] + back[d]).abs() < 1e-9 * whole));
    // Those that do not meet do not meet across the period either.
    let apart = scene().between("left", "right", Interaction::None);
    let alone = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(pressed("left", [0.0; 2], [0.1, 0.1]))
        .boundary(Periodic::along(0, 0.0, 0.2))
        .boundary(Periodic::along(1, 0.0, 0.1));
    let [apart, alone] = [apart, alone].map(|scene| {
        let mut simulation = scene.build().unwrap();
        simulation.evaluate().unwrap();
        let left = simulation.body("left").unwrap();
        left.map(|particle| particle.acceleration())
            .collect::<Vec<_>>()
    });
    let most = alone
        .iter()
        .flatten()
        .fold(0.0_f64, |most, a| most.max(a.abs()));
    for (a, b) in apart.iter().flatten().zip(alone.iter().flatten()) {
        assert!((a - b).abs() < 1e-9 * most, "{a} {b}");
    }
}

/// Half of a scene with a plane of symmetry has half of the force along the plane.
#[test]
fn half_a_scene_has_half_of_the_force() {
    let scene = |left: f64| {
        Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(pressed("lower", [left, 0.0], [0.1, 0.1]))
            .body(pressed("upper", [left, 0.1], [0.1, 0.2]))
    };
    let whole = forces(scene(-0.1).build().unwrap(), ["upper", "lower"]);
    let plane = MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]);
    let half = forces(
        scene(0.0).boundary(plane).build().unwrap(),
        ["upper", "lower"],
    );
    println!("{whole:?} {half:?}");
    assert!(whole[0][1] > 0.8 * PRESSURE * 0.2);
    for k in 0..2 {
        assert!((half[k][1] / whole[k][1] - 0.5).abs() < 1e-9);
    }
}

#[test]
fn forces_between_walls_are_refused() {
    let simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(pressed("water", [0.0; 2], [0.1, 0.1]))
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [0.1; 2],
            DX,
            4,
            [[true, false]; 2],
        ))
        .boundary(MirrorPlane::wall([0.1, 0.0], [1.0, 0.0]))
        .build()
        .unwrap();
    let error = simulation.force_between("tank", "wall").unwrap_err();
    assert!(error.to_string().contains("name a body"), "{error}");
    let [on, back] = ["wall", "water"].map(|name| {
        let other = if name == "wall" { "water" } else { "wall" };
        simulation.force_between(name, other).unwrap()
    });
    assert_eq!(on, back.map(|force| -force));
}

/// Liquid under pressure between planes, or in a period: sensors on the plane, in a corner and at the end of a period read it.
#[test]
fn probes_on_planes_and_by_periods_read_the_pressure() {
    let scene = |boundary: bool| {
        let scene = Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(pressed("water", [0.0; 2], [0.2, 0.2]))
            .boundary(MirrorPlane::wall([0.0; 2], [-1.0, 0.0]))
            .boundary(MirrorPlane::wall([0.2, 0.0], [1.0, 0.0]));
        if boundary {
            scene.boundary(Periodic::along(1, 0.0, 0.2))
        } else {
            scene
                .boundary(MirrorPlane::wall([0.0; 2], [0.0, -1.0]))
                .boundary(MirrorPlane::wall([0.0, 0.2], [0.0, 1.0]))
        }
    };
    for periodic in [true, false] {
        let mut simulation = scene(periodic).build().unwrap();
        simulation.evaluate().unwrap();
        for y in [0.1, 0.0, 0.195] {
            let probe =
                PressureProbe::disc(&simulation, "plane", [0.0, y], [1.0, 0.0], 4.0 * DX).unwrap();
            let read = probe.pressure(&simulation) / PRESSURE;
            let felt = probe.contact_pressure(&simulation) / PRESSURE;
            println!("{periodic} {y}: {read} {felt}");
            assert!((read - 1.0).abs() < 0.01, "{read}");
            // In a corner half of the disc is behind the other plane, or one period on.
            if y == 0.1 {
                assert!((felt - 1.0).abs() < 0.02, "{felt}");
            }
        }
        let places = [[0.0, 0.1], [0.1, 0.0], [0.0, 0.0], [0.1, 0.1]];
        let pressure = simulation.sample(Field::PRESSURE, &places).unwrap();
        for k in 0..4 {
            assert!((pressure.filling()[k] - 1.0).abs() < 0.01, "{pressure:?}");
            assert!((pressure.scalar(k).unwrap() / PRESSURE - 1.0).abs() < 1e-6);
        }
    }
}

/// A jet onto a plane, on which nothing but images stands: sensors where it divides read ½ ρ v².
#[test]
fn a_probe_under_a_jet_reads_its_stagnation_pressure() {
    let (speed, width, length) = (116.0, 20.0 * DX, 120.0 * DX);
    let jet = Material::new("water", Linear::new(1000.0, 10.0 * speed));
    let (low, high) = ([-0.5 * width, 0.0], [0.5 * width, length]);
    let mut simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("jet", jet, low, high, DX).velocity([0.0, -speed]))
        .boundary(MirrorPlane::wall([0.0; 2], [0.0, -1.0]))
        .build()
        .unwrap();
    let probe = PressureProbe::disc(&simulation, "plane", [0.0; 2], [0.0, 1.0], 4.0 * DX).unwrap();
    let (mut sums, mut readings) = ([0.0; 2], 0.0);
    // It is steady after it has run on by twice its width, and until its end comes near.
    for k in 0..=100 {
        let run = 2.0 * width + f64::from(k) / 100.0 * (0.7 * length - 2.0 * width);
        simulation.run_until(run / speed).unwrap();
        sums[0] += probe.pressure(&simulation);
        sums[1] += probe.contact_pressure(&simulation);
        readings += 1.0;
    }
    let stagnation = 0.5 * 1000.0 * speed * speed;
    let [read, felt] = sums.map(|sum| sum / (readings * stagnation));
    println!("sensor {read}, contact {felt} of {stagnation} Pa");
    assert!((read - 1.0).abs() < 0.05, "{read}");
    assert!((felt - 1.0).abs() < 0.05, "{felt}");
}

/// What is sampled on a plane does not go through it; behind it nothing is read that is not there.
#[test]
fn fields_on_a_plane_are_those_of_both_sides() {
    let flow = |[x, y]: [f64; 2]| [-x, y];
    let body =
        pressed("water", [0.0; 2], [0.2, 0.2]).start(move |x, start| meshfree::scene::Start {
            velocity: flow(x),
            ..start
        });
    let simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(body)
        .boundary(MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]))
        .build()
        .unwrap();
    let places = [[0.0, 0.1], [0.01, 0.1], [-0.025, 0.1]];
    let velocity = simulation.sample(Field::VELOCITY, &places).unwrap();
    for (k, place) in places.iter().enumerate().take(2) {
        let (read, exact) = (velocity.vector(k).unwrap(), flow(*place));
        assert!(
            (0..2).all(|d| (read[d] - exact[d]).abs() < 1e-3),
            "{read:?} {exact:?}"
        );
    }
    assert!(velocity.filling()[2] < 0.05, "{:?}", velocity.filling());
}

#[test]
fn a_gauge_by_a_plane_or_a_period_reads_the_height() {
    let scene = |boundaries: usize| {
        let scene = Scene::<f64, 2>::new(schemes::weakly_compressible()).body(Body::block(
            "water",
            water(),
            [0.0; 2],
            [0.2, 0.1],
            DX,
        ));
        if boundaries == 1 {
            return scene.boundary(Periodic::along(0, 0.0, 0.2));
        }
        scene
            .boundary(MirrorPlane::wall([0.0; 2], [-1.0, 0.0]))
            .boundary(MirrorPlane::wall([0.2, 0.0], [1.0, 0.0]))
    };
    for boundaries in [1, 2] {
        let simulation = scene(boundaries).build().unwrap();
        for x in [0.0, 0.1] {
            let gauge = WaveGauge::upwards(&simulation, "gauge", [x, 0.0], 1).unwrap();
            let height = gauge.height(&simulation);
            assert!((height - 0.1).abs() < 0.1 * DX, "{x}: {height}");
        }
    }
}
