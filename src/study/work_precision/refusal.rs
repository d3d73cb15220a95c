//! Why a question has no answer: what the pilot runs do not support, and what would.
//! Nothing is made up beyond them.

use super::fit::Estimate;
use crate::output::table::significant;

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Refusal {
    /// Three parameters need three spacings.
    #[error(
        "a law with floor, factor and order needs at least three spacings, and {have} gave a value: run more"
    )]
    FewSpacings {
        /// The spacings that gave a value.
        have: usize,
    },
    /// The spacings lie too close to show an order.
    #[error("the spacings span a factor of {span:.2} only: let them span two at least")]
    NarrowSpacings {
        /// Largest over smallest.
        span: f64,
    },
    /// A value without logarithm.
    #[error(
        "the {what} on a spacing of {} m is {value}{unit}, which has no logarithm: it must be positive and finite",
        significant(*.spacing, 3)
    )]
    NoLogarithm {
        /// Of what: an error, or a time.
        what: &'static str,
        /// Its unit after a space; nothing for errors, which are parts of a scale.
        unit: &'static str,
        /// The spacing \[m\].
        spacing: f64,
        /// The value.
        value: f64,
    },
    /// Refinement makes it worse.
    #[error(
        "the error grows from {} % on the coarsest spacing, {} m, to {} % on the finest, {} m, so no law says what comes next",
        percent(*.coarse), significant(.spacings[0], 3), percent(*.fine), significant(.spacings[1], 3)
    )]
    Grows {
        /// Error on the coarsest spacing.
        coarse: f64,
        /// Error on the finest.
        fine: f64,
        /// The coarsest spacing and the finest \[m\].
        spacings: [f64; 2],
    },
    /// The law does not describe the values.
    #[error("values scatter by {:.0} % about every law floor + C x^p: add spacings, or choose a quantity that varies less", 100.0 * .scatter)]
    Scatter {
        /// Root mean square, as a part of the value.
        scatter: f64,
    },
    /// No order in sight.
    #[error(
        "values follow no order between 0.1 and 6, the best is {order:.1} at the edge: run finer, where one law holds"
    )]
    NoOrder {
        /// The best order of those that are tried.
        order: f64,
    },
    /// Finer spacings do not help.
    #[error(
        "an error of {} % is not reachable by refinement: the floor is {} % ({} % to {} %)",
        percent(*.wanted), percent(.floor.value), percent(.floor.low), percent(.floor.high)
    )]
    Floor {
        /// The error that is wanted.
        wanted: f64,
        /// The floor.
        floor: Estimate,
    },
    /// Too far from what was measured.
    #[error(
        "it would take a {what} of {} {unit}, and the runs support {} to {} {unit}, four times beyond what was measured: \
         run nearer to it",
        significant(*.wanted, 3), significant(*.from, 3), significant(*.to, 3)
    )]
    TooFar {
        /// Of what: a spacing, or a fineness, which is one over the spacing.
        what: &'static str,
        /// Its unit.
        unit: &'static str,
        /// What it would take.
        wanted: f64,
        /// The least that is supported.
        from: f64,
        /// The largest.
        to: f64,
    },
    /// No measured runs on both sides of it.
    #[error(
        "no two runs lie around an error of {} %: they have {} % to {} %; run coarser or finer ones",
        percent(*.wanted), percent(*.least), percent(*.largest)
    )]
    NotAround {
        /// The error that is wanted.
        wanted: f64,
        /// The least of the runs.
        least: f64,
        /// The largest.
        largest: f64,
    },
    /// There is no time for any run.
    #[error("the cheapest run takes {} s, and {} s are given", significant(*.least, 3), significant(*.given, 3))]
    NoTime {
        /// Seconds of the cheapest run.
        least: f64,
        /// Seconds given.
        given: f64,
    },
    /// No method answers; each says why.
    #[error("no method answers:{}", each(.0))]
    NoMethod(Vec<Rejected>),
    /// A quantity that the study does not have.
    #[error("there is no quantity called `{name}`: the study has {known}")]
    UnknownQuantity {
        /// The name asked for.
        name: String,
        /// Those that there are.
        known: String,
    },
}

/// A method that does not answer.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Rejected {
    /// The method.
    pub method: String,
    /// Why it does not.
    pub why: Refusal,
    /// Spacing \[m\] and time \[s\] of its finest run that has an error.
    pub finest: Option<(f64, f64)>,
}

/// An error, which is a part of the scale of its quantity, in percent.
fn percent(error: f64) -> String {
    significant(100.0 * error, 3)
}

/// A line for each method, with what its finest run took: by that a reader judges what a finer one would take.
fn each(rejected: &[Rejected]) -> String {
    let mut lines = String::new();
    for own in rejected {
        lines += &format!("\n  {}: {}", own.method, own.why);
        if let Some((spacing, seconds)) = own.finest {
            let [spacing, seconds] = [spacing, seconds].map(|value| significant(value, 3));
            lines += &format!(" (its finest run, on {spacing} m, took {seconds} s)");
        }
    }
    lines
}
