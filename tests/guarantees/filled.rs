//! An effect of tests: Σ V W over the neighbours, summed at a stage and kept in a field.
//! With the published surface alone.

use meshfree::effect::{Effect, Point, PointLaw, Reach, Setting, StepProgram};
use meshfree::name;
use meshfree::particles::{Field, Fields, Output, Outputs};
use meshfree::prelude::*;
use meshfree::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, parts::StageMarker, stage};
use std::marker::PhantomData;

pub const FILLED: Field = Field::scalar(name!("filling", "1"));
const FILLING: Output = Output::scalar(name!("sum of volumes", "1"));

/// Σ V W at the stage `M`.
#[derive(Clone, Copy, Debug)]
pub struct Filled<M>(Stage, PhantomData<M>);

pub const WHERE_DENSITIES_ARE: Filled<stage::Density> = Filled(Stage::Density, PhantomData);
pub const WHERE_GRADIENTS_ARE: Filled<stage::Gradients> = Filled(Stage::Gradients, PhantomData);

impl<const D: usize, M: StageMarker<D>> Term<D> for Filled<M> {
    const NAME: &'static str = "tests::filled";
    const READS: Fields = Fields::of(&[Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[FILLING]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volume = pair.j(Field::MASS) / pair.j(Field::DENSITY);
        sums.add(FILLING, volume * pair.w);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "filling".into(),
            equation: "Σ V W",
            source: "a test",
        }
    }
}

impl<const D: usize, M: StageMarker<D>> Effect<D> for Filled<M> {
    type Terms = (In<M, Self>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(self.clone()),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(FILLED, 0.0);
        program.law(self.0, self.clone());
    }
}

impl<const D: usize, M: StageMarker<D>> PointLaw<D> for Filled<M> {
    const NAME: &'static str = "filling";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[FILLED]);
    const SUMS: Outputs = Outputs::of(&[FILLING]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        at.set(FILLED, at.sum(FILLING));
    }
}
