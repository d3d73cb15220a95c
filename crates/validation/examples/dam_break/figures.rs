//! Figures of dam breaks: histories with the measured ones in the same axes, and frames.
//! What is not in the reference folder is left out, by name.

use super::common::Failure;
use super::flat::Flat;
use super::obstacle::{BOX, TANK};
use super::violent::{Choices, History};
use meshfree::output::picture::Picture;
use meshfree::output::svg::{Axis, Cloud, Color, Figure, Panel, Series};
use meshfree::prelude::*;
use std::path::Path;

/// Martin & Moyce 1952, table 2: T = t √(2g/a) and Z = x/a of the front, n² = 2, a = 57.15 mm.
pub const MARTIN_MOYCE_FRONT: [(f64, f64); 15] = [
    (0.41, 1.11),
    (0.84, 1.22),
    (1.19, 1.44),
    (1.43, 1.67),
    (1.63, 1.89),
    (1.83, 2.11),
    (1.98, 2.33),
    (2.20, 2.56),
    (2.32, 2.78),
    (2.51, 3.00),
    (2.65, 3.22),
    (2.83, 3.44),
    (2.98, 3.67),
    (3.11, 3.89),
    (3.33, 4.11),
];

/// Martin & Moyce 1952, table 6: t √(g/a) and η/(2a) at the rear wall, n² = 2, a = 57.15 mm.
pub const MARTIN_MOYCE_REAR: [(f64, f64); 13] = [
    (0.56, 0.94),
    (0.77, 0.89),
    (0.93, 0.83),
    (1.08, 0.78),
    (1.28, 0.72),
    (1.46, 0.67),
    (1.66, 0.61),
    (1.84, 0.56),
    (2.00, 0.50),
    (2.21, 0.44),
    (2.45, 0.39),
    (2.70, 0.33),
    (3.06, 0.28),
];

/// Kleefsman et al. 2005, figure of H2, computed by volume of fluid with 236 × 76 × 68 cells: time and height \[s, m\].
///
/// Read off the figure as the SPHERIC document of 2006 reprints it, whose pixels are 2.3 mm.
pub const VOLUME_OF_FLUID_H2: [(f64, f64); 29] = [
    (0.4, 0.052),
    (0.5, 0.083),
    (0.6, 0.098),
    (0.8, 0.135),
    (1.0, 0.168),
    (1.2, 0.186),
    (1.4, 0.198),
    (1.5, 0.218),
    (1.6, 0.282),
    (1.7, 0.365),
    (1.8, 0.363),
    (1.9, 0.341),
    (2.0, 0.328),
    (2.1, 0.325),
    (2.25, 0.339),
    (2.4, 0.300),
    (2.5, 0.272),
    (2.6, 0.265),
    (2.8, 0.256),
    (3.0, 0.255),
    (3.2, 0.231),
    (3.4, 0.205),
    (3.6, 0.198),
    (3.8, 0.187),
    (4.0, 0.178),
    (4.2, 0.160),
    (4.6, 0.129),
    (4.8, 0.207),
    (5.0, 0.228),
];

/// The same for P1 \[s, Pa\], without the 1000 Pa by which the figure is too high; a pixel is 82 Pa.
pub const VOLUME_OF_FLUID_P1: [(f64, f64); 14] = [
    (0.42, 12_000.0),
    (0.55, 5450.0),
    (0.6, 4950.0),
    (0.7, 4570.0),
    (0.8, 4240.0),
    (0.9, 3960.0),
    (1.0, 3730.0),
    (1.1, 3480.0),
    (2.0, 2820.0),
    (2.5, 2490.0),
    (3.0, 2060.0),
    (3.5, 1580.0),
    (4.0, 1300.0),
    (4.5, 1020.0),
];

/// Points of a measured record as a series of markers, where the record is there.
fn measured(
    choices: &Choices,
    file: &str,
    label: &str,
    columns: [&str; 2],
) -> Result<Option<Series>, Failure> {
    let Some(record) = choices.records.read(file) else {
        return Ok(None);
    };
    let (x, y) = (record.column(columns[0])?, record.column(columns[1])?);
    Ok(Some(Series::markers(label, x.into_iter().zip(y))))
}

/// Particles coloured by pressure at one instant.
pub fn plane<T: Real>(case: &Flat, now: &Simulation<T, 2>, path: &Path) -> Result<(), Failure> {
    let top = (2.0 * case.column[1]).min(case.tank[1]);
    let hydrostatic = case.density * super::flat::GRAVITY * case.column[1];
    let value = Axis::linear("pressure", "kPa").range(0.0, 1e-3 * hydrostatic);
    let walls = now.walls().map(|name| now.wall(name));
    let walls = walls.collect::<Result<Vec<_>, _>>()?.into_iter().flatten();
    let water = now.all().map(|p| (p.position(), 1e-3 * p.pressure()));
    let picture = Picture::new(1600, (1600.0 * top / case.tank[0]) as usize)
        .bounds([0.0, 0.0], [case.tank[0], top])
        .particles(value.clone(), case.spacing, water)
        .plain(
            Color(150, 150, 150),
            1.0,
            case.spacing,
            walls.map(|p| p.position()),
        );
    super::common::save_picture(&picture, path)?;
    let points = now.all().map(|particle| {
        let [x, y] = particle.position();
        (x, y, 1e-3 * particle.pressure())
    });
    let panel = Panel::new(
        Axis::linear("x", "m").range(0.0, case.tank[0]),
        Axis::linear("y", "m").range(0.0, top),
    )
    .title(&format!("t = {:.3} s", now.time()))
    .equal_aspect()
    .cloud(Cloud::new(value, points).diameter(case.spacing));
    let figure = Figure::new().panel_size(720.0, 720.0 * top / case.tank[0]);
    Ok(figure.panel(panel).save(path.with_extension("svg"))?)
}

/// Fronts, heights and pressures of a plane case.
pub fn histories(
    case: &Flat,
    history: &History,
    choices: &Choices,
    folder: &Path,
) -> Result<(), Failure> {
    let units = case.units()?;
    let mut panels = Vec::new();
    let front = history.points("front_m", units.front_time_unit(), units.width());
    let wet = front
        .into_iter()
        .take_while(|(_, z)| *z < 0.995 * case.tank[0] / units.width());
    let mut panel = Panel::new(Axis::linear("t √(2g/a)", ""), Axis::linear("front x/a", ""))
        .title("front")
        .series(Series::line("computed", wet));
    // Their column is twice as high as wide.
    let tall = case.column[1] > case.column[0];
    if tall {
        panel = panel.series(Series::markers("Martin & Moyce 1952", MARTIN_MOYCE_FRONT));
    }
    if case.name == "koshizuka" {
        let file = "dambreak2d_front/koshizuka_oka_1996_pysph.csv";
        let label = "Koshizuka & Oka 1996";
        if let Some(series) = measured(choices, file, label, ["T", "Z"])? {
            panel = panel.series(series);
        }
        let file = "dambreak2d_front/koshizuka_oka_1996_mps.csv";
        if let Some(series) = measured(choices, file, "their computation", ["T", "Z"])? {
            panel = panel.series(series);
        }
    }
    panels.push(panel);
    let rear = history.points("rear_m", units.height_time_unit(), units.height());
    let mut panel = Panel::new(
        Axis::linear("t √(g/a)", ""),
        Axis::linear("height at the rear η/h", ""),
    )
    .title("rear wall")
    .series(Series::line("computed", rear));
    if tall {
        panel = panel.series(Series::markers("Martin & Moyce 1952", MARTIN_MOYCE_REAR));
    }
    panels.push(panel);
    let smooth = history.smoothed(1e-3);
    for (k, sensor) in case.sensors.iter().enumerate() {
        let time = Axis::linear("t √(g/h)", "").from(2.0);
        let mut panel = Panel::new(time, Axis::linear("p/(ρgh)", "")).title(&format!(
            "{:.0} mm above the bottom, mean over 1 ms",
            1e3 * sensor.height
        ));
        let unit = units.pressure_unit(case.density);
        let points = smooth.points(&format!("p{}_pa", k + 1), units.pressure_time_unit(), unit);
        panel = panel.series(Series::line("computed", points));
        let file = format!("dambreak2d_pressure/{}", sensor.record);
        if k == 1 {
            for (column, label) in [
                ("P_2.5pct", "Lobovský et al. 2014: 2.5, 50, 97.5 %"),
                ("P_median", ""),
                ("P_97.5pct", ""),
            ] {
                if let Some(record) = choices.records.read(&file) {
                    let points = record.column("T")?.into_iter().zip(record.column(column)?);
                    panel = panel.series(Series::line(label, points).reference());
                }
            }
        } else if let Some(series) = measured(choices, &file, sensor.by, ["T", "P"])? {
            panel = panel.series(series);
        }
        panels.push(panel);
    }
    let figure = panels.into_iter().fold(Figure::new(), Figure::panel);
    let title = format!(
        "Dam break, {}, spacing {:.2} mm",
        case.name,
        1e3 * case.spacing
    );
    figure
        .title(&title)
        .columns(2)
        .panel_size(520.0, 320.0)
        .save(folder.join("histories.svg"))?;
    Ok(())
}

/// The flow around the box at one instant.
pub fn space<T: Real>(now: &Simulation<T, 3>, path: &Path) -> Result<(), Failure> {
    let value = Axis::linear("pressure", "kPa").range(0.0, 5.0);
    let water = now.all().map(|p| (p.position(), 1e-3 * p.pressure()));
    let [low, high] = BOX;
    let obstacle = now.wall("box")?.map(|p| p.position());
    let picture = Picture::new(1400, 700)
        .title(&format!("t = {:.2} s", now.time()))
        .bounds([0.0; 3], TANK)
        .particles(value, now.spacing(), water)
        .plain(Color(120, 120, 120), 1.0, now.spacing(), obstacle)
        .edges([0.0; 3], TANK)
        .edges(low, high);
    Ok(super::common::save_picture(&picture, path)?)
}

/// Heights and pressures of SPHERIC 2.
pub fn obstacle(
    history: &History,
    spacing: f64,
    choices: &Choices,
    folder: &Path,
) -> Result<(), Failure> {
    let until = history.time.last().copied().unwrap_or(0.0);
    let heights = choices
        .records
        .read("spheric02_dambreak3d/water_heights.csv");
    let pressures = choices.records.read("spheric02_dambreak3d/pressures.csv");
    let smooth = history.smoothed(2e-3);
    let mut figure = Figure::new();
    let names = (1..=4).map(|k| (format!("h{k}"), true));
    for (name, height) in names.chain((1..=8).map(|k| (format!("p{k}"), false))) {
        let (unit, column, axis, scale) = if height {
            ("m", format!("{name}_m"), "height", 1.0)
        } else {
            ("kPa", format!("{name}_pa"), "pressure", 1000.0)
        };
        let time = Axis::linear("time", "s").range(0.0, until);
        let points = smooth.points(&column, 1.0, scale);
        let mut panel = Panel::new(time, Axis::linear(axis, unit))
            .title(&name.to_uppercase())
            .series(Series::line("computed", points));
        // In the record the columns of H1 and H3 are exchanged against the sketch.
        let named = match name.as_str() {
            "h1" => "H3".into(),
            "h3" => "H1".into(),
            _ => name.to_uppercase(),
        };
        if let Some(record) = if height { &heights } else { &pressures } {
            let values = record.column(&named)?.into_iter().map(|v| v / scale);
            let points = record.column("time_s")?.into_iter().zip(values);
            let series = Series::line("Kleefsman et al. 2005", points).reference();
            panel = panel.series(series);
        }
        let other = match name.as_str() {
            "h2" => &VOLUME_OF_FLUID_H2[..],
            "p1" => &VOLUME_OF_FLUID_P1[..],
            _ => &[],
        };
        if !other.is_empty() {
            let points = other.iter().map(|(t, v)| (*t, v / scale));
            panel = panel.series(Series::markers("their computation", points));
        }
        figure = figure.panel(panel);
    }
    figure
        .title(&format!("SPHERIC 2, spacing {:.1} mm", 1e3 * spacing))
        .columns(3)
        .panel_size(420.0, 260.0)
        .shared_legend()
        .save(folder.join("histories.svg"))?;
    Ok(())
}
