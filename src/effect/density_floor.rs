//! A least density of debris: what has lost its neighbours keeps a volume that its kernel can stand for.
//! Mass, momentum and energy stay what they are.

use super::{Around, CONSTANTS, Effect, Point, PointLaw, Reach, Rung, Setting, StepProgram};
use crate::error::Problem;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::term::{Stage, TermDoc};

/// Holds densities that follow from continuity above a share of that at rest.
///
#[doc = include_str!("../../docs/equations/density_floor.html")]
///
/// In debris a particle whose neighbours all leave goes on expanding by continuity, though nothing is left that it could
/// measure: its density falls without end, and its volume m/ρ outweighs all others in their gradients and forces. A
/// particle at h/dx 1.2 without neighbours fills about as much as its kernel, some five to ten times its volume at rest in
/// space; from there on density says nothing. Densities that were held are counted in
/// [`limits`](crate::simulation::Simulation::limits) as `density floor`.
///
/// ```
/// use meshfree::effect::{Damage, DensityFloor, Hypoelastic};
/// use meshfree::material::failure::SpallStrength;
/// use meshfree::prelude::*;
///
/// // A copper bar bursts, and its pieces do not thin out to nothing.
/// let copper = catalogue::copper().with_shear_modulus(46e9).with_failure(SpallStrength::new(1e9));
/// let apart = |[x]: [f64; 1], start| meshfree::scheme::Start { velocity: [2e5 * x], ..start };
/// let scheme = schemes::impact_by_continuity()
///     .with(Hypoelastic)
///     .with(Damage)
///     .with(DensityFloor { share: 0.6 });
/// let mut bar = Scene::<f64, 1>::new(scheme)
///     .body(Body::block("bar", copper, [-0.01], [0.01], 1e-3).start(apart))
///     .build()?;
/// bar.run_until(2e-5)?;
/// assert!(bar.all().all(|particle| particle.density() >= 0.599 * 8930.0));
/// assert!(bar.limited("density floor") > 0);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct DensityFloor {
    /// Share s of the density at rest; 0.1 by default, ten times the volume.
    pub share: f64,
}

impl Default for DensityFloor {
    fn default() -> Self {
        Self { share: 0.1 }
    }
}

impl<const D: usize> Effect<D> for DensityFloor {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::Bounds, *self);
        program.document(TermDoc {
            name: format!("density floor, {} of that at rest", self.share),
            equation: "ρ ← max(ρ, s ρ₀)",
            source: "of this crate",
        });
        program.require(|scene| {
            (!scene.integrated.contains(Field::DENSITY)).then(|| Problem::Incompatible {
                what: "DensityFloor holds densities that follow from continuity, and those of the scheme do not".into(),
                remedy: "take a density by continuity (schemes::impact_by_continuity), or leave it out",
            })
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let fine = self.share > 0.0 && self.share < 1.0;
        (!fine)
            .then_some((
                "share of the density floor",
                self.share,
                "it must be above 0 and below 1",
            ))
            .into_iter()
            .collect()
    }
}

const CHANGED: [Field; 2] = [Field::DENSITY, Field::DENSITY_RESIDUAL];

impl<const D: usize> PointLaw<D> for DensityFloor {
    const NAME: &'static str = "density floor";
    const READS: Fields = Fields::of(&CHANGED);
    const WRITES: Fields = Fields::of(&CHANGED);
    const OPTIONAL: Fields = Fields::of(&[Field::DENSITY_RESIDUAL]);
    const RUNG: Option<Rung> = Some(Rung::Bound);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        constants[0] = self.share * around.material.reference_density();
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (density, least) = (at.get(Field::DENSITY), at.constant(0));
        // What is no number stays one, and ends the run.
        let low = density.lt(least);
        let residual = at.get(Field::DENSITY_RESIDUAL);
        at.set(Field::DENSITY, L::select(low, least, density));
        at.set(Field::DENSITY_RESIDUAL, L::select(low, L::zero(), residual));
        at.limited(low);
    }
}
