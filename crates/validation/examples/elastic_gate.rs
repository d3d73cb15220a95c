//! A dam break through a rubber gate that its water bends open (Antoci, Gallati & Sibilla 2007).
//! `cargo validate elastic_gate -- --help` lists the options.

mod common;

use common::{Example, Failure, Options, Own, Records, Shade, picture};
use meshfree::boundary::{Outlet, Wall};
use meshfree::effect::NeoHookean;
use meshfree::material::eos::Linear;
use meshfree::material::{SoundSpeed, catalogue};
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Figure, Marker, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::study::records::Record;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "elastic_gate",
    about: "Water 0.14 m deep behind a rubber gate, clamped at its top, in plane strain.",
    schemes: &["default"],
    own: &[
        Own {
            name: "--youngs-modulus",
            value: "PA",
            help: "of the rubber, Poisson ratio 0.4; 12e6",
        },
        Own {
            name: "--sound-speed",
            value: "M/S",
            help: "artificial sound speed of the water; 20",
        },
        Records::OPTION,
    ],
};

const GRAVITY: f64 = 9.81;
/// Width and depth of the water \[m\].
const WATER: [f64; 2] = [0.1, 0.14];
/// Length and thickness of the gate \[m\].
const GATE: [f64; 2] = [0.079, 0.005];
const RUBBER: f64 = 1100.0;
const POISSON: f64 = 0.4;
/// Length of the channel behind the gate \[m\], and layers of wall particles.
const CHANNEL: f64 = 0.15;
const LAYERS: i64 = 3;

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

/// Places of a lattice from the origin, of those columns and rows.
fn lattice(dx: f64, columns: [i64; 2], rows: [i64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let place = move |k: i64| (k as f64 + 0.5) * dx;
    (rows[0]..rows[1]).flat_map(move |row| {
        (columns[0]..columns[1]).map(move |column| [place(column), place(row)])
    })
}

struct Case {
    youngs: f64,
    sound_speed: f64,
    dx: f64,
}

impl Case {
    /// Columns and rows of a length.
    fn cells(&self, length: f64) -> i64 {
        (length / self.dx).round() as i64
    }
    fn rubber<T: Real>(&self) -> Material<T> {
        let law = Linear::from_elastic_constants(RUBBER, self.youngs, POISSON);
        let shear = self.youngs / (2.0 * (1.0 + POISSON));
        Material::new("rubber", law).with_shear_modulus(shear)
    }
    fn scene<T: Real>(&self) -> Scene<T, 2> {
        let dx = self.dx;
        let [width, depth] = WATER.map(|length| self.cells(length));
        let [length, thickness] = GATE.map(|length| self.cells(length));
        let water: Material<T> =
            catalogue::water_at(SoundSpeed::artificial(self.sound_speed / 10.0));
        let column =
            Body::block("water", water, [0.0; 2], WATER, dx).hydrostatic([0.0, -GRAVITY], WATER);
        // Rows above the gate are its clamp, and above those is a wall.
        let held = length + LAYERS;
        let top = [WATER[0] + GATE[1], held as f64 * dx];
        let gate = Body::block("gate", self.rubber(), [WATER[0], 0.0], top, dx);
        let far = width + self.cells(CHANNEL);
        let floor = lattice(dx, [-LAYERS, far], [-LAYERS, 0]);
        let rear = lattice(dx, [-LAYERS, 0], [0, depth + LAYERS]);
        let above = lattice(dx, [width, width + thickness], [held, depth + LAYERS]);
        let walls = floor.chain(rear).chain(above).collect();
        let root = length as f64 * dx;
        Scene::new(schemes::weakly_compressible())
            .body(column)
            .group(schemes::total_lagrangian().with(NeoHookean), [gate])
            .wall(Wall::of("tank", walls, dx))
            .outlet(Outlet::plane([far as f64 * dx, 0.0], [1.0, 0.0]))
            .fix("gate", move |[_, y]| *y > root)
            // It swings in a gap.
            .between("gate", "tank", Interaction::None)
            .sub_cycle(
                "gate",
                common::stable_steps([self.youngs, POISSON, RUBBER], self.sound_speed),
            )
            .acceleration(|_| [0.0, -GRAVITY])
    }
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let records = Records::of(options)?;
    let case = Case {
        youngs: options.number("--youngs-modulus", 12e6)?,
        sound_speed: options.number("--sound-speed", 20.0)?,
        dx: options.spacing_or(0.001, 0.0025),
    };
    let mut simulation = case.scene::<T>().build()?;
    let low: Vec<usize> = simulation
        .body("gate")?
        .filter(|p| p.position()[1] < case.dx)
        .map(|p| p.id())
        .collect();
    let tip = |now: &Simulation<T, 2>| -> Result<[f64; 2], Failure> {
        let mut sum = [0.0; 2];
        for p in now.body("gate")?.filter(|p| low.contains(&p.id())) {
            let x = p.position();
            sum = [sum[0] + x[0], sum[1] + x[1]];
        }
        Ok(sum.map(|sum| sum / low.len() as f64))
    };
    let first = tip(&simulation)?;

    let until = options.until_or(0.4, 0.03);
    let columns = [
        "time_s",
        "tip_dx_m",
        "tip_dy_m",
        "kinetic_gate_j_m",
        "elastic_gate_j_m",
    ];
    let mut csv = CsvWriter::create(options.file("history.csv"), &columns)?;
    let mut movie = Pvd::create(options.file("gate.pvd"))?;
    let mut samples: [Vec<(f64, f64)>; 2] = Default::default();
    let mut pictures = Vec::new();
    let times = 1 + (until / 0.002).ceil() as usize;
    let summary = Run::new(&mut simulation, until)
        .label(EXAMPLE.name)
        .observe(Schedule::evenly(times), |now| {
            let at = tip(now)?;
            let moved = [at[0] - first[0], at[1] - first[1]];
            let ledger = now.ledger();
            let gate = &ledger.bodies[1].1;
            let elastic = gate.total("elastic energy").unwrap_or(0.0);
            csv.row(&[now.time(), moved[0], moved[1], gate.kinetic, elastic])?;
            let count = samples[0].len();
            if count.is_multiple_of(10) {
                movie.frame(now.time(), &now.vtu_with_walls())?;
            }
            if [times / 5, times / 2, times - 1].contains(&count) {
                pictures.push(picture(now, Shade::Speed, [0, 1], case.dx));
            }
            for (line, value) in samples.iter_mut().zip(moved) {
                line.push((now.time(), value));
            }
            Ok(())
        })
        .go()?;

    let mut figure = Figure::new().columns(2).shared_legend();
    let kinds = [("x", "dx_m", "tip, along"), ("y", "dy_m", "tip, up")];
    for (line, (axis, column, label)) in samples.iter().zip(kinds) {
        let mut panel = Panel::new(Axis::linear("time", "s"), Axis::linear(label, "m"))
            .series(Series::line("meshfree", line.clone()));
        for (name, file, marker) in [
            ("measured, Antoci et al. 2007", "exp", Marker::Circle),
            (
                "computed, Khayyer et al. 2018",
                "code_khayyer_2018_isph_sph",
                Marker::Ring,
            ),
            (
                "computed, Yang et al. 2012",
                "code_yang_2012_sph_fem",
                Marker::Cross,
            ),
        ] {
            let file = format!("fsi_elastic_gate_antoci/{file}_{axis}.csv");
            if let Some(record) = records.read(&file) {
                let curve = curve(&record, column)?;
                let series = Series::markers(name, curve).reference().marker(marker);
                panel = panel.series(series);
            }
        }
        figure = figure.panel(panel);
    }
    for panel in pictures {
        figure = figure.panel(panel);
    }
    figure.save(options.file("gate.svg"))?;
    println!("{summary}, {} steps of the gate", simulation.sub_steps());
    for (line, (_, _, label)) in samples.iter().zip(kinds) {
        let most = line.iter().fold(
            (0.0, 0.0),
            |most, own| if own.1 > most.1 { *own } else { most },
        );
        println!(
            "{label}: {:.2} mm at most, at {:.3} s",
            1e3 * most.1,
            most.0
        );
    }
    println!("written to {}", options.folder().display());
    Ok(())
}

fn curve(record: &Record, column: &str) -> Result<Vec<(f64, f64)>, Failure> {
    let times = record.column("time_s")?;
    Ok(times.into_iter().zip(record.column(column)?).collect())
}
