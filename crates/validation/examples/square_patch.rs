//! A square patch of liquid that spins and stretches into four arms, with and without what keeps a liquid in tension even.
//! `cargo validate square_patch -- --help` lists the options.

#[path = "common/mod.rs"]
mod common;

use common::{Example, Failure, Options, Own};
use meshfree::effect::{ArtificialPressure, PairingControl};
use meshfree::material::SoundSpeed;
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Cloud, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::scene::Start;
use meshfree::simulation::Thresholds;
use std::f64::consts::PI;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "square_patch",
    about: "A spinning square patch of liquid under its own tension, with a verdict on its stability.",
    schemes: &["weakly compressible"],
    own: &[Own {
        name: "--remedy",
        value: "NAME",
        help: "none, shifting, even (the default: shifting, artificial pressure and pairing control)",
    }],
};

const RHO: f64 = 1000.0;
/// Ten times the speed of a corner, to a tenth and a half.
const SOUND: f64 = 10.0;

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

/// One composition, whose remedies act with strengths that may be zero.
fn scheme<T: Real>(remedy: &str) -> Result<Scheme<T, 2>, Failure> {
    let (shifting, share, strength) = match remedy {
        "none" => (0.0, 0.0, 0.0),
        "shifting" => (2.0, 0.0, 0.0),
        "even" => {
            let [pressure, pairing] = [
                ArtificialPressure::default().share,
                PairingControl::default().strength,
            ];
            (2.0, pressure, pairing)
        }
        other => {
            return Err(format!(
                "--remedy: `{other}` is not accepted; it takes none, shifting or even"
            )
            .into());
        }
    };
    Ok(schemes::weakly_compressible()
        .with(Shifting::Concentration {
            strength: shifting,
            free_surface: true,
        })
        .with(ArtificialPressure {
            share,
            ..ArtificialPressure::default()
        })
        .with(PairingControl { strength })
        .compose())
}

/// The pressure \[Pa\] of the incompressible patch of unit side at the start, as a double sine series of ∇²p = 2 ρ ω² with
/// p = 0 on the sides; (0, 0) is a corner.
fn pressure([x, y]: [f64; 2]) -> f64 {
    let odd = || (1..60).step_by(2).map(f64::from);
    let term = |m: f64, n: f64| {
        let wave = (m * PI * x).sin() * (n * PI * y).sin();
        -32.0 * RHO * wave / (m * n * PI * PI * (m * m + n * n) * PI * PI)
    };
    odd().flat_map(|m| odd().map(move |n| term(m, n))).sum()
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let remedy = options.text("--remedy").unwrap_or("even");
    let spacing = options.spacing_or(0.01, 0.02);
    let until = options.until_or(4.0, 4.0);
    let spin = |[x, y]: [f64; 2], start| Start {
        velocity: [y, -x],
        density: RHO + pressure([x + 0.5, y + 0.5]) / (SOUND * SOUND),
        ..start
    };
    let water = catalogue::water_at(SoundSpeed::Chosen(SOUND));
    let body = Body::block("patch", water, [-0.5; 2], [0.5; 2], spacing).start(spin);
    let mut patch = Scene::new(scheme::<T>(remedy)?).body(body).build()?;
    patch.keep_stability(Thresholds {
        nearest: 0.5,
        every: 50,
        ..Thresholds::default()
    });
    let columns = [
        "time_s",
        "nearest_spacings",
        "within_half_a_spacing",
        "angular_momentum_kg_m2_s",
        "kinetic_j",
    ];
    let mut csv = CsvWriter::create(options.file("history.csv"), &columns)?;
    let mut movie = Pvd::create(options.file("patch.pvd"))?;
    let (mut panels, mut history): (Vec<Panel>, Vec<[f64; 5]>) = (Vec::new(), Vec::new());
    let mut frame = 0;
    let summary = Run::new(&mut patch, until)
        .label(EXAMPLE.name)
        .observe(Schedule::evenly(41), |now| {
            let turn = |p: meshfree::simulation::ParticleView<'_, T, 2>| {
                let ([x, y], [u, v]) = (p.position(), p.velocity());
                p.mass() * (x * v - y * u)
            };
            let report = now.stability();
            let [nearest, close] = report
                .arrangement
                .map_or([1.0, 0.0], |now| [now.nearest, now.close]);
            let row = [
                now.time(),
                nearest,
                close,
                now.all().map(turn).sum(),
                now.ledger().whole.kinetic,
            ];
            csv.row(&row)?;
            history.push(row);
            if frame % 10 == 0 {
                movie.frame(now.time(), &now.vtu())?;
            }
            if [10, 20, 40].contains(&frame) {
                let points = now.all().map(|p| {
                    let [x, y] = p.position();
                    (x, y, p.pressure())
                });
                let color = Axis::linear("pressure", "Pa").range(-100.0, 100.0);
                let reach = [0.0, 1.1, 1.6, 0.0, 2.9][frame / 10];
                panels.push(
                    Panel::new(
                        Axis::linear("x", "m").range(-reach, reach),
                        Axis::linear("y", "m").range(-reach, reach),
                    )
                    .cloud(Cloud::new(color, points).diameter(spacing))
                    .equal_aspect()
                    .title(&format!("t = {:.0} s", now.time())),
                );
            }
            frame += 1;
            Ok(())
        })
        .go()?;
    let mut figure = Figure::new().title(&format!("spinning square patch, remedy: {remedy}"));
    for panel in panels {
        figure = figure.panel(panel);
    }
    figure
        .panel(
            Panel::new(
                Axis::linear("time", "s"),
                Axis::linear("nearest pair / spacing", "1").from(0.0),
            )
            .series(Series::line(
                remedy,
                history.iter().map(|row| (row[0], row[1])),
            )),
        )
        .columns(2)
        .save(options.file("patch.svg"))?;
    let (first, last) = (history[0], history[history.len() - 1]);
    let report = format!(
        "Spinning square patch of unit side at 1/s, spacing {spacing} m, remedy {remedy}\n{summary}\n\
         angular momentum {:+.4}, kinetic energy {:+.4} of that at the start\n{}",
        last[3] / first[3] - 1.0,
        last[4] / first[4] - 1.0,
        patch.stability(),
    );
    std::fs::write(options.file("report.txt"), &report)?;
    println!("{report}written to {}", options.folder().display());
    Ok(())
}
