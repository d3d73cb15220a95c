//! Dam breaks in seconds: the front, the end at rest, and what walls and ledgers must balance.
//! `docs/dam_breaks.md` holds the same against experiments at spacings that take longer.

use meshfree::boundary::Translation;
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::observe::{PressureProbe, WaveGauge};
use meshfree::prelude::*;
use meshfree::study::dam_break::Column;
use meshfree::term::viscosity::MonaghanGingold;

const GRAVITY: f64 = 9.81;
/// Column of Martin & Moyce 1952, table 2: a × 2a \[m\].
const WIDTH: f64 = 0.05715;

fn water<T: Real>(sound_speed: f64) -> Material<T> {
    Liquid::new(1000.0, 1480.0, 1e-3).material("water", SoundSpeed::Chosen(sound_speed))
}

/// A column `wide` × `high` in an open tank of `length`, with `more` behind a word of the scene.
fn column<T: Real>(wide: f64, high: f64, length: f64, spacing: f64, alpha: f64) -> Scene<T, 2> {
    let sound_speed = 20.0 * (GRAVITY * high).sqrt();
    let scheme =
        schemes::weakly_compressible().with_viscosity(MonaghanGingold { alpha, beta: 0.0 });
    let water = water(sound_speed).with_pressure_cut_off(0.0);
    let body = Body::block("water", water, [0.0; 2], [wide, high], spacing)
        .hydrostatic([0.0, -GRAVITY], [0.0, high]);
    let closed = [[true, true], [true, false]];
    Scene::new(scheme)
        .body(body)
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [length, 1.5 * high],
            spacing,
            3,
            closed,
        ))
        .acceleration(|_| [0.0, -GRAVITY])
}

/// The column of Martin & Moyce with so many particles across.
fn martin_moyce<T: Real>(across: f64) -> Scene<T, 2> {
    column(WIDTH, 2.0 * WIDTH, 6.0 * WIDTH, WIDTH / across, 0.02)
}

fn front<T: Real>(simulation: &Simulation<T, 2>) -> f64 {
    let foremost = simulation
        .all()
        .fold(0.0_f64, |most, p| most.max(p.position()[0]));
    foremost + 0.5 * simulation.spacing()
}

fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (mx, my) = points
        .iter()
        .fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (xy, xx) = points.iter().fold((0.0, 0.0), |(a, b), (x, y)| {
        (a + (x - mx) * (y - my), b + (x - mx) * (x - mx))
    });
    xy / xx
}

/// Between the measured front of Martin & Moyce 1952, table 2, whose bed has friction and whose gate takes
/// its time, and that of shallow water without either (Ritter 1892).
#[test]
fn the_front_is_ahead_of_the_measured_one_and_behind_that_of_shallow_water() {
    let measured = [
        (1.19, 1.44),
        (1.43, 1.67),
        (1.83, 2.11),
        (2.20, 2.56),
        (2.51, 3.00),
        (2.83, 3.44),
        (3.11, 3.89),
        (3.33, 4.11),
    ];
    let units = Column::new(WIDTH, 2.0 * WIDTH).unwrap();
    let mut simulation = martin_moyce::<f64>(20.0).build().unwrap();
    let mut computed = Vec::new();
    for (time, place) in measured {
        simulation
            .run_until(time * units.front_time_unit())
            .unwrap();
        let own = front(&simulation) / WIDTH;
        let bound = 1.0 + units.ritter_front(simulation.time()) / WIDTH;
        assert!(place < own && own < bound, "{place} {own} {bound}");
        computed.push((time, own));
    }
    let ratio = slope(&computed) / slope(&measured);
    assert!((1.0..1.1).contains(&ratio), "{ratio} {computed:?}");
    // No water is lost, and none is in a wall.
    for particle in simulation.all() {
        let [x, y] = particle.position();
        assert!((0.0..6.0 * WIDTH).contains(&x) && y > 0.0, "{x} {y}");
    }
}

/// After all has come to rest the water stands as high as its volume says, under its own weight.
#[test]
fn the_end_is_a_pool_of_the_same_volume_at_hydrostatic_pressure() {
    let (side, length, spacing) = (0.1, 0.2, 0.005);
    // Strong viscosity, so that it comes to rest soon.
    let mut simulation = column::<f64>(side, side, length, spacing, 0.5)
        .build()
        .unwrap();
    simulation.run_until(2.0).unwrap();
    let depth = side * side / length;
    let places = [0.05, 0.1, 0.15].map(|x| [x, 0.0]);
    let gauges = places.map(|foot| WaveGauge::upwards(&simulation, "h", foot, 1).unwrap());
    let mean = gauges.iter().map(|g| g.height(&simulation)).sum::<f64>() / 3.0;
    assert!((mean / depth - 1.0).abs() < 0.04, "{mean}");
    let probes =
        places.map(|x| PressureProbe::disc(&simulation, "p", x, [0.0, 1.0], 0.02).unwrap());
    let pressure = probes.iter().map(|p| p.pressure(&simulation)).sum::<f64>() / 3.0;
    let expected = 1000.0 * GRAVITY * depth;
    assert!(
        (pressure / expected - 1.0).abs() < 0.04,
        "{pressure} {expected}"
    );
    // The tank carries the weight of the water to a hundredth.
    let weight = GRAVITY * simulation.ledger().whole.mass;
    let mut carried = 0.0;
    let steps = 200;
    for _ in 0..steps {
        simulation.step().unwrap();
        carried -= simulation.wall_force(0).unwrap()[1] / f64::from(steps);
    }
    assert!((carried / weight - 1.0).abs() < 0.01, "{carried} {weight}");
}

/// What gravity gives less what walls take is the momentum of the water, through the impact.
#[test]
fn reactions_of_the_walls_balance_the_momentum() {
    let spacing = WIDTH / 12.0;
    let post: Vec<[f64; 2]> = (0..24)
        .map(|k| [k % 4, k / 4].map(|n| (f64::from(n) + 0.5) * spacing))
        .map(|[x, y]| [2.0 * WIDTH + x, y])
        .collect();
    let mut simulation = martin_moyce::<f64>(12.0)
        .wall(Wall::of("post", post, spacing))
        .build()
        .unwrap();
    simulation.run_until(0.15).unwrap();
    let whole = simulation.ledger().whole;
    let loads = [0.0, -GRAVITY * whole.mass * simulation.time()];
    let scale = loads[1].abs();
    for d in 0..2 {
        let walls = simulation.wall_impulse(0).unwrap()[d] + simulation.wall_impulse(1).unwrap()[d];
        let gap = whole.momentum[d] + walls - loads[d];
        assert!(gap.abs() < 1e-11 * scale, "{gap} {scale}");
    }
    // The post was struck.
    assert!(simulation.wall_impulse(1).unwrap()[0] > 0.01 * scale);
}

/// Work, stored energy and dissipation add up, the work is the fall of the water, and dissipation only
/// grows, but for what a step is off.
#[test]
fn the_energy_ledger_closes_and_dissipation_is_not_negative() {
    let mut simulation = martin_moyce::<f64>(12.0).build().unwrap();
    simulation.keep_energy();
    let potential = |now: &Simulation<f64, 2>| -> f64 {
        now.all()
            .map(|p| p.mass() * GRAVITY * p.position()[1])
            .sum()
    };
    let before = potential(&simulation);
    let start = simulation.energy().unwrap();
    let mut least = 0.0_f64;
    simulation
        .run_with(0.25, |now| {
            least = least.min(now.energy().unwrap().dissipated);
        })
        .unwrap();
    let end = simulation.energy().unwrap();
    let fall = before - potential(&simulation);
    // Work is summed in kicks and the fall in drifts, which differ by the third power of a step.
    assert!(
        (end.load_work / fall - 1.0).abs() < 1e-5,
        "{} {fall}",
        end.load_work
    );
    let kinetic = simulation.ledger().whole.kinetic;
    let closing = start.kinetic + start.compression + fall - kinetic - end.compression;
    assert!((end.dissipated - closing).abs() < 1e-5 * fall);
    assert!(least > -1e-4 * fall, "{least} {fall}");
    // The impact on the far wall has cost something by then.
    assert!(end.dissipated > 0.01 * fall, "{} {fall}", end.dissipated);
}

/// The same bits on one and on three threads, through list builds and the impact.
#[test]
fn threads_do_not_change_a_bit() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut simulation = martin_moyce::<f64>(12.0).build().unwrap();
            simulation.run_until(0.1).unwrap();
            let state = simulation
                .all()
                .map(|p| (p.position(), p.velocity(), p.density()));
            state.collect::<Vec<_>>()
        })
    };
    assert_eq!(run(1), run(3));
}

/// Half the digits carry the same front.
#[test]
fn single_precision_carries_the_same_flow() {
    fn state<T: Real>() -> (f64, f64) {
        let mut simulation = martin_moyce::<T>(12.0).build().unwrap();
        simulation.run_until(0.12).unwrap();
        let whole = simulation.ledger().whole;
        (front(&simulation), whole.kinetic)
    }
    let (single, double) = (state::<f32>(), state::<f64>());
    assert!(
        (single.0 - double.0).abs() < 0.02 * WIDTH,
        "{single:?} {double:?}"
    );
    assert!(
        (single.1 / double.1 - 1.0).abs() < 0.005,
        "{single:?} {double:?}"
    );
}

/// A wall that draws away leaves the liquid behind. With suction allowed it takes the liquid along: the
/// control, which shows that the first is the doing of the floor and the cut-off.
#[test]
fn separating_walls_let_go_unless_suction_is_allowed() {
    let drawn = |floor: f64, cut_off: f64| {
        let spacing = 0.01;
        let points = (0..3 * 20).map(|k| {
            let [i, j] = [k % 3, k / 3].map(|n| (f64::from(n) + 0.5) * spacing);
            [-i, j]
        });
        let wall =
            Wall::of("wall", points.collect(), spacing).motion(Translation::steady([-1.0, 0.0]));
        let water = water::<f64>(20.0).with_pressure_cut_off(cut_off);
        let body = Body::block("water", water, [0.0; 2], [0.2, 0.2], spacing);
        let scheme = schemes::weakly_compressible().walls(ExtrapolatedPressure { floor });
        let mut simulation = Scene::new(scheme).body(body).wall(wall).build().unwrap();
        simulation.run_until(0.02).unwrap();
        let whole = simulation.ledger().whole;
        whole.momentum[0] / whole.mass
    };
    let (lets_go, floor_alone) = (drawn(0.0, 0.0), drawn(0.0, -1e9));
    let sucked = drawn(f64::NEG_INFINITY, -1e9);
    assert!(lets_go.abs() < 1e-6, "{lets_go}");
    assert!(sucked < -0.1, "{sucked}");
    // The floor takes the wall's suction away, and leaves the tension of the liquid itself.
    assert!(
        floor_alone.abs() < 0.3 * sucked.abs(),
        "{floor_alone} {sucked}"
    );
}

/// A drop that is blown apart tears, and what flies off keeps nine tenths of its density; without a
/// cut-off it holds together.
#[test]
fn spray_stays_water() {
    let blown = |cut_off: f64| {
        let water = water::<f64>(20.0).with_pressure_cut_off(cut_off);
        let drop = Body::block("drop", water, [-0.05; 2], [0.05; 2], 0.01).start(|x, start| {
            meshfree::scene::Start {
                velocity: x.map(|x| 100.0 * x),
                ..start
            }
        });
        let mut simulation = Scene::new(schemes::weakly_compressible())
            .body(drop)
            .build()
            .unwrap();
        simulation.run_until(0.05).unwrap();
        let least = simulation
            .all()
            .fold(f64::INFINITY, |least, p| least.min(p.density()));
        (least, simulation.limited("cavitation"))
    };
    let (least, held) = blown(0.0);
    assert!(
        (least / 900.0 - 1.0).abs() < 1e-3 && held > 0,
        "{least} {held}"
    );
    assert_eq!(blown(-1e9).1, 0);
}
