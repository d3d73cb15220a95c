//! One case: the scene, the run, and what is sampled on the way.
//! x is the way out, z the direction of the crush; the depth y is one cell between planes of symmetry.

use super::common::Failure;
use meshfree::effect::HydrostaticWalls;
use meshfree::geometry::{Cuboid, OpenCell, Shape, fill};
use meshfree::observe::FlowPlane;
use meshfree::output::csv::CsvWriter;
use meshfree::output::picture::Picture;
use meshfree::output::progress::Progress;
use meshfree::output::svg::{Axis, Color};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::term::LaminarViscosity;
use meshfree::term::viscosity::MonaghanGingold;
use std::path::Path;
use std::time::Instant;

/// Rate of strain \[1/s\] of the paper.
pub const RATE: f64 = 1000.0;
/// Sound speed of water \[m/s\].
pub const SOUND: f64 = 1480.0;
/// Diameter of the holes \[m\] of the paper.
pub const HOLE: f64 = 3e-3;
/// Smoothing length over spacing: short, for the walls between the holes are thin.
const H_OVER_DX: f64 = 1.3;
/// How strongly densities are held to the space of particles: between 0.02 and 0.1 the volume driven out
/// changes by a hundredth.
const CONSISTENCY: f64 = 0.05;
/// Linear artificial viscosity of water between rigid walls, that of the scheme.
const ALPHA: f64 = 0.02;
/// Layers of the plates.
pub const LAYERS: usize = 3;
/// Samples of a run.
const SAMPLES: usize = 120;
/// Frames for ParaView.
const FRAMES: usize = 12;

/// What the paper does not state.
pub const CHOICES: &str = "\
Vesenjak & Ren (2007): holes of 3 mm, walls of 1.5, 1.0 and 0.5 mm, strain rate 1000 1/s, water.
Our choice, which the paper does not state: cells in a block one deep between planes of symmetry, open at
one end and symmetric at the other, plates above and below; walls move in an affine crush, whose rate grows
from zero while sound runs through the block six times (a sudden start cavitates the water); viscosities 1e-3
to 1 Pa s; spacing of particles 0.25 mm (0.112 mm in the paper); Mie-Grueneisen constants of water C0 1480 m/s,
S 1.92, Gamma 0.1.";

/// A structure, its filler, and the crush.
#[derive(Clone, Debug)]
pub struct Case {
    /// Thickness between the holes \[m\].
    pub wall: f64,
    /// Dynamic viscosity \[Pa s\].
    pub viscosity: f64,
    /// Cells along x and z.
    pub cells: [usize; 2],
    /// Spacing that is asked for \[m\]; a whole number fits a cell.
    pub spacing: f64,
    /// Final strain.
    pub strain: f64,
    /// Whether densities are held to the space of particles, and these kept evenly spread.
    pub consistent: bool,
}

/// What was measured at one time.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    pub strain: f64,
    /// Force \[N\] on the top plate that does the work of the crush.
    pub force: f64,
    /// Work of the walls on the water \[J\].
    pub work: f64,
    /// Volume driven out over the loss of void.
    pub expelled: f64,
    pub dissipated: f64,
    pub kinetic: f64,
}

/// A run.
#[derive(Clone, Debug, Default)]
pub struct Record {
    pub samples: Vec<Sample>,
    pub relative_density: f64,
    pub particles: usize,
    pub steps: u64,
    pub seconds: f64,
}

impl Case {
    pub fn name(&self) -> String {
        format!("c{:.1}mm_mu{:.0e}", 1e3 * self.wall, self.viscosity)
    }
    fn cell(&self) -> OpenCell {
        OpenCell::new(HOLE, self.wall).tiled([self.cells[0], 1, self.cells[1]])
    }
    /// The spacing \[m\] of which a whole number fits a cell.
    fn fitted(&self) -> f64 {
        let side = HOLE + self.wall;
        side / (side / self.spacing).round().max(1.0)
    }
    /// Length, depth and height \[m\].
    fn size(&self) -> [f64; 3] {
        [self.cells[0], 1, self.cells[1]].map(|cells| cells as f64 * (HOLE + self.wall))
    }

    /// Time \[s\] in which the rate of strain grows.
    fn ramp(&self) -> f64 {
        ramp(self.size()[0])
    }
    /// Time \[s\] of the final strain.
    fn end(&self) -> f64 {
        self.strain / RATE + 0.5 * self.ramp()
    }

    fn build<T: Real>(&self) -> Result<Simulation<T, 3>, Error> {
        let (dx, size) = (self.fitted(), self.size());
        let [length, depth, height] = size;
        let water = water::<T>(self.viscosity);
        let places = fill(&self.cell().void(), dx, [0.0; 3])?;
        let water = Body::points_of("water", water, places, dx);
        // The structure, and plates below and above it.
        let thick = LAYERS as f64 * dx;
        let mut walls = fill(&self.cell().solid(), dx, [0.0; 3])?;
        for low in [-thick, height] {
            let plate = Cuboid::new([0.0, 0.0, low], [length, depth, low + thick]);
            walls.extend(fill(&plate, dx, plate.bounds().0)?);
        }
        let ramp = self.ramp();
        let crush = Crush::along(2, 0.0, move |t| strain(ramp, t));
        // Continuity alone loses the space of the particles: 13 to 16 % too much water is driven out.
        let scheme: Scheme<T, 3> = if self.consistent {
            water_scheme(ALPHA)
        } else {
            schemes::weakly_compressible()
                .h_over_dx(H_OVER_DX)
                .with(Laminar(LaminarViscosity))
                .compose()
        };
        Scene::<T, 3>::new(scheme)
            .body(water)
            .wall(Wall::of("structure", walls, dx).motion(crush).no_slip())
            .boundary(MirrorPlane::symmetry([0.0; 3], [-1.0, 0.0, 0.0]))
            .boundary(MirrorPlane::symmetry([0.0; 3], [0.0, -1.0, 0.0]))
            .boundary(MirrorPlane::symmetry([0.0, depth, 0.0], [0.0, 1.0, 0.0]))
            .outlet(Outlet::plane([1.5 * length, 0.0, 0.0], [1.0, 0.0, 0.0]))
            .build()
    }
}

/// Water of a dynamic viscosity \[Pa s\] by the law of Mie and Grüneisen, as the paper has it, which supports no tension. Its internal
/// energy, of which Γ = 0.1 takes 10⁻⁴ of the pressure at the few MPa here, is not integrated.
pub fn water<T: Real>(viscosity: f64) -> Material<T> {
    catalogue::water()
        .with_dynamic_viscosity(viscosity)
        .with_pressure_cut_off(0.0)
}

/// Water with viscosity, whose densities are held to the space of particles, which are kept evenly spread; `alpha` is its
/// linear artificial viscosity. Walls show no acceleration of their own: that of particles in contact throws water away.
pub fn water_scheme<T: Real>(alpha: f64) -> Scheme<T, 3> {
    let strength = CONSISTENCY;
    schemes::weakly_compressible()
        .h_over_dx(H_OVER_DX)
        .with_viscosity(MonaghanGingold { alpha, beta: 0.0 })
        .with(Laminar(LaminarViscosity))
        .with(Shifting::STANDARD)
        .with(VolumeConsistency { strength })
        .walls(HydrostaticWalls::default())
        .compose()
}

/// Time \[s\] in which the rate of strain grows: that in which sound runs six times through a block of this length \[m\].
pub fn ramp(length: f64) -> f64 {
    6.0 * length / SOUND
}

/// Strain, its rate, which grows as half a cosine within `ramp` \[s\], and its second derivative.
pub fn strain(ramp: f64, t: f64) -> [f64; 3] {
    if t >= ramp {
        return [RATE * (t - 0.5 * ramp), RATE, 0.0];
    }
    let w = core::f64::consts::PI / ramp;
    let (sine, cosine) = (w * t).sin_cos();
    let half = 0.5 * RATE;
    [
        half * (t - sine / w),
        half * (1.0 - cosine),
        half * w * sine,
    ]
}

/// Runs a case into a folder.
pub fn run<T: Real>(case: &Case, folder: &Path) -> Result<Record, Failure> {
    let mut simulation = case.build::<T>()?;
    simulation.keep_energy();
    let started = Instant::now();
    let size = case.size();
    let (cell, dx) = (case.cell(), case.fitted());
    // The loss of the void as particles fill it: of the water that is there.
    let water: f64 = simulation
        .all()
        .map(|particle| particle.mass() / 1000.0)
        .sum();
    let out = FlowPlane::new([size[0], 0.0, 0.0], [1.0, 0.0, 0.0])?;
    let mut record = Record {
        relative_density: cell.relative_density(),
        particles: simulation.particles(),
        ..Record::default()
    };
    let columns = [
        "time_s",
        "strain",
        "force_n",
        "work_j",
        "kinetic_j",
        "dissipated_j",
        "expelled_volume_m3",
        "void_loss_m3",
    ];
    let mut file = CsvWriter::create(folder.join("filler.csv"), &columns)?;
    let mut movie = Pvd::create(folder.join("water.pvd"))?;
    movie.frame(simulation.time(), &simulation.vtu_with_walls())?;
    let mut progress = Progress::new(case.name());
    let end = case.end();
    let mut before = [0.0; 2];
    for k in 1..=SAMPLES {
        let time = end * k as f64 / SAMPLES as f64;
        simulation.run_with(time, |now| {
            progress.update(now.time() / end, format_args!("{:.1} µs", 1e6 * now.time()));
        })?;
        let energy = simulation.energy().unwrap_or_default();
        let [strain, ..] = strain(case.ramp(), time);
        // The top goes down by the height times the strain.
        let travel = size[2] * (strain - before[1]);
        let expelled = out.mass_beyond(&simulation) / 1000.0;
        let sample = Sample {
            strain,
            force: (energy.wall_work - before[0]) / travel,
            work: energy.wall_work,
            expelled: expelled / (water * strain),
            dissipated: energy.dissipated,
            kinetic: energy.kinetic + energy.left,
        };
        before = [energy.wall_work, strain];
        file.row(&[
            time,
            strain,
            sample.force,
            sample.work,
            sample.kinetic,
            sample.dissipated,
            expelled,
            water * strain,
        ])?;
        if k % (SAMPLES / FRAMES) == 0 {
            movie.frame(simulation.time(), &simulation.vtu_with_walls())?;
        }
        record.samples.push(sample);
    }
    progress.finish();
    picture(&simulation, size, dx, &case.name(), folder)?;
    record.steps = simulation.steps();
    record.seconds = started.elapsed().as_secs_f64();
    Ok(record)
}

/// The water coloured by pressure, and the structure seen through.
fn picture<T: Real>(
    simulation: &Simulation<T, 3>,
    size: [f64; 3],
    dx: f64,
    name: &str,
    folder: &Path,
) -> Result<(), Error> {
    let places = simulation
        .all()
        .map(|particle| (particle.position(), 1e-6 * particle.pressure()));
    let front = simulation
        .wall("structure")?
        .map(|particle| particle.position());
    let picture = Picture::new(1200, 800)
        .title(&format!("{name}, {:.0} µs", 1e6 * simulation.time()))
        .view(-75.0, 15.0)
        .bounds([0.0; 3], [1.4 * size[0], size[1], size[2]])
        .particles(Axis::linear("pressure", "MPa").from(0.0), dx, places)
        .plain(
            Color(150, 150, 150),
            0.15,
            dx,
            front.filter(|x| x[1] > 0.5 * size[1]),
        );
    super::common::save_picture(&picture, folder.join("water"))
}
