//! What accuracy costs in time: one study for each of seventeen problems, and the page `docs/accuracy_and_cost.md` of them.
//! `cargo validate work_precision -- --help` lists the options.

mod choices;
mod energy;
mod forecast;
mod gas;
mod gresho;
mod implosion;
mod liquids;
mod page;
mod plate;
mod problem;
mod recommended;
mod rods;
mod sound;
mod tube;
mod vortices;
mod within;

use clap::Parser;
use clap::builder::PossibleValuesParser;
use meshfree::study::work_precision::{Clock, Failure, Report, save_page};
use problem::Problem;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

const TITLE: &str = "meshfree: what accuracy costs in time";

type Make = fn(bool) -> Result<Problem, Failure>;

/// In the order of the page.
const PROBLEMS: &[(&str, Make)] = &[
    ("rods_copper", |quick| rods::problem("copper", quick)),
    ("rods_pmma", |quick| rods::problem("pmma", quick)),
    ("rods_tension", rods::tension),
    ("sod", |quick| Ok(gas::sod(quick))),
    ("sod_3d", |quick| Ok(tube::problem(quick))),
    ("noh", |quick| Ok(gas::noh(quick))),
    ("noh_3d", |quick| Ok(implosion::noh(quick))),
    ("sedov_3d", |quick| Ok(implosion::sedov(quick))),
    ("gresho", |quick| Ok(gresho::problem(quick))),
    ("sound_1d", |quick| Ok(sound::problem(1, quick))),
    ("sound_2d", |quick| Ok(sound::problem(2, quick))),
    ("sound_3d", |quick| Ok(sound::problem(3, quick))),
    ("tank", |quick| Ok(liquids::rest_problem(quick))),
    ("wave", liquids::wave_problem),
    ("dam", liquids::dam_problem),
    ("vortices", |quick| Ok(vortices::problem(quick))),
    ("plate", plate::problem),
];

/// The command line.
#[derive(Parser)]
#[command(
    about = "Error and cost of all problems; writes their pages to docs/ and out/work_precision."
)]
struct Line {
    /// Three coarse spacings of each problem, into out/work_precision
    #[arg(long)]
    quick: bool,
    /// Some of the problems, into out/work_precision
    #[arg(long, value_name = "KEY,KEY", value_delimiter = ',',
          value_parser = PossibleValuesParser::new(PROBLEMS.iter().map(|(key, _)| *key)))]
    only: Vec<String>,
    /// One method of a problem, by its name there
    #[arg(long, requires = "only", requires = "spacing")]
    method: Option<String>,
    /// One spacing of that method [m]
    #[arg(long, requires = "method", value_name = "DX")]
    spacing: Option<f64>,
    /// Where files go instead
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// What first steps predict of whole runs
    #[arg(long)]
    forecast: bool,
    /// What compatible energy costs against symmetric
    #[arg(long)]
    energy: bool,
    /// What comes of runs that are to take a minute
    #[arg(long)]
    within: bool,
}

/// After this time of a problem none of its runs is begun; what was not run is a row that says so.
const BUDGET: Duration = Duration::from_secs(180);

/// The state of the program, where it is known.
fn commit() -> Option<String> {
    let found = Command::new("git")
        .args(["rev-parse", "--short", "HEAD"])
        .output();
    let found = found.ok().filter(|found| found.status.success())?;
    Some(String::from_utf8(found.stdout).ok()?.trim().into())
}

/// Runs a study, and leaves its rows and its plot.
fn measure(problem: Problem, line: &Line, data: &Path, out: &Path) -> Result<Report, Failure> {
    let (text, quick) = (problem.text, line.quick);
    let key = text.key;
    let command = format!(
        "cargo validate work_precision -- --only {key} --method '{{method}}' --spacing {{spacing}}"
    );
    let mut study = problem.study;
    for (name, note) in [
        ("command", command),
        ("setting", text.setting.into()),
        ("advice", text.words.into()),
    ] {
        study = study.note(name, &note);
    }
    if let Some(commit) = commit() {
        study = study.note("commit", &commit);
    }
    if let Some((method, spacing)) = line.method.as_ref().zip(line.spacing) {
        study = study.point(method, spacing);
    }
    let report = study
        .repeats(if quick { 1 } else { 3 })
        .clock(Clock::Processor)
        .repeat_up_to(Duration::from_millis(500))
        .budget(BUDGET)
        .run()?;
    report.csv(data.join(format!("{key}.csv")))?;
    report.save_json(data.join(format!("{key}.json")))?;
    report
        .first()
        .figure()
        .save(out.join(format!("accuracy_{key}.svg")))?;
    Ok(report)
}

pub(crate) fn main() -> Result<(), Failure> {
    let line = Line::parse();
    let quick = line.quick;
    // Small runs have nothing to share out, and one thread repeats.
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build_global()?;
    if line.forecast {
        print!("{}", forecast::table(quick)?);
        return Ok(());
    }
    if line.energy {
        print!("{}", energy::table(quick)?.markdown());
        return Ok(());
    }
    if line.within {
        let seconds = if quick { 2.0 } else { 60.0 };
        print!("{}", within::table(seconds)?);
        return Ok(());
    }
    // A quick run, or one of some problems, checks that everything works: it does not touch the documentation.
    let whole = !quick && line.only.is_empty();
    let out = line.out.clone().unwrap_or_else(|| {
        if whole {
            "docs".into()
        } else {
            "out/work_precision".into()
        }
    });
    let data = if whole {
        PathBuf::from("out/work_precision")
    } else {
        out.clone()
    };
    let start = Instant::now();
    let (mut page, mut reports) = (page::Page::new(), Vec::new());
    for (key, make) in PROBLEMS {
        if !line.only.is_empty() && !line.only.iter().any(|own| own == key) {
            continue;
        }
        let begin = Instant::now();
        // A problem that fails is a section that says so, and the others run.
        let done = make(quick).and_then(|problem| {
            let text = problem.text;
            Ok((text, measure(problem, &line, &data, &out)?))
        });
        match done {
            Ok((text, report)) => {
                println!("{report}\n{key}: {:.1} s\n", begin.elapsed().as_secs_f64());
                page.add(&text, &report);
                reports.push(report);
            }
            Err(why) => {
                println!("{key}: failed: {why}\n");
                page.fail(key, &why.to_string());
            }
        }
    }
    if whole {
        page.price_of_energy(&energy::table(quick)?);
    }
    let seconds = start.elapsed().as_secs_f64();
    page.save(&out.join("accuracy_and_cost.md"))?;
    save_page(out.join("accuracy.html"), TITLE, &reports)?;
    println!(
        "{seconds:.0} s; the pages are in {}, all rows in {}",
        out.display(),
        data.display()
    );
    Ok(())
}
