//! The Lagrangian form of water against exact values: sound, a column under its weight, a shock; and where its validity ends.
//! Two dimensions are a slice.

use approx::assert_relative_eq;
use meshfree::effect::{HourglassControl, LagrangianLiquid};
use meshfree::material::{Liquid, Material, SoundSpeed};
use meshfree::particles::Field;
use meshfree::prelude::*;
use meshfree::scene::{Conversion, Distortion, Start};
use meshfree::term::viscosity::{Inviscid, MonaghanGingold};
use std::f64::consts::TAU;

const RHO: f64 = 1000.0;
const G: f64 = 9.81;

fn water(sound: f64) -> Material<f64> {
    Liquid::new(RHO, 1480.0, 1e-6)
        .linear()
        .material("water", SoundSpeed::Chosen(sound))
}

/// A standing wave comes back after λ/c, at 20 spacings a wavelength.
#[test]
fn sound_runs_at_its_speed() {
    let sound = 20.0;
    let start = |[x, _]: [f64; 2], own: Start<2>| Start {
        velocity: [1e-3 * (TAU * x).sin(), 0.0],
        ..own
    };
    let strip = Body::block("strip", water(sound), [0.0; 2], [1.0, 0.2], 0.05);
    let mut strip = Scene::<f64, 2>::new(schemes::total_lagrangian().with(LagrangianLiquid))
        .body(strip.start(start))
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 0.2))
        .build()
        .unwrap();
    let amplitude = |now: &Simulation<f64, 2>| -> f64 {
        let own = now.all();
        own.map(|p| p.velocity()[0] * (TAU * p.position()[0]).sin())
            .sum()
    };
    let before = strip.ledger().whole.total_energy();
    // Crossings of zero of the amplitude are half a period apart.
    let (mut last, mut crossings) = ([0.0, amplitude(&strip)], Vec::new());
    while crossings.len() < 5 {
        strip.step().unwrap();
        let now = [strip.time(), amplitude(&strip)];
        if now[1] * last[1] < 0.0 {
            crossings.push(last[0] + (now[0] - last[0]) * last[1] / (last[1] - now[1]));
        }
        last = now;
    }
    let period = 0.5 * (crossings[4] - crossings[0]);
    // Differences over two spacings see sin(k dx)/dx for k; the neighbours farther off change little at h/dx 0.8.
    let lattice = (TAU * 0.05).sin() / (TAU * 0.05);
    assert_relative_eq!(1.0 / (sound * period), lattice, max_relative = 3e-3);
    let after = strip.ledger().whole.total_energy();
    assert_relative_eq!(after, before, max_relative = 1e-12);
}

/// A column that settles under its weight has p = ρ₀ g (H − X) at the place X that a particle was built at, for any equation of state.
#[test]
fn a_column_settles_to_the_pressure_of_its_weight() {
    let (dx, height) = (0.05, 1.0);
    let damped = MonaghanGingold {
        alpha: 20.0,
        beta: 0.0,
    };
    let scheme = schemes::total_lagrangian()
        .with_viscosity(damped)
        .with(LagrangianLiquid);
    let mut column = Scene::<f64, 2>::new(scheme)
        .body(Body::block(
            "water",
            water(10.0),
            [0.0; 2],
            [0.2, height],
            dx,
        ))
        .boundary(Periodic::along(0, 0.0, 0.2))
        .boundary(MirrorPlane::symmetry([0.0; 2], [0.0, -1.0]))
        .acceleration(|_| [0.0, -G])
        .build()
        .unwrap();
    column.run_until(6.0).unwrap();
    let mut worst = 0.0_f64;
    for p in column.all() {
        let x = p.vector(Field::REFERENCE_POSITION).unwrap();
        worst = worst.max((p.pressure() - RHO * G * (height - x[1])).abs());
    }
    println!("worst {worst} of {}", RHO * G * height);
    assert!(worst < 0.03 * RHO * G * height, "{worst}");
}

/// Water that meets a wall at v has p = ρ₀ U v behind the shock, with the speed U² = c² ρ/ρ₀ of the linear law along X.
#[test]
fn a_shock_has_the_pressure_of_its_jump() {
    let (sound, speed, dx) = (100.0, 10.0, 0.005);
    let scheme = schemes::total_lagrangian_impact().with(LagrangianLiquid);
    let mut column = Scene::<f64, 1>::new(scheme)
        .body(Body::block("water", water(sound), [0.0], [1.0], dx).velocity([-speed]))
        .boundary(MirrorPlane::symmetry([0.0], [-1.0]))
        .build()
        .unwrap();
    column.run_until(0.006).unwrap();
    // p = c² (ρ − ρ₀) and p = ρ₀ U v = v c √(ρ ρ₀).
    let mut density = RHO;
    for _ in 0..50 {
        density = RHO + speed * (density * RHO).sqrt() / sound;
    }
    let exact = sound * sound * (density - RHO);
    let behind = column.all().filter(|p| {
        let x = p.position()[0];
        x > 0.1 && x < 0.4
    });
    let behind: Vec<_> = behind.map(|p| p.pressure()).collect();
    let mean = behind.iter().sum::<f64>() / behind.len() as f64;
    assert!(behind.len() > 50);
    assert_relative_eq!(mean, exact, max_relative = 5e-3);
}

/// A slice of a tank at 30 g, until the monitor speaks or 60 ms are over: the greatest change of the
/// volume until 30 ms, and what stopped it.
fn slice(strength: f64, monitor: Conversion) -> (f64, Option<Distortion<2>>) {
    let ([length, depth], dx) = ([0.5, 0.18], 0.015);
    let gravity = [0.0, -G];
    let body = Body::block(
        "water",
        water(171.5).with_pressure_cut_off(0.0),
        [0.0; 2],
        [length, depth],
        dx,
    );
    let scheme = SchemeBuilder::total_lagrangian(WendlandC2, Inviscid)
        .with(HourglassControl { strength })
        .h_over_dx(1.0)
        .with(LagrangianLiquid);
    let mut tank = Scene::<f64, 2>::new(scheme)
        .body(body.hydrostatic(gravity, [0.0, depth]))
        .boundary(MirrorPlane::symmetry([length, 0.0], [1.0, 0.0]))
        .boundary(MirrorPlane::symmetry([0.0; 2], [0.0, -1.0]))
        .acceleration(|t: f64| [30.0 * G * (0.5 * TAU * t / 0.08).sin(), -G])
        .build()
        .unwrap();
    let mut changed = 0.0_f64;
    while tank.time() < 0.06 {
        tank.step().unwrap();
        if tank.time() < 0.03 {
            let volume: f64 = tank.all().map(|p| p.mass() / p.density()).sum();
            changed = changed.max((volume / (length * depth) - 1.0).abs());
        }
        if let Some(reason) = monitor.distortion(&tank, "water").unwrap() {
            return (changed, Some(reason));
        }
    }
    (changed, None)
}

/// The monitor stops a tank at 30 g at a time that its bounds set, with particle, place and reason.
#[test]
fn a_tank_is_stopped_where_its_neighbours_are_no_longer_near() {
    let (changed, reason) = slice(0.1, Conversion::default());
    let reason = reason.expect("it is stopped");
    assert!(changed < 2e-3, "{changed}");
    assert!(reason.quantity.ends_with("stretch"), "{reason}");
    assert!(reason.to_string().contains("at t = 0.0"), "{reason}");
    let strict = slice(0.1, Conversion::default().stretches([0.8, 1.25]));
    let sooner = strict.1.expect("it is stopped").time;
    assert!(0.01 < sooner && sooner < reason.time, "{sooner}");
    // Without hourglass control zigzags stop it at two thirds of that time.
    let bare = slice(0.0, Conversion::default()).1.expect("it is stopped");
    assert!(bare.time < 0.7 * reason.time, "{bare}");
}

/// A material with a shear modulus is not taken for a liquid, and a liquid not for a solid.
#[test]
fn solids_are_refused() {
    let told = |scheme: Scheme<f64, 1>, material: Material<f64>| {
        let body = Body::block("block", material, [0.0], [1.0], 0.1);
        let scene = Scene::new(scheme).body(body);
        scene.build().unwrap_err().to_string()
    };
    let liquid = || schemes::total_lagrangian().with(LagrangianLiquid).compose();
    let found = told(liquid(), water(10.0).with_shear_modulus(1e3));
    assert!(found.contains("has no resistance to shear"), "{found}");
    let solid = schemes::total_lagrangian().with(NeoHookean).compose();
    let found = told(solid, water(10.0));
    assert!(found.contains("shear modulus of body `block`"), "{found}");
}
