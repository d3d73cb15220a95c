//! The way of particles to other ranks at a list build: each number goes from the rank that had it to the one that gets it.
//! All ranks know the new order, so each finds by itself what it sends and what it gets.

use super::group::Group;
use super::part::{place_in, runs_of};
use super::workspace::{Saved, Workspace};
use crate::particles::{Columns, Field};
use crate::ranks::{Division, Letters, Taken, Team, put_numbers};
use crate::scalar::Real;
use crate::sweep::Results;
use std::ops::Range;

/// What a rank had of a group before a list build, but for what lists are built from.
pub(super) struct Leaving<T: Real, const D: usize> {
    pub division: Division,
    pub columns: Columns<T, D>,
    pub work: Workspace<T, D>,
}

/// Who sends which of its particles to whom.
struct Route<'a> {
    team: &'a Team,
    /// Particles that this rank sends, rank by rank, and how many each gets and gives.
    sends: Vec<u32>,
    to: Vec<usize>,
    from: Vec<usize>,
    /// How many it had.
    had: usize,
    /// Where each particle of this rank stands now: among those that it had, or behind these among those that come.
    sources: Vec<u32>,
}

impl<'a> Route<'a> {
    /// From the runs of each rank before to those after. Slot k of the group becomes what slot `order[k]` was; an empty order keeps
    /// all slots.
    fn new(team: &'a Team, runs: &[[[Range<usize>; 2]; 2]], order: &[u32]) -> Self {
        let before = |slot: usize| order.get(slot).map_or(slot, |&old| old as usize);
        let rank = team.rank();
        let own = &runs[rank][0];
        let had = own.iter().map(Range::len).sum();
        let is_in = |runs: &[Range<usize>; 2], slot| runs.iter().any(|run| run.contains(&slot));
        let after = |other: usize| runs[other][1].clone().into_iter().flatten().map(before);
        let (mut sends, mut to, mut from) = (Vec::new(), Vec::new(), vec![0; runs.len()]);
        for other in 0..runs.len() {
            let begun = sends.len();
            if other != rank {
                let leave = after(other).filter(|old| is_in(own, *old));
                sends.extend(leave.map(|old| place_in(own, old) as u32));
            }
            to.push(sends.len() - begun);
        }
        // Of either kind ranks have ascending runs.
        let moving = runs[runs.len() - 1][0][0].end;
        let owner = |old: usize| {
            let kind = usize::from(old >= moving);
            runs.partition_point(|own| own[0][kind].end <= old)
        };
        let owners = after(rank).map(|old| Some(owner(old)).filter(|own| *own != rank));
        for other in owners.clone().flatten() {
            from[other] += 1;
        }
        let mut next = had;
        let mut places: Vec<usize> = Vec::with_capacity(from.len());
        for count in &from {
            places.push(next);
            next += count;
        }
        let sources = after(rank).zip(owners).map(|(old, owner)| match owner {
            None => place_in(own, old) as u32,
            Some(other) => {
                places[other] += 1;
                places[other] as u32 - 1
            }
        });
        let sources = sources.collect();
        Self {
            team,
            sends,
            to,
            from,
            had,
            sources,
        }
    }

    /// A column of the particles that this rank gets, from that of those that it had.
    fn carry<T: Real>(&self, own: &[T], width: usize) -> Vec<T> {
        let at = |slot: u32| slot as usize * width..(slot as usize + 1) * width;
        let size = width * size_of::<T>();
        let mut letters = Vec::with_capacity(size * self.sends.len());
        for &slot in &self.sends {
            put_numbers(&own[at(slot)], &mut letters);
        }
        let count: usize = self.from.iter().sum();
        let mut come = vec![0; size * count];
        let bytes = |counts: &[usize]| -> Vec<usize> { counts.iter().map(|n| size * n).collect() };
        let (to, from) = (bytes(&self.to), bytes(&self.from));
        let told = self
            .team
            .exchange(Letters::Moved, (&letters, &to), (&mut come, &from));
        let mut arrived = vec![T::zero(); width * count];
        if told {
            let _ = Taken(&come).numbers(&mut arrived);
        }
        let mut all = Vec::with_capacity(width * self.sources.len());
        for &source in &self.sources {
            all.extend_from_slice(match (source as usize).checked_sub(self.had) {
                None => &own[at(source)],
                Some(k) => &arrived[at(k as u32)],
            });
        }
        all
    }
}

impl<T: Real, const D: usize> Leaving<T, D> {
    /// Gives a group, which has this rank's places after a list build, all else of its particles.
    pub fn arrive(mut self, group: &mut Group<T, D>, order: &[u32]) {
        let (Some(all), Some(share)) = (&group.all, &group.share) else {
            return;
        };
        let divisions = [&self.division, share.division()];
        let runs: Vec<_> = (0..share.team.count())
            .map(|rank| divisions.map(|own| runs_of::<T>(own, rank, all.slots())))
            .collect();
        let route = Route::new(&share.team, &runs, order);
        for field in self.columns.fields().iter() {
            let own = core::mem::take(self.columns.column_mut(field));
            if !own.is_empty() {
                let column = group.particles.columns.column_mut(field);
                *column = route.carry(&own, field.components(D));
            }
        }
        let carry_sums = |own: &mut Results<T, D>| {
            let own = core::mem::take(own);
            let width = own.outputs().width(D);
            if width == 0 {
                return own;
            }
            let numbers = route.carry(&own.numbers(route.had), width);
            // Nothing tells the chunks of forces between blocks.
            let forces = own.reactions().copied().collect();
            let moving = &numbers[..width * group.particles.mobile];
            Results::of_rows(own.outputs(), moving, forces)
        };
        let work = &mut self.work;
        group.work.rates = carry_sums(&mut work.rates);
        group.work.worked = carry_sums(&mut work.worked);
        let carry_saved = |own: &Saved<T>| -> Saved<T> {
            let carried = |(field, column): &(Field, Vec<T>)| match column.len() {
                0 => (*field, Vec::new()),
                _ => (*field, route.carry(column, field.components(D))),
            };
            own.iter().map(carried).collect()
        };
        group.work.kept = work.kept.iter().map(carry_saved).collect();
        if work.is_predicted {
            group.work.predicted = carry_saved(&work.predicted);
        }
    }

    /// The same where a rank has failed, which is told where the call ends: room for all particles.
    pub fn fail(self, group: &mut Group<T, D>) {
        let slots = group.particles.columns.slots();
        for field in self.columns.fields().iter() {
            let column = group.particles.columns.column_mut(field);
            column.resize(field.components(D) * slots, T::zero());
        }
        (group.work).expect_saved(&self.work, &group.particles, slots);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::in_threads;

    /// Slots of a rank: of particles that move by forces, of which there are 60, and of the 40 others.
    fn cut_at(rank: usize, bounds: [[usize; 4]; 2]) -> [Range<usize>; 2] {
        bounds.map(|own| own[rank]..own[rank + 1])
    }

    #[test]
    fn every_number_comes_to_where_the_order_says() {
        let cuts = [
            [[0, 20, 30, 60], [60, 70, 70, 100]],
            [[0, 7, 50, 60], [60, 61, 90, 100]],
        ];
        // Particles keep to their kind, and some are repeated.
        let mixed: Vec<u32> = (0..60)
            .map(|k| k * 37 % 60)
            .chain((0..40).map(|k| 60 + k * 13 % 39))
            .collect();
        let all = in_threads(3, 1, |ranks| {
            let rank = ranks.rank();
            let team = Team::new(ranks);
            let runs: Vec<_> = (0..3)
                .map(|rank| cuts.map(|own| cut_at(rank, own)))
                .collect();
            let [before, after] = runs[rank].clone();
            let column = |runs: &[Range<usize>; 2], order: &[u32]| -> Vec<f64> {
                let slots = runs.iter().cloned().flatten();
                let at = |slot| order.get(slot).map_or(slot, |&old| old as usize);
                slots
                    .flat_map(|slot| [at(slot) as f64, -0.5 * at(slot) as f64])
                    .collect()
            };
            for order in [&mixed[..], &[]] {
                let route = Route::new(&team, &runs, order);
                let carried = route.carry(&column(&before, &[]), 2);
                assert_eq!(carried, column(&after, order));
            }
            let stay = runs
                .iter()
                .map(|own| [own[0].clone(), own[0].clone()])
                .collect::<Vec<_>>();
            let route = Route::new(&team, &stay, &[]);
            assert!(
                route.sends.is_empty(),
                "nothing travels where nothing moves"
            );
            assert_eq!(route.carry(&column(&before, &[]), 2), column(&before, &[]));
        });
        assert_eq!(all.expect("threads").len(), 3);
    }
}
