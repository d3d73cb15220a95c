//! Speed and memory of liquids in a breaking dam: interactions a second, time by phase, bytes a particle,
//! what each term costs, the composed pair loop against one that is written out by hand, kernels and
//! viscosities of a user's own against those of the crate, and solids beside the liquid.
//!
//! `cargo bench --bench throughput [-- --quick | --solids]`. An interaction is an ordered pair of particles inside
//! of the support, the first of them liquid. Times are medians over steps, ratios medians over pairs of
//! runs that take turns.

#[path = "throughput/by_hand.rs"]
mod by_hand;
#[path = "throughput/lattice.rs"]
mod lattice;
#[path = "throughput/pair_loop.rs"]
mod pair_loop;
#[path = "throughput/solids.rs"]
mod solids;

use meshfree::boundary::Wall;
use meshfree::material::catalogue;
use meshfree::neighbors::Cells;
use meshfree::prelude::*;
use meshfree::scheme::Scheme;
use meshfree::term::Nothing;
use meshfree::term::viscosity::Inviscid;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Bytes on the heap now, and the most since [`PEAK`] was last set: sorting particles and building lists
/// need room for a while.
static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

struct Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

// SAFETY: everything is passed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let held = HELD.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        PEAK.fetch_max(held, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        let held = HELD.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        PEAK.fetch_max(held, Ordering::Relaxed);
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Where it has to move, old and new are held at once.
        let held = HELD.fetch_add(size, Ordering::Relaxed) + size;
        PEAK.fetch_max(held, Ordering::Relaxed);
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

const GRAVITY: f64 = 9.81;

/// What is measured of a run.
struct Measured {
    liquid: usize,
    all: usize,
    pairs: u64,
    step: f64,
    evaluation: f64,
    /// Lists, packing, pairs, walls, materials and integration, each a share of the step.
    shares: [f64; 7],
    bytes: usize,
    /// The most bytes on the heap while the scene was built, particles sorted and lists made.
    peak: usize,
    steps_a_build: f64,
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A dam of about `count` particles that breaks in a tank, after it has fallen for a while.
fn dam<T: Real, const D: usize>(scheme: impl Into<Scheme<T, D>>, count: usize) -> Simulation<T, D> {
    let size: [f64; D] = core::array::from_fn(|d| {
        if d == D - 1 {
            0.56
        } else {
            1.2 - 0.2 * d as f64
        }
    });
    let tank: [f64; D] = core::array::from_fn(|d| if d == D - 1 { 1.0 } else { [3.2, 1.0][d] });
    let dx = (size.iter().product::<f64>() / count as f64).powf(1.0 / D as f64);
    let faces = core::array::from_fn(|d| [true, d < D - 1]);
    let water = catalogue::weakly_compressible_water((2.0 * GRAVITY * 0.56).sqrt());
    let mut down = [0.0; D];
    down[D - 1] = -GRAVITY;
    Scene::new(scheme)
        .body(Body::block("water", water, [0.0; D], size, dx))
        .wall(Wall::around("tank", [0.0; D], tank, dx, 3, faces))
        .acceleration(move |_| down)
        .build()
        .expect("a scene that makes sense")
}

/// Ordered pairs within the support: liquid with liquid, and liquid with walls.
fn count_pairs<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> (u64, usize) {
    let mut positions: Vec<[f64; D]> = simulation.all().map(|p| p.position()).collect();
    let liquid = positions.len();
    positions.extend(simulation.wall_particle_forces().iter().map(|(x, _)| *x));
    let h = simulation
        .body(0)
        .expect("the liquid")
        .next()
        .map_or(0.0, |p| p.smoothing_length());
    let reach = 2.0 * h;
    let points: Vec<u32> = (0..positions.len() as u32).collect();
    let cells = Cells::build(&positions, &points, reach);
    let mut pairs = 0;
    for (i, x) in positions[..liquid].iter().enumerate() {
        cells.for_each_run(x.map(|x| x - reach), x.map(|x| x + reach), |run| {
            for &j in run {
                let y = &positions[j as usize];
                let r2: f64 = (0..D).map(|d| (x[d] - y[d]).powi(2)).sum();
                pairs += u64::from(r2 < reach * reach && j as usize != i);
            }
        });
    }
    (pairs, positions.len())
}

/// Steps in a pool of threads; `fall` \[s\] passes first.
fn measure<T: Real, const D: usize>(
    scheme: impl Into<Scheme<T, D>> + Send,
    count: usize,
    threads: usize,
    fall: f64,
    steps: usize,
) -> Measured {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("a pool of threads");
    pool.install(|| {
        // Building the scene sorts all particles, walls as well; the fall sorts the liquid again.
        let elsewhere = HELD.load(Ordering::Relaxed);
        PEAK.store(elsewhere, Ordering::Relaxed);
        let mut simulation = dam::<T, D>(scheme, count);
        simulation.step().expect("a step");
        simulation
            .run_until(fall.max(simulation.time()))
            .expect("a run");
        simulation.step().expect("a step");
        let peak = PEAK.load(Ordering::Relaxed) - elsewhere;
        let (mut times, mut evaluations) = (Vec::new(), Vec::new());
        let (first, builds) = (simulation.phases(), simulation.list_builds());
        for _ in 0..steps {
            let (start, before) = (Instant::now(), simulation.phases());
            simulation.step().expect("a step");
            times.push(start.elapsed().as_secs_f64());
            evaluations.push(
                simulation
                    .phases()
                    .since(&before)
                    .evaluation()
                    .as_secs_f64(),
            );
        }
        let spent = simulation.phases().since(&first);
        let total = spent.total().as_secs_f64();
        let share = |phase: Duration| phase.as_secs_f64() / total;
        let builds = simulation.list_builds() - builds;
        let bytes = simulation.bytes();
        let (pairs, all) = count_pairs(&simulation);
        Measured {
            liquid: simulation.particles(),
            all,
            pairs,
            // List builds fall into some steps only, so a step costs the mean and not the median.
            step: times.iter().sum::<f64>() / steps as f64,
            evaluation: median(evaluations),
            shares: [
                spent.lists,
                spent.packing,
                spent.pairs,
                spent.work,
                spent.walls,
                spent.materials,
                spent.integration,
            ]
            .map(share),
            bytes,
            peak,
            steps_a_build: steps as f64 / builds.max(1) as f64,
        }
    })
}

fn print_head() {
    println!(
        "| D | scalar | liquid | with walls | threads | neighbours | M/s and thread, evaluation | step | ns a step and liquid particle | lists | packing | pairs | work | walls | materials | integration | bytes a liquid particle | a particle | at the peak | steps a build |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
}

fn print<const D: usize>(name: &str, threads: usize, m: &Measured) {
    let rate = |time: f64| m.pairs as f64 / time / threads as f64 * 1e-6;
    let shares: Vec<String> = m
        .shares
        .iter()
        .map(|share| format!("{:.0} %", 100.0 * share))
        .collect();
    println!(
        "| {D} | {name} | {} | {} | {threads} | {:.1} | {:.0} | {:.0} | {:.0} | {} | {} | {} | {} | {:.1} |",
        m.liquid,
        m.all,
        m.pairs as f64 / m.liquid as f64,
        rate(m.evaluation),
        rate(m.step),
        m.step / m.liquid as f64 * 1e9,
        shares.join(" | "),
        m.bytes / m.liquid,
        m.bytes / m.all,
        m.peak / m.all,
        m.steps_a_build,
    );
}

/// What each term costs: the same scene without it.
fn terms(count: usize, fall: f64, steps: usize) {
    println!("\n| 3D, f64, one thread | ns a step and liquid particle | bytes a liquid particle |");
    println!("|---|---|---|");
    let row = |name: &str, m: Measured| {
        let each = m.step / m.liquid as f64 * 1e9;
        println!("| {name} | {each:.0} | {} |", m.bytes / m.liquid);
    };
    let whole = || schemes::weakly_compressible().h_over_dx(1.3);
    row(
        "all terms",
        measure::<f64, 3>(whole(), count, 1, fall, steps),
    );
    let scheme = whole().density_diffusion(Nothing);
    row(
        "without density diffusion",
        measure::<f64, 3>(scheme, count, 1, fall, steps),
    );
    let scheme = whole().with_viscosity(Inviscid);
    row(
        "without artificial viscosity",
        measure::<f64, 3>(scheme, count, 1, fall, steps),
    );
}

fn main() {
    // `cargo test` runs benches without `--bench`: then small and once.
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let given = |name: &str| arguments.iter().any(|a| a == name);
    let (quick, full) = (given("--quick"), given("--bench"));
    let sizes: &[usize] = match (full, quick) {
        (false, _) => &[2_000],
        (true, true) => &[20_000, 100_000],
        (true, false) => &[20_000, 100_000, 1_000_000],
    };
    let (fall, steps) = if full { (0.05, 30) } else { (0.0, 3) };
    let (side, turns) = if full { (32, 60) } else { (12, 5) };
    pair_loop::table(side, turns);
    solids::table(if full { 32 } else { 10 }, steps);
    if given("--solids") {
        return;
    }
    println!();
    print_head();
    let scheme = || schemes::weakly_compressible().h_over_dx(1.3);
    for &size in sizes {
        // A larger dam takes as many steps to fall as a small one takes to run out.
        let fall = if size > 200_000 { 0.01 } else { fall };
        for threads in [1, 2] {
            print::<3>(
                "f64",
                threads,
                &measure::<f64, 3>(scheme(), size, threads, fall, steps),
            );
            print::<3>(
                "f32",
                threads,
                &measure::<f32, 3>(scheme(), size, threads, fall, steps),
            );
            print::<2>(
                "f64",
                threads,
                &measure::<f64, 2>(scheme(), size, threads, fall, steps),
            );
            print::<2>(
                "f32",
                threads,
                &measure::<f32, 2>(scheme(), size, threads, fall, steps),
            );
        }
    }
    terms(if full { 20_000 } else { 2_000 }, fall, steps);
}
