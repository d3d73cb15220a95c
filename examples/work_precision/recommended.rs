//! What the page recommends for each problem, against what was measured: its cost beside the cheapest way to its error, and its
//! error beside what its law says of it.
//! Both are of the finest run of the method, which the law is not of.

use meshfree::output::table::{Table, significant};
use meshfree::study::work_precision::{Column, Report, View};

/// Problem and method, as "What to choose" has it.
const RECOMMENDED: [(&str, &str); 17] = [
    ("rods_copper", "impact, h/dx 1.2 (default)"),
    ("rods_pmma", "impact, α 1"),
    ("rods_tension", "impact, h/dx 1.3"),
    ("sod", "gas, C4, h/dx 1.8, α 0.5"),
    ("sod_3d", "gas, C4, h/dx 1.8 (default)"),
    ("noh", "gas, C4, h/dx 1.3"),
    ("noh_3d", "gas, C4, h/dx 1.3"),
    ("sedov_3d", "gas, C4, h/dx 1.3"),
    ("gresho", "Cullen–Dehnen, h/dx 2.2"),
    ("sound_1d", "h/dx 1.5, α 0.02, Antuono δ 0.1"),
    ("sound_2d", "h/dx 1.5, α 0.02, Antuono δ 0.1"),
    ("sound_3d", "h/dx 1.5, α 0.02, Antuono δ 0.1"),
    ("tank", "h/dx 1.5, α 0.02, δ 0.1 (default)"),
    ("wave", "h/dx 2.0, α 0.005, δ 0.1"),
    ("dam", "h/dx 1.5, α 0.02, δ 0.1 (default)"),
    ("vortices", "C4, h/dx 2.2, shifted"),
    ("plate", "h/dx 0.8 (default)"),
];

pub fn table() -> Table {
    Table::new([
        "problem",
        "recommended",
        "error of its finest run [%]",
        "its time over the least for that error",
        "pairs over the least",
        "error foretold over found (90 %)",
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
    let Some((_, method)) = RECOMMENDED.iter().find(|(own, _)| *own == key) else {
        return;
    };
    let view = report.first();
    let rows = report.rows().iter().filter(|row| row.method == *method);
    let Some((row, error)) = rows
        .filter_map(|row| Some((row, view.error(row)?)))
        .next_back()
    else {
        return;
    };
    let foretold = view.foretold();
    let law = foretold.iter().find(|one| one.method == *method);
    let law = law.map_or("too few runs".into(), |one| match &one.error {
        (Ok(by_law), measured) => {
            let [value, low, high] = [by_law.value, by_law.low, by_law.high].map(|x| x / measured);
            format!("{value:.2} ({low:.2} to {high:.2})")
        }
        (Err(why), _) => format!("refused: {why}"),
    });
    let (seconds, pairs) = (row.seconds, row.work.pairs as f64);
    table.row([
        title.to_string(),
        (*method).to_string(),
        significant(100.0 * error, 2),
        format!(
            "{:.2}",
            over_least(report, &view, error, seconds, Column::Seconds)
        ),
        format!(
            "{:.2}",
            over_least(report, &view, error, pairs, Column::Pairs)
        ),
        law,
    ]);
}
