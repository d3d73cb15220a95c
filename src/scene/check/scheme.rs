//! What can be wrong with a scheme and with how it is stepped: what lies outside its range,
//! and what does not go with the integrator, the bodies or the machine.

use crate::boundary::Boundary;
use crate::effect::{SceneFacts, When};
use crate::error::Problem;
use crate::particles::{Field, Outputs, Shape};
use crate::scalar::Real;
use crate::scene::Scene;
use crate::scene::plan::Plan;
use crate::scheme::EnergyForm;
use crate::sweep::Interaction;
use crate::term::Stage;
use std::sync::Arc;

impl<T: Real, const D: usize> Plan<'_, T, D> {
    /// Particles that stay are a lattice that nothing may move through.
    fn check_what_stays(&self, problems: &mut Vec<Problem>) {
        if self.scheme.program.moves {
            return;
        }
        let walls = self.walls.iter().map(|(wall, _)| wall);
        let walls = walls.filter(|wall| wall.motion.is_some());
        let walls = walls.map(|wall| format!("wall `{}`", wall.name));
        let boundaries = self.scene.boundaries.iter().filter(|own| own.moves());
        let moving = walls.chain(boundaries.map(|own| own.name()));
        problems.extend(moving.map(|what| Problem::Incompatible {
            what: format!(
                "{what} moves through particles of the scheme {}, which stay where they are",
                self.scheme.name
            ),
            remedy: "let the container be the frame of the scene (Wall::container_frame) and accelerate what is in it (Scene::acceleration)",
        }));
    }

    pub(in crate::scene) fn check_scheme(&self, problems: &mut Vec<Problem>) {
        let (scheme, kernel) = (&self.scheme, self.scheme.kernel);
        let (lowest, highest) = kernel.range;
        // On a lattice that stays it is enough to reach the particles beside one.
        let lowest = if scheme.program.moves {
            lowest
        } else {
            lowest.min(1.2 / kernel.support)
        };
        if !(lowest..=highest).contains(&scheme.h_over_dx) {
            problems.push(Problem::SmoothingRatio {
                kernel: kernel.name,
                ratio: scheme.h_over_dx,
                lowest,
                highest,
                recommended: kernel.h_over_dx,
            });
        }
        let facts = SceneFacts {
            bodies: self
                .bodies
                .iter()
                .map(|body| (body.name.as_str(), &body.material))
                .collect(),
            integrator: self.scene.integrator.name(),
            kicks: self.scene.integrator.kicks(),
            lengths_vary: scheme.fields().contains(Field::SMOOTHING_LENGTH),
            integrated: scheme.program.integrated(),
            written: scheme.program.written(),
        };
        let parameters = scheme.problems.iter().cloned();
        let parameters = parameters.map(|(what, value, must_be)| Problem::Parameter {
            what,
            value,
            must_be,
        });
        let asked = scheme.program.requirements.iter();
        let asked = asked.filter_map(|requirement| requirement(&facts));
        let mut of_effects: Vec<Problem> = parameters.chain(asked).collect();
        // Not in the order of the list of effects.
        of_effects.sort_by_cached_key(ToString::to_string);
        problems.extend(of_effects);
        self.check_what_stays(problems);
        for (what, value, must_be) in &scheme.kernel_problems {
            problems.push(Problem::Parameter {
                what: format!("{what} of the {} kernel", kernel.name),
                value: *value,
                must_be,
            });
        }
        let moment = scheme.lattice_consistency_factor;
        let known =
            scheme.kernel_problems.is_empty() && (lowest..=highest).contains(&scheme.h_over_dx);
        if known && !(moment.is_finite() && moment > 0.0) {
            problems.push(Problem::Parameter {
                what: format!("first moment of the {} kernel on a lattice", kernel.name),
                value: moment,
                must_be: "it must be finite and positive: h/dx times the support must be between 1 and 32 spacings",
            });
        }
        problems.extend(scheme.misordered());
        self.check_starts(problems);
        let mut incompatible = |what: String, remedy| {
            problems.push(Problem::Incompatible { what, remedy });
        };
        if scheme.energy == EnergyForm::Compatible && !self.scene.integrator.kicks() {
            incompatible(
                format!(
                    "the compatible energy form cannot follow the integrator {}",
                    self.scene.integrator.name()
                ),
                "take EnergyForm::Symmetric, or an integrator that kicks (kick-drift-kick)",
            );
        }
        if scheme.density.is_integrated() && !self.scene.integrator.integrates_density() {
            incompatible(
                format!(
                    "the integrator {} does not integrate density",
                    self.scene.integrator.name()
                ),
                "take a density form that follows from positions, or another integrator",
            );
        }
        let in_drifts = scheme.program.evolved.iter().filter(|own| {
            let mut sums = own.rates.iter().map(|rate| rate.sums());
            let there = scheme.sums(Stage::Rates);
            own.when == When::Drift && sums.any(|sums| sums.minus(there) != Outputs::NONE)
        });
        let in_drifts = in_drifts.map(|own| {
            let name = scheme.program.name_of(own.field);
            format!(
                "the scheme {} sums the rate of {name} in drifts",
                scheme.name
            )
        });
        let laws = &scheme.program.laws[Stage::Continuity.number()];
        let laws = laws
            .iter()
            .map(|law| format!("the law `{}` acts in drifts", law.name()));
        for what in in_drifts
            .chain(laws)
            .filter(|_| !self.scene.integrator.drifts())
        {
            incompatible(
                format!(
                    "{what}, which the integrator {} does not take",
                    self.scene.integrator.name()
                ),
                "take an integrator that drifts (kick-drift-kick)",
            );
        }
        let boundaries = &self.scene.boundaries;
        let leaves = |boundary: &Arc<dyn Boundary<D>>| {
            boundary.moves() || boundary.interaction() == Interaction::Unilateral
        };
        let opens = self.interactions().contains(&Interaction::Unilateral);
        let opens = opens || boundaries.iter().any(leaves);
        if scheme.density.keeps_neighbors() && (opens || self.inlets().next().is_some()) {
            incompatible(
                format!(
                    "the scheme {} keeps its neighbours, and the scene has a contact that opens, a boundary that moves \
                     or an inlet of it",
                    scheme.name
                ),
                "bond the bodies or let them meet by a coupling, and take planes of symmetry (MirrorPlane::symmetry) and \
                 periods that rest",
            );
        }
        // Particles of inlets wait as walls do.
        let prescribed = match (self.walls.first(), self.inlets().next().is_none()) {
            (Some((wall, _)), _) => Some(format!("wall `{}`", wall.name)),
            (None, false) => Some("an inlet".into()),
            (None, true) => None,
        };
        if let Some(prescribed) = prescribed.filter(|_| !self.scene.integrator.kicks()) {
            incompatible(
                format!(
                    "the integrator {} combines states of all particles, and would move those of {prescribed}",
                    self.scene.integrator.name()
                ),
                "take an integrator that kicks (kick-drift-kick), or boundaries of images (MirrorPlane)",
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
                "give all bodies the same spacing, or allow it with the effect MixedSpacing",
            );
        }
    }
}

impl<T: Real, const D: usize> Plan<'_, T, D> {
    /// The fields that bodies give values of, and what effects keep in the ledger.
    fn check_starts(&self, problems: &mut Vec<Problem>) {
        let program = &self.scheme.program;
        for body in self.bodies {
            for start in &body.fields {
                if let Some(problem) = program.cannot_start(start.field, start.components) {
                    problems.push(problem);
                } else if let Some(value) = start.values.iter().find(|value| !value.is_finite()) {
                    problems.push(Problem::Parameter {
                        what: format!("{} of body `{}`", program.name_of(start.field), body.name),
                        value: *value,
                        must_be: "it must be finite",
                    });
                }
            }
        }
        for column in &program.ledger {
            if column.field.shape() != Shape::Scalar {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the ledger is asked for {}, the sum of {}, which is no scalar",
                        column.name,
                        program.name_of(column.field)
                    ),
                    remedy: "let a law write the number to be summed into a scalar field",
                });
            }
        }
    }
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// How steps are chosen, and what they run on.
    pub(super) fn check_steps(&self, problems: &mut Vec<Problem>) {
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
        if let Some(skin) = self.skin {
            positive("skin", skin);
        }
        if let Some(step) = self.control.fixed {
            positive("fixed time step", step);
        }
        if !self.instructions.available() {
            problems.push(Problem::Incompatible {
                what: format!(
                    "this machine, or this build, does not have {:?}",
                    self.instructions
                ),
                remedy: "leave the choice to the scene, or take InstructionSet::Baseline in a build for any machine",
            });
        }
    }
}
