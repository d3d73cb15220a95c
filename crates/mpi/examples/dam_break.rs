//! A dam breaks in a plane, on as many processes as `mpirun` starts, to the bits of one.
//!
//! ```text
//! mpirun -n 2 cargo run --release -p meshfree-mpi --example dam_break
//! ```
//!
//! The first rank prints the front of the water, a hash of all bits, and what ranks said to each other, and writes
//! `out/dam_break_on_ranks.png`. The hash is the same on any number of ranks.

use meshfree::boundary::Wall;
use meshfree::output::picture::Picture;
use meshfree::output::svg::{Axis, Color};
use meshfree::prelude::*;
use meshfree_mpi::World;
use std::error::Error;
use std::time::Instant;

/// Column of water and tank \[m\], and spacing in metres.
const COLUMN: [f64; 2] = [0.6, 0.3];
const TANK: [f64; 2] = [1.6, 0.6];
const END: f64 = 0.35;

fn main() -> Result<(), Box<dyn Error>> {
    let world = World::init()?;
    // The spacing may be given in metres.
    let spacing = std::env::args()
        .nth(1)
        .map_or(Ok(0.005), |own| own.parse())?;
    // The fastest water runs at about 2 √(g H).
    let water = catalogue::weakly_compressible_water(2.0 * (9.81 * COLUMN[1]).sqrt());
    let open = [[true; 2], [true, false]];
    let mut simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], COLUMN, spacing))
        .wall(Wall::around("tank", [0.0; 2], TANK, spacing, 4, open))
        .acceleration(|_| [0.0, -9.81])
        .on_ranks(world.ranks())
        .build()?;
    let start = Instant::now();
    simulation.run_until(END)?;
    let taken = start.elapsed().as_secs_f64();
    if !simulation.is_first_rank() {
        return Ok(());
    }
    let front = simulation
        .all()
        .map(|own| own.position()[0])
        .fold(0.0, f64::max);
    let ranks = simulation.rank().map_or(1, |(_, count)| count);
    println!(
        "{} particles, {} steps on {ranks} ranks in {taken:.1} s",
        simulation.particles(),
        simulation.steps()
    );
    println!(
        "front at {front:.4} m after {END} s, bits {:016x}",
        simulation.bits_hash()
    );
    let phases = simulation.phases();
    let divided = phases.pairs + phases.walls + phases.lists;
    println!(
        "pairs, walls and lists take {:.0} % of the steps, packing {:.0} %",
        100.0 * divided.as_secs_f64() / phases.total().as_secs_f64(),
        100.0 * phases.packing.as_secs_f64() / phases.total().as_secs_f64(),
    );
    if let Some(traffic) = simulation.traffic() {
        println!(
            "{} gatherings, {:.1} kB to this rank a step, {:.1} s of messages and waiting",
            traffic.gathered,
            traffic.received as f64 / 1e3 / simulation.steps() as f64,
            traffic.waited.as_secs_f64(),
        );
    }
    let water = simulation
        .all()
        .map(|own| (own.position(), own.pressure() / 1e3));
    let tank = simulation.wall("tank")?.map(|own| own.position());
    Picture::new(1200, 450)
        .bounds([0.0; 2], TANK)
        .particles(
            Axis::linear("pressure", "kPa").range(0.0, 4.0),
            spacing,
            water,
        )
        .plain(Color(130, 130, 130), 1.0, spacing, tank)
        .save_png("out/dam_break_on_ranks.png")?;
    Ok(())
}
