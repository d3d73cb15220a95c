//! The indicators of the present state, from what a sample of its particles says.
//! Each is a number without unit, zero of a continuum.

use super::super::Simulation;
use super::super::stability::Extreme;
use super::limit::{self, Estimates};
use super::look::{Look, Looker};
use super::report::{Indicators, Spread, median};
use super::thickness::thicknesses;
use crate::collective::over;
use crate::particles::Field;
use crate::scalar::Real;

/// Particles that are looked at in a scene, about.
const SAMPLE: usize = 1 << 15;
/// A range of pressures or velocities below this share of ρc² or c is rounding and not a field.
const FIELD: f64 = 1e-9;

/// Largest and least of some numbers, apart.
fn range(values: impl Iterator<Item = f64>) -> f64 {
    let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], own| {
        [low.min(own), high.max(own)]
    });
    (ends[1] - ends[0]).max(0.0)
}

/// Where a value was.
struct At {
    value: f64,
    group: usize,
    slot: usize,
}

/// Looks at the present state.
pub(super) fn of<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> Indicators {
    let extreme = |at: &At| {
        let group = &simulation.state.groups[at.group];
        let id = group.particles.first_id + group.particles.ids[at.slot] as usize;
        let (body, particle) = simulation.locate(id);
        Extreme {
            value: at.value,
            time: simulation.time(),
            body,
            particle,
            position: group.particles.position(at.slot).to_vec(),
        }
    };
    let spread = |values: Vec<At>, least: bool| {
        let sign = if least { -1.0 } else { 1.0 };
        let worst = values
            .iter()
            .max_by(|a, b| (sign * a.value).total_cmp(&(sign * b.value)))?;
        let mut numbers: Vec<f64> = values.iter().map(|own| own.value).collect();
        Some(Spread {
            median: median(&mut numbers),
            worst: extreme(worst),
        })
    };
    let mobile: usize = simulation
        .state
        .groups
        .iter()
        .map(|own| own.particles.mobile)
        .sum();
    let stride = mobile.div_ceil(SAMPLE).max(1);
    let mut particles = 0;
    let mut looks: Vec<(usize, Look)> = Vec::new();
    let mut ranges = Vec::new();
    let mut thickness = Vec::new();
    for (index, group) in simulation.state.groups.iter().enumerate() {
        let looker = Looker::new(group);
        let (count, own) = looker.looks(stride);
        particles += count;
        let columns = &group.particles.columns;
        let sound = |look: &Look| {
            let [c, rho] = [Field::SOUND_SPEED, Field::DENSITY]
                .map(|field| columns.raw(field)[look.slot].to_f64());
            [rho * c * c, c]
        };
        let floor = own.iter().map(sound).fold([0.0_f64; 2], |most, own| {
            [most[0].max(own[0]), most[1].max(own[1])]
        });
        let velocities = columns.vectors(Field::VELOCITY);
        let pressures = range(own.iter().map(|look| look.pressure));
        let speeds = (0..D).map(|d| range(own.iter().map(|k| velocities[k.slot][d].to_f64())));
        let speeds = speeds.fold(0.0, f64::max);
        ranges.push([
            Some(pressures).filter(|own| *own > FIELD * floor[0]),
            Some(speeds).filter(|own| *own > FIELD * floor[1]),
        ]);
        looks.extend(own.into_iter().map(|look| (index, look)));
        if group.neighborhood.lists.chunks().is_empty() {
            continue;
        }
        for body in 0..group.particles.bodies.len() {
            let across = thicknesses(&looker, body);
            let at = across.into_iter().map(|(slot, value)| At {
                value,
                group: index,
                slot,
            });
            thickness.extend(spread(at.collect(), true));
        }
    }
    let of = |value: &dyn Fn(usize, &Look) -> f64| {
        let all = looks.iter().map(|(group, look)| At {
            value: value(*group, look),
            group: *group,
            slot: look.slot,
        });
        spread(all.filter(|own| own.value.is_finite()).collect(), false)
    };
    let mut indicators = Indicators {
        time: simulation.time(),
        particles,
        inside: looks.len(),
        unity: of(&|_, look| look.unity),
        gradient: of(&|_, look| look.gradient),
        left: of(&|_, look| look.left),
        disorder: of(&|_, look| look.disorder),
        density: of(&|_, look| look.density.abs()),
        drift: None,
        fronts: of(&|group, look| ranges[group][0].map_or(f64::NAN, |own| look.steepness / own)),
        layers: of(&|group, look| ranges[group][1].map_or(f64::NAN, |own| look.shear / own)),
        thickness,
        limits: Vec::new(),
    };
    let signed = looks.iter().map(|(_, look)| look.density);
    let signed: Vec<f64> = signed.filter(|own| own.is_finite()).collect();
    if !signed.is_empty() {
        indicators.drift = Some(over(0..signed.len(), |k| signed[k]) / signed.len() as f64);
    }
    let estimates = Estimates::of(&looks, &ranges);
    indicators.limits = limit::limits(simulation, &indicators, &estimates);
    indicators
}
