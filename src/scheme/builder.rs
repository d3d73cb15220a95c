//! The builder of schemes: the choices, and how they are compiled into sweeps over pairs.
//! What the builder's type rules out leaves no loop behind.

use super::force::{ENERGY, Gradients, KICKED, Needs, Pressure, Rate};
use super::{EnergyForm, Scheme, Smoothing};
use crate::effect::{
    BySum, Cavitation, Compression, ConsistentSmoothing, ContactActivity, CorrectedGradients,
    DensityDiffusion, DensityForm, Divergence, Effect, Effects, Evolved, ExtrapolatedPressure,
    NoWalls, Setting, StepProgram, SummedDensity, Update, ViscositySwitch, When,
};
use crate::error::Problem;
use crate::kernel::{Kernel, KernelFacts};
use crate::particles::{Field, Fields, Output};
use crate::scalar::Real;
use crate::sweep::{FusedKernel, Interaction, PairSweep, SmoothingMode};
use crate::term::{
    ArtificialViscosity, InternalEnergy, KernelMoment, KernelSum, MidpointReconstruction, SlopeInH,
    Stage, StageMarker, StagedTerms, Terms, Unity, Viscosity, stage,
};
use core::marker::PhantomData;

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
    kernel: K,
    viscosity: V,
    walls: W,
    effects: E,
    settings: Settings,
}

/// The choices that are no types.
#[derive(Clone, Debug)]
struct Settings {
    name: String,
    density: DensityForm,
    pressure_form: Option<DensityForm>,
    energy: EnergyForm,
    smoothing: Smoothing,
    consistency: Consistency,
    h_over_dx: Option<f64>,
    curvature: f64,
    step_factor: f64,
    between: Interaction,
}

/// By which first moment sums of gradients are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Consistency {
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
    /// waves run at the wrong speed that uncorrected SPH gives them, and a liquid column at h/dx 1.3 with Wendland
    /// C2 is 2.7 % too heavy.
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

/// Methods that choose a form of the force, each from the forms that it goes with.
macro_rules! forms {
    ($( $from:literal => [$midpoint:expr, $plain:expr, $renormalised:expr] ),*) => {$(
        impl<K, V, W, E, const MODES: u8> SchemeBuilder<K, V, W, E, MODES, $from> {
            /// Adds midpoint reconstruction of the pressure with strength χ; see [`MidpointReconstruction`].
            #[must_use]
            pub fn midpoint_reconstruction(
                self,
                strength: f64,
            ) -> SchemeBuilder<K, V, W, E, MODES, { $midpoint }> {
                self.set(|own| own.curvature = strength).map(|k, v, w, e| (k, v, w, e))
            }
            /// Leaves midpoint reconstruction of the pressure out.
            #[must_use]
            pub fn without_midpoint_reconstruction(
                self,
            ) -> SchemeBuilder<K, V, W, E, MODES, { $plain }> {
                self.map(|k, v, w, e| (k, v, w, e))
            }
            /// Corrects gradients of pressure force and compression, so that they are exact for linear fields, for
            /// the price of a sweep.
            #[must_use]
            pub fn renormalised(self) -> SchemeBuilder<K, V, W, E, MODES, { $renormalised }> {
                self.without_consistency_factor().map(|k, v, w, e| (k, v, w, e))
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

impl<K, V, W, E, const MODES: u8> SchemeBuilder<K, V, W, E, MODES, 0> {
    /// Sums the rate of density with the forces, in one sweep a step, and kicks density with velocity, as
    /// Runge–Kutta methods need; a sweep of its own at the middle of the drift takes more time a step and bears
    /// longer steps.
    ///
    /// The sweep sees velocity and density set a step ahead with the last rates, and
    /// [`KickDriftKick`](crate::integrator::KickDriftKick) corrects both once with what it finds:
    ///
    /// ```text
    /// y* = yₙ + dt rₙ,  rₙ₊₁ = f(xₙ₊₁, y*),  yₙ₊₁ = yₙ + dt (rₙ + rₙ₊₁)/2,  y = (v, ρ)
    /// ```
    ///
    /// On sound, y' = iω y, a step multiplies y by a root of z² − (1 + 3iω dt/2) z + iω dt/2 = 0, as the
    /// two-step method of Adams and Bashforth does: |z| = 1 + (ω dt)⁴/4, so sound grows that nothing damps,
    /// where the sweep at the middle makes a leapfrog that is neutral up to ω dt = 2. It takes density
    /// diffusion or viscosity to hold the step, which is therefore shortened by [`DENSITY_WITH_RATES_STEP`].
    ///
    /// For uniform spacing, without [`Shifting`](crate::effect::Shifting), renormalised gradients, and walls
    /// [without slip](crate::boundary::Wall::no_slip): the velocity that makes a liquid stick belongs to the forces,
    /// not to the compression.
    #[must_use]
    pub fn density_with_rates(self) -> SchemeBuilder<K, V, W, E, MODES, KICKED> {
        self.set(|own| own.step_factor *= DENSITY_WITH_RATES_STEP)
            .map(|k, v, w, e| (k, v, w, e))
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

impl<K, V, W, E, const MODES: u8, const FORCE: u8> SchemeBuilder<K, V, W, E, MODES, FORCE> {
    fn setting<const D: usize>(&self) -> Setting
    where
        K: Kernel<D>,
    {
        let own = &self.settings;
        let h_over_dx = own.h_over_dx.unwrap_or(self.kernel.h_over_dx());
        let changes = if FORCE & KICKED == 0 {
            When::Drift
        } else {
            When::Kick
        };
        let forms = (own.density, own.pressure_form.unwrap_or(own.density));
        Setting::of(&self.kernel, h_over_dx, forms, changes)
    }

    fn mode(&self) -> SmoothingMode {
        match self.settings.smoothing {
            Smoothing::Consistent { .. } => SmoothingMode::Own,
            Smoothing::Divergence { .. } => SmoothingMode::Mean,
            Smoothing::Fixed if MODES & SmoothingMode::Uniform.bit() != 0 => SmoothingMode::Uniform,
            Smoothing::Fixed => SmoothingMode::Mean,
        }
    }

    fn composed<T: Real, const D: usize>(self) -> Scheme<T, D>
    where
        K: Kernel<D>,
        V: ArtificialViscosity<D>,
        W: Effect<D>,
        E: Effects<D>,
    {
        let setting = self.setting::<D>();
        let compiled = Compiled::<K, V, E, NeedsOf<W, E, D>, MODES, FORCE> {
            kernel: self.kernel,
            mode: self.mode(),
            viscosity: self.viscosity.clone(),
            curvature: self.settings.curvature,
            effects: self.effects.clone(),
            setting,
            needs: PhantomData,
        };
        let own = &self.settings;
        let integrated = own.density.is_integrated();
        let follows_divergence = matches!(own.smoothing, Smoothing::Divergence { .. });
        // A switch follows the compression once a step, by the sum that the rates make.
        let switch = self.viscosity.switch();
        let with_rates = integrated || follows_divergence || switch.is_some();
        let mut sweeps: [Option<Box<dyn PairSweep<T, D>>>; Stage::COUNT] = Default::default();
        sweeps[Stage::Density.number()] = compiled.density(own.density);
        let walls = self.walls.terms(&setting).at::<stage::Walls>();
        let walls = walls.then(self.effects.at::<stage::Walls>(&setting));
        sweeps[Stage::Walls.number()] = compiled.named(walls);
        sweeps[Stage::Gradients.number()] = compiled.gradients();
        sweeps[Stage::Flow.number()] = compiled.at::<stage::Flow, T, D>();
        sweeps[Stage::Rates.number()] = Some(compiled.rates(with_rates));
        sweeps[Stage::Continuity.number()] = compiled.continuity(integrated || follows_divergence);

        let mut program = StepProgram::new(setting);
        if sweeps[Stage::Gradients.number()].is_some() {
            let wanted = Gradients::<V, NeedsOf<W, E, D>, FORCE>::wanted::<D>();
            program.law(Stage::Gradients, CorrectedGradients { wanted });
        }
        // A viscosity that is chosen at run time reads what others of its kind do, and nothing may write that.
        let remembered = Fields::of(&[Field::VISCOSITY_COEFFICIENT, Field::DIVERGENCE]);
        let mut unwritten = remembered.minus(remembered.minus(V::READS));
        if sweeps[Stage::Gradients.number()].is_none() {
            unwritten = unwritten.union(Gradients::<V, NeedsOf<W, E, D>, FORCE>::wanted::<D>());
        }
        for field in unwritten.iter() {
            program.carry(field);
        }
        self.evolve(&mut program);
        self.walls.register(&mut program);
        self.effects.register(&mut program);
        if let Some(switch) = switch {
            program.start(Field::VISCOSITY_COEFFICIENT, switch.start());
            let law = ViscositySwitch {
                switch,
                form: own.density,
                support: setting.kernel.support,
            };
            program.law(Stage::Rates, law);
        }
        let carries_energy = own.energy != EnergyForm::None;
        let cannot = FORCE & ENERGY == 0 && (carries_energy || !integrated);
        program.require(move |_| {
            cannot.then(|| Problem::Incompatible {
                what: "a scheme of liquids integrates its density and carries no internal energy".into(),
                remedy: "start from SchemeBuilder::new, or take DensityForm::Continuity or ContinuityByMass with \
                         EnergyForm::None",
            })
        });
        let of = |what: &str, (name, value, must_be)| (format!("{name}{what}"), value, must_be);
        let viscous = self.viscosity.problems().into_iter();
        let effects = self
            .walls
            .problems()
            .into_iter()
            .chain(self.effects.problems());
        Scheme {
            name: own.name.clone(),
            kernel: KernelFacts::of(&self.kernel),
            density: own.density,
            pressure_form: setting.pressure_form,
            energy: own.energy,
            smoothing: own.smoothing,
            h_over_dx: setting.h_over_dx,
            step_factor: own.step_factor * program.step_factor,
            consistent_at_rest: own.consistency == Consistency::AtRest,
            between: own.between,
            kernel_problems: crate::kernel::problems_of(&self.kernel),
            problems: viscous
                .map(|one| of(" of the artificial viscosity", one))
                .chain(effects.map(|one| of("", one)))
                .collect(),
            reference: (FORCE & ENERGY != 0).then(|| compiled.reference()),
            sweeps,
            lattice_consistency_factor: if own.consistency == Consistency::Lattice {
                setting.lattice_consistency_factor
            } else {
                1.0
            },
            program,
        }
    }

    /// What the scheme itself integrates in time, and how density follows from sums.
    fn evolve<T: Real, const D: usize>(&self, program: &mut StepProgram<T, D>) {
        let own = &self.settings;
        let (setting, when) = (*program.setting(), program.setting().density_changes);
        let compression = Compression {
            density: setting.density,
            pressure: setting.pressure_form,
        };
        if let Smoothing::Divergence { smallest, largest } = own.smoothing {
            program.evolve(
                Evolved::kicked(Field::SMOOTHING_LENGTH)
                    .at(When::Drift)
                    .updated(Update::Within { smallest, largest })
                    .by(Divergence(compression)),
            );
        }
        if own.density.is_integrated() {
            let density = Evolved::kicked(Field::DENSITY)
                .at(when)
                .updated(Update::Exponential)
                .by(compression);
            program.evolve(density.keeping(Field::DENSITY_RESIDUAL));
        } else if let Smoothing::Consistent { smallest, largest } = own.smoothing {
            let law = ConsistentSmoothing {
                eta: setting.h_over_dx,
                limits: [smallest, largest],
            };
            program.law(Stage::Density, law);
        } else {
            program.law(Stage::Density, SummedDensity(own.density));
        }
        // Liquids have no contacts, and smoothing that follows density takes bodies as one.
        if FORCE & ENERGY != 0 && !matches!(own.smoothing, Smoothing::Consistent { .. }) {
            program.law(Stage::Density, ContactActivity);
        }
        if own.energy != EnergyForm::None {
            program.evolve(Evolved::kicked(Field::ENERGY).by(BySum {
                sum: Output::POWER,
                over: Some(Field::MASS),
            }));
        }
    }
}

/// What the terms and laws of a scheme read beside those of force and viscosity.
struct NeedsOf<W, E, const D: usize>(PhantomData<fn() -> (W, E)>);

impl<W: Effect<D>, E: Effects<D>, const D: usize> Needs for NeedsOf<W, E, D> {
    const NEEDS: Fields = W::NEEDS.union(E::READS);
}

/// The choices on their way into sweeps.
struct Compiled<K, V, E, N, const MODES: u8, const FORCE: u8> {
    kernel: K,
    mode: SmoothingMode,
    viscosity: V,
    curvature: f64,
    effects: E,
    setting: Setting,
    needs: PhantomData<fn() -> N>,
}

impl<K, V, E, N: Needs, const MODES: u8, const FORCE: u8> Compiled<K, V, E, N, MODES, FORCE> {
    fn sweep<T: Real, const D: usize>(&self, terms: impl Terms<D>) -> Box<dyn PairSweep<T, D>>
    where
        K: Kernel<D>,
    {
        Box::new(FusedKernel::<_, _, MODES>::new(
            self.kernel,
            terms,
            self.mode,
        ))
    }

    /// The sweep of some terms, if there are any.
    fn named<T: Real, const D: usize, A: Terms<D>>(
        &self,
        terms: A,
    ) -> Option<Box<dyn PairSweep<T, D>>>
    where
        K: Kernel<D>,
    {
        if const { A::WRITES.is_empty() } {
            return None;
        }
        Some(self.sweep(terms))
    }

    /// The sweep of a stage that effects alone name.
    fn at<S: StageMarker<D>, T: Real, const D: usize>(&self) -> Option<Box<dyn PairSweep<T, D>>>
    where
        K: Kernel<D>,
        E: Effects<D>,
    {
        self.named(self.effects.at::<S>(&self.setting))
    }

    fn density<T: Real, const D: usize>(
        &self,
        form: DensityForm,
    ) -> Option<Box<dyn PairSweep<T, D>>>
    where
        K: Kernel<D>,
        E: Effects<D>,
    {
        // Liquids integrate their density.
        if const { FORCE & ENERGY == 0 } || form.is_integrated() {
            return self.at::<stage::Density, T, D>();
        }
        let own = self.effects.at::<stage::Density>(&self.setting);
        Some(match (form, self.mode) {
            (DensityForm::Normalised | DensityForm::Lam, _) => {
                self.sweep((KernelSum, Unity).then(own))
            }
            (_, SmoothingMode::Own) => self.sweep((KernelSum, SlopeInH).then(own)),
            _ => self.sweep((KernelSum,).then(own)),
        })
    }

    fn reference<T: Real, const D: usize>(&self) -> Box<dyn PairSweep<T, D>>
    where
        K: Kernel<D>,
    {
        self.sweep((KernelSum, Unity, KernelMoment))
    }

    fn gradients<T: Real, const D: usize>(&self) -> Option<Box<dyn PairSweep<T, D>>>
    where
        K: Kernel<D>,
        V: ArtificialViscosity<D>,
        E: Effects<D>,
    {
        if const { Gradients::<V, N, FORCE>::wanted::<D>().is_empty() } {
            return None;
        }
        // A viscosity that is chosen at run time may ask for nothing.
        let asked = const { !Gradients::<V, N, FORCE>::of_others::<D>().is_empty() };
        (asked || self.viscosity.needs_velocity_gradient())
            .then(|| self.sweep(Gradients::<V, N, FORCE>::NEW))
    }

    fn rates<T: Real, const D: usize>(&self, with_compression: bool) -> Box<dyn PairSweep<T, D>>
    where
        K: Kernel<D>,
        V: ArtificialViscosity<D>,
        E: Effects<D>,
    {
        let pressure = Pressure::<FORCE> {
            curvature: MidpointReconstruction {
                strength: self.curvature,
            },
        };
        let viscosity = (Viscosity(self.viscosity.clone()),);
        let own = self.effects.at::<stage::Rates>(&self.setting);
        let forces = pressure.then(viscosity).then(own);
        if const { FORCE & KICKED != 0 } {
            let density = self.effects.at::<stage::Continuity>(&self.setting);
            return self.sweep(forces.then(Rate::<FORCE>).then(density));
        }
        if const { FORCE & ENERGY == 0 } {
            return self.sweep(forces);
        }
        let forces = forces.then((InternalEnergy,));
        if with_compression {
            self.sweep(forces.then(Rate::<FORCE>))
        } else {
            self.sweep(forces)
        }
    }

    fn continuity<T: Real, const D: usize>(
        &self,
        integrated: bool,
    ) -> Option<Box<dyn PairSweep<T, D>>>
    where
        K: Kernel<D>,
        E: Effects<D>,
    {
        if const { FORCE & KICKED != 0 } {
            return None;
        }
        if !integrated {
            return self.at::<stage::Continuity, T, D>();
        }
        let own = self.effects.at::<stage::Continuity>(&self.setting);
        Some(self.sweep(Rate::<FORCE>.then(own)))
    }
}

/// Default step in units of h/(c + signal). Limited viscosity at α = 2 with corrected dispersion loses
/// its plateau at 0.8 and blows up at 1.1; the steepest fronts come at or below 0.55.
pub const DEFAULT_STEP_FACTOR: f64 = 0.55;

/// By what [`SchemeBuilder::density_with_rates`] shortens the step: 0.25 h/c where two sweeps
/// take 0.55 h/c.
///
/// On a lattice density diffusion holds noise up to 0.55 h/c, that of a Riemann solver up to 0.35 h/c. Liquid
/// that strikes a wall has fewer neighbours to diffuse to, and walls do not diffuse: of a dam break on 2500
/// particles 0.25 h/c keeps the fluctuations of density and the greatest speeds that two sweeps have, at
/// 0.3 h/c they are up to twice as large, at 0.55 h/c the fluctuations four to ten times. It belongs to
/// kick-drift-kick; for a Runge–Kutta method of higher order divide [`step_factor`](SchemeBuilder::step_factor)
/// by it.
pub const DENSITY_WITH_RATES_STEP: f64 = 0.25 / 0.55;

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
