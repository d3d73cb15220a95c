//! Whether liquids are compressed beyond what is called weak, for longer than sound takes to cross them.
//! A sound speed that is too low for the pressure of the flow shows so, whether inertia or viscosity makes the pressure.

use super::super::Simulation;
use crate::collective::{Corners, Least, over};
use crate::material::Material;
use crate::particles::Field;
use crate::scalar::Real;
use crate::scheme::EnergyForm;

/// The share of the particles of a body that may be compressed further.
const FEW: f64 = 0.01;

/// A body of a liquid.
#[derive(Clone, Copy, Debug)]
struct Liquid {
    group: usize,
    body: usize,
    /// How long sound takes to cross it as it starts \[s\].
    crossing: f64,
    /// Since when more than a few particles are compressed too far \[s\].
    since: Option<f64>,
}

/// What is known of the compression of all liquids.
#[derive(Clone, Debug)]
pub(in super::super) struct Compression {
    liquids: Vec<Liquid>,
    sound_speed: Option<f64>,
}

impl Compression {
    pub fn of<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> Self {
        let mut liquids = Vec::new();
        for (number, group) in simulation.state.groups.iter().enumerate() {
            if !group.scheme.meets_walls() || group.scheme.energy != EnergyForm::None {
                continue;
            }
            let x = group.particles.columns.vectors(Field::POSITION);
            for (body, own) in group.particles.bodies.iter().enumerate() {
                if own.material.is_gas() {
                    continue;
                }
                let place = |slot: usize| Corners::at(x[slot].map(Real::to_f64));
                let extent = over(own.slots.clone(), place).extent();
                let longest = extent.into_iter().fold(own.spacing, f64::max);
                liquids.push(Liquid {
                    group: number,
                    body,
                    crossing: longest * own.material.reference_density() / own.material.impedance(),
                    since: None,
                });
            }
        }
        Self {
            liquids,
            sound_speed: None,
        }
    }

    /// Takes what is compressed now for lasting.
    pub fn forget_durations(&mut self) {
        for liquid in &mut self.liquids {
            liquid.crossing = 0.0;
        }
    }

    /// The sound speed \[m/s\] at which the largest lasting pressure keeps the limit.
    pub fn sound_speed(&self) -> Option<f64> {
        self.sound_speed
    }

    /// Looks at all liquids; gives group and slot of the densest particle of one that has been compressed beyond the limit for
    /// longer than a crossing, and its ρ/ρ₀ − 1.
    pub fn look<T: Real, const D: usize>(
        &mut self,
        simulation: &Simulation<T, D>,
        limit: f64,
    ) -> Option<(usize, usize, f64)> {
        let mut found = None;
        for liquid in &mut self.liquids {
            let particles = &simulation.state.groups[liquid.group].particles;
            let body = &particles.bodies[liquid.body];
            let density = &particles.columns.raw(Field::DENSITY)[body.slots.clone()];
            let by = 1.0 / body.material.reference_density();
            // How many are beyond, and the densest: of equal ones the first.
            let (count, Least(value, slot)) = over(0..density.len(), |n| {
                let value = density[n].to_f64() * by - 1.0;
                (u64::from(value > limit), Least(-value, n))
            });
            let value = -value;
            if count as f64 <= FEW * density.len() as f64 {
                liquid.since = None;
                continue;
            }
            let since = *liquid.since.get_or_insert(simulation.state.time);
            if simulation.state.time - since < liquid.crossing {
                continue;
            }
            let least = sound_speed_for(&body.material, value, limit);
            self.sound_speed = self.sound_speed.into_iter().chain(least).reduce(f64::max);
            found = found.or(Some((liquid.group, body.slots.start + slot, value)));
        }
        found
    }
}

/// The sound speed \[m/s\] at which the pressure of ρ/ρ₀ − 1 = `found` compresses by `limit` alone: the pressures of a law are as
/// c².
fn sound_speed_for<T: Real>(material: &Material<T>, found: f64, limit: f64) -> Option<f64> {
    let rest = material.reference_density();
    let (least, c) = material.state(rest, 0.0);
    let above = |compression: f64| material.state(rest * (1.0 + compression), 0.0).0 - least;
    let factor = (above(found) / above(limit)).sqrt();
    (factor.is_finite() && factor > 0.0).then_some(c * factor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::eos::{Linear, Tait};

    #[test]
    fn the_sound_speed_bears_the_pressure() {
        // Linear: c² ∝ compression. Tait: ((1 + e)⁷ − 1).
        let linear = Material::<f64>::new("it", Linear::new(1000.0, 6.0));
        let c = sound_speed_for(&linear, 0.12, 0.03).unwrap();
        assert!((c - 12.0).abs() < 1e-9, "{c}");
        let tait = Material::<f64>::new("it", Tait::new(1000.0, 6.0));
        let c = sound_speed_for(&tait, 0.12, 0.03).unwrap();
        let pressure = |compression: f64| (1.0 + compression).powi(7) - 1.0;
        assert!(
            (c / 6.0 - (pressure(0.12) / pressure(0.03)).sqrt()).abs() < 1e-9,
            "{c}"
        );
    }
}
