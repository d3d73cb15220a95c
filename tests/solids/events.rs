//! In time and space: bodies that are held until something happens, loads that begin with it, effects in a window of time, and
//! particles that leave a box. What is conserved closes with what is booked, and a run that resumes has the same bits.

use approx::assert_relative_eq;
use meshfree::effect::During;
use meshfree::prelude::*;
use meshfree::simulation::Simulation;

const CONTACT: &str = "first contact of target";

/// A striker that meets a target after a flight of 0.1 mm, both under a steady acceleration.
fn rods() -> Scene<f64, 1> {
    Scene::new(schemes::impact())
        .body(Body::block("striker", catalogue::copper(), [0.0], [0.005], 2e-4).velocity([100.0]))
        .body(Body::block(
            "target",
            catalogue::copper(),
            [0.0051],
            [0.0101],
            2e-4,
        ))
        .acceleration(|_| [1e5])
        .at_rest_until_contact("target")
}

fn bits(simulation: &Simulation<f64, 1>) -> Vec<u64> {
    let of = |particle: meshfree::simulation::ParticleView<'_, f64, 1>| {
        let numbers = [particle.position()[0], particle.velocity()[0]];
        [
            numbers[0],
            numbers[1],
            particle.density(),
            particle.energy(),
        ]
        .map(f64::to_bits)
    };
    let clamps = simulation.clamps().into_iter();
    let given = clamps.map(|own| own.impulse[0].to_bits());
    simulation.all().flat_map(of).chain(given).collect()
}

#[test]
fn a_body_rests_until_it_is_struck_and_momentum_closes() -> Result<(), Error> {
    let mut run = rods().build()?;
    let places = |run: &Simulation<f64, 1>| -> Result<Vec<u64>, Error> {
        let all = run.body("target")?;
        Ok(all
            .flat_map(|p| [p.position()[0], p.velocity()[0]])
            .map(f64::to_bits)
            .collect())
    };
    let (first, before) = (places(&run)?, run.ledger().whole.momentum[0]);
    let mass = run.ledger().whole.mass;
    // Gravity alone would have moved it by a hundredth of a spacing a microsecond.
    run.run_until(0.7e-6)?;
    assert_eq!(run.event(CONTACT)?, None);
    assert_eq!(places(&run)?, first, "it moves before it is struck");
    let (mut met, mut longest) = (None, 0.0_f64);
    run.run_with(3e-6, |now| {
        longest = longest.max(now.last_vote().map_or(0.0, |vote| vote.step));
        met = met.or(now.event(CONTACT).ok().flatten());
    })?;
    // The striker flies 0.1 mm and a little less, as kernels meet before faces do.
    let met = met.expect("a contact");
    assert!((0.7e-6..1.05e-6).contains(&met), "{met}");
    let velocity = |k: usize| {
        run.body("target")
            .map(|mut all| all.nth(k).map_or(0.0, |p| p.velocity()[0]))
    };
    assert!(velocity(5)? > 20.0);
    // What gravity and the clamp gave is all that momentum has changed by; the clamp gives nothing after.
    let clamp = run.clamps()[0].impulse[0];
    let expected = before + mass * 1e5 * run.time() + clamp;
    let ledger = run.ledger().whole.momentum[0];
    assert!(
        (ledger / expected - 1.0).abs() < 1e-12,
        "{ledger} {expected}"
    );
    run.run_until(3.5e-6)?;
    assert_eq!(run.clamps()[0].impulse[0], clamp);
    // It held the target against gravity until the contact, and took the blow of a step, as a rigid wall does: shock and
    // artificial viscosity press 1.22 times as hard as sound.
    let held = -0.5 * mass * 1e5 * met;
    let blow = 1.3 * 8930.0 * 3940.0 * 100.0 * longest;
    println!("held {held}, clamp {clamp}, a step of the blow {blow}");
    assert!(
        clamp <= held && clamp >= held - blow,
        "{clamp} {held} {blow}"
    );
    Ok(())
}

#[cfg(feature = "checkpoint")]
#[test]
fn a_run_that_resumes_before_or_after_an_event_has_the_same_bits() -> Result<(), Error> {
    let path = std::env::temp_dir().join(format!(
        "meshfree-events-{}.safetensors",
        std::process::id()
    ));
    let heated = || {
        rods().load(Load::heating(|at| {
            at.since(CONTACT).map_or(0.0, |since| 1e12 * since)
        }))
    };
    let mut whole = heated().build()?;
    whole.run_until(2e-6)?;
    let steps = whole.steps();
    for stop in [3, steps / 2 - 1, steps / 2, 3 * steps / 4] {
        let mut run = heated().build()?;
        while run.steps() < stop {
            run.step()?;
        }
        run.save(&path)?;
        let mut resumed = heated().resume(&path)?;
        assert_eq!(resumed.event(CONTACT)?, run.event(CONTACT)?);
        resumed.run_until(2e-6)?;
        assert_eq!(
            bits(&resumed),
            bits(&whole),
            "stopped after {stop} of {steps}"
        );
        assert_eq!(resumed.event(CONTACT)?, whole.event(CONTACT)?);
    }
    let before = heated().event("another", |_| false).resume(&path);
    assert!(before.is_err_and(|error| error.to_string().contains("events")));
    let _ = std::fs::remove_file(&path);
    Ok(())
}

#[test]
fn a_load_begins_with_its_event() -> Result<(), Error> {
    let mut run = Scene::<f64, 1>::new(schemes::impact())
        .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
        .event("late", |now| now.time() > 0.999e-6)
        .step_ends_at([1e-6])
        .load(Load::acceleration(|at| {
            [if at.since("late").is_some() { 1e6 } else { 0.0 }]
        }))
        .build()?;
    run.run_until(1e-6)?;
    assert_eq!(run.ledger().whole.momentum[0], 0.0);
    let step = run.step()?;
    run.run_until(2e-6)?;
    // It begins half a step late.
    let gained = run.ledger().whole.momentum[0] / run.ledger().whole.mass;
    let expected = 1e6 * (1e-6 - 0.5 * step);
    assert!(
        (gained / expected - 1.0).abs() < 1e-9,
        "{gained} {expected}"
    );
    let late = run.event("late")?.unwrap_or(0.0);
    assert!((late / 1e-6 - 1.0).abs() < 1e-12);
    let unknown = run.event("early").err().map(|error| error.to_string());
    assert!(unknown.is_some_and(|text| text.contains("early") && text.contains("late")));
    Ok(())
}

#[test]
fn what_waits_for_no_event_is_refused() {
    let lost = rods().fix_until("striker", |_| true, "the end").problems();
    assert!(
        lost.iter()
            .any(|problem| problem.to_string().contains("the end")),
        "{lost:?}"
    );
    let twice = rods().event(CONTACT, |_| false).problems();
    assert!(
        twice
            .iter()
            .any(|problem| problem.to_string().contains("two events")),
        "{twice:?}"
    );
}

/// A column of liquid that rings, with acoustic damping in a window of time.
fn column(from: f64, until: f64) -> Scene<f64, 1> {
    let water = catalogue::weakly_compressible_water(10.0);
    let body = Body::block("water", water, [0.0], [0.1], 1e-3);
    let effect = AcousticDamping { strength: 0.3 };
    Scene::new(schemes::weakly_compressible().with(During {
        effect,
        from,
        until,
    }))
    .body(body.start(|x, own| meshfree::scene::Start {
        velocity: [(20.0 * std::f64::consts::PI * x[0]).cos()],
        ..own
    }))
}

#[test]
fn an_effect_acts_in_its_window_alone() -> Result<(), Error> {
    let run = |from, until, end| -> Result<(Vec<u64>, f64), Error> {
        let mut run = column(from, until).build()?;
        run.run_until(end)?;
        Ok((bits(&run), run.ledger().whole.kinetic))
    };
    let (begin, end) = (2e-4, 1e-3);
    let never = run(f64::MAX, f64::INFINITY, end)?;
    let always = run(0.0, f64::INFINITY, end)?;
    let late = run(begin, f64::INFINITY, end)?;
    // To the bit as without it before it begins, and other bits after.
    let [before, off] = [begin, f64::MAX].map(|from| run(from, f64::INFINITY, 0.9 * begin));
    assert_eq!(before?, off?);
    assert_ne!(late.0, never.0);
    // And the same as throughout where the window is all of the run.
    assert_eq!(run(f64::NEG_INFINITY, 2.0 * end, end)?, always);
    assert_ne!(always.0, never.0);
    let wrong = column(1.0, 0.5).problems();
    assert!(
        wrong
            .iter()
            .any(|problem| problem.to_string().contains("end of the window"))
    );
    let kept = During {
        effect: meshfree::effect::UniaxialStress,
        from: 0.0,
        until: 1.0,
    };
    let scheme = schemes::impact_by_continuity().with(kept);
    let refused = Scene::<f64, 1>::new(scheme)
        .body(Body::block(
            "rod",
            catalogue::ofhc_copper(),
            [0.0],
            [0.01],
            2e-4,
        ))
        .problems();
    assert!(
        refused
            .iter()
            .any(|problem| problem.to_string().contains("window of time")),
        "{refused:?}"
    );
    Ok(())
}

#[test]
fn what_leaves_a_box_is_counted() -> Result<(), Error> {
    let water = catalogue::weakly_compressible_water(10.0);
    let mut run = Scene::<f64, 1>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0], [0.1], 1e-3).velocity([5.0]))
        .outlet(Outlet::outside_box([-0.01], [0.12]))
        .build()?;
    let [mass, momentum] = [run.ledger().whole.mass, run.ledger().whole.momentum[0]];
    run.run_until(0.012)?;
    let (gone, left) = (run.removed(), run.ledger().whole);
    assert!(gone.particles > 20 && run.particles() + gone.particles as usize == 100);
    assert_relative_eq!(
        gone.mass + left.mass,
        mass,
        epsilon = 0.0,
        max_relative = 1e-12
    );
    assert_relative_eq!(
        gone.momentum[0] + left.momentum[0],
        momentum,
        epsilon = 0.0,
        max_relative = 1e-9
    );
    assert!(run.all().all(|particle| particle.position()[0] < 0.13));
    Ok(())
}
