//! The builder of schemes: the choices, which `compile` turns into sweeps over pairs.
//! What its type rules out leaves no loop behind.

use super::force::{ENERGY, REFERENCE};
use super::{EnergyForm, Scheme, Smoothing};
use crate::effect::{
    Cavitation, DensityDiffusion, DensityForm, Effect, Effects, ExtrapolatedPressure, NoWalls,
    TotalLagrangian,
};
use crate::kernel::Kernel;
use crate::scalar::Real;
use crate::sweep::{Interaction, SmoothingMode};
use crate::term::ArtificialViscosity;

/// Chooses the parts of a scheme: a kernel, an artificial viscosity, forms of density and energy, how walls
/// answer, and a list of [effects](crate::effect).
///
/// ```
/// use meshfree::kernel::CubicSpline;
/// use meshfree::scheme::{DensityForm, EnergyForm, Scheme, SchemeBuilder};
/// use meshfree::term::viscosity::MonaghanGingold;
///
/// let scheme: Scheme<f64, 1> = SchemeBuilder::new(CubicSpline, MonaghanGingold::default())
///     .density(DensityForm::Continuity)
///     .energy(EnergyForm::Compatible)
///     .compose();
/// println!("{scheme}");
/// ```
///
/// The type says what is compiled: kernel `K`, viscosity `V`, wall law `W`, effects `E` as nested pairs,
/// the ways in which pairs get their smoothing length, and forms of the force.
#[derive(Clone, Debug)]
pub struct SchemeBuilder<
    K,
    V,
    W = NoWalls,
    E = (),
    const MODES: u8 = { SmoothingMode::Uniform.bit() },
    const FORCE: u8 = ENERGY,
> {
    pub(super) kernel: K,
    pub(super) viscosity: V,
    pub(super) walls: W,
    pub(super) effects: E,
    pub(super) settings: Settings,
}

/// The choices that are no types.
#[derive(Clone, Debug)]
pub(super) struct Settings {
    pub name: String,
    pub density: DensityForm,
    pub pressure_form: Option<DensityForm>,
    pub energy: EnergyForm,
    pub smoothing: Smoothing,
    pub consistency: Consistency,
    pub h_over_dx: Option<f64>,
    pub curvature: f64,
    pub step_factor: f64,
    pub between: Interaction,
}

/// By which first moment sums of gradients are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Consistency {
    /// By none.
    None,
    /// By that of each particle at rest.
    AtRest,
    /// By that of the lattice.
    Lattice,
}

impl<K, V> SchemeBuilder<K, V> {
    /// A scheme of solids and gases with a kernel and an artificial viscosity; the other choices have defaults.
    #[must_use]
    pub fn new(kernel: K, viscosity: V) -> Self {
        Self {
            kernel,
            viscosity,
            walls: NoWalls,
            effects: (),
            settings: Settings {
                name: "composed".into(),
                density: DensityForm::default(),
                pressure_form: None,
                energy: EnergyForm::default(),
                smoothing: Smoothing::default(),
                consistency: Consistency::AtRest,
                h_over_dx: None,
                curvature: 0.0,
                step_factor: DEFAULT_STEP_FACTOR,
                between: Interaction::Unilateral,
            },
        }
    }
}

/// What [`SchemeBuilder::liquid`] returns, with more effects `E`.
pub type LiquidBuilder<K, V, E = ((), Cavitation)> =
    SchemeBuilder<K, V, ExtrapolatedPressure, E, { SmoothingMode::Uniform.bit() }, 0>;

impl<K, V> LiquidBuilder<K, V> {
    /// A scheme of weakly compressible liquids with a kernel and an artificial viscosity: continuity, walls that
    /// extrapolate the pressure, no internal energy, no density diffusion.
    ///
    /// A liquid does not keep its neighbours, so it is divided by the consistency factor of the lattice, one number of
    /// kernel and h/dx.
    #[must_use]
    pub fn liquid(kernel: K, viscosity: V) -> Self {
        let solid = SchemeBuilder::new(kernel, viscosity);
        Self {
            kernel: solid.kernel,
            viscosity: solid.viscosity,
            walls: ExtrapolatedPressure::default(),
            effects: ((), Cavitation),
            settings: Settings {
                name: "liquid".into(),
                density: DensityForm::Continuity,
                energy: EnergyForm::None,
                consistency: Consistency::Lattice,
                ..solid.settings
            },
        }
    }
}

/// What [`SchemeBuilder::total_lagrangian`] returns, with more effects `E`.
pub type TotalLagrangianBuilder<K, V, E = ((), TotalLagrangian)> =
    SchemeBuilder<K, V, NoWalls, E, { SmoothingMode::Uniform.bit() }, { ENERGY | REFERENCE }>;

impl<K, V> TotalLagrangianBuilder<K, V> {
    /// A scheme of solids whose neighbours and kernels are those of the scene as built: [`TotalLagrangian`], to which
    /// belongs an effect that gives a stress, as [`NeoHookean`](crate::effect::NeoHookean). Bodies do not feel each
    /// other unless they are [bonded](Interaction::Bonded) or coupled.
    #[must_use]
    pub fn total_lagrangian(kernel: K, viscosity: V) -> Self {
        let solid = SchemeBuilder::new(kernel, viscosity);
        Self {
            kernel: solid.kernel,
            viscosity: solid.viscosity,
            walls: NoWalls,
            effects: ((), TotalLagrangian),
            settings: Settings {
                name: "total Lagrangian".into(),
                density: DensityForm::Deformation,
                consistency: Consistency::None,
                between: Interaction::None,
                ..solid.settings
            },
        }
    }
}

impl<K, V, W, E, const MODES: u8, const FORCE: u8> SchemeBuilder<K, V, W, E, MODES, FORCE> {
    fn map<L, U, X, F, const OTHER: u8, const FORM: u8>(
        self,
        change: impl FnOnce(K, V, W, E) -> (L, U, X, F),
    ) -> SchemeBuilder<L, U, X, F, OTHER, FORM> {
        let (kernel, viscosity, walls, effects) =
            change(self.kernel, self.viscosity, self.walls, self.effects);
        SchemeBuilder {
            kernel,
            viscosity,
            walls,
            effects,
            settings: self.settings,
        }
    }
    fn set(mut self, change: impl FnOnce(&mut Settings)) -> Self {
        change(&mut self.settings);
        self
    }

    /// The same choices with another kernel; h/dx becomes its recommendation unless it was given.
    #[must_use]
    pub fn with_kernel<L>(self, kernel: L) -> SchemeBuilder<L, V, W, E, MODES, FORCE> {
        self.map(|_, v, w, e| (kernel, v, w, e))
    }
    /// The same choices with another artificial viscosity;
    /// [`Inviscid`](crate::term::viscosity::Inviscid) for none.
    #[must_use]
    pub fn with_viscosity<U>(self, viscosity: U) -> SchemeBuilder<K, U, W, E, MODES, FORCE> {
        self.map(|k, _, w, e| (k, viscosity, w, e))
    }
    /// The same choices with another wall law: [`ExtrapolatedPressure`],
    /// [`RiemannWalls`](crate::effect::RiemannWalls), [`NoWalls`], or one of your own.
    #[must_use]
    pub fn walls<X>(self, walls: X) -> SchemeBuilder<K, V, X, E, MODES, FORCE> {
        self.map(|k, v, _, e| (k, v, walls, e))
    }
    /// Adds an [effect](crate::effect).
    #[must_use]
    pub fn with<A>(self, effect: A) -> SchemeBuilder<K, V, W, (E, A), MODES, FORCE> {
        self.map(|k, v, w, e| (k, v, w, (e, effect)))
    }
    /// The artificial viscosity.
    #[must_use]
    pub fn viscosity(&self) -> &V {
        &self.viscosity
    }
    /// A name for reports.
    #[must_use]
    pub fn named(self, name: &str) -> Self {
        self.set(|own| own.name = name.into())
    }
    /// The density form, and with it the pressure form.
    #[must_use]
    pub fn density(self, form: DensityForm) -> Self {
        self.set(|own| own.density = form)
    }
    /// The pressure form of *another* density form: an explicit step out of the matched pair. At a
    /// joint of copper and PMMA continuity with the form of summation explodes.
    #[must_use]
    pub fn mismatched_pressure_form(self, form: DensityForm) -> Self {
        self.set(|own| own.pressure_form = Some(form))
    }
    /// What its bodies do to each other where a scene says nothing else: they carry compression and open
    /// ([`Interaction::Unilateral`]) if not given, and are one material with [`Interaction::Bonded`], as gases are.
    #[must_use]
    pub fn between_bodies(self, interaction: Interaction) -> Self {
        self.set(|own| own.between = interaction)
    }
    /// The energy form. A scheme of [liquids](SchemeBuilder::liquid) carries no internal energy, and is refused with one.
    #[must_use]
    pub fn energy(self, form: EnergyForm) -> Self {
        self.set(|own| own.energy = form)
    }
    /// How the smoothing length changes.
    #[must_use]
    pub fn smoothing(
        self,
        law: Smoothing,
    ) -> SchemeBuilder<K, V, W, E, { SmoothingMode::ALL }, FORCE> {
        self.set(|own| own.smoothing = law)
            .map(|k, v, w, e| (k, v, w, e))
    }
    /// Lets the smoothing length follow the divergence within limits in units of the first
    /// ([`Smoothing::Divergence`]), as LS-DYNA does.
    #[must_use]
    pub fn smoothing_by_divergence(
        self,
        smallest: f64,
        largest: f64,
    ) -> SchemeBuilder<K, V, W, E, { SmoothingMode::Mean.bit() }, FORCE> {
        self.set(|own| own.smoothing = Smoothing::Divergence { smallest, largest })
            .map(|k, v, w, e| (k, v, w, e))
    }
    /// Allows bodies of different spacing: pairs use the mean of their smoothing lengths.
    #[must_use]
    pub fn mixed_spacing(self) -> SchemeBuilder<K, V, W, E, { SmoothingMode::Mean.bit() }, FORCE> {
        self.map(|k, v, w, e| (k, v, w, e))
    }
    /// Ratio of smoothing length to spacing; the kernel's recommendation if not given.
    #[must_use]
    pub fn h_over_dx(self, ratio: f64) -> Self {
        self.set(|own| own.h_over_dx = Some(ratio))
    }
    /// Step in units of h/(c + signal); see [`StepControl`](crate::simulation::StepControl).
    #[must_use]
    pub fn step_factor(self, factor: f64) -> Self {
        self.set(|own| own.step_factor = factor)
    }
    /// Leaves out the first-moment consistency factor of the kernel gradient, at rest or of the lattice, so that
    /// waves run at the wrong speed that uncorrected SPH gives them, and liquids at rest have the wrong weight.
    #[must_use]
    pub fn without_consistency_factor(self) -> Self {
        self.set(|own| own.consistency = Consistency::None)
    }
    /// Compiles the choices into sweeps.
    #[must_use]
    pub fn compose<T: Real, const D: usize>(self) -> Scheme<T, D>
    where
        K: Kernel<D>,
        V: ArtificialViscosity<D>,
        W: Effect<D>,
        E: Effects<D>,
    {
        self.composed()
    }
}

/// The forms that the force of a builder can be changed to. Implemented by [`SchemeBuilder`] where the form of its force is
/// a set of [`MIDPOINT`](super::forms::MIDPOINT), [`RENORMALISED`](super::forms::RENORMALISED) and
/// [`ENERGY`](super::forms::ENERGY).
pub trait ForceForm: Sized {
    /// The builder with midpoint reconstruction.
    type Midpoint;
    /// The builder without it.
    type Plain;
    /// The builder with corrected gradients.
    type Renormalised;
    #[doc(hidden)]
    fn into_midpoint(self) -> Self::Midpoint;
    #[doc(hidden)]
    fn into_plain(self) -> Self::Plain;
    #[doc(hidden)]
    fn into_renormalised(self) -> Self::Renormalised;
}

/// Implements the forms for one form of the force.
macro_rules! forms {
    ($( $from:literal => [$midpoint:expr, $plain:expr, $renormalised:expr] ),*) => {$(
        #[doc(hidden)]
        impl<K, V, W, E, const MODES: u8> ForceForm for SchemeBuilder<K, V, W, E, MODES, $from> {
            type Midpoint = SchemeBuilder<K, V, W, E, MODES, { $midpoint }>;
            type Plain = SchemeBuilder<K, V, W, E, MODES, { $plain }>;
            type Renormalised = SchemeBuilder<K, V, W, E, MODES, { $renormalised }>;
            fn into_midpoint(self) -> Self::Midpoint {
                self.map(|k, v, w, e| (k, v, w, e))
            }
            fn into_plain(self) -> Self::Plain {
                self.map(|k, v, w, e| (k, v, w, e))
            }
            fn into_renormalised(self) -> Self::Renormalised {
                self.map(|k, v, w, e| (k, v, w, e))
            }
        }
    )*};
}
// Every set of the bits MIDPOINT, RENORMALISED and ENERGY, which is no pattern: with midpoint reconstruction, without it,
// and with renormalised gradients.
forms! {
    0b000 => [0b001, 0b000, 0b010],
    0b001 => [0b001, 0b000, 0b011],
    0b010 => [0b011, 0b010, 0b010],
    0b011 => [0b011, 0b010, 0b011],
    0b100 => [0b101, 0b100, 0b110],
    0b101 => [0b101, 0b100, 0b111],
    0b110 => [0b111, 0b110, 0b110],
    0b111 => [0b111, 0b110, 0b111]
}

impl<K, V, W, E, const MODES: u8, const FORCE: u8> SchemeBuilder<K, V, W, E, MODES, FORCE>
where
    Self: ForceForm,
{
    /// Adds midpoint reconstruction of the pressure with strength χ; see
    /// [`MidpointReconstruction`](crate::term::MidpointReconstruction).
    #[must_use]
    pub fn midpoint_reconstruction(self, strength: f64) -> <Self as ForceForm>::Midpoint {
        self.set(|own| own.curvature = strength).into_midpoint()
    }
    /// Leaves midpoint reconstruction of the pressure out.
    #[must_use]
    pub fn without_midpoint_reconstruction(self) -> <Self as ForceForm>::Plain {
        self.into_plain()
    }
    /// Corrects gradients of pressure force and compression, so that they are exact for linear fields, for
    /// the price of a sweep.
    #[must_use]
    pub fn renormalised(self) -> <Self as ForceForm>::Renormalised {
        self.without_consistency_factor().into_renormalised()
    }
}

impl<K, V, W, E, Y, const MODES: u8, const FORCE: u8>
    SchemeBuilder<K, V, W, (E, DensityDiffusion<Y>), MODES, FORCE>
{
    /// The same choices with another density diffusion; [`Nothing`](crate::term::Nothing) for none. To be called
    /// before other effects are added.
    #[must_use]
    pub fn density_diffusion<X>(
        self,
        diffusion: X,
    ) -> SchemeBuilder<K, V, W, (E, DensityDiffusion<X>), MODES, FORCE> {
        self.map(|k, v, w, (e, _)| (k, v, w, (e, DensityDiffusion(diffusion))))
    }
}

/// Default step in units of h/(c + signal). Limited viscosity at α = 2 with corrected dispersion loses
/// its plateau at 0.8 and blows up at 1.1; the steepest fronts come at or below 0.55.
pub const DEFAULT_STEP_FACTOR: f64 = 0.55;

impl<T, const D: usize, K, V, W, E, const MODES: u8, const FORCE: u8>
    From<SchemeBuilder<K, V, W, E, MODES, FORCE>> for Scheme<T, D>
where
    T: Real,
    K: Kernel<D>,
    V: ArtificialViscosity<D>,
    W: Effect<D>,
    E: Effects<D>,
{
    fn from(builder: SchemeBuilder<K, V, W, E, MODES, FORCE>) -> Self {
        builder.compose()
    }
}
