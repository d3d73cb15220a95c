//! Numbers that ranks join: the largest of each, and whether something is so on any of them.
//! What is joined depends on neither the order of ranks nor how particles are cut among them.

use super::{Plain, Taken, Team, What, put_number, put_numbers};
use crate::collective::Corners;
use core::cell::Cell;
use std::ops::Range;

/// Numbers of all ranks in one message.
const PIECE: usize = 1 << 18;

/// From where a rank gets numbers of the others.
#[derive(Clone, Copy)]
pub(crate) enum Source<'a> {
    /// From a gathering of all ranks.
    All(&'a Team, What),
    /// From offers, for which the other ranks need not ask.
    Offer(&'a Asked<'a>),
}

/// Asks for the parts of an offer, one after another.
pub(crate) struct Asked<'a> {
    team: &'a Team,
    number: u64,
    part: Cell<usize>,
}

impl<'a> Asked<'a> {
    pub fn new(team: &'a Team, number: u64) -> Self {
        let part = Cell::new(0);
        Self { team, number, part }
    }
}

impl Source<'_> {
    /// The ranks.
    pub fn team(&self) -> &Team {
        match self {
            Self::All(team, _) => team,
            Self::Offer(asked) => asked.team,
        }
    }

    /// Gets the numbers of each rank into its runs of `all`. Each rank gives `added` with its numbers, and `take_added` reads that.
    pub fn numbers<V: Plain>(
        &self,
        all: &mut [V],
        runs_of: impl Fn(usize) -> [Range<usize>; 2],
        added: Vec<u8>,
        mut take_added: impl FnMut(usize, &mut Taken<'_>) -> Option<()>,
    ) {
        match self {
            Self::All(team, what) => team.gather_numbers(*what, all, runs_of, added, take_added),
            Self::Offer(asked) => {
                let part = asked.part.replace(asked.part.get() + 1);
                asked.team.ask(asked.number, part, |rank, from| {
                    for run in runs_of(rank) {
                        from.numbers(all.get_mut(run)?)?;
                    }
                    take_added(rank, from)
                });
            }
        }
    }
}

impl Team {
    /// Shows the numbers of each rank, of which all have as many; those of this one alone where a rank has failed.
    pub fn numbers<const N: usize>(&self, own: [u64; N], mut each: impl FnMut([u64; N])) {
        let put = |to: &mut Vec<u8>| own.iter().for_each(|own| put_number(*own, to));
        let mut any = false;
        self.gather(What::Numbers, put, |_, from| {
            let (mut from, mut numbers) = (Taken(from), [0; N]);
            for number in &mut numbers {
                *number = from.number()?;
            }
            any = true;
            each(numbers);
            from.0.is_empty().then_some(())
        });
        if !any {
            each(own);
        }
    }

    /// Gets the numbers of each rank where its runs are among those of all. In pieces, so that no message is large; with the first
    /// goes what each rank adds to it.
    fn gather_numbers<V: Plain>(
        &self,
        what: What,
        all: &mut [V],
        runs_of: impl Fn(usize) -> [Range<usize>; 2],
        mut added: Vec<u8>,
        mut take_added: impl FnMut(usize, &mut Taken<'_>) -> Option<()>,
    ) {
        let lengths = (0..self.count()).map(|rank| runs_of(rank).iter().map(Range::len).sum());
        let longest: usize = lengths.max().unwrap_or(0);
        let piece = (PIECE / self.count()).max(1);
        // What of the runs of a rank is in the piece that begins there.
        let parts = |rank: usize, begin: usize| {
            let mut before = 0;
            runs_of(rank).map(|run| {
                let at = |n: usize| run.start + n.clamp(before, before + run.len()) - before;
                let part = at(begin)..at(begin + piece);
                before += run.len();
                part
            })
        };
        for begin in (0..longest.max(1)).step_by(piece) {
            let mut own = Vec::new();
            for part in parts(self.rank(), begin) {
                put_numbers(all.get(part).unwrap_or_default(), &mut own);
            }
            own.append(&mut added);
            let put = |to: &mut Vec<u8>| to.append(&mut own);
            self.gather(what, put, |rank, from| {
                let mut from = Taken(from);
                for part in parts(rank, begin) {
                    from.numbers(all.get_mut(part)?)?;
                }
                if begin == 0 {
                    take_added(rank, &mut from)?;
                }
                from.0.is_empty().then_some(())
            });
        }
    }

    /// The largest of each number over all ranks.
    pub fn largest<const N: usize>(&self, own: [f64; N]) -> [f64; N] {
        let mut most = own;
        self.raise(&mut most);
        most
    }

    /// Raises each number to the largest of it over all ranks, of which all have as many.
    pub fn raise(&self, own: &mut [f64]) {
        let mut most = own.to_vec();
        let put = |to: &mut Vec<u8>| put_numbers(own, to);
        self.gather(What::Numbers, put, |_, from| {
            let mut other = vec![0.0; most.len()];
            let mut from = Taken(from);
            from.numbers(&mut other)?;
            for (most, other) in most.iter_mut().zip(other) {
                *most = most.max(other);
            }
            from.0.is_empty().then_some(())
        });
        own.copy_from_slice(&most);
    }

    /// The corners of all vectors, of which each rank has those of its own, group by group, and the largest of each of other numbers.
    pub fn join_corners<const D: usize>(&self, own: &mut [Corners<D>], largest: &mut [f64]) {
        let outward = |own: &Corners<D>| [own.0[0].map(|x| -x), own.0[1]];
        let outward: Vec<[[f64; D]; 2]> = own.iter().map(outward).collect();
        let mut all = outward.as_flattened().as_flattened().to_vec();
        all.extend_from_slice(largest);
        self.raise(&mut all);
        let (corners, others) = all.split_at(all.len() - largest.len());
        for (own, [low, high]) in own.iter_mut().zip(corners.as_chunks().0.as_chunks().0) {
            own.0 = [low.map(|x: f64| -x), *high];
        }
        largest.copy_from_slice(others);
    }

    /// The first rank that says something, and what: the same on all ranks.
    pub fn first_said(&self, own: Option<&str>) -> Option<(usize, String)> {
        let mut first = None;
        let put = |to: &mut Vec<u8>| {
            if let Some(own) = own {
                to.push(1);
                to.extend_from_slice(own.as_bytes());
            }
        };
        self.gather(What::Decision, put, |rank, said| {
            if let (None, Some((_, said))) = (&first, said.split_first()) {
                first = Some((rank, String::from_utf8_lossy(said).into_owned()));
            }
            Some(())
        });
        first
    }

    /// How many ranks share the memory of this one, itself among them.
    pub fn beside(&self) -> u64 {
        let boot = std::fs::read("/proc/sys/kernel/random/boot_id").unwrap_or_default();
        let add = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
        let machine = boot.iter().fold(0xcbf2_9ce4_8422_2325, add);
        let mut count = 0;
        self.numbers([machine], |[other]| count += u64::from(other == machine));
        count
    }

    /// Whether it is so on any rank.
    pub fn any(&self, own: bool) -> bool {
        let mut any = false;
        self.numbers([u64::from(own)], |[own]| any |= own == 1);
        any
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Letters, in_threads};
    use super::*;
    use crate::error::{Error, Problem};

    #[test]
    fn all_know_the_largest_and_whether_it_is_so_on_any() {
        let all = in_threads(3, 1, |ranks| {
            let team = Team::new(ranks);
            let rank = team.rank();
            let most = team.largest([rank as f64, 1.0 / (1.0 + rank as f64)]);
            let any = [team.any(rank == 1), team.any(false)];
            (most, any, team.beside())
        });
        assert_eq!(all.expect("threads"), [([2.0, 1.0], [true, false], 3); 3]);
    }

    #[test]
    fn numbers_come_to_their_places_in_pieces() {
        const EACH: usize = PIECE / 2 + 1000;
        let all = in_threads(2, 1, |ranks| {
            let team = Team::new(ranks);
            // One has the first and the third part, and the other what is between and behind.
            let runs_of = |rank: usize| match rank {
                0 => [0..EACH - 7, 2 * EACH..2 * EACH + 5],
                _ => [EACH - 7..2 * EACH, 2 * EACH + 5..2 * EACH + 5],
            };
            let mut all = vec![0.0; 2 * EACH + 5];
            for k in runs_of(team.rank()).into_iter().flatten() {
                all[k] = k as f64;
            }
            let mut heard = Vec::new();
            let added = vec![team.rank() as u8; 8];
            team.gather_numbers(What::State, &mut all, runs_of, added, |rank, from| {
                heard.push((rank, from.number()?.to_ne_bytes()[0]));
                Some(())
            });
            assert_eq!(heard, [(0, 0), (1, 1)]);
            let come = all.iter().enumerate().all(|(k, own)| *own == k as f64);
            (come, team.traffic().gathered > 2)
        });
        assert_eq!(all.expect("threads"), [(true, true); 2]);
    }

    #[test]
    fn all_hear_the_first_that_says_something() {
        let all = in_threads(3, 1, |ranks| {
            let team = Team::new(ranks);
            let rank = team.rank();
            let own = format!("of {rank}");
            let late = team.first_said((rank > 0).then_some(&*own));
            let empty = team.first_said((rank == 2).then_some(""));
            (late, empty, team.first_said(None), team.is_broken())
        });
        let said = |rank: usize, text: &str| Some((rank, text.to_string()));
        let expected = (said(1, "of 1"), said(2, ""), None, false);
        assert_eq!(all.expect("threads"), vec![expected; 3]);
    }

    /// As where one rank has a scene with a chunk more: the others could go on, and would wait for it.
    #[test]
    fn a_message_that_one_cannot_take_ends_all() {
        let all = in_threads(3, 1, |ranks| {
            let team = Team::new(ranks);
            let rank = team.rank();
            let take = |from: usize, _: &[u8]| (rank != 2 || from != 1).then_some(());
            team.gather(What::Lists, |to| to.push(1), take);
            let was_broken = team.is_broken();
            let (own, each) = ([1; 3], [1; 3]);
            let came = team.exchange(Letters::Each(1), (&own, &each), (&mut [0; 3], &each));
            let told = team
                .agree(None, Ok(()))
                .expect_err("one scene is another")
                .to_string();
            (
                was_broken,
                came,
                told.contains("(Lists) is not that of the same scene"),
                team,
            )
        });
        for (rank, (was_broken, came, is_told, team)) in
            all.expect("threads").into_iter().enumerate()
        {
            assert_eq!((was_broken, came, is_told), (rank == 2, false, true));
            assert!(team.is_broken());
        }
    }

    #[test]
    fn letters_reach_those_for_whom_they_are_and_errors_reach_all() {
        let all = in_threads(3, 1, |ranks| {
            let team = Team::new(ranks);
            let rank = team.rank();
            let (mut come, each) = ([9; 3], [1; 3]);
            let own: Vec<u8> = (0..3).map(|other| (10 * rank + other) as u8).collect();
            let came = team.exchange(Letters::Each(1), (&own, &each), (&mut come, &each));
            // One fails while the others wait for its letter.
            if rank == 1 {
                let wrong = Err::<(), _>(Error::Argument(Problem::EmptyScene));
                return (came, come, team.agree(None, wrong).is_err());
            }
            let failed = !team.exchange(Letters::Each(1), (&own, &each), (&mut [0; 3], &each));
            (came, come, failed && team.agree(None, Ok(())).is_err())
        });
        let expected = [[0, 10, 20], [1, 11, 21], [2, 12, 22]].map(|come| (true, come, true));
        assert_eq!(all.expect("threads"), expected);
    }
}
