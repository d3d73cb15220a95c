//! Particle data: the fields a particle can carry, and the columns that hold them.
//! Bodies are runs of slots; the pair loop reads packed records made from the columns.
//!
//! [`Field`] and [`Output`] list everything with name, unit and shape. [`Fields`] and [`Outputs`] are
//! sets of them that can be constants, so a [term](crate::term) declares what it touches and the
//! compiler knows where each number of a record stands. Effects declare fields and sums of
//! their own by name, with [`Field::scalar`] and its like.

mod columns;
mod field;
mod name;

pub use columns::Columns;
pub use field::{Field, Fields, Output, Outputs};
pub use name::{Name, Shape};
