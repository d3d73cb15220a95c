//! Runs in parts that are read between two steps, where each rank keeps its own particles of the state after the last one: whatever is
//! done then is what a plain run does, to the bit.

use super::bits::said;
use super::scenes::{
    bent_plate, corner, crushed_tank, dam_break, gas_in_periods, rod_by_runge_kutta,
};
use super::watched_for;
use meshfree::prelude::*;
use meshfree::ranks;
use meshfree::simulation::Thresholds;

type Act<T, const D: usize> = fn(&mut Simulation<T, D>) -> String;

/// What may be done between two steps, and what it says.
fn acts<T: Real, const D: usize>() -> Vec<(&'static str, Act<T, D>)> {
    let steps = |now: &mut Simulation<T, D>| format!("{:?}", now.step());
    vec![
        ("goes on", |_| String::new()),
        ("steps", steps),
        ("is accepted", |now| {
            now.accept();
            String::new()
        }),
        ("is accepted and steps", |now| {
            now.accept();
            format!("{:?} {:?}", now.evaluate(), now.step())
        }),
        ("takes a short step", |now| {
            let step = now.clone().step().expect("a step");
            format!("{:?}", now.step_at_most(0.3 * step))
        }),
        ("is evaluated", |now| {
            let evaluated = [now.evaluate(), now.evaluate()];
            format!("{evaluated:?} {:?}", said(now))
        }),
        ("is evaluated and keeps energy", |now| {
            now.evaluate().expect("rates");
            now.keep_energy();
            format!("{:?}", now.energy())
        }),
        ("is evaluated and accepted", |now| {
            now.evaluate().expect("rates");
            now.accept();
            format!("{:?}", said(now))
        }),
        ("is rehearsed", |now| {
            let own = now.expected_work(2.0 * now.time()).expect("a rehearsal");
            let counts = [own.steps, own.evaluations, own.list_builds, own.pairs];
            format!("{counts:?}")
        }),
        ("is rehearsed for ranks", |now| {
            let model = now.rank_model(2.0 * now.time()).expect("a model");
            format!("{}", model.particles)
        }),
        ("keeps energy", |now| {
            now.keep_energy();
            format!("{:?}", now.energy())
        }),
        ("is watched", |now| {
            now.keep_stability(Thresholds::default());
            let first = format!("{:?}", now.stability().verdict);
            now.run_until(1.1 * now.time()).expect("a run");
            format!("{first} {:?}", now.stability().verdict)
        }),
        ("gets velocities", |now| {
            now.set_velocities(|_, v| v.map(|v| 0.99 * v));
            String::new()
        }),
        ("gets a field", |now| {
            let set = now.set_field(0, Field::VELOCITY, |_, v: [f64; D]| v.map(|v| 0.98 * v));
            format!("{set:?}")
        }),
        ("is limited", |now| {
            now.limit_stored_energy(0.4);
            String::new()
        }),
        ("is read again in the same step", |now| {
            let mut read = Vec::new();
            for _ in 0..2 {
                now.run_until(now.time() * (1.0 + 1e-7)).expect("a run");
                read.push((said(now), now.steps()));
            }
            format!("{read:?}")
        }),
        ("goes on step by step", |now| {
            let mut seen = Vec::new();
            let end = 1.02 * now.time();
            now.run_with(end, |now| seen.push(said(now)))
                .expect("a run");
            format!("{seen:?}")
        }),
        ("is cloned, and the clone goes on", |now| {
            let mut other = now.clone();
            other.accept();
            other.run_until(1.1 * now.time()).expect("a run");
            format!("{:?}", said(&other))
        }),
    ]
}

/// All that a run says and has counted.
fn told<T: Real, const D: usize>(now: &Simulation<T, D>) -> String {
    let work = now.work();
    let counts = (work.steps, work.evaluations, work.list_builds, work.pairs);
    let votes = (now.cost().steps, now.last_vote(), now.limits());
    format!(
        "{counts:?} {votes:?} {:?} {:?}",
        now.guard_counts(),
        said(now)
    )
}

/// A run of so many steps that is read after about half of them, and goes on in each of these ways.
fn read<T: Real, const D: usize>(scene: Scene<T, D>, end: f64) -> Vec<[String; 4]> {
    let mut first = scene.build().expect("the scene");
    first.run_until(0.3 * end).expect("a run");
    first.run_until(0.5003 * end).expect("a run");
    let act = |(name, act): (&str, Act<T, D>)| {
        let mut now = first.clone();
        let begun = told(&now);
        let said = act(&mut now);
        let then = told(&now);
        now.run_until(0.8 * end).expect("a run");
        now.run_until(end).expect("a run");
        [name.into(), begun, said + &then, told(&now)]
    };
    acts().into_iter().map(act).collect()
}

/// Compares what follows a reading on ranks with what does in a plain run.
fn one_set_of_bits<T: Real, const D: usize>(
    name: &'static str,
    steps: usize,
    scene: impl Fn() -> Scene<T, D> + Send + Sync + 'static,
) {
    watched_for(900, move || {
        let mut first = scene().build().expect("the scene");
        for _ in 0..steps {
            first.step().expect("a step");
        }
        let end = first.time();
        let plain = read(scene(), end);
        let mut shown = scene().build().expect("the scene");
        shown.run_until(0.5003 * end).expect("a run");
        let (time, step) = (shown.time(), shown.step().expect("a step"));
        assert!(shown.time() > time && shown.time() - step < time, "{name}");
        for (count, threads) in [(2, 1), (3, 2)] {
            let all = ranks::in_threads(count, threads, |ranks| read(scene().on_ranks(ranks), end));
            for (rank, own) in all.expect("threads").into_iter().enumerate() {
                for (own, plain) in own.iter().zip(&plain) {
                    let at = format!("{name} {}: rank {rank} of {count}", plain[0]);
                    assert!(own[1] == plain[1], "{at}: another reading");
                    assert!(own[2] == plain[2], "{at}: says something else");
                    assert!(own[3] == plain[3], "{at}: another end");
                }
            }
        }
    });
}

#[test]
fn a_dam_break_that_is_read_goes_on() {
    one_set_of_bits("a dam break", 120, dam_break);
}

#[test]
fn a_crushed_tank_that_is_read_goes_on() {
    one_set_of_bits("a crushed tank", 80, crushed_tank);
}

#[test]
fn water_before_mirrors_that_is_read_goes_on() {
    one_set_of_bits("a corner", 100, corner);
}

#[test]
fn a_gas_that_is_read_goes_on() {
    one_set_of_bits("a gas", 30, || gas_in_periods(EnergyForm::Compatible));
}

#[test]
fn a_plate_that_is_read_goes_on() {
    one_set_of_bits("a plate", 50, bent_plate);
}

#[test]
fn a_rod_by_runge_kutta_that_is_read_goes_on() {
    one_set_of_bits("a rod", 60, rod_by_runge_kutta);
}
