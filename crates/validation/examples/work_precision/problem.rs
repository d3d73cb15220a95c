//! A problem of the study: what runs, what is said about it, and what it is asked.
//! Text about a choice is written from the numbers, and to be read again when they change.

use meshfree::study::work_precision::{Case, Failure, Method, Outcome, Value, WorkPrecision};
use meshfree::term::viscosity::MonaghanGingold;

/// What is said about a problem.
#[derive(Clone, Copy)]
pub struct Text {
    /// Name of its files, and of `--only`.
    pub key: &'static str,
    pub title: &'static str,
    /// What runs, and what its error is.
    pub setting: &'static str,
    /// What to choose and why.
    pub words: &'static str,
}

/// What is said about it, and its study.
pub struct Problem {
    pub text: Text,
    pub study: WorkPrecision<'static>,
}

/// A method by its choices.
pub fn method(name: &str, texts: &[(&str, &str)], numbers: &[(&str, f64)]) -> Method {
    let texts = texts
        .iter()
        .map(|(name, value)| ((*name).to_string(), Value::from(*value)));
    let numbers = numbers
        .iter()
        .map(|(name, value)| ((*name).to_string(), Value::from(*value)));
    Method {
        name: name.into(),
        choices: texts.chain(numbers).collect(),
    }
}

/// A weakly compressible liquid: which scheme, h/dx, artificial viscosity and density diffusion.
pub fn liquid(name: &str, scheme: &str, ratio: f64, alpha: f64, delta: f64) -> Method {
    let numbers = [("h/dx", ratio), ("alpha", alpha), ("delta", delta)];
    method(name, &[("scheme", scheme)], &numbers)
}

/// The artificial viscosity of such a liquid.
pub fn plain_viscosity(case: &Case<'_>) -> Result<MonaghanGingold, Failure> {
    Ok(MonaghanGingold {
        alpha: case.number("alpha")?,
        beta: 0.0,
    })
}

/// A study of these methods on so many particles a metre; of a quick one the three coarsest.
pub fn sweep(
    text: Text,
    counts: &[u32],
    quick: bool,
    methods: Vec<Method>,
    run: impl Fn(&Case<'_>) -> Result<Outcome, Failure> + Send + Sync + 'static,
) -> WorkPrecision<'static> {
    let counts = &counts[..if quick { 3 } else { counts.len() }];
    let study = WorkPrecision::new(text.title, run);
    let study = study.spacings(counts.iter().map(|n| 1.0 / f64::from(*n)));
    with(study, methods)
}

/// A study with these methods.
pub fn with(study: WorkPrecision<'static>, methods: Vec<Method>) -> WorkPrecision<'static> {
    methods.into_iter().fold(study, |study, own| {
        let choices = own
            .choices
            .iter()
            .map(|(name, value)| (name.as_str(), value.clone()));
        study.method(&own.name, choices)
    })
}
