//! A crank drives a block through a rod, next to the exact motion. It shows rigid bodies, hinges, a slider with a damper, and
//! a motor with the work that it does.
//! `cargo run --release --example mechanism` leaves a picture, a table and files for ParaView in `out/mechanism`.

use meshfree::coupling::Joint;
use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};
use std::f64::consts::TAU;

/// Lengths of crank and rod \[m\], and the speed of the crank \[1/s\].
const CRANK: f64 = 0.3;
const ROD: f64 = 1.0;
const SPIN: f64 = 3.0;
const SPACING: f64 = 0.05;

pub(crate) fn main() -> Result<(), Failure> {
    let bar = |name, low: [f64; 2], high: [f64; 2]| {
        let steel = Material::new("steel", Linear::new(7800.0, 20.0));
        Body::block(name, steel, low, high, SPACING)
    };
    let (knee, head, out) = ([CRANK, 0.0], [CRANK + ROD, 0.0], [0.0, 0.0, 1.0]);
    let mut run = Scene::<f64, 2>::new(schemes::impact_by_continuity())
        .body(bar("crank", [0.0, -0.025], [CRANK, 0.025]))
        .body(bar("rod", [CRANK, -0.025], [CRANK + ROD, 0.025]))
        .body(bar(
            "block",
            [CRANK + ROD, -0.075],
            [CRANK + ROD + 0.2, 0.075],
        ))
        .rigid("crank")
        .rigid("rod")
        .rigid("block")
        // Joints hold them; surfaces that meet at a hinge do not touch.
        .between("crank", "rod", Interaction::None)
        .between("rod", "block", Interaction::None)
        .joint_to_ground("crank", Joint::hinge([0.0; 2], out).speed(|_| SPIN))
        .joint("rod", "crank", Joint::hinge(knee, out))
        .joint("block", "rod", Joint::hinge(head, out))
        .joint_to_ground("block", Joint::slider(head, [1.0, 0.0]).damping(50.0))
        .build()?;

    // Where the block is for an angle of the crank, from where it starts.
    let exact = |angle: f64| {
        let side = CRANK * angle.sin();
        CRANK * angle.cos() + (ROD * ROD - side * side).sqrt() - (CRANK + ROD)
    };
    let turn = TAU / SPIN;
    let columns = ["time_s", "block_m", "exact_m", "motor_j", "damper_j"];
    let mut table = CsvWriter::create("out/mechanism/block.csv", &columns)?;
    let mut curves = [const { Vec::new() }; 4];
    let mut pictures = Vec::new();
    let summary = Run::new(&mut run, turn)
        .label("mechanism")
        .observe(Schedule::evenly(121), |now| {
            let joints = now.joints();
            let (motor, slider) = (joints[0].motor_work, &joints[3]);
            let exact = exact(SPIN * now.time());
            table.row(&[now.time(), slider.value, exact, motor, slider.heat])?;
            let values = [slider.value, exact, motor, slider.heat];
            for (curve, value) in curves.iter_mut().zip(values) {
                curve.push((now.time(), value));
            }
            Ok(())
        })
        .observe(Schedule::at([0.2 * turn, 0.4 * turn]), |now| {
            pictures.push(picture(now));
            Ok(())
        })
        .paraview(Schedule::evenly(61), "out/mechanism/mechanism.pvd")
        .go()?;

    let [block, exact, motor, damper] = curves;
    let time = || Axis::linear("time", "s");
    let place = Panel::new(time(), Axis::linear("displacement of the block", "m"))
        .series(Series::line("joints", block))
        .series(Series::line("exact", exact).reference());
    let work = Panel::new(time(), Axis::linear("work", "J/m"))
        .series(Series::line("of the motor", motor))
        .series(Series::line("into the damper", damper));
    let panels = [place, work].into_iter().chain(pictures);
    let figure = panels.fold(Figure::new().columns(2), Figure::panel);
    figure.save("out/mechanism/mechanism.svg")?;
    println!("{summary}\nwritten to out/mechanism");
    Ok(())
}

/// Crank, rod and block, coloured by their speed, with the same axes at all times.
fn picture(now: &Simulation<f64, 2>) -> Panel {
    let points = now.all().map(|p| {
        let ([x, y], [u, v]) = (p.position(), p.velocity());
        (x, y, u.hypot(v))
    });
    let speed = Axis::linear("speed", "m/s").range(0.0, 1.0);
    Panel::new(
        Axis::linear("x", "m").range(-0.4, 1.6),
        Axis::linear("y", "m").range(-0.4, 0.4),
    )
    .cloud(Cloud::new(speed, points).diameter(SPACING))
    .equal_aspect()
    .title(&format!("t = {:.2} s", now.time()))
}
