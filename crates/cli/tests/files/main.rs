//! Scene files: the bits of the same scene in Rust, errors that name fields, the scenes of this package, the schema, the program.
//! One program, for each composed scheme takes seconds to compile.

mod bits;
mod faults;
mod physics;
mod program;
mod schema;

use meshfree_cli::command::{Task, perform};
use meshfree_cli::fault::Source;
use std::path::{Path, PathBuf};

/// The folder of the scenes of this package.
fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

/// A scene of this package.
fn text(name: &str) -> String {
    std::fs::read_to_string(scenes().join(name)).expect("a scene of this package")
}

/// The same with parts replaced, each of which must be there.
fn altered(text: &str, replaced: &[(&str, &str)]) -> String {
    replaced.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "`{from}` is not in the scene");
        text.replacen(from, to, 1)
    })
}

/// A text as a scene beside those of this package.
fn source(text: &str) -> Source {
    Source::new(&scenes().join("altered.toml"), text.to_owned())
}

/// A folder of this test that is empty.
fn folder(name: &str) -> PathBuf {
    let own = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("files")
        .join(name);
    let _ = std::fs::remove_dir_all(&own);
    own
}

#[test]
fn every_scene_passes_its_check() {
    let mut count = 0;
    for entry in std::fs::read_dir(scenes()).expect("scenes").flatten() {
        let path = entry.path();
        if path.extension().is_none_or(|own| own != "toml") {
            continue;
        }
        let source = Source::read(&path).expect("a text");
        match perform(&source, &Task::Check) {
            Ok(text) => assert!(text.contains(" particles, about "), "{text}"),
            Err(stopped) => panic!("{stopped}"),
        }
        count += 1;
    }
    assert!(count >= 8, "{count} scenes");
}

#[test]
fn the_scene_of_the_page_passes_its_check() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/how_to_scene_files.md");
    let page = std::fs::read_to_string(page).expect("the page");
    let (_, rest) = page.split_once("```toml\n").expect("a scene");
    let (scene, _) = rest.split_once("```").expect("its end");
    match perform(&source(scene), &Task::Check) {
        Ok(text) => assert!(text.contains(" particles, about "), "{text}"),
        Err(stopped) => panic!("{stopped}"),
    }
}
