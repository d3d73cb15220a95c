//! Elastic solids: a deviatoric stress that follows the strain rate and turns with the body, and the force it makes.
//! The Jaumann rate as Libersky et al. 1993 and Benz & Asphaug 1995 have it, without a limit of strength.

use super::gradients::GRADIENT_SUMS;
use super::{
    Around, CONSTANTS, Effect, Evolved, LedgerColumn, Point, PointLaw, PointLimit, PointRate,
    Reach, Rung, Setting, StepProgram, Update, When,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, VelocityGradient, stage};

/// A hypoelastic solid: a deviatoric stress S is added to the pressure of its equation of state.
///
#[doc = include_str!("../../docs/equations/hypoelastic.html")]
///
/// with the [shear modulus](crate::material::Material::with_shear_modulus) G of each body, and D and W the symmetric
/// and antisymmetric parts of the corrected velocity gradient at the middle of each drift. So waves of shear and
/// of pressure run by one leapfrog. s is the first moment by which the pressure force is normalised too.
///
/// | it adds | as |
/// |---|---|
/// | [`STRESS`](Self::STRESS) | S \[Pa\], positive in tension, turned exactly with a rigid rotation |
/// | [`DISTORTION`](Self::DISTORTION) | the energy of distortion S:S/(4Gρ) \[J/kg\], in the ledger as `distortion` |
/// | sound speed | √(c² + 4G/3ρ), that of longitudinal waves |
/// | limit of the step | 0.1/‖∇v‖: no particle is strained or turned by more than a tenth |
///
/// Internal energy takes the work of S with that of the pressure. Across a contact that may open only what presses
/// acts. It needs an integrator that drifts. [`Plasticity`](super::Plasticity) limits S by the strength of the material.
///
/// ```
/// use meshfree::effect::Hypoelastic;
/// use meshfree::prelude::*;
///
/// // A steel plate whose edge is struck; speeds by its bulk and shear modulus.
/// let steel = catalogue::steel().with_shear_modulus(77e9);
/// let struck = |[x, _]: [f64; 2], start| meshfree::scheme::Start {
///     velocity: [if x < 0.002 { 5.0 } else { 0.0 }, 0.0],
///     ..start
/// };
/// let mut plate = Scene::<f64, 2>::new(schemes::impact_by_continuity().with(Hypoelastic))
///     .body(Body::block("plate", steel, [0.0; 2], [0.02, 0.01], 5e-4).start(struck))
///     .build()?;
/// plate.run_until(1e-6)?;
/// let distortion = plate.ledger().whole.total("distortion").unwrap_or(0.0);
/// assert!(distortion > 0.0);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Hypoelastic;

impl Hypoelastic {
    /// Deviatoric stress S \[Pa\], positive in tension: xx, yy, zz, yz, xz, xy.
    pub const STRESS: Field = Field::tensor(name!("deviatoric_stress", "Pa"));
    /// Specific energy of distortion S:S/(4Gρ) \[J/kg\].
    pub const DISTORTION: Field = Field::scalar(name!("distortion", "J/kg"));
}

const STRESS: Field = Hypoelastic::STRESS;
const DISTORTION: Field = Hypoelastic::DISTORTION;
/// ‖∇v‖ \[1/s\] in the last drift.
const DEFORMATION: Field = Field::scalar(name!("deformation_rate", "1/s"));
const GRADIENT: Outputs = Outputs::of(&GRADIENT_SUMS);

impl<const D: usize> Effect<D> for Hypoelastic {
    type Terms = (
        In<stage::Rates, Self>,
        In<stage::Continuity, VelocityGradient>,
    );
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self), In::new(VelocityGradient))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(STRESS, 0.0);
        program.declare(DISTORTION, 0.0);
        program.store(DISTORTION);
        program.declare(DEFORMATION, 0.0);
        let stress = Evolved::kicked(STRESS)
            .at(When::Drift)
            .updated(Update::Rotated);
        program.evolve(stress.by(*self));
        program.law(Stage::State, ElasticState);
        program.law(Stage::Continuity, DeformationRate);
        program.limit(*self);
        program.ledger(LedgerColumn {
            name: "distortion",
            unit: "J",
            field: DISTORTION,
            times_mass: true,
            factor: 1.0,
        });
        program.document(TermDoc {
            name: "hypoelastic stress".into(),
            equation: "dS/dt = 2 G (D − tr D/3) + W S − S W",
            source: "Benz & Asphaug 1995",
        });
        program.require(|scene| {
            let stiff = |modulus: Option<f64>| modulus.is_some_and(|modulus| modulus > 0.0);
            let soft = scene
                .bodies
                .iter()
                .find(|(_, material)| !stiff(material.shear_modulus));
            soft.map(|(body, material)| Problem::Parameter {
                what: format!("shear modulus of body `{body}`, of {}", material.name),
                value: material.shear_modulus.unwrap_or(0.0),
                must_be: "an elastic solid needs a positive one (Material::with_shear_modulus)",
            })
        });
    }
}

/// 2 G (D − tr D/3).
impl<const D: usize> PointRate<D> for Hypoelastic {
    const SUMS: Outputs = GRADIENT;
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        constants[0] = 2.0 * around.material.shear_modulus.unwrap_or(0.0);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, _present: L, rate: &mut [L]) {
        let strain = at.velocity_gradient().symmetric_part().deviator();
        for (rate, own) in rate.iter_mut().zip(strain.components()) {
            *rate += at.constant(0) * *own;
        }
    }
}

impl<const D: usize> Term<D> for Hypoelastic {
    const NAME: &'static str = "meshfree::hypoelastic";
    const READS: Fields = Fields::of(&[
        STRESS,
        Field::MASS,
        Field::DENSITY,
        Field::CONSISTENCY_FACTOR,
    ]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        sums.add_tractions(pair, pair.volumes(), STRESS);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "force of the deviatoric stress".into(),
            equation: "mᵢ dvᵢ/dt = Σⱼ Vᵢ Vⱼ (Sᵢ/sᵢ + Sⱼ/sⱼ)·∇Wᵢⱼ",
            source: "Libersky et al. 1993, with the weights of Bonet & Lok 1999",
        }
    }
}

/// The speed of longitudinal waves for that of sound, and the energy of distortion.
#[derive(Clone, Copy, Debug)]
struct ElasticState;

impl<const D: usize> PointLaw<D> for ElasticState {
    const NAME: &'static str = "elastic waves and energy of distortion";
    const READS: Fields = Fields::of(&[STRESS, Field::DENSITY, Field::SOUND_SPEED]);
    const WRITES: Fields = Fields::of(&[Field::SOUND_SPEED, DISTORTION]);
    const RUNG: Option<Rung> = Some(Rung::Trial);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        constants[0] = around.material.shear_modulus.unwrap_or(0.0);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (modulus, density) = (at.constant(0), at.get(Field::DENSITY));
        let (c, stress) = (at.get(Field::SOUND_SPEED), at.tensor(STRESS));
        let speed = (c * c + L::of(4.0 / 3.0) * modulus / density).sqrt();
        at.set(Field::SOUND_SPEED, speed);
        let distortion = stress.contract(&stress) / (L::of(4.0) * modulus * density);
        at.set(DISTORTION, distortion);
    }
}

/// ‖∇v‖ of the drift, for the limit of the step.
#[derive(Clone, Copy, Debug)]
struct DeformationRate;

impl<const D: usize> PointLaw<D> for DeformationRate {
    const NAME: &'static str = "rate of deformation";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[DEFORMATION]);
    const SUMS: Outputs = GRADIENT;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        at.set(DEFORMATION, at.velocity_gradient().square().sqrt());
    }
}

impl<const D: usize> PointLimit<D> for Hypoelastic {
    const NAME: &'static str = "deformation: 0.1/|grad v|";
    const READS: Fields = Fields::of(&[DEFORMATION]);
    #[inline(always)]
    fn step<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>) -> L {
        L::of(0.1) / at.get(DEFORMATION)
    }
}

#[cfg(test)]
mod tests {
    use crate::effect::Hypoelastic;
    use crate::material::eos::Linear;
    use crate::prelude::*;
    use crate::scheme::Start;
    use crate::term::viscosity::Inviscid;
    use std::f64::consts::TAU;

    const RHO: f64 = 1000.0;
    const C: f64 = 100.0;

    fn soft(modulus: f64) -> Material<f64> {
        Material::new("soft", Linear::new(RHO, C)).with_shear_modulus(modulus)
    }

    fn scheme<const D: usize>() -> Scheme<f64, D>
    where
        CubicSpline: Kernel<D>,
    {
        SchemeBuilder::new(CubicSpline, Inviscid)
            .density(DensityForm::Continuity)
            .energy(EnergyForm::Compatible)
            .with(Hypoelastic)
            .compose()
    }

    /// Energy that has left a standing wave for a while is in compression and distortion, K (∇·u)²/2 and G e:e.
    #[test]
    fn the_work_of_a_wave_is_elastic_energy() {
        let modulus = 5e6;
        let start = |[x]: [f64; 1], own: Start<1>| Start {
            velocity: [0.1 * (TAU * x).sin()],
            ..own
        };
        let mut rod = Scene::<f64, 1>::new(scheme())
            .body(Body::block("rod", soft(modulus), [0.0], [1.0], 0.01).start(start))
            .boundary(Periodic::along(0, 0.0, 1.0))
            .build()
            .unwrap();
        let before = rod.ledger().whole.total_energy();
        let speed = (C * C + 4.0 / 3.0 * modulus / RHO).sqrt();
        // A quarter of a period: nearly all is elastic.
        rod.run_until(0.25 / speed).unwrap();
        let whole = rod.ledger().whole;
        assert!((whole.total_energy() / before - 1.0).abs() < 1e-13);
        let distortion = whole.total("distortion").unwrap();
        let compression: f64 = rod
            .all()
            .map(|p| p.mass() / p.density() * p.pressure().powi(2) / (2.0 * RHO * C * C))
            .sum();
        let stored = (distortion + compression) / whole.internal;
        assert!((stored - 1.0).abs() < 0.005, "{stored}");
        assert!(whole.internal > 0.99 * before);
        // In uniaxial strain the two are as 4G/3 to K.
        let ratio = distortion / compression / (4.0 / 3.0 * modulus / (RHO * C * C));
        assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
        let p = rod.all().next().unwrap();
        let sound = p.scalar(Field::SOUND_SPEED).unwrap();
        assert!((sound / speed - 1.0).abs() < 1e-3, "{sound}");
    }

    #[test]
    fn each_body_has_its_own_modulus() {
        let stretch = |[x]: [f64; 1], own: Start<1>| Start {
            velocity: [x],
            ..own
        };
        let body = |name, low: f64, modulus| {
            Body::block(name, soft(modulus), [low], [low + 1.0], 0.02).start(stretch)
        };
        let mut two = Scene::<f64, 1>::new(scheme())
            .body(body("soft", 0.0, 1e6))
            .body(body("stiff", 3.0, 4e6))
            .build()
            .unwrap();
        let dt = two.step().unwrap();
        for (body, modulus) in [(0, 1e6), (1, 4e6)] {
            let middle = two.body(body).unwrap().nth(25).unwrap();
            let stress = middle.tensor(Hypoelastic::STRESS).unwrap();
            let [xx, yy, zz, ..] = *stress.components();
            let exact = 4.0 / 3.0 * modulus * dt;
            assert!((xx / exact - 1.0).abs() < 1e-3, "{xx} {exact}");
            assert!((yy + 0.5 * xx).abs() < 1e-12 * xx && yy == zz);
        }
    }

    #[test]
    fn fast_shear_limits_the_step_and_what_cannot_be_is_refused() {
        // Layers pass each other at up to 40 times the sound speed.
        let shear = |[_, y]: [f64; 2], own: Start<2>| Start {
            velocity: [4e4 * y, 0.0],
            ..own
        };
        let block = |modulus| Body::block("block", soft(modulus), [0.0; 2], [0.2; 2], 0.02);
        let mut sheared = Scene::<f64, 2>::new(scheme())
            .body(block(1e6).start(shear))
            .build()
            .unwrap();
        sheared.step_at_most(1e-7).unwrap();
        let vote = sheared.vote().unwrap();
        assert_eq!(vote.criterion.name(), "deformation: 0.1/|grad v|");
        assert!((vote.step * 4e5 - 1.0).abs() < 1e-3, "{}", vote.step);

        let liquid = Scene::<f64, 2>::new(scheme()).body(block(0.0));
        let problem = liquid.problems()[0].to_string();
        assert!(
            problem.contains("shear modulus of body `block`"),
            "{problem}"
        );
        let symmetric = SchemeBuilder::new(CubicSpline, Inviscid)
            .density(DensityForm::NumberDensity)
            .energy(EnergyForm::Symmetric)
            .with(Hypoelastic);
        let combined = Scene::<f64, 2>::new(symmetric)
            .body(block(1e6))
            .integrator(RungeKutta4);
        let problem = combined.problems()[0].to_string();
        assert!(problem.contains("kick-drift-kick"), "{problem}");
    }

    /// Two blocks that part do not hold each other; that meet, do.
    #[test]
    fn a_contact_presses_and_does_not_pull() {
        let apart = |speed: f64| {
            let block = |name, low: f64, v: f64| {
                Body::block(name, soft(5e6), [low, 0.0], [low + 0.2, 0.1], 0.01).velocity([v, 0.0])
            };
            let mut blocks = Scene::<f64, 2>::new(scheme())
                .body(block("left", 0.0, speed))
                .body(block("right", 0.2, -speed))
                .build()
                .unwrap();
            blocks.run_until(1e-3).unwrap();
            let momentum = blocks.ledger().bodies[0].1.momentum[0];
            momentum / (0.02 * RHO * speed)
        };
        let (met, parted) = (apart(1.0), apart(-1.0));
        assert!((parted - 1.0).abs() < 1e-3, "{parted}");
        assert!(met < 0.5, "{met}");
    }
}
