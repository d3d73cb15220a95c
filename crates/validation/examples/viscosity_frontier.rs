//! The frontier of artificial viscosities: the rise of a front under each law, and its overshoot.
//! Copper rods at 20 m/s on copper and PMMA; writes a page of tables and a plot.

use clap::Parser;
use meshfree::kernel::CubicSpline;
use meshfree::material::catalogue;
use meshfree::output::svg::{Axis, Figure, Marker, PALETTE, Panel, Series};
use meshfree::output::table::{Table, significant};
use meshfree::scene::{Body, Scene};
use meshfree::scheme::{DensityForm, Scheme, SchemeBuilder};
use meshfree::study::norms::{overshoot, plateau_mean, rise_10_90};
use meshfree::term::MidpointReconstruction;
use meshfree::term::viscosity::ViscosityKind;
use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

/// Impact speed \[m/s\].
const SPEED: f64 = 20.0;
/// Length of each rod \[m\]: the probe, in the middle of the striker, sees one plateau.
const LENGTH: f64 = 0.010;
/// End of a run \[s\], and the interval of the plateau.
const END: f64 = 3.5e-6;
const PLATEAU: (f64, f64) = (2.0e-6, 3.2e-6);
/// Strengths of the midpoint reconstruction: none, and what cancels the leading dispersion.
const CURVATURES: [Option<f64>; 3] = [None, Some(0.25), Some(1.0 / 3.0)];
const TARGETS: [&str; 2] = ["copper", "pmma"];
/// The laws with the coefficients that are tried; `docs/rods.md` says why some of them
/// have to be so large.
const LAWS: [(&str, &[&str]); 8] = [
    ("none", &["none"]),
    ("mg", &["mg:0.1", "mg:0.25", "mg:0.5", "mg", "mg:1.5"]),
    (
        "limited",
        &[
            "limited:1",
            "limited",
            "limited:3",
            "limited:4",
            "limited:6",
        ],
    ),
    (
        "signal",
        &[
            "signal:0.1",
            "signal:0.25",
            "signal:0.5",
            "signal",
            "signal:1.5",
        ],
    ),
    ("balsara", &["balsara"]),
    (
        "morris-monaghan",
        &[
            "morris-monaghan",
            "morris-monaghan:30",
            "morris-monaghan:100",
            "morris-monaghan:300",
        ],
    ),
    (
        "cullen-dehnen",
        &[
            "cullen-dehnen",
            "cullen-dehnen:30",
            "cullen-dehnen:100",
            "cullen-dehnen:300",
        ],
    ),
    (
        "riemann",
        &[
            "riemann",
            "riemann:1,100",
            "riemann:1,300",
            "riemann:1,1000",
            "riemann:1,1e6",
        ],
    ),
];

/// What a run showed at the middle of the striker.
struct Front {
    /// Rise from 10 % to 90 % \[µs\].
    rise: f64,
    /// Overshoot in per cent of the plateau.
    overshoot: f64,
    steps: u64,
}

struct Case {
    law: usize,
    viscosity: ViscosityKind,
    curvature: Option<f64>,
    target: &'static str,
}

fn run(case: &Case, spacing: f64) -> Result<Front, Box<dyn Error>> {
    let plain = SchemeBuilder::new(CubicSpline, case.viscosity).density(DensityForm::NumberDensity);
    let scheme: Scheme<f64, 1> = match case.curvature {
        Some(strength) => plain.with(MidpointReconstruction { strength }).compose(),
        None => plain.compose(),
    };
    let target = catalogue::by_name(case.target)?;
    let copper = catalogue::copper();
    let mut simulation = Scene::<f64, 1>::new(scheme)
        .body(Body::block("striker", copper, [0.0], [LENGTH], spacing).velocity([SPEED]))
        .body(Body::block(
            "target",
            target,
            [LENGTH],
            [2.0 * LENGTH],
            spacing,
        ))
        .build()?;
    let middle = simulation.body("striker")?.count() / 2;
    let (mut times, mut pressures) = (vec![0.0], vec![0.0]);
    simulation.run_with(END, |now| {
        // The particles of the striker are the first.
        let two = now.all().skip(middle - 1).take(2);
        times.push(now.time());
        pressures.push(0.5 * two.map(|particle| particle.pressure()).sum::<f64>());
    })?;
    let plateau = plateau_mean(&times, &pressures, PLATEAU.0, PLATEAU.1)?;
    Ok(Front {
        rise: 1e6 * rise_10_90(&times, &pressures, 0.0, plateau)?,
        overshoot: 100.0 * overshoot(&pressures, 0.0, plateau)?,
        steps: simulation.steps(),
    })
}

fn cases(quick: bool) -> Result<Vec<Case>, Box<dyn Error>> {
    let mut cases = Vec::new();
    for (law, (_, texts)) in LAWS.iter().enumerate() {
        for text in texts.iter().take(if quick { 1 } else { texts.len() }) {
            for curvature in CURVATURES {
                for target in TARGETS {
                    if quick && (target != "copper" || curvature == Some(0.25)) {
                        continue;
                    }
                    cases.push(Case {
                        law,
                        viscosity: text.parse()?,
                        curvature,
                        target,
                    });
                }
            }
        }
    }
    Ok(cases)
}

fn curvature_name(curvature: Option<f64>) -> &'static str {
    match curvature {
        None => "0",
        Some(strength) if strength < 0.3 => "1/4",
        Some(_) => "1/3",
    }
}

fn table(results: &[(Case, Option<Front>)], target: &str) -> Table {
    let mut table = Table::new([
        "viscosity",
        "α",
        "β or limiter",
        "curvature",
        "rise [µs]",
        "overshoot [%]",
        "steps",
    ]);
    for (case, front) in results.iter().filter(|(case, _)| case.target == target) {
        let number = |value: Option<f64>| value.map_or("–".into(), |v| significant(v, 3));
        let (rise, over, steps) = front.as_ref().map_or_else(
            || ("–".into(), "broke".into(), "–".into()),
            |front| {
                (
                    format!("{:.3}", front.rise),
                    format!("{:.2}", front.overshoot),
                    front.steps.to_string(),
                )
            },
        );
        table.row([
            case.viscosity.key().to_owned(),
            number(case.viscosity.alpha()),
            number(case.viscosity.beta()),
            curvature_name(case.curvature).to_owned(),
            rise,
            over,
            steps,
        ]);
    }
    table
}

fn figure(results: &[(Case, Option<Front>)], targets: &[&str]) -> Figure {
    let mut figure = Figure::new()
        .title("Rise and overshoot of a 20 m/s impact front, copper striker")
        .shared_legend();
    let is_run = |target: &str, curvature: Option<f64>| {
        let mut cases = results.iter().map(|(case, _)| case);
        cases.any(|case| case.target == target && case.curvature == curvature)
    };
    for &target in targets {
        for curvature in CURVATURES.into_iter().filter(|own| is_run(target, *own)) {
            let mut panel = Panel::new(
                Axis::linear("rise 10–90 %", "µs").from(0.0),
                Axis::linear("overshoot", "%").range(0.0, 30.0),
            )
            .title(&format!(
                "{target}, curvature {}",
                curvature_name(curvature)
            ))
            .mark_x(0.14)
            .mark_y(3.0);
            for (law, (name, _)) in LAWS.iter().enumerate() {
                let own = |(case, _): &&(Case, Option<Front>)| {
                    case.law == law && case.target == target && case.curvature == curvature
                };
                let points: Vec<_> = results
                    .iter()
                    .filter(own)
                    .filter_map(|(_, front)| front.as_ref())
                    .map(|front| (front.rise, front.overshoot))
                    .collect();
                if points.is_empty() {
                    continue;
                }
                panel = panel.series(
                    Series::line(name, points)
                        .marker(Marker::Circle)
                        .color(PALETTE[law % PALETTE.len()]),
                );
            }
            figure = figure.panel(panel);
        }
    }
    let is_shown = |own: &&Option<f64>| targets.iter().any(|target| is_run(target, **own));
    figure.columns(CURVATURES.iter().filter(is_shown).count())
}

const TEXT: &str = include_str!("viscosity_frontier.md");

/// The command line.
#[derive(Parser)]
#[command(
    about = "Rise and overshoot of an impact front by each artificial viscosity: copper rods at 20 m/s."
)]
struct Line {
    /// Coarse and few, to see that it runs
    #[arg(long)]
    quick: bool,
    /// Where files go
    #[arg(long, value_name = "DIR", default_value = "out/viscosity_frontier")]
    out: PathBuf,
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let Line { quick, out } = Line::parse();
    let spacing = if quick { 1e-4 } else { 5e-5 };
    let start = Instant::now();
    let mut results = Vec::new();
    for case in cases(quick)? {
        // A run that breaks is a result too.
        let front = run(&case, spacing).ok();
        results.push((case, front));
    }
    let mut page = TEXT.to_owned();
    for target in TARGETS {
        let table = table(&results, target);
        println!(
            "copper on {target}, spacing {} mm\n\n{table}",
            spacing * 1e3
        );
        page += &format!("\n## Copper on {target}\n\n{}", table.markdown());
    }
    println!(
        "{} runs in {:.1} s",
        results.len(),
        start.elapsed().as_secs_f64()
    );
    std::fs::create_dir_all(&out)?;
    std::fs::write(out.join("viscosity_frontier.md"), page)?;
    figure(&results, &TARGETS).save(out.join("viscosity_frontier.svg"))?;
    println!("written to {}", out.display());
    Ok(())
}
