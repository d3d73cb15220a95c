//! What ranks would bring: speed-up, what takes the time of a step, and memory of a rank on up to 10 000 ranks, predicted on one process.
//!
//! ```text
//! cargo run --release -p meshfree-mpi --example rank_model
//! ```
//!
//! Water that moves in a closed tank in space is measured here. More of it follows by the model, on machines of 32 cores with a rank each
//! and a network of 2 µs and 10 GB/s. It prints what limits each number of ranks most, and writes `out/rank_model.svg`.

use meshfree::boundary::Wall;
use meshfree::output::svg::{Axis, Figure, Panel, Series};
use meshfree::prelude::*;
use meshfree::ranks::{Network, RankCost, RankModel};
use std::error::Error;

/// Cores of a machine, of which this one has others.
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
    println!("particles, ranks: ms a step, speed-up, GB of a rank, what takes most");
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
                // One rank waits for nobody.
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
    let dx = 0.02;
    let water = catalogue::weakly_compressible_water(2.0 * 9.81_f64.sqrt());
    let column = Body::block("water", water, [0.0; 3], [2.0, 1.0, 1.0], dx);
    let closed = [[true; 2]; 3];
    let mut tank = Scene::<f64, 3>::new(schemes::weakly_compressible())
        .body(column.velocity([1.0, 0.0, 0.0]))
        .wall(Wall::around(
            "tank",
            [0.0; 3],
            [2.5, 1.0, 1.5],
            dx,
            4,
            closed,
        ))
        .acceleration(|_| [0.0, 0.0, -9.81])
        .build()?;
    tank.run_until(0.01)?;
    let mut model = tank.rank_model(0.05)?;
    let here = std::thread::available_parallelism()?.get() as f64;
    for price in [&mut model.step, &mut model.list_build, &mut model.sort] {
        price.divided *= here / CORES;
        price.undivided *= here / CORES;
    }
    Ok(model)
}
