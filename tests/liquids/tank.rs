//! A tank of water with 20 particles over its depth of 1 m, at rest and in a standing wave.
//! Both have exact answers, which every scheme of liquids is held against.

use meshfree::boundary::Wall;
use meshfree::material::{Material, SoundSpeed, catalogue};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::study::standing_wave::StandingWave;

pub const GRAVITY: f64 = 9.81;

/// Water in a tank, under the pressure of rest, with 20 particles over its depth.
pub fn tank(
    scheme: impl Into<Scheme<f64, 2>>,
    length: f64,
    flow: impl Fn([f64; 2]) -> [f64; 2],
) -> Scene<f64, 2> {
    let spacing = 0.05;
    let water: Material<f64> = catalogue::water_at(SoundSpeed::Chosen(10.0 * GRAVITY.sqrt()));
    let body = Body::block("water", water, [0.0; 2], [length, 1.0], spacing)
        .hydrostatic([0.0, -GRAVITY], [0.0, 1.0])
        .start(|x, start| Start {
            velocity: flow(x),
            ..start
        });
    let sides = [[true; 2], [true, false]];
    Scene::new(scheme)
        .body(body)
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [length, 1.5],
            spacing,
            5,
            sides,
        ))
        .acceleration(|_| [0.0, -GRAVITY])
}

/// Of a column after 20 √(H/g): RMS error of the pressure over ρgH, rise of the mean height in
/// spacings, and the greatest speed over c.
pub fn after_rest(scheme: impl Into<Scheme<f64, 2>>) -> [f64; 3] {
    let mut column = tank(scheme, 0.5, |_| [0.0; 2]).build().expect("a column");
    let mean = |now: &Simulation<f64, 2>| {
        now.all().map(|p| p.position()[1]).sum::<f64>() / now.particles() as f64
    };
    let before = mean(&column);
    column.run_until(20.0 / GRAVITY.sqrt()).expect("rest");
    // Of a column that its weight compresses, p = ρ₀c² (exp(g d/c²) − 1) with c² = 100 gH.
    let exact = |z: f64| 100.0 * (0.01 * (1.0 - z)).exp_m1();
    let whole = 1000.0 * GRAVITY;
    let squares = column
        .all()
        .map(|p| (p.pressure() / whole - exact(p.position()[1])).powi(2));
    let rms = (squares.sum::<f64>() / column.particles() as f64).sqrt();
    let fastest = column
        .all()
        .map(|p| p.velocity()[0].hypot(p.velocity()[1]))
        .fold(0.0, f64::max);
    let rise = (mean(&column) - before) / 0.05;
    [rms, rise, fastest / (10.0 * GRAVITY.sqrt())]
}

/// Of a standing wave of 5 cm, from a flat surface through two swings: its period over the exact one, and the
/// second crest over the first.
pub fn swings(scheme: impl Into<Scheme<f64, 2>>) -> [f64; 2] {
    let wave = StandingWave::new(2.0, 1.0, 0.05).and_then(|wave| wave.with_gravity(GRAVITY));
    let wave = wave.expect("a wave");
    let period = wave.finite_amplitude_period().expect("a period");
    let flat = -0.25 * wave.period();
    let mut water = tank(scheme, 1.0, |x| wave.velocity(x, flat))
        .build()
        .expect("a tank");
    let height = |now: &Simulation<f64, 2>| {
        let cosine = |x: f64| (wave.wavenumber() * x).cos();
        now.all()
            .map(|p| p.mass() / p.density() * cosine(p.position()[0]))
            .sum::<f64>()
    };
    let (mut last, mut rises, mut crests) = ((0.0, height(&water)), Vec::new(), [0.0_f64; 2]);
    water
        .run_with(2.1 * period, |now| {
            let next = (now.time(), height(now));
            if last.1 < 0.0 && next.1 >= 0.0 && next.0 > 0.5 * period {
                let share = last.1 / (last.1 - next.1);
                rises.push(last.0 + share * (next.0 - last.0));
            }
            let swing = usize::from(next.0 > period);
            crests[swing] = crests[swing].max(next.1);
            last = next;
        })
        .expect("a run");
    [0.5 * rises[1] / period, crests[1] / crests[0]]
}
