//! The commands `run`, `check` and `schema`.
//! A scene is read once to find its dimension, and built in that.

use crate::build::{faults_of, scene, schemes};
use crate::fault::{Fault, Faults, Source};
use crate::format::SceneFile;
use crate::outputs::{self, CHECKPOINT, Sensors};
use core::fmt;
use meshfree::prelude::Scheme;
use meshfree::run::Failure;
use meshfree::scene::advice::Known;
use meshfree::simulation::Work;
use std::path::{Path, PathBuf};

/// Why a command has not done what it was asked to.
#[derive(Debug)]
pub enum Stopped {
    /// The scene is wrong.
    Scene(Faults),
    /// The run failed.
    Run(Failure),
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(faults) => faults.fmt(f),
            Self::Run(failure) => failure.fmt(f),
        }
    }
}

impl std::error::Error for Stopped {}

impl From<Faults> for Stopped {
    fn from(faults: Faults) -> Self {
        Self::Scene(faults)
    }
}

/// What is done with a scene.
#[derive(Clone, Debug)]
pub enum Task {
    /// Checks, and prints advice, memory and cost.
    Check,
    /// Runs, and writes into a folder if not into that of the file.
    Run(Option<PathBuf>),
    /// Goes on from the checkpoint in that folder.
    Resume(Option<PathBuf>),
}

/// Does what is asked with the scene of a file; returns what there is to print.
///
/// # Errors
/// If the scene is wrong, or the run fails.
pub fn perform(source: &Source, task: &Task) -> Result<String, Stopped> {
    let file: SceneFile = source.parse()?;
    let wrong = |fault| source.faults(vec![fault]);
    match file.dimension {
        1 => with(
            source,
            &file,
            schemes::in_line(&file.scheme).map_err(wrong)?,
            task,
        ),
        2 => with(
            source,
            &file,
            schemes::in_plane(&file.scheme).map_err(wrong)?,
            task,
        ),
        3 => with(
            source,
            &file,
            schemes::in_space(&file.scheme).map_err(wrong)?,
            task,
        ),
        other => {
            let text = format!("is {other}: it must be 1, 2 or 3");
            Err(wrong(Fault::new("dimension", text)).into())
        }
    }
}

fn with<const D: usize>(
    source: &Source,
    file: &SceneFile,
    scheme: Scheme<f64, D>,
    task: &Task,
) -> Result<String, Stopped> {
    let printed = scheme.to_string();
    let scene = scene(source, file, scheme)?;
    let advice = scene.advise(file.run.until, &Known::from(&file.known));
    let stem = source.path().file_stem().unwrap_or_default();
    let folder = |given: &Option<PathBuf>| {
        let own = || file.output.folder.as_ref().map(PathBuf::from);
        let given = given.clone().or_else(own);
        given.unwrap_or_else(|| Path::new("out").join(stem))
    };
    let built = match task {
        Task::Check | Task::Run(_) => scene.build(),
        Task::Resume(given) => scene.resume(folder(given).join(CHECKPOINT)),
    };
    let mut simulation = built.map_err(|error| faults_of(source, &error))?;
    let sensors = Sensors::of(source, file, &mut simulation)?;
    match task {
        Task::Check => {
            let work = simulation.expected_work(file.run.until);
            let work = work.map_err(|error| faults_of(source, &error))?;
            // Advice names what it lacks as the library does.
            let advice = advice.to_string().replace("Known::", "known.");
            Ok(format!("{printed}\n{advice}\n{}", price(&work)))
        }
        Task::Run(given) | Task::Resume(given) => {
            let folder = folder(given);
            let stem = stem.to_string_lossy();
            let title = file.title.as_deref().unwrap_or(&stem);
            let ran = outputs::run(title, file, &mut simulation, &sensors, &folder);
            let summary = ran.map_err(Stopped::Run)?;
            Ok(format!(
                "{title}: {summary}\nwritten to {}",
                folder.display()
            ))
        }
    }
}

/// What a run will take.
fn price(work: &Work) -> String {
    format!(
        "{} particles, about {} steps of {:.2} ms, {:.1} MB, {:.1} s",
        work.particles,
        work.steps,
        1e3 * work.time.as_secs_f64() / work.steps.max(1) as f64,
        1e-6 * work.bytes as f64,
        work.time.as_secs_f64()
    )
}

/// The format as a JSON schema, for editors.
#[must_use]
pub fn schema() -> String {
    let schema = schemars::schema_for!(SceneFile);
    serde_json::to_string_pretty(&schema).unwrap_or_default()
}
