//! The Taylor bar: a cylinder of metal that strikes a rigid wall without friction, a quarter of it in space.
//! `cargo validate taylor_bar -- --help` lists the options.

#[path = "../common/mod.rs"]
mod common;
mod profile;
mod shots;

use common::{Example, Failure, Options, Own, Records};
use meshfree::effect::{FiniteStrainPlasticity, HourglassFree, Plasticity};
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Cloud, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::term::viscosity::{LimitedMonaghanGingold, MonaghanGingold};
use profile::Layers;
use std::collections::HashSet;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "taylor_bar",
    about: "A cylinder of metal strikes a rigid wall without friction.",
    schemes: &["impact by continuity"],
    own: &[
        Own {
            name: "--material",
            value: "NAME",
            help: "copper-j2 (the default), copper-jc, 4340, 6061",
        },
        Own {
            name: "--length",
            value: "MM",
            help: "length; 32.4",
        },
        Own {
            name: "--diameter",
            value: "MM",
            help: "diameter; 6.4",
        },
        Own {
            name: "--speed",
            value: "M/S",
            help: "speed; 227",
        },
        Own {
            name: "--spacing",
            value: "MM",
            help: "particle spacing; a sixteenth of the diameter, with --quick an eighth",
        },
        Own {
            name: "--formulation",
            value: "NAME",
            help: "updated (the default), total",
        },
        Own {
            name: "--remedy",
            value: "NAME",
            help: "of updated: hourglass-free (the default), none; total takes none",
        },
        Own {
            name: "--wall",
            value: "NAME",
            help: "mirror (the default), which the foot does not leave, or contact, which it may",
        },
        Own {
            name: "--smoothing",
            value: "RATIO",
            help: "of updated: smoothing length over spacing; 2, because spacings grow more than twofold across the foot",
        },
        Own {
            name: "--viscosity",
            value: "ALPHA",
            help: "linear coefficient of the artificial viscosity; 0.5, 0.1 with total",
        },
        Records::OPTION,
    ],
};

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform, None)
}

fn material(name: &str) -> Result<Material<f64>, Failure> {
    match name {
        "copper-j2" => Ok(catalogue::benchmark_copper()),
        "copper-jc" => Ok(catalogue::ofhc_copper()),
        "4340" => Ok(catalogue::steel_4340()),
        "6061" => Ok(catalogue::aluminium_6061_t6()),
        other => Err(format!(
            "--material: `{other}` is not accepted; it takes copper-j2, copper-jc, 4340 or 6061"
        )
        .into()),
    }
}

fn scheme(
    formulation: &str,
    remedy: &str,
    [alpha, smoothing]: [f64; 2],
) -> Result<Scheme<f64, 3>, Failure> {
    let updated = || {
        let scheme = schemes::updated_lagrangian().with_kernel(WendlandC2);
        let standard = *scheme.viscosity();
        scheme
            .with_viscosity(LimitedMonaghanGingold { alpha, ..standard })
            .h_over_dx(smoothing)
            .with(Plasticity)
    };
    match (formulation, remedy) {
        ("updated", "none") => Ok(updated().compose()),
        ("updated", "hourglass-free") => Ok(updated().with(HourglassFree::default()).compose()),
        ("total", "none") => Ok(schemes::total_lagrangian_impact()
            .with_viscosity(MonaghanGingold {
                alpha,
                ..MonaghanGingold::STANDARD
            })
            .with(FiniteStrainPlasticity)
            .compose()),
        _ => Err(format!(
            "--formulation: `{formulation}` with --remedy `{remedy}` is not accepted; they take updated or total, and none \
             or hourglass-free"
        )
        .into()),
    }
}

/// A bar \[m, m/s\], at rest but for its speed.
#[derive(Clone, Copy, Debug)]
pub struct Bar {
    /// Length \[m\].
    pub length: f64,
    /// Diameter \[m\].
    pub diameter: f64,
    /// Speed \[m/s\].
    pub speed: f64,
}

/// A quarter of the bar on a cubic lattice; layers fit its length.
fn quarter(bar: Bar, material: Material<f64>, spacing: f64) -> Body<f64, 3> {
    let radius = 0.5 * bar.diameter;
    let across = (radius / spacing).ceil() as usize;
    let layers = (bar.length / spacing).round().max(1.0) as usize;
    let mut points = Vec::new();
    for layer in 0..layers {
        for j in 0..across {
            for i in 0..across {
                let [x, y] = [i, j].map(|k| (k as f64 + 0.5) * spacing);
                if x.hypot(y) < radius {
                    points.push([x, y, (layer as f64 + 0.5) * bar.length / layers as f64]);
                }
            }
        }
    }
    Body::points_of("bar", material, points, spacing).velocity([0.0, 0.0, -bar.speed])
}

/// The particles next to the middle plane, which leave it as the bar widens.
fn cut(now: &Simulation<f64, 3>, spacing: f64) -> HashSet<usize> {
    let near = now.all().filter(|p| p.position()[1] < 0.75 * spacing);
    near.map(|p| p.id()).collect()
}

/// The bar as cut in its middle plane, coloured by plastic strain.
fn picture(now: &Simulation<f64, 3>, bar: Bar, spacing: f64, cut: &HashSet<usize>) -> Panel {
    let cut = now.all().filter(|p| cut.contains(&p.id()));
    let points = cut.flat_map(|p| {
        let [x, _, z] = p.position();
        let strain = p.scalar(Plasticity::STRAIN).unwrap_or(0.0);
        [(1e3 * x, 1e3 * z, strain), (-1e3 * x, 1e3 * z, strain)]
    });
    let side = 1.3e3 * bar.diameter;
    Panel::new(
        Axis::linear("x", "mm").range(-side, side),
        Axis::linear("z", "mm").range(0.0, 1.05e3 * bar.length),
    )
    .cloud(
        Cloud::new(Axis::linear("plastic strain", "1").from(0.0), points).diameter(1e3 * spacing),
    )
    .equal_aspect()
    .title(&format!("t = {:.0} µs", 1e6 * now.time()))
}

fn perform(options: &Options) -> Result<(), Failure> {
    let name = options.text("--material").unwrap_or("copper-j2");
    // Of the copper that the finite-element benchmark takes nothing was measured.
    let records = (name != "copper-j2").then(|| Records::of(options));
    let records = records.transpose()?;
    let bar = Bar {
        length: 1e-3 * options.number("--length", 32.4)?,
        diameter: 1e-3 * options.number("--diameter", 6.4)?,
        speed: options.number("--speed", 227.0)?,
    };
    let formulation = options.text("--formulation").unwrap_or("updated");
    let (usual, remedy) = match formulation {
        "total" => (0.1, "none"),
        _ => (0.5, "hourglass-free"),
    };
    let remedy = options.text("--remedy").unwrap_or(remedy);
    let alpha = options.number("--viscosity", usual)?;
    let smoothing = options.number("--smoothing", 2.0)?;
    let usual = 1e3 * bar.diameter / options.pick(16.0, 8.0);
    let spacing = 1e-3 * options.number("--spacing", usual)?;
    let until = options.until_or(80e-6, 40e-6);
    let metal = material(name)?;
    let down = [0.0, 0.0, -1.0];
    let facing = options.text("--wall").unwrap_or("mirror");
    let wall = match facing {
        "mirror" => MirrorPlane::symmetry([0.0; 3], down),
        "contact" => MirrorPlane::wall([0.0; 3], down),
        other => {
            return Err(
                format!("--wall: `{other}` is not accepted; it takes mirror or contact").into(),
            );
        }
    };
    let mut simulation = Scene::<f64, 3>::new(scheme(formulation, remedy, [alpha, smoothing])?)
        .body(quarter(bar, metal, spacing))
        .boundary(wall)
        .boundary(MirrorPlane::symmetry([0.0; 3], [-1.0, 0.0, 0.0]))
        .boundary(MirrorPlane::symmetry([0.0; 3], [0.0, -1.0, 0.0]))
        .build()?;
    let layers = Layers::of(&simulation, bar.diameter, spacing);
    let (start, plane) = (simulation.ledger().whole, cut(&simulation, spacing));

    let columns = [
        "time_s",
        "length_m",
        "foot_radius_m",
        "momentum_z_kg_m_s",
        "kinetic_j",
        "internal_j",
        "distortion_j",
        "plastic_work_j",
        "most_plastic_strain",
    ];
    let mut csv = CsvWriter::create(options.file("history.csv"), &columns)?;
    let mut movie = Pvd::create(options.file("bar.pvd"))?;
    let (mut frame, mut panels, mut lengths) = (0, Vec::new(), Vec::new());
    let summary = Run::new(&mut simulation, until)
        .label(EXAMPLE.name)
        .observe(Schedule::evenly(81), |now| {
            let whole = now.ledger().whole;
            let profile = layers.profile(now);
            let length = layers.length(now);
            let foot = profile.first().map_or(0.0, |own| own[1]);
            let strains = now.all().filter_map(|p| p.scalar(Plasticity::STRAIN));
            csv.row(&[
                now.time(),
                length,
                foot,
                whole.momentum[2],
                whole.kinetic,
                whole.internal,
                whole.total("distortion").unwrap_or(0.0),
                whole.total("plastic work").unwrap_or(0.0),
                strains.fold(0.0, f64::max),
            ])?;
            lengths.push((1e6 * now.time(), 1e3 * length, 1e3 * foot));
            if frame % 20 == 0 {
                movie.frame(now.time(), &now.vtu())?;
            }
            if [20, 80].contains(&frame) {
                panels.push(picture(now, bar, spacing, &plane));
            }
            frame += 1;
            Ok(())
        })
        .go()?;

    let profile = layers.profile(&simulation);
    let mut csv = CsvWriter::create(options.file("profile.csv"), &["z_m", "radius_m"])?;
    csv.rows(&profile)?;
    let (length, foot) = (layers.length(&simulation), profile[0][1]);
    let mut figure = Figure::new().title(&format!("Taylor bar, {name}, {} m/s", bar.speed));
    for panel in panels {
        figure = figure.panel(panel);
    }
    let outline = profile.iter().map(|[z, r]| (1e3 * r, 1e3 * z));
    figure
        .panel(
            Panel::new(
                Axis::linear("radius", "mm").from(0.0),
                Axis::linear("z", "mm").from(0.0),
            )
            .series(Series::line("profile", outline))
            .title("profile at the end"),
        )
        .panel(
            Panel::new(Axis::linear("time", "µs"), Axis::linear("", "mm").from(0.0))
                .series(Series::line(
                    "length",
                    lengths.iter().map(|own| (own.0, own.1)),
                ))
                .series(Series::line(
                    "foot radius",
                    lengths.iter().map(|own| (own.0, own.2)),
                )),
        )
        .columns(2)
        .save(options.file("taylor_bar.svg"))?;

    let last = simulation.ledger().whole;
    let mut report = format!(
        "Taylor bar of {name}, {:.2} x {:.2} mm at {} m/s, spacing {:.3} mm, formulation {formulation}, remedy {remedy}, wall {facing}, \
         viscosity {alpha}, smoothing {smoothing}\n\
         {summary}\n\
         length at the end         {:.3} mm ({:.4} of the first)\n\
         diameter of the foot      {:.3} mm (radius {:.3} mm)\n\
         kinetic energy left       {:.2e} of the first\n\
         plastic work              {:.4} of the first kinetic energy\n\
         drift of total energy     {:.1e}\n",
        1e3 * bar.length,
        1e3 * bar.diameter,
        bar.speed,
        1e3 * spacing,
        1e3 * length,
        length / bar.length,
        2e3 * foot,
        1e3 * foot,
        last.kinetic / start.kinetic,
        last.total("plastic work").unwrap_or(0.0) / start.kinetic,
        last.total_energy() / start.total_energy() - 1.0,
    );
    if last.kinetic < 0.01 * start.kinetic {
        report += &shots::compared(name, bar, length, 2.0 * foot, records.as_ref())?;
    }
    std::fs::write(options.file("report.txt"), &report)?;
    println!("{report}written to {}", options.folder().display());
    Ok(())
}
