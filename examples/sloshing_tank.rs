//! Water in a closed tank that is thrown sideways at 30 g for 80 ms, in space (Vesenjak & Ren 2007). It shows an accelerated
//! frame, pressure probes, forces on walls, a picture of particles in space and files for ParaView.
//! `cargo run --release --features pictures,progress --example sloshing_tank` leaves them in `out/sloshing_tank`; a spacing
//! \[m\] may follow after `--`. The package `meshfree-validation` has the same tank with all its checks.

use meshfree::output::picture::Picture;
use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};
use std::f64::consts::PI;

/// Inner size of the tank and depth of the water \[m\].
const SIZE: [f64; 3] = [0.5, 0.3, 0.3];
const DEPTH: f64 = 0.18;
/// Peak of the acceleration \[m/s²\] and length of its half sine \[s\].
const PEAK: f64 = 30.0 * 9.80665;
const PULSE: f64 = 0.08;
const GRAVITY: f64 = 9.81;

pub(crate) fn main() -> Result<(), Failure> {
    let argument = std::env::args().nth(1);
    let spacing: f64 = argument.map_or(Ok(0.015), |text| text.parse())?;

    // The pressure of the water ends at that of the air. Disorder keeps layers of the lattice from staying at walls.
    let speed = (2.0 * PEAK * SIZE[0]).sqrt();
    let water = catalogue::weakly_compressible_water(speed).with_pressure_cut_off(0.0);
    let filled = [SIZE[0], SIZE[1], DEPTH];
    let water = Body::block("water", water, [0.0; 3], filled, spacing)
        .hydrostatic([0.0, 0.0, -GRAVITY], [0.0, 0.0, DEPTH])
        .jitter(0.15, 1);
    let walls = Wall::around("tank", [0.0; 3], SIZE, spacing, 3, [[true; 2]; 3]);
    // What is at rest in the frame of the tank feels the tank's acceleration, reversed.
    let pulse = |t: f64| PEAK * (PI * t / PULSE).sin().max(0.0);
    let scheme = schemes::weakly_compressible().with(Shifting::STANDARD);
    let mut tank = Scene::<f64, 3>::new(scheme)
        .body(water)
        .wall(walls)
        .acceleration(move |t| [pulse(t), 0.0, -GRAVITY])
        .build()?;

    let heights = [0.05, 0.15, 0.25];
    let probes = heights.map(|z| {
        let place = [SIZE[0], 0.5 * SIZE[1], z];
        PressureProbe::disc(&tank, &format!("{z} m"), place, [-1.0, 0.0, 0.0], 0.02)
    });
    let [low, middle, high] = probes;
    let probes = [low?, middle?, high?];
    let columns = ["time_s", "low_pa", "middle_pa", "high_pa", "force_x_n"];
    let mut table = CsvWriter::create("out/sloshing_tank/pressure.csv", &columns)?;
    let mut pressures = [const { Vec::new() }; 3];
    let summary = Run::new(&mut tank, PULSE)
        .label("tank")
        .observe(Schedule::every(2e-4), |now| {
            let [low, middle, high] = probes.each_ref().map(|probe| probe.pressure(now));
            for (curve, pressure) in pressures.iter_mut().zip([low, middle, high]) {
                curve.push((1e3 * now.time(), 1e-3 * pressure));
            }
            table.row(&[now.time(), low, middle, high, now.wall_force("tank")?[0]])?;
            Ok(())
        })
        .observe(Schedule::at([0.038]), |now| {
            picture(now, spacing).save("out/sloshing_tank/water_38ms.svg")?;
            Ok(())
        })
        .paraview(Schedule::every(0.002), "out/sloshing_tank/water.pvd")
        .go()?;

    let axes = [Axis::linear("time", "ms"), Axis::linear("pressure", "kPa")];
    let [time, pressure] = axes;
    let mut panel = Panel::new(time, pressure).title("on the struck wall");
    for (z, curve) in heights.iter().zip(pressures) {
        panel = panel.series(Series::line(&format!("z = {z} m"), curve));
    }
    Figure::new()
        .panel(panel)
        .save("out/sloshing_tank/pressure.svg")?;
    println!("{summary}\nwritten to out/sloshing_tank");
    Ok(())
}

/// The water in space, coloured by its pressure.
fn picture(now: &Simulation<f64, 3>, spacing: f64) -> Picture {
    let water = now.all().map(|p| (p.position(), 1e-3 * p.pressure()));
    let pressure = Axis::linear("pressure", "kPa").range(0.0, 150.0);
    Picture::new(1200, 800)
        .title(&format!("t = {:.0} ms", 1e3 * now.time()))
        .view(-70.0, 15.0)
        .particles(pressure, spacing, water)
        .edges([0.0; 3], SIZE)
}
