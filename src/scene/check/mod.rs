//! What can be wrong with a scene: every check runs, and every problem is reported.
//! A message names the field, the value, and what to do.

mod doubled;
mod groups;
mod held;
mod images;
mod limits;
mod memory;
mod scheme;
mod solids_at_walls;
mod thin;
mod walls;

use super::numerics::SKINS;
use super::{Body, Part, Plan, Scene};
use crate::effect::HeatConduction;
use crate::error::Problem;
use crate::neighbors::Cells;
use crate::scalar::Real;
use crate::scheme::EnergyForm;
use crate::simulation::{ACCELERATION, Load, UniformLoad, is_square_finite};

/// Share of the spacing below which two particles of different bodies cannot be neighbours by intent.
const TOO_CLOSE: f64 = 0.6;
/// Share of the spacing within which lattices that overlap without such a pair put
/// [`surrounding`] particles of one body around a particle of the other; a lattice that only touches
/// puts one there.
const AROUND: f64 = 0.95;
/// Share of the spacing below which two particles of one body are the same particle twice: within a
/// body a user may place points as densely as a gas needs.
const SAME: f64 = 6e-4;

/// How many particles of another body around one are an overlap.
const fn surrounding(dimension: usize) -> usize {
    if dimension < 3 { 3 } else { 4 }
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// Everything that is wrong with the scene; empty if it can be built.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        if self.bodies().next().is_none() {
            problems.push(Problem::EmptyScene);
        }
        for body in self.bodies() {
            check_body(body, &mut problems);
        }
        self.check_names(&mut problems);
        self.check_contacts(&mut problems);
        self.check_outlets(&mut problems);
        self.check_sources(&mut problems);
        let plans: Vec<Plan<'_, T, D>> = self.plans().collect();
        for plan in &plans {
            plan.check_scheme(&mut problems);
            plan.check_openings_of_sums(&mut problems);
        }
        self.check_steps(&mut problems);
        self.check_factors(&mut problems);
        self.check_groups(&mut problems);
        self.check_couplings(&mut problems);
        self.check_solids_at_walls(&mut problems);
        self.check_sub_cycles(&mut problems);
        self.check_held(&mut problems);
        self.check_joints(&mut problems);
        self.check_events(&mut problems);
        self.check_exchanges(&mut problems);
        let before = problems.len();
        self.check_boundaries(&mut problems);
        // What is wrong by its own numbers has no transforms to look at.
        if problems.len() == before {
            self.check_transforms(&mut problems);
        }
        if problems.len() == before {
            self.check_periods(&mut problems);
            self.check_boundary_count(&mut problems);
            self.check_images(&mut problems);
        }
        self.check_openings(&mut problems);
        for plan in &plans {
            plan.check_walls(&mut problems);
        }
        self.check_loads(&mut problems);
        if problems.is_empty() {
            self.check_extent(&mut problems);
            self.check_memory(&mut problems);
        }
        if problems.is_empty() {
            for plan in &plans {
                plan.check_overlap(&mut problems);
                plan.check_wall_places(&mut problems);
            }
            self.check_doubled_walls(&mut problems);
            self.check_doubled_inlets(&mut problems);
            self.check_coupled_places(&mut problems);
            self.check_thickness(&mut problems);
        }
        problems
    }

    fn check_names(&self, problems: &mut Vec<Problem>) {
        for (k, body) in self.bodies().enumerate() {
            if self
                .bodies()
                .take(k)
                .any(|earlier| earlier.name == body.name)
            {
                problems.push(Problem::Incompatible {
                    what: format!("two bodies are called `{}`", body.name),
                    remedy: "give every body a name of its own",
                });
            }
        }
        for name in self
            .contacts
            .iter()
            .flat_map(|(first, second, _)| [first, second])
        {
            if self.place_of(name).is_none() && self.wall_number(name).is_none() {
                problems.push(self.unknown_body(name));
            }
        }
    }

    /// The problem that no body has a name.
    pub(super) fn unknown_body(&self, name: &str) -> Problem {
        let names: Vec<_> = self
            .bodies()
            .map(|body| format!("`{}`", body.name))
            .collect();
        Problem::UnknownName {
            kind: "body",
            name: name.into(),
            known: names.join(", "),
        }
    }

    fn check_boundaries(&self, problems: &mut Vec<Problem>) {
        let skin = self.skin.unwrap_or(SKINS[0]);
        let reach = |part: &Part<T, D>| {
            let spacings = part.bodies.iter().map(|body| body.spacing);
            let spacing = spacings.fold(0.0, f64::max);
            part.scheme.kernel.support * part.scheme.h_over_dx * spacing * (1.0 + skin)
        };
        let reach = self.parts.iter().map(reach).fold(0.0, f64::max);
        for boundary in &self.boundaries {
            for (what, value, must_be) in boundary.problems(reach) {
                problems.push(Problem::Parameter {
                    what: format!("{what} of the {}", boundary.name()),
                    value,
                    must_be,
                });
            }
            let crossed = |x: &&[f64; D]| boundary.crossed(x, 0.0);
            for body in self.bodies() {
                if let Some(x) = body.points.iter().find(crossed) {
                    problems.push(Problem::Incompatible {
                        what: format!(
                            "body `{}` has a particle at {x:?} m, behind the {}",
                            body.name,
                            boundary.name()
                        ),
                        remedy: "move one of them, or reverse the normal: it points out of the material",
                    });
                }
            }
        }
    }

    fn check_loads(&self, problems: &mut Vec<Problem>) {
        let bad = |load: &UniformLoad<D>| {
            let given = load(0.0).into_iter();
            given.into_iter().find(|a| !is_square_finite::<T>(*a))
        };
        if let Some(value) = self.accelerations.iter().find_map(bad) {
            problems.push(parameter("acceleration at t = 0", value, ACCELERATION));
        }
        self.check_hydrostatic(problems);
        for load in &self.loads {
            self.check_load(load, problems);
        }
    }

    /// Bodies that start at rest under an acceleration that points against that of the scene.
    fn check_hydrostatic(&self, problems: &mut Vec<Problem>) {
        let given = |d: usize| self.accelerations.iter().map(|load| load(0.0)[d]).sum();
        let given: [f64; D] = core::array::from_fn(given);
        for body in self.bodies() {
            let Some(own) = body.hydrostatic else {
                continue;
            };
            if (0..D).map(|d| own[d] * given[d]).sum::<f64>() < 0.0 {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "body `{}` starts hydrostatic under {own:?} m/s², and the acceleration of the scene at t = 0 is {given:?} m/s²",
                        body.name
                    ),
                    remedy: "give both the same value",
                });
            }
        }
    }

    /// A load on a body that there is, and heat where there is energy.
    fn check_load(&self, load: &Load<D>, problems: &mut Vec<Problem>) {
        if let Some(name) = load.body()
            && !self.bodies().any(|body| body.name == name)
        {
            problems.push(self.unknown_body(name));
        }
        for part in &self.parts {
            let warms = part.scheme.program.keeps(HeatConduction::TEMPERATURE);
            let cold = load.heats() && part.scheme.energy == EnergyForm::None && !warms;
            let mut own = part.bodies.iter();
            let there = part.scheme.fields();
            let lacks = load.reads().iter().find(|field| !there.contains(*field));
            let mut acted_on = part.bodies.iter().filter(|body| load.acts_on(&body.name));
            if let (Some(field), Some(body)) = (lacks, acted_on.next()) {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the load ({load}) reads {} of body `{}`, which the scheme {} does not have",
                        part.scheme.program.name_of(field), body.name, part.scheme.name
                    ),
                    remedy: "add the effect that has the field, or limit the load with `Load::on` to a body that has it",
                });
            }
            if let Some(body) = own.find(|body| cold && load.acts_on(&body.name)) {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the load ({load}) heats body `{}`, and the scheme {} carries no energy and no temperature",
                        body.name, part.scheme.name
                    ),
                    remedy: "take an energy form that does, add effect::HeatConduction, or limit the load with `Load::on` to a body that has one",
                });
            }
        }
    }
}

impl<T: Real, const D: usize> Plan<'_, T, D> {
    /// Finds the closest pair of particles that are too close to be neighbours.
    fn check_overlap(&self, problems: &mut Vec<Problem>) {
        let points: Vec<[f64; D]> = self
            .bodies
            .iter()
            .flat_map(|body| body.points.iter().copied())
            .collect();
        let ends: Vec<usize> = self
            .bodies
            .iter()
            .scan(0, |sum, body| {
                *sum += body.points.len();
                Some(*sum)
            })
            .collect();
        let spacing = self
            .bodies
            .iter()
            .fold(f64::INFINITY, |least, body| least.min(body.spacing));
        let all: Vec<u32> = (0..points.len() as u32).collect();
        let cells = Cells::build(&points, &all, spacing);
        let body_of = |k: usize| ends.partition_point(|&end| end <= k);
        let mut reported: Vec<(usize, usize)> = Vec::new();
        let mut around: Vec<(usize, f64)> = Vec::new();
        for (i, x) in points.iter().enumerate() {
            let (own, reach) = (body_of(i), AROUND * spacing);
            around.clear();
            cells.for_each_run(x.map(|x| x - reach), x.map(|x| x + reach), |run| {
                for j in run.iter().map(|&j| j as usize).filter(|&j| j != i) {
                    let apart = (0..D)
                        .map(|d| (points[j][d] - x[d]).powi(2))
                        .sum::<f64>()
                        .sqrt();
                    let other = body_of(j);
                    if apart < if other == own { SAME * spacing } else { reach } {
                        around.push((other, apart));
                    }
                }
            });
            let nearest = around.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((other, distance)) = nearest else {
                continue;
            };
            let count = around.iter().filter(|near| near.0 == other).count();
            let pair = (own.min(other), own.max(other));
            let fits = distance >= TOO_CLOSE * spacing && count < surrounding(D);
            if fits || reported.contains(&pair) {
                continue;
            }
            reported.push(pair);
            problems.push(Problem::Overlap {
                first: self.bodies[pair.0].name.clone(),
                second: self.bodies[pair.1].name.clone(),
                distance,
                spacing,
                position: x.to_vec(),
            });
        }
    }
}

/// A parameter out of its range.
fn parameter(what: &str, value: f64, must_be: &'static str) -> Problem {
    Problem::Parameter {
        what: what.into(),
        value,
        must_be,
    }
}

fn check_body<T: Real, const D: usize>(body: &Body<T, D>, problems: &mut Vec<Problem>) {
    let before = problems.len();
    let mut parameter = |what: &str, value: f64, must_be: &'static str| {
        problems.push(Problem::Parameter {
            what: format!("{what} of body `{}`", body.name),
            value,
            must_be,
        });
    };
    if let Err((what, value, must_be)) = body.shape {
        parameter(what, value, must_be);
        return;
    }
    for (what, value, must_be) in body.material.problems() {
        parameter(
            &format!("{what} of material `{}`", body.material.name),
            value,
            must_be,
        );
    }
    let first = |bad: &dyn Fn(&super::Start<D>) -> Option<f64>| body.starts.iter().find_map(bad);
    if let Some(value) = first(&|s| Some(s.density).filter(|d| !(d.is_finite() && *d > 0.0))) {
        parameter("density", value, "it must be finite and positive, in kg/m³");
    }
    if let Some(value) = first(&|s| s.velocity.into_iter().find(|v| !v.is_finite())) {
        parameter("velocity", value, "it must be finite, in m/s");
    }
    if let Some(value) = first(&|s| Some(s.energy).filter(|e| !e.is_finite())) {
        parameter("energy", value, "it must be finite, in J/kg");
    }
    let position = body.points.iter().flatten().find(|x| !x.is_finite());
    if let Some(&value) = position {
        parameter("position", value, "it must be finite, in metres");
    }
    let spaced = body.spacing.is_finite() && body.spacing > 0.0;
    if !(spaced || body.points.is_empty()) {
        parameter(
            "spacing",
            body.spacing,
            "it must be finite and positive, in metres",
        );
    }
    if body.points.is_empty() {
        problems.push(Problem::EmptyBody {
            body: body.name.clone(),
        });
    }
    if problems.len() == before
        && let Some((what, value, must_be)) = limits::check_starts(body)
    {
        problems.push(Problem::Parameter {
            what: format!("{what} of body `{}`", body.name),
            value,
            must_be,
        });
    }
}
