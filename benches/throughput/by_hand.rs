//! Sums over pairs that are written out by hand for just these effects, beside the crate's loop with the terms of these: what
//! composing costs. Both share lists, kernel, records, rows and root; the crate's may sum both sides of a pair at once.

// Those that `--bench gate` and `--bench throughput` need too; the others are modules of `--bench effects` alone.
#[path = "by_hand/forces.rs"]
pub mod forces;

use super::lattice::{BATCH, H, Lattice, assert_same, print_ratio, ratios, within_reach};
use meshfree::effect::TwoPhase;
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree::name;
use meshfree::neighbors::{CHUNK, ClusterLists};
use meshfree::particles::{Field, Fields, Output};
use meshfree::scalar::{Lane, OnRows};
use meshfree::sweep::{FusedKernel, InstructionSet, PairSweep, Pass, Records, Results, Root};
use meshfree::term::Terms;
use std::marker::PhantomData;

/// Most numbers of a record, and most sums.
pub const MOST: usize = 32;

/// What a record holds, known when the loop is compiled.
pub trait Record {
    const FIELDS: Fields;
}

/// The record of a loop with these terms.
struct Of<P>(PhantomData<P>);

impl<P: Terms<3>> Record for Of<P> {
    const FIELDS: Fields = P::READS
        .union(Fields::of(&[Field::POSITION]))
        .without(Field::POSITION_RESIDUAL);
}

/// Where fields begin in a record.
pub const fn places<R: Record, const N: usize>(fields: [Field; N]) -> [usize; N] {
    let (mut places, mut k) = ([0; N], 0);
    while k < N {
        places[k] = R::FIELDS.offset(fields[k], 3);
        k += 1;
    }
    places
}

/// A row of particles and a neighbour: what every loop makes of their places first. What a loop does not use the compiler leaves
/// out.
pub struct Apart<Row> {
    /// From the neighbour, in the places by which lists are made.
    pub r: [Row; 3],
    pub d2: Row,
    /// The kernel over its factor in front.
    pub shape: Row,
    /// The factor F of the kernel's gradient.
    pub f: Row,
}

/// How fast a row and a neighbour part, and the product of that with their distance.
#[inline(always)]
pub fn parting<Row: Lane<Scalar = f64>, R: Record>(
    r: &[Row; 3],
    own: &[Row; MOST],
    other: &[f64],
) -> ([Row; 3], Row) {
    let [v] = const { places::<R, 1>([Field::VELOCITY]) };
    let (mut jump, mut vr) = ([Row::zero(); 3], Row::zero());
    for d in 0..3 {
        jump[d] = own[v + d] - Row::splat(other[v + d]);
        vr = jump[d].mul_add(r[d], vr);
    }
    (jump, vr)
}

/// The sums of a loop.
pub trait Written: Copy + Send + Sync {
    /// What is summed, and its components, in the order of `finish`.
    fn outputs() -> Vec<(Output, usize)>;
    /// What of a row is the same for all of its neighbours; it may replace numbers of the row's record.
    #[inline(always)]
    fn prepare<Row: Lane<Scalar = f64>, R: Record>(&self, _own: &mut [Row; MOST]) {}
    /// Adds a pair.
    fn pair<Row: Lane<Scalar = f64>, R: Record>(
        &self,
        apart: &Apart<Row>,
        own: &[Row; MOST],
        other: &[f64],
        sums: &mut [Row; MOST],
    );
    /// What of the sums is the same for all neighbours, and their order.
    #[inline(always)]
    fn finish<Row: Lane<Scalar = f64>>(&self, sums: &[Row; MOST]) -> [Row; MOST] {
        *sums
    }
}

/// The loop by hand around the sums of `W`.
struct ByHand<'a, W, R> {
    written: W,
    records: &'a [f64],
    lists: &'a ClusterLists,
    out: &'a mut [f64],
    width: usize,
    gradient: f64,
    by_divider: bool,
    record: PhantomData<R>,
}

/// Reads the records of a row. Never inlined, so that what is read lies in memory row by row.
#[inline(never)]
fn read<Row: Lane<Scalar = f64>>(
    records: &[f64],
    first: usize,
    stride: usize,
    own: &mut [Row; MOST],
) {
    for (k, value) in own.iter_mut().enumerate().take(stride) {
        *value = Row::from_fn(|lane| records[(first + lane) * stride + k]);
    }
}

impl<W: Written, R: Record> OnRows<f64> for ByHand<'_, W, R> {
    type Output = ();
    #[inline(always)]
    fn run<Row: Lane<Scalar = f64, Broadcast = f64>>(self) {
        let stride = const { R::FIELDS.width(3) };
        let place = const {
            if R::FIELDS.contains(Field::REFERENCE_POSITION) {
                R::FIELDS.offset(Field::REFERENCE_POSITION, 3)
            } else {
                R::FIELDS.offset(Field::POSITION, 3)
            }
        };
        let inverse = 1.0 / H;
        let mut near = [0_u32; BATCH];
        let mut own = [Row::zero(); MOST];
        for (chunk_at, chunk) in self.lists.chunks().iter().enumerate() {
            for (k, bounds) in chunk.starts.windows(2).enumerate() {
                let first = (chunk_at * CHUNK + k) * 8;
                read(self.records, first, stride, &mut own);
                self.written.prepare::<Row, R>(&mut own);
                let mut sums = [Row::zero(); MOST];
                for segment in &chunk.segments[bounds[0] as usize..bounds[1] as usize] {
                    let listed = &chunk.neighbors[segment.start as usize..segment.end as usize];
                    let staying = (segment.near_end - segment.start) as usize;
                    for (b, batch) in listed.chunks(BATCH).enumerate() {
                        let staying = staying.saturating_sub(b * BATCH).min(batch.len());
                        let records = (self.records, stride, place);
                        let count = within_reach(records, &own, (batch, staying), &mut near);
                        for &j in &near[..count] {
                            let other = &self.records[j as usize * stride..][..stride];
                            let mut r = [Row::zero(); 3];
                            for d in 0..3 {
                                r[d] = own[place + d] - Row::splat(other[place + d]);
                            }
                            let d2 = r[2].mul_add(r[2], r[1].mul_add(r[1], r[0] * r[0]));
                            let distance = if self.by_divider {
                                d2.sqrt()
                            } else {
                                d2.root()
                            };
                            let t = distance
                                .mul_add(Row::splat(-0.5 * inverse), Row::one())
                                .positive_part();
                            let t3 = t * t * t;
                            let one_and_twice =
                                distance.mul_add(Row::splat(2.0 * inverse), Row::one());
                            let apart = Apart {
                                r,
                                d2,
                                shape: t3 * t * one_and_twice,
                                f: t3 * Row::splat(-5.0 * self.gradient),
                            };
                            self.written.pair::<Row, R>(&apart, &own, other, &mut sums);
                        }
                    }
                }
                let row = &mut self.out[first * self.width..(first + 8) * self.width];
                let finished = self.written.finish(&sums);
                for (row, sum) in row.chunks_exact_mut(8).zip(&finished) {
                    sum.store(row);
                }
            }
        }
    }
}

type Composed<P> = FusedKernel<WendlandC2, P>;

/// Fields of terms: a mean, and by how much each component varies in space.
const VALUES: [(Field, f64, f64); 17] = [
    (Field::DYNAMIC_VISCOSITY, 1.0, 0.1),
    (Field::PRESSURE, 0.0, 1e4),
    (Field::ENERGY, 1e3, 1e2),
    (Field::CONSISTENCY_FACTOR, 1.0, 0.05),
    // Velocities of consistent shifting.
    (Field::vector(name!("shifting_velocity", "m/s")), 0.0, 0.1),
    // The deviatoric stress, the artificial one, and the mismatch of the hourglass-free form.
    (Field::tensor(name!("deviatoric_stress", "Pa")), 0.0, 1e6),
    (Field::tensor(name!("artificial_tension", "Pa")), 1e5, 1e5),
    (Field::vector(name!("hourglass_mismatch", "m")), 0.0, 0.01),
    // The corrected stress of total-Lagrangian solids, their deformation, and the stiffness of hourglass forces.
    (
        Field::matrix(name!("corrected_piola_stress", "Pa")),
        0.0,
        1e6,
    ),
    (Field::matrix(name!("deformation_gradient", "1")), 0.3, 1.0),
    (Field::scalar(name!("hourglass_stiffness", "Pa")), 1e8, 1e7),
    // Gradients, what corrects them, and what laws of viscosity keep of each particle.
    (Field::CORRECTION, 0.3, 1.0),
    (Field::PRESSURE_GRADIENT, 0.0, 1e3),
    (Field::DENSITY_GRADIENT, 0.0, 1.0),
    (Field::VELOCITY_GRADIENT, 0.0, 0.3),
    (Field::VISCOSITY_COEFFICIENT, 1.0, 0.5),
    (Field::DIVERGENCE, 0.0, 1.0),
];

fn fill(lattice: &mut Lattice<f64>, fields: Fields) {
    for slot in 0..lattice.columns.slots() {
        let x = lattice.columns.vectors(Field::POSITION)[slot];
        if fields.contains(Field::REFERENCE_POSITION) {
            let built = x.map(|x| x + 0.02 * (0.7 * x).sin());
            lattice.columns.vectors_mut(Field::REFERENCE_POSITION)[slot] = built;
        }
        if fields.contains(TwoPhase::PHASE) {
            // Two liquids side by side.
            let phase = if x[0] < 10.0 { 1000.0 } else { 1.0 };
            lattice.columns.raw_mut(TwoPhase::PHASE)[slot] = phase;
        }
        for (field, mean, part) in VALUES {
            if fields.contains(field) {
                let width = field.components(3);
                let own = &mut lattice.columns.raw_mut(field)[slot * width..][..width];
                for (k, value) in own.iter_mut().enumerate() {
                    *value = mean + part * (0.3 * x[k % 3] + k as f64).sin();
                }
            }
        }
    }
}

/// A row of the table: terms composed, over the loop by hand. Prints the median ratio and its interval, and returns the least that
/// it may be.
pub fn row<P: Terms<3>, W: Written>(
    name: &str,
    terms: P,
    written: W,
    side: usize,
    turns: usize,
) -> f64 {
    let sweep: Composed<P> = FusedKernel::new(WendlandC2, terms);
    let sweep: &dyn PairSweep<f64, 3> = &sweep;
    assert_eq!(sweep.fields(), Of::<P>::FIELDS, "the layout of records");
    let mut lattice = Lattice::<f64>::new(side, sweep.fields());
    fill(&mut lattice, sweep.fields());
    let slots = lattice.columns.slots();
    let input = lattice.input();
    let (mut records, mut rows) = (Records::default(), Results::default());
    sweep.pack(Pass::Rates, &input, &mut records);
    let outputs = W::outputs();
    let width = outputs.iter().map(|(_, components)| components).sum();
    let mut out = vec![0.0; width * slots];
    let ratios = ratios(
        turns,
        || sweep.run(Pass::Rates, &input, &records, &mut rows),
        || {
            InstructionSet::Avx512.run(ByHand {
                written,
                records: records.data(),
                lists: &lattice.lists,
                out: &mut out,
                width,
                gradient: norm() / H.powi(5),
                by_divider: input.root == Root::Divider,
                record: PhantomData::<Of<P>>,
            });
        },
    );
    assert_eq!(
        sweep.outputs().width(3),
        width,
        "all that the crate sums, and no more"
    );
    assert_same(&rows, &outputs, &out, slots);
    print!("{name}: ");
    print_ratio(&ratios)
}

/// The kernel's factor in front at h = 1.
pub fn norm() -> f64 {
    Kernel::<3>::normalisation(&WendlandC2)
}

/// One over the kernel's shape at the spacing, which is one here.
pub fn over_shape_at_spacing() -> f64 {
    1.0 / Kernel::<3>::shape(&WendlandC2, 1.0 / H)
}

/// Whether the machine has what the loops by hand are compiled for.
pub fn skipped() -> bool {
    let skipped = InstructionSet::detect() != InstructionSet::Avx512;
    if skipped {
        println!("\ncomposed against written out by hand: skipped, the machine has no AVX-512");
    }
    skipped
}
