//! The open-cell structure of Vesenjak & Ren: cubes pierced by three orthogonal through holes.
//! Void of a cell: 3π r² a − 8√2 r³, with r = d/2 and a = d + c.

use super::{Cuboid, Shape};
use crate::tensor::{Vector, length};
use core::f64::consts::{PI, SQRT_2};

/// A block of open cells: cubes of side a = d + c, each pierced through its centre by a hole of
/// diameter d along every axis, so that walls of thickness c stand between the holes.
///
/// Of three holes of radius r that cross at right angles any two share 16/3 r³, and all three
/// 8 (2 − √2) r³ (Steinmetz solids). Counted once, they leave the void 3π r² a − 8√2 r³ in a cell.
///
/// Source: Vesenjak & Ren (2007), figure 9 and section 4: d = 3 mm and c = 1.5, 1.0 and 0.5 mm for
/// relative densities of 0.37, 0.27 and 0.16. The figure is read as holes through the centre of the
/// cube; the volumes agree with the densities printed.
///
/// A lattice of 40 points a side counts the solid of these three to 2 %, one of 80 to 0.5 %.
///
/// ```
/// use meshfree::geometry::{OpenCell, Shape, fill};
/// let cells = OpenCell::new(3e-3, 1.5e-3).tiled([2, 1, 1]);
/// assert!((cells.relative_density() - 0.37).abs() < 0.005);
/// // Polymer and water, on one lattice.
/// let polymer = fill(&cells.solid(), 1.5e-4, [0.0; 3])?;
/// let water = fill(&cells.void(), 1.5e-4, [0.0; 3])?;
/// assert_eq!(polymer.len() + water.len(), 60 * 30 * 30);
/// # Ok::<(), meshfree::error::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenCell {
    diameter: f64,
    wall: f64,
    counts: [usize; 3],
    origin: [f64; 3],
}

impl OpenCell {
    /// One cell with holes of `diameter` \[m\] and walls of thickness `wall` \[m\] between the holes
    /// of neighbouring cells, its low corner at the origin.
    #[must_use]
    pub fn new(diameter: f64, wall: f64) -> Self {
        Self {
            diameter,
            wall,
            counts: [1; 3],
            origin: [0.0; 3],
        }
    }

    /// So many cells along each axis; one if not given.
    #[must_use]
    pub fn tiled(self, counts: [usize; 3]) -> Self {
        Self { counts, ..self }
    }

    /// Places the low corner of the block at `origin` \[m\].
    #[must_use]
    pub fn at(self, origin: [f64; 3]) -> Self {
        Self { origin, ..self }
    }

    /// Side a = d + c of a cell \[m\].
    #[must_use]
    pub fn side(&self) -> f64 {
        self.diameter + self.wall
    }

    /// Void of one cell \[m³\]: 3π r² a − 8√2 r³.
    #[must_use]
    pub fn void_volume(&self) -> f64 {
        let r = self.diameter / 2.0;
        3.0 * PI * r * r * self.side() - 8.0 * SQRT_2 * r * r * r
    }

    /// Solid of a cell over its volume: the density of the structure over that of its material.
    #[must_use]
    pub fn relative_density(&self) -> f64 {
        1.0 - self.void_volume() / self.side().powi(3)
    }

    /// The walls.
    #[must_use]
    pub fn solid(self) -> OpenCellPart {
        OpenCellPart {
            cells: self,
            is_solid: true,
        }
    }

    /// The holes, open at the faces of the block.
    #[must_use]
    pub fn void(self) -> OpenCellPart {
        OpenCellPart {
            cells: self,
            is_solid: false,
        }
    }

    fn block(&self) -> Cuboid<3> {
        let (side, origin) = (self.side(), self.origin);
        let high = core::array::from_fn(|d| origin[d] + self.counts[d] as f64 * side);
        Cuboid::new(origin, high)
    }

    /// Signed distance \[m\] to the holes, as if there were cells without end.
    fn holes(&self, x: &[f64; 3]) -> f64 {
        let side = self.side();
        // Of parallel holes the nearest is that of the point's own cell.
        let u: [f64; 3] =
            core::array::from_fn(|d| (x[d] - self.origin[d]).rem_euclid(side) - 0.5 * side);
        let nearest = (0..3)
            .map(|d| length(&Vector::from([u[(d + 1) % 3], u[(d + 2) % 3]])))
            .fold(f64::INFINITY, f64::min);
        nearest - 0.5 * self.diameter
    }
}

/// The solid or the void of a block of open cells, by [`OpenCell::solid`] and [`OpenCell::void`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenCellPart {
    cells: OpenCell,
    is_solid: bool,
}

impl Shape<3> for OpenCellPart {
    fn signed_distance(&self, x: &[f64; 3]) -> f64 {
        let holes = self.cells.holes(x);
        let part = if self.is_solid { -holes } else { holes };
        self.cells.block().signed_distance(x).max(part)
    }
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        self.cells.block().bounds()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = Vec::new();
        let lengths = [
            ("hole diameter of the open cells", self.cells.diameter),
            ("wall thickness of the open cells", self.cells.wall),
        ];
        for (name, value) in lengths {
            if !(value.is_finite() && value > 0.0) {
                problems.push((name, value, super::POSITIVE));
            }
        }
        if self.cells.counts.contains(&0) {
            problems.push((
                "number of open cells along an axis",
                0.0,
                "it must be at least one",
            ));
        }
        if let Some(&bad) = self.cells.origin.iter().find(|x| !x.is_finite()) {
            problems.push((
                "origin of the open cells",
                bad,
                "it must be finite, in metres",
            ));
        }
        problems
    }
}
