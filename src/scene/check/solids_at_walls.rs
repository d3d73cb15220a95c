//! What can be wrong where solids meet walls of particles: contact that is not named, and couplings that walls cannot have.
//! A liquid meets all walls by the wall law of its scheme.

use crate::error::Problem;
use crate::scalar::Real;
use crate::scene::{Body, Part, Scene};
use crate::sweep::Interaction;

impl<T: Real, const D: usize> Scene<T, D> {
    pub(super) fn check_solids_at_walls(&self, problems: &mut Vec<Problem>) {
        for part in &self.parts {
            let bodies = part.bodies.iter();
            for body in bodies.filter(|body| self.may_meet_walls(part, body)) {
                for wall in &self.walls {
                    let (body, wall) = (&body.name, &wall.name);
                    let said = self.said_between(body, wall) == Some(Interaction::None);
                    if !said && self.coupling(body, wall).is_none() {
                        problems.push(Problem::ContactNotNamed {
                            body: body.clone(),
                            scheme: part.scheme.name.clone(),
                            wall: wall.clone(),
                        });
                    }
                }
            }
        }
        for (first, second, interaction) in &self.contacts {
            let what = format!("the interaction of `{first}` and `{second}` is given");
            self.check_wall_of_pair(first, second, &what, problems);
            let walls = [first, second].map(|name| self.wall_number(name).is_some());
            if walls.contains(&true) && *interaction != Interaction::None {
                problems.push(Problem::Incompatible {
                    what: format!("{what} as {interaction:?}, and one is a wall of particles"),
                    remedy: "name their contact with Scene::couple; for a wall Scene::between takes only \
                    Interaction::None",
                });
            }
        }
        for own in &self.couplings {
            let (first, second) = (&own.first, &own.second);
            let name = own.coupling.name();
            let what = format!("the coupling {name} of `{first}` and `{second}`");
            self.check_wall_of_pair(first, second, &what, problems);
            let mut incompatible = |fault: &str, remedy| {
                let what = format!("{what} {fault}");
                problems.push(Problem::Incompatible { what, remedy });
            };
            if self.wall_number(first).is_some() && self.place_of(second).is_some() {
                incompatible(
                    "names a wall of particles first",
                    "name the body first and the wall second: no force moves a wall",
                );
            }
            if self.wall_number(second).is_some() && own.coupling.is_wall() {
                incompatible(
                    "makes a wall of a wall of particles, which already is one for all liquids",
                    "leave it out, or take a contact (ContactDensity, Penalty)",
                );
            }
        }
    }

    /// Whether a body is a solid of which particles are free to move.
    fn may_meet_walls(&self, part: &Part<T, D>, body: &Body<T, D>) -> bool {
        if part.scheme.meets_walls() || self.walls.is_empty() {
            return false;
        }
        let mut free = vec![true; body.points.len()];
        let clamps = self.clamps.iter();
        for own in clamps.filter(|own| own.body == body.name && own.is_for_good()) {
            for (k, _) in own.particles(&body.points) {
                free[k as usize] = false;
            }
        }
        free.contains(&true)
    }

    /// What is said of a wall and something else: that must be a solid.
    fn check_wall_of_pair(
        &self,
        first: &str,
        second: &str,
        what: &str,
        problems: &mut Vec<Problem>,
    ) {
        let is_wall = |name| self.wall_number(name).is_some();
        let is_liquid = |name| {
            let place = self.place_of(name);
            place.is_some_and(|(group, _)| self.parts[group].scheme.meets_walls())
        };
        if is_wall(first) && is_wall(second) {
            problems.push(Problem::Incompatible {
                what: format!("{what}, and both are walls of particles"),
                remedy: "leave it out: walls move as prescribed",
            });
        } else if (is_wall(first) && is_liquid(second)) || (is_liquid(first) && is_wall(second)) {
            problems.push(Problem::Incompatible {
                what: format!("{what}, and one is a liquid and the other a wall of particles"),
                remedy: "leave it out: liquids meet walls by the wall law of their scheme",
            });
        }
    }
}
