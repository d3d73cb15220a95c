//! Pictures of an impact: the cloud by body and by damage, energies, and how hole and front grow.
//! In space they show a slice next to a plane of symmetry, and its mirror image.

use super::cases::Case;
use super::common::Failure;
use meshfree::effect::Damage;
use meshfree::output::svg::{Axis, Cloud, Figure, Panel, Series};
use meshfree::prelude::*;
use std::path::Path;

/// What a row of the ledger holds, by column.
pub type Row = [f64; 11];

/// The particles of a body in the slice, with a value each \[mm\].
fn slice<const D: usize>(
    now: &Simulation<f64, D>,
    spacing: f64,
    value: impl Fn(usize, f64) -> f64,
) -> Vec<(f64, f64, f64)> {
    let mut points = Vec::new();
    for (body, name) in ["projectile", "plate"].into_iter().enumerate() {
        for p in now.body(name).into_iter().flatten() {
            let x = p.position();
            if D == 3 && x[2] > 3.0 * spacing {
                continue;
            }
            let value = value(body, p.scalar(Damage::DAMAGE).unwrap_or(0.0));
            let [along, across] = [1e3 * x[0], 1e3 * x[1]];
            points.extend([(along, across, value), (along, -across, value)]);
        }
    }
    points
}

fn panel<const D: usize>(
    now: &Simulation<f64, D>,
    case: &Case,
    spacing: f64,
    axis: Axis,
    points: Vec<(f64, f64, f64)>,
) -> Panel {
    let side = 1e3 * case.reach;
    let farthest = 1e6 * case.speed * case.microseconds * 1e-9;
    Panel::new(
        Axis::linear("x", "mm").range(-0.5 * farthest, farthest),
        Axis::linear("y", "mm").range(-1.2 * side, 1.2 * side),
    )
    .cloud(Cloud::new(axis, points).diameter(1e3 * spacing))
    .equal_aspect()
    .title(&format!("t = {:.1} µs", 1e6 * now.time()))
}

/// Which body is where.
pub fn bodies<const D: usize>(now: &Simulation<f64, D>, case: &Case, spacing: f64) -> Panel {
    let points = slice(now, spacing, |body, _| body as f64);
    let axis = Axis::linear("0 projectile, 1 plate", "").range(0.0, 1.0);
    panel(now, case, spacing, axis, points)
}

/// What has failed.
pub fn damage<const D: usize>(now: &Simulation<f64, D>, case: &Case, spacing: f64) -> Panel {
    let points = slice(now, spacing, |_, damage| damage);
    let axis = Axis::linear("damage", "1").range(0.0, 1.0);
    panel(now, case, spacing, axis, points)
}

/// Energies over the first.
pub fn energies(history: &[Row], first: f64) -> Panel {
    let share = |k: usize| {
        history
            .iter()
            .map(move |row| (1e6 * row[0], row[k] / first))
    };
    Panel::new(
        Axis::linear("time", "µs"),
        Axis::linear("energy / energy of motion at the start", "1").from(0.0),
    )
    .series(Series::line("kinetic", share(1)))
    .series(Series::line("internal", share(2)))
    .series(Series::line("plastic work", share(4)))
}

/// Hole and front.
pub fn growth(history: &[Row]) -> Panel {
    let line = |k: usize| history.iter().map(move |row| (1e6 * row[0], 1e3 * row[k]));
    Panel::new(
        Axis::linear("time", "µs"),
        Axis::linear("length", "mm").from(0.0),
    )
    .series(Series::line("front behind the plate", line(8)))
    .series(Series::line("diameter of the hole", line(10)))
}

/// All of them in one file.
pub fn save(path: &Path, case: &Case, panels: Vec<Panel>) -> Result<(), Failure> {
    let mut figure = Figure::new().title(case.about).columns(3);
    for panel in panels {
        figure = figure.panel(panel);
    }
    Ok(figure.save(path)?)
}
