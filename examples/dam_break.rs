//! A column of water collapses in a tank, in a plane. It shows a gauge, a pressure probe on a wall, and a film that browsers
//! play.
//! `cargo run --release --features pictures --example dam_break` leaves a picture, a film, a table and files for ParaView in
//! `out/dam_break`.

use meshfree::output::film::Film;
use meshfree::output::picture::Picture;
use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};

/// Width and height of column and tank \[m\].
const COLUMN: [f64; 2] = [0.6, 0.3];
const TANK: [f64; 2] = [1.6, 0.6];
const GRAVITY: [f64; 2] = [0.0, -9.81];
const SPACING: f64 = 0.01;
const END: f64 = 1.0;

pub(crate) fn main() -> Result<(), Failure> {
    // The greatest expected speed is that of the front.
    let water = catalogue::weakly_compressible_water(2.0 * (9.81 * COLUMN[1]).sqrt());
    let column = Body::block("water", water, [0.0; 2], COLUMN, SPACING);
    let sides = [[true; 2], [true, false]];
    let walls = Wall::around("tank", [0.0; 2], TANK, SPACING, 3, sides);
    let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(column.hydrostatic(GRAVITY, [0.0, COLUMN[1]]))
        .wall(walls)
        .acceleration(|_| GRAVITY)
        .build()?;

    let (place, inwards) = ([TANK[0], 0.03], [-1.0, 0.0]);
    let probe = PressureProbe::disc(&tank, "far wall", place, inwards, 0.03)?;
    let gauge = WaveGauge::upwards(&tank, "under the column", [0.3, 0.0], 1)?;
    let columns = ["time_s", "pressure_pa", "height_m"];
    let mut table = CsvWriter::create("out/dam_break/history.csv", &columns)?;
    let mut curves = [const { Vec::new() }; 2];
    let mut film = Film::new("out/dam_break/film.png");
    let summary = Run::new(&mut tank, END)
        .label("dam break")
        .observe(Schedule::every(0.005), |now| {
            let (pressure, height) = (probe.pressure(now), gauge.height(now));
            table.row(&[now.time(), pressure, height])?;
            curves[0].push((now.time(), 1e-3 * pressure));
            curves[1].push((now.time(), 1e3 * height));
            Ok(())
        })
        .observe(Schedule::every(0.02), |now| {
            film.frame(now.time(), picture(now))?;
            Ok(())
        })
        .paraview(Schedule::every(0.02), "out/dam_break/water.pvd")
        .go()?;
    film.finish()?;

    let [pressure, height] = curves;
    let [x, y] = [Axis::linear("time", "s"), Axis::linear("pressure", "kPa")];
    let pressure = Panel::new(x, y).series(Series::line("on the far wall", pressure));
    let [x, y] = [Axis::linear("time", "s"), Axis::linear("height", "mm")];
    let height = Panel::new(x, y.from(0.0)).series(Series::line("at x = 0.3 m", height));
    let points = tank.all().map(|p| {
        let ([x, y], [u, v]) = (p.position(), p.velocity());
        (x, y, u.hypot(v))
    });
    let speed = Axis::linear("speed", "m/s").from(0.0);
    let [x, y] = [Axis::linear("x", "m"), Axis::linear("y", "m")];
    let water = Panel::new(x.range(0.0, TANK[0]), y.range(0.0, TANK[1]))
        .cloud(Cloud::new(speed, points).diameter(SPACING))
        .equal_aspect()
        .title(&format!("after {END} s"));
    let figure = Figure::new().columns(1).panel_size(640.0, 240.0);
    let panels = [pressure, height, water];
    let figure = panels.into_iter().fold(figure, Figure::panel);
    figure.save("out/dam_break/water.svg")?;
    println!("{summary}\nwritten to out/dam_break");
    Ok(())
}

/// The water, coloured by its pressure; all pictures of a film have one size and one range of colours.
fn picture(now: &Simulation<f64, 2>) -> Picture {
    let water = now.all().map(|p| (p.position(), 1e-3 * p.pressure()));
    let pressure = Axis::linear("pressure", "kPa").range(0.0, 3.0);
    let (low, high) = ([0.0; 2], TANK);
    let picture = Picture::new(960, 360).bounds(low, high).edges(low, high);
    picture.particles(pressure, SPACING, water)
}
