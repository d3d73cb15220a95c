//! Advice on liquids: sound, gravity, surface tension, cavitation, gas, and walls that move.
//! Speeds are what bodies start with, what walls have, and √(a L) of uniform accelerations.

use super::bands::{
    ADDED_MASS, BOND, CAVITATION, CROSSINGS, DEFLECTION, FROUDE, GAS, MACH, SHOCK, WEBER,
};
use super::measures::{Measures, fastest_of, length, norm, thickness, velocity};
use super::{Advice, Known, Need};
use crate::material::SoundSpeed;
use crate::scalar::Real;
use crate::scene::{Body, Part, Scene};
use crate::scheme::EnergyForm;
use crate::term::Stage;

/// Deflection over length of a clamped square plate under a pressure q = ρ U²: 0.00126 q L⁴/D with D = E t³/(12 (1 − ν²)) and ν = 0.3
/// (Timoshenko & Woinowsky-Krieger 1959, table 35) is 0.014 (ρ U²/E)(L/t)³.
const PLATE: f64 = 0.014;

/// A liquid, or a gas, and its scales.
pub(super) struct Flow {
    /// U \[m/s\].
    pub speed: f64,
    /// L \[m\].
    pub length: f64,
    pub density: f64,
    pub spacing: f64,
}

impl<T: Real, const D: usize> Scene<T, D> {
    pub(super) fn advise_on_liquids(
        &self,
        measures: &Measures,
        known: &Known,
        advice: &mut Advice,
    ) {
        let liquids = || self.parts.iter().filter(|part| part.scheme.meets_walls());
        for part in liquids() {
            for body in &part.bodies {
                let flow = self.flow(body, measures, known);
                self.advise_on_sound(part, body, &flow, measures, known, advice);
                self.advise_on_viscosity(part, body, &flow, known, advice);
                self.advise_on_viscous_pressure(body, &flow, measures, known, advice);
                self.advise_under_pressure(part, body, &flow, measures, known, advice);
                self.advise_on_gravity(&body.name, flow.speed, flow.length, measures, advice);
                advise_on_surface(&body.name, &flow, measures, known, advice);
                advise_on_cavitation(part, body, &flow, known, advice);
                self.advise_on_walls(body, &flow, known, advice);
            }
        }
        self.advise_on_gas(known, advice);
    }

    fn flow(&self, body: &Body<T, D>, measures: &Measures, known: &Known) -> Flow {
        let length = length(body);
        // What stands still, or else the mean of all particles.
        let count = self
            .bodies()
            .map(|own| own.points.len())
            .sum::<usize>()
            .max(1) as f64;
        let mean = self.bodies().fold([0.0; D], |sum: [f64; D], own| {
            let v = velocity(own);
            core::array::from_fn(|d| sum[d] + v[d] * own.points.len() as f64 / count)
        });
        let beside = if measures.at_rest { [0.0; D] } else { mean };
        let others = self.bodies().map(|own| {
            let (v, w) = (velocity(own), velocity(body));
            norm(&core::array::from_fn::<f64, D, _>(|d| v[d] - w[d]))
        });
        let given = fastest_of(body, &beside)
            .max(measures.walls)
            .max((measures.acceleration * length).sqrt());
        Flow {
            speed: known.speed.unwrap_or_else(|| others.fold(given, f64::max)),
            length,
            density: body.material.reference_density(),
            spacing: body.spacing,
        }
    }

    fn advise_on_sound(
        &self,
        part: &Part<T, D>,
        body: &Body<T, D>,
        flow: &Flow,
        measures: &Measures,
        known: &Known,
        advice: &mut Advice,
    ) {
        let own = body.material.impedance() / flow.density;
        let physical = body.material.sound_speed() == SoundSpeed::Physical;
        let (c, whose) = match known.sound_speed {
            Some(c) if !physical => (c, "of the real liquid"),
            _ if physical => (own, "of the real liquid"),
            _ => (own, "of the artificial sound speed"),
        };
        let mach = MACH.line(&body.name, flow.speed / c, Some(physical));
        advice.add(mach.because(whose));
        let crossings = CROSSINGS.line(&body.name, measures.end * c / flow.length, Some(physical));
        advice.add(crossings.because(whose));
        if !physical {
            let artificial = MACH.line(&body.name, flow.speed / own, Some(physical));
            advice.add(artificial.because("of the artificial sound speed, which has to be raised"));
        }
        let energy = Some(part.scheme.energy != EnergyForm::None);
        advice.add(SHOCK.line(&body.name, flow.speed / c, energy));
    }

    /// Gravity on what moves at U \[m/s\] and is L \[m\] large.
    pub(super) fn advise_on_gravity(
        &self,
        of: &str,
        speed: f64,
        length: f64,
        measures: &Measures,
        advice: &mut Advice,
    ) {
        if measures.gravity == 0.0 {
            return;
        }
        let froude = speed / (measures.gravity * length).sqrt();
        let weight = measures.acceleration / measures.gravity;
        // What gravity alone moves has a Froude number of one.
        let present = measures.acceleration >= 0.5 * measures.gravity;
        advice.add(FROUDE.line(of, froude.max(weight), Some(present)));
    }

    /// Walls that move: structures of the scene, or the wall that is known.
    fn advise_on_walls(&self, body: &Body<T, D>, flow: &Flow, known: &Known, advice: &mut Advice) {
        let solids = self.parts.iter().filter(|part| !part.scheme.meets_walls());
        let mut any = false;
        for wall in solids.flat_map(|part| &part.bodies) {
            if self.wall_coupling(&body.name, &wall.name).is_none() {
                continue;
            }
            any = true;
            let material = &wall.material;
            let modulus = material.youngs_modulus();
            let modulus = modulus.unwrap_or_else(|| material.bulk_modulus());
            let rigid = self.rigid.contains(&wall.name);
            let names = format!("{} and {}", body.name, wall.name);
            let density = material.reference_density();
            let wall = [modulus, density, thickness(wall)];
            advise_on_wall(&names, flow, wall, !rigid, advice);
        }
        if let (false, Some(wall)) = (any, known.wall) {
            advise_on_wall(&body.name, flow, wall, false, advice);
        } else if !any && !self.walls.is_empty() {
            advice.lacks(
                "whether walls move: give Known::wall, its modulus, density and thickness".into(),
            );
        }
    }

    /// The lightest against the heaviest of what flows, or the gas that is left out.
    fn advise_on_gas(&self, known: &Known, advice: &mut Advice) {
        let parts = self.parts.iter().filter(|part| part.scheme.meets_walls());
        let bodies = parts.flat_map(|part| &part.bodies);
        let mut all: Vec<_> = bodies
            .map(|body| (body.material.reference_density(), body.name.as_str()))
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (Some(light), Some(heavy)) = (all.first(), all.last()) else {
            return;
        };
        let (ratio, of, present) = match known.gas_density {
            _ if light.0 < 0.5 * heavy.0 => (
                light.0 / heavy.0,
                format!("{} and {}", light.1, heavy.1),
                true,
            ),
            Some(gas) => (gas / heavy.0, heavy.1.to_owned(), false),
            None => {
                return advice.lacks("gas next to the liquid: give Known::gas_density".into());
            }
        };
        let line = GAS.line(&of, ratio, Some(present));
        advice.add(match (line.need, known.trapped_gas) {
            (Need::Skip, Some(true)) => line.rather(
                Need::Recommend,
                "but pockets of it cushion what strikes; try without first, and look at an ablation",
            ),
            (Need::Skip, None) => line.rather(
                Need::Optional,
                "unless pockets of it are trapped (Known::trapped_gas): leave it out first, and look at an ablation later",
            ),
            _ => line,
        });
    }
}

/// A wall of modulus E \[Pa\], density \[kg/m³\] and thickness t \[m\] against a flow: a clamped plate as long as the liquid.
fn advise_on_wall(of: &str, flow: &Flow, wall: [f64; 3], present: bool, advice: &mut Advice) {
    let [modulus, density, thickness] = wall;
    let cauchy = flow.density * flow.speed.powi(2) / modulus;
    let bend = PLATE * cauchy * (flow.length / thickness).powi(3);
    let bending = DEFLECTION.line(of, bend, Some(present));
    let bends = bending.need;
    advice.add(bending.because(&format!("Cauchy number rho U2/E = {cauchy:.1e}")));
    let mass = flow.density * flow.length / (density * thickness);
    let added = ADDED_MASS.line(of, mass, Some(present));
    let little = added.need < Need::Skip && bends != Need::Require;
    advice.add(if little {
        added.rather(
            bends,
            "but the wall bends little, and it counts where the wall moves",
        )
    } else {
        added
    });
}

fn advise_on_surface(
    of: &str,
    flow: &Flow,
    measures: &Measures,
    known: &Known,
    advice: &mut Advice,
) {
    let Some(tension) = known.surface_tension.filter(|tension| *tension > 0.0) else {
        if known.surface_tension.is_none() {
            advice.lacks("surface tension: give Known::surface_tension".into());
        }
        return;
    };
    // No effect of the crate is a surface tension: it has to be written as one of one's own, which no field tells.
    if flow.speed > 0.0 {
        let inertia = flow.density * flow.speed.powi(2);
        let line = WEBER.line(of, inertia * flow.length / tension, None);
        let spacing = inertia * flow.spacing / tension;
        advice.add(if line.need == Need::Skip && spacing <= 10.0 {
            line.rather(
                Need::Optional,
                &format!(
                    "but the spacing resolves drops that it holds: rho U2 dx/sigma = {spacing:.1}"
                ),
            )
        } else {
            line
        });
    }
    let load = measures.acceleration.max(measures.gravity);
    if load > 0.0 {
        let bond = flow.density * load * flow.length.powi(2) / tension;
        advice.add(BOND.line(of, bond, None));
    }
}

fn advise_on_cavitation<T: Real, const D: usize>(
    part: &Part<T, D>,
    body: &Body<T, D>,
    flow: &Flow,
    known: &Known,
    advice: &mut Advice,
) {
    if flow.speed == 0.0 {
        return;
    }
    let law = part.scheme.program.laws[Stage::Bounds.number()].iter();
    let cuts = body.material.eos().pressure_cut_off().is_some()
        && law.map(|law| law.name()).any(|name| name == "cavitation");
    let suction = 0.5 * flow.density * flow.speed.powi(2);
    let number = (known.ambient_pressure - known.vapour_pressure) / suction;
    advice.add(CAVITATION.line(&body.name, number, Some(cuts)));
}
