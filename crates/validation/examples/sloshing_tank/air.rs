//! What the air in the tank does: a slice of it, 2D, with water and air as two phases, or with water alone.
//! Both runs share scheme and cut-off, so that they differ by the air.

use super::common::{Failure, Options};
use super::run::SNAPSHOT;
use super::tank::{Case, GRAVITY};
use meshfree::effect::{ExpansionMemory, TwoPhase, WithinPhase};
use meshfree::material::Liquid;
use meshfree::material::eos::Tait;
use meshfree::observe::PressureProbe;
use meshfree::output::csv::CsvWriter;
use meshfree::output::picture::Picture;
use meshfree::output::svg::{Axis, Figure, Panel, Series};
use meshfree::output::table::{Table, significant};
use meshfree::prelude::*;
use meshfree::scalar::Real;
use meshfree::sweep::Interaction;
use meshfree::term::Fourtakas;
use meshfree::term::viscosity::MonaghanGingold;
use std::time::Instant;

/// Density of the air \[kg/m³\].
const AIR: f64 = 1.2;
/// Stiffness ρc² of the air over that of the water at its artificial sound speed. True air has a two-hundredth of it, and is
/// thrown about by what pressures of water err at the interface.
const STIFFNESS: f64 = 0.1;
/// Lowest pressure of water, air and walls \[Pa\]: vacuum, for pressures are above that of the air.
const VACUUM: f64 = -101e3;
/// Time between samples \[s\].
const SAMPLING: f64 = 5e-5;

/// Pressure at Point 1 and the mean of the air over time.
struct History {
    name: &'static str,
    /// Time \[s\], pressure at Point 1 and of the air \[Pa\].
    samples: Vec<[f64; 3]>,
    steps: u64,
    particles: usize,
    seconds: f64,
}

impl History {
    /// ∫ p dt \[Pa s\] until `end` of what is made of a sample.
    fn impulse(&self, end: f64, of: impl Fn(&[f64; 3]) -> f64) -> f64 {
        let pairs = self
            .samples
            .windows(2)
            .filter(|p| p[1][0] <= end + SAMPLING);
        pairs
            .map(|p| 0.5 * (p[1][0] - p[0][0]) * (of(&p[0]) + of(&p[1])))
            .sum()
    }
}

/// Runs the slice with and without air, as asked for.
pub fn compare<T: Real>(case: &Case, which: &str, options: &Options) -> Result<(), Failure> {
    let choices: &[bool] = match which {
        "on" => &[true],
        "off" => &[false],
        "both" => &[false, true],
        other => {
            return Err(
                format!("--air: `{other}` is not accepted; it takes on, off or both").into(),
            );
        }
    };
    std::fs::create_dir_all(options.folder())?;
    let runs = choices.iter().map(|air| run::<T>(case, *air, options));
    let runs = runs.collect::<Result<Vec<_>, _>>()?;
    let mut table = Table::new([
        "slice",
        "impulse at Point 1 until 38 ms [Pa s]",
        "until the end",
        "above the mean of the air",
        "peak [kPa]",
        "particles",
        "steps",
        "time [s]",
    ]);
    let mut panel = Panel::new(
        Axis::linear("time", "ms"),
        Axis::linear("pressure at Point 1", "kPa"),
    );
    for run in &runs {
        let peak = run.samples.iter().map(|s| s[1]).fold(0.0, f64::max);
        table.row([
            run.name.to_string(),
            significant(run.impulse(SNAPSHOT, |s| s[1]), 4),
            significant(run.impulse(case.until, |s| s[1]), 4),
            significant(run.impulse(case.until, |s| s[1] - s[2]), 4),
            significant(1e-3 * peak, 3),
            run.particles.to_string(),
            run.steps.to_string(),
            significant(run.seconds, 3),
        ]);
        let points = run.samples.iter().map(|s| (1e3 * s[0], 1e-3 * s[1]));
        panel = panel.series(Series::line(run.name, points));
        if run.name == "with air" {
            let points = run.samples.iter().map(|s| (1e3 * s[0], 1e-3 * s[2]));
            panel = panel.series(Series::line("mean of the air", points).dashed());
        }
    }
    println!("{table}");
    std::fs::write(options.file("air.md"), table.markdown())?;
    Figure::new().panel(panel).save(options.file("air.svg"))?;
    println!("written to {}", options.folder().display());
    Ok(())
}

fn run<T: Real>(case: &Case, air: bool, options: &Options) -> Result<History, Failure> {
    let started = Instant::now();
    let (dx, size) = (case.spacing, [case.size[0], case.size[2]]);
    let filled = [size[0], case.depth()];
    let water = Liquid::water().material::<T>("water", case.sound_speed);
    let sound = case.sound_speed.of(1480.0);
    let stiff = sound * (STIFFNESS * 1000.0 / AIR).sqrt();
    let gravity = [0.0, -GRAVITY];
    let water = Body::block(
        "water",
        water.with_pressure_cut_off(VACUUM),
        [0.0; 2],
        filled,
        dx,
    )
    .hydrostatic(gravity, [0.0, case.depth()]);
    let scheme = schemes::weakly_compressible()
        .with_viscosity(MonaghanGingold {
            alpha: 0.002,
            beta: 0.0,
        })
        .walls(ExtrapolatedPressure { floor: VACUUM })
        .density_diffusion(WithinPhase(Fourtakas::default()))
        .with(TwoPhase::default())
        .with(ExpansionMemory)
        .between_bodies(Interaction::Bonded);
    let mut scene = Scene::<T, 2>::new(scheme).body(water);
    if air {
        let law = Tait::new(AIR, stiff).with_gamma(1.4);
        let air = Material::new("air", law).with_pressure_cut_off(VACUUM);
        scene = scene.body(Body::block("air", air, [0.0, case.depth()], size, dx));
    }
    let tank = Wall::around("tank", [0.0; 2], size, dx, 3, [[true; 2]; 2]);
    let pulse = case.pulse.motion::<2>(case.peak())?;
    let mut own = scene
        .wall(tank.container_frame())
        .acceleration(move |t| {
            let a = pulse.pose(t).shift[2];
            [-a[0], -a[1] - GRAVITY]
        })
        .build()?;
    let point = [size[0], 0.05];
    let probe = PressureProbe::disc(&own, "Point 1", point, [-1.0, 0.0], 0.02)?.on_wall("tank")?;
    let name = if air { "with air" } else { "water alone" };
    let folder = options.folder().join(name.replace(' ', "_"));
    std::fs::create_dir_all(&folder)?;
    let mut file = CsvWriter::create(
        folder.join("point_1.csv"),
        &["time_s", "pressure_pa", "air_pa"],
    )?;
    let (mut samples, mut failed): (Vec<[f64; 3]>, Result<(), Error>) = (Vec::new(), Ok(()));
    let mut stops = vec![SNAPSHOT.min(case.until), case.until];
    stops.dedup();
    for stop in stops {
        own.run_with(stop, |now| {
            let last = samples.last().map_or(-1.0, |s| s[0]);
            if failed.is_err() || now.time() < last + SAMPLING {
                return;
            }
            let (mut sum, mut count) = (0.0, 0.0_f64);
            for p in now.body("air").into_iter().flatten() {
                sum += p.pressure().to_f64();
                count += 1.0;
            }
            let sample = [now.time(), probe.pressure(now), sum / count.max(1.0)];
            failed = file.row(&sample);
            samples.push(sample);
        })?;
        if stop <= SNAPSHOT {
            snapshot(case, &own, &folder)?;
        }
    }
    failed?;
    Ok(History {
        name,
        samples,
        steps: own.steps(),
        particles: own.particles(),
        seconds: started.elapsed().as_secs_f64(),
    })
}

/// The water by its pressure.
fn snapshot<T: Real>(
    case: &Case,
    own: &Simulation<T, 2>,
    folder: &std::path::Path,
) -> Result<(), Error> {
    let top = 1e-3 * 1000.0 * case.peak() * case.size[0] * case.fill;
    let water = own.body("water")?.map(|p| {
        let [x, z] = p.position().map(Real::to_f64);
        ([x, 0.0, z], 1e-3 * p.pressure().to_f64())
    });
    let picture = Picture::new(1200, 800)
        .title(&format!(
            "slice of the tank, t = {:.1} ms, water",
            1e3 * own.time()
        ))
        .view(-90.0, 0.0)
        .particles(
            Axis::linear("pressure", "kPa").range(0.0, top.max(1.0)),
            case.spacing,
            water,
        );
    super::common::save_picture(&picture, folder.join("water_38ms"))
}
