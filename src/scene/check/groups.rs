//! What can be wrong between groups: bodies of different schemes that nothing couples, couplings and sub-cycling.
//! A liquid meets structures; all else is coupled by the scene, or the scene says that it does not meet.

use super::TOO_CLOSE;
use super::doubled::nearest_pair;
use crate::error::Problem;
use crate::scalar::Real;
use crate::scene::{Body, Coupled, Part, Scene};
use crate::sweep::Interaction;

impl<T: Real, const D: usize> Scene<T, D> {
    pub(super) fn check_groups(&self, problems: &mut Vec<Problem>) {
        for (k, part) in self.parts.iter().enumerate() {
            if part.bodies.is_empty() && self.parts.len() > 1 {
                problems.push(Problem::Incompatible {
                    what: format!("the group of the scheme {} has no bodies", part.scheme.name),
                    remedy: "add bodies to it, or make their scheme that of the scene",
                });
            }
            for other in &self.parts[k + 1..] {
                let with = |first| other.bodies.iter().map(move |second| (first, second));
                for (first, second) in part.bodies.iter().flat_map(with) {
                    self.check_coupling((part, first), (other, second), problems);
                }
            }
        }
    }

    /// What two bodies of different groups do to each other.
    fn check_coupling(
        &self,
        (own, first): (&Part<T, D>, &Body<T, D>),
        (other, second): (&Part<T, D>, &Body<T, D>),
        problems: &mut Vec<Problem>,
    ) {
        if self.coupling(&first.name, &second.name).is_some() {
            return;
        }
        let said = self.said_between(&first.name, &second.name);
        let liquids = [own, other].map(|part| part.scheme.meets_walls());
        let coupled = liquids[0] != liquids[1];
        let remedy = match said {
            Some(Interaction::None) => return,
            Some(Interaction::Bonded) if coupled => {
                "leave it out: a liquid presses on a structure and separates from it; to take the coupling away, \
                 say Interaction::None between the two"
            }
            _ if coupled => return,
            _ => {
                "give both to one group, or couple them by Scene::couple; if they never meet, say \
                 Interaction::None between the two"
            }
        };
        problems.push(Problem::Incompatible {
            what: format!(
                "bodies `{}` and `{}` obey the schemes {} and {}, and nothing couples them{}",
                first.name,
                second.name,
                own.scheme.name,
                other.scheme.name,
                if coupled { " as bonded" } else { "" }
            ),
            remedy,
        });
    }

    /// Couplings that the scene names.
    pub(super) fn check_couplings(&self, problems: &mut Vec<Problem>) {
        for own in &self.couplings {
            let (name, coupling) = (own.coupling.name(), &own.coupling);
            for (what, value, must_be) in coupling.problems() {
                problems.push(Problem::Parameter {
                    what: format!("{what} of the coupling {name}"),
                    value,
                    must_be,
                });
            }
            let walls = [&own.first, &own.second].map(|name| self.wall_number(name).is_some());
            if walls.contains(&true) {
                self.check_reach_to_wall(own, problems);
                continue;
            }
            let sides = [&own.first, &own.second].map(|body| self.known_place(body, problems));
            let [Some(first), Some(second)] = sides else {
                continue;
            };
            let mut incompatible = |what: &str, remedy| {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the coupling {name} of `{}` and `{}` {what}",
                        own.first, own.second
                    ),
                    remedy,
                });
            };
            let liquid = self.parts[first.0].scheme.meets_walls();
            if first == second && own.exclusion.to_bits() == 0 && !coupling.as_built() {
                incompatible(
                    "names one body twice",
                    "give the initial distance from which on a body can meet itself, with Scene::couple_self",
                );
                continue;
            }
            if first == second && liquid {
                incompatible(
                    "is of a liquid with itself",
                    "leave it out: the kernels of a liquid already act wherever it meets itself",
                );
                continue;
            }
            if first.0 == second.0 && coupling.is_wall() {
                incompatible(
                    "is between bodies of one group",
                    "say what they do to each other by Scene::between, or give one of them a group of its own",
                );
                continue;
            }
            let liquids = [first, second].map(|(group, _)| self.parts[group].scheme.meets_walls());
            if coupling.is_wall() && liquids != [true, false] {
                incompatible(
                    "makes the second a wall of the first",
                    "name a body of a scheme of liquids first, and one of another scheme second",
                );
            }
            let spacings =
                [first, second].map(|(group, body)| self.parts[group].bodies[body].spacing);
            let reach = coupling.reach(spacings);
            if !(reach.is_finite() && reach >= 0.0) {
                problems.push(Problem::Parameter {
                    what: format!("reach of the coupling {name}"),
                    value: reach,
                    must_be: "it must be finite and not negative, in metres",
                });
            } else if reach == 0.0 && !coupling.is_wall() {
                incompatible(
                    "makes no wall and has no reach",
                    "give it a reach (Coupling::reach), or say Interaction::None between the two",
                );
            }
            let built = first == second && !coupling.as_built();
            if built && !(own.exclusion.is_finite() && own.exclusion >= reach) {
                problems.push(Problem::Parameter {
                    what: format!(
                        "distance as built from which on the coupling {name} lets body `{}` meet itself",
                        own.first
                    ),
                    value: own.exclusion,
                    must_be: "it must be finite, in metres, and no less than the reach of the coupling, or the \
                              body presses on itself from the start",
                });
            }
        }
    }

    /// The reach of a coupling with a wall of particles.
    fn check_reach_to_wall(&self, own: &Coupled<T, D>, problems: &mut Vec<Problem>) {
        let sides =
            [&own.first, &own.second].map(|name| self.side_of(name, &[0.0; D]).map(|side| side.2));
        let [Some(first), Some(second)] = sides else {
            for name in [&own.first, &own.second] {
                if self.wall_number(name).is_none() {
                    self.known_place(name, problems);
                }
            }
            return;
        };
        let reach = own.coupling.reach([first, second]);
        let acts = own.coupling.is_wall() || (reach.is_finite() && reach > 0.0);
        if !acts {
            problems.push(Problem::Parameter {
                what: format!("reach of the coupling {}", own.coupling.name()),
                value: reach,
                must_be: "it must be finite and positive, in metres: contact with a wall of particles is by forces",
            });
        }
    }

    /// Bodies of different groups, or a body and a wall, that are coupled by forces and start in each other.
    pub(super) fn check_coupled_places(&self, problems: &mut Vec<Problem>) {
        for own in &self.couplings {
            let sides = [&own.first, &own.second].map(|body| self.place_of(body));
            // Bodies of one group are looked at with it, and walls of liquids with these.
            let [first, second] = sides.map(|place| place.map(|(group, _)| group));
            if first == second || own.coupling.is_wall() {
                continue;
            }
            let sides = [&own.first, &own.second].map(|name| self.side_of(name, &[0.0; D]));
            let [Some((.., near, own_points)), Some((.., far, points))] = sides else {
                continue;
            };
            let spacing = 0.5 * (near + far);
            if let Some((distance, position)) =
                nearest_pair(&points, &own_points, spacing, TOO_CLOSE)
            {
                problems.push(Problem::Overlap {
                    first: own.first.clone(),
                    second: own.second.clone(),
                    distance,
                    spacing,
                    position: position.to_vec(),
                });
            }
        }
    }

    /// Groups that take steps of their own.
    pub(super) fn check_sub_cycles(&self, problems: &mut Vec<Problem>) {
        for (body, count) in &self.sub_cycled {
            let place = self.known_place(body, problems);
            if *count == 0 {
                problems.push(Problem::Parameter {
                    what: format!("number of steps of the group of body `{body}`"),
                    value: 0.0,
                    must_be: "it must be one or more",
                });
            }
            let Some((group, _)) = place else {
                continue;
            };
            let mut incompatible = |what: String, remedy| {
                problems.push(Problem::Incompatible { what, remedy });
            };
            if self.parts[group].scheme.meets_walls() {
                incompatible(
                    format!("body `{body}` is a liquid, whose walls move with the others' steps"),
                    "let the group of the solid sub-cycle",
                );
            }
            if self.parts.len() == 1 {
                incompatible(
                    format!("body `{body}` is of the only group"),
                    "leave Scene::sub_cycle out: there is no other group with longer steps",
                );
            }
            if !self.integrator.kicks() || !self.integrator.drifts() {
                incompatible(
                    format!(
                        "the integrator {} does not step by kicks and drifts, between which groups sub-cycle",
                        self.integrator.name()
                    ),
                    "take KickDriftKick, or leave Scene::sub_cycle out",
                );
            }
        }
    }

    /// Where a body is, or the problem that there is none.
    fn known_place(&self, body: &str, problems: &mut Vec<Problem>) -> Option<(usize, usize)> {
        let place = self.place_of(body);
        if place.is_none() {
            problems.push(self.unknown_body(body));
        }
        place
    }
}
