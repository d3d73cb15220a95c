//! Motion that ends and begins: bodies that are driven until an event and then free, and bodies that are caught.
//! Momentum closes with what clamps gave, and after the event a run is the one that starts there.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use meshfree::boundary::{Composed, Recorded, Wall};
use meshfree::coupling::ContactDensity;
use meshfree::material::Material;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
#[cfg(feature = "checkpoint")]
use meshfree::simulation::Change;
use meshfree::simulation::Simulation;

const DX: f64 = 0.05;

/// A rigid box over a tank of water.
fn entry() -> Scene<f64, 2> {
    let wood = Material::new("wood", Linear::new(600.0, 15.0));
    let water = catalogue::weakly_compressible_water(15.0);
    let sides = [[true; 2], [true, false]];
    Scene::new(schemes::weakly_compressible())
        .body(
            Body::block("water", water, [0.0; 2], [1.0, 0.4], DX)
                .hydrostatic([0.0, -9.81], [0.0, 0.4]),
        )
        .group(
            schemes::impact_by_continuity(),
            [Body::block("box", wood, [0.4, 0.5], [0.7, 0.7], DX)],
        )
        .wall(Wall::around("tank", [0.0; 2], [1.0, 1.0], DX, 5, sides))
        .rigid("box")
        .couple("box", "tank", ContactDensity::new())
        .acceleration(|_| [0.0, -9.81])
}

/// The same, lowered at 1 m/s until a corner is 0.1 m deep.
fn lowered() -> Scene<f64, 2> {
    let deep = |now: &Simulation<f64, 2>| {
        let mut all = now.body("box").into_iter().flatten();
        all.next().is_some_and(|p| p.position()[1] < 0.3)
    };
    entry()
        .clamp_until("box", |_| true, Translation::steady([0.0, -1.0]), "let go")
        .event("let go", deep)
}

fn bits(simulation: &Simulation<f64, 2>) -> Vec<u64> {
    let all = simulation.all().flat_map(|p| [p.position(), p.velocity()]);
    all.flatten().map(f64::to_bits).collect()
}

#[test]
fn a_box_enters_water_at_constant_speed_and_momentum_closes_after_it_is_let_go() -> Result<(), Error>
{
    let mut run = lowered().build()?;
    let start = run.ledger().whole.momentum.clone();
    let (mut driven, mut at_release) = (Vec::new(), None);
    run.run_with(0.5, |now| {
        let first = now.body("box").ok().and_then(|mut all| all.next());
        let v = first.map_or([0.0; 2], |p| p.velocity());
        match now.event("let go").ok().flatten() {
            None => driven.push(v[1]),
            Some(when) => {
                at_release.get_or_insert((when, now.clamps()[0].clone()));
            }
        }
    })?;
    let (when, given) = at_release.expect("a release");
    println!("let go at {when} s; clamp {given:?}");
    assert_abs_diff_eq!(when, 0.225, epsilon = 0.005);
    for v in driven {
        assert_abs_diff_eq!(v, -1.0, epsilon = 1e-12);
    }
    // Water gives more than its weight at this depth and speed, so it slows down.
    let v = run.body("box")?.next().map_or(0.0, |p| p.velocity()[1]);
    assert!(v > -1.0 && v.abs() > 1e-3, "{v}");
    let (ledger, clamp) = (run.ledger(), run.clamps()[0].clone());
    assert_eq!(clamp.impulse, given.impulse);
    let wall = run.wall_impulse("tank")?;
    let load = -9.81 * ledger.whole.mass * run.time();
    for d in 0..2 {
        let gained = ledger.whole.momentum[d] - start[d];
        let sum = clamp.impulse[d] - wall[d] + if d == 1 { load } else { 0.0 };
        assert_abs_diff_eq!(gained, sum, epsilon = 1e-9 * load.abs());
    }
    Ok(())
}

#[cfg(feature = "checkpoint")]
#[test]
fn after_release_a_run_is_the_one_that_starts_there_to_the_bit() -> Result<(), Error> {
    let folder = std::env::temp_dir();
    let [early, at, late] = ["early", "at", "late"]
        .map(|name| folder.join(format!("meshfree-driven-{}-{name}", std::process::id())));
    let mut run = lowered().build()?;
    let mut saved = Vec::new();
    run.run_with(0.3, |now| {
        let happened = now.event("let go").ok().flatten().is_some();
        match saved.len() {
            0 if now.time() > 0.1 => saved.push(now.save(&early)),
            1 if happened => saved.push(now.save(&at)),
            2 if now.time() > 0.26 => saved.push(now.save(&late)),
            _ => {}
        }
    })?;
    assert_eq!(saved.len(), 3);
    saved.into_iter().collect::<Result<Vec<()>, Error>>()?;
    // Free from the state at the release.
    let mut free = entry().resume_with(&at, &[Change::Motions, Change::Events])?;
    free.run_until(0.3)?;
    assert!(bits(&run) == bits(&free), "free");
    for file in [&early, &at, &late] {
        let mut again = lowered().resume(file)?;
        again.run_until(0.3)?;
        assert!(bits(&run) == bits(&again), "{file:?}");
        assert_eq!(run.clamps(), again.clamps());
        let _ = std::fs::remove_file(file);
    }
    Ok(())
}

/// A plate in free flight that turns, with an event.
fn flying() -> Scene<f64, 2> {
    let wood = Material::new("wood", Linear::new(600.0, 15.0));
    Scene::new(schemes::impact_by_continuity())
        .body(Body::block("plate", wood, [-0.2, -0.1], [0.2, 0.1], DX).velocity([1.0, 0.5]))
        .rigid("plate")
        .event("late", |now: &Simulation<f64, 2>| now.time() >= 0.1)
        .step_ends_at([0.1])
}

#[test]
fn what_is_let_go_flies_on_as_what_starts_so() -> Result<(), Error> {
    // Turned and moved by rows whose motion is steady, so that it keeps its velocities.
    let times = || (0..9).map(|k| 0.05 * f64::from(k));
    let turn: Vec<_> = times().map(|t| (t, 2.0 * t)).collect();
    let way: Vec<_> = times().map(|t| (t, [t, 0.5 * t])).collect();
    let motion =
        Composed::of(Recorded::rotation([0.0; 2], &turn)?).then(Recorded::translation(&way)?);
    let mut driven = flying()
        .clamp_until("plate", |_| true, motion, "late")
        .build()?;
    driven.run_until(0.3)?;
    let (sin, cos) = 0.6_f64.sin_cos();
    let [x, y] = [-0.175, -0.075];
    let exact = [0.3 + cos * x - sin * y, 0.15 + sin * x + cos * y];
    let corner = driven
        .body("plate")?
        .next()
        .map_or([0.0; 2], |p| p.position());
    assert_relative_eq!(corner.as_slice(), exact.as_slice(), max_relative = 1e-4);
    assert_abs_diff_eq!(driven.clamps()[0].work, 0.0, epsilon = 1e-9);
    Ok(())
}

#[test]
fn what_is_caught_stops_and_gives_what_it_had() -> Result<(), Error> {
    let mut run = flying().fix_from("plate", |_| true, "late").build()?;
    run.run_until(0.05)?;
    assert_eq!(run.clamps()[0].impulse, [0.0; 2]);
    let before = run.ledger().whole.clone();
    run.run_until(0.1)?;
    run.step()?;
    let corner = |run: &Simulation<f64, 2>| {
        let mut all = run.body("plate").into_iter().flatten();
        all.next().map_or([0.0; 2], |p| p.position())
    };
    let there = corner(&run);
    assert_relative_eq!(there[0], -0.175 + 0.1, max_relative = 1e-12);
    run.run_until(0.2)?;
    assert_eq!(corner(&run), there);
    let clamp = run.clamps()[0].clone();
    for d in 0..2 {
        assert_eq!(run.ledger().whole.momentum[d], 0.0);
        assert_relative_eq!(clamp.impulse[d], -before.momentum[d], max_relative = 1e-12);
    }
    assert_relative_eq!(clamp.work, -before.kinetic, max_relative = 1e-12);
    Ok(())
}

/// A body that is driven until an event which also catches it: reading it every millisecond changes no bit.
#[test]
fn driven_and_then_caught_however_often_it_is_read() -> Result<(), Error> {
    let scene = || lowered().fix_from("box", |_| true, "let go");
    let mut run = scene().build()?;
    run.run_until(0.4)?;
    let mut read = scene().build()?;
    for k in 1..=400 {
        read.run_until(1e-3 * f64::from(k))?;
        assert!(read.ledger().whole.mass > 0.0 && read.clamps().len() == 2);
    }
    assert!(bits(&run) == bits(&read));
    assert_eq!(run.clamps(), read.clamps());
    for p in run.body("box")? {
        assert_abs_diff_eq!(p.velocity()[1], 0.0, epsilon = 1e-12);
    }
    Ok(())
}
