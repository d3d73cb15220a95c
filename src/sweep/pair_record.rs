//! What a sweep does with one pair, recorded: kernel, terms, directions and all, so that a device can run it.
//! It takes the text of the terms as it is, and turns their forces into vectors as the loop does.

use super::task::{Composed, MEAN, OWN, Shown, apply};
use crate::kernel::Kernel;
use crate::particles::{Field, Fields, Output, Outputs};
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
    /// The same across a contact that may open, where there are any.
    pub across: Option<Record>,
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
    contacts: bool,
) -> Result<PairRecord, Unrecordable> {
    let own = Composed::<T, P, D, HOW>::READS;
    // Whether particles are active in a contact is packed with what terms read.
    let reads = if contacts {
        own.union(Fields::of(&[Field::CONTACT_ACTIVITY]))
    } else {
        own
    };
    let (stride, width) = (reads.width(D), P::WRITES.width(D));
    let mut raised = 0;
    let mut of = |across: bool| {
        Record::of(2 * stride + PairRecord::shared(D), |given| {
            let (sums, maxima) = one_pair::<T, K, P, D, HOW>(kernel, terms, (reads, across), given);
            raised |= maxima;
            sums
        })
    };
    Ok(PairRecord {
        reads,
        writes: P::WRITES,
        record: of(false)?,
        across: contacts.then(|| of(true)).transpose()?,
        maxima: (0..width).map(|k| raised >> k & 1 == 1).collect(),
        listed: if reads.contains(Field::REFERENCE_POSITION) {
            Field::REFERENCE_POSITION
        } else {
            Field::POSITION
        },
        support: kernel.support(),
        uniform: HOW & (MEAN | OWN) == 0,
    })
}

/// What a pair adds to the sums of i, and which of them are maxima.
fn one_pair<T: Real, K: Kernel<D>, P: Terms<D>, const D: usize, const HOW: u8>(
    kernel: &K,
    terms: &P,
    (packed, across): (Fields, bool),
    given: &[Traced],
) -> (Vec<Traced>, u128) {
    let reads = Composed::<T, P, D, HOW>::READS;
    let (stride, width) = (packed.width(D), P::WRITES.width(D));
    // A gradient does not look across a contact that may open, unless it shares the sweep of what must.
    let one_sided =
        P::WRITES.contains(Output::MOMENT_MATRIX) && !P::WRITES.contains(Output::COMPRESSION);
    if across && one_sided {
        return (vec![Traced::of(0.0); width], 0);
    }
    let (mut i, mut j) = ([Traced::of(0.0); MOST_READS], [Traced::of(0.0); MOST_READS]);
    for field in reads.iter() {
        let (from, to) = (packed.offset(field, D), reads.offset(field, D));
        let count = field.components(D);
        i[to..to + count].copy_from_slice(&given[from..from + count]);
        j[to..to + count].copy_from_slice(&given[stride + from..stride + from + count]);
    }
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
    let (h, [w, w_j], [mut f, mut f_i, mut f_j]);
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
    if across {
        let at = packed.offset(Field::CONTACT_ACTIVITY, D);
        f_i *= given[at];
        f_j *= given[stride + at];
        f = (f_i + f_j) * half;
        Shown::across::<T, P, D, HOW, Traced>(&mut i);
        Shown::across::<T, P, D, HOW, Traced>(&mut j);
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
        gated: across,
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
    if across {
        sums.divert_kernel_sum(Traced::of(0.0));
    }
    (sums.kept[..width].to_vec(), sums.raised)
}
