//! Ablation: what each effect of a scene changes in a quantity, and what it costs, by runs that leave one out at a time.
//! The scene is coarse and the quantity the user's; an answer to "do I need it?" that no dimensionless number gives.
//!
//! [`ablate`] runs a closure with all effects, without each, and with all again. The closure asks [`Choice::has`] for each name and
//! builds its scene accordingly, so what is left out is left out by type, with its loops and columns; [`Outcome`] carries the
//! quantity and the [counted work](crate::simulation::Work) back.
//!
//! ```
//! use meshfree::prelude::*;
//! use meshfree::study::ablation::{Outcome, ablate};
//! use meshfree::term::viscosity::Inviscid;
//! // Does the pressure behind an impact need artificial viscosity, and does it need heat?
//! let table = ablate("pressure [Pa]", &["viscosity", "energy"], |choice| {
//!     let plain = || schemes::impact().energy(if choice.has("energy") { EnergyForm::Compatible } else { EnergyForm::None });
//!     let scheme: Scheme<f64, 1> = match choice.has("viscosity") {
//!         true => plain().compose(),
//!         false => plain().with_viscosity(Inviscid).compose(),
//!     };
//!     let copper = catalogue::copper;
//!     let mut run = Scene::new(scheme)
//!         .body(Body::block("striker", copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
//!         .body(Body::block("target", copper(), [0.01], [0.03], 2e-4))
//!         .build()?;
//!     run.run_until(2e-6)?;
//!     let pressure = run.body("target")?.nth(10).map_or(f64::NAN, |particle| particle.pressure());
//!     Ok(Outcome::of(pressure, run.work()))
//! })?;
//! println!("{table}");
//! assert!(table.change("energy").is_some_and(|change| change.abs() < 0.01));
//! # Ok::<(), Error>(())
//! ```

use crate::error::{Error, Problem, Result};
use crate::output::csv::{Cell, CsvWriter};
use crate::output::table::{Table, significant};
use crate::simulation::Work;
use core::fmt;
use std::path::Path;

/// Which effects a run has: all but one, or all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice<'a> {
    effects: &'a [&'a str],
    without: Option<usize>,
}

impl Choice<'_> {
    /// Whether the run has an effect. A name that was not given to [`ablate`] is not among those that are left out, so
    /// the run has it.
    #[must_use]
    pub fn has(&self, effect: &str) -> bool {
        self.without.is_none_or(|k| self.effects[k] != effect)
    }
}

/// What a run gave: the quantity, and what it cost.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Outcome {
    /// The quantity that is asked for.
    pub value: f64,
    /// Particles, steps, pairs, bytes and time.
    pub work: Work,
}

impl Outcome {
    /// A quantity, and [`Simulation::work`](crate::simulation::Simulation::work) of the run that gave it.
    #[must_use]
    pub const fn of(value: f64, work: Work) -> Self {
        Self { value, work }
    }
}

/// A run without an effect, or why there is none.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Without {
    /// The effect that it leaves out.
    pub effect: String,
    /// What it gave, or the error that ended it.
    pub outcome: core::result::Result<Outcome, String>,
}

/// What each effect changes and costs: print it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Ablation {
    /// The quantity's name, with its unit.
    pub quantity: String,
    /// The run with all effects.
    pub all: Outcome,
    /// The same run once more, last of all: what the times of two equal runs differ by is noise.
    pub again: Outcome,
    /// The runs without one.
    pub without: Vec<Without>,
}

/// Runs `run` with all effects, without each of them, and with all again.
///
/// # Errors
/// If the run with all effects fails, its error; if two effects have one name, or a quantity is no number,
/// [`Error::Argument`]; if the two runs with all effects do not give the same number to the bit, [`Error::Argument`]: then
/// differences of the others say nothing. A run without an effect that fails is a line of the table.
pub fn ablate(
    quantity: &str,
    effects: &[&str],
    mut run: impl FnMut(Choice<'_>) -> Result<Outcome>,
) -> Result<Ablation> {
    for (k, name) in effects.iter().enumerate() {
        if effects[..k].contains(name) {
            return Err(Error::Argument(Problem::Incompatible {
                what: format!("two effects of the ablation are called `{name}`"),
                remedy: "give every effect a name of its own",
            }));
        }
    }
    let mut at = |without| run(Choice { effects, without });
    let finite = |outcome: Outcome| {
        if outcome.value.is_finite() {
            Ok(outcome)
        } else {
            Err(Error::Argument(Problem::Parameter {
                what: quantity.into(),
                value: outcome.value,
                must_be: "it must be a finite number",
            }))
        }
    };
    let all = finite(at(None)?)?;
    let without = (0..effects.len()).map(|k| Without {
        effect: effects[k].into(),
        outcome: at(Some(k))
            .and_then(finite)
            .map_err(|error| error.to_string()),
    });
    let without = without.collect();
    let again = finite(at(None)?)?;
    if again.value.to_bits() != all.value.to_bits() {
        return Err(Error::Argument(Problem::Parameter {
            what: format!(
                "{quantity} of the same run once more, which gave {} before,",
                all.value
            ),
            value: again.value,
            must_be: "it must be the same to the bit: let the scene depend on the choice alone",
        }));
    }
    Ok(Ablation {
        quantity: quantity.into(),
        all,
        again,
        without,
    })
}

impl Ablation {
    /// What leaving an effect out changes in the quantity, over its value with all effects; of a value of zero the change
    /// itself. Nothing if there is no such effect, or its run failed.
    #[must_use]
    pub fn change(&self, effect: &str) -> Option<f64> {
        let own = self.without.iter().find(|own| own.effect == effect)?;
        own.outcome.as_ref().ok().map(|own| self.change_of(own))
    }

    fn change_of(&self, outcome: &Outcome) -> f64 {
        let change = outcome.value - self.all.value;
        if self.all.value == 0.0 {
            change
        } else {
            change / self.all.value.abs()
        }
    }

    /// The shares \[1\] of time, pairs, steps and bytes that leaving an effect out saves; negative if it costs. Nothing if
    /// there is no such effect, or its run failed.
    #[must_use]
    pub fn saved(&self, effect: &str) -> Option<[f64; 4]> {
        let own = self.without.iter().find(|own| own.effect == effect)?;
        own.outcome
            .as_ref()
            .ok()
            .map(|own| self.saved_of(&own.work))
    }

    fn saved_of(&self, work: &Work) -> [f64; 4] {
        // The shorter of the two times: what else the machine does only adds.
        let time = self.all.work.time.min(self.again.work.time);
        let numbers = |work: &Work| [work.pairs as f64, work.steps as f64, work.bytes as f64];
        let (all, own) = (numbers(&self.all.work), numbers(work));
        let share = |own: f64, all: f64| if all == 0.0 { 0.0 } else { 1.0 - own / all };
        let time = share(work.time.as_secs_f64(), time.as_secs_f64());
        [
            time,
            share(own[0], all[0]),
            share(own[1], all[1]),
            share(own[2], all[2]),
        ]
    }

    /// By what share the times of the two equal runs differ: savings of time below that are none.
    #[must_use]
    pub fn noise(&self) -> f64 {
        let [a, b] = [&self.all, &self.again].map(|own| own.work.time.as_secs_f64());
        (a - b).abs() / a.min(b).max(f64::MIN_POSITIVE)
    }

    /// Writes the table as CSV: one row a run, with value, relative change, and time, pairs, steps and bytes.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be written.
    pub fn csv(&self, path: impl AsRef<Path>) -> Result<()> {
        let columns = [
            "without",
            &self.quantity,
            "relative change",
            "time [s]",
            "pairs",
            "steps",
            "bytes",
            "error",
        ];
        let mut file = CsvWriter::create(path, &columns)?;
        let mut write = |name: &str, outcome: &core::result::Result<Outcome, String>| {
            let numbers = outcome.as_ref().map_or([f64::NAN; 6], |own| {
                let Work {
                    time,
                    pairs,
                    steps,
                    bytes,
                    ..
                } = own.work;
                let time = time.as_secs_f64();
                let counts = [pairs as f64, steps as f64, bytes as f64];
                let [pairs, steps, bytes] = counts;
                [own.value, self.change_of(own), time, pairs, steps, bytes]
            });
            let error = outcome.as_ref().err().map_or("", String::as_str);
            let mut cells: Vec<Cell<'_>> = vec![name.into()];
            cells.extend(numbers.map(Cell::from));
            cells.push(error.into());
            file.mixed_row(&cells)
        };
        write("nothing", &Ok(self.all))?;
        for own in &self.without {
            write(&own.effect, &own.outcome)?;
        }
        write("nothing, again", &Ok(self.again))
    }
}

impl fmt::Display for Ablation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = Table::new([
            "without",
            &self.quantity,
            "changes",
            "saves time",
            "pairs",
            "steps",
            "bytes",
        ]);
        let percent = |share: f64| format!("{:+.1} %", 100.0 * share);
        table.row([
            "nothing",
            &significant(self.all.value, 5),
            "",
            &format!("(noise {:.1} %)", 100.0 * self.noise()),
            "",
            "",
            "",
        ]);
        for own in &self.without {
            match &own.outcome {
                Ok(outcome) => {
                    let saved = self.saved_of(&outcome.work).map(percent);
                    let change = if self.all.value == 0.0 {
                        significant(self.change_of(outcome), 3)
                    } else {
                        format!("{:+.3} %", 100.0 * self.change_of(outcome))
                    };
                    let value = significant(outcome.value, 5);
                    let [time, pairs, steps, bytes] = &saved;
                    table.row([&own.effect, &value, &change, time, pairs, steps, bytes]);
                }
                Err(error) => {
                    table.row([&own.effect, "fails", error, "", "", "", ""]);
                }
            }
        }
        write!(f, "{table}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// A run that costs and gives what its effects do.
    fn run(choice: Choice<'_>) -> Outcome {
        let (a, b) = (choice.has("a"), choice.has("b"));
        let value = 1.0 + if a { 1.0 } else { 0.0 };
        let pairs = 100 + if a { 25 } else { 0 } + if b { 75 } else { 0 };
        Outcome::of(
            value,
            Work {
                pairs,
                steps: 10,
                bytes: 1000,
                time: Duration::from_millis(pairs),
                ..Work::default()
            },
        )
    }

    #[test]
    fn each_is_left_out_once() {
        let mut tried = Vec::new();
        let table = ablate("x [m]", &["a", "b"], |choice| {
            tried.push(["a", "b", "c"].map(|name| choice.has(name)));
            Ok(run(choice))
        })
        .expect("a table");
        let all = [true, true, true];
        assert_eq!(tried, [all, [false, true, true], [true, false, true], all]);
        assert_eq!(
            [table.change("a"), table.change("b")],
            [Some(-0.5), Some(0.0)]
        );
        assert_eq!(table.saved("b"), Some([0.375, 0.375, 0.0, 0.0]));
        assert_eq!((table.saved("c"), table.noise()), (None, 0.0));
        let text = table.to_string();
        assert!(
            text.contains("-50.000 %") && text.contains("+37.5 %"),
            "{text}"
        );
    }

    #[test]
    fn a_run_that_breaks_without_an_effect_is_a_line() {
        let table = ablate("x", &["a", "b"], |choice| {
            let mut outcome = run(choice);
            if !choice.has("b") {
                outcome.value = f64::NAN;
            }
            Ok(outcome)
        })
        .expect("a table");
        assert!(table.change("b").is_none() && table.to_string().contains("fails"));
        let path =
            std::env::temp_dir().join(format!("meshfree-ablation-{}.csv", std::process::id()));
        table.csv(&path).expect("a file");
        let text = std::fs::read_to_string(&path).expect("a text");
        let _ = std::fs::remove_file(&path);
        assert_eq!(text.lines().count(), 5, "{text}");
        assert!(text.contains("it must be a finite number"), "{text}");
    }

    #[test]
    fn what_makes_differences_meaningless_is_refused() {
        let twice = ablate("x", &["a", "a"], |choice| Ok(run(choice)));
        assert!(twice.is_err_and(|error| error.to_string().contains("called `a`")));
        let mut runs = 0.0;
        let drifts = ablate("x", &["a"], |_| {
            runs += 1.0;
            Ok(Outcome::of(runs, Work::default()))
        });
        assert!(drifts.is_err_and(|error| error.to_string().contains("same to the bit")));
    }
}
