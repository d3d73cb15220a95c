//! Elastic solids whose force is made by the gradients that strain them, corrected at surfaces too.
//! Bonet & Lok 1999 for the force; the stress is that of `hypoelastic`.

use super::{Effect, Hypoelastic, Setting, StepProgram};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Sums, Term, TermDoc, VelocityGradient, corrected, stage};

/// The [`Hypoelastic`] solid with a force by corrected gradients, for
/// [renormalised](crate::scheme::SchemeBuilder::renormalised) schemes.
///
#[doc = include_str!("../../docs/equations/renormalised_hypoelastic.html")]
///
/// Strain follows from the velocity gradient that L corrects, so this force is the one whose power is Σ V S:∇v, and
/// angular momentum is conserved with the linear one. [`Hypoelastic`] divides by one number a particle instead, the first
/// moment at rest: right inside a body, where both are the same on a lattice, and wrong in the row at a free surface,
/// where moments along and across the surface differ. That row carries half of the moment of a plate of ten rows, which
/// bends a fifth too little by it, and bodies that stretch several times over carry a moment that has long ceased to be
/// theirs. It takes D² numbers a particle more.
///
/// Bodies that meet by their kernels alone have a contact that is stiffer than they are, for L is that of the body's own
/// side: let bodies of groups of their own meet by a coupling, as [`ContactDensity`](crate::coupling::ContactDensity).
///
/// [`schemes::updated_lagrangian`](crate::schemes::updated_lagrangian) has all that goes with it. Fields, ledger and limits are
/// those of [`Hypoelastic`].
#[derive(Clone, Copy, Debug, Default)]
pub struct RenormalisedHypoelastic;

const STRESS: Field = Hypoelastic::STRESS;

impl<const D: usize> Effect<D> for RenormalisedHypoelastic {
    type Terms = (
        In<stage::Rates, Self>,
        In<stage::Continuity, VelocityGradient>,
    );
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self), In::new(VelocityGradient))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        Effect::<D>::register(&Hypoelastic, program);
    }
}

impl<const D: usize> Term<D> for RenormalisedHypoelastic {
    const NAME: &'static str = "meshfree::renormalised_hypoelastic";
    const READS: Fields = Fields::of(&[STRESS, Field::MASS, Field::DENSITY, Field::CORRECTION]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volumes = pair.volumes();
        let own = corrected(&pair.r, volumes * pair.weight_i(), |k| {
            pair.i_at(Field::CORRECTION, k)
        });
        let other = corrected(&pair.r, volumes * pair.weight_j(), |k| {
            pair.j_at(Field::CORRECTION, k)
        });
        sums.force += pair.i_tensor(STRESS).dot(&own);
        sums.force += pair.j_tensor(STRESS).dot(&other);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "force of the deviatoric stress by corrected gradients".into(),
            equation: "mᵢ dvᵢ/dt = Σⱼ Vᵢ Vⱼ (Sᵢ Lᵢ + Sⱼ Lⱼ)·∇Wᵢⱼ",
            source: "Bonet & Lok 1999",
        }
    }
}
