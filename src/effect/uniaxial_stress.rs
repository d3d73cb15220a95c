//! Bars in one dimension that are free to widen: the lateral strain by which lateral stress is zero.
//! Without it a line of particles is a layer of an infinite plate, in uniaxial strain.

use super::{
    Around, CONSTANTS, Effect, Evolved, Hypoelastic, Point, PointLaw, PointRate, Reach, Setting,
    StepProgram, When,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::tensor::Symmetric;
use crate::term::{Stage, TermDoc};

/// Uniaxial stress, for [`Hypoelastic`] solids in one dimension: slender bars, whose waves run at √(E/ρ).
///
#[doc = include_str!("../../docs/equations/uniaxial_stress.html")]
///
/// with Young's modulus E = 9KG/(3K + G) and Poisson's ratio ν of the material at rest;
/// [`Plasticity`](super::Plasticity) keeps lateral stress at zero too. The pressure of the equation of state does not
/// act. Strains are small: the force is that on the cross-section at rest, so at a strain of 10 % it is some 10 % too
/// small in compression, and too large in tension. The step, and viscosity, take the speed of longitudinal waves in the bulk, which is above
/// that of the bar.
///
/// | it adds | as |
/// |---|---|
/// | [`LATERAL_STRAIN`](Self::LATERAL_STRAIN) | ε_yy = ε_zz, positive where the bar has widened |
///
/// ```
/// use meshfree::effect::{Hypoelastic, UniaxialStress};
/// use meshfree::prelude::*;
///
/// let steel = catalogue::steel_4340();
/// let strike = Body::block("rod", steel, [0.0], [0.05], 5e-4).velocity([-5.0]);
/// let scheme = schemes::impact_by_continuity().with(Hypoelastic).with(UniaxialStress);
/// let mut rod = Scene::<f64, 1>::new(scheme)
///     .body(strike)
///     .boundary(MirrorPlane::wall([0.0], [-1.0]))
///     .build()?;
/// rod.run_until(4e-6)?;
/// let foot = rod.body("rod")?.next().and_then(|p| p.scalar(UniaxialStress::LATERAL_STRAIN));
/// assert!(foot.is_some_and(|strain| strain > 0.0));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct UniaxialStress;

impl UniaxialStress {
    /// Lateral strain.
    pub const LATERAL_STRAIN: Field = Field::scalar(name!("lateral_strain", "1"));
}

const STRESS: Field = Hypoelastic::STRESS;
const LATERAL_STRAIN: Field = UniaxialStress::LATERAL_STRAIN;
const GRADIENT: Outputs = Outputs::of(&[Output::VELOCITY_GRADIENT, Output::MOMENT_MATRIX]);

impl Effect<1> for UniaxialStress {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, 1>) {
        program.declare(LATERAL_STRAIN, 0.0);
        let strain = Evolved::kicked(LATERAL_STRAIN).at(When::Drift);
        program.evolve(strain.by(*self));
        program.contribute(STRESS, WideningStress);
        program.law(Stage::State, *self);
        program.document(TermDoc {
            name: "uniaxial stress".into(),
            equation: "D_yy = D_zz = −ν D_xx, p = S_yy",
            source: "Hooke's law with σ_yy = σ_zz = 0",
        });
        program.require(|scene| {
            (!scene.integrated.contains(STRESS)).then(|| Problem::Incompatible {
                what: "UniaxialStress needs a deviatoric stress, which nothing in the scheme integrates"
                    .into(),
                remedy: "add the elastic solid as well: .with(Hypoelastic)",
            })
        });
    }
}

/// −ν of the material, and twice its shear modulus.
fn constants<T: Real>(around: &Around<'_, T, 1>) -> [f64; CONSTANTS] {
    let poisson = around.material.poisson_ratio().unwrap_or(0.0);
    let shear = around.material.shear_modulus.unwrap_or(0.0);
    [-poisson, 2.0 * shear, 0.0, 0.0]
}

/// −ν ∂v/∂x of each particle.
#[inline(always)]
fn widening<L: Lane, P: Reach>(at: &Point<'_, L, 1, P>) -> L {
    at.velocity_gradient().trace() * at.constant(0)
}

impl PointRate<1> for UniaxialStress {
    const SUMS: Outputs = GRADIENT;
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, 1>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        *constants = self::constants(around);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, 1, P>, _present: L, rate: &mut [L]) {
        rate[0] += widening(at);
    }
}

/// What widening adds to the rate of S, 2 G (D − tr D/3) of its two components.
#[derive(Clone, Copy, Debug)]
struct WideningStress;

impl PointRate<1> for WideningStress {
    const SUMS: Outputs = GRADIENT;
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, 1>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        *constants = self::constants(around);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, 1, P>, _present: L, rate: &mut [L]) {
        let own = widening(at);
        let strain = Symmetric::diagonal([L::zero(), own, own]);
        for (rate, own) in rate.iter_mut().zip(strain.deviator().components()) {
            *rate += at.constant(1) * *own;
        }
    }
}

impl PointLaw<1> for UniaxialStress {
    const NAME: &'static str = "pressure of uniaxial stress";
    const READS: Fields = Fields::of(&[STRESS]);
    const WRITES: Fields = Fields::of(&[Field::PRESSURE]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, 1, P>) {
        at.set(Field::PRESSURE, at.get_at(STRESS, 1));
    }
}
