//! Runs that stop at random moments and go on from their files: they end as the run that did not stop, to the bit.
//! What files hold is compared by name.

use super::bits::said;
use super::readings::read_on_the_way;
use crate::common::Random;
use crate::common::folder::Folder;
use meshfree::prelude::*;
use safetensors::SafeTensors;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// All that a file holds, by name.
pub(super) fn held(path: &Path) -> BTreeMap<String, Vec<u8>> {
    let bytes = fs::read(path).unwrap();
    let file = SafeTensors::deserialize(&bytes).unwrap();
    let columns = file
        .iter()
        .filter(|(name, _)| *name != "checksum")
        .map(|(name, view)| (name.to_string(), view.data().to_vec()));
    let (_, header) = SafeTensors::read_metadata(&bytes).unwrap();
    let texts = header.metadata().clone().unwrap();
    let texts = texts
        .into_iter()
        .map(|(name, text)| (name, text.into_bytes()));
    columns.chain(texts).collect()
}

pub(super) fn assert_same(name: &str, one: &Path, other: &Path) {
    let [one, other] = [one, other].map(held);
    let names = |of: &BTreeMap<String, Vec<u8>>| of.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other), "{name}");
    for (column, bytes) in &one {
        assert!(*bytes == other[column], "{name}: `{column}` differs");
    }
}

/// Moments at which each scene is stopped.
const MOMENTS: usize = 5;

/// Stops a scene at random moments of a run to `end` \[s\], goes on from each, and holds the ends against that of the
/// run which did not stop.
pub(super) fn stop_and_go_on<T: Real, const D: usize>(
    name: &str,
    scene: impl Fn() -> Scene<T, D>,
    keeps_energy: bool,
    end: f64,
) -> Vec<u64> {
    let folder = Folder::new(name);
    let start = || {
        let mut simulation = scene().build().unwrap();
        if keeps_energy {
            simulation.keep_energy();
        }
        simulation
    };
    let mut whole = start();
    whole.run_until(end).unwrap();
    let (last, steps, builds) = (said(&whole), whole.steps(), whole.list_builds());
    assert!((20..400).contains(&steps), "{name}: {steps} steps");
    println!("{name}: {steps} steps, {builds} list builds");
    let at_end = folder.file("end");
    whole.save(&at_end).unwrap();
    drop(whole);
    let mut random = Random(name.bytes().map(u64::from).sum());
    let mut moments: Vec<u64> = Vec::new();
    while moments.len() < MOMENTS {
        let moment = 1 + random.bits() % (steps - 1);
        if !moments.contains(&moment) {
            moments.push(moment);
        }
    }
    let mut watched = start();
    watched
        .run_with(end, |now| {
            if moments.contains(&now.steps()) {
                now.save(folder.file(&now.steps().to_string())).unwrap();
            }
        })
        .unwrap();
    assert!(said(&watched) == last, "{name}: to save changes nothing");
    drop(watched);
    for moment in moments {
        let stopped = folder.file(&moment.to_string());
        let mut resumed = scene().resume(&stopped).unwrap();
        assert_eq!(resumed.steps(), moment);
        let again = folder.file("again");
        resumed.save(&again).unwrap();
        assert_same(name, &stopped, &again);
        resumed.run_until(end).unwrap();
        assert!(said(&resumed) == last, "{name}: stopped after {moment}");
        resumed.save(&again).unwrap();
        assert_same(name, &at_end, &again);
    }
    let resume = |path: &Path| scene().resume(path).unwrap();
    read_on_the_way(name, start, resume, end, &folder.file("read"));
    last
}
