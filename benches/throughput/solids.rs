//! Solids beside the liquid: what a step of each scheme costs a particle and a neighbour, and how many bytes.
//! A free block that rings, stepped on one thread.

use meshfree::effect::{FiniteStrainPlasticity, Hypoelastic, NeoHookean, Plasticity};
use meshfree::material::catalogue;
use meshfree::material::eos::IdealGas;
use meshfree::neighbors::Cells;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::scheme::Scheme;
use std::time::Instant;

/// A free block of `side`³ particles a millimetre apart that rings, stepped on one thread.
fn row(name: &str, scheme: Scheme<f64, 3>, material: Material<f64>, side: usize, steps: usize) {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a pool of threads");
    pool.install(|| {
        let (dx, size) = (1e-3, 1e-3 * side as f64);
        // A gas rings about a state in which it has a pressure.
        let (_, cold) = material.state(material.reference_density(), 0.0);
        let energy = if cold > 0.0 { 0.0 } else { 1.0 };
        let (_, c) = material.state(material.reference_density(), energy);
        let rings = move |x: [f64; 3], own: Start<3>| Start {
            velocity: [0, 1, 2].map(|d| 1e-3 * c * (6.0 * x[d] / size).sin()),
            energy,
            ..own
        };
        let body = Body::block("block", material, [0.0; 3], [size; 3], dx).start(rings);
        let mut simulation = Scene::new(scheme).body(body).build().expect("a scene");
        let positions: Vec<[f64; 3]> = simulation.all().map(|p| p.position()).collect();
        let h = simulation.smoothing_length();
        let reach = 2.0 * h;
        let points: Vec<u32> = (0..positions.len() as u32).collect();
        let cells = Cells::build(&positions, &points, reach);
        let mut pairs = 0_u64;
        for (i, x) in positions.iter().enumerate() {
            cells.for_each_run(x.map(|x| x - reach), x.map(|x| x + reach), |run| {
                for &j in run {
                    let y = &positions[j as usize];
                    let r2: f64 = (0..3).map(|d| (x[d] - y[d]).powi(2)).sum();
                    pairs += u64::from(r2 < reach * reach && j as usize != i);
                }
            });
        }
        for _ in 0..3 {
            simulation.step().expect("a step");
        }
        let mut times: Vec<f64> = (0..steps)
            .map(|_| {
                let start = Instant::now();
                simulation.step().expect("a step");
                start.elapsed().as_secs_f64()
            })
            .collect();
        times.sort_by(f64::total_cmp);
        let (step, count) = (times[steps / 2], positions.len());
        println!(
            "| {name} | {:.1} | {:.0} | {:.0} | {:.1} | {} |",
            pairs as f64 / count as f64,
            pairs as f64 / step * 1e-6,
            step / count as f64 * 1e9,
            step / pairs as f64 * 1e9,
            simulation.bytes() / count,
        );
    });
}

/// Every scheme of solids beside the liquid, 3D, `f64`, one thread, medians over steps.
pub fn table(side: usize, steps: usize) {
    println!(
        "\n| a free block of {side}³ | neighbours | M interactions/s | ns a step and particle | ns a step and neighbour | bytes a particle |"
    );
    println!("|---|---:|---:|---:|---:|---:|");
    let steel = catalogue::steel_4340::<f64>;
    let liquid = schemes::weakly_compressible().h_over_dx(1.3).compose();
    let water = catalogue::weakly_compressible_water(10.0);
    row("liquid, h/dx 1.3", liquid, water, side, steps);
    let gas = Material::new("gas", IdealGas::new(5.0 / 3.0, 1.0));
    row(
        "gas, h follows density",
        schemes::gas().compose(),
        gas,
        side,
        steps,
    );
    let impact = schemes::impact().compose();
    row("impact, copper", impact, catalogue::copper(), side, steps);
    let updated = || schemes::impact_by_continuity().with(Hypoelastic);
    row(
        "updated Lagrangian, elastic, h/dx 1.2",
        updated().compose(),
        steel(),
        side,
        steps,
    );
    let plastic = updated().with(Plasticity).compose();
    row("updated Lagrangian, plastic", plastic, steel(), side, steps);
    let total = || schemes::total_lagrangian().with(NeoHookean);
    row(
        "total Lagrangian, neo-Hookean, h/dx 0.8",
        total().compose(),
        steel(),
        side,
        steps,
    );
    row(
        "the same at h/dx 1.3",
        total().h_over_dx(1.3).compose(),
        steel(),
        side,
        steps,
    );
    let plastic = schemes::total_lagrangian()
        .with(FiniteStrainPlasticity)
        .compose();
    row(
        "total Lagrangian, plastic, h/dx 0.8",
        plastic,
        steel(),
        side,
        steps,
    );
}
