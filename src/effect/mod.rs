//! Effects: what a scheme is made of, each one file, one value and one equation with its source.
//! A scheme that does not name an effect contains nothing of it: no loop, no column, no law.
//!
//! A scheme is a list of effects on a kernel. What an effect may consist of:
//!
//! | part | what it is | where it stands |
//! |---|---|---|
//! | pair terms | sums over neighbours, each in the sweep of a [`Stage`] | [`Effect::terms`] |
//! | fields and sums of its own | constants with a [`name!`](crate::name) and unit: scalar, vector, symmetric tensor or matrix | [`StepProgram::declare`] for fields of the state |
//! | [evolved](Evolved) fields | integrated in time, by a rate, in an update, at a kick or drift | [`StepProgram::evolve`] |
//! | [laws](PointLaw) | what happens to single particles after the sweep of a stage, as lane text or as a [loop](Law) over columns | [`StepProgram::law`] |
//! | forces on single particles | [`Field::FORCE`](crate::particles::Field::FORCE), which laws of `Stage::Rates` add to | [`StepProgram::law`] |
//! | [smoothing](Smoothing) lengths | how they change, and the loops that this takes | [`Effect::smoothing`], [`Effect::MODES`] |
//! | [limits](PointLimit) of the step | the largest that is stable at a particle | [`StepProgram::limit`] |
//! | a column of the ledger | the sum of a field over every body | [`StepProgram::ledger`] |
//! | energy that it stores or dissipates | fields of both | [`StepProgram::store`], [`StepProgram::dissipate`], [`Effect::BOOKS_ENERGY`] |
//! | requirements | what it asks of materials and integrator | [`StepProgram::require`] |
//!
//! The pair terms of a list fuse into one loop a stage; the rest is objects that a step calls a handful of times.
//! Wall laws ([`ExtrapolatedPressure`], [`HydrostaticWalls`], [`RiemannWalls`]) are effects whose sums and laws belong to the particles of
//! walls, [`Stage::Walls`].
//!
//! [`Stage`]: crate::term::Stage
//! [`Stage::Walls`]: crate::term::Stage::Walls

#[cfg(test)]
mod absent;
mod absorbing_layer;
mod access;
mod acoustic_damping;
mod arbitrary_lagrangian;
mod artificial_conduction;
mod artificial_pressure;
mod artificial_stress;
mod cavitation;
mod chunk;
mod consistent_shifting;
mod continuity;
mod damage;
#[cfg(test)]
mod declared;
mod density;
mod density_diffusion;
mod density_floor;
mod density_form;
mod during;
mod each;
mod eulerian;
mod evolved;
mod finite_strain_plasticity;
mod five_equations;
mod forms;
pub(crate) mod gradients;
mod heat_conduction;
mod hourglass_control;
mod hourglass_free;
mod hyperelastic;
mod hypoelastic;
mod in_plane_stress;
mod lagrangian_liquid;
mod laminar;
mod law;
mod limit;
mod list;
mod mass_exchange;
mod neo_hookean;
mod pairing_control;
#[doc(hidden)]
pub mod parts;
mod plane;
mod plane_stress;
mod plasticity;
mod point;
mod pressure_difference;
mod program;
mod programmed_burn;
mod radial_return;
mod rates;
#[cfg(any(test, feature = "devices"))]
mod recorded;
mod renormalised_hypoelastic;
mod rows;
mod sequence;
mod setting;
mod shifting;
mod smoothing;
mod sponge;
mod st_venant_kirchhoff;
mod surface_area;
mod surface_heat;
mod surface_tension;
mod tension_limit;
mod total_lagrangian;
mod two_phase;
mod uniaxial_stress;
mod viscosity_switch;
mod volume_consistency;
mod walls;
mod yielding_hourglass;

use crate::term::not_negative;

pub use absorbing_layer::AbsorbingLayer;
pub use access::Summed;
pub use acoustic_damping::AcousticDamping;
pub use arbitrary_lagrangian::ArbitraryLagrangian;
pub use artificial_conduction::{ArtificialConduction, ConductionSignal};
pub use artificial_pressure::ArtificialPressure;
pub use artificial_stress::ArtificialStress;
pub use cavitation::{Cavitation, ExpansionMemory};
pub(crate) use chunk::Slices;
pub use chunk::{Around, Chunk};
pub use consistent_shifting::ConsistentShifting;
pub use damage::Damage;
pub use density_diffusion::DensityDiffusion;
pub use density_floor::DensityFloor;
pub use density_form::DensityForm;
pub use during::During;
pub use eulerian::Eulerian;
pub use evolved::{ByField, BySum, Evolved, Rate, Update, View, When};
pub use finite_strain_plasticity::FiniteStrainPlasticity;
pub use five_equations::{FiveEquations, Fluid};
pub use forms::EnergyForm;
pub(crate) use gradients::CorrectedGradients;
pub use heat_conduction::HeatConduction;
pub use hourglass_control::HourglassControl;
pub use hourglass_free::HourglassFree;
pub use hypoelastic::Hypoelastic;
pub use in_plane_stress::InPlaneStress;
pub use lagrangian_liquid::LagrangianLiquid;
pub use laminar::{GeneralisedNewtonian, Laminar};
pub use law::{Law, Tally};
pub(crate) use law::{MOST_LAWS, reads_and_writes};
pub use limit::Limit;
pub use list::{Effect, Effects};
pub use neo_hookean::NeoHookean;
pub use pairing_control::PairingControl;
pub(crate) use parts::*;
pub use plane_stress::PlaneStress;
pub use plasticity::Plasticity;
pub use point::{AtWall, CONSTANTS, Point, PointLaw, PointLimit, PointRate, Reach};
pub use pressure_difference::PressureDifference;
pub use program::{LedgerColumn, Requirement, SceneFacts, StepProgram};
pub use programmed_burn::ProgrammedBurn;
pub use renormalised_hypoelastic::RenormalisedHypoelastic;
pub use sequence::Rung;
pub(crate) use sequence::sequence;
pub use setting::Setting;
pub use shifting::Shifting;
pub use smoothing::{ConsistentSmoothing, DivergenceSmoothing, MixedSpacing, Smoothing};
pub use sponge::Sponge;
pub use st_venant_kirchhoff::StVenantKirchhoff;
pub(crate) use surface_heat::TOTAL_AREA;
pub use surface_heat::{STEFAN_BOLTZMANN, SurfaceHeat};
pub use surface_tension::SurfaceTension;
pub use total_lagrangian::TotalLagrangian;
pub(crate) use total_lagrangian::stretches;
pub use two_phase::{TwoPhase, WithinPhase};
pub use uniaxial_stress::UniaxialStress;
pub(crate) use viscosity_switch::ViscositySwitch;
pub use volume_consistency::VolumeConsistency;
pub use walls::{ExtrapolatedPressure, HydrostaticWalls, NoWalls, RiemannWalls};
pub use yielding_hourglass::YieldingHourglass;
