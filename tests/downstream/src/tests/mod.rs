//! Short runs with every part, each held against something independent.

mod heat;
mod hypoelastic;
mod parts;
mod two_crates;
