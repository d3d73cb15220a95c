//! The breaking dam in space of `cargo bench --bench throughput` on a device: particle steps a second. `crates/gpu/bench.sh` runs it.
//! `cargo run --release -p meshfree-gpu --example throughput -- f32|f64 PARTICLES [SECONDS]`: how many, and for how long at most.

use meshfree::prelude::*;
use meshfree_gpu::Device;
use std::error::Error;
use std::time::{Duration, Instant};

const GRAVITY: f64 = 9.81;
/// Steps that no time is taken of: the first builds of lists.
const WARM: usize = 4;
/// Most steps that are measured.
const STEPS: u32 = 200;

fn dam<T: Real>(count: f64) -> Result<Simulation<T, 3>, Box<dyn Error>> {
    let size = [1.2, 1.0, 0.56];
    let dx = (size.iter().product::<f64>() / count).cbrt();
    let water = catalogue::weakly_compressible_water((2.0 * GRAVITY * 0.56).sqrt());
    let faces = [[true, true], [true, true], [true, false]];
    let scene = Scene::<T, 3>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 3], size, dx))
        .wall(Wall::around(
            "tank",
            [0.0; 3],
            [3.2, 1.0, 1.0],
            dx,
            3,
            faces,
        ))
        .acceleration(|_| [0.0, 0.0, -GRAVITY]);
    Ok(scene.build()?)
}

fn measure<T: Real>(name: &str, count: f64, most: Duration) -> Result<(), Box<dyn Error>> {
    let device = Device::open()?;
    let start = Instant::now();
    let dam = dam::<T>(count)?;
    let (liquid, walls) = (dam.particles(), dam.wall("tank")?.count());
    let built = start.elapsed().as_secs_f64();
    let mut run = device.load(dam)?;
    for _ in 0..WARM {
        run.step()?;
    }
    let (loaded, before) = (start.elapsed().as_secs_f64(), device.traffic());
    let start = Instant::now();
    // Steps in which the host builds lists are those that send most.
    let (mut steps, mut builds, mut building) = (0_u32, 0_u32, 0.0);
    while steps < STEPS && start.elapsed() < most {
        let (now, sent) = (Instant::now(), device.traffic().sent);
        run.step()?;
        steps += 1;
        if device.traffic().sent - sent > 8 * liquid as u64 {
            builds += 1;
            building += now.elapsed().as_secs_f64();
        }
    }
    let (time, after) = (start.elapsed().as_secs_f64(), device.traffic());
    let quiet = (time - building) / f64::from(steps - builds).max(1.0);
    let each = time / f64::from(steps);
    println!(
        "{name}, {liquid} particles of water and {} of walls on {}: {:.3} M particle steps/s ({:.3} M without lists), \
         {:.2} ms a step ({:.2}), {builds} list builds in {steps} steps, {:.0} kB a step; scene in {:.1} s, loaded in {:.1} s",
        walls,
        device.adapter().name,
        1e-6 * liquid as f64 / each,
        1e-6 * liquid as f64 / quiet,
        1e3 * each,
        1e3 * quiet,
        1e-3 * (after.sent + after.received - before.sent - before.received) as f64
            / f64::from(steps),
        built,
        loaded - built,
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let [scalar, count, rest @ ..] = &given[..] else {
        return Err("f32 or f64, and a number of particles".into());
    };
    let count: f64 = count.parse()?;
    let most = rest.first().map_or(Ok(60.0), |own| own.parse())?;
    let most = Duration::try_from_secs_f64(most)?;
    match scalar.as_str() {
        "f32" => measure::<f32>(scalar, count, most),
        "f64" => measure::<f64>(scalar, count, most),
        other => Err(format!("`{other}` is no scalar: f32 or f64").into()),
    }
}
