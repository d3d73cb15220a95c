//! Densities held to the space that particles really take, in closed flows.
//! The re-initialisation of Colagrossi & Landrini 2003, relaxed over time.

use super::{Effect, Point, PointRate, Reach, Setting, StepProgram, not_negative};
use crate::error::Problem;
use crate::material::Material;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Sums, Term, TermDoc, stage};

/// Holds densities to the space that particles really take, in flow that walls or periods enclose.
///
#[doc = include_str!("../../docs/equations/volume_consistency.html")]
///
/// with U₀ = Σ V W on the lattice. Continuity integrates velocities, and knows nothing of where disorder and [`Shifting`](super::Shifting) have
/// moved particles: volumes m/ρ and the space between particles part. This is the re-initialisation of density
/// by kernel sums (Colagrossi & Landrini 2003) done a little in every step; walls fill space too.
///
/// What is summed are masses, which stay. Sums of the volumes m/ρ at hand would do the same in a full neighbourhood; but where liquid
/// has cavitated or ends, particles are thin, and by their larger volumes press those behind them: water in an open-cell structure
/// that does not move drove a twentieth of itself out of the open end in a quarter of a millisecond, and by masses stays
/// ([crushed cells](crate#pages)).
///
/// So the liquids of a scheme must have one density at rest. U₀ belongs to one smoothing length, so the law does not go with lengths
/// that vary or differ. At a free surface neighbourhoods are not full, and the liquid within the kernel's reach of it loses its
/// pressure: the law is for closed flows, and for jets that have none. A strength of 0.05 is usual.
///
/// ```
/// use meshfree::effect::{Shifting, VolumeConsistency};
/// use meshfree::prelude::*;
/// let closed: Scheme<f64, 2> = schemes::weakly_compressible()
///     .with(Shifting::CLOSED)
///     .with(VolumeConsistency { strength: 0.05 })
///     .compose();
/// assert!(closed.to_string().contains("volume consistency"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct VolumeConsistency {
    /// Strength κ.
    pub strength: f64,
}

/// Density \[kg/m³\] by the masses around.
const SUMMED: Output = Output::scalar(name!("summed_density", "kg/m³"));

/// Σⱼ mⱼ Wᵢⱼ, the sum of [`VolumeConsistency`].
#[derive(Clone, Copy, Debug)]
pub struct SummedMass;

impl<const D: usize> Term<D> for SummedMass {
    const NAME: &'static str = "meshfree::summed_mass";
    const READS: Fields = Fields::of(&[Field::POSITION_RESIDUAL, Field::MASS]);
    const WRITES: Outputs = Outputs::of(&[SUMMED]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        sums.add(SUMMED, pair.j(Field::MASS) * pair.w);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "density by the masses around".into(),
            equation: "ρ̃ᵢ = Σⱼ mⱼ Wᵢⱼ",
            source: "Gingold & Monaghan 1977",
        }
    }
}

impl<const D: usize> Effect<D> for VolumeConsistency {
    type Terms = (In<stage::Continuity, SummedMass>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(SummedMass),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let unity = program.setting().lattice_unity;
        program.contribute(
            Field::DENSITY,
            Relaxation {
                strength: self.strength,
                unity,
            },
        );
        program.require(|scene| {
            scene.lengths_vary.then(|| Problem::Incompatible {
                what: "volume consistency holds kernel sums to those of a lattice at one smoothing length, \
                       and the smoothing lengths of this scheme vary or differ"
                    .into(),
                remedy: "leave out either VolumeConsistency or MixedSpacing and laws of smoothing",
            })
        });
        let acts = self.strength != 0.0;
        program.require(move |scene| {
            let ((first, liquid), others) = scene.bodies.split_first()?;
            let rest = liquid.reference_density();
            let unlike = |own: &&(&str, &Material<T>)| own.1.reference_density() != rest;
            let (other, _) = others.iter().find(unlike).filter(|_| acts)?;
            Some(Problem::Incompatible {
                what: format!(
                    "volume consistency holds densities to the masses around, and the bodies `{first}` and `{other}` of its \
                     scheme differ in their density at rest"
                ),
                remedy: "leave out VolumeConsistency, or give the liquids one density at rest",
            })
        });
        program.document(TermDoc {
            name: format!("volume consistency, κ = {}", self.strength),
            equation: "dρᵢ/dt += κ (c/h) (ρ̃ᵢ/u₀ − ρᵢ)",
            source: "after Colagrossi & Landrini 2003",
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[("strength of the volume consistency", self.strength)])
    }
}

/// The growth κ (c/h) (ρ̃/(u₀ ρ) − 1).
#[derive(Clone, Copy, Debug)]
struct Relaxation {
    strength: f64,
    unity: f64,
}

impl<const D: usize> PointRate<D> for Relaxation {
    const READS: Fields = Fields::of(&[Field::SOUND_SPEED]);
    const SUMS: Outputs = Outputs::of(&[SUMMED]);
    const GROWTH: bool = true;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, present: L, rate: &mut [L]) {
        let factor = L::of(self.strength / at.around.smoothing_length);
        let excess = at.sum(SUMMED) / (L::of(self.unity) * present) - L::one();
        rate[0] += factor * at.get(Field::SOUND_SPEED) * excess;
    }
}
