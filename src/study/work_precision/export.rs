//! A report as text, comma-separated values and JSON.
//! Rows have all choices and counts, so that a file alone repeats a study.

use super::fit::Estimate;
use super::report::{Report, Row, Status, View};
use crate::error::Result;
use crate::output::csv::{Cell, CsvWriter};
use crate::output::json::{json_number, json_object, json_text, processor};
use crate::output::table::{Table, significant};
use crate::output::write_whole;
use core::fmt;
use std::path::Path;

const COUNTS: [&str; 7] = [
    "particles",
    "steps",
    "evaluations",
    "list_builds",
    "pairs",
    "bytes",
    "repeats",
];

fn counts(row: &Row) -> [u64; 7] {
    let work = &row.work;
    [
        work.particles as u64,
        work.steps,
        work.evaluations,
        work.list_builds,
        work.pairs,
        work.bytes as u64,
        row.repeats as u64,
    ]
}

/// How a run ended, in words.
fn ended(row: &Row) -> (&'static str, &str) {
    match &row.status {
        Status::Done => ("done", ""),
        Status::Failed(why) => ("failed", why),
        Status::NotRun(why) => ("not run", why),
    }
}

fn json_estimate(estimate: Estimate) -> String {
    let Estimate { value, low, high } = estimate;
    let [value, low, high] = [value, low, high].map(json_number);
    format!("[{value}, {low}, {high}]")
}

/// `value (low to high)`.
fn span(estimate: Estimate, factor: f64) -> String {
    let [value, low, high] =
        [estimate.value, estimate.low, estimate.high].map(|v| significant(factor * v, 2));
    format!("{value} ({low} to {high})")
}

impl View<'_> {
    /// The runs: spacing, error, time and counts, and what became of those without an error.
    #[must_use]
    pub fn table(&self) -> Table {
        let mut table = Table::new([
            "method",
            "spacing [m]",
            "error",
            "time [s]",
            "spread [%]",
            "steps",
            "pairs",
            "list builds",
            "MB",
        ]);
        let front = self.front();
        for row in &self.report.rows {
            let on_front = front.iter().any(|other| core::ptr::eq(*other, row));
            let error = match (self.error(row), &row.errors[self.index], ended(row)) {
                (Some(error), ..) if on_front => format!("{} *", significant(error, 3)),
                (Some(error), ..) => significant(error, 3),
                (None, Err(why), ("done", _)) => format!("none: {why}"),
                (None, _, (how, why)) => format!("{how}: {}", why.split(':').next().unwrap_or(why)),
            };
            let seconds = Some(row.seconds).filter(|s| s.is_finite());
            let spread = 100.0 * (row.spread[1] - row.spread[0]) / row.seconds;
            let work = &row.work;
            table.row([
                row.method.clone(),
                significant(row.spacing, 3),
                error,
                seconds.map_or("–".into(), |s| significant(s, 3)),
                if row.repeats > 1 && spread.is_finite() {
                    format!("{spread:.0}")
                } else {
                    "–".into()
                },
                work.steps.to_string(),
                significant(work.pairs as f64, 3),
                work.list_builds.to_string(),
                significant(work.bytes as f64 / 1e6, 2),
            ]);
        }
        table
    }

    /// The laws of every method: order, floor, order of the work, and how the finest run was predicted.
    #[must_use]
    pub fn fits(&self) -> Table {
        let mut table = Table::new([
            "method",
            "order",
            "floor [%]",
            "scatter [%]",
            "pairs ~ dx^-q, q",
            "finest predicted: error, time (over measured)",
        ]);
        let predicted = self.predicted();
        for method in self.report.methods() {
            let [order, floor, scatter] = match self.fit(method) {
                Ok(fit) => [
                    span(fit.order(), 1.0),
                    span(fit.floor(), 100.0),
                    significant(100.0 * fit.scatter(), 2),
                ],
                Err(why) => [why.to_string(), String::new(), String::new()],
            };
            let cost = self.price(method);
            let cost = cost.map_or("–".into(), |price| span(price.order(), 1.0));
            let own = predicted.iter().find(|one| one.method == method);
            let ratio = |(by_law, measured): &(core::result::Result<Estimate, _>, f64)| match by_law
            {
                Ok(by_law) => format!("{:.2}", by_law.value / measured),
                Err(_) => "refused".into(),
            };
            let checked = own.map_or("–".into(), |own| {
                format!("{}, {}", ratio(&own.error), ratio(&own.seconds))
            });
            table.row([method.to_string(), order, floor, scatter, cost, checked]);
        }
        table
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.name)?;
        for view in self.views() {
            writeln!(
                f,
                "\n{} (* on the front)\n\n{}",
                view.quantity().name(),
                view.table()
            )?;
            write!(f, "{}", view.fits())?;
        }
        Ok(())
    }
}

impl Report {
    /// Writes all rows as comma-separated values: one column a quantity, empty where a run has no error or no time.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn csv(&self, path: impl AsRef<Path>) -> Result<()> {
        let errors: Vec<_> = self
            .quantities
            .iter()
            .map(|q| format!("error of {}", q.name()))
            .collect();
        let mut columns = vec![
            "method",
            "spacing_m",
            "status",
            "seconds",
            "least_s",
            "largest_s",
        ];
        columns.extend(COUNTS);
        columns.extend(errors.iter().map(String::as_str));
        let mut file = CsvWriter::create(path, &columns)?;
        for row in &self.rows {
            let (how, why) = ended(row);
            let status = if why.is_empty() {
                how.into()
            } else {
                format!("{how}: {why}")
            };
            let mut cells: Vec<Cell<'_>> = vec![
                row.method.as_str().into(),
                row.spacing.into(),
                status.as_str().into(),
            ];
            // A run that ended early has no time.
            let times = [row.seconds, row.spread[0], row.spread[1]];
            let known = |time: f64| time.is_finite().then(|| Cell::from(time));
            cells.extend(times.map(|time| known(time).unwrap_or(Cell::from(""))));
            cells.extend(counts(row).map(|count| Cell::from(count as f64)));
            cells.extend(row.errors.iter().map(|error| match error {
                Ok(error) => Cell::from(*error),
                Err(_) => Cell::from(""),
            }));
            file.mixed_row(&cells)?;
        }
        Ok(())
    }

    /// The report in JSON: the machine, notes, quantities, rows with all choices and counts, and the laws.
    #[must_use]
    pub fn json(&self) -> String {
        let machine = format!(
            "{{\"architecture\": {}, \"processor\": {}, \"cores\": {}, \"threads\": {}, \"clock\": {}, \"code\": \"meshfree\", \"version\": {}}}",
            json_text(std::env::consts::ARCH),
            json_text(&processor()),
            std::thread::available_parallelism().map_or(1, usize::from),
            crate::parallel::threads(),
            json_text(self.clock.words()),
            json_text(env!("CARGO_PKG_VERSION"))
        );
        let quantities: Vec<_> = self
            .quantities
            .iter()
            .map(|q| json_text(q.name()))
            .collect();
        let rows: Vec<_> = self.rows.iter().map(|row| self.json_row(row)).collect();
        let mut laws = Vec::new();
        for view in self.views() {
            for method in self.methods() {
                let law = match view.fit(method) {
                    Ok(fit) => format!(
                        "\"order\": {}, \"floor\": {}, \"factor\": {}, \"scatter\": {}",
                        json_estimate(fit.order()),
                        json_estimate(fit.floor()),
                        json_estimate(fit.factor()),
                        json_number(fit.scatter())
                    ),
                    Err(why) => format!("\"refused\": {}", json_text(&why.to_string())),
                };
                laws.push(format!(
                    "    {{\"quantity\": {}, \"method\": {}, {law}}}",
                    json_text(view.quantity().name()),
                    json_text(method)
                ));
            }
        }
        format!(
            "{{\n  \"study\": {},\n  \"machine\": {machine},\n  \"notes\": {},\n  \"quantities\": [{}],\n  \"rows\": [\n{}\n  ],\n  \"laws\": [\n{}\n  ]\n}}\n",
            json_text(&self.name),
            json_object(
                self.notes
                    .iter()
                    .map(|(name, text)| (name, json_text(text)))
            ),
            quantities.join(", "),
            rows.join(",\n"),
            laws.join(",\n")
        )
    }

    fn json_row(&self, row: &Row) -> String {
        let (how, why) = ended(row);
        let own = self.methods.iter().find(|method| method.name == row.method);
        let choices = own.into_iter().flat_map(|method| &method.choices);
        let choices = choices.map(|(name, value)| {
            let value = match value {
                super::Value::Number(value) => json_number(*value),
                super::Value::Text(text) => json_text(text),
            };
            format!("{}: {value}", json_text(name))
        });
        let errors = row.errors.iter().map(|error| match error {
            Ok(error) => json_number(*error),
            Err(_) => "null".into(),
        });
        let counts = COUNTS.iter().zip(counts(row));
        let counts = counts.map(|(name, count)| format!("{}: {count}", json_text(name)));
        let [least, largest] = row.spread.map(json_number);
        format!(
            "    {{\"method\": {}, \"choices\": {{{}}}, \"spacing\": {}, \"status\": {}, \"why\": {}, \
             \"seconds\": {}, \"spread\": [{least}, {largest}], \"wall_seconds\": {}, {}, \"bits\": {}, \"errors\": [{}]}}",
            json_text(&row.method),
            choices.collect::<Vec<_>>().join(", "),
            json_number(row.spacing),
            json_text(how),
            json_text(why),
            json_number(row.seconds),
            json_number(row.work.time.as_secs_f64()),
            counts.collect::<Vec<_>>().join(", "),
            row.bits
                .map_or("null".into(), |bits| json_text(&format!("{bits:016x}"))),
            errors.collect::<Vec<_>>().join(", ")
        )
    }

    /// Writes [`json`](Self::json) to a file.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn save_json(&self, path: impl AsRef<Path>) -> Result<()> {
        write_whole(path.as_ref(), self.json().as_bytes())
    }
}
