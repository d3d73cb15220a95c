//! Pair terms and records that effects are made of, for tests, benchmarks and packages of this repository.
//! They are no part of the published interface: a release may change them without a word.

pub use super::artificial_conduction::EnergyGradient;
pub use super::artificial_pressure::TensionRepulsion;
pub use super::artificial_stress::Repulsion;
pub use super::consistent_shifting::{Crowding, ShiftedContinuity};
pub use super::five_equations::{FluidFluxes, FluidGradients};
pub use super::heat_conduction::HeatFlow;
pub use super::hourglass_free::VelocityMismatch;
pub use super::mass_exchange::Exchange;
pub use super::pairing_control::NearPairs;
pub use super::pressure_difference::PressureSlope;
#[cfg(any(test, feature = "devices"))]
pub use super::recorded::{PointRecord, point_records};
pub use super::surface_area::VolumeGradient;
pub use super::surface_tension::{ColourGradient, InterfaceCurvature};
pub use super::total_lagrangian::{DisplacementGradient, ReferenceMoment, StressForce};
pub use super::volume_consistency::SummedMass;
pub use super::walls::VelocityBeforeWall;
