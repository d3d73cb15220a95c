//! The order of particles along the curve, and the cut of chunks, where each rank has its own particles: who goes to which rank.
//! Ranks find the key at each cut digit by digit; none has the keys of others (histogram sort: Solomonik & Kalé 2010, IPDPS).

use super::group::Group;
use super::migration::{Going, Route};
use super::part::{Part, chunk_slots, runs_of};
use crate::boundary::Pose;
use crate::neighbors::{Grid, corners_of};
use crate::parallel::sort_by_key;
use crate::particles::Field;
use crate::ranks::{Division, Letters, Taken, Team, What, put_number, put_numbers};
use crate::scalar::Real;
use std::ops::Range;
use std::sync::Arc;

/// Bits of a digit, and how many digits there are.
const BITS: u32 = 8;
const DIGITS: usize = 1 << BITS;

/// Own particles of a body in the order of their keys along the curve.
struct Sorted {
    /// The keys, and whose they are.
    keys: Vec<u64>,
    slots: Vec<u32>,
}

/// The first particle of a rank among those of the body in which its part begins.
#[derive(Clone, Copy)]
struct Cut {
    rank: usize,
    body: usize,
    /// How many of the body are before it, in the order of keys and then of slots.
    before: usize,
}

/// Where a rank's part begins among own particles of each body in their order: how many are before each cut.
fn places_of_cuts(team: &Team, cuts: &[Cut], own: &[Sorted], digits: u32) -> Option<Vec<usize>> {
    let (count, rank) = (team.count(), team.rank());
    let mine = cuts.iter().find(|own| own.rank == rank);
    // Of the key at the own cut the digits that are known, and how many with these are before it.
    let (mut key, mut left) = (0_u64, mine.map_or(0, |own| own.before));
    let mut of_ranks = vec![[0; DIGITS]; count];
    let each = vec![1; count];
    for digit in (0..digits).rev() {
        let keys = if digit + 1 == digits {
            vec![0; count]
        } else {
            all_keys(team, key)?
        };
        let shift = digit * BITS;
        let mut counts = vec![[0_u32; DIGITS]; count];
        for cut in cuts {
            let own = &own[cut.body].keys;
            let at =
                |d: u64| own.partition_point(|key| key >> shift < (keys[cut.rank] << BITS) + d);
            for (d, count) in (0..).zip(&mut counts[cut.rank]) {
                *count = (at(d + 1) - at(d)) as u32;
            }
        }
        let letters = Letters::Each(size_of::<[u32; DIGITS]>());
        of_ranks = team.post((&counts, &each), &each, letters)?;
        let sum = |d: usize| of_ranks.iter().map(|own| own[d] as usize).sum::<usize>();
        let mut own = 0;
        while own + 1 < DIGITS && sum(own) <= left {
            left -= sum(own);
            own += 1;
        }
        key = key << BITS | own as u64;
    }
    // Of equal keys those in lower slots are before, which lower ranks have.
    let last = (key % DIGITS as u64) as usize;
    let mut told = Vec::with_capacity(count);
    for own in &of_ranks {
        let equal = left.min(own[last] as usize);
        told.push(if mine.is_some() {
            [key, equal as u64]
        } else {
            [0; 2]
        });
        left -= equal;
    }
    let letters = Letters::Each(size_of::<[u64; 2]>());
    let told = team.post((&told, &each), &each, letters)?;
    let place = |cut: &Cut| {
        let [at, equal] = told[cut.rank];
        own[cut.body].keys.partition_point(|key| *key < at) + equal as usize
    };
    Some(cuts.iter().map(place).collect())
}

/// A number of each rank.
fn all_keys(team: &Team, own: u64) -> Option<Vec<u64>> {
    let mut all = Vec::with_capacity(team.count());
    team.numbers([own], |[own]| all.push(own));
    (all.len() == team.count()).then_some(all)
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Sorts every body along the space-filling curve as [`Particles::sort`](super::Particles::sort) does, where each rank has its own
    /// particles; at the first list build, at a time \[s\], so it does walls.
    pub(super) fn sort_own(&mut self, first: Option<f64>) {
        let Some((team, part)) = self.apart() else {
            return;
        };
        let (team, columns) = (team.clone(), &self.particles.columns);
        let mut corners = [corners_of(columns.vectors(Field::POSITION))];
        team.join_corners(&mut corners, &mut []);
        let spacings = self.particles.bodies.iter().map(|body| body.spacing);
        let grid = Grid::centred(&corners[0].0, spacings.fold(f64::INFINITY, f64::min));
        let Some(mut route) = self.order_of_own(&team, part, &grid) else {
            return;
        };
        // What repeats the last of a body goes where that goes, and walls keep their shape.
        let mut sorted = core::mem::take(&mut route.sources).into_iter();
        let particles = &self.particles;
        for body in &particles.bodies {
            route.sources.extend(sorted.by_ref().take(body.slots.len()));
            let last = route.sources.last().copied();
            route.sources.resize(body.end, last.unwrap_or(0));
        }
        let walls = particles.mobile..particles.columns.slots();
        route.sources.extend(walls.map(|slot| slot as u32));
        self.travel(&route, self.particles.mobile);
        if let Some(time) = first {
            self.sort_walls(&grid, time);
        }
    }

    /// Gives the slots of walls on this rank the particles that sorting whole walls brings there. No particle travels: every rank knows
    /// where all particles of a wall are.
    fn sort_walls(&mut self, grid: &Grid<D>, time: f64) {
        let Some(all) = &self.all else {
            return;
        };
        for (wall, own) in all.walls.iter().zip(&self.walls) {
            let pose = wall.pose(time, None).unwrap_or_else(Pose::rest);
            let places = wall.places(&pose, &self.boundaries, time);
            let mut order: Vec<u32> = (0..places.len() as u32).collect();
            sort_by_key(&mut order, 0, &grid.orders(&places));
            for slot in own.slots.start..own.end {
                let at = all.part.slot_in_group(slot) - wall.slots.start;
                let number = order[at.min(order.len() - 1)];
                self.particles.ids[slot] = own.slots.start as u32 + number;
            }
            own.place(&pose, &mut self.particles, &self.boundaries, time);
        }
    }

    fn order_of_own(&self, team: &Arc<Team>, part: &Part, grid: &Grid<D>) -> Option<Route> {
        let (all, share) = (self.all.as_ref()?, self.share.as_ref()?);
        let (particles, columns) = (&self.particles, &self.particles.columns);
        let positions = columns.vectors(Field::POSITION);
        let sorted = |slots: &Range<usize>| {
            let keys = grid.orders(&positions[slots.clone()]);
            let mut order: Vec<u32> = slots.clone().map(|slot| slot as u32).collect();
            sort_by_key(&mut order, slots.start, &keys);
            let keys = order.iter().map(|slot| keys[*slot as usize - slots.start]);
            Sorted {
                keys: keys.collect(),
                slots: order,
            }
        };
        let own: Vec<Sorted> = particles
            .bodies
            .iter()
            .map(|own| sorted(&own.slots))
            .collect();
        // Where parts begin among the slots of the group.
        let begins = |rank: usize| runs_of::<T>(share.division(), rank, all.slots())[0].start;
        let begins: Vec<usize> = (0..team.count()).map(begins).collect();
        let bodies = &all.particles.bodies;
        let cut_at = |(rank, &slot): (usize, &usize)| {
            let body = bodies.iter().position(|own| own.slots.contains(&slot))?;
            Some(Cut {
                rank,
                body,
                before: slot - bodies[body].slots.start,
            })
        };
        let cuts: Vec<Cut> = begins.iter().enumerate().filter_map(cut_at).collect();
        let digits = (grid.bits() * D as u32).div_ceil(BITS);
        let places = places_of_cuts(team, &cuts, &own, digits)?;
        let mut going = Vec::with_capacity(particles.mobile);
        for (body, own) in own.iter().enumerate() {
            let mut next = cuts
                .iter()
                .zip(&places)
                .filter(|(cut, _)| cut.body == body)
                .peekable();
            let mut to = begins.partition_point(|slot| *slot < bodies[body].slots.start + 1) - 1;
            for (k, (key, slot)) in own.keys.iter().zip(&own.slots).enumerate() {
                while let Some((cut, _)) = next.next_if(|(_, place)| **place <= k) {
                    to = cut.rank;
                }
                let before = part.slot_in_group(*slot as usize) as u32;
                going.push(Going {
                    slot: *slot,
                    to: to as u32,
                    order: [body as u32, (*key >> 32) as u32, *key as u32, before],
                });
            }
        }
        Route::new(team, columns.slots(), &going)
    }

    /// Tells all ranks what own chunks cost, and cuts chunks anew where that pays; whether it did.
    pub(super) fn balance(&mut self) -> bool {
        let Some((team, _)) = self.apart() else {
            return false;
        };
        let team = team.clone();
        let (Some(all), Some(share)) = (&mut self.all, &self.share) else {
            return false;
        };
        let chunks = all.slots().div_ceil(chunk_slots::<T>());
        let of_mobile = all
            .particles
            .mobile
            .div_ceil(chunk_slots::<T>())
            .min(chunks);
        let lists = &self.neighborhood.lists;
        let own: Vec<u32> = lists.costs().into_iter().map(|cost| cost as u32).collect();
        let (mut costs, mut entries) = (vec![0_usize; chunks], 0);
        let put = |to: &mut Vec<u8>| {
            put_number(lists.entries() as u64, to);
            put_numbers(&own, to);
        };
        team.gather(What::Lists, put, |rank, from| {
            let mut from = Taken(from);
            entries += from.number()? as usize;
            for run in share.division().of(rank) {
                let mut own = vec![0_u32; run.len()];
                from.numbers(&mut own)?;
                for (cost, own) in costs[run].iter_mut().zip(own) {
                    *cost = own as usize;
                }
            }
            from.0.is_empty().then_some(())
        });
        all.entries = entries;
        match share
            .better_division(&costs, of_mobile)
            .filter(|_| !team.is_broken())
        {
            Some(new) => self.cut_anew(&team, new),
            None => false,
        }
    }

    /// Goes on with the particles of the chunks that this rank has by another cut.
    fn cut_anew(&mut self, team: &Arc<Team>, new: Division) -> bool {
        let (Some(all), Some(share)) = (&mut self.all, &mut self.share) else {
            return false;
        };
        let runs: Vec<_> = (0..team.count())
            .map(|rank| runs_of::<T>(&new, rank, all.slots()))
            .collect();
        let moving = runs[runs.len() - 1][0].end;
        let part = all.part.clone();
        let going = (0..part.count()).map(|slot| {
            let in_group = part.slot_in_group(slot);
            // Of either kind ranks have ascending runs.
            let kind = usize::from(in_group >= moving);
            Going {
                slot: slot as u32,
                to: runs.partition_point(|own| own[kind].end <= in_group) as u32,
                order: [in_group as u32, 0, 0, 0],
            }
        });
        let going: Vec<_> = going.collect();
        let Some(route) = Route::new(team, part.count(), &going) else {
            return false;
        };
        part.number_walls(&mut self.particles.ids, &all.walls, false);
        let part = Part::of::<T>(team, &new, all.slots());
        let mobile = part.at(all.particles.mobile);
        all.part = Arc::new(part);
        share.set_division(new);
        self.travel(&route, mobile);
        self.place_own();
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::in_threads;

    /// Keys of two bodies, many of them equal, on three ranks: what is before each cut is what is before it in the order of all.
    #[test]
    fn cuts_are_where_the_order_of_all_has_them() {
        const EACH: usize = 200;
        // Three digits, many of them equal.
        let key = |number: usize| ((number as u64 * 7919 + 13) % 97) * 1_001;
        let cuts = [(1, 0, 57), (2, 1, 111)].map(|(rank, body, before)| Cut { rank, body, before });
        let all = in_threads(3, 1, |ranks| {
            let (rank, team) = (ranks.rank(), Team::new(ranks));
            // Slots of each body in three runs.
            let own = [0, 1].map(|body| {
                let first = body * EACH;
                let run = first + rank * EACH / 3..first + (rank + 1) * EACH / 3;
                let mut slots: Vec<u32> = run.map(|slot| slot as u32).collect();
                slots.sort_by_key(|slot| key(*slot as usize));
                let keys = slots.iter().map(|slot| key(*slot as usize)).collect();
                Sorted { keys, slots }
            });
            let places = places_of_cuts(&team, &cuts, &own, 3).expect("places");
            for (cut, place) in cuts.iter().zip(places) {
                let mut order: Vec<usize> = (cut.body * EACH..(cut.body + 1) * EACH).collect();
                order.sort_by_key(|slot| key(*slot));
                let before = &order[..cut.before];
                let own = &own[cut.body].slots;
                let is_before = |slot: &u32| before.contains(&(*slot as usize));
                assert!(own[..place].iter().all(is_before), "{place}");
                assert!(!own[place..].iter().any(is_before), "{place}");
            }
        });
        assert_eq!(all.expect("threads").len(), 3);
    }
}
