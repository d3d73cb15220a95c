//! Particles packed into a shape, so that they follow its surface where a lattice makes steps.
//! Relaxation from a lattice, with the outside of the shape as part of the sum that is evened out.

use super::lattice::{argument, lattice};
use super::{Flaw, Shape};
use crate::error::Result;
use crate::kernel::{Kernel, WendlandC2};
use crate::neighbors::Cells;
use crate::parallel::{cut, for_each};
use crate::tensor::{Vector, length};

/// Smoothing length in spacings.
const H: f64 = 1.5;
/// Reach of the kernel in spacings.
const REACH: f64 = 2.0 * H;
/// Moves in h² of the gradient of the concentration; at ½ the finest pattern of a lattice swings.
const RELAXATION: f64 = 0.2;
/// The farthest that a particle moves at once, in spacings.
const FARTHEST: f64 = 0.1;
/// Moves at most.
const MOST: usize = 400;
/// Moves after which particles count as at rest, in spacings.
const AT_REST: f64 = 1e-4;
/// How far from the surface particles stay, in spacings; at rest the first are at ½ of a flat one.
const CLEAR: f64 = 0.25;
/// Points that a thread takes at once.
const PIECE: usize = 64;

/// Points that fill a shape evenly and follow its surface: as many as its volume has cells of `spacing`ᴰ \[mᴰ\], the first of
/// them half a spacing below a flat surface and a little less below a curved one.
///
/// Beside a surface that is curved or oblique a lattice makes steps, and its volume is that of whole cells: a disc with
/// a radius of eight spacings gets 3.5 % too much or too little, and steps cost several per cent in drag and in added
/// mass. Here points begin on the lattice of [`fill`](super::fill) and move down the gradient of the concentration
///
/// ∇C = Σ V ∇W(x − xⱼ) + ∫ ∇W(x − y) dy over all that is outside,
///
/// Δx = −0.2 h² ∇C with h of 1.5 spacings, until they rest (after Colagrossi, Bouscasse, Antuono & Marrone 2012,
/// who fill the outside with particles that are mirrored; here it is an integral over cells of half the spacing, as
/// Yu, Zhu, Zhang, Haidn & Hu 2023 take it over levels). Where the lattice of [`fill`](super::fill) fits the shape, as in a box of
/// whole spacings, points stay on it.
///
/// The points of the surface's two sides are packed each by itself: the liquid around a disc is
/// `tank.minus(disc)`, and a wall of particles in the disc is the disc.
///
/// ```
/// use meshfree::geometry::{Ball, Shape, pack};
/// let disc = Ball::new([0.0; 2], 0.8);
/// let points = pack(&disc, 0.1, [0.0; 2])?;
/// // π 8² = 201.06 cells.
/// assert_eq!(points.len(), 201);
/// // Of the first layer half a spacing is the mean within a tenth.
/// let depth = points.iter().map(|x| -disc.signed_distance(x) / 0.1).filter(|depth| *depth < 0.8);
/// let (sum, count) = depth.fold((0.0, 0.0), |(sum, count), depth| (sum + depth, count + 1.0));
/// assert!((sum / count - 0.5_f64).abs() < 0.1);
/// # Ok::<(), meshfree::error::Error>(())
/// ```
///
/// It takes up to 400 passes over all points; the same come from any number of threads.
///
/// # Errors
/// As [`fill`](super::fill).
pub fn pack<const D: usize>(
    shape: &(impl Shape<D> + ?Sized),
    spacing: f64,
    origin: [f64; D],
) -> Result<Vec<[f64; D]>> {
    packed(shape, spacing, origin).map_err(argument)
}

/// As [`pack`], with the error in the form of a body's.
pub(crate) fn packed<const D: usize>(
    shape: &(impl Shape<D> + ?Sized),
    spacing: f64,
    origin: [f64; D],
) -> core::result::Result<Vec<[f64; D]>, Flaw> {
    let near = |spacing: f64, far: f64| {
        lattice(shape, spacing, origin, far, |row, wanted| {
            for (x, wanted) in row.iter().zip(wanted) {
                *wanted = shape.signed_distance(x) < far;
            }
        })
    };
    let mut candidates: Vec<(f64, [f64; D])> = near(spacing, spacing)?
        .into_iter()
        .map(|x| (shape.signed_distance(&x), x))
        .collect();
    // What is outside, by cells that the surface cuts in part.
    let cell = 0.5 * spacing;
    let (mut cells, mut outside, mut shares) = (0.0, Vec::new(), Vec::new());
    for x in near(cell, (REACH + 1.0) * spacing)? {
        let share = share_outside(shape, &x, cell);
        cells += 1.0 - share;
        if share > 0.0 {
            outside.push(x);
            shares.push(share);
        }
    }
    let wanted = (cells * (cell / spacing).powi(D as i32)).round() as usize;
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    candidates.truncate(wanted);
    let mut points: Vec<[f64; D]> = candidates.into_iter().map(|(_, x)| x).collect();
    let outside = Outside {
        cells: Cells::build(
            &outside,
            &(0..outside.len() as u32).collect::<Vec<_>>(),
            spacing,
        ),
        points: outside,
        shares,
        volume: (cell / spacing).powi(D as i32),
    };
    for _ in 0..MOST {
        if relaxed(shape, spacing, &mut points, &outside) < AT_REST {
            break;
        }
    }
    Ok(points)
}

/// The share of a cell around `x` that is outside, by the distances of 3ᴰ points in it: as of planes through them.
fn share_outside<const D: usize>(shape: &(impl Shape<D> + ?Sized), x: &[f64; D], cell: f64) -> f64 {
    let distance = shape.signed_distance(x) / cell;
    if distance.abs() > D as f64 {
        return f64::from(distance > 0.0);
    }
    let count = 3_usize.pow(D as u32);
    let shares = (0..count).map(|k| {
        let at = core::array::from_fn(|d| {
            let step = (k / 3_usize.pow(d as u32) % 3) as f64 - 1.0;
            x[d] + step / 3.0 * cell
        });
        (0.5 + 3.0 * shape.signed_distance(&at) / cell).clamp(0.0, 1.0)
    });
    shares.sum::<f64>() / count as f64
}

/// Cells around a shape, of some volume in spacingsᴰ and the share of it that is outside.
struct Outside<const D: usize> {
    cells: Cells<D>,
    points: Vec<[f64; D]>,
    shares: Vec<f64>,
    volume: f64,
}

/// Moves all points once; the farthest move in spacings.
fn relaxed<const D: usize>(
    shape: &(impl Shape<D> + ?Sized),
    spacing: f64,
    points: &mut [[f64; D]],
    outside: &Outside<D>,
) -> f64 {
    let before = points.to_vec();
    let all: Vec<u32> = (0..before.len() as u32).collect();
    let cells = Cells::build(&before, &all, spacing);
    let mut moves = vec![0.0; points.len()];
    for_each(
        (cut(points, PIECE), cut(&mut moves, PIECE)),
        |piece, (points, moves)| {
            for (own, (x, moved)) in points.iter_mut().zip(moves).enumerate() {
                let own = piece * PIECE + own;
                let mut slope = [0.0; D];
                around(&cells, x, spacing, |other| {
                    if other != own {
                        add(&mut slope, x, &before[other], spacing, 1.0);
                    }
                });
                if shape.signed_distance(x) > -REACH * spacing {
                    around(&outside.cells, x, spacing, |cell| {
                        let share = outside.shares[cell] * outside.volume;
                        add(&mut slope, x, &outside.points[cell], spacing, share);
                    });
                }
                let length = length(&Vector::from(slope));
                let step = (RELAXATION * H * H * length).min(FARTHEST);
                if step > 0.0 {
                    *moved = step;
                    for d in 0..D {
                        x[d] -= step * spacing * slope[d] / length;
                    }
                }
                keep_inside(shape, spacing, x);
            }
        },
    );
    moves.into_iter().fold(0.0, f64::max)
}

/// Calls `visit` with the points in the cells around a place.
fn around<const D: usize>(
    cells: &Cells<D>,
    x: &[f64; D],
    spacing: f64,
    mut visit: impl FnMut(usize),
) {
    let [low, high] = [-REACH, REACH].map(|r| x.map(|x| x + r * spacing));
    cells.for_each_run(low, high, |run| {
        for &other in run {
            visit(other as usize);
        }
    });
}

/// Adds V ∇W of a point to the slope of the concentration at `x`, in one over the spacing.
fn add<const D: usize>(
    slope: &mut [f64; D],
    x: &[f64; D],
    other: &[f64; D],
    spacing: f64,
    volume: f64,
) {
    let apart: [f64; D] = core::array::from_fn(|d| (x[d] - other[d]) / spacing);
    let r2: f64 = apart.iter().map(|x| x * x).sum();
    if r2 < REACH * REACH {
        let factor = volume * kernel_slope::<D>(r2.sqrt() / H) / H.powi(D as i32 + 2);
        for d in 0..D {
            slope[d] += factor * apart[d];
        }
    }
}

/// W′/q hᴰ of Wendland's C2.
fn kernel_slope<const D: usize>(q: f64) -> f64 {
    fn of<const D: usize>(q: f64) -> f64
    where
        WendlandC2: Kernel<D>,
    {
        WendlandC2.normalisation() * WendlandC2.slope_over_q(q)
    }
    match D {
        1 => of::<1>(q),
        2 => of::<2>(q),
        _ => of::<3>(q),
    }
}

/// Moves a point that came too near to the surface back along its normal.
fn keep_inside<const D: usize>(shape: &(impl Shape<D> + ?Sized), spacing: f64, x: &mut [f64; D]) {
    let over = shape.signed_distance(x) + CLEAR * spacing;
    if over <= 0.0 {
        return;
    }
    let normal: [f64; D] = core::array::from_fn(|d| {
        let at = |by: f64| {
            let mut beside = *x;
            beside[d] += by * spacing;
            shape.signed_distance(&beside)
        };
        at(0.01) - at(-0.01)
    });
    let length = length(&Vector::from(normal));
    if length > 0.0 {
        for d in 0..D {
            x[d] -= over * normal[d] / length;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Ball, Cuboid, fill};
    use approx::assert_abs_diff_eq;

    /// The distance to the surface in spacings, of points nearer than 0.8: the mean.
    fn layer<const D: usize>(shape: &impl Shape<D>, spacing: f64, points: &[[f64; D]]) -> f64 {
        let near = points.iter().map(|x| shape.signed_distance(x) / spacing);
        let near: Vec<f64> = near.filter(|&distance| distance > -0.8).collect();
        near.iter().sum::<f64>() / near.len() as f64
    }

    /// The distance in spacings from each point to the nearest: the smallest of all.
    fn closest<const D: usize>(spacing: f64, points: &[[f64; D]]) -> f64 {
        let mut least = f64::INFINITY;
        for (k, x) in points.iter().enumerate() {
            for y in &points[..k] {
                let r2: f64 = (0..D).map(|d| (x[d] - y[d]).powi(2)).sum();
                least = least.min(r2.sqrt() / spacing);
            }
        }
        least
    }

    #[test]
    fn a_box_of_whole_spacings_keeps_its_lattice() {
        let cuboid = Cuboid::new([0.0; 2], [1.0, 0.7]);
        let lattice = fill(&cuboid, 0.1, [0.0; 2]).unwrap();
        let mut points = pack(&cuboid, 0.1, [0.0; 2]).unwrap();
        assert_eq!(points.len(), lattice.len());
        for x in lattice {
            let from = |y: &[f64; 2]| (x[0] - y[0]).hypot(x[1] - y[1]);
            let nearest = points
                .iter()
                .map(from)
                .enumerate()
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let (k, distance) = nearest.unwrap();
            assert!(distance < 5e-3, "{distance}");
            points.swap_remove(k);
        }
    }

    #[test]
    fn discs_and_balls_have_their_volume_and_a_first_layer_at_half_a_spacing() {
        for radius in [4.0, 8.0, 13.3] {
            let disc = Ball::new([0.3, -0.1], 0.1 * radius);
            let points = pack(&disc, 0.1, [0.0; 2]).unwrap();
            let cells = core::f64::consts::PI * radius * radius;
            assert_abs_diff_eq!(points.len() as f64, cells, epsilon = 0.002 * cells + 0.5);
            assert_abs_diff_eq!(layer(&disc, 0.1, &points), -0.45, epsilon = 0.06);
            assert!(closest(0.1, &points) > 0.85);
            // The lattice has particles that touch the surface and gaps of a spacing.
            let lattice = fill(&disc, 0.1, [0.0; 2]).unwrap();
            let spread = |points: &[[f64; 2]]| {
                let near = points.iter().map(|x| disc.signed_distance(x) / 0.1);
                near.fold(f64::NEG_INFINITY, f64::max)
            };
            assert!(spread(&points) < -0.25 && spread(&lattice) > spread(&points));
        }
        let ball = Ball::new([0.0; 3], 0.5);
        let points = pack(&ball, 0.1, [0.0; 3]).unwrap();
        let cells = 4.0 / 3.0 * core::f64::consts::PI * 125.0;
        assert_abs_diff_eq!(points.len() as f64, cells, epsilon = 0.002 * cells + 0.5);
        assert!(closest(0.1, &points) > 0.8);
    }

    #[test]
    fn the_place_of_a_shape_is_nothing() {
        let points = |at: f64| {
            let hole = Ball::new([at + 0.5, 0.5], 0.25);
            let shape = Cuboid::new([at, 0.0], [at + 1.0, 1.0]).minus(hole);
            pack(&shape, 0.125, [at, 0.0]).unwrap()
        };
        let (here, there) = (points(0.0), points(1024.0));
        assert_eq!(here.len(), there.len());
        for (x, y) in here.iter().zip(&there) {
            assert_abs_diff_eq!(x[0], y[0] - 1024.0, epsilon = 1e-3);
            assert_abs_diff_eq!(x[1], y[1], epsilon = 1e-3);
        }
    }

    #[test]
    fn what_cannot_be_is_named() {
        let message = |spacing| {
            let refused = pack(&Ball::new([0.0; 2], 1.0), spacing, [0.0; 2]);
            refused.unwrap_err().to_string()
        };
        assert!(message(0.0).contains("spacing"));
        assert!(message(f64::NAN).contains("spacing"));
        assert!(message(1e-9).contains("number of lattice points"));
        let open = crate::geometry::HalfSpace::new([0.0; 2], [1.0, 0.0]);
        assert!(
            pack(&open, 0.1, [0.0; 2])
                .unwrap_err()
                .to_string()
                .contains("extent")
        );
        assert!(
            pack(&Ball::new([0.0; 2], 0.01), 0.1, [0.0; 2])
                .unwrap()
                .is_empty()
        );
    }
}
