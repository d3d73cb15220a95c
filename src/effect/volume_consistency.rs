//! Densities held to the space that particles really take, in closed flows.
//! The re-initialisation of Colagrossi & Landrini 2003, relaxed over time.

use super::{Effect, Rate, Setting, StepProgram, View, not_negative};
use crate::error::Problem;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
use crate::term::{In, TermDoc, Unity, stage};

/// Holds densities to the space that particles really take, in flow that walls or periods enclose:
/// dρᵢ/dt += κ (c/h) ρᵢ (Σⱼ Vⱼ Wᵢⱼ/U₀ − 1), with U₀ the sum on the lattice.
///
/// Continuity integrates velocities, and knows nothing of where disorder and [`Shifting`](super::Shifting) have
/// moved particles: volumes m/ρ and the space between particles part. This is the re-initialisation of density
/// by kernel sums (Colagrossi & Landrini 2003) done a little in every step; walls fill space too.
///
/// U₀ belongs to one smoothing length, so the law does not go with lengths that vary or differ. At a free
/// surface neighbourhoods are not full and the law is wrong. A strength of 0.05 is usual.
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
pub struct VolumeConsistency {
    /// Strength κ.
    pub strength: f64,
}

impl<const D: usize> Effect<D> for VolumeConsistency {
    type Terms = (In<stage::Continuity, Unity>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(Unity),)
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
                remedy: "leave out either VolumeConsistency or smoothing and mixed_spacing",
            })
        });
        program.document(TermDoc {
            name: format!("volume consistency, κ = {}", self.strength),
            equation: "dρᵢ/dt += κ (c/h) ρᵢ (uᵢ/u₀ − 1)",
            source: "after Colagrossi & Landrini 2003",
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[("strength of the volume consistency", self.strength)])
    }
}

/// The growth κ (c/h) (u/u₀ − 1).
#[derive(Clone, Copy, Debug)]
struct Relaxation {
    strength: f64,
    unity: f64,
}

impl<T: Real, const D: usize> Rate<T, D> for Relaxation {
    fn reads(&self) -> Fields {
        Fields::of(&[Field::SOUND_SPEED])
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[Output::UNITY])
    }
    fn growth(&self, at: &View<'_, T, D>, first: usize, _present: &[T], growth: &mut [T]) {
        let sound_speed = &at.columns.raw(Field::SOUND_SPEED)[first..];
        let factor = T::from_f64(self.strength / at.around.smoothing_length);
        for (n, (growth, c)) in growth.iter_mut().zip(sound_speed).enumerate() {
            let excess = at.sum(Output::UNITY, 0, first + n) / T::from_f64(self.unity) - T::one();
            *growth += factor * *c * excess;
        }
    }
    fn source(&self, _at: &View<'_, T, D>, _first: usize, _source: &mut [T]) {}
}
