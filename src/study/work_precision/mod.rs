//! What accuracy costs in time: a scene swept over spacings and methods, fits of its error and cost, and answers.
//! Before a run: which error to expect, with which method and spacing, and how long it takes on this machine.
//!
//! A study runs one function for every method and spacing. Methods are choices by name, a product of
//! [`sweep`](WorkPrecision::sweep)s or named one by one; the function reads them and builds the scene, so anything that a
//! scene can be is something that a study can sweep. What it returns is an [`Outcome`]: values of the quantities of
//! interest, and the work that it was. Time is that of steps
//! unless another [`Clock`] is chosen; the same runs are also reported in pairs, steps, list builds and
//! bytes, which no machine changes ([`Work`](crate::simulation::Work)). A run that fails is a row too.
//!
//! ```
//! use meshfree::prelude::*;
//! use meshfree::study::work_precision::{History, Outcome, Quantity, WorkPrecision};
//! let report = WorkPrecision::new("copper on copper", |case| {
//!     let scheme: Scheme<f64, 1> = schemes::impact().h_over_dx(case.number("h/dx")?).compose();
//!     let rod = |name, x| Body::block(name, catalogue::copper(), [x], [x + 0.01], case.spacing());
//!     let striker = rod("striker", 0.0).velocity([20.0]);
//!     let mut rods = Scene::new(scheme).body(striker).body(rod("target", 0.01)).build()?;
//!     let (middle, mut pressure) = (rods.particles() / 4, History::new());
//!     rods.run_with(2.5e-6, |now| {
//!         let there = now.all().nth(middle).map_or(0.0, |particle| particle.pressure());
//!         pressure.push(now.time(), there);
//!     })?;
//!     Ok(Outcome::of(&rods).value("rise", pressure.rise(0.0, 353.17e6)? / 1e-6))
//! })
//! .quantity(Quantity::measured("rise"))
//! .spacings([4e-4, 2e-4, 1e-4])
//! .sweep("h/dx", [1.2, 1.5])
//! .run()?;
//! println!("{report}");
//! let steep = report.for_error(0.2).expect("three spacings support this");
//! println!("a front of 0.2 µs: {steep}");
//! # assert!(steep.spacing < 4e-4 && steep.spacing > 5e-5, "{steep}");
//! # assert!(report.for_error(1e-9).is_err());
//! # Ok::<(), Error>(())
//! ```
//!
//! # What is fitted, and what is refused
//!
//! Of each method [`PowerFit`] gives error = floor + C dxᵖ, and [`Price`] the time by counted pairs and what one takes, with
//! intervals, from three spacings on. They are followed four times beyond what was measured and no farther; a [`Refusal`] says
//! what is missing. Where the law does not describe the errors, what was measured still answers.
//!
//! | question | call |
//! |---|---|
//! | what does an error of so much cost? | [`Report::for_error`] |
//! | how good is the best run of so many seconds? | [`Report::within`] |
//! | what did an error take, in pairs that no machine changes? | [`View::work_at`] |
//! | which runs are beaten by no other? | [`View::front`] |
//! | does the law predict the finest run from the others? | [`View::predicted`] |
//! | all of it to look at | [`Report`] as text, [`Report::csv`], [`Report::json`], [`View::figure`], [`page`] for a browser |

mod answer;
mod case;
mod clock;
mod counted;
mod export;
mod fit;
mod history;
mod outcome;
mod page;
mod plot;
mod price;
mod quantity;
mod refusal;
mod report;
#[cfg(test)]
mod tests;

pub use answer::{Basis, Prediction, Recipe};
pub use case::{Case, Method, Value};
pub use clock::Clock;
pub(super) use fit::student_90;
pub use fit::{Estimate, PowerFit};
pub use history::History;
pub use outcome::{Outcome, relative_l1, relative_l2, residual};
pub use page::{json, page, save_page};
pub use plot::Column;
pub use price::Price;
pub use quantity::{Norm, Quantity, Reference};
pub use refusal::{Refusal, Rejected};
pub use report::{Report, Row, Status, View};

use crate::clock::Instant;
use crate::error::{Error, Problem, Result};
use crate::parallel::Pool;
use clock::Begin;
use report::Measured;
use std::time::Duration;

/// What can end a run early: any error.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;

type Run<'a> = dyn Fn(&Case<'_>) -> core::result::Result<Outcome, Failure> + Send + Sync + 'a;
type Watch<'a> = dyn FnMut(&Row) + 'a;

/// A study of accuracy against cost. The [module](self) says what it is for and shows one.
pub struct WorkPrecision<'a> {
    name: String,
    run: Box<Run<'a>>,
    quantities: Vec<Quantity>,
    spacings: Vec<f64>,
    sweeps: Vec<(String, Vec<Value>)>,
    methods: Vec<Method>,
    repeats: usize,
    repeat_up_to: Duration,
    budget: Option<Duration>,
    clock: Clock,
    notes: Vec<(String, String)>,
    point: Option<(String, f64)>,
    watch: Option<Box<Watch<'a>>>,
}

impl<'a> WorkPrecision<'a> {
    /// A study of what this function builds and runs.
    ///
    /// A choice called `threads` that is a number makes the function run on so many; else it runs on all.
    #[must_use]
    pub fn new(
        name: &str,
        run: impl Fn(&Case<'_>) -> core::result::Result<Outcome, Failure> + Send + Sync + 'a,
    ) -> Self {
        Self {
            name: name.into(),
            run: Box::new(run),
            quantities: Vec::new(),
            spacings: Vec::new(),
            sweeps: Vec::new(),
            methods: Vec::new(),
            repeats: 3,
            repeat_up_to: Duration::from_secs(1),
            budget: None,
            clock: Clock::default(),
            notes: Vec::new(),
            point: None,
            watch: None,
        }
    }

    /// Adds a quantity of interest. Questions that name none are about the first.
    #[must_use]
    pub fn quantity(mut self, quantity: Quantity) -> Self {
        self.quantities.push(quantity);
        self
    }

    /// The spacings \[m\], in any order; runs go from coarse to fine.
    #[must_use]
    pub fn spacings(mut self, spacings: impl IntoIterator<Item = f64>) -> Self {
        self.spacings.extend(spacings);
        self
    }

    /// Values of a choice: methods are all combinations of the choices that are swept.
    #[must_use]
    pub fn sweep<V: Into<Value>>(
        mut self,
        choice: &str,
        values: impl IntoIterator<Item = V>,
    ) -> Self {
        let values = values.into_iter().map(Into::into).collect();
        self.sweeps.push((choice.into(), values));
        self
    }

    /// One method by name, with its choices, each of which is combined with those that are swept.
    #[must_use]
    pub fn method<'n>(
        mut self,
        name: &str,
        choices: impl IntoIterator<Item = (&'n str, Value)>,
    ) -> Self {
        let choices = choices
            .into_iter()
            .map(|(name, value)| (name.into(), value));
        self.methods.push(Method {
            name: name.into(),
            choices: choices.collect(),
        });
        self
    }

    /// How often a run is timed, for the median of its time, as long as all its repeats together take less than
    /// [`repeat_up_to`](Self::repeat_up_to); 3 by default. A run before them, which finds cold caches and a clock that has yet to rise,
    /// is not counted; where there is no time for a second run, it is the one that counts.
    #[must_use]
    pub fn repeats(mut self, times: usize) -> Self {
        self.repeats = times.max(1);
        self
    }

    /// The time that repeats of one run may take; a second by default.
    #[must_use]
    pub fn repeat_up_to(mut self, time: Duration) -> Self {
        self.repeat_up_to = time;
        self
    }

    /// The time after which no further run is begun; later runs are rows that say so. None by default.
    #[must_use]
    pub fn budget(mut self, time: Duration) -> Self {
        self.budget = Some(time);
        self
    }

    /// What the time of a run is; by default the wall-clock time of its steps.
    #[must_use]
    pub fn clock(mut self, clock: Clock) -> Self {
        self.clock = clock;
        self
    }

    /// A note that goes with the report into [`Report::json`] and the [`page`].
    ///
    /// | name | text |
    /// |---|---|
    /// | `command` | what repeats a run, with `{method}` and `{spacing}` where they stand in it ([`point`](Self::point)) |
    /// | `commit` | the state of the program |
    /// | `setting` | what runs, and what its error is |
    /// | `advice` | paragraphs about the study, with `**emphasis**` and code between backticks |
    #[must_use]
    pub fn note(mut self, name: &str, text: &str) -> Self {
        self.notes.push((name.into(), text.into()));
        self
    }

    /// Runs this method on this spacing \[m\] alone: one point of a study, again.
    ///
    /// An error that is measured against finer runs has none to be measured against.
    #[must_use]
    pub fn point(mut self, method: &str, spacing: f64) -> Self {
        self.point = Some((method.into(), spacing));
        self
    }

    /// Shows every row as soon as it is measured, before its errors are known.
    #[must_use]
    pub fn watch(mut self, watch: impl FnMut(&Row) + 'a) -> Self {
        self.watch = Some(Box::new(watch));
        self
    }

    /// All methods: those that were named, each with all combinations of what is swept.
    fn all_methods(&self) -> Vec<Method> {
        let mut all = self.methods.clone();
        if all.is_empty() {
            all.push(Method {
                name: String::new(),
                choices: Vec::new(),
            });
        }
        for (choice, values) in &self.sweeps {
            let with = |method: &Method, value: &Value| {
                let mut choices = method.choices.clone();
                choices.push((choice.clone(), value.clone()));
                let own = match value {
                    Value::Number(value) => format!("{choice} {value}"),
                    Value::Text(text) => text.clone(),
                };
                let name = [method.name.as_str(), own.as_str()];
                let name = name.into_iter().filter(|part| !part.is_empty());
                Method {
                    name: name.collect::<Vec<_>>().join(", "),
                    choices,
                }
            };
            all = all
                .iter()
                .flat_map(|method| values.iter().map(move |value| with(method, value)))
                .collect();
        }
        if let [only] = all.as_mut_slice()
            && only.name.is_empty()
        {
            only.name = "as it is".into();
        }
        all
    }

    fn check(&self, methods: &[Method]) -> Result<()> {
        let refuse =
            |what: String, remedy| Err(Error::Argument(Problem::Incompatible { what, remedy }));
        let study = format!("the study `{}`", self.name);
        if self.quantities.is_empty() {
            return refuse(
                format!("{study} has no quantity of interest"),
                "add one with `WorkPrecision::quantity`",
            );
        }
        if self.spacings.is_empty() || methods.is_empty() {
            return refuse(
                format!("{study} has no spacings, or a choice without values"),
                "give at least one with `WorkPrecision::spacings`, three to let laws be fitted",
            );
        }
        for &spacing in &self.spacings {
            if !(spacing.is_finite() && spacing > 0.0) {
                return Err(Error::Argument(Problem::Parameter {
                    what: format!("a spacing of {study} [m]"),
                    value: spacing,
                    must_be: "must be larger than 0 and finite",
                }));
            }
        }
        Ok(())
    }

    /// Runs all methods on all spacings, coarse to fine.
    ///
    /// # Errors
    /// If the study has no quantity, no spacing, or one that is not positive and finite. A run that fails is a row of the report.
    pub fn run(mut self) -> Result<Report> {
        let mut methods = self.all_methods();
        if let Some((method, spacing)) = &self.point {
            let known: Vec<_> = methods.iter().map(|own| own.name.clone()).collect();
            methods.retain(|own| own.name == *method);
            self.spacings = vec![*spacing];
            if methods.is_empty() {
                return Err(Error::Argument(Problem::Incompatible {
                    what: format!(
                        "the study `{}` has no method `{method}` but `{}`",
                        self.name,
                        known.join("`, `")
                    ),
                    remedy: "take one of these names",
                }));
            }
        }
        self.check(&methods)?;
        let mut spacings = self.spacings.clone();
        spacings.sort_by(|a, b| b.total_cmp(a));
        spacings.dedup();
        let begin = Instant::now();
        let mut watch = self.watch.take();
        let mut measured = vec![Vec::new(); methods.len()];
        // Spacing by spacing, so that a budget cuts off the finest of all methods.
        for &spacing in &spacings {
            for (method, runs) in methods.iter().zip(&mut measured) {
                let spent = self.budget.filter(|budget| begin.elapsed() >= *budget);
                let run = match spent {
                    Some(budget) => Measured::without(
                        spacing,
                        Status::NotRun(format!(
                            "the {} s of the study were spent",
                            budget.as_secs_f64()
                        )),
                    ),
                    None => self.measure(&Case { spacing, method }),
                };
                if let Some(watch) = &mut watch {
                    watch(&run.row(&method.name));
                }
                runs.push(run);
            }
        }
        let mut report = Report::new(self.name, self.quantities, methods, measured);
        (report.notes, report.clock) = (self.notes, self.clock);
        Ok(report)
    }

    /// One run with its repeats.
    fn measure(&self, case: &Case<'_>) -> Measured {
        let run = &self.run;
        let threads = case.number("threads").ok().filter(|n| *n >= 1.0);
        let pool = threads.map(|n| Pool::new(n as usize));
        let pool = match pool.transpose() {
            Ok(pool) => pool,
            Err(why) => return Measured::without(case.spacing, Status::Failed(why)),
        };
        let start = Instant::now();
        let mut times: Vec<f64> = Vec::new();
        let mut outcome = Outcome::default();
        // The first of several warms up.
        let runs = if self.repeats > 1 {
            self.repeats + 1
        } else {
            1
        };
        while times.len() < runs {
            let begin = Begin::now();
            let result = match &pool {
                Some(pool) => pool.install(|| run(case)),
                None => run(case),
            };
            match result {
                Ok(found) => outcome = found,
                Err(why) => {
                    let mut failed =
                        Measured::without(case.spacing, Status::Failed(why.to_string()));
                    failed.seconds = begin.wall().as_secs_f64();
                    return failed;
                }
            }
            let time = match self.clock {
                Clock::Wall => outcome.work.time,
                Clock::Processor => begin.processor(),
            };
            times.push(time.as_secs_f64());
            let mean = start.elapsed() / times.len() as u32;
            if start.elapsed() + mean > self.repeat_up_to {
                break;
            }
        }
        if times.len() > 1 {
            times.remove(0);
        }
        times.sort_by(f64::total_cmp);
        Measured {
            spacing: case.spacing,
            status: Status::Done,
            seconds: times[times.len() / 2],
            spread: [times[0], times[times.len() - 1]],
            repeats: times.len(),
            outcome,
        }
    }
}
