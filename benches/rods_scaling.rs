//! Time per particle and step of a rod impact in 1D, from 10⁵ to 10⁷ particles on one and two threads.
//! It must not grow by more than a fifth from 10⁶ to 10⁷: nothing in a step may be worse than linear.
//!
//! `cargo bench --bench rods_scaling [-- LARGEST]`

use meshfree::material::catalogue;
use meshfree::scene::{Body, Scene};
use meshfree::schemes;
use std::time::Instant;

/// Accepted ratio of the times per particle and step at 10⁷ and 10⁶ particles.
const LIMIT: f64 = 1.2;

/// Steps that are timed.
const STEPS: u32 = 20;

/// Nanoseconds per particle and step with list builds among them, the seconds that building the scene
/// took, and the number of list builds.
fn measure(particles: usize, threads: usize) -> (f64, f64, u64) {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("a pool of threads");
    pool.install(|| {
        let length = particles as f64 * 1e-5;
        let (striker, target) = (0.2 * length, 0.8 * length);
        let start = Instant::now();
        let mut simulation = Scene::<f64, 1>::new(schemes::impact())
            .body(
                Body::block("striker", catalogue::copper(), [0.0], [striker], 1e-5)
                    .velocity([200.0]),
            )
            .body(Body::block(
                "target",
                catalogue::aluminium(),
                [striker],
                [striker + target],
                1e-5,
            ))
            .build()
            .expect("a scene that makes sense");
        let built = start.elapsed().as_secs_f64();
        simulation.step().expect("a step");
        // The same number of steps for all, fast enough that lists are built some times on the way.
        let (start, builds) = (Instant::now(), simulation.list_builds());
        for _ in 0..STEPS {
            simulation.step().expect("a step");
        }
        let each = start.elapsed().as_secs_f64() / f64::from(STEPS) / particles as f64;
        (each * 1e9, built, simulation.list_builds() - builds)
    })
}

fn main() {
    // `cargo bench` passes `--bench`, and `cargo test` runs benches without it: then once, small.
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let largest = if arguments.iter().any(|a| a == "--bench") {
        let given = arguments.iter().find_map(|a| a.parse::<f64>().ok());
        given.unwrap_or(1e7) as usize
    } else {
        10_000
    };
    let mut failed = false;
    println!("particles  threads  ns/particle/step  build s  list builds  against a tenth");
    for threads in [1, 2] {
        let mut before = None;
        for particles in [100_000, 1_000_000, 10_000_000] {
            let particles = particles.min(largest);
            let (each, built, builds) = measure(particles, threads);
            let ratio = before.map(|before: f64| each / before);
            let shown = ratio.map_or("-".into(), |ratio| format!("{ratio:.2}"));
            println!(
                "{particles:9}  {threads:7}  {each:16.1}  {built:7.2}  {builds:11}  {shown:>15}"
            );
            failed |= particles == 10_000_000 && ratio.is_some_and(|ratio| ratio > LIMIT);
            if particles >= largest {
                break;
            }
            before = Some(each);
        }
    }
    if failed {
        eprintln!("the time per particle and step grows by more than {LIMIT} from 10^6 to 10^7");
        std::process::exit(1);
    }
}
