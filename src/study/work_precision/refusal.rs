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
    #[error("a value is zero, negative or not finite, and has no logarithm")]
    NoLogarithm,
    /// Refinement makes it worse.
    #[error(
        "the error grows from {} on the coarsest spacing to {} on the finest, so no law says what comes next",
        significant(*.coarse, 3), significant(*.fine, 3)
    )]
    Grows {
        /// Error on the coarsest spacing.
        coarse: f64,
        /// Error on the finest.
        fine: f64,
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
        "not reachable by refinement: the floor is {} ({} to {}), and {} is wanted",
        significant(.floor.value, 3), significant(.floor.low, 3), significant(.floor.high, 3), significant(*.wanted, 3)
    )]
    Floor {
        /// The value that is wanted.
        wanted: f64,
        /// The floor.
        floor: Estimate,
    },
    /// Too far from what was measured.
    #[error(
        "it would take {}, and the runs support {} to {}, four times beyond what was measured: run nearer to it",
        significant(*.wanted, 3), significant(*.from, 3), significant(*.to, 3)
    )]
    TooFar {
        /// What it would take.
        wanted: f64,
        /// The least that is supported.
        from: f64,
        /// The largest.
        to: f64,
    },
    /// No measured runs on both sides of it.
    #[error(
        "no two runs lie around an error of {}: they have {} to {}; run coarser or finer ones",
        significant(*.wanted, 3), significant(*.least, 3), significant(*.largest, 3)
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
    NoMethod(Vec<(String, Refusal)>),
    /// A quantity that the study does not have.
    #[error("there is no quantity called `{name}`: the study has {known}")]
    UnknownQuantity {
        /// The name asked for.
        name: String,
        /// Those that there are.
        known: String,
    },
}

/// A line for each method.
fn each(refusals: &[(String, Refusal)]) -> String {
    let mut lines = String::new();
    for (method, why) in refusals {
        lines += &format!("\n  {method}: {why}");
    }
    lines
}
