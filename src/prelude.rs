//! What most programs name, in one line: `use meshfree::prelude::*;`.
//!
//! Everything here lives in the module that explains it; this module only gathers names. The crate's
//! `Result` is not among them, so the standard one keeps its name.

#[doc(no_inline)]
pub use crate::boundary::{
    Boundary, Composed, Crush, Inlet, LeesEdwards, MirrorPlane, Motion, Outlet, Periodic, Recorded,
    Rotation, Translation, Wall,
};
#[doc(no_inline)]
pub use crate::coupling::{ContactDensity, Coupling, Joint, Penalty, Tied};
#[doc(no_inline)]
pub use crate::effect::{
    AcousticDamping, Cavitation, ConsistentSmoothing, DensityDiffusion, DivergenceSmoothing,
    Effect, Effects, ExpansionMemory, ExtrapolatedPressure, GeneralisedNewtonian, Hypoelastic,
    Laminar, MixedSpacing, NeoHookean, Plasticity, RiemannWalls, StVenantKirchhoff,
    VolumeConsistency,
};
#[doc(no_inline)]
pub use crate::error::{BuildError, Error};
#[doc(no_inline)]
pub use crate::geometry::{Ball, Cuboid, Cylinder, HalfSpace, OpenCell, Shape};
#[doc(no_inline)]
pub use crate::integrator::{
    DriftKickDrift, Integrator, KickDriftKick, LamLeapfrog, Midpoint, PositionVerlet, RungeKutta4,
    StrongStabilityPreserving3, System,
};
#[doc(no_inline)]
pub use crate::kernel::{
    CubicSpline, Gaussian, Kernel, QuarticSpline, QuinticSpline, WendlandC2, WendlandC4, WendlandC6,
};
#[doc(no_inline)]
pub use crate::material::eos::{EosState, EquationOfState, Guards, IdealGas, Linear, Tait};
#[doc(no_inline)]
pub use crate::material::{Liquid, Material, SoundSpeed, catalogue};
#[doc(no_inline)]
pub use crate::observe::{PressureProbe, WaveGauge};
#[doc(no_inline)]
pub use crate::output::csv::CsvWriter;
#[doc(no_inline)]
pub use crate::output::svg::{Axis, Cloud, Figure, Panel, Series};
#[doc(no_inline)]
pub use crate::particles::{Field, Fields};
#[doc(no_inline)]
pub use crate::run::{Run, Schedule, Stop};
#[doc(no_inline)]
pub use crate::scalar::{Lane, Real};
#[doc(no_inline)]
pub use crate::scene::{Body, Scene};
#[doc(no_inline)]
pub use crate::scheme::{DensityForm, EnergyForm, Scheme, SchemeBuilder, Shifting, Smoothing};
#[doc(no_inline)]
pub use crate::schemes;
#[doc(no_inline)]
pub use crate::simulation::{Ledger, Load, Simulation, StepControl};
#[doc(no_inline)]
pub use crate::sweep::Interaction;
#[doc(no_inline)]
pub use crate::term::viscosity::ArtificialViscosity;
