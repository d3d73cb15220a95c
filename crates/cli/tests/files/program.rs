//! The program itself: exit status, files, and what it prints.
//! A run that is wrong by its scene has another exit status than one that failed.

use super::{altered, folder, text};
use std::path::Path;
use std::process::{Command, Output};

fn meshfree(arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_meshfree");
    Command::new(program)
        .args(arguments)
        .output()
        .expect("the program")
}

fn printed(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_scene_runs_and_leaves_its_files() {
    let folder = folder("program");
    std::fs::create_dir_all(&folder).expect("a folder");
    let scene = folder.join("rods.toml");
    let rods = altered(
        &text("composite_rods.toml"),
        &[("until = 26e-6", "until = 2e-6\nwall_clock = 3600")],
    );
    std::fs::write(&scene, rods).expect("a scene");
    let (scene, out) = (scene.to_string_lossy().into_owned(), folder.join("out"));
    let run = meshfree(&["run", &scene, "--out", &out.to_string_lossy()]);
    assert!(run.status.success(), "{}", printed(&run.stderr));
    assert!(
        printed(&run.stdout).starts_with("composite rods: 550 particles"),
        "{}",
        printed(&run.stdout)
    );
    for (name, rows) in [
        ("history.csv", 3),
        ("probes.csv", 41),
        ("particles.csv", 550),
    ] {
        let table = meshfree::output::csv::Csv::read(out.join(name)).expect("a table");
        assert_eq!(table.rows.len(), rows, "{name}");
    }
    assert!(out.join("receipt.json").exists() && !out.join("particles.pvd").exists());
    let dry = meshfree(&["run", &scene, "--dry-run"]);
    assert!(dry.status.success() && printed(&dry.stdout).contains("550 particles, about "));
}

#[test]
fn what_is_wrong_has_its_exit_status() {
    let missing = meshfree(&["run", "no_such_scene.toml"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(printed(&missing.stderr).starts_with("no_such_scene.toml: cannot be read"));
    let folder = folder("program_wrong");
    std::fs::create_dir_all(&folder).expect("a folder");
    let scene = folder.join("rods.toml");
    let write = |text: String| std::fs::write(&scene, text).expect("a scene");
    write(altered(
        &text("composite_rods.toml"),
        &[("spacing = 1e-4", "spacing = -1e-4")],
    ));
    let wrong = meshfree(&["check", &scene.to_string_lossy()]);
    assert_eq!(wrong.status.code(), Some(2));
    let expected = ":11: body[0].spacing: is -0.0001: it must be finite and positive, in metres";
    assert!(
        printed(&wrong.stderr).contains(expected),
        "{}",
        printed(&wrong.stderr)
    );
    // A file is where the folder ought to be.
    write(text("composite_rods.toml"));
    let failed = meshfree(&[
        "run",
        &scene.to_string_lossy(),
        "--out",
        &scene.to_string_lossy(),
    ]);
    assert_eq!(failed.status.code(), Some(1));
    assert!(Path::new(&scene).is_file());
}

#[test]
fn the_schema_is_printed() {
    let schema = meshfree(&["schema"]);
    assert!(schema.status.success() && printed(&schema.stdout).contains("\"mirror_plane\""));
}
