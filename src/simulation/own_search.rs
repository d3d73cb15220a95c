//! The search for neighbours where each rank has its own particles: it gets those of others that are within reach of the boxes around
//! its own. Each block is searched in cells of the box of all of its particles, and in the order of all, so lists are those of one process.

use super::group::Group;
use super::neighborhood::Neighborhood;
use super::part::{Halo, Part, chunk_slots};
use crate::collective::{Corners, Join};
use crate::neighbors::{LocalBlock, corners_of, leave_narrow};
use crate::ranks::{Letters, Taken, Team, What, even, put_numbers};
use crate::scalar::Real;
use crate::sweep::Image;
use core::mem::take;
use std::ops::Range;
use std::sync::Arc;

/// Runs of particles of a rank, which follow each other on the curve, and boxes around each, apart from each other as where some have
/// re-entered a period.
const RUNS: usize = 16;
const BOXES: usize = 4;

/// By how much more than the reach is within reach: what rounding may add to a distance.
const ROUNDING: f64 = 1.0 + 1e-5;

/// Particles of other ranks, rank by rank.
struct Candidates<T, const D: usize> {
    /// Their slots in the group.
    slots: Vec<u32>,
    places: Vec<[T; D]>,
    /// Their smoothing lengths, where they are not all the same.
    lengths: Vec<T>,
    /// How many there are of each rank.
    from: Vec<usize>,
}

/// Adds a run of slots that begins where the last one ends, or behind it.
fn add_run(runs: &mut Vec<Range<usize>>, run: Range<usize>) {
    match runs.last_mut() {
        Some(last) if last.end == run.start => last.end = run.end,
        _ => runs.push(run),
    }
}

/// Whether boxes are within a distance of each other.
fn is_near<const D: usize>(a: &Corners<D>, b: &Corners<D>, distance: f64) -> bool {
    let apart = |d: usize| (a.0[0][d] - b.0[1][d]).max(b.0[0][d] - a.0[1][d]).max(0.0);
    let apart2: f64 = (0..D).map(|d| apart(d).powi(2)).sum();
    apart2 <= distance * distance
}

/// Boxes around all of these places \[m\], a few where some are farther than the reach from others.
fn boxes_of<T: Real, const D: usize>(places: &[[T; D]], reach: f64) -> Vec<Corners<D>> {
    let mut boxes: Vec<Corners<D>> = Vec::new();
    for x in places {
        let x = Corners::at(x.map(Real::to_f64));
        match boxes.iter().rposition(|own| is_near(&x, own, reach)) {
            None if boxes.len() < BOXES => boxes.push(x),
            near => {
                let own = &mut boxes[near.unwrap_or(0)];
                *own = own.and(x);
            }
        }
    }
    boxes
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Lists the neighbours of own particles where they are listed, with images within `reach` \[m\] at a time \[s\]. Returns the slots
    /// of its ghosts in the group. All ranks do so at once.
    pub(super) fn list_own(&mut self, at: (f64, f64)) -> Vec<u32> {
        let Some((team, part)) = self.apart() else {
            return Vec::new();
        };
        let (team, mut part) = (team.clone(), part.clone());
        let boundaries = self.boundaries.clone();
        let near = &mut self.neighborhood;
        near.place_blocks(&self.particles, &self.walls, &boundaries, at);
        let parts = near.parts_of_blocks(&team);
        let others = near.candidates(&team, &part, at.1);
        let points = self.points_of_blocks(&part, &others.slots);
        let near = &mut self.neighborhood;
        near.add(&others, (part.count(), points.len()));
        let walls = self.walls.iter().map(Some);
        let kinds = self.particles.bodies.iter().map(|_| None).chain(walls);
        near.place_images(
            points.iter().map(|own| own.iter().copied()).zip(kinds),
            &boundaries,
            at.0,
        );
        let images = near.blocks[points.len()..].iter();
        let images = images.map(|own| (own.slots.start as u32..own.slots.end as u32).collect());
        let blocks = points.into_iter().chain(images).zip(parts);
        let blocks: Vec<_> = blocks
            .map(|(points, parts)| LocalBlock { points, parts })
            .collect();
        near.search_own(&blocks, (self.instructions, part.count()));
        let ghosts = near.forget_unnamed(&mut part, &others);
        if let Some(all) = &mut self.all {
            let halo = Halo::new(&team, (&ghosts.0, ghosts.1), |slot| part.at(slot));
            part.halo = Arc::new(halo);
            all.part = Arc::new(part);
        }
        ghosts.0
    }

    /// The particles of each body and wall that are here, by their numbers, in the order of the group.
    fn points_of_blocks(&self, part: &Part, others: &[u32]) -> Vec<Vec<u32>> {
        let Some(all) = &self.all else {
            return Vec::new();
        };
        let count = part.count();
        let mut sorted: Vec<u32> = (0..others.len() as u32).collect();
        sorted.sort_unstable_by_key(|own| others[*own as usize]);
        let slot_of = |number: u32| match (number as usize).checked_sub(count) {
            None => part.slot_in_group(number as usize) as u32,
            Some(other) => others[other],
        };
        let bodies = all.particles.bodies.iter().map(|own| &own.slots);
        let of_block = |slots: &Range<usize>| {
            let own = part.within(slots);
            let at =
                |slot: usize| sorted.partition_point(|own| (others[*own as usize] as usize) < slot);
            let others = sorted[at(slots.start)..at(slots.end)].iter();
            let mut points: Vec<u32> = (own.start as u32..own.end as u32).collect();
            points.extend(others.map(|own| count as u32 + own));
            // Two runs or three.
            points.sort_by_key(|number| slot_of(*number));
            points
        };
        bodies
            .chain(all.walls.iter().map(|own| &own.slots))
            .map(of_block)
            .collect()
    }
}

impl<T: Real, const D: usize> Neighborhood<T, D> {
    /// The widest support radius and the box of each part of each block, of the particles of all ranks.
    fn parts_of_blocks(&self, team: &Team) -> Vec<Vec<(f64, Corners<D>)>> {
        let slots = |k: usize| self.blocks[k].slots.clone();
        let mut rest: Vec<Vec<u32>> = (0..self.blocks.len())
            .map(|k| slots(k).map(|own| own as u32).collect())
            .collect();
        let varies = !self.listed_h.is_empty();
        let radius = |p: u32| match self.listed_h.get(p as usize) {
            Some(h) => h.to_f64() * self.support,
            None => self.support * self.smoothing_length,
        };
        let widest = |points: &Vec<u32>| points.iter().map(|p| radius(*p)).fold(0.0, f64::max);
        let mut largest: Vec<f64> = rest.iter().map(widest).collect();
        if varies {
            team.raise(&mut largest);
        }
        let mut parts = vec![Vec::new(); self.blocks.len()];
        for before in 0.. {
            let mut boxes = Vec::new();
            for (points, largest) in rest.iter_mut().zip(&largest) {
                let narrow = leave_narrow(points, (before, *largest), radius);
                let own = core::mem::replace(points, narrow);
                let own: Vec<[T; D]> = own.iter().map(|p| self.listed[*p as usize]).collect();
                boxes.push(corners_of(&own));
            }
            let mut next: Vec<f64> = rest.iter().map(widest).collect();
            team.join_corners(&mut boxes, &mut next);
            for ((parts, largest), own) in parts.iter_mut().zip(&largest).zip(boxes) {
                parts.push((*largest, own));
            }
            if next.iter().all(|widest| *widest == 0.0) {
                break;
            }
            largest = next;
        }
        parts
    }

    /// Sends others what of this rank is within `reach` \[m\] of theirs, itself or by an image, and gets what is of its own.
    fn candidates(&self, team: &Team, part: &Part, reach: f64) -> Candidates<T, D> {
        let (count, reach) = (part.count(), reach * ROUNDING);
        let chunks = count.div_ceil(chunk_slots::<T>());
        let runs: Vec<Range<usize>> = (0..RUNS.min(chunks))
            .map(|k| even(chunks, k, RUNS.min(chunks)))
            .map(|own| own.start * chunk_slots::<T>()..(own.end * chunk_slots::<T>()).min(count))
            .collect();
        let own: Vec<Vec<Corners<D>>> = (runs.iter().cloned())
            .map(|run| boxes_of(&self.listed[run], reach))
            .collect();
        let mut boxes: Vec<Vec<Corners<D>>> = vec![Vec::new(); team.count()];
        let put = |to: &mut Vec<u8>| {
            let own = own.iter().flatten();
            own.for_each(|own| put_numbers(&own.0, to));
        };
        team.gather(What::Numbers, put, |rank, from| {
            let mut all = Vec::new();
            Taken(from).more(from.len() / size_of::<[[f64; D]; 2]>(), &mut all)?;
            boxes[rank].extend(all.into_iter().map(Corners));
            Some(())
        });
        let of_images = corners_of(&self.listed[count..]);
        let (mut sends, mut to) = (Vec::new(), Vec::new());
        for (rank, others) in boxes.iter().enumerate() {
            let mut slots = Vec::new();
            let meets = |x: &[T; D], others: &[&Corners<D>]| {
                let x = Corners::at(x.map(Real::to_f64));
                others.iter().any(|own| is_near(&x, own, reach))
            };
            if rank != team.rank() {
                for (run, own) in runs.iter().zip(&own) {
                    let is_met =
                        |other: &&Corners<D>| own.iter().any(|own| is_near(own, other, reach));
                    let others = others.iter().filter(is_met);
                    let others: Vec<_> = others.collect();
                    let near = run
                        .clone()
                        .filter(|slot| meets(&self.listed[*slot], &others));
                    slots.extend(near.map(|slot| slot as u32));
                }
                let others = others
                    .iter()
                    .filter(|other| is_near(&of_images, other, reach));
                let others: Vec<_> = others.collect();
                let images = self.images.iter().zip(&self.listed[count..]);
                let near = images.filter(|(_, x)| meets(x, &others));
                slots.extend(near.map(|(image, _)| image.source));
                slots.sort_unstable();
                slots.dedup();
            }
            to.push(slots.len());
            sends.append(&mut slots);
        }
        let from = team.counts(&to);
        let mut letters = Vec::new();
        for slot in sends.iter().map(|own| *own as usize) {
            put_numbers(&[part.slot_in_group(slot) as u32], &mut letters);
            put_numbers(&[self.listed[slot]], &mut letters);
            put_numbers(
                self.listed_h.get(slot..=slot).unwrap_or_default(),
                &mut letters,
            );
        }
        let widths = D + usize::from(!self.listed_h.is_empty());
        let each = size_of::<u32>() + widths * size_of::<T>();
        let come = team.post_bytes((&letters, &to), &from, (each, Letters::Ghosts(each)));
        let mut others = Candidates {
            slots: Vec::new(),
            places: Vec::new(),
            lengths: Vec::new(),
            from: come
                .as_ref()
                .map_or_else(|| vec![0; team.count()], |_| from),
        };
        let mut come = Taken(come.as_deref().unwrap_or_default());
        while let (Some(()), Some(())) = (
            come.more(1, &mut others.slots),
            come.more(1, &mut others.places),
        ) {
            let _ = come.more(widths - D, &mut others.lengths);
        }
        others
    }

    /// Numbers particles of other ranks behind so many of its own, which are so many blocks, without images.
    fn add(&mut self, others: &Candidates<T, D>, (count, blocks): (usize, usize)) {
        let listed = Arc::make_mut(&mut self.listed);
        listed.truncate(count);
        listed.extend_from_slice(&others.places);
        if !self.listed_h.is_empty() {
            self.listed_h.truncate(count);
            self.listed_h.extend_from_slice(&others.lengths);
        }
        self.blocks.truncate(blocks);
        self.mirrored.truncate(blocks);
    }

    /// Forgets others and images that no list names, gives the rest the next numbers, and finds which chunks name others. The slots of
    /// ghosts in the group, and how many there are of each rank.
    fn forget_unnamed(
        &mut self,
        part: &mut Part,
        others: &Candidates<T, D>,
    ) -> (Vec<u32>, Vec<usize>) {
        let (count, behind) = (part.count(), part.count() + others.slots.len());
        let mut is_named = vec![false; self.listed.len()];
        part.inner_and_outer = [Vec::new(), Vec::new()];
        for (chunk, list) in self.lists.chunks().iter().enumerate() {
            let mut is_outer = false;
            for &j in &list.neighbors {
                is_named[j as usize] = true;
                is_outer |= j as usize >= count;
            }
            let size = chunk_slots::<T>();
            let slots = chunk * size..(chunk + 1) * size;
            add_run(&mut part.inner_and_outer[usize::from(is_outer)], slots);
        }
        for (image, k) in self.images.iter().zip(behind..) {
            is_named[image.source as usize] |= is_named[k];
        }
        is_named[..count].fill(true);
        let mut numbers = vec![u32::MAX; self.listed.len()];
        let (mut next, listed) = (0, Arc::make_mut(&mut self.listed));
        for k in (0..listed.len()).filter(|k| is_named[*k]) {
            numbers[k] = next;
            listed[next as usize] = listed[k];
            next += 1;
        }
        listed.truncate(next as usize);
        listed.shrink_to_fit();
        self.listed_h.truncate(count);
        Arc::make_mut(&mut self.lists).renumber(|j| numbers[j as usize]);
        // A block of images begins with its first named one.
        let at = |slot: usize| {
            let behind = numbers[slot..].iter().find(|own| **own != u32::MAX);
            behind.map_or(next as usize, |own| *own as usize)
        };
        for block in self
            .blocks
            .iter_mut()
            .filter(|own| own.slots.start >= behind)
        {
            block.slots = at(block.slots.start)..at(block.slots.end);
        }
        let images = take(&mut self.images);
        part.of_own = (images.iter().copied())
            .filter(|own| (own.source as usize) < count)
            .collect();
        let shown = images
            .into_iter()
            .zip(behind..)
            .filter(|own| is_named[own.1]);
        let here = |(own, _): (Image, usize)| Image {
            source: numbers[own.source as usize],
            ..own
        };
        self.images = shown.map(here).collect();
        let is_ghost = |own: &usize| is_named[count + own];
        let mut first = 0;
        let from = others.from.iter().map(|own| {
            first += own;
            (first - own..first).filter(is_ghost).count()
        });
        let from = from.collect();
        let ghosts = (0..others.slots.len()).filter(is_ghost);
        (ghosts.map(|own| others.slots[own]).collect(), from)
    }
}
