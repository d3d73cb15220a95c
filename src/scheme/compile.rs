//! How the choices of a scheme are compiled into sweeps over pairs, and into the program of a step.
//! Loops are of those choices that the type of the builder allows, and of no others.

use super::builder::{Consistency, SchemeBuilder};
use super::gradients::Gradients;
use super::{EnergyForm, Entries, Scheme, Smoothing};
use crate::effect::{
    CorrectedGradients, DensityForm, Effect, Effects, Setting, StepProgram, ViscositySwitch,
};
use crate::error::Problem;
use crate::kernel::{Kernel, KernelFacts, Profile};
use crate::particles::{Field, Fields};
use crate::scalar::Real;
use crate::sweep::{FusedKernel, PairSweep, SmoothingMode};
use crate::term::{
    ArtificialViscosity, ByName, Join, KernelMoment, KernelSum, SlopeInH, Stage, StageMarker,
    StagedTerms, Terms, Unity, Viscosity, stage,
};

impl<K, V, W, E> SchemeBuilder<K, V, W, E> {
    pub(super) fn composed<T: Real, const D: usize>(self) -> Scheme<T, D>
    where
        K: Kernel<D>,
        V: ArtificialViscosity<D>,
        W: Effect<D>,
        E: Effects<D>,
    {
        let own = &self.settings;
        let h_over_dx = own.h_over_dx.unwrap_or(self.kernel.h_over_dx());
        let forms = (own.density, own.pressure_form.unwrap_or(own.density));
        let smoothing = self.effects.smoothing();
        let setting = Setting {
            energy: own.energy,
            smoothing,
            ..Setting::of(&self.kernel, h_over_dx, forms)
        };
        let compiled = Compiled::<_, _, _, _, D> {
            own: &self,
            setting,
        };
        let integrated = own.density.is_integrated();
        let follows_divergence = matches!(smoothing, Smoothing::Divergence(_));
        // A switch follows the compression once a step, by the sum that the rates make.
        let support = setting.kernel.support;
        let switch = ViscositySwitch::of(&self.viscosity, own.density, support);
        let with_rates = integrated || follows_divergence || switch.is_some();
        let mut sweeps: [Option<Box<dyn PairSweep<T, D>>>; Stage::COUNT] = Default::default();
        sweeps[Stage::Reference.number()] = compiled.named(compiled.of::<stage::Reference>());
        // Where density follows from sums, contacts are among these.
        sweeps[Stage::Contacts.number()] = compiled.reference().filter(|_| integrated);
        sweeps[Stage::Density.number()] = compiled.density(own.density);
        let walls = ByName::<_, D>(self.walls.terms(&setting).at::<stage::Walls>());
        let walls = Join(walls, compiled.of::<stage::Walls>());
        sweeps[Stage::Walls.number()] = compiled.named(walls);
        sweeps[Stage::Gradients.number()] = compiled.gradients();
        sweeps[Stage::Flow.number()] = compiled.named(compiled.of::<stage::Flow>());
        sweeps[Stage::Rates.number()] = Some(compiled.rates(with_rates));
        sweeps[Stage::Continuity.number()] = compiled.continuity(integrated || follows_divergence);

        let mut program = StepProgram::new(setting);
        let makes_gradients = compiled.makes_gradients();
        if makes_gradients {
            let wanted = Gradients::<V, W, E>::wanted::<D>();
            let by_kernel = smoothing.mode() == SmoothingMode::Own;
            program.law(Stage::Gradients, CorrectedGradients { wanted, by_kernel });
        }
        // A viscosity that is chosen at run time reads what others of its kind do, and nothing may write that.
        let remembered = Fields::of(&[Field::VISCOSITY_COEFFICIENT, Field::DIVERGENCE]);
        let mut unwritten = remembered.minus(remembered.minus(V::READS));
        if !makes_gradients {
            unwritten = unwritten.union(Gradients::<V, W, E>::wanted::<D>());
        }
        for field in unwritten.iter() {
            program.carry(field);
        }
        self.walls.register(&mut program);
        program.books_energy &= W::BOOKS_ENERGY;
        self.effects.register(&mut program);
        if let Some(law) = switch {
            program.declare(Field::VISCOSITY_COEFFICIENT, law.switch.start());
            for field in law.switch.keeps().iter() {
                program.carry(field);
            }
            program.law(Stage::Rates, law);
        }
        let carries_energy = own.energy != EnergyForm::None;
        let cannot = (carries_energy && !E::ENERGY && !program.gives_state)
            || !(integrated || E::SUMS || own.density == DensityForm::Deformation);
        program.require(move |_| {
            cannot.then(|| Problem::Incompatible {
                what: "a scheme of liquids integrates its density and carries no internal energy".into(),
                remedy: "start from SchemeBuilder::new, or take DensityForm::Continuity or ContinuityByMass with \
                         EnergyForm::None",
            })
        });
        let unnamed = E::LOOPS & smoothing.mode().bit() == 0;
        program.require(move |_| {
            unnamed.then(|| Problem::Incompatible {
                what: format!("an effect asks for {smoothing:?} smoothing lengths, of which its loops are not compiled"),
                remedy: "name SmoothingMode::Mean or SmoothingMode::Own in Effect::MODES",
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
        let mut scheme = Scheme {
            name: own.name.clone(),
            kernel: if E::REFERENCE {
                // Neighbours that stay do not pair, and tension does not part them.
                KernelFacts {
                    range: REFERENCE_RANGE,
                    ..setting.kernel
                }
            } else {
                setting.kernel
            },
            profile: Profile::of::<K, D>(self.kernel),
            density: own.density,
            pressure_form: setting.pressure_form,
            energy: own.energy,
            smoothing,
            h_over_dx: setting.h_over_dx,
            step_factor: own.step_factor * program.step_factor(),
            consistent_at_rest: own.consistency == Consistency::AtRest,
            between: own.between,
            kernel_problems: crate::kernel::problems_of(&self.kernel),
            problems: viscous
                .map(|one| of(" of the artificial viscosity", one))
                .chain(effects.map(|one| of("", one)))
                .collect(),
            reference: compiled.reference(),
            sweeps,
            lattice_consistency_factor: if own.consistency == Consistency::Lattice {
                setting.lattice_consistency_factor
            } else {
                1.0
            },
            program,
            entries: Entries::default(),
        };
        scheme.entries = Entries::of(&scheme);
        scheme
    }

    /// Asks that all sums are over the reference configuration where one is, and none where none is.
    fn require_reference<T: Real, const D: usize>(
        &self,
        sweeps: &[Option<Box<dyn PairSweep<T, D>>>],
        program: &mut StepProgram<T, D>,
    ) where
        V: ArtificialViscosity<D>,
        E: Effects<D>,
    {
        let total = E::REFERENCE;
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
        let varies = program.setting().smoothing.varies() || self.viscosity.switch().is_some();
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
}

/// Ratios of smoothing length to spacing of total-Lagrangian schemes: from the least at which every kernel reaches the
/// neighbours across a diagonal, to what bends half as well.
const REFERENCE_RANGE: (f64, f64) = (0.8, 2.0);

/// The choices on their way into sweeps.
struct Compiled<'a, K, V, W, E, const D: usize> {
    own: &'a SchemeBuilder<K, V, W, E>,
    setting: Setting,
}

impl<K, V, W, E, const D: usize> Compiled<'_, K, V, W, E, D>
where
    K: Kernel<D>,
    V: ArtificialViscosity<D>,
    W: Effect<D>,
    E: Effects<D>,
{
    /// The terms of a stage.
    fn of<S: StageMarker<D>>(&self) -> ByName<E::At<S>, D> {
        ByName(self.own.effects.at::<S>(&self.setting))
    }

    fn sweep<T: Real>(&self, terms: impl Terms<D>) -> Box<dyn PairSweep<T, D>> {
        const UNIFORM: u8 = SmoothingMode::Uniform.bit();
        const MEAN: u8 = SmoothingMode::Mean.bit();
        const OWN: u8 = SmoothingMode::Own.bit();
        let (kernel, mode) = (self.own.kernel, self.setting.smoothing.mode());
        // A mode that no effect names leaves no loop behind.
        if const { E::LOOPS & OWN != 0 }
            && (const { E::LOOPS == OWN } || mode == SmoothingMode::Own)
        {
            Box::new(FusedKernel::<_, _, OWN>::new(kernel, terms))
        } else if const { E::LOOPS & MEAN != 0 }
            && (const { E::LOOPS & UNIFORM == 0 } || mode == SmoothingMode::Mean)
        {
            Box::new(FusedKernel::<_, _, MEAN>::new(kernel, terms))
        } else {
            Box::new(FusedKernel::<_, _, UNIFORM>::new(kernel, terms))
        }
    }

    /// The sweep of some terms, if there are any.
    fn named<T: Real, A: Terms<D>>(&self, terms: A) -> Option<Box<dyn PairSweep<T, D>>> {
        if const { A::WRITES.is_empty() } {
            return None;
        }
        Some(self.sweep(terms))
    }

    fn density<T: Real>(&self, form: DensityForm) -> Option<Box<dyn PairSweep<T, D>>> {
        let (sums, own) = (self.of::<stage::Sums>(), self.of::<stage::Density>());
        if const { !E::SUMS } || form.is_integrated() {
            return self.named(own);
        }
        if matches!(form, DensityForm::Normalised | DensityForm::Lam) {
            return Some(self.sweep(Join(Join(sums, (Unity,)), own)));
        }
        let solved = matches!(self.setting.smoothing, Smoothing::Consistent(_));
        if const { E::LOOPS & SmoothingMode::Own.bit() != 0 } && solved {
            return Some(self.sweep(Join(Join(sums, (SlopeInH,)), own)));
        }
        Some(self.sweep(Join(sums, own)))
    }

    /// The sums at rest from which densities measure.
    fn reference<T: Real>(&self) -> Option<Box<dyn PairSweep<T, D>>> {
        if const { E::SUMS } {
            return Some(self.sweep((KernelSum, Unity, KernelMoment)));
        }
        None
    }

    fn gradients<T: Real>(&self) -> Option<Box<dyn PairSweep<T, D>>> {
        let own = self.of::<stage::Gradients>();
        if self.makes_gradients() {
            return Some(self.sweep(Join(Gradients::<V, W, E>::NEW, own)));
        }
        self.named(own)
    }

    /// Whether it makes gradients of its own.
    fn makes_gradients(&self) -> bool {
        // A viscosity that is chosen at run time may ask for nothing.
        let asked = const { !Gradients::<V, W, E>::of_others::<D>().is_empty() };
        let wanted = const { !Gradients::<V, W, E>::wanted::<D>().is_empty() };
        wanted && (asked || self.own.viscosity.needs_velocity_gradient())
    }

    fn rates<T: Real>(&self, with_compression: bool) -> Box<dyn PairSweep<T, D>> {
        let viscosity = (Viscosity(self.own.viscosity.clone()),);
        let forces = Join(self.of::<stage::Pressure>(), viscosity);
        let forces = Join(forces, self.of::<stage::Rates>());
        let forces = Join(forces, self.of::<stage::Power>());
        // Liquids sum it in drifts alone.
        if const { E::ENERGY } && with_compression {
            return self.sweep(Join(forces, self.of::<stage::Compression>()));
        }
        self.sweep(forces)
    }

    fn continuity<T: Real>(&self, integrated: bool) -> Option<Box<dyn PairSweep<T, D>>> {
        let own = self.of::<stage::Continuity>();
        if const { !E::SUMS } || integrated {
            return self.named(Join(self.of::<stage::Compression>(), own));
        }
        self.named(own)
    }
}
