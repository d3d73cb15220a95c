//! A column of water that collapses in a tank, on a device and on the CPU, with a picture of both in out/.
//! `cargo run --release -p meshfree-gpu --example dam_break -- [SPACING]`, in metres; 0.0125 if not given.

use meshfree::output::picture::Picture;
use meshfree::output::svg::{Axis, Color};
use meshfree::prelude::*;
use meshfree_gpu::Device;
use std::time::Instant;

const WIDTH: f64 = 0.6;
const HEIGHT: f64 = 0.3;
const END: f64 = 0.25;

fn scene(spacing: f64) -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water((2.0 * 9.81 * HEIGHT).sqrt());
    let closed = [[true, true], [true, false]];
    Scene::new(schemes::weakly_compressible())
        .body(Body::block(
            "water",
            water,
            [0.0; 2],
            [0.25, HEIGHT],
            spacing,
        ))
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [WIDTH, WIDTH],
            spacing,
            3,
            closed,
        ))
        .acceleration(|_| [0.0, -9.81])
}

/// Particles coloured by speed, in a tank that begins `left` \[m\] from the origin.
fn draw(picture: Picture, simulation: &Simulation<f64, 2>, spacing: f64, left: f64) -> Picture {
    let place = |[x, y]: [f64; 2]| [x + left, y];
    let water = simulation.all().map(|particle| {
        let [u, v] = particle.velocity();
        (place(particle.position()), u.hypot(v))
    });
    let wall = simulation.wall("tank").into_iter().flatten();
    let wall = wall.map(|particle| place(particle.position()));
    picture
        .particles(Axis::linear("speed", "m/s").range(0.0, 2.5), spacing, water)
        .plain(Color(130, 130, 130), 1.0, spacing, wall)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let spacing = std::env::args()
        .nth(1)
        .map_or(Ok(0.0125), |text| text.parse())?;
    let device = Device::open()?;
    let adapter = device.adapter();
    println!("{} ({}, {})", adapter.name, adapter.kind, adapter.driver);

    let start = Instant::now();
    let mut run = device.load(scene(spacing).build()?)?;
    println!("kernels in {:.2} s", start.elapsed().as_secs_f64());
    let start = Instant::now();
    run.run_until(END)?;
    let on_device = run.into_simulation()?;
    let seconds = start.elapsed().as_secs_f64();
    let steps = on_device.steps();
    println!(
        "{} particles, {steps} steps until {END} s in {seconds:.1} s, {:.2} ms a step, {:?}",
        on_device.particles(),
        1e3 * seconds / steps as f64,
        device.traffic()
    );

    let start = Instant::now();
    let mut on_host = scene(spacing).build()?;
    on_host.run_until(END)?;
    println!("the CPU in {:.1} s", start.elapsed().as_secs_f64());
    let pairs = on_device.all().zip(on_host.all());
    let apart = pairs.map(|(a, b)| {
        let ([x, y], [u, v]) = (a.position(), b.position());
        (x - u).hypot(y - v)
    });
    println!(
        "places differ by {:.1e} m at most",
        apart.fold(0.0, f64::max)
    );

    let mut picture = Picture::new(1300, 700).title(&format!(
        "t = {END} s: {} on the left, the CPU on the right",
        adapter.name
    ));
    for (simulation, left) in [(&on_device, 0.0), (&on_host, 1.2 * WIDTH)] {
        picture = draw(picture, simulation, spacing, left);
    }
    picture.save("out/gpu_dam_break.svg")?;
    picture.save_png("out/gpu_dam_break.png")?;
    println!("out/gpu_dam_break.svg and out/gpu_dam_break.png are written");
    Ok(())
}
