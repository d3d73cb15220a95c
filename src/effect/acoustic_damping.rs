//! Damping of sound by a bulk viscosity that follows the last rate of compression.
//! After the acoustic damper of Sun, Pilloton, Antuono & Colagrossi 2023.

use super::{
    Around, CONSTANTS, DensityForm, Effect, Point, PointLaw, Reach, Rung, Setting, StepProgram,
    not_negative,
};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{Stage, TermDoc};

/// Damps sound by a bulk viscosity ζ = λ ρ c h: liquid shows its neighbours the pressure p − ζ ∇·v
/// (after Sun, Pilloton, Antuono & Colagrossi 2023).
///
#[doc = include_str!("../../docs/equations/acoustic_damping.html")]
///
/// The sound of a weakly compressible liquid is not that of the real one, and what an impact leaves
/// ringing in a corner no dissipation between particles reaches. A wave of wave number k decays by
/// exp(−λ c h k² t/2); shear is not touched. The step shortens, at λ = 0.3 by a quarter.
///
/// ```
/// use meshfree::effect::AcousticDamping;
/// use meshfree::prelude::*;
/// let scheme: Scheme<f64, 2> = schemes::weakly_compressible()
///     .with(AcousticDamping { strength: 0.3 })
///     .compose();
/// assert!(scheme.to_string().contains("bulk viscosity against sound"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct AcousticDamping {
    /// Strength λ; zero does nothing.
    pub strength: f64,
}

impl<const D: usize> Effect<D> for AcousticDamping {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let setting = *program.setting();
        program.shorten_step(damped_step(self.strength, setting.kernel.stable_step));
        program.law(Stage::Continuity, KeptDivergence(setting.density));
        program.law(Stage::State, *self);
        program.document(TermDoc {
            name: format!("bulk viscosity against sound, λ = {}", self.strength),
            equation: "p ← p − λ ρ c h ∇·v",
            source: "after Sun, Pilloton, Antuono & Colagrossi 2023",
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[("strength of the acoustic damping", self.strength)])
    }
}

/// By what a bulk viscosity shortens the stable step Δ \[h/c\] of a leapfrog.
///
/// It acts half a step late, so a wave that the step samples at ω dt is stable while
/// (ω dt)² (λ h/(2 c dt) + 1/4) ≤ 1, of which the shortest wave makes dt = √(λ² + Δ²) − λ.
fn damped_step(strength: f64, stable: f64) -> f64 {
    let ratio = strength / stable;
    (ratio * ratio + 1.0).sqrt() - ratio
}

/// Keeps ∇·v \[1/s\] of the last sum of compression.
#[derive(Clone, Copy, Debug)]
struct KeptDivergence(DensityForm);

impl<const D: usize> PointLaw<D> for KeptDivergence {
    const NAME: &'static str = "divergence for acoustic damping";
    const READS: Fields = Fields::of(&[Field::DENSITY]);
    const WRITES: Fields = Fields::of(&[Field::DIVERGENCE]);
    const SUMS: Outputs = Outputs::of(&[Output::COMPRESSION]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (sum, density) = (at.sum(Output::COMPRESSION), at.get(Field::DENSITY));
        let lattice = L::of(at.around.lattice_consistency_factor);
        let compression = self.0.compression(sum, density, L::one(), lattice);
        at.set(Field::DIVERGENCE, -compression);
    }
}

/// p ← p − λ ρ c h ∇·v, but no suction beyond what the material supports.
impl<const D: usize> PointLaw<D> for AcousticDamping {
    const NAME: &'static str = "acoustic damping";
    const READS: Fields = Fields::of(&[
        Field::PRESSURE,
        Field::DENSITY,
        Field::SOUND_SPEED,
        Field::DIVERGENCE,
        Field::SMOOTHING_LENGTH,
    ]);
    const WRITES: Fields = Fields::of(&[Field::PRESSURE]);
    const OPTIONAL: Fields = Fields::of(&[Field::SMOOTHING_LENGTH]);
    const RUNG: Option<Rung> = Some(Rung::Trial);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        let least = around.material.eos().pressure_cut_off();
        constants[0] = least.unwrap_or(f64::NEG_INFINITY);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (pressure, least) = (at.get(Field::PRESSURE), at.constant(0));
        let impedance = L::of(self.strength) * at.get(Field::DENSITY) * at.get(Field::SOUND_SPEED);
        let bulk = impedance * at.smoothing_length();
        let damped = (pressure - bulk * at.get(Field::DIVERGENCE)).max(least);
        // Cavitated liquid carries no sound.
        at.set(
            Field::PRESSURE,
            L::select(pressure.le(least), pressure, damped),
        );
    }
}
