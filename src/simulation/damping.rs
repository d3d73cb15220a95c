//! Damping of sound by a bulk viscosity that follows the last rate of compression.
//! After the acoustic damper of Sun, Pilloton, Antuono & Colagrossi 2023.

use super::continuity::{Reference, compression_sums, rate};
use super::evaluate::GRAIN;
use super::group::Group;
use crate::particles::Field;
use crate::scalar::Real;
use rayon::prelude::*;

impl<T: Real, const D: usize> Group<T, D> {
    fn acoustic_damping(&self) -> Option<f64> {
        self.scheme.liquid.as_ref()?.acoustic_damping
    }

    /// Keeps ∇·v \[1/s\] of the last sweep for compression.
    pub fn keep_divergence(&mut self) {
        if self.acoustic_damping().is_none() {
            return;
        }
        let form = self.scheme.density;
        let lattice = T::from_f64(self.scheme.lattice_moment);
        let rows = compression_sums(&self.scheme, &self.rows, &self.scratch_rows);
        let mobile = self.mobile;
        let [divergence, density] = self.columns.many_mut([Field::DIVERGENCE, Field::DENSITY]);
        let rest: Reference<'_, T> = (&[], &[], lattice);
        divergence[..mobile]
            .par_iter_mut()
            .zip(&*density)
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(slot, (divergence, density))| {
                *divergence = -rate(form, rows, rest, slot, *density);
            });
    }

    /// p ← p − λ ρ c h ∇·v, but no suction beyond what the material bears.
    pub fn damp_sound(&mut self) {
        let Some(strength) = self.acoustic_damping() else {
            return;
        };
        let uniform = T::from_f64(self.smoothing_length);
        let strength = T::from_f64(strength);
        let [pressure, divergence, density, sound_speed, h] = self.columns.many_mut([
            Field::PRESSURE,
            Field::DIVERGENCE,
            Field::DENSITY,
            Field::SOUND_SPEED,
            Field::SMOOTHING_LENGTH,
        ]);
        for body in &self.bodies {
            let least = body.material.eos().pressure_cut_off();
            let least = T::from_f64(least.unwrap_or(f64::NEG_INFINITY));
            let run = body.slots.clone();
            pressure[run.clone()]
                .par_iter_mut()
                .enumerate()
                .with_min_len(GRAIN)
                .for_each(|(k, pressure)| {
                    let slot = run.start + k;
                    // Torn liquid carries no sound.
                    if *pressure <= least {
                        return;
                    }
                    let h = h.get(slot).copied().unwrap_or(uniform);
                    let bulk = strength * density[slot] * sound_speed[slot] * h;
                    *pressure = (*pressure - bulk * divergence[slot]).max(least);
                });
        }
    }
}
