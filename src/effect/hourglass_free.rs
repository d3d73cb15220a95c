//! Hourglass control of updated-Lagrangian solids: a stiffness against what a gradient does not see.
//! After Zhang, Wu, Lourenço & Hu 2025, in a form whose forces are central and opposite for every pair.

use super::gradients::GRADIENT_SUMS;
use super::hourglass_control::STIFFNESS;
use super::{
    Around, CONSTANTS, Damage, Effect, Hypoelastic, Plasticity, Point, PointLaw, Reach, Rung,
    Setting, StepProgram, not_negative,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::tensor::Square;
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// Stiffness against hourglass modes, for [`Hypoelastic`] solids. Particles may move in zigzag without any change of
/// the velocity gradient, so without stress, and what then looks like a tensile instability grows from it. Each particle
/// integrates its mismatch q \[m\] with the motion that its gradient predicts for its neighbours, and pairs resist
/// differences of it.
///
#[doc = include_str!("../../docs/equations/hourglass_free.html")]
///
/// with the shear modulus G \[Pa\], ∇W = F r, and W the spin at the middle of the drift. In a motion that is linear in
/// space q stays zero, and with it the force.
///
/// Zhang et al. (2025, arXiv 2409.11474) add to each particle the time integral of the pair accelerations
/// ζ G/ρ (vᵢⱼ − ½ (∇vᵢ + ∇vⱼ) rᵢⱼ) ∂W/∂r V/r. Three things differ here. What is integrated is a displacement
/// of the particle and not its acceleration, and the force is made anew of it and the present places: it lies along rᵢⱼ,
/// so angular momentum is conserved with the linear one, and its work is that of a pair. q turns with the body. Plastic
/// flow takes from q the share that the return takes from the deviatoric stress, Y/σ, where the paper scales
/// what it adds by that factor; so what is left of it where a solid flows is bounded as stress is.
///
/// Differences between bodies that may part do not count. Particles that [`Damage`] has failed have none. q adds to the
/// stiffness of the shortest waves alone, which have none of shear without it, so the step stays that of bulk waves.
///
/// | it adds | as |
/// |---|---|
/// | [`MISMATCH`](Self::MISMATCH) | q \[m\] |
///
/// ```
/// use meshfree::effect::{HourglassFree, Hypoelastic};
/// use meshfree::prelude::*;
///
/// // A strip whose particles start in a zigzag of velocities comes back to where it was.
/// let law = meshfree::material::eos::Linear::from_elastic_constants(1000.0, 2e6, 0.3975);
/// let rubber = Material::new("rubber", law).with_shear_modulus(2e6 / 2.795);
/// let zigzag = |[x, _]: [f64; 2], start| {
///     let sign = if (x / 5e-3).floor() % 2.0 == 0.0 { 0.1 } else { -0.1 };
///     meshfree::scheme::Start { velocity: [0.0, sign], ..start }
/// };
/// let scheme = schemes::impact_by_continuity().with(Hypoelastic).with(HourglassFree::default());
/// let mut strip = Scene::<f64, 2>::new(scheme)
///     .body(Body::block("strip", rubber, [0.0; 2], [0.2, 0.05], 5e-3).start(zigzag))
///     .build()?;
/// strip.run_until(1e-4)?;
/// let most = strip.all().filter_map(|p| p.vector(HourglassFree::MISMATCH)).map(|q| q[1].abs()).fold(0.0, f64::max);
/// assert!(most > 1e-6);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct HourglassFree {
    /// Stiffness ξ in units of the shear modulus; 1, with which colliding rings rebound whole at any spacing tried. More
    /// holds the lattice straighter and puts more energy into forces that no stress shows.
    pub stiffness: f64,
}

impl Default for HourglassFree {
    fn default() -> Self {
        Self { stiffness: 1.0 }
    }
}

impl HourglassFree {
    /// Mismatch q \[m\] of a particle with the motion that velocity gradients predict.
    pub const MISMATCH: Field = Field::vector(name!("hourglass_mismatch", "m"));
}

const STRESS: Field = Hypoelastic::STRESS;
const MISMATCH: Field = HourglassFree::MISMATCH;
/// The plastic strain at the last drift.
const FLOWED: Field = Field::scalar(name!("plastic_strain_of_mismatch", "1"));
/// Σⱼ wᵢⱼ vᵢⱼ \[m/s\].
const DIFFERENCE: Output = Output::vector(name!("velocity_mismatch", "m/s"));
/// Σⱼ wᵢⱼ rᵢⱼ \[m\].
const CENTRE: Output = Output::vector(name!("neighbours_centre", "m"));

/// The sums of the mismatch.
#[derive(Clone, Copy, Debug)]
pub struct VelocityMismatch;

impl<const D: usize> Effect<D> for HourglassFree {
    type Terms = (
        In<stage::Rates, Self>,
        In<stage::Continuity, VelocityMismatch>,
    );
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self), In::new(VelocityMismatch))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(MISMATCH, 0.0);
        program.declare(FLOWED, 0.0);
        // −ξ G: negative, so that a contact which may open shows nothing of it.
        program.declare(STIFFNESS, 0.0);
        program.law(Stage::State, Stiffness(self.stiffness));
        program.law(Stage::Continuity, *self);
        program.require(|scene| {
            (!scene.integrated.contains(STRESS)).then(|| Problem::Incompatible {
                what: "HourglassFree needs the velocity gradients of an elastic solid, which is not in the scheme"
                    .into(),
                remedy: "add the elastic solid as well: .with(Hypoelastic)",
            })
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[("stiffness", self.stiffness)])
    }
}

/// Writes −ξ G.
#[derive(Clone, Copy, Debug)]
struct Stiffness(f64);

impl<const D: usize> PointLaw<D> for Stiffness {
    const NAME: &'static str = "stiffness against hourglass modes";
    const READS: Fields = Fields::of(&[Damage::DAMAGE]);
    const WRITES: Fields = Fields::of(&[STIFFNESS]);
    const OPTIONAL: Fields = Fields::of(&[Damage::DAMAGE]);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        constants[0] = -self.0 * around.material.shear_modulus.unwrap_or(0.0);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (whole, failed) = (at.constant(0), at.get(Damage::DAMAGE).ge(L::one()));
        at.set(STIFFNESS, L::select(failed, whole * L::of(FAILED), whole));
    }
}

/// Keeps quotients of stiffnesses that a contact hides finite \[Pa\].
const LEAST: f64 = 1e-30;
/// What is left of the stiffness of a failed particle: next to nothing, and no zero to divide by.
const FAILED: f64 = 1e-9;

impl<const D: usize> PointLaw<D> for HourglassFree {
    const NAME: &'static str = "mismatch of motion and gradient";
    const READS: Fields =
        Fields::of(&[MISMATCH, FLOWED, STRESS, Plasticity::STRAIN, Damage::DAMAGE]);
    const WRITES: Fields = Fields::of(&[MISMATCH, FLOWED]);
    const SUMS: Outputs = Outputs::of(&[DIFFERENCE, CENTRE]).union(Outputs::of(&GRADIENT_SUMS));
    const OPTIONAL: Fields = Fields::of(&[Plasticity::STRAIN, Damage::DAMAGE]);
    const RUNG: Option<Rung> = Some(Rung::Flow);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        constants[0] = 3.0 * around.material.shear_modulus.unwrap_or(0.0);
        around.in_drift
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (zero, one, dt) = (L::zero(), L::one(), at.dt());
        let (gradient, before) = (at.velocity_gradient(), at.vector(MISMATCH));
        let (difference, centre) = (at.sum_vector(DIFFERENCE), at.sum_vector(CENTRE));
        let linear = gradient.dot(&centre);
        let mut left = one;
        if at.has(Plasticity::STRAIN) {
            let strain = at.get(Plasticity::STRAIN);
            let more = strain - at.get(FLOWED);
            at.set(FLOWED, strain);
            let yields = at.tensor(STRESS).von_mises();
            let share = yields / (yields + at.constant(0) * more);
            left = L::select(more.gt(zero), share, one);
        }
        left = L::select(at.get(Damage::DAMAGE).ge(one), zero, left);
        let spin = gradient.plus(-one, &gradient.transposed());
        let mut after = [zero; D];
        for d in 0..D {
            after[d] = before[d] + (difference[d] - linear[d]) * dt;
        }
        let turned = Square::rotation(&spin.scaled(dt * L::of(0.5))).dot(&after);
        for d in 0..D {
            at.set_at(MISMATCH, d, turned[d] * left);
        }
    }
}

impl<const D: usize> Term<D> for VelocityMismatch {
    const NAME: &'static str = "meshfree::velocity_mismatch";
    const READS: Fields = Fields::of(&[Field::VELOCITY, Field::MASS, Field::DENSITY, STIFFNESS]);
    const WRITES: Outputs = Outputs::of(&[DIFFERENCE, CENTRE]);
    const TENSILE: Fields = Fields::of(&[STIFFNESS]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volume = pair.j(Field::MASS) / pair.j(Field::DENSITY);
        // One within a body, and zero across a contact, where neither side shows its own.
        let share = pair.j(STIFFNESS) / (pair.i(STIFFNESS) + pair.j(STIFFNESS) - L::of(LEAST));
        let weight = volume * pair.f * pair.r2 * share * L::of(-2.0 / D as f64);
        for d in 0..D {
            sums.add_product_at(DIFFERENCE, d, weight, pair.v[d]);
            sums.add_product_at(CENTRE, d, weight, pair.r[d]);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "mismatch of velocities and their gradient".into(),
            equation: "dqᵢ/dt = Σⱼ wᵢⱼ (vᵢⱼ − ∇vᵢ·rᵢⱼ), wᵢⱼ = −Vⱼ rᵢⱼ·∇W/D",
            source: "after Zhang, Wu, Lourenço & Hu 2025",
        }
    }
}

impl<const D: usize> Term<D> for HourglassFree {
    const NAME: &'static str = "meshfree::hourglass_free";
    const READS: Fields = Fields::of(&[
        MISMATCH,
        STIFFNESS,
        Field::MASS,
        Field::DENSITY,
        Field::CONSISTENCY_FACTOR,
    ]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    const TENSILE: Fields = Fields::of(&[STIFFNESS]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let (a, b) = (pair.i(STIFFNESS), pair.j(STIFFNESS));
        let volumes = pair.volumes();
        let moments = pair.i(Field::CONSISTENCY_FACTOR) + pair.j(Field::CONSISTENCY_FACTOR);
        let mut along = (pair.i_at(MISMATCH, 0) - pair.j_at(MISMATCH, 0)) * pair.r[0];
        for d in 1..D {
            along = (pair.i_at(MISMATCH, d) - pair.j_at(MISMATCH, d)).mul_add(pair.r[d], along);
        }
        // The harmonic mean of the two, −ξ G for equal ones, and nothing across a contact.
        let stiffness = a * b * L::of(-4.0 * (D as f64 + 2.0));
        // One division for all. Distances are in smoothing lengths, and powers of lengths meet before they meet stiffness: each by
        // itself leaves the range of `f32` where particles are a micrometre or a kilometre apart.
        let over_h2 = (pair.h * pair.h).recip();
        let distance2 = pair.r2.mul_add(over_h2, L::of(1e-12));
        let below = (a + b - L::of(LEAST)) * moments * distance2;
        let radial = volumes * pair.f * over_h2 * stiffness / below;
        sums.radial.add_product(radial, along);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("stiffness against hourglass modes, ξ = {}", self.stiffness),
            equation: "mᵢ dvᵢ/dt = Σⱼ (D + 2) ξ G Vᵢ Vⱼ F (qᵢⱼ·rᵢⱼ)/r² rᵢⱼ/s̄",
            source: "after Zhang, Wu, Lourenço & Hu 2025",
        }
    }
}
