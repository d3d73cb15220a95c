//! Axial impact of rods: the seven figures of Lam, Shen & Gong (2002), and any other case.
//! `cargo validate rod_impact -- --help` lists the options.

mod bars;
mod cases;
mod choices;
mod claims;
mod convergence;
mod figures;
mod invariants;
mod options;
mod pads;
mod paper;
mod parallel;
mod record;
mod report;
#[cfg(test)]
mod tests;
mod theory;

use options::{Options, Task};
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// What can end the program early.
type Failure = Box<dyn Error + Send + Sync>;

pub(crate) fn main() -> ExitCode {
    let options = options::parse(std::env::args_os()).unwrap_or_else(|bad| bad.exit());
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
        Task::Case => report::run(options, folder("out/rod_impact")),
        Task::Figures => figures_and_claims(options, folder("out/rod_impact")),
        Task::Bars => bars::measure(options, folder("out/rod_impact")),
        Task::Convergence => convergence::study(options, folder("docs")),
    }
}

/// Figures 1 to 7 and the table of claims.
fn figures_and_claims(options: &Options, folder: &Path) -> Result<(), Failure> {
    let started = Instant::now();
    let runs = paper::Runs::of(options)?;
    figures::write(&runs, folder)?;
    let table = claims::table(&runs)?;
    let drift = runs
        .all()
        .fold(0.0, |most: f64, run| most.max(run.record.momentum_drift));
    let text = format!(
        "Axial impact of composite rods (Lam, Shen & Gong 2002), spacing {} mm\n\n{table}\n{}\n\
         Largest drift of momentum in all runs: {drift:.1e}. {} runs in {:.1} s.\n",
        cases::short(1e3 * options.case.spacing),
        claims::NOTES,
        runs.all().count(),
        started.elapsed().as_secs_f64()
    );
    std::fs::write(folder.join("report.txt"), &text)?;
    print!("{text}\nwritten to {}\n", folder.display());
    Ok(())
}
