//! Errors on ranks: what one rank finds ends the call on all of them, and nothing hangs.

use super::scenes::{DX, dam_break};
use super::watched;
use meshfree::boundary::Wall;
use meshfree::error::Problem;
use meshfree::prelude::*;
use meshfree::ranks::{self, Ranks};
use std::sync::Arc;

const RANKS: usize = 3;

/// What each rank returns, in words.
fn on_ranks(
    program: impl Fn(Arc<dyn Ranks>) -> Result<(), Error> + Send + Sync + 'static,
) -> Vec<String> {
    watched(move || {
        let said =
            |ranks| program(ranks).map_or_else(|error| error.to_string(), |()| "well".into());
        ranks::in_threads(RANKS, 1, said).expect("threads")
    })
}

/// All ranks say that one has failed; that one says why, which is in what the others say.
pub(super) fn named_by_all(all: &[String], failed: usize, why: &str) {
    assert!(all[failed].contains(why), "{all:#?}");
    for (rank, text) in all.iter().enumerate().filter(|(rank, _)| *rank != failed) {
        assert!(
            text.starts_with(&format!("rank {failed} has failed")),
            "{rank}: {text}"
        );
        assert!(text.contains(&all[failed]), "{rank}: {text}");
    }
}

fn rod(spacing: f64, velocity: f64) -> Scene<f64, 1> {
    let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], spacing);
    Scene::new(schemes::impact())
        .body(rod.velocity([velocity]))
        .boundary(MirrorPlane::wall([0.01], [1.0]))
}

#[test]
fn a_load_that_fails_on_one_rank_ends_all() {
    let all = on_ranks(|ranks| {
        let broken = ranks.rank() == 1;
        let load = Load::acceleration(move |at| {
            let late = broken && at.time > 0.002;
            [if late { f64::NAN } else { 0.0 }, 0.0]
        });
        let mut simulation = dam_break().load(load).on_ranks(ranks).build()?;
        let failed = simulation.run_until(0.01);
        // A simulation that has failed goes no further, on any rank.
        assert!(matches!(simulation.step(), Err(Error::Failed { .. })));
        failed
    });
    named_by_all(&all, 1, "the load");
}

#[test]
fn a_hundred_scenes_that_are_wrong_give_one_error_on_all_ranks() {
    for k in 0..100 {
        let wrong = [f64::NAN, -1e-4, 0.0, f64::INFINITY, 1.0][k % 5];
        let on_all = k % 2 == 0;
        let failed = k / 2 % RANKS;
        let all = on_ranks(move |ranks| {
            let is_wrong = on_all || ranks.rank() == failed;
            let scene = match k / 10 % 3 {
                0 => rod(if is_wrong { wrong } else { 2e-4 }, 20.0),
                1 if is_wrong => rod(2e-4, f64::NAN),
                1 => rod(2e-4, 20.0),
                _ if is_wrong => rod(2e-4, 20.0).between("rod", "pad", Interaction::Bonded),
                _ => rod(2e-4, 20.0),
            };
            scene.on_ranks(ranks).build()?.step().map(|_| ())
        });
        if on_all {
            assert_ne!(all[0], "well");
            assert!(all.iter().all(|text| *text == all[0]), "{k}: {all:#?}");
        } else {
            named_by_all(&all, failed, "");
        }
    }
}

#[test]
fn ranks_of_other_scenes_or_calls_are_told() {
    let other_scene = on_ranks(|ranks| {
        let velocity = if ranks.rank() == 2 {
            20.0 + 1e-12
        } else {
            20.0
        };
        let mut simulation = rod(2e-4, velocity).on_ranks(ranks).build()?;
        simulation.run_until(1e-6)
    });
    assert!(
        other_scene
            .iter()
            .all(|text| text.contains("rank 2") && text.contains("its time"))
    );
    // Walls do not travel, so each rank would have its own.
    let other_wall = on_ranks(|ranks| {
        let low = if ranks.rank() == 1 { 0.9 + DX } else { 0.9 };
        let box_wall = Wall::around("box", [low, 0.2], [1.1, 0.3], DX, 1, [[true; 2]; 2]);
        dam_break()
            .wall(box_wall)
            .on_ranks(ranks)
            .build()
            .map(|_| ())
    });
    assert!(other_wall.iter().all(|text| text.contains("rank 1 has")));
    let other_calls = on_ranks(|ranks| {
        let stops = ranks.rank() == 1;
        let mut simulation = rod(2e-4, 20.0).on_ranks(ranks).build()?;
        simulation.step()?;
        if stops {
            return Ok(());
        }
        simulation.run_until(1e-6)
    });
    assert_eq!(other_calls[1], "well");
    for rank in [0, 2] {
        assert!(
            other_calls[rank].contains("rank 1 has ended"),
            "{other_calls:#?}"
        );
    }
}

/// Bytes of a step as counted by hand.
#[test]
fn each_rank_gets_the_sums_that_it_does_not_make() {
    let counted = watched(|| {
        ranks::in_threads(2, 1, |ranks| -> Result<_, Error> {
            let mut simulation = dam_break().on_ranks(ranks).build()?;
            simulation.step()?;
            let (before, builds) = (
                simulation.traffic().expect("ranks"),
                simulation.list_builds(),
            );
            simulation.step()?;
            assert_eq!(simulation.list_builds(), builds);
            let after = simulation.traffic().expect("ranks");
            Ok([
                after.sent - before.sent,
                after.received - before.received,
                after.gathered - before.gathered,
            ])
        })
        .expect("threads")
    });
    let counted: Vec<[u64; 3]> = counted
        .into_iter()
        .map(|own| own.expect("a step"))
        .collect();
    // A step has one evaluation and one middle of a drift: sums of walls (weight, pressure, two components of a moment), rates
    // (two components of the force, signal) and continuity (compression, diffusion), eight bytes each.
    let (liquid, walls) = (3200.0, (120.0 + 8.0) * 4.0 + 2.0 * 60.0 * 4.0);
    let sums = 8.0 * (walls * 4.0 + liquid * (3.0 + 2.0));
    let both = (counted[0][0] + counted[1][0]) as f64;
    // Forces by walls come with the sums: 32 bytes for each cluster that meets a wall.
    assert!(both > sums && both < 1.3 * sums, "{both} of {sums}");
    assert_eq!(counted[0][0], counted[1][1]);
    // Three sweeps and an end, each with its header.
    assert_eq!(counted[0][2], 8);
}

#[test]
fn memory_is_predicted_for_the_part_of_a_rank() {
    let needed = |problems: &[Problem]| match problems {
        [Problem::Memory { needed, .. }] => *needed,
        other => panic!("{other:?}"),
    };
    let whole = needed(&dam_break().memory_limit(1).problems());
    let limit = whole / 2;
    let all = on_ranks(move |ranks| {
        let scene = dam_break().memory_limit(limit).on_ranks(ranks);
        scene.build().map(|_| ())
    });
    assert_eq!(all, ["well"; RANKS]);
    // Where a load may look at them, every rank has all particles.
    let all = on_ranks(move |ranks| {
        let load = Load::acceleration(|_| [0.0; 2]);
        let scene = dam_break().load(load).memory_limit(limit);
        scene.on_ranks(ranks).build().map(|_| ())
    });
    assert!(all[0].contains("memory"), "{all:?}");
    assert!(all.iter().all(|own| *own == all[0]), "{all:?}");
}
