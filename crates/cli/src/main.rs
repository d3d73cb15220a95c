//! The program `meshfree`: runs scenes from files.
//! Exit status 2 is a command line or a scene that cannot be followed, 1 a run that failed.

use clap::{Parser, Subcommand};
use meshfree_cli::command::{Stopped, Task, perform, schema};
use meshfree_cli::fault::Source;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

/// Smoothed particle hydrodynamics: runs scenes from TOML files.
#[derive(Parser)]
#[command(name = "meshfree", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Runs a scene.
    Run {
        /// The scene file.
        scene: PathBuf,
        /// The folder that is written to, in place of that of the file.
        #[arg(long)]
        out: Option<PathBuf>,
        /// Goes on from the checkpoint in that folder, to the bits of a run in one go.
        #[arg(long)]
        resume: bool,
        /// Checks alone, as `check` does.
        #[arg(long)]
        dry_run: bool,
    },
    /// Checks a scene, and prints its scheme, advice, memory and cost.
    Check {
        /// The scene file.
        scene: PathBuf,
    },
    /// Prints the format as a JSON schema, for editors.
    Schema,
}

fn main() -> ExitCode {
    let (scene, task) = match Arguments::parse().command {
        Command::Schema => return printed(&schema()),
        Command::Check { scene } => (scene, Task::Check),
        Command::Run {
            scene,
            dry_run: true,
            ..
        } => (scene, Task::Check),
        Command::Run {
            scene,
            out,
            resume: true,
            ..
        } => (scene, Task::Resume(out)),
        Command::Run { scene, out, .. } => (scene, Task::Run(out)),
    };
    let done = Source::read(&scene).map_err(Stopped::Scene);
    match done.and_then(|source| perform(&source, &task)) {
        Ok(text) => printed(&text),
        Err(stopped) => {
            eprintln!("{stopped}");
            ExitCode::from(if matches!(stopped, Stopped::Scene(_)) {
                2
            } else {
                1
            })
        }
    }
}

/// Prints; a reader that goes away early, as `head` does, is no failure.
fn printed(text: &str) -> ExitCode {
    match writeln!(std::io::stdout(), "{text}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => ExitCode::from(1),
        _ => ExitCode::SUCCESS,
    }
}
