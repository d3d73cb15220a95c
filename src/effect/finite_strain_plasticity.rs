//! Elastic–plastic solids under finite strain: a total-Lagrangian stress with the yield condition of von Mises.
//! The multiplicative plasticity of Simo 1992 (Simo & Hughes 1998, box 9.1), with pressure by the equation of state.

use super::hyperelastic::square;
use super::radial_return::{after, radial_return};
use super::total_lagrangian::{matrix, put, stretches_with};
use super::{
    Chunk, Effect, Hypoelastic, Law, LedgerColumn, Plasticity, Rung, Setting, StepProgram, Tally,
    TotalLagrangian,
};
use crate::error::Problem;
use crate::material::strength::{PlasticState, ROOM_TEMPERATURE};
use crate::name;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::tensor::{Matrix, Symmetric, determinant, inverse};
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
/// It needs an integrator that kicks: the state of flow changes once a step.
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

impl<T: Real, const D: usize> Law<T, D> for FiniteStrainPlasticity {
    fn name(&self) -> &'static str {
        "plastic flow"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[
            F,
            CP,
            STRAIN,
            WORK,
            Field::PRESSURE,
            Field::SOUND_SPEED,
            Field::DENSITY,
            Field::REFERENCE_DENSITY,
        ])
    }
    fn writes(&self) -> Fields {
        Fields::of(&[PIOLA, CP, STRAIN, WORK, DISTORTION, Field::SOUND_SPEED])
    }
    fn rung(&self) -> Option<Rung> {
        Some(Rung::Flow)
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let mut tally = Tally::default();
        let (material, dt) = (chunk.around.material, chunk.around.dt);
        let (Some(law), Some(shear)) = (material.strength(), material.shear_modulus) else {
            return tally;
        };
        let heating = material.plastic_heating();
        let (live, reference) = (chunk.live, material.reference_density());
        let ([pressure, density, rest, deformation], [piola, plastic, strain, work, distortion, c]) =
            chunk.columns(
                [Field::PRESSURE, Field::DENSITY, Field::REFERENCE_DENSITY, F],
                [PIOLA, CP, STRAIN, WORK, DISTORTION, Field::SOUND_SPEED],
            );
        for (n, out) in piola.chunks_exact_mut(D * D).enumerate() {
            let gradient = matrix::<T, D>(deformation, n);
            let volume = determinant(&gradient).to_f64();
            let p = pressure[n].to_f64();
            let mut elastic = Elastic::of(&gradient, volume, &plastic[n * 6..]);
            let trial = elastic.stress(shear);
            let von_mises = (1.5 * square(&trial)).sqrt() / volume;
            let (flowed, worked) = (strain[n].to_f64(), work[n].to_f64());
            let before = PlasticState {
                strain: flowed,
                rate: 0.0,
                temperature: heating.map_or(ROOM_TEMPERATURE, |own| own.temperature(worked)),
                pressure: p,
                density_ratio: density[n].to_f64() / reference,
            };
            let mut stress = trial;
            // √(3/2 s:s) falls by 3 G tr b̄/3 for each unit of plastic strain.
            let stiffness = shear * elastic.trace() / volume;
            let back = radial_return(von_mises, stiffness, |more| after(law, &before, more, dt));
            if let Some([increment, yields]) = back {
                stress *= yields / von_mises;
                elastic.return_to(&stress, shear);
                elastic.pull_back(&mut plastic[n * 6..(n + 1) * 6]);
                strain[n] = T::from_f64(flowed + increment);
                work[n] = T::from_f64(worked + yields * increment * volume / rest[n].to_f64());
                tally.limited += u64::from(n < live);
            }
            // Of Kirchhoff's stress the part in the space of the body, pulled back on one side.
            let kirchhoff = Matrix::<T, D>::from_fn(|a, b| {
                let pressure = if a == b { volume * p } else { 0.0 };
                T::from_f64(stress[(a, b)] - pressure)
            });
            let back = inverse(&gradient, 0.0).unwrap_or_else(Matrix::identity);
            put(out, &(kirchhoff * back.transpose()));
            let rest = rest[n].to_f64();
            distortion[n] = T::from_f64(0.5 * shear * (elastic.trace() - 3.0) / rest);
            // Along X: the speed of longitudinal waves over the smallest stretch.
            let squared = c[n].to_f64().powi(2) + 4.0 / 3.0 * shear / (rest / volume);
            let [_, over] = stretches_with(&gradient, &back);
            c[n] = T::from_f64((squared * over.to_f64()).sqrt());
        }
        tally
    }
}

/// The elastic, volume-free deformation b̄ of a particle, in space.
struct Elastic {
    /// J^(−1/3) F, one out of the plane.
    gradient: Matrix<f64, 3>,
    deformation: Matrix<f64, 3>,
}

impl Elastic {
    /// Of F and Cₚ⁻¹ − 1.
    fn of<T: Real, const D: usize>(gradient: &Matrix<T, D>, volume: f64, plastic: &[T]) -> Self {
        let shrunk = Lane::powf(volume, -1.0 / 3.0);
        let gradient = Matrix::<f64, 3>::from_fn(|a, b| {
            let own = if a < D && b < D {
                gradient[(a, b)].to_f64()
            } else {
                f64::from(u8::from(a == b))
            };
            own * shrunk
        });
        let plastic = Symmetric::from_slice(plastic).to_f64();
        let inverse =
            Matrix::<f64, 3>::from_fn(|a, b| f64::from(u8::from(a == b)) + plastic.at(a, b));
        Self {
            gradient,
            deformation: gradient * inverse * gradient.transpose(),
        }
    }
    fn trace(&self) -> f64 {
        self.deformation.trace()
    }
    /// G dev b̄ \[Pa\].
    fn stress(&self, shear: f64) -> Matrix<f64, 3> {
        let mean = Matrix::<f64, 3>::identity() * (self.trace() / 3.0);
        (self.deformation - mean) * shear
    }
    /// That of which the stress is this one, with a determinant of one: kept at that of the trial, as box 9.1 has it, the
    /// trace would gather all plastic work as elastic energy.
    fn return_to(&mut self, stress: &Matrix<f64, 3>, shear: f64) {
        let deviator = stress / shear;
        // det(a + m 1) = m³ − ½ (a:a) m + det a, which rises beyond its root.
        let (half, third) = (0.5 * square(&deviator), determinant(&deviator));
        let mut mean = (self.trace() / 3.0).max(1.0);
        for _ in 0..MOST_MEANS {
            let change = ((mean * mean - half) * mean + third - 1.0) / (3.0 * mean * mean - half);
            mean -= change;
            if change.abs() <= f64::EPSILON * mean {
                break;
            }
        }
        self.deformation = deviator + Matrix::<f64, 3>::identity() * mean;
    }
    /// Cₚ⁻¹ − 1.
    fn pull_back<T: Real>(&self, plastic: &mut [T]) {
        let back = inverse(&self.gradient, 0.0).unwrap_or_else(Matrix::identity);
        let inverse = back * self.deformation * back.transpose() - Matrix::identity();
        let own = Symmetric::symmetric_part(&inverse);
        plastic.copy_from_slice(&own.components().map(T::from_f64));
    }
}

/// More than Newton's method takes for the mean of b̄, which is three to five.
const MOST_MEANS: usize = 20;
