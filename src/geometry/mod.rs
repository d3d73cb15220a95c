//! Shapes by signed distance, booleans of them, and the lattices that fill and surround them.
//! A shape knows no particles; bodies of a scene are filled from one.
//!
//! | shape | D | distance |
//! |---|---|---|
//! | [`Cuboid`] | any | exact |
//! | [`Ball`] | any | exact |
//! | [`HalfSpace`] | any | exact |
//! | [`Cylinder`] | 3 | exact |
//! | `Mesh`, of triangles in an STL file, with the feature `meshes` | 3 | exact |
//! | [`OpenCell`], solid and void | 3 | exact inside the solid, else a bound |
//! | [`union`](Shape::union) | any | exact outside, a bound inside |
//! | [`intersection`](Shape::intersection), [`minus`](Shape::minus) | any | exact inside, a bound outside |
//! | [`complement`](Shape::complement), [`moved`](Shape::moved) | any | as the shape |
//!
//! [`fill`] places particles in a shape on a lattice, [`pack`] so that they follow its surface, [`layers`] those of a wall around one;
//! [`Body::fill`](crate::scene::Body::fill) makes a body in one step.
//!
//! ```
//! use meshfree::geometry::{Ball, Cuboid, Shape, fill};
//! // A plate 4 mm square with a hole of 1 mm radius, a particle every 0.02 mm.
//! let plate = Cuboid::new([0.0; 2], [4e-3; 2]).minus(Ball::new([2e-3; 2], 1e-3));
//! let points = fill(&plate, 2e-5, [0.0; 2])?;
//! let area = points.len() as f64 * 2e-5_f64.powi(2);
//! assert!((area / (16e-6 - std::f64::consts::PI * 1e-6) - 1.0).abs() < 1e-3);
//! # Ok::<(), meshfree::error::Error>(())
//! ```

mod ball;
mod boolean;
mod cuboid;
mod cylinder;
mod half_space;
mod lattice;
#[cfg(feature = "meshes")]
mod mesh;
mod moved;
mod open_cell;
#[cfg(feature = "meshes")]
mod overlap;
mod pack;
#[cfg(feature = "meshes")]
mod rows;
#[cfg(test)]
mod tests;

use crate::scalar::Lane;
use crate::tensor::{Matrix, Vector, length};
use core::fmt::Debug;

pub use ball::Ball;
pub use boolean::{Complement, Intersection, Union};
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use half_space::HalfSpace;
use lattice::is_inside;
pub(crate) use lattice::{FEWER, MOST_PARTICLES, POSITIVE, SWAPPED, filled};
pub use lattice::{fill, layers};
#[cfg(feature = "meshes")]
pub use mesh::Mesh;
pub use moved::Moved;
pub use open_cell::{OpenCell, OpenCellPart};
pub use pack::pack;
pub(crate) use pack::packed;

/// The edge of a cube, square or line of some volume \[mᴰ\].
pub(crate) fn edge<const D: usize>(volume: f64) -> f64 {
    match D {
        1 => volume,
        2 => volume.sqrt(),
        _ => Lane::cbrt(volume),
    }
}

/// What is wrong with a parameter, as `(name, value, what it must be)`.
pub(crate) type Flaw = (&'static str, f64, &'static str);

/// A region of space, given by the distance to its surface.
///
/// ```
/// use meshfree::geometry::Shape;
///
/// /// All within `half` of the diagonal x = y.
/// #[derive(Clone, Copy, Debug)]
/// struct Stripe { half: f64 }
///
/// impl Shape<2> for Stripe {
///     fn signed_distance(&self, x: &[f64; 2]) -> f64 {
///         (x[0] - x[1]).abs() / 2.0_f64.sqrt() - self.half
///     }
///     fn bounds(&self) -> ([f64; 2], [f64; 2]) {
///         ([f64::NEG_INFINITY; 2], [f64::INFINITY; 2])
///     }
/// }
/// assert_eq!(Stripe { half: 0.5 }.complement().signed_distance(&[3.0, 3.0]), 0.5);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a shape in {D} dimensions",
    note = "implement `Shape<{D}>`: the signed distance to the surface, and a box that holds the shape"
)]
pub trait Shape<const D: usize>: Debug + Send + Sync {
    /// Distance \[m\] from `x` \[m\] to the surface, negative inside.
    ///
    /// The sign is always right. The size is exact where the table of the [module](self) says so;
    /// elsewhere it is a bound, at most the distance and never more.
    fn signed_distance(&self, x: &[f64; D]) -> f64;

    /// Lowest and highest corner \[m\] of a box that holds the shape, infinite where it has no end.
    fn bounds(&self) -> ([f64; D], [f64; D]);

    /// Whether points of a `row` are inside: points that differ in their first coordinate alone, which rises. Each point by
    /// its distance if not given.
    ///
    /// [`fill`] asks this of the rows of its lattice; a shape that can decide a row at once gives the points that its distance
    /// gives.
    fn inside_row(&self, row: &[[f64; D]], inside: &mut [bool]) {
        for (x, inside) in row.iter().zip(inside) {
            *inside = is_inside(self.signed_distance(x));
        }
    }

    /// What is wrong with the parameters, as `(field, value, what it must be)`; nothing if not given.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }

    /// What is in this shape or in the other.
    fn union<B: Shape<D>>(self, other: B) -> Union<Self, B>
    where
        Self: Sized,
    {
        Union::new(self, other)
    }

    /// What is in this shape and in the other.
    fn intersection<B: Shape<D>>(self, other: B) -> Intersection<Self, B>
    where
        Self: Sized,
    {
        Intersection::new(self, other)
    }

    /// What is in this shape and not in the other.
    fn minus<B: Shape<D>>(self, other: B) -> Intersection<Self, Complement<B>>
    where
        Self: Sized,
    {
        Intersection::new(self, Complement::new(other))
    }

    /// All that is not in this shape.
    fn complement(self) -> Complement<Self>
    where
        Self: Sized,
    {
        Complement::new(self)
    }

    /// This shape turned about the origin by an orthonormal `rotation`, then moved by `shift` \[m\].
    fn moved(self, rotation: Matrix<f64, D>, shift: [f64; D]) -> Moved<Self, D>
    where
        Self: Sized,
    {
        Moved::new(self, rotation, shift)
    }
}

/// A shape chosen at run time.
impl<const D: usize, S: Shape<D> + ?Sized> Shape<D> for Box<S> {
    fn signed_distance(&self, x: &[f64; D]) -> f64 {
        (**self).signed_distance(x)
    }
    fn bounds(&self) -> ([f64; D], [f64; D]) {
        (**self).bounds()
    }
    fn inside_row(&self, row: &[[f64; D]], inside: &mut [bool]) {
        (**self).inside_row(row, inside);
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        (**self).problems()
    }
}

/// Signed distance \[m\] to a product of regions at right angles to each other, from the signed
/// distance \[m\] to each: a box from its axes, a cylinder from its disc and its length.
fn product<const N: usize>(distances: [f64; N]) -> f64 {
    let largest = distances.into_iter().fold(f64::NEG_INFINITY, f64::max);
    if largest > 0.0 {
        length(&Vector::from(distances.map(|d| d.max(0.0))))
    } else {
        largest
    }
}
