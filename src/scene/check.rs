//! What can be wrong with a scene: every check runs, and every problem is reported.
//! A message names the field, the value, and what to do.

use super::Scene;
use crate::boundary::{Outlet, Pose, Slip};
use crate::error::Problem;
use crate::neighbors::Cells;
use crate::particles::Field;
use crate::scalar::Real;
use crate::scheme::EnergyForm;
use crate::simulation::Load;

/// Share of the spacing below which two particles of different bodies cannot be neighbours by intent.
const TOO_CLOSE: f64 = 0.6;
/// Share of the spacing within which lattices that overlap without such a pair put
/// [`surrounding`] particles of one body around a particle of the other; a lattice that only touches
/// puts one there.
const AROUND: f64 = 0.95;
/// Share of the spacing below which two particles of one body are the same particle twice: within a
/// body a user may place points as densely as a gas needs.
const SAME: f64 = 6e-4;
/// Share by which the spacing of an inlet may differ from that of its body, as the density that enters.
const SAME_SPACING: f64 = 1e-3;

/// How many particles of another body around one are an overlap.
const fn surrounding(dimension: usize) -> usize {
    if dimension < 3 { 3 } else { 4 }
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// Everything that is wrong with the scene; empty if it can be built.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        if self.bodies.is_empty() {
            problems.push(Problem::EmptyScene);
        }
        for body in &self.bodies {
            self.check_body(body, &mut problems);
        }
        self.check_scheme(&mut problems);
        self.check_names(&mut problems);
        self.check_boundaries(&mut problems);
        self.check_openings(&mut problems);
        self.check_walls(&mut problems);
        if problems.is_empty() {
            self.check_overlap(&mut problems);
            self.check_wall_places(&mut problems);
        }
        problems
    }

    fn check_body(&self, body: &super::Body<T, D>, problems: &mut Vec<Problem>) {
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
        let first =
            |bad: &dyn Fn(&super::Start<D>) -> Option<f64>| body.starts.iter().find_map(bad);
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
    }

    fn check_scheme(&self, problems: &mut Vec<Problem>) {
        let (scheme, kernel) = (&self.scheme, self.scheme.kernel);
        let (lowest, highest) = kernel.range;
        if !(lowest..=highest).contains(&scheme.h_over_dx) {
            problems.push(Problem::SmoothingRatio {
                kernel: kernel.name,
                ratio: scheme.h_over_dx,
                lowest,
                highest,
                recommended: kernel.h_over_dx,
            });
        }
        for (what, value, must_be) in &scheme.viscosity_problems {
            problems.push(Problem::Parameter {
                what: format!("{what} of the artificial viscosity"),
                value: *value,
                must_be,
            });
        }
        if let Some(liquid) = &scheme.liquid {
            let lengths_vary = scheme.fields().contains(Field::SmoothingLength);
            if liquid.volume_consistency.is_some() && lengths_vary {
                problems.push(Problem::Incompatible {
                    what: "volume consistency holds kernel sums to those of a lattice at one smoothing length, \
                           and the smoothing lengths of this scheme vary or differ"
                        .into(),
                    remedy: "leave out either volume_consistency or smoothing and mixed_spacing",
                });
            }
            let consistency = liquid.volume_consistency.map(|(strength, _)| strength);
            for (what, strength) in [
                ("acoustic damping", liquid.acoustic_damping),
                ("volume consistency", consistency),
            ] {
                let Some(value) = strength.filter(|s| !(s.is_finite() && *s >= 0.0)) else {
                    continue;
                };
                problems.push(Problem::Parameter {
                    what: format!("strength of the {what}"),
                    value,
                    must_be: "it must be finite and not negative",
                });
            }
        }
        let mut positive = |what: &str, value: f64| {
            if !(value.is_finite() && value > 0.0) {
                problems.push(Problem::Parameter {
                    what: what.into(),
                    value,
                    must_be: "it must be finite and positive",
                });
            }
        };
        positive("step factor (courant)", self.control.courant);
        positive("force factor of the step", self.control.force);
        positive("skin", self.skin);
        if let Some(step) = self.control.fixed {
            positive("fixed time step", step);
        }
        let mut incompatible = |what: String, remedy| {
            problems.push(Problem::Incompatible { what, remedy });
        };
        if scheme.energy == EnergyForm::Compatible && !self.integrator.kicks() {
            incompatible(
                format!(
                    "the compatible energy form cannot follow the integrator {}",
                    self.integrator.name()
                ),
                "take EnergyForm::Symmetric, or an integrator that kicks (kick-drift-kick)",
            );
        }
        if scheme.density.is_integrated() && !self.integrator.integrates_density() {
            incompatible(
                format!(
                    "the integrator {} does not integrate density",
                    self.integrator.name()
                ),
                "take a density form that follows from positions, or another integrator",
            );
        }
        if scheme.liquid.is_some() && !scheme.kicks_density() && !self.integrator.kicks() {
            incompatible(
                format!(
                    "the scheme {} sums the rate of density in drifts, which the integrator {} does not take",
                    scheme.name,
                    self.integrator.name()
                ),
                "take LiquidBuilder::compose_with_one_evaluation, or an integrator that kicks (kick-drift-kick)",
            );
        }
        if !self.walls.is_empty() && !self.integrator.kicks() {
            incompatible(
                format!(
                    "the integrator {} combines states of all particles, and would move those of wall `{}`",
                    self.integrator.name(),
                    self.walls[0].name
                ),
                "take an integrator that kicks (kick-drift-kick), or boundaries of images (MirrorPlane)",
            );
        }
        if !self.instructions.available() {
            incompatible(
                format!("this machine does not have {:?}", self.instructions),
                "leave the choice to the scene, or take InstructionSet::Baseline",
            );
        }
        let hot = self.bodies.iter().find(|body| {
            scheme.energy == EnergyForm::None && body.starts.iter().any(|start| start.energy != 0.0)
        });
        if let Some(body) = hot {
            incompatible(
                format!(
                    "body `{}` starts with internal energy, which the scheme does not carry",
                    body.name
                ),
                "take an energy form in the scheme, or start without energy",
            );
        }
        if self.is_mixed() && self.is_uniform() {
            incompatible(
                "bodies have different spacings, and the scheme has one smoothing length".into(),
                "give all bodies the same spacing, or allow it with SchemeBuilder::mixed_spacing",
            );
        }
    }

    fn check_names(&self, problems: &mut Vec<Problem>) {
        let known = || {
            let names: Vec<_> = self
                .bodies
                .iter()
                .map(|body| format!("`{}`", body.name))
                .collect();
            names.join(", ")
        };
        for (k, body) in self.bodies.iter().enumerate() {
            if self.bodies[..k]
                .iter()
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
            if !self.bodies.iter().any(|body| body.name == *name) {
                problems.push(Problem::UnknownName {
                    kind: "body",
                    name: name.clone(),
                    known: known(),
                });
            }
        }
    }

    fn check_boundaries(&self, problems: &mut Vec<Problem>) {
        let spacing = self
            .bodies
            .iter()
            .fold(0.0_f64, |most, body| most.max(body.spacing));
        let reach =
            self.scheme.kernel.support * self.scheme.h_over_dx * spacing * (1.0 + self.skin);
        for boundary in &self.boundaries {
            for (what, value, must_be) in boundary.problems(reach) {
                problems.push(Problem::Parameter {
                    what: format!("{what} of the {}", boundary.name()),
                    value,
                    must_be,
                });
            }
        }
    }

    /// Inlets and outlets.
    fn check_openings(&self, problems: &mut Vec<Problem>) {
        for inlet in &self.inlets {
            for (what, value, must_be) in inlet.problems() {
                problems.push(Problem::Parameter {
                    what: format!("{what} of the inlet of body `{}`", inlet.body),
                    value,
                    must_be,
                });
            }
            if self.scheme.liquid.is_none() {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the inlet of body `{}` has a buffer of wall particles, which the scheme {} does not see",
                        inlet.body, self.scheme.name
                    ),
                    remedy: "take a scheme of liquids (schemes::weakly_compressible)",
                });
            }
            let Some(body) = self.bodies.iter().find(|body| body.name == inlet.body) else {
                let known: Vec<_> = self.bodies.iter().map(|body| body.name.as_str()).collect();
                problems.push(Problem::UnknownName {
                    kind: "body",
                    name: inlet.body.clone(),
                    known: known.join(", "),
                });
                continue;
            };
            // What is no number has its own problem.
            let off = (inlet.spacing - body.spacing).abs();
            if inlet.spacing > 0.0 && off.is_finite() && off > SAME_SPACING * body.spacing {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the inlet of body `{}` has a spacing of {} m, and the body of {} m as fitted to its shape",
                        body.name, inlet.spacing, body.spacing
                    ),
                    remedy: "give the inlet the spacing of the body, or the flow has another density",
                });
            }
        }
        for (what, value, must_be) in self.outlets.iter().flat_map(Outlet::problems) {
            problems.push(Problem::Parameter {
                what: format!("{what} of an outlet"),
                value,
                must_be,
            });
        }
    }

    fn check_walls(&self, problems: &mut Vec<Problem>) {
        let spacing = self.bodies.first().map_or(0.0, |body| body.spacing);
        for (k, wall) in self.walls.iter().enumerate() {
            if self.scheme.liquid.is_none() {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "wall `{}` is made of particles, which the scheme {} does not see",
                        wall.name, self.scheme.name
                    ),
                    remedy: "take a scheme of liquids (schemes::weakly_compressible), or a MirrorPlane",
                });
            }
            if self.scheme.kicks_density()
                && wall.slip == Slip::None
                && self.scheme.fields().contains(Field::DynamicViscosity)
            {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the scheme {} sums forces and compression in one sweep, and the velocity that makes a \
                         liquid stick to wall `{}` belongs to the forces alone",
                        self.scheme.name, wall.name
                    ),
                    remedy: "take LiquidBuilder::compose, or leave out Wall::no_slip",
                });
            }
            let names = self.bodies.iter().map(|body| &body.name);
            let earlier = self.walls[..k].iter().map(|wall| &wall.name);
            if names.chain(earlier).any(|name| *name == wall.name) {
                problems.push(Problem::Incompatible {
                    what: format!("two bodies or walls are called `{}`", wall.name),
                    remedy: "give every body and wall a name of its own",
                });
            }
            let mut parameter = |what: &str, value: f64, must_be: &'static str| {
                problems.push(Problem::Parameter {
                    what: format!("{what} of wall `{}`", wall.name),
                    value,
                    must_be,
                });
            };
            if let Err((what, value, must_be)) = wall.shape {
                parameter(what, value, must_be);
                continue;
            }
            if let Some(&bad) = wall.points.iter().flatten().find(|x| !x.is_finite()) {
                parameter("position", bad, "it must be finite, in metres");
            }
            // A lattice that is fitted to a box is stretched by less than half a particle in a row.
            let off = (wall.spacing - spacing).abs();
            if off.is_nan() || off > 0.1 * spacing {
                parameter(
                    "spacing",
                    wall.spacing,
                    "it must be that of the liquid: fill both on one lattice",
                );
            }
            let pose = wall.motion.as_ref().map(|motion| motion.pose(0.0));
            let finite = |pose: &Pose<D>| {
                (0..3).all(|order| {
                    let shift = pose.shift[order].iter();
                    shift
                        .chain(pose.linear[order].iter())
                        .all(|x| x.is_finite())
                })
            };
            if pose.as_ref().is_some_and(|pose| !finite(pose)) {
                parameter(
                    "motion at t = 0",
                    f64::NAN,
                    "position, velocity and acceleration must be finite: look for gaps in its table",
                );
            }
            if wall.points.is_empty() {
                problems.push(Problem::EmptyBody {
                    body: wall.name.clone(),
                });
            }
        }
        let bad = |load: &Load<D>| load(0.0).into_iter().find(|a| !a.is_finite());
        if let Some(value) = self.loads.iter().find_map(bad) {
            problems.push(Problem::Parameter {
                what: "acceleration at t = 0".into(),
                value,
                must_be: "it must be finite, in m/s²",
            });
        }
    }

    /// Finds walls that liquid overlaps, and walls that are thinner than the kernel reaches.
    fn check_wall_places(&self, problems: &mut Vec<Problem>) {
        let Some(spacing) = self.bodies.first().map(|body| body.spacing) else {
            return;
        };
        let liquid: Vec<[f64; D]> = self
            .bodies
            .iter()
            .flat_map(|body| body.points.iter().copied())
            .collect();
        let reach = self.scheme.kernel.support * self.scheme.h_over_dx * spacing;
        let near = |points: &[[f64; D]], cells: &Cells<D>, x: &[f64; D], within: f64| {
            let mut best: Option<(usize, f64)> = None;
            cells.for_each_run(x.map(|x| x - within), x.map(|x| x + within), |run| {
                for &j in run {
                    let r2: f64 = (0..D).map(|d| (points[j as usize][d] - x[d]).powi(2)).sum();
                    if r2 < within * within && best.is_none_or(|(_, least)| r2 < least) {
                        best = Some((j as usize, r2));
                    }
                }
            });
            best
        };
        let every: Vec<u32> = (0..liquid.len() as u32).collect();
        let liquid_cells = Cells::build(&liquid, &every, spacing);
        let solid: Vec<[f64; D]> = self
            .walls
            .iter()
            .flat_map(|wall| wall.points.iter().copied())
            .collect();
        let every: Vec<u32> = (0..solid.len() as u32).collect();
        let solid_cells = Cells::build(&solid, &every, spacing);
        for wall in &self.walls {
            let (mut faces, mut thin) = (0_usize, 0_usize);
            for x in &wall.points {
                let Some((j, r2)) = near(&liquid, &liquid_cells, x, 1.2 * spacing) else {
                    continue;
                };
                let distance = r2.sqrt();
                if distance < TOO_CLOSE * spacing {
                    problems.push(Problem::Overlap {
                        first: wall.name.clone(),
                        second: self.bodies[0].name.clone(),
                        distance,
                        spacing,
                        position: x.to_vec(),
                    });
                    return;
                }
                // Straight on from the liquid: is there wall as far as the kernel of that liquid reaches?
                faces += 1;
                let along: [f64; D] = core::array::from_fn(|d| (x[d] - liquid[j][d]) / distance);
                let depth = reach - distance - 0.5 * spacing;
                let end = core::array::from_fn(|d| x[d] + along[d] * depth.max(0.0));
                thin += usize::from(near(&solid, &solid_cells, &end, 0.9 * spacing).is_none());
            }
            if 2 * thin > faces {
                problems.push(Problem::ThinWall {
                    wall: wall.name.clone(),
                    reach,
                    layers: (reach / spacing).ceil() as usize,
                });
            }
        }
    }

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
