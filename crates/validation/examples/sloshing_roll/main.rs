//! Sloshing in a rolling tank: SPHERIC 10, lateral impact of water, in a plane or in space.
//! `cargo validate sloshing_roll -- --help` lists the options.

#[path = "../common/mod.rs"]
mod common;
mod roll;
#[path = "../common/violent.rs"]
mod violent;

use common::{Example, Failure, Options};
use meshfree::boundary::Rotation;
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::observe::PressureProbe;
use meshfree::output::picture::Picture;
use meshfree::output::svg::{Axis, Color, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use std::process::ExitCode;
use violent::{Bar, Choices, History, Keep, Watch, own};

const EXAMPLE: Example = Example {
    name: "sloshing_roll",
    about: "Sloshing in a rolling tank: SPHERIC 10, lateral impact of water (Souto-Iglesias et al. 2011).

--case NAME is record, the roll as measured, or sine, the fit of it (the default where the record is
not there). The scheme viscous has the water's own viscosity, and walls without slip. The heights of
all four impacts are among the measured ones with --spacing 0.00465 --until 7.5 --precision f32 --scheme riemann
--h-over-dx 2 --riemann-walls (docs/dam_breaks.md).",
    schemes: &violent::SCHEMES,
    own: &violent::options_and(own(
        "--breadth",
        "M",
        "of the tank, with two side walls (in a plane)",
    )),
};

const GRAVITY: f64 = 9.81;
/// Inside of the tank \[m\]; it rolls about the middle of its bottom.
const TANK: [f64; 2] = [0.9, 0.508];
/// Depth of the water, and height of the sensor on the left wall \[m\].
const DEPTH: f64 = 0.093;
/// Density \[kg/m³\] and dynamic viscosity \[Pa s\] of the water.
const WATER: [f64; 2] = [998.0, 8.94e-4];
/// The record's file.
const PRESSURE: &str = "spheric10_lateral_water/pressure_sensor1.csv";

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, Some(perform::<f32>))
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let choices = Choices::of(options)?;
    let breadth = options.number("--breadth", 0.0)?;
    if breadth > 0.0 {
        tank::<T, 3>(options, &choices, breadth)
    } else {
        tank::<T, 2>(options, &choices, breadth)
    }
}

/// The point of a plane in D dimensions, or of space at a place across the tank.
fn place<const D: usize>(x: f64, y: f64, across: f64) -> [f64; D] {
    core::array::from_fn(|d| [x, y, across][d])
}

/// Runs the tank, in a plane, or in space between two side walls `breadth` \[m\] apart.
fn tank<T: Real, const D: usize>(
    options: &Options,
    choices: &Choices,
    breadth: f64,
) -> Result<(), Failure>
where
    WendlandC2: Kernel<D>,
{
    let spacing = options.spacing_or(DEPTH / 31.0, DEPTH / 12.0);
    let until = options.until_or(6.5, 2.6);
    // Ten times the speed of the water along the bottom, which is less than 2 √(gh).
    let usual = 20.0 * (GRAVITY * DEPTH).sqrt();
    let sound_speed = choices.sound_speed.unwrap_or(usual);
    let (roll, source) = roll::asked_for(options, choices)?;
    println!(
        "SPHERIC 10, lateral, water: roll by {source}, spacing {spacing:.5} m, sound speed \
         {sound_speed:.1} m/s, {}, until {until} s",
        if D == 3 {
            format!("{breadth} m wide")
        } else {
            "in a plane".into()
        }
    );
    let [density, viscosity] = WATER;
    let water = Liquid::new(density, 1480.0, viscosity)
        .material("water", SoundSpeed::Chosen(sound_speed))
        .with_pressure_cut_off(choices.cut_off);
    let half = 0.5 * TANK[0];
    let (low, high) = (place(-half, 0.0, 0.0), place(half, TANK[1], breadth));
    let down = place(0.0, -GRAVITY, 0.0);
    let body = Body::block("water", water, low, place(half, DEPTH, breadth), spacing);
    let body = choices
        .jittered(body, 0.0)
        .hydrostatic(down, place(0.0, DEPTH, 0.0));
    // The record's angle is positive where the left wall goes down first; a rotation from the first axis
    // towards the second lifts the right wall, which is the same.
    let tank = Wall::around(
        "tank",
        low,
        high,
        spacing,
        choices.layers(),
        core::array::from_fn(|d| [d < 2 || choices.sticks(); 2]),
    );
    let tank = choices
        .slip(tank)
        .motion(Rotation::about([0.0; D], roll))
        .container_frame();
    let mut scene = Scene::<T, D>::new(choices.compose::<T, D>())
        .body(body)
        .wall(tank)
        .acceleration(move |_| down);
    // Side walls with slip need no particles.
    if D == 3 && !choices.sticks() {
        for (across, out) in [(0.0, -1.0), (breadth, 1.0)] {
            scene = scene.boundary(MirrorPlane::symmetry(
                place(0.0, 0.0, across),
                place(0.0, 0.0, out),
            ));
        }
    }
    let mut simulation = scene.build()?;
    println!("{}", simulation.scheme());
    let sensor = |name: &str, x: f64, normal: f64| {
        // The sensors of the experiment have 9 mm.
        PressureProbe::disc(
            &simulation,
            name,
            place(x, DEPTH, 0.5 * breadth),
            place(normal, 0.0, 0.0),
            0.009,
        )?
        .on_wall("tank")
    };
    let watch = Watch {
        probes: vec![sensor("left", -half, 1.0)?, sensor("right", half, -1.0)?],
        ..Watch::default()
    };
    let mut series = Pvd::create(options.file("particles.pvd"))?;
    let frame = |now: &Simulation<T, D>, k: usize| {
        series.frame(now.time(), &now.vtu_with_walls())?;
        picture(now, breadth, &options.file(&format!("frame_{k:05}")))
    };
    let inside = |now: &Simulation<T, D>, x: [f64; D]| {
        // Back into the tank's own frame: its linear part is a rotation.
        let Ok(pose) = now.wall_pose("tank") else {
            return false;
        };
        let own = pose.linear[0].transpose() * (meshfree::tensor::Vector::from(x) - pose.shift[0]);
        // A drop that strikes a wall alone dives a little before it bounces.
        let deep = 0.5 * now.spacing();
        let in_plane = own[0].abs() <= half + deep && (-deep..=TANK[1] + deep).contains(&own[1]);
        in_plane && (2..D).all(|d| (-deep..=breadth + deep).contains(&own[d]))
    };
    let keep = Keep {
        table: options.file("history.csv"),
        comment: "SPHERIC 10, lateral, water",
        apart: 5e-4,
        frames: choices.frames,
    };
    let history = violent::run(&keep, &mut simulation, until, &watch, inside, frame)?;
    println!("{}", history.summary());
    figure(&history, spacing, choices, options)?;
    if choices.bars {
        bars(&history, spacing, choices);
    }
    println!("written to {}", options.folder().display());
    Ok(())
}

/// Particles coloured by pressure, in the frame of the laboratory and from the side, without the side walls.
fn picture<T: Real, const D: usize>(
    now: &Simulation<T, D>,
    breadth: f64,
    path: &std::path::Path,
) -> Result<(), Failure> {
    let (dx, half) = (now.spacing(), 0.5 * TANK[0]);
    let value = Axis::linear("pressure", "kPa").range(0.0, 2.0);
    let side = |x: [f64; D]| [x[0], x[1]];
    let water = now.all().map(|p| (side(p.position()), 1e-3 * p.pressure()));
    let walls = now.wall("tank")?.map(|p| p.position());
    let walls = walls.filter(|x| (2..D).all(|d| (0.0..=breadth).contains(&x[d])));
    let walls = walls.map(side);
    let picture = Picture::new(1200, 600)
        .title(&format!("t = {:.3} s", now.time()))
        .bounds([-half - 0.05, -0.06], [half + 0.05, 0.45])
        .particles(value, dx, water)
        .plain(Color(150, 150, 150), 1.0, dx, walls);
    Ok(common::save_picture(&picture, path)?)
}

/// Pressure at the sensor with the measured one in the same axes.
fn figure(
    history: &History,
    spacing: f64,
    choices: &Choices,
    options: &Options,
) -> Result<(), Failure> {
    let until = history.time.last().copied().unwrap_or(0.0);
    let points = history.smoothed(1e-3).points("left_pa", 1.0, 1000.0);
    let axes = [
        Axis::linear("time", "s").range(0.0, until),
        Axis::linear("pressure", "kPa"),
    ];
    let [time, pressure] = axes;
    let mut panel = Panel::new(time, pressure)
        .title("sensor 1, left wall, 93 mm above the bottom; mean over 1 ms")
        .series(Series::line("computed", points));
    if let Some(record) = choices.records.read(PRESSURE) {
        let values = record.column("p_median_Pa")?.into_iter().map(|p| 1e-3 * p);
        let points = record.column("time_s")?.into_iter().zip(values);
        panel = panel.series(Series::line("Souto-Iglesias et al. 2011", points).reference());
    }
    Figure::new()
        .title(&format!(
            "SPHERIC 10, lateral impact, spacing {:.2} mm",
            1e3 * spacing
        ))
        .panel_size(900.0, 380.0)
        .panel(panel)
        .save(options.file("pressure.svg"))?;
    Ok(())
}

/// What does not hang on where single particles strike, which they do for some milliseconds: the greatest mean over
/// 20 ms around the time of a peak, its time \[s\] and height \[Pa\], and the time \[s\] at which the water leaves the
/// sensor afterwards, where that mean falls below the middle between wet and dry. The sensor of the record drifts, so
/// dry is not zero.
fn whole(history: &History, time: f64) -> [f64; 3] {
    let smooth = history.smoothed(0.02);
    let level = |from: f64, to: f64| history.mean("left_pa", time + from, time + to);
    let middle = 0.5 * (level(0.25, 0.35) + level(0.6, 0.65));
    let mut samples = smooth.time.iter().zip(smooth.column("left_pa"));
    let left = samples.find(|(t, p)| **t > time + 0.35 && **p < middle);
    let (when, greatest) = smooth.peak("left_pa", time - 0.2, time + 0.2);
    [when, greatest, left.map_or(f64::NAN, |(t, _)| *t)]
}

/// The peaks: of the record at 2.375, 4.067 and 5.671 s; mean and deviation over 100 runs in pascals.
fn bars(history: &History, spacing: f64, choices: &Choices) {
    const PEAKS: [(f64, f64, f64); 4] = [
        (2.375, 3710.0, 730.0),
        (4.067, 4820.0, 1500.0),
        (5.671, 4690.0, 1710.0),
        (7.3, 4640.0, 1320.0),
    ];
    let until = history.time.last().copied().unwrap_or(0.0);
    let smooth = history.smoothed(1e-3);
    let measured = choices.records.read(PRESSURE).and_then(|record| {
        Some(History {
            time: record.column("time_s").ok()?,
            names: vec!["left_pa".into()],
            columns: vec![record.column("p_median_Pa").ok()?],
            ..History::default()
        })
    });
    let mut bars = vec![Bar::between(
        "particles over half a spacing deep in walls",
        history.lost as f64,
        0.0,
        0.0,
    )];
    for (k, (time, mean, deviation)) in PEAKS.into_iter().enumerate() {
        if time + 0.2 > until {
            continue;
        }
        let (when, peak) = smooth.peak("left_pa", time - 0.3, time + 0.3);
        let name = |what: &str| format!("{what} of peak {}", k + 1);
        let (low, high) = (mean - 2.0 * deviation, mean + 2.0 * deviation);
        bars.push(Bar::between(&(name("height") + " [Pa]"), peak, low, high));
        if k < 3 {
            bars.push(Bar::near(&(name("time") + " [s]"), when, time, 0.02));
            if let Some(measured) = measured.as_ref().filter(|_| time + 0.65 < until) {
                let [own, theirs] = [history, measured].map(|of| whole(of, time));
                let what = format!("water leaves the sensor after peak {} [s]", k + 1);
                bars.push(Bar::near(&what, own[2], theirs[2], 0.02));
                println!(
                    "impact {}: greatest mean over 20 ms {:.0} Pa at {:.3} s, measured {:.0} Pa at {:.3} s",
                    k + 1,
                    own[1],
                    own[0],
                    theirs[1],
                    theirs[0]
                );
            }
        }
    }
    let title = format!(
        "SPHERIC 10, spacing {:.2} mm, {}",
        1e3 * spacing,
        choices.scheme
    );
    violent::print_bars(&title, &bars);
}
