//! Damage of solids: it grows as the material's law of failure says, and at one a particle supports no shear and no tension.
//! Mass is never deleted: what has failed is counted, and stands in the ledger.

use super::plasticity::cold;
use super::{
    Around, CONSTANTS, Effect, Hypoelastic, LedgerColumn, Plasticity, Point, PointLaw, Reach, Rung,
    Setting, StepProgram,
};
use crate::error::Problem;
use crate::material::failure::FailureState;
use crate::material::strength::{PlasticHeating, ROOM_TEMPERATURE};
use crate::name;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::tensor::Symmetric;
use crate::term::{Stage, TermDoc};

/// Damage D of [`Hypoelastic`] solids by the [law of failure](crate::material::Material::with_failure) of their material.
///
#[doc = include_str!("../../docs/equations/damage.html")]
///
/// A particle that has failed stays so. Below one damage weakens nothing. The law sees each step's stress of the last evaluation's pressure and the
/// deviatoric stress after plastic flow. What failed keeps mass, momentum and energy; particles that have failed
/// are counted once each in [`limits`](crate::simulation::Simulation::limits), under `failure`, and their mass is in the
/// ledger. The energy of distortion that a particle held when it failed stays in its internal energy.
///
/// | it adds | as |
/// |---|---|
/// | [`DAMAGE`](Self::DAMAGE) | D, from 0 to 1 |
/// | [`FAILED`](Self::FAILED) | 1 where D is 1, else 0; in the ledger, times the mass, as `failed mass` |
///
/// Bodies without a law do not fail; a scene in which no body has one is refused. Damage
/// follows the plastic strain of the same step.
///
/// ```
/// use meshfree::effect::{Damage, Hypoelastic};
/// use meshfree::material::failure::SpallStrength;
/// use meshfree::prelude::*;
///
/// // A copper bar whose halves fly apart fails in the middle.
/// let copper = catalogue::copper().with_shear_modulus(46e9).with_failure(SpallStrength::new(1e9));
/// let apart = |[x]: [f64; 1], start| meshfree::scheme::Start {
///     velocity: [if x < 0.0 { -50.0 } else { 50.0 }],
///     ..start
/// };
/// let scheme = schemes::impact_by_continuity().with(Hypoelastic).with(Damage);
/// let mut bar = Scene::<f64, 1>::new(scheme)
///     .body(Body::block("bar", copper, [-0.01], [0.01], 1e-4).start(apart))
///     .build()?;
/// bar.run_until(1e-6)?;
/// let failed = bar.ledger().whole.total("failed mass").unwrap_or(0.0);
/// assert!(failed > 0.0 && failed < 0.2 * bar.ledger().whole.mass);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Damage;

impl Damage {
    /// Damage D, from 0 to 1.
    pub const DAMAGE: Field = Field::scalar(name!("damage", "1"));
    /// 1 where the particle has failed, else 0.
    pub const FAILED: Field = Field::scalar(name!("failed", "1"));
}

const STRESS: Field = Hypoelastic::STRESS;
const DAMAGE: Field = Damage::DAMAGE;
const FAILED: Field = Damage::FAILED;
/// The plastic strain at the last drift.
const FLOWED: Field = Field::scalar(name!("plastic_strain_of_damage", "1"));

impl<const D: usize> Effect<D> for Damage {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(DAMAGE, 0.0);
        program.declare(FAILED, 0.0);
        program.declare(FLOWED, 0.0);
        program.law(Stage::Continuity, *self);
        program.law(Stage::State, NoTension);
        program.ledger(LedgerColumn {
            name: "failed mass",
            unit: "kg",
            field: FAILED,
            times_mass: true,
            factor: 1.0,
        });
        program.document(TermDoc {
            name: "damage".into(),
            equation: "D ← min(D + ΔD, 1), at D = 1: S ← 0 and p ← max(p, 0)",
            source: "Johnson & Cook 1985; the material's law of failure",
        });
        program.require(|scene| {
            (!scene.integrated.contains(STRESS)).then(|| Problem::Incompatible {
                what: "Damage takes the deviatoric stress away, which nothing in the scheme integrates"
                    .into(),
                remedy: "add the elastic solid as well: .with(Hypoelastic)",
            })
        });
        program.require(|scene| {
            let none = scene
                .bodies
                .iter()
                .all(|(_, material)| material.failure().is_none());
            none.then(|| Problem::Incompatible {
                what: "no body has a law of failure, which Damage needs".into(),
                remedy: "give a material a law (Material::with_failure), or leave out Damage",
            })
        });
        program.require(|scene| {
            scene.bodies.iter().find_map(|(body, material)| {
                let law = material.failure()?;
                let flows = scene.written.contains(Plasticity::STRAIN);
                (law.uses_plastic_strain() && !flows).then(|| Problem::Incompatible {
                    what: format!(
                        "the failure of body `{body}`, of {}, follows from plastic strain ({}), and the scheme \
                         has no plastic flow",
                        material.name,
                        law.name()
                    ),
                    remedy: "add .with(Plasticity), or take a law of stress",
                })
            })
        });
        program.require(|scene| {
            cold(scene, "failure", |material| {
                let law = material.failure()?;
                law.uses_temperature().then(|| law.name())
            })
        });
        program.require(|scene| {
            scene.bodies.iter().find_map(|(body, material)| {
                let fails = material.failure()?.pressure_at_failure()?;
                let least = material.eos().pressure_cut_off()?;
                (least > fails).then(|| Problem::Incompatible {
                    what: format!(
                        "body `{body}`, of {}, fails at a pressure of {fails} Pa, which its cut-off at {least} Pa \
                         prevents",
                        material.name
                    ),
                    remedy: "leave out the cut-off (Material::with_pressure_cut_off), or lower it",
                })
            })
        });
    }
}

impl<const D: usize> PointLaw<D> for Damage {
    const NAME: &'static str = "failure";
    const READS: Fields = Fields::of(&[
        STRESS,
        DAMAGE,
        FAILED,
        FLOWED,
        Field::PRESSURE,
        Plasticity::STRAIN,
        Plasticity::WORK,
    ]);
    const WRITES: Fields = Fields::of(&[STRESS, DAMAGE, FAILED, FLOWED]);
    const OPTIONAL: Fields = Fields::of(&[Plasticity::STRAIN, Plasticity::WORK]);
    const RUNG: Option<Rung> = Some(Rung::Failure);
    const DOUBLE: bool = true;
    fn prepare<T: Real>(&self, around: &Around<'_, T, D>, _all: &mut [f64; CONSTANTS]) -> bool {
        around.in_drift && around.material.failure().is_some()
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let material = at.around.material;
        let Some(law) = material.failure() else {
            return;
        };
        let (zero, one) = (L::zero(), L::one());
        let (damage, failed, flowed) = (at.get(DAMAGE), at.get(FAILED), at.get(FLOWED));
        let (stress, pressure) = (at.tensor(STRESS), at.get(Field::PRESSURE));
        let (strain, work, dt) = (
            at.get(Plasticity::STRAIN),
            at.get(Plasticity::WORK),
            at.dt(),
        );
        let increment = strain - flowed;
        let temperature = |own: PlasticHeating| own.temperature(work);
        let state = FailureState {
            strain,
            increment,
            rate: L::select(dt.gt(zero), increment / dt, zero),
            temperature: (material.plastic_heating())
                .map_or_else(|| L::of(ROOM_TEMPERATURE), temperature),
            pressure,
            von_mises: stress.von_mises(),
            principal_stress: largest(&stress) - pressure,
        };
        let whole = damage.lt(one);
        let more = (damage + law.damage(&state)).min(one);
        let damage = L::select(whole, more, damage);
        // In `f32` damage may round to one.
        let fails = damage.ge(one);
        at.limited(fails & failed.lt(one));
        at.set(FLOWED, L::select(whole, strain, flowed));
        at.set(DAMAGE, damage);
        at.set(FAILED, L::select(fails, one, failed));
        for (k, own) in stress.components().iter().enumerate() {
            at.set_at(STRESS, k, L::select(fails, zero, *own));
        }
    }
}

/// The largest principal value of a tensor without trace, by the angle of Lode.
#[inline(always)]
fn largest<L: Lane>(deviator: &Symmetric<L>) -> L {
    let second = L::of(0.5) * deviator.contract(deviator);
    let [xx, yy, zz, yz, xz, xy] = *deviator.components();
    let third = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    let radius = (second / L::of(3.0)).sqrt();
    let cosine = (L::of(0.5) * third / radius.powi(3)).max(-L::one());
    let angle = cosine.min(L::one()).acos() / L::of(3.0);
    let own = L::of(2.0) * radius * angle.cos();
    L::select(second.gt(L::zero()), own, L::zero())
}

/// Pressure without tension where a particle has failed.
#[derive(Clone, Copy, Debug)]
struct NoTension;

impl<const D: usize> PointLaw<D> for NoTension {
    const NAME: &'static str = "tension of what has failed";
    const READS: Fields = Fields::of(&[DAMAGE, Field::PRESSURE]);
    const WRITES: Fields = Fields::of(&[Field::PRESSURE]);
    const RUNG: Option<Rung> = Some(Rung::Failure);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (pressure, failed) = (at.get(Field::PRESSURE), at.get(DAMAGE).ge(L::one()));
        at.set(
            Field::PRESSURE,
            L::select(failed, pressure.positive_part(), pressure),
        );
    }
}
