//! Advice on viscous liquids: what viscosity does, the pressure it makes in thin films, and slow flow under pressure.
//! Pressures of films are those of lubrication theory (Reynolds 1886).

use super::bands::{REYNOLDS, UNDER_PRESSURE, VISCOUS, VISIBLE, WALL_REYNOLDS};
use super::liquids::Flow;
use super::measures::{Measures, extents};
use super::{Advice, Known, Need};
use crate::boundary::Slip;
use crate::effect::{PointLaw, PressureDifference};
use crate::material::SoundSpeed;
use crate::particles::Field;
use crate::scalar::Real;
use crate::scene::{Body, Part, Scene};

/// The compression that a weakly compressible liquid may have, as in
/// [`Thresholds::compression`](crate::simulation::Thresholds::compression).
const WEAK: f64 = 0.03;
/// The Reynolds number above which flow is not called slow.
const SLOW: f64 = 1e3;

impl<T: Real, const D: usize> Scene<T, D> {
    pub(super) fn advise_on_viscosity(
        &self,
        part: &Part<T, D>,
        body: &Body<T, D>,
        flow: &Flow,
        known: &Known,
        advice: &mut Advice,
    ) {
        if flow.speed == 0.0 {
            return advice.lacks(format!("the speed of `{}`: give Known::speed", body.name));
        }
        let Some(viscosity) = body.material.rheology() else {
            return advice.lacks(format!(
                "viscosity of `{}`: its material has none",
                body.name
            ));
        };
        let nu = viscosity.viscosity(flow.speed / flow.length) / flow.density;
        let acts = part.scheme.fields().contains(Field::DYNAMIC_VISCOSITY);
        let reynolds = flow.speed * flow.length / nu;
        advice.add(REYNOLDS.line(&body.name, reynolds, Some(acts)));
        match known.artificial_viscosity {
            Some(alpha) => {
                let c = body.material.impedance() / flow.density;
                let h = part.scheme.h_over_dx() * flow.spacing;
                let line = VISIBLE.line(&body.name, alpha * h * c / 10.0 / nu, Some(acts));
                let unseen = line.need == Need::Impossible && reynolds >= 1e4;
                advice.add(if unseen {
                    line.rather(Need::Skip, "which does not matter at this Reynolds number")
                } else {
                    line
                });
            }
            None => advice.lacks(
                "whether artificial viscosity hides that of the liquid: give Known::artificial_viscosity".into(),
            ),
        }
        let structures = self.bodies().any(|own| own.slip == Slip::None);
        if !self.walls.is_empty() || structures {
            let line = WALL_REYNOLDS.line(
                &body.name,
                flow.speed * flow.spacing / nu,
                Some(self.sticks() && acts),
            );
            advice.add(line);
        }
    }

    /// Whether liquid sticks to a wall or a body.
    fn sticks(&self) -> bool {
        let bodies = self.bodies().any(|own| own.slip == Slip::None);
        bodies || self.walls.iter().any(|wall| wall.slip == Slip::None)
    }

    /// The pressure that viscosity makes in a film between what closes on it, or in a gap that is known, over ρ c².
    ///
    /// Plates of length L that close with V on a film of thickness h: p = (6 μ V/h³)(L²/4 − x²), 1.5 μ V L²/h³ at most. Flow
    /// with the mean speed U through a gap of length L: Δp = 12 μ U L/h². Both are solutions of Reynolds' equation
    /// (Batchelor 1967, section 4.8).
    pub(super) fn advise_on_viscous_pressure(
        &self,
        body: &Body<T, D>,
        flow: &Flow,
        measures: &Measures,
        known: &Known,
        advice: &mut Advice,
    ) {
        let Some(viscosity) = body.material.rheology().filter(|_| self.sticks()) else {
            return;
        };
        let sizes = extents(body);
        let Some(thin) = (0..D).min_by(|&a, &b| sizes[a].total_cmp(&sizes[b])) else {
            return;
        };
        let [closing, way] = measures.closing[thin];
        let last = (sizes[thin] - way).max(body.spacing);
        let film = if closing > 0.0 && last < flow.length {
            let rate = 0.5 * closing * flow.length / last.powi(2);
            1.5 * viscosity.viscosity(rate) * closing * flow.length.powi(2) / last.powi(3)
        } else {
            0.0
        };
        let gap = match (known.gap, known.speed) {
            (Some(gap), Some(speed)) => {
                12.0 * viscosity.viscosity(speed / gap) * speed * flow.length / gap.powi(2)
            }
            _ => 0.0,
        };
        let pressure = film.max(gap);
        if pressure == 0.0 {
            return;
        }
        let own = body.material.impedance() / flow.density;
        let line = VISCOUS.line(&body.name, pressure / (flow.density * own * own), None);
        let least = (pressure / (WEAK * flow.density)).sqrt();
        let line = line.because(&format!(
            "a sound speed of {least:.3} m/s keeps the density within 3 %"
        ));
        let physical = body.material.sound_speed() == SoundSpeed::Physical;
        advice.add(if physical && line.need == Need::Impossible {
            line.rather(
                Need::Optional,
                "but the sound speed is said to be that of the liquid",
            )
        } else {
            line
        });
    }

    /// Slow flow under pressure: p over the stresses of the flow.
    pub(super) fn advise_under_pressure(
        &self,
        part: &Part<T, D>,
        body: &Body<T, D>,
        flow: &Flow,
        measures: &Measures,
        known: &Known,
        advice: &mut Advice,
    ) {
        let Some(viscosity) = body.material.rheology().filter(|_| flow.speed > 0.0) else {
            return;
        };
        let length = known.gap.unwrap_or(flow.length);
        let mu = viscosity.viscosity(flow.speed / length);
        if flow.density * flow.speed * length >= SLOW * mu {
            return;
        }
        let rest = body.material.state(flow.density, 0.0).0;
        let starts = body.starts.iter().map(|own| own.density);
        let densest = starts.fold(flow.density, f64::max);
        let start = body.material.state(densest, 0.0).0 - rest;
        let heads = extents(body).into_iter().zip(&measures.pull);
        let head = heads.map(|(size, a)| flow.density * size * a).sum::<f64>();
        let stresses = mu * flow.speed / length + flow.density * flow.speed.powi(2);
        let mut laws = part.scheme.program.laws.iter().flatten();
        let name = <PressureDifference as PointLaw<D>>::NAME;
        let by_differences = laws.any(|law| law.name() == name);
        let line =
            UNDER_PRESSURE.line(&body.name, start.max(head) / stresses, Some(by_differences));
        advice.add(if line.need == Need::Skip {
            line
        } else {
            line.because(
                "PressureDifference with ConsistentShifting removes it away from free surfaces",
            )
        });
    }
}
