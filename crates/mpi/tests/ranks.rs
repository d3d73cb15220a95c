//! Scenes on processes: this program starts itself under `mpirun` on 1, 2, 3 and 4 ranks, whose bits must be those of a plain
//! run. Without `mpirun` the tests skip, and say so.

use meshfree::material::Material;
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::ranks::Ranks;
use meshfree::scene::Start;
use meshfree_mpi::World;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

type Outcome = Result<String, Box<dyn Error>>;
type Test = fn(&World) -> Outcome;

/// What is run on processes, by name.
const TESTS: [(&str, Test); 7] = [
    ("dam_break", |world| {
        Ok(format!(
            "{:016x}",
            moved(dam_break().on_ranks(world.ranks()), 300)?
        ))
    }),
    ("periodic_gas", |world| {
        Ok(format!(
            "{:016x}",
            moved(gas().on_ranks(world.ranks()), 20)?
        ))
    }),
    ("dam_in_parts", |world| {
        Ok(format!(
            "{:016x}",
            run_in_parts(dam_break().on_ranks(world.ranks()), 300.0)?
        ))
    }),
    ("one_reads_alone", |world| one_reads_alone(world.ranks())),
    ("restart", |world| restart(world.ranks())),
    ("error_of_one", |world| error_of_one(world.ranks())),
    ("long_messages", long_messages),
];

/// Set in processes that `mpirun` starts: the test.
const TEST: &str = "MESHFREE_MPI_TEST";

fn dam_break() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(4.0);
    let open = [[true; 2], [true, false]];
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.8, 0.4], 0.01))
        .wall(meshfree::boundary::Wall::around(
            "tank",
            [0.0; 2],
            [1.2, 0.6],
            0.01,
            4,
            open,
        ))
        .acceleration(|_| [0.0, -9.81])
}

fn gas() -> Scene<f64, 2> {
    let gas = IdealGas::new(1.4, 1.0);
    let square = Body::block("gas", Material::new("gas", gas), [0.0; 2], [1.0; 2], 0.02);
    let start = move |x: [f64; 2], start: Start<2>| Start {
        velocity: [2.0 + (6.0 * x[1]).sin(), (6.0 * x[0]).sin()],
        energy: gas.energy(1.0, 1.0),
        ..start
    };
    Scene::new(schemes::gas())
        .body(square.start(start))
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
}

/// A hash of the state after so many steps.
fn moved(scene: Scene<f64, 2>, steps: usize) -> Result<u64, Box<dyn Error>> {
    let mut simulation = scene.build()?;
    for _ in 0..steps {
        simulation.step()?;
    }
    assert!(simulation.list_builds() >= 5);
    Ok(simulation.bits_hash())
}

/// A hash of the state after about so many steps, and readings on the way, of ranks that step their own particles.
fn run_in_parts(scene: Scene<f64, 2>, steps: f64) -> Result<u64, Box<dyn Error>> {
    let mut simulation = scene.build()?;
    let end = steps * simulation.step()?;
    for share in [0.2, 0.201, 0.7, 1.0] {
        simulation.run_until(share * end)?;
    }
    assert!(simulation.list_builds() >= 5);
    assert!(simulation.traffic().is_none_or(|own| own.exchanged > 100));
    Ok(simulation.bits_hash())
}

/// The last rank reads alone on the way, while the others go on, and the first one at the end, while the others end.
fn one_reads_alone(ranks: Arc<dyn Ranks>) -> Outcome {
    let (rank, last) = (ranks.rank(), ranks.count() - 1);
    let mut simulation = dam_break().on_ranks(ranks).build()?;
    simulation.run_until(0.008)?;
    if rank == last {
        let mut plain = dam_break().build()?;
        plain.run_until(0.008)?;
        assert_eq!(simulation.bits_hash(), plain.bits_hash());
    }
    simulation.run_until(0.015)?;
    if rank > 0 {
        return Ok(String::new());
    }
    Ok(format!("{:016x}", simulation.bits_hash()))
}

/// A folder that all processes of a test know.
fn folder() -> PathBuf {
    std::env::temp_dir().join("meshfree-mpi-tests")
}

/// Resumes from what three ranks have written.
fn restart(ranks: Arc<dyn Ranks>) -> Outcome {
    let path = folder().join("dam");
    if std::env::var_os("MESHFREE_MPI_WRITE").is_some() {
        let mut simulation = dam_break().on_ranks(ranks).build()?;
        for _ in 0..40 {
            simulation.step()?;
        }
        simulation.save(&path)?;
        return Ok("written".into());
    }
    Ok(format!(
        "{:016x}",
        gone_on(dam_break().on_ranks(ranks), &path)?
    ))
}

fn gone_on(scene: Scene<f64, 2>, path: &Path) -> Result<u64, Box<dyn Error>> {
    let mut simulation = scene.resume(path)?;
    for _ in 0..40 {
        simulation.step()?;
    }
    Ok(simulation.bits_hash())
}

/// The last rank has a load that fails; all end, and name it.
fn error_of_one(ranks: Arc<dyn Ranks>) -> Outcome {
    let (rank, last) = (ranks.rank(), ranks.count() - 1);
    let load = Load::acceleration(move |at| {
        [
            if rank == last && at.time > 0.002 {
                f64::NAN
            } else {
                0.0
            },
            0.0,
        ]
    });
    let mut simulation = dam_break().load(load).on_ranks(ranks).build()?;
    let failed = simulation
        .run_until(0.01)
        .expect_err("a load that fails")
        .to_string();
    assert!(failed.contains("the load"), "{failed}");
    assert_eq!(
        rank != last,
        failed.starts_with(&format!("rank {last} has failed")),
        "{failed}"
    );
    Ok("ended".into())
}

/// Messages longer than MPI takes at once, which are here of seven bytes.
fn long_messages(world: &World) -> Outcome {
    let short = meshfree_mpi::in_pieces(world, 7);
    let counts: Vec<usize> = (0..short.count()).map(|rank| 5 * rank + 9).collect();
    let part = |rank: usize| (0..counts[rank]).map(move |k| (31 * rank + k) as u8);
    let own: Vec<u8> = part(short.rank()).collect();
    let all: Vec<u8> = (0..short.count()).flat_map(part).collect();
    for ranks in [world.ranks(), short] {
        let mut got = vec![0; all.len()];
        ranks
            .gather(&own, &counts, &mut got)
            .map_err(|why| why.to_string())?;
        assert_eq!(got, all);
        // Rank r has r + 1 bytes for each of the others.
        let (rank, count) = (ranks.rank(), ranks.count());
        let to: Vec<usize> = (0..count)
            .map(|other| usize::from(other != rank) * (rank + 1))
            .collect();
        let from: Vec<usize> = (0..count)
            .map(|other| usize::from(other != rank) * (other + 1))
            .collect();
        let meant = |from: usize, to: usize| vec![(10 * from + to) as u8; from + 1];
        let others = || (0..count).filter(|other| *other != rank);
        let own: Vec<u8> = others().flat_map(|other| meant(rank, other)).collect();
        let mut come = vec![0; from.iter().sum()];
        ranks
            .exchange(&own, &to, &mut come, &from)
            .map_err(|why| why.to_string())?;
        let expected: Vec<u8> = others().flat_map(|other| meant(other, rank)).collect();
        assert_eq!(come, expected);
    }
    Ok("gathered".into())
}

/// What a test says on so many processes, within five minutes.
fn on_processes(test: &str, ranks: usize, write: bool) -> Result<String, String> {
    let own = std::env::current_exe().map_err(|why| why.to_string())?;
    let mut run = Command::new("mpirun");
    // Open MPI wants to be asked for as root, and for more ranks than cores; MPICH does not look.
    run.env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_rmaps_base_oversubscribe", "1")
        .env("RAYON_NUM_THREADS", "1")
        .env(TEST, test);
    if write {
        run.env("MESHFREE_MPI_WRITE", "1");
    }
    run.args(["-n", &ranks.to_string()]).arg(own);
    let spawned = run
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut running = spawned.map_err(|why| why.to_string())?;
    let start = Instant::now();
    loop {
        match running.try_wait().map_err(|why| why.to_string())? {
            Some(_) => break,
            None if start.elapsed() > Duration::from_secs(300) => {
                let _ = running.kill();
                return Err("the processes hang".into());
            }
            None => std::thread::sleep(Duration::from_millis(20)),
        }
    }
    let output = running.wait_with_output().map_err(|why| why.to_string())?;
    let [said, wrong] =
        [output.stdout, output.stderr].map(|own| String::from_utf8_lossy(&own).into_owned());
    if output.status.success() {
        Ok(said.trim().into())
    } else {
        Err(format!("{said}{wrong}"))
    }
}

/// A test on 1 to 4 ranks, against what a plain run says.
fn check(test: &str) -> Result<(), String> {
    let error = |why: Box<dyn Error>| why.to_string();
    let expected = match test {
        "dam_break" => format!("{:016x}", moved(dam_break(), 300).map_err(error)?),
        "periodic_gas" => format!("{:016x}", moved(gas(), 20).map_err(error)?),
        "dam_in_parts" => format!("{:016x}", run_in_parts(dam_break(), 300.0).map_err(error)?),
        "one_reads_alone" => {
            let mut plain = dam_break().build().map_err(|why| why.to_string())?;
            plain.run_until(0.015).map_err(|why| why.to_string())?;
            format!("{:016x}", plain.bits_hash())
        }
        "restart" => {
            on_processes(test, 3, true)?;
            format!(
                "{:016x}",
                gone_on(dam_break(), &folder().join("dam")).map_err(error)?
            )
        }
        "error_of_one" => "ended".into(),
        _ => "gathered".into(),
    };
    for ranks in 1..=4 {
        let said = on_processes(test, ranks, false)?;
        if said != expected {
            return Err(format!(
                "{ranks} ranks say `{said}`, and a plain run `{expected}`"
            ));
        }
    }
    Ok(())
}

fn main() {
    if let Ok(test) = std::env::var(TEST) {
        let world = World::init().expect("MPI");
        let run = TESTS.iter().find(|own| own.0 == test).expect("a test");
        let said = run.1(&world).expect("a run");
        if world.ranks().rank() == 0 {
            println!("{said}");
        }
        return;
    }
    let wanted: Vec<String> = std::env::args()
        .skip(1)
        .filter(|own| !own.starts_with('-'))
        .collect();
    let is_wanted =
        |name: &str| wanted.is_empty() || wanted.iter().any(|own| name.contains(own.as_str()));
    let there = Command::new("mpirun").arg("--version").output().is_ok();
    let (mut passed, mut failed) = (0, Vec::new());
    for (name, _) in TESTS.iter().filter(|own| is_wanted(own.0)) {
        if !there {
            println!("test {name} ... skipped: there is no mpirun");
            continue;
        }
        match check(name) {
            Ok(()) => {
                passed += 1;
                println!("test {name} ... ok");
            }
            Err(why) => {
                println!("test {name} ... FAILED: {why}");
                failed.push(*name);
            }
        }
    }
    let _ = std::fs::remove_dir_all(folder());
    println!(
        "test result: {passed} passed on 1 to 4 ranks; {} failed {failed:?}",
        failed.len()
    );
    std::process::exit(i32::from(!failed.is_empty()));
}
