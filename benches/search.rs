//! Search for neighbours by buckets against a look at all pairs, in 3D: where buckets begin to pay.
//! Vesenjak & Ren argue for buckets by the growth of both with the number of particles.
//!
//! `cargo bench --bench search [-- --quick]`

use meshfree::neighbors::{Block, Cells, ClusterLists, Radii, SearchInput};
use meshfree::scalar::InstructionSet;
use std::hint::black_box;
use std::time::Instant;

/// The support of the kernel, in spacings.
const REACH: f64 = 2.6;

/// A cube of points, disturbed.
fn points(side: usize) -> Vec<[f64; 3]> {
    (0..side.pow(3))
        .map(|k| {
            let cell = [k % side, k / side % side, k / side / side];
            core::array::from_fn(|d| {
                cell[d] as f64 + 0.1 * (1e4 * (k as f64 * (0.7 + d as f64)).sin()).fract()
            })
        })
        .collect()
}

fn apart2(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|d| (a[d] - b[d]).powi(2)).sum()
}

fn by_all_pairs(points: &[[f64; 3]]) -> usize {
    let near = |a: &[f64; 3]| {
        points
            .iter()
            .filter(|b| apart2(a, b) < REACH * REACH)
            .count()
    };
    points.iter().map(near).sum()
}

fn by_buckets(points: &[[f64; 3]]) -> usize {
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let cells = Cells::build(points, &all, REACH);
    let mut found = 0;
    for a in points {
        cells.for_each_run(a.map(|x| x - REACH), a.map(|x| x + REACH), |run| {
            found += run
                .iter()
                .filter(|&&j| apart2(a, &points[j as usize]) < REACH * REACH)
                .count();
        });
    }
    found
}

/// The search of the simulations: rows of eight share a list.
fn by_clusters(points: &[[f64; 3]]) -> usize {
    let slots = points.len() / 8 * 8;
    let blocks = [Block {
        slots: 0..slots,
        wall: false,
    }];
    let mut lists = ClusterLists::default();
    lists.rebuild(&SearchInput {
        positions: &points[..slots],
        radii: Radii::Uniform(REACH),
        blocks: &blocks,
        listed: &[],
        width: 8,
        slots,
        skin: 0.0,
        instructions: InstructionSet::detect(),
    });
    lists.entries()
}

/// Nanoseconds a particle, the best of some runs.
fn time(points: &[[f64; 3]], search: fn(&[[f64; 3]]) -> usize) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..3 {
        let start = Instant::now();
        black_box(search(black_box(points)));
        best = best.min(start.elapsed().as_secs_f64());
    }
    best / points.len() as f64 * 1e9
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let given = |name: &str| arguments.iter().any(|a| a == name);
    let sides: &[usize] = match (given("--bench"), given("--quick")) {
        (false, _) => &[4, 6],
        (true, true) => &[4, 6, 8, 10, 16, 24],
        (true, false) => &[4, 5, 6, 7, 8, 10, 12, 16, 24, 32, 64],
    };
    println!("| particles | all pairs, ns a particle | buckets | rows with a common list |");
    println!("|---|---|---|---|");
    let mut crossover = None;
    for &side in sides {
        let points = points(side);
        assert_eq!(points.len(), side.pow(3));
        // All pairs of more than that take minutes.
        let all = (side <= 32).then(|| time(&points, by_all_pairs));
        if side <= 12 {
            assert_eq!(by_all_pairs(&points), by_buckets(&points));
        }
        let (buckets, rows) = (time(&points, by_buckets), time(&points, by_clusters));
        let shown = all.map_or("-".into(), |all| format!("{all:.0}"));
        println!("| {} | {shown} | {buckets:.0} | {rows:.0} |", points.len());
        if crossover.is_none() && all.is_some_and(|all| all > buckets) {
            crossover = Some(points.len());
        }
    }
    if let Some(particles) = crossover {
        println!("\nbuckets are faster from {particles} particles on");
    }
}
