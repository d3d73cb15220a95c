//! Particle data: the fields a particle can carry, and the columns that hold them.
//! Bodies are runs of slots; the pair loop reads packed records made from the columns.

mod columns;
mod field;

pub use columns::Columns;
pub use field::{Field, Fields, Output, Outputs, Shape};
