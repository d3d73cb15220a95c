//! Solids beside the liquid: what a step of each scheme costs a particle and a neighbour, and how many bytes.
//! The total-Lagrangian force, composed, against one that is written out by hand.

use super::lattice::{BATCH, H, Lattice, assert_same, print_ratio, ratios, within_reach};
use meshfree::effect::{FiniteStrainPlasticity, Hypoelastic, NeoHookean, Plasticity, StressForce};
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree::material::catalogue;
use meshfree::material::eos::IdealGas;
use meshfree::neighbors::{CHUNK, Cells, ClusterLists};
use meshfree::particles::{Field, Fields, Output};
use meshfree::prelude::*;
use meshfree::scalar::{Lane, OnRows};
use meshfree::scene::Start;
use meshfree::scheme::Scheme;
use meshfree::sweep::{
    FusedKernel, InstructionSet, PairSweep, Pass, Records, Results, SmoothingMode,
};
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

/// P L, as the effect of total-Lagrangian solids has it.
const CORRECTED: Field = Field::matrix(13);

/// The force of the Piola stress, written out. Records are x, V, X and P L.
struct Fused<'a> {
    records: &'a [f64],
    lists: &'a ClusterLists,
    out: &'a mut [f64],
    gradient: f64,
}

const STRIDE: usize = 16;
/// Where the weight, the reference position and the corrected stress begin in a record.
const AT: [usize; 3] = [3, 4, 7];

impl OnRows<f64> for Fused<'_> {
    type Output = ();
    #[inline(always)]
    fn run<Row: Lane<Scalar = f64, Broadcast = f64>>(self) {
        let [weight, place, stress] = AT;
        let inverse = 1.0 / H;
        let mut near = [0_u32; BATCH];
        for (c, chunk) in self.lists.chunks().iter().enumerate() {
            for (k, bounds) in chunk.starts.windows(2).enumerate() {
                let first = (c * CHUNK + k) * 8;
                let mut own = [Row::splat(0.0); STRIDE];
                for (k, value) in own.iter_mut().enumerate() {
                    *value = Row::from_fn(|lane| self.records[(first + lane) * STRIDE + k]);
                }
                let mut force = [Row::splat(0.0); 3];
                for segment in &chunk.segments[bounds[0] as usize..bounds[1] as usize] {
                    let listed = &chunk.neighbors[segment.start as usize..segment.end as usize];
                    let staying = (segment.near_end - segment.start) as usize;
                    for (b, batch) in listed.chunks(BATCH).enumerate() {
                        let staying = staying.saturating_sub(b * BATCH).min(batch.len());
                        let records = (self.records, STRIDE, place);
                        let count = within_reach(records, &own, (batch, staying), &mut near);
                        for &j in &near[..count] {
                            let other = &self.records[j as usize * STRIDE..][..STRIDE];
                            let x: [Row; 3] = core::array::from_fn(|d| {
                                own[place + d] - Row::splat(other[place + d])
                            });
                            let d2 = x[2].mul_add(x[2], x[1].mul_add(x[1], x[0] * x[0]));
                            let t = d2
                                .root()
                                .mul_add(Row::splat(-0.5 * inverse), Row::splat(1.0))
                                .positive_part();
                            let f = t * t * t * Row::splat(-5.0 * self.gradient);
                            let factor = own[weight] * Row::splat(other[weight]) * f;
                            for a in 0..3 {
                                let mut traction = Row::zero();
                                for b in 0..3 {
                                    let at = stress + 3 * a + b;
                                    let sum = own[at] + Row::splat(other[at]);
                                    traction = sum.mul_add(x[b], traction);
                                }
                                force[a] = factor.mul_add(traction, force[a]);
                            }
                        }
                    }
                }
                for (k, sum) in force.into_iter().enumerate() {
                    for lane in 0..8 {
                        self.out[first * 3 + k * 8 + lane] = sum.extract(lane);
                    }
                }
            }
        }
    }
}

/// Composed against written out, over the same lists, taking turns.
pub fn composed_against_fused(side: usize, turns: usize) {
    if InstructionSet::detect() != InstructionSet::Avx512 {
        println!(
            "\ntotal-Lagrangian force, composed against written out: skipped, the machine has no AVX-512"
        );
        return;
    }
    type Force = FusedKernel<WendlandC2, (StressForce,), { SmoothingMode::Uniform.bit() }>;
    let sweep: Force = FusedKernel::new(WendlandC2, (StressForce,), SmoothingMode::Uniform);
    let sweep: &dyn PairSweep<f64, 3> = &sweep;
    // The lattice writes what liquids read, too.
    let liquid = Fields::of(&[
        Field::VELOCITY,
        Field::MASS,
        Field::DENSITY,
        Field::SOUND_SPEED,
        Field::PRESSURE_COEFFICIENT,
    ]);
    let mut lattice = Lattice::new(side, sweep.fields().union(liquid));
    let slots = lattice.columns.slots();
    for slot in 0..slots {
        let x = lattice.columns.vectors(Field::POSITION)[slot];
        lattice.columns.vectors_mut(Field::REFERENCE_POSITION)[slot] = x;
        for k in 0..9_usize {
            let value: f64 = 0.1 * x[k % 3] + k as f64 + 1.0;
            lattice.columns.raw_mut(CORRECTED)[slot * 9 + k] = 1e6 * value.sin();
        }
    }
    let input = lattice.input();
    let (mut records, mut rows) = (Records::default(), Results::default());
    sweep.pack(Pass::Rates, &input, &mut records);
    let one = &records.data()[..records.data().len() / slots];
    let begins = |field| {
        let own = lattice.columns.raw(field)[0];
        one.iter()
            .skip(3)
            .position(|value| *value == own)
            .map(|k| k + 3)
    };
    let found = [Field::WEIGHT, Field::REFERENCE_POSITION, CORRECTED].map(begins);
    assert_eq!(
        (one.len(), found),
        (STRIDE, AT.map(Some)),
        "the layout of records"
    );
    let gradient = Kernel::<3>::normalisation(&WendlandC2) / H.powi(5);
    let mut out = vec![0.0; 3 * slots];
    let ratios = ratios(
        turns,
        || sweep.run(Pass::Rates, &input, &records, &mut rows),
        || {
            InstructionSet::Avx512.run(Fused {
                records: records.data(),
                lists: &lattice.lists,
                out: &mut out,
                gradient,
            });
        },
    );
    assert_same(&rows, &[(Output::FORCE, 3)], &out, slots);
    print!("\ntotal-Lagrangian force, composed against written out, {slots} particles, ");
    print_ratio(&ratios);
}
