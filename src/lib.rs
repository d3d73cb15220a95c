//! Smoothed particle hydrodynamics.
#![forbid(unsafe_op_in_unsafe_fn)]
#![warn(missing_docs)]

pub mod boundary;
pub mod error;
pub mod kernel;
pub mod material;
pub mod neighbors;
pub mod output;
pub mod particles;
pub mod scalar;
pub mod sweep;
pub mod tensor;
pub mod term;
