//! Dam breaks in a plane: a column of water between the rear wall of a tank and a gate.
//! The gate vanishes at once, or is a wall that is pulled up.

use super::common::{Failure, Options};
use super::violent::{self, Choices, History, Keep, Watch};
use super::{bars, figures};
use meshfree::boundary::Translation;
use meshfree::geometry::{Cuboid, Shape};
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::observe::{PressureProbe, WaveGauge};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::study::dam_break::Column;

pub const GRAVITY: f64 = 9.81;

/// A pressure sensor on the far wall.
#[derive(Clone, Copy, Debug)]
pub struct Sensor {
    /// Height of its centre above the bottom, and its diameter \[m\].
    pub height: f64,
    pub diameter: f64,
    /// Whose it is, and their record.
    pub by: &'static str,
    pub record: &'static str,
}

const fn lobovsky(height: f64, record: &'static str) -> Sensor {
    Sensor {
        height,
        diameter: 0.0042,
        by: "Lobovský et al. 2014",
        record,
    }
}

const SENSORS: [Sensor; 5] = [
    lobovsky(0.003, "lobovsky_2014_H300_P1.csv"),
    lobovsky(0.015, "lobovsky_2014_H300_sensor2_percentiles.csv"),
    lobovsky(0.030, "lobovsky_2014_H300_P3.csv"),
    lobovsky(0.080, "lobovsky_2014_H300_P4.csv"),
    // A column of the same shape, twice as high; half of his 90 mm here, around 0.2 h.
    Sensor {
        height: 0.060,
        diameter: 0.045,
        by: "Buchner 2002",
        record: "buchner_2002.csv",
    },
];

/// A column in a tank.
#[derive(Clone, Debug)]
pub struct Flat {
    pub name: &'static str,
    /// Width and height of the column \[m\].
    pub column: [f64; 2],
    /// Width and height of the tank \[m\].
    pub tank: [f64; 2],
    /// Density \[kg/m³\].
    pub density: f64,
    /// Speed \[m/s\] at which the gate is pulled up; it vanishes at once if there is none.
    pub gate: Option<f64>,
    pub sensors: &'static [Sensor],
    pub spacing: f64,
    pub until: f64,
}

impl Flat {
    /// The case of that name with the choices of the command line.
    pub fn of(name: &str, options: &Options, choices: &Choices) -> Option<Self> {
        let usual = match name {
            // Koshizuka & Oka 1996: L = 0.146 m, 2 L high, in a tank of 4 L.
            "koshizuka" => Self {
                name: "koshizuka",
                column: [0.146, 0.292],
                tank: [0.584, 0.584],
                density: 1000.0,
                gate: None,
                sensors: &[],
                spacing: 0.146 / 50.0,
                until: 0.28,
            },
            // Martin & Moyce 1952, table 2: a = 2.25 in, n² = 2, on a long bed.
            "martin-moyce" => Self {
                name: "martin-moyce",
                column: [0.05715, 0.1143],
                tank: [7.0 * 0.05715, 3.0 * 0.05715],
                density: 1000.0,
                gate: None,
                sensors: &[],
                spacing: 0.05715 / 50.0,
                until: 0.2,
            },
            // Lobovský et al. 2014: 600 mm × 300 mm in 1610 mm. The walls are higher than theirs.
            "lobovsky" => Self {
                name: "lobovsky",
                column: [0.6, 0.3],
                tank: [1.61, 1.0],
                density: 997.0,
                gate: None,
                sensors: &SENSORS,
                spacing: 0.003,
                until: 1.25,
            },
            _ => return None,
        };
        Some(Self {
            spacing: options.spacing_or(usual.spacing, 2.5 * usual.spacing),
            until: options.until_or(usual.until, usual.until),
            gate: choices.gate,
            ..usual
        })
    }

    /// Units of its experiment.
    pub fn units(&self) -> Result<Column, Failure> {
        Ok(Column::new(self.column[0], self.column[1])?)
    }

    /// Ten times the speed of the front by shallow water, 2 √(gh).
    pub fn sound_speed(&self, choices: &Choices) -> f64 {
        let usual = 20.0 * (GRAVITY * self.column[1]).sqrt();
        choices.sound_speed.unwrap_or(usual)
    }

    fn scene<T: Real>(&self, choices: &Choices) -> Scene<T, 2> {
        let (dx, [width, height]) = (self.spacing, self.column);
        let choice = SoundSpeed::Chosen(self.sound_speed(choices));
        let water = Liquid::new(self.density, 1480.0, 8.9e-4)
            .material("water", choice)
            .with_pressure_cut_off(choices.cut_off);
        let layers = choices.layers();
        let closed = [[true, true], [true, false]];
        let column = Body::block("water", water, [0.0; 2], self.column, dx);
        let column = choices
            .jittered(column, 0.0)
            .hydrostatic([0.0, -GRAVITY], [0.0, height]);
        let mut scene = Scene::new(choices.compose::<T, 2>())
            .body(column)
            .wall(choices.slip(Wall::around(
                "tank", [0.0; 2], self.tank, dx, layers, closed,
            )))
            .acceleration(|_| [0.0, -GRAVITY]);
        if let Some(speed) = self.gate {
            let rows = (height / dx).ceil() as usize + layers;
            let points = (0..rows * layers).map(|k| {
                let [i, j] = [k % layers, k / layers].map(|n| n as f64 + 0.5);
                [width + dx * i, dx * j]
            });
            let size = [dx * layers as f64, dx * rows as f64];
            let plate = Cuboid::new([width, 0.0], [width + size[0], size[1]]);
            let gate = Wall::of("gate", points.collect(), dx).fluid_side(plate.complement());
            scene = scene.wall(gate.motion(Translation::steady([0.0, speed])));
        }
        scene
    }

    fn watch<T: Real>(&self, now: &Simulation<T, 2>) -> Result<Watch<2>, Error> {
        let sensor = |(k, own): (usize, &Sensor)| {
            let (name, centre) = (format!("p{}", k + 1), [self.tank[0], own.height]);
            PressureProbe::disc(now, &name, centre, [-1.0, 0.0], own.diameter)
        };
        // A support of the kernel off the rear wall.
        let rear = [4.0 * self.spacing, 0.0];
        let probes: Result<_, Error> = self.sensors.iter().enumerate().map(sensor).collect();
        Ok(Watch {
            probes: probes?,
            gauges: vec![WaveGauge::upwards(now, "rear", rear, 1)?],
            ..Watch::default()
        })
    }

    /// Runs it, with frames into the folder of the options.
    pub fn run<T: Real>(&self, options: &Options, choices: &Choices) -> Result<History, Failure> {
        let mut simulation = self.scene::<T>(choices).build()?;
        println!("{}", simulation.scheme());
        let mut series = Pvd::create(options.file("particles.pvd"))?;
        // Above the rim it may fly.
        let [length, top] = self.tank;
        // A drop that strikes a wall alone dives a little before it bounces.
        let deep = 0.5 * self.spacing;
        let inside = |_: &Simulation<T, 2>, [x, y]: [f64; 2]| {
            y > top || (-deep..=length + deep).contains(&x) && y >= -deep
        };
        let frame = |now: &Simulation<T, 2>, k: usize| {
            series.frame(now.time(), &now.vtu_with_walls())?;
            figures::plane(self, now, &options.file(&format!("frame_{k:05}")))
        };
        let watch = self.watch(&simulation)?;
        let keep = Keep {
            table: options.file("history.csv"),
            comment: self.name,
            apart: 1e-4,
            frames: choices.frames,
        };
        violent::run(&keep, &mut simulation, self.until, &watch, inside, frame)
    }
}

/// Runs the case, writes its tables and figures, and compares where asked to.
pub fn perform<T: Real>(case: &Flat, options: &Options, choices: &Choices) -> Result<(), Failure> {
    println!(
        "{}: column {} m x {} m, spacing {} m, sound speed {:.1} m/s, until {} s",
        case.name,
        case.column[0],
        case.column[1],
        case.spacing,
        case.sound_speed(choices),
        case.until
    );
    let history = case.run::<T>(options, choices)?;
    println!("{}", history.summary());
    figures::histories(case, &history, choices, options.folder())?;
    if choices.bars {
        bars::flat(case, &history, choices)?;
    }
    println!("written to {}", options.folder().display());
    Ok(())
}
