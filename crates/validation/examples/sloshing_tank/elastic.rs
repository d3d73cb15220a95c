//! Elastic walls: the box of PMMA as one total-Lagrangian body, its deflections, energies and clamps.
//! Vesenjak & Ren (2007) take shells; here particles fill the thickness.

use super::common::Failure;
use super::pulse::Pulse;
use super::run::Record;
use super::tank::{Case, GRAVITY};
use meshfree::boundary::Motion;
use meshfree::effect::StVenantKirchhoff;
use meshfree::error::{Error, Problem};
use meshfree::material::eos::Linear;
use meshfree::output::csv::CsvWriter;
use meshfree::output::picture::Picture;
use meshfree::output::svg::{Axis, Color, Figure, Panel, Series};
use meshfree::output::vtu::{Pvd, Vtu};
use meshfree::prelude::*;
use meshfree::term::viscosity::MonaghanGingold;
use std::path::Path;

/// Thickness of the walls \[m\], density \[kg/m³\], Young's modulus \[Pa\] and Poisson ratio of the paper's PMMA.
pub const THICKNESS: f64 = 0.030;
pub const DENSITY: f64 = 1180.0;
pub const YOUNGS: f64 = 3e9;
const POISSON: f64 = 0.35;
/// Fewest layers of particles through the thickness.
const LAYERS: f64 = 3.0;
/// Steps of the walls in one of the water that are asked for. With 23 and more, as sound speeds allow, impulses at the water's steps
/// shake the walls: their kinetic energy is thirty times as much.
const STEPS: u32 = 8;
/// Coefficient of the walls' artificial viscosity. Without one the impulses make them ring until they hold three times the work
/// of the water: docs/sloshing.md.
const VISCOSITY: f64 = 0.2;

/// Spacing of the walls' particles \[m\]: the water's, unless that gives fewer than three layers.
pub fn spacing(case: &Case) -> f64 {
    THICKNESS / (THICKNESS / case.spacing - 1e-9).ceil().max(LAYERS)
}

/// Whether walls have the spacing of the water, as rigid ones always do.
pub fn shares_spacing(case: &Case) -> bool {
    case.youngs.is_none() || (spacing(case) / case.spacing - 1.0).abs() < 1e-9
}

/// What is wrong with elastic walls.
pub fn problems(case: &Case, youngs: f64) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut refuse = |what: String, value: f64, must_be: &'static str| {
        problems.push(Problem::Parameter {
            what,
            value,
            must_be,
        });
    };
    if !(youngs.is_finite() && youngs > 0.0) {
        refuse(
            "Young's modulus of the walls".into(),
            youngs,
            "it must be finite and positive, in Pa",
        );
    }
    if case.spacing > 0.5 * THICKNESS * (1.0 + 1e-9) {
        refuse(
            "spacing of water in elastic walls".into(),
            case.spacing,
            "it must be at most half the thickness of the walls, 0.015 m, or the kernel sees through them",
        );
        return problems;
    }
    let own = spacing(case);
    let names = ["length", "width", "height"];
    for (name, size) in names.into_iter().zip(case.size) {
        let cells = size / own;
        if (cells - cells.round()).abs() > 1e-6 * cells {
            refuse(
                format!("{name} of the tank over the spacing {own} m of its elastic walls"),
                cells,
                "it must be a whole number: choose a spacing of which both are multiples, such as 0.01 m",
            );
        }
    }
    problems
}

/// The walls, closed all around.
pub fn body<T: Real>(case: &Case, youngs: f64) -> Body<T, 3> {
    let dx = spacing(case);
    let layers = (THICKNESS / dx).round() as i64;
    let counts = case.size.map(|size| (size / dx).round() as i64);
    let beyond = |k: i64, d: usize| !(0..counts[d]).contains(&k);
    let mut points = Vec::new();
    for k in -layers..counts[2] + layers {
        for j in -layers..counts[1] + layers {
            for i in -layers..counts[0] + layers {
                if beyond(i, 0) || beyond(j, 1) || beyond(k, 2) {
                    points.push([i, j, k].map(|n| (n as f64 + 0.5) * dx));
                }
            }
        }
    }
    let pmma = Linear::from_elastic_constants(DENSITY, youngs, POISSON);
    let pmma = Material::new("PMMA", pmma).with_shear_modulus(youngs / (2.0 * (1.0 + POISSON)));
    Body::points_of("tank", pmma, points, dx)
}

/// Adds the walls to a scene, held by the columns along the twelve edges of the box.
pub fn add<T: Real>(scene: Scene<T, 3>, case: &Case, youngs: f64) -> Scene<T, 3> {
    let size = case.size;
    let edge = move |x: &[f64; 3]| {
        let beyond = (0..3).filter(|&d| !(0.0..=size[d]).contains(&x[d]));
        beyond.count() > 1
    };
    let walls = body(case, youngs);
    let viscosity = MonaghanGingold {
        alpha: VISCOSITY,
        beta: 0.0,
    };
    let scheme = schemes::total_lagrangian()
        .with_viscosity(viscosity)
        .with(StVenantKirchhoff);
    scene
        .group(scheme, [walls])
        .fix("tank", edge)
        .sub_cycle("tank", STEPS)
}

/// What is ours of elastic walls.
pub fn choices(case: &Case, youngs: f64) -> String {
    let dx = spacing(case);
    format!(
        "Walls of PMMA, {} mm, {DENSITY} kg/m3, E = {:.3} GPa, nu = {POISSON}: a total-Lagrangian body of {:.0} layers of \
         particles, {:.1} mm apart, with an artificial viscosity alpha of {VISCOSITY}. Our choice: in the frame of the \
         tank, whose acceleration loads water and walls alike, the columns along its twelve edges are clamped, so that \
         each wall is a plate clamped all around.\n",
        1e3 * THICKNESS,
        1e-9 * youngs,
        THICKNESS / dx,
        1e3 * dx,
    )
}

/// Mean load \[Pa\] above which a deflection is compared with that of a plate.
const LOADED: f64 = 2e4;

/// How the walls stand at one time.
#[derive(Clone, Copy, Debug)]
pub struct Stand {
    pub time: f64,
    /// Mean displacement along x of the middles of the struck and of the far wall, through the thickness \[m\].
    pub middle: [f64; 2],
    /// Mean pressure of the water on the struck wall \[Pa\].
    pub pressure: f64,
    /// Kinetic, elastic and hourglass energy of the walls, and the work of the water on them \[J\].
    pub energies: [f64; 4],
    /// Momentum that the clamps have given since the start \[N s\].
    pub clamps: [f64; 3],
}

/// Particles whose displacement is followed, as numbers in the body, with where they are as built.
#[derive(Clone, Debug)]
pub struct Watch {
    built: Vec<[f64; 3]>,
    middles: [Vec<usize>; 2],
}

impl Watch {
    pub fn new<T: Real>(case: &Case, now: &Simulation<T, 3>) -> Result<Self, Error> {
        let built: Vec<_> = now.body("tank")?.map(|p| p.position()).collect();
        let near = spacing(case);
        let middle = |struck: bool| {
            let inside = |x: &[f64; 3]| {
                (x[0] > 0.5 * case.size[0]) == struck
                    && (1..3).all(|d| (x[d] - 0.5 * case.size[d]).abs() < near)
                    && !(0.0..=case.size[0]).contains(&x[0])
            };
            let all = built.iter().enumerate();
            all.filter(|(_, x)| inside(x)).map(|(k, _)| k).collect()
        };
        let middles = [middle(true), middle(false)];
        Ok(Self { built, middles })
    }

    pub fn stand<T: Real>(&self, case: &Case, now: &Simulation<T, 3>) -> Result<Stand, Error> {
        let moved: Vec<f64> = self.displaced(now)?.map(|(_, moved)| moved[0]).collect();
        let mean =
            |of: &Vec<usize>| of.iter().map(|&k| moved[k]).sum::<f64>() / of.len().max(1) as f64;
        let [length, width, height] = case.size;
        let struck = |x: &[f64; 3]| {
            x[0] > length && (0.0..=width).contains(&x[1]) && (0.0..=height).contains(&x[2])
        };
        let forces = now.wall_particle_forces();
        let force: f64 = forces
            .iter()
            .filter(|(x, _)| struck(x))
            .map(|(_, force)| force[0])
            .sum();
        let ledger = now.ledger();
        let walls = ledger.bodies.iter().find(|(name, _)| name == "tank");
        let total = |name: &str| walls.and_then(|(_, own)| own.total(name)).unwrap_or(0.0);
        Ok(Stand {
            time: now.time(),
            middle: [mean(&self.middles[0]), mean(&self.middles[1])],
            pressure: force / (width * height),
            energies: [
                walls.map_or(0.0, |(_, own)| own.kinetic),
                total("elastic energy"),
                total("hourglass energy"),
                total("work of couplings"),
            ],
            clamps: clamped(now),
        })
    }

    /// Places as built and displacements \[m\].
    fn displaced<'a, T: Real>(
        &'a self,
        now: &'a Simulation<T, 3>,
    ) -> Result<impl Iterator<Item = ([f64; 3], [f64; 3])> + 'a, Error> {
        let now = now.body("tank")?.map(|p| p.position());
        let both = self.built.iter().zip(now);
        Ok(both.map(|(built, x)| (*built, core::array::from_fn(|d| x[d] - built[d]))))
    }

    /// The rear half of the walls at 38 ms, coloured by what they have moved.
    pub fn snapshot<T: Real>(
        &self,
        case: &Case,
        now: &Simulation<T, 3>,
        folder: &Path,
    ) -> Result<(), Error> {
        let half = 0.5 * case.size[1];
        let size = |u: [f64; 3]| 1e6 * u.iter().map(|u| u * u).sum::<f64>().sqrt();
        let rear = self.displaced(now)?.filter(|(x, _)| x[1] > half);
        let rear: Vec<_> = rear.map(|(x, moved)| (x, size(moved))).collect();
        let title = format!(
            "walls cut at mid width, t = {:.3} ms, displacement",
            1e3 * now.time()
        );
        let outer = |sign: f64, d: usize| {
            if sign < 0.0 {
                -THICKNESS
            } else {
                case.size[d] + THICKNESS
            }
        };
        let picture = Picture::new(1200, 800)
            .title(&title)
            .view(-70.0, 15.0)
            .particles(
                Axis::linear("displacement", "µm").from(0.0),
                spacing(case),
                rear,
            )
            .edges::<3>(
                core::array::from_fn(|d| outer(-1.0, d)),
                core::array::from_fn(|d| outer(1.0, d)),
            );
        super::common::save_picture(&picture, folder.join("walls_38ms"))
    }
}

/// Momentum \[N s\] that the clamps have given.
fn clamped<T: Real>(now: &Simulation<T, 3>) -> [f64; 3] {
    let clamps = now.clamps();
    let of = |d: usize| clamps.iter().map(|clamp| clamp.impulse[d]).sum();
    core::array::from_fn(of)
}

/// Momentum of a body \[N s\] and its mass \[kg\].
fn budget<T: Real>(now: &Simulation<T, 3>, body: &str) -> ([f64; 3], f64) {
    let ledger = now.ledger();
    let own = ledger.bodies.iter().find(|(name, _)| name == body);
    own.map_or(([0.0; 3], 0.0), |(_, own)| {
        (core::array::from_fn(|d| own.momentum[d]), own.mass)
    })
}

/// Impulse of the water on the walls \[N s\]: what the load gave the water and it does not have.
pub fn impulse<T: Real>(case: &Case, now: &Simulation<T, 3>) -> Result<[f64; 3], Error> {
    let ([x, y, z], mass) = budget(now, "water");
    let gained = gained(case, now.time())?;
    Ok([mass * gained[0] - x, -y, mass * gained[2] - z])
}

/// Speed that the load would have given by then \[m/s\].
fn gained(case: &Case, time: f64) -> Result<[f64; 3], Error> {
    let along = -case.pulse.motion::<3>(case.peak())?.pose(time).shift[1][0];
    Ok([along, 0.0, -GRAVITY * time])
}

/// Momentum of water and walls less loads and clamps, over the impulse of the loads: rounding where the load is
/// constant, else what the trapezoids of kicks make of the pulse too.
pub fn imbalance<T: Real>(case: &Case, now: &Simulation<T, 3>) -> Result<f64, Error> {
    let [(water, water_mass), (walls, walls_mass)] =
        ["water", "tank"].map(|body| budget(now, body));
    let (gained, held) = (gained(case, now.time())?, clamped(now));
    let mass = water_mass + walls_mass;
    let size = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    let lack = core::array::from_fn(|d| water[d] + walls[d] - held[d] - mass * gained[d]);
    Ok(size(lack) / size(gained.map(|v| mass * v)))
}

/// The files of the walls that grow while a case runs.
pub struct Files {
    history: CsvWriter,
    movie: Pvd,
}

impl Files {
    pub fn create(folder: &Path) -> Result<Self, Error> {
        let columns = [
            "time_s",
            "deflection_struck_m",
            "deflection_far_m",
            "pressure_struck_pa",
            "kinetic_walls_j",
            "elastic_walls_j",
            "hourglass_walls_j",
            "work_of_water_j",
            "clamp_impulse_x_n_s",
            "clamp_impulse_y_n_s",
            "clamp_impulse_z_n_s",
        ];
        Ok(Self {
            history: CsvWriter::create(folder.join("walls.csv"), &columns)?,
            movie: Pvd::create(folder.join("walls.pvd"))?,
        })
    }

    pub fn sample(&mut self, stand: &Stand) -> Result<(), Error> {
        let mut row = vec![stand.time, stand.middle[0], stand.middle[1], stand.pressure];
        row.extend(stand.energies);
        row.extend(stand.clamps);
        self.history.row(&row)
    }

    pub fn frame<T: Real>(&mut self, watch: &Watch, now: &Simulation<T, 3>) -> Result<(), Error> {
        let single = |x: [f64; 3]| x.map(|x| x as f32);
        let vtu = Vtu::new(now.body("tank")?.map(|p| single(p.position())))
            .vector(
                "displacement_m",
                watch.displaced(now)?.map(|(_, moved)| single(moved)),
            )
            .vector(
                "velocity_m_s",
                now.body("tank")?.map(|p| single(p.velocity())),
            )
            .scalar(
                "pressure_pa",
                now.body("tank")?.map(|p| p.pressure() as f32),
            )
            .time(now.time());
        self.movie.frame(now.time(), &vtu).map(|_| ())
    }
}

/// Deflection \[m\] in the middle of a square plate clamped all around under a pressure \[Pa\]: 0.00126 q a⁴/D after
/// Kirchhoff (Timoshenko & Woinowsky-Krieger 1959, table 35), and with what shear adds, that of a membrane of tension
/// 5/6 G t, 0.0737 q a²/(5/6 G t). Walls that are not square count by their shorter side.
fn plate(case: &Case, youngs: f64, pressure: f64) -> [f64; 2] {
    let side = case.size[1].min(case.size[2]);
    let stiffness = youngs * THICKNESS.powi(3) / (12.0 * (1.0 - POISSON * POISSON));
    let shear = 5.0 / 6.0 * THICKNESS * youngs / (2.0 * (1.0 + POISSON));
    let bent = 0.00126 * pressure * side.powi(4) / stiffness;
    [bent, bent + 0.0737 * pressure * side * side / shear]
}

/// The deflection in the middle of the struck wall over time, with that of the plate under what acts just then.
pub fn report(case: &Case, youngs: f64, record: &Record, folder: &Path) -> Result<String, Failure> {
    let load = |stand: &Stand| -> Result<f64, Error> {
        let own = DENSITY * THICKNESS * super::report::acceleration(case, stand.time)?;
        Ok(stand.pressure + own)
    };
    let mut plates = [Vec::new(), Vec::new()];
    // Means over 1 ms: the walls ring a wave at a time, and the plate is at rest.
    let (mut sums, mut count, mut means) = ([0.0; 3], 0, Vec::new());
    for stand in &record.walls {
        let q = load(stand)?;
        for (line, own) in sums.iter_mut().zip([stand.time, stand.middle[0], q]) {
            *line += own;
        }
        count += 1;
        if stand.time > 1e-3 * (1 + means.len()) as f64 {
            means.push(sums.map(|sum| sum / f64::from(count)));
            (sums, count) = ([0.0; 3], 0);
        }
    }
    for [time, _, q] in &means {
        for (line, moved) in plates.iter_mut().zip(plate(case, youngs, *q)) {
            line.push((1e3 * time, 1e6 * moved));
        }
    }
    let lines = [0, 1].map(|k| {
        let all = record.walls.iter();
        all.map(move |stand| (1e3 * stand.time, 1e6 * stand.middle[k]))
    });
    let [struck, far] = lines;
    let [bent, sheared] = plates;
    let axis = Axis::linear("time", "ms");
    let mut panel = Panel::new(axis.clone(), Axis::linear("deflection along x", "µm"))
        .title("middles of the end walls")
        .series(Series::line("struck wall", struck))
        .series(Series::line("far wall", far));
    // A run below a millisecond has no means.
    if !means.is_empty() {
        panel = panel
            .series(Series::line("plate in bending", bent).reference())
            .series(
                Series::line("plate in bending and shear", sheared)
                    .dashed()
                    .color(Color(120, 120, 120)),
            );
    }
    let mut energy = Panel::new(axis, Axis::linear("energy of the walls", "mJ"));
    for (k, name) in ["kinetic", "elastic", "hourglass", "work of the water"]
        .into_iter()
        .enumerate()
    {
        let line = record
            .walls
            .iter()
            .map(|s| (1e3 * s.time, 1e3 * s.energies[k]));
        energy = energy.series(Series::line(name, line));
    }
    let figure = Figure::new().columns(2).panel(panel).panel(energy);
    figure.save(folder.join("walls.svg"))?;

    let first = record.walls.first();
    let most = first.map_or(0.0, |first| {
        let all = record.walls.iter().map(|stand| stand.middle[0]);
        all.fold(first.middle[0], f64::max)
    });
    let mut text = format!("struck wall: {:.4} mm at most", 1e3 * most);
    // Over all that is well loaded: the ratio of impulses is free of ringing.
    let loaded: Vec<_> = means.iter().filter(|own| own[2] > LOADED).collect();
    if !loaded.is_empty() {
        let sum = |k: usize| loaded.iter().map(|own| own[k]).sum::<f64>();
        let [bent, sheared] = plate(case, youngs, sum(2)).map(|moved| 1e2 * (sum(1) / moved - 1.0));
        text += &format!(
            "; while its mean load is above 20 kPa {:.4} mm under {:.1} kPa, {bent:+.1} % off a clamped plate in \
             bending and {sheared:+.1} % off one in bending and shear",
            1e3 * sum(1) / loaded.len() as f64,
            1e-3 * sum(2) / loaded.len() as f64,
        );
    }
    let kind = if case.pulse == Pulse::Constant {
        "rounding"
    } else {
        "rounding and the trapezoids of a pulse of straight lines"
    };
    text += &format!(
        "\nmomentum of water and walls less loads and clamps, over the loads': {:.1e} ({kind})\n{} particles of walls, {} \
         steps of theirs in {} of the water, {:.2} ms of computing for one of the water",
        record.imbalance,
        record.wall_particles,
        record.wall_steps,
        record.steps,
        1e3 * record.seconds / record.steps.max(1) as f64,
    );
    Ok(text)
}
