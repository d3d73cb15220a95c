//! Hourglass control that yields with the metal: its stiffness falls to the secant of the stress that is left.
//! After the idea that a control must not carry a load that the solid does not (Ganzenmüller 2015); the measure is of this crate.

use super::hourglass_control::STIFFNESS;
use super::radial_return::before;
use super::{
    Around, CONSTANTS, Effect, Plasticity, Point, PointLaw, Reach, Rung, Setting, StepProgram,
};
use crate::error::Problem;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::term::{Stage, TermDoc};

/// Cuts the stiffness of [`HourglassControl`](super::HourglassControl) where a [`FiniteStrainPlasticity`](super::FiniteStrainPlasticity) solid has flowed.
///
#[doc = include_str!("../../docs/equations/yielding_hourglass.html")]
///
/// with the plastic strain ε, the yield stress Y there at rest, and the shear modulus G: the secant of the stress that is borne over
/// that of the same strain without flow. A control of full stiffness is an elastic spring of the body as built, and resists
/// folds that are meant to stay. What its springs hold when they are cut is not told apart from what they have worked: the
/// ledger's `hourglass energy` stays the work of the control, and total energy is kept as before. Put it behind the plasticity in the
/// list.
///
/// ```
/// use meshfree::effect::{FiniteStrainPlasticity, YieldingHourglass};
/// use meshfree::prelude::*;
///
/// let scheme = schemes::total_lagrangian_impact().with(FiniteStrainPlasticity).with(YieldingHourglass);
/// let bar = Body::block("bar", catalogue::ofhc_copper(), [0.0; 2], [0.01, 0.004], 5e-4).velocity([-100.0, 0.0]);
/// let mut bar = Scene::<f64, 2>::new(scheme)
///     .body(bar)
///     .boundary(MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]))
///     .build()?;
/// bar.run_until(2e-6)?;
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct YieldingHourglass;

const STRAIN: Field = Plasticity::STRAIN;
const WORK: Field = Plasticity::WORK;

impl<const D: usize> Effect<D> for YieldingHourglass {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::State, *self);
        program.document(TermDoc {
            name: "yielding hourglass control".into(),
            equation: "E ← E Y/(Y + 3 G ε)",
            source: "of this crate, after Ganzenmüller 2015",
        });
        program.require(|scene| {
            let both = scene.written.contains(STRAIN)
                && scene.written.contains(super::TotalLagrangian::PIOLA);
            (!both).then(|| Problem::Incompatible {
                what: "YieldingHourglass cuts a control by plastic strain, which nothing in the scheme makes".into(),
                remedy: "add .with(FiniteStrainPlasticity), or leave it out",
            })
        });
    }
}

impl<const D: usize> PointLaw<D> for YieldingHourglass {
    const NAME: &'static str = "yielding of the hourglass control";
    const READS: Fields = Fields::of(&[STIFFNESS, STRAIN, WORK, Field::PRESSURE, Field::DENSITY]);
    const WRITES: Fields = Fields::of(&[STIFFNESS]);
    const RUNG: Option<Rung> = Some(Rung::Flow);
    const DOUBLE: bool = true;
    fn prepare<T: Real>(&self, around: &Around<'_, T, D>, _all: &mut [f64; CONSTANTS]) -> bool {
        super::plasticity::flows(around)
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let material = at.around.material;
        let (Some(law), Some(shear)) = (material.strength(), material.shear_modulus) else {
            return;
        };
        let modulus = L::of(material.youngs_modulus().unwrap_or(0.0));
        let state = before(at);
        let yields = law.yield_stress(&state);
        let left = yields / L::of(3.0 * shear).fused(state.strain, yields);
        let own = L::select(
            state.strain.gt(L::zero()),
            modulus * left,
            at.get(STIFFNESS),
        );
        at.set(STIFFNESS, own);
    }
}
