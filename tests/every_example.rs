//! All examples in one program, which compiles in half the time of a program for each, since loops and driver that
//! they share are compiled once. It runs each, or those whose names contain a word that it is given, and looks for what they
//! leave.

// Examples are programs, each in a module here.
#![allow(missing_docs)]

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Termination};
use std::time::Instant;

/// Names the example that a process is to be.
const BE: &str = "MESHFREE_EXAMPLE";

/// No example has more lines, so that it is read at one sitting.
const LINES: usize = 120;

macro_rules! examples {
    ($($name:ident $path:literal $([$($argument:literal),+])?)+) => {
        $(#[path = $path] mod $name;)+

        fn main() -> ExitCode {
            match std::env::var(BE).as_deref() {
                $(Ok(stringify!($name)) => return $name::main().report(),)+
                Ok(name) => panic!("there is no example {name}"),
                Err(_) => {}
            }
            let words: Vec<String> = std::env::args().skip(1).collect();
            let asked = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word.as_str()));
            let mut failed = wrong(&[$(stringify!($name)),*]);
            $(if asked(stringify!($name)) && !passes(stringify!($name), &[$($($argument),+)?]) {
                failed.push(stringify!($name).to_owned());
            })+
            if !failed.is_empty() {
                eprintln!("these failed: {failed:?}");
            }
            ExitCode::from(u8::from(!failed.is_empty()))
        }
    };
}

/// Examples of the folder that have no line here, or too many of their own.
fn wrong(all: &[&str]) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let entries = std::fs::read_dir(folder).expect("the folder of examples");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let wrong = paths.filter(|path| {
        let name = path.file_stem().and_then(|name| name.to_str());
        let text = std::fs::read_to_string(path).expect("a file");
        name.is_none_or(|name| !all.contains(&name)) || text.lines().count() > LINES
    });
    wrong.map(|path| path.display().to_string()).collect()
}

/// Whether an example ends well, in a process of its own, and leaves a picture and a file for ParaView where it says so. What
/// it writes stays in `target/tmp/examples`.
fn passes(name: &str, arguments: &[&str]) -> bool {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("examples");
    let out = folder.join("out").join(name);
    let _ = std::fs::remove_dir_all(&out);
    std::fs::create_dir_all(&folder).expect("a folder");
    println!("== example {name}");
    let begun = Instant::now();
    let ended = Command::new(std::env::current_exe().expect("this program"))
        .env(BE, name)
        .args(arguments)
        .current_dir(&folder)
        .status()
        .expect("a process");
    println!(
        "== example {name}: {ended}, {:.1} s",
        begun.elapsed().as_secs_f64()
    );
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/{name}.rs"));
    let shown = std::fs::read_to_string(source).expect("the example");
    let needed = if shown.contains(".paraview(") {
        vec!["csv", "pvd", "svg"]
    } else {
        vec!["csv", "svg"]
    };
    let left = files(&out);
    let complete = needed.iter().all(|end| {
        let written = |path: &&PathBuf| path.extension().is_some_and(|own| own == *end);
        left.iter().any(|path| written(&path))
    });
    if !complete {
        eprintln!("{name} left {left:?}, not all of {needed:?}");
    }
    ended.success() && complete
}

/// Files in a folder that are not empty.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let full = entries.filter(|entry| entry.metadata().is_ok_and(|about| about.len() > 0));
    full.map(|entry| entry.path()).collect()
}

examples! {
    dam_break "../examples/dam_break.rs"
    elastic_plate "../examples/elastic_plate.rs"
    falling_drop "../examples/falling_drop.rs"
    hydrostatic "../examples/hydrostatic.rs"
    mechanism "../examples/mechanism.rs"
    own_effect "../examples/own_effect.rs"
    own_material "../examples/own_material.rs"
    rod_impact "../examples/rod_impact.rs"
    sloshing_tank "../examples/sloshing_tank.rs" ["0.03"]
    standing_wave "../examples/standing_wave.rs"
    taylor_bar "../examples/taylor_bar.rs"
    taylor_green "../examples/taylor_green.rs"
}
