//! How the chunks of a group are cut among ranks.
//! The cut follows from the lists alone, and no bit depends on it.

use std::ops::Range;

/// Runs of consecutive chunks, one a rank, of those with particles that move by forces and of all others: a sweep is over one or
/// the other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Division {
    /// The first chunk of each rank, and the end of the last.
    bounds: [Vec<usize>; 2],
}

impl Division {
    /// Cuts chunks of these costs into as many runs as there are ranks; the first `mobile` ones move by forces.
    pub fn new(costs: &[usize], mobile: usize, ranks: usize) -> Self {
        let middle = mobile.min(costs.len());
        Self {
            bounds: [0..middle, middle..costs.len()].map(|part| cut(costs, part, ranks)),
        }
    }

    /// Whether every rank has particles that move by forces.
    pub fn is_full(&self) -> bool {
        self.bounds[0].windows(2).all(|own| own[0] < own[1])
    }

    /// Whether it cuts so many chunks, of which the first `mobile` ones move by forces.
    pub fn is_of(&self, chunks: usize, mobile: usize) -> bool {
        let [middle, end] = self.bounds.each_ref().map(|own| own.last().copied());
        (middle, end) == (Some(mobile), Some(chunks))
    }

    /// The cost of the slowest rank over the mean.
    pub fn imbalance(&self, costs: &[usize]) -> f64 {
        let ranks = self.bounds[0].len().saturating_sub(1);
        let cost = |rank| -> usize { self.of(rank).into_iter().flatten().map(|k| costs[k]).sum() };
        let most = (0..ranks).map(cost).max().unwrap_or(0);
        (most * ranks) as f64 / costs.iter().sum::<usize>().max(1) as f64
    }

    /// The chunks of a rank.
    pub fn of(&self, rank: usize) -> [Range<usize>; 2] {
        self.bounds.each_ref().map(|bounds| {
            let at = |k: usize| bounds.get(k).copied().unwrap_or(0);
            at(rank)..at(rank + 1)
        })
    }
}

/// Equal numbers of chunks for a rank.
pub(crate) fn even(chunks: usize, rank: usize, ranks: usize) -> Range<usize> {
    rank * chunks / ranks..(rank + 1) * chunks / ranks
}

/// Cuts a part of the chunks where the cost before is nearest to what it would be if all were equal.
fn cut(costs: &[usize], part: Range<usize>, ranks: usize) -> Vec<usize> {
    let whole: usize = costs[part.clone()].iter().sum();
    let mut bounds = vec![part.start];
    let (mut at, mut before) = (part.start, 0);
    for rank in 1..ranks {
        let wanted = whole * rank / ranks;
        while at < part.end && 2 * before + costs[at] <= 2 * wanted {
            before += costs[at];
            at += 1;
        }
        bounds.push(at);
    }
    bounds.push(part.end);
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_chunk_has_one_rank_and_ranks_cost_alike() {
        let costs: Vec<usize> = (0..200).map(|k| 500 + 400 * (k % 7) + 9 * k).collect();
        let largest = costs.iter().copied().max().unwrap_or(0);
        for ranks in 1..=9 {
            let division = Division::new(&costs, 170, ranks);
            for (part, chunks) in [0..170, 170..200].into_iter().enumerate() {
                let mut next = chunks.start;
                let mean = costs[chunks.clone()].iter().sum::<usize>() / ranks;
                for rank in 0..ranks {
                    let own = division.of(rank)[part].clone();
                    assert_eq!(own.start, next);
                    next = own.end;
                    let cost: usize = costs[own].iter().sum();
                    assert!(cost.abs_diff(mean) <= largest, "{cost} of {mean}");
                }
                assert_eq!(next, chunks.end);
            }
        }
    }

    #[test]
    fn more_ranks_than_chunks_leave_some_without() {
        let division = Division::new(&[5, 5, 5], 2, 4);
        let all: Vec<_> = (0..4)
            .flat_map(|rank| division.of(rank))
            .flatten()
            .collect();
        let mut sorted = all.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, [0, 1, 2]);
        assert!(!division.is_full() && Division::new(&[5, 5, 5], 2, 2).is_full());
        assert_eq!(Division::new(&[], 0, 3).of(2), [0..0, 0..0]);
        assert_eq!((0..3).map(|rank| even(7, rank, 3).len()).sum::<usize>(), 7);
    }
}
