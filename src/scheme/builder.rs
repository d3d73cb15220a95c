//! The builder of schemes: the choices, which `compile` turns into sweeps over pairs.
//! What its type rules out leaves no loop behind.

use super::{EnergyForm, Scheme};
use crate::effect::{
    Cavitation, DensityDiffusion, DensityForm, Effect, Effects, ExtrapolatedPressure,
    FiveEquations, NoWalls, TotalLagrangian,
};
use crate::kernel::Kernel;
use crate::scalar::Real;
use crate::sweep::Interaction;
use crate::term::viscosity::Inviscid;
use crate::term::{
    ArtificialViscosity, InternalEnergy, KernelSum, MatrixPressureForce, MidpointReconstruction,
    PressureForce, RenormalisedPressureForce,
};

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
/// The type says what is compiled: kernel `K`, viscosity `V`, wall law `W`, and effects `E` as nested pairs, first those that
/// make it a scheme: the pressure force, densities from sums and internal energy of solids and gases, if not given.
#[derive(Clone, Debug)]
pub struct SchemeBuilder<K, V, W = NoWalls, E = ((((), PressureForce), KernelSum), InternalEnergy)>
{
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
    pub consistency: Consistency,
    pub h_over_dx: Option<f64>,
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
            effects: ((((), PressureForce), KernelSum), InternalEnergy),
            settings: Settings {
                name: "composed".into(),
                density: DensityForm::default(),
                pressure_form: None,
                energy: EnergyForm::default(),
                consistency: Consistency::AtRest,
                h_over_dx: None,
                step_factor: DEFAULT_STEP_FACTOR,
                between: Interaction::Unilateral,
            },
        }
    }
}

impl<K, V> SchemeBuilder<K, V, ExtrapolatedPressure, (((), PressureForce), Cavitation)> {
    /// A scheme of weakly compressible liquids with a kernel and an artificial viscosity: continuity, walls that
    /// extrapolate the pressure, no internal energy, no density diffusion.
    ///
    /// A liquid does not keep its neighbours, so it is divided by the consistency factor of the lattice, one number of
    /// kernel and h/dx.
    #[must_use]
    pub fn liquid(kernel: K, viscosity: V) -> Self {
        SchemeBuilder::new(kernel, viscosity)
            .named("liquid")
            .density(DensityForm::Continuity)
            .energy(EnergyForm::None)
            .set(|own| own.consistency = Consistency::Lattice)
            .map(|k, v, _, ((pressure, _), _)| {
                let walls = ExtrapolatedPressure::default();
                (k, v, walls, (pressure, Cavitation))
            })
    }
}

impl<K> SchemeBuilder<K, Inviscid, ExtrapolatedPressure, ((), FiveEquations)> {
    /// A scheme of two fluids on a lattice that stays, with a kernel: [`FiveEquations`].
    ///
    /// With h/dx 0.75, if nothing else is said, a particle has to do with those beside it alone, as the cells of a finite-volume scheme have:
    /// wider kernels blur interfaces and pressures over their support.
    #[must_use]
    pub fn five_equations(kernel: K, fluids: FiveEquations) -> Self {
        SchemeBuilder::liquid(kernel, Inviscid)
            .named("five equations")
            .h_over_dx(0.75)
            .energy(EnergyForm::Symmetric)
            .between_bodies(Interaction::Bonded)
            .map(|k, v, w, _| (k, v, w, ((), fluids)))
    }
}

impl<K, V> SchemeBuilder<K, V, NoWalls, (((), TotalLagrangian), InternalEnergy)> {
    /// A scheme of solids whose neighbours and kernels are those of the scene as built: [`TotalLagrangian`], to which
    /// belongs an effect that gives a stress, as [`NeoHookean`](crate::effect::NeoHookean). Bodies do not feel each
    /// other unless they are [bonded](Interaction::Bonded) or coupled.
    #[must_use]
    pub fn total_lagrangian(kernel: K, viscosity: V) -> Self {
        SchemeBuilder::new(kernel, viscosity)
            .named("total Lagrangian")
            .density(DensityForm::Deformation)
            .between_bodies(Interaction::None)
            .without_consistency_factor()
            .map(|k, v, w, (_, energy)| (k, v, w, (((), TotalLagrangian), energy)))
    }
}

impl<K, V, W, E> SchemeBuilder<K, V, W, E> {
    fn map<L, U, X, F>(
        self,
        change: impl FnOnce(K, V, W, E) -> (L, U, X, F),
    ) -> SchemeBuilder<L, U, X, F> {
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
    pub fn with_kernel<L>(self, kernel: L) -> SchemeBuilder<L, V, W, E> {
        self.map(|_, v, w, e| (kernel, v, w, e))
    }
    /// The same choices with another artificial viscosity;
    /// [`Inviscid`](crate::term::viscosity::Inviscid) for none.
    #[must_use]
    pub fn with_viscosity<U>(self, viscosity: U) -> SchemeBuilder<K, U, W, E> {
        self.map(|k, _, w, e| (k, viscosity, w, e))
    }
    /// The same choices with another wall law: [`ExtrapolatedPressure`],
    /// [`RiemannWalls`](crate::effect::RiemannWalls), [`NoWalls`], or one of your own.
    #[must_use]
    pub fn walls<X>(self, walls: X) -> SchemeBuilder<K, V, X, E> {
        self.map(|k, v, _, e| (k, v, walls, e))
    }
    /// Adds an [effect](crate::effect).
    #[must_use]
    pub fn with<A>(self, effect: A) -> SchemeBuilder<K, V, W, (E, A)> {
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

/// Effects whose pressure force can take corrected gradients: lists that begin with [`PressureForce`].
#[diagnostic::on_unimplemented(
    message = "the effects of this scheme have no pressure force whose gradients can be corrected",
    note = "call `renormalised` or `matrix_gradients` once, for a scheme of solids, gases or liquids"
)]
pub trait Renormalise {
    /// The list with another pressure force.
    type With<P>;
    #[doc(hidden)]
    fn with_force<P>(self, force: P) -> Self::With<P>;
}

impl Renormalise for ((), PressureForce) {
    type With<P> = ((), P);
    fn with_force<P>(self, force: P) -> Self::With<P> {
        ((), force)
    }
}

impl<E: Renormalise, A> Renormalise for (E, A) {
    type With<P> = (E::With<P>, A);
    fn with_force<P>(self, force: P) -> Self::With<P> {
        (self.0.with_force(force), self.1)
    }
}

impl<K, V, W, E: Renormalise> SchemeBuilder<K, V, W, E> {
    /// Corrects gradients of pressure force and compression, so that they are exact for linear fields, for
    /// the price of a sweep.
    #[must_use]
    pub fn renormalised(self) -> SchemeBuilder<K, V, W, E::With<RenormalisedPressureForce>> {
        self.with_force(RenormalisedPressureForce)
    }
    /// The pressure force of gases with gradients from inverted matrices, [`MatrixPressureForce`], for the price of a sweep.
    #[must_use]
    pub fn matrix_gradients(self) -> SchemeBuilder<K, V, W, E::With<MatrixPressureForce>> {
        self.with_force(MatrixPressureForce)
    }
    fn with_force<P>(self, force: P) -> SchemeBuilder<K, V, W, E::With<P>> {
        self.without_consistency_factor()
            .map(|k, v, w, e| (k, v, w, e.with_force(force)))
    }
}

impl<K, V, W, E> SchemeBuilder<K, V, W, (E, MidpointReconstruction)> {
    /// Leaves midpoint reconstruction of the pressure out. To be called before other effects are added.
    #[must_use]
    pub fn without_midpoint_reconstruction(self) -> SchemeBuilder<K, V, W, E> {
        self.map(|k, v, w, (e, _)| (k, v, w, e))
    }
}

impl<K, V, W, E, Y> SchemeBuilder<K, V, W, (E, DensityDiffusion<Y>)> {
    /// The same choices with another density diffusion; [`Nothing`](crate::term::Nothing) for none. To be called
    /// before other effects are added.
    #[must_use]
    pub fn density_diffusion<X>(
        self,
        diffusion: X,
    ) -> SchemeBuilder<K, V, W, (E, DensityDiffusion<X>)> {
        self.map(|k, v, w, (e, _)| (k, v, w, (e, DensityDiffusion(diffusion))))
    }
}

/// Default step in units of h/(c + signal). Limited viscosity at α = 2 with corrected dispersion loses
/// its plateau at 0.8 and blows up at 1.1; the steepest fronts come at or below 0.55.
pub const DEFAULT_STEP_FACTOR: f64 = 0.55;

impl<T, const D: usize, K, V, W, E> From<SchemeBuilder<K, V, W, E>> for Scheme<T, D>
where
    T: Real,
    K: Kernel<D>,
    V: ArtificialViscosity<D>,
    W: Effect<D>,
    E: Effects<D>,
{
    fn from(builder: SchemeBuilder<K, V, W, E>) -> Self {
        builder.compose()
    }
}
