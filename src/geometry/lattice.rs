//! Cubic lattices in a shape and around it.
//! The points are origin + (k + ½) spacing for whole numbers k.

use super::{Flaw, Shape};
use crate::error::{Error, Problem, Result};
use crate::parallel::{GRAIN, collect};

/// Most particles that a shape is filled with; more is a slip of the spacing's unit.
pub(crate) const MOST_PARTICLES: f64 = 4e9;
/// What to do about too many.
pub(crate) const FEWER: &str =
    "it must fit into memory and be below 4e9: check that the spacing is in metres";
/// What a length must be.
pub(crate) const POSITIVE: &str = "it must be finite and positive, in metres";
/// What the extent of a box from its low to its high corner must be.
pub(crate) const SWAPPED: &str = "it must be positive: low and high are swapped along that axis; the low one comes first, in metres";
/// Layers that a wall can have at most: the kernels of the crate reach six spacings.
const MOST_LAYERS: f64 = 10.0;
/// Share of the spacing that lengths given as multiples of it are off by rounding, and no more.
const ROUNDING: f64 = 1e-9;

/// The points origin + (k + ½) `spacing` \[m\] of the cubic lattice that are inside of a shape, the
/// first coordinate running fastest.
///
/// A point on the surface is in the shape or in its complement, never in both or in none: a body and
/// what fills its holes, filled from one origin, have no particle in common and none between them.
///
/// The volume of a shape is the number of points times `spacing`ᴰ, with an error of first order at
/// most: only cells that the surface cuts contribute to it.
///
/// ```
/// use meshfree::geometry::{Cuboid, fill};
/// assert_eq!(fill(&Cuboid::new([0.0], [1.0]), 0.25, [0.0])?, [[0.125], [0.375], [0.625], [0.875]]);
/// # Ok::<(), meshfree::error::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] if the shape has a [problem](Shape::problems) or no end, if `spacing` is not
/// positive or a number not finite, and if the box around the shape has more lattice points than
/// 4·10⁹ or memory holds.
pub fn fill<const D: usize>(
    shape: &(impl Shape<D> + ?Sized),
    spacing: f64,
    origin: [f64; D],
) -> Result<Vec<[f64; D]>> {
    filled(shape, spacing, origin).map_err(argument)
}

/// As [`fill`], with the error in the form of a body's.
pub(crate) fn filled<const D: usize>(
    shape: &(impl Shape<D> + ?Sized),
    spacing: f64,
    origin: [f64; D],
) -> core::result::Result<Vec<[f64; D]>, Flaw> {
    lattice(shape, spacing, origin, 0.0, |row, inside| {
        shape.inside_row(row, inside);
    })
}

/// The points of the lattice of [`fill`] that make a wall of `thickness` \[m\] around a shape: the
/// dummy particles of a tank whose inside is the shape.
///
/// A point outside of the shape belongs to the wall
/// - if its distance to the shape is at most `thickness`, or
/// - if no coordinate differs by more than `thickness` (rounded to whole spacings) from that of a
///   point inside.
///
/// The first are all that a particle in the shape can feel whose kernel reaches `thickness`: nothing
/// beyond is nearer to any place in the shape, edges and corners included. The second complete the
/// edges and corners of a box to the full block, up to √D `thickness` away; a wall particle there
/// feels no particle of the shape that stays inside. They are what one expects of a tank, they give
/// wall particles their own neighbours, and they stand behind a particle that slipped out at an edge.
/// Around a surface that is oblique to the lattice they make the wall up to √D times as thick;
/// `retain(|x| shape.signed_distance(x) <= thickness)` takes them away.
///
/// Take as thickness what the kernel reaches: its support times h, the next whole number of spacings.
/// Where the shape's distance is a bound only (see [the table](super)) the wall has more points, not
/// fewer.
///
/// ```
/// use meshfree::geometry::{Cuboid, layers};
/// // A tank 1 m wide and 0.5 m deep with walls of three layers, open at the top.
/// let inside = Cuboid::new([0.0; 2], [1.0, 0.5]);
/// let mut wall = layers(&inside, 0.1, 0.3, [0.0; 2])?;
/// assert_eq!(wall.len(), 16 * 11 - 10 * 5);
/// wall.retain(|x| x[1] < 0.5);
/// assert_eq!(wall.len(), 16 * 8 - 10 * 5);
/// # Ok::<(), meshfree::error::Error>(())
/// ```
///
/// # Errors
/// As [`fill`], and if `thickness` is not finite and positive, or more than ten spacings: it is a length, where
/// [`Wall::around`](crate::boundary::Wall::around) takes a count.
pub fn layers<const D: usize>(
    shape: &(impl Shape<D> + ?Sized),
    spacing: f64,
    thickness: f64,
    origin: [f64; D],
) -> Result<Vec<[f64; D]>> {
    if !(thickness.is_finite() && thickness > 0.0) {
        return Err(argument(("thickness of the wall", thickness, POSITIVE)));
    }
    let count = thickness / spacing;
    if count.is_finite() && count > MOST_LAYERS {
        return Err(Error::Argument(Problem::Incompatible {
            what: format!(
                "a wall {thickness} m thick is {count:.0} layers of particles {spacing} m apart, and no kernel reaches farther than \
                 {MOST_LAYERS}"
            ),
            remedy: "give the thickness in metres: the number of layers times the spacing",
        }));
    }
    // Far from zero places are rounded by more.
    let (low, high) = shape.bounds();
    let places = low.iter().chain(&high).filter(|x| x.is_finite());
    let farthest = places.fold(0.0_f64, |most, x| most.max(x.abs()));
    let near = thickness + (ROUNDING * spacing).max(4.0 * f64::EPSILON * farthest);
    // The first layer is half a spacing from the surface of a box that fits the lattice.
    let steps = (near / spacing + 0.5).floor();
    let far = steps * spacing * (D as f64).sqrt();
    let belongs = |x: &[f64; D]| {
        let distance = shape.signed_distance(x);
        !is_inside(distance)
            && (distance <= near || distance <= far && has_inside(shape, x, steps, spacing))
    };
    let mark = |row: &[[f64; D]], belong: &mut [bool]| {
        for (x, own) in row.iter().zip(belong) {
            *own = belongs(x);
        }
    };
    lattice(shape, spacing, origin, thickness + spacing, mark).map_err(argument)
}

/// Whether a distance is that of a point inside. The sign of zero counts: it is the one thing that
/// differs between a shape and its complement on the surface.
pub(super) fn is_inside(distance: f64) -> bool {
    distance.is_sign_negative()
}

/// Whether a point of the lattice no more than `steps` from `x` along each axis is inside.
fn has_inside<const D: usize>(
    shape: &(impl Shape<D> + ?Sized),
    x: &[f64; D],
    steps: f64,
    spacing: f64,
) -> bool {
    let mut offset = [-steps; D];
    loop {
        let at = core::array::from_fn(|d| x[d] + offset[d] * spacing);
        if is_inside(shape.signed_distance(&at)) {
            return true;
        }
        let Some(d) = offset.iter().position(|&o| o < steps) else {
            return false;
        };
        offset[d] += 1.0;
        offset[..d].fill(-steps);
    }
}

/// The points of the lattice in the shape's box, widened by `margin` \[m\], that `mark` takes of each row.
pub(super) fn lattice<const D: usize>(
    shape: &(impl Shape<D> + ?Sized),
    spacing: f64,
    origin: [f64; D],
    margin: f64,
    mark: impl Fn(&[[f64; D]], &mut [bool]) + Sync,
) -> core::result::Result<Vec<[f64; D]>, Flaw> {
    if let Some(&flaw) = shape.problems().first() {
        return Err(flaw);
    }
    if !(spacing.is_finite() && spacing > 0.0) {
        return Err(("spacing", spacing, POSITIVE));
    }
    let (low, high) = shape.bounds();
    if let Some(d) = (0..D).find(|&d| !(low[d].is_finite() && high[d].is_finite())) {
        return Err((
            "extent of the shape",
            high[d] - low[d],
            "it must be finite along every axis: intersect the shape with a box",
        ));
    }
    if let Some(&bad) = origin.iter().find(|x| !x.is_finite()) {
        return Err(("origin of the lattice", bad, "it must be finite, in metres"));
    }
    let index = |x: f64, d: usize| (x - origin[d]) / spacing - 0.5;
    let first: [f64; D] = core::array::from_fn(|d| index(low[d] - margin, d).floor());
    let counts: [f64; D] =
        core::array::from_fn(|d| (index(high[d] + margin, d).ceil() - first[d] + 1.0).max(0.0));
    let total: f64 = counts.iter().product();
    if total.is_nan() || total > MOST_PARTICLES {
        return Err(("number of lattice points", total, FEWER));
    }
    let counts = counts.map(|n| n as usize);
    // Rows in pieces, so that neither long rows nor many short ones are one thread's.
    let part = counts[0].clamp(1, GRAIN);
    let parts = counts[0].div_ceil(part);
    let rows: usize = counts[1..].iter().product();
    let together = (GRAIN / part).max(1);
    let points_of = |piece: usize| {
        let (mut found, mut row) = (Vec::new(), Vec::with_capacity(part));
        let mut wanted = vec![false; part];
        let all = rows * parts;
        for number in piece * together..all.min((piece + 1) * together) {
            let start = number % parts * part;
            let steps = start..counts[0].min(start + part);
            row.clear();
            row.extend(steps.map(|step| {
                let mut rest = number / parts;
                core::array::from_fn(|d| {
                    let step = if d == 0 { step } else { rest % counts[d] };
                    rest /= if d == 0 { 1 } else { counts[d] };
                    origin[d] + (first[d] + step as f64 + 0.5) * spacing
                })
            }));
            mark(&row, &mut wanted[..row.len()]);
            let own = || row.iter().zip(&wanted).filter(|(_, wanted)| **wanted);
            found.try_reserve(own().count()).ok()?;
            found.extend(own().map(|(x, _)| *x));
        }
        Some(found)
    };
    let pieces = collect((rows * parts).div_ceil(together), points_of);
    let short = ("number of lattice points", total, FEWER);
    let pieces: Vec<Vec<[f64; D]>> = pieces.into_iter().collect::<Option<_>>().ok_or(short)?;
    let mut points = Vec::new();
    points
        .try_reserve(pieces.iter().map(Vec::len).sum())
        .map_err(|_| short)?;
    points.extend(pieces.into_iter().flatten());
    Ok(points)
}

pub(super) fn argument((what, value, must_be): Flaw) -> Error {
    Error::Argument(Problem::Parameter {
        what: what.into(),
        value,
        must_be,
    })
}
