//! What must hold, measured: start-up pressure, impulses, balances, frames, and the wall that is left.
//! Each line is a quantity, what it must be, and what was found; `docs/sloshing.md` has the main ones.

use super::common::{Failure, Options};
use super::pulse::Pulse;
use super::report::{IMPULSIVE, acceleration, bracket, shares};
use super::run::{Record, Sample, in_tank, run};
use super::surface::Space;
use super::tank::{Case, GRAVITY, H_OVER_DX, WATER};
use meshfree::material::SoundSpeed;
use meshfree::output::table::{Table, significant};
use meshfree::scalar::Real;
use std::time::Instant;

/// When the sound of the start has gone to and fro often enough for a mean to be taken \[s\].
const SETTLED: f64 = 0.002;

/// When the water has calmed after the half sine \[s\].
const CALM: f64 = 1.25;

/// Measures all, at the spacing of the case and two coarser ones.
pub fn measure<T: Real>(case: &Case, options: &Options) -> Result<(), Failure> {
    let started = Instant::now();
    let mut text = format!("{}\n", case.choices());
    let mut show = |part: String| {
        println!("{part}");
        text += &part;
        text += "\n";
    };
    let artificial = Case {
        sound_speed: artificial(case),
        until: 0.08,
        ..case.clone()
    };
    show(start_up::<T>(case, &artificial)?.markdown());
    show(steady::<T>(&artificial)?.markdown());
    let spacings = [1.0, 4.0 / 3.0, 2.0].map(|factor| factor * case.spacing);
    let mut runs = Vec::new();
    for cut_off in [0.0, -101e3] {
        for spacing in spacings {
            let case = Case {
                spacing,
                cut_off,
                ..artificial.clone()
            };
            let record = run::<T>(&case, None, true)?;
            runs.push((case, record));
        }
    }
    show(balances(&runs).markdown());
    show(far_wall(&runs).markdown());
    show(calmed::<T>(&artificial, spacings[1])?.markdown());
    show(frames::<T>(&artificial, spacings[2])?.markdown());
    show(format!("All in {:.0} s.", started.elapsed().as_secs_f64()));
    std::fs::create_dir_all(options.folder())?;
    Ok(std::fs::write(options.file("bars.md"), text)?)
}

fn artificial(case: &Case) -> SoundSpeed {
    SoundSpeed::artificial((2.0 * case.peak() * case.size[0]).sqrt())
}

/// The pressure less the hydrostatic one over ρ a h at three heights, t < 10 ms.
fn start_up<T: Real>(case: &Case, artificial: &Case) -> Result<Table, Failure> {
    let mut table = Table::new([
        "sound speed",
        "height [mm]",
        "bracket",
        "means over 4 h/c0",
        "outside",
    ])
    .title("Start-up pressure over rho a(t) h, less hydrostatic, 2 to 10 ms; within 5 %");
    for (name, case) in [("physical", case), ("artificial", artificial)] {
        let heights = [0.01, 0.05, 0.10];
        let case = Case {
            sound_speed: if name == "physical" {
                SoundSpeed::Physical
            } else {
                case.sound_speed
            },
            until: IMPULSIVE,
            probes: heights
                .map(|z| [case.size[0], 0.5 * case.size[1], z])
                .to_vec(),
            ..case.clone()
        };
        let record = run::<T>(&case, None, false)?;
        // Force by acceleration: impulses of both over the window, as a(t) grows within it.
        let window = 4.0 * case.depth() / case.sound_speed.of(1480.0);
        for (k, z) in heights.into_iter().enumerate() {
            let Some([low, high]) = bracket(&case, z) else {
                continue;
            };
            let static_pressure = WATER * GRAVITY * (case.depth() - z);
            let (mut least, mut greatest, mut at) = (f64::INFINITY, 0.0_f64, SETTLED);
            while at + window <= IMPULSIVE {
                let mean = record.mean([at, at + window], |s| s.pressures[k]) - static_pressure;
                let pieces = 50;
                let mut a = 0.0;
                for piece in 0..pieces {
                    let time = at + window * (f64::from(piece) + 0.5) / f64::from(pieces);
                    a += acceleration(&case, time)? / f64::from(pieces);
                }
                let c = mean / (WATER * a * case.depth());
                (least, greatest) = (least.min(c), greatest.max(c));
                at += 0.25 * window;
            }
            let outside = (1.0 - least / low).max(greatest / high - 1.0).max(0.0);
            table.row([
                name.into(),
                significant(1e3 * z, 3),
                format!("{low:.3} to {high:.3}"),
                format!("{least:.3} to {greatest:.3}"),
                format!("{:.1} %", 1e2 * outside),
            ]);
        }
    }
    Ok(table)
}

/// Constant acceleration: the water abuts the wall.
fn steady<T: Real>(artificial: &Case) -> Result<Table, Failure> {
    let case = Case {
        pulse: Pulse::Constant,
        until: 0.2,
        ..artificial.clone()
    };
    let record = run::<T>(&case, None, false)?;
    let slab = WATER * case.peak() * case.fill * case.size[0];
    let mut table = Table::new(["height [mm]", "rho a l [kPa]", "mean [kPa]", "difference"])
        .title("Constant acceleration: mean pressure over 150 to 200 ms; within 5 %");
    let space = in_words(record.space[1]);
    for (k, probe) in case.probes.iter().enumerate() {
        let mean = record.mean([0.15, 0.2], |s| s.pressures[k]);
        table.row([
            significant(1e3 * probe[2], 3),
            significant(1e-3 * slab, 4),
            significant(1e-3 * mean, 4),
            format!("{:+.1} %", 1e2 * (mean / slab - 1.0)),
        ]);
    }
    table.row(["at 200 ms", &space]);
    Ok(table)
}

fn in_words(space: Space) -> String {
    format!(
        "space half full {:+.1} %, with spray {:+.1} %",
        1e2 * space.half_full,
        1e2 * space.with_spray
    )
}

/// What is left of the volume when the water has fallen back: at a cut-off of 0, under gravity after the
/// half sine.
fn calmed<T: Real>(artificial: &Case, spacing: f64) -> Result<Table, Failure> {
    let case = Case {
        spacing,
        cut_off: 0.0,
        until: CALM,
        ..artificial.clone()
    };
    let record = run::<T>(&case, None, false)?;
    let mut table = Table::new(["spacing [mm]", "time [s]", "space", "leaked", "run [s]"])
        .title("After the half sine, under gravity: volume within 2 %");
    table.row([
        significant(1e3 * spacing, 3),
        significant(CALM, 3),
        in_words(record.space[1]),
        format!("{} of {}", record.leaked, record.particles),
        significant(record.seconds, 3),
    ]);
    Ok(table)
}

fn point(sample: &Sample) -> f64 {
    sample.pressures.first().copied().unwrap_or(0.0)
}

/// What is conserved, and the impulse at Point 1 over three spacings.
fn balances(runs: &[(Case, Record)]) -> Table {
    let mut table = Table::new([
        "cut-off [kPa]",
        "spacing [mm]",
        "Point 1 impulse, disc [Pa s]",
        "contact [Pa s]",
        "momentum",
        "pressure integral over force on the ends until 30, 80 ms",
        "over force on the tank until 80 ms",
        "leaked, deepest in wall [spacings]",
        "space half full at 38 ms, end",
        "space with spray",
        "impulse on tank [N s]",
        "time [s]",
    ])
    .title("Half sine, artificial sound speed, 80 ms");
    for (case, record) in runs {
        let ends = [0.03, case.until].map(|end| record.sensed_over(end, |ends| ends.felt));
        let tank = record.sensed_over(case.until, |ends| ends.tank);
        let percent = |lack: f64| format!("{:+.2} %", 1e2 * lack);
        table.row([
            significant(1e-3 * case.cut_off, 3),
            significant(1e3 * case.spacing, 3),
            significant(record.integral(case.until, point), 4),
            record.contact_impulse(case.until),
            format!("{:.1e}", record.imbalance),
            ends.map(percent).join(", "),
            percent(tank),
            format!(
                "{} of {}, {:.1}",
                record.leaked,
                record.particles,
                record.deepest / case.spacing
            ),
            shares(record.space.map(|space| space.half_full)),
            shares(record.space.map(|space| space.with_spray)),
            significant(record.impulse[0], 4),
            significant(record.seconds, 3),
        ]);
    }
    table
}

/// The wall that the water leaves, at 38 ms.
fn far_wall(runs: &[(Case, Record)]) -> Table {
    let mut table = Table::new([
        "cut-off [kPa]",
        "spacing [mm]",
        "lowest pressure [kPa]",
        "wetted height [mm]",
        "film within 30 mm [kg]",
        "cut or held",
    ])
    .title(
        "Far wall at 38 ms: no pressure below the cut-off, a film that shrinks with the spacing",
    );
    for (case, record) in runs {
        let far = record.far_wall;
        table.row([
            significant(1e-3 * case.cut_off, 3),
            significant(1e3 * case.spacing, 3),
            significant(1e-3 * far.lowest, 4),
            significant(1e3 * far.wetted, 3),
            significant(far.film, 3),
            far.cuts.to_string(),
        ]);
    }
    table
}

/// Walls that move against a frame that does.
fn frames<T: Real>(artificial: &Case, spacing: f64) -> Result<Table, Failure> {
    let base = Case {
        spacing,
        ..artificial.clone()
    };
    let c = base.sound_speed.of(1480.0);
    let fixed = Case {
        step: Some(0.2 * H_OVER_DX * spacing / c),
        // A leapfrog is exact in a steady field, so that the places can be the same to rounding; in a half
        // sine the steps' own error of dt² remains.
        pulse: Pulse::Constant,
        ..base.clone()
    };
    let framed = |case: &Case| Case {
        in_frame: true,
        ..case.clone()
    };
    let (mut moving, mut resting) = (fixed.build::<T>()?, framed(&fixed).build::<T>()?);
    for _ in 0..200 {
        moving.step()?;
        resting.step()?;
    }
    let places = in_tank(&fixed, &moving)?.zip(in_tank(&fixed, &resting)?);
    let apart = places
        .map(|((x, _), (y, _))| (0..3).map(|d| (x[d] - y[d]).abs()).fold(0.0, f64::max))
        .fold(0.0, f64::max);
    let [moving, resting] = [
        run::<T>(&base, None, false)?,
        run::<T>(&framed(&base), None, false)?,
    ];
    let mut table = Table::new(["quantity", "found", "must be"])
        .title("Moving walls against an accelerated frame");
    table.row([
        "places after 200 equal steps, over the spacing".into(),
        format!("{:.1e}", apart / spacing),
        "1e-9".to_string(),
    ]);
    let impulses = [moving.impulse[0], resting.impulse[0]];
    let [a, b] = [&moving, &resting].map(|record| record.integral(0.08, point));
    table.row([
        format!(
            "impulse on the tank at 80 ms, {:.2} and {:.2} N s",
            impulses[0], impulses[1]
        ),
        format!("{:+.2} %", 1e2 * (impulses[1] / impulses[0] - 1.0)),
        "0.5 %".into(),
    ]);
    table.row([
        format!("impulse at Point 1, {a:.1} and {b:.1} Pa s"),
        format!("{:+.2} %", 1e2 * (b / a - 1.0)),
        "reported".into(),
    ]);
    Ok(table)
}
