//! SPHERIC 2: a column of water in a tank with a box in its way (Kleefsman et al. 2005).
//! Heights at four gauges and pressures at eight sensors of the box.

use super::common::{Failure, Options};
use super::flat::GRAVITY;
use super::violent::{self, Choices, Keep, Watch};
use super::{bars, consistency, figures, lattice_rows};
use meshfree::geometry::{Cuboid, Shape, fill};
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::observe::{PressureProbe, WaveGauge};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;

/// Inside of the tank \[m\].
pub const TANK: [f64; 3] = [3.22, 1.0, 1.0];
/// Where the column starts, and its height \[m\].
pub const COLUMN: [f64; 2] = [1.992, 0.55];
/// Corners of the box \[m\].
pub const BOX: [[f64; 3]; 2] = [[0.6635, 0.2985, 0.0], [0.8245, 0.7015, 0.161]];
/// Places of the gauges along the tank \[m\], H1 to H4 as the sketch numbers them.
pub const GAUGES: [f64; 4] = [0.496, 0.992, 1.488, 2.638];
/// Heights on the front face of P1 to P4, and distances behind its edge of P5 to P8 \[m\].
pub const SENSORS: [f64; 4] = [0.021, 0.061, 0.101, 0.141];
/// Across the tank: 0.176 m from one end of the box \[m\].
const SENSOR_SIDE: f64 = 0.4745;
/// Density \[kg/m³\].
pub const DENSITY: f64 = 1000.0;

/// Ten times the speed of the front by shallow water, 2 √(gh).
fn sound_speed(choices: &Choices) -> f64 {
    let usual = 20.0 * (GRAVITY * COLUMN[1]).sqrt();
    choices.sound_speed.unwrap_or(usual)
}

/// The box as a wall: on the lattice that fits it, and hollow where no kernel reaches.
fn obstacle(spacing: f64, layers: usize) -> Result<Wall<3>, Failure> {
    let [low, high] = BOX;
    let size: [f64; 3] = core::array::from_fn(|d| high[d] - low[d]);
    let counts = size.map(|s| (s / spacing).round().max(1.0));
    // Filled in units of its own cells.
    let cells = fill(&Cuboid::new([0.0; 3], counts), 1.0, [0.0; 3])?;
    let depth = layers as f64;
    let shell = |x: &[f64; 3]| (0..3).any(|d| (d < 2 && x[d] < depth) || x[d] > counts[d] - depth);
    let points = cells
        .into_iter()
        .filter(shell)
        .map(|x| core::array::from_fn(|d| low[d] + size[d] * x[d] / counts[d]))
        .collect();
    let volume: f64 = (0..3).map(|d| size[d] / counts[d]).product();
    // Its foot is not a surface.
    let solid = Cuboid::new([low[0], low[1], -1.0], high);
    Ok(Wall::of("box", points, volume.cbrt()).fluid_side(solid.complement()))
}

/// Off the lattice, whose rows would strike the box all at once; lattice rows have a random offset as well.
const JITTER: f64 = 0.2;

fn scene<T: Real>(spacing: f64, choices: &Choices) -> Result<Scene<T, 3>, Failure> {
    let water = Liquid::new(DENSITY, 1480.0, 1e-3)
        .material("water", SoundSpeed::Chosen(sound_speed(choices)))
        .with_pressure_cut_off(choices.cut_off);
    let [start, height] = COLUMN;
    let mut column = Body::block(
        "water",
        water,
        [start, 0.0, 0.0],
        [TANK[0], TANK[1], height],
        spacing,
    );
    if choices.jitter != Some(0.0) {
        column = lattice_rows::offset(column, 0, spacing, [true, false], choices.seed);
    }
    let column = choices
        .jittered(column, JITTER)
        .hydrostatic([0.0, 0.0, -GRAVITY], [0.0, 0.0, height]);
    let layers = choices.layers();
    let closed = [[true, true], [true, true], [true, false]];
    Ok(Scene::new(choices.compose::<T, 3>())
        .body(column)
        .wall(choices.slip(Wall::around(
            "tank", [0.0; 3], TANK, spacing, layers, closed,
        )))
        .wall(choices.slip(obstacle(spacing, layers)?))
        .outlet(over_the_rim(layers as f64 * spacing))
        .acceleration(|_| [0.0, 0.0, -GRAVITY]))
}

/// The tank is open: what splashes over its rim, beyond walls of that thickness \[m\], leaves.
fn over_the_rim(thickness: f64) -> Outlet<3> {
    let [length, width, height] = TANK;
    Outlet::outside_box(
        [-thickness; 3],
        [length + thickness, width + thickness, 10.0 * height],
    )
}

fn watch<T: Real>(now: &Simulation<T, 3>) -> Result<Watch<3>, Error> {
    let [_, [face, _, top]] = BOX;
    // The sensors are small against any spacing that one can afford.
    let diameter = 0.01;
    let mut probes = Vec::new();
    for (k, z) in SENSORS.iter().enumerate() {
        let name = format!("p{}", k + 1);
        let centre = [face, SENSOR_SIDE, *z];
        let normal = [1.0, 0.0, 0.0];
        probes.push(PressureProbe::disc(now, &name, centre, normal, diameter)?);
    }
    for (k, behind) in SENSORS.iter().enumerate() {
        let name = format!("p{}", k + 5);
        let centre = [face - behind, SENSOR_SIDE, top];
        let normal = [0.0, 0.0, 1.0];
        probes.push(PressureProbe::disc(now, &name, centre, normal, diameter)?);
    }
    let gauge = |(k, x): (usize, &f64)| {
        let foot = [*x, 0.5 * TANK[1], 0.0];
        WaveGauge::upwards(now, &format!("h{}", k + 1), foot, 2)
    };
    let gauges: Result<_, Error> = GAUGES.iter().enumerate().map(gauge).collect();
    Ok(Watch {
        probes,
        gauges: gauges?,
        // Means around a point and forces differ where drops strike, and next to the floor.
        contact: true,
    })
}

/// Runs the case, writes its tables and figures, and compares where asked to.
pub fn perform<T: Real>(options: &Options, choices: &Choices) -> Result<(), Failure> {
    let spacing = options.spacing_or(0.55 / 30.0, 0.05);
    let until = options.until_or(6.0, 1.0);
    let start = match choices.jitter.unwrap_or(JITTER) {
        0.0 => "on the lattice".into(),
        share => format!(
            "lattice rows with random offset, off the lattice by up to {share} of the spacing (draw {})",
            choices.seed
        ),
    };
    println!(
        "SPHERIC 2: spacing {spacing} m, sound speed {:.1} m/s, {start}, until {until} s",
        sound_speed(choices),
    );
    let mut simulation = scene::<T>(spacing, choices)?.build()?;
    println!("{}", simulation.scheme());
    let mut series = Pvd::create(options.file("particles.pvd"))?;
    let inside = |_: &Simulation<T, 3>, x: [f64; 3]| {
        // A drop that strikes a wall alone dives a little before it bounces.
        let deep = 0.5 * spacing;
        let boxed = (0..3).all(|d| x[d] > BOX[0][d] + deep && x[d] < BOX[1][d] - deep);
        let in_tank = (0..3).all(|d| x[d] >= -deep && x[d] <= TANK[d] + deep);
        x[2] > TANK[2] || (in_tank && !boxed)
    };
    let frame = |now: &Simulation<T, 3>, k: usize| {
        series.frame(now.time(), &now.vtu_with_walls())?;
        figures::space(now, &options.file(&format!("frame_{k:05}")))
    };
    let keep = Keep {
        table: options.file("history.csv"),
        comment: "SPHERIC 2",
        apart: 5e-4,
        frames: choices.frames,
    };
    let watch = watch(&simulation)?;
    let history = violent::run(&keep, &mut simulation, until, &watch, inside, frame)?;
    println!("{}", history.summary());
    figures::obstacle(&history, spacing, choices, options.folder())?;
    if choices.bars {
        bars::obstacle(&history, spacing, choices)?;
        consistency::print(&history, choices)?;
    }
    println!("written to {}", options.folder().display());
    Ok(())
}
