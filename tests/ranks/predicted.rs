//! Messages, bytes and memory of a step on ranks: predicted by `Simulation::rank_model` from the scene on one process, and counted.
//! Nothing here is timed, so no machine changes an outcome.

use super::scenes::{bent_plate, dam_break, periodic_gas, plate_at_wall, rod, tank_in_space};
use super::watched;
use meshfree::boundary::Wall;
use meshfree::prelude::*;
use meshfree::ranks::{self, Network, Ranks};
use std::sync::Arc;

/// Predicted over counted bytes, at most, and one over it at least: ghosts of a part of the curve are more than those of a box.
const BYTES: f64 = 1.5;

/// The same of gatherings, of which a step has one or two more where something is near.
const GATHERINGS: f64 = 1.15;

/// Steps, list builds and sorts of a run, of each step in the mean gatherings, exchanges and bytes that the rank received, and bytes that
/// it holds.
fn counted<T: Real, const D: usize>(scene: Scene<T, D>, end: f64) -> [f64; 7] {
    let mut simulation = scene.build().expect("the scene");
    let (before, builds) = (simulation.traffic(), simulation.list_builds());
    let before = before.expect("ranks");
    simulation.run_until(end).expect("a run");
    let after = simulation.traffic().expect("ranks");
    let steps = simulation.steps() as f64;
    [
        steps,
        (simulation.list_builds() - builds) as f64,
        (after.travelled - before.travelled) as f64,
        (after.gathered - before.gathered) as f64 / steps,
        (after.exchanged - before.exchanged) as f64 / steps,
        (after.received - before.received) as f64 / steps,
        simulation.bytes() as f64,
    ]
}

/// Compares the prediction for a run of so many steps with what is counted on two and four ranks.
fn as_predicted<T: Real, const D: usize>(
    name: &'static str,
    steps: usize,
    own_alone: bool,
    scene: impl Fn() -> Scene<T, D> + Send + Sync + 'static,
) {
    watched(move || {
        let mut plain = scene().build().expect("the scene");
        for _ in 0..steps {
            plain.step().expect("a step");
        }
        // The end of a step, so that nothing is shown between two.
        let end = plain.time();
        let mut predicted = scene().build().expect("the scene");
        let mut model = predicted.rank_model(end).expect("a model");
        assert_eq!(model.own_alone, own_alone, "{name}");
        for count in [2, 4] {
            let program = |ranks: Arc<dyn Ranks>| counted(scene().on_ranks(ranks), end);
            let all = ranks::in_threads(count, 1, program).expect("threads");
            let mean = |k: usize| all.iter().map(|own| own[k]).sum::<f64>() / count as f64;
            let [taken, builds, sorts] = [mean(0), mean(1), mean(2)];
            assert_eq!(taken as usize, steps, "{name}");
            // How often lists are built is the subject of another test, and all come together once in so many steps. A new cut is
            // a sort of another kind.
            model.list_builds = builds / taken;
            model.sorts = (sorts / builds.max(1.0)).min(1.0);
            model.gathers_of_all = (model.gathers_of_all * taken).floor() / taken;
            let cost = model.on(count, &Network::default()).expect("a cost");
            let held = cost.memory - (8 * D) as f64 * model.particles;
            let pairs = [
                ("bytes held", held, mean(6), BYTES),
                ("gatherings", cost.gathered, mean(3), GATHERINGS),
                ("exchanges", cost.exchanged, mean(4), GATHERINGS),
                ("bytes", cost.received, mean(5), BYTES),
            ];
            println!(
                "{name} on {count}: {builds} builds in {taken} steps, {sorts} sorts, {:.0} ghosts",
                cost.ghosts
            );
            for (what, predicted, counted, most) in pairs {
                println!("  {what}: {predicted:.1} predicted, {counted:.1} counted");
                if counted == 0.0 {
                    assert_eq!(predicted, 0.0, "{name} on {count}: {what}");
                    continue;
                }
                let ratio = predicted / counted;
                assert!(
                    ratio < most && ratio > 1.0 / most,
                    "{name} on {count}: {ratio} of {what}"
                );
            }
            // Without list builds the prediction is of another scene, where there were steps without to predict from.
            let mut without = model.clone();
            without.list_builds = 0.0;
            let without = without.on(count, &Network::default()).expect("a cost");
            let all_or_none = builds == 0.0 || builds >= taken;
            assert!(all_or_none || without.received < cost.received, "{name}");
        }
    });
}

#[test]
fn messages_of_a_dam_break_are_as_predicted() {
    as_predicted("dam break", 120, true, dam_break);
}

#[test]
fn messages_of_a_tank_in_space_are_as_predicted() {
    as_predicted("tank in space, f32", 60, true, tank_in_space);
}

#[test]
fn messages_of_a_gas_in_periods_are_as_predicted() {
    as_predicted("periodic gas", 60, true, periodic_gas);
}

#[test]
fn messages_of_a_rod_are_as_predicted() {
    as_predicted("rod", 100, true, || rod(400.0));
}

#[test]
fn messages_of_a_plate_of_fixed_neighbours_are_as_predicted() {
    as_predicted("total-Lagrangian plate", 60, true, bent_plate);
}

#[test]
fn messages_of_sums_of_all_are_as_predicted() {
    as_predicted("plate at a wall", 60, false, plate_at_wall);
}

#[test]
fn two_ranks_hold_hardly_more_than_one_process() {
    let scene = || {
        let water = catalogue::weakly_compressible_water(4.0);
        let closed = [[true; 2]; 2];
        Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(Body::block("water", water, [0.0; 2], [1.6, 0.4], 0.005))
            .wall(Wall::around("tank", [0.0; 2], [2.0, 0.6], 0.005, 4, closed))
            .acceleration(|_| [0.0, -9.81])
    };
    let held = |scene: Scene<f64, 2>| {
        let mut now = scene.build().expect("the scene");
        while now.list_builds() < 3 {
            now.run_until(now.time() + 0.002).expect("a run");
        }
        now.bytes()
    };
    watched(move || {
        let plain = held(scene());
        let all = ranks::in_threads(2, 1, |ranks| held(scene().on_ranks(ranks)));
        let all: usize = all.expect("threads").into_iter().sum();
        println!("{} of {plain} bytes", all as f64 / plain as f64);
        assert!((all as f64) < 1.15 * plain as f64, "{all} of {plain}");
    });
}

/// The rehearsal changes no bit and no count, with ranks and without.
#[test]
fn a_model_of_ranks_leaves_no_trace() {
    fn told(scene: Scene<f64, 2>, looks: bool) -> [u64; 4] {
        let mut simulation = scene.build().expect("the scene");
        for k in 1..4 {
            if looks {
                let model = simulation.rank_model(0.2).expect("a model");
                assert!(model.step.gathered > 4.0 && model.parts.len() == 2);
            }
            simulation.run_until(0.011 * f64::from(k)).expect("a run");
        }
        let work = simulation.work();
        [
            simulation.bits_hash(),
            work.pairs,
            work.steps,
            work.list_builds,
        ]
    }
    watched(|| {
        let plain = told(dam_break(), false);
        assert_eq!(told(dam_break(), true), plain);
        let all = ranks::in_threads(3, 1, |ranks| told(dam_break().on_ranks(ranks), true));
        assert_eq!(all.expect("threads"), [plain; 3]);
    });
}
