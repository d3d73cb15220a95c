//! Whole steps of a column of water in space on one process and on more, in turns, with one thread each: medians and their ratio.
//! `cargo bench -p meshfree-mpi --bench speed [-- PARTICLES ROUNDS RANKS]`; it starts itself under `mpirun`.

use meshfree::boundary::Wall;
use meshfree::prelude::*;
use meshfree_mpi::World;
use std::error::Error;
use std::process::{Command, ExitCode};
use std::time::Instant;

/// Particles of water in processes that `mpirun` starts.
const COUNT: &str = "MESHFREE_MPI_SPEED";
/// About how many steps are timed, after the first list build.
const STEPS: u64 = 60;

fn main() -> ExitCode {
    let ended = match std::env::var(COUNT) {
        Ok(count) => timed(&count),
        Err(_) => compare(),
    };
    if let Err(error) = &ended {
        eprintln!("{error}");
    }
    ExitCode::from(u8::from(ended.is_err()))
}

/// A column twice as long as high and deep, in a closed tank, which moves so that lists are built every fifteen steps.
fn scene(count: f64) -> Scene<f64, 3> {
    let dx = (2.0 / count).cbrt();
    let water = catalogue::weakly_compressible_water(2.0 * 9.81_f64.sqrt());
    let column =
        Body::block("water", water, [0.0; 3], [2.0, 1.0, 1.0], dx).velocity([1.0, 0.0, 0.0]);
    let closed = [[true; 2]; 3];
    Scene::new(schemes::weakly_compressible())
        .body(column)
        .wall(Wall::around(
            "tank",
            [0.0; 3],
            [2.5, 1.0, 1.5],
            dx,
            4,
            closed,
        ))
        .acceleration(|_| [0.0, 0.0, -9.81])
}

/// The most memory that all processes have held together \[MB\]; zero where the system does not say.
fn most_memory(world: &World) -> Result<f64, Box<dyn Error>> {
    let said = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = said.lines().find_map(|own| own.strip_prefix("VmHWM:"));
    let own = line.and_then(|own| own.split_whitespace().next()?.parse::<u64>().ok());
    let (ranks, own) = (world.ranks(), own.unwrap_or(0).to_ne_bytes());
    let mut all = vec![[0; 8]; ranks.count()];
    let counts = vec![own.len(); ranks.count()];
    let gathered = ranks.gather(&own, &counts, all.as_flattened_mut());
    gathered.map_err(|why| why.to_string())?;
    Ok(all.into_iter().map(u64::from_ne_bytes).sum::<u64>() as f64 / 1e3)
}

/// Times steps, and prints seconds a step, bytes that the first rank got a step, memory before anything is read, and the bits of all.
fn timed(count: &str) -> Result<(), Box<dyn Error>> {
    let world = World::init()?;
    let scene = scene(count.parse()?).on_ranks(world.ranks());
    let mut simulation = scene.build()?;
    simulation.run_until(5e-4)?;
    let step = simulation.last_vote().ok_or("no step was taken")?.step;
    let (steps, builds) = (simulation.steps(), simulation.list_builds());
    let before = simulation.traffic();
    let begun = Instant::now();
    simulation.run_until(simulation.time() + STEPS as f64 * step)?;
    let taken = begun.elapsed().as_secs_f64();
    let steps = (simulation.steps() - steps) as f64;
    let memory = most_memory(&world)?;
    if !simulation.is_first_rank() {
        return Ok(());
    }
    let [got, waited] = simulation
        .traffic()
        .zip(before)
        .map_or([0.0; 2], |(now, own)| {
            let waited = now.waited.as_secs_f64() - own.waited.as_secs_f64();
            [(now.received - own.received) as f64 / steps, waited / steps]
        });
    println!(
        "{} {steps} {} {got} {waited} {memory} {:016x}",
        taken / steps,
        simulation.list_builds() - builds,
        simulation.bits_hash()
    );
    Ok(())
}

/// Starts both in turns.
fn compare() -> Result<(), Box<dyn Error>> {
    let numbers: Vec<usize> = std::env::args()
        .filter_map(|own| own.parse().ok())
        .collect();
    let [count, rounds, ranks] = [1_000_000, 3, 2];
    let count = numbers.first().copied().unwrap_or(count);
    let rounds = numbers.get(1).copied().unwrap_or(rounds);
    let ranks = numbers.get(2).copied().unwrap_or(ranks);
    let program = std::env::current_exe()?;
    let mut times = [Vec::new(), Vec::new()];
    let mut bits: Option<String> = None;
    for _ in 0..rounds {
        for (own, ranks) in times.iter_mut().zip([1, ranks]) {
            let run = Command::new("mpirun")
                .args(["-n", &ranks.to_string()])
                .arg(&program)
                .env(COUNT, count.to_string())
                .env("RAYON_NUM_THREADS", "1")
                .output()?;
            let said = String::from_utf8_lossy(&run.stdout);
            let words: Vec<&str> = said.split_whitespace().collect();
            let [step, steps, builds, got, waited, memory, hash] = words[..] else {
                let why = String::from_utf8_lossy(&run.stderr);
                return Err(format!("no times of {ranks} ranks: {said}{why}").into());
            };
            println!(
                "{ranks} ranks: {:.4} s a step, {steps} steps, {builds} list builds; {:.0} kB and {:.4} s of messages and waiting a step; {:.0} MB at most",
                step.parse::<f64>()?,
                got.parse::<f64>()? / 1e3,
                waited.parse::<f64>()?,
                memory.parse::<f64>()?,
            );
            own.push(step.parse::<f64>()?);
            if bits.get_or_insert(hash.to_owned()).as_str() != hash {
                return Err(format!("{ranks} ranks have other bits").into());
            }
        }
    }
    let [one, more] = times.map(|mut own| {
        own.sort_by(f64::total_cmp);
        own[own.len() / 2]
    });
    println!(
        "{count} particles, medians of {rounds}: {one:.4} s on one, {more:.4} s on {ranks}: {:.2} times as fast, the same bits",
        one / more
    );
    Ok(())
}
