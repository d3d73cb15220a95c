//! Hypervelocity impact of a sphere or cylinder on a thin plate, in a plane or in a quarter of space: hole and debris cloud.
//! `cargo validate hypervelocity -- --help` lists the options.

mod cases;
mod cloud;
#[path = "../common/mod.rs"]
mod common;
mod draw;

use cases::Case;
use cloud::Measured;
use common::{Example, Failure, Options, Own};
use meshfree::effect::{Damage, DensityFloor, Hypoelastic, Plasticity};
use meshfree::output::csv::CsvWriter;
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::term::viscosity::MonaghanGingold;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "hypervelocity",
    about: "A sphere or cylinder strikes a thin plate at several kilometres a second.",
    schemes: &["hypervelocity"],
    own: &[
        Own {
            name: "--case",
            value: "NAME",
            help: "hiermaier (the default: aluminium at 6.18 km/s), howell (steel on aluminium at 3.1 km/s)",
        },
        Own {
            name: "--dimension",
            value: "2|3",
            help: "2 (the default): cylinder and slab in plane strain; 3: sphere and plate, a quarter of them",
        },
        Own {
            name: "--spacing",
            value: "MM",
            help: "particle spacing; 0.25 in a plane, 0.5 in space",
        },
        Own {
            name: "--time",
            value: "US",
            help: "end of the run; 20, of howell 8",
        },
        Own {
            name: "--viscosity",
            value: "ALPHA",
            help: "linear coefficient of the artificial viscosity, the quadratic one is twice that; 1",
        },
    ],
};

pub(crate) fn main() -> ExitCode {
    common::main(
        &EXAMPLE,
        |options| match options.text("--dimension").unwrap_or("2") {
            "2" => perform::<2>(options),
            "3" => perform::<3>(options),
            other => Err(format!("--dimension: `{other}` is not accepted; it takes 2 or 3").into()),
        },
        None,
    )
}

fn perform<const D: usize>(options: &Options) -> Result<(), Failure>
where
    CubicSpline: Kernel<D>,
{
    let case = Case::of(options)?;
    let usual = match D {
        2 => options.pick(0.25, 0.5),
        _ => options.pick(0.5, 1.0),
    };
    let spacing = 1e-3 * options.number("--spacing", usual)?;
    let until = 1e-6
        * options.number(
            "--time",
            options.pick(case.microseconds, 0.4 * case.microseconds),
        )?;
    let alpha = options.number("--viscosity", 1.0)?;
    // Continuity and pressure by mass, plain viscosity and no midpoint reconstruction: in debris densities of neighbours differ
    // tenfold and gradients rest on a handful of them. Volume form breaks within 2 µs, and `schemes::impact` within 4.
    let viscosity = MonaghanGingold {
        alpha,
        beta: 2.0 * alpha,
    };
    let scheme = SchemeBuilder::new(CubicSpline, viscosity)
        .named("hypervelocity")
        .density(DensityForm::ContinuityByMass)
        .energy(EnergyForm::Compatible)
        .with(Hypoelastic)
        .with(Plasticity)
        .with(Damage)
        .with(DensityFloor::default())
        .compose();
    let mut scene = Scene::<f64, D>::new(scheme)
        .body(case.projectile(spacing))
        .body(case.plate(spacing));
    for axis in 1..D {
        let mut normal = [0.0; D];
        normal[axis] = -1.0;
        scene = scene.boundary(MirrorPlane::symmetry([0.0; D], normal));
    }
    let mut simulation = scene.build()?;
    let start = simulation.ledger().whole;

    let columns = [
        "time_s",
        "kinetic_j",
        "internal_j",
        "distortion_j",
        "plastic_work_j",
        "failed_mass_kg",
        "momentum_x_kg_m_s",
        "drift_of_energy",
        "front_m",
        "front_speed_m_s",
        "hole_m",
    ];
    let mut csv = CsvWriter::create(options.file("ledger.csv"), &columns)?;
    let mut movie = Pvd::create(options.file("cloud.pvd"))?;
    let (mut frame, mut panels, mut history) = (0, Vec::new(), Vec::new());
    let watched = Run::new(&mut simulation, until)
        .label(EXAMPLE.name)
        .observe(Schedule::evenly(41), |now| {
            let whole = now.ledger().whole;
            let seen = Measured::of(now, &case, spacing);
            let row = [
                now.time(),
                whole.kinetic,
                whole.internal,
                whole.total("distortion").unwrap_or(0.0),
                whole.total("plastic work").unwrap_or(0.0),
                whole.total("failed mass").unwrap_or(0.0),
                whole.momentum[0],
                whole.total_energy() / start.total_energy() - 1.0,
                seen.front,
                seen.front_speed,
                seen.hole,
            ];
            csv.row(&row)?;
            history.push(row);
            if frame % 10 == 0 {
                movie.frame(now.time(), &now.vtu())?;
            }
            if [10, 20, 40].contains(&frame) {
                panels.push(draw::bodies(now, &case, spacing));
            }
            frame += 1;
            Ok(())
        })
        .go();
    if watched.is_err() {
        // What broke can be looked at.
        simulation.vtu().write(options.file("broken.vtu"))?;
    }
    let summary = watched?;
    panels.push(draw::damage(&simulation, &case, spacing));
    panels.push(draw::energies(&history, start.kinetic));
    panels.push(draw::growth(&history));
    draw::save(&options.file("cloud.svg"), &case, panels)?;

    let last = simulation.ledger().whole;
    let seen = Measured::of(&simulation, &case, spacing);
    let report = format!(
        "{}, {D} dimensions, spacing {:.3} mm, viscosity {alpha}, to {:.1} µs\n{summary}\n\
         {}\
         failed mass                 {:.4} of the whole\n\
         kinetic energy at the end   {:.4} of the first\n\
         momentum along the impact   {:+.1e} of the first\n\
         drift of total energy       {:.1e}\n\
         densities held              {}, a particle and step\n",
        case.about,
        1e3 * spacing,
        1e6 * simulation.time(),
        seen.report(&case, D),
        last.total("failed mass").unwrap_or(0.0) / last.mass,
        last.kinetic / start.kinetic,
        last.momentum[0] / start.momentum[0] - 1.0,
        last.total_energy() / start.total_energy() - 1.0,
        simulation.limited("density floor"),
    );
    std::fs::write(options.file("report.txt"), &report)?;
    println!("{report}written to {}", options.folder().display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::EXAMPLE;

    fn read(line: &str) -> Result<super::Options, String> {
        let line = format!("hypervelocity {line}");
        let read = EXAMPLE.read(line.split_whitespace());
        read.map_err(|bad| bad.to_string())
    }

    #[test]
    fn lines_are_read_with_what_an_example_adds_and_what_it_changes() {
        let plain = read("").unwrap();
        assert!(!plain.quick && !plain.single && plain.scheme == EXAMPLE.schemes[0]);
        assert!(plain.file("a.csv").ends_with("out/hypervelocity/a.csv"));
        let options = read("--quick --precision=f32 --out x --spacing 0.5 --viscosity 2").unwrap();
        assert!(options.quick && options.single && options.file("a").ends_with("x/a"));
        // The spacing is in millimetres here, and so it is not the common one.
        assert_eq!(options.spacing_or(1.0, 7.0), 7.0);
        assert_eq!(options.number("--spacing", 1.0), Ok(0.5));
        assert_eq!(options.number("--viscosity", 1.0), Ok(2.0));
    }

    #[test]
    fn bad_options_name_themselves_and_what_they_take() {
        for (line, says) in [
            ("--until -1", ["--until", "above 0"]),
            ("--threads 0", ["--threads", "1..=1024"]),
            ("--precision f16", ["--precision", "f64 or f32"]),
            ("--scheme best", ["'best'", "possible values"]),
            ("--sped 3", ["'--sped'", "unexpected"]),
        ] {
            let message = read(line).map(|_| ()).unwrap_err();
            assert!(says.iter().all(|part| message.contains(part)), "{message}");
        }
    }
}
