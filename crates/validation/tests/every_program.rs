//! All programs in one, which compiles in half the time of a program for each, since loops and driver that they share are
//! compiled once. It reads the help of each and runs it in its quick setting, or those whose names contain a word that it
//! is given.

// What one program exports, another does not use. Their tests are run elsewhere, and what these use is dead here.
#![allow(missing_docs, dead_code, unused_imports, clippy::duplicate_mod)]

use std::path::Path;
use std::process::{Command, ExitCode, Termination};
use std::time::Instant;

/// Names the program that a process is to be.
const BE: &str = "MESHFREE_PROGRAM";

macro_rules! programs {
    ($($name:ident $path:literal)+) => {
        $(#[path = $path] mod $name;)+

        fn main() -> ExitCode {
            match std::env::var(BE).as_deref() {
                $(Ok(stringify!($name)) => return $name::main().report(),)+
                Ok(name) => panic!("there is no program {name}"),
                Err(_) => {}
            }
            let words: Vec<String> = std::env::args().skip(1).collect();
            let asked = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word.as_str()));
            let all = [$(stringify!($name)),*];
            let mut failed = missing(&all);
            $(if asked(stringify!($name)) && !(explains(stringify!($name), $path) && passes(stringify!($name))) {
                failed.push(stringify!($name).to_owned());
            })+
            if !failed.is_empty() {
                eprintln!("these failed: {failed:?}");
            }
            ExitCode::from(u8::from(!failed.is_empty()))
        }
    };
}

/// Programs of the folder that have no line here.
fn missing(all: &[&str]) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let entries = std::fs::read_dir(folder).expect("the folder of programs");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let programs = paths.filter(|path| {
        path.extension().is_some_and(|end| end == "rs") || path.join("main.rs").exists()
    });
    let names = programs.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()));
    names.filter(|name| !all.contains(&name.as_str())).collect()
}

/// The program as a process.
fn process(name: &str) -> Command {
    let mut process = Command::new(std::env::current_exe().expect("this program"));
    process.env(BE, name);
    process
}

/// The first line of a program's description, as its source has it.
fn description(path: &str) -> String {
    let main = Path::new(env!("CARGO_MANIFEST_DIR")).join(path.trim_start_matches("../"));
    let mut sources = vec![main.clone()];
    if main.ends_with("main.rs") {
        sources.push(main.with_file_name("options.rs"));
    }
    let texts = sources.into_iter().map(std::fs::read_to_string);
    let text: String = texts.filter_map(Result::ok).collect();
    let begun = ["about: \"", "about = \""]
        .iter()
        .find_map(|key| text.split_once(key));
    let (_, rest) = begun.expect("a description");
    let end = ["\"", "\\n", "\n"]
        .iter()
        .filter_map(|end| rest.find(end))
        .min();
    rest[..end.expect("its end")].to_owned()
}

/// Whether the help of a program begins with its description, and says how it is called.
fn explains(name: &str, path: &str) -> bool {
    let shown = process(name).arg("--help").output().expect("a process");
    let help = String::from_utf8_lossy(&shown.stdout);
    let well = shown.status.success()
        && help.starts_with(&description(path))
        && help.contains("Usage: ")
        && help.contains("--quick");
    if !well {
        println!("== program {name}: its help is\n{help}");
    }
    well
}

/// Whether a program ends well in its quick setting, in a process of its own. What it writes stays in `target/tmp/programs`.
fn passes(name: &str) -> bool {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("programs")
        .join(name);
    let _ = std::fs::remove_dir_all(&out);
    println!("== program {name}");
    let begun = Instant::now();
    let mut run = process(name);
    run.args(["--quick", "--out"]).arg(out);
    let ended = run.status().expect("a process");
    println!(
        "== program {name}: {ended}, {:.1} s",
        begun.elapsed().as_secs_f64()
    );
    ended.success()
}

programs! {
    cellular_filler "../examples/cellular_filler/main.rs"
    channel "../examples/channel.rs"
    dam_break "../examples/dam_break/main.rs"
    elastic_gate "../examples/elastic_gate.rs"
    elastic_plate "../examples/elastic_plate.rs"
    hydrostatic "../examples/hydrostatic.rs"
    hypervelocity "../examples/hypervelocity/main.rs"
    lid_driven_cavity "../examples/lid_driven_cavity.rs"
    rod_impact "../examples/rod_impact/main.rs"
    rubber_rings "../examples/rubber_rings/main.rs"
    sloshing_roll "../examples/sloshing_roll/main.rs"
    sloshing_tank "../examples/sloshing_tank/main.rs"
    square_patch "../examples/square_patch.rs"
    standing_wave "../examples/standing_wave.rs"
    taylor_bar "../examples/taylor_bar/main.rs"
    taylor_green "../examples/taylor_green.rs"
    turek_hron "../examples/turek_hron.rs"
    viscosity_frontier "../examples/viscosity_frontier.rs"
    water_on_plate "../examples/water_on_plate.rs"
    work_precision "../examples/work_precision/main.rs"
}
