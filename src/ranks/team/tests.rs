//! Parts, errors and ranks that part, on ranks that are threads.
//! Nothing hangs, and all are told.

use super::super::in_threads;
use super::*;
use crate::error::Problem;

const STAMP: Stamp = Stamp {
    steps: 3,
    time: 0.5,
    particles: 7,
    motion: 11,
};

fn on_ranks<V: Send>(program: impl Fn(&Team) -> V + Sync) -> Vec<V> {
    in_threads(3, 1, |ranks| program(&Team::new(ranks))).expect("threads")
}

fn text<V>(outcome: Result<V, Error>) -> String {
    outcome.map_or_else(|error| error.to_string(), |_| "well".into())
}

#[test]
fn parts_of_any_length_reach_all_in_order() {
    let all = on_ranks(|team| {
        let mut got = Vec::new();
        for turn in 0..5 {
            let own = vec![team.rank() as u8; turn * team.rank()];
            let take = |rank: usize, own: &[u8]| {
                assert_eq!(own, vec![rank as u8; turn * rank]);
                got.push(rank);
                Some(())
            };
            team.gather(What::Sums, |to| to.extend(own), take);
        }
        assert_eq!(team.traffic().gathered, 10);
        (got, text(team.agree(Some(STAMP), Ok(()))))
    });
    let expected: Vec<usize> = (0..15).map(|k| k % 3).collect();
    assert!(
        all.iter()
            .all(|own| *own == (expected.clone(), "well".into()))
    );
}

#[test]
fn an_error_of_one_reaches_all_wherever_they_are() {
    let wrong = || Err::<(), _>(Error::Argument(Problem::EmptyScene));
    let all = on_ranks(|team| {
        if team.rank() == 1 {
            return [text(team.agree(Some(STAMP), wrong())), String::new()];
        }
        // They are in the middle of a step, and go on to its end without waiting for anybody.
        for _ in 0..4 {
            team.gather(What::Sums, |to| to.push(1), |_, _| Some(()));
        }
        let first = text(team.agree(Some(STAMP), Ok(())));
        [first, text(team.agree(Some(STAMP), Ok(())))]
    });
    let own = Problem::EmptyScene.to_string();
    assert_eq!(all[1][0], own);
    for rank in [0, 2] {
        assert!(
            all[rank]
                .iter()
                .all(|text| text.contains("rank 1") && text.contains(&own))
        );
    }
    // One that all ranks have is theirs, and they may go on.
    let all = on_ranks(|team| {
        let first = text(team.agree(Some(STAMP), wrong()));
        [first, text(team.agree(Some(STAMP), Ok(())))]
    });
    assert_eq!(all, vec![[own, "well".to_string()]; 3]);
}

#[test]
fn ranks_that_part_end_with_the_number_of_the_first_that_differs() {
    let elsewhere = on_ranks(|team| {
        let time = [0.5, 0.5, 0.25][team.rank()];
        text(team.agree(Some(Stamp { time, ..STAMP }), Ok(())))
    });
    assert!(
        elsewhere
            .iter()
            .all(|text| text.contains("rank 2") && text.contains("its time"))
    );
    let other = on_ranks(|team| {
        let what = [What::Sums, What::Lists, What::Sums][team.rank()];
        team.gather(what, |_| {}, |_, _| Some(()));
        text(team.agree(None, Ok(())))
    });
    assert!(
        other
            .iter()
            .all(|text| text.contains("rank 1") && text.contains("other methods"))
    );
    let short = on_ranks(|team| {
        let put = |to: &mut Vec<u8>| to.resize(team.rank(), 0);
        team.gather(What::Sums, put, |_, own| (own.len() < 2).then_some(()));
        text(team.agree(None, Ok(())))
    });
    assert!(
        short
            .iter()
            .all(|text| text.contains("rank 2") && text.contains("message"))
    );
}

#[test]
fn a_rank_that_has_gone_ends_the_others() {
    let all = on_ranks(|team| match team.rank() {
        0 => String::new(),
        _ => text(team.agree(Some(STAMP), Ok(()))),
    });
    assert!(
        all[1..]
            .iter()
            .all(|text| text.contains("rank 0 has ended")),
        "{all:?}"
    );
}
