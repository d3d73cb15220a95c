//! Artificial stress: a repulsion along directions of tension, so that particles of a stretched solid do not clump.
//! The remedy of the tensile instability by Monaghan 2000 and Gray, Monaghan & Swift 2001.

use super::{Effect, Hypoelastic, Point, PointLaw, Reach, Setting, StepProgram, not_negative};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::tensor::Symmetric;
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// The artificial stress of Gray, Monaghan & Swift (2001, section 4) for [`Hypoelastic`] solids.
///
#[doc = include_str!("../../docs/equations/artificial_stress.html")]
///
/// over the principal stresses σₐ \[Pa\] of σ = S − p and their directions eₐ. In tension SPH particles attract each other the more
/// the nearer they are, and a stretched solid breaks up into clumps; R takes the attraction away within about a
/// spacing Δx, and f⁴ leaves little of it at two. The paper has σ/ρ² and masses, here are the volumes V and
/// first moments s of the other forces of the scheme; for equal particles the two agree.
///
/// A stretched lattice carries less than its stress by what R takes at its nearest neighbours: some ε times the tension,
/// so waves in a solid under tension σ are slowed by about ε σ/2E. Across a contact that may open nothing acts.
///
/// | it adds | as |
/// |---|---|
/// | [`TENSION`](Self::TENSION) | −R \[Pa\], of the stresses of the last evaluation |
///
/// ```
/// use meshfree::effect::{ArtificialStress, Hypoelastic};
/// use meshfree::prelude::*;
///
/// // A rubber strip that is pulled apart.
/// let law = meshfree::material::eos::Linear::from_elastic_constants(1000.0, 2e6, 0.3975);
/// let rubber = Material::new("rubber", law).with_shear_modulus(2e6 / 2.795);
/// let pulled = |[x, _]: [f64; 2], start| meshfree::scheme::Start { velocity: [50.0 * x, 0.0], ..start };
/// let scheme = schemes::impact_by_continuity().with(Hypoelastic).with(ArtificialStress::default());
/// let mut strip = Scene::<f64, 2>::new(scheme)
///     .body(Body::block("strip", rubber, [-0.1, 0.0], [0.1, 0.04], 5e-3).start(pulled))
///     .build()?;
/// strip.run_until(2e-4)?;
/// let middle = strip.all().find(|p| p.position()[0].abs() < 5e-3);
/// let tension = middle.and_then(|p| p.tensor(ArtificialStress::TENSION));
/// assert!(tension.is_some_and(|tension| tension.at(0, 0) > 1e3));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ArtificialStress {
    /// Share ε of the tension that is taken away; 0.3, which Gray et al. find by the dispersion relation of waves in a
    /// stretched solid.
    pub share: f64,
    /// Exponent n of the kernel ratio; 4 as in the paper. Larger ones act nearer alone.
    pub exponent: u32,
}

impl Default for ArtificialStress {
    fn default() -> Self {
        Self {
            share: 0.3,
            exponent: 4,
        }
    }
}

impl ArtificialStress {
    /// ε times the tensile part of the stress \[Pa\], which is −R: xx, yy, zz, yz, xz, xy.
    pub const TENSION: Field = Field::tensor(name!("artificial_tension", "Pa"));
}

const TENSION: Field = ArtificialStress::TENSION;
const STRESS: Field = Hypoelastic::STRESS;

/// The force of the artificial stress.
#[derive(Clone, Copy, Debug)]
pub struct Repulsion {
    /// Power n of the kernel's ratio.
    pub exponent: u32,
    /// One over hᴰ W of the spacing.
    pub over_kernel_at_spacing: f64,
}

impl<const D: usize> Effect<D> for ArtificialStress {
    type Terms = (In<stage::Rates, Repulsion>,);
    fn terms(&self, setting: &Setting) -> Self::Terms {
        (In::new(Repulsion {
            exponent: self.exponent,
            over_kernel_at_spacing: 1.0 / setting.kernel_at_spacing,
        }),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(TENSION, 0.0);
        // Pressures are final once the laws of the state have run.
        program.law(Stage::Flow, *self);
        program.require(|scene| {
            (!scene.integrated.contains(STRESS)).then(|| Problem::Incompatible {
                what: "ArtificialStress needs a deviatoric stress, which nothing in the scheme integrates"
                    .into(),
                remedy: "add the elastic solid as well: .with(Hypoelastic)",
            })
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[("share", self.share)])
    }
}

impl<const D: usize> PointLaw<D> for ArtificialStress {
    const NAME: &'static str = "artificial stress";
    const READS: Fields = Fields::of(&[STRESS, Field::PRESSURE]);
    const WRITES: Fields = Fields::of(&[TENSION]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let pressure = Symmetric::diagonal([at.get(Field::PRESSURE); 3]);
        let stress = at.tensor(STRESS).plus(-L::one(), &pressure);
        at.set_tensor(TENSION, &tensile_part(&stress).scaled(L::of(self.share)));
    }
}

/// What pulls of a stress: Σ max(λ, 0) e ⊗ e.
fn tensile_part<L: Lane>(stress: &Symmetric<L>) -> Symmetric<L> {
    stress.plus(-L::one(), &stress.compressive_part())
}

impl<const D: usize> Term<D> for Repulsion {
    const NAME: &'static str = "meshfree::repulsion";
    const READS: Fields = Fields::of(&[
        TENSION,
        Field::MASS,
        Field::DENSITY,
        Field::CONSISTENCY_FACTOR,
    ]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let ratio = pair.w * (pair.h.powi(D as u32) * L::of(self.over_kernel_at_spacing));
        let near = -(pair.volumes() * ratio.powi(self.exponent));
        sums.add_tractions(pair, near, TENSION);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("artificial stress, n = {}", self.exponent),
            equation: "mᵢ dvᵢ/dt = Σⱼ Vᵢ Vⱼ (Rᵢ/sᵢ + Rⱼ/sⱼ)·∇W (W/W(Δx))ⁿ, R = −ε Σ max(σₐ, 0) eₐ ⊗ eₐ",
            source: "Gray, Monaghan & Swift 2001",
        }
    }
}
