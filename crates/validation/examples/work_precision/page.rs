//! The page of all problems: what to take for each, their plots, and what single choices buy; every run is on the page for a browser.
//! All numbers are from the run that writes it.

use super::choices;
use super::problem::Text;
use super::recommended;
use meshfree::error::Error;
use meshfree::output::table::Table;
use meshfree::study::work_precision::{Estimate, Report, View};
use std::path::Path;

const HEAD: &str = include_str!("words/head.md");
const CHOSEN: &str = include_str!("words/choices.md");
const ENERGY: &str = include_str!("words/energy.md");
const RECOMMENDED: &str = include_str!("words/recommended.md");

pub struct Page {
    /// A picture of each problem, and what failed.
    pictures: Vec<String>,
    failures: String,
    energy: String,
    choices: Table,
    recommended: Table,
    /// Problems that failed.
    failed: usize,
    /// Finest runs that the coarser ones could predict; errors within a quarter, times within 15 %, the same refused, and errors within
    /// their intervals.
    predicted: [usize; 6],
    /// Time of all runs \[s\].
    seconds: f64,
}

impl Page {
    pub fn new() -> Self {
        Self {
            pictures: Vec::new(),
            failures: String::new(),
            energy: String::new(),
            choices: choices::table(),
            recommended: recommended::table(),
            failed: 0,
            predicted: [0; 6],
            seconds: 0.0,
        }
    }

    /// What compatible energy costs, after the problems so far.
    pub fn price_of_energy(&mut self, table: &Table) {
        self.energy = format!("\n{ENERGY}\n{}", table.markdown());
    }

    /// A problem that gave no report.
    pub fn fail(&mut self, key: &str, why: &str) {
        self.failed += 1;
        self.failures += &format!("\n{key} failed: {why}\n");
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
        let key = text.key;
        self.pictures.push(format!("![{key}](accuracy_{key}.svg)"));
    }

    /// How the finest runs were predicted.
    fn count(&mut self, view: &View<'_>) {
        for own in view.predicted() {
            self.predicted[0] += 1;
            if let (Ok(by_law), measured) = &own.error {
                let held = by_law.low <= *measured && *measured <= by_law.high;
                self.predicted[5] += usize::from(held);
            }
            let off = |by_law: &Estimate, measured: f64| (by_law.value / measured - 1.0).abs();
            for (at, (by_law, measured), bound) in [(1, own.error, 0.25), (2, own.seconds, 0.15)] {
                match by_law {
                    Ok(by_law) => {
                        self.predicted[at] += usize::from(off(&by_law, measured) <= bound);
                    }
                    Err(_) => self.predicted[at + 2] += 1,
                }
            }
        }
    }

    pub fn save(&self, path: &Path) -> Result<(), Error> {
        let [all, errors, times, no_errors, no_times, held] = self.predicted;
        let failed = match self.failed {
            0 => String::new(),
            some => format!(" {some} problems failed, as their sections say."),
        };
        let text = format!(
            "{HEAD}\n{RECOMMENDED}\n{}{}\n{}\nThe runs took {:.0} s. Fits to the coarser runs predicted the error of the finest within 25 % in {errors} of \
             {all} cases; {no_errors} fits were rejected, and {held} errors were within their intervals of 90 %. Times were predicted within 15 % in \
             {times} cases, and {no_times} were not predicted.{failed}\n\n{CHOSEN}\n{}{}",
            self.recommended.markdown(),
            self.failures,
            grid(&self.pictures),
            self.seconds,
            self.choices.markdown(),
            self.energy
        );
        let fail = |cause| Error::File {
            action: "write",
            path: path.into(),
            cause,
        };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(fail)?;
        }
        std::fs::write(path, narrow(&text)).map_err(fail)
    }
}

/// Tables without padding, which browsers show alike: the page has two thirds of the length.
fn narrow(page: &str) -> String {
    let mut text = String::with_capacity(page.len());
    for line in page.lines() {
        if line.starts_with('|') {
            let words = line.split_whitespace();
            let words = words.map(|word| match word.trim_start_matches('-') {
                "" if word.len() > 1 => "---",
                ":" => "---:",
                _ => word,
            });
            text += &words.collect::<Vec<_>>().join(" ");
        } else {
            text += line;
        }
        text.push('\n');
    }
    text
}

/// Pictures three in a row.
fn grid(pictures: &[String]) -> String {
    let mut table = Table::new(["", "", ""]);
    for row in pictures.chunks(3) {
        table.row((0..3).map(|k| row.get(k).cloned().unwrap_or_default()));
    }
    table.markdown()
}
