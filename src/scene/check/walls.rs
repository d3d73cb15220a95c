//! What can be wrong with walls, inlets and outlets: their own numbers,
//! whether scheme and liquid go with them, and where walls lie.

use super::TOO_CLOSE;
use crate::boundary::{Outlet, Pose, Wall};
use crate::error::Problem;
use crate::neighbors::Cells;
use crate::scalar::Real;
use crate::scene::Scene;
use crate::scene::plan::{Origin, Plan};

/// Share by which the spacing of an inlet may differ from that of its body, as the density that enters.
const SAME_SPACING: f64 = 1e-3;

impl<T: Real, const D: usize> Scene<T, D> {
    /// Inlets and outlets.
    pub(super) fn check_openings(&self, problems: &mut Vec<Problem>) {
        for inlet in &self.inlets {
            for (what, value, must_be) in inlet.problems() {
                problems.push(Problem::Parameter {
                    what: format!("{what} of the inlet of body `{}`", inlet.body),
                    value,
                    must_be,
                });
            }
            let fed = self.parts.iter().find_map(|part| {
                let mut bodies = part.bodies.iter();
                let body = bodies.find(|body| body.name == inlet.body)?;
                Some((&part.scheme, body))
            });
            let Some((scheme, body)) = fed else {
                problems.push(self.unknown_body(&inlet.body));
                continue;
            };
            if !scheme.meets_walls() {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the inlet of body `{}` has a buffer of wall particles, which the scheme {} does not see",
                        inlet.body, scheme.name
                    ),
                    remedy: "take a scheme of liquids (schemes::weakly_compressible)",
                });
            }
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
        self.check_buffers(problems);
        for (what, value, must_be) in self.outlets.iter().flat_map(Outlet::problems) {
            problems.push(Problem::Parameter {
                what: format!("{what} of an outlet"),
                value,
                must_be,
            });
        }
    }
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// Whether schemes and buffers of outlets go together.
    fn check_buffers(&self, problems: &mut Vec<Problem>) {
        let buffers = || self.outlets.iter().filter_map(Outlet::open);
        for part in self.parts.iter().filter(|_| buffers().next().is_some()) {
            let scheme = &part.scheme;
            if !scheme.meets_walls() || !scheme.density.is_integrated() {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "an outlet has a buffer of given density, and the scheme {} does not integrate the \
                         density of a liquid",
                        scheme.name
                    ),
                    remedy: "take a scheme of liquids (schemes::weakly_compressible), or an outlet without a buffer",
                });
                continue;
            }
            let widest = part
                .bodies
                .iter()
                .map(|body| body.spacing)
                .fold(0.0, f64::max);
            let reach = scheme.kernel.support * scheme.h_over_dx * widest;
            for (_, _, buffer) in buffers().filter(|own| own.2.depth < reach) {
                problems.push(Problem::Parameter {
                    what: "depth of the buffer of an outlet".into(),
                    value: buffer.depth,
                    must_be: "it must be as much as the kernel reaches, its support times h, or the end acts on \
                    the liquid inside: make it deeper",
                });
            }
        }
    }
}

impl<T: Real, const D: usize> Plan<'_, T, D> {
    pub(super) fn check_walls(&self, problems: &mut Vec<Problem>) {
        let spacing = self.bodies.first().map_or(0.0, |body| body.spacing);
        for (k, (wall, origin)) in self.walls.iter().enumerate() {
            // The buffers of inlets, which are numbered after the walls, face nothing.
            if self.scheme.program.wall_normals
                && matches!(origin, Origin::Wall(k) if *k < self.scene.walls.len())
                && wall.fluid_side.is_none()
            {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the wall law of the scheme {} needs normals, and wall `{}` has no container of the \
                         liquid",
                        self.scheme.name, wall.name
                    ),
                    remedy: "give it the container of the liquid, Wall::fluid_side, or take ExtrapolatedPressure",
                });
            }
            let names = self.scene.bodies().map(|body| &body.name);
            let earlier = self.walls[..k].iter().map(|(wall, _)| &wall.name);
            let named = matches!(origin, Origin::Wall(_));
            if named && names.chain(earlier).any(|name| *name == wall.name) {
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
            if let Some(&bad) = wall.sliding.iter().find(|v| !v.is_finite()) {
                parameter("velocity", bad, "it must be finite, in m/s");
            }
            // A lattice that is fitted to a box is stretched by less than half a particle in a row.
            let off = wall.spacing - spacing;
            let fine = match origin {
                Origin::Structure(..) => off < 0.0,
                // What no liquid meets may have any spacing.
                Origin::Wall(_) => !self.scheme.meets_walls() && wall.spacing > 0.0,
            };
            if off.is_nan() || (off.abs() > 0.1 * spacing && !fine) {
                let must_be = match origin {
                    Origin::Wall(_) => "it must be that of the liquid: fill both on one lattice",
                    Origin::Structure(..) => "it must be at most that of the liquid that meets it",
                };
                parameter("spacing", wall.spacing, must_be);
            }
            // What has no place yet is told with its span.
            let motion = wall.motion.as_ref().filter(|own| own.span()[0] <= 0.0);
            let pose = motion.map(|motion| motion.pose(0.0));
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
                    "position, velocity and acceleration must be finite: check its table for gaps",
                );
            }
            if wall.points.is_empty() {
                problems.push(Problem::EmptyBody {
                    body: wall.name.clone(),
                });
            }
        }
    }

    /// Finds walls that liquid overlaps, and walls that are thinner than the kernel reaches.
    pub(super) fn check_wall_places(&self, problems: &mut Vec<Problem>) {
        let Some(spacing) = self.bodies.first().map(|body| body.spacing) else {
            return;
        };
        if !self.scheme.meets_walls() {
            return;
        }
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
        // A motion may have moved a wall by the start.
        let placed = |wall: &Wall<D>| -> Vec<[f64; D]> {
            let pose = wall
                .motion
                .as_ref()
                .map_or(Pose::rest(), |motion| motion.pose(0.0));
            wall.points.iter().map(|x| pose.of(0, x)).collect()
        };
        let solid: Vec<[f64; D]> = self
            .walls
            .iter()
            .flat_map(|(wall, _)| placed(wall))
            .collect();
        let every: Vec<u32> = (0..solid.len() as u32).collect();
        let solid_cells = Cells::build(&solid, &every, spacing);
        for (wall, _) in &self.walls {
            let (mut faces, mut thin) = (0_usize, 0_usize);
            // Lattices that touch are half a spacing of each apart.
            let between = 0.5 * (spacing + wall.spacing.min(spacing));
            for x in &placed(wall) {
                let Some((j, r2)) = near(&liquid, &liquid_cells, x, 1.2 * spacing) else {
                    continue;
                };
                let distance = r2.sqrt();
                if distance < TOO_CLOSE * between {
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
}
