//! Smoothed particle hydrodynamics.
#![forbid(unsafe_op_in_unsafe_fn)]
#![warn(missing_docs)]

pub mod boundary;
pub mod error;
pub mod integrator;
pub mod kernel;
pub mod material;
pub mod neighbors;
pub mod particles;
pub mod scalar;
pub mod scheme;
pub mod sweep;
pub mod tensor;
pub mod term;
