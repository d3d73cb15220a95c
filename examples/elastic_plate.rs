//! A free elastic plate that swings, next to Timoshenko's beam. It shows a total-Lagrangian solid, hyperelastic and without
//! dissipation, and a study's reference for the period.
//! `cargo run --release --example elastic_plate` leaves a picture, a table and files for ParaView in `out/elastic_plate`.

use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};
use meshfree::scene::Start;
use meshfree::study::free_beam::FreeBeam;

/// Length and height of the plate \[m\].
const SIZE: [f64; 2] = [0.2, 0.02];
const DENSITY: f64 = 1000.0;
/// Young's modulus \[Pa\] and Poisson's ratio.
const YOUNGS: f64 = 2e6;
const POISSON: f64 = 0.3975;
/// Ten particles through the thickness.
const SPACING: f64 = 0.002;
/// Half of the first speed of the ends \[m/s\].
const SPEED: f64 = 0.5;

pub(crate) fn main() -> Result<(), Failure> {
    let law = Linear::from_elastic_constants(DENSITY, YOUNGS, POISSON);
    let rubber = Material::new("rubber", law).with_shear_modulus(YOUNGS / (2.0 * (1.0 + POISSON)));
    // It starts straight, with the velocity of its first shape of bending.
    let beam = FreeBeam::new(SIZE[0], SIZE[1], DENSITY, YOUNGS, POISSON)?;
    let plate = Body::block("plate", rubber, [0.0; 2], SIZE, SPACING);
    let plate = plate.start(|[x, _], own| Start {
        velocity: [0.0, SPEED * beam.shape(x)],
        ..own
    });
    // Particles keep the neighbours of the reference configuration, so bodies stretch without breaking up.
    let scheme = schemes::total_lagrangian().with(NeoHookean);
    let mut plate = Scene::<f64, 2>::new(scheme).body(plate).build()?;

    let start = plate.ledger().whole.kinetic;
    let tip = plate.particles() - 1;
    let columns = ["time_s", "tip_m", "kinetic_j", "elastic_j"];
    let mut table = CsvWriter::create("out/elastic_plate/swing.csv", &columns)?;
    let mut curves = [const { Vec::new() }; 3];
    let mut pictures = Vec::new();
    let period = beam.period();
    let summary = Run::new(&mut plate, 2.0 * period)
        .label("plate")
        .observe(Schedule::evenly(201), |now| {
            let whole = now.ledger().whole;
            let elastic = whole.total("elastic energy").unwrap_or(0.0);
            let height = now.all().nth(tip).map_or(0.0, |p| p.position()[1]);
            let deflection = height - (SIZE[1] - 0.5 * SPACING);
            table.row(&[now.time(), deflection, whole.kinetic, elastic])?;
            let values = [1e3 * deflection, whole.kinetic / start, elastic / start];
            for (curve, value) in curves.iter_mut().zip(values) {
                curve.push((now.time() / period, value));
            }
            Ok(())
        })
        .observe(Schedule::at([0.25 * period]), |now| {
            pictures.push(picture(now));
            Ok(())
        })
        .paraview(Schedule::evenly(41), "out/elastic_plate/plate.pvd")
        .go()?;

    let [deflection, kinetic, elastic] = curves;
    let time = || Axis::linear("time over the period of Timoshenko's beam", "1");
    let deflection = Panel::new(time(), Axis::linear("deflection of an end", "mm"))
        .series(Series::line("particles", deflection))
        .mark_x(1.0);
    let energy = Panel::new(time(), Axis::linear("share of the energy", "1"))
        .series(Series::line("kinetic", kinetic))
        .series(Series::line("elastic", elastic));
    let figure = Figure::new().columns(1).panel_size(640.0, 240.0);
    let panels = [deflection, energy].into_iter().chain(pictures);
    let figure = panels.fold(figure, Figure::panel);
    figure.save("out/elastic_plate/plate.svg")?;
    println!("{summary}\nwritten to out/elastic_plate");
    Ok(())
}

/// The plate, coloured by its pressure.
fn picture(now: &Simulation<f64, 2>) -> Panel {
    let points = now.all().map(|p| {
        let [x, y] = p.position();
        (x, y, 1e-3 * p.pressure())
    });
    Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m"))
        .cloud(Cloud::new(Axis::linear("pressure", "kPa"), points).diameter(SPACING))
        .equal_aspect()
        .title("after a quarter of the period")
}
