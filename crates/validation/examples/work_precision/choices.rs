//! What one choice buys and costs: a method over another that differs in it alone, by the runs of the study.
//! Ratios are geometric means over the spacings that both ran, and of the work for the same error.

use meshfree::output::table::{Table, significant};
use meshfree::study::work_precision::{Column, Report, Row, View};

/// The choice, its problem, and the names of the methods without and with it.
type Choice = (&'static str, &'static str, &'static str, &'static str);

const IMPACT: &str = "impact, h/dx 1.2 (default)";
const LIQUID: &str = "h/dx 1.5, α 0.02, δ 0.1 (default)";
const CUBIC: &str = "cubic spline, h/dx 1.2";
const WIDER: &str = "h/dx 2.0, α 0.02, δ 0.1";
const GAS: &str = "gas, C4, h/dx 1.8 (default)";
const VORTICES: &str = "C2, h/dx 1.5, shifted (default)";

const CHOICES: &[Choice] = &[
    ("`f32` for `f64`", "rods_copper", IMPACT, "impact, f32"),
    (
        "drift–kick–drift for kick–drift–kick",
        "tank",
        LIQUID,
        "h/dx 1.5, drift–kick–drift",
    ),
    (
        "C2 at 1.5 for the cubic spline at 1.2",
        "tank",
        CUBIC,
        LIQUID,
    ),
    (
        "C2 at 1.5 for the cubic spline at 1.2",
        "wave",
        CUBIC,
        LIQUID,
    ),
    (
        "C2 at 1.5 for the cubic spline at 1.2",
        "dam",
        CUBIC,
        LIQUID,
    ),
    (
        "C4 at 1.8 for the cubic spline at 1.2",
        "sod",
        "cubic, signal velocity, h/dx 1.2",
        GAS,
    ),
    (
        "C4 at 2.2 for C2 at 2.0",
        "vortices",
        "C2, h/dx 2.0, shifted",
        "C4, h/dx 2.2, shifted",
    ),
    ("h/dx 1.3 for 1.8", "sod", GAS, "gas, C4, h/dx 1.3"),
    ("h/dx 2.0 for 1.5", "tank", LIQUID, WIDER),
    ("h/dx 2.0 for 1.5", "wave", LIQUID, WIDER),
    ("h/dx 2.0 for 1.5", "dam", LIQUID, WIDER),
    (
        "h/dx 2.0 for 1.5",
        "vortices",
        VORTICES,
        "C2, h/dx 2.0, shifted",
    ),
    (
        "h/dx 1.2 for 0.8",
        "plate",
        "h/dx 0.8 (default)",
        "h/dx 1.2",
    ),
    (
        "matrix gradients for the plain force",
        "sod",
        "plain force, C4, h/dx 1.8",
        GAS,
    ),
    (
        "diffusion of Antuono for that of Fourtakas",
        "sound_1d",
        LIQUID,
        "h/dx 1.5, α 0.02, Antuono δ 0.1",
    ),
    (
        "diffusion of Antuono for that of Fourtakas",
        "tank",
        LIQUID,
        "h/dx 1.5, Antuono δ 0.1",
    ),
    (
        "diffusion of Antuono for that of Fourtakas",
        "dam",
        LIQUID,
        "h/dx 1.5, Antuono δ 0.1",
    ),
];

/// The table, empty.
pub fn table() -> Table {
    Table::new([
        "choice",
        "problem",
        "error",
        "pairs for the same error",
        "time for the same error",
    ])
}

/// Adds the choices that this problem shows, in its first quantity.
pub fn add(table: &mut Table, key: &str, title: &str, report: &Report) {
    let view = report.first();
    for (choice, problem, without, with) in CHOICES {
        if *problem != key {
            continue;
        }
        let [without, with] = [*without, *with].map(|name| pilots(report, &view, name));
        let error = mean(&without, &with, |row| view.error(row));
        let same = |column| same_error(&view, &without, &with, column);
        let cell = |ratio: Option<f64>| ratio.map_or("–".to_string(), |r| significant(r, 2));
        table.row([
            (*choice).to_string(),
            title.to_string(),
            cell(error),
            cell(same(Column::Pairs)),
            cell(same(Column::Seconds)),
        ]);
    }
}

/// Rows of a method that have an error, coarse to fine.
fn pilots<'a>(report: &'a Report, view: &View<'_>, method: &str) -> Vec<&'a Row> {
    let rows = report.rows().iter().filter(|row| row.method == method);
    rows.filter(|row| view.error(row).is_some()).collect()
}

/// Geometric mean of the ratio of what two methods have on the same spacing.
fn mean(without: &[&Row], with: &[&Row], of: impl Fn(&Row) -> Option<f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for row in with {
        let same = without.iter().find(|own| own.spacing == row.spacing);
        if let (Some(own), Some(a)) = (same, of(row))
            && let Some(b) = of(own)
        {
            sum += (a / b).ln();
            count += 1.0;
        }
    }
    (count > 0.0).then(|| (sum / count).exp())
}

/// Ratio of the work for the larger of both errors on the finest spacing.
fn same_error(view: &View<'_>, without: &[&Row], with: &[&Row], column: Column) -> Option<f64> {
    let (without, with) = (without.last()?, with.last()?);
    let error = view.error(without)?.max(view.error(with)?);
    let work = |row: &Row| view.work_at(&row.method, column, error).ok();
    Some(work(with)? / work(without)?)
}
