//! Speed and memory of liquids in a breaking dam: interactions a second, time by phase, bytes a particle,
//! what each term costs, the composed pair loop against one that is written out by hand, kernels and
//! viscosities of a user's own against those of the crate, and solids beside the liquid.
//!
//! `cargo bench --bench throughput [-- --quick | --solids | --gate]`. With `--gate` it compares the two loops only, and fails
//! if the composed one takes more than 1.15 of the other's time. An interaction is an ordered pair of particles inside
//! of the support, the first of them liquid. Times are medians over steps, ratios medians over pairs of
//! runs that take turns.

#[path = "throughput/solids.rs"]
mod solids;

use meshfree::boundary::Wall;
use meshfree::kernel::{Kernel, WendlandC2, WendlandC4};
use meshfree::material::catalogue;
use meshfree::neighbors::{Block, CHUNK, Cells, ClusterLists, Radii, SearchInput};
use meshfree::particles::{Columns, Field, Fields, Output};
use meshfree::prelude::*;
use meshfree::scalar::{Lane, Lanes, Mask};
use meshfree::scheme::Scheme;
use meshfree::sweep::{
    FusedKernel, InstructionSet, Interaction, PairSweep, Pass, Records, Results, Root,
    SmoothingMode, SweepInput,
};
use meshfree::term::viscosity::{ArtificialViscosity, Inviscid, MonaghanGingold, Viscous};
use meshfree::term::{self, Nothing, Pair, PressureForce, TermDoc, Viscosity};
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
    shares: [f64; 6],
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
        "| D | scalar | liquid | with walls | threads | neighbours | M/s and thread, evaluation | step | ns a step and liquid particle | lists | packing | pairs | walls | materials | integration | bytes a liquid particle | a particle | at the peak | steps a build |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
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

type Row = Lanes<f64, 8, true>;

/// Pressure force and Monaghan–Gingold viscosity of rows, written out: what the composed loop is held
/// against. Records are x, v, m, ρ, c, B and X.
struct Fused<'a> {
    records: &'a [f64],
    lists: &'a ClusterLists,
    h: f64,
    norm: f64,
    alpha: f64,
    by_divider: bool,
}

impl Fused<'_> {
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512vl,avx512dq,fma")]
    fn run_avx512(&self, out: &mut [f64]) {
        self.run(out);
    }

    #[inline(always)]
    fn run(&self, out: &mut [f64]) {
        const STRIDE: usize = 11;
        let (inverse, reach2) = (1.0 / self.h, 4.004 * self.h * self.h);
        let gradient = self.norm * inverse.powi(5);
        let mut near = [0_u32; 256];
        for (c, chunk) in self.lists.chunks().iter().enumerate() {
            for (k, bounds) in chunk.starts.windows(2).enumerate() {
                let first = (c * CHUNK + k) * 8;
                let mut own = [Row::splat(0.0); STRIDE];
                for (k, value) in own.iter_mut().enumerate() {
                    *value = Row::from_fn(|lane| self.records[(first + lane) * STRIDE + k]);
                }
                let mut force = [Row::splat(0.0); 3];
                let mut signal = Row::splat(0.0);
                for segment in &chunk.segments[bounds[0] as usize..bounds[1] as usize] {
                    let listed = &chunk.neighbors[segment.start as usize..segment.end as usize];
                    let staying = (segment.near_end - segment.start) as usize;
                    for (b, batch) in listed.chunks(near.len()).enumerate() {
                        let staying = staying.saturating_sub(b * near.len()).min(batch.len());
                        let mut count = staying;
                        near[..count].copy_from_slice(&batch[..count]);
                        for &j in &batch[count..] {
                            let at = j as usize * STRIDE;
                            let x = &self.records[at..at + 3];
                            let mut r2 = Row::splat(0.0);
                            for d in 0..3 {
                                let r = own[d] - Row::splat(x[d]);
                                r2 = r.mul_add(r, r2);
                            }
                            near[count % 256] = j;
                            count += usize::from(r2.lt(Row::splat(reach2)).any());
                        }
                        for &j in &near[..count] {
                            let at = j as usize * STRIDE;
                            let other = &self.records[at..at + STRIDE];
                            let r0 = own[0] - Row::splat(other[0]);
                            let r1 = own[1] - Row::splat(other[1]);
                            let r2 = own[2] - Row::splat(other[2]);
                            let v0 = own[3] - Row::splat(other[3]);
                            let v1 = own[4] - Row::splat(other[4]);
                            let v2 = own[5] - Row::splat(other[5]);
                            let d2 = r2.mul_add(r2, r1.mul_add(r1, r0 * r0));
                            let vr = v2.mul_add(r2, v1.mul_add(r1, v0 * r0));
                            let distance = if self.by_divider {
                                d2.sqrt()
                            } else {
                                d2.root()
                            };
                            let t = distance
                                .mul_add(Row::splat(-0.5 * inverse), Row::splat(1.0))
                                .positive_part();
                            let f = t * t * t * Row::splat(-5.0 * gradient);
                            let sounds = own[8] + Row::splat(other[8]);
                            let densities = own[7] + Row::splat(other[7]);
                            let over_h = d2.mul_add(Row::splat(inverse), Row::splat(0.01 * self.h));
                            let jump = vr / (over_h * densities);
                            let approach =
                                Row::select(vr.lt(Row::splat(0.0)), jump, Row::splat(0.0));
                            let speed = sounds * Row::splat(self.alpha);
                            let pi = -(approach * speed);
                            let inside = f.lt(Row::splat(0.0));
                            signal = signal.max(Row::select(
                                inside,
                                speed * Row::splat(0.3),
                                Row::splat(0.0),
                            ));
                            let weights = own[9] * Row::splat(other[9]);
                            let masses = own[6] * Row::splat(other[6]);
                            let stress = own[10] + Row::splat(other[10]);
                            let radial = -(weights * stress + masses * pi) * f;
                            force[0] = radial.mul_add(r0, force[0]);
                            force[1] = radial.mul_add(r1, force[1]);
                            force[2] = radial.mul_add(r2, force[2]);
                        }
                    }
                }
                let row = &mut out[first * 4..(first + 8) * 4];
                for (k, sum) in [force[0], force[1], force[2], signal]
                    .into_iter()
                    .enumerate()
                {
                    for lane in 0..8 {
                        row[k * 8 + lane] = sum.extract(lane);
                    }
                }
            }
        }
    }
}

/// A block of particles off its lattice, and its lists.
struct Lattice<T: Real> {
    columns: Columns<T, 3>,
    lists: ClusterLists,
    blocks: [Block; 1],
}

const H: f64 = 1.3;

impl<T: Real> Lattice<T> {
    fn new(side: usize, fields: Fields) -> Self {
        let mut positions = Vec::new();
        // Blocks of two by two by two, so that clusters are compact without a sort.
        for block in 0..(side / 2).pow(3) {
            let corner = [
                block % (side / 2),
                block / (side / 2) % (side / 2),
                block / (side / 2).pow(2),
            ];
            for k in 0..8_usize {
                let cell = [k & 1, k >> 1 & 1, k >> 2];
                positions.push(core::array::from_fn::<f64, 3, _>(|d| {
                    let noise = (1e4 * ((8 * block + k) as f64 * (0.7 + d as f64)).sin()).fract();
                    (2 * corner[d] + cell[d]) as f64 + 0.1 * noise
                }));
            }
        }
        let slots = positions.len();
        let mut columns = Columns::<T, 3>::new(
            fields.union(Fields::of(&[Field::POSITION, Field::VELOCITY])),
            slots,
        );
        for (slot, x) in positions.iter().enumerate() {
            columns.vectors_mut(Field::POSITION)[slot] = x.map(T::from_f64);
            columns.vectors_mut(Field::VELOCITY)[slot] = x.map(|x| T::from_f64((0.3 * x).sin()));
            for (field, value) in [
                (Field::MASS, 1000.0),
                (Field::DENSITY, 1000.0 + (0.2 * x[0]).sin()),
                (Field::SOUND_SPEED, 30.0),
                (Field::WEIGHT, 1.0),
                (Field::PRESSURE_COEFFICIENT, 500.0 * (0.1 * x[2]).cos()),
            ] {
                // A sweep may need fewer.
                if let Some(own) = columns.raw_mut(field).get_mut(slot) {
                    *own = T::from_f64(value);
                }
            }
        }
        let blocks = [Block {
            slots: 0..slots,
            wall: false,
        }];
        let mut lists = ClusterLists::default();
        lists.rebuild(&SearchInput {
            positions: columns.vectors(Field::POSITION),
            radii: Radii::Uniform(2.0 * H),
            blocks: &blocks,
            listed: &[],
            width: <T::Wide<false> as Lane>::WIDTH,
            slots,
            skin: 0.2 * H,
            instructions: InstructionSet::detect(),
        });
        Self {
            columns,
            lists,
            blocks,
        }
    }

    fn input(&self) -> SweepInput<'_, T, 3> {
        SweepInput {
            columns: &self.columns,
            images: &[],
            transforms: &[],
            lists: &self.lists,
            blocks: &self.blocks,
            interactions: &[Interaction::Bonded],
            smoothing_length: H,
            targets: self.blocks[0].slots.clone(),
            body_force: [T::zero(); 3],
            lattice_consistency_factor: 1.0,
            instructions: InstructionSet::detect(),
            root: Root::detect(),
        }
    }
}

/// The time of one over that of another, which take turns on one thread.
fn ratios(turns: usize, mut one: impl FnMut() + Send, mut other: impl FnMut() + Send) -> Vec<f64> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a pool of threads");
    let mut ratios = pool.install(|| {
        (0..=turns)
            .map(|_| {
                let start = Instant::now();
                one();
                let first = start.elapsed().as_secs_f64();
                let start = Instant::now();
                other();
                first / start.elapsed().as_secs_f64()
            })
            .skip(1)
            .collect::<Vec<f64>>()
    });
    ratios.sort_by(f64::total_cmp);
    ratios
}

/// The median and order statistics that hold it in 95 % of all samples, of which it returns the lower.
fn print_ratio(ratios: &[f64]) -> f64 {
    let n = ratios.len();
    let off = (0.98 * (n as f64).sqrt()).ceil() as usize;
    let low = ratios[(n / 2).saturating_sub(off)];
    println!(
        "{n} turns: median ratio {:.3}, 95 % interval {:.3} to {:.3}",
        ratios[n / 2],
        low,
        ratios[(n / 2 + off).min(n - 1)],
    );
    low
}

/// The share of lanes with a pair that acts, of those for which terms are evaluated: rows of particles against
/// neighbours that come within the support of any of the row.
fn useful_lanes<T: Real>(side: usize) {
    let lattice = Lattice::<T>::new(side, Fields::NONE);
    let width = <T::Wide<false> as Lane>::WIDTH;
    let positions = lattice.columns.vectors(Field::POSITION);
    let (mut useful, mut evaluated) = (0, 0);
    for (c, chunk) in lattice.lists.chunks().iter().enumerate() {
        for (k, bounds) in chunk.starts.windows(2).enumerate() {
            let first = (c * CHUNK + k) * width;
            for segment in &chunk.segments[bounds[0] as usize..bounds[1] as usize] {
                for &j in &chunk.neighbors[segment.start as usize..segment.end as usize] {
                    let acts = |i: &usize| {
                        let apart = (0..3).map(|d| positions[*i][d] - positions[j as usize][d]);
                        let square: f64 = apart.map(|r| r.to_f64().powi(2)).sum();
                        square < 4.0 * H * H && *i != j as usize
                    };
                    let lanes = (first..first + width).filter(acts).count();
                    useful += lanes;
                    evaluated += if lanes > 0 { width } else { 0 };
                }
            }
        }
    }
    println!(
        "useful lanes, {} × {width}, 3D: {:.2}",
        T::NAME,
        f64::from(useful as u32) / f64::from(evaluated as u32)
    );
}

/// Composed over written out, from which on `--gate` fails; by the lower end of the interval of its median, or a machine
/// that does other things besides would fail it.
const GATE: f64 = 1.15;

/// Composed against written out, over the same lists, taking turns: the least that the median ratio may be.
fn composed_against_fused(side: usize, turns: usize) -> f64 {
    if InstructionSet::detect() != InstructionSet::Avx512 {
        println!("\ncomposed against written out: skipped, the machine has no AVX-512");
        return 1.0;
    }
    let alpha = 0.02;
    let sweep = pair_loop(WendlandC2, MonaghanGingold { alpha, beta: 0.0 });
    let sweep: &dyn PairSweep<f64, 3> = &sweep;
    let lattice = Lattice::new(side, sweep.fields());
    let slots = lattice.columns.slots();
    let input = lattice.input();
    let (mut records, mut rows) = (Records::default(), Results::default());
    sweep.pack(Pass::Rates, &input, &mut records);
    let fused = Fused {
        records: records.data(),
        lists: &lattice.lists,
        h: H,
        norm: Kernel::<3>::normalisation(&WendlandC2),
        alpha,
        by_divider: input.root == Root::Divider,
    };
    let mut out = vec![0.0; 4 * slots];
    let ratios = ratios(
        turns,
        || sweep.run(Pass::Rates, &input, &records, &mut rows),
        || {
            #[cfg(target_arch = "x86_64")]
            // SAFETY: the machine has been asked above.
            unsafe {
                fused.run_avx512(&mut out);
            }
        },
    );
    assert_same(slots, &rows, &out, |slot, d| {
        (slot / 8 * 4 + d) * 8 + slot % 8
    });
    print!(
        "\ncomposed against written out, {slots} particles, root by {:?}, ",
        input.root
    );
    print_ratio(&ratios)
}

/// Both loops make the same forces, or their comparison says nothing; `place` is where the one written out has them.
fn assert_same(
    slots: usize,
    rows: &Results<f64, 3>,
    out: &[f64],
    place: impl Fn(usize, usize) -> usize,
) {
    let largest = out.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for slot in 0..slots {
        for d in 0..3 {
            let (a, b) = (rows.get(Output::FORCE, d, slot), out[place(slot, d)]);
            assert!((a - b).abs() < 1e-9 * largest, "slot {slot}: {a} and {b}");
        }
    }
}

/// Pressure and an artificial viscosity under a kernel, in one loop.
fn pair_loop<K, V>(
    kernel: K,
    viscosity: V,
) -> FusedKernel<K, (PressureForce, Viscosity<V>), { SmoothingMode::Uniform.bit() }> {
    let terms = (PressureForce, Viscosity(viscosity));
    FusedKernel::new(kernel, terms, SmoothingMode::Uniform)
}

/// The Wendland C4 kernel in 3D as a user's crate would write it.
#[derive(Clone, Copy, Debug)]
struct OwnKernel;

impl Kernel<3> for OwnKernel {
    fn name(&self) -> &'static str {
        "own Wendland C4"
    }
    fn support(&self) -> f64 {
        2.0
    }
    fn normalisation(&self) -> f64 {
        495.0 / (256.0 * std::f64::consts::PI)
    }
    fn h_over_dx(&self) -> f64 {
        1.8
    }
    fn h_over_dx_range(&self) -> (f64, f64) {
        (1.3, 2.3)
    }
    fn stable_step(&self) -> f64 {
        1.0
    }
    #[inline(always)]
    fn shape<L: Lane>(&self, q: L) -> L {
        let q = q.min(L::of(2.0));
        let t = q.mul_add(L::of(-0.5), L::one());
        let polynomial = q.mul_add(L::of(35.0 / 12.0), L::of(3.0));
        t.powi(6) * polynomial.mul_add(q, L::one())
    }
    #[inline(always)]
    fn slope_over_q<L: Lane>(&self, q: L) -> L {
        let q = q.min(L::of(2.0));
        let t = q.mul_add(L::of(-0.5), L::one());
        t.powi(5) * q.mul_add(L::of(-35.0 / 3.0), L::of(-14.0 / 3.0))
    }
}

/// The viscosity of Monaghan & Gingold as a user's crate would write it.
#[derive(Clone, Debug)]
struct OwnViscosity {
    alpha: f64,
    beta: f64,
}

impl<const D: usize> ArtificialViscosity<D> for OwnViscosity {
    const READS: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: term::Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        // Twice the means, and one division: the arithmetic of the crate's own, or the comparison says nothing.
        let sound_speeds = pair.i(Field::SOUND_SPEED) + pair.j(Field::SOUND_SPEED);
        let densities = pair.i(Field::DENSITY) + pair.j(Field::DENSITY);
        let approaching = pair.v_dot_r.lt(L::zero());
        let over_h = pair.r2.mul_add(pair.h.recip(), pair.h * L::of(0.01));
        let quotient = pair.v_dot_r / (over_h * densities);
        let quotient = L::select(approaching, quotient, L::zero());
        let mu = quotient * densities;
        let speed = mu.mul_add(L::of(-2.0 * self.beta), L::of(self.alpha) * sound_speeds);
        Viscous {
            pi: -(quotient * speed),
            signal: speed * L::of(0.3),
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("own viscosity, α = {}, β = {}", self.alpha, self.beta),
            equation: "Π = (−α c̄ μ + β μ²)/ρ̄",
            source: "Monaghan & Gingold 1983",
        }
    }
}

/// What a user's crate writes against the same in the crate, taking turns: at most 1.05.
fn own_against_built_in<T: Real>(side: usize, turns: usize) {
    let against = |what: &str, own: &dyn PairSweep<T, 3>, built_in: &dyn PairSweep<T, 3>| {
        let lattice = Lattice::new(side, own.fields());
        let input = lattice.input();
        let (mut records, mut rows) =
            (Records::default(), [Results::default(), Results::default()]);
        own.pack(Pass::Rates, &input, &mut records);
        let [own_rows, rows] = &mut rows;
        let ratios = ratios(
            turns,
            || own.run(Pass::Rates, &input, &records, own_rows),
            || built_in.run(Pass::Rates, &input, &records, rows),
        );
        let force = |rows: &Results<T, 3>, slot| rows.get(Output::FORCE, 0, slot).to_f64();
        let slots = 0..lattice.columns.slots();
        let largest = slots
            .clone()
            .fold(0.0_f64, |m, slot| m.max(force(rows, slot).abs()));
        for slot in slots {
            let (a, b) = (force(own_rows, slot), force(rows, slot));
            assert!(
                (a - b).abs() < 1e-4 * largest,
                "{what}, slot {slot}: {a} and {b}"
            );
        }
        print!(
            "{what} of one's own over the same in the crate, {}, ",
            T::NAME
        );
        print_ratio(&ratios);
    };
    let (alpha, beta) = (1.0, 2.0);
    let built_in = MonaghanGingold { alpha, beta };
    against(
        "kernel",
        &pair_loop(OwnKernel, built_in),
        &pair_loop(WendlandC4, built_in),
    );
    against(
        "viscosity",
        &pair_loop(WendlandC4, OwnViscosity { alpha, beta }),
        &pair_loop(WendlandC4, built_in),
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
    let ratio = composed_against_fused(side, turns);
    if given("--gate") {
        assert!(
            ratio <= GATE,
            "the composed loop takes at least {ratio:.3} of the time of the one written out, and may take {GATE}"
        );
        return;
    }
    useful_lanes::<f64>(side);
    useful_lanes::<f32>(side);
    solids::composed_against_fused(side, turns);
    solids::table(if full { 32 } else { 10 }, steps);
    if given("--solids") {
        return;
    }
    own_against_built_in::<f64>(side, turns);
    own_against_built_in::<f32>(side, turns);
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
