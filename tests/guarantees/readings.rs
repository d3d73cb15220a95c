//! Readings: what is observed, how often and when changes no bit of a run; what acts on a shown state makes it that of the run.
//! The scenes of the restart test are read here, and every integrator.

use super::bits::said;
use crate::common::Random;
use meshfree::integrator::{
    Integrator, LamLeapfrog, Midpoint, PositionVerlet, Predictor, StrongStabilityPreserving3,
};
use meshfree::material::Material;
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::simulation::{Criterion, Thresholds};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Looks at a simulation in every way that a user may.
fn look<T: Real, const D: usize>(now: &Simulation<T, D>) {
    assert!(now.ledger().whole.mass > 0.0 && now.vtu().len() == now.particles());
    assert!(now.stability().time == now.time());
    let _ = (
        now.energy(),
        now.contacts(),
        now.work(),
        now.cost(),
        now.vote().unwrap(),
    );
}

/// Reads a run to `end` \[s\] at many times, in many ways, and holds its end against that of a run that was not read.
pub(super) fn read_on_the_way<T: Real, const D: usize>(
    name: &str,
    start: impl Fn() -> Simulation<T, D>,
    resume: impl Fn(&Path) -> Simulation<T, D>,
    end: f64,
    file: &Path,
) {
    let mut whole = start();
    whole.run_until(end).unwrap();
    let (last, pairs) = (said(&whole), whole.work().pairs);
    let mut random = Random(name.bytes().map(u64::from).sum());
    for readings in [10, 100, 1000, 0] {
        let mut times: Vec<f64> = match readings {
            0 => (0..37).map(|_| end * random.unit()).collect(),
            _ => (1..readings)
                .map(|k| end * f64::from(k) / f64::from(readings))
                .collect(),
        };
        times.sort_by(f64::total_cmp);
        times.push(end);
        let mut read = start();
        for (k, time) in times.into_iter().enumerate() {
            read.run_until(time).unwrap();
            assert_eq!(read.time(), time, "{name}");
            if k % 7 == 3 && time < end {
                look(&read);
                if readings == 10 {
                    read.expected_work(end).unwrap();
                    read.save(file).unwrap();
                    let resumed = resume(file);
                    assert!(
                        said(&resumed) == said(&read),
                        "{name}: resumes to what was shown"
                    );
                    read = resumed;
                }
                read.evaluate().unwrap();
            }
        }
        assert!(said(&read) == last, "{name}: {readings} readings");
        if readings != 10 {
            assert_eq!(read.work().pairs, pairs, "{name}: pairs of the run");
        }
    }
}

/// A rod that rings, with whatever integrator.
fn rod(integrator: Box<dyn Integrator>) -> Simulation<f64, 1> {
    // Not all of them kick, as compatible energy needs.
    Scene::new(schemes::impact().energy(EnergyForm::Symmetric))
        .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
        .boundary(MirrorPlane::wall([0.01], [1.0]))
        .boxed_integrator(integrator)
        .build()
        .unwrap()
}

#[test]
fn every_integrator_takes_the_same_steps_read_or_not() {
    let all: [fn() -> Box<dyn Integrator>; 7] = [
        || Box::new(KickDriftKick),
        || Box::new(DriftKickDrift),
        || Box::new(RungeKutta4),
        || Box::new(Midpoint),
        || Box::new(StrongStabilityPreserving3),
        || Box::new(PositionVerlet),
        || {
            Box::new(LamLeapfrog {
                predictor: Predictor::Lagged,
            })
        },
    ];
    for integrator in all {
        let end = 4e-6;
        let mut whole = rod(integrator());
        whole.run_until(end).unwrap();
        for readings in [1_u32, 10, 100, 1000] {
            let mut read = rod(integrator());
            for k in 1..=readings {
                let share = f64::from(k) / f64::from(readings);
                read.run_until(end * share).unwrap();
            }
            let name = read.integrator_name();
            assert!(said(&read) == said(&whole), "{name}: {readings} readings");
        }
    }
}

/// Two rods of gas that meet: an event on the way, watched.
fn gases(seen: &Arc<AtomicU64>) -> Simulation<f64, 1> {
    let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
    let body = |name, x| Body::block(name, gas.clone(), [x], [x + 1.0], 0.02).energy(1.0);
    let seen = seen.clone();
    let mut gases = Scene::new(schemes::gas())
        .body(body("left", 0.0).velocity([0.5]))
        .body(body("right", 1.0))
        .event("late", move |now: &Simulation<f64, 1>| {
            seen.fetch_add(1, Ordering::Relaxed);
            now.time() > 0.2
        })
        .build()
        .unwrap();
    gases.keep_stability(Thresholds::default());
    gases.keep_energy();
    gases
}

#[test]
fn events_histories_and_reports_do_not_know_of_readings() {
    let [mut counted, mut also] = [0, 0].map(|_| Arc::new(AtomicU64::new(0)));
    let (mut whole, mut read) = (gases(&counted), gases(&also));
    let end = 0.5;
    let mut steps = Vec::new();
    whole
        .run_with(end, |now| steps.push((now.steps(), now.time())))
        .unwrap();
    let mut shown = Vec::new();
    for k in 1..=90 {
        let at = end * f64::from(k) / 90.0;
        read.run_with(at, |now| shown.push((now.steps(), now.time())))
            .unwrap();
        assert_eq!(read.stability().time, at);
        assert!(
            read.stability().momentum.unwrap() < 1e-12,
            "{}",
            read.stability()
        );
    }
    assert_eq!(whole.event("late").unwrap(), read.event("late").unwrap());
    let [counted, also] = [&mut counted, &mut also].map(|own| own.load(Ordering::Relaxed));
    assert_eq!(counted, also, "an event is looked at after steps alone");
    // Observers see every step once, in the order of time, and readings between.
    assert!(shown.is_sorted_by(|a, b| a.1 < b.1));
    let of_run: Vec<_> = shown
        .iter()
        .filter(|own| steps.contains(own))
        .copied()
        .collect();
    assert_eq!(of_run, steps);
    let [mut one, mut other] = [whole.stability(), read.stability()];
    (one.price, other.price) = (0.0, 0.0);
    assert_eq!(one, other);
    assert_eq!(whole.cost().steps, read.cost().steps);
    assert_eq!(whole.energy(), read.energy());
    assert!(read.phases().total() > std::time::Duration::ZERO);
}

#[test]
fn a_step_after_a_reading_is_the_next_of_the_run() {
    let [mut whole, mut read] = [0, 0].map(|_| rod(Box::new(KickDriftKick)));
    for _ in 0..9 {
        whole.step().unwrap();
    }
    let before = whole.time();
    read.run_until(before).unwrap();
    assert!(said(&read) == said(&whole));
    let size = whole.step().unwrap();
    read.run_until(before + 0.4 * size).unwrap();
    assert_eq!((read.steps(), read.time()), (9, before + 0.4 * size));
    assert_eq!(read.step().unwrap(), size);
    assert!(said(&read) == said(&whole));
}

/// A step of the run that ends within rounding of a reading keeps its own time.
#[test]
fn fixed_steps_keep_their_own_time() {
    let scene = || {
        Scene::<f64, 1>::new(schemes::impact())
            .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
            .boundary(MirrorPlane::wall([0.01], [1.0]))
            .steps(|steps| StepControl {
                fixed: Some(1e-8),
                ..steps
            })
    };
    let mut stepped = scene().build().unwrap();
    let mut read = scene().build().unwrap();
    let mut rounded = 0;
    for k in 1..=300_u32 {
        stepped.step().unwrap();
        let at = 1e-8 * f64::from(k);
        read.run_until(at).unwrap();
        assert_eq!((read.time(), read.steps()), (at, u64::from(k)));
        rounded += u32::from(stepped.time() != at);
    }
    assert!(rounded > 100, "{rounded}");
    read.step().unwrap();
    stepped.step().unwrap();
    assert!(said(&read) == said(&stepped));
}

#[test]
fn to_act_on_what_is_shown_makes_it_that_of_the_run() {
    let at = 1.37e-6;
    let acts: [fn(&mut Simulation<f64, 1>); 4] = [
        |own| own.set_velocities(|_, [v]| [v + 1.0]),
        |own| {
            own.set_field("rod", Field::ENERGY, |_, [e]| [e + 1.0])
                .unwrap();
        },
        |own| assert_eq!(own.step_at_most(1e-9).unwrap(), 1e-9),
        |own| {
            own.accept();
            own.step().unwrap();
        },
    ];
    for act in acts {
        let mut read = rod(Box::new(KickDriftKick));
        // The same by a cut, and not by a reading.
        let mut cut = rod(Box::new(KickDriftKick));
        read.run_until(at).unwrap();
        while cut.time() + cut.vote().unwrap().step < at {
            cut.step().unwrap();
        }
        cut.step_at_most(at - cut.time()).unwrap();
        let shown = read.steps();
        assert_eq!(cut.steps(), shown + 1);
        act(&mut read);
        act(&mut cut);
        read.step().unwrap();
        cut.step().unwrap();
        assert_eq!(cut.steps(), read.steps());
        for (one, other) in read.all().zip(cut.all()) {
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (a.abs() + b.abs() + 1e-3);
            assert!(close(one.position()[0], other.position()[0]));
            assert!(close(one.velocity()[0], other.velocity()[0]));
        }
        assert!((read.time() - cut.time()).abs() < 1e-20);
    }
}

/// A reading that cannot be shown leaves the state after the last step, and a run that has failed.
#[test]
fn a_reading_that_fails_is_the_end_of_the_run() {
    let mut rod = Scene::<f64, 1>::new(schemes::impact())
        .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
        .load(Load::heating(
            |at| if at.time > 1e-6 { f64::NAN } else { 0.0 },
        ))
        .build()
        .unwrap();
    rod.run_until(0.99e-6).unwrap();
    let steps = rod.steps();
    assert!(matches!(rod.run_until(1.001e-6), Err(Error::Load { .. })));
    assert!(rod.time() <= 1e-6 && rod.steps() - steps <= 1);
    assert!(matches!(rod.run_until(2e-6), Err(Error::Failed { .. })));
    assert!(rod.all().all(|particle| particle.energy().is_finite()));
}

#[test]
fn steps_grow_by_a_factor_and_shrink_freely() {
    let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
    let hot = |x: [f64; 1], start| Start {
        energy: if x[0] < 0.1 { 1e4 } else { 1.0 },
        ..start
    };
    let scene = |growth: f64| {
        Scene::<f64, 1>::new(schemes::gas())
            .body(Body::block("gas", gas.clone(), [0.0], [1.0], 0.01).start(hot))
            .boundary(MirrorPlane::wall([0.0], [-1.0]))
            .steps(|steps| StepControl { growth, ..steps })
    };
    let steps = |growth: f64| {
        let mut gas = scene(growth).build().unwrap();
        let mut all = Vec::new();
        for _ in 0..200 {
            let step = gas.step().unwrap();
            all.push((step, gas.last_vote().unwrap().criterion));
        }
        all
    };
    let most = |all: &[(f64, Criterion)]| {
        all.windows(2)
            .map(|two| two[1].0 / two[0].0)
            .fold(0.0, f64::max)
    };
    let (free, default) = (steps(f64::INFINITY), steps(StepControl::default().growth));
    println!(
        "a step grows by {} without a limit, by {} with it",
        most(&free),
        most(&default)
    );
    let tight = steps(1.001);
    assert!(most(&tight) < 1.001 + 1e-12);
    assert!(tight.iter().any(|own| own.1 == Criterion::Growth));
    assert!(most(&default) < StepControl::default().growth + 1e-12);
    assert!(scene(1.0).build().is_err() && scene(f64::NAN).build().is_err());
}

#[test]
fn steps_end_where_the_scene_asks_for_it() {
    // A load that ends in a kink: steps that end there integrate it exactly, by trapezia.
    let push = |t: f64| [2e9 * (1.0 - t / 1e-7).max(0.0)];
    let scene = || {
        Scene::<f64, 1>::new(schemes::impact())
            .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
            .acceleration(push)
    };
    let speed = |scene: Scene<f64, 1>, readings: u32| {
        let mut rod = scene.build().unwrap();
        for k in 1..=readings {
            rod.run_until(4e-7 * f64::from(k) / f64::from(readings))
                .unwrap();
        }
        let ledger = rod.ledger();
        let own = &ledger.bodies[0].1;
        (own.momentum[0] / own.mass, said(&rod))
    };
    let (with, bits) = speed(scene().step_ends_at([3e-7, 1e-7]), 1);
    let (without, _) = speed(scene(), 1);
    println!("100 m/s: {with} with, {without} without an end of a step at the kink");
    assert!((with - 100.0).abs() < 1e-6 && (without - 100.0).abs() > 1e-3);
    assert!(bits == speed(scene().step_ends_at([1e-7, 3e-7]), 23).1);
    assert!(scene().step_ends_at([f64::NAN]).build().is_err());
    // A step that is cut short holds nothing back: the next is as long as without.
    let mut cut = scene().step_ends_at([1e-7, 1e-7 + 1e-12]).build().unwrap();
    let steps: Vec<f64> = (0..30).map(|_| cut.step().unwrap()).collect();
    let short = steps.iter().position(|step| *step < 2e-12).unwrap();
    assert!(steps[short + 1] > 1e-9, "{}", steps[short + 1]);
}
