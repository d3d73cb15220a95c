//! What is given twice and acts twice: walls at rest whose particles stand at one place, and inlets of one opening.
//! Liquid feels both, and pressures say nothing of it.

use super::parameter;
use crate::boundary::Wall;
use crate::error::Problem;
use crate::neighbors::Cells;
use crate::scalar::Real;
use crate::scene::Scene;

/// Share of the spacing within which two particles are one.
const SAME_PLACE: f64 = 0.01;

impl<T: Real, const D: usize> Scene<T, D> {
    /// Walls at rest that share particles; what moves may go through another wall.
    pub(super) fn check_doubled_walls(&self, problems: &mut Vec<Problem>) {
        let rests = |wall: &&Wall<D>| wall.motion.is_none();
        let walls: Vec<&Wall<D>> = self.walls.iter().filter(rests).collect();
        for (k, second) in walls.iter().enumerate() {
            for first in &walls[..k] {
                let spacing = first.spacing.min(second.spacing);
                if let Some((distance, position)) =
                    nearest_pair(&first.points, &second.points, spacing, SAME_PLACE)
                {
                    problems.push(Problem::Overlap {
                        first: first.name.clone(),
                        second: second.name.clone(),
                        distance,
                        spacing,
                        position: position.to_vec(),
                    });
                }
            }
        }
    }

    /// Inlets with a point of their openings in common.
    pub(super) fn check_doubled_inlets(&self, problems: &mut Vec<Problem>) {
        for (k, second) in self.inlets.iter().enumerate() {
            for first in &self.inlets[..k] {
                let spacing = first.spacing.min(second.spacing);
                if let Some((distance, _)) =
                    nearest_pair(&first.opening, &second.opening, spacing, SAME_PLACE)
                {
                    let what = format!(
                        "distance of points of the openings of an inlet of body `{}` and one of body `{}`",
                        first.body, second.body
                    );
                    let must_be = "it must be a spacing: particles would enter twice at one place";
                    problems.push(parameter(&what, distance, must_be));
                }
            }
        }
    }
}

/// The distance \[m\] of the nearest pair of two sets, if it is below this share of the spacing \[m\], and the place of its point in
/// the second.
pub(super) fn nearest_pair<const D: usize>(
    points: &[[f64; D]],
    others: &[[f64; D]],
    spacing: f64,
    share: f64,
) -> Option<(f64, [f64; D])> {
    let reach = share * spacing;
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let cells = Cells::build(points, &all, spacing);
    let mut nearest = (reach * reach, None);
    for x in others {
        cells.for_each_run(x.map(|x| x - reach), x.map(|x| x + reach), |run| {
            for &j in run {
                let y = &points[j as usize];
                let square: f64 = (0..D).map(|d| (x[d] - y[d]).powi(2)).sum();
                if square < nearest.0 {
                    nearest = (square, Some(*x));
                }
            }
        });
    }
    nearest.1.map(|x| (nearest.0.sqrt(), x))
}
