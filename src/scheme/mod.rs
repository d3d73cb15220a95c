//! Schemes: named lists of terms that can be printed.
//! A scheme joins a kernel, a density form with its pressure form, a viscosity, and an energy form.
//!
//! [`SchemeBuilder`] takes the choices, and [`SchemeBuilder::compose`] compiles them into sweeps over
//! pairs. At most four run in an evaluation, each one loop for all its terms:
//!
//! | sweep | runs | makes |
//! |---|---|---|
//! | sums | unless density is integrated | kernel sums, and with them density |
//! | gradient | if the viscosity or the curvature asks | ∇v and ∇p, exact for linear fields |
//! | rates | always | force, power, signal; rate of compression where density is integrated |
//! | compression | in a drift, where density is integrated | rate of compression at the middle of the drift |
//!
//! A fifth sweep runs once, when the scene is built: it takes the sums at rest from which
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

mod builder;
mod density;
mod lattice;
mod liquid;
mod shifting;

pub use builder::{DEFAULT_STEP_FACTOR, SchemeBuilder};
pub use density::DensityForm;
pub(crate) use liquid::Liquid;
pub use liquid::{LiquidBuilder, ONE_EVALUATION_STEP};
pub use shifting::Shifting;

use crate::kernel::Kernel;
use crate::particles::{Field, Fields};
use crate::scalar::Real;
use crate::sweep::PairSweep;
use crate::term::{TermDoc, viscosity::Switch};
use core::fmt;

/// How internal energy follows from the work of pair forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum EnergyForm {
    /// Not carried: the materials do not ask for it.
    None,
    /// Each side takes half the power of every pair force; total energy drifts with the order of the
    /// step (Monaghan & Gingold 1983).
    ///
    #[doc = include_str!("../../docs/equations/energy_symmetric.html")]
    Symmetric,
    /// The work of every pair force with the mean velocity of each kick, so that total energy is
    /// conserved to rounding whatever the forces are (Owen 2014). Needs an integrator that kicks, and
    /// a second pass over the pairs of each kick.
    ///
    #[doc = include_str!("../../docs/equations/energy_compatible.html")]
    #[default]
    Compatible,
}

/// How the smoothing length changes.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Smoothing {
    /// Fixed, h = η dx for every body.
    #[default]
    Fixed,
    /// Follows the divergence within limits, as LS-DYNA does (Vesenjak & Ren 2007, eq. 6).
    ///
    #[doc = include_str!("../../docs/equations/smoothing_divergence.html")]
    Divergence {
        /// Smallest h in units of the first.
        smallest: f64,
        /// Largest h in units of the first.
        largest: f64,
    },
    /// Solved together with the density, with grad-h terms: η is h/dx
    /// (Springel & Hernquist 2002; Price 2012).
    ///
    #[doc = include_str!("../../docs/equations/smoothing_consistent.html")]
    Consistent {
        /// Smallest h in units of the first.
        smallest: f64,
        /// Largest h in units of the first.
        largest: f64,
    },
}

/// What the scheme's kernel says about itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KernelFacts {
    /// Its name.
    pub name: &'static str,
    /// Support in units of h.
    pub support: f64,
    /// Recommended h/dx.
    pub h_over_dx: f64,
    /// Accepted h/dx.
    pub range: (f64, f64),
    /// Stable step of an undamped leapfrog in h/c.
    pub stable_step: f64,
}

impl KernelFacts {
    fn of<const D: usize>(kernel: &impl Kernel<D>) -> Self {
        Self {
            name: kernel.name(),
            support: kernel.support(),
            h_over_dx: kernel.h_over_dx(),
            range: kernel.h_over_dx_range(),
            stable_step: kernel.stable_step(),
        }
    }
}

/// A composed scheme: what a group of bodies obeys. Built by [`SchemeBuilder`], or ready in
/// [`schemes`](crate::schemes).
#[derive(Debug)]
pub struct Scheme<T: Real, const D: usize> {
    pub(crate) name: String,
    pub(crate) kernel: KernelFacts,
    pub(crate) density: DensityForm,
    pub(crate) pressure_form: DensityForm,
    pub(crate) energy: EnergyForm,
    pub(crate) smoothing: Smoothing,
    pub(crate) h_over_dx: f64,
    pub(crate) step_factor: f64,
    pub(crate) normalised: bool,
    pub(crate) viscosity_problems: Vec<(&'static str, f64, &'static str)>,
    pub(crate) kernel_problems: Vec<(&'static str, f64, &'static str)>,
    pub(crate) switch: Option<Switch>,
    pub(crate) reference: Option<Box<dyn PairSweep<T, D>>>,
    pub(crate) sums: Option<Box<dyn PairSweep<T, D>>>,
    pub(crate) compression: Option<Box<dyn PairSweep<T, D>>>,
    pub(crate) gradient: Option<Box<dyn PairSweep<T, D>>>,
    pub(crate) rates: Box<dyn PairSweep<T, D>>,
    pub(crate) liquid: Option<Liquid<T, D>>,
    /// First moment of the kernel gradient on the lattice, where particles do not carry their own.
    pub(crate) lattice_moment: f64,
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

    /// Whether the forces' sweep sums compression too, so that density is kicked with velocity.
    pub(crate) fn kicks_density(&self) -> bool {
        self.liquid.is_some() && self.compression.is_none()
    }

    /// Whether walls meet its liquid as in a Riemann problem.
    pub(crate) fn has_riemann_walls(&self) -> bool {
        self.liquid.as_ref().is_some_and(|own| own.riemann_walls)
    }

    /// Whether it has what a second criterion can keep: corrections without gradients of density, which follow
    /// sound, or viscosities that follow the shear rate.
    pub(crate) fn has_slow_fields(&self) -> bool {
        let fields = self.fields();
        let corrected =
            fields.contains(Field::Correction) && !fields.contains(Field::DensityGradient);
        corrected || (self.liquid.as_ref()).is_some_and(|liquid| liquid.shear.is_some())
    }

    /// All sweeps, in the order in which a step runs them.
    fn sweeps(&self) -> impl Iterator<Item = &dyn PairSweep<T, D>> {
        let optional = [&self.sums, &self.compression, &self.gradient];
        optional
            .into_iter()
            .filter_map(|sweep| sweep.as_deref())
            .chain(self.liquid.iter().map(|liquid| liquid.wall.as_ref()))
            .chain(
                self.liquid
                    .iter()
                    .filter_map(|liquid| liquid.shear.as_deref()),
            )
            .chain(core::iter::once(self.rates.as_ref()))
    }

    /// The terms, in the order in which a step meets them.
    #[must_use]
    pub fn terms(&self) -> Vec<TermDoc> {
        let liquid = self.liquid.as_ref();
        let damping = liquid.and_then(|own| own.acoustic_damping);
        let damping = damping.map(|strength| TermDoc {
            name: format!("bulk viscosity against sound, λ = {strength}"),
            equation: "p ← p − λ ρ c h ∇·v",
            source: "after Sun, Pilloton, Antuono & Colagrossi 2023",
        });
        let consistency = liquid.and_then(|own| own.volume_consistency);
        let consistency = consistency.map(|(strength, _)| TermDoc {
            name: format!("volume consistency, κ = {strength}"),
            equation: "dρᵢ/dt += κ (c/h) ρᵢ (uᵢ/u₀ − 1)",
            source: "after Colagrossi & Landrini 2003",
        });
        let dual = liquid.filter(|own| own.dual_criteria);
        let dual = dual.map(|_| TermDoc {
            name: "corrections and viscosities once an advection step".into(),
            equation: "kept until a particle has moved by half the skin, or for h²/(4 ν)",
            source: "after Zhang, Rezavand & Hu 2020",
        });
        let walls = liquid.filter(|own| own.riemann_walls);
        let walls = walls.map(|_| TermDoc {
            name: "walls as one-sided Riemann problems".into(),
            equation: "p_w ← p_w + 2 ρ β u, u = (Σ v_f W / Σ W − v_wall)·n, β = min(6 |u|, c)",
            source: "after Zhang, Hu & Adams 2017, eqs. 13, 14",
        });
        let tearing = liquid.filter(|own| own.reversible_tearing);
        let tearing = tearing.map(|_| TermDoc {
            name: "reversible tearing".into(),
            equation: "ρ = ρ_t while τ = ln(ρ/ρ_t) by continuity is below 0, τ ≥ −1",
            source: "of this crate",
        });
        self.sweeps()
            .flat_map(PairSweep::document)
            .chain(damping)
            .chain(consistency)
            .chain(walls)
            .chain(tearing)
            .chain(dual)
            .collect()
    }

    /// The fields that a particle carries under this scheme.
    #[must_use]
    pub fn fields(&self) -> Fields {
        let mut fields = self
            .sweeps()
            .chain(self.reference.as_deref())
            .fold(Fields::NONE, |all, sweep| all.union(sweep.fields()));
        fields = fields.union(Fields::of(&[
            Field::Position,
            Field::Velocity,
            Field::Mass,
            Field::Density,
            Field::Pressure,
            Field::SoundSpeed,
            Field::Weight,
            Field::PressureCoefficient,
        ]));
        if T::COMPENSATED {
            fields = fields.union(Fields::of(&[Field::PositionResidual]));
            if self.density.is_integrated() {
                fields = fields.union(Fields::of(&[Field::DensityResidual]));
            }
        }
        if self.energy != EnergyForm::None {
            fields = fields.union(Fields::of(&[Field::Energy]));
        }
        if self.energy == EnergyForm::Compatible {
            fields = fields.union(Fields::of(&[Field::MeanVelocity]));
        }
        if self.density.has_reference() && self.reference.is_some() {
            fields = fields.union(Fields::of(&[
                Field::Normalisation,
                Field::ReferenceSum,
                Field::ReferenceDensity,
            ]));
        }
        if self.smoothing != Smoothing::Fixed {
            fields = fields.union(Fields::of(&[Field::SmoothingLength]));
        }
        if matches!(self.smoothing, Smoothing::Consistent { .. }) {
            fields = fields.union(Fields::of(&[Field::GradH]));
        }
        let damped = |liquid: &Liquid<T, D>| liquid.acoustic_damping.is_some();
        if self.liquid.as_ref().is_some_and(damped) {
            fields = fields.union(Fields::of(&[Field::Divergence]));
        }
        let tears = |liquid: &Liquid<T, D>| liquid.reversible_tearing;
        if self.liquid.as_ref().is_some_and(tears) {
            fields = fields.union(Fields::of(&[Field::Tear]));
        }
        match self.switch {
            Some(Switch::CullenDehnen { .. }) => {
                // In one dimension there is no shear to tell from a shock.
                let shear: &[Field] = if D > 1 {
                    &[Field::VelocityGradient]
                } else {
                    &[]
                };
                fields.union(Fields::of(shear)).union(Fields::of(&[
                    Field::ViscosityCoefficient,
                    Field::Divergence,
                ]))
            }
            Some(Switch::MorrisMonaghan { .. }) => {
                fields.union(Fields::of(&[Field::ViscosityCoefficient]))
            }
            None => fields,
        }
    }

    /// Numbers a particle in the widest record of its sweeps, and in their widest sums.
    pub(crate) fn widths(&self) -> (usize, usize) {
        let all = || self.sweeps().chain(self.reference.as_deref());
        let records = all().map(|sweep| sweep.fields().width(D)).max();
        let sums = all().map(|sweep| sweep.outputs().width(D)).max();
        (records.unwrap_or(0), sums.unwrap_or(0))
    }

    /// The coefficient of artificial viscosity that a particle starts with, where it has its own.
    pub(crate) fn starting_coefficient(&self) -> f64 {
        self.switch.map_or(0.0, |switch| switch.start())
    }
}

impl<T: Real, const D: usize> fmt::Display for Scheme<T, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{}: {} kernel, h/dx {}, density by {}, energy {:?}, smoothing {:?}",
            self.name, self.kernel.name, self.h_over_dx, self.density, self.energy, self.smoothing
        )?;
        for term in self.terms() {
            writeln!(f, "  {}: {}  [{}]", term.name, term.equation, term.source)?;
        }
        let fields: Vec<_> = self.fields().iter().map(Field::name).collect();
        write!(f, "  carries {}", fields.join(", "))
    }
}
