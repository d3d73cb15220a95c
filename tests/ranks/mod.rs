//! A scene on ranks that are threads of one process: one set of bits on 1, 2, 3 and 4 ranks, with 1 and 2 threads each,
//! equal to that of a plain run; and errors that reach all ranks.

mod bad_inputs;
mod between;
mod errors;
#[cfg(feature = "checkpoint")]
mod killed;
mod long;
mod parts;
mod pieces;
mod predicted;
mod readers;
#[cfg(feature = "checkpoint")]
mod restart;
mod scenes;

use crate::guarantees::bits::{self, said};
#[cfg(feature = "checkpoint")]
use crate::guarantees::flap;
use meshfree::prelude::*;
use meshfree::ranks::{self, Ranks};
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::Duration;

/// Ranks, and threads of each.
const PLACES: [[usize; 2]; 5] = [[1, 2], [2, 1], [2, 2], [3, 1], [4, 2]];

/// Ends the test if ranks wait for each other for ever.
fn watched<V: Send + 'static>(program: impl FnOnce() -> V + Send + 'static) -> V {
    watched_for(300, program)
}

/// The same after so many seconds.
fn watched_for<V: Send + 'static>(seconds: u64, program: impl FnOnce() -> V + Send + 'static) -> V {
    let (done, end) = channel();
    let running = std::thread::spawn(move || {
        let value = program();
        let _ = done.send(());
        value
    });
    let ended = end.recv_timeout(Duration::from_secs(seconds)).is_ok();
    assert!(ended || running.is_finished(), "ranks hang");
    running.join().expect("a program on ranks")
}

/// The end of a run of so many steps and a sixth more of each form in turns, and the ledgers and votes of all steps, to the bit.
fn run<T: Real, const D: usize>(scene: Scene<T, D>, steps: usize) -> (Vec<u64>, Vec<u64>, u64) {
    let mut simulation = scene.build().expect("the scene");
    let mut history = Vec::new();
    for _ in 0..steps {
        history.push(simulation.step().expect("a step").to_bits());
        let ledger = simulation.ledger();
        let numbers = ledger
            .whole
            .momentum
            .into_iter()
            .chain([ledger.whole.kinetic]);
        history.extend(numbers.chain(ledger.boundary_impulse).map(f64::to_bits));
    }
    for _ in 0..3 {
        let step = simulation.step().expect("a step");
        let end = simulation.time() + steps as f64 / 18.0 * step;
        simulation.run_until(end).expect("a run");
        history.extend(said(&simulation));
    }
    (said(&simulation), history, simulation.list_builds())
}

/// Holds a scene on ranks against the plain run, over at least so many list builds.
fn one_set_of_bits<T: Real, const D: usize>(
    name: &'static str,
    least: (usize, u64),
    scene: impl Fn() -> Scene<T, D> + Send + Sync + 'static,
) {
    one_set_of_bits_on(&PLACES, name, least, scene);
}

/// The same on some numbers of ranks and threads.
fn one_set_of_bits_on<T: Real, const D: usize>(
    places: &'static [[usize; 2]],
    name: &'static str,
    (steps, builds): (usize, u64),
    scene: impl Fn() -> Scene<T, D> + Send + Sync + 'static,
) {
    // The long form is of five times as many steps.
    let each = if steps < 300 { 60 } else { 120 };
    watched_for(each * places.len() as u64, move || {
        let plain = run(scene(), steps);
        println!("{name}: {} list builds", plain.2);
        assert!(plain.2 >= builds, "{name}: {} list builds", plain.2);
        for &[count, threads] in places {
            let program = |ranks: Arc<dyn Ranks>| run(scene().on_ranks(ranks), steps);
            let all = ranks::in_threads(count, threads, program).expect("threads");
            for (rank, own) in all.into_iter().enumerate() {
                let at = format!("{name}: rank {rank} of {count} with {threads} threads");
                assert!(own.1 == plain.1, "{at}: another history");
                assert!(own.0 == plain.0, "{at}: other bits");
            }
        }
    });
}
