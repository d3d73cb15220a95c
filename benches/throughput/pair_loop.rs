//! The composed pair loop beside one that is written out by hand, kernels and viscosities of a user's own beside those of
//! the crate, and the share of useful lanes. A module of `throughput`, and all of `gate`.

use meshfree::kernel::{Kernel, WendlandC2, WendlandC4};
use meshfree::neighbors::{Block, CHUNK, ClusterLists, Radii, SearchInput};
use meshfree::particles::{Columns, Field, Fields, Output};
use meshfree::prelude::*;
use meshfree::scalar::{Lane, Mask, OnRows};
use meshfree::sweep::{
    FusedKernel, InstructionSet, Interaction, PairSweep, Pass, Records, Results, Root,
    SmoothingMode, SweepInput,
};
use meshfree::term::viscosity::{ArtificialViscosity, MonaghanGingold, Viscous};
use meshfree::term::{self, Pair, PressureForce, TermDoc, Viscosity};
use std::time::Instant;

/// Pressure force and Monaghan–Gingold viscosity of rows, written out: what the composed loop is held
/// against. Records are x, v, m, ρ, c, B and X.
struct Fused<'a> {
    records: &'a [f64],
    lists: &'a ClusterLists,
    out: &'a mut [f64],
    h: f64,
    norm: f64,
    alpha: f64,
    by_divider: bool,
}

impl OnRows<f64> for Fused<'_> {
    type Output = ();
    #[inline(always)]
    fn run<Row: Lane<Scalar = f64, Broadcast = f64>>(self) {
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
                let row = &mut self.out[first * 4..(first + 8) * 4];
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
pub struct Lattice<T: Real> {
    pub columns: Columns<T, 3>,
    pub lists: ClusterLists,
    pub blocks: [Block; 1],
}

pub const H: f64 = 1.3;

impl<T: Real> Lattice<T> {
    pub fn new(side: usize, fields: Fields) -> Self {
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

    pub fn input(&self) -> SweepInput<'_, T, 3> {
        SweepInput {
            columns: &self.columns,
            images: &[],
            transforms: &[],
            lists: &self.lists,
            blocks: &self.blocks,
            interactions: &[Interaction::Bonded],
            smoothing_length: H,
            targets: self.blocks[0].slots.clone(),
            among: None,
            body_force: [T::zero(); 3],
            lattice_consistency_factor: 1.0,
            instructions: InstructionSet::detect(),
            root: Root::detect(),
        }
    }
}

/// The time of one over that of another, which take turns on one thread.
pub fn ratios(
    turns: usize,
    mut one: impl FnMut() + Send,
    mut other: impl FnMut() + Send,
) -> Vec<f64> {
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
pub fn print_ratio(ratios: &[f64]) -> f64 {
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
    let norm = Kernel::<3>::normalisation(&WendlandC2);
    let mut out = vec![0.0; 4 * slots];
    let ratios = ratios(
        turns,
        || sweep.run(Pass::Rates, &input, &records, &mut rows),
        || {
            InstructionSet::Avx512.run(Fused {
                records: records.data(),
                lists: &lattice.lists,
                out: &mut out,
                h: H,
                norm,
                alpha,
                by_divider: input.root == Root::Divider,
            });
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
pub fn assert_same(
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

/// Prints all of it: the least that the median ratio of composed to written out may be.
pub fn table(side: usize, turns: usize) -> f64 {
    let ratio = composed_against_fused(side, turns);
    useful_lanes::<f64>(side);
    useful_lanes::<f32>(side);
    own_against_built_in::<f64>(side, turns);
    own_against_built_in::<f32>(side, turns);
    ratio
}
