//! The two questions that a study answers: what an error costs, and what a time buys.
//! By the laws of the methods, or by what was measured where a law is refused.

use super::fit::{Estimate, PowerFit, REACH};
use super::price::Price;
use super::refusal::{Refusal, Rejected};
use super::report::{Row, View, fit_of_errors};
use crate::output::table::significant;
use core::fmt;
use std::time::Duration;

/// What an answer rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Basis {
    /// The law of the error of the method, and the price of its runs.
    Fitted,
    /// One run that was measured, because a law was refused; its error is the largest of it and the finer ones.
    Measured,
}

/// How to run, what it costs, and the result. Intervals hold with 90 % if the laws hold.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Recipe {
    /// The method.
    pub method: String,
    /// The spacing \[m\].
    pub spacing: f64,
    /// Its time on this machine \[s\], which for a wanted error includes the doubt about the spacing that it takes.
    pub seconds: Estimate,
    /// Its error.
    pub error: Estimate,
    /// What this rests on.
    pub basis: Basis,
    /// The finest spacing that was run over this one: above 1 it is extrapolated.
    pub beyond: f64,
}

impl fmt::Display for Recipe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let span = |e: &Estimate| {
            let high = if e.high.is_finite() {
                significant(e.high, 2)
            } else {
                "no bound".into()
            };
            format!(
                "{} ({} to {high})",
                significant(e.value, 2),
                significant(e.low, 2)
            )
        };
        write!(
            f,
            "{}, spacing {} m: error {}, {} s",
            self.method,
            significant(self.spacing, 3),
            span(&self.error),
            span(&self.seconds)
        )?;
        match self.basis {
            Basis::Measured => write!(f, ", as measured"),
            Basis::Fitted if self.beyond > 1.0 => {
                write!(f, ", {:.1} times beyond the finest run", self.beyond)
            }
            Basis::Fitted => Ok(()),
        }
    }
}

/// The finest run of a method, and what the laws through its other runs say of it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Prediction {
    /// The method.
    pub method: String,
    /// The spacing of the finest run \[m\].
    pub spacing: f64,
    /// Its error by the law, and as measured.
    pub error: (Result<Estimate, Refusal>, f64),
    /// Its time \[s\] by the law, and as measured.
    pub seconds: (Result<Estimate, Refusal>, f64),
}

/// A method's laws.
struct Laws {
    error: PowerFit,
    time: Price,
}

impl Laws {
    fn recipe(&self, method: &str, spacing: f64, from: f64, to: f64) -> Result<Recipe, Refusal> {
        let fineness = self.time.range();
        let mut seconds = self.time.at(1.0 / spacing)?;
        // What the doubt about the spacing adds; the time has no bound where that is out of reach.
        let end = |spacing: f64| self.time.at((1.0 / spacing).max(fineness.0));
        seconds.high = end(from).map_or(f64::INFINITY, |e| e.high.max(seconds.high));
        seconds.low = end(to).map_or(seconds.low, |e| e.low.min(seconds.low));
        Ok(Recipe {
            method: method.into(),
            spacing,
            seconds,
            error: self.error.at(spacing)?,
            basis: Basis::Fitted,
            beyond: 1.0 / (spacing * fineness.1),
        })
    }
}

impl View<'_> {
    fn laws(&self, method: &str) -> Result<Laws, Refusal> {
        Ok(Laws {
            error: self.fit(method)?,
            time: self.price(method)?,
        })
    }

    /// The answer of every method by `fitted`, or by the rows that `measured` takes, and the best of them by `rank`.
    fn best(
        &self,
        fitted: impl Fn(&str, &Laws) -> Result<Recipe, Refusal>,
        measured: impl Fn(&Row, f64) -> bool,
        rank: impl Fn(&Recipe) -> f64,
    ) -> Result<Recipe, Refusal> {
        let (mut answers, mut refusals) = (Vec::new(), Vec::new());
        for method in self.report.methods() {
            let why = match self.laws(method) {
                Ok(laws) => match fitted(method, &laws) {
                    Ok(recipe) => {
                        answers.push(recipe);
                        continue;
                    }
                    Err(why) => why,
                },
                Err(why) => why,
            };
            // An error counts as the largest from its spacing on: where it passes through zero it is small by luck.
            let mut pilots = self.pilots(method);
            let mut largest = 0.0_f64;
            for (_, error) in pilots.iter_mut().rev() {
                largest = largest.max(*error);
                *error = largest;
            }
            let good = pilots.iter().filter(|(row, error)| measured(row, *error));
            let recipes = good.map(|(row, error)| as_measured(row, *error));
            match recipes.min_by(|a, b| rank(a).total_cmp(&rank(b))) {
                Some(recipe) => answers.push(recipe),
                None => refusals.push(Rejected {
                    method: method.to_string(),
                    why,
                    finest: pilots.last().map(|(row, _)| (row.spacing, row.seconds)),
                }),
            }
        }
        let best = answers
            .into_iter()
            .min_by(|a, b| rank(a).total_cmp(&rank(b)));
        best.ok_or(Refusal::NoMethod(refusals))
    }

    /// The cheapest way to this error: method, spacing and time. Where the error is larger than those that a law is of, runs
    /// that were measured answer: a method whose coarsest run is already better is taken with that, for coarser ones were
    /// not seen.
    ///
    /// # Errors
    /// [`Refusal::NoMethod`], with the reason of each, if none reaches it by what the runs support.
    pub fn for_error(&self, error: f64) -> Result<Recipe, Refusal> {
        self.best(
            |method, laws| {
                let spacing = laws.error.inverse(error)?;
                // Of what is coarser than the runs of the law it says nothing, but those runs do.
                let (from, to) = laws.error.range();
                if spacing.value > to {
                    return Err(Refusal::TooFar {
                        what: "spacing",
                        unit: "m",
                        wanted: spacing.value,
                        from: from / REACH,
                        to,
                    });
                }
                laws.recipe(method, spacing.value, spacing.low, spacing.high.min(to))
            },
            |_, found| found <= error,
            |recipe| recipe.seconds.value,
        )
    }

    /// The best error within this time: method, spacing and error. It goes four times beyond the finest run at most.
    ///
    /// # Errors
    /// [`Refusal::NoMethod`], with the reason of each, if none answers by what the runs support.
    pub fn within(&self, time: Duration) -> Result<Recipe, Refusal> {
        let given = time.as_secs_f64();
        self.best(
            |method, laws| {
                let (coarsest, finest) = laws.time.range();
                let fineness = match laws.time.inverse(given) {
                    Ok(fineness) => fineness,
                    Err(Refusal::TooFar { wanted, .. }) if wanted > finest => REACH * finest,
                    Err(Refusal::TooFar { .. }) => {
                        let least = laws.time.at(coarsest)?.value;
                        return Err(Refusal::NoTime { least, given });
                    }
                    Err(why) => return Err(why),
                };
                // No coarser than what was run, and no finer than what the law of the error supports.
                let spacing = (1.0 / fineness).max(laws.error.range().0 / REACH);
                if fineness < coarsest {
                    let least = laws.time.at(coarsest)?.value;
                    return Err(Refusal::NoTime { least, given });
                }
                laws.recipe(method, spacing, spacing, spacing)
            },
            |row, _| row.seconds <= given,
            |recipe| recipe.error.value,
        )
    }

    /// Of every method the finest run, as the laws through its other runs predict it: what answers are worth here.
    /// Methods with fewer than four runs are not in it, for three are needed to predict the fourth.
    #[must_use]
    pub fn predicted(&self) -> Vec<Prediction> {
        let of = |method: &str| {
            let pilots = self.pilots(method);
            let (finest, others) = pilots.split_last()?;
            let rows: Vec<_> = others.iter().map(|(row, _)| *row).collect();
            let (row, error) = *finest;
            (others.len() >= 3).then(|| Prediction {
                method: method.into(),
                spacing: row.spacing,
                error: (
                    fit_of_errors(others).and_then(|fit| fit.at(row.spacing)),
                    error,
                ),
                seconds: (
                    Price::of(&rows).and_then(|price| price.at(1.0 / row.spacing)),
                    row.seconds,
                ),
            })
        };
        self.report.methods().filter_map(of).collect()
    }
}

/// The recipe that a run was.
fn as_measured(row: &Row, error: f64) -> Recipe {
    let [low, high] = row.spread;
    Recipe {
        method: row.method.clone(),
        spacing: row.spacing,
        seconds: Estimate {
            value: row.seconds,
            low,
            high,
        },
        error: Estimate {
            value: error,
            low: error,
            high: error,
        },
        basis: Basis::Measured,
        beyond: 1.0,
    }
}
