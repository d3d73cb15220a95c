//! The page of a study: for every problem its plot, errors by spacing, the runs on the front, the laws, answers, and the words about them.
//! All numbers are from the run that writes it.

use super::choices;
use super::problem::Text;
use super::recommended;
use meshfree::error::Error;
use meshfree::output::table::{Table, significant};
use meshfree::study::work_precision::{Estimate, Refusal, Report, Row, View};
use std::path::Path;
use std::time::Duration;

const HEAD: &str = include_str!("words/head.md");
const CHOSEN: &str = include_str!("words/choices.md");
const ENERGY: &str = include_str!("words/energy.md");
const RECOMMENDED: &str = include_str!("words/recommended.md");

pub struct Page {
    body: String,
    choices: Table,
    recommended: Table,
    /// Problems that failed.
    failed: usize,
    /// Finest runs that others could foretell; errors within a quarter, times within 15 %, the same refused, and errors within
    /// their intervals.
    foretold: [usize; 6],
    /// Time of all runs \[s\].
    seconds: f64,
}

/// The first reason, without those of the other methods.
fn shortly(why: &Refusal) -> String {
    match why {
        Refusal::NoMethod(all) => {
            let own = all.iter().map(|(method, why)| format!("{method}: {why}"));
            own.take(1)
                .chain((all.len() > 1).then(|| format!("and {} more", all.len() - 1)))
                .collect::<Vec<_>>()
                .join("; ")
        }
        other => other.to_string(),
    }
}

impl Page {
    pub fn new() -> Self {
        Self {
            body: String::new(),
            choices: choices::table(),
            recommended: recommended::table(),
            failed: 0,
            foretold: [0; 6],
            seconds: 0.0,
        }
    }

    /// What compatible energy costs, after the problems so far.
    pub fn price_of_energy(&mut self, table: &Table) {
        self.body += &format!("\n{ENERGY}\n{}", table.markdown());
    }

    /// A problem that gave no report.
    pub fn fail(&mut self, key: &str, why: &str) {
        self.failed += 1;
        self.body += &format!("\n## {key}\n\nFailed: {why}\n");
    }

    pub fn add(&mut self, text: &Text, report: &Report) {
        let view = report.first();
        self.count(&view);
        choices::add(&mut self.choices, text.key, text.title, report);
        recommended::add(&mut self.recommended, text.key, text.title, report);
        let times = report
            .rows()
            .iter()
            .map(|row| row.seconds * row.repeats as f64);
        self.seconds += times.filter(|time| time.is_finite()).sum::<f64>();
        let mut front = Table::new([
            "on the front",
            "spacing [m]",
            "error [%]",
            "time [s]",
            "steps",
            "pairs",
        ]);
        for row in view.front() {
            front.row([
                row.method.clone(),
                significant(row.spacing, 3),
                view.error(row)
                    .map_or(String::new(), |error| significant(100.0 * error, 3)),
                significant(row.seconds, 2),
                row.work.steps.to_string(),
                significant(row.work.pairs as f64, 3),
            ]);
        }
        let answer = |what: String, found: Result<_, Refusal>| match found {
            Ok(recipe) => format!("- {what}: {recipe}\n"),
            Err(why) => format!("- {what}: no answer ({})\n", shortly(&why)),
        };
        let errors = text.errors.iter();
        let mut answers: String = errors
            .map(|&error| {
                answer(
                    format!("error of {} %", significant(100.0 * error, 2)),
                    view.for_error(error),
                )
            })
            .collect();
        answers.extend(text.seconds.iter().map(|&seconds| {
            answer(
                format!("within {seconds} s"),
                view.within(Duration::from_secs_f64(seconds)),
            )
        }));
        let failed = report.rows().iter().filter(|row| view.error(row).is_none());
        let mut without = String::new();
        for row in failed {
            let Row { method, status, .. } = row;
            let spacing = significant(row.spacing, 3);
            without += &format!("- no error: {method}, spacing {spacing} m: {status:?}\n");
        }
        self.body += &format!(
            "\n## {}\n\n{}\n\n![{}](accuracy_{}.svg)\n\n{}\n{}\n{}\n{}\n{}",
            text.title,
            text.setting,
            text.title,
            text.key,
            text.words,
            spacings_table(report, &view).markdown(),
            front.markdown(),
            view.fits().markdown(),
            answers,
        );
        if !without.is_empty() {
            self.body += &format!("\n{without}");
        }
        for other in report.views().skip(1) {
            self.body += &format!(
                "\n{}:\n\n{}",
                other.quantity().name(),
                spacings_table(report, &other).markdown()
            );
        }
    }

    /// How the finest runs were foretold.
    fn count(&mut self, view: &View<'_>) {
        for own in view.foretold() {
            self.foretold[0] += 1;
            if let (Ok(by_law), measured) = &own.error {
                let held = by_law.low <= *measured && *measured <= by_law.high;
                self.foretold[5] += usize::from(held);
            }
            let off = |by_law: &Estimate, measured: f64| (by_law.value / measured - 1.0).abs();
            for (at, (by_law, measured), bound) in [(1, own.error, 0.25), (2, own.seconds, 0.15)] {
                match by_law {
                    Ok(by_law) => self.foretold[at] += usize::from(off(&by_law, measured) <= bound),
                    Err(_) => self.foretold[at + 2] += 1,
                }
            }
        }
    }

    pub fn save(&self, path: &Path) -> Result<(), Error> {
        let [all, errors, times, no_errors, no_times, held] = self.foretold;
        let failed = match self.failed {
            0 => String::new(),
            some => format!(" {some} problems failed, as their sections say."),
        };
        let text = format!(
            "{HEAD}\nThe runs took {:.0} s. Of {all} finest runs the laws through the coarser ones foretold the \
             error of {errors} within 25 % and refused that of {no_errors}; {held} were within intervals of 90 %. The price of \
             the coarser ones foretold the time of {times} within 15 % and refused that of {no_times}.{failed}\n\n{RECOMMENDED}\n\
             {}\n{CHOSEN}\n{}{}",
            self.seconds,
            self.recommended.markdown(),
            self.choices.markdown(),
            self.body
        );
        let fail = |cause| Error::File {
            action: "write",
            path: path.into(),
            cause,
        };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(fail)?;
        }
        std::fs::write(path, text).map_err(fail)
    }
}

/// Errors of all methods by spacing.
fn spacings_table(report: &Report, view: &View<'_>) -> Table {
    let mut spacings: Vec<f64> = report.rows().iter().map(|row| row.spacing).collect();
    spacings.sort_by(|a, b| b.total_cmp(a));
    spacings.dedup();
    let heads = spacings
        .iter()
        .map(|dx| format!("dx {}", significant(*dx, 3)));
    let mut table = Table::new(std::iter::once("method".to_string()).chain(heads));
    for method in report.methods() {
        let rows = report.rows().iter().filter(|row| row.method == method);
        let cells = rows.map(|row| {
            view.error(row)
                .map_or("–".into(), |error| significant(error, 3))
        });
        table.row(std::iter::once(method.to_string()).chain(cells));
    }
    table
}
