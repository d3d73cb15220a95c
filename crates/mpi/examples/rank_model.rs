//! Predicted speed-up, parts of a step and memory of a rank on up to 10 000 ranks.
//!
//! ```text
//! cargo run --release -p meshfree-mpi --example rank_model
//! ```
//!
//! The example measures water in space on this machine and predicts larger scenes by the model, on machines of 32 cores with a rank each
//! and a network of 2 µs and 10 GB/s. It prints the largest part of a step on each number of ranks, and writes `out/rank_model.svg`.

use meshfree::output::svg::{Axis, Figure, Panel, Series};
use meshfree::prelude::*;
use meshfree::ranks::{Network, RankCost, RankModel};
use meshfree::scene::Start;
use std::error::Error;
use std::f64::consts::PI;

/// Cores of a machine of the cluster.
const CORES: f64 = 32.0;
const PARTICLES: [(&str, f64); 3] = [("10⁶", 1e6), ("10⁸", 1e8), ("10¹⁰", 1e10)];
const RANKS: [usize; 13] = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10_000];

fn main() -> Result<(), Box<dyn Error>> {
    let measured = measured()?;
    let ranks = || Axis::log("ranks", "");
    let mut speed = Panel::new(ranks(), Axis::log("speed-up", ""));
    // Room for the legends.
    let mut parts = Panel::new(ranks(), Axis::log("time", "ms").to(1e6));
    let mut memory = Panel::new(ranks(), Axis::log("memory of a rank", "GB").to(1e5));
    println!("particles, ranks: ms a step, speed-up, GB of a rank, largest part");
    for (name, particles) in PARTICLES {
        let model = measured.of_particles(particles)?;
        let costs = RANKS.map(|ranks| model.on(ranks, &Network::default()));
        let costs: Vec<RankCost> = costs.into_iter().collect::<Result<_, _>>()?;
        let one = costs[0].step;
        for cost in costs
            .iter()
            .filter(|own| [1, 10, 100, 1000, 10_000].contains(&own.ranks))
        {
            let most = cost.largest().map_or("", |line| line.what);
            println!(
                "{name}, {}: {:.3}, {:.1}, {:.3}, {most}",
                cost.ranks,
                1e3 * cost.step,
                one / cost.step,
                1e-9 * cost.memory,
            );
        }
        let over = |of: &dyn Fn(&RankCost) -> f64| -> Vec<(f64, f64)> {
            costs
                .iter()
                .map(|own| (own.ranks as f64, of(own)))
                .collect()
        };
        let label = format!("{name} particles");
        speed = speed.series(Series::line(&label, over(&|own| one / own.step)));
        memory = memory.series(Series::line(&label, over(&|own| 1e-9 * own.memory)));
        if particles == 1e8 {
            for (k, line) in costs[0].lines.iter().enumerate() {
                let times = over(&|own| 1e3 * own.lines[k].seconds);
                // One rank has nothing to wait for.
                let first = usize::from(!line.what.starts_with("work"));
                if times.iter().any(|own| own.1 > 0.0) {
                    parts = parts.series(Series::line(line.what, times.into_iter().skip(first)));
                }
            }
        }
    }
    let ideal = RANKS.map(|ranks| (ranks as f64, ranks as f64));
    speed = speed.series(Series::line("as many times as ranks", ideal).reference());
    Figure::new()
        .title("Water in space on ranks of 32 cores, predicted")
        .panel(speed.title("Speed-up over one rank"))
        .panel(parts.title("Parts of a step, 10⁸ particles"))
        .panel(memory.title("Memory"))
        .columns(3)
        .save("out/rank_model.svg")?;
    println!("out/rank_model.svg");
    Ok(())
}

/// What a step takes here, with the cores of such a machine.
fn measured() -> Result<RankModel, Box<dyn Error>> {
    // Vortices of 1 m/s fill a cube between periods.
    let water = catalogue::weakly_compressible_water(1.0);
    let cube = Body::block("water", water, [0.0; 3], [1.0; 3], 0.016);
    let mut scene = Scene::<f64, 3>::new(schemes::weakly_compressible()).body(cube.start(
        |[x, y, _], start| {
            let [x, y] = [x, y].map(|own| 2.0 * PI * own);
            let velocity = [x.sin() * y.cos(), -x.cos() * y.sin(), 0.0];
            Start { velocity, ..start }
        },
    ));
    for axis in 0..3 {
        scene = scene.boundary(Periodic::along(axis, 0.0, 1.0));
    }
    let mut vortices = scene.build()?;
    vortices.run_until(0.01)?;
    let mut model = vortices.rank_model(0.1)?;
    let here = std::thread::available_parallelism()?.get() as f64;
    for price in [&mut model.step, &mut model.list_build, &mut model.sort] {
        price.divided *= here / CORES;
        price.undivided *= here / CORES;
    }
    Ok(model)
}
