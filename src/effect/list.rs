//! Lists of effects: what a scheme is made of, as a type.
//! `((), A)` is a list of one; each call of `with` adds one at the end.

use super::{Setting, Smoothing, StepProgram};
use crate::particles::{Field, Fields};
use crate::scalar::Real;
use crate::sweep::SmoothingMode;
use crate::term::{StageMarker, StagedTerms, TermList, Terms, stage};
use core::fmt::Debug;

/// A physical or numerical effect: its pair terms, and what it does to single particles.
///
/// Everything of an effect stands in one file: pair terms, each with the stage of the sweep that it shares; the
/// fields that it evolves, its laws, its limit of the step, its column in the ledger, in
/// [`register`](Self::register).
/// A scheme that does not name the effect contains nothing of it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an effect in {D} dimensions",
    note = "implement `Effect<{D}>`: its pair terms, and what it does to single particles"
)]
pub trait Effect<const D: usize>: Clone + Debug + Send + Sync + 'static {
    /// Its pair terms: a tuple of up to four [`In`](crate::term::In), `()` for none.
    type Terms: StagedTerms<D>;
    /// Gradients that its laws read, in addition to what its terms read: [`Field::VELOCITY_GRADIENT`] and its like.
    ///
    /// [`Field::VELOCITY_GRADIENT`]: crate::particles::Field::VELOCITY_GRADIENT
    const NEEDS: Fields = Fields::NONE;
    /// The [modes](SmoothingMode::bit) of loops that its [`smoothing`](Self::smoothing) may ask for.
    const MODES: u8 = 0;
    /// Whether all energy that its forces store is declared by [`StepProgram::store`], or they store none and take energy
    /// alone, as a viscosity does. `false` by default: of a scheme with such an effect nothing is said about
    /// [stored energy](crate::simulation::Simulation::stored_energy).
    const BOOKS_ENERGY: bool = false;
    /// The terms, for a scheme with this kernel and spacing.
    fn terms(&self, setting: &Setting) -> Self::Terms;
    /// How smoothing lengths change under it, if it says so.
    fn smoothing(&self) -> Option<Smoothing> {
        None
    }
    /// Says what it does in addition to its terms.
    fn register<T: Real>(&self, _program: &mut StepProgram<T, D>) {}
    /// What is wrong with its parameters, as `(field, value, what it must be)`.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}

/// A list of effects.
pub trait Effects<const D: usize>: Clone + Debug + Send + Sync + 'static {
    /// The pair terms of a stage.
    type At<S: StageMarker<D>>: TermList<D>;
    /// What terms and laws read.
    const READS: Fields;
    /// The modes of loops that their smoothing may ask for.
    const MODES: u8;
    /// Whether densities may follow from sums.
    const SUMS: bool = !<Self::At<stage::Sums> as Terms<D>>::WRITES.is_empty();
    /// Whether particles may carry energy.
    const ENERGY: bool = !<Self::At<stage::Power> as Terms<D>>::WRITES.is_empty();
    /// Whether kernels are those of the reference configuration.
    const REFERENCE: bool = Self::READS.contains(Field::REFERENCE_POSITION);
    /// The modes of loops that are compiled.
    const LOOPS: u8 = if Self::MODES == 0 {
        SmoothingMode::Uniform.bit()
    } else {
        Self::MODES
    };
    /// The terms of a stage.
    fn at<S: StageMarker<D>>(&self, setting: &Setting) -> Self::At<S>;
    /// How smoothing lengths change.
    fn smoothing(&self) -> Smoothing;
    /// Registers all, in order.
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>);
    /// What is wrong with their parameters.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)>;
}

impl<const D: usize> Effects<D> for () {
    type At<S: StageMarker<D>> = ();
    const READS: Fields = Fields::NONE;
    const MODES: u8 = 0;
    fn at<S: StageMarker<D>>(&self, _setting: &Setting) {}
    fn smoothing(&self) -> Smoothing {
        Smoothing::Fixed
    }
    fn register<T: Real>(&self, _program: &mut StepProgram<T, D>) {}
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}

impl<const D: usize, A: Effects<D>, B: Effect<D>> Effects<D> for (A, B) {
    type At<S: StageMarker<D>> =
        <A::At<S> as TermList<D>>::Then<<B::Terms as StagedTerms<D>>::At<S>>;
    const READS: Fields = A::READS
        .union(B::NEEDS)
        .union(<B::Terms as StagedTerms<D>>::READS);
    const MODES: u8 = A::MODES | B::MODES;
    fn at<S: StageMarker<D>>(&self, setting: &Setting) -> Self::At<S> {
        let next = self.1.terms(setting).at::<S>();
        self.0.at::<S>(setting).then(next)
    }
    fn smoothing(&self) -> Smoothing {
        self.0.smoothing().then(self.1.smoothing())
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        self.0.register(program);
        self.1.register(program);
        program.books_energy &= B::BOOKS_ENERGY;
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = self.0.problems();
        problems.extend(self.1.problems());
        problems
    }
}

/// An effect without pair terms may be chosen at run time.
impl<const D: usize, A: Effect<D, Terms = ()>> Effect<D> for Option<A> {
    type Terms = ();
    const NEEDS: Fields = A::NEEDS;
    const MODES: u8 = if A::MODES == 0 {
        0
    } else {
        A::MODES | SmoothingMode::Uniform.bit()
    };
    const BOOKS_ENERGY: bool = A::BOOKS_ENERGY;
    fn terms(&self, _setting: &Setting) {}
    fn smoothing(&self) -> Option<Smoothing> {
        self.as_ref().and_then(Effect::smoothing)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        if let Some(effect) = self {
            effect.register(program);
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        self.as_ref().map_or_else(Vec::new, Effect::problems)
    }
}
