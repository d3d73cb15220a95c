//! How the choices of a scheme are compiled into sweeps over pairs, and into the program of a step.
//! Loops are of those choices that the type of the builder allows, and of no others.

use super::builder::{Consistency, SchemeBuilder};
use super::force::{ENERGY, Gradients, Needs, Pressure, REFERENCE, Rate};
use super::{EnergyForm, Scheme, Smoothing};
use crate::effect::{
    BySum, Compression, ConsistentSmoothing, ContactActivity, CorrectedGradients, DensityForm,
    Divergence, Effect, Effects, Evolved, Setting, StepProgram, SummedDensity, Update,
    ViscositySwitch, When,
};
use crate::error::Problem;
use crate::kernel::{Kernel, KernelFacts, Profile};
use crate::particles::{Field, Fields, Output};
use crate::scalar::Real;
use crate::sweep::{FusedKernel, PairSweep, SmoothingMode};
use crate::term::{
    ArtificialViscosity, InternalEnergy, KernelMoment, KernelSum, MidpointReconstruction, SlopeInH,
    Stage, StageMarker, StagedTerms, Terms, Unity, Viscosity, stage,
};
use core::marker::PhantomData;

impl<K, V, W, E, const MODES: u8, const FORCE: u8> SchemeBuilder<K, V, W, E, MODES, FORCE> {
    fn setting<const D: usize>(&self) -> Setting
    where
        K: Kernel<D>,
    {
        let own = &self.settings;
        let h_over_dx = own.h_over_dx.unwrap_or(self.kernel.h_over_dx());
        let forms = (own.density, own.pressure_form.unwrap_or(own.density));
        Setting::of(&self.kernel, h_over_dx, forms)
    }

    fn mode(&self) -> SmoothingMode {
        match self.settings.smoothing {
            Smoothing::Consistent { .. } => SmoothingMode::Own,
            Smoothing::Divergence { .. } => SmoothingMode::Mean,
            Smoothing::Fixed if MODES & SmoothingMode::Uniform.bit() != 0 => SmoothingMode::Uniform,
            Smoothing::Fixed => SmoothingMode::Mean,
        }
    }

    pub(super) fn composed<T: Real, const D: usize>(self) -> Scheme<T, D>
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
        let support = setting.kernel.support;
        let switch = ViscositySwitch::<T>::of(&self.viscosity, own.density, support);
        let with_rates = integrated || follows_divergence || switch.is_some();
        let mut sweeps: [Option<Box<dyn PairSweep<T, D>>>; Stage::COUNT] = Default::default();
        sweeps[Stage::Reference.number()] = compiled.at::<stage::Reference, T, D>();
        sweeps[Stage::Density.number()] = compiled.density(own.density);
        let walls = self.walls.terms(&setting).at::<stage::Walls>();
        let walls = walls.then(self.effects.at::<stage::Walls>(&setting));
        sweeps[Stage::Walls.number()] = compiled.named(walls);
        sweeps[Stage::Gradients.number()] = compiled.gradients();
        sweeps[Stage::Flow.number()] = compiled.at::<stage::Flow, T, D>();
        sweeps[Stage::Rates.number()] = Some(compiled.rates(with_rates));
        sweeps[Stage::Continuity.number()] = compiled.continuity(integrated || follows_divergence);

        let mut program = StepProgram::new(setting);
        let makes_gradients = compiled.makes_gradients::<D>();
        if makes_gradients {
            let wanted = Gradients::<V, NeedsOf<W, E, D>, FORCE>::wanted::<D>();
            program.law(Stage::Gradients, CorrectedGradients { wanted });
        }
        // A viscosity that is chosen at run time reads what others of its kind do, and nothing may write that.
        let remembered = Fields::of(&[Field::VISCOSITY_COEFFICIENT, Field::DIVERGENCE]);
        let mut unwritten = remembered.minus(remembered.minus(V::READS));
        if !makes_gradients {
            unwritten = unwritten.union(Gradients::<V, NeedsOf<W, E, D>, FORCE>::wanted::<D>());
        }
        for field in unwritten.iter() {
            program.carry(field);
        }
        self.evolve(&mut program);
        self.walls.register(&mut program);
        program.books_energy &= W::BOOKS_ENERGY;
        self.effects.register(&mut program);
        if let Some(law) = switch {
            program.start(Field::VISCOSITY_COEFFICIENT, law.switch.start());
            for field in law.switch.keeps().iter() {
                program.carry(field);
            }
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
        self.require_reference(&sweeps, &mut program);
        program.arrange();
        let of = |what: &str, (name, value, must_be)| (format!("{name}{what}"), value, must_be);
        let viscous = self.viscosity.problems().into_iter();
        let effects = self
            .walls
            .problems()
            .into_iter()
            .chain(self.effects.problems());
        Scheme {
            name: own.name.clone(),
            kernel: if FORCE & REFERENCE == 0 {
                KernelFacts::of(&self.kernel)
            } else {
                // Neighbours that stay do not pair, and tension does not part them.
                KernelFacts {
                    range: REFERENCE_RANGE,
                    ..KernelFacts::of(&self.kernel)
                }
            },
            profile: Profile::of::<K, D>(self.kernel),
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
            reference: (FORCE & (ENERGY | REFERENCE) == ENERGY).then(|| compiled.reference()),
            sweeps,
            lattice_consistency_factor: if own.consistency == Consistency::Lattice {
                setting.lattice_consistency_factor
            } else {
                1.0
            },
            program,
        }
    }

    /// Asks that all sums are over the reference configuration where one is, and none where none is.
    fn require_reference<T: Real, const D: usize>(
        &self,
        sweeps: &[Option<Box<dyn PairSweep<T, D>>>],
        program: &mut StepProgram<T, D>,
    ) where
        V: ArtificialViscosity<D>,
    {
        let total = FORCE & REFERENCE != 0;
        let own = &self.settings;
        let other_form = total != (own.density == DensityForm::Deformation);
        program.require(move |_| {
            other_form.then(|| Problem::Incompatible {
                what: "the density of a total-Lagrangian body follows from its deformation, and that of no other does"
                    .into(),
                remedy: "start from SchemeBuilder::total_lagrangian, and leave its density form as it is",
            })
        });
        let refers =
            |sweep: &dyn PairSweep<T, D>| sweep.fields().contains(Field::REFERENCE_POSITION);
        let mut all = sweeps.iter().flatten();
        let varies = own.smoothing != Smoothing::Fixed || self.viscosity.switch::<T>().is_some();
        let mixed = all.any(|sweep| refers(sweep.as_ref()) != total) || (total && varies);
        program.require(move |_| {
            mixed.then(|| Problem::Incompatible {
                what: "an effect, a viscosity or a smoothing law sums over the present neighbours in a total-Lagrangian \
                       scheme, which has those of the reference configuration alone, or the other way round"
                    .into(),
                remedy: "take a viscosity without gradients and switches (Inviscid, MonaghanGingold, SignalVelocity), a \
                         fixed smoothing length, and effects of total-Lagrangian solids",
            })
        });
    }

    /// What the scheme itself integrates in time, and how density follows from sums.
    fn evolve<T: Real, const D: usize>(&self, program: &mut StepProgram<T, D>) {
        let own = &self.settings;
        let setting = *program.setting();
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
                .at(When::Drift)
                .updated(Update::Exponential)
                .by(compression);
            program.evolve(density.keeping(Field::DENSITY_RESIDUAL));
        } else if let Smoothing::Consistent { smallest, largest } = own.smoothing {
            let law = ConsistentSmoothing {
                eta: setting.h_over_dx,
                limits: [smallest, largest],
            };
            program.law(Stage::Density, law);
        } else if FORCE & REFERENCE == 0 {
            program.law(Stage::Density, SummedDensity(own.density));
        }
        // Liquids have no contacts, and smoothing that follows density takes bodies as one.
        if FORCE & (ENERGY | REFERENCE) == ENERGY
            && !matches!(own.smoothing, Smoothing::Consistent { .. })
        {
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

/// Ratios of smoothing length to spacing of total-Lagrangian schemes: from the least at which every kernel reaches the
/// neighbours across a diagonal, to what bends half as well.
const REFERENCE_RANGE: (f64, f64) = (0.8, 2.0);

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
        if const { FORCE & ENERGY == 0 || FORCE & REFERENCE != 0 } || form.is_integrated() {
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
        let own = self.effects.at::<stage::Gradients>(&self.setting);
        if self.makes_gradients::<D>() {
            return Some(self.sweep(Gradients::<V, N, FORCE>::NEW.then(own)));
        }
        self.named(own)
    }

    /// Whether it makes gradients of its own.
    fn makes_gradients<const D: usize>(&self) -> bool
    where
        V: ArtificialViscosity<D>,
    {
        // A viscosity that is chosen at run time may ask for nothing.
        let asked = const { !Gradients::<V, N, FORCE>::of_others::<D>().is_empty() };
        let wanted = const { !Gradients::<V, N, FORCE>::wanted::<D>().is_empty() };
        wanted && (asked || self.viscosity.needs_velocity_gradient())
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
        if const { FORCE & REFERENCE != 0 } {
            return self.sweep(viscosity.then(own).then((InternalEnergy,)));
        }
        let forces = pressure.then(viscosity).then(own);
        if const { FORCE & ENERGY == 0 } {
            return self.sweep(forces);
        }
        let forces = forces.then((InternalEnergy,));
        if with_compression {
            self.sweep(forces.then((Rate::<FORCE>,)))
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
        if !integrated {
            return self.at::<stage::Continuity, T, D>();
        }
        let own = self.effects.at::<stage::Continuity>(&self.setting);
        Some(self.sweep((Rate::<FORCE>,).then(own)))
    }
}
