//! Total-Lagrangian solids: deformation and forces by the neighbours and kernels of the body as built.
//! Bonet & Kulasegaram 2001; Vignjevic, Reveles & Campbell 2006.

use super::{Effect, Point, PointLaw, Reach, Setting, StepProgram};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::tensor::{Matrix, Square};
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// The kinematics and the force of a total-Lagrangian solid, in reference positions X.
///
#[doc = include_str!("../../docs/equations/total_lagrangian.html")]
///
/// with the displacement u = x − X, the first Piola–Kirchhoff stress P of an effect beside it, and the inverse L of the
/// kernel's first moment matrix, taken once. Neighbours are never searched again. The kernel sees no motion, so the body
/// has no tensile instability, a rigid rotation leaves no stress, and F is exact for a linear map on any arrangement
/// of particles. Linear momentum is kept to rounding; angular momentum too, because P Fᵀ is symmetric (Bonet & Lok 1999).
///
/// | stress | effect |
/// |---|---|
/// | moderate strains, large rotations | [`StVenantKirchhoff`](super::StVenantKirchhoff) |
/// | rubber | [`NeoHookean`](super::NeoHookean) |
/// | metals and polymers that yield; pressure by the equation of state | [`FiniteStrainPlasticity`](super::FiniteStrainPlasticity) |
/// | liquids, until they have flowed too far | [`LagrangianLiquid`](super::LagrangianLiquid) |
///
/// [`HourglassControl`](super::HourglassControl) suppresses the modes that F does not see. A scheme of these is
/// [`schemes::total_lagrangian`](crate::schemes::total_lagrangian).
///
/// | it adds | as |
/// |---|---|
/// | [`DEFORMATION`](Self::DEFORMATION) | the deformation gradient F |
/// | [`Field::REFERENCE_POSITION`] | X \[m\] |
/// | limit of the step | none: sound speeds that stresses write are those along X, dX/dt |
///
/// It holds as long as neighbours stay neighbours. Particles whose det F is below 0.1 or above 10, or one of whose
/// stretches is below 0.2 or above 2.5, are counted in [`limits`](crate::simulation::Simulation::limits) as
/// `beyond the validity of total Lagrangian`; where det F is not positive the run stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct TotalLagrangian;

impl TotalLagrangian {
    /// Deformation gradient F = ∂x/∂X, row by row.
    pub const DEFORMATION: Field = Field::matrix(name!("deformation_gradient", "1"));
    /// First Piola–Kirchhoff stress P \[Pa\], row by row, positive in tension: a law at [`Stage::State`] writes it.
    pub const PIOLA: Field = Field::matrix(name!("piola_stress", "Pa"));
}

const F: Field = TotalLagrangian::DEFORMATION;
const PIOLA: Field = TotalLagrangian::PIOLA;
/// P L \[Pa\].
const CORRECTED: Field = Field::matrix(name!("corrected_piola_stress", "Pa"));
/// Σⱼ V₀ⱼ (uⱼ − uᵢ) ⊗ ∇₀W.
const DISPLACEMENT_SUM: Output = Output::matrix(name!("displacement_gradient", "1"));

impl<const D: usize> Effect<D> for TotalLagrangian {
    type Terms = (
        In<stage::Reference, ReferenceMoment>,
        In<stage::Density, DisplacementGradient>,
        In<stage::Rates, StressForce>,
    );
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (
            In::new(ReferenceMoment),
            In::new(DisplacementGradient),
            In::new(StressForce),
        )
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(F, 0.0);
        program.declare(CORRECTED, 0.0);
        program.carry(Field::REFERENCE_POSITION);
        program.carry(Field::REFERENCE_DENSITY);
        program.carry(Field::CORRECTION);
        program.law(Stage::Reference, ReferenceCorrection);
        program.law(Stage::Density, DeformationGradient);
        program.law(Stage::Flow, CorrectedStress);
        program.require(|scene| {
            (!scene.written.contains(PIOLA)).then(|| Problem::Incompatible {
                what: "nothing in the total-Lagrangian scheme gives a stress".into(),
                remedy: "add an effect that does: NeoHookean, StVenantKirchhoff, FiniteStrainPlasticity, or LagrangianLiquid",
            })
        });
    }
}

/// The Poisson ratio from which a solid is taken for incompressible.
const LOCKED: f64 = 0.495;

/// Asks for what a solid with a stress of its own needs: a shear modulus, and volumes that give.
pub(super) fn require_solid<T: Real, const D: usize>(program: &mut StepProgram<T, D>) {
    program.require(|scene| {
        let soft = scene
            .bodies
            .iter()
            .find(|(_, material)| material.shear_modulus.is_none_or(|modulus| modulus <= 0.0));
        soft.map(|(body, material)| Problem::Parameter {
            what: format!("shear modulus of body `{body}`, of {}", material.name),
            value: material.shear_modulus.unwrap_or(0.0),
            must_be: "a total-Lagrangian solid needs a positive one (Material::with_shear_modulus)",
        })
    });
    program.require(|scene| {
        let mut ratios = scene
            .bodies
            .iter()
            .filter_map(|(body, material)| Some((body, material.poisson_ratio()?)));
        let locked = ratios.find(|(_, ratio)| !(-1.0..LOCKED).contains(ratio));
        locked.map(|(body, ratio)| Problem::Parameter {
            what: format!("Poisson ratio of body `{body}`, by its bulk and shear moduli"),
            value: ratio,
            must_be: "it must be above -1 and below 0.495: at 0.5 volumes lock, and no step is short enough",
        })
    });
}

/// −Σⱼ V₀ⱼ Xᵢⱼ ⊗ ∇₀W, whose inverse is L.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceMoment;

impl<const D: usize> Term<D> for ReferenceMoment {
    const NAME: &'static str = "meshfree::reference_moment";
    const READS: Fields = Fields::of(&[Field::REFERENCE_POSITION, Field::WEIGHT]);
    const WRITES: Outputs = Outputs::of(&[Output::MOMENT_MATRIX]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let apart = pair.reference();
        let factor = -pair.j(Field::WEIGHT) * pair.f;
        for a in 0..D {
            for b in 0..D {
                let moment = factor * apart[a] * apart[b];
                sums.add_at(Output::MOMENT_MATRIX, a * D + b, moment);
            }
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "correction of gradients as built".into(),
            equation: "L = [−Σⱼ V₀ⱼ Xᵢⱼ ⊗ ∇₀W]⁻¹",
            source: "Randles & Libersky 1996",
        }
    }
}

/// Σⱼ V₀ⱼ (uⱼ − uᵢ) ⊗ ∇₀W.
#[derive(Clone, Copy, Debug)]
pub struct DisplacementGradient;

impl<const D: usize> Term<D> for DisplacementGradient {
    const NAME: &'static str = "meshfree::displacement_gradient";
    const READS: Fields = Fields::of(&[
        Field::POSITION_RESIDUAL,
        Field::REFERENCE_POSITION,
        Field::WEIGHT,
    ]);
    const WRITES: Outputs = Outputs::of(&[DISPLACEMENT_SUM]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let apart = pair.reference();
        let factor = -pair.j(Field::WEIGHT) * pair.f;
        for a in 0..D {
            // Of displacements, which are exactly zero at rest.
            let displaced = factor * (pair.r[a] - apart[a]);
            for b in 0..D {
                sums.add_product_at(DISPLACEMENT_SUM, a * D + b, displaced, apart[b]);
            }
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "deformation gradient".into(),
            equation: "Fᵢ = 1 + Σⱼ V₀ⱼ (uⱼ − uᵢ) ⊗ Lᵢ∇₀W",
            source: "Bonet & Kulasegaram 2001",
        }
    }
}

/// Σⱼ V₀ᵢ V₀ⱼ (Pᵢ Lᵢ + Pⱼ Lⱼ) ∇₀W.
#[derive(Clone, Copy, Debug)]
pub struct StressForce;

impl<const D: usize> Term<D> for StressForce {
    const NAME: &'static str = "meshfree::stress_force";
    const READS: Fields = Fields::of(&[
        Field::POSITION_RESIDUAL,
        Field::REFERENCE_POSITION,
        Field::WEIGHT,
        CORRECTED,
    ]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let apart = pair.reference();
        let factor = pair.i(Field::WEIGHT) * pair.j(Field::WEIGHT) * pair.f;
        for a in 0..D {
            let mut traction = L::zero();
            for b in 0..D {
                let stress = pair.i_at(CORRECTED, a * D + b) + pair.j_at(CORRECTED, a * D + b);
                traction = stress.mul_add(apart[b], traction);
            }
            sums.force.add(a, factor * traction);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "force of the Piola stress".into(),
            equation: "mᵢ dvᵢ/dt = Σⱼ V₀ᵢ V₀ⱼ (Pᵢ Lᵢ + Pⱼ Lⱼ) ∇₀Wᵢⱼ",
            source: "Bonet & Lok 1999; Vignjevic, Reveles & Campbell 2006",
        }
    }
}

/// L, once.
#[derive(Clone, Copy, Debug)]
struct ReferenceCorrection;

impl<const D: usize> PointLaw<D> for ReferenceCorrection {
    const NAME: &'static str = "correction of gradients as built";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[Field::CORRECTION]);
    const SUMS: Outputs = Outputs::of(&[Output::MOMENT_MATRIX]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        at.set_matrix(Field::CORRECTION, &at.correction());
    }
}

/// F and ρ, and whether neighbours can still be those of the body as built.
#[derive(Clone, Copy, Debug)]
struct DeformationGradient;

/// det F, and the square of a stretch, beyond which neighbours as built say little of the body.
const VOLUME_RATIOS: [f64; 2] = [0.1, 10.0];
const SQUARED_STRETCHES: [f64; 2] = [0.04, 6.25];

impl<const D: usize> PointLaw<D> for DeformationGradient {
    const NAME: &'static str = "beyond the validity of total Lagrangian";
    const READS: Fields = Fields::of(&[Field::CORRECTION, Field::REFERENCE_DENSITY]);
    const WRITES: Fields = Fields::of(&[F, Field::DENSITY]);
    const SUMS: Outputs = Outputs::of(&[DISPLACEMENT_SUM]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let displaced = at
            .sum_matrix(DISPLACEMENT_SUM)
            .times(&at.matrix(Field::CORRECTION));
        let gradient = Square::identity().plus(L::one(), &displaced);
        let volume = gradient.determinant();
        at.set(Field::DENSITY, at.get(Field::REFERENCE_DENSITY) / volume);
        at.set_matrix(F, &gradient);
        at.limited(is_far(&gradient, volume));
    }
}

/// Whether a deformation is beyond what neighbours as built can tell.
#[inline(always)]
fn is_far<L: Lane, const D: usize>(gradient: &Square<L, D>, volume: L) -> L::Mask {
    // With ‖F − 1‖ below 0.4 the stretches are between 0.6 and 1.4, and det F between 0.2 and 2.8: bounds of the stretches,
    // at most √D as large, are within the limits by far, and need no inverse.
    let change = gradient.plus(-L::one(), &Square::identity());
    let apart = !change.square().lt(L::of(0.16));
    if !L::somewhere(apart) {
        return apart;
    }
    let ([low, high], [least, most]) = (VOLUME_RATIOS, SQUARED_STRETCHES);
    let [right, back] = stretches_of(gradient, &gradient.inverse(0.0).0);
    let within = L::of(low).lt(volume) & volume.lt(L::of(high));
    let within = within & !right.gt(L::of(most)) & !(back * L::of(least)).gt(L::one());
    apart & !within
}

/// Bounds of the largest squared stretch, and of the inverse of the smallest, by Gershgorin's circles of FᵀF and its
/// inverse; exact where the axes are principal.
pub(crate) fn stretches<T: Real, const D: usize>(gradient: &Matrix<T, D>) -> [T; 2] {
    let own = Square::<T, D>(core::array::from_fn(|a| {
        core::array::from_fn(|b| gradient[(a, b)])
    }));
    stretches_of(&own, &own.inverse(0.0).0)
}

/// The same of rows of particles.
#[inline(always)]
pub(super) fn stretches_of<L: Lane, const D: usize>(
    gradient: &Square<L, D>,
    back: &Square<L, D>,
) -> [L; 2] {
    let right = gradient.transposed().times(gradient);
    let back = back.times(&back.transposed());
    let (mut stretched, mut shrunk) = (L::zero(), L::zero());
    for row in 0..D {
        let (mut sum, mut other) = (L::zero(), L::zero());
        for column in 0..D {
            sum += right.0[row][column].abs();
            other += back.0[row][column].abs();
        }
        (stretched, shrunk) = (stretched.max(sum), shrunk.max(other));
    }
    [stretched, shrunk]
}

/// P L.
#[derive(Clone, Copy, Debug)]
struct CorrectedStress;

impl<const D: usize> PointLaw<D> for CorrectedStress {
    const NAME: &'static str = "corrected Piola stress";
    const READS: Fields = Fields::of(&[PIOLA, Field::CORRECTION]);
    const WRITES: Fields = Fields::of(&[CORRECTED]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let corrected = at.matrix(PIOLA).times(&at.matrix(Field::CORRECTION));
        at.set_matrix(CORRECTED, &corrected);
    }
}
