//! What a sweep does with one pair, recorded: kernel, terms, directions and all, so that a device can run it.
//! It takes the text of the terms as it is, and turns their forces into vectors as the loop does.

use super::task::{Composed, MEAN, OWN, apply};
use crate::kernel::Kernel;
use crate::particles::{Field, Fields, Outputs};
use crate::scalar::{Lane, Real, Record, Traced, Unrecordable};
use crate::term::{Layout, MOST_READS, Pair, Sums, Terms};
use core::marker::PhantomData;

/// One pair of a sweep, recorded.
///
/// Its inputs are the fields of i, those of j, and then [what all pairs share](Self::shared): one or zero as i and as j moves by
/// forces, the smoothing length \[m\] where it is one for all, the lattice consistency factor, and the body force \[m/s²\].
/// Its results are what the pair adds to the sums of i.
#[derive(Clone, Debug)]
pub struct PairRecord {
    /// What is read of i and of j.
    pub reads: Fields,
    /// What is summed.
    pub writes: Outputs,
    /// Which results are maxima, and not added.
    pub maxima: Vec<bool>,
    /// The field whose distance decides which pairs act.
    pub listed: Field,
    /// The radius of the kernel in smoothing lengths.
    pub support: f64,
    /// Whether one smoothing length serves all: what is beyond its support adds nothing.
    pub uniform: bool,
    /// What is done.
    pub record: Record,
}

impl PairRecord {
    /// How many inputs all pairs share, in `d` dimensions.
    #[must_use]
    pub const fn shared(d: usize) -> usize {
        4 + d
    }
}

/// Records a pair of terms under a kernel.
pub(super) fn record<T: Real, K: Kernel<D>, P: Terms<D>, const D: usize, const HOW: u8>(
    kernel: &K,
    terms: &P,
) -> Result<PairRecord, Unrecordable> {
    let reads = Composed::<T, P, D, HOW>::READS;
    let (stride, width) = (reads.width(D), P::WRITES.width(D));
    let mut raised = 0;
    let record = Record::of(2 * stride + PairRecord::shared(D), |given| {
        let (mut i, mut j) = ([Traced::of(0.0); MOST_READS], [Traced::of(0.0); MOST_READS]);
        i[..stride].copy_from_slice(&given[..stride]);
        j[..stride].copy_from_slice(&given[stride..2 * stride]);
        let shared = &given[2 * stride..];
        let apart = |field: Field| -> [Traced; D] {
            let at = reads.offset(field, D);
            core::array::from_fn(|d| i[at + d] - j[at + d])
        };
        let dot = |a: &[Traced; D], b: &[Traced; D]| {
            (1..D).fold(a[0] * b[0], |sum, d| a[d].mul_add(b[d], sum))
        };
        let mut r = apart(Field::POSITION);
        if reads.contains(Field::POSITION_RESIDUAL) {
            let lost = apart(Field::POSITION_RESIDUAL);
            r = core::array::from_fn(|d| r[d] + lost[d]);
        }
        let v = if reads.contains(Field::VELOCITY) {
            apart(Field::VELOCITY)
        } else {
            [Traced::of(0.0); D]
        };
        let r2 = dot(&r, &r);
        let distance = if reads.contains(Field::REFERENCE_POSITION) {
            let apart = apart(Field::REFERENCE_POSITION);
            dot(&apart, &apart).root()
        } else {
            r2.root()
        };
        let norm = Traced::of(kernel.normalisation());
        let under = |h: Traced| {
            let inverse = h.recip();
            let scale = norm * inverse.powi(D as u32);
            let w = scale * kernel.shape(distance * inverse);
            (
                w,
                kernel.gradient(distance, inverse, scale * inverse * inverse),
            )
        };
        let half = Traced::of(0.5);
        let (h_i, h_j) = if HOW & (MEAN | OWN) == 0 {
            (shared[2], shared[2])
        } else {
            let at = reads.offset(Field::SMOOTHING_LENGTH, D);
            (i[at], j[at])
        };
        let (h, [w, w_j], [f, f_i, f_j]);
        if HOW & OWN != 0 {
            h = (h_i + h_j) * half;
            let (own, other) = (under(h_i), under(h_j));
            [w, w_j] = [own.0, other.0];
            [f, f_i, f_j] = [(own.1 + other.1) * half, own.1, other.1];
        } else {
            h = if HOW & MEAN == 0 {
                h_i
            } else {
                (h_i + h_j) * half
            };
            let both = under(h);
            [w, w_j] = [both.0; 2];
            [f, f_i, f_j] = [both.1; 3];
        }
        let pair = Pair::<Traced, D, Composed<T, P, D, HOW>> {
            r,
            r2,
            v,
            v_dot_r: dot(&v, &r),
            h,
            h_i,
            w,
            w_j,
            f,
            f_i,
            f_j,
            mobile: shared[1],
            mobile_i: shared[0],
            body_force: core::array::from_fn(|d| shared[4 + d]),
            lattice_consistency_factor: shared[3],
            gated: false,
            swapped: false,
            i: &i,
            j: &j,
            layout: PhantomData,
        };
        let mut sums = Sums::new();
        sums.next_pair();
        terms.pair(&pair, &mut sums);
        sums.settle(pair.f);
        apply::<_, D, _, false>(&pair, &mut sums);
        raised = sums.raised;
        sums.kept[..width].to_vec()
    })?;
    Ok(PairRecord {
        reads,
        writes: P::WRITES,
        maxima: (0..width).map(|k| raised >> k & 1 == 1).collect(),
        listed: if reads.contains(Field::REFERENCE_POSITION) {
            Field::REFERENCE_POSITION
        } else {
            Field::POSITION
        },
        support: kernel.support(),
        uniform: HOW & (MEAN | OWN) == 0,
        record,
    })
}
