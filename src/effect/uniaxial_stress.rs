//! Bars in one dimension that are free to widen: the lateral strain by which lateral stress is zero.
//! Without it a line of particles is a layer of an infinite plate, in uniaxial strain.

use super::{
    Chunk, Effect, Evolved, Hypoelastic, Law, Rate, Setting, StepProgram, Tally, View, When,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
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

/// −ν ∂v/∂x of each particle.
fn widening<T: Real>(at: &View<'_, T, 1>, slot: usize) -> T {
    let poisson = at.around.material.poisson_ratio().unwrap_or(0.0);
    at.velocity_gradient(slot)[(0, 0)] * T::from_f64(-poisson)
}

impl<T: Real> Rate<T, 1> for UniaxialStress {
    fn reads(&self) -> Fields {
        Fields::NONE
    }
    fn sums(&self) -> Outputs {
        GRADIENT
    }
    fn source(&self, at: &View<'_, T, 1>, first: usize, source: &mut [T]) {
        for (n, rate) in source.iter_mut().enumerate() {
            *rate += widening(at, first + n);
        }
    }
}

/// What widening adds to the rate of S, 2 G (D − tr D/3) of its two components.
#[derive(Clone, Copy, Debug)]
struct WideningStress;

impl<T: Real> Rate<T, 1> for WideningStress {
    fn reads(&self) -> Fields {
        Fields::NONE
    }
    fn sums(&self) -> Outputs {
        GRADIENT
    }
    fn source(&self, at: &View<'_, T, 1>, first: usize, source: &mut [T]) {
        let twice = T::from_f64(2.0 * at.around.material.shear_modulus.unwrap_or(0.0));
        for (n, source) in source.chunks_exact_mut(6).enumerate() {
            let rate = widening(at, first + n);
            let strain = Symmetric::diagonal([T::zero(), rate, rate]);
            for (sum, rate) in source.iter_mut().zip(strain.deviator().components()) {
                *sum += twice * *rate;
            }
        }
    }
}

impl<T: Real> Law<T, 1> for UniaxialStress {
    fn name(&self) -> &'static str {
        "pressure of uniaxial stress"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[STRESS])
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::PRESSURE])
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, 1>) -> Tally {
        let ([stress], [pressure]) = chunk.columns([STRESS], [Field::PRESSURE]);
        for (pressure, stress) in pressure.iter_mut().zip(stress.chunks_exact(6)) {
            *pressure = stress[1];
        }
        Tally::default()
    }
}
