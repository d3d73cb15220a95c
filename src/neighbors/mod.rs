//! Neighbour search: buckets, a space-filling order, and cluster lists with a skin.
//! Useful on its own: points in, lists out, no particles of this crate needed.
//!
//! [`Cells`] sorts points into buckets and runs over those in a box. [`ClusterLists`] gives rows of
//! consecutive points their common list of neighbours, with a skin within which the points may move
//! before the lists must be made anew. [`hilbert_index`] orders cells so that what is near in space is
//! near in memory.
//!
//! ```
//! use meshfree::neighbors::Cells;
//! let points: Vec<[f64; 2]> = (0..100).map(|k| [0.1 * f64::from(k % 10), 0.1 * f64::from(k / 10)]).collect();
//! let all: Vec<u32> = (0..100).collect();
//! let cells = Cells::build(&points, &all, 0.25);
//! let mut near = Vec::new();
//! cells.for_each_run([0.35, 0.35], [0.55, 0.55], |run| near.extend_from_slice(run));
//! near.retain(|&k| (0..2).all(|d| (points[k as usize][d] - 0.45).abs() < 0.1));
//! assert_eq!(near.len(), 4);
//! ```
//!
//! The skin is a trade: lists with a thicker skin are longer, and last longer. In a simulation it is
//! 0.1 of the support, and 0.2 where lists would not last ([`Scene::skin`](crate::scene::Scene::skin)).
//! Lists are made anew when two particles may have come nearer by the skin: when the largest displacement is half of it
//! and, where there are neither images nor outlets, displacements differ by more than it.

mod cells;
mod clusters;
mod hilbert;
mod own_lists;
mod sieve;

pub(crate) use cells::corners_of;
pub use cells::{Cells, Grid};
pub use clusters::{Block, CHUNK, ChunkList, ClusterLists, Order, Radii, SearchInput, Segment};
pub use hilbert::hilbert_index;
pub(crate) use sieve::{LocalBlock, leave_narrow};

/// Entries of the list of a row of `lanes` particles at unit spacing, inside of a body: a ball as wide as the reach and the
/// row.
pub(crate) fn listed_around(dimensions: usize, reach: f64, lanes: usize) -> f64 {
    let row = (lanes as f64).powf(1.0 / dimensions as f64);
    match dimensions {
        1 => 2.0 * reach + row,
        2 => core::f64::consts::PI * (reach + 0.5 * row).powi(2),
        _ => 4.0 / 3.0 * core::f64::consts::PI * (reach + 0.5 * row).powi(3),
    }
}
