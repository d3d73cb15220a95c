//! Histories at the probes and the surface at 38 ms, with what theory says in the same axes.
//! The references: the impulsive solution with its two far walls, and ρ a l of a slab of water.

use super::run::{Record, SNAPSHOT};
use super::tank::{Case, GRAVITY, WATER};
use meshfree::error::Error;
use meshfree::output::svg::{Axis, Color, Figure, Panel, Series};
use meshfree::output::table::{Table, significant};
use meshfree::study::impulsive_tank::{FarWall, ImpulsiveTank};

/// How long the impulsive solution holds \[s\]: the tank has then moved 2 mm.
pub const IMPULSIVE: f64 = 0.010;

/// Acceleration \[m/s²\] at a time \[s\].
pub fn acceleration(case: &Case, time: f64) -> Result<f64, Error> {
    use meshfree::boundary::Motion;
    Ok(-case.pulse.motion::<3>(case.peak())?.pose(time).shift[2][0])
}

/// Coefficients p/(ρ a h) of the impulsive solution at a height \[m\] on the struck wall, with the far
/// wall attached and detached; `None` above the water.
pub fn bracket(case: &Case, height: f64) -> Option<[f64; 2]> {
    let of = |far| {
        let tank = ImpulsiveTank::new(case.size[0], case.depth(), far).ok()?;
        tank.coefficient([0.0, height]).ok()
    };
    Some([of(FarWall::Attached)?, of(FarWall::Detached)?])
}

/// The curve of a run. LS-DYNA's forms are dashed: there are more schemes than colours.
fn curve(name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Series {
    let line = Series::line(name, points);
    if name.starts_with("ls-dyna") {
        line.dashed()
    } else {
        line
    }
}

/// Histories at the probes on the struck wall, and the surface at 38 ms.
pub fn figure(case: &Case, runs: &[(String, &Record)]) -> Result<Figure, Error> {
    let mut figure = Figure::new().columns(2).shared_legend();
    let times: Vec<f64> = runs
        .first()
        .map(|(_, record)| record.samples.iter().map(|sample| sample.time).collect())
        .unwrap_or_default();
    let mut pulse = Vec::new();
    for &time in &times {
        pulse.push((time, acceleration(case, time)?));
    }
    // A slab as high as the tank that lies against the wall.
    let slab = case.fill * case.size[0];
    for (k, probe) in case.probes.iter().enumerate() {
        let mut panel = Panel::new(Axis::linear("time", "ms"), Axis::linear("pressure", "kPa"))
            .title(&format!("({}, {}, {}) m", probe[0], probe[1], probe[2]));
        for (name, record) in runs {
            let points = record
                .samples
                .iter()
                .map(|s| (1e3 * s.time, 1e-3 * s.pressures[k]));
            panel = panel.series(curve(name, points));
        }
        let on_struck_wall = (probe[0] - case.size[0]).abs() < 1e-9;
        if on_struck_wall {
            if let Some(both) = bracket(case, probe[2]) {
                let static_pressure = WATER * GRAVITY * (case.depth() - probe[2]);
                for (name, coefficient) in ["far wall attached", "far wall detached"]
                    .into_iter()
                    .zip(both)
                {
                    let early = pulse.iter().filter(|(time, _)| *time <= IMPULSIVE);
                    let points = early.map(|(time, a)| {
                        let p = coefficient * WATER * a * case.depth() + static_pressure;
                        (1e3 * time, 1e-3 * p)
                    });
                    panel = panel.series(Series::line(name, points).reference());
                }
            }
            let points = pulse
                .iter()
                .map(|(time, a)| (1e3 * time, 1e-3 * WATER * a * slab));
            let slab = Series::line("ρ a l, water against the wall", points);
            panel = panel.series(slab.dashed().color(Color(0, 0, 0)));
        }
        figure = figure.panel(panel);
    }
    let mut panel = Panel::new(Axis::linear("x", "m"), Axis::linear("z", "m")).title(&format!(
        "surface at {:.0} ms, mid width",
        1e3 * SNAPSHOT.min(case.until)
    ));
    for (name, record) in runs {
        let points = record.surface.iter().map(|[x, z]| (*x, *z));
        panel = panel.series(curve(name, points));
    }
    let [length, _, height] = case.size;
    let walls = [
        (0.0, 0.0),
        (length, 0.0),
        (length, height),
        (0.0, height),
        (0.0, 0.0),
    ];
    panel = panel
        .series(Series::line("tank", walls).reference())
        .equal_aspect();
    Ok(figure.panel(panel))
}

/// Two differences in per cent.
pub fn shares(of: [f64; 2]) -> String {
    of.map(|share| format!("{:+.1} %", 1e2 * share)).join(", ")
}

/// One row for each run.
pub fn table(case: &Case, runs: &[(String, &Record)]) -> Table {
    let mut table = Table::new([
        "run",
        "impulse at Point 1, disc [Pa s]",
        "contact [Pa s]",
        "peak [kPa]",
        "at 38 ms [kPa]",
        "impulse on tank [N s]",
        "far wall wetted [mm]",
        "film [kg]",
        "space half full at 38 ms, end",
        "space with spray",
        "steps",
        "time [s]",
    ]);
    for (name, record) in runs {
        let point = |s: &super::run::Sample| s.pressures.first().copied().unwrap_or(0.0);
        let peak = record.samples.iter().map(point).fold(0.0, f64::max);
        let window = [SNAPSHOT - 5e-4, SNAPSHOT + 5e-4];
        let at_snapshot = if case.until >= window[1] {
            significant(1e-3 * record.mean(window, point), 3)
        } else {
            "not reached".into()
        };
        table.row([
            name.clone(),
            significant(record.integral(case.until, point), 4),
            record.contact_impulse(case.until),
            significant(1e-3 * peak, 3),
            at_snapshot,
            significant(record.impulse[0], 4),
            significant(1e3 * record.far_wall.wetted, 3),
            significant(record.far_wall.film, 2),
            shares(record.space.map(|space| space.half_full)),
            shares(record.space.map(|space| space.with_spray)),
            record.steps.to_string(),
            significant(record.seconds, 3),
        ]);
    }
    table
}
