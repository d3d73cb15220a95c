//! Parts of a user's own, written against the published surface of meshfree: one file each, as short as they can be.
//! Each is used in a short run whose result is held against something independent of the crate.

pub mod boundary;
pub mod coupling;
pub mod eos;
pub mod heat;
pub mod hypoelastic;
pub mod integrator;
pub mod kernel;
pub mod motion;
pub mod pump;
pub mod shape;
pub mod viscosity;
pub mod wall;

#[cfg(test)]
mod tests;
