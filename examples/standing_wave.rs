//! A standing wave in a tank of half its length, next to linear theory. It shows a start with velocities of an exact solution
//! and a gauge of the water's height.
//! `cargo run --release --example standing_wave` leaves a picture, a table and files for ParaView in `out/standing_wave`.

use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};
use meshfree::scene::Start;
use meshfree::study::standing_wave::StandingWave;

const LENGTH: f64 = 2.0;
const DEPTH: f64 = 1.0;
const AMPLITUDE: f64 = 0.05;
const GRAVITY: [f64; 2] = [0.0, -9.81];
const SPACING: f64 = 0.02;

pub(crate) fn main() -> Result<(), Failure> {
    let wave = StandingWave::new(LENGTH, DEPTH, AMPLITUDE)?.with_gravity(9.81)?;
    // A quarter of a period before its crest the surface is flat, and the water at its fastest.
    let flat = -0.25 * wave.period();
    let water = catalogue::weakly_compressible_water(2.0 * (9.81 * DEPTH).sqrt());
    let side = 0.5 * LENGTH;
    let water = Body::block("water", water, [0.0; 2], [side, DEPTH], SPACING)
        .hydrostatic(GRAVITY, [0.0, DEPTH])
        .start(|x, own| Start {
            velocity: wave.velocity(x, flat),
            ..own
        });
    let (top, sides) = ([side, DEPTH + 0.3], [[true; 2], [true, false]]);
    let tank = Wall::around("tank", [0.0; 2], top, SPACING, 4, sides);
    // A narrower kernel makes periods two thirds of a per cent too short.
    let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible().h_over_dx(2.0))
        .body(water)
        .wall(tank)
        .acceleration(|_| GRAVITY)
        .build()?;

    // The height of the water, further from the wall than the kernel reaches.
    let place = 0.1;
    let gauge = WaveGauge::upwards(&tank, "gauge", [place, 0.0], 1)?;
    let columns = ["time_s", "elevation_m", "linear_theory_m"];
    let mut table = CsvWriter::create("out/standing_wave/wave.csv", &columns)?;
    let mut curves = [const { Vec::new() }; 2];
    let summary = Run::new(&mut tank, 3.0 * wave.period())
        .label("wave")
        .observe(Schedule::evenly(121), |now| {
            let elevation = gauge.height(now) - DEPTH;
            let theory = wave.elevation(place, now.time() + flat);
            table.row(&[now.time(), elevation, theory])?;
            curves[0].push((now.time(), elevation));
            curves[1].push((now.time(), theory));
            Ok(())
        })
        .paraview(Schedule::evenly(31), "out/standing_wave/wave.pvd")
        .go()?;

    let [particles, theory] = curves;
    let [x, y] = [
        Axis::linear("time", "s"),
        Axis::linear("elevation at the gauge", "m"),
    ];
    let elevation = Panel::new(x, y)
        .series(Series::line("linear theory", theory).reference())
        .series(Series::line("particles", particles));
    let points = tank.all().map(|p| {
        let [x, y] = p.position();
        (x, y, 1e-3 * p.pressure())
    });
    let pressure = Axis::linear("pressure", "kPa").from(0.0);
    let picture = Panel::new(Axis::linear("x", "m"), Axis::linear("z", "m"))
        .cloud(Cloud::new(pressure, points).diameter(SPACING))
        .equal_aspect()
        .title("after three periods");
    let figure = Figure::new().panel(elevation).panel(picture);
    figure.save("out/standing_wave/wave.svg")?;
    println!("{summary}\nwritten to out/standing_wave");
    Ok(())
}
