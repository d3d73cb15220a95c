//! Readings of ranks that have their own particles only: after the ranks have ended, in observers, on ranks that make no offers, and on
//! ranks of which one stops early.

use super::bits::said;
use super::scenes::{corner, dam_break};
use super::watched;
use meshfree::error::Failure;
use meshfree::prelude::*;
use meshfree::ranks::{self, Ranks};
use std::sync::Arc;

fn run(mut now: Simulation<f64, 2>, end: f64) -> Simulation<f64, 2> {
    now.run_until(end).expect("a run");
    now
}

#[test]
fn simulations_that_ranks_return_are_read_one_after_another() {
    watched(|| {
        for end in [0.0111, 0.0203] {
            let plain = said(&run(dam_break().build().expect("the scene"), end));
            let all = ranks::in_threads(3, 1, |ranks| {
                run(dam_break().on_ranks(ranks).build().expect("the scene"), end)
            });
            for mut own in all.expect("threads") {
                assert!(said(&own) == plain);
                assert!(said(&own.clone()) == plain);
                // There is no rank to step with.
                let error = own.run_until(2.0 * end).expect_err("the ranks have ended");
                assert!(error.to_string().contains("has ended"), "{error}");
            }
        }
    });
}

/// Ranks that reach each other as others do, and make no offers.
#[derive(Debug)]
struct WithoutOffers(Arc<dyn Ranks>);

impl Ranks for WithoutOffers {
    fn rank(&self) -> usize {
        self.0.rank()
    }

    fn count(&self) -> usize {
        self.0.count()
    }

    fn gather(&self, own: &[u8], counts: &[usize], all: &mut [u8]) -> Result<(), Failure> {
        self.0.gather(own, counts, all)
    }

    fn exchange(
        &self,
        own: &[u8],
        to: &[usize],
        all: &mut [u8],
        from: &[usize],
    ) -> Result<(), Failure> {
        self.0.exchange(own, to, all, from)
    }
}

#[test]
fn ranks_without_offers_have_the_same_bits() {
    fn read(scene: Scene<f64, 2>) -> Vec<Vec<u64>> {
        let mut now = scene.build().expect("the scene");
        let mut seen = vec![said(&now)];
        for end in [0.0111, 0.0203, 0.03] {
            now = run(now, end);
            seen.push(said(&now));
        }
        seen
    }
    watched(|| {
        for scene in [dam_break, corner] {
            let plain = read(scene());
            let all = ranks::in_threads(3, 1, |ranks| {
                read(scene().on_ranks(Arc::new(WithoutOffers(ranks))))
            });
            assert!(all.expect("threads").iter().all(|own| *own == plain));
        }
    });
}

/// An observer writes a checkpoint on all ranks, and then one rank reads alone.
#[cfg(feature = "checkpoint")]
#[test]
fn an_observer_saves_and_one_rank_reads() {
    fn observed(scene: Scene<f64, 2>, path: &std::path::Path, reads: bool) -> Vec<Vec<u64>> {
        let mut now = scene.build().expect("the scene");
        let mut seen = Vec::new();
        Run::new(&mut now, 0.03)
            .observe(Schedule::every(0.0071), |now| {
                now.save(path)?;
                if reads {
                    seen.push(said(now));
                }
                Ok(())
            })
            .go()
            .expect("a run");
        seen
    }
    watched(|| {
        let folder = std::env::temp_dir().join(format!("meshfree-readers-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let [plain_path, path] = ["plain", "ranks"].map(|name| folder.join(name));
        let plain = observed(dam_break(), &plain_path, true);
        let all = ranks::in_threads(3, 1, |ranks| {
            let reads = ranks.rank() == 1;
            observed(dam_break().on_ranks(ranks), &path, reads)
        });
        assert!(plain.len() > 3 && all.expect("threads")[1] == plain);
        let end = |path| {
            let resumed = dam_break().resume(path).expect("a checkpoint");
            said(&run(resumed, 0.04))
        };
        assert!(end(&path) == end(&plain_path));
        let _ = std::fs::remove_dir_all(folder);
    });
}

/// One rank drops its simulation where the others run on: an error on all of these, and no hang.
#[test]
fn a_rank_that_stops_early_is_an_error() {
    watched(|| {
        let all = ranks::in_threads(3, 1, |ranks| {
            let rank = ranks.rank();
            let now = run(
                dam_break().on_ranks(ranks).build().expect("the scene"),
                0.0111,
            );
            if rank == 1 {
                return None;
            }
            let mut now = now;
            Some(
                now.run_until(0.02)
                    .expect_err("a rank has stopped")
                    .to_string(),
            )
        });
        let all = all.expect("threads");
        assert_eq!(all[1], None);
        for rank in [0, 2] {
            let error = all[rank].as_deref().unwrap_or_default();
            assert!(error.starts_with("rank 1 has failed"), "{error}");
        }
    });
}
