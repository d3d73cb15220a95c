//! Clamped particles and rigid bodies, against closed forms and Euler's equations.
//! What holds them is in the ledger, and a checkpoint goes on from them to the same bits.

use meshfree::boundary::Translation;
use meshfree::coupling::ContactDensity;
use meshfree::effect::Hypoelastic;
use meshfree::integrator::RungeKutta4;
use meshfree::material::Material;
use meshfree::material::eos::Linear;
use meshfree::scene::{Body, Scene};
use meshfree::scheme::{Scheme, Start};
use meshfree::schemes;
use meshfree::simulation::{Load, Simulation};

fn linear(density: f64, sound_speed: f64) -> Material<f64> {
    Material::new("linear", Linear::new(density, sound_speed))
}

fn solid() -> Scheme<f64, 2> {
    schemes::impact_by_continuity().with(Hypoelastic).into()
}

#[cfg(feature = "checkpoint")]
fn bits<const D: usize>(now: &Simulation<f64, D>) -> Vec<u64> {
    let numbers = now.all().flat_map(|p| [p.position(), p.velocity()]);
    numbers.flatten().map(f64::to_bits).collect()
}

type Vector = [f64; 3];

fn cross(a: Vector, b: Vector) -> Vector {
    core::array::from_fn(|d| a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3])
}

/// A brick of unlike edges in space, and what it turns with at first \[1/s\]: nearly about its middle axis, which is
/// unstable.
const SPIN: Vector = [0.05, 3.0, 0.02];
const COUNTS: Vector = [4.0, 6.0, 8.0];
const SPACING: f64 = 0.1;

fn brick(turned: bool) -> Simulation<f64, 3> {
    let low = COUNTS.map(|count| -0.5 * count * SPACING);
    let turns = move |x: Vector, start: Start<3>| Start {
        velocity: if turned { cross(SPIN, x) } else { [0.0; 3] },
        ..start
    };
    Scene::new(schemes::impact_by_continuity())
        .body(Body::block("brick", linear(500.0, 5.0), low, low.map(|x| -x), SPACING).start(turns))
        .rigid("brick")
        .build()
        .unwrap()
}

/// Angular momentum about the origin and kinetic energy.
fn spinning(now: &Simulation<f64, 3>) -> (Vector, f64) {
    now.all().fold(([0.0; 3], 0.0), |(spin, energy), p| {
        let (x, v, m) = (p.position(), p.velocity(), p.mass());
        let own = cross(x, v);
        let square: f64 = v.iter().map(|v| v * v).sum();
        (
            core::array::from_fn(|d| spin[d] + m * own[d]),
            energy + 0.5 * m * square,
        )
    })
}

/// Where a point of the brick goes by Euler's equations and ẋ = ω × x, by Runge & Kutta with small steps.
fn by_euler(point: Vector, end: f64) -> Vector {
    // Σ m r² over a lattice: (n² − 1) s²/12 along each axis.
    let along = COUNTS.map(|count| (count * count - 1.0) * SPACING * SPACING / 12.0);
    let inertia: Vector = core::array::from_fn(|d| along[(d + 1) % 3] + along[(d + 2) % 3]);
    // ω in the body, and its axes in space.
    type State = [Vector; 4];
    let rate = |y: &State| -> State {
        let w = y[0];
        let momentum = core::array::from_fn(|d| inertia[d] * w[d]);
        let moment = cross(momentum, w);
        let space: Vector = core::array::from_fn(|k| (0..3).map(|d| w[d] * y[1 + d][k]).sum());
        [
            core::array::from_fn(|d| moment[d] / inertia[d]),
            cross(space, y[1]),
            cross(space, y[2]),
            cross(space, y[3]),
        ]
    };
    let add = |y: &State, k: &State, by: f64| -> State {
        core::array::from_fn(|n| core::array::from_fn(|d| y[n][d] + by * k[n][d]))
    };
    let mut y: State = [SPIN, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let count = 40_000;
    let dt = end / f64::from(count);
    for _ in 0..count {
        let a = rate(&y);
        let b = rate(&add(&y, &a, 0.5 * dt));
        let c = rate(&add(&y, &b, 0.5 * dt));
        let d = rate(&add(&y, &c, dt));
        for (k, by) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
            y = add(&y, &k, by * dt / 6.0);
        }
    }
    core::array::from_fn(|k| (0..3).map(|d| point[d] * y[1 + d][k]).sum())
}

#[test]
fn a_free_brick_turns_over_as_euler_has_it() {
    let mut simulation = brick(true);
    let (spin, energy) = spinning(&simulation);
    let first = simulation.all().next().unwrap().position();
    let (mut worst, mut turned) = (0.0_f64, 1.0_f64);
    let end = 12.0;
    simulation
        .run_with(end, |now| {
            let (_, present) = spinning(now);
            worst = worst.max((present / energy - 1.0).abs());
            // The middle axis turns over: its first particle goes to the other side.
            let place = now.all().next().unwrap().position();
            turned = turned.min(place[1] / first[1]);
        })
        .unwrap();
    let (after, _) = spinning(&simulation);
    let size = |v: Vector| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    let lost = size(core::array::from_fn(|d| after[d] - spin[d])) / size(spin);
    let place = simulation.all().next().unwrap().position();
    let exact = by_euler(first, end);
    let off = size(core::array::from_fn(|d| place[d] - exact[d])) / size(first);
    println!(
        "energy {worst:e}, momentum {lost:e}, place {off:e}, turned {turned}, steps {}",
        simulation.steps()
    );
    assert!(turned < -0.8, "it has turned over: {turned}");
    assert!(lost < 1e-11, "{lost:e}");
    assert!(worst < 1e-4, "{worst:e}");
    assert!(off < 0.02, "{off:e}");
    // Places in it stay.
    let points: Vec<Vector> = simulation.all().map(|p| p.position()).collect();
    let still: Vec<Vector> = brick(false).all().map(|p| p.position()).collect();
    let apart = |all: &[Vector], k: usize| size(core::array::from_fn(|d| all[k][d] - all[0][d]));
    for k in 1..points.len() {
        assert!((apart(&points, k) / apart(&still, k) - 1.0).abs() < 1e-12);
    }
}

/// A rigid box that falls on ground that is fixed below, tilted.
fn falling(mu: f64, tilt: f64) -> Scene<f64, 2> {
    let dx = 0.01;
    let (sin, cos) = tilt.sin_cos();
    let count = 10;
    let mut points = Vec::new();
    for k in 0..count * count {
        let [x, y] =
            [k % count, k / count].map(|n| (f64::from(n) - 0.5 * f64::from(count - 1)) * dx);
        points.push([cos * x - sin * y, 0.1 + sin * x + cos * y]);
    }
    let hard = || linear(1000.0, 20.0).with_shear_modulus(1e5);
    Scene::new(solid())
        .body(Body::points_of("box", hard(), points, dx))
        .body(Body::block("ground", hard(), [-0.3, -0.03], [0.3, 0.0], dx))
        .rigid("box")
        .fix("ground", |_| true)
        .couple("box", "ground", ContactDensity::new().friction(mu))
        .load(Load::acceleration(|_| [0.0, -9.81]).on("box"))
}

#[test]
fn a_rigid_box_bounces_with_the_energy_that_it_has() {
    let mut simulation = falling(0.0, 0.0).build().unwrap();
    let height = |now: &Simulation<f64, 2>| {
        let all: Vec<f64> = now.body("box").unwrap().map(|p| p.position()[1]).collect();
        all.iter().sum::<f64>() / all.len() as f64
    };
    let (start, mut lowest, mut again) = (height(&simulation), f64::INFINITY, 0.0_f64);
    // It falls by 0.05 m within 0.101 s.
    simulation
        .run_with(0.24, |now| {
            lowest = lowest.min(height(now));
            if now.time() > 0.15 {
                again = again.max(height(now));
            }
        })
        .unwrap();
    let contact = &simulation.contacts()[0];
    let ledger = simulation.ledger();
    println!(
        "{start} {lowest} {again} {contact:?} {:?}",
        simulation.clamps()
    );
    assert!(((again - 0.05) / (start - 0.05) - 1.0).abs() < 0.02);
    assert!(lowest < 0.05 && contact.largest_penetration < 0.2);
    // The ground has not moved, and its clamp has taken what it was given.
    assert_eq!(ledger.bodies[1].1.kinetic, 0.0);
    let clamp = &simulation.clamps()[0];
    assert_eq!(clamp.work, 0.0);
    let mass = ledger.bodies[0].1.mass;
    let fallen = -9.81 * mass * simulation.time();
    let momentum = ledger.whole.momentum[1];
    assert!(((momentum - fallen) / clamp.impulse[1] - 1.0).abs() < 1e-10);
}

#[test]
fn a_rigid_box_that_lands_on_its_edge_loses_what_friction_takes() {
    let mut simulation = falling(0.5, 0.3).build().unwrap();
    let height = |now: &Simulation<f64, 2>| {
        let all: Vec<f64> = now.body("box").unwrap().map(|p| p.position()[1]).collect();
        all.iter().sum::<f64>() / all.len() as f64
    };
    let start = height(&simulation);
    simulation.run_until(0.6).unwrap();
    let own = &simulation.ledger().bodies[0].1;
    let contact = &simulation.contacts()[0];
    let fell = own.mass * 9.81 * (start - height(&simulation));
    let [work, _] = contact.work;
    println!("{fell} {work} {contact:?}");
    // What gravity and the contact have worked is what it moves with.
    assert!(((own.kinetic - fell - work) / fell).abs() < 1e-10);
    // Friction has taken nearly all that the contact has.
    assert!(contact.heat > 0.0 && contact.heat + contact.stored < -work);
    assert!(contact.heat + contact.stored > -0.9 * work);
    let lowest = simulation.body("box").unwrap().map(|p| p.position()[1]);
    assert!(lowest.fold(f64::INFINITY, f64::min) > 0.0);
}

#[test]
fn a_rod_that_is_fixed_swings_by_a_quarter_of_its_wave() {
    // Of length one from the clamp: it shortens for 2 L/c, and flies off the other way for as long.
    let v = 1e-4;
    let dx = 0.01;
    let flies = move |[x]: [f64; 1], start: Start<1>| Start {
        velocity: [if x > 0.0 { -v } else { 0.0 }],
        ..start
    };
    let mut simulation = Scene::<f64, 1>::new(schemes::impact())
        .body(Body::block("rod", linear(1.0, 1.0), [-3.0 * dx], [1.0], dx).start(flies))
        .fix("rod", |x| x[0] < 0.0)
        .build()
        .unwrap();
    let energy = simulation.ledger().whole.total_energy();
    let mut pushed = Vec::new();
    simulation
        .run_with(4.0, |now| {
            pushed.push((now.time(), now.clamps()[0].force[0]));
        })
        .unwrap();
    // It pushes with ρ c v, and then pulls.
    let mean = |from: f64, to: f64| {
        let own: Vec<f64> = pushed
            .iter()
            .filter(|p| p.0 > from && p.0 < to)
            .map(|p| p.1)
            .collect();
        own.iter().sum::<f64>() / own.len() as f64 / v
    };
    let (push, pull) = (mean(0.2, 1.8), mean(2.2, 3.8));
    let clamp = &simulation.clamps()[0];
    let ledger = simulation.ledger();
    let momentum = (ledger.whole.momentum[0] + v - clamp.impulse[0]) / v;
    println!(
        "{push} {pull} {momentum:e} {:e}",
        ledger.whole.total_energy() / energy - 1.0
    );
    assert!((push - 1.0).abs() < 0.01 && (pull + 1.0).abs() < 0.01);
    assert!(momentum.abs() < 1e-11);
    assert!((ledger.whole.total_energy() / energy - 1.0).abs() < 1e-12);
    assert!(simulation.all().take(3).all(|p| p.velocity() == [0.0]));
}

#[test]
fn what_is_pulled_gets_the_work_of_its_clamp() {
    let v = 1e-3;
    let mut simulation = Scene::<f64, 1>::new(schemes::impact())
        .body(Body::block("rod", linear(1.0, 1.0), [0.0], [1.0], 0.01))
        .fix("rod", |x| x[0] < 0.03)
        .clamp(
            "rod",
            |x| x[0] > 0.97,
            Translation::new(
                move |t| [v * (1.0 - t.cos())],
                move |t| [v * t.sin()],
                move |t| [v * t.cos()],
            ),
        )
        .build()
        .unwrap();
    simulation.run_until(3.0).unwrap();
    let clamps = simulation.clamps();
    let whole = simulation.ledger().whole;
    let end = simulation.all().last().unwrap().position()[0];
    println!(
        "{clamps:?} {:e} {:e}",
        whole.total_energy() / clamps[1].work - 1.0,
        (end - 0.995) / v - 1.0 + 3.0_f64.cos()
    );
    assert!((whole.total_energy() / clamps[1].work - 1.0).abs() < 1e-10);
    let given = clamps[0].impulse[0] + clamps[1].impulse[0];
    assert!((whole.momentum[0] - given).abs() < 1e-12 * v);
    assert!(((end - 0.995) / v - 1.0 + 3.0_f64.cos()).abs() < 1e-3);
}

/// A striker meets a stiff rod that takes steps of its own, and is fixed from a place on.
fn struck(fixed_to: f64) {
    let v = 1e-3;
    let mut simulation = Scene::<f64, 1>::new(schemes::impact())
        .body(Body::block("striker", linear(1.0, 1.0), [0.5], [1.0], 0.01).velocity([-v]))
        .group(
            schemes::impact(),
            [Body::block("rod", linear(1.0, 4.0), [0.0], [0.5], 0.01)],
        )
        .sub_cycle("rod", 8)
        .couple("striker", "rod", ContactDensity::new())
        .fix("rod", move |x| x[0] < fixed_to)
        .build()
        .unwrap();
    let kept = |now: &Simulation<f64, 1>| {
        let whole = now.ledger().whole;
        whole.total_energy() - whole.total("work of couplings").unwrap_or(0.0)
    };
    let (energy, momentum) = (kept(&simulation), simulation.ledger().whole.momentum[0]);
    simulation.run_until(0.9).unwrap();
    let clamp = &simulation.clamps()[0];
    let ledger = simulation.ledger();
    let given = (ledger.whole.momentum[0] - momentum - clamp.impulse[0]) / momentum;
    println!(
        "{fixed_to} {given:e} {:e} {clamp:?}",
        kept(&simulation) / energy - 1.0
    );
    assert!(simulation.sub_steps() > simulation.steps());
    assert!(
        clamp.impulse[0] > 0.4 * v && given.abs() < 1e-11,
        "{given:e}"
    );
    assert!((kept(&simulation) / energy - 1.0).abs() < 1e-10);
    let still = simulation.body("rod").unwrap().take(clamp.particles);
    assert!(still.into_iter().all(|p| p.velocity() == [0.0]));
}

#[test]
fn what_steps_on_its_own_is_held_against_couplings_too() {
    struck(0.03);
    struck(1.0);
}

#[test]
fn what_cannot_be_held_is_refused() {
    let scene = || {
        Scene::<f64, 1>::new(schemes::impact()).body(Body::block(
            "rod",
            linear(1.0, 1.0),
            [0.0],
            [1.0],
            0.1,
        ))
    };
    for (scene, part) in [
        (
            scene().fix("bar", |_| true),
            "there is no body called `bar`",
        ),
        (
            scene().fix("rod", |x| x[0] > 2.0),
            "holds none of its particles",
        ),
        (scene().rigid("bar"), "there is no body called `bar`"),
        (
            scene().rigid("rod").fix("rod", |x| x[0] < 0.55),
            "is rigid, and particles of it are clamped",
        ),
        (
            scene().rigid("rod").integrator(RungeKutta4),
            "does not step by kicks and drifts",
        ),
    ] {
        let all: Vec<String> = scene.problems().iter().map(ToString::to_string).collect();
        assert!(
            all.iter().any(|text| text.contains(part)),
            "{part}: {all:?}"
        );
    }
}

#[cfg(feature = "checkpoint")]
#[test]
fn what_is_held_goes_on_from_a_checkpoint_to_the_same_bits() {
    let file = std::env::temp_dir().join(format!("meshfree-held-{}", std::process::id()));
    let mut through = falling(0.3, 0.2).build().unwrap();
    through.run_until(0.11).unwrap();
    through.evaluate().unwrap();
    through.save(&file).unwrap();
    let mut resumed = falling(0.3, 0.2).resume(&file).unwrap();
    let _ = std::fs::remove_file(&file);
    for simulation in [&mut through, &mut resumed] {
        simulation.run_until(0.14).unwrap();
    }
    assert!(through.contacts()[0].heat > 0.0);
    assert_eq!(bits(&through), bits(&resumed));
    assert_eq!(through.clamps(), resumed.clamps());
    assert_eq!(through.contacts(), resumed.contacts());
}
