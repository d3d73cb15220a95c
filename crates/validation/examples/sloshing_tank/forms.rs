//! Four forms of the same water side by side, as Vesenjak & Ren (2007) compare them: SPH, ALE, Eulerian and Lagrangian.
//! On a slice of the tank, or in space; each runs until the end, or until it can no longer hold its water.

use super::common::{Failure, Options};
use super::heights::Surface;
use super::run::SNAPSHOT;
use super::tank::{ALPHA, Case, GRAVITY, H_OVER_DX, JITTER, LAYERS};
use meshfree::boundary::{Motion, Translation};
use meshfree::coupling::Penalty;
use meshfree::effect::{
    ArbitraryLagrangian, ExpansionMemory, FiveEquations, HourglassControl, LagrangianLiquid,
    Shifting,
};
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree::material::Liquid;
use meshfree::material::eos::{IdealGas, StiffenedGas};
use meshfree::observe::PressureProbe;
use meshfree::output::csv::CsvWriter;
use meshfree::output::progress::Progress;
use meshfree::output::svg::{Axis, Figure, Panel, Series};
use meshfree::output::table::{Table, significant};
use meshfree::prelude::*;
use meshfree::scene::{Conversion, Start};
use meshfree::term::viscosity::MonaghanGingold;
use std::time::{Duration, Instant};

/// Stations \[shares of the length\] at which the height of the surface is read.
const STATIONS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// Height of Point 1 and diameter of its sensor \[m\].
const POINT: f64 = 0.05;
const SENSOR: f64 = 0.02;
/// Time until which impulses of forms that stop are compared \[s\].
const EARLY: f64 = 0.03;
/// Stretches beyond which a total-Lagrangian scheme counts its particles as beyond its validity. At a largest stretch of 4 the impulse
/// is within 0.5 % and the surface within 3 mm of those of SPH; at 8 a fifth of the impulse is lost.
const STRETCHES: [f64; 2] = [0.1, 4.0];

/// A form of the water.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Sph,
    Ale,
    Eulerian,
    Lagrangian,
}

const FORMS: [(Form, &str); 4] = [
    (Form::Sph, "SPH"),
    (Form::Ale, "ALE"),
    (Form::Eulerian, "Eulerian"),
    (Form::Lagrangian, "Lagrangian"),
];

/// What a form did.
#[derive(Clone, Debug, Default)]
struct Record {
    name: &'static str,
    /// Time \[s\] and pressure at Point 1 \[Pa\], step by step.
    samples: Vec<[f64; 2]>,
    /// Heights of the surface at the stations \[m\], and along the tank as (x, z) \[m\], at 38 ms.
    heights: Option<[f64; 5]>,
    surface: Vec<[f64; 2]>,
    /// Σ m/ρ over that of the start, less one: at 38 ms, or where it stopped.
    volume: f64,
    /// The same of mass; of momentum what is neither from the acceleration nor from walls, over that from the acceleration.
    mass: f64,
    momentum: Option<f64>,
    /// Work of the acceleration that is not energy of motion, over the work: dissipated, or stored in compression.
    energy: f64,
    particles: usize,
    steps: u64,
    /// Time on processors \[s\].
    seconds: f64,
    /// When it stopped \[s\], and why.
    stopped: Option<(f64, String)>,
}

impl Record {
    fn end(&self) -> f64 {
        self.samples.last().map_or(0.0, |sample| sample[0])
    }
    /// ∫ p dt \[Pa s\] until `end` \[s\], if it came so far.
    fn impulse(&self, end: f64) -> Option<f64> {
        let pairs = || self.samples.windows(2).filter(|pair| pair[1][0] <= end);
        let sum = pairs().map(|p| 0.5 * (p[1][0] - p[0][0]) * (p[0][1] + p[1][1]));
        (self.end() >= end).then(|| sum.sum())
    }
    /// Pressure \[Pa\] at a time \[s\], a mean over a millisecond before it, if it came so far.
    fn pressure(&self, time: f64) -> Option<f64> {
        Some((self.impulse(time)? - self.impulse(time - 1e-3)?) / 1e-3)
    }
}

/// Pressure of the air at rest \[Pa\], from which pressures of the Eulerian form count, and the density of the air \[kg/m³\].
const AIR: [f64; 2] = [101_325.0, 1.2];
/// Exponents of water and air.
const GAMMA: [f64; 2] = [4.4, 1.4];
/// The true sound speed of water \[m/s\].
const SOUND: f64 = 1480.0;

/// Water of a sound speed \[m/s\], and air.
fn laws(sound: f64) -> (StiffenedGas, IdealGas) {
    let stiffness = 1000.0 * sound * sound / GAMMA[0] - AIR[0];
    (
        StiffenedGas::new(GAMMA[0], stiffness, 1000.0),
        IdealGas::new(GAMMA[1], AIR[1]),
    )
}

fn fluids(sound: f64) -> FiveEquations {
    let (water, air) = laws(sound);
    FiveEquations::new(water, air)
}

/// Water and air of the Eulerian form at rest, under the pressure of the air.
fn water_and_air<const D: usize>(case: &Case) -> [Body<f64, D>; 2] {
    let up = D - 1;
    let (water, air) = laws(case.sound_speed.of(SOUND));
    let mut low = [0.0; D];
    let mut high: [f64; D] = core::array::from_fn(|d| case.size[d]);
    (low[up], high[up]) = (case.depth(), case.size[2]);
    let warm = |p: f64, gamma: f64, density: f64| p / ((gamma - 1.0) * density);
    let depth = case.depth();
    let above = Body::block("air", Material::new("air", air), low, high, case.spacing)
        .energy(warm(AIR[0], GAMMA[1], AIR[1]));
    (low[up], high[up]) = (0.0, depth);
    let below = Body::block(
        "water",
        Material::new("water", water),
        low,
        high,
        case.spacing,
    );
    let below = below.start(move |x, start| Start {
        energy: warm(
            AIR[0] + 1000.0 * GRAVITY * (depth - x[up]),
            GAMMA[0],
            1000.0,
        ),
        ..start
    });
    [below, above]
}

/// The scheme of a form; one text for a slice and for space.
macro_rules! scheme_of {
    ($name:ident, $dimension:literal) => {
        fn $name(form: Form, floor: f64, sound: f64) -> Scheme<f64, $dimension> {
            let viscosity = MonaghanGingold {
                alpha: ALPHA,
                beta: 0.0,
            };
            let flowing = || {
                schemes::weakly_compressible()
                    .h_over_dx(H_OVER_DX)
                    .with_viscosity(viscosity)
                    .walls(ExtrapolatedPressure { floor })
                    .with(ExpansionMemory)
            };
            match form {
                Form::Sph => flowing().with(Shifting::STANDARD).compose(),
                Form::Ale => flowing()
                    .with(ArbitraryLagrangian::<false>::default())
                    .compose(),
                Form::Eulerian => {
                    SchemeBuilder::five_equations(WendlandC2, fluids(sound)).compose()
                }
                Form::Lagrangian => SchemeBuilder::total_lagrangian(WendlandC2, viscosity)
                    .h_over_dx(1.0)
                    .with(HourglassControl::default())
                    .with(LagrangianLiquid)
                    .compose(),
            }
        }
    };
}
scheme_of!(slice, 2);
scheme_of!(space, 3);

/// Runs all forms, prints them side by side and leaves a picture and two tables.
pub fn compare(case: &Case, in_space: bool, options: &Options) -> Result<(), Failure> {
    if options.single {
        return Err("--compare: the forms run in f64 alone; leave out --precision".into());
    }
    std::fs::create_dir_all(options.folder())?;
    let (sound, mut records) = (case.sound_speed.of(SOUND), Vec::new());
    for (form, name) in FORMS {
        records.push(if in_space {
            run(case, form, name, space(form, case.cut_off, sound))?
        } else {
            run(case, form, name, slice(form, case.cut_off, sound))?
        });
    }
    let table = table(case, &records);
    println!("{table}");
    let mut text = table.markdown();
    for record in &records {
        if let Some((time, reason)) = &record.stopped {
            let line = format!("{} stopped at {:.1} ms: {reason}.", record.name, 1e3 * time);
            println!("{line}");
            text += &format!("\n{line}\n");
        }
    }
    std::fs::write(options.file("forms.md"), text)?;
    let mut surfaces = CsvWriter::create(options.file("surfaces.csv"), &["form", "x_m", "z_m"])?;
    let mut points = CsvWriter::create(
        options.file("point_1.csv"),
        &["form", "time_s", "pressure_pa"],
    )?;
    for (k, record) in records.iter().enumerate() {
        for [x, z] in &record.surface {
            surfaces.row(&[k as f64, *x, *z])?;
        }
        for [t, p] in &record.samples {
            points.row(&[k as f64, *t, *p])?;
        }
    }
    figure(case, &records).save(options.file("forms.svg"))?;
    println!("written to {}", options.folder().display());
    Ok(())
}

fn table(case: &Case, records: &[Record]) -> Table {
    let mut columns = vec!["quantity".to_string()];
    columns.extend(records.iter().map(|record| record.name.to_string()));
    let mut table = Table::new(columns);
    let mut row = |name: String, of: &dyn Fn(&Record) -> Option<String>| {
        let own = records
            .iter()
            .map(|own| of(own).unwrap_or_else(|| "-".into()));
        table.row(core::iter::once(name).chain(own).collect::<Vec<_>>());
    };
    for (k, share) in STATIONS.into_iter().enumerate() {
        let name = format!(
            "height at x = {:.0} mm, 38 ms [mm]",
            1e3 * share * case.size[0]
        );
        row(name, &|own| Some(format!("{:.0}", 1e3 * own.heights?[k])));
    }
    let pascal_seconds = |value: f64| significant(value, 4);
    for end in [0.01, EARLY, SNAPSHOT, case.until] {
        let name = format!("impulse at Point 1 until {:.0} ms [Pa s]", 1e3 * end);
        row(name, &|own| own.impulse(end).map(pascal_seconds));
    }
    for time in [EARLY, SNAPSHOT] {
        let name = format!("pressure at Point 1, {:.0} ms [kPa]", 1e3 * time);
        row(name, &|own| {
            Some(significant(1e-3 * own.pressure(time)?, 3))
        });
    }
    let percent = |value: f64| Some(format!("{:+.2} %", 1e2 * value));
    row("volume of particles".into(), &|own| percent(own.volume));
    row("mass".into(), &|own| Some(format!("{:.1e}", own.mass)));
    row("momentum".into(), &|own| {
        Some(format!("{:.1e}", own.momentum?))
    });
    row("work not in motion".into(), &|own| {
        (own.end() >= EARLY).then(|| percent(own.energy))?
    });
    row("stopped at [ms]".into(), &|own| {
        Some(format!("{:.1}", 1e3 * own.stopped.as_ref()?.0))
    });
    row("particles".into(), &|own| Some(own.particles.to_string()));
    row("steps".into(), &|own| Some(own.steps.to_string()));
    row("processor time [s]".into(), &|own| {
        Some(significant(own.seconds, 3))
    });
    row("per millisecond [ms]".into(), &|own| {
        Some(significant(own.seconds / own.end(), 3))
    });
    table
}

/// The surfaces over each other, and the pressure at Point 1.
fn figure(case: &Case, records: &[Record]) -> Figure {
    let mut surfaces = Panel::new(Axis::linear("x", "m"), Axis::linear("z", "m"))
        .title("surface at 38 ms")
        .equal_aspect();
    let mut pressures = Panel::new(Axis::linear("time", "ms"), Axis::linear("pressure", "kPa"))
        .title("Point 1, means over 0.5 ms");
    for record in records {
        if !record.surface.is_empty() {
            let points = record.surface.iter().map(|[x, z]| (*x, *z));
            surfaces = surfaces.series(Series::line(record.name, points));
        }
        let mut means = Vec::new();
        let mut group: Vec<[f64; 2]> = Vec::new();
        for sample in &record.samples {
            group.push(*sample);
            if sample[0] - group[0][0] >= 5e-4 {
                let mean = group.iter().map(|own| own[1]).sum::<f64>() / group.len() as f64;
                means.push((0.5e3 * (sample[0] + group[0][0]), 1e-3 * mean));
                group.clear();
            }
        }
        pressures = pressures.series(Series::line(record.name, means));
    }
    let [length, _, height] = case.size;
    let tank = [
        (0.0, 0.0),
        (length, 0.0),
        (length, height),
        (0.0, height),
        (0.0, 0.0),
    ];
    let surfaces = surfaces.series(Series::line("tank", tank).reference());
    Figure::new()
        .columns(2)
        .shared_legend()
        .panel(surfaces)
        .panel(pressures)
}

/// Time that the threads of this process were on processors, where the system tells.
fn processor_time() -> Option<Duration> {
    let mut sum = 0;
    for task in std::fs::read_dir("/proc/self/task").ok()? {
        let text = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        sum += text.split_whitespace().next()?.parse::<u64>().ok()?;
    }
    Some(Duration::from_nanos(sum))
}

/// The tank of a form: walls of particles; for the Lagrangian one planes of symmetry where it starts, that is bottom, struck
/// wall and sides, and contact with those that it leaves or comes to.
fn build<const D: usize>(
    case: &Case,
    form: Form,
    scheme: Scheme<f64, D>,
    motion: Translation<D>,
) -> Result<Simulation<f64, D>, Error> {
    let up = D - 1;
    let size: [f64; D] =
        core::array::from_fn(|d| if d == up { case.size[2] } else { case.size[d] });
    let mut filled = size;
    filled[up] = case.depth();
    let mut gravity = [0.0; D];
    gravity[up] = -GRAVITY;
    let mut surface = [0.0; D];
    surface[up] = case.depth();
    let water = Liquid::water()
        .material("water", case.sound_speed)
        .with_pressure_cut_off(case.cut_off);
    let moves = [Form::Sph, Form::Ale].contains(&form);
    let body = Body::block("water", water, [0.0; D], filled, case.spacing)
        .jitter(if moves { JITTER } else { 0.0 }, 1)
        .hydrostatic(gravity, surface);
    let mut closed = [[true; 2]; D];
    let mut scene = Scene::new(scheme);
    scene = if form == Form::Eulerian {
        water_and_air(case).into_iter().fold(scene, Scene::body)
    } else {
        scene.body(body)
    };
    if form == Form::Lagrangian {
        closed = [[false; 2]; D];
        closed[0][0] = true;
        closed[up][1] = true;
        for d in 0..D {
            for (high, at) in [(false, 0.0), (true, size[d])] {
                if closed[d][usize::from(high)] {
                    continue;
                }
                let (mut point, mut normal) = ([0.0; D], [0.0; D]);
                point[d] = at;
                normal[d] = if high { 1.0 } else { -1.0 };
                scene = scene.boundary(MirrorPlane::symmetry(point, normal));
            }
        }
    }
    let tank = Wall::around("tank", [0.0; D], size, case.spacing, LAYERS, closed);
    scene = scene.wall(tank.container_frame());
    if form == Form::Lagrangian {
        scene = scene.couple("water", "tank", Penalty::new());
    }
    scene
        .acceleration(move |t| {
            let mut a = motion.pose(t).shift[2].map(|a| -a);
            a[D - 1] -= GRAVITY;
            a.into()
        })
        .build()
}

/// Pressure \[Pa\] at Point 1 from the two layers of a lattice before it, continued to the wall: a probe takes what is not full for dry, and here
/// all is full, of water or of air.
fn at_wall<const D: usize>(case: &Case, now: &Simulation<f64, D>) -> f64 {
    let mut layers = [[0.0; 2]; 2];
    for p in now.all() {
        let x = p.position();
        let layer = ((case.size[0] - x[0]) / case.spacing) as usize;
        let beside = |d: usize, at: f64| (x[d] - at).abs() <= 0.5 * SENSOR;
        let near = beside(D - 1, POINT) && (1..D - 1).all(|d| beside(d, 0.5 * case.size[d]));
        if let Some([sum, count]) = layers.get_mut(layer).filter(|_| near) {
            *sum += p.pressure();
            *count += 1.0;
        }
    }
    let [first, second] = layers.map(|[sum, count]| sum / count);
    1.5 * first - 0.5 * second
}

fn run<const D: usize>(
    case: &Case,
    form: Form,
    name: &'static str,
    scheme: Scheme<f64, D>,
) -> Result<Record, Failure>
where
    WendlandC2: Kernel<D>,
{
    let up = D - 1;
    let motion = case.pulse.motion::<D>(case.peak())?;
    let mut own = build(case, form, scheme, case.pulse.motion::<D>(case.peak())?)?;
    let mut point = [0.5 * case.size[1]; D];
    (point[0], point[up]) = (case.size[0], POINT);
    let mut normal = [0.0; D];
    normal[0] = -1.0;
    let mut probe = PressureProbe::disc(&own, "Point 1", point, normal, SENSOR)?;
    if form != Form::Lagrangian {
        probe = probe.on_wall("tank")?;
    }
    // Of the water, where it shares its particles with air.
    let totals = |now: &Simulation<f64, D>| -> [f64; 2] {
        let all = now.all();
        all.fold([0.0; 2], |[m, v], p| {
            let mass = p.scalar(FiveEquations::LIQUID).unwrap_or(p.mass());
            let share = p.scalar(FiveEquations::FRACTION).unwrap_or(1.0);
            [m + mass, v + share * p.mass() / p.density()]
        })
    };
    let pressure = |now: &Simulation<f64, D>| {
        if form == Form::Eulerian {
            at_wall(case, now) - AIR[0]
        } else {
            probe.pressure(now)
        }
    };
    let acceleration = |t: f64| -> [f64; D] {
        let a = motion.pose(t).shift[2];
        core::array::from_fn(|d| -a[d] - if d == up { GRAVITY } else { 0.0 })
    };
    let momentum = |now: &Simulation<f64, D>| now.ledger().whole.momentum;
    let start = totals(&own);
    let mut record = Record {
        name,
        particles: own.all().count(),
        samples: vec![[0.0, pressure(&own)]],
        ..Record::default()
    };
    let monitor = Conversion::default()
        .volumes([0.1, 10.0])
        .stretches(STRETCHES);
    let (mut given, mut work) = ([0.0; D], 0.0);
    let mut before = (0.0, acceleration(0.0), momentum(&own));
    let began = (processor_time(), Instant::now());
    let mut progress = Progress::new(name);
    while own.time() < case.until {
        own.step()?;
        let time = own.time();
        let now = (time, acceleration(time), momentum(&own));
        let half = 0.5 * (time - before.0);
        for d in 0..D {
            given[d] += half * start[0] * (before.1[d] + now.1[d]);
            work += half * (before.1[d] * before.2[d] + now.1[d] * now.2[d]);
        }
        before = now;
        record.samples.push([time, pressure(&own)]);
        progress.update(time / case.until, format_args!("t = {:.2} ms", 1e3 * time));
        let reason = if form == Form::Lagrangian {
            monitor
                .distortion(&own, "water")?
                .map(|own| own.to_string())
        } else {
            None
        };
        let shown = time >= SNAPSHOT && record.heights.is_none();
        if shown {
            let surface = Surface::of(case, &own);
            record.heights = Some(STATIONS.map(|share| surface.height(share * case.size[0])));
            let count = (2.0 * case.size[0] / case.spacing).round() as usize;
            let places = (0..count).map(|k| (k as f64 + 0.5) * case.size[0] / count as f64);
            record.surface = places.map(|x| [x, surface.height(x)]).collect();
        }
        if shown || (reason.is_some() && time < SNAPSHOT) {
            let [mass, volume] = totals(&own);
            (record.mass, record.volume) = (mass / start[0] - 1.0, volume / start[1] - 1.0);
            let ledger = own.ledger();
            record.energy = 1.0 - ledger.whole.kinetic / work;
            let walls = own.wall_impulse("tank")?;
            let lack = |d: usize| {
                ledger.whole.momentum[d] + walls[d] - ledger.boundary_impulse[d] - given[d]
            };
            let size =
                |of: &dyn Fn(usize) -> f64| (0..D).map(|d| of(d).powi(2)).sum::<f64>().sqrt();
            // Forces on walls of the Eulerian form are in no sum.
            record.momentum = (form != Form::Eulerian).then(|| size(&lack) / size(&|d| given[d]));
        }
        if let Some(reason) = reason {
            record.stopped = Some((time, reason));
            break;
        }
    }
    progress.finish();
    let spent = began.0.and_then(|from| processor_time()?.checked_sub(from));
    record.seconds = spent.unwrap_or_else(|| began.1.elapsed()).as_secs_f64();
    record.steps = own.steps();
    Ok(record)
}
