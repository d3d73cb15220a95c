//! All examples in one program, which compiles in half the time of a program for each, since loops and driver that
//! they share are compiled once. It runs each in its quick setting, or those whose names contain a word that it is given.

// Examples are programs; what one of them exports, another does not use. Their tests are run elsewhere, and what these use is dead here.
#![allow(missing_docs, dead_code, unused_imports, clippy::duplicate_mod)]

use std::path::Path;
use std::process::{Command, ExitCode, Termination};
use std::time::Instant;

/// Names the example that a process is to be.
const BE: &str = "MESHFREE_EXAMPLE";

macro_rules! examples {
    ($($name:ident $path:literal)+) => {
        $(#[path = $path] mod $name;)+

        fn main() -> ExitCode {
            match std::env::var(BE).as_deref() {
                $(Ok(stringify!($name)) => return $name::main().report(),)+
                Ok(name) => panic!("there is no example {name}"),
                Err(_) => {}
            }
            let words: Vec<String> = std::env::args().skip(1).collect();
            let asked = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word.as_str()));
            let all = [$(stringify!($name)),*];
            let mut failed = missing(&all);
            $(if asked(stringify!($name)) && !passes(stringify!($name)) {
                failed.push(stringify!($name).to_owned());
            })+
            if !failed.is_empty() {
                eprintln!("these failed: {failed:?}");
            }
            ExitCode::from(u8::from(!failed.is_empty()))
        }
    };
}

/// Examples of the folder that have no line here.
fn missing(all: &[&str]) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let entries = std::fs::read_dir(folder).expect("the folder of examples");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let programs = paths.filter(|path| {
        path.extension().is_some_and(|end| end == "rs") || path.join("main.rs").exists()
    });
    let names = programs.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()));
    names.filter(|name| !all.contains(&name.as_str())).collect()
}

/// Whether an example ends well in its quick setting, in a process of its own. What it writes stays in `target/tmp/examples`.
fn passes(name: &str) -> bool {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("examples")
        .join(name);
    let _ = std::fs::remove_dir_all(&out);
    println!("== example {name}");
    let begun = Instant::now();
    let own = std::env::current_exe().expect("this program");
    let mut run = Command::new(own);
    run.env(BE, name).args(["--quick", "--out"]).arg(out);
    let ended = run.status().expect("a process");
    println!(
        "== example {name}: {ended}, {:.1} s",
        begun.elapsed().as_secs_f64()
    );
    ended.success()
}

examples! {
    cellular_filler "../examples/cellular_filler/main.rs"
    channel "../examples/channel.rs"
    dam_break "../examples/dam_break/main.rs"
    elastic_gate "../examples/elastic_gate.rs"
    elastic_plate "../examples/elastic_plate.rs"
    falling_drop "../examples/falling_drop.rs"
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
