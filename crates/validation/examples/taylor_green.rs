//! Taylor–Green vortices: an array of eddies in a periodic square that only viscosity slows.
//! `cargo validate taylor_green -- --help` lists the options.

mod common;

use common::{Example, Failure, Options, Own, Shade, evenly, picture};
use meshfree::material::{Liquid, Material, SoundSpeed};
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::scene::Start;
use meshfree::scheme::Shifting;
use meshfree::study::taylor_green::TaylorGreen;
use meshfree::term::LaminarViscosity;
use meshfree::term::viscosity::Inviscid;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "taylor_green",
    about: "Decay of Taylor-Green vortices of 1 m/s in a periodic square of 1 m.",
    schemes: &["shifting", "transport", "unshifted"],
    own: &[Own {
        name: "--reynolds",
        value: "RE",
        help: "Reynolds number; 100",
    }],
};

/// Sound speed in units of the greatest speed.
const SOUND: f64 = 10.0;

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

fn scene<T: Real>(options: &Options, flow: TaylorGreen, spacing: f64) -> Scene<T, 2> {
    let material: Material<T> = Liquid::new(1.0, 1480.0, flow.kinematic_viscosity())
        .linear()
        .material("liquid", SoundSpeed::Chosen(SOUND));
    let liquid = Body::block("liquid", material, [0.0; 2], [1.0; 2], spacing);
    // The pressure of the exact flow, so that no sound starts with it.
    let liquid = liquid.start(|x, start| Start {
        velocity: flow.velocity(x, 0.0),
        density: 1.0 + flow.pressure(x, 0.0) / (SOUND * SOUND),
        ..start
    });
    let scheme = schemes::weakly_compressible()
        .with_viscosity(Inviscid)
        .with(Laminar(LaminarViscosity));
    let scheme: Scheme<T, 2> = match options.scheme.as_str() {
        "shifting" => scheme.with(Shifting::CLOSED).compose(),
        "transport" => scheme.with(Shifting::TRANSPORT).compose(),
        _ => scheme.compose(),
    };
    Scene::new(scheme)
        .body(liquid)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let flow = TaylorGreen::new(options.number("--reynolds", 100.0)?)?;
    let spacing = options.spacing_or(0.01, 0.02);
    let until = options.until_or(1.0, 0.5);
    let mut simulation = scene::<T>(options, flow, spacing).build()?;

    let columns = ["time_s", "speed_m_s", "exact_m_s", "error_percent"];
    let mut csv = CsvWriter::create(options.file("decay.csv"), &columns)?;
    let mut movie = Pvd::create(options.file("vortices.pvd"))?;
    let (mut decay, mut worst) = (Vec::new(), 0.0_f64);
    let summary = Run::new(&mut simulation, until)
        .label(EXAMPLE.name)
        .observe(Schedule::evenly(21), |now| {
            let energy: f64 = now
                .all()
                .map(|particle| {
                    let [u, v] = particle.velocity();
                    0.5 * particle.mass() * (u * u + v * v)
                })
                .sum();
            // The greatest speed that belongs to the energy: the greatest of one particle is noise.
            let exact = flow.greatest_speed(now.time());
            let speed = exact * (energy / flow.kinetic_energy(now.time())).sqrt();
            let error = speed / exact - 1.0;
            worst = if error.abs() > worst.abs() {
                error
            } else {
                worst
            };
            csv.row(&[now.time(), speed, exact, 100.0 * error])?;
            decay.push((now.time(), speed));
            movie.frame(now.time(), &now.vtu_with_walls())?;
            Ok(())
        })
        .go()?;

    let exact = evenly(until, 101).into_iter();
    let exact = exact.map(|t| (t, flow.greatest_speed(t)));
    Figure::new()
        .panel(
            Panel::new(
                Axis::linear("time", "s"),
                Axis::linear("greatest speed", "m/s"),
            )
            .series(Series::line("exact", exact).reference())
            .series(Series::markers(&options.scheme, decay)),
        )
        .panel(picture(&simulation, Shade::Speed, [0, 1], spacing))
        .save(options.file("vortices.svg"))?;
    println!(
        "{summary}\nlargest error of the speed until {until} s: {:+.2} % (bar 1 %)\nwritten to {}",
        100.0 * worst,
        options.folder().display()
    );
    Ok(())
}
