//! What a run will cost, predicted before it runs, against what it came to, for ten scenes that nothing was calibrated on.
//! It names those whose memory is more than 5 % off or whose pairs are more than 10 %, which no machine changes; time is
//! printed.
//!
//! `cargo bench --bench cost_model [-- --quick]`

use meshfree::material::catalogue;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::study::cost_model::CostModel;
use std::f64::consts::TAU;
use std::time::Instant;

/// Seconds that this thread had a processor for, or that passed where the system does not tell.
fn processor(begin: Instant) -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let first = text.split_whitespace().next();
    let nanoseconds = first.and_then(|own| own.parse::<f64>().ok());
    nanoseconds.map_or_else(|| begin.elapsed().as_secs_f64(), |own| 1e-9 * own)
}

/// A copper rod of 10 mm that strikes one of another material, at a spacing \[m\].
fn rods(dx: f64, other: Material<f64>) -> Simulation<f64, 1> {
    let moving = Body::block("moving", catalogue::copper(), [0.0], [0.01], dx).velocity([20.0]);
    Scene::new(schemes::impact())
        .body(moving)
        .body(Body::block("resting", other, [0.01], [0.03], dx))
        .build()
        .expect("rods")
}

/// A copper bar of 20 mm by 5 mm that strikes a wall.
fn bar(dx: f64, speed: f64) -> Simulation<f64, 2> {
    let copper = catalogue::copper();
    Scene::new(schemes::impact())
        .body(Body::block("bar", copper, [0.0; 2], [0.02, 0.005], dx).velocity([speed, 0.0]))
        .boundary(MirrorPlane::wall([0.02, 0.0], [1.0, 0.0]))
        .build()
        .expect("a bar")
}

/// Sod's shock tube, with so many particles.
fn tube(count: u32) -> Simulation<f64, 1> {
    let gas =
        meshfree::material::Material::new("gas", meshfree::material::eos::IdealGas::new(1.4, 1.0));
    let dx = 1.0 / f64::from(count);
    let left = Body::block("left", gas.clone(), [0.0], [0.5], dx).energy(2.5);
    let right = Body::block("right", gas, [0.5], [1.0], dx)
        .density(0.25)
        .energy(1.8);
    Scene::new(schemes::gas())
        .body(left)
        .body(right)
        .boundary(MirrorPlane::wall([0.0], [-1.0]))
        .boundary(MirrorPlane::wall([1.0], [1.0]))
        .build()
        .expect("a tube")
}

/// Water of 1 m depth and some width in a tank of 2 m, which falls if that is less.
fn dam(dx: f64, width: f64) -> Simulation<f64, 2> {
    let water = catalogue::weakly_compressible_water(5.0);
    let gravity = [0.0, -9.81];
    let body = Body::block("water", water, [0.0; 2], [width, 1.0], dx);
    let walls = [[true, true], [true, false]];
    Scene::new(schemes::weakly_compressible())
        .body(body.hydrostatic(gravity, [0.0, 1.0]))
        .wall(Wall::around("tank", [0.0; 2], [2.0, 1.5], dx, 3, walls))
        .acceleration(move |_| gravity)
        .build()
        .expect("a tank")
}

/// Vortices in a periodic square or cube of so many particles along.
fn vortices<const D: usize>(scheme: Scheme<f64, D>, side: u32) -> Simulation<f64, D> {
    let water = catalogue::weakly_compressible_water(1.0);
    let dx = 1.0 / f64::from(side);
    let body = Body::block("water", water, [0.0; D], [1.0; D], dx).start(|x, start| {
        let [a, b] = [x[0], x[1]].map(|x| TAU * x);
        let mut velocity = [0.0; D];
        velocity[0] = a.cos() * b.sin();
        velocity[1] = -a.sin() * b.cos();
        Start { velocity, ..start }
    });
    let mut scene = Scene::new(scheme).body(body);
    for d in 0..D {
        scene = scene.boundary(Periodic::along(d, 0.0, 1.0));
    }
    scene.build().expect("vortices")
}

/// Water of so many particles along that falls in a corner.
fn falls(side: u32) -> Simulation<f64, 3> {
    let water = catalogue::weakly_compressible_water(5.0);
    let dx = 1.0 / f64::from(side);
    let body = Body::block("water", water, [0.0; 3], [1.0; 3], dx);
    let walls = [[true, true], [true, true], [true, false]];
    Scene::new(schemes::weakly_compressible())
        .body(body.hydrostatic([0.0, 0.0, -9.81], [0.0, 0.0, 1.0]))
        .wall(Wall::around(
            "tank",
            [0.0; 3],
            [2.0, 1.0, 1.5],
            dx,
            3,
            walls,
        ))
        .acceleration(|_| [0.0, 0.0, -9.81])
        .build()
        .expect("a tank")
}

/// What is held against what.
struct Table {
    model: CostModel,
    off: Vec<String>,
}

impl Table {
    fn row<const D: usize>(&mut self, name: &str, mut scene: Simulation<f64, D>, end: f64) {
        let begin = Instant::now();
        let clock = processor(begin);
        let predicted = self.model.predict(&mut scene, end).expect("a prediction");
        // The share of the processor that the prediction had: the rest was for other programs.
        let had = (processor(begin) - clock) / begin.elapsed().as_secs_f64();
        let (before, clock) = (scene.work(), processor(begin));
        scene.run_until(end).expect("a run");
        let (after, took) = (scene.work(), processor(begin) - clock);
        let pairs = predicted.pairs / (after.pairs - before.pairs) as f64;
        let bytes = predicted.bytes as f64 / after.bytes as f64;
        println!(
            "| {name} | {} | {} | {:.3} | {pairs:.3} | {bytes:.3} | {took:.2} | {:.2} |",
            after.particles,
            after.steps,
            predicted.steps / after.steps as f64,
            predicted.seconds * had / took,
        );
        if (pairs - 1.0).abs() > 0.1 || (bytes - 1.0).abs() > 0.05 {
            self.off.push(name.into());
        }
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let given = |name: &str| arguments.iter().any(|a| a == name);
    // Under `cargo test --benches` one scene will do.
    let (full, one) = (given("--bench") && !given("--quick"), !given("--bench"));
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a pool of threads");
    let off = pool.install(|| {
        println!(
            "| scene | particles | steps | steps, predicted over run | pairs | memory | processor [s] | time, predicted over \
             run |\n|---|---|---|---|---|---|---|---|"
        );
        let mut table = Table {
            model: CostModel::new(),
            off: Vec::new(),
        };
        table.row("1D rods, copper on copper", rods(2.5e-5, catalogue::copper()), 3e-6);
        if one {
            return table.off;
        }
        table.row("1D rods, copper on PMMA", rods(5e-6, catalogue::pmma()), 1e-6);
        if full {
            table.row("1D rods, copper on PMMA", rods(2.5e-7, catalogue::pmma()), 1e-8);
        }
        table.row("1D shock tube", tube(2000), 0.1);
        table.row("2D bar on a wall", bar(6.25e-5, 50.0), 2e-6);
        table.row("2D tank at rest", dam(0.02, 2.0), 0.5);
        table.row("2D dam break", dam(0.02, 0.5), 0.5);
        let side = if full { 300 } else { 150 };
        table.row("2D vortices", vortices::<2>(schemes::weakly_compressible().compose(), side), 0.01);
        table.row("3D dam break", falls(if full { 40 } else { 16 }), 0.05);
        if full {
            table.row("3D vortices", vortices::<3>(schemes::weakly_compressible().compose(), 100), 0.004);
        }
        table.off
    });
    if !off.is_empty() {
        println!("memory beyond 5 % or pairs beyond 10 %: {}", off.join(", "));
    }
}
