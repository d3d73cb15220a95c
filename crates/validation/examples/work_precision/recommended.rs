//! What the page recommends for each problem: its cost relative to the cheapest method with the same error, and its error relative to the fit.
//! The cost is of the finest run that lowers the error by a tenth, the error of the finest run, which the fit leaves out.

use super::{implosion, liquids};
use meshfree::output::table::{Table, significant};
use meshfree::study::work_precision::{Column, Report, View};

/// Problem, method as "What to choose" has it, and the quantity for which it does, unless it is the first.
const RECOMMENDED: [(&str, &str, Option<&str>); 17] = [
    ("rods_copper", "impact, h/dx 1.0", None),
    ("rods_pmma", "impact, α 1", None),
    ("rods_tension", "impact, h/dx 1.3", None),
    ("sod", "gas, C4, h/dx 1.5", None),
    ("sod_3d", "gas, C4, h/dx 1.8 (default)", None),
    ("noh", "gas, C4, h/dx 1.5", None),
    ("noh_3d", "gas, C4, h/dx 1.3", Some(implosion::PLATEAU)),
    ("sedov_3d", "gas, C4, h/dx 1.3", Some(implosion::PEAK)),
    ("gresho", "gas, h/dx 2.2", None),
    ("sound_1d", "h/dx 1.5, α 0, δ 0", None),
    ("sound_2d", "h/dx 1.5, α 0, δ 0", None),
    ("sound_3d", "h/dx 1.5, α 0, δ 0", None),
    ("tank", "cubic spline, h/dx 1.2", None),
    ("wave", "h/dx 2.0, α 0.005, δ 0.1", Some(liquids::CREST)),
    ("dam", "cubic spline, h/dx 1.2", None),
    ("vortices", "C4, h/dx 2.2, shifted", None),
    ("plate", "h/dx 0.8 (default)", None),
];

/// Of the least error on coarser spacings, what a run must stay below to be worth its time.
const GAINS: f64 = 0.9;

pub fn table() -> Table {
    Table::new([
        "problem",
        "error",
        "method, spacing [m]",
        "time, pairs",
        "over the cheapest",
        "error predicted over measured (90 %)",
    ])
}

/// What the finest run of a method took over the least that any took for its error.
fn over_least(report: &Report, view: &View<'_>, error: f64, own: f64, of: Column) -> f64 {
    let all = report
        .methods()
        .filter_map(|method| view.work_at(method, of, error).ok());
    own / all.fold(own, f64::min)
}

/// A row, if the problem has a recommendation and its method runs.
pub fn add(table: &mut Table, key: &str, title: &str, report: &Report) {
    let Some((_, method, quantity)) = RECOMMENDED.iter().find(|(own, ..)| *own == key) else {
        return;
    };
    let Ok(view) = quantity.map_or(Ok(report.first()), |name| report.quantity(name)) else {
        return;
    };
    let rows = report.rows().iter().filter(|row| row.method == *method);
    let errors = rows.filter_map(|row| Some((row, view.error(row)?)));
    let worth = errors.reduce(|best, own| if own.1 < GAINS * best.1 { own } else { best });
    let Some((row, error)) = worth else {
        return;
    };
    let predicted = view.predicted();
    let law = predicted.iter().find(|one| one.method == *method);
    let law = law.map_or("too few runs".into(), |one| match &one.error {
        (Ok(by_law), measured) => {
            let [value, low, high] = [by_law.value, by_law.low, by_law.high].map(|x| x / measured);
            format!("{value:.2} ({low:.2} to {high:.2})")
        }
        (Err(why), _) => format!("rejected: {why}"),
    });
    let (seconds, pairs) = (row.seconds, row.work.pairs as f64);
    table.row([
        title.to_string(),
        format!(
            "{} % of {}",
            significant(100.0 * error, 2),
            view.quantity().name()
        ),
        format!("`{method}`, {}", significant(row.spacing, 3)),
        format!("{} s, {}", significant(seconds, 2), significant(pairs, 2)),
        format!(
            "{:.2}, {:.2}",
            over_least(report, &view, error, seconds, Column::Seconds),
            over_least(report, &view, error, pairs, Column::Pairs)
        ),
        law,
    ]);
}
