//! The points of a block that are within reach of a row of particles: cells near the row, and then their points.
//! Points are looked at in rows, whose places lie axis by axis, each against all particles of the row.

use super::cells::{Cells, Grid};
use super::clusters::{Radii, SearchInput};
use crate::collective::Corners;
use crate::scalar::{Lane, MOST_LANES, Mask, OnRows, Real};
use core::ops::Range;

/// A block of which some particles are here.
pub(crate) struct LocalBlock<const D: usize> {
    /// These, by their numbers here, in the order of the whole block.
    pub(crate) points: Vec<u32>,
    /// The largest support radius and the box of each part of the whole block by its support radii.
    pub(crate) parts: Vec<(f64, Corners<D>)>,
}

/// Particles of a block, as the search for neighbours meets them.
pub(super) struct Source<T, const D: usize> {
    cells: Cells<D>,
    /// Slots in the order of the cells, and what fills the last row of an instruction.
    slots: Vec<u32>,
    /// Their positions, axis by axis.
    positions: [Vec<T>; D],
    /// Their support radii, where they are not all the same.
    radii: Vec<T>,
    /// The largest support radius.
    pub(super) largest: f64,
}

/// Parts of a block by its support radii, at most so many: what is narrower than this share of the widest of a part is left to
/// the next.
pub(super) const PARTS: usize = 8;
pub(super) const NARROWER: f64 = 0.75;

/// Leaves to the next part of a block, behind so many, what is too narrow for this one.
pub(crate) fn leave_narrow(
    points: &mut Vec<u32>,
    (before, largest): (usize, f64),
    radius: impl Fn(u32) -> f64,
) -> Vec<u32> {
    let mut rest = Vec::new();
    if before + 1 < PARTS {
        let narrow = |p: &u32| radius(*p) < NARROWER * largest;
        rest.extend(points.iter().copied().filter(narrow));
        points.retain(|p| !narrow(p));
    }
    rest
}

impl<T: Real, const D: usize> Source<T, D> {
    /// The particles of a block, those of wide support apart from the others: few particles that reach far, as gas behind a
    /// blast does, would else have all others searched for as far away as they reach.
    pub(super) fn of_block(
        input: &SearchInput<'_, T, D>,
        block: usize,
        local: Option<&LocalBlock<D>>,
    ) -> Vec<Self> {
        let blocks = input.blocks.len();
        let wanted = (0..blocks).any(|own| input.lists(own, block));
        let slots = input.blocks[block].slots.clone();
        let mut points: Vec<u32> = match local {
            _ if !wanted => Vec::new(),
            Some(own) => own.points.clone(),
            None => (slots.start as u32..slots.end as u32).collect(),
        };
        // Where others are elsewhere all are known to be in so wide parts.
        let part = |k: usize| local.and_then(|own| own.parts.get(k));
        let Radii::Varying(..) = input.radii else {
            return vec![Self::new(input, &points, input.radii.of(0), part(0))];
        };
        let widest = |points: &[u32]| {
            let radii = points.iter().map(|&p| input.radii.of(p as usize));
            radii.fold(0.0_f64, f64::max)
        };
        let mut parts = Vec::new();
        loop {
            let known = part(parts.len());
            let largest = known.map_or_else(|| widest(&points), |own| own.0);
            let radius = |p: u32| input.radii.of(p as usize);
            let rest = leave_narrow(&mut points, (parts.len(), largest), radius);
            parts.push(Self::new(input, &points, largest, known));
            if rest.is_empty() {
                return parts;
            }
            points = rest;
        }
    }

    fn new(
        input: &SearchInput<'_, T, D>,
        points: &[u32],
        largest: f64,
        known: Option<&(f64, Corners<D>)>,
    ) -> Self {
        let reach = largest + input.skin;
        // Cells of half the reach fit the boxes of clusters better than cells of the full reach.
        let size = if D == 1 { reach } else { 0.5 * reach };
        let chosen: Vec<[T; D]> = (points.iter())
            .map(|&p| input.positions[p as usize])
            .collect();
        let grid = match known {
            Some((_, Corners(corners))) => Grid::over(corners, size),
            None => Grid::over(&chosen, size),
        };
        let cells = Cells::in_grid(grid, &chosen, points);
        drop(chosen);
        let mut slots = cells.points().to_vec();
        slots.resize(slots.len() + MOST_LANES, 0);
        let mut positions = core::array::from_fn(|_| vec![T::zero(); slots.len()]);
        let along = positions.each_mut();
        for (k, &slot) in slots[..points.len()].iter().enumerate() {
            let x = &input.positions[slot as usize];
            for d in 0..D {
                along[d][k] = x[d];
            }
        }
        let mut radii = Vec::new();
        if let Radii::Varying(..) = input.radii {
            radii.extend(
                slots
                    .iter()
                    .map(|&slot| T::from_f64(input.radii.of(slot as usize))),
            );
        }
        Self {
            cells,
            slots,
            positions,
            radii,
            largest,
        }
    }
}

/// Points in cells near a row of particles, run after run.
pub(super) struct Candidates<T, const D: usize> {
    /// Where the runs stand among the points of the source.
    runs: Vec<Range<usize>>,
    slots: Vec<u32>,
    positions: [Vec<T>; D],
    /// Support radii, where they are not all the same.
    radii: Vec<T>,
}

impl<T, const D: usize> Default for Candidates<T, D> {
    fn default() -> Self {
        Self {
            runs: Vec::new(),
            slots: Vec::new(),
            positions: core::array::from_fn(|_| Vec::new()),
            radii: Vec::new(),
        }
    }
}

impl<T: Real, const D: usize> Candidates<T, D> {
    /// Takes the runs of a source's points that may be within reach of a box, and makes room for them.
    pub(super) fn choose(
        &mut self,
        source: &Source<T, D>,
        low: [f64; D],
        high: [f64; D],
        reach: f64,
    ) {
        let Self {
            runs,
            slots,
            positions,
            radii,
        } = self;
        runs.clear();
        let mut most = MOST_LANES;
        // As much as rounding may add to a reach in `f32`.
        source
            .cells
            .for_each_range_near(low, high, reach * (1.0 + 1e-6), |run| {
                most += run.len();
                runs.push(run);
            });
        grow(slots, most);
        for along in positions {
            grow(along, most);
        }
        if !source.radii.is_empty() {
            grow(radii, most);
        }
    }
}

/// Room for so many, with whatever is in it.
fn grow<V: Copy + Default>(room: &mut Vec<V>, most: usize) {
    if room.len() < most {
        room.resize(most, V::default());
    }
}

/// A row of particles against candidates.
pub(super) struct Sieve<'a, T, const D: usize> {
    pub(super) input: &'a SearchInput<'a, T, D>,
    /// Places of the row.
    pub(super) row: &'a [[T; D]],
    /// Its widest support radius.
    pub(super) radius: f64,
    /// How far a pair reaches, with the skin.
    pub(super) reach: f64,
    pub(super) source: &'a Source<T, D>,
    pub(super) candidates: &'a mut Candidates<T, D>,
    pub(super) found: &'a mut Vec<u32>,
    pub(super) leaving: &'a mut Vec<u32>,
}

impl<T: Real, const D: usize> OnRows<T> for Sieve<'_, T, D> {
    type Output = ();
    /// Adds the candidates that are within reach of any of the row: to `leaving` those that may leave the support by the
    /// time the skin is used up, and to `found` the others.
    #[inline(always)]
    fn run<L: Lane<Scalar = T, Broadcast = T>>(self) {
        const { assert!(L::WIDTH <= MOST_LANES) };
        let skin = self.input.skin;
        let Candidates {
            runs,
            slots,
            positions,
            radii,
        } = self.candidates;
        let varying = !self.source.radii.is_empty();
        // Places of memory that the compiler keeps in registers.
        let (slots, radii) = (&mut slots[..], &mut radii[..]);
        let x_of = positions.each_mut().map(|along| &mut along[..]);
        let mut count = 0;
        for run in runs.iter() {
            for k in run.clone().step_by(L::WIDTH) {
                // The next run is put over what is too much.
                let to = count + (k - run.start);
                for d in 0..D {
                    L::load(&self.source.positions[d][k..]).store(&mut x_of[d][to..]);
                }
                slots[to..to + L::WIDTH].copy_from_slice(&self.source.slots[k..k + L::WIDTH]);
                if varying {
                    L::load(&self.source.radii[k..]).store(&mut radii[to..]);
                }
            }
            count += run.len();
        }
        x_of[0][count..count + L::WIDTH].fill(T::from_f64(f64::INFINITY));
        let (found_before, leaving_before) = (self.found.len(), self.leaving.len());
        self.found.resize(found_before + count + L::WIDTH, 0);
        self.leaving.resize(leaving_before + count + L::WIDTH, 0);
        let found = &mut self.found[found_before..];
        let leaving = &mut self.leaving[leaving_before..];
        let (mut found_count, mut leaving_count) = (0, 0);
        let uniform = squares::<T>(self.reach, skin);
        let widest = L::of(self.radius);
        for first in (0..count).step_by(L::WIDTH) {
            let (mut x, mut least) = ([L::zero(); D], L::of(f64::INFINITY));
            for d in 0..D {
                x[d] = L::load(&x_of[d][first..]);
            }
            for y in self.row {
                let mut r2 = L::zero();
                for d in 0..D {
                    let r = x[d] - L::splat(y[d]);
                    r2 = r.mul_add(r, r2);
                }
                least = r2.min(least);
            }
            let own = &slots[first..first + L::WIDTH];
            let [mut reach2, mut stays2] = [L::splat(uniform[0]), L::splat(uniform[1])];
            if varying {
                let reach = L::load(&radii[first..]).max(widest) + L::of(skin);
                let stays = (reach - L::of(2.0 * skin)).positive_part();
                (reach2, stays2) = (reach * reach * L::of(1.0 + rounding::<T>()), stays * stays);
            }
            let (any, stays) = (least.le(reach2), least.lt(stays2));
            // Who stays is within reach, too.
            found_count += stays.choose(own, &mut found[found_count..]);
            leaving_count += (any & !stays).choose(own, &mut leaving[leaving_count..]);
        }
        self.found.truncate(found_before + found_count);
        self.leaving.truncate(leaving_before + leaving_count);
    }
}

/// What the square of a reach is raised by, so that rounding leaves out none.
fn rounding<T: Real>() -> f64 {
    if T::COMPENSATED { 1e-6 } else { 1e-15 }
}

/// The squares of a reach with its skin, and of what is left of it when the skin is used up.
fn squares<T: Real>(reach: f64, skin: f64) -> [T; 2] {
    let stays = (reach - 2.0 * skin).max(0.0);
    [
        T::from_f64(reach * reach * (1.0 + rounding::<T>())),
        T::from_f64(stays * stays),
    ]
}
