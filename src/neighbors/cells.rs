//! Buckets: points sorted by the cell of a uniform grid they lie in, with a table from cell to run.
//! The table is dense where the bounding box is well filled and hashed where it is not.

use super::hilbert::hilbert_index;
use crate::collective::{Corners, Join};
use crate::parallel::{GRAIN, cut, for_each};
use crate::scalar::Real;
use std::collections::HashMap;
use std::ops::Range;

/// A uniform grid of cubic cells over a bounding box.
#[derive(Clone, Debug)]
pub struct Grid<const D: usize> {
    origin: [f64; D],
    inverse_size: f64,
    size: f64,
    counts: [u32; D],
}

/// The least and the largest of each coordinate of points that is finite.
pub(crate) fn corners_of<T: Real, const D: usize>(points: &[[T; D]]) -> Corners<D> {
    let Corners([mut low, mut high]) = Corners::NONE;
    for point in points {
        for d in 0..D {
            let x = point[d].to_f64();
            if x.is_finite() {
                low[d] = low[d].min(x);
                high[d] = high[d].max(x);
            }
        }
    }
    Corners([low, high])
}

impl<const D: usize> Grid<D> {
    /// A grid with cells of edge `size` over all `points` that are finite.
    #[must_use]
    pub fn over<T: Real>(points: &[[T; D]], size: f64) -> Self {
        let Corners([mut low, mut high]) = corners_of(points);
        let mut size = size;
        // A box so long that a coordinate overflows gets coarser cells; the search stays correct.
        for d in 0..D {
            if low[d] > high[d] {
                (low[d], high[d]) = (0.0, 0.0);
            }
            size = size.max((high[d] - low[d]) / f64::from(1 << 20));
        }
        let counts = core::array::from_fn(|d| ((high[d] - low[d]) / size) as u32 + 1);
        Self {
            origin: low,
            inverse_size: 1.0 / size,
            size,
            counts,
        }
    }

    /// The same with the lowest point in the middle of a cell and not on its face, so that a lattice of
    /// spacing `size` has one point a cell.
    #[must_use]
    pub fn centred<T: Real>(points: &[[T; D]], size: f64) -> Self {
        let mut grid = Self::over(points, size);
        for d in 0..D {
            grid.origin[d] -= 0.5 * grid.size;
            grid.counts[d] += 1;
        }
        grid
    }

    /// Edge of a cell.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.size
    }

    /// The lowest corner.
    #[must_use]
    pub fn origin(&self) -> [f64; D] {
        self.origin
    }

    /// How many cells there are along each axis.
    #[must_use]
    pub fn counts(&self) -> [u32; D] {
        self.counts
    }

    /// The cell that holds a point; points outside belong to the nearest cell.
    #[must_use]
    pub fn cell<T: Real>(&self, point: &[T; D]) -> [u32; D] {
        core::array::from_fn(|d| self.coordinate(point[d].to_f64(), d))
    }

    /// The cell coordinate along axis `d` of position `x`.
    #[must_use]
    pub fn coordinate(&self, x: f64, d: usize) -> u32 {
        // The cast takes NaN and values below the origin to zero.
        (((x - self.origin[d]) * self.inverse_size) as u32).min(self.counts[d] - 1)
    }

    /// Whether a box has anything in common with the grid's.
    fn meets(&self, low: &[f64; D], high: &[f64; D]) -> bool {
        (0..D).all(|d| {
            let end = self.origin[d] + f64::from(self.counts[d]) * self.size;
            high[d] >= self.origin[d] && low[d] <= end
        })
    }

    /// How far the cells with a coordinate along axis `d` are from `low..high` on it, but for rounding.
    fn gap(&self, coordinate: u32, d: usize, low: f64, high: f64) -> f64 {
        let start = self.origin[d] + f64::from(coordinate) * self.size;
        let apart = (low - start - self.size).max(start - high);
        (apart - 1e-6 * self.size).max(0.0)
    }

    /// Bits that coordinates of cells take.
    #[must_use]
    pub fn bits(&self) -> u32 {
        let most = self.counts.iter().copied().max().unwrap_or(1);
        (32 - (most - 1).leading_zeros()).max(1)
    }

    /// Position of the point's cell along the Hilbert curve.
    #[must_use]
    pub fn order<T: Real>(&self, point: &[T; D]) -> u64 {
        hilbert_index(self.cell(point), self.bits())
    }

    /// Those of all points.
    #[must_use]
    pub fn orders<T: Real>(&self, points: &[[T; D]]) -> Vec<u64> {
        let mut all = vec![0; points.len()];
        for_each(cut(&mut all, GRAIN), |piece, own| {
            for (order, x) in own.iter_mut().zip(&points[piece * GRAIN..]) {
                *order = self.order(x);
            }
        });
        all
    }

    fn cells(&self) -> usize {
        self.counts
            .iter()
            .fold(1, |n, &c| n.saturating_mul(c as usize))
    }

    fn linear(&self, cell: [u32; D]) -> usize {
        (0..D)
            .rev()
            .fold(0, |n, d| n * self.counts[d] as usize + cell[d] as usize)
    }
}

#[derive(Clone, Debug)]
enum Table {
    Dense(Vec<u32>),
    Hashed(HashMap<u64, (u32, u32)>),
}

/// Points listed by cell.
#[derive(Clone, Debug)]
pub struct Cells<const D: usize> {
    grid: Grid<D>,
    points: Vec<u32>,
    table: Table,
}

impl<const D: usize> Cells<D> {
    /// Lists `points` (a subset of the slots, by index) in cells of edge `size`.
    #[must_use]
    pub fn build<T: Real>(positions: &[[T; D]], points: &[u32], size: f64) -> Self {
        let chosen: Vec<[T; D]> = points.iter().map(|&p| positions[p as usize]).collect();
        Self::in_grid(Grid::over(&chosen, size), &chosen, points)
    }

    /// Lists points, which are at these places, in the cells of a grid; those of a cell keep their order.
    pub(super) fn in_grid<T: Real>(grid: Grid<D>, chosen: &[[T; D]], points: &[u32]) -> Self {
        let dense = grid.cells() <= 4 * points.len() + 1024;
        let keys: Vec<u64> = chosen
            .iter()
            .map(|x| grid.linear(grid.cell(x)) as u64)
            .collect();
        if dense {
            let mut starts = vec![0_u32; grid.cells() + 1];
            for &key in &keys {
                starts[key as usize + 1] += 1;
            }
            for k in 1..starts.len() {
                starts[k] += starts[k - 1];
            }
            let mut next = starts.clone();
            let mut sorted = vec![0; points.len()];
            for (&point, &key) in points.iter().zip(&keys) {
                let place = &mut next[key as usize];
                sorted[*place as usize] = point;
                *place += 1;
            }
            return Self {
                grid,
                points: sorted,
                table: Table::Dense(starts),
            };
        }
        let mut pairs: Vec<(u64, u32)> = keys.into_iter().zip(points.iter().copied()).collect();
        pairs.sort_by_key(|pair| pair.0);
        let mut runs = HashMap::new();
        let mut start = 0;
        for run in pairs.chunk_by(|a, b| a.0 == b.0) {
            runs.insert(run[0].0, (start, start + run.len() as u32));
            start += run.len() as u32;
        }
        let points = pairs.into_iter().map(|pair| pair.1).collect();
        Self {
            grid,
            points,
            table: Table::Hashed(runs),
        }
    }

    /// The points, cell after cell.
    #[must_use]
    pub fn points(&self) -> &[u32] {
        &self.points
    }

    /// Calls `visit` with the run of points of every cell that meets the box `low..high`.
    pub fn for_each_run(&self, low: [f64; D], high: [f64; D], mut visit: impl FnMut(&[u32])) {
        self.for_each_range_near(low, high, 0.0, |range| visit(&self.points[range]));
    }

    /// Calls `visit` with where in [`points`](Self::points) the runs of cells stand that are within `reach` of the
    /// box `low..high`.
    pub fn for_each_range_near(
        &self,
        low: [f64; D],
        high: [f64; D],
        reach: f64,
        mut visit: impl FnMut(Range<usize>),
    ) {
        let outer_low = low.map(|x| x - reach);
        let outer_high = high.map(|x| x + reach);
        if !self.grid.meets(&outer_low, &outer_high) {
            return;
        }
        let first: [u32; D] = core::array::from_fn(|d| self.grid.coordinate(outer_low[d], d));
        let last: [u32; D] = core::array::from_fn(|d| self.grid.coordinate(outer_high[d], d));
        let spanned = (0..D).fold(1_u64, |n, d| {
            n.saturating_mul(u64::from(last[d] - first[d]) + 1)
        });
        // A box that a far outlier stretches has more cells than there are points.
        if spanned > self.points.len() as u64 + 64 {
            visit(0..self.points.len());
            return;
        }
        let mut cell = first;
        loop {
            // A row of cells along the first axis, as long as the reach at its distance from the box is.
            let across2: f64 = (1..D)
                .map(|d| self.grid.gap(cell[d], d, low[d], high[d]).powi(2))
                .sum();
            if across2 <= reach * reach {
                let along = (reach * reach - across2).sqrt();
                cell[0] = self.grid.coordinate(low[0] - along, 0);
                let end = self.grid.coordinate(high[0] + along, 0) + 1;
                self.visit_row(cell, (end - cell[0]) as usize, &mut visit);
            }
            let mut d = 1;
            loop {
                if d >= D {
                    return;
                }
                if cell[d] < last[d] {
                    cell[d] += 1;
                    break;
                }
                cell[d] = first[d];
                d += 1;
            }
        }
    }

    /// Calls `visit` with the runs of so many cells along the first axis.
    fn visit_row(&self, from: [u32; D], cells: usize, visit: &mut impl FnMut(Range<usize>)) {
        let row = self.grid.linear(from);
        match &self.table {
            // Cells along the first axis follow one another, and so do their points.
            Table::Dense(starts) => visit(starts[row] as usize..starts[row + cells] as usize),
            Table::Hashed(runs) => {
                for key in row as u64..(row + cells) as u64 {
                    if let Some(&(start, end)) = runs.get(&key) {
                        visit(start as usize..end as usize);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finds_all_within_the_box(spread: f64) {
        let positions: Vec<[f64; 2]> = (0..500)
            .map(|k| {
                let k = f64::from(k);
                [spread * (k * 0.618).fract(), spread * (k * 0.414).fract()]
            })
            .collect();
        let points: Vec<u32> = (0..500).collect();
        let cells = Cells::build(&positions, &points, 0.07);
        let (low, high) = ([0.2, 0.3], [0.45, 0.41]);
        let mut found = Vec::new();
        cells.for_each_run(low, high, |run| found.extend_from_slice(run));
        let inside = |p: &[f64; 2]| (0..2).all(|d| p[d] >= low[d] && p[d] <= high[d]);
        for (k, p) in positions.iter().enumerate() {
            assert!(!inside(p) || found.contains(&(k as u32)));
        }
    }

    #[test]
    fn dense_and_hashed_tables_miss_nothing() {
        finds_all_within_the_box(1.0);
        finds_all_within_the_box(300.0);
    }
}
