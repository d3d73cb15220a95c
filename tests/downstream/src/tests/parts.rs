//! Kernel, equation of state, viscosity, boundary, integrator and wall law, each in a short run.

use crate::boundary::Glide;
use crate::eos::Isothermal;
use crate::integrator::SymplecticEuler;
use crate::kernel::Lucy;
use crate::viscosity::Richtmyer;
use crate::wall::LevelWall;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::scheme::Start;
use meshfree::term::viscosity::Inviscid;
use std::f64::consts::{PI, TAU};

#[test]
fn sound_runs_at_its_speed_with_a_kernel_of_ones_own() {
    let steps = 20_000;
    let cells = (0..steps).map(|k| (f64::from(k) + 0.5) * 2.0 / f64::from(steps));
    let integral: f64 = cells
        .map(|q| 2.0 * Lucy.shape(q) * 2.0 / f64::from(steps))
        .sum();
    assert!(
        (Lucy.normalisation() * integral - 1.0).abs() < 1e-8,
        "{integral}"
    );
    for q in [0.2, 0.9, 1.7] {
        let slope = (Lucy.shape(q + 1e-6) - Lucy.shape(q - 1e-6)) / 2e-6;
        assert!((Lucy.slope_over_q(q) * q - slope).abs() < 1e-8);
    }
    let scheme = SchemeBuilder::new(Lucy, Inviscid)
        .density(DensityForm::NumberDensity)
        .energy(EnergyForm::None);
    let rod = Body::block(
        "rod",
        Material::new("rod", Linear::new(1000.0, 100.0)),
        [0.0],
        [1.0],
        0.01,
    );
    let start = |[x]: [f64; 1], own: Start<1>| Start {
        velocity: [1e-3 * (TAU * x).sin()],
        ..own
    };
    let mut rod = Scene::<f64, 1>::new(scheme)
        .body(rod.start(start))
        .boundary(Periodic::along(0, 0.0, 1.0))
        .build()
        .unwrap();
    // cos(ωt) passes through zero a quarter of a period after the start.
    let mut quarter = None;
    rod.run_with(4e-3, |now| {
        let swing: f64 = now
            .all()
            .map(|p| p.velocity()[0] * (TAU * p.position()[0]).sin())
            .sum();
        if swing < 0.0 && quarter.is_none() {
            quarter = Some(now.time());
        }
    })
    .unwrap();
    let quarter = quarter.unwrap();
    assert!(
        (quarter / 2.5e-3 - 1.0).abs() < 0.02,
        "{quarter} s for 2.5 ms"
    );
}

#[test]
fn an_isothermal_shock_compresses_by_the_square_of_its_mach_number() {
    // Gas that meets a wall with u = c (M − 1/M) is compressed M² times, behind a shock of the speed u/(M² − 1).
    let (c, mach): (f64, f64) = (100.0, 2.0);
    let u = c * (mach - 1.0 / mach);
    let gas = Material::new(
        "cloud",
        Isothermal {
            density: 1e-18,
            sound_speed: c,
        },
    );
    let scheme = SchemeBuilder::new(
        CubicSpline,
        Richtmyer {
            alpha: 1.0,
            beta: 2.0,
        },
    )
    .density(DensityForm::Summation)
    .energy(EnergyForm::None);
    let body = Body::block("cloud", gas, [0.0], [1.0], 0.001).velocity([u]);
    let mut cloud = Scene::<f64, 1>::new(scheme)
        .body(body)
        .boundary(MirrorPlane::symmetry([1.0], [1.0]))
        .build()
        .unwrap();
    let end = 3e-3;
    cloud.run_until(end).unwrap();
    let shock = 1.0 - u / (mach * mach - 1.0) * end;
    let mean = |from: f64, to: f64| {
        let inside = cloud
            .all()
            .filter(|p| (from..to).contains(&p.position()[0]));
        let (sum, count) = inside.fold((0.0, 0), |(sum, n), p| (sum + p.density(), n + 1));
        sum / f64::from(count) / 1e-18
    };
    let (behind, before) = (mean(shock + 0.03, 0.98), mean(shock - 0.06, shock - 0.03));
    println!("compressed {behind} behind the shock, {before} before it");
    assert!((behind / (mach * mach) - 1.0).abs() < 0.01, "{behind}");
    assert!((before - 1.0).abs() < 0.01, "{before}");
}

/// A strip of a length \[m\] with a flow that a glide by 0.4 m leaves as it is, drifting along it.
fn strip(length: f64, boundary: impl Boundary<2> + 'static) -> Simulation<f64, 2> {
    let scheme = SchemeBuilder::new(WendlandC2, Inviscid)
        .density(DensityForm::NumberDensity)
        .energy(EnergyForm::None);
    let soft = Material::new("soft", Linear::new(1000.0, 10.0));
    let body = Body::block("strip", soft, [0.0, -0.1], [length, 0.1], 0.02);
    let start = |[x, y]: [f64; 2], own: Start<2>| Start {
        velocity: [
            3.0 + 4.0 * (PI * x / 0.4).cos() * y,
            2.0 * (TAU * x / 0.4).sin() * y,
        ],
        ..own
    };
    let scene = Scene::<f64, 2>::new(scheme).body(body.start(start));
    scene.boundary(boundary).build().unwrap()
}

#[test]
fn half_a_period_behind_a_glide_plane_is_the_whole_period() {
    let mut half = strip(0.4, Glide { period: 0.4 });
    let mut whole = strip(0.8, Periodic::along(0, 0.0, 0.8));
    for simulation in [&mut half, &mut whole] {
        simulation.run_until(0.1).unwrap();
    }
    let fold = |[x, y]: [f64; 2]| {
        let periods = (x / 0.4).floor();
        [
            x - 0.4 * periods,
            if periods as i64 % 2 == 0 { y } else { -y },
        ]
    };
    let (own, all) = (
        half.particles(),
        whole.all().map(|p| p.position()).collect::<Vec<_>>(),
    );
    let mut farthest: f64 = 0.0;
    for (k, particle) in half.all().enumerate() {
        let (row, column) = (k / 20, k % 20);
        let [a, b] = [fold(particle.position()), fold(all[row * 40 + column])];
        let apart = ((a[0] - b[0] + 0.2).rem_euclid(0.4) - 0.2).abs();
        // One that has just passed a period is turned over.
        let across = (a[1] - b[1]).abs().min((a[1] + b[1]).abs());
        farthest = farthest.max(apart).max(across);
    }
    println!("{own} particles, {farthest:e} m apart");
    assert!(farthest < 1e-10, "{farthest}");
    let moved = half.all().next().unwrap().position();
    assert!(
        (moved[0] - 0.01).abs() > 0.05,
        "nothing has gone through the plane"
    );
}

#[test]
fn symplectic_euler_is_of_first_order() {
    // A body at rest under cos(t) m/s² is at 1 − cos(1) m after one second.
    let error = |dt: f64| {
        let scheme = SchemeBuilder::new(CubicSpline, Inviscid).energy(EnergyForm::None);
        let block = Material::new("block", Linear::new(1000.0, 1.0));
        let mut body = Scene::<f64, 1>::new(scheme)
            .body(Body::block("block", block, [0.0], [20.0], 1.0))
            .acceleration(|t: f64| [t.cos()])
            .integrator(SymplecticEuler)
            .steps(|control| StepControl {
                fixed: Some(dt),
                ..control
            })
            .build()
            .unwrap();
        body.run_until(1.0).unwrap();
        body.ledger().whole.momentum[0] / body.ledger().whole.mass - 1.0_f64.sin()
    };
    let [coarse, fine] = [error(0.02), error(0.01)];
    println!("errors {coarse:e}, {fine:e} m/s");
    assert!((1.9..2.1).contains(&(coarse / fine)) && coarse.abs() > 1e-4);
}

#[test]
fn a_wall_of_ones_own_carries_the_weight_of_what_rests_on_it() {
    let (width, depth, spacing, g) = (0.4, 0.2, 0.01, 9.81);
    let water = catalogue::weakly_compressible_water(20.0);
    let liquid = Body::block("water", water, [0.0; 2], [width, depth], spacing)
        .hydrostatic([0.0, -g], [0.0, depth]);
    let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible().walls(LevelWall))
        .body(liquid)
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [width, 2.0 * depth],
            spacing,
            5,
            [[true; 2]; 2],
        ))
        .acceleration(move |_| [0.0, -g])
        .build()
        .unwrap();
    let (mut impulse, mut last) = (0.0, 0.0);
    tank.run_with(0.5, |now| {
        impulse += now.wall_force(0).unwrap()[1] * (now.time() - last);
        last = now.time();
    })
    .unwrap();
    let weight = 1000.0 * width * depth * g;
    let carried = -impulse / 0.5 / weight;
    println!("the floor carries {carried} of the weight");
    assert!((carried - 1.0).abs() < 0.01, "{carried}");
    let fastest = tank
        .all()
        .map(|p| p.velocity()[1].abs())
        .fold(0.0, f64::max);
    assert!(fastest < 0.05 * (g * depth).sqrt(), "{fastest} m/s");
}
