//! Density diffusion of weakly compressible liquids, summed with the rate of density.
//! The forms are terms: Molteni & Colagrossi 2009, Fourtakas et al. 2019, Antuono et al. 2010, Riemann.

use super::{BySum, DensityForm, Effect, Setting, StepProgram};
use crate::error::Problem;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::term::{In, Term, stage};

/// Diffusion of density by one of the terms [`Fourtakas`](crate::term::Fourtakas),
/// [`Molteni`](crate::term::Molteni), [`Antuono`](crate::term::Antuono),
/// [`RiemannDiffusion`](crate::term::RiemannDiffusion), or one of your own that adds to
/// [`Output::DENSITY_DIFFUSION`].
///
#[doc = include_str!("../../docs/equations/density_diffusion.html")]
///
/// Each term has its ψ.
///
/// ```
/// use meshfree::prelude::*;
/// use meshfree::term::Antuono;
/// let scheme: Scheme<f64, 2> = schemes::weakly_compressible()
///     .density_diffusion(Antuono::default())
///     .compose();
/// ```
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DensityDiffusion<W>(pub W);

impl<const D: usize, W: Term<D>> Effect<D> for DensityDiffusion<W> {
    type Terms = (In<stage::Continuity, W>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(self.0.clone()),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        // There may be none.
        if W::WRITES.contains(Output::DENSITY_DIFFUSION) {
            let rate = BySum {
                sum: Output::DENSITY_DIFFUSION,
                over: None,
            };
            program.contribute(Field::DENSITY, rate);
            let by_mass = program.setting().density == DensityForm::ContinuityByMass;
            program.require(move |_| {
            by_mass.then(|| Problem::Incompatible {
                what: "density diffusion weighs neighbours by volume, which continuity by mass does not carry"
                    .into(),
                remedy: "take DensityForm::Continuity, or no diffusion (term::Nothing)",
            })
        });
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        self.0.problems()
    }
}
