//! The builder of schemes: the choices, and how they are compiled into sweeps over pairs.
//! What the builder's type rules out leaves no loop behind.

use super::{DensityForm, EnergyForm, KernelFacts, Scheme, Smoothing};
use crate::kernel::Kernel;
use crate::scalar::Real;
use crate::sweep::{PairSweep, Program, SmoothingMode};
use crate::term::{
    ArtificialViscosity, Compression, InternalEnergy, KernelMoment, KernelSum, PressureCurvature,
    PressureForce, PressureGradient, SlopeInH, Unity, VelocityGradient, Viscosity,
};

/// Chooses the parts of a scheme.
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
#[derive(Clone, Debug)]
pub struct SchemeBuilder<
    K,
    V,
    const MODES: u8 = { SmoothingMode::Uniform.bit() },
    const CURVED: bool = false,
> {
    name: String,
    kernel: K,
    viscosity: V,
    density: DensityForm,
    pressure_form: Option<DensityForm>,
    energy: EnergyForm,
    smoothing: Smoothing,
    h_over_dx: Option<f64>,
    curvature: f64,
    step_factor: Option<f64>,
    normalised: bool,
    uniform: bool,
}

impl<K, V> SchemeBuilder<K, V> {
    /// A scheme with a kernel and an artificial viscosity; the other choices have defaults.
    #[must_use]
    pub fn new(kernel: K, viscosity: V) -> Self {
        Self {
            name: "composed".into(),
            kernel,
            viscosity,
            density: DensityForm::default(),
            pressure_form: None,
            energy: EnergyForm::default(),
            smoothing: Smoothing::default(),
            h_over_dx: None,
            curvature: 0.0,
            step_factor: None,
            normalised: true,
            uniform: true,
        }
    }
}

impl<K, V, const MODES: u8, const CURVED: bool> SchemeBuilder<K, V, MODES, CURVED> {
    /// The same choices with another kernel; h/dx becomes its recommendation unless it was given.
    #[must_use]
    pub fn with_kernel<L>(self, kernel: L) -> SchemeBuilder<L, V, MODES, CURVED> {
        self.map(|_| kernel, |viscosity| viscosity)
    }
    /// The same choices with another artificial viscosity.
    #[must_use]
    pub fn with_viscosity<W>(self, viscosity: W) -> SchemeBuilder<K, W, MODES, CURVED> {
        self.map(|kernel| kernel, |_| viscosity)
    }
    /// The artificial viscosity.
    #[must_use]
    pub fn viscosity(&self) -> &V {
        &self.viscosity
    }
    /// A name for reports.
    #[must_use]
    pub fn named(mut self, name: &str) -> Self {
        self.name = name.into();
        self
    }
    /// The density form, and with it the pressure form.
    #[must_use]
    pub fn density(mut self, form: DensityForm) -> Self {
        self.density = form;
        self
    }
    /// The pressure form of *another* density form: an explicit step out of the matched pair. At a
    /// joint of copper and PMMA continuity with the form of summation explodes.
    #[must_use]
    pub fn mismatched_pressure_form(mut self, form: DensityForm) -> Self {
        self.pressure_form = Some(form);
        self
    }
    /// The energy form.
    #[must_use]
    pub fn energy(mut self, form: EnergyForm) -> Self {
        self.energy = form;
        self
    }
    /// How the smoothing length changes.
    #[must_use]
    pub fn smoothing(self, law: Smoothing) -> SchemeBuilder<K, V, { SmoothingMode::ALL }, CURVED> {
        SchemeBuilder {
            smoothing: law,
            ..self.modes()
        }
    }
    /// Allows bodies of different spacing: pairs use the mean of their smoothing lengths.
    #[must_use]
    pub fn mixed_spacing(self) -> SchemeBuilder<K, V, { SmoothingMode::Mean.bit() }, CURVED> {
        SchemeBuilder {
            uniform: false,
            ..self.modes()
        }
    }
    fn modes<const OTHER: u8, const BENT: bool>(self) -> SchemeBuilder<K, V, OTHER, BENT> {
        self.map(|kernel| kernel, |viscosity| viscosity)
    }
    fn map<L, W, const OTHER: u8, const BENT: bool>(
        self,
        kernel: impl FnOnce(K) -> L,
        viscosity: impl FnOnce(V) -> W,
    ) -> SchemeBuilder<L, W, OTHER, BENT> {
        SchemeBuilder {
            name: self.name,
            kernel: kernel(self.kernel),
            viscosity: viscosity(self.viscosity),
            density: self.density,
            pressure_form: self.pressure_form,
            energy: self.energy,
            smoothing: self.smoothing,
            h_over_dx: self.h_over_dx,
            curvature: self.curvature,
            step_factor: self.step_factor,
            normalised: self.normalised,
            uniform: self.uniform,
        }
    }
    /// Ratio of smoothing length to spacing; the kernel's recommendation if not given.
    #[must_use]
    pub fn h_over_dx(mut self, ratio: f64) -> Self {
        self.h_over_dx = Some(ratio);
        self
    }
    /// Adds the curvature of the pressure with strength χ; see [`PressureCurvature`].
    #[must_use]
    pub fn pressure_curvature(self, strength: f64) -> SchemeBuilder<K, V, MODES, true> {
        SchemeBuilder {
            curvature: strength,
            ..self.modes()
        }
    }
    /// Leaves the curvature of the pressure out.
    #[must_use]
    pub fn without_pressure_curvature(self) -> SchemeBuilder<K, V, MODES, false> {
        self.modes()
    }
    /// Step in units of h/(c + signal); see [`StepControl`](crate::simulation::StepControl).
    #[must_use]
    pub fn step_factor(mut self, factor: f64) -> Self {
        self.step_factor = Some(factor);
        self
    }
    /// Leaves out the normalisation by the first moment at rest, so that waves run at the wrong speed
    /// that uncorrected SPH gives them.
    #[must_use]
    pub fn without_normalisation(mut self) -> Self {
        self.normalised = false;
        self
    }

    /// Compiles the choices into sweeps.
    #[must_use]
    pub fn compose<T: Real, const D: usize>(self) -> Scheme<T, D>
    where
        K: Kernel<D>,
        V: ArtificialViscosity<D>,
    {
        let mode = match self.smoothing {
            Smoothing::Consistent { .. } => SmoothingMode::Own,
            Smoothing::Divergence { .. } => SmoothingMode::Mean,
            Smoothing::Fixed if self.uniform => SmoothingMode::Uniform,
            Smoothing::Fixed => SmoothingMode::Mean,
        };
        let kernel = self.kernel;
        let sums: Option<Box<dyn PairSweep<T, D>>> = match (self.density, mode) {
            (DensityForm::Continuity | DensityForm::ContinuityByMass, _) => None,
            (DensityForm::Normalised | DensityForm::Lam, _) => Some(Box::new(
                Program::<_, _, MODES>::new(kernel, (KernelSum, Unity), mode),
            )),
            (_, SmoothingMode::Own) => Some(Box::new(Program::<_, _, MODES>::new(
                kernel,
                (KernelSum, SlopeInH),
                mode,
            ))),
            _ => Some(Box::new(Program::<_, _, MODES>::new(
                kernel,
                (KernelSum,),
                mode,
            ))),
        };
        let integrated =
            self.density.is_integrated() || matches!(self.smoothing, Smoothing::Divergence { .. });
        let compression: Option<Box<dyn PairSweep<T, D>>> = integrated
            .then(|| Box::new(Program::<_, _, MODES>::new(kernel, (Compression,), mode)) as _);
        // A switch follows the compression once a step, by the sum that the rates make.
        let compressing = integrated || self.viscosity.switch().is_some();
        // What the builder's type rules out leaves no loop behind.
        let gradient: Option<Box<dyn PairSweep<T, D>>> = if const { CURVED } {
            let terms = (VelocityGradient, PressureGradient);
            Some(Box::new(Program::<_, _, MODES>::new(kernel, terms, mode)))
        } else if self.viscosity.needs_velocity_gradient() {
            let terms = (VelocityGradient,);
            Some(Box::new(Program::<_, _, MODES>::new(kernel, terms, mode)))
        } else {
            None
        };
        let viscosity_problems = self.viscosity.problems();
        let switch = self.viscosity.switch();
        let viscosity = Viscosity(self.viscosity);
        let rates: Box<dyn PairSweep<T, D>> = if const { CURVED } {
            let curvature = PressureCurvature {
                strength: self.curvature,
            };
            let terms = (PressureForce, curvature, viscosity, InternalEnergy);
            if compressing {
                let (a, b, c, d) = terms;
                Box::new(Program::<_, _, MODES>::new(
                    kernel,
                    (a, b, c, d, Compression),
                    mode,
                ))
            } else {
                Box::new(Program::<_, _, MODES>::new(kernel, terms, mode))
            }
        } else if compressing {
            let terms = (PressureForce, viscosity, InternalEnergy, Compression);
            Box::new(Program::<_, _, MODES>::new(kernel, terms, mode))
        } else {
            let terms = (PressureForce, viscosity, InternalEnergy);
            Box::new(Program::<_, _, MODES>::new(kernel, terms, mode))
        };
        Scheme {
            name: self.name,
            kernel: KernelFacts::of(&kernel),
            density: self.density,
            pressure_form: self.pressure_form.unwrap_or(self.density),
            energy: self.energy,
            smoothing: self.smoothing,
            h_over_dx: self.h_over_dx.unwrap_or(kernel.h_over_dx()),
            step_factor: self.step_factor.unwrap_or(DEFAULT_STEP_FACTOR),
            normalised: self.normalised,
            viscosity_problems,
            kernel_problems: crate::kernel::problems_of(&kernel),
            switch,
            reference: Some(Box::new(Program::<_, _, MODES>::new(
                kernel,
                (KernelSum, Unity, KernelMoment),
                mode,
            ))),
            sums,
            compression,
            gradient,
            rates,
            liquid: None,
            lattice_moment: 1.0,
        }
    }
}

/// Default step in units of h/(c + signal). Limited viscosity at α = 2 with corrected dispersion loses
/// its plateau at 0.8 and blows up at 1.1; the steepest fronts come at or below 0.55.
pub const DEFAULT_STEP_FACTOR: f64 = 0.55;

impl<T, const D: usize, K, V, const MODES: u8, const CURVED: bool>
    From<SchemeBuilder<K, V, MODES, CURVED>> for Scheme<T, D>
where
    T: Real,
    K: Kernel<D>,
    V: ArtificialViscosity<D>,
{
    fn from(builder: SchemeBuilder<K, V, MODES, CURVED>) -> Self {
        builder.compose()
    }
}
