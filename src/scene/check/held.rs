//! What can be wrong with clamps and rigid bodies.
//! They are of bodies that there are, hold something, and are solids.

use crate::boundary::Boundary;
use crate::error::Problem;
use crate::scalar::Real;
use crate::scene::Scene;
use crate::tensor::{Matrix, Vector};

/// Whether the images of a boundary are shifted by what does not change, and are no more.
fn shifts<const D: usize>(boundary: &dyn Boundary<D>) -> bool {
    let images = (0..boundary.images()).map(|k| boundary.transform(k, 0.0));
    let mut shifts = images.map(|own| {
        own.rotation == Matrix::<f64, D>::identity() && own.velocity == Vector::<f64, D>::zeros()
    });
    !boundary.moves() && shifts.all(|shifts| shifts)
}

impl<T: Real, const D: usize> Scene<T, D> {
    pub(super) fn check_held(&self, problems: &mut Vec<Problem>) {
        let mut incompatible = |what: String, remedy| {
            problems.push(Problem::Incompatible { what, remedy });
        };
        for own in &self.clamps {
            let Some((group, body)) = self.place_of(&own.body) else {
                continue;
            };
            let part = &self.parts[group];
            if part.scheme.meets_walls() {
                incompatible(
                    format!("particles of body `{}`, a liquid, are clamped", own.body),
                    "make a wall of what does not flow (Scene::wall)",
                );
            }
            let (held, all) = (
                own.particles(&part.bodies[body].points).len(),
                part.bodies[body].points.len(),
            );
            if held == 0 {
                incompatible(
                    format!("a clamp of body `{}` holds none of its particles", own.body),
                    "choose a region that contains some: it gets initial positions, in metres",
                );
            }
            if self.rigid.contains(&own.body) && held != all {
                incompatible(
                    format!(
                        "body `{}` is rigid, and particles of it are clamped: {held} of {all}",
                        own.body
                    ),
                    "clamp all of it to give it a motion, or leave the clamp out",
                );
            }
        }
        for body in &self.rigid {
            let Some((group, _)) = self.place_of(body) else {
                continue;
            };
            if self.parts[group].scheme.meets_walls() {
                incompatible(
                    format!("body `{body}`, a liquid, is rigid"),
                    "give it a group of a scheme of solids",
                );
            }
            if !self.integrator.kicks() || !self.integrator.drifts() {
                incompatible(
                    format!(
                        "the integrator {} does not step by kicks and drifts, in which body `{body}` turns",
                        self.integrator.name()
                    ),
                    "take KickDriftKick",
                );
            }
            if let Some(boundary) = self.boundaries.iter().find(|own| !shifts(&***own)) {
                incompatible(
                    format!(
                        "body `{body}` is rigid in a scene with the boundary {}, whose images rotate or move, and \
                         not with the body",
                        boundary.name()
                    ),
                    "bound the scene by walls of particles (Scene::wall), which it meets by a contact that Scene::couple \
                     names, or leave Scene::rigid out and give it an elastic material",
                );
            }
        }
        let walls = self.walls.iter();
        let walls = walls.map(|own| (format!("wall `{}`", own.name), &own.motion));
        let clamps = self.clamps.iter();
        let clamps = clamps.map(|own| (format!("a clamp of body `{}`", own.body), &own.motion));
        for (whose, motion) in walls.chain(clamps) {
            let Some(motion) = motion else { continue };
            let [first, last] = motion.span();
            if !(first..=last).contains(&0.0) {
                problems.push(Problem::Parameter {
                    what: format!("first time of the motion of {whose} ({})", motion.name()),
                    value: first,
                    must_be: "a run starts at t = 0, before its first row: give rows from t = 0 on, or let it \
                    rest there by Recorded::at_rest_beyond",
                });
            }
        }
        let named = self.clamps.iter().map(|own| &own.body).chain(&self.rigid);
        for body in named.filter(|body| self.place_of(body).is_none()) {
            problems.push(self.unknown_body(body));
        }
    }
}
