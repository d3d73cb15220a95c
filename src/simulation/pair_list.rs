//! The pairs of a coupling that may be within reach: found in cells of the one side, and numbered by their particles.
//! A list serves until both sides together have moved by its skin.

use super::images::PairImages;
use super::side::Listed;
use crate::collective::{Collective, Corners, Join};
use crate::coupling::{Anchor, CoupledParticle};
use crate::neighbors::Cells;
use crate::scalar::Real;

/// Pairs that may be within reach, and the particles in them. It follows from positions.
#[derive(Clone, Debug)]
pub(crate) struct PairList<T: Real, const D: usize> {
    /// Particles in pairs by their numbers in the body: of the first side up to `split`, then of the second.
    pub rows: Vec<u32>,
    pub split: usize,
    /// Pairs of rows, in the order of the particles' numbers.
    pub pairs: Vec<[u32; 2]>,
    /// Where all particles of both sides were \[m\], by number, and then their images; empty before the first list.
    pub listed: [Listed<D>; 2],
    /// How far both sides together may move before it is made anew \[m\].
    pub skin: f64,
    pub particles: Vec<CoupledParticle<T, D>>,
    pub forces: Vec<[T; D]>,
    /// The force \[N\] of boundaries on both sides, boundary by boundary.
    pub given: [Vec<Collective<[f64; D]>>; 2],
    pub anchors: Vec<([u64; 2], Anchor<T, D>)>,
    pub near: [Vec<u32>; 2],
    pub found: Vec<[u32; 2]>,
    pub row_of: Vec<u32>,
    /// Images that are listed behind the particles.
    pub images: PairImages<T, D>,
    /// Of rows that are images: the row of the particle (`u32::MAX` if it is in no pair), and the chain.
    pub image_rows: Vec<Option<[u32; 2]>>,
    /// When it was made \[s\].
    pub time: f64,
}

impl<T: Real, const D: usize> Default for PairList<T, D> {
    fn default() -> Self {
        Self {
            rows: Vec::new(),
            split: 0,
            pairs: Vec::new(),
            listed: [Listed::default(), Listed::default()],
            skin: 0.0,
            particles: Vec::new(),
            forces: Vec::new(),
            given: [Vec::new(), Vec::new()],
            anchors: Vec::new(),
            near: [Vec::new(), Vec::new()],
            found: Vec::new(),
            row_of: Vec::new(),
            images: PairImages::default(),
            image_rows: Vec::new(),
            time: 0.0,
        }
    }
}

/// The box around points, by number, that are there.
fn extent<const D: usize>(points: &[[f64; D]], of: impl Iterator<Item = u32>) -> [[f64; D]; 2] {
    let boxes = of.map(|id| Corners::at(points[id as usize]));
    boxes.fold(Corners::NONE, Join::and).0
}

impl<T: Real, const D: usize> PairList<T, D> {
    /// Finds pairs of particles nearer than `reach` \[m\] by where they are listed.
    pub fn find(&mut self, is_self: bool, reach: f64) {
        let Self {
            listed,
            near,
            found,
            skin,
            images,
            ..
        } = self;
        let listed = listed.each_ref().map(|own| own.places.as_slice());
        found.clear();
        let [first, second] = [0, usize::from(!is_self)].map(|side| images.counts[side] as u32);
        let other = usize::from(!is_self);
        let all = |side: usize| 0..listed[side].len() as u32;
        if is_self {
            near[0].clear();
            let there = |id: &u32| !listed[0][*id as usize][0].is_nan();
            near[0].extend(all(0).filter(there));
        } else {
            let boxes = [0, 1].map(|side| extent(listed[side], all(side)));
            // Bodies that are far from each other may come nearer by all of their gap.
            let gap = (0..D)
                .map(|d| (boxes[1][0][d] - boxes[0][1][d]).max(boxes[0][0][d] - boxes[1][1][d]));
            let gap = gap.fold(f64::NEG_INFINITY, f64::max);
            *skin = skin.max(gap - reach + *skin);
            for side in 0..2 {
                let [low, high] = boxes[1 - side];
                near[side].clear();
                let inside = |id: &u32| {
                    let x = &listed[side][*id as usize];
                    (0..D).all(|d| (low[d] - reach..=high[d] + reach).contains(&x[d]))
                };
                near[side].extend(all(side).filter(inside));
            }
        }
        if near[0].is_empty() || near[other].is_empty() {
            return;
        }
        let cells = Cells::build(listed[other], &near[other], reach);
        for &a in &near[0] {
            let x = listed[0][a as usize];
            cells.for_each_run(x.map(|x| x - reach), x.map(|x| x + reach), |run| {
                for &b in run {
                    let y = &listed[other][b as usize];
                    let square = (0..D).map(|d| (x[d] - y[d]).powi(2)).sum::<f64>();
                    // Two images are the image of two particles.
                    let there = a < first || b < second;
                    if square < reach * reach && (!is_self || a < b) && there {
                        found.push([a, b]);
                    }
                }
            });
        }
        found.sort_unstable();
    }

    /// Numbers the particles in pairs.
    pub fn number(&mut self, is_self: bool) {
        let Self {
            rows,
            split,
            pairs,
            listed,
            found,
            row_of,
            images,
            image_rows,
            ..
        } = self;
        rows.clear();
        image_rows.clear();
        pairs.clear();
        pairs.extend_from_slice(found);
        let sides: &[&[usize]] = if is_self { &[&[0, 1]] } else { &[&[0], &[1]] };
        for (side, places) in sides.iter().enumerate() {
            row_of.clear();
            row_of.resize(listed[side].places.len(), u32::MAX);
            for pair in &*found {
                for &place in *places {
                    row_of[pair[place] as usize] = 0;
                }
            }
            for (id, row) in row_of.iter_mut().enumerate() {
                if *row == 0 {
                    *row = rows.len() as u32;
                    rows.push(id as u32);
                }
            }
            for &id in &rows[image_rows.len()..] {
                let (source, chain) = images.source(side, id);
                image_rows.push(chain.map(|chain| [row_of[source as usize], chain as u32]));
            }
            if side == 0 {
                *split = rows.len();
            }
            for (pair, ids) in pairs.iter_mut().zip(&*found) {
                for &place in *places {
                    pair[place] = row_of[ids[place] as usize];
                }
            }
        }
    }
}
