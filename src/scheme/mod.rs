//! Schemes: kernels with lists of effects, as step programs that can be printed.
//! A scheme joins a kernel, a density form with its pressure form, a viscosity, an energy form, and effects.
//!
//! [`SchemeBuilder`] takes the choices, and [`SchemeBuilder::compose`] compiles them into sweeps over
//! pairs, one a [stage](crate::term::Stage) at most, each one loop for all its terms:
//!
//! | sweep | runs | makes |
//! |---|---|---|
//! | density | unless density is integrated | kernel sums, and with them density |
//! | walls | in liquids with walls | what walls take from the liquid |
//! | gradients | if a term asks | ∇v and ∇p, exact for linear fields |
//! | flow | if an effect asks | what follows from gradients |
//! | rates | always | force, power, signal; rate of compression where density is integrated |
//! | continuity | in a drift, where density is integrated | rate of compression at the middle of the drift |
//!
//! What a scheme starts from are effects as well, whose terms are the first of a list:
//!
//! | builder | effects |
//! |---|---|
//! | [`SchemeBuilder::new`] | [`PressureForce`], densities by [`KernelSum`] with contacts, [`InternalEnergy`] |
//! | [`SchemeBuilder::liquid`] | [`PressureForce`], [`Cavitation`] |
//! | [`SchemeBuilder::total_lagrangian`] | [`TotalLagrangian`], [`InternalEnergy`] |
//!
//! [`MidpointReconstruction`] adds to the pressure force; [`MixedSpacing`], [`DivergenceSmoothing`] and
//! [`ConsistentSmoothing`] change smoothing lengths. A function that returns a builder names its list, or
//! `impl Effects<D>`.
//!
//! One more sweep runs once, when the scene is built: it takes the reference configuration from which
//! [`DensityForm::NumberDensity`] and [`DensityForm::Continuity`] measure.
//!
//! # Density and pressure are one choice
//!
//! The pressure force is the derivative of the internal energy under the density in use, so each
//! density form brings its own: weights Bᵢ and coefficients Xᵢ of one pair law.
//!
#![doc = include_str!("../../docs/equations/pressure_force.html")]
//!
//! A pair from two forms loses energy in silence. [`SchemeBuilder::mismatched_pressure_form`] is the
//! explicit way to such a pair, for studies.
//!
//! # Energy
//!
//! With [`EnergyForm::Compatible`] the work that pair forces do in a kick is summed with the mean
//! velocities of that kick, in a second pass over the same pairs with the same forces. What kinetic
//! energy loses in the kick, internal energy gains, to rounding, whatever the forces are and however
//! long the step. [`EnergyForm::Symmetric`] saves that pass, and drifts with the order of the step.
//!
//! Total-Lagrangian schemes need no second pass. Their pairs share out the power −½ Fᵢⱼ·uᵢⱼ of the velocities u with which
//! forces are summed, and each particle adds the work −Fᵢ·(v̄ᵢ − uᵢ) of its own force: the sum is the same. In a leapfrog v̄ − u
//! is of second order in the step, and so is what this moves between neighbours.
//!
//! [`Cavitation`]: crate::effect::Cavitation
//! [`ConsistentSmoothing`]: crate::effect::ConsistentSmoothing
//! [`DivergenceSmoothing`]: crate::effect::DivergenceSmoothing
//! [`InternalEnergy`]: crate::term::InternalEnergy
//! [`KernelSum`]: crate::term::KernelSum
//! [`MidpointReconstruction`]: crate::term::MidpointReconstruction
//! [`MixedSpacing`]: crate::effect::MixedSpacing
//! [`PressureForce`]: crate::term::PressureForce
//! [`TotalLagrangian`]: crate::effect::TotalLagrangian

mod builder;
mod compile;
mod entry;
mod gradients;
mod order;
mod print;
mod start;

pub use crate::effect::{DensityForm, EnergyForm, Shifting, Smoothing};
pub use crate::kernel::KernelFacts;
pub(crate) use builder::DEFAULT_STEP_FACTOR;
#[doc(hidden)]
pub use builder::Renormalise;
pub use builder::SchemeBuilder;
pub(crate) use entry::{Entries, Entry};
pub use start::Start;

use crate::effect::StepProgram;
use crate::kernel::Profile;
use crate::particles::{Field, Fields};
use crate::scalar::Real;
use crate::sweep::{Interaction, PairSweep};
use crate::term::{Stage, TermDoc};

/// A composed scheme: what a group of bodies obeys. Built by [`SchemeBuilder`], or ready in
/// [`schemes`](crate::schemes).
#[derive(Debug)]
pub struct Scheme<T: Real, const D: usize> {
    pub(crate) name: String,
    pub(crate) kernel: KernelFacts,
    /// The kernel itself, for looks at few pairs.
    pub(crate) profile: Profile,
    pub(crate) density: DensityForm,
    pub(crate) pressure_form: DensityForm,
    pub(crate) energy: EnergyForm,
    pub(crate) smoothing: Smoothing,
    pub(crate) h_over_dx: f64,
    pub(crate) step_factor: f64,
    /// Whether sums are divided by the first moment of each particle at rest.
    pub(crate) consistent_at_rest: bool,
    /// What its bodies do to each other where a scene says nothing else.
    pub(crate) between: Interaction,
    /// What is wrong with the kernel.
    pub(crate) kernel_problems: Vec<(&'static str, f64, &'static str)>,
    /// What is wrong with the parameters of its parts.
    pub(crate) problems: Vec<(String, f64, &'static str)>,
    /// The reference configuration from which density forms measure.
    pub(crate) reference: Option<Box<dyn PairSweep<T, D>>>,
    pub(crate) sweeps: [Option<Box<dyn PairSweep<T, D>>>; Stage::COUNT],
    /// First moment of the kernel gradient on the lattice, where particles do not carry their own.
    pub(crate) lattice_consistency_factor: f64,
    /// What its effects do beside their pair terms.
    pub(crate) program: StepProgram<T, D>,
    /// The entries of a step.
    pub(crate) entries: Entries,
}

impl<T: Real, const D: usize> Scheme<T, D> {
    /// The scheme's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Ratio of smoothing length to spacing.
    #[must_use]
    pub fn h_over_dx(&self) -> f64 {
        self.h_over_dx
    }

    /// What the kernel says about itself.
    #[must_use]
    pub fn kernel(&self) -> KernelFacts {
        self.kernel
    }

    /// One pair of each sweep, recorded for a device, with its stage.
    ///
    /// ```
    /// use meshfree::particles::Output;
    /// let scheme = meshfree::schemes::weakly_compressible().compose::<f64, 2>();
    /// let sweeps = scheme.pair_records()?;
    /// assert!(sweeps.iter().any(|(_, pair)| pair.writes.contains(Output::FORCE)));
    /// # Ok::<(), meshfree::scalar::Unrecordable>(())
    /// ```
    ///
    /// # Errors
    ///
    /// If a term, or the kernel, does what cannot be recorded.
    #[cfg(feature = "devices")]
    pub fn pair_records(
        &self,
    ) -> Result<Vec<(Stage, crate::sweep::PairRecord)>, crate::scalar::Unrecordable> {
        use crate::sweep::Pass;
        let all = Stage::ALL.iter();
        all.filter_map(|&stage| {
            let sweep = self.sweep(stage)?;
            Some((stage, sweep.record(Pass::Rates, false)))
        })
        .map(|(stage, record)| Ok((stage, record?)))
        .collect()
    }

    /// The sweep of a stage, if any term names the stage.
    pub(crate) fn sweep(&self, stage: Stage) -> Option<&dyn PairSweep<T, D>> {
        self.sweeps[stage.number()].as_deref()
    }

    /// Whether it has a wall law, and so meets walls of particles and the bodies of schemes that have none.
    pub(crate) fn meets_walls(&self) -> bool {
        self.sweep(Stage::Walls).is_some()
    }

    /// Whether the work of a kick takes a sweep of its own.
    pub(crate) fn sweeps_work(&self) -> bool {
        self.energy == EnergyForm::Compatible && !self.density.keeps_neighbors()
    }

    /// Whether a step has entries in the middle of a drift.
    pub(crate) fn acts_in_drift(&self) -> bool {
        !self.entries.drift.is_empty()
    }

    /// The terms, in the order in which a step meets them, and what else effects do.
    #[must_use]
    pub fn terms(&self) -> Vec<TermDoc> {
        let sweeps = self.sweeps.iter().flatten();
        sweeps
            .flat_map(|sweep| sweep.document())
            .chain(self.program.documents.iter().cloned())
            .collect()
    }

    /// Puts what effects do in a step into another order, as another list of effects does, and then into its own again: for
    /// tests of what its order depends on.
    #[doc(hidden)]
    pub fn permute(&mut self, seed: u64) {
        self.program.permute(seed);
    }

    /// By how much kernels that sample its particles are wider than its own, which on a [lattice that stays](crate::effect::StepProgram::stay)
    /// may be too narrow for a sum over volumes to be one.
    pub(crate) fn widening(&self) -> f64 {
        if self.h_over_dx < self.kernel.range.0 {
            self.kernel.h_over_dx / self.h_over_dx
        } else {
            1.0
        }
    }

    /// The fields that a particle carries under this scheme.
    #[must_use]
    pub fn fields(&self) -> Fields {
        let sweeps = self.sweeps.iter().flatten().chain(&self.reference);
        let mut fields = sweeps.fold(Fields::NONE, |all, sweep| all.union(sweep.fields()));
        fields = fields.union(self.program.fields()).union(Fields::of(&[
            Field::POSITION,
            Field::VELOCITY,
            Field::MASS,
            Field::DENSITY,
            Field::PRESSURE,
            Field::SOUND_SPEED,
            Field::WEIGHT,
            Field::PRESSURE_COEFFICIENT,
        ]));
        if T::COMPENSATED {
            fields = fields.union(Fields::of(&[Field::POSITION_RESIDUAL]));
        }
        if self.density.has_reference() && self.reference.is_some() {
            fields = fields.union(Fields::of(&[
                Field::CONSISTENCY_FACTOR,
                Field::REFERENCE_SUM,
                Field::REFERENCE_DENSITY,
            ]));
        }
        if self.smoothing != Smoothing::Fixed {
            fields = fields.union(Fields::of(&[Field::SMOOTHING_LENGTH]));
        }
        if matches!(self.smoothing, Smoothing::Consistent(_)) {
            fields = fields.union(Fields::of(&[
                Field::FOUND_SMOOTHING_LENGTH,
                Field::SMOOTHING_RATE,
            ]));
        }
        fields
    }

    /// Numbers a particle in the widest record of its sweeps, and in their widest sums.
    pub(crate) fn widths(&self) -> (usize, usize) {
        let all = || self.sweeps.iter().flatten().chain(&self.reference);
        let records = all().map(|sweep| sweep.fields().width(D)).max();
        let sums = all().map(|sweep| sweep.outputs().width(D)).max();
        (records.unwrap_or(0), sums.unwrap_or(0))
    }
}
