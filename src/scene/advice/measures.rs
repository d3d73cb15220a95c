//! Sizes and speeds of a scene, as advice needs them: extents, thicknesses, closing speeds, motions and loads.
//! A thickness is a median over particles of the shortest row of them, along an axis, that a particle is in.

use super::Known;
use crate::boundary::Motion;
use crate::scalar::Real;
use crate::scene::{Body, Scene};
use std::collections::HashSet;

/// Times at which loads and motions are looked at.
const LOOKS: usize = 257;

/// What the whole scene gives.
pub(super) struct Measures {
    /// End time t \[s\].
    pub end: f64,
    /// Gravity g \[m/s²\].
    pub gravity: f64,
    /// Largest uniform acceleration \[m/s²\], of loads and of the frames of walls.
    pub acceleration: f64,
    /// Largest uniform acceleration along each axis \[m/s²\].
    pub pull: Vec<f64>,
    /// Largest speed of a wall \[m/s\].
    pub walls: f64,
    /// Along each axis: the largest difference of the velocities \[m/s\] of two walls or solids, and of the ways \[m\] of two walls.
    pub closing: Vec<[f64; 2]>,
    /// Whether something stands still beside the bodies: walls or boundaries.
    pub at_rest: bool,
}

impl Measures {
    pub fn of<T: Real, const D: usize>(scene: &Scene<T, D>, end: f64, known: &Known) -> Self {
        let mut acceleration: f64 = 0.0;
        let mut pull = vec![0.0_f64; D];
        for time in times(end) {
            let mut sum = [0.0; D];
            for own in &scene.accelerations {
                let a = own(time);
                sum = core::array::from_fn(|d| sum[d] + a[d]);
            }
            acceleration = acceleration.max(norm(&sum));
            for (own, sum) in pull.iter_mut().zip(sum) {
                *own = own.max(sum.abs());
            }
        }
        let mut walls: f64 = 0.0;
        for wall in &scene.walls {
            walls = walls.max(norm(&wall.sliding));
            if let Some(motion) = &wall.motion {
                let corners = corners(&wall.points);
                walls = walls.max(fastest(&**motion, &corners, end, 1));
                acceleration = acceleration.max(fastest(&**motion, &corners, end, 2));
            }
        }
        Self {
            end,
            gravity: known.gravity,
            acceleration,
            pull,
            walls,
            closing: (0..D).map(|axis| closing(scene, end, axis)).collect(),
            at_rest: !(scene.walls.is_empty() && scene.boundaries.is_empty()),
        }
    }
}

fn times(end: f64) -> impl Iterator<Item = f64> {
    (0..LOOKS).map(move |k| end * k as f64 / (LOOKS - 1) as f64)
}

/// The largest velocity (`order` 1) or acceleration (2) that a motion gives some points, over a run to `end` \[s\]. A
/// motion that has no number at a time gives none.
pub(super) fn fastest<const D: usize>(
    motion: &dyn Motion<D>,
    points: &[[f64; D]],
    end: f64,
    order: usize,
) -> f64 {
    let at = |time| {
        let pose = motion.pose(time);
        let speeds = points.iter().map(|x| norm(&pose.of(order, x)));
        speeds.fold(0.0, f64::max)
    };
    times(end).map(at).fold(0.0, f64::max)
}

/// The largest difference along an axis of the velocities \[m/s\] of two walls at one time, or of walls and solids at the start, and
/// of the ways \[m\] of two walls: each in the mean over its corners.
fn closing<T: Real, const D: usize>(scene: &Scene<T, D>, end: f64, axis: usize) -> [f64; 2] {
    let solids = scene.parts.iter().filter(|part| !part.scheme.meets_walls());
    let solids = solids.flat_map(|part| &part.bodies);
    let starts: Vec<f64> = solids.map(|body| velocity(body)[axis]).collect();
    let walls: Vec<_> = (scene.walls.iter())
        .map(|wall| (wall.motion.as_deref(), corners(&wall.points)))
        .collect();
    let range = |values: &mut dyn Iterator<Item = f64>| {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let [low, high] = values.fold(none, |[a, b], v| [a.min(v), b.max(v)]);
        (high - low).max(0.0)
    };
    let mut most = [0.0_f64; 2];
    for time in times(end) {
        let moved = |order: usize| {
            let of = move |(motion, corners): &(Option<&dyn Motion<D>>, Vec<[f64; D]>)| {
                let Some(pose) = motion.map(|motion| motion.pose(time)) else {
                    return 0.0;
                };
                let rest = if order == 0 { 1.0 } else { 0.0 };
                let ways = corners
                    .iter()
                    .map(|x| pose.of(order, x)[axis] - rest * x[axis]);
                ways.sum::<f64>() / corners.len().max(1) as f64
            };
            walls.iter().map(of)
        };
        let solids = starts.iter().copied().filter(|_| time == 0.0);
        most[0] = most[0].max(range(&mut moved(1).chain(solids)));
        most[1] = most[1].max(range(&mut moved(0)));
    }
    most
}

/// How far a motion takes some points from where they were \[m\], at most.
pub(super) fn farthest<const D: usize>(
    motion: &dyn Motion<D>,
    points: &[[f64; D]],
    end: f64,
) -> f64 {
    let at = |time| {
        let pose = motion.pose(time);
        let way = points.iter().map(|x| {
            let y = pose.of(0, x);
            norm(&core::array::from_fn::<f64, D, _>(|d| y[d] - x[d]))
        });
        way.fold(0.0, f64::max)
    };
    times(end).map(at).fold(0.0, f64::max)
}

pub(super) fn norm<const D: usize>(v: &[f64; D]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Lowest and highest corner \[m\] of some points.
pub(super) fn bounds<const D: usize>(points: &[[f64; D]]) -> [[f64; D]; 2] {
    let start = [[f64::INFINITY; D], [f64::NEG_INFINITY; D]];
    points.iter().fold(start, |[low, high], x| {
        [
            core::array::from_fn(|d| low[d].min(x[d])),
            core::array::from_fn(|d| high[d].max(x[d])),
        ]
    })
}

/// The corners of the box around some points.
fn corners<const D: usize>(points: &[[f64; D]]) -> Vec<[f64; D]> {
    if points.is_empty() {
        return Vec::new();
    }
    let ends = bounds(points);
    let corner = |k: usize| core::array::from_fn(|d| ends[k >> d & 1][d]);
    (0..1 << D).map(corner).collect()
}

/// Extents of a body along the axes \[m\], half a spacing at either side of its particles' places included.
pub(super) fn extents<T: Real, const D: usize>(body: &Body<T, D>) -> [f64; D] {
    if body.points.is_empty() {
        return [0.0; D];
    }
    let [low, high] = bounds(&body.points);
    core::array::from_fn(|d| high[d] - low[d] + body.spacing)
}

/// The largest extent of a body \[m\].
pub(super) fn length<T: Real, const D: usize>(body: &Body<T, D>) -> f64 {
    extents(body).into_iter().fold(0.0, f64::max)
}

/// Mean velocity of a body as it starts \[m/s\].
pub(super) fn velocity<T: Real, const D: usize>(body: &Body<T, D>) -> [f64; D] {
    let count = body.starts.len().max(1) as f64;
    let starts = body.starts.iter();
    starts.fold([0.0; D], |sum, start| {
        core::array::from_fn(|d| sum[d] + start.velocity[d] / count)
    })
}

/// The middle of a body \[m\].
pub(super) fn middle<T: Real, const D: usize>(body: &Body<T, D>) -> [f64; D] {
    let [low, high] = bounds(&body.points);
    core::array::from_fn(|d| 0.5 * (low[d] + high[d]))
}

/// The largest speed of a particle of a body as it starts, beside a velocity \[m/s\].
pub(super) fn fastest_of<T: Real, const D: usize>(body: &Body<T, D>, beside: &[f64; D]) -> f64 {
    let speed = |start: &crate::scheme::Start<D>| {
        norm(&core::array::from_fn::<f64, D, _>(|d| {
            start.velocity[d] - beside[d]
        }))
    };
    body.starts.iter().map(speed).fold(0.0, f64::max)
}

/// The thickness of a body \[m\]: of each particle the shortest of the rows of particles that it is in along the axes, and of
/// those the median. Particles off a lattice may leave one place of a row empty. Of a ball it is about two thirds of the
/// diameter; of a plate, a hollow box or the struts of a foam, what is meant.
pub(super) fn thickness<T: Real, const D: usize>(body: &Body<T, D>) -> f64 {
    let dx = body.spacing;
    if body.points.is_empty() || !(dx.is_finite() && dx > 0.0) {
        return f64::NAN;
    }
    let [low, _] = bounds(&body.points);
    let place = |x: &[f64; D]| -> [i64; D] {
        core::array::from_fn(|d| ((x[d] - low[d]) / dx).round() as i64)
    };
    let mut cells: Vec<[i64; D]> = body.points.iter().map(place).collect();
    cells = cells
        .into_iter()
        .collect::<HashSet<_>>()
        .into_iter()
        .collect();
    let mut shortest: std::collections::HashMap<[i64; D], i64> =
        cells.iter().map(|&cell| (cell, i64::MAX)).collect();
    for axis in 0..D {
        // Rows along the axis, one after another.
        let key = |cell: &[i64; D]| -> [i64; D] {
            core::array::from_fn(|d| {
                cell[if d + 1 == D {
                    axis
                } else {
                    d + usize::from(d >= axis)
                }]
            })
        };
        cells.sort_unstable_by_key(key);
        let joined = |a: &[i64; D], b: &[i64; D]| {
            (0..D).all(|d| d == axis || a[d] == b[d]) && b[axis] - a[axis] <= 2
        };
        for row in cells.chunk_by(joined) {
            let long = row[row.len() - 1][axis] - row[0][axis] + 1;
            for cell in row {
                if let Some(least) = shortest.get_mut(cell) {
                    *least = long.min(*least);
                }
            }
        }
    }
    let mut all: Vec<i64> = shortest.into_values().collect();
    let middle = all.len() / 2;
    *all.select_nth_unstable(middle).1 as f64 * dx
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Ball, Cuboid, Shape};
    use crate::material::catalogue;

    fn of<const D: usize>(shape: &impl Shape<D>, spacing: f64) -> f64 {
        thickness(&Body::<f64, D>::fill(
            "it",
            catalogue::copper(),
            shape,
            spacing,
        ))
    }

    #[test]
    fn thickness_of_plates_boxes_and_balls() {
        let dx = 0.1;
        assert!((of(&Cuboid::new([0.0; 2], [4.0, 0.5]), dx) - 0.5).abs() < 1e-12);
        assert!((of(&Cuboid::new([0.0; 3], [2.0, 0.3, 1.0]), dx) - 0.3).abs() < 1e-12);
        // A hollow box with walls of 0.4.
        let shell = Cuboid::new([0.0; 2], [4.0; 2]).minus(Cuboid::new([0.4; 2], [3.6; 2]));
        assert!((of(&shell, dx) - 0.4).abs() < 1e-12);
        let ball = of(&Ball::new([0.0; 2], 1.0), dx);
        assert!((1.0..2.0).contains(&ball), "{ball}");
    }

    #[test]
    fn thickness_bears_disorder() {
        let plate = Body::<f64, 2>::block("it", catalogue::copper(), [0.0; 2], [4.0, 0.5], 0.1);
        let off = thickness(&plate.jitter(0.2, 7));
        assert!((off - 0.5).abs() < 0.11, "{off}");
    }
}
