//! Checkpoints on ranks: parts and manifest hold what one process writes, go on anywhere to the same bits, and stand when another one fails.

use super::bits::said;
use super::flap::raft_with_flap;
use super::scenes::{DX, crushed_tank, dam_break, down, periodic_gas, rod_by_runge_kutta};
use super::watched;
use crate::common::folder::Folder;
use meshfree::boundary::Wall;
use meshfree::prelude::*;
use meshfree::ranks;
use safetensors::SafeTensors;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const STEPS: usize = 60;

/// All columns of a file, by name.
fn columns(path: &Path) -> BTreeMap<String, Vec<u8>> {
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let file = SafeTensors::deserialize(&bytes).expect("a checkpoint");
    let columns = file.iter().filter(|(name, _)| *name != "checksum");
    columns
        .map(|(name, view)| (name.to_string(), view.data().to_vec()))
        .collect()
}

/// All columns of a checkpoint: with its parts one after another, if it has so many.
fn held(path: &Path, parts: usize) -> BTreeMap<String, Vec<u8>> {
    let mut all = columns(path);
    let (sums, turn) = (all.remove("parts"), all.remove("turn"));
    assert_eq!(sums.map_or(0, |sums| sums.len() / 8), parts);
    for rank in 0..parts {
        let turn = if turn.as_ref().is_some_and(|turn| turn[0] == 0) {
            "a"
        } else {
            "b"
        };
        let part = format!("{}.{turn}{rank}", path.display());
        let rows = columns(Path::new(&part));
        assert!(rows.values().all(|rows| !rows.is_empty()), "{part}");
        for (name, rows) in rows {
            all.entry(name).or_default().extend(rows);
        }
    }
    all
}

/// The names of all files in a folder.
fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    let mut names: Vec<_> = entries.map(|entry| name(entry.expect("a file"))).collect();
    names.sort();
    names
}

fn go<T: Real, const D: usize>(simulation: &mut Simulation<T, D>) -> Result<(), Error> {
    (0..STEPS).try_for_each(|_| simulation.step().map(|_| ()))
}

fn go_on<T: Real, const D: usize>(mut simulation: Simulation<T, D>) -> Result<Vec<u64>, Error> {
    go(&mut simulation)?;
    Ok(said(&simulation))
}

/// What ranks write is what one process writes, column by column, and goes on anywhere.
fn goes_on_anywhere<T: Real, const D: usize>(
    name: &'static str,
    scene: impl Fn() -> Scene<T, D> + Send + Sync + 'static,
) {
    watched(move || {
        let folder = Folder::new(&format!("on-ranks-{}", name.replace(' ', "-")));
        let [path, plain] = ["ranks", "plain"].map(|name| folder.0.join(name));
        let mut whole = scene().build().expect("the scene");
        go(&mut whole).expect("steps");
        whole.save(&plain).expect("a file");
        let end = go_on(whole).expect("the end");
        let written = ranks::in_threads(3, 1, |ranks| -> Result<(), Error> {
            let mut simulation = scene().on_ranks(ranks).build()?;
            go(&mut simulation)?;
            simulation.save(&path)
        });
        for own in written.expect("threads") {
            own.expect("a file");
        }
        assert!(held(&path, 3) == held(&plain, 0), "{name}: other columns");
        let resumed = scene().resume(&path).and_then(go_on);
        assert!(resumed.expect("the end") == end, "{name}: without ranks");
        for count in [1, 2, 4] {
            let program = |ranks| scene().on_ranks(ranks).resume(&path).and_then(go_on);
            for own in ranks::in_threads(count, 1, program).expect("threads") {
                assert!(own.expect("the end") == end, "{name}: on {count} ranks");
            }
        }
        // What ranks resume from what one process wrote, they write as it does; its file gives way to a manifest.
        let again = ranks::in_threads(2, 1, |ranks| -> Result<(), Error> {
            let simulation = scene().on_ranks(ranks).resume(&plain)?;
            simulation.save(&plain)?;
            simulation.save(&plain)
        });
        for own in again.expect("threads") {
            own.expect("a file");
        }
        assert!(held(&plain, 2) == held(&path, 3), "{name}: other columns");
        let expected = [
            "plain", "plain.b0", "plain.b1", "ranks", "ranks.a0", "ranks.a1", "ranks.a2",
        ];
        assert_eq!(files(&folder.0), expected, "{name}");
    });
}

/// Water between walls of particles and a mirror plane: records of images, which all particles give, are in the file.
fn mirror_beside_walls() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(4.0);
    let open = [[false, true], [true, true]];
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.8, 0.4], DX).jitter(0.2, 3))
        .wall(Wall::around("tank", [0.0; 2], [1.2, 0.6], DX, 4, open))
        .boundary(MirrorPlane::wall([0.0; 2], [-1.0, 0.0]))
        .acceleration(down)
}

/// The same of a run in parts that is read between two steps, and saved then: each rank has its own particles after the last step.
#[test]
fn what_is_read_between_steps_goes_on_anywhere() {
    fn go_on<const D: usize>(mut simulation: Simulation<f64, D>, end: f64) -> [Vec<u64>; 2] {
        let first = said(&simulation);
        simulation.run_until(end).expect("a run");
        [first, said(&simulation)]
    }
    fn saved<const D: usize>(name: &str, scene: impl Fn() -> Scene<f64, D> + Sync) {
        let folder = Folder::new(&format!("read-on-ranks-{name}"));
        let [path, plain] = ["ranks", "plain"].map(|name| folder.0.join(name));
        let mut whole = scene().build().expect("the scene");
        let time = 40.3 * whole.step().expect("a step");
        let run = |simulation: &mut Simulation<f64, D>, path: &Path| {
            simulation.run_until(0.7 * time).expect("a run");
            simulation.run_until(time).expect("a run");
            simulation.save(path).expect("a file");
        };
        let mut whole = scene().build().expect("the scene");
        run(&mut whole, &plain);
        let expected = go_on(whole, 1.5 * time);
        let all = ranks::in_threads(3, 1, |ranks| {
            let mut simulation = scene().on_ranks(ranks).build().expect("the scene");
            run(&mut simulation, &path);
            go_on(simulation, 1.5 * time)
        });
        assert!(all.expect("threads").iter().all(|own| *own == expected));
        assert!(columns(&path).contains_key("shown"), "{name}");
        assert!(held(&path, 3) == held(&plain, 0), "{name}: other columns");
        let resumed = scene().resume(&path).expect("a checkpoint");
        assert!(go_on(resumed, 1.5 * time) == expected, "{name}");
        for count in [1, 2, 4] {
            let all = ranks::in_threads(count, 1, |ranks| {
                let resumed = scene().on_ranks(ranks).resume(&path).expect("a checkpoint");
                go_on(resumed, 1.5 * time)
            });
            let all = all.expect("threads");
            assert!(all.iter().all(|own| *own == expected), "{name} on {count}");
        }
    }
    watched(|| {
        saved("dam break", dam_break);
        saved("crushed", crushed_tank);
        saved("mirror beside walls", mirror_beside_walls);
        saved("gas", periodic_gas);
        saved("Runge-Kutta", rod_by_runge_kutta);
    });
}

/// Books of energy are of all particles, of which a rank that resumes has its own alone.
#[test]
fn energy_that_is_kept_goes_on() {
    watched(|| {
        let folder = Folder::new("energy-on-ranks");
        let path = folder.0.join("plain");
        let end = |mut now: Simulation<f64, 2>| {
            now.run_until(0.03).expect("a run");
            (format!("{:?}", now.energy()), said(&now))
        };
        let mut plain = dam_break().build().expect("the scene");
        plain.keep_energy();
        plain.run_until(0.02).expect("a run");
        plain.save(&path).expect("a file");
        let expected = end(plain);
        let all = ranks::in_threads(3, 1, |ranks| {
            end(dam_break().on_ranks(ranks).resume(&path).expect("a file"))
        });
        assert!(all.expect("threads").iter().all(|own| *own == expected));
    });
}

#[test]
fn a_dam_break_on_three_ranks_goes_on_anywhere() {
    goes_on_anywhere("dam break", dam_break);
}

#[test]
fn a_gas_on_three_ranks_goes_on_anywhere() {
    goes_on_anywhere("periodic gas", periodic_gas);
}

#[test]
fn a_run_that_keeps_states_goes_on_anywhere() {
    goes_on_anywhere("Runge-Kutta", rod_by_runge_kutta);
}

#[test]
fn a_crushed_tank_on_three_ranks_goes_on_anywhere() {
    goes_on_anywhere("crushed", crushed_tank);
}

/// Two groups, of which one has joints with springs, dampers and a motor.
#[test]
fn a_raft_with_a_flap_goes_on_anywhere() {
    goes_on_anywhere("raft", || raft_with_flap(0.01));
}

/// What each of three ranks says.
fn said_by_all(program: impl Fn(std::sync::Arc<dyn ranks::Ranks>) -> String + Sync) -> Vec<String> {
    ranks::in_threads(3, 1, program).expect("threads")
}

#[test]
fn a_part_that_is_missing_or_altered_is_one_error_on_all_ranks() {
    watched(|| {
        let folder = Folder::new("parts");
        let path = folder.0.join("dam");
        let resumed = |ranks: std::sync::Arc<dyn ranks::Ranks>| {
            let resumed = dam_break().on_ranks(ranks).resume(&path);
            resumed.map_or_else(|error| error.to_string(), |_| "well".into())
        };
        said_by_all(|ranks| {
            let simulation = dam_break().on_ranks(ranks).build().expect("the scene");
            simulation.save(&path).expect("a file");
            String::new()
        });
        let part = folder.0.join("dam.a1");
        let whole = fs::read(&part).expect("a part");
        let mut altered = whole.clone();
        altered[whole.len() / 2] ^= 1;
        fs::write(&part, altered).expect("a file");
        let all = said_by_all(resumed);
        assert!(all.iter().all(|own| *own == all[0]), "{all:#?}");
        assert!(
            all[0].contains("dam.a1") && all[0].contains("rank 1 of 3"),
            "{all:#?}"
        );
        fs::remove_file(&part).expect("a part");
        let all = said_by_all(resumed);
        assert!(all.iter().all(|own| *own == all[0]), "{all:#?}");
        assert!(
            all[0].contains("dam.a1, of rank 1 of 3, cannot be read"),
            "{all:#?}"
        );
        let plain = dam_break().resume(&path).expect_err("no part").to_string();
        assert_eq!(plain, all[0]);
        fs::write(&part, whole).expect("a file");
        assert_eq!(said_by_all(resumed), ["well"; 3]);
    });
}

#[test]
fn a_checkpoint_that_cannot_be_written_leaves_the_one_before() {
    watched(|| {
        let folder = Folder::new("blocked");
        let path = folder.0.join("dam");
        let mut plain = dam_break().build().expect("the scene");
        plain.run_until(0.002).expect("a run");
        let before = said(&plain);
        plain.run_until(0.004).expect("a run");
        let after = said(&plain);
        // A folder stands where a file must be: of rank 1, of ranks 2 and 1, of the manifest, and of what the manifest is made in.
        for (blocked, failed) in [
            (&["dam.b1"][..], 1),
            (&["dam.b2.part", "dam.b1"], 1),
            (&["dam.part"], 0),
        ] {
            let all = said_by_all(|ranks| {
                let is_first = ranks.rank() == 0;
                let mut simulation = dam_break().on_ranks(ranks).build().expect("the scene");
                simulation.run_until(0.002).expect("a run");
                if is_first {
                    let _ = fs::remove_file(&path);
                }
                simulation.save(&path).expect("a file");
                if is_first {
                    for name in blocked {
                        fs::create_dir_all(folder.0.join(name).join("full")).expect("a folder");
                    }
                }
                simulation.run_until(0.004).expect("a run");
                let error = simulation.save(&path).expect_err("blocked");
                assert!(
                    matches!(error, Error::Rank { rank, .. } if rank == failed),
                    "{error}"
                );
                // The run goes on after it, and what was written before stands.
                assert!(said(&simulation) == after);
                assert!(said(&dam_break().resume(&path).expect("the one before")) == before);
                simulation.save(folder.0.join("other")).expect("files");
                simulation.step().expect("a step");
                error.to_string()
            });
            assert!(all.iter().all(|own| *own == all[0]), "{all:#?}");
            assert!(all[0].contains(blocked[blocked.len() - 1]), "{all:#?}");
            assert!(said(&dam_break().resume(folder.0.join("other")).expect("files")) == after);
            for name in blocked {
                fs::remove_dir_all(folder.0.join(name)).expect("a folder");
            }
        }
    });
}

#[test]
fn a_file_that_is_no_checkpoint_is_an_error_on_all_ranks() {
    let folder = Folder::new("no-file");
    let file = folder.0.join("file");
    fs::write(&file, b"no checkpoint").expect("a file");
    watched(move || {
        let all = said_by_all(|ranks| {
            let simulation = dam_break()
                .on_ranks(ranks.clone())
                .build()
                .expect("the scene");
            let written = simulation.save(file.join("below")).expect_err("no folder");
            let resumed = dam_break()
                .on_ranks(ranks)
                .resume(&file)
                .expect_err("no checkpoint");
            format!("{written}\n{resumed}")
        });
        assert!(all.iter().all(|own| *own == all[0]), "{all:#?}");
        assert!(
            all[0].starts_with("rank 0 has failed") && all[0].contains("below"),
            "{all:#?}"
        );
        assert!(all[0].contains("cannot resume"), "{all:#?}");
        drop(folder);
    });
}
