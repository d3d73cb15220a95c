//! Rows of a lattice strike a wall all at once, and a sensor reads spikes; particles off the lattice do not.
//! The control is the same dam break on the lattice.

use meshfree::material::{Liquid, SoundSpeed};
use meshfree::observe::PressureProbe;
use meshfree::prelude::*;

const DX: f64 = 0.04;
const GRAVITY: f64 = 9.81;

/// A column 0.4 m wide and high, put off its lattice, breaks in a tank of 1.2 m; returns the greatest mean over 5 ms
/// that a sensor low on the far wall reads \[Pa\], and what it reads in the mean from 0.45 s, when all have struck, to
/// 0.6 s.
fn strike(off_lattice: impl Fn(Body<f64, 3>) -> Body<f64, 3>) -> [f64; 2] {
    let water: Material<f64> = Liquid::new(1000.0, 1480.0, 1e-3)
        .material("water", SoundSpeed::Chosen(40.0))
        .with_pressure_cut_off(0.0);
    let column = Body::block("column", water, [0.0; 3], [0.4; 3], DX);
    let column = off_lattice(column).hydrostatic([0.0, 0.0, -GRAVITY], [0.0, 0.0, 0.4]);
    let closed = [[true; 2], [true; 2], [true, false]];
    let tank = Wall::around("tank", [0.0; 3], [1.2, 0.4, 0.6], DX, 3, closed);
    let mut simulation = Scene::new(schemes::weakly_compressible())
        .body(column)
        .wall(tank)
        .acceleration(|_| [0.0, 0.0, -GRAVITY])
        .build()
        .unwrap();
    let place = [1.2, 0.2, 0.04];
    let sensor = PressureProbe::disc(&simulation, "foot", place, [-1.0, 0.0, 0.0], DX).unwrap();
    let mut impulse = vec![(0.0, 0.0)];
    simulation
        .run_with(0.6, |now| {
            let (time, sum) = impulse[impulse.len() - 1];
            let pressure = sensor.pressure(now);
            impulse.push((now.time(), sum + pressure * (now.time() - time)));
        })
        .unwrap();
    let between = |from: f64, to: f64| {
        let at = |time: f64| {
            impulse[impulse
                .partition_point(|own| own.0 < time)
                .min(impulse.len() - 1)]
        };
        let (begin, end) = (at(from), at(to));
        (end.1 - begin.1) / (end.0 - begin.0)
    };
    let peak = (0..550)
        .map(|k| 1e-3 * f64::from(k))
        .map(|from| between(from, from + 5e-3));
    [peak.fold(0.0, f64::max), between(0.45, 0.6)]
}

#[test]
fn particles_off_the_lattice_strike_one_after_the_other() {
    let [rows, mean] = strike(|column| column);
    let check = |name: &str, [drops, own]: [f64; 2]| {
        let text = format!("{name}: {drops} of {rows}, {own} of {mean}");
        assert!(drops < 0.5 * rows, "{text}");
        assert!((own / mean - 1.0).abs() < 0.1, "{text}");
    };
    for seed in [1, 2] {
        let jitter = |column: Body<f64, 3>| column.jitter(0.2, seed);
        check("jitter", strike(jitter));
    }
}
