//! One pair on its own: what a test of a term looks at.
//! The crate holds all its terms to one contract with it; a user's own terms can be held to the same.

use super::{Layout, MOST_READS, MOST_SUMS, Pair, Sums, Term, assert_room};
use crate::kernel::Kernel;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;
use core::marker::PhantomData;

/// What a term makes of one pair, or of a row of pairs with the same j.
#[derive(Clone, Debug)]
pub struct Probe<L, const D: usize> {
    /// Force on i along rᵢⱼ, divided by rᵢⱼ \[N/m\].
    pub radial: L,
    /// Force on i along vᵢⱼ, divided by vᵢⱼ \[N s/m\].
    pub shear: L,
    /// Force on i in any other direction \[N\].
    pub force: [L; D],
    sums: [L; MOST_SUMS],
    kept: Outputs,
}

impl<L: Lane, const D: usize> Probe<L, D> {
    /// Component `k` of what was added to a sum: one of the crate, declared by the term or not, or one of its
    /// own that it declares. Forces are not among the sums: see `radial`, `shear` and `force`.
    #[must_use]
    pub fn sum(&self, output: Output, k: usize) -> L {
        if self.kept.contains(output) {
            self.sums[self.kept.offset(output, D) + k]
        } else {
            L::zero()
        }
    }
}

/// The layout of one term, with every sum kept so that one that is not declared shows.
struct Alone<A, const D: usize>(PhantomData<A>);

impl<const D: usize, A: Term<D>> Layout for Alone<A, D> {
    const READS: Fields = A::READS.union(Fields::of(&[
        Field::POSITION,
        Field::VELOCITY,
        Field::SMOOTHING_LENGTH,
    ]));
    const WRITES: Outputs = Outputs::ALL.union(A::WRITES);
    const ONE_GRADIENT: bool = true;
}

/// Evaluates one term for one pair under `kernel` with the mean of the two smoothing lengths, and a body
/// force of 1 m/s² along the first axis.
/// `i` and `j` give component k of a field. With [`Traced`](crate::scalar::Traced) numbers it records the term
/// ([`Record`](crate::scalar::Record)).
///
/// ```
/// use meshfree::kernel::CubicSpline;
/// use meshfree::particles::Output;
/// use meshfree::term::{KernelSum, probe};
/// let at = |x: f64| move |field: meshfree::particles::Field, _| match field.name() {
///     "position" => x,
///     _ => 1.0,
/// };
/// let near = probe::<f64, 1, _, _>(&KernelSum, &CubicSpline, at(0.0), at(0.5));
/// assert_eq!(near.sum(Output::KERNEL_SUM, 0), 2.0 / 3.0 * (1.0 - 1.5 * 0.25 + 0.75 * 0.125));
/// ```
#[must_use]
pub fn probe<L: Lane, const D: usize, K: Kernel<D>, A: Term<D>>(
    term: &A,
    kernel: &K,
    i: impl Fn(Field, usize) -> L,
    j: impl Fn(Field, usize) -> L::Broadcast,
) -> Probe<L, D> {
    const { assert_room::<Alone<A, D>, D>() }
    let reads = <Alone<A, D> as Layout>::READS;
    let Between {
        r,
        r2,
        v,
        v_dot_r,
        h,
        h_i,
        w,
        f,
        body_force,
        own,
        other,
    } = Between::new(kernel, reads, &i, &j);
    let pair = Pair::<L, D, Alone<A, D>> {
        r,
        r2,
        v,
        v_dot_r,
        h,
        h_i,
        w,
        w_j: w,
        f,
        f_i: f,
        f_j: f,
        mobile: L::one(),
        mobile_i: L::one(),
        body_force,
        lattice_consistency_factor: L::one(),
        gated: false,
        swapped: false,
        i: &own,
        j: &other,
        layout: PhantomData,
    };
    let mut sums = Sums::new();
    term.pair(&pair, &mut sums);
    sums.settle(pair.f);
    Probe {
        radial: sums.radial.value(),
        shear: sums.shear.value(),
        force: sums.force.value(),
        sums: sums.kept,
        kept: <Alone<A, D> as Layout>::WRITES,
    }
}

/// The numbers of a pair, whatever its term: so that they are compiled once for all.
struct Between<L: Lane, const D: usize> {
    r: [L; D],
    r2: L,
    v: [L; D],
    v_dot_r: L,
    h: L,
    h_i: L,
    w: L,
    f: L,
    body_force: [L; D],
    own: [L; MOST_READS],
    other: [L::Broadcast; MOST_READS],
}

impl<L: Lane, const D: usize> Between<L, D> {
    fn new<K: Kernel<D>>(
        kernel: &K,
        reads: Fields,
        i: &dyn Fn(Field, usize) -> L,
        j: &dyn Fn(Field, usize) -> L::Broadcast,
    ) -> Self {
        let (mut own, mut other) = ([L::zero(); MOST_READS], [j(Field::POSITION, 0); MOST_READS]);
        for field in reads.iter() {
            for k in 0..field.components(D) {
                own[reads.offset(field, D) + k] = i(field, k);
                other[reads.offset(field, D) + k] = j(field, k);
            }
        }
        let apart =
            |field| -> [L; D] { core::array::from_fn(|k| i(field, k) - L::broadcast(j(field, k))) };
        let dot = |a: [L; D], b: [L; D]| (1..D).fold(a[0] * b[0], |sum, d| a[d].mul_add(b[d], sum));
        let (r, v) = (apart(Field::POSITION), apart(Field::VELOCITY));
        let r2 = dot(r, r);
        let distance2 = if reads.contains(Field::REFERENCE_POSITION) {
            let apart = apart(Field::REFERENCE_POSITION);
            dot(apart, apart)
        } else {
            r2
        };
        let h_i = i(Field::SMOOTHING_LENGTH, 0);
        let h = (h_i + L::broadcast(j(Field::SMOOTHING_LENGTH, 0))) * L::of(0.5);
        let inverse = h.recip();
        let q = distance2.sqrt() * inverse;
        let norm = L::of(kernel.normalisation()) * inverse.powi(D as u32);
        Self {
            r,
            r2,
            v,
            v_dot_r: dot(v, r),
            h,
            h_i,
            w: norm * kernel.shape(q),
            f: norm * inverse * inverse * kernel.slope_over_q(q),
            body_force: core::array::from_fn(|d| if d == 0 { L::one() } else { L::zero() }),
            own,
            other,
        }
    }
}
