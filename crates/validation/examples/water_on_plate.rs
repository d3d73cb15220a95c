//! A tank of water that stands on a clamped elastic plate, which settles at the deflection of plate theory.
//! `cargo validate water_on_plate -- --help` lists the options.

mod common;

use common::{Example, Failure, Options, Own, evenly};
use meshfree::boundary::Wall;
use meshfree::effect::NeoHookean;
use meshfree::material::eos::Linear;
use meshfree::material::{SoundSpeed, catalogue};
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Cloud, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::particles::Field;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use std::collections::BTreeMap;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "water_on_plate",
    about: "Water 2 m deep on an aluminium plate, 1 m long, 50 mm thick and clamped at both ends, in plane strain.",
    schemes: &["default"],
    own: &[
        Own {
            name: "--through",
            value: "N",
            help: "particles through the thickness of the plate, in place of --spacing; 10, with --quick 5",
        },
        Own {
            name: "--ratio",
            value: "R",
            help: "spacing of the water over that of the plate; 2, with --quick 1.5; the kernel of the water must not see through the plate",
        },
        Own {
            name: "--sound-speed",
            value: "M/S",
            help: "artificial sound speed of the water; 200",
        },
        Own {
            name: "--steps",
            value: "N",
            help: "of the plate in one of the water; 64",
        },
        Own {
            name: "--drag",
            value: "1/S",
            help: "deceleration of water and plate over their velocity; 200 and ten times that",
        },
    ],
};

const GRAVITY: f64 = 9.81;
/// Width and depth of the water \[m\].
const WATER: [f64; 2] = [1.0, 2.0];
const THICKNESS: f64 = 0.05;
const DENSITY: f64 = 2700.0;
const YOUNGS: f64 = 67.5e9;
const POISSON: f64 = 0.34;
/// Columns that are held at each end, that at the edge among them.
const HELD: i64 = 4;

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

/// Deflection \[m\] of the middle of a clamped thin plate in plane strain under water and its own weight, and what shear
/// adds (Timoshenko 1921, shear coefficient 5/6).
fn theory() -> [f64; 2] {
    let load = GRAVITY * (1000.0 * WATER[1] + DENSITY * THICKNESS);
    let stiffness = YOUNGS * THICKNESS.powi(3) / (12.0 * (1.0 - POISSON * POISSON));
    let shear = 5.0 / 6.0 * THICKNESS * YOUNGS / (2.0 * (1.0 + POISSON));
    [
        -load * WATER[0].powi(4) / (384.0 * stiffness),
        -load * WATER[0].powi(2) / (8.0 * shear),
    ]
}

struct Case {
    /// Spacings of plate and water \[m\].
    plate: f64,
    water: f64,
    sound_speed: f64,
    steps: u32,
    drag: f64,
}

impl Case {
    fn of(options: &Options) -> Result<Self, Failure> {
        let through = options.number("--through", options.pick(10.0, 5.0))?;
        let asked = options.spacing.map_or(through, |dx| THICKNESS / dx);
        let plate = THICKNESS / asked.round().max(1.0);
        let ratio = options.number("--ratio", options.pick(2.0, 1.5))?;
        Ok(Self {
            plate,
            water: WATER[0] / (WATER[0] / (ratio * plate)).round(),
            sound_speed: options.number("--sound-speed", 200.0)?,
            steps: options.number("--steps", 64.0)? as u32,
            drag: options.number("--drag", 200.0)?,
        })
    }

    /// The plate, whose columns at both ends of the span are the first that are held: what is held is places.
    fn plate<T: Real>(&self) -> Body<T, 2> {
        let law = Linear::from_elastic_constants(DENSITY, YOUNGS, POISSON);
        let shear = YOUNGS / (2.0 * (1.0 + POISSON));
        let metal = Material::new("aluminium", law).with_shear_modulus(shear);
        let count = |length: f64| (length / self.plate).round() as i64;
        let (columns, rows) = (count(WATER[0]), count(THICKNESS));
        let dx = WATER[0] / columns as f64;
        let points = (0..rows).flat_map(|row| {
            let y = -THICKNESS * (row as f64 + 0.5) / rows as f64;
            (1 - HELD..columns + HELD).map(move |column| [column as f64 * dx, y])
        });
        Body::points_of("plate", metal, points.collect(), self.plate)
    }

    fn scene<T: Real>(&self) -> Scene<T, 2> {
        let liquid = catalogue::water_at(SoundSpeed::artificial(0.1 * self.sound_speed));
        let water = Body::block("water", liquid, [0.0; 2], WATER, self.water)
            .hydrostatic([0.0, -GRAVITY], [0.0, WATER[1]]);
        let top = WATER[1] + 4.0 * self.water;
        let sides = [[true; 2], [false; 2]];
        let tank = Wall::around("tank", [0.0; 2], [WATER[0], top], self.water, 3, sides);
        let (drag, edge) = (self.drag, 1e-6 * self.plate);
        Scene::new(schemes::weakly_compressible())
            .body(water)
            .group(schemes::total_lagrangian().with(NeoHookean), [self.plate()])
            .wall(tank)
            .fix("plate", move |[x, _]| !(edge..WATER[0] - edge).contains(x))
            // It lies below the walls.
            .between("plate", "tank", Interaction::None)
            .load(Load::acceleration(move |at| at.velocity.map(|v| -drag * v)).on("water"))
            .load(Load::acceleration(move |at| at.velocity.map(|v| -10.0 * drag * v)).on("plate"))
            .sub_cycle("plate", self.steps)
            .acceleration(|_| [0.0, -GRAVITY])
    }
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let case = Case::of(options)?;
    let mut simulation = case.scene::<T>().build()?;
    // Displacements are far below the spacing, so the mean of those next to the middle is as good as the middle.
    let near: Vec<(usize, f64)> = simulation
        .body("plate")?
        .filter(|p| {
            p.vector(Field::REFERENCE_POSITION)
                .is_some_and(|at| (at[0] - 0.5 * WATER[0]).abs() < 0.51 * case.plate)
        })
        .map(|p| (p.id(), p.position()[1]))
        .collect();
    let middle = |now: &Simulation<T, 2>| -> Result<f64, Failure> {
        let own = now.body("plate")?.filter_map(|p| {
            let (_, first) = near.iter().find(|(id, _)| *id == p.id())?;
            Some(p.position()[1] - first)
        });
        Ok(own.sum::<f64>() / near.len() as f64)
    };

    let [bending, shear] = theory();
    let expected = bending + shear;
    let until = options.until_or(0.05, 0.03);
    let columns = [
        "time_s",
        "middle_m",
        "plate_theory_m",
        "kinetic_water_j_m",
        "kinetic_plate_j_m",
        "elastic_plate_j_m",
    ];
    let mut csv = CsvWriter::create(options.file("history.csv"), &columns)?;
    let mut movie = Pvd::create(options.file("plate.pvd"))?;
    let mut samples = Vec::new();
    let summary = Run::new(&mut simulation, until)
        .label(EXAMPLE.name)
        .observe(Schedule::evenly(121), |now| {
            let at = middle(now)?;
            let ledger = now.ledger();
            let [water, plate] = [0, 1].map(|body| &ledger.bodies[body].1);
            let elastic = plate.total("elastic energy").unwrap_or(0.0);
            csv.row(&[
                now.time(),
                at,
                expected,
                water.kinetic,
                plate.kinetic,
                elastic,
            ])?;
            if samples.len().is_multiple_of(20) {
                movie.frame(now.time(), &now.vtu_with_walls())?;
            }
            samples.push((now.time(), at));
            Ok(())
        })
        .go()?;

    // The last third has settled.
    let settled: Vec<f64> = samples[2 * samples.len() / 3..]
        .iter()
        .map(|(_, at)| *at)
        .collect();
    let mean = settled.iter().sum::<f64>() / settled.len() as f64;
    let spread = settled
        .iter()
        .fold(0.0_f64, |most, at| most.max((at - mean).abs()));
    let micro = |at: f64| 1e6 * at;
    let history = samples.iter().map(|(time, at)| (1e3 * time, micro(*at)));
    let level = |at: f64| [(0.0, micro(at)), (1e3 * until, micro(at))];
    let panel = Panel::new(
        Axis::linear("time", "ms"),
        Axis::linear("middle of the plate", "µm"),
    )
    .series(Series::line("meshfree", history))
    .series(Series::line("plate theory with shear", level(expected)).reference())
    .series(Series::line("thin plate", level(bending)).dashed());
    // Deflection along the plate, through all rows.
    let mut along: BTreeMap<i64, (f64, f64, f64)> = BTreeMap::new();
    for p in simulation.body("plate")? {
        let Some(at) = p.vector(Field::REFERENCE_POSITION) else {
            continue;
        };
        let own = along.entry((at[0] / (0.25 * case.plate)).round() as i64);
        let own = own.or_insert((at[0], 0.0, 0.0));
        own.1 += p.position()[1] - at[1];
        own.2 += 1.0;
    }
    let line = along.values().map(|(x, sum, n)| (*x, micro(sum / n)));
    let curve = evenly(WATER[0], 101).into_iter().map(|x| {
        let s = x / WATER[0];
        let thin = 16.0 * (s * (1.0 - s)).powi(2) * bending;
        (x, micro(thin + 4.0 * s * (1.0 - s) * shear))
    });
    let profile = Panel::new(Axis::linear("x", "m"), Axis::linear("deflection", "µm"))
        .series(Series::line("meshfree", line))
        .series(Series::line("plate theory with shear", curve).reference())
        .title(&format!("t = {:.3} s", simulation.time()));
    // Pressures in the plate are a hundred times those of the water.
    let pressures = simulation.body("water")?.map(|p| {
        let [x, y] = p.position();
        (x, y, 1e-3 * p.pressure())
    });
    let column = Cloud::new(Axis::linear("pressure", "kPa"), pressures).diameter(case.water);
    let column = Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m"))
        .cloud(column)
        .equal_aspect()
        .title("water");
    Figure::new()
        .columns(3)
        .panel(panel)
        .panel(profile)
        .panel(column)
        .save(options.file("plate.svg"))?;

    println!("{summary}, {} steps of the plate", simulation.sub_steps());
    println!(
        "middle {:.2} µm, ± {:.2} µm over the last third; plate theory {:.2} µm: {:+.1} % (bar 5 %)",
        micro(mean),
        micro(spread),
        micro(expected),
        100.0 * (mean / expected - 1.0)
    );
    println!("written to {}", options.folder().display());
    Ok(())
}
