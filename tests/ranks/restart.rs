//! Checkpoints on ranks: written on some number of them, resumed on any other and without any, to the same bits.

use super::bits::said;
use super::flap::raft_with_flap;
use super::scenes::dam_break;
use super::watched;
use meshfree::prelude::*;
use meshfree::ranks;
use safetensors::SafeTensors;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const STEPS: usize = 60;

/// A folder of its own for a test, removed when it goes out of scope.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("meshfree-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// All that a file holds, by name.
fn held(path: &Path) -> BTreeMap<String, Vec<u8>> {
    let bytes = std::fs::read(path).expect("a file");
    let file = SafeTensors::deserialize(&bytes).expect("a checkpoint");
    let columns = file.iter().filter(|(name, _)| *name != "checksum");
    columns
        .map(|(name, view)| (name.to_string(), view.data().to_vec()))
        .collect()
}

fn go_on(mut simulation: Simulation<f64, 2>) -> Result<Vec<u64>, Error> {
    for _ in 0..STEPS {
        simulation.step()?;
    }
    Ok(said(&simulation))
}

/// The file that some ranks write after some steps of a scene.
fn written_on(count: usize, scene: fn() -> Scene<f64, 2>, path: &Path) {
    let written = ranks::in_threads(count, 1, |ranks| -> Result<(), Error> {
        let mut simulation = scene().on_ranks(ranks).build()?;
        for _ in 0..STEPS {
            simulation.step()?;
        }
        simulation.save(path)
    });
    for own in written.expect("threads") {
        own.expect("a file");
    }
}

/// Writes a scene on so many ranks and goes on without any and on others, as the run of one process that does not stop.
fn goes_on_anywhere(name: &str, scene: fn() -> Scene<f64, 2>, count: usize, others: &[usize]) {
    let folder = Folder::new(name);
    let [path, plain] = ["ranks", "plain"].map(|name| folder.0.join(name));
    let mut whole = scene().build().expect("the scene");
    for _ in 0..STEPS {
        whole.step().expect("a step");
    }
    whole.save(&plain).expect("a file");
    let end = go_on(whole).expect("the end");
    written_on(count, scene, &path);
    assert!(
        held(&path) == held(&plain),
        "{name}: ranks write the file of one process"
    );
    let resumed = scene().resume(&path).and_then(go_on);
    assert!(resumed.expect("the end") == end, "{name}: without ranks");
    for &count in others {
        let program = |ranks| scene().on_ranks(ranks).resume(&path).and_then(go_on);
        for own in ranks::in_threads(count, 1, program).expect("threads") {
            assert!(own.expect("the end") == end, "{name}: on {count} ranks");
        }
    }
}

#[test]
fn a_run_on_three_ranks_goes_on_anywhere() {
    watched(|| goes_on_anywhere("on-ranks", dam_break, 3, &[1, 2, 4]));
}

/// Two groups, of which one has joints with springs, dampers and a motor.
#[test]
fn a_raft_with_a_flap_on_two_ranks_goes_on_anywhere() {
    watched(|| goes_on_anywhere("raft", || raft_with_flap(0.01), 2, &[2]));
}

#[test]
fn a_file_that_cannot_be_written_or_read_is_an_error_on_all_ranks() {
    let folder = Folder::new("no-file");
    let file = folder.0.join("file");
    std::fs::write(&file, b"no checkpoint").expect("a file");
    watched(move || {
        let said = ranks::in_threads(3, 1, |ranks| {
            let simulation = dam_break()
                .on_ranks(ranks.clone())
                .build()
                .expect("the scene");
            let written = simulation
                .save(file.join("below"))
                .map_err(|error| error.to_string());
            let resumed = dam_break()
                .on_ranks(ranks)
                .resume(&file)
                .map_err(|error| error.to_string());
            [
                written.expect_err("no folder"),
                resumed.expect_err("no checkpoint"),
            ]
        });
        let said = said.expect("threads");
        assert!(said[0][0].starts_with("cannot"), "{said:#?}");
        for rank in [1, 2] {
            assert!(
                said[rank][0].starts_with("rank 0 has failed")
                    && said[rank][0].contains(&said[0][0])
            );
        }
        assert!(
            said.iter()
                .all(|own| own[1] == said[0][1] && own[1].starts_with("cannot resume"))
        );
    });
}
