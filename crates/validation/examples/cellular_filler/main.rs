//! Water in an open-cell structure that is crushed at 1000 1/s, after Vesenjak & Ren (2007).
//! `cargo validate cellular_filler -- --help` lists the options.

#[path = "../common/mod.rs"]
mod common;
mod crush;
mod crush_report;
mod crushing;
mod filler;
mod finite_differences;
mod report;
mod through;

use common::{Example, Failure, Options, Own};
use crush::Crushed;
use crushing::Crushing;
use filler::{Case, Record};
use meshfree::scalar::Real;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};

const EXAMPLE: Example = Example {
    name: "cellular_filler",
    about: "Cubes of side d + c with three holes of d = 3 mm, filled and empty, crushed at 1000 1/s to 30 %\n\
            (Vesenjak & Ren 2007): an elastic-plastic structure between two plates, with water in it or without.\n\
            With rigid walls these move as prescribed, and what is measured is the filler alone.\n\
            standard: densities held to the space of particles, which are kept evenly spread; plain: neither.",
    schemes: &["standard", "plain"],
    own: &[
        own(
            "--walls",
            "NAME",
            "deforming (default): a solid between plates; rigid: particles in an affine crush",
        ),
        own(
            "--cells",
            "N or LONGxHIGH",
            "cells along outflow and crush; deforming 1; rigid 4x4 (--quick: 2x2)",
        ),
        own(
            "--cell",
            "C",
            "one thickness [mm] between the holes; 1.5 and 1.0 (--quick: 1.5), all of 1.5, 1.0, 0.5 with --study and rigid walls",
        ),
        own(
            "--fill",
            "NAME",
            "water or none, with deforming walls; both",
        ),
        own(
            "--viscosity",
            "PA_S",
            "one viscosity; deforming: 1e-3; rigid: all of 1e-3, 1e-2, 1e-1 and 1",
        ),
        own(
            "--study",
            "",
            "deforming walls: also the thinnest walls, and the other viscosities at the densest cell",
        ),
        own(
            "--through",
            "",
            "instead: slow flow through the cell that does not move, against finite differences",
        ),
        own(
            "--strain",
            "SHARE",
            "final strain; 0.3 (--quick: 0.1, rigid 0.05)",
        ),
    ],
};

const fn own(name: &'static str, value: &'static str, help: &'static str) -> Own {
    Own { name, value, help }
}

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    if options.has("--through") {
        return through::compare(1e-3 * options.number("--cell", 1.5)?, options);
    }
    match options.text("--walls").unwrap_or("deforming") {
        "rigid" => {}
        "deforming" => return deform(options),
        other => {
            let accepted = "deforming, rigid";
            return Err(format!("--walls: `{other}` is not accepted; it takes {accepted}").into());
        }
    }
    for only in ["--fill", "--study"] {
        if options.has(only) {
            return Err(format!("{only} goes with --walls deforming").into());
        }
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
    for wall in one("--cell", walls)? {
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

/// The crush of structures that deform.
fn deform(options: &Options) -> Result<(), Failure> {
    let thick: &[f64] = if options.has("--study") {
        &[1.5, 1.0, 0.5]
    } else {
        options.pick(&[1.5, 1.0], &[1.5])
    };
    let thick = match options.text("--cell") {
        Some(_) => vec![options.number("--cell", 1.5)?],
        None => thick.to_vec(),
    };
    let [count, high] = options.text("--cells").map_or(Ok([1, 1]), cells)?;
    if count != high {
        return Err(
            "--cells: deforming walls take as many along the outflow as along the crush".into(),
        );
    }
    let viscosity = options.number("--viscosity", 1e-3)?;
    let (filled, empty) = (Some(viscosity), None);
    let fills = match options.text("--fill") {
        None => vec![empty, filled],
        Some("water") => vec![filled],
        Some("none") => vec![empty],
        Some(other) => {
            return Err(format!("--fill: `{other}` is not accepted; it takes water, none").into());
        }
    };
    let mut list: Vec<(f64, Option<f64>)> = thick
        .iter()
        .flat_map(|&c| fills.iter().map(move |&fill| (c, fill)))
        .collect();
    if options.has("--study") {
        list.extend([1e-2, 1e-1, 1.0].map(|viscosity| (thick[0], Some(viscosity))));
    }
    let strain = match options.until {
        Some(end) => end * filler::RATE,
        None => options.number("--strain", options.pick(0.3, 0.1))?,
    };
    println!("{}", crush::CHOICES);
    let cases = list.into_iter().map(|(wall, viscosity)| Crushed {
        wall: 1e-3 * wall,
        viscosity,
        cells: count,
        // Four spacings through the wall, and six through the thickest.
        spacing: options.spacing_or(0.25e-3_f64.min(0.25e-3 * wall), 4.5e-4),
        strain,
    });
    let runs = at_once(cases.collect(), options.folder())?;
    crush_report::figure(&runs).save(options.file("stress_strain.svg"))?;
    let (table, trends) = (crush_report::table(&runs), crush_report::trends(&runs));
    println!("\n{table}\n{trends}");
    let text = format!("{}\n\n{}\n{trends}", crush::CHOICES, table.markdown());
    std::fs::write(options.file("report.txt"), text)?;
    println!("written to {}", options.folder().display());
    Ok(())
}

/// Runs that do not depend on each other, as many at once as there are cores, which they share: a run has too few particles for more.
fn at_once(cases: Vec<Crushed>, folder: &Path) -> Result<Vec<(Crushed, Crushing)>, Failure> {
    let next = AtomicUsize::new(0);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let count = cores.min(cases.len());
    let work = || -> Result<Vec<(usize, Crushing)>, String> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(cores / count)
            .build();
        let pool = pool.map_err(|error| error.to_string())?;
        let mut own = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            let Some(case) = cases.get(k) else {
                return Ok(own);
            };
            let record = pool.install(|| crush_one(case, folder));
            let named = |error| format!("{}: {error}", case.name());
            own.push((k, record.map_err(named)?));
        }
    };
    let ended: Vec<_> = std::thread::scope(|scope| {
        let all: Vec<_> = (0..count).map(|_| scope.spawn(work)).collect();
        all.into_iter().map(|own| own.join()).collect()
    });
    let mut records = Vec::new();
    for own in ended {
        records.extend(own.map_err(|_| "a run has panicked")??);
    }
    records.sort_by_key(|own| own.0);
    let records = records.into_iter().map(|own| own.1);
    Ok(cases.into_iter().zip(records).collect())
}

fn crush_one(case: &Crushed, folder: &Path) -> Result<Crushing, Failure> {
    let folder = folder.join(case.name());
    let record = crushing::run(case, &folder)?;
    crush_report::sections(case, &record).save(folder.join("sections.svg"))?;
    std::fs::write(folder.join("report.txt"), crush_report::text(case, &record))?;
    println!(
        "{}: {} particles, {} steps, {:.0} s",
        case.name(),
        record.particles.iter().sum::<usize>(),
        record.steps,
        record.seconds
    );
    Ok(record)
}

/// `4x4`, or `4` for the same.
fn cells(text: &str) -> Result<[usize; 2], Failure> {
    let parts: Vec<usize> = text
        .split('x')
        .filter_map(|part| part.parse().ok())
        .collect();
    match parts[..] {
        [count] if !text.contains('x') && (1..=64).contains(&count) => Ok([count; 2]),
        [long, high] if (1..=64).contains(&long) && (1..=64).contains(&high) => Ok([long, high]),
        _ => Err(
            format!("--cells: `{text}` is not accepted; it takes N or LONGxHIGH, as 4x4").into(),
        ),
    }
}
