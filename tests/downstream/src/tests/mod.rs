//! Short runs with every part, each held against something independent.

mod bodies;
mod heat;
mod hypoelastic;
mod parts;
mod pump;
mod two_crates;
