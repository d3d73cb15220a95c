//! Sources and drains: what passes, what is booked, and what is refused.
//! The mass that passes is within half a particle of the integral of the rate.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use meshfree::boundary::{Drain, Source};
use meshfree::prelude::*;

const DX: f64 = 0.02;
/// Mass of a particle \[kg/m\].
const EACH: f64 = 1000.0 * DX * DX;

fn water() -> Material<f64> {
    catalogue::weakly_compressible_water(2.0)
}

/// A basin with a pump in its floor, under a hose.
fn basin(at: f64) -> Scene<f64, 2> {
    let hose = (0..3)
        .map(|k| [at + 0.13 + DX * f64::from(k), 0.31])
        .collect();
    let tank = Wall::around(
        "tank",
        [at, 0.0],
        [at + 0.4, 0.3],
        DX,
        3,
        [[true, true], [true, false]],
    );
    let pump = Cuboid::new([at + 0.2, 0.0], [at + 0.3, 0.08]);
    Scene::new(schemes::weakly_compressible())
        .body(Body::block(
            "water",
            water(),
            [at, 0.0],
            [at + 0.4, 0.12],
            DX,
        ))
        .wall(tank)
        .source(
            Source::new("water", hose, 40.0, 100)
                .velocity([0.0, -1.0])
                .between(0.02, 0.1),
        )
        .drain(Drain::within(pump, 30.0).on("water"))
        .acceleration(|_| [0.0, -9.81])
}

#[test]
fn mass_closes_and_follows_the_rates() {
    let mut run = basin(0.0).build().expect("a basin");
    let before = run.ledger().whole.mass;
    let mut last = 0;
    for time in [0.03, 0.06, 0.12] {
        run.run_until(time).expect("a run");
        // What is due at the end of a step passes in the next.
        let late = 40.0 * run.last_vote().map_or(0.0, |vote| vote.step);
        let (entered, removed) = (run.entered(), run.removed());
        let poured = 40.0 * (time.min(0.1) - 0.02);
        assert_abs_diff_eq!(entered.mass, poured, epsilon = 0.51 * EACH + late);
        assert_abs_diff_eq!(removed.mass, 30.0 * time, epsilon = 0.56 * EACH + late);
        let after = run.ledger().whole.mass;
        assert_relative_eq!(
            after,
            before + entered.mass - removed.mass,
            max_relative = 1e-12
        );
        assert_relative_eq!(entered.momentum[1], -entered.mass, max_relative = 1e-12);
        assert_relative_eq!(entered.kinetic, 0.5 * entered.mass, max_relative = 1e-12);
        assert!(entered.particles > last && removed.particles > 0);
        last = entered.particles;
    }
    assert_eq!(run.entered().particles, 8, "3.2 kg/m");
}

/// A jet in free flight takes nothing, and a ledger that is kept from later on shows what came since.
#[test]
fn the_energy_that_enters_is_booked() {
    let jet = (0..3).map(|k| [1.0, DX * f64::from(k)]).collect();
    let mut run = Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water(), [0.0; 2], [0.1; 2], DX))
        .source(Source::new("water", jet, 40.0, 100).velocity([2.0, 0.0]))
        .build()
        .expect("a jet");
    run.keep_energy();
    run.run_until(0.05).expect("a run");
    let mut later = run.clone();
    later.keep_energy();
    let first = run.energy().expect("a ledger");
    assert!(first.entered > 1.0 && first.entered == run.entered().kinetic);
    assert_abs_diff_eq!(first.dissipated, 0.0, epsilon = 0.02 * first.entered);
    for run in [&mut run, &mut later] {
        run.run_until(0.1).expect("a run");
    }
    let (whole, later) = (run.energy().expect("one"), later.energy().expect("one"));
    let since = whole.dissipated - first.dissipated;
    assert_abs_diff_eq!(later.dissipated, since, epsilon = 1e-12 * whole.entered);
}

/// The same particles enter and leave at the same times wherever the scene is.
#[test]
fn place_changes_nothing() {
    let [here, there] = [0.0, 4096.0].map(|at| {
        let mut run = basin(at).build().expect("a basin");
        run.run_until(0.06).expect("a run");
        let x: Vec<[f64; 2]> = run.all().map(|own| own.position()).collect();
        (run.entered(), run.removed(), x)
    });
    assert_eq!(
        (here.0.particles, here.1.particles),
        (there.0.particles, there.1.particles)
    );
    for (a, b) in here.2.iter().zip(&there.2) {
        assert_abs_diff_eq!(a[0], b[0] - 4096.0, epsilon = 1e-9);
    }
}

/// A covered source does not press particles into others: it waits, and says so.
#[test]
fn a_covered_source_ends_the_run() {
    let scene = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water(), [0.0; 2], [0.2; 2], DX))
        .source(Source::new("water", vec![[0.1, 0.1]], 40.0, 10));
    let mut run = scene.build().expect("water");
    let error = run
        .run_until(1.0)
        .map(drop)
        .expect_err("it waits")
        .to_string();
    assert!(
        error.contains("source of body `water`") && error.contains("kg"),
        "{error}"
    );
    assert_eq!(run.entered().particles, 0);
}

/// What a drain finds no liquid for is not made up for later.
#[test]
fn a_dry_drain_takes_nothing() {
    let box_of = |low: f64| Cuboid::new([low, -1.0], [low + 0.1, 1.0]);
    let mut run = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water(), [0.0; 2], [0.2; 2], DX).velocity([1.0, 0.0]))
        .drain(Drain::within(box_of(0.3), 20.0))
        .build()
        .expect("water");
    run.run_until(0.09).expect("a run");
    assert_eq!(run.removed().particles, 0);
    run.run_until(0.15).expect("a run");
    let taken = run.removed().mass;
    assert!(taken > 0.0 && taken < 20.0 * 0.05 + 2.0 * EACH, "{taken}");
}

#[cfg(feature = "checkpoint")]
#[test]
fn it_resumes_to_the_same_bits() {
    let file = std::env::temp_dir().join(format!("meshfree-{}-basin", std::process::id()));
    let mut whole = basin(0.0).build().expect("a basin");
    whole.run_until(0.05).expect("a run");
    whole.save(&file).expect("a file");
    whole.run_until(0.08).expect("a run");
    let mut resumed = basin(0.0).resume(&file).expect("a file");
    resumed.run_until(0.08).expect("a run");
    let _ = std::fs::remove_file(&file);
    assert_eq!(whole.entered(), resumed.entered());
    assert_eq!(whole.removed(), resumed.removed());
    let places = |run: &Simulation<f64, 2>| -> Vec<[f64; 2]> {
        run.all().map(|own| own.position()).collect()
    };
    assert_eq!(places(&whole), places(&resumed));
}

#[test]
fn wrong_ones_are_refused() {
    let scene = || {
        Scene::<f64, 2>::new(schemes::weakly_compressible()).body(Body::block(
            "water",
            water(),
            [0.0; 2],
            [0.2; 2],
            DX,
        ))
    };
    let source = |body: &str, rate: f64| Source::new(body, vec![[1.0; 2]], rate, 10);
    let region = || Cuboid::new([0.0; 2], [0.1; 2]);
    for (scene, what) in [
        (scene().source(source("oil", 1.0)), "oil"),
        (scene().source(source("water", -1.0)), "rate"),
        (
            scene().source(source("water", 1.0).between(1.0, 0.5)),
            "end",
        ),
        (
            scene().source(source("water", 1.0).velocity([f64::NAN, 0.0])),
            "velocity",
        ),
        (
            scene().source(Source::new("water", Vec::new(), 1.0, 10)),
            "points",
        ),
        (scene().drain(Drain::within(region(), f64::NAN)), "rate"),
        (scene().drain(Drain::within(region(), 1.0).on("oil")), "oil"),
    ] {
        let error = scene.build().map(drop).expect_err(what).to_string();
        assert!(error.contains(what), "{error}");
    }
    // A reserve that is too small.
    let mut run = scene()
        .source(Source::new("water", vec![[1.0; 2]], 100.0, 1).velocity([5.0, 0.0]))
        .build()
        .expect("water");
    let error = run
        .run_until(1.0)
        .map(drop)
        .expect_err("no reserve")
        .to_string();
    assert!(error.contains("reserve"), "{error}");
}
