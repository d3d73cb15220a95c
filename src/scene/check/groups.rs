//! What can be wrong between groups: bodies of different schemes that nothing couples.
//! A liquid meets structures; all else has to be said not to meet.

use crate::error::Problem;
use crate::scalar::Real;
use crate::scene::{Body, Part, Scene};
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
        let said = self.said_between(&first.name, &second.name);
        let liquids = [own, other].map(|part| part.scheme.meets_walls());
        let coupled = liquids[0] != liquids[1];
        let remedy = match said {
            Some(Interaction::None) => return,
            Some(Interaction::Bonded) if coupled => {
                "leave it out: a liquid presses on a structure and parts from it; to take the coupling away, \
                 say Interaction::None between the two"
            }
            _ if coupled => return,
            _ => {
                "give both to one group; if they never meet, say Interaction::None between the two"
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
}
