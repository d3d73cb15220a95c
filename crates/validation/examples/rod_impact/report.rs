//! One case: runs it, compares it with theory, and writes its report and a picture.
//! Everything but the report is written while the case runs.

use super::Failure;
use super::cases::{Case, short};
use super::options::Options;
use super::record::{self, Record, Watch};
use super::theory::{Theory, steps_of};
use meshfree::output::progress::Progress;
use meshfree::output::svg::{Axis, Figure, PALETTE, Panel, Series};
use meshfree::output::table::{Table, significant};
use meshfree::study::norms::{arrival, plateau_mean};
use std::fmt::Write as _;
use std::path::Path;

/// Cells of the reference: fronts of a few nanoseconds.
const CELLS: usize = 3000;

/// Runs a case and writes its files into a folder.
pub fn run(options: &Options, folder: &Path) -> Result<(), Failure> {
    let case = &options.case;
    let threads = options.threads.unwrap_or(0);
    let pool = rayon_pool(threads)?;
    let record = pool.install(|| -> Result<Record, Failure> {
        let mut progress = Progress::new(case.scheme.key());
        let record = record::run(case, Watch::Files(folder), &mut |time| {
            progress.update(time / case.until, format_args!("t = {:.2} µs", 1e6 * time));
        });
        Ok(record?)
    })?;
    let mut text = summary(&record, pool.current_num_threads());
    if case.bears_shear() {
        writeln!(text, "\n{}", with_shear(&record))?;
        std::fs::write(folder.join("report.txt"), &text)?;
        print!("{text}\nwritten to {}\n", folder.display());
        return Ok(());
    }
    let theory = Theory::of(case, if options.quick { CELLS / 4 } else { CELLS });
    match &theory {
        Ok(theory) => {
            writeln!(text, "\n{}", plateaus(&record, theory)?)?;
            writeln!(text, "{}", contact(case, theory)?)?;
            picture(&record, theory).save(folder.join("history.svg"))?;
        }
        Err(why) => writeln!(text, "\nNo reference solution: {why}")?,
    }
    std::fs::write(folder.join("report.txt"), &text)?;
    print!("{text}");
    println!("\nwritten to {}", folder.display());
    Ok(())
}

/// What the rods bore, and what yielded; the reference solutions know pressure alone.
fn with_shear(record: &Record) -> String {
    let case = &record.case;
    let mut lines = vec![format!(
        "state {}, strength {}; the reference solutions are hydrodynamic, and are left out",
        case.state.key(),
        case.strength().key()
    )];
    for probe in &record.probes {
        let most = |sign: f64| {
            let stress = probe.stress.iter().map(|stress| sign * stress);
            1e-6 * stress.fold(0.0, f64::max)
        };
        lines.push(format!(
            "at {} mm: largest compression {:.2} MPa, largest tension {:.2} MPa",
            short(1e3 * probe.x0),
            most(-1.0),
            most(1.0)
        ));
    }
    for (rod, (work, strain)) in case.rods().iter().zip(&record.plastic) {
        lines.push(format!(
            "{}: plastic work {} J, largest plastic strain {}",
            rod.name,
            significant(*work, 4),
            significant(*strain, 3)
        ));
    }
    lines.join("\n")
}

/// A pool of so many threads; all cores for 0.
pub fn rayon_pool(threads: usize) -> Result<rayon::ThreadPool, Failure> {
    Ok(rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()?)
}

fn summary(record: &Record, threads: usize) -> String {
    let case = &record.case;
    let mut lines = vec![
        case.title(),
        String::new(),
        record.scheme.clone(),
        String::new(),
        format!(
            "integrator {}, contact {}",
            record.integrator,
            case.contact().key()
        ),
        format!(
            "{} particles every {} mm, {} steps to {} µs, {:.2} s on {threads} thread(s)",
            record.particles,
            short(1e3 * case.spacing),
            record.steps,
            short(1e6 * case.until),
            record.wall_time.as_secs_f64()
        ),
        format!(
            "largest drift: momentum {:.1e} and energy {:.1e} of those of the impact (less the wall's impulse)",
            record.momentum_drift, record.energy_drift
        ),
        format!("guards of equations of state acted {} times", record.guards),
        "Masses, forces and energies are those of a cross-section of 1 m². Tension is positive."
            .into(),
    ];
    for rod in case.rods() {
        if let Ok(material) = super::cases::material(&rod.material) {
            lines.push(format!(
                "{}: {} mm of {}, {:?} ({})",
                rod.name,
                short(1e3 * rod.length()),
                material.name,
                material.eos().name(),
                material.source
            ));
        }
    }
    lines.join("\n") + "\n"
}

/// Plateaus at the probes: means over the central 70 % between arrivals of linear waves.
fn plateaus(record: &Record, theory: &Theory) -> Result<Table, Failure> {
    let mut table = Table::new([
        "probe [mm]",
        "from [µs]",
        "to [µs]",
        "linear [MPa]",
        "reference [MPa]",
        "computed [MPa]",
        "difference [%]",
        "half-height arrival [µs]",
        "reference [µs]",
    ])
    .title("Stress at the probes");
    for (probe, gauge) in record.probes.iter().zip(theory.reference.gauges()) {
        let mut first = None;
        let mut before = 0.0;
        for (from, until, linear) in steps_of(&theory.acoustic, probe.x0, 0.2e-6)? {
            let margin = 0.15 * (until - from);
            let (a, b) = (from + margin, until - margin);
            let reference = plateau_mean(&gauge.time, &gauge.stress, a, b)?;
            let computed = plateau_mean(&record.time, &probe.stress, a, b)?;
            let scale = if linear.abs() > 1.0 {
                *first.get_or_insert(reference.abs())
            } else {
                f64::INFINITY
            };
            let arrivals =
                [(&gauge.time, &gauge.stress), (&record.time, &probe.stress)].map(|(t, s)| {
                    let k = t.partition_point(|&t| t < from - 0.3e-6);
                    let end = t.partition_point(|&t| t < until);
                    arrival(&t[k..end], &s[k..end], before, reference)
                        .map_or_else(|_| "-".into(), |t| format!("{:.4}", 1e6 * t))
                });
            let [at_reference, at_computed] = if from > 0.0 {
                arrivals
            } else {
                ["-".into(), "-".into()]
            };
            table.row([
                short(1e3 * probe.x0),
                format!("{:.3}", 1e6 * from),
                format!("{:.3}", 1e6 * until),
                format!("{:.2}", 1e-6 * linear),
                format!("{:.2}", 1e-6 * reference),
                format!("{:.2}", 1e-6 * computed),
                format!("{:+.3}", 100.0 * (computed.abs() - reference.abs()) / scale),
                at_computed,
                at_reference,
            ]);
            before = reference;
        }
    }
    Ok(table)
}

fn contact(case: &Case, theory: &Theory) -> Result<String, Failure> {
    let closed = theory
        .reference
        .joint(Theory::contact(case))?
        .intervals
        .clone();
    let text = |time: f64| format!("{} µs", significant(1e6 * time, 5));
    let closed: Vec<_> = closed
        .iter()
        .map(|i| {
            format!(
                "{} to {}",
                text(i.from),
                i.until.map_or("after the end".into(), text)
            )
        })
        .collect();
    Ok(format!(
        "The contact of the reference is closed from {}.",
        closed.join(", from ")
    ))
}

fn picture(record: &Record, theory: &Theory) -> Figure {
    let us = |t: &f64| 1e6 * t;
    let mut stress = Panel::new(Axis::linear("time", "µs"), Axis::linear("stress", "MPa"));
    let mut velocity = Panel::new(Axis::linear("time", "µs"), Axis::linear("velocity", "m/s"));
    for (k, (probe, gauge)) in record
        .probes
        .iter()
        .zip(theory.reference.gauges())
        .enumerate()
    {
        let label = format!("{} mm", short(1e3 * probe.x0));
        let color = PALETTE[k % PALETTE.len()];
        let exact = if k == 0 { "Godunov reference" } else { "" };
        let pairs = |t: &[f64], y: &[f64], scale: f64| -> Vec<(f64, f64)> {
            t.iter().map(us).zip(y.iter().map(|y| scale * y)).collect()
        };
        stress = stress
            .series(Series::line(&label, pairs(&record.time, &probe.stress, 1e-6)).color(color))
            .series(Series::line(exact, pairs(&gauge.time, &gauge.stress, 1e-6)).reference());
        velocity = velocity
            .series(Series::line(&label, pairs(&record.time, &probe.velocity, 1.0)).color(color))
            .series(Series::line(exact, pairs(&gauge.time, &gauge.velocity, 1.0)).reference());
    }
    Figure::new()
        .title(&record.case.title())
        .panel(stress)
        .panel(velocity)
        .columns(1)
        .shared_legend()
        .panel_size(720.0, 320.0)
}
