//! Smoothed particle hydrodynamics.
#![forbid(unsafe_op_in_unsafe_fn)]
#![warn(missing_docs)]

pub mod kernel;
pub mod material;
pub mod scalar;
pub mod study;
pub mod tensor;
