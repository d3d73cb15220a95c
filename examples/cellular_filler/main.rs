//! Water in an open-cell structure that is crushed at 1000 1/s, after Vesenjak & Ren (2007).
//! `cargo run --release --example cellular_filler -- --help` lists the options.

#[path = "../common/mod.rs"]
mod common;
mod filler;
mod report;

use common::{Example, Failure, Options, Own};
use filler::{Case, Record};
use meshfree::scalar::Real;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "cellular_filler",
    about: "Water in cubes of side d + c with three holes of d = 3 mm, crushed at 1000 1/s to 30 %\n\
            (Vesenjak & Ren 2007). The walls move as prescribed; what is measured is the filler alone.\n\
            standard: densities held to the space of particles, which are kept evenly spread; plain: neither.",
    schemes: &["standard", "plain"],
    own: &[
        own(
            "--walls",
            "NAME",
            "prescribed: rigid particles in an affine crush; the only one here",
        ),
        own(
            "--cells",
            "LONGxHIGH",
            "cells along the outflow and along the crush; 4x4 (--quick: 2x2)",
        ),
        own(
            "--wall-mm",
            "C",
            "one thickness between the holes; all of 1.5, 1.0 and 0.5",
        ),
        own(
            "--viscosity",
            "PA_S",
            "one viscosity; all of 1e-3, 1e-2, 1e-1 and 1",
        ),
        own("--strain", "SHARE", "final strain; 0.3 (--quick: 0.05)"),
    ],
};

const fn own(name: &'static str, value: &'static str, help: &'static str) -> Own {
    Own { name, value, help }
}

fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f32>, perform::<f64>)
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    if let Some(other) = options.text("--walls").filter(|name| *name != "prescribed") {
        return Err(format!("--walls: `{other}` is not accepted; it takes prescribed").into());
    }
    let cells = match options.text("--cells") {
        None => options.pick([4, 4], [2, 2]),
        Some(text) => cells(text)?,
    };
    let one = |name: &str, all: &[f64]| -> Result<Vec<f64>, Failure> {
        Ok(match options.text(name) {
            Some(_) => vec![options.number(name, 1.0)?],
            None => all.to_vec(),
        })
    };
    let strain = match options.until {
        Some(end) => end * filler::RATE,
        None => options.number("--strain", options.pick(0.3, 0.05))?,
    };
    let mut runs: Vec<(Case, Record)> = Vec::new();
    println!("{}", filler::CHOICES);
    // Quick runs show that it runs, and the two trends by their ends.
    let walls: &[f64] = options.pick(&[1.5, 1.0, 0.5], &[1.5, 0.5]);
    let viscosities: &[f64] = options.pick(&[1e-3, 1e-2, 1e-1, 1.0], &[1e-3, 1.0]);
    for wall in one("--wall-mm", walls)? {
        for viscosity in one("--viscosity", viscosities)? {
            let case = Case {
                wall: 1e-3 * wall,
                viscosity,
                cells,
                consistent: options.scheme == "standard",
                spacing: options.spacing_or(2.5e-4, 4.5e-4),
                strain,
            };
            let folder = options.folder().join(case.name());
            let record = filler::run::<T>(&case, &folder)?;
            println!(
                "{}: {} particles, {} steps, {:.0} s",
                case.name(),
                record.particles,
                record.steps,
                record.seconds
            );
            runs.push((case, record));
        }
    }
    report::figure(&runs).save(options.file("filler.svg"))?;
    let table = report::table(&runs);
    println!("\n{table}\n{}", report::trends(&runs));
    std::fs::write(
        options.file("report.md"),
        format!(
            "{}\n\n{}\n{}",
            filler::CHOICES,
            table.markdown(),
            report::trends(&runs)
        ),
    )?;
    println!("written to {}", options.folder().display());
    Ok(())
}

/// `4x4`.
fn cells(text: &str) -> Result<[usize; 2], Failure> {
    let parts: Vec<usize> = text
        .split('x')
        .filter_map(|part| part.parse().ok())
        .collect();
    match parts[..] {
        [long, high] if (1..=64).contains(&long) && (1..=64).contains(&high) => Ok([long, high]),
        _ => Err(format!("--cells: `{text}` is not accepted; it takes LONGxHIGH, as 4x4").into()),
    }
}
