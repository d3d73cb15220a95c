//! Plastic flow of solids: the deviatoric stress returns to the yield surface of the material's law of strength.
//! The radial return of Wilkins 1964, implicit in the plastic strain for any hardening and rate.

use super::radial_return::{before, returned, yields_first};
use super::{
    Around, CONSTANTS, Damage, Effect, Hypoelastic, LedgerColumn, PlaneStress, Point, PointLaw,
    Reach, Rung, SceneFacts, Setting, StepProgram, UniaxialStress, plane_stress,
};
use crate::error::Problem;
use crate::material::Material;
use crate::name;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::term::{Stage, TermDoc};

/// Plasticity with the condition of von Mises, added to [`Hypoelastic`]: the deviatoric stress S returns to the yield surface after
/// each elastic change.
///
#[doc = include_str!("../../docs/equations/plasticity.html")]
///
/// wherever σ is above the [yield stress](crate::material::Material::strength) Y. The increment Δ of the equivalent
/// plastic strain solves the equation to rounding, with hardening and rate at the end of the step, so no step limit
/// is needed beyond that of the elastic solid; temperature T₀ + χ w/c
/// ([`PlasticHeating`](crate::material::strength::PlasticHeating)), pressure and density are those before it. Flow
/// keeps volume. A particle that [has failed](super::Damage) by the end of a step flows no more in the steps after it.
///
/// | it adds | as |
/// |---|---|
/// | [`STRAIN`](Self::STRAIN) | the equivalent plastic strain ε = ∫ √(2/3 Dᵖ:Dᵖ) dt |
/// | [`WORK`](Self::WORK) | the plastic work w \[J/kg\], in the ledger as `plastic work` |
///
/// In [`UniaxialStress`] Young's modulus stands for 3G. In [`PlaneStress`] the strain across the sheet is solved with Δ.
///
/// Internal energy has the work of S whether it is stored or dissipated, so total energy is kept as before. Particles
/// that flowed are counted in [`limits`](crate::simulation::Simulation::limits). Every body needs a law of strength,
/// and thermal data where its law asks for temperature.
///
/// ```
/// use meshfree::effect::{Hypoelastic, Plasticity};
/// use meshfree::prelude::*;
///
/// // A copper rod on a wall, in uniaxial strain, with the strength of Johnson & Cook.
/// let scheme = schemes::impact_by_continuity().with(Hypoelastic).with(Plasticity);
/// let rod = Body::block("rod", catalogue::ofhc_copper(), [0.0], [0.01], 1e-4).velocity([-50.0]);
/// let mut rod = Scene::<f64, 1>::new(scheme)
///     .body(rod)
///     .boundary(MirrorPlane::wall([0.0], [-1.0]))
///     .build()?;
/// rod.run_until(1e-6)?;
/// let work = rod.ledger().whole.total("plastic work").unwrap_or(0.0);
/// assert!(work > 0.0);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Plasticity;

impl Plasticity {
    /// Equivalent plastic strain ε.
    pub const STRAIN: Field = Field::scalar(name!("plastic_strain", "1"));
    /// Specific plastic work w \[J/kg\].
    pub const WORK: Field = Field::scalar(name!("plastic_work", "J/kg"));
}

const STRESS: Field = Hypoelastic::STRESS;
const STRAIN: Field = Plasticity::STRAIN;
const WORK: Field = Plasticity::WORK;
/// Carried by bars that are free to widen.
const LATERAL_STRAIN: Field = UniaxialStress::LATERAL_STRAIN;
/// Carried by sheets that are free to thin.
const THICKNESS_STRAIN: Field = PlaneStress::THICKNESS_STRAIN;
/// Carried where solids fail.
const FAILED: Field = Damage::FAILED;
/// The strains of bars and sheets that are free to widen or thin.
const FREE: Fields = Fields::of(&[LATERAL_STRAIN, THICKNESS_STRAIN]);

impl<const D: usize> Effect<D> for Plasticity {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(STRAIN, 0.0);
        program.declare(WORK, 0.0);
        program.dissipate(WORK);
        program.law(Stage::Continuity, *self);
        program.ledger(LedgerColumn {
            name: "plastic work",
            unit: "J",
            field: WORK,
            times_mass: true,
            factor: 1.0,
        });
        program.document(TermDoc {
            name: "plasticity by radial return".into(),
            equation: "S ← S Y/σ where σ = √(3/2 S:S) > Y, σ − 3GΔ = Y(ε + Δ, Δ/dt, T, p, ρ)",
            source: "Wilkins 1964",
        });
        program.require(|scene| {
            (!scene.integrated.contains(STRESS)).then(|| Problem::Incompatible {
                what: "Plasticity limits the deviatoric stress, which nothing in the scheme integrates"
                    .into(),
                remedy: "add the elastic solid as well: .with(Hypoelastic)",
            })
        });
        program.require(lacks_strength);
        program.require(lacks_temperature);
        program.require(super::tension_limit::yields_beyond_tension);
    }
}

/// A body without a law of strength.
pub(super) fn lacks_strength<T: Real>(scene: &SceneFacts<'_, T>) -> Option<Problem> {
    let mut bodies = scene.bodies.iter();
    let weak = bodies.find(|(_, material)| material.strength().is_none());
    weak.map(|(body, material)| Problem::Incompatible {
        what: format!(
            "body `{body}`, of {}, has no strength, which plasticity needs",
            material.name
        ),
        remedy: "give the material a law (Material::with_strength) or a constant yield stress \
                 (Material::with_yield_stress)",
    })
}

/// A body whose strength follows from a temperature that it does not have.
pub(super) fn lacks_temperature<T: Real>(scene: &SceneFacts<'_, T>) -> Option<Problem> {
    cold(scene, "strength", |material| {
        let law = material.strength()?;
        law.uses_temperature().then(|| law.name())
    })
}

/// A body that has no temperature, of which `asks` names a law that follows from it.
pub(super) fn cold<T: Real>(
    scene: &SceneFacts<'_, T>,
    what: &str,
    asks: impl Fn(&Material<T>) -> Option<&'static str>,
) -> Option<Problem> {
    let mut bodies = scene.bodies.iter();
    let cold = bodies.find_map(|(body, material)| {
        let law = asks(material).filter(|_| material.plastic_heating().is_none())?;
        Some((body, &material.name, law))
    });
    cold.map(|(body, material, law)| Problem::Incompatible {
        what: format!(
            "the {what} of body `{body}`, of {material}, follows from temperature ({law}), which it does not have"
        ),
        remedy: "give the material its specific heat (Material::with_plastic_heating)",
    })
}

impl<const D: usize> PointLaw<D> for Plasticity {
    const NAME: &'static str = "plastic flow";
    const READS: Fields = Fields::of(&[STRESS, STRAIN, WORK, Field::PRESSURE, Field::DENSITY])
        .union(FREE)
        .union(Fields::of(&[FAILED]));
    const WRITES: Fields = Fields::of(&[STRESS, STRAIN, WORK]).union(FREE);
    const OPTIONAL: Fields = FREE.union(Fields::of(&[FAILED]));
    const BEFORE: Fields = Fields::of(&[FAILED]);
    const RUNG: Option<Rung> = Some(Rung::Flow);
    const DOUBLE: bool = true;
    fn prepare<T: Real>(&self, around: &Around<'_, T, D>, _all: &mut [f64; CONSTANTS]) -> bool {
        // Stress changes in drifts alone.
        around.in_drift && flows(around)
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let material = at.around.material;
        let (Some(law), Some(modulus)) = (material.strength(), material.shear_modulus) else {
            return;
        };
        let stiffness = if at.has(LATERAL_STRAIN) {
            material.youngs_modulus().unwrap_or(0.0)
        } else {
            3.0 * modulus
        };
        let (before, dt) = (before(at), at.dt());
        let first = yields_first(law, &before, dt);
        let returned = |trial: L| returned(law, &before, dt, [first, trial, L::of(stiffness)]);
        let own = at.tensor(STRESS);
        let mut trial = own.von_mises();
        let mut back = returned(trial);
        // Failed material supports no shear stress: it does not flow, harden or heat.
        let flows = back.flows & at.get(FAILED).lt(L::one());
        at.limited(flows);
        if !L::somewhere(back.flows) {
            return;
        }
        let mut stress = own;
        if at.has(THICKNESS_STRAIN) {
            let left = |trial: L| {
                let own = returned(trial);
                L::select(own.flows, own.yields / trial, L::one())
            };
            let bulk = material.bulk_modulus();
            let more = plane_stress::strain_across(&own, [bulk, modulus], flows, left);
            stress = plane_stress::with_strain_across(&own, modulus, more);
            at.add_at(THICKNESS_STRAIN, 0, L::select(flows, more, L::zero()));
            trial = stress.von_mises();
            back = returned(trial);
            back.yields = L::select(back.flows, back.yields, trial);
        }
        if at.has(LATERAL_STRAIN) {
            // Flow keeps volume, and takes back the widening of the elastic strain that it replaces.
            let poisson = material.poisson_ratio().unwrap_or(0.0);
            let widening = L::of(0.5 - poisson) * back.increment;
            let widening = L::select(own.at(0, 0).lt(L::zero()), widening, -widening);
            at.add_at(LATERAL_STRAIN, 0, L::select(flows, widening, L::zero()));
        }
        let share = back.yields / trial;
        for (k, component) in stress.components().iter().enumerate() {
            let kept = own.components()[k];
            at.set_at(STRESS, k, L::select(flows, *component * share, kept));
        }
        let (strain, work) = (before.strain + back.increment, at.get(WORK));
        let more = back.yields * back.increment / at.get(Field::DENSITY);
        at.set(STRAIN, L::select(flows, strain, before.strain));
        at.set(WORK, L::select(flows, work + more, work));
    }
}

/// Whether a body has what plastic flow needs.
pub(super) fn flows<T: Real, const D: usize>(around: &Around<'_, T, D>) -> bool {
    around.material.strength().is_some() && around.material.shear_modulus.is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::eos::Linear;
    use crate::material::strength::{JohnsonCook, LinearHardening, PlasticHeating, Strength};
    use crate::prelude::*;
    use crate::scheme::Start;
    use crate::tensor::Symmetric;

    const RHO: f64 = 1000.0;
    const C: f64 = 100.0;
    const SHEAR: f64 = 5e6;
    const YIELD: f64 = 2e3;

    fn bar<T: Real>(law: impl Strength) -> Material<T> {
        Material::new("metal", Linear::new(RHO, C))
            .with_shear_modulus(SHEAR)
            .with_strength(law)
    }

    /// A stretch of a bar in one step beyond yield, in uniaxial strain: the stress is the yield stress, and the strain
    /// what the elastic one lacks.
    fn stretched<T: Real>(tolerance: f64) {
        let stretch = |[x]: [f64; 1], own: Start<1>| Start {
            velocity: [100.0 * x],
            ..own
        };
        let law = LinearHardening::new(YIELD, 1e6);
        let body = Body::block("bar", bar(law), [0.0], [1.0], 0.02).start(stretch);
        let scheme = schemes::impact_by_continuity()
            .with(Hypoelastic)
            .with(Plasticity);
        let mut scene = Scene::<T, 1>::new(scheme).body(body).build().unwrap();
        let dt = scene.step_at_most(1e-5).unwrap();
        let middle = scene.body(0).unwrap().nth(25).unwrap();
        let stress = middle.tensor(Hypoelastic::STRESS).unwrap();
        let flowed = middle.scalar(STRAIN).unwrap().to_f64();
        let trial = 2.0 * SHEAR * 100.0 * dt;
        let exact = (trial - YIELD) / (3.0 * SHEAR + 1e6);
        assert!((flowed / exact - 1.0).abs() < 1e-3, "{flowed} {exact}");
        let stress = Symmetric::new(stress.components().map(|s| s.to_f64()));
        let equivalent = (1.5 * stress.contract(&stress)).sqrt();
        let yields = 1e6f64.mul_add(flowed, YIELD);
        assert!(
            (equivalent / yields - 1.0).abs() < tolerance,
            "{equivalent}"
        );
        assert!(
            scene
                .limits()
                .iter()
                .any(|(name, _)| *name == "plastic flow")
        );
    }

    #[test]
    fn a_stretched_bar_bears_its_yield_stress() {
        stretched::<f64>(1e-12);
        stretched::<f32>(1e-6);
    }

    #[test]
    fn what_it_needs_is_asked_for_by_name() {
        let body = |material| Body::block("plate", material, [0.0; 2], [0.2; 2], 0.02);
        let problem = |material: Material<f64>| {
            let scheme = schemes::impact_by_continuity()
                .with(Plasticity)
                .with(Hypoelastic);
            let scene = Scene::<f64, 2>::new(scheme).body(body(material));
            scene.problems().iter().map(ToString::to_string).collect()
        };
        let elastic = Material::new("gum", Linear::new(RHO, C)).with_shear_modulus(SHEAR);
        let problems: Vec<String> = problem(elastic.clone());
        assert!(
            problems.len() == 1 && problems[0].contains("body `plate`, of gum, has no strength")
        );
        let law = JohnsonCook::new(1e6, 1e6, 0.5).with_softening(1.0, 600.0);
        let problems: Vec<String> = problem(elastic.clone().with_strength(law));
        assert!(problems.len() == 1 && problems[0].contains("follows from temperature"));
        let warm = elastic.with_strength(law);
        let warm = warm.with_plastic_heating(PlasticHeating::new(400.0));
        let problems: Vec<String> = problem(warm.clone());
        assert!(problems.is_empty(), "{problems:?}");
        let alone = Scene::<f64, 2>::new(schemes::impact_by_continuity().with(Plasticity));
        let problems = alone.body(body(warm)).problems();
        assert!(problems[0].to_string().contains(".with(Hypoelastic)"));
        let wrong = Material::<f64>::new("gum", Linear::new(RHO, C))
            .with_shear_modulus(SHEAR)
            .with_strength(LinearHardening::new(f64::NAN, 0.0));
        let problems: Vec<String> = problem(wrong);
        assert!(problems[0].contains("yield_stress"), "{problems:?}");
    }
}
