//! What accuracy costs in time: one study for each of ten problems, and the page `docs/accuracy_and_cost.md` of them.
//! `cargo run --release --example work_precision [-- --quick] [--only KEY,KEY] [--out DIR]`,
//! and with `--forecast` what first steps foretell of whole runs.

mod forecast;
mod gas;
mod liquids;
mod page;
mod plate;
mod problem;
mod rods;
mod sound;
mod vortices;

use meshfree::study::work_precision::{Clock, Failure};
use problem::Problem;
use std::path::PathBuf;
use std::time::{Duration, Instant};

type Make = fn(bool) -> Result<Problem, Failure>;

/// In the order of the page, the cheap ones first.
const PROBLEMS: &[(&str, Make)] = &[
    ("rods_copper", |quick| rods::problem("copper", quick)),
    ("rods_pmma", |quick| rods::problem("pmma", quick)),
    ("sod", |quick| Ok(gas::sod(quick))),
    ("noh", |quick| Ok(gas::noh(quick))),
    ("sound_1d", |quick| Ok(sound::problem(false, quick))),
    ("sound_2d", |quick| Ok(sound::problem(true, quick))),
    ("tank", |quick| Ok(liquids::rest_problem(quick))),
    ("wave", liquids::wave_problem),
    ("vortices", |quick| Ok(vortices::problem(quick))),
    ("plate", |quick| Ok(plate::problem(quick))),
];

fn main() -> Result<(), Failure> {
    let (mut quick, mut foretell, mut only, mut out) = (false, false, None, None);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--quick" => quick = true,
            "--forecast" => foretell = true,
            "--only" => only = arguments.next(),
            "--out" => out = arguments.next().map(PathBuf::from),
            other => {
                return Err(format!(
                    "unknown option `{other}`: there are --quick, --forecast, --only KEY,KEY and --out DIR"
                )
                .into());
            }
        }
    }
    // Small runs have nothing to share out, and one thread repeats.
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build_global()?;
    if foretell {
        print!("{}", forecast::table(quick)?);
        return Ok(());
    }
    // A quick run, or one of some problems, checks that everything works: it does not touch the documentation.
    let whole = !quick && only.is_none();
    let out = out.unwrap_or_else(|| {
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
    let mut page = page::Page::default();
    for (key, make) in PROBLEMS {
        if only
            .as_ref()
            .is_some_and(|only| !only.split(',').any(|own| own == *key))
        {
            continue;
        }
        let begin = Instant::now();
        let Problem { text, study } = make(quick)?;
        let report = study
            .repeats(if quick { 1 } else { 3 })
            .clock(Clock::Processor)
            .repeat_up_to(Duration::from_millis(500))
            .run()?;
        println!("{report}\n{key}: {:.1} s\n", begin.elapsed().as_secs_f64());
        report.csv(data.join(format!("{key}.csv")))?;
        report.save_json(data.join(format!("{key}.json")))?;
        report
            .first()
            .figure()
            .save(out.join(format!("accuracy_{key}.svg")))?;
        page.add(&text, &report);
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
