//! What accuracy costs in time: one study for each of seventeen problems, and the page `docs/accuracy_and_cost.md` of them.
//! `cargo run --release --example work_precision -- --help` lists the options.

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
use meshfree::study::work_precision::{Clock, Failure, Report};
use problem::Problem;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

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
    about = "What an error costs: all problems, and the page of them, into docs/ and out/work_precision."
)]
struct Line {
    /// Three coarse spacings of each problem, into out/work_precision
    #[arg(long)]
    quick: bool,
    /// Some of the problems, into out/work_precision
    #[arg(long, value_name = "KEY,KEY", value_delimiter = ',',
          value_parser = PossibleValuesParser::new(PROBLEMS.iter().map(|(key, _)| *key)))]
    only: Vec<String>,
    /// Where files go instead
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// What first steps foretell of whole runs
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

/// Runs a study, and leaves its rows and its plot.
fn measure(problem: Problem, quick: bool, data: &Path, out: &Path) -> Result<Report, Failure> {
    let key = problem.text.key;
    let report = problem
        .study
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
    let out = line.out.unwrap_or_else(|| {
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
    let mut page = page::Page::new();
    for (key, make) in PROBLEMS {
        if !line.only.is_empty() && !line.only.iter().any(|own| own == key) {
            continue;
        }
        let begin = Instant::now();
        // A problem that fails is a section that says so, and the others run.
        let done = make(quick).and_then(|problem| {
            let text = problem.text;
            Ok((text, measure(problem, quick, &data, &out)?))
        });
        match done {
            Ok((text, report)) => {
                println!("{report}\n{key}: {:.1} s\n", begin.elapsed().as_secs_f64());
                page.add(&text, &report);
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
    println!(
        "{seconds:.0} s; the page is in {}, all rows in {}",
        out.display(),
        data.display()
    );
    Ok(())
}
