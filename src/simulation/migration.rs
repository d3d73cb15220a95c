//! The way of particles to other ranks at a list build: each number goes from the rank that has it to the one that gets it.
//! Each is told by its place in the order of all, by which those that come find theirs.

use super::group::Group;
use crate::ranks::{Letters, Plain, Taken, Team, put_numbers};
use crate::scalar::Real;
use crate::sweep::Results;
use core::mem::take;
use std::ops::Range;
use std::sync::Arc;

/// A particle of this rank, the rank that it goes to, and its place in the order of all.
pub(super) struct Going {
    pub slot: u32,
    pub to: u32,
    pub order: [u32; 4],
}

/// Who sends which of its particles to whom.
pub(super) struct Route {
    team: Arc<Team>,
    /// Particles that this rank sends, rank by rank, and how many each gets and gives.
    sends: Vec<u32>,
    to: Vec<usize>,
    from: Vec<usize>,
    /// How many it had.
    had: usize,
    /// Where each particle of this rank stands, in their order: among those that it had, or behind these among those that come.
    pub sources: Vec<u32>,
}

impl Route {
    /// From where each particle of this rank, which has so many slots, goes, in their order; none where a rank has failed.
    pub fn new(team: &Arc<Team>, had: usize, own: &[Going]) -> Option<Self> {
        let stays = |own: &Going| own.to as usize == team.rank();
        let mut leave: Vec<&Going> = own.iter().filter(|own| !stays(own)).collect();
        leave.sort_by_key(|own| own.to);
        let mut to = vec![0; team.count()];
        for own in &leave {
            to[own.to as usize] += 1;
        }
        let orders: Vec<[u32; 4]> = leave.iter().map(|own| own.order).collect();
        let (orders, from) = team.letters((&orders, &to), Letters::Moved);
        team.count_travel();
        if team.is_broken() {
            return None;
        }
        let mut come: Vec<_> = orders.into_iter().zip(had as u32..).collect();
        come.sort_unstable();
        let mut come = come.into_iter().peekable();
        let mut sources = Vec::with_capacity(own.len() - leave.len() + come.len());
        for own in own.iter().filter(|own| stays(own)) {
            while let Some((_, source)) = come.next_if(|(order, _)| *order < own.order) {
                sources.push(source);
            }
            sources.push(own.slot);
        }
        sources.extend(come.map(|own| own.1));
        Some(Self {
            team: team.clone(),
            sends: leave.iter().map(|own| own.slot).collect(),
            to,
            from,
            had,
            sources,
        })
    }

    /// Columns of the particles that this rank gets, and what they are known by, from those of the particles that it had. A column has
    /// so many numbers of each, or none of any.
    fn carry<T: Real>(&self, own: Vec<(Vec<T>, usize)>, ids: &[u32]) -> (Vec<Vec<T>>, Vec<u32>) {
        let there = || own.iter().filter(|own| !own.0.is_empty());
        let (mut sent, mut rest) = (Vec::new(), &self.sends[..]);
        for &count in &self.to {
            let slots;
            (slots, rest) = rest.split_at(count);
            for &slot in slots {
                put_numbers(&ids[at(slot, 1)], &mut sent);
            }
            for (column, width) in there() {
                for &slot in slots {
                    put_numbers(&column[at(slot, *width)], &mut sent);
                }
            }
        }
        let widths = there().map(|own| own.1);
        let each = size_of::<u32>() + widths.sum::<usize>() * size_of::<T>();
        let kind = (each, Letters::Moved);
        let come = (self.team).post_bytes((&sent, &self.to), &self.from, kind);
        // Nothing is read of what comes where a rank has failed.
        let come = come.unwrap_or_else(|| vec![0; each * self.from.iter().sum::<usize>()]);
        let mut rest = &come[..];
        let mut letters: Vec<Taken<'_>> = (self.from.iter())
            .map(|count| Taken(rest.split_off(..each * count).unwrap_or_default()))
            .collect();
        let ids = self.arrange(ids, 1, &mut letters);
        let column = |(own, width): (Vec<T>, usize)| {
            if own.is_empty() {
                return own;
            }
            self.arrange(&own, width, &mut letters)
        };
        (own.into_iter().map(column).collect(), ids)
    }

    /// A column in the order of the particles that this rank gets, whose letters begin with those that come.
    fn arrange<V: Plain>(&self, own: &[V], width: usize, letters: &mut [Taken<'_>]) -> Vec<V> {
        let mut come = Vec::new();
        for (letter, count) in letters.iter_mut().zip(&self.from) {
            let _ = letter.more(width * count, &mut come);
        }
        let mut all = Vec::with_capacity(width * self.sources.len());
        for &source in &self.sources {
            all.extend_from_slice(match (source as usize).checked_sub(self.had) {
                None => &own[at(source, width)],
                Some(k) => &come[at(k as u32, width)],
            });
        }
        all
    }
}

/// The numbers of a slot in a column that has so many of each.
fn at(slot: u32, width: usize) -> Range<usize> {
    slot as usize * width..(slot as usize + 1) * width
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Goes on with the particles that come by a route, of which the first `mobile` ones move by forces.
    pub(super) fn travel(&mut self, route: &Route, mobile: usize) {
        let (particles, work) = (&mut self.particles, &mut self.work);
        work.forget_taken_back();
        let mut own = Vec::new();
        for field in particles.columns.fields().iter() {
            let column = take(particles.columns.column_mut(field));
            own.push((column, field.components(D)));
        }
        for sums in work.sums_mut() {
            let outputs = sums.outputs();
            own.push((sums.numbers(route.had), outputs.width(D)));
            // Nothing tells the chunks of forces between blocks.
            let forces = sums.reactions().copied().collect();
            *sums = Results::of_rows(outputs, &[], forces);
        }
        for (field, column) in work.saved_mut() {
            own.push((take(column), field.components(D)));
        }
        let (come, ids) = route.carry(own, &particles.ids);
        let mut come = come.into_iter();
        let mut next = || come.next().unwrap_or_default();
        for field in particles.columns.fields().iter() {
            *particles.columns.column_mut(field) = next();
        }
        particles.columns.set_slots(route.sources.len());
        particles.ids = ids;
        for sums in work.sums_mut() {
            let (outputs, numbers) = (sums.outputs(), next());
            let forces = sums.reactions().copied().collect();
            *sums = Results::of_rows(outputs, &numbers[..outputs.width(D) * mobile], forces);
        }
        work.saved_mut().for_each(|(_, column)| *column = next());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::in_threads;

    #[test]
    fn every_number_comes_to_where_the_order_says() {
        // Where the part of each rank begins before and after.
        let cuts = [[0, 20, 30, 60], [0, 7, 50, 60]];
        let all = in_threads(3, 1, |ranks| {
            let (rank, team) = (ranks.rank(), Arc::new(Team::new(ranks)));
            let own = cuts[0][rank]..cuts[0][rank + 1];
            let place = |number: usize| number * 37 % 60;
            let going = own.clone().map(|number| Going {
                slot: (number - own.start) as u32,
                to: cuts[1].partition_point(|first| *first <= place(number)) as u32 - 1,
                order: [0, 0, place(number) as u32, 0],
            });
            let mut going: Vec<_> = going.collect();
            going.sort_by_key(|own| own.order);
            let route = Route::new(&team, own.len(), &going).expect("a route");
            let column = |numbers: &mut dyn Iterator<Item = usize>| -> Vec<f64> {
                numbers.flat_map(|k| [k as f64, -0.5 * k as f64]).collect()
            };
            let ids: Vec<u32> = own.clone().map(|number| number as u32).collect();
            let columns = vec![(column(&mut own.clone()), 2), (Vec::new(), 3)];
            let (carried, ids) = route.carry(columns, &ids);
            let mut come: Vec<usize> = (0..60).collect();
            come.sort_by_key(|number| place(*number));
            let come = &come[cuts[1][rank]..cuts[1][rank + 1]];
            assert_eq!(carried, [column(&mut come.iter().copied()), Vec::new()]);
            assert!(ids.into_iter().eq(come.iter().map(|number| *number as u32)));
            // Nothing travels where nothing moves.
            let stay = (0..own.len()).map(|slot| Going {
                slot: slot as u32,
                to: rank as u32,
                order: [slot as u32, 0, 0, 0],
            });
            let stay: Vec<_> = stay.collect();
            let route = Route::new(&team, own.len(), &stay).expect("a route");
            assert!(route.sends.is_empty());
            let (all, _) = route.carry(vec![(vec![2.0_f64; own.len()], 1)], &[0; 60]);
            assert_eq!(all, [vec![2.0; own.len()]]);
        });
        assert_eq!(all.expect("threads").len(), 3);
    }
}
