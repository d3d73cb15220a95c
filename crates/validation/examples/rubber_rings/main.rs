//! Two rubber rings that collide in plane strain, whole or in pieces by the remedy of the tensile instability.
//! `cargo validate rubber_rings -- --help` lists the options.

#[path = "../common/mod.rs"]
mod common;
mod pieces;

use common::{Example, Failure, Options, Own};
use meshfree::coupling::ContactDensity;
use meshfree::effect::{ArtificialStress, HourglassFree, Hypoelastic, NeoHookean};
use meshfree::material::eos::Linear;
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Cloud, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::term::viscosity::LimitedMonaghanGingold;
use pieces::pieces;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "rubber_rings",
    about: "Two rubber rings, 3 and 4 cm in radius, that collide at 0.059 of the speed of sound each.",
    schemes: &["impact by continuity"],
    own: &[Own {
        name: "--remedy",
        value: "NAME",
        help: "corrected (the default: hourglass-free with corrected gradients), hourglass-free, artificial-stress, none, \
               total-lagrangian",
    }],
};

const INNER: f64 = 0.03;
const OUTER: f64 = 0.04;
const RHO: f64 = 1000.0;
const YOUNG: f64 = 2e6;
const POISSON: f64 = 0.3975;
/// Speed of each ring in units of the speed of sound √(K/ρ).
const MACH: f64 = 0.059;

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

fn bulk_modulus() -> f64 {
    YOUNG / (3.0 * (1.0 - 2.0 * POISSON))
}

fn scheme<T: Real>(remedy: &str) -> Result<Scheme<T, 2>, Failure> {
    let solid = schemes::impact_by_continuity().with(Hypoelastic);
    match remedy {
        "none" => Ok(solid.compose()),
        "artificial-stress" => Ok(solid.with(ArtificialStress::default()).compose()),
        "hourglass-free" => Ok(solid.with(HourglassFree::default()).compose()),
        // Nothing here is a shock, so a tenth of the viscosity does. Midpoint reconstruction would make pressures of neighbours alternate sooner.
        "corrected" => Ok(schemes::updated_lagrangian()
            .without_midpoint_reconstruction()
            .with_viscosity(LimitedMonaghanGingold {
                alpha: 0.2,
                beta: 2.0,
            })
            .with(HourglassFree::default())
            .compose()),
        "total-lagrangian" => Ok(schemes::total_lagrangian().with(NeoHookean).compose()),
        other => Err(format!(
            "--remedy: `{other}` is not accepted; it takes corrected, hourglass-free, artificial-stress, none or total-lagrangian"
        )
        .into()),
    }
}

/// A ring about (`centre`, 0) on a square lattice.
fn ring<T: Real>(name: &str, centre: f64, speed: f64, spacing: f64) -> Body<T, 2> {
    let law = Linear::from_elastic_constants(RHO, YOUNG, POISSON);
    let rubber = Material::new("rubber", law).with_shear_modulus(YOUNG / (2.0 * (1.0 + POISSON)));
    let n = (OUTER / spacing).ceil() as i32;
    let places = (-n..n).flat_map(|i| (-n..n).map(move |j| [i, j]));
    let points = places
        .map(|place| place.map(|k| (f64::from(k) + 0.5) * spacing))
        .filter(|[x, y]| (INNER..OUTER).contains(&x.hypot(*y)))
        .map(|[x, y]| [x + centre, y])
        .collect();
    Body::points_of(name, rubber, points, spacing).velocity([speed, 0.0])
}

/// Both rings, coloured by the tension −p.
fn picture<T: Real>(now: &Simulation<T, 2>, spacing: f64) -> Panel {
    let points = now.all().map(|particle| {
        let [x, y] = particle.position();
        (x, y, -1e-3 * particle.pressure())
    });
    Panel::new(
        Axis::linear("x", "m").range(-0.12, 0.12),
        Axis::linear("y", "m").range(-0.07, 0.07),
    )
    .cloud(Cloud::new(Axis::linear("tension", "kPa").range(-60.0, 60.0), points).diameter(spacing))
    .equal_aspect()
    .title(&format!("t = {:.1} ms", 1e3 * now.time()))
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let remedy = options.text("--remedy").unwrap_or("corrected");
    let spacing = options.spacing_or(1e-3, 2e-3);
    let until = options.until_or(0.03, 0.02);
    let speed = MACH * (bulk_modulus() / RHO).sqrt();
    let apart = OUTER + spacing;
    let [left, right] = [
        ring("left", -apart, speed, spacing),
        ring("right", apart, -speed, spacing),
    ];
    let scene = Scene::new(scheme::<T>(remedy)?).body(left);
    let contact = ContactDensity::new();
    let scene = match remedy {
        // Kernels of the bodies as built do not see each other.
        "total-lagrangian" => scene.body(right).couple("left", "right", contact),
        // A correction that knows one side makes a contact by kernels too stiff.
        "corrected" => scene
            .group(scheme(remedy)?, [right])
            .couple("left", "right", contact),
        _ => scene.body(right),
    };
    let mut rings = scene.build()?;
    let start = rings.ledger().whole;
    let columns = [
        "time_s",
        "momentum_x_kg_m_s",
        "kinetic_j",
        "internal_j",
        "distortion_j",
        "compression_j",
        "speed_of_left_m_s",
        "pieces",
    ];
    let mut csv = CsvWriter::create(options.file("history.csv"), &columns)?;
    let mut movie = Pvd::create(options.file("rings.pvd"))?;
    let (mut panels, mut history) = (Vec::new(), Vec::new());
    let mut frame = 0;
    let summary = Run::new(&mut rings, until)
        .label(EXAMPLE.name)
        .observe(Schedule::evenly(61), |now| {
            let ledger = now.ledger();
            let whole = &ledger.whole;
            let energy = |p: f64| p * p / (2.0 * bulk_modulus());
            let compression: f64 = now
                .all()
                .map(|p| p.mass() / p.density() * energy(p.pressure()))
                .sum();
            let distortion = whole.total("distortion").unwrap_or(0.0);
            // A total-Lagrangian ring knows its stored energy as one.
            let elastic = whole.total("elastic energy");
            let [distortion, compression] =
                elastic.map_or([distortion, compression], |all| [all, 0.0]);
            let mut count = 0;
            for body in ["left", "right"] {
                let places: Vec<_> = now.body(body)?.map(|p| p.position()).collect();
                count += pieces(&places, 1.6 * spacing).len();
            }
            let left = &ledger.bodies[0].1;
            let row = [
                now.time(),
                whole.momentum[0],
                whole.kinetic,
                whole.internal,
                distortion,
                compression,
                left.momentum[0] / left.mass,
                count as f64,
            ];
            csv.row(&row)?;
            history.push(row);
            if frame % 10 == 0 {
                movie.frame(now.time(), &now.vtu())?;
            }
            if [0, 20, 60].contains(&frame) {
                panels.push(picture(now, spacing));
            }
            frame += 1;
            Ok(())
        })
        .go()?;

    let share = |k: usize| {
        history
            .iter()
            .map(move |row| (1e3 * row[0], row[k] / start.kinetic))
    };
    let mechanical = history
        .iter()
        .map(|row| (1e3 * row[0], (row[2] + row[4] + row[5]) / start.kinetic));
    let mut figure = Figure::new().title(&format!("rubber rings, remedy: {remedy}"));
    for panel in panels {
        figure = figure.panel(panel);
    }
    let shares = Axis::linear("energy / energy of motion at the start", "1").range(0.0, 1.5);
    figure
        .panel(
            Panel::new(Axis::linear("time", "ms"), shares)
                .series(Series::line("kinetic", share(2)))
                .series(Series::line("distortion", share(4)))
                .series(Series::line("compression", share(5)))
                .series(Series::line("sum of these", mechanical)),
        )
        .columns(2)
        .save(options.file("rings.svg"))?;

    let last = history.last().ok_or("no time was given")?;
    let end = rings.ledger().whole;
    let contact = end.total("work of couplings").unwrap_or(0.0);
    let report = format!(
        "Rubber rings at {:.2} m/s each, spacing {spacing} m, remedy {remedy}\n{summary}\n\
         most pieces of the two rings         {}\n\
         speed of the left ring at the end    {:+.3} of that before, away from the other\n\
         kinetic energy at the end            {:.3} of that before\n\
         with distortion and compression      {:.3}\n\
         work of the contact                  {:+.4}\n\
         momentum                             {:.1e} of that of a ring\n\
         drift of total energy                {:.1e}\n",
        speed,
        history.iter().map(|row| row[7]).fold(0.0, f64::max),
        -last[6] / speed,
        last[2] / start.kinetic,
        (last[2] + last[4] + last[5]) / start.kinetic,
        contact / start.kinetic,
        last[1].abs() / (0.5 * start.mass * speed),
        (end.total_energy() - contact) / start.total_energy() - 1.0,
    );
    std::fs::write(options.file("report.txt"), &report)?;
    println!("{report}written to {}", options.folder().display());
    Ok(())
}
