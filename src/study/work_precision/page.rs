//! A page of studies for a browser: any column against any other, filters, laws, failures, and commands that repeat a run.
//! A single file without dependencies.

use super::report::Report;
use crate::error::Result;
use crate::output::write_whole;
use std::path::Path;

const PAGE: &str = include_str!("page.html");

/// Studies as one page in HTML, with all of their rows inside.
///
/// The reader chooses a study, which columns are drawn against each other, and which methods by words or by their choices;
/// what is shown stands in the address and can be sent to others. The page takes further rows from files of
/// [`Report::json`], which other machines or, in the same format, other codes have left. Of the [notes](super::WorkPrecision::note)
/// it shows `setting` above the plot and `advice` below it, and fills in `command` for the run that is clicked on.
///
/// ```
/// use meshfree::study::work_precision::{Outcome, Quantity, WorkPrecision, page};
/// let report = WorkPrecision::new("a square", |case| Ok(Outcome::default().value("area", 1.0 + case.spacing())))
///     .quantity(Quantity::exact("area", 1.0))
///     .spacings([0.1, 0.05, 0.025])
///     .note("command", "square --spacing {spacing}")
///     .run()?;
/// let html = page("What a square costs", [&report]);
/// assert!(html.contains("square --spacing {spacing}"));
/// # Ok::<(), meshfree::error::Error>(())
/// ```
#[must_use]
pub fn page<'a>(title: &str, reports: impl IntoIterator<Item = &'a Report>) -> String {
    let title = title.replace('&', "&amp;").replace('<', "&lt;");
    PAGE.replace("{{title}}", &title)
        .replace("{{reports}}", &json(reports).replace("</", "<\\/"))
}

/// All rows of studies in JSON: an array of what [`Report::json`] says of each.
#[must_use]
pub fn json<'a>(reports: impl IntoIterator<Item = &'a Report>) -> String {
    let all: Vec<_> = reports.into_iter().map(Report::json).collect();
    format!("[\n{}]\n", all.join(",\n"))
}

/// Writes [`page`] to a file.
///
/// # Errors
/// When it cannot be written.
pub fn save_page<'a>(
    path: impl AsRef<Path>,
    title: &str,
    reports: impl IntoIterator<Item = &'a Report>,
) -> Result<()> {
    write_whole(path.as_ref(), page(title, reports).as_bytes())
}
