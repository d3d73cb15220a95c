//! Pair terms: one effect a file, each with its equation, its source, and the fields it touches.
//! A term adds to the sums of a pair; the sweep applies directions, so a tuple costs what fused code costs.
//!
//! A [`Term`] names the fields that it reads and the sums that it writes as constants. A particle
//! carries the union of what the terms of its scheme name, and nothing else. A tuple of terms is a list
//! that shares one loop over pairs.
//!
//! | term | equation of | makes |
//! |---|---|---|
//! | [`KernelSum`], [`Unity`], [`KernelMoment`], [`SlopeInH`] | density | sums that density is made of |
//! | [`Compression`] | density | rate of compression |
//! | [`VelocityGradient`], [`PressureGradient`] | – | gradients for viscosities and curvature |
//! | [`PressureForce`], [`MidpointReconstruction`] | momentum | force |
//! | [`Viscosity`] | momentum | force and signal of an [artificial viscosity](viscosity) |
//! | [`InternalEnergy`] | energy | half the power of all forces |
//! | [`RenormalisedPressureForce`], [`RenormalisedCompression`] | momentum, density | the same with corrected gradients |
//! | [`MatrixPressureForce`] | momentum, energy | force of gases with gradients from inverted matrices |
//! | [`LaminarViscosity`], [`CentralViscosity`] | momentum | force of a physical viscosity |
//! | [`Molteni`], [`Fourtakas`], [`Antuono`], [`RiemannDiffusion`] | density | diffusion against noise |
//! | [`ConcentrationGradient`] | position | what shifting needs |
//! | [`LiquidNearWall`], [`VelocityAtWall`], [`ViscosityAtWall`] | walls | what wall particles take from the liquid |
//!
//! [`probe()`] evaluates a term for one pair, for tests of terms of your own.
//!
//! A force is set as its component along rᵢⱼ or along vᵢⱼ, which must be symmetric in i and j, or as a vector
//! ([`FreeForce`]), which must change its sign with them. Then it is opposite for the two, and the scheme
//! conserves momentum; angular momentum too where it lies along rᵢⱼ.
//!
//! # Artificial viscosity
//!
//! A viscosity is a term of fixed form, of which only Π differs:
//!
#![doc = include_str!("../../docs/equations/viscous_force.html")]
//!
//! The law of Monaghan & Gingold,
//!
#![doc = include_str!("../../docs/equations/monaghan_gingold.html")]
//!
//! acts wherever particles approach, in a smooth compression too. The limited form leaves it only the
//! jump that linear reconstruction from both sides does not explain:
//!
#![doc = include_str!("../../docs/equations/limited_jump.html")]
//!
//! Other laws let α follow the flow of each particle, as Morris & Monaghan do:
//!
#![doc = include_str!("../../docs/equations/morris_monaghan.html")]
//!
//! # A viscosity of your own
//!
//! ```
//! use meshfree::particles::{Field, Fields};
//! use meshfree::prelude::*;
//! use meshfree::term::{Layout, Pair, TermDoc, Viscous};
//!
//! /// The quadratic law of von Neumann & Richtmyer, Π = β μ²/ρ̄ for approaching pairs.
//! #[derive(Clone, Debug)]
//! struct Quadratic {
//!     beta: f64,
//! }
//!
//! impl<const D: usize> ArtificialViscosity<D> for Quadratic {
//!     const READS: Fields = Fields::NONE;
//!     #[inline(always)]
//!     fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
//!         let approach = (-pair.v_dot_r).positive_part();
//!         let mu = pair.h * approach / pair.h.mul_add(pair.h * L::of(0.01), pair.r2);
//!         let density = (pair.i(Field::DENSITY) + pair.j(Field::DENSITY)) * L::of(0.5);
//!         Viscous {
//!             pi: mu * mu * L::of(self.beta) / density,
//!             signal: mu * L::of(0.6 * self.beta),
//!         }
//!     }
//!     fn document(&self) -> TermDoc {
//!         TermDoc {
//!             name: format!("quadratic viscosity, β = {}", self.beta),
//!             equation: "Π = β μ²/ρ̄, μ = h |v·r|/(r² + 0.01 h²), v·r < 0",
//!             source: "von Neumann & Richtmyer 1950",
//!         }
//!     }
//! }
//!
//! let scheme = SchemeBuilder::new(CubicSpline, Quadratic { beta: 2.0 })
//!     .density(DensityForm::NumberDensity);
//! let mut simulation = Scene::<f64, 1>::new(scheme)
//!     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
//!     .boundary(MirrorPlane::wall([0.01], [1.0]))
//!     .build()?;
//! simulation.run_until(2e-7)?;
//! assert!(simulation.scheme().to_string().contains("quadratic viscosity, β = 2"));
//! # Ok::<(), Error>(())
//! ```

use crate::particles::{Fields, Outputs};
use crate::scalar::Lane;
use core::fmt::Debug;

mod concentration;
mod density_diffusion;
mod density_sums;
mod force;
mod gradient;
mod laminar_viscosity;
mod limiter;
mod list;
mod matrix;
mod momentum;
mod pair;
#[doc(hidden)]
pub mod parts;
mod probe;
mod renormalised;
mod staged;
mod stages;
mod sums;
pub mod viscosity;
mod wall;

pub use concentration::Nothing;
pub use density_diffusion::{Antuono, Fourtakas, Molteni, RiemannDiffusion};
pub use density_sums::KernelSum;
pub use force::{Along, FreeForce};
pub use gradient::VelocityGradient;
pub use laminar_viscosity::{CentralViscosity, LaminarViscosity};
pub(crate) use limiter::left_of_jump;
pub(crate) use list::{ByName, Join};
pub use list::{Names, Terms};
pub use matrix::MatrixPressureForce;
pub use momentum::{InternalEnergy, MidpointReconstruction, PressureForce};
pub(crate) use pair::assert_room;
pub use pair::{Layout, MOST_READS, MOST_SUMS, Pair};
pub(crate) use parts::*;
pub use probe::{Probe, probe};
pub use renormalised::RenormalisedPressureForce;
pub(crate) use renormalised::corrected;
pub use staged::{In, stage};
pub use stages::Stage;
pub use sums::Sums;
pub use viscosity::{ArtificialViscosity, Viscosity, Viscous};

/// What a term is, for people: printed by a scheme and collected in the documentation.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct TermDoc {
    /// The field's name of the effect.
    pub name: String,
    /// The equation, in plain text.
    pub equation: &'static str,
    /// Author, year and equation number.
    pub source: &'static str,
}

#[doc(hidden)]
/// A term of a sweep, for the check of a scheme's order and for people.
#[derive(Clone, Debug, PartialEq)]
pub struct TermUse {
    /// Its [name](Term::NAME).
    pub name: &'static str,
    /// What it is, for people.
    pub document: TermDoc,
    /// Its debug text, with its parameters.
    pub text: String,
    /// What it reads.
    pub reads: Fields,
    /// What it writes.
    pub writes: Outputs,
}

impl TermUse {
    pub(crate) fn of<const D: usize, A: Term<D>>(term: &A) -> Self {
        Self {
            name: A::NAME,
            document: term.document(),
            text: format!("{term:?}"),
            reads: A::READS,
            writes: A::WRITES,
        }
    }
}

/// One effect between pairs of particles.
///
/// Mark [`pair`](Term::pair), and every function that it calls, `#[inline(always)]`. The pair loop is compiled
/// for wider instructions than the rest of a program, and what is not inlined into it runs without them, several
/// times slower. A closure that a loop calls counts as such a function.
///
/// Write it with the arithmetic of lanes and [`Lane::select`] only, so that it can be
/// [recorded](crate::scalar::Record). The sweep borrows the term, so a table that it holds is not copied.
///
/// ```
/// use meshfree::name;
/// use meshfree::particles::{Field, Fields, Output, Outputs};
/// use meshfree::scalar::Lane;
/// use meshfree::term::{Layout, Pair, Sums, Term, TermDoc};
///
/// const SUMMED: Output = Output::scalar(name!("summed_density", "kg/m³"));
///
/// /// Counts mass within the support, weighted with the kernel: the summed density.
/// #[derive(Clone, Debug)]
/// struct SummedDensity;
///
/// impl<const D: usize> Term<D> for SummedDensity {
///     const NAME: &'static str = "mine::summed_density";
///     const READS: Fields = Fields::of(&[Field::MASS]);
///     const WRITES: Outputs = Outputs::of(&[SUMMED]);
///     #[inline(always)]
///     fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
///         sums.add(SUMMED, pair.j(Field::MASS) * pair.w);
///     }
///     fn document(&self) -> TermDoc {
///         TermDoc { name: "summed density".into(), equation: "ρᵢ = Σⱼ mⱼ Wᵢⱼ", source: "Gingold & Monaghan 1977" }
///     }
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a pair term in {D} dimensions",
    note = "implement `Term<{D}>`: its name, the fields it reads and writes, and what a pair adds to the sums"
)]
pub trait Term<const D: usize>: Clone + Debug + Send + Sync + 'static {
    /// The package and the name there, as `meshfree::pressure_force`. Terms of effects run in the order of these names, so that
    /// the order of a list of effects changes no bit. A scheme that has two terms of one name in a sweep is refused. A
    /// term that restricts another, as [`WithinPhase`](crate::effect::WithinPhase), has the name of that.
    const NAME: &'static str;
    /// Fields of i and j that the term reads, in addition to the position.
    const READS: Fields;
    /// Sums that the term adds to. A term that sets `radial`, `shear` or `force` names
    /// [`Output::FORCE`](crate::particles::Output::FORCE).
    const WRITES: Outputs;
    /// Those of `READS` that carry tension, of which two sides of a contact that may open see only the
    /// compression: of a scalar (positive in compression) its positive part, of a symmetric tensor (positive
    /// in tension) its [compressive part](crate::tensor::Symmetric::compressive_part), of a vector or matrix
    /// nothing.
    ///
    /// Unless a term says otherwise, [what counts as a stress](Fields::stresses). Name here a pressure of your
    /// own; leave out a tensor that is no stress. What one term of a sweep names counts for all of them.
    const TENSILE: Fields = Self::READS.stresses();
    /// Adds what this pair contributes. A force on i must be the opposite of that on j.
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>);
    /// What the term is, for people.
    fn document(&self) -> TermDoc;
    /// What is wrong with its parameters, as `(field, value, what it must be)`. [`DensityDiffusion`](crate::effect::DensityDiffusion)
    /// asks its term; an effect that is its own term says it as [`Effect::problems`](crate::effect::Effect::problems).
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}

/// The parameters that are negative or not finite.
pub(crate) fn not_negative(
    parameters: &[(&'static str, f64)],
) -> Vec<(&'static str, f64, &'static str)> {
    parameters
        .iter()
        .filter(|(_, value)| !(value.is_finite() && *value >= 0.0))
        .map(|&(name, value)| (name, value, "it must be finite and not negative"))
        .collect()
}

/// Calls a macro with one term of each kind, as expressions separated by commas, after whatever else it is
/// given. Every test and benchmark that runs over all terms takes them from here.
///
/// ```
/// use meshfree::term::Term;
/// fn writes<T: Term<2>>(_term: &T) -> usize {
///     T::WRITES.iter().count()
/// }
/// macro_rules! most {
///     ($least:literal: $($term:expr),*) => { [$least, $(writes(&$term)),*].into_iter().max() };
/// }
/// assert_eq!(meshfree::for_each_term!(most 1:), Some(7));
/// ```
#[macro_export]
macro_rules! for_each_term {
    ($callback:ident $($given:tt)*) => {
        $callback! {
            $($given)*
            $crate::term::PressureForce,
            $crate::term::MidpointReconstruction { strength: 1.0 / 3.0 },
            $crate::term::InternalEnergy,
            $crate::term::KernelSum,
            $crate::term::parts::Unity,
            $crate::term::parts::KernelMoment,
            $crate::term::parts::SlopeInH,
            $crate::term::parts::Compression,
            $crate::term::VelocityGradient,
            $crate::term::parts::PressureGradient,
            $crate::term::parts::DensityGradient,
            $crate::term::parts::MomentMatrix,
            $crate::term::LaminarViscosity,
            $crate::term::CentralViscosity,
            $crate::term::Molteni::default(),
            $crate::term::Fourtakas::default(),
            $crate::term::Antuono::default(),
            $crate::term::RiemannDiffusion,
            $crate::term::parts::ConcentrationGradient { repulsion: 0.2, at_spacing: 1.0 },
            $crate::term::parts::LiquidNearWall,
            $crate::term::parts::VelocityAtWall,
            $crate::term::parts::ViscosityAtWall,
            $crate::effect::parts::VelocityBeforeWall,
            $crate::effect::ArtificialConduction::default(),
            $crate::effect::Hypoelastic,
            $crate::effect::RenormalisedHypoelastic,
            $crate::effect::parts::Repulsion { exponent: 4, over_kernel_at_spacing: 1.0 },
            $crate::effect::parts::TensionRepulsion {
                of: $crate::effect::ArtificialPressure { share: 0.3, exponent: 4 },
                over_kernel_at_spacing: 1.0
            },
            $crate::effect::parts::NearPairs { over_kernel_at_spacing: 20.0 },
            $crate::effect::parts::SummedMass,
            $crate::effect::parts::Crowding { over_kernel_at_spacing: 20.0 },
            $crate::effect::parts::ShiftedContinuity,
            $crate::effect::parts::Exchange::<false, true>,
            $crate::effect::parts::Exchange::<true, true>,
            $crate::effect::parts::FluidGradients,
            $crate::effect::parts::FluidFluxes($crate::effect::FiveEquations::new(
                $crate::material::eos::StiffenedGas::new(4.4, 2.0, 1.0),
                $crate::material::eos::IdealGas::new(1.4, 1.2)
            )),
            $crate::effect::parts::PressureSlope,
            $crate::effect::TwoPhase::default(),
            $crate::effect::WithinPhase($crate::term::Fourtakas::default()),
            $crate::effect::parts::ColourGradient,
            $crate::effect::parts::InterfaceCurvature,
            $crate::effect::parts::HeatFlow { moment: 1.0 },
            $crate::effect::parts::VolumeGradient,
            $crate::effect::HourglassFree::default(),
            $crate::effect::parts::VelocityMismatch,
            $crate::effect::parts::ReferenceMoment,
            $crate::effect::parts::DisplacementGradient,
            $crate::effect::parts::StressForce,
            $crate::effect::HourglassControl::default(),
            $crate::term::RenormalisedPressureForce,
            $crate::term::parts::RenormalisedCompression,
            $crate::term::MatrixPressureForce,
            $crate::effect::parts::EnergyGradient,
            $crate::term::Viscosity($crate::term::viscosity::Inviscid),
            $crate::term::Viscosity($crate::term::viscosity::MonaghanGingold::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::LimitedMonaghanGingold::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::SignalVelocity::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::Balsara::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::MorrisMonaghan::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::CullenDehnen::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::Riemann::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::LamPrinted { alpha: 1.0, beta: 2.0 })
        }
    };
}
