//! What a study found: one row for every method and spacing, with errors, time and counts.
//! A view is the report as one of its quantities sees it.

use super::answer::Recipe;
use super::case::Method;
use super::clock::Clock;
use super::fit::PowerFit;
use super::outcome::Outcome;
use super::price::Price;
use super::quantity::Quantity;
use super::refusal::Refusal;
use crate::simulation::Work;
use std::time::Duration;

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Status {
    /// It went to its end.
    Done,
    /// It failed, and why.
    Failed(String),
    /// It was not begun, and why.
    NotRun(String),
}

/// A run as it was measured.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    pub spacing: f64,
    pub status: Status,
    pub seconds: f64,
    pub spread: [f64; 2],
    pub repeats: usize,
    pub outcome: Outcome,
}

impl Measured {
    pub fn without(spacing: f64, status: Status) -> Self {
        Self {
            spacing,
            status,
            seconds: f64::NAN,
            spread: [f64::NAN; 2],
            repeats: 0,
            outcome: Outcome::default(),
        }
    }

    pub fn values(&self, quantity: &str) -> Option<&[f64]> {
        let own = |(name, _): &&(String, Vec<f64>)| name == quantity;
        let found = self.outcome.values.iter().find(own);
        found.map(|(_, values)| values.as_slice())
    }

    /// The row, without errors.
    pub fn row(&self, method: &str) -> Row {
        Row {
            method: method.into(),
            spacing: self.spacing,
            status: self.status.clone(),
            errors: Vec::new(),
            seconds: self.seconds,
            spread: self.spread,
            repeats: self.repeats,
            work: self.outcome.work,
            bits: self.outcome.bits,
        }
    }
}

/// One run.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Row {
    /// The name of its method.
    pub method: String,
    /// Its spacing \[m\].
    pub spacing: f64,
    /// How it ended.
    pub status: Status,
    /// Its error in each quantity, in the order of the study, or why there is none.
    pub errors: Vec<Result<f64, String>>,
    /// Median of its time \[s\]: that of all steps, and of a run that failed that until then.
    pub seconds: f64,
    /// Least and largest time of the repeats \[s\].
    pub spread: [f64; 2],
    /// How often it ran.
    pub repeats: usize,
    /// What was counted, and the time of steps on the wall.
    pub work: Work,
    /// [`Simulation::bits_hash`](crate::simulation::Simulation::bits_hash) at the end, where the run was of a simulation.
    pub bits: Option<u64>,
}

/// What a study found. Printed, it is a table and the fits of every quantity.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Report {
    pub(super) name: String,
    pub(super) quantities: Vec<Quantity>,
    pub(super) methods: Vec<Method>,
    pub(super) rows: Vec<Row>,
    pub(super) notes: Vec<(String, String)>,
    pub(super) clock: Clock,
}

impl Report {
    pub(super) fn new(
        name: String,
        quantities: Vec<Quantity>,
        methods: Vec<Method>,
        measured: Vec<Vec<Measured>>,
    ) -> Self {
        let mut rows = Vec::new();
        for (method, runs) in methods.iter().zip(&measured) {
            let first = rows.len();
            rows.extend(runs.iter().map(|run| run.row(&method.name)));
            for quantity in &quantities {
                let finished = |run: &&Measured| run.status == Status::Done;
                let values: Vec<_> = runs
                    .iter()
                    .map(|run| {
                        let run = Some(run).filter(finished);
                        run.and_then(|run| run.values(&quantity.name))
                    })
                    .collect();
                let seen: Vec<_> = runs.iter().map(|run| run.spacing).zip(values).collect();
                for (row, error) in rows[first..].iter_mut().zip(quantity.errors(&seen)) {
                    row.errors.push(error);
                }
            }
        }
        Self {
            name,
            quantities,
            methods,
            rows,
            notes: Vec::new(),
            clock: Clock::default(),
        }
    }

    /// The name of the study.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// All rows, method by method, coarse to fine.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The names of all methods.
    pub fn methods(&self) -> impl Iterator<Item = &str> {
        self.methods.iter().map(|method| method.name.as_str())
    }

    /// The report as one of its quantities sees it.
    ///
    /// # Errors
    /// If the study has no such quantity.
    pub fn quantity(&self, name: &str) -> Result<View<'_>, Refusal> {
        let found = self.quantities.iter().position(|own| own.name == name);
        let known = || {
            self.quantities
                .iter()
                .map(Quantity::name)
                .collect::<Vec<_>>()
        };
        match found {
            Some(index) => Ok(View {
                report: self,
                index,
            }),
            None => Err(Refusal::UnknownQuantity {
                name: name.into(),
                known: known().join(", "),
            }),
        }
    }

    /// One view for each quantity.
    pub fn views(&self) -> impl Iterator<Item = View<'_>> {
        (0..self.quantities.len()).map(|index| View {
            report: self,
            index,
        })
    }

    /// The report as the first quantity sees it.
    #[must_use]
    pub fn first(&self) -> View<'_> {
        // A study without quantities does not run.
        View {
            report: self,
            index: 0,
        }
    }

    /// The cheapest way to an error of the first quantity: [`View::for_error`].
    ///
    /// # Errors
    /// As there.
    pub fn for_error(&self, error: f64) -> Result<Recipe, Refusal> {
        self.first().for_error(error)
    }

    /// The best error of the first quantity within a time: [`View::within`].
    ///
    /// # Errors
    /// As there.
    pub fn within(&self, time: Duration) -> Result<Recipe, Refusal> {
        self.first().within(time)
    }
}

/// A report as one quantity sees it.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    pub(super) report: &'a Report,
    pub(super) index: usize,
}

impl<'a> View<'a> {
    /// The quantity.
    #[must_use]
    pub fn quantity(&self) -> &'a Quantity {
        &self.report.quantities[self.index]
    }

    /// The error of a row, if it has one.
    #[must_use]
    pub fn error(&self, row: &Row) -> Option<f64> {
        row.errors.get(self.index)?.as_ref().ok().copied()
    }

    /// Rows of a method that have an error, with it.
    pub(super) fn pilots(&self, method: &str) -> Vec<(&'a Row, f64)> {
        let rows = self.report.rows.iter().filter(|row| row.method == method);
        rows.filter_map(|row| Some((row, self.error(row)?)))
            .collect()
    }

    /// The law of the error of a method in the spacing \[m\].
    ///
    /// # Errors
    /// If its runs do not support one.
    pub fn fit(&self, method: &str) -> Result<PowerFit, Refusal> {
        fit_of_errors(&self.pilots(method))
    }

    /// The time \[s\] of a method by one over the spacing \[1/m\].
    ///
    /// # Errors
    /// If there are fewer than three.
    pub fn price(&self, method: &str) -> Result<Price, Refusal> {
        let rows = self.report.rows.iter().filter(|row| row.method == method);
        let done: Vec<_> = rows.filter(|row| row.status == Status::Done).collect();
        Price::of(&done)
    }

    /// The rows that no other beats in both error and time, the cheapest first (the Pareto front).
    #[must_use]
    pub fn front(&self) -> Vec<&'a Row> {
        let mut rows: Vec<_> = self
            .report
            .rows
            .iter()
            .filter_map(|row| Some((row, self.error(row)?)))
            .collect();
        rows.sort_by(|(a, e), (b, f)| a.seconds.total_cmp(&b.seconds).then(e.total_cmp(f)));
        let mut least = f64::INFINITY;
        rows.retain(|(_, error)| {
            let better = *error < least;
            least = least.min(*error);
            better
        });
        rows.into_iter().map(|(row, _)| row).collect()
    }
}

pub(super) fn fit_of_errors(pilots: &[(&Row, f64)]) -> Result<PowerFit, Refusal> {
    let spacings: Vec<_> = pilots.iter().map(|(row, _)| row.spacing).collect();
    let errors: Vec<_> = pilots.iter().map(|(_, error)| *error).collect();
    PowerFit::of(&spacings, &errors)
}
