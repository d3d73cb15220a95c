//! Neighbour search: buckets, a space-filling order, and cluster lists with a skin.
//! Useful on its own: points in, lists out, no particles of this crate needed.

mod cells;
mod clusters;
mod hilbert;

pub use cells::{Cells, Grid};
pub use clusters::{Block, CHUNK, ChunkList, ClusterLists, Radii, SearchInput, Segment};
pub use hilbert::hilbert_index;
