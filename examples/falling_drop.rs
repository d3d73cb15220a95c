//! A drop that falls on a film of water: the splash, the pressure below it, and the impulse that the pan takes.
//! `cargo run --release --example falling_drop -- --help` lists the options.

mod common;

use common::{Example, Failure, Options, Shade, picture};
use meshfree::observe::PressureProbe;
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::Figure;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};

const EXAMPLE: Example = Example {
    name: "falling_drop",
    about: "A cylinder of water, 20 mm across, falls at 4 m/s on a film of 8 mm in a pan, in a plane.",
    schemes: &["weakly-compressible"],
    own: &[],
};

pub(crate) fn main() -> std::process::ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let (radius, depth, width, speed, gravity) = (0.010, 0.008, 0.200, 4.0, [0.0, -9.81]);
    let dx = options.spacing_or(0.0005, 0.001);
    let water = || catalogue::weakly_compressible_water(2.0 * speed);
    let film = Body::block("film", water(), [0.0; 2], [width, depth], dx);
    let ball = Ball::new([0.5 * width, depth + radius + dx], radius);
    let drop = Body::fill("drop", water(), &ball, dx).velocity([0.0, -speed]);
    let pan = [[true; 2], [true, false]];
    let pan = Wall::around("pan", [0.0; 2], [width, 0.08], dx, 3, pan);
    let mut now = Scene::<T, 2>::new(schemes::weakly_compressible())
        .body(film.hydrostatic(gravity, [0.0, depth]))
        .body(drop)
        .wall(pan)
        .acceleration(move |_| gravity)
        .build()?;
    let below = PressureProbe::disc(&now, "below", [0.5 * width, 0.0], [0.0, 1.0], 4.0 * dx)?;
    let columns = ["time_s", "pressure_pa", "impulse_n_s", "missing_n_s"];
    let mut table = CsvWriter::create(options.file("below.csv"), &columns)?;
    let start = now.ledger().whole;
    let mut panels = Vec::new();
    let summary = Run::new(&mut now, options.until_or(0.02, 0.01))
        .label("drop")
        .observe(Schedule::evenly(81), |now| {
            // What the water has lost, and its weight has given, is what the pan has got.
            let given = start.momentum[1] + gravity[1] * start.mass * now.time();
            let impulse = now.wall_impulse("pan")?[1];
            let missing = given - now.ledger().whole.momentum[1] - impulse;
            table.row(&[now.time(), below.pressure(now), impulse, missing])?;
            panels.push(picture(now, Shade::Speed, [0, 1], dx));
            Ok(())
        })
        .go()?;
    let shown = panels.into_iter().skip(20).step_by(20);
    let figure = Figure::new().columns(1).panel_size(720.0, 290.0);
    let figure = shown.fold(figure, Figure::panel);
    figure.save(options.file("splash.svg"))?;
    println!("{summary}\nwritten to {}", options.folder().display());
    Ok(())
}
