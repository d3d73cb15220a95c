//! The pressure force between particles, and the energy it costs.
//! One pair law serves every density form: the form sets weights and coefficients (Bonet & Lok 1999).

use super::{Layout, Pair, Sums, Term, TermDoc};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

/// Fᵢⱼ = −Bᵢ Bⱼ (Xᵢ ∇W(hᵢ) + Xⱼ ∇W(hⱼ)).
///
/// | density form | B | X | becomes |
/// |---|---|---|---|
/// | summation | m | p/ρ² | −mᵢmⱼ (pᵢ/ρᵢ² + pⱼ/ρⱼ²) ∇W |
/// | number density | V₀ | p (ρ₀/ρ)²/M | pV² form, normalised |
/// | continuity | V | p/s | −VᵢVⱼ (pᵢ + pⱼ) ∇W, normalised |
///
/// It is the derivative of the internal energy with respect to positions under the matching density,
/// so energy is conserved by the pair, and linear and angular momentum by symmetry.
#[derive(Clone, Copy, Debug)]
pub struct PressureForce;

impl<const D: usize> Term<D> for PressureForce {
    const READS: Fields = Fields::of(&[Field::Weight, Field::PressureCoefficient]);
    const WRITES: Outputs = Outputs::of(&[Output::Force]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let stress = pair
            .i(Field::PressureCoefficient)
            .mul_add(pair.f_i, pair.j(Field::PressureCoefficient) * pair.f_j);
        sums.radial -= pair.i(Field::Weight) * pair.j(Field::Weight) * stress;
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "pressure force".into(),
            equation: "mᵢ dvᵢ/dt = −Σⱼ Bᵢ Bⱼ (Xᵢ + Xⱼ) ∇Wᵢⱼ",
            source: "Bonet & Lok 1999; Lam, Shen & Gong 2002, eq. 20",
        }
    }
}

/// mᵢ deᵢ/dt = −½ Σⱼ Fᵢⱼ·vᵢⱼ: each side of a pair takes half the work of all its forces.
///
/// The term names the sum; the sweep fills it from whatever forces the other terms set, so total
/// energy is conserved in continuous time for any list of terms.
#[derive(Clone, Copy, Debug)]
pub struct InternalEnergy;

impl<const D: usize> Term<D> for InternalEnergy {
    const READS: Fields = Fields::of(&[Field::Velocity]);
    const WRITES: Outputs = Outputs::of(&[Output::Power]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, _pair: &Pair<'_, L, D, P>, _sums: &mut Sums<L, D, P>) {}
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "internal energy".into(),
            equation: "mᵢ deᵢ/dt = −½ Σⱼ Fᵢⱼ·vᵢⱼ",
            source: "Monaghan & Gingold 1983; Lam, Shen & Gong 2002, eq. 21",
        }
    }
}
