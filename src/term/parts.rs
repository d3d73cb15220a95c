//! Pair terms and lists that ready parts are made of, for tests, benchmarks and packages of this repository.
//! They are no part of the published interface: a release may change them without a word.

pub use super::concentration::ConcentrationGradient;
pub use super::density_sums::{Compression, KernelMoment, SlopeInH, Unity};
pub use super::gradient::{DensityGradient, MomentMatrix, PressureGradient};
pub use super::list::TermList;
pub use super::renormalised::RenormalisedCompression;
pub use super::staged::{StageMarker, StagedTerms};
pub use super::wall::{LiquidNearWall, VelocityAtWall, ViscosityAtWall};
