//! Taylor–Green vortices, which viscosity slows, next to their exact decay. It shows periodic boundaries, laminar viscosity,
//! particle shifting and a start by a function of place.
//! `cargo run --release --example taylor_green` leaves a picture, a table and files for ParaView in `out/taylor_green`.

use meshfree::material::{Liquid, SoundSpeed};
use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};
use meshfree::scene::Start;
use meshfree::study::taylor_green::TaylorGreen;
use meshfree::term::LaminarViscosity;
use meshfree::term::viscosity::Inviscid;

const SPACING: f64 = 0.02;
/// Sound speed, in units of the greatest speed.
const SOUND: f64 = 10.0;

pub(crate) fn main() -> Result<(), Failure> {
    // A square of 1 m, 1 m/s and a Reynolds number of 100.
    let flow = TaylorGreen::new(100.0)?;
    let liquid = Liquid::new(1.0, 1480.0, flow.kinematic_viscosity())
        .linear()
        .material("liquid", SoundSpeed::Chosen(SOUND));
    // With the pressure of the exact flow no sound starts.
    let liquid = Body::block("liquid", liquid, [0.0; 2], [1.0; 2], SPACING);
    let liquid = liquid.start(|x, start| Start {
        velocity: flow.velocity(x, 0.0),
        density: 1.0 + flow.pressure(x, 0.0) / (SOUND * SOUND),
        ..start
    });
    // The liquid's own viscosity in place of an artificial one; shifting keeps particles evenly spread.
    let scheme = schemes::weakly_compressible()
        .with_viscosity(Inviscid)
        .with(Laminar(LaminarViscosity))
        .with(Shifting::CLOSED);
    let mut vortices = Scene::<f64, 2>::new(scheme)
        .body(liquid)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .build()?;

    let columns = ["time_s", "speed_m_s", "exact_m_s"];
    let mut table = CsvWriter::create("out/taylor_green/decay.csv", &columns)?;
    let mut decay = [const { Vec::new() }; 2];
    let summary = Run::new(&mut vortices, 1.0)
        .label("vortices")
        .observe(Schedule::evenly(21), |now| {
            // The greatest speed that belongs to the energy; the greatest of single particles is noise.
            let exact = flow.greatest_speed(now.time());
            let share = now.kinetic_energy() / flow.kinetic_energy(now.time());
            let speed = exact * share.sqrt();
            table.row(&[now.time(), speed, exact])?;
            decay[0].push((now.time(), speed));
            decay[1].push((now.time(), exact));
            Ok(())
        })
        .paraview(Schedule::evenly(21), "out/taylor_green/vortices.pvd")
        .go()?;

    let [particles, exact] = decay;
    let [x, y] = [
        Axis::linear("time", "s"),
        Axis::linear("greatest speed", "m/s"),
    ];
    let decay = Panel::new(x, y)
        .series(Series::line("exact", exact).reference())
        .series(Series::markers("particles", particles));
    let points = vortices.all().map(|p| {
        let ([x, y], [u, v]) = (p.position(), p.velocity());
        (x, y, u.hypot(v))
    });
    let speed = Axis::linear("speed", "m/s").from(0.0);
    let picture = Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m"))
        .cloud(Cloud::new(speed, points).diameter(SPACING))
        .equal_aspect()
        .title("after 1 s");
    let figure = Figure::new().panel(decay).panel(picture);
    figure.save("out/taylor_green/vortices.svg")?;
    println!("{summary}\nwritten to out/taylor_green");
    Ok(())
}
