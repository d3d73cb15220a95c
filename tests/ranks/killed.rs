//! Ranks that are killed at random moments while they save: whatever they have told to be written is there, to the bit.
//! Each victim goes on from what the one before has left, on another number of ranks.

use super::bits::said;
use crate::common::Random;
use crate::common::folder::Folder;
use meshfree::prelude::*;
use meshfree::ranks;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const KILLS: usize = 50;
/// Steps of the run, of which each victim takes some.
const STEPS: u64 = 20_000;
/// What a victim is told: where its files are, and its number of ranks.
const VICTIM: &str = "MESHFREE_RANKS_VICTIM";

/// Water that falls in a corner: rows enough for every rank.
fn scene() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(4.0);
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.2, 0.1], 0.01).velocity([-0.5, 0.0]))
        .boundary(MirrorPlane::wall([0.0; 2], [-1.0, 0.0]))
        .boundary(MirrorPlane::wall([0.0; 2], [0.0, -1.0]))
        .acceleration(|_| [0.0, -9.81])
}

/// Saves after every step, and tells when that is done.
fn run(folder: &Path, count: usize) -> Result<(), Error> {
    let path = folder.join("run");
    let all = ranks::in_threads(count, 1, |ranks| -> Result<(), Error> {
        let scene = scene().on_ranks(ranks);
        let mut simulation = if path.exists() {
            scene.resume(&path)?
        } else {
            scene.build()?
        };
        while simulation.steps() < STEPS {
            simulation.step()?;
            simulation.save(&path)?;
            if simulation.is_first_rank() {
                let mut told = OpenOptions::new();
                let told = told.append(true).create(true).open(folder.join("told"));
                told.and_then(|mut told| writeln!(told, "{}", simulation.steps()))
                    .expect("a line");
            }
        }
        Ok(())
    })?;
    all.into_iter().collect()
}

/// The last step that was told to be written.
fn told(folder: &Path) -> u64 {
    let text = fs::read_to_string(folder.join("told")).unwrap_or_default();
    // A line that a kill has cut counts not.
    let whole = text.rsplit_once('\n').map_or("", |(whole, _)| whole);
    whole
        .lines()
        .last()
        .map_or(0, |line| line.parse().expect("a step"))
}

/// A victim, which is killed with all of its ranks however the test ends.
struct Victim(Child);

impl Drop for Victim {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn victim(folder: &Path, count: usize) -> Victim {
    let mut own = Command::new(std::env::current_exe().expect("this program"));
    own.args([
        "--exact",
        "ranks::killed::fifty_kills_lose_nothing_that_was_written",
    ])
    .env(VICTIM, folder)
    .env("MESHFREE_RANKS_COUNT", count.to_string())
    .stdout(Stdio::null())
    .stderr(Stdio::null());
    Victim(own.spawn().expect("a victim"))
}

#[test]
fn fifty_kills_lose_nothing_that_was_written() {
    if let Some(folder) = std::env::var_os(VICTIM) {
        let count = std::env::var("MESHFREE_RANKS_COUNT").expect("a number of ranks");
        run(Path::new(&folder), count.parse().expect("a number")).expect("a run");
        return;
    }
    // What a run without ranks and kills is after each of its steps.
    let mut plain = scene().build().expect("the scene");
    let mut hashes = vec![plain.bits_hash()];
    let folder = Folder::new("killed-ranks");
    let mut random = Random(29);
    let (mut killed, mut before, mut beyond) = (0, 0, 0);
    while killed < KILLS {
        let mut own = victim(&folder.0, 2 + killed % 3);
        let begin = Instant::now();
        while told(&folder.0) <= before {
            assert!(
                begin.elapsed() < Duration::from_secs(60),
                "nothing is saved"
            );
            assert!(
                own.0.try_wait().expect("a victim").is_none(),
                "a victim that ends by itself"
            );
            std::thread::sleep(Duration::from_micros(200));
        }
        std::thread::sleep(Duration::from_micros(random.bits() % 30_000));
        drop(own);
        killed += 1;
        before = told(&folder.0);
        let resumed = scene().resume(folder.0.join("run")).expect("a checkpoint");
        let steps = resumed.steps();
        assert!(
            (before..=before + 1).contains(&steps),
            "{before} steps were told to be written, and {steps} are there"
        );
        beyond += u32::from(steps > before);
        while plain.steps() < steps {
            plain.step().expect("a step");
            hashes.push(plain.bits_hash());
        }
        assert_eq!(
            resumed.bits_hash(),
            hashes[steps as usize],
            "killed after {steps}"
        );
        // Parts of one checkpoint, and at most those of the next.
        let files = fs::read_dir(&folder.0).expect("a folder").count();
        assert!(files <= 2 + 2 * 4 + 4 + 1, "{files} files");
        assert!(steps + 50 < STEPS, "a victim may end by itself");
    }
    let mut resumed = scene().resume(folder.0.join("run")).expect("a checkpoint");
    while plain.steps() < resumed.steps() + 20 {
        plain.step().expect("a step");
    }
    while resumed.steps() < plain.steps() {
        resumed.step().expect("a step");
    }
    assert!(said(&resumed) == said(&plain), "after {KILLS} kills");
    println!("{beyond} of {KILLS} were killed after the manifest and before it was told");
}
