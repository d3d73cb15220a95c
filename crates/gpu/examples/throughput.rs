//! The breaking dam in space of `cargo bench --bench throughput` on a device: particle steps a second. `crates/gpu/bench.sh` runs it.
//! `cargo run --release -p meshfree-gpu --example throughput -- f32|f64 PARTICLES [SECONDS [cuda|vulkan]]`: how many, and for how long at
//! most. `list` lists adapters; with the feature `cuda`, `sm_90` in the place of the seconds compiles the kernels for such a card.

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

/// The fastest adapter by `cuda`, by `vulkan`, or of all.
fn open(way: &str) -> Result<Device, Box<dyn Error>> {
    let all = Device::list().into_iter();
    let own = all.filter(|own| own.driver.starts_with("CUDA") == (way == "cuda"));
    match own.min_by_key(|own| own.kind != "DiscreteGpu") {
        Some(own) if !way.is_empty() => Ok(Device::named(&own.name)?),
        None if !way.is_empty() => Err(format!("no adapter by {way}").into()),
        _ => Ok(Device::open()?),
    }
}

/// Compiles the kernels for an architecture, to the folder of [`nvrtc::FOLDER`](meshfree_gpu::nvrtc::FOLDER).
#[cfg(feature = "cuda")]
fn compile<T: Real>(count: f64, architecture: &str) -> Result<(), Box<dyn Error>> {
    use meshfree_gpu::{Language, nvrtc, sources};
    for (_, text) in sources(dam::<T>(count)?, Language::Cuda)? {
        nvrtc::code(&text, architecture)?;
    }
    Ok(())
}
#[cfg(not(feature = "cuda"))]
fn compile<T: Real>(_: f64, _: &str) -> Result<(), Box<dyn Error>> {
    Err("built without the feature `cuda`".into())
}

fn measure<T: Real>(
    name: &str,
    count: f64,
    most: Duration,
    way: &str,
) -> Result<(), Box<dyn Error>> {
    let device = open(way)?;
    let start = Instant::now();
    let dam = dam::<T>(count)?;
    // Of every hundredth particle.
    let (mut looked, mut neighbours) = (0_u32, 0_u32);
    for particle in dam.all().step_by(100) {
        looked += 1;
        particle.for_each_neighbor(|_| neighbours += 1);
    }
    let neighbours = f64::from(neighbours) / f64::from(looked);
    let (liquid, walls) = (dam.particles(), dam.wall("tank")?.count());
    let built = start.elapsed().as_secs_f64();
    let mut run = device.load(dam)?;
    for _ in 0..WARM {
        run.step()?;
    }
    let (loaded, before) = (start.elapsed().as_secs_f64(), device.traffic());
    let start = Instant::now();
    let (mut steps, mut builds, mut building) = (0_u32, 0_u32, 0.0);
    while steps < STEPS && start.elapsed() < most {
        let (now, built) = (Instant::now(), run.list_builds());
        run.step()?;
        steps += 1;
        if run.list_builds() > built {
            builds += 1;
            building += now.elapsed().as_secs_f64();
        }
    }
    let (time, after) = (start.elapsed().as_secs_f64(), device.traffic());
    let quiet = (time - building) / f64::from(steps - builds).max(1.0);
    let each = time / f64::from(steps);
    println!(
        "{name}, {liquid} particles of water and {} of walls on {} ({}): {:.3} M particle steps/s ({:.3} M without lists, \
         {:.2} G interactions/s of {neighbours:.0} neighbours), \
         {:.2} ms a step ({:.2}), {builds} list builds in {steps} steps, {:.0} kB a step; scene in {:.1} s, loaded in {:.1} s",
        walls,
        device.adapter().name,
        device.adapter().driver,
        1e-6 * liquid as f64 / each,
        1e-6 * liquid as f64 / quiet,
        1e-9 * liquid as f64 * neighbours / quiet,
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
    if given == ["list"] {
        for own in Device::list() {
            println!("{own:?}");
        }
        return Ok(());
    }
    let [scalar, count, rest @ ..] = &given[..] else {
        return Err("f32 or f64, and a number of particles".into());
    };
    let count: f64 = count.parse()?;
    if let Some(own) = rest.first().filter(|own| own.starts_with("sm_")) {
        return match scalar.as_str() {
            "f32" => compile::<f32>(count, own),
            _ => compile::<f64>(count, own),
        };
    }
    let most = rest.first().map_or(Ok(60.0), |own| own.parse())?;
    let most = Duration::try_from_secs_f64(most)?;
    let way = rest.get(1).map_or("", String::as_str);
    match scalar.as_str() {
        "f32" => measure::<f32>(scalar, count, most, way),
        "f64" => measure::<f64>(scalar, count, most, way),
        other => Err(format!("`{other}` is no scalar: f32 or f64").into()),
    }
}
