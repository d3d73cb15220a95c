//! The work of pair forces in a kick: the terms of the rates again, with their forces turned into power.
//! Power is linear in velocity, so one pass serves the two kicks that share the forces of an evaluation.

use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;
use crate::term::{Layout, Pair, Sums, TermUse, Terms};

/// The terms of rates, of which the power with the mean velocities v̄ of a kick is summed (Owen 2014), and what it gains
/// with their accelerations a: of −½ Fᵢⱼ·v̄ᵢⱼ and −½ Fᵢⱼ·aᵢⱼ the first is that of the kick, and the first with τ of the
/// second that of another one with mean velocities v̄ + τ a and the same forces. What terms add to power by themselves
/// belongs to the first.
#[derive(Clone, Debug)]
#[repr(transparent)]
pub(super) struct Working<P>(P);

impl<P> Working<P> {
    /// The same terms, seen as their work.
    pub fn of(terms: &P) -> &Self {
        // SAFETY: a transparent wrapper has the layout of what it holds.
        unsafe { &*core::ptr::from_ref(terms).cast() }
    }
}

const SUMS: Outputs = Outputs::of(&[Output::POWER, Output::POWER_OF_ACCELERATION]);

impl<P: Terms<D>, const D: usize> Terms<D> for Working<P> {
    const READS: Fields = P::READS.union(Fields::of(&[
        Field::MEAN_VELOCITY,
        Field::MEAN_ACCELERATION,
    ]));
    const WRITES: Outputs = SUMS;
    const TENSILE: Fields = P::TENSILE;
    #[inline(always)]
    fn pair<L: Lane, C: Layout>(&self, pair: &Pair<'_, L, D, C>, sums: &mut Sums<L, D, C>) {
        self.0.pair(pair, sums);
        if const { !P::WRITES.contains(Output::FORCE) } {
            return;
        }
        sums.settle(pair.f);
        let (mut work, mut gained) = (L::zero(), L::zero());
        for d in 0..D {
            let free = sums.force.plus(d, L::zero());
            let force = sums
                .radial
                .mul_add(pair.r[d], sums.shear.mul_add(pair.v[d], free));
            let (v, a) = (Field::MEAN_VELOCITY, Field::MEAN_ACCELERATION);
            work = force.mul_add(pair.j_at(v, d) - pair.i_at(v, d), work);
            gained = force.mul_add(pair.j_at(a, d) - pair.i_at(a, d), gained);
        }
        sums.add(Output::POWER, work * L::of(0.5));
        sums.add(Output::POWER_OF_ACCELERATION, gained * L::of(0.5));
    }
    fn uses(&self) -> Vec<TermUse> {
        self.0.uses()
    }
}
