//! Why a simulation cannot go on from a checkpoint.
//! A problem says what differs and what to resume with.

use std::path::PathBuf;
use thiserror::Error;

/// Why a simulation cannot go on from a checkpoint.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum CheckpointProblem {
    /// The file is not what was written.
    #[error("it is truncated or altered ({detail}): take an older checkpoint, or start again")]
    Damaged {
        /// Where it shows.
        detail: String,
    },
    /// The file of one of the ranks that wrote it is not there, or is another.
    #[error(
        "its part {}, of rank {rank} of {count}, {fault}: bring all files of the checkpoint into one folder under their \
         names, or take an older checkpoint", part.display()
    )]
    Part {
        /// The file.
        part: PathBuf,
        /// The rank that wrote it.
        rank: usize,
        /// How many ranks there were.
        count: usize,
        /// What is wrong with it.
        fault: String,
    },
    /// Another version of the crate wrote it, which held another state.
    #[error(
        "its state is of version {found}, and this crate reads version {known}: resume with the version of the \
         crate that wrote it"
    )]
    Version {
        /// The version of the file.
        found: String,
        /// The version that this crate reads.
        known: &'static str,
    },
    /// Simulations of another type: another scalar, dimension, or width of lanes.
    #[error(
        "its {what} is {found}, and that of the scene is {own}: resume with the {what} that it was written with"
    )]
    Kind {
        /// Scalar, dimension or lane width.
        what: &'static str,
        /// That of the file.
        found: String,
        /// That of the scene.
        own: String,
    },
    /// It is of another scene.
    #[error(
        "it was written by another scene, which differs in {}{}: resume with the scene that wrote it, or name the \
         parts that may differ in `Scene::resume_with`",
        parts.join(", "), in_brackets(.values)
    )]
    Scene {
        /// What differs.
        parts: Vec<&'static str>,
        /// Values of it, as far as they have names: which, and what it is in the file and in the scene.
        values: Vec<String>,
    },
    /// The machine cannot run the loops that it was written by.
    #[error(
        "its pair loops ran on {found}, which this machine or this build lacks, and other instructions round \
         differently: resume on a machine that has it, or run on `InstructionSet::Baseline` from the start"
    )]
    Instructions {
        /// The instruction set of the file.
        found: String,
    },
}

/// Most differences that a message tells.
const MOST: usize = 20;

/// The values in brackets, or nothing if there are none.
fn in_brackets(values: &[String]) -> String {
    if values.is_empty() {
        return String::new();
    }
    let told = values[..values.len().min(MOST)].join("; ");
    match values.len().saturating_sub(MOST) {
        0 => format!(" ({told})"),
        left => format!(" ({told}; and {left} more)"),
    }
}
