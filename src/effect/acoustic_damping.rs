//! Damping of sound by a bulk viscosity that follows the last rate of compression.
//! After the acoustic damper of Sun, Pilloton, Antuono & Colagrossi 2023.

use super::{Chunk, DensityForm, Effect, Law, Rung, Setting, StepProgram, Tally, not_negative};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
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

impl<T: Real, const D: usize> Law<T, D> for KeptDivergence {
    fn name(&self) -> &'static str {
        "divergence for acoustic damping"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[Field::DENSITY])
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[Output::COMPRESSION])
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::DIVERGENCE])
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let compression = chunk.sum(Output::COMPRESSION);
        let lattice = T::from_f64(chunk.around.lattice_consistency_factor);
        let ([density], [divergence]) = chunk.columns([Field::DENSITY], [Field::DIVERGENCE]);
        for (n, (divergence, density)) in divergence.iter_mut().zip(density).enumerate() {
            let sum = compression.get(0, n);
            *divergence = -self.0.compression(sum, *density, T::one(), lattice);
        }
        Tally::default()
    }
}

/// p ← p − λ ρ c h ∇·v, but no suction beyond what the material bears.
impl<T: Real, const D: usize> Law<T, D> for AcousticDamping {
    fn name(&self) -> &'static str {
        "acoustic damping"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[
            Field::PRESSURE,
            Field::DENSITY,
            Field::SOUND_SPEED,
            Field::DIVERGENCE,
            Field::SMOOTHING_LENGTH,
        ])
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::PRESSURE])
    }
    fn optional(&self) -> Fields {
        Fields::of(&[Field::SMOOTHING_LENGTH])
    }
    fn rung(&self) -> Option<Rung> {
        Some(Rung::Trial)
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let uniform = T::from_f64(chunk.around.smoothing_length);
        let strength = T::from_f64(self.strength);
        let least = chunk.around.material.eos().pressure_cut_off();
        let least = T::from_f64(least.unwrap_or(f64::NEG_INFINITY));
        let ([divergence, density, sound_speed, h], [pressure]) = chunk.columns(
            [
                Field::DIVERGENCE,
                Field::DENSITY,
                Field::SOUND_SPEED,
                Field::SMOOTHING_LENGTH,
            ],
            [Field::PRESSURE],
        );
        for (n, pressure) in pressure.iter_mut().enumerate() {
            // Cavitated liquid carries no sound.
            if *pressure <= least {
                continue;
            }
            let h = h.get(n).copied().unwrap_or(uniform);
            let bulk = strength * density[n] * sound_speed[n] * h;
            *pressure = (*pressure - bulk * divergence[n]).max(least);
        }
        Tally::default()
    }
}
