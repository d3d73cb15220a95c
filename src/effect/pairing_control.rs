//! Pairing control: particles nearer to each other than the spacing are moved apart, at free surfaces too.
//! Shifting that acts between near pairs alone, after Xu, Stansby & Laurence 2009 and Lind et al. 2012.

use super::shifting::{PLACE, length};
use super::{
    DensityForm, Effect, Point, PointLaw, Reach, Rung, Setting, StepProgram, not_negative,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// Moves particles apart that are nearer to each other than the spacing.
///
#[doc = include_str!("../../docs/equations/pairing_control.html")]
///
/// with the sound speed c \[m/s\]. [`Shifting`](super::Shifting) follows the gradient of the concentration, which at a free
/// surface points out of the liquid, so it is silent there, and pairs that form in a jet of two or three particles
/// stay. f − 1 is zero from the spacing Δx on: an even lattice is not moved, at a surface neither, and between equal
/// particles the displacements are opposite, so that the centre of mass stays. That it acts by c makes it the same for every
/// observer. Densities do not follow; angular momentum changes by δx × v of what is moved.
///
/// Of the kind of Lind, Xu, Stansby & Rogers (2012, eq. 24), whose repulsion R fⁿ is that of all pairs; that only
/// near pairs count is of this crate. It keeps pairs apart and does not close voids: with it alone, a liquid in
/// tension opens into a net of threads. Use it with [`ArtificialPressure`](super::ArtificialPressure), where there is an example.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct PairingControl {
    /// Strength a; 0.005, the least that keeps pairs apart in a spinning patch: more swells a liquid that is stretched
    /// ([defaults](crate#pages)).
    pub strength: f64,
}

impl Default for PairingControl {
    fn default() -> Self {
        Self { strength: 0.005 }
    }
}

/// Σⱼ Vⱼ max(f − 1, 0) ∇W \[1/m\].
const NEAR: Output = Output::vector(name!("near_pairs", "1/m"));
/// Longest displacement in units of the smoothing length, as of shifting.
const LONGEST: f64 = 0.1;

/// The sum over near pairs.
#[derive(Clone, Copy, Debug)]
pub struct NearPairs {
    /// One over hᴰ W of the spacing.
    pub over_kernel_at_spacing: f64,
}

impl<const D: usize> Effect<D> for PairingControl {
    type Terms = (In<stage::Continuity, NearPairs>,);
    fn terms(&self, setting: &Setting) -> Self::Terms {
        (In::new(NearPairs {
            over_kernel_at_spacing: 1.0 / setting.kernel_at_spacing,
        }),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let by_volume = program.setting().density == DensityForm::Continuity;
        program.law(Stage::Continuity, *self);
        program.require(move |_| {
            (!by_volume).then(|| Problem::Incompatible {
                what: "PairingControl moves particles in the middle of a drift by sums over volumes, which this scheme \
                       does not make there"
                    .into(),
                remedy: "take DensityForm::Continuity, or leave out PairingControl",
            })
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[("strength of the pairing control", self.strength)])
    }
}

impl<const D: usize> PointLaw<D> for PairingControl {
    const NAME: &'static str = "pairing control";
    const READS: Fields = Fields::of(&[Field::SOUND_SPEED]);
    const WRITES: Fields = PLACE;
    const ADDS: Fields = PLACE;
    const SUMS: Outputs = Outputs::of(&[NEAR]);
    const OPTIONAL: Fields = Fields::of(&[Field::POSITION_RESIDUAL]);
    const RUNG: Option<Rung> = Some(Rung::Constraint);
    const DOUBLE: bool = true;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (near, h) = (at.sum_vector(NEAR), at.around.smoothing_length);
        let length = length(&near);
        let factor = L::of(self.strength * h) * at.get(Field::SOUND_SPEED) * at.dt();
        let factor = factor.min(L::of(LONGEST * h) / length);
        let factor = L::select(length.gt(L::zero()), factor, L::zero());
        for d in 0..D {
            at.displace(d, -factor * near[d]);
        }
    }
}

impl<const D: usize> Term<D> for NearPairs {
    const NAME: &'static str = "meshfree::near_pairs";
    const READS: Fields = Fields::of(&[Field::WEIGHT]);
    const WRITES: Outputs = Outputs::of(&[NEAR]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let ratio = pair.w * (pair.h.powi(D as u32) * L::of(self.over_kernel_at_spacing));
        let near = pair.j(Field::WEIGHT) * pair.f * (ratio - L::one()).positive_part();
        for d in 0..D {
            sums.add_product_at(NEAR, d, near, pair.r[d]);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "near pairs".into(),
            equation: "Σⱼ Vⱼ max(W/W(Δx) − 1, 0) ∇W",
            source: "after Lind et al. 2012, eq. 24",
        }
    }
}
