//! Solids in tanks of particles with water: blocks that sink lie on the floor, which bears what the water does not, and one
//! scene with all that floats, sinks, bends, is wet and stays dry.

use meshfree::boundary::Wall;
use meshfree::coupling::{ContactDensity, Penalty};
use meshfree::effect::NeoHookean;
use meshfree::material::SoundSpeed;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::term::viscosity::MonaghanGingold;

pub(crate) const DX: f64 = 0.02;
pub(crate) const G: f64 = 9.81;
const SOUND: f64 = 20.0;

pub(crate) fn rubber(density: f64, youngs: f64) -> Material<f64> {
    let law = Linear::from_elastic_constants(density, youngs, 0.3);
    Material::new("rubber", law).with_shear_modulus(youngs / 2.6)
}

pub(crate) fn stuff(density: f64) -> Material<f64> {
    Material::new("stuff", Linear::new(density, SOUND))
}

/// A box of so many spacings, from the place of its lower corner in spacings.
pub(crate) fn boxed(
    name: &str,
    material: Material<f64>,
    [i, j]: [f64; 2],
    [m, n]: [f64; 2],
) -> Body<f64, 2> {
    let (low, high) = ([i * DX, j * DX], [(i + m) * DX, (j + n) * DX]);
    Body::block(name, material, low, high, DX)
}

/// Water of `depth` spacings in a tank of `width`, around boxes that are given by two corners in spacings.
pub(crate) fn water(width: i32, depth: i32, around: &[[[f64; 2]; 2]]) -> Body<f64, 2> {
    let cells =
        (0..depth).flat_map(|j| (0..width).map(move |i| [f64::from(i) + 0.5, f64::from(j) + 0.5]));
    let free = |x: &[f64; 2]| {
        let within = |[low, high]: &[[f64; 2]; 2]| (0..2).all(|d| low[d] < x[d] && x[d] < high[d]);
        !around.iter().any(within)
    };
    let points = cells.filter(free).map(|x| x.map(|x| x * DX)).collect();
    let liquid = catalogue::water_at(SoundSpeed::Chosen(SOUND));
    let deep = f64::from(depth) * DX;
    Body::points_of("water", liquid, points, DX).hydrostatic([0.0, -G], [0.0, deep])
}

pub(crate) fn tank(width: i32, height: i32) -> Wall<2> {
    let high = [f64::from(width) * DX, f64::from(height) * DX];
    Wall::around("tank", [0.0; 2], high, DX, 4, [[true; 2], [true, false]])
}

pub(crate) fn liquid() -> Scene<f64, 2> {
    let viscosity = MonaghanGingold {
        alpha: 0.1,
        beta: 0.0,
    };
    Scene::new(schemes::weakly_compressible().with_viscosity(viscosity)).acceleration(|_| [0.0, -G])
}

fn bends() -> impl Into<Scheme<f64, 2>> {
    let viscosity = MonaghanGingold {
        alpha: 1.0,
        beta: 0.0,
    };
    schemes::total_lagrangian()
        .with(NeoHookean)
        .with_viscosity(viscosity)
}

/// A block of twice the density of water, let go a spacing above the floor of a tank.
fn sinks(elastic: bool) -> Scene<f64, 2> {
    let low = [12.0, 1.0];
    let size = [6.0, 6.0];
    let wet = water(30, 14, &[[low, [18.0, 7.0]]]);
    let scene = liquid().body(wet).wall(tank(30, 22));
    if elastic {
        let block = boxed("block", rubber(2000.0, 5e5), low, size);
        scene.group(bends(), [block])
    } else {
        let block = boxed("block", stuff(2000.0), low, size);
        let scheme = schemes::impact_by_continuity();
        scene.group(scheme, [block]).rigid("block")
    }
}

fn lowest(now: &Simulation<f64, 2>, body: &str) -> f64 {
    let heights = now.body(body).unwrap().map(|p| p.position()[1]);
    heights.fold(f64::INFINITY, f64::min) / DX
}

/// A block that sinks comes to rest a spacing before the floor, which bears what the water does not.
#[test]
fn blocks_that_sink_lie_on_the_floor() {
    for elastic in [false, true] {
        let mut simulation = sinks(elastic)
            .couple("block", "tank", Penalty::new().damping(0.5))
            .build()
            .unwrap();
        simulation.run_until(1.5).unwrap();
        let before = simulation.ledger().bodies[1].1.momentum[1];
        let (mut floor, mut wet, mut time) = (0.0, 0.0, simulation.time());
        simulation
            .run_with(2.5, |now| {
                let dt = now.time() - time;
                time = now.time();
                floor += dt * now.force_between("block", "tank").unwrap()[1];
                wet += dt * now.force_between("block", "water").unwrap()[1];
            })
            .unwrap();
        let weight = 2000.0 * 0.12 * 0.12 * G;
        let gained = simulation.ledger().bodies[1].1.momentum[1] - before;
        let [floor, wet] = [floor, wet].map(|sum| sum / weight);
        let gap = lowest(&simulation, "block") + 0.5;
        println!(
            "elastic {elastic}: gap {gap}, floor {floor}, water {wet}, gained {}",
            gained / weight
        );
        assert!((gap - 1.0).abs() < 0.5, "{gap}");
        assert!((floor + wet - 1.0).abs() < 0.01, "{floor} {wet}");
        assert!(floor > 0.2, "{floor}");
    }
}

/// Without contact it goes through.
#[test]
fn blocks_without_contact_sink_through_the_floor() {
    for elastic in [false, true] {
        let scene = sinks(elastic).between("block", "tank", Interaction::None);
        let mut simulation = scene.build().unwrap();
        simulation.run_until(0.8).unwrap();
        let low = lowest(&simulation, "block");
        println!("elastic {elastic}: {low} spacings");
        assert!(low < -3.0, "elastic {elastic}: {low}");
    }
}

/// What is solid in the scene of all.
const SOLIDS: [&str; 7] = ["log", "stone", "crate", "pad", "mat", "brick", "lid"];

/// A tank with a shelf above the water. In it float a rigid log and an elastic mat, sink a rigid stone and an elastic pad, falls
/// a rigid crate onto the log, and lie a rigid brick and an elastic lid, dry, on the shelf.
fn all() -> Scene<f64, 2> {
    let floats = [[[4.0, 9.0], [12.0, 15.0]], [[28.0, 10.0], [38.0, 14.0]]];
    let sinks = [[[14.0, 2.0], [20.0, 7.0]], [[21.0, 4.0], [27.0, 8.0]]];
    let wet = water(50, 13, &[floats[0], floats[1], sinks[0], sinks[1]]);
    let mut walls = tank(50, 40).points().to_vec();
    for i in 40..50 {
        for j in 18..22 {
            walls.push([(f64::from(i) + 0.5) * DX, (f64::from(j) + 0.5) * DX]);
        }
    }
    let rigid = [
        boxed("log", stuff(500.0), [4.0, 9.0], [8.0, 6.0]),
        boxed("stone", stuff(2500.0), [14.0, 2.0], [6.0, 5.0]),
        boxed("crate", stuff(300.0), [6.0, 17.0], [4.0, 4.0]),
        boxed("brick", stuff(2000.0), [41.0, 22.5], [4.0, 4.0]),
    ];
    let elastic = [
        boxed("pad", rubber(1500.0, 3e5), [21.0, 4.0], [6.0, 4.0]),
        boxed("mat", rubber(600.0, 3e5), [28.0, 10.0], [10.0, 4.0]),
        boxed("lid", rubber(1200.0, 3e5), [41.0, 27.0], [6.0, 4.0]),
    ];
    let mut scene = liquid()
        .body(wet)
        .wall(Wall::of("tank", walls, DX))
        .group(schemes::impact_by_continuity(), rigid)
        .group(bends(), elastic);
    for body in ["log", "stone", "crate", "brick"] {
        scene = scene.rigid(body);
    }
    for (k, first) in SOLIDS.into_iter().enumerate() {
        let rubs = || ContactDensity::new().friction(0.3);
        scene = scene.couple(first, "tank", rubs());
        for second in &SOLIDS[k + 1..] {
            scene = scene.couple(first, second, rubs());
        }
    }
    scene
}

/// All bits of the state, and of what the ledger has of it.
#[cfg(feature = "checkpoint")]
fn bits(now: &Simulation<f64, 2>) -> Vec<u64> {
    let mut all: Vec<u64> = now
        .all()
        .flat_map(|p| p.position().into_iter().chain(p.velocity()))
        .map(f64::to_bits)
        .collect();
    let wall = now.wall_impulse("tank").unwrap();
    all.extend(wall.map(f64::to_bits));
    for contact in now.contacts() {
        all.extend([contact.stored, contact.heat].map(f64::to_bits));
        all.extend(contact.work.map(f64::to_bits));
    }
    all
}

/// Kinetic energy, what water, rubber and contacts have stored, and what gravity has in store.
fn energy(now: &Simulation<f64, 2>) -> f64 {
    let ledger = now.ledger();
    let high = now.all().map(|p| p.mass() * G * p.position()[1]);
    let stored = ledger.whole.total("energy of couplings").unwrap();
    let water = now.body("water").unwrap().map(|p| {
        let strain = p.pressure() / (p.density() * SOUND * SOUND);
        0.5 * p.mass() * (SOUND * strain).powi(2)
    });
    ledger.whole.kinetic + ledger.whole.internal + stored + high.sum::<f64>() + water.sum::<f64>()
}

/// Runs the scene of all to `end` \[s\]: nothing is lost, momentum and energy are closed, and it resumes at the half.
fn all_hold(end: f64) {
    let mut simulation = all().build().unwrap();
    let particles = simulation.particles();
    let first = energy(&simulation);
    // The stone presses out the last layers of water, whose walls show an extrapolated pressure and no energy of their own.
    let mut most = first;
    for k in 1..=50 {
        simulation.run_until(f64::from(k) / 100.0 * end).unwrap();
        most = most.max(energy(&simulation));
    }
    println!("has {} of its energy at most", most / first);
    assert!(most < 1.01 * first, "{most} of {first}");
    #[cfg(feature = "checkpoint")]
    let mut resumed = {
        let path = std::env::temp_dir().join(format!("meshfree-all-{}-{end}", std::process::id()));
        simulation.save(&path).unwrap();
        let resumed = all().resume(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        resumed
    };
    simulation.run_until(end).unwrap();
    #[cfg(feature = "checkpoint")]
    {
        resumed.run_until(end).unwrap();
        assert!(bits(&simulation) == bits(&resumed), "it resumes otherwise");
    }

    let ledger = simulation.ledger();
    let weight = ledger.whole.mass * G * end;
    let [x, y] = simulation.wall_impulse("tank").unwrap();
    let lacks = [
        ledger.whole.momentum[0] + x,
        ledger.whole.momentum[1] + y + weight,
    ];
    println!(
        "momentum {:?}, lacks {lacks:?} of {weight}",
        ledger.whole.momentum
    );
    assert!(
        lacks.iter().all(|lacks| lacks.abs() < 1e-10 * weight),
        "{lacks:?}"
    );
    for contact in simulation.contacts() {
        if contact.largest_penetration > 0.0 {
            println!("{contact:.3?}");
        }
        assert!(contact.largest_penetration < 0.5, "{contact:?}");
    }
    // What contacts took is heat of friction and in their springs; the rest is what sticks and parts.
    let (mut taken, mut known) = (0.0, 0.0);
    for contact in simulation.contacts() {
        taken -= contact.work[0] + contact.work[1];
        known += contact.stored + contact.heat;
    }
    println!("contacts took {taken} J/m, of which {known} are known");
    assert!((known / taken - 1.0).abs() < 0.1, "{known} {taken}");
    // Nothing gives energy, and loads of every kind are losses.
    let spent = first - energy(&simulation);
    println!("{spent} J/m of {first} are gone");
    assert!(spent > known && spent < 0.5 * first, "{spent} of {first}");
    assert_eq!(simulation.particles(), particles);
    for body in ["water"].into_iter().chain(SOLIDS) {
        for p in simulation.body(body).unwrap() {
            let [x, y] = p.position();
            let inside = (0.0..50.0 * DX).contains(&x) && (0.0..40.0 * DX).contains(&y);
            assert!(inside, "a particle of {body} is at {x} {y}");
        }
    }
    for body in SOLIDS {
        println!("{body} at {} spacings", lowest(&simulation, body));
    }
    println!(
        "{} steps, {:?}",
        simulation.steps(),
        simulation.indicators()
    );
}

#[test]
fn all_kinds_of_solids_stay_in_a_tank() {
    all_hold(0.3);
}

#[test]
#[ignore = "takes minutes"]
fn all_kinds_of_solids_stay_in_a_tank_for_ten_seconds() {
    all_hold(10.0);
}
