//! Axial impact of rods: the seven figures of Lam, Shen & Gong (2002), and any other case.
//! `cargo run --release --example rod_impact -- --help` lists the options.

mod cases;
mod choices;
mod options;
mod record;
mod report;
mod theory;

use options::{Options, Task};
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

/// What can end the program early.
type Failure = Box<dyn Error + Send + Sync>;

fn main() -> ExitCode {
    let options = match options::parse(std::env::args().skip(1)) {
        Ok(options) => options,
        Err(bad) => {
            eprintln!("{bad}");
            return ExitCode::from(2);
        }
    };
    match perform(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
            let bad_case = failure
                .downcast_ref::<meshfree::error::Error>()
                .is_some_and(|error| matches!(error, meshfree::error::Error::Build(_)));
            ExitCode::from(if bad_case { 2 } else { 1 })
        }
    }
}

fn perform(options: &Options) -> Result<(), Failure> {
    let folder = |default: &'static str| options.out.as_deref().unwrap_or(Path::new(default));
    match options.task {
        Task::Help => {
            print!("{}", options::HELP);
            Ok(())
        }
        Task::Case => report::run(options, folder("out/rod_impact")),
        _ => Ok(()),
    }
}
