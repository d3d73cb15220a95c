//! What loops that are written out by hand share with those of the crate: a block of particles off its lattice, its lists, the
//! neighbours of a row within reach, and the ratio of two times.

use meshfree::neighbors::{Block, ClusterLists, Radii, SearchInput};
use meshfree::particles::{Columns, Field, Fields, Output};
use meshfree::prelude::*;
use meshfree::scalar::{Lane, Mask};
use meshfree::sweep::{InstructionSet, Interaction, Results, Root, SweepInput};
use std::time::Instant;

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
            ghosts: None,
            images: &[],
            transforms: &[],
            lists: &self.lists,
            blocks: &self.blocks,
            interactions: &[Interaction::Bonded],
            smoothing_length: H,
            targets: self.blocks[0].slots.clone(),
            among: None,
            goes_on: false,
            body_force: [T::zero(); 3],
            lattice_consistency_factor: 1.0,
            instructions: InstructionSet::detect(),
            root: Root::detect(),
        }
    }
}

/// Neighbours that are looked through at once.
pub const BATCH: usize = 256;

/// Those of a batch of listed neighbours that are within reach of any of a row, whose places begin at `place` in records of
/// `stride` numbers; the first `staying` are taken as they are. Returns how many there are.
#[inline(always)]
pub fn within_reach<Row: Lane<Scalar = f64>>(
    (records, stride, place): (&[f64], usize, usize),
    own: &[Row],
    (batch, staying): (&[u32], usize),
    near: &mut [u32; BATCH],
) -> usize {
    let reach2 = Row::splat(4.004 * H * H);
    let mut count = staying;
    near[..count].copy_from_slice(&batch[..count]);
    for &j in &batch[count..] {
        let x = &records[j as usize * stride + place..][..3];
        let mut r2 = Row::zero();
        for d in 0..3 {
            let r = own[place + d] - Row::splat(x[d]);
            r2 = r.mul_add(r, r2);
        }
        near[count % BATCH] = j;
        count += usize::from(r2.lt(reach2).any());
    }
    count
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

/// Both loops make the same sums, or their comparison says nothing: those of outputs with so many components each lie behind each
/// other, a row of eight after the other.
pub fn assert_same(rows: &Results<f64, 3>, outputs: &[(Output, usize)], out: &[f64], slots: usize) {
    let width = out.len() / slots;
    let sums = outputs
        .iter()
        .flat_map(|&(output, components)| (0..components).map(move |d| (output, d)));
    for (k, (output, d)) in sums.enumerate() {
        let by_hand = |slot: usize| out[(slot / 8 * width + k) * 8 + slot % 8];
        let largest = (0..slots).fold(0.0_f64, |m, slot| m.max(by_hand(slot).abs()));
        for slot in 0..slots {
            let (a, b) = (rows.get(output, d, slot), by_hand(slot));
            // No contact is in the lattice; any other sum that is zero everywhere would hold nothing to the loop by hand.
            let absent = output == Output::CONTACT_SUM && a == 0.0 && b == 0.0;
            assert!(
                absent || (a - b).abs() < 1e-9 * largest,
                "sum {k} of slot {slot}: {a} and {b}"
            );
        }
    }
}
