//! A scene of the library from what a scene file says.
//! All faults of a file are found together, as far as they do not follow from each other.

mod bodies;
mod materials;
pub mod schemes;
mod shapes;
mod tables;
mod walls;

use crate::fault::{Fault, Faults, Source};
use crate::format::{Interaction, SceneFile};
use meshfree::boundary::Translation;
use meshfree::coupling::ContactDensity;
use meshfree::error::{Error, Problem};
use meshfree::prelude::{Boundary, Motion, Scene, Scheme};
use meshfree::simulation::StepControl;
use meshfree::sweep;
use std::any::Any;
use std::path::Path;

/// What one part of a file becomes.
pub type Part<V> = Result<V, Fault>;

/// The folder in which files are looked for, and what is wrong so far.
pub(crate) struct Builder<'a, const D: usize> {
    file: &'a SceneFile,
    folder: &'a Path,
    faults: Vec<Fault>,
}

impl<const D: usize> Builder<'_, D> {
    /// A part that is right, or one more fault, unless another part has told it.
    fn keep<V>(&mut self, part: Part<V>) -> Option<V> {
        let tell = |fault| {
            if !self.faults.contains(&fault) {
                self.faults.push(fault);
            }
        };
        part.map_err(tell).ok()
    }
}

/// The numbers of a vector.
pub(crate) fn vector<const D: usize>(numbers: &[f64], field: &str) -> Part<[f64; D]> {
    numbers.try_into().map_err(|_| {
        let text = format!(
            "has {} numbers, and the scene {D} dimensions: give one for each",
            numbers.len()
        );
        Fault::new(field, text)
    })
}

/// Refuses what there is in three dimensions alone.
pub(crate) fn only_in_space<const D: usize>(field: &str) -> Part<()> {
    if D == 3 {
        return Ok(());
    }
    let text =
        format!("is for three dimensions, and the scene has {D}: take another, or leave it out");
    Err(Fault::new(field, text))
}

/// The same value in the dimension of the scene, if that is its own.
pub(crate) fn in_space<const D: usize, A: 'static, B: 'static>(own: A, field: &str) -> Part<B> {
    let any: Box<dyn Any> = Box::new(own);
    match any.downcast::<B>() {
        Ok(own) => Ok(*own),
        Err(_) => Err(only_in_space::<D>(field)
            .err()
            .unwrap_or(Fault::new(field, "has no place here"))),
    }
}

/// The only one of several keys that is given.
pub(crate) fn only_one(given: &[(&str, bool)], field: &str) -> Part<()> {
    let names: Vec<_> = given.iter().map(|(name, _)| format!("`{name}`")).collect();
    let present: Vec<_> = given.iter().filter(|own| own.1).map(|own| own.0).collect();
    match present[..] {
        [_] => Ok(()),
        [] => Err(Fault::new(
            field,
            format!("lacks one of {}: give it", names.join(", ")),
        )),
        _ => {
            let text = format!(
                "has `{}` together: give only one of them",
                present.join("` and `")
            );
            Err(Fault::new(field, text))
        }
    }
}

/// The scene of a file, checked as a whole.
///
/// # Errors
/// All that is wrong, with lines.
pub fn scene<const D: usize>(
    source: &Source,
    file: &SceneFile,
    scheme: Scheme<f64, D>,
) -> Result<Scene<f64, D>, Faults> {
    let mut builder = Builder {
        file,
        folder: source.path().parent().unwrap_or(Path::new("")),
        faults: Vec::new(),
    };
    let scene = builder.scene(scheme);
    let mut faults = builder.faults;
    if faults.is_empty() {
        let problems = scene.problems();
        faults.extend(problems.iter().map(|own| fault_of(source, own)));
    }
    if faults.is_empty() {
        Ok(scene)
    } else {
        Err(source.faults(faults))
    }
}

impl<const D: usize> Builder<'_, D> {
    fn scene(&mut self, scheme: Scheme<f64, D>) -> Scene<f64, D> {
        let file = self.file;
        let layers = (scheme.kernel().support * scheme.h_over_dx()).ceil() as usize;
        let mut scene = Scene::new(scheme);
        let gravity = file.gravity.as_ref().map(|own| vector(own, "gravity"));
        let gravity = gravity.and_then(|own| self.keep(own));
        if let Some(gravity) = gravity {
            scene = scene.acceleration(move |_| gravity);
        }
        for name in file.material.keys() {
            let material = self.material(name, "material");
            self.keep(material);
        }
        for (k, table) in file.acceleration.iter().enumerate() {
            let field = format!("acceleration[{k}]");
            let motion = self.accelerated(table, &field);
            if let Some(motion) = self.keep(motion) {
                scene = scene.acceleration(move |time| motion.pose(time).shift[2].into());
            }
        }
        for k in 0..file.body.len() {
            if let Some(body) = self.body(k, gravity) {
                scene = scene.body(body);
                scene = self.held(k, scene);
            }
        }
        for k in 0..file.wall.len() {
            let wall = self.wall(k, layers);
            if let Some(wall) = self.keep(wall) {
                scene = scene.wall(wall);
            }
        }
        scene = self.boundaries(scene);
        for (k, own) in file.between.iter().enumerate() {
            let interaction = match own.interaction {
                Interaction::Bonded => sweep::Interaction::Bonded,
                Interaction::Unilateral => sweep::Interaction::Unilateral,
                Interaction::None => sweep::Interaction::None,
                Interaction::Contact => {
                    let contact = ContactDensity::new().friction(own.friction.unwrap_or(0.0));
                    scene = scene.couple(&own.first, &own.second, contact);
                    continue;
                }
            };
            if own.friction.is_some() {
                let text = "is for the interaction `contact`: take that, or leave it out";
                self.faults
                    .push(Fault::new(format!("between[{k}].friction"), text));
            }
            scene = scene.between(&own.first, &own.second, interaction);
        }
        if let Some(steps) = &file.steps {
            scene = scene.steps(|control| StepControl {
                courant: steps.courant.unwrap_or(control.courant),
                fixed: steps.fixed,
                ..control
            });
            scene = scene.step_ends_at(steps.end_at.iter().copied());
        }
        self.check_end();
        scene
    }

    /// An acceleration by rows of a table.
    fn accelerated(&self, table: &crate::format::Table, field: &str) -> Part<Translation<D>> {
        let rows = self.rows::<D>(table, field)?;
        Translation::from_acceleration(&rows).map_err(Fault::of(field))
    }

    /// The end of the run, which a scene does not know.
    fn check_end(&mut self) {
        let until = self.file.run.until;
        if !(until.is_finite() && until > 0.0) {
            let text = format!("is {until}: it must be finite and positive, in seconds");
            self.faults.push(Fault::new("run.until", text));
        }
    }
}

/// A boundary, unless its numbers make none.
pub(crate) fn sound<const D: usize, B: Boundary<D>>(boundary: B, field: &str) -> Part<B> {
    // What depends on the reach of the kernel the scene checks.
    match boundary.problems(0.0).first() {
        Some(problem) => Err(Fault::of_part(field, *problem)),
        None => Ok(boundary),
    }
}

/// Problems of a scene, at the fields of the file that they name.
///
/// The library knows bodies, walls and quantities by their names, and not where the file has them.
#[must_use]
pub fn faults_of(source: &Source, error: &Error) -> Faults {
    let list = match error {
        Error::Build(own) => own
            .problems
            .iter()
            .map(|own| fault_of(source, own))
            .collect(),
        Error::Argument(own) => vec![fault_of(source, own)],
        other => vec![Fault::new("", other)],
    };
    source.faults(list)
}

fn fault_of(source: &Source, problem: &Problem) -> Fault {
    let text = problem.to_string();
    let mut names = text.split('`').skip(1).step_by(2);
    let entry = names.find_map(|name| source.entry_called(name));
    let field = match problem {
        Problem::SmoothingRatio { .. } => source.key_named("scheme", "h over dx"),
        Problem::StepAboveLimit { .. } => Some("steps.fixed".to_owned()),
        Problem::UnknownName { name, .. } => source.field_of_text(name),
        Problem::ThinWall { .. } => {
            let layers = entry.as_ref().map(|entry| format!("{entry}.layers"));
            layers.filter(|field| source.has(field)).or(entry)
        }
        Problem::Parameter { what, .. } if what.starts_with("acceleration at") => {
            Some("gravity".to_owned())
        }
        _ => entry.or_else(|| {
            let tables = ["scheme", "steps"];
            tables
                .iter()
                .find_map(|table| source.key_named(table, &text))
        }),
    };
    let text = match problem {
        // The library says it in Rust.
        Problem::ContactNotNamed { body, wall, .. } => format!(
            "body `{body}` meets wall `{wall}`, and the file does not say how: add `[[between]]` of the two with the \
             interaction \"contact\", and its `friction` where it rubs, or \"none\" if they never meet"
        ),
        _ => text,
    };
    Fault::new(field.unwrap_or_default(), text)
}
