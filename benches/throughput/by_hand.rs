//! Pair terms of liquids, any of them, beside a loop that is written out by hand for just these: what composing costs.
//! Both loops share lists, kernel, rows and root; that of the crate sums both sides of a pair at once.

use super::lattice::{BATCH, H, Lattice, assert_same, print_ratio, ratios, within_reach};
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree::neighbors::{CHUNK, ClusterLists};
use meshfree::particles::{Field, Fields, Output};
use meshfree::scalar::{Lane, OnRows};
use meshfree::sweep::{
    FusedKernel, InstructionSet, PairSweep, Pass, Records, Results, Root, SmoothingMode,
};
use meshfree::term::viscosity::MonaghanGingold;
use meshfree::term::{PressureForce, Terms, Viscosity};

const ALPHA: f64 = 0.02;
pub const DELTA: f64 = 0.1;
pub const SHARE: f64 = 0.3;

/// What a loop does beside pressure, or beside compression.
pub const VISCOSITY: u8 = 1;
pub const LAMINAR: u8 = 2;
pub const TENSION: u8 = 4;
pub const DIFFUSION: u8 = 8;
/// Compression in place of forces.
pub const CONTINUITY: u8 = 16;

/// The loop by hand: forces (three sums and, with an artificial viscosity, a maximum), or compression (and diffusion).
struct ByHand<'a, const WHAT: u8> {
    records: &'a [f64],
    lists: &'a ClusterLists,
    out: &'a mut [f64],
    fields: Fields,
    norm: f64,
    over_kernel_at_spacing: f64,
    by_divider: bool,
}

/// Most numbers of a record.
const MOST: usize = 24;

impl<const WHAT: u8> ByHand<'_, WHAT> {
    const SUMS: usize = if WHAT & CONTINUITY == 0 {
        3 + (WHAT & VISCOSITY != 0) as usize
    } else {
        1 + (WHAT & DIFFUSION != 0) as usize
    };
}

impl<const WHAT: u8> OnRows<f64> for ByHand<'_, WHAT> {
    type Output = ();
    #[inline(always)]
    fn run<Row: Lane<Scalar = f64, Broadcast = f64>>(self) {
        let stride = self.fields.width(3);
        let at = |field: Field| self.fields.offset(field, 3);
        let (v, m, rho, c) = (
            at(Field::VELOCITY),
            at(Field::MASS),
            at(Field::DENSITY),
            at(Field::SOUND_SPEED),
        );
        let (weight, coefficient) = (at(Field::WEIGHT), at(Field::PRESSURE_COEFFICIENT));
        let (mu, p) = (at(Field::DYNAMIC_VISCOSITY), at(Field::PRESSURE));
        let inverse = 1.0 / H;
        let [value, gradient] = [self.norm * inverse.powi(3), self.norm * inverse.powi(5)];
        let mut near = [0_u32; BATCH];
        for (chunk_at, chunk) in self.lists.chunks().iter().enumerate() {
            for (k, bounds) in chunk.starts.windows(2).enumerate() {
                let first = (chunk_at * CHUNK + k) * 8;
                let mut own = [Row::zero(); MOST];
                for (k, value) in own[..stride].iter_mut().enumerate() {
                    *value = Row::from_fn(|lane| self.records[(first + lane) * stride + k]);
                }
                let mut sums = [Row::zero(); 4];
                for segment in &chunk.segments[bounds[0] as usize..bounds[1] as usize] {
                    let listed = &chunk.neighbors[segment.start as usize..segment.end as usize];
                    let staying = (segment.near_end - segment.start) as usize;
                    for (b, batch) in listed.chunks(BATCH).enumerate() {
                        let staying = staying.saturating_sub(b * BATCH).min(batch.len());
                        let records = (self.records, stride, 0);
                        let count = within_reach(records, &own, (batch, staying), &mut near);
                        for &j in &near[..count] {
                            let other = &self.records[j as usize * stride..][..stride];
                            let mut r = [Row::zero(); 3];
                            let mut jump = [Row::zero(); 3];
                            for d in 0..3 {
                                r[d] = own[d] - Row::splat(other[d]);
                                if WHAT & (VISCOSITY | LAMINAR | CONTINUITY) != 0 {
                                    jump[d] = own[v + d] - Row::splat(other[v + d]);
                                }
                            }
                            let d2 = r[2].mul_add(r[2], r[1].mul_add(r[1], r[0] * r[0]));
                            let vr = jump[2].mul_add(r[2], jump[1].mul_add(r[1], jump[0] * r[0]));
                            let distance = if self.by_divider {
                                d2.sqrt()
                            } else {
                                d2.root()
                            };
                            let t = distance
                                .mul_add(Row::splat(-0.5 * inverse), Row::one())
                                .positive_part();
                            let t3 = t * t * t;
                            let f = t3 * Row::splat(-5.0 * gradient);
                            if WHAT & CONTINUITY != 0 {
                                let share = Row::splat(other[weight]) * f;
                                sums[0] = share.mul_add(vr, sums[0]);
                                if WHAT & DIFFUSION != 0 {
                                    let rate = share * (Row::splat(2.0 * DELTA * H) / own[c]);
                                    let apart = own[p] - Row::splat(other[p]);
                                    // Without a body force nothing is hydrostatic.
                                    sums[1] = rate.mul_add(apart, sums[1]);
                                }
                                continue;
                            }
                            let weights = own[weight] * Row::splat(other[weight]);
                            let stress = own[coefficient] + Row::splat(other[coefficient]);
                            let mut along = weights * stress;
                            if WHAT & VISCOSITY != 0 {
                                let sounds = own[c] + Row::splat(other[c]);
                                let densities = own[rho] + Row::splat(other[rho]);
                                let over_h = d2.mul_add(Row::splat(inverse), Row::splat(0.01 * H));
                                let approach = vr.min(Row::zero()) / (over_h * densities);
                                let speed = sounds * Row::splat(ALPHA);
                                let masses = own[m] * Row::splat(other[m]);
                                along = masses.mul_add(-(approach * speed), along);
                                let inside = f.lt(Row::zero());
                                let signal = speed * Row::splat(0.3);
                                sums[3] = sums[3].max(Row::select(inside, signal, Row::zero()));
                            }
                            if WHAT & TENSION != 0 {
                                // The kernel over its value at the spacing, to the fourth power.
                                let w = t3
                                    * t
                                    * (distance + distance)
                                        .mul_add(Row::splat(inverse), Row::one());
                                let scale = value * H * H * H * self.over_kernel_at_spacing;
                                let ratio = w * Row::splat(scale);
                                let square = ratio * ratio;
                                let tension =
                                    (-own[p]).positive_part() + Row::splat((-other[p]).max(0.0));
                                let pull = tension * Row::splat(SHARE) * (square * square);
                                along = weights.mul_add(pull, along);
                            }
                            let radial = -(along * f);
                            for d in 0..3 {
                                sums[d] = radial.mul_add(r[d], sums[d]);
                            }
                            if WHAT & LAMINAR != 0 {
                                let [mine, its] = [own[mu], Row::splat(other[mu])];
                                let mean = (mine + mine) * its / (mine + its);
                                let volumes = own[m] * Row::splat(other[m])
                                    / (own[rho] * Row::splat(other[rho]));
                                let shear = (volumes + volumes) * mean * f;
                                for d in 0..3 {
                                    sums[d] = shear.mul_add(jump[d], sums[d]);
                                }
                            }
                        }
                    }
                }
                let row = &mut self.out[first * Self::SUMS..(first + 8) * Self::SUMS];
                for (k, sum) in sums[..Self::SUMS].iter().enumerate() {
                    sum.store(&mut row[k * 8..]);
                }
            }
        }
    }
}

type Composed<P> = FusedKernel<WendlandC2, P, { SmoothingMode::Uniform.bit() }>;

/// A row: the terms composed, over the loop for `WHAT` by hand. Prints the median ratio and its interval, and returns the least
/// that it may be.
pub fn row<P: Terms<3>, const WHAT: u8>(name: &str, terms: P, side: usize, turns: usize) -> f64 {
    let sweep: Composed<P> = FusedKernel::new(WendlandC2, terms, SmoothingMode::Uniform);
    let sweep: &dyn PairSweep<f64, 3> = &sweep;
    let mut lattice = Lattice::<f64>::new(side, sweep.fields());
    let slots = lattice.columns.slots();
    for slot in 0..slots {
        let x = lattice.columns.vectors(Field::POSITION)[slot];
        for (field, value) in [
            (Field::DYNAMIC_VISCOSITY, 1.0 + 0.1 * (0.2 * x[1]).cos()),
            (Field::PRESSURE, 1e4 * (0.3 * x[0]).sin()),
        ] {
            if let Some(own) = lattice.columns.raw_mut(field).get_mut(slot) {
                *own = value;
            }
        }
    }
    let input = lattice.input();
    let (mut records, mut rows) = (Records::default(), Results::default());
    sweep.pack(Pass::Rates, &input, &mut records);
    assert_eq!(
        records.data().len(),
        sweep.fields().width(3) * slots,
        "the layout of records"
    );
    let width = ByHand::<WHAT>::SUMS;
    let mut out = vec![0.0; width * slots];
    let ratios = ratios(
        turns,
        || sweep.run(Pass::Rates, &input, &records, &mut rows),
        || {
            InstructionSet::Avx512.run(ByHand::<WHAT> {
                records: records.data(),
                lists: &lattice.lists,
                out: &mut out,
                fields: sweep.fields(),
                norm: Kernel::<3>::normalisation(&WendlandC2),
                over_kernel_at_spacing: over_kernel_at_spacing(),
                by_divider: input.root == Root::Divider,
            });
        },
    );
    let count = |of: u8| usize::from(WHAT & of != 0);
    let outputs: &[(Output, usize)] = if WHAT & CONTINUITY == 0 {
        &[(Output::FORCE, 3), (Output::SIGNAL, count(VISCOSITY))]
    } else {
        &[
            (Output::COMPRESSION, 1),
            (Output::DENSITY_DIFFUSION, count(DIFFUSION)),
        ]
    };
    assert_same(&rows, outputs, &out, slots);
    print!("{name}: ");
    print_ratio(&ratios)
}

/// One over hᴰ W of the spacing, which is one here.
pub fn over_kernel_at_spacing() -> f64 {
    let kernel = WendlandC2;
    1.0 / (Kernel::<3>::normalisation(&kernel) * Kernel::<3>::shape(&kernel, 1.0 / H))
}

pub fn viscosity() -> Viscosity<MonaghanGingold> {
    Viscosity(MonaghanGingold {
        alpha: ALPHA,
        beta: 0.0,
    })
}

/// Whether the machine has what the loops by hand are compiled for.
pub fn skipped() -> bool {
    let skipped = InstructionSet::detect() != InstructionSet::Avx512;
    if skipped {
        println!("\ncomposed against written out by hand: skipped, the machine has no AVX-512");
    }
    skipped
}

/// Pressure and artificial viscosity alone: what the gate holds.
pub fn forces(side: usize, turns: usize) -> f64 {
    if skipped() {
        return 1.0;
    }
    let terms = (PressureForce, viscosity());
    row::<_, VISCOSITY>("composed over written out by hand", terms, side, turns)
}
