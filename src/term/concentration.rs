//! The gradient of the concentration of particles, by which shifting moves them.
//! Lind, Xu, Stansby & Rogers 2012; Sun et al. 2017.

use super::{Layout, Pair, Sums, Term, TermDoc};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

/// The gradient of the concentration, Σⱼ Vⱼ (1 + R (W/W₀)ⁿ) ∇W with n = 4, and the first moment that
/// tells a free surface.
///
/// W₀ is the kernel at the spacing: the second summand keeps particles from pairing (Monaghan 2000;
/// Lind et al. 2012, eq. 24).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConcentrationGradient<const D: usize> {
    /// Strength R of the repulsion; 0.2.
    pub repulsion: f64,
    /// hᴰ W₀, the kernel in D dimensions at the spacing for h = 1.
    pub at_spacing: f64,
}

impl<const D: usize> Term<D> for ConcentrationGradient<D> {
    const NAME: &'static str = "meshfree::concentration_gradient";
    const READS: Fields = Fields::of(&[Field::WEIGHT]);
    const WRITES: Outputs = Outputs::of(&[Output::CONCENTRATION_GRADIENT, Output::MOMENT]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        // What all pairs share comes first, once.
        let ratio = pair.w * (pair.h.powi(D as u32) * L::of(1.0 / self.at_spacing));
        let square = ratio * ratio;
        let gradient = pair.j(Field::WEIGHT) * pair.f;
        let weighted = gradient * (square * square).mul_add(L::of(self.repulsion), L::one());
        for d in 0..D {
            sums.add_product_at(Output::CONCENTRATION_GRADIENT, d, weighted, pair.r[d]);
        }
        sums.add_product(Output::MOMENT, gradient * L::of(-1.0 / D as f64), pair.r2);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("concentration gradient, R = {}", self.repulsion),
            equation: "∇Cᵢ = Σⱼ Vⱼ (1 + R (W/W₀)⁴) ∇W",
            source: "Lind et al. 2012, eq. 24; Sun et al. 2017",
        }
    }
}

/// Nothing: the place of a term that a scheme does without.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nothing;

impl<const D: usize> Term<D> for Nothing {
    const NAME: &'static str = "meshfree::nothing";
    const READS: Fields = Fields::NONE;
    const WRITES: Outputs = Outputs::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, _pair: &Pair<'_, L, D, P>, _sums: &mut Sums<L, D, P>) {}
    fn document(&self) -> TermDoc {
        TermDoc {
            name: String::new(),
            equation: "",
            source: "",
        }
    }
}
