//! "Within a minute": what a study answers, and what comes of it when it is run.
//! The answer is of the whole sweeps of two problems; the run is one that they did not see.

use super::problem::Problem;
use super::{liquids, rods};
use meshfree::output::table::{Table, significant};
use meshfree::study::work_precision::{Clock, Estimate, Failure};
use std::time::Duration;

/// A row: the answer, and the run by it.
fn hold(
    table: &mut Table,
    seconds: f64,
    problem: Problem,
    again: impl Fn(&str, f64) -> Result<Problem, Failure>,
) -> Result<(), Failure> {
    let title = problem.text.title;
    let study = problem.study.clock(Clock::Processor).repeats(3);
    let report = study.repeat_up_to(Duration::from_millis(500)).run()?;
    let recipe = report.within(Duration::from_secs_f64(seconds))?;
    println!("{title}: {recipe}");
    let (method, spacing) = (recipe.method.clone(), lattice(recipe.spacing));
    let run = again(&method, spacing)?.study.clock(Clock::Processor);
    let found = run.repeats(1).run()?;
    let row = &found.rows()[0];
    let error = match &row.errors[0] {
        Ok(error) => *error,
        Err(why) => return Err(format!("{title}: {why}: {:?}", row.status).into()),
    };
    let span = |own: &Estimate| {
        let [value, low, high] = [own.value, own.low, own.high].map(|x| significant(x, 2));
        format!("{value} ({low} to {high})")
    };
    table.row([
        title.to_string(),
        method,
        significant(spacing, 4),
        format!("{:.1}", recipe.beyond),
        span(&recipe.seconds),
        significant(row.seconds, 3),
        span(&recipe.error),
        significant(error, 3),
    ]);
    Ok(())
}

/// The spacing that fits into half a metre and into the 10 mm of a rod a whole number of times.
fn lattice(spacing: f64) -> f64 {
    let per = if spacing < 1e-3 { 0.01 } else { 0.5 };
    per / (per / spacing).round()
}

/// Both problems, asked for so many seconds.
pub fn table(seconds: f64) -> Result<Table, Failure> {
    let mut table = Table::new([
        "problem",
        "method",
        "spacing [m]",
        "finest run over it",
        "time, predicted [s]",
        "took [s]",
        "error, predicted",
        "found",
    ]);
    let quick = seconds < 10.0;
    hold(
        &mut table,
        seconds,
        rods::problem("copper", quick)?,
        rods::again,
    )?;
    hold(
        &mut table,
        seconds,
        liquids::rest_problem(quick),
        |name, dx| Ok(liquids::rest_again(name, dx)),
    )?;
    Ok(table)
}
