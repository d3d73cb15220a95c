//! A recording of bits: many short scenes, each hashed after its steps, against `bits.txt` beside this file.
//! A change of structure must reproduce them all; a change of results names the scenes that it changes.
//!
//! A line of the recording is a scene, an instruction set, and the hashes of its
//!
//! | hash | of |
//! |---|---|
//! | particles | position, velocity, density, pressure, energy, mass, smoothing length, sound speed, and what the scheme adds |
//! | balances | ledgers, impulses and forces of walls, forces between bodies, what has left |
//! | counts | particles, steps, evaluations, list builds, guards |
//! | history | time, step, sampled particles and probes after each step |
//!
//! The number of lanes depends on the scalar alone, and fused multiplications on the instruction set, so each
//! instruction set has lines of its own. Sines, exponentials and powers are those of the platform: on one whose
//! differ, scenes that call them differ too.

mod hash;
mod scenes;

use hash::Hash;
use meshfree::ranks::{Ranks, in_threads};
use meshfree::scalar::Real;
use meshfree::scene::Scene;
use meshfree::simulation::Simulation;
use meshfree::sweep::{InstructionSet, Root};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;

const PATHS: [(InstructionSet, &str); 3] = [
    (InstructionSet::Baseline, "baseline"),
    (InstructionSet::Avx2, "avx2"),
    (InstructionSet::Avx512, "avx512"),
];
const PARTS: [&str; 4] = ["particles", "balances", "counts", "history"];
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/recording/bits.txt");
const AGAIN: &str = "MESHFREE_RECORD=1 cargo test --test checks recording";

/// The hashes of a run, in the order of [`PARTS`].
type Bits = [u64; 4];
type Run =
    Box<dyn Fn(InstructionSet, Option<Arc<dyn Ranks>>) -> Result<Bits, String> + Send + Sync>;

/// The scenes by name, each with what runs it.
#[derive(Default)]
struct Scenes(Vec<(String, Run)>);

/// What is done to a simulation between its steps, and what is read of it.
struct Plan<T: Real, const D: usize> {
    steps: usize,
    /// Called half-way.
    change: fn(&mut Simulation<T, D>),
    /// Read after every step into the history.
    read: fn(&Simulation<T, D>) -> Vec<f64>,
}

impl Scenes {
    /// Adds a scene that runs for a number of steps, and a last one that is cut short.
    fn add<T: Real, const D: usize>(
        &mut self,
        name: impl Into<String>,
        steps: usize,
        scene: impl Fn() -> Scene<T, D> + Send + Sync + 'static,
    ) {
        let plan = Plan {
            steps,
            change: |_| {},
            read: |_| Vec::new(),
        };
        self.add_with(name, plan, scene);
    }

    fn add_with<T: Real, const D: usize>(
        &mut self,
        name: impl Into<String>,
        plan: Plan<T, D>,
        scene: impl Fn() -> Scene<T, D> + Send + Sync + 'static,
    ) {
        let name = name.into();
        let run = move |set, ranks: Option<Arc<dyn Ranks>>| {
            let scene = scene().instructions(set).root(Root::Products);
            let scene = match ranks {
                Some(ranks) => scene.on_ranks(ranks),
                None => scene,
            };
            run(&plan, scene)
        };
        self.0.push((name, Box::new(run)));
    }
}

fn run<T: Real, const D: usize>(plan: &Plan<T, D>, scene: Scene<T, D>) -> Result<Bits, String> {
    let built = scene.build();
    let mut now = built.map_err(|error| format!("does not build: {error}"))?;
    now.keep_energy();
    let mut history = Hash::new();
    let mut step = 0.0;
    for k in 0..=plan.steps {
        if k == plan.steps / 2 {
            (plan.change)(&mut now);
        }
        // The last step is cut short, as at the end of a run.
        let done = if k < plan.steps {
            now.step()
        } else {
            now.step_at_most(0.375 * step)
        };
        step = done.map_err(|error| format!("stops in step {k}: {error}"))?;
        hash::moment(&mut history, &now);
        history.numbers((plan.read)(&now));
    }
    let all = [
        hash::particles(&now),
        hash::balances(&now),
        hash::counts(&now),
        history,
    ];
    for (hash, part) in all.iter().zip(PARTS) {
        if !hash.finite {
            return Err(format!("has numbers in its {part} that are not finite"));
        }
    }
    Ok(all.map(|hash| hash.value))
}

/// Scene and path of every line, with its hashes.
type Recording = BTreeMap<(String, String), Bits>;

fn parse(text: &str) -> Recording {
    let mut recording = Recording::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [scene, path, hashes @ ..] = words.as_slice() else {
            panic!("not a line of a recording: {line}");
        };
        let hashes: Vec<u64> = hashes
            .iter()
            .map(|hash| u64::from_str_radix(hash, 16).expect(line))
            .collect();
        let key = ((*scene).to_owned(), (*path).to_owned());
        let before = recording.insert(key, hashes.try_into().expect(line));
        assert!(before.is_none(), "recorded twice: {line}");
    }
    recording
}

fn print(recording: &Recording) -> String {
    let mut text = format!(
        "# scene, path, hashes of {}; made anew by {AGAIN}\n",
        PARTS.join(", ")
    );
    for ((scene, path), hashes) in recording {
        write!(text, "{scene} {path}").expect("a string takes all");
        for hash in hashes {
            write!(text, " {hash:016x}").expect("a string takes all");
        }
        text.push('\n');
    }
    text
}

#[test]
fn scenes_have_the_bits_of_the_recording() {
    let Scenes(scenes) = scenes::all();
    let record = std::env::var_os("MESHFREE_RECORD").is_some();
    let mut recording = parse(&std::fs::read_to_string(FILE).unwrap_or_default());
    let known = |scene: &str| scenes.iter().any(|(name, _)| name == scene);
    if record {
        // Paths that this machine lacks keep their lines.
        recording.retain(|(scene, _), _| known(scene));
    }
    let mut wrong = Vec::new();
    for (scene, _) in recording.keys() {
        if !known(scene) {
            wrong.push(format!("{scene} is recorded, and there is no such scene"));
        }
    }
    let mut compared = 0;
    for (set, path) in PATHS {
        if !set.available() {
            println!(
                "skipped: this machine does not have the path {path}, whose lines stay as they are"
            );
            continue;
        }
        let has_lines = recording.keys().any(|(_, own)| own == path);
        if !record && !has_lines && set != InstructionSet::Baseline {
            println!("skipped: nothing is recorded for the path {path}");
            continue;
        }
        for (scene, run) in &scenes {
            compared += 1;
            let key = (scene.clone(), path.to_owned());
            match (run(set, None), recording.get(&key)) {
                (Err(error), _) => wrong.push(format!("{scene} on {path} {error}")),
                (Ok(found), _) if record => {
                    recording.insert(key, found);
                }
                (Ok(_), None) => wrong.push(format!("{scene} on {path} is not recorded")),
                (Ok(found), Some(bits)) if *bits != found => {
                    let parts = PARTS.iter().zip(bits.iter().zip(found));
                    let parts = parts.filter(|(_, (was, is))| *was != is);
                    let parts: Vec<&str> = parts.map(|(part, _)| *part).collect();
                    wrong.push(format!("{scene} on {path}: other {}", parts.join(", ")));
                }
                (Ok(_), Some(_)) => {}
            }
        }
    }
    if record && wrong.is_empty() {
        std::fs::write(FILE, print(&recording)).expect("the recording is written");
        println!("recorded {} scenes in {FILE}", scenes.len());
        return;
    }
    println!("{} scenes, {compared} runs compared", scenes.len());
    assert!(
        wrong.is_empty(),
        "{} of {compared} runs differ from {FILE}:\n  {}\nIf results were meant to change, say which and why, and \
         record them anew: {AGAIN}\nOn a machine whose sines, exponentials or powers are not those of the recording, \
         scenes with them differ; record there before a change, and compare after it.",
        wrong.len(),
        wrong.join("\n  ")
    );
}

#[test]
fn scenes_have_names_of_their_own() {
    let Scenes(scenes) = scenes::all();
    let names: std::collections::HashSet<_> = scenes.iter().map(|(name, _)| name).collect();
    assert_eq!(names.len(), scenes.len());
    assert!(scenes.len() >= 40, "{} scenes", scenes.len());
    assert!(names.iter().all(|name| !name.contains(char::is_whitespace)));
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let on = |threads: usize, run: &Run| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let set = InstructionSet::detect();
        pool.expect("a pool").install(|| run(set, None))
    };
    let Scenes(scenes) = scenes::all();
    let differ: Vec<&str> = scenes
        .iter()
        .filter(|(_, run)| on(1, run) != on(2, run))
        .map(|(name, _)| name.as_str())
        .collect();
    assert!(differ.is_empty(), "threads change the bits of {differ:?}");
}

/// Probes, integrators, openings, structures, contacts and images of all these scenes on ranks.
#[test]
#[ignore = "all scenes on two, three and four ranks: 40 s"]
fn ranks_do_not_change_a_bit() {
    let Scenes(scenes) = scenes::all();
    let set = InstructionSet::detect();
    let mut differ = Vec::new();
    for (name, run) in &scenes {
        let alone = run(set, None);
        for (count, threads) in [(2, 1), (3, 2), (4, 1)] {
            let all = in_threads(count, threads, |ranks| run(set, Some(ranks)));
            if all.expect("threads").iter().any(|own| *own != alone) {
                differ.push(format!("{name} on {count} ranks"));
            }
        }
    }
    assert!(differ.is_empty(), "{differ:#?}");
}
