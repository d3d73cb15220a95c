//! Particles that sleep outside of a box: their state is held to the bit, what is withheld of momentum and energy is
//! booked, they wake when the box reaches them, and a run that resumes has the same bits.

use meshfree::particles::Field;
use meshfree::prelude::*;
use meshfree::simulation::ParticleView;
#[cfg(feature = "checkpoint")]
use meshfree::simulation::Simulation;

const INFINITY: f64 = f64::INFINITY;
const SPEED: f64 = 20.0;

/// A striker and a rod, both under an acceleration, awake up to a place that is 4 mm into the rod and grows by a speed.
fn rods(growth: f64, acceleration: f64) -> Scene<f64, 1> {
    let copper = |name, low, high| Body::block(name, catalogue::copper(), [low], [high], 2e-4);
    Scene::new(schemes::impact())
        .body(copper("striker", -0.002, 0.0).velocity([SPEED]))
        .body(copper("rod", 0.0, 0.03))
        .acceleration(move |_| [acceleration])
        .awake_inside(move |now| [[-INFINITY], [0.004 + growth * now.time()]])
}

fn numbers(p: &ParticleView<'_, f64, 1>) -> [u64; 3] {
    [p.position()[0], p.velocity()[0], p.energy()].map(f64::to_bits)
}

#[cfg(feature = "checkpoint")]
fn bits(simulation: &Simulation<f64, 1>) -> Vec<u64> {
    let asleep = simulation.asleep().into_iter();
    let given = asleep.flat_map(|own| [own.impulse[0].to_bits(), own.energy.to_bits(), own.woken]);
    simulation
        .all()
        .flat_map(|p| numbers(&p))
        .chain(given)
        .collect()
}

#[test]
fn sleepers_are_held_and_what_is_withheld_is_booked() -> Result<(), Error> {
    for (growth, acceleration) in [(0.0, 0.0), (0.0, 1e6), (2000.0, 1e6), (2000.0, 0.0)] {
        let mut run = rods(growth, acceleration).build()?;
        let before = run.ledger().whole;
        let first: Vec<_> = run.body("rod")?.map(|p| numbers(&p)).collect();
        // The pulse, at 4 mm/µs, has come to the edge and back.
        run.run_until(2.5e-6)?;
        let (after, asleep) = (run.ledger().whole, run.asleep().expect("a box"));
        let edge = 0.004 + growth * run.time();
        let held = run
            .body("rod")?
            .zip(&first)
            .filter(|(p, _)| p.position()[0] > edge);
        let held: Vec<_> = held.map(|(p, first)| numbers(&p) == *first).collect();
        assert_eq!(asleep.particles, held.len());
        assert!(held.len() > 70 && held.iter().all(|same| *same));
        assert_eq!(asleep.fallen as usize - asleep.woken as usize, held.len());
        assert_eq!(growth > 0.0, asleep.woken > 10);
        let scale = before.momentum[0];
        let given = before.mass * acceleration * run.time() + asleep.impulse[0];
        let open = (after.momentum[0] - before.momentum[0] - given) / scale;
        assert!(open.abs() < 1e-12, "{open}");
        // The pulse has pushed at the edge, which is at rest: it takes no work, but heats what sleeps.
        assert!(asleep.impulse[0] < -0.1 * scale, "{asleep:?}");
        if acceleration == 0.0 {
            let open = after.total_energy() - before.total_energy() - asleep.energy;
            let open = open / before.total_energy();
            assert!(
                open.abs() < 1e-12 && asleep.energy < 0.0,
                "{open} {asleep:?}"
            );
        }
    }
    Ok(())
}

#[test]
fn a_box_that_holds_all_changes_no_bit() -> Result<(), Error> {
    let run = |wide: bool| -> Result<Vec<u64>, Error> {
        let mut scene = Scene::<f64, 1>::new(schemes::impact())
            .body(Body::block("a", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([SPEED]))
            .body(Body::block("b", catalogue::copper(), [0.01], [0.02], 2e-4));
        if wide {
            scene = scene.awake_inside(|_| [[-1.0], [1.0]]);
        }
        let mut run = scene.build()?;
        run.run_until(1e-6)?;
        let asleep = run.asleep();
        assert_eq!(wide, asleep.is_some());
        assert_eq!(asleep.map_or(0, |own| own.fallen), 0);
        Ok(run.all().flat_map(|p| numbers(&p)).collect())
    };
    assert_eq!(run(true)?, run(false)?);
    Ok(())
}

/// An edge ahead of the pulse reflects nothing: what is awake is as if all were.
#[test]
fn an_edge_ahead_of_the_pulse_is_not_felt() -> Result<(), Error> {
    let run = |growth| -> Result<Vec<f64>, Error> {
        let mut run = rods(growth, 0.0).build()?;
        run.run_until(3e-6)?;
        let all = run.body("rod")?;
        Ok(all.map(|p| p.velocity()[0]).collect())
    };
    let (ahead, none) = (run(5500.0)?, run(1e9)?);
    let worst = ahead.iter().zip(&none).map(|(a, b)| (a - b).abs());
    let worst = worst.fold(0.0, f64::max);
    println!("worst {worst} m/s of {SPEED}");
    assert!(worst < 1e-6 * SPEED, "{worst}");
    Ok(())
}

/// Water that flies out of the box falls asleep there; the ledger of energy books what it had.
#[test]
fn what_flies_out_falls_asleep() -> Result<(), Error> {
    let water = catalogue::weakly_compressible_water(10.0);
    let mut run = Scene::<f64, 1>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0], [0.1], 1e-3).velocity([5.0]))
        .acceleration(|_| [3.0])
        .awake_inside(|now| [[-1.0], [if now.time() < 0.02 { 0.12 } else { 1.0 }]])
        .build()?;
    run.keep_energy();
    let before = run.ledger().whole;
    run.run_until(0.012)?;
    let mid = run.asleep().expect("a box");
    assert!(mid.particles > 3 && mid.woken == 0, "{mid:?}");
    let slept = run.all().filter(|p| p.position()[0] > 0.12);
    let slept: Vec<_> = slept
        .map(|p| (p.id(), p.position()[0], p.density()))
        .collect();
    assert_eq!(slept.len(), mid.particles);
    run.run_until(0.0195)?;
    for (id, x, density) in slept {
        let now = run.all().find(|p| p.id() == id).expect("a particle");
        assert_eq!((now.position()[0], now.density()), (x, density));
        assert_eq!(now.velocity()[0], 0.0);
        assert_eq!(now.vector(Field::VELOCITY), Some([0.0]));
    }
    // It wakes where it is when the box grows, and nothing of momentum and energy is lost on the way.
    run.run_until(0.025)?;
    let (after, asleep) = (run.ledger().whole, run.asleep().expect("a box"));
    assert!(
        asleep.particles == 0 && asleep.woken == asleep.fallen,
        "{asleep:?}"
    );
    let given = before.mass * 3.0 * run.time() + asleep.impulse[0];
    let open = (after.momentum[0] - before.momentum[0] - given) / before.momentum[0];
    assert!(open.abs() < 1e-12, "{open}");
    let energy = run.energy().expect("a ledger");
    assert!((energy.asleep + asleep.energy).abs() < 1e-9 * before.kinetic);
    Ok(())
}

#[cfg(feature = "checkpoint")]
#[test]
fn a_run_that_resumes_with_sleepers_has_the_same_bits() -> Result<(), Error> {
    let path = std::env::temp_dir().join(format!(
        "meshfree-asleep-{}.safetensors",
        std::process::id()
    ));
    let scene = || rods(2000.0, 1e6);
    let mut whole = scene().build()?;
    whole.run_until(2e-6)?;
    let steps = whole.steps();
    for stop in [1, steps / 3, steps / 2, 3 * steps / 4] {
        let mut run = scene().build()?;
        while run.steps() < stop {
            run.step()?;
        }
        run.save(&path)?;
        let mut resumed = scene().resume(&path)?;
        assert_eq!(resumed.asleep(), run.asleep());
        resumed.run_until(2e-6)?;
        assert_eq!(
            bits(&resumed),
            bits(&whole),
            "stopped after {stop} of {steps}"
        );
    }
    let _ = std::fs::remove_file(&path);
    Ok(())
}

#[test]
fn what_does_not_go_with_sleepers_is_refused() {
    let refused = |scene: Scene<f64, 1>, word: &str| {
        let problems = scene.problems();
        let found = problems.iter().any(|one| one.to_string().contains(word));
        assert!(found, "{problems:?}");
    };
    refused(rods(0.0, 0.0).rigid("striker"), "sleep");
    refused(rods(0.0, 0.0).integrator(RungeKutta4), "sleep");
}
