//! Smoothed particle hydrodynamics.
#![warn(missing_docs)]

pub mod boundary;
pub mod error;
pub mod integrator;
pub mod kernel;
pub mod material;
pub mod neighbors;
pub mod output;
pub mod particles;
pub mod scalar;
pub mod scene;
pub mod scheme;
pub mod schemes;
pub mod simulation;
pub mod study;
pub mod sweep;
pub mod tensor;
pub mod term;
