//! A drop that falls on a film of water, in a plane. It shows a body that fills a shape, a pressure probe, the impulse that
//! a wall takes, and pictures of one run at several times.
//! `cargo run --release --example falling_drop` leaves a picture, a table and files for ParaView in `out/falling_drop`.

use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};

/// Radius of the drop, depth of the film and width of the pan \[m\].
const RADIUS: f64 = 0.010;
const DEPTH: f64 = 0.008;
const WIDTH: f64 = 0.200;
/// Speed of the drop \[m/s\].
const SPEED: f64 = 4.0;
const GRAVITY: [f64; 2] = [0.0, -9.81];
const SPACING: f64 = 0.0005;

pub(crate) fn main() -> Result<(), Failure> {
    // The sound speed follows from the greatest expected speed, that of the splash.
    let water = || catalogue::weakly_compressible_water(2.0 * SPEED);
    let film = Body::block("film", water(), [0.0; 2], [WIDTH, DEPTH], SPACING);
    let ball = Ball::new([0.5 * WIDTH, DEPTH + RADIUS + SPACING], RADIUS);
    let drop = Body::fill("drop", water(), &ball, SPACING).velocity([0.0, -SPEED]);
    // Walls at both ends of x and at the lower end of y.
    let sides = [[true; 2], [true, false]];
    let pan = Wall::around("pan", [0.0; 2], [WIDTH, 0.08], SPACING, 3, sides);
    let mut splash = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(film.hydrostatic(GRAVITY, [0.0, DEPTH]))
        .body(drop)
        .wall(pan)
        .acceleration(|_| GRAVITY)
        .build()?;

    let (place, inwards) = ([0.5 * WIDTH, 0.0], [0.0, 1.0]);
    let below = PressureProbe::disc(&splash, "below", place, inwards, 4.0 * SPACING)?;
    let start = splash.ledger().whole;
    let columns = ["time_s", "pressure_pa", "impulse_n_s", "missing_n_s"];
    let mut table = CsvWriter::create("out/falling_drop/below.csv", &columns)?;
    let mut panels = Vec::new();
    let summary = Run::new(&mut splash, 0.02)
        .label("drop")
        .observe(Schedule::evenly(81), |now| {
            // What the water has lost, and its weight has given, is what the pan has got.
            let given = start.momentum[1] + GRAVITY[1] * start.mass * now.time();
            let impulse = now.wall_impulse("pan")?[1];
            let missing = given - now.ledger().whole.momentum[1] - impulse;
            table.row(&[now.time(), below.pressure(now), impulse, missing])?;
            Ok(())
        })
        .observe(Schedule::at([0.005, 0.01, 0.015, 0.02]), |now| {
            panels.push(picture(now));
            Ok(())
        })
        .paraview(Schedule::every(0.001), "out/falling_drop/splash.pvd")
        .go()?;
    let figure = Figure::new().columns(1).panel_size(720.0, 290.0);
    let figure = panels.into_iter().fold(figure, Figure::panel);
    figure.save("out/falling_drop/splash.svg")?;
    println!("{summary}\nwritten to out/falling_drop");
    Ok(())
}

/// Particles, coloured by their speed, with the same axes at all times.
fn picture(now: &Simulation<f64, 2>) -> Panel {
    let points = now.all().map(|p| {
        let ([x, y], [u, v]) = (p.position(), p.velocity());
        (x, y, u.hypot(v))
    });
    let speed = Axis::linear("speed", "m/s").range(0.0, 2.0 * SPEED);
    Panel::new(
        Axis::linear("x", "m").range(0.0, WIDTH),
        Axis::linear("y", "m").range(0.0, 0.08),
    )
    .cloud(Cloud::new(speed, points).diameter(SPACING))
    .equal_aspect()
    .title(&format!("t = {:.4} s", now.time()))
}
