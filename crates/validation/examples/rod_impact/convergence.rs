//! The error of figure 1 against the spacing, over a factor of 16, for our scheme and the paper's.
//! Written as a table between two marks of the page `rods.md`, and a plot.

use super::Failure;
use super::cases::{Case, short};
use super::choices::SchemeChoice;
use super::figures::at;
use super::options::Options;
use super::parallel::{self, Board};
use super::record::{self, Watch};
use super::theory::{Theory, waves};
use meshfree::output::svg::{Axis, Figure, PALETTE, Panel, Series};
use meshfree::output::table::{Table, significant};
use meshfree::study::norms::{Norms, observed_order};
use std::path::Path;

const SCHEMES: [SchemeChoice; 2] = [SchemeChoice::Impact, SchemeChoice::Lam2002];
/// Spacings \[m\].
const SPACINGS: [f64; 5] = [4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5];
/// Time of figure 1 \[s\].
const TIME: f64 = 7.7e-6;
/// Places at which profiles are compared.
const SAMPLES: usize = 20_000;

fn case(scheme: SchemeChoice, spacing: f64) -> Case {
    Case {
        scheme,
        spacing,
        until: TIME,
        probes: vec![5e-3],
        snapshots: vec![TIME],
        ..Case::default()
    }
}

/// The marks between which the page has the table.
const MARKS: [&str; 2] = ["<!-- begin convergence -->\n", "<!-- end convergence -->\n"];

/// Runs the study and writes its table into `rods.md`, and its plot.
pub fn study(options: &Options, folder: &Path) -> Result<(), Failure> {
    let spacings = if options.quick {
        &SPACINGS[..3]
    } else {
        &SPACINGS[..]
    };
    let finest_first = spacings.iter().rev();
    let jobs: Vec<Case> = finest_first
        .flat_map(|&dx| SCHEMES.map(|scheme| case(scheme, dx)))
        .collect();
    let board = Board::new(
        "convergence",
        jobs.iter().map(|case| case.spacing.powi(-2)).collect(),
    );
    let places: Vec<f64> = (0..SAMPLES)
        .map(|k| 0.050 * (k as f64 + 0.5) / SAMPLES as f64)
        .collect();
    let profiles = parallel::map(&jobs, options.threads, |k, case| {
        let record = record::run(case, Watch::Every(1000), &mut |time| {
            let mm = short(1e3 * case.spacing);
            board.update(k, time / TIME, &format!("{}, {mm} mm", case.scheme.key()));
        })?;
        let shot = record.snapshot(TIME).ok_or("no snapshot")?;
        let (x, y): (Vec<f64>, Vec<f64>) =
            shot.points.iter().map(|p| (p.reference, p.stress)).unzip();
        Ok(places
            .iter()
            .map(|&place| at(&x, &y, place))
            .collect::<Vec<f64>>())
    })?;
    drop(board);
    let base = case(SchemeChoice::Impact, SPACINGS[0]);
    let theory = Theory::of(&base, if options.quick { 4000 } else { 20_000 })?;
    let cells = &theory
        .reference
        .snapshots()
        .first()
        .ok_or("no snapshot")?
        .cells;
    let (x, y): (Vec<f64>, Vec<f64>) = cells.iter().map(|c| (c.x0, -c.pressure)).unzip();
    let exact: Vec<f64> = places.iter().map(|&place| at(&x, &y, place)).collect();
    let acoustic = waves(&base)?;
    let linear: Result<Vec<f64>, _> = places.iter().map(|&x| acoustic.stress(x, TIME)).collect();
    let linear = linear?;

    // The mean error over 50 mm, as a part of the pulse: 353.17 MPa over 20 mm.
    let part = |a: &[f64], b: &[f64]| -> Result<f64, Failure> {
        Ok(Norms::of_difference(a, b)?.l1 * 0.050 / (353.17e6 * 0.020))
    };
    let mut table = Table::new(["spacing [mm]", "particles", "impact [%]", "lam2002 [%]"]);
    let mut errors = [Vec::new(), Vec::new()];
    for &spacing in spacings {
        let mut row = vec![short(1e3 * spacing), format!("{:.0}", 0.050 / spacing)];
        for (s, scheme) in SCHEMES.iter().enumerate() {
            let found = jobs
                .iter()
                .position(|job| job.scheme == *scheme && job.spacing == spacing);
            let profile = &profiles[found.ok_or("no such run")?];
            let error = part(profile, &exact)?;
            errors[s].push(error);
            row.push(significant(100.0 * error, 3));
        }
        table.row(row);
    }
    let orders = [
        observed_order(spacings, &errors[0])?,
        observed_order(spacings, &errors[1])?,
    ];
    let difference = part(&exact, &linear)?;
    let slopes = orders.map(|order| format!("{:.2} ± {:.2}", order.order, order.half_width));
    let text = block(&table.markdown(), &slopes, difference);
    std::fs::create_dir_all(folder)?;
    let path = folder.join("rods.md");
    let page = std::fs::read_to_string(&path).unwrap_or_default();
    std::fs::write(&path, put(&page, &text))?;
    plot(spacings, &errors).save(folder.join("rods_convergence.svg"))?;
    println!(
        "{table}\nslopes: impact {}, lam2002 {}\nwritten to {}",
        slopes[0],
        slopes[1],
        folder.display()
    );
    Ok(())
}

fn plot(spacings: &[f64], errors: &[Vec<f64>; 2]) -> Figure {
    let mut panel = Panel::new(
        Axis::log("spacing", "mm"),
        Axis::log("L1 error of the pulse", "%"),
    );
    for ((scheme, errors), color) in SCHEMES.iter().zip(errors).zip(PALETTE) {
        let points = spacings
            .iter()
            .zip(errors)
            .map(|(dx, error)| (1e3 * dx, 100.0 * error));
        panel = panel.series(Series::markers(scheme.key(), points).color(color).fitted());
    }
    Figure::new()
        .title("Copper onto copper at 20 m/s: stress at 7.7 µs")
        .panel(panel.slope(1.0))
        .panel_size(560.0, 400.0)
}

/// The table with its marks.
fn block(table: &str, slopes: &[String; 2], difference: f64) -> String {
    let [begin, end] = MARKS;
    format!(
        "{begin}{table}\nObserved order (least squares, 95 %): impact {}, lam2002 {}. Linear waves are off by {:.2} %.\n{end}",
        slopes[0],
        slopes[1],
        100.0 * difference,
    )
}

/// The page with the table in place of its old one; the table alone where there is no page.
fn put(page: &str, block: &str) -> String {
    let [begin, end] = MARKS;
    let parts = page
        .split_once(begin)
        .and_then(|(above, rest)| Some((above, rest.split_once(end)?.1)));
    parts.map_or_else(
        || block.to_string(),
        |(above, below)| format!("{above}{block}{below}"),
    )
}
