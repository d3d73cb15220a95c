//! A copper bar strikes a rigid wall at 227 m/s, in plane strain. It shows strength with hardening, the energy that plastic
//! work takes, and the field of an effect in pictures and tables.
//! `cargo run --release --example taylor_bar` leaves a picture, a table and files for ParaView in `out/taylor_bar`.

use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};

/// Length and width of the bar \[m\].
const SIZE: [f64; 2] = [0.0324, 0.0064];
const SPEED: f64 = 227.0;
const SPACING: f64 = 4e-4;

pub(crate) fn main() -> Result<(), Failure> {
    // Copper with the hardening of Johnson & Cook.
    let bar = Body::block("bar", catalogue::ofhc_copper(), [0.0; 2], SIZE, SPACING);
    let scheme = schemes::impact_by_continuity()
        .with(Hypoelastic)
        .with(Plasticity);
    let mut bar = Scene::<f64, 2>::new(scheme)
        .body(bar.velocity([-SPEED, 0.0]))
        .boundary(MirrorPlane::wall([0.0; 2], [-1.0, 0.0]))
        .build()?;
    // The equations of the scheme and their sources.
    println!("{}", bar.scheme());

    let columns = ["time_s", "length_m", "kinetic_j", "plastic_work_j"];
    let mut table = CsvWriter::create("out/taylor_bar/history.csv", &columns)?;
    let start = bar.ledger().whole;
    let mut curves = [const { Vec::new() }; 3];
    let summary = Run::new(&mut bar, 60e-6)
        .label("bar")
        .observe(Schedule::evenly(121), |now| {
            let whole = now.ledger().whole;
            let plastic = whole.total("plastic work").unwrap_or(0.0);
            let end = now.all().map(|p| p.position()[0]).fold(0.0, f64::max);
            let length = end + 0.5 * SPACING;
            table.row(&[now.time(), length, whole.kinetic, plastic])?;
            let shares = [whole.kinetic, plastic].map(|energy| energy / start.kinetic);
            for (curve, value) in curves.iter_mut().zip([1e3 * length, shares[0], shares[1]]) {
                curve.push((1e6 * now.time(), value));
            }
            Ok(())
        })
        .paraview(Schedule::every(2e-6), "out/taylor_bar/bar.pvd")
        .go()?;
    let drift = bar.ledger().whole.total_energy() / start.total_energy() - 1.0;
    println!("{summary}\nthe total energy has drifted by {drift:.0e}");

    let [length, kinetic, plastic] = curves;
    let time = || Axis::linear("time", "µs");
    let length = Panel::new(time(), Axis::linear("length of the bar", "mm").from(0.0))
        .series(Series::line("", length));
    let energy = Panel::new(
        time(),
        Axis::linear("share of the first kinetic energy", "1"),
    )
    .series(Series::line("kinetic", kinetic))
    .series(Series::line("plastic work", plastic));
    let points = bar.all().map(|p| {
        let [x, y] = p.position();
        let strain = p.scalar(Plasticity::STRAIN).unwrap_or(0.0);
        (1e3 * x, 1e3 * y, strain)
    });
    let strain = Axis::linear("plastic strain", "1").range(0.0, 1.5);
    let picture = Panel::new(Axis::linear("x", "mm"), Axis::linear("y", "mm"))
        .cloud(Cloud::new(strain, points).diameter(1e3 * SPACING))
        .equal_aspect()
        .title("after 60 µs");
    let figure = Figure::new().columns(1).panel_size(640.0, 240.0);
    let panels = [length, energy, picture];
    let figure = panels.into_iter().fold(figure, Figure::panel);
    figure.save("out/taylor_bar/bar.svg")?;
    println!("written to out/taylor_bar");
    Ok(())
}
