//! Sponge layers: waves of a flume that end in one, against theory and without it, and a stream whose momentum they take. A paddle on a
//! spring and a damper that absorbs.
//! Incident and reflected waves by two gauges: Goda & Suzuki 1976 (Proc. 15th Coastal Eng. Conf., 828).

use approx::{assert_abs_diff_eq, assert_relative_eq};
use meshfree::boundary::Wall;
use meshfree::coupling::Joint;
use meshfree::effect::Sponge;
use meshfree::error::{Error, Problem};
use meshfree::material::{Material, SoundSpeed};
use meshfree::observe::WaveGauge;
use meshfree::prelude::*;
use meshfree::simulation::Criterion;
use std::f64::consts::{PI, TAU};

const DX: f64 = 0.05;
const DEPTH: f64 = 0.5;
const PERIOD: f64 = 1.2;
const GRAVITY: f64 = 9.81;
const OMEGA: f64 = TAU / PERIOD;
/// Amplitude of the piston \[m\], which grows over two periods.
const STROKE: f64 = 0.02;
const GROWTH: f64 = 2.0 * PERIOD;
/// Where the gauges are \[m\], a quarter of a wave apart.
const GAUGES: [f64; 2] = [2.0, 2.5];

/// ω² = g k tanh(k d).
fn wavenumber() -> f64 {
    let deep = OMEGA * OMEGA / GRAVITY;
    (0..100).fold(deep, |k, _| 0.5 * (k + deep / (k * DEPTH).tanh()))
}

/// Place, velocity and acceleration of the piston.
fn piston(t: f64) -> [f64; 3] {
    let (sin, cos) = (OMEGA * t).sin_cos();
    let [grown, rate] = if t < GROWTH {
        [t / GROWTH, 1.0 / GROWTH]
    } else {
        [1.0, 0.0]
    };
    [
        STROKE * grown * sin,
        STROKE * (grown * OMEGA * cos + rate * sin),
        STROKE * (2.0 * rate * OMEGA * cos - grown * OMEGA * OMEGA * sin),
    ]
}

/// A flume whose end is a wall, or open to a floor that goes on.
fn open_flume(length: f64, sponge: Option<Sponge>, is_closed: bool) -> Scene<f64, 2> {
    let gravity = [0.0, -GRAVITY];
    let sound = SoundSpeed::Chosen(10.0 * (GRAVITY * DEPTH).sqrt());
    let water: Material<f64> = catalogue::water_at(sound);
    let body = Body::block("water", water, [0.0; 2], [length, DEPTH], DX);
    let sides = [[false, is_closed], [true, false]];
    let end = if is_closed { length } else { length + 0.5 };
    let place = |i: u32, j: u32| [DX * (f64::from(i) - 4.5), DX * (f64::from(j) + 0.5)];
    let maker = (0..5).flat_map(|i| (0..16).map(move |j| place(i, j)));
    let motion = Translation::new(
        |t| [piston(t)[0], 0.0],
        |t| [piston(t)[1], 0.0],
        |t| [piston(t)[2], 0.0],
    );
    Scene::new(schemes::weakly_compressible().with(sponge))
        .body(body.hydrostatic(gravity, [0.0, DEPTH]))
        .wall(Wall::around("tank", [-0.25, 0.0], [end, 0.8], DX, 5, sides))
        .wall(Wall::of("piston", maker.collect(), DX).motion(motion))
        .acceleration(move |_| gravity)
}

fn flume(length: f64, sponge: Option<Sponge>) -> Simulation<f64, 2> {
    let scene = open_flume(length, sponge, true);
    scene.build().expect("a flume")
}

/// Added mass \[kg/m\] and radiation damping \[kg/(m s)\] of a vertical plate that swings along the flume, from its velocity in the
/// eigenfunctions cosh k(z + d) and cos kₙ(z + d) with ω² = −g kₙ tan kₙ d (Dean & Dalrymple 1991, chapter 6).
fn loads_of_plate() -> [f64; 2] {
    let (k, deep) = (wavenumber(), OMEGA * OMEGA * DEPTH / GRAVITY);
    let kd = k * DEPTH;
    let share = 4.0 * kd.sinh().powi(2) / (2.0 * kd + (2.0 * kd).sinh());
    let of_root = |n: u32| {
        let [mut low, mut high] = [f64::from(n) - 0.5, f64::from(n)].map(|x| x * PI);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if middle.tan() + deep / middle > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        4.0 * low.sin().powi(2) / (low * low * (2.0 * low + (2.0 * low).sin()))
    };
    let added: f64 = (1..200).map(of_root).sum();
    [
        1000.0 * DEPTH * DEPTH * added,
        1000.0 * OMEGA * share / (k * k),
    ]
}

/// Density \[kg/m³\] and size \[m\] of the paddle.
const PADDLE: [f64; 3] = [400.0, 0.25, 0.8];

/// A paddle absorbs where what it radiates cancels what a wall reflects: the damper has the radiation damping, and the spring the mass
/// and added mass in resonance, k = ω² (M + m) (Milgram 1970, J. Ship Res. 14, 187). `share` of that damping is there.
fn paddle(length: f64, share: f64) -> Simulation<f64, 2> {
    let [density, width, height] = PADDLE;
    let [added, damping] = loads_of_plate();
    let stiffness = OMEGA * OMEGA * (density * width * height + added);
    let still = 0.5 * 1000.0 * GRAVITY * DEPTH * DEPTH;
    // The spring is tensioned against water at rest.
    let slider = Joint::slider([length, 0.5 * DEPTH], [1.0, 0.0])
        .stiffness(stiffness)
        .damping(share * damping)
        .rest(-still / stiffness);
    let wood = Material::new("wood", Linear::new(density, 20.0));
    let (low, high) = ([length, 0.0], [length + width, height]);
    open_flume(length, None, false)
        .group(
            schemes::impact_by_continuity(),
            [Body::block("paddle", wood, low, high, DX)],
        )
        .rigid("paddle")
        .between("paddle", "tank", Interaction::None)
        .between("paddle", "piston", Interaction::None)
        .joint_to_ground("paddle", slider)
        .build()
        .expect("a flume")
}

#[test]
fn a_paddle_on_a_spring_and_a_damper_absorbs() {
    let [incident, reflected, _] = waves(paddle(3.5, 1.0), 6.0 * PERIOD);
    println!(
        "paddle: {incident} m, {reflected} back, loads {:?}",
        loads_of_plate()
    );
    assert!(reflected < 0.1 * incident, "{reflected} of {incident}");
    // The control: a hundredth of the damping gives back what the spring takes.
    let [incident, reflected, _] = waves(paddle(3.5, 0.01), 6.0 * PERIOD);
    println!("hardly damped: {incident} m, {reflected} back");
    assert!(reflected > 0.5 * incident, "{reflected} of {incident}");
}

/// Amplitudes \[m\] of the incident and the reflected wave in two periods from a time on, and the power \[W/m\] that laws take then.
fn waves(mut run: Simulation<f64, 2>, from: f64) -> [f64; 3] {
    run.keep_energy();
    let gauges = GAUGES.map(|x| WaveGauge::upwards(&run, "g", [x, 0.0], 1).expect("a gauge"));
    let work = |run: &Simulation<f64, 2>| run.energy().map_or(0.0, |energy| energy.law_work);
    run.run_until(from).expect("waves");
    let (before, count) = (work(&run), 120);
    let mut waves = [[0.0; 2]; 2];
    for k in 1..=count {
        let time = from + 2.0 * PERIOD * f64::from(k) / f64::from(count);
        run.run_until(time).expect("waves");
        let (sin, cos) = (OMEGA * time).sin_cos();
        for (gauge, [a, b]) in gauges.iter().zip(&mut waves) {
            // The mean level is orthogonal to both.
            let height = 2.0 / f64::from(count) * gauge.height(&run);
            *a += height * cos;
            *b += height * sin;
        }
    }
    let ([[a1, b1], [a2, b2]], phase) = (waves, wavenumber() * (GAUGES[1] - GAUGES[0]));
    let (sin, cos) = phase.sin_cos();
    let amplitude = |sign: f64| {
        let along = a2 - a1 * cos - sign * b1 * sin;
        let across = b2 + sign * a1 * sin - b1 * cos;
        along.hypot(across) / (2.0 * sin.abs())
    };
    let power = (work(&run) - before) / (2.0 * PERIOD);
    [amplitude(1.0), amplitude(-1.0), power]
}

#[test]
fn a_sponge_absorbs_what_a_wall_reflects() {
    // One wave of 2.05 m long is the layer.
    let sponge = Sponge::beyond([3.5, 0.0], [1.0, 0.0], 2.0, 5.0);
    let [incident, reflected, power] = waves(flume(5.5, Some(sponge)), 6.0 * PERIOD);
    // Of a piston (Dean & Dalrymple 1991, chapter 6).
    let kd = 2.0 * wavenumber() * DEPTH;
    let theory = STROKE * 2.0 * (kd.cosh() - 1.0) / (kd.sinh() + kd);
    let group = 0.5 * OMEGA / wavenumber() * (1.0 + kd / kd.sinh());
    let flux = 0.5 * 1000.0 * GRAVITY * incident.powi(2) * group;
    println!(
        "sponge: {incident} m of {theory}, {reflected} back, takes {power} of {flux} W/m, group {group} m/s"
    );
    assert_relative_eq!(incident, theory, max_relative = 0.1);
    assert!(reflected < 0.05 * incident, "{reflected} of {incident}");
    assert!(power < 0.0 && power > -1.05 * flux);
    let [incident, reflected, power] = waves(flume(3.5, None), 6.0 * PERIOD);
    println!("wall: {incident} m, {reflected} back");
    assert!(reflected > 0.9 * incident && power == 0.0);
}

/// A body of water that streams in one dimension.
fn stream(sponge: Sponge) -> Scene<f64, 1> {
    let water = catalogue::weakly_compressible_water(1.0);
    Scene::new(schemes::weakly_compressible().with(sponge))
        .body(Body::block("water", water, [0.2], [0.4], 0.01).velocity([1.0]))
}

#[test]
fn the_ledger_has_what_a_sponge_takes() {
    // Towards a current of 0.25 m/s.
    let sponge = Sponge::beyond([0.0], [2.0], 0.1, 20.0).velocity([0.25]);
    let mut run = stream(sponge).build().expect("a stream");
    run.keep_energy();
    let before = run.ledger().whole;
    run.run_until(0.05).expect("a stream");
    let after = run.ledger();
    let v = after.whole.momentum[0] / 200.0;
    let exact = 0.25 + 0.75 * (-1.0_f64).exp();
    assert_relative_eq!(v, exact, max_relative = 1e-4);
    let given = after.whole.momentum[0] - before.momentum[0];
    assert_relative_eq!(after.law_impulse[0], given, max_relative = 1e-12);
    let work = after.whole.total("work of laws").expect("a column");
    assert_relative_eq!(
        work,
        after.whole.kinetic - before.kinetic,
        max_relative = 1e-9
    );
    let energy = run.energy().expect("kept");
    assert_relative_eq!(energy.law_work, work, max_relative = 1e-12);
    assert_abs_diff_eq!(energy.dissipated, 0.0, epsilon = 1e-9);
}

#[test]
fn a_violent_sponge_sets_the_step_and_is_stable() {
    let mut run = stream(Sponge::beyond([0.0], [1.0], 0.1, 1e5))
        .build()
        .expect("a stream");
    run.run_until(1e-3).expect("a stream");
    let vote = run.last_vote().expect("steps");
    assert_relative_eq!(vote.step, 2.5e-6, max_relative = 1e-9);
    assert!(matches!(vote.criterion, Criterion::Effect(name) if name.contains("sponge")));
    assert!(run.all().all(|p| p.velocity()[0].abs() < 1e-9));
}

#[test]
fn wrong_sponges_are_refused() {
    let fine = || Sponge::beyond([0.0], [1.0], 0.1, 1.0);
    for (sponge, what) in [
        (Sponge::beyond([0.0], [0.0], 0.1, 1.0), "normal"),
        (Sponge::beyond([f64::NAN], [1.0], 0.1, 1.0), "place"),
        (
            Sponge::beyond([0.0; 2], [1.0, 0.0], 0.1, 1.0),
            "coordinates",
        ),
        (
            Sponge::beyond([0.0], [1.0], 0.0, 1.0),
            "thickness of a sponge",
        ),
        (Sponge::beyond([0.0], [1.0], 0.1, -1.0), "rate of a sponge"),
        (fine().and(fine().velocity([f64::INFINITY])), "velocity"),
    ] {
        let Err(Error::Build(error)) = stream(sponge).build().map(drop) else {
            panic!("{what} is not refused");
        };
        let [Problem::Parameter { what: named, .. }] = &error.problems[..] else {
            panic!("{what}: {error}");
        };
        assert!(named.contains(what), "{named} for {what}");
    }
    assert!(stream(fine()).problems().is_empty());
}
