//! Pressure force and compression with gradients that are exact for linear fields.
//! Randles & Libersky 1996; the renormalised formulations of LS-DYNA.

use super::{Layout, Pair, Sums, Term, TermDoc};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

/// L ∇W, with L of i or j as `value` gives its entries.
///
/// Loops, because a closure is compiled without the wider instructions of the pair loop unless it is
/// inlined, and then calls a function for every fused product: 8 times slower.
#[inline(always)]
pub(crate) fn corrected<L: Lane, const D: usize>(
    r: &[L; D],
    f: L,
    value: impl Fn(usize) -> L,
) -> [L; D] {
    let mut gradient = [L::zero(); D];
    for (a, gradient) in gradient.iter_mut().enumerate() {
        for (b, r) in r.iter().enumerate() {
            *gradient = value(a * D + b).mul_add(*r, *gradient);
        }
        *gradient *= f;
    }
    gradient
}

/// The pressure force with the corrected gradient of each side:
/// mᵢ dvᵢ/dt = −Σⱼ Bᵢ Bⱼ (Xᵢ Lᵢ + Xⱼ Lⱼ) ∇W, L the inverse of −Σ V r ⊗ ∇W.
///
/// Opposite for the two sides, so linear momentum is conserved. It does not point along the line of
/// centres, but with weights by volume the torques of a particle's neighbours cancel, because L is the
/// inverse of their moment: angular momentum is conserved too (Bonet & Lok 1999). With weights by mass it
/// is not, where densities differ.
#[derive(Clone, Copy, Debug)]
pub struct RenormalisedPressureForce;

impl<const D: usize> Term<D> for RenormalisedPressureForce {
    const NAME: &'static str = "meshfree::renormalised_pressure_force";
    const READS: Fields = Fields::of(&[
        Field::WEIGHT,
        Field::PRESSURE_COEFFICIENT,
        Field::CORRECTION,
    ]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let weights = pair.i(Field::WEIGHT) * pair.j(Field::WEIGHT);
        let own = corrected(&pair.r, pair.weight_i(), |k| {
            pair.i_at(Field::CORRECTION, k)
        });
        let other = corrected(&pair.r, pair.weight_j(), |k| {
            pair.j_at(Field::CORRECTION, k)
        });
        let (x_i, x_j) = (
            weights * pair.i(Field::PRESSURE_COEFFICIENT),
            weights * pair.j(Field::PRESSURE_COEFFICIENT),
        );
        for d in 0..D {
            let force = x_i.mul_add(own[d], x_j * other[d]);
            sums.force.add(d, -force);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "renormalised pressure force".into(),
            equation: "mᵢ dvᵢ/dt = −Σⱼ Bᵢ Bⱼ (Xᵢ Lᵢ + Xⱼ Lⱼ) ∇Wᵢⱼ",
            source: "Randles & Libersky 1996; Bonet & Lok 1999",
        }
    }
}

/// Σⱼ Bⱼ vᵢⱼ·Lᵢ ∇W: the rate of compression, exact for linear velocities.
#[derive(Clone, Copy, Debug)]
pub struct RenormalisedCompression;

impl<const D: usize> Term<D> for RenormalisedCompression {
    const NAME: &'static str = "meshfree::renormalised_compression";
    const READS: Fields = Fields::of(&[Field::VELOCITY, Field::WEIGHT, Field::CORRECTION]);
    const WRITES: Outputs = Outputs::of(&[Output::COMPRESSION]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let gradient = corrected(&pair.r, pair.weight(), |k| pair.i_at(Field::CORRECTION, k));
        let mut along = L::zero();
        for d in 0..D {
            along = pair.v[d].mul_add(gradient[d], along);
        }
        sums.add(Output::COMPRESSION, pair.j(Field::WEIGHT) * along);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "renormalised rate of compression".into(),
            equation: "−∇·v = Σⱼ Vⱼ vᵢⱼ·Lᵢ ∇Wᵢⱼ",
            source: "Randles & Libersky 1996",
        }
    }
}
