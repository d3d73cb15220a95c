//! What may change between a checkpoint and the scene that resumes from it, and in what the two differ.
//! Nothing changes that is not named, and nothing that the state in the file would not fit.

use crate::output::checkpoint::{Checkpoint, Hashes};
use crate::output::values::Values;
use crate::scene::Described;
use core::fmt;

/// A part of a scene that may be another than that of the run which wrote a checkpoint, for
/// [`Scene::resume_with`](crate::scene::Scene::resume_with).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Change {
    /// How steps are chosen, and the times at which they end.
    Steps,
    /// The integrator.
    Integrator,
    /// Uniform accelerations and loads. What closures do cannot be compared: name it whenever one is another.
    Loads,
    /// Viscosities: the terms of schemes that have the same fields, by the same kernel, density and energy, and the
    /// viscosities and rheologies of materials.
    Viscosity,
    /// Clamps and how they move: what they hold takes their velocity at the restart, from which what they have given counts.
    Motions,
    /// Motions, slip, sliding and places of walls, of which each has as many particles as before.
    Walls,
    /// Outlets.
    Outlets,
    /// Events: one of a name that the file has is as it was there, and another has not happened.
    Events,
}

impl Change {
    /// Whether rates of the file are those of the scene all the same.
    fn keeps_rates(self) -> bool {
        matches!(self, Self::Steps | Self::Outlets | Self::Events)
    }

    /// Whether it covers all that differs in a part.
    fn covers(self, part: &str, all: &[Difference], [file, scene]: [&Values; 2]) -> bool {
        let of_part = || all.iter().filter(|own| own.part == part);
        let each = |is: fn(&Difference) -> bool| of_part().all(is);
        match (self, part) {
            (Self::Steps, "the choice of steps" | "times at which steps end")
            | (Self::Integrator, "the integrator")
            | (Self::Loads, "the loads")
            | (Self::Outlets, "outlets")
            | (Self::Events, "events") => true,
            (Self::Viscosity, "bodies") => each(|own| {
                let is_law = ["viscosity", "rheology"].iter();
                own.what.contains(".material.")
                    && is_law.into_iter().any(|law| own.what.contains(law))
            }),
            // The first line says kernel, density and energy, and another which fields there are.
            (Self::Viscosity, "schemes") => {
                let fixed = |name: &str, line: &str| {
                    name.starts_with("line 1 of") || line.starts_with("carries")
                };
                file.of(fixed) == scene.of(fixed)
            }
            (Self::Motions, "clamps and rigid bodies") => each(|own| own.what != "rigid bodies"),
            (Self::Walls, "walls") => each(|own| {
                own.file.is_some() == own.scene.is_some() && !own.what.ends_with(".particles")
                    || own.what.contains(".motion")
                    || own.what.contains(".slip")
            }),
            _ => false,
        }
    }
}

/// What is other in a scene than in the one that wrote a checkpoint.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Difference {
    /// The part of the scene, as `walls`.
    pub part: &'static str,
    /// What of it.
    pub what: String,
    /// Its value in the file; none if the scene alone has it.
    pub file: Option<String>,
    /// Its value in the scene; none if the file alone has it.
    pub scene: Option<String>,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = &self.what;
        match (&self.file, &self.scene) {
            (Some(file), Some(own)) => {
                write!(f, "{what} is {file} in the file and {own} in the scene")
            }
            (Some(file), None) => write!(f, "{what} is {file} in the file and not in the scene"),
            (None, own) => {
                let own = own.as_deref().unwrap_or_default();
                write!(f, "{what} is {own} in the scene and not in the file")
            }
        }
    }
}

/// What a program allows to be another.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Changes<'a> {
    named: &'a [Change],
    /// Whether rates are found anew, and what an integrator keeps is forgotten.
    pub is_anew: bool,
}

impl<'a> Changes<'a> {
    pub fn new(named: &'a [Change]) -> Self {
        let is_anew = named.iter().any(|own| !own.keeps_rates());
        Self { named, is_anew }
    }
    /// The same where no clamp holds anything, in the file or in the scene: then motions change no rate.
    pub fn without_clamps(self) -> Self {
        let changes = |own: &Change| !own.keeps_rates() && *own != Change::Motions;
        let is_anew = self.named.iter().any(changes);
        Self { is_anew, ..self }
    }
    /// Whether nothing may be another.
    pub fn is_empty(self) -> bool {
        self.named.is_empty()
    }
    pub fn has(self, change: Change) -> bool {
        self.named.contains(&change)
    }
    /// The parts that differ and that nothing named covers.
    pub fn refused(
        self,
        all: &[Difference],
        described: &Described,
        file: &Checkpoint,
    ) -> Vec<&'static str> {
        let mut parts: Vec<&'static str> = all.iter().map(|own| own.part).collect();
        parts.dedup();
        parts.retain(|part| {
            let own = described.iter().find(|own| own.0 == *part);
            let none = Values::default();
            let scene = own.map_or(&none, |own| &own.1);
            let text = file.text(&format!("values of {part}")).unwrap_or_default();
            let values = [&Values::of_text(text), scene];
            !self.named.iter().any(|own| own.covers(part, all, values))
        });
        parts
    }
}

/// All that differs between a file and a scene, by its hashes and values.
pub(crate) fn differences(
    (hashes, described): (&Hashes, &Described),
    rare: &[&'static str],
    file: &Checkpoint,
) -> Vec<Difference> {
    let mut all = Vec::new();
    let hash_in_file = |part: &str| file.text(&format!("hash of {part}")).ok();
    let of_scene = hashes
        .iter()
        .map(|(part, hash)| (*part, Some(format!("{hash:016x}"))));
    // Parts that few scenes have, of which the file has one and the scene none.
    let lacking = rare
        .iter()
        .filter(|part| !hashes.iter().any(|own| own.0 == **part))
        .map(|part| (*part, None));
    for (part, hash) in of_scene.chain(lacking) {
        let found = hash_in_file(part);
        if found == hash.as_deref() {
            continue;
        }
        let own = described.iter().find(|own| own.0 == part);
        // Files of before there were values have none.
        let values = file.text(&format!("values of {part}"));
        let before = all.len();
        if let (Some((_, own)), Ok(text)) = (own, values) {
            let values = Values::of_text(text).differing(own);
            all.extend(values.into_iter().map(|(what, file, scene)| Difference {
                part,
                what,
                file,
                scene,
            }));
        }
        if all.len() == before {
            all.push(Difference {
                part,
                what: format!("hash of {part}"),
                file: found.map(Into::into),
                scene: hash,
            });
        }
    }
    all
}
