//! Regular grids of points, on which fields are sampled and written for visualisation programs.
//! In three dimensions a grid with one point along an axis is a slice.

use super::Sample;
use crate::error::{Error, Problem, Result};
use crate::geometry::SWAPPED;
use crate::output::vti::Vti;
use std::path::Path;

/// Points at even distances along each axis, x varying first.
///
/// ```
/// use meshfree::observe::SampleGrid;
/// use meshfree::prelude::*;
/// let water = catalogue::weakly_compressible_water(2.0);
/// let simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
///     .body(Body::block("water", water, [0.0; 2], [0.2, 0.1], 0.01))
///     .build()?;
/// let grid = SampleGrid::between([0.0, 0.0], [0.2, 0.1], [41, 21])?;
/// let velocity = simulation.sample_grid(Field::VELOCITY, &grid)?;
/// let pressure = simulation.sample_grid(Field::PRESSURE, &grid)?;
/// assert_eq!((grid.points()[41], velocity.len()), ([0.0, 0.005], 41 * 21));
/// # let path = std::env::temp_dir().join(format!("meshfree-grid-{}.vti", std::process::id()));
/// # /*
/// let path = "water.vti";
/// # */
/// grid.write_vti(&path, &[&velocity, &pressure])?;
/// # let _ = std::fs::remove_file(path);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SampleGrid<const D: usize> {
    low: [f64; D],
    high: [f64; D],
    counts: [usize; D],
}

/// Points of a grid at most: their numbers have 32 bits.
const MOST_POINTS: usize = u32::MAX as usize;

impl<const D: usize> SampleGrid<D> {
    /// From `low` to `high` \[m\], which are points of it, with `counts` points along each axis; where there is one
    /// point, it is at `low`.
    ///
    /// # Errors
    /// If a corner is not finite, `high` is below `low` or, with more than one point, the same, if a count is zero, or if
    /// there are more than 2³² points.
    pub fn between(low: [f64; D], high: [f64; D], counts: [usize; D]) -> Result<Self> {
        for d in 0..D {
            let refused = |what: &str, value: f64, must_be| {
                let what = format!("{what} along axis {d} of a grid of samples");
                Err(Error::Argument(Problem::Parameter {
                    what,
                    value,
                    must_be,
                }))
            };
            for (what, value) in [("low end", low[d]), ("high end", high[d])] {
                if !value.is_finite() {
                    return refused(what, value, "it must be finite, in metres");
                }
            }
            if counts[d] == 0 {
                return refused("number of points", 0.0, "it must be one at least");
            }
            let extent = high[d] - low[d];
            if extent < 0.0 {
                return refused("extent", extent, SWAPPED);
            }
            if !extent.is_finite() || (counts[d] > 1 && extent == 0.0) {
                let must_be = "it must be positive and finite, in metres, or zero with one point";
                return refused("extent", extent, must_be);
            }
        }
        let total = counts.iter().fold(1, |n: usize, &c| n.saturating_mul(c));
        if total > MOST_POINTS {
            return Err(Error::Argument(Problem::Parameter {
                what: "number of points of a grid of samples".into(),
                value: total as f64,
                must_be: "it must be below 2³²",
            }));
        }
        Ok(Self { low, high, counts })
    }

    /// The number of points along each axis.
    #[must_use]
    pub fn counts(&self) -> [usize; D] {
        self.counts
    }

    /// The distance of neighbouring points along each axis \[m\]; zero where there is one point.
    #[must_use]
    pub fn spacing(&self) -> [f64; D] {
        core::array::from_fn(|d| match self.counts[d] {
            1 => 0.0,
            count => (self.high[d] - self.low[d]) / (count - 1) as f64,
        })
    }

    /// All points \[m\], x varying first.
    #[must_use]
    pub fn points(&self) -> Vec<[f64; D]> {
        let spacing = self.spacing();
        let total = self.counts.iter().product();
        let point = |mut index: usize| {
            core::array::from_fn(|d| {
                let along = index % self.counts[d];
                index /= self.counts[d];
                self.low[d] + along as f64 * spacing[d]
            })
        };
        (0..total).map(point).collect()
    }

    /// Writes samples at its points as VTK image data, each under the name of its field, with the filling of the
    /// first; for `ParaView` and others. What is out of reach of particles is not a number.
    ///
    /// # Errors
    /// When the file cannot be written, or a sample has another number of points.
    pub fn write_vti(&self, path: impl AsRef<Path>, samples: &[&Sample<D>]) -> Result<()> {
        // VTK asks for a spacing where there is one point, too.
        let spacing = self.spacing().map(|dx| if dx > 0.0 { dx } else { 1.0 });
        let mut file = Vti::new(self.low, spacing, self.counts);
        for sample in samples {
            let tuples = sample.values().chunks(sample.components());
            let padded = |numbers: &[f64]| {
                core::array::from_fn(|k| numbers.get(k).copied().unwrap_or(f64::NAN))
            };
            file = file.field::<D>(sample.name(), sample.shape(), tuples.map(padded));
        }
        if let Some(first) = samples.first() {
            file = file.scalar("filling", first.filling().iter().copied());
        }
        file.write(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_where_they_are_said_to_be() {
        let grid = SampleGrid::between([0.0, -1.0, 2.0], [1.0, 1.0, 2.0], [3, 2, 1]).unwrap();
        let points = grid.points();
        assert_eq!(points.len(), 6);
        assert_eq!((points[1], points[3]), ([0.5, -1.0, 2.0], [0.0, 1.0, 2.0]));
        assert_eq!(points[5], [1.0, 1.0, 2.0]);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let message = |low, high, counts| {
            let refused = SampleGrid::<1>::between([low], [high], [counts]);
            refused.unwrap_err().to_string()
        };
        assert!(message(0.0, f64::NAN, 2).contains("high end along axis 0"));
        assert!(message(1.0, 0.0, 2).contains("extent along axis 0"));
        assert!(message(1.0, 1.0, 2).contains("or zero with one point"));
        assert!(message(0.0, 1.0, 0).contains("number of points along axis 0"));
        assert!(message(0.0, 1.0, usize::MAX).contains("below 2³²"));
        assert!(SampleGrid::between([1.0], [1.0], [1]).is_ok());
    }
}
