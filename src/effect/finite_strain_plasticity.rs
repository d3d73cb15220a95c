//! Elastic–plastic solids under finite strain: a total-Lagrangian stress with the yield condition of von Mises.
//! The multiplicative plasticity of Simo 1992 (Simo & Hughes 1998, box 9.1), with pressure by the equation of state.

use super::radial_return::{before, returned, yields_first};
use super::total_lagrangian::{require_solid, stretches_of};
use super::{
    Around, CONSTANTS, Effect, Hypoelastic, LedgerColumn, Plasticity, Point, PointLaw, Reach, Rung,
    Setting, StepProgram, TotalLagrangian,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real, iterate};
use crate::tensor::{Square, Symmetric};
use crate::term::{Stage, TermDoc};

/// The stress of a [total-Lagrangian](TotalLagrangian) solid that yields. Of the deformation gradient F a part is plastic and
/// keeps volume; b̄ is elastic and free of volume.
///
#[doc = include_str!("../../docs/equations/finite_strain_plasticity.html")]
///
/// with J = det F, the [shear modulus](crate::material::Material::with_shear_modulus) G, the yield stress Y of the material's
/// [law of strength](crate::material::Material::with_strength), and p by its equation of state from density and internal
/// energy. Where a step leaves the yield surface, s returns to it along itself, with hardening and rate at the end of the
/// step, to rounding. Any [strength](crate::material::strength) goes, as with [`Plasticity`]; a body that never yields is a
/// neo-Hookean one with this pressure.
///
/// | it adds | as |
/// |---|---|
/// | [`TotalLagrangian::PIOLA`] | P \[Pa\] |
/// | [`INVERSE_PLASTIC`](Self::INVERSE_PLASTIC) | Cₚ⁻¹ − 1 |
/// | [`Plasticity::STRAIN`], [`Plasticity::WORK`] | plastic strain, and its work, in the ledger as `plastic work` |
/// | elastic energy | of distortion, ½ G (tr b̄ − 3)/ρ₀ \[J/kg\], in the ledger as `distortion` |
///
/// It needs an integrator that drifts: the state of flow changes once a step.
///
/// ```
/// use meshfree::effect::FiniteStrainPlasticity;
/// use meshfree::prelude::*;
///
/// // A copper bar strikes a plane of symmetry, which is a bar of its own kind that comes the other way.
/// let scheme = schemes::total_lagrangian_impact().with(FiniteStrainPlasticity);
/// let bar = Body::block("bar", catalogue::ofhc_copper(), [0.0; 2], [0.01, 0.004], 5e-4).velocity([-100.0, 0.0]);
/// let mut bar = Scene::<f64, 2>::new(scheme)
///     .body(bar)
///     .boundary(MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]))
///     .build()?;
/// bar.run_until(2e-6)?;
/// assert!(bar.ledger().whole.total("plastic work").unwrap_or(0.0) > 0.0);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct FiniteStrainPlasticity;

impl FiniteStrainPlasticity {
    /// Cₚ⁻¹ − 1, with Cₚ = FₚᵀFₚ of the plastic part of the deformation.
    pub const INVERSE_PLASTIC: Field = Field::tensor(name!("inverse_plastic_deformation", "1"));
}

const CP: Field = FiniteStrainPlasticity::INVERSE_PLASTIC;
const F: Field = TotalLagrangian::DEFORMATION;
const PIOLA: Field = TotalLagrangian::PIOLA;
const STRAIN: Field = Plasticity::STRAIN;
const WORK: Field = Plasticity::WORK;
const DISTORTION: Field = Hypoelastic::DISTORTION;

impl<const D: usize> Effect<D> for FiniteStrainPlasticity {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(PIOLA, 0.0);
        program.declare(CP, 0.0);
        program.declare(STRAIN, 0.0);
        program.declare(WORK, 0.0);
        program.declare(DISTORTION, 0.0);
        program.store(DISTORTION);
        program.dissipate(WORK);
        program.law(Stage::State, *self);
        for (name, field) in [("plastic work", WORK), ("distortion", DISTORTION)] {
            program.ledger(LedgerColumn {
                name,
                unit: "J",
                field,
                times_mass: true,
                factor: 1.0,
            });
        }
        program.document(TermDoc {
            name: "plasticity under finite strain".into(),
            equation: "s = G dev b̄, √(3/2 s:s)/J ≤ Y, P = (s − J p) F⁻ᵀ",
            source: "Simo & Hughes 1998, box 9.1",
        });
        require_solid(program);
        program.require(|scene| super::plasticity::lacks_strength(scene));
        program.require(|scene| super::plasticity::lacks_temperature(scene));
        program.require(super::tension_limit::yields_beyond_tension);
        program.require(|scene| {
            (!scene.kicks).then(|| Problem::Incompatible {
                what: format!(
                    "plastic flow is counted once a step, and the integrator {} evaluates more often",
                    scene.integrator
                ),
                remedy: "take an integrator that kicks (kick-drift-kick)",
            })
        });
    }
}

impl<const D: usize> PointLaw<D> for FiniteStrainPlasticity {
    const NAME: &'static str = "plastic flow";
    const READS: Fields = Fields::of(&[
        F,
        CP,
        STRAIN,
        WORK,
        Field::PRESSURE,
        Field::SOUND_SPEED,
        Field::DENSITY,
        Field::REFERENCE_DENSITY,
    ]);
    const WRITES: Fields = Fields::of(&[PIOLA, CP, STRAIN, WORK, DISTORTION, Field::SOUND_SPEED]);
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
        let (gradient, p, dt) = (at.matrix(F), at.get(Field::PRESSURE), at.dt());
        let (rest, shear) = (at.get(Field::REFERENCE_DENSITY), L::of(shear));
        let (volume, three) = (gradient.determinant(), L::of(3.0));
        let plastic = at.tensor(CP);
        let mut elastic = Elastic::of(&gradient, volume, &plastic);
        let trial = elastic.stress(shear);
        let von_mises = (L::of(1.5) * trial.square()).sqrt() / volume;
        let before = before(at);
        // √(3/2 s:s) falls by 3 G tr b̄/3 for each unit of plastic strain.
        let stiffness = shear * elastic.deformation.trace() / volume;
        let first = yields_first(law, &before, dt);
        let back = returned(law, &before, dt, [first, von_mises, stiffness]);
        let mut stress = trial;
        at.limited(back.flows);
        if L::somewhere(back.flows) {
            let pick = |yes: L, no: L| L::select(back.flows, yes, no);
            stress = stress.scaled(pick(back.yields / von_mises, L::one()));
            elastic.return_to(&stress, shear, back.flows);
            let left = elastic.pull_back();
            for (k, own) in left.components().iter().enumerate() {
                at.set_at(CP, k, pick(*own, plastic.components()[k]));
            }
            let (strain, work) = (before.strain + back.increment, at.get(WORK));
            let more = back.yields * back.increment * volume / rest;
            at.set(STRAIN, pick(strain, before.strain));
            at.set(WORK, pick(work + more, work));
        }
        // Of Kirchhoff's stress the part in the space of the body, pulled back on one side.
        let mut kirchhoff = Square::<L, D>::zero();
        for a in 0..D {
            for b in 0..D {
                kirchhoff.0[a][b] = stress.0[a][b];
            }
            kirchhoff.0[a][a] -= volume * p;
        }
        let back = gradient.inverse(0.0).0;
        at.set_matrix(PIOLA, &kirchhoff.times(&back.transposed()));
        let strained = elastic.deformation.trace() - three;
        at.set(DISTORTION, L::of(0.5) * shear * strained / rest);
        // Along X: the speed of longitudinal waves over the smallest stretch.
        let c = at.get(Field::SOUND_SPEED);
        let squared = c * c + L::of(4.0 / 3.0) * shear / (rest / volume);
        let [_, over] = stretches_of(&gradient, &back);
        at.set(Field::SOUND_SPEED, (squared * over).sqrt());
    }
}

/// The elastic, volume-free deformation b̄ of a particle, in space.
struct Elastic<L> {
    /// J^(−1/3) F, one out of the plane.
    gradient: Square<L, 3>,
    deformation: Square<L, 3>,
}

impl<L: Lane> Elastic<L> {
    /// Of F and Cₚ⁻¹ − 1.
    #[inline(always)]
    fn of<const D: usize>(gradient: &Square<L, D>, volume: L, plastic: &Symmetric<L>) -> Self {
        let mut whole = Square::identity();
        for a in 0..D {
            for b in 0..D {
                whole.0[a][b] = gradient.0[a][b];
            }
        }
        let gradient = whole.scaled(volume.powf(-1.0 / 3.0));
        let mut inverse = Square::identity();
        for a in 0..3 {
            for b in 0..3 {
                inverse.0[a][b] += plastic.at(a, b);
            }
        }
        Self {
            gradient,
            deformation: gradient.times(&inverse).times(&gradient.transposed()),
        }
    }
    /// G dev b̄ \[Pa\].
    #[inline(always)]
    fn stress(&self, shear: L) -> Square<L, 3> {
        let mean = self.deformation.trace() / L::of(3.0);
        self.deformation
            .plus(-mean, &Square::identity())
            .scaled(shear)
    }
    /// That of which the stress is this one, with a determinant of one, where it is asked for: kept at that of the trial, as box
    /// 9.1 has it, the trace would gather all plastic work as elastic energy.
    #[inline(always)]
    fn return_to(&mut self, stress: &Square<L, 3>, shear: L, asked: L::Mask) {
        let mut deviator = *stress;
        for row in &mut deviator.0 {
            for own in row {
                *own /= shear;
            }
        }
        // det(a + m 1) = m³ − ½ (a:a) m + det a, which rises beyond its root.
        let (half, third) = (L::of(0.5) * deviator.square(), deviator.determinant());
        let first = (self.deformation.trace() / L::of(3.0)).max(L::one());
        let [mean] = iterate!(L, MOST_MEANS, [first], |[mean]| {
            let excess = (mean * mean - half) * mean + third - L::one();
            let change = excess / (L::of(3.0) * mean * mean - half);
            let next = mean - change;
            ([next], !asked | change.abs().le(L::of(f64::EPSILON) * next))
        });
        let own = deviator.plus(mean, &Square::identity());
        for a in 0..3 {
            for b in 0..3 {
                let before = self.deformation.0[a][b];
                self.deformation.0[a][b] = L::select(asked, own.0[a][b], before);
            }
        }
    }
    /// Cₚ⁻¹ − 1.
    #[inline(always)]
    fn pull_back(&self) -> Symmetric<L> {
        let back = self.gradient.inverse(0.0).0;
        let inverse = back.times(&self.deformation).times(&back.transposed());
        inverse
            .plus(-L::one(), &Square::identity())
            .symmetric_part()
    }
}

/// More than Newton's method takes for the mean of b̄, which is three to five.
const MOST_MEANS: usize = 20;
