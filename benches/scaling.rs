//! Time per particle and step of a 3D liquid, from 10⁴ to 4·10⁶ particles with equal neighbourhoods.
//! From 10⁵ to 4·10⁶ it must not grow by more than a quarter.
//!
//! `cargo bench --bench scaling [-- --quick]`

use meshfree::material::catalogue;
use meshfree::prelude::*;
use meshfree::scene::Start;
use std::time::Instant;

/// Accepted ratio of the times per particle and step at 4·10⁶ and 10⁵ particles.
const LIMIT: f64 = 1.25;

/// Nanoseconds per particle and step of a periodic box, lists built on the way, and bytes per particle.
fn measure(side: usize, steps: usize) -> (f64, usize) {
    let dx = 1.0 / side as f64;
    let water = catalogue::weakly_compressible_water::<f64>(1.0);
    let mut scene = Scene::<f64, 3>::new(schemes::weakly_compressible().h_over_dx(1.3)).body(
        Body::block("water", water, [0.0; 3], [1.0; 3], dx).start(|x, start| {
            let [a, b] = [x[0], x[1]].map(|x| core::f64::consts::TAU * x);
            Start {
                velocity: [a.cos() * b.sin(), -a.sin() * b.cos(), 0.0],
                ..start
            }
        }),
    );
    for d in 0..3 {
        scene = scene.boundary(Periodic::along(d, 0.0, 1.0));
    }
    let mut simulation = scene.build().expect("a scene that makes sense");
    simulation.step().expect("a step");
    let mut best = f64::INFINITY;
    for _ in 0..steps {
        let start = Instant::now();
        simulation.step().expect("a step");
        best = best.min(start.elapsed().as_secs_f64());
    }
    let particles = simulation.particles();
    (
        best / particles as f64 * 1e9,
        simulation.bytes() / particles,
    )
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let given = |name: &str| arguments.iter().any(|a| a == name);
    let sides: &[usize] = match (given("--bench"), given("--quick")) {
        (false, _) => &[12],
        (true, true) => &[22, 46],
        (true, false) => &[22, 46, 100, 159],
    };
    println!(
        "| particles | ns a particle and step, best of ten | bytes a particle |\n|---|---|---|"
    );
    let mut reference = None;
    let mut failed = false;
    for &side in sides {
        let (each, bytes) = measure(side, 10);
        println!("| {} | {each:.0} | {bytes} |", side.pow(3));
        if side == 46 {
            reference = Some(each);
        }
        failed |= side == 159 && reference.is_some_and(|reference| each > LIMIT * reference);
    }
    if failed {
        eprintln!("the time per particle and step grows by more than {LIMIT} from 10^5 to 4·10^6");
        std::process::exit(1);
    }
}
