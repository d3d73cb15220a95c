//! What the method must meet, measured: plateaus, fronts, arrivals, contact ends, pads, conservation.
//! The reference is the Godunov solution with the same equation of state and a contact that opens.

use super::Failure;
use super::cases::{Case, short};
use super::choices::SchemeChoice;
use super::claims::{last_above, pulse_length};
use super::figures::at;
use super::options::Options;
use super::paper::{cases, pad_label};
use super::parallel::{self, Board};
use super::record::{self, Record, Watch};
use super::theory::{Theory, steps_of};
use meshfree::output::table::{Align, Table};
use meshfree::study::norms::{arrival, overshoot, plateau_mean, rise_10_90};
use std::path::Path;

const SCHEMES: [SchemeChoice; 3] = [
    SchemeChoice::Impact,
    SchemeChoice::Continuity,
    SchemeChoice::Lam2002,
];

/// A measured value and the bar it must stay below, both in the unit of its row.
pub struct Row {
    pub name: String,
    pub bar: f64,
    pub values: Vec<f64>,
}

/// A job: a case, and whether the reference is solved too.
type Job = (String, Case, bool);

fn jobs(options: &Options) -> Vec<Job> {
    let mut jobs = Vec::new();
    for scheme in SCHEMES {
        let all = cases(scheme, options.case.spacing);
        for (label, mut case) in all {
            if label == "wall" {
                case.snapshots = vec![5e-6];
            }
            if label == pad_label(10.0) {
                // A pad that is no multiple of the striker, and the joint before the wave comes.
                let mut odd = case.clone();
                odd.pad = Some(("pmma".into(), 7.5e-3));
                odd.snapshots = vec![1.5e-6];
                jobs.push((pad_label(7.5), odd, scheme == SchemeChoice::Impact));
            }
            jobs.push((label, case, scheme == SchemeChoice::Impact));
        }
    }
    jobs
}

/// Everything that was run.
pub struct Measured {
    records: Vec<(String, Record)>,
    theories: Vec<(String, Theory)>,
}

impl Measured {
    fn record(&self, scheme: SchemeChoice, label: &str) -> Result<&Record, Failure> {
        let own =
            |(name, record): &&(String, Record)| name == label && record.case.scheme == scheme;
        let found = self.records.iter().find(own);
        found
            .map(|(_, record)| record)
            .ok_or_else(|| format!("no run of {label}").into())
    }
    pub fn theory(&self, label: &str) -> Result<&Theory, Failure> {
        let found = self.theories.iter().find(|(name, _)| name == label);
        found
            .map(|(_, theory)| theory)
            .ok_or_else(|| format!("no theory of {label}").into())
    }
    /// A row with a value for each scheme.
    pub fn row(
        &self,
        name: impl Into<String>,
        bar: f64,
        label: &str,
        value: impl Fn(&Record, &Theory) -> Result<f64, Failure>,
    ) -> Result<Row, Failure> {
        let theory = self.theory(label)?;
        let of = |&scheme: &SchemeChoice| value(self.record(scheme, label)?, theory);
        let values: Result<Vec<f64>, Failure> = SCHEMES.iter().map(of).collect();
        Ok(Row {
            name: name.into(),
            bar,
            values: values?,
        })
    }
}

/// Measures everything, prints the table and writes it into a folder.
pub fn measure(options: &Options, folder: &Path) -> Result<(), Failure> {
    let jobs = jobs(options);
    let cells = if options.quick { 1000 } else { 6000 };
    let weights = jobs
        .iter()
        .map(|(_, case, _)| case.length() * case.until)
        .collect();
    let board = Board::new("bars", weights);
    let results = parallel::map(&jobs, options.threads, |k, (label, case, exact)| {
        let record = record::run(case, Watch::Every(1), &mut |time| {
            board.update(
                k,
                time / case.until,
                &format!("{}, {label}", case.scheme.key()),
            );
        })?;
        Ok((record, exact.then(|| Theory::of(case, cells)).transpose()?))
    })?;
    drop(board);
    let mut measured = Measured {
        records: Vec::new(),
        theories: Vec::new(),
    };
    for ((label, _, _), (record, theory)) in jobs.into_iter().zip(results) {
        if let Some(theory) = theory {
            measured.theories.push((label.clone(), theory));
        }
        measured.records.push((label, record));
    }
    let mut rows = Vec::new();
    fronts(&measured, &mut rows)?;
    figures(&measured, &mut rows)?;
    contacts(&measured, &mut rows)?;
    super::pads::rows(&measured, &mut rows)?;
    conservation(&measured, &mut rows);
    super::invariants::rows(options, &mut |name, bar, values| {
        rows.push(Row { name, bar, values });
    })?;
    let text = format!(
        "Spacing {} mm; reference: Godunov with {cells} cells, contact that opens. A value beyond its bar has a !\n\n{}",
        short(1e3 * options.case.spacing),
        table(&rows)
    );
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("bars.txt"), &text)?;
    print!("{text}");
    Ok(())
}

fn table(rows: &[Row]) -> Table {
    let mut header = vec!["quantity".to_string(), "bar".into()];
    header.extend(SCHEMES.iter().map(|scheme| scheme.key().to_string()));
    let mut table = Table::new(header);
    for column in 1..5 {
        table = table.align(column, Align::Right);
    }
    let text = |value: f64| {
        let small = value != 0.0 && value.abs() < 1e-3;
        if small {
            format!("{value:.1e}")
        } else {
            format!("{value:.4}")
        }
    };
    for row in rows {
        let bar = if row.bar.is_finite() {
            text(row.bar)
        } else {
            "-".into()
        };
        let mut cells = vec![row.name.clone(), bar];
        cells.extend(row.values.iter().map(|&value| {
            let mark = if value.abs() <= row.bar { " " } else { "!" };
            format!("{}{mark}", text(value))
        }));
        table.row(cells);
    }
    table
}

/// Central 70 % of state `k` that linear waves bring to `x0`.
pub fn window(theory: &Theory, x0: f64, k: usize) -> Result<(f64, f64), Failure> {
    let steps = steps_of(&theory.acoustic, x0, 0.2e-6)?;
    let &(from, until, _) = steps.get(k).ok_or("the waves bring no such state")?;
    let margin = 0.15 * (until - from);
    Ok((from + margin, until - margin))
}

/// Means of the reference and of the run over a window, at probe `p` \[Pa\].
pub fn means(
    record: &Record,
    theory: &Theory,
    p: usize,
    window: (f64, f64),
) -> Result<(f64, f64), Failure> {
    let (gauge, probe) = (&theory.reference.gauges()[p], &record.probes[p]);
    Ok((
        plateau_mean(&gauge.time, &gauge.stress, window.0, window.1)?,
        plateau_mean(&record.time, &probe.stress, window.0, window.1)?,
    ))
}

fn fronts(measured: &Measured, rows: &mut Vec<Row>) -> Result<(), Failure> {
    let targets = ["wall", "copper", "steel", "aluminium", "pmma"];
    for label in targets {
        rows.push(measured.row(
            format!("{label}: first plateau at 5 mm [%]"),
            0.5,
            label,
            |r, t| {
                let (reference, run) = means(r, t, 0, window(t, 5e-3, 1)?)?;
                Ok(100.0 * (run / reference - 1.0))
            },
        )?);
    }
    for label in targets {
        rows.push(
            measured.row(format!("{label}: overshoot [%]"), 3.0, label, |r, t| {
                let (_, mean) = means(r, t, 0, window(t, 5e-3, 1)?)?;
                let end = r.time.partition_point(|&time| time < 3.5e-6);
                Ok(100.0 * overshoot(&r.probes[0].stress[..end], 0.0, mean)?)
            })?,
        );
    }
    for label in targets {
        rows.push(measured.row(
            format!("{label}: rise 10-90 % [µs]"),
            0.14,
            label,
            |r, t| {
                let (_, mean) = means(r, t, 0, window(t, 5e-3, 1)?)?;
                Ok(1e6 * rise_10_90(&r.time, &r.probes[0].stress, 0.0, mean)?)
            },
        )?);
    }
    for label in targets {
        rows.push(measured.row(
            format!("{label}: arrival less reference [µs]"),
            0.01,
            label,
            |r, t| {
                let (reference, mean) = means(r, t, 0, window(t, 5e-3, 1)?)?;
                let gauge = &t.reference.gauges()[0];
                let exact = arrival(&gauge.time, &gauge.stress, 0.0, reference)?;
                Ok(1e6 * (arrival(&r.time, &r.probes[0].stress, 0.0, mean)? - exact))
            },
        )?);
    }
    for label in &targets[1..] {
        for k in [2, 3] {
            // Only while the chain has not heard of the far end.
            let steps = steps_of(&measured.theory(label)?.acoustic, 15e-3, 0.2e-6)?;
            if steps.get(k).is_none_or(|step| step.1 - step.0 < 1e-6) {
                continue;
            }
            let name = format!("{label}: plateau {k} at 15 mm [% of the first]");
            rows.push(measured.row(name, 1.0, label, |r, t| {
                let (first, _) = means(r, t, 1, window(t, 15e-3, 1)?)?;
                let (reference, run) = means(r, t, 1, window(t, 15e-3, k)?)?;
                Ok(100.0 * (run - reference) / first)
            })?);
        }
    }
    Ok(())
}

fn figures(measured: &Measured, rows: &mut Vec<Row>) -> Result<(), Failure> {
    for label in ["copper", "steel", "aluminium", "pmma"] {
        let name = format!("{label}: velocity at 5 mm, 5.1 µs [% of 20 m/s]");
        rows.push(measured.row(name, 0.3, label, |r, t| {
            let gauge = &t.reference.gauges()[0];
            let exact = at(&gauge.time, &gauge.velocity, 5.1e-6);
            Ok(100.0 * (at(&r.time, &r.probes[0].velocity, 5.1e-6) - exact) / 20.0)
        })?);
    }
    rows.push(measured.row(
        "figure 1: length of the pulse [% of 20 mm]",
        1.0,
        "copper",
        |r, _| {
            let shot = r.snapshot(7.7e-6).ok_or("no snapshot")?;
            let (x, y): (Vec<f64>, Vec<f64>) =
                shot.points.iter().map(|p| (p.reference, p.stress)).unzip();
            Ok(100.0 * (pulse_length(&x, &y) / 0.020 - 1.0))
        },
    )?);
    Ok(())
}

fn contacts(measured: &Measured, rows: &mut Vec<Row>) -> Result<(), Failure> {
    let ends = |r: &Record, t: &Theory| -> Result<(f64, f64), Failure> {
        let joint = t.reference.joint(Theory::contact(&r.case))?;
        let first = at(&joint.time, &joint.pressure, 2e-6);
        let until = *r.time.last().ok_or("no times")?;
        let run = last_above(&r.time, &r.contact, 0.01 * first).unwrap_or(until);
        let exact = last_above(&joint.time, &joint.pressure, 0.01 * first).unwrap_or(until);
        Ok((run, exact))
    };
    for label in ["steel", "aluminium", "pmma"] {
        let exact = ends(
            measured.record(SchemeChoice::Impact, label)?,
            measured.theory(label)?,
        )?
        .1;
        let name = format!("{label}: contact ends, reference {:.3} µs [%]", 1e6 * exact);
        rows.push(measured.row(name, 1.0, label, |r, t| {
            let (run, exact) = ends(r, t)?;
            Ok(100.0 * (run / exact - 1.0))
        })?);
    }
    rows.push(measured.row(
        "wall: contact ends, less reference [µs]",
        0.1,
        "wall",
        |r, t| {
            let (run, exact) = ends(r, t)?;
            Ok(1e6 * (run - exact))
        },
    )?);
    rows.push(measured.row(
        "copper: force below 1 % after [µs]",
        5.3,
        "copper",
        |r, t| Ok(1e6 * ends(r, t)?.0),
    )?);
    Ok(())
}

fn conservation(measured: &Measured, rows: &mut Vec<Row>) {
    let worst = |scheme: SchemeChoice, of: &dyn Fn(&Record) -> f64| {
        let own = measured.records.iter().map(|(_, record)| record);
        let own = own.filter(|r| r.case.scheme == scheme);
        own.fold(0.0, |most: f64, record| most.max(of(record)))
    };
    let all = |of: &dyn Fn(&Record) -> f64| SCHEMES.iter().map(|&s| worst(s, of)).collect();
    rows.push(Row {
        name: "momentum less wall impulse, worst drift of all runs".into(),
        bar: 1e-12,
        values: all(&|r| r.momentum_drift),
    });
    rows.push(Row {
        name: "total energy, worst drift of all runs".into(),
        bar: 1e-11,
        values: all(&|r| r.energy_drift),
    });
}
