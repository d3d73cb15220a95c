//! The seven figures of the paper as SVG and CSV, our scheme beside the paper's.
//! Dashed black lines are the exact linear waves of the same case and contact law.

use super::Failure;
use super::choices::SchemeChoice;
use super::paper::{PAD_SHOWN, PADS, Run, Runs, SCHEMES, SHOWN, TARGETS, pad_label};
use super::record::Point;
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Color, Figure, Legend, PALETTE, Panel, Series};
use std::path::Path;

/// What a figure shows of its runs.
#[derive(Clone, Copy, PartialEq)]
enum Quantity {
    Stress,
    Velocity,
}

impl Quantity {
    fn axis(self) -> Axis {
        match self {
            Self::Stress => Axis::linear("stress", "MPa"),
            Self::Velocity => Axis::linear("velocity", "m/s"),
        }
    }
    fn column(self) -> &'static str {
        match self {
            Self::Stress => "stress_pa",
            Self::Velocity => "velocity_m_s",
        }
    }
    /// From SI units to those of the axis.
    fn shown(self) -> f64 {
        match self {
            Self::Stress => 1e-6,
            Self::Velocity => 1.0,
        }
    }
    fn of_point(self, point: &Point) -> f64 {
        match self {
            Self::Stress => point.stress,
            Self::Velocity => point.velocity,
        }
    }
}

/// Writes all figures into a folder.
pub fn write(runs: &Runs, folder: &Path) -> Result<(), Failure> {
    let copper = ["copper".to_string()];
    let targets = TARGETS.map(String::from);
    let pads = PADS.map(pad_label);
    let profile = |number, title, time, quantity, labels: &[String]| {
        profiles(runs, folder, number, title, time, quantity, labels)
    };
    profile(
        1,
        "stress at 7.7 µs, copper onto copper",
        7.7e-6,
        Quantity::Stress,
        &copper,
    )?;
    profile(
        2,
        "velocity at 12.8 µs, copper onto copper",
        12.8e-6,
        Quantity::Velocity,
        &copper,
    )?;
    profile(
        5,
        "velocity at 5.1 µs",
        5.1e-6,
        Quantity::Velocity,
        &targets[1..],
    )?;
    let history =
        |number, title, place: &dyn Fn(&Run) -> (usize, f64), until, labels: &[String]| {
            histories(runs, folder, number, title, place, until, labels)
        };
    let middle = |_: &Run| (0, 5e-3);
    history(
        3,
        "stress in the middle of the copper striker (5 mm)",
        &middle,
        SHOWN,
        &targets,
    )?;
    history(
        4,
        "stress in the target, 5 mm behind its face (15 mm)",
        &|_| (1, 15e-3),
        SHOWN,
        &targets[1..],
    )?;
    history(
        6,
        "stress in the middle of the copper striker behind a PMMA pad",
        &middle,
        PAD_SHOWN,
        &pads,
    )?;
    let in_pad = |run: &Run| (1, run.record.probes.get(1).map_or(0.0, |probe| probe.x0));
    history(
        7,
        "stress in the middle of the PMMA pad",
        &in_pad,
        PAD_SHOWN,
        &pads,
    )
}

fn color(label: &str, position: usize) -> Color {
    let place = TARGETS.iter().position(|target| *target == label);
    PALETTE[match place {
        Some(0) => 7,
        Some(1) => 1,
        Some(2) => 0,
        Some(3) => 2,
        Some(_) => 3,
        None => [0, 1, 2][position % 3],
    }]
}

fn panel_title(scheme: SchemeChoice) -> &'static str {
    match scheme {
        SchemeChoice::Lam2002 => "lam2002: the paper's scheme, bodies bonded",
        SchemeChoice::Continuity => "continuity",
        SchemeChoice::Impact => "impact: our default, contact opens",
    }
}

fn finish(title: &str, number: usize, panels: Vec<Panel>, folder: &Path) -> Result<(), Failure> {
    let figure = panels.into_iter().fold(Figure::new(), Figure::panel);
    figure
        .title(&format!("Figure {number}: {title}"))
        .columns(2)
        .panel_size(520.0, 340.0)
        .shared_legend()
        .save(folder.join(format!("figure{number}.svg")))?;
    Ok(())
}

/// A figure of a quantity along the rods.
fn profiles(
    runs: &Runs,
    folder: &Path,
    number: usize,
    title: &str,
    time: f64,
    quantity: Quantity,
    labels: &[String],
) -> Result<(), Failure> {
    let mut panels = Vec::new();
    let mut names = vec!["reference_x_m".to_string()];
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for scheme in SCHEMES {
        let x = Axis::linear("initial position", "mm").range(0.0, 50.0);
        let mut panel = Panel::new(x, quantity.axis()).title(panel_title(scheme));
        for (k, label) in labels.iter().enumerate() {
            let run = runs.get(scheme, label)?;
            let Some(shot) = run.record.snapshot(time) else {
                continue;
            };
            let places: Vec<f64> = shot.points.iter().map(|p| p.reference).collect();
            let values: Vec<f64> = shot.points.iter().map(|p| quantity.of_point(p)).collect();
            let drawn = places
                .iter()
                .zip(&values)
                .map(|(x, y)| (1e3 * x, quantity.shown() * y));
            let mut steps = Vec::new();
            for piece in run.waves.snapshot(time)? {
                let y = match quantity {
                    Quantity::Stress => piece.stress,
                    Quantity::Velocity => piece.velocity,
                };
                steps.extend([piece.from, piece.to].map(|x| (1e3 * x, quantity.shown() * y)));
            }
            let exact = if k == 0 { "exact linear waves" } else { "" };
            panel = panel
                .series(Series::line(label, drawn).color(color(label, k)))
                .series(Series::line(exact, steps).reference());
            let exact_values: Result<Vec<f64>, _> = places
                .iter()
                .map(|&x0| match quantity {
                    Quantity::Stress => run.waves.stress(x0, time),
                    Quantity::Velocity => run.waves.velocity(x0, time),
                })
                .collect();
            if columns.is_empty() {
                columns.push(places);
            }
            for (source, values) in [(scheme.key(), values), ("exact", exact_values?)] {
                let source = if source == "exact" {
                    format!("exact for {}", scheme.key())
                } else {
                    source.into()
                };
                names.push(format!("{}@{label} {source}", quantity.column()));
                columns.push(values);
            }
        }
        panels.push(panel.legend(Legend::Auto));
    }
    write_columns(folder, number, &names, &columns)?;
    finish(title, number, panels, folder)
}

/// A figure of stress histories. Those with a reference beside linear waves get a panel each.
fn histories(
    runs: &Runs,
    folder: &Path,
    number: usize,
    title: &str,
    place: &dyn Fn(&Run) -> (usize, f64),
    until: f64,
    labels: &[String],
) -> Result<(), Failure> {
    let steps = 1300;
    let grid: Vec<f64> = (0..=steps)
        .map(|k| until * f64::from(k) / f64::from(steps))
        .collect();
    let mut panels: Vec<Vec<Panel>> = Vec::new();
    let mut names = vec!["time_s".to_string()];
    let mut columns = vec![grid.clone()];
    let us = |t: f64| 1e6 * t;
    for scheme in SCHEMES {
        let panel = |title: &str| {
            let x = Axis::linear("time", "µs").range(0.0, us(until));
            Panel::new(x, Quantity::Stress.axis()).title(title)
        };
        let mut own = Vec::new();
        for (k, label) in labels.iter().enumerate() {
            let run = runs.get(scheme, label)?;
            let (p, x0) = place(run);
            let Some(probe) = run.record.probes.get(p) else {
                continue;
            };
            let shown = |time: &[f64], stress: &[f64]| -> Vec<(f64, f64)> {
                let all = time.iter().zip(stress).take_while(|(t, _)| **t <= until);
                all.map(|(t, stress)| (us(*t), 1e-6 * stress)).collect()
            };
            let states = run.waves.history(x0)?;
            let states = states.iter().take_while(|state| state.time <= until);
            let mut exact: Vec<_> = states.map(|s| (us(s.time), 1e-6 * s.stress)).collect();
            exact.extend(exact.last().map(|last| (us(until), last.1)));
            let gauge = run
                .reference
                .as_ref()
                .and_then(|theory| theory.reference.gauges().get(p));
            let name = if k == 0 { "exact linear waves" } else { "" };
            let mut series = Vec::new();
            if let Some(gauge) = gauge {
                let points = shown(&gauge.time, &gauge.stress);
                let name = if k == 0 { "Godunov reference" } else { "" };
                series.push(
                    Series::line(name, points)
                        .color(Color(190, 190, 190))
                        .width(3.0),
                );
            }
            let drawn = shown(&run.record.time, &probe.stress);
            series.push(Series::line(label, drawn).color(color(label, k)));
            series.push(Series::steps(name, exact).reference());
            if gauge.is_some() || own.is_empty() {
                let title = match gauge {
                    Some(_) => format!("{}, {label}", scheme.key()),
                    None => panel_title(scheme).into(),
                };
                own.push(panel(&title));
            }
            if let Some(last) = own.pop() {
                own.push(series.into_iter().fold(last, Panel::series));
            }
            let mut column = |source: &str, values: Vec<f64>| {
                names.push(format!("stress_pa@{label} {source}"));
                columns.push(values);
            };
            let sampled = |t: &[f64], y: &[f64]| grid.iter().map(|&time| at(t, y, time)).collect();
            let exact: Result<Vec<f64>, _> =
                grid.iter().map(|&t| run.waves.stress(x0, t)).collect();
            column(scheme.key(), sampled(&run.record.time, &probe.stress));
            column(&format!("exact for {}", scheme.key()), exact?);
            if let Some(gauge) = gauge {
                let source = format!("reference for {}", scheme.key());
                column(&source, sampled(&gauge.time, &gauge.stress));
            }
        }
        panels.push(own);
    }
    write_columns(folder, number, &names, &columns)?;
    // Rows are runs, columns are schemes.
    let rows = panels.iter().map(Vec::len).max().unwrap_or(0);
    let ordered =
        (0..rows).flat_map(|row| panels.iter().filter_map(move |own| own.get(row).cloned()));
    finish(title, number, ordered.collect(), folder)
}

/// A sampled function at a place, linear between samples.
pub fn at(x: &[f64], y: &[f64], place: f64) -> f64 {
    let right = x
        .partition_point(|&x| x <= place)
        .clamp(1, x.len().max(2) - 1);
    let (Some(&a), Some(&b)) = (x.get(right - 1), x.get(right)) else {
        return y.first().copied().unwrap_or(0.0);
    };
    y[right - 1] + (y[right] - y[right - 1]) * (place - a) / (b - a)
}

fn write_columns(
    folder: &Path,
    number: usize,
    names: &[String],
    columns: &[Vec<f64>],
) -> Result<(), Failure> {
    let mut file = CsvWriter::create(folder.join(format!("figure{number}.csv")), names)?;
    let count = columns.first().map_or(0, Vec::len);
    file.rows((0..count).map(|k| {
        let value = |column: &Vec<f64>| column.get(k).copied().unwrap_or(f64::NAN);
        columns.iter().map(value).collect::<Vec<_>>()
    }))?;
    Ok(())
}
