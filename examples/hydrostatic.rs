//! Water at rest in a tank, next to the exact pressure: the first thing to try with a scheme for liquids. It shows a body that
//! starts in equilibrium, and how much particles move that should not.
//! `cargo run --release --example hydrostatic` leaves a picture, a table and files for ParaView in `out/hydrostatic`.

use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};

const DEPTH: f64 = 1.0;
const WIDTH: f64 = 0.5;
const GRAVITY: [f64; 2] = [0.0, -9.81];
const SPACING: f64 = 0.02;

pub(crate) fn main() -> Result<(), Failure> {
    // Nothing moves, but a liquid needs a sound speed: that of water that falls through its own depth.
    let fall = (2.0 * 9.81 * DEPTH).sqrt();
    let water = catalogue::weakly_compressible_water(fall);
    let water = Body::block("water", water, [0.0; 2], [WIDTH, DEPTH], SPACING);
    // Walls end above the surface, with as many layers as the kernel reaches through.
    let (top, sides) = ([WIDTH, DEPTH + 0.2], [[true; 2], [true, false]]);
    let tank = Wall::around("tank", [0.0; 2], top, SPACING, 4, sides);
    // A wider kernel leaves a tenth of the residual motion.
    let mut column = Scene::<f64, 2>::new(schemes::weakly_compressible().h_over_dx(2.0))
        .body(water.hydrostatic(GRAVITY, [0.0, DEPTH]))
        .wall(tank)
        .acceleration(|_| GRAVITY)
        .build()?;

    let exact = |height: f64| 1000.0 * 9.81 * (DEPTH - height);
    let columns = ["time_s", "error_over_rho_g_h", "fastest_m_s"];
    let mut table = CsvWriter::create("out/hydrostatic/rest.csv", &columns)?;
    let mut error = Vec::new();
    let summary = Run::new(&mut column, 4.0)
        .label("column")
        .observe(Schedule::evenly(81), |now| {
            let squares = now.all().map(|p| {
                let [_, height] = p.position();
                (p.pressure() - exact(height)).powi(2)
            });
            let mean = squares.sum::<f64>() / now.particles() as f64;
            let share = mean.sqrt() / exact(0.0);
            let speeds = now.all().map(|p| p.velocity()[0].hypot(p.velocity()[1]));
            table.row(&[now.time(), share, speeds.fold(0.0, f64::max)])?;
            error.push((now.time(), 100.0 * share));
            Ok(())
        })
        .paraview(Schedule::evenly(11), "out/hydrostatic/column.pvd")
        .go()?;

    let of_particles = column.all().map(|p| (1e-3 * p.pressure(), p.position()[1]));
    let of_theory = [0.0, DEPTH].map(|height| (1e-3 * exact(height), height));
    let [x, y] = [Axis::linear("pressure", "kPa"), Axis::linear("height", "m")];
    let pressure = Panel::new(x, y)
        .series(Series::markers("particles after 4 s", of_particles))
        .series(Series::line("exact", of_theory).reference());
    let [x, y] = [
        Axis::linear("time", "s"),
        Axis::linear("error of the pressure", "% of ρgH"),
    ];
    let error = Panel::new(x, y.from(0.0)).series(Series::line("root mean square", error));
    let figure = Figure::new().panel(pressure).panel(error);
    figure.save("out/hydrostatic/column.svg")?;
    println!("{summary}\nwritten to out/hydrostatic");
    Ok(())
}
