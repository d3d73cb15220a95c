//! The velocity gradient and the moment matrix that makes it exact for linear fields.
//! Randles & Libersky 1996; Bonet & Lok 1999.

use super::{Layout, Pair, Sums, Term, TermDoc};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

/// The two sums of the velocity gradient. It is the first times the inverse of the second, and exact
/// for a linear field on any arrangement of particles.
///
#[doc = include_str!("../../docs/equations/gradient.html")]
#[derive(Clone, Copy, Debug)]
pub struct VelocityGradient;

impl<const D: usize> Term<D> for VelocityGradient {
    const NAME: &'static str = "meshfree::velocity_gradient";
    const READS: Fields = Fields::of(&[Field::VELOCITY, Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[Output::VELOCITY_GRADIENT, Output::MOMENT_MATRIX]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let factor = -pair.j(Field::MASS) / pair.j(Field::DENSITY) * pair.weight();
        for a in 0..D {
            for b in 0..D {
                let gradient = factor * pair.r[b];
                sums.add_product_at(Output::VELOCITY_GRADIENT, a * D + b, pair.v[a], gradient);
                sums.add_product_at(Output::MOMENT_MATRIX, a * D + b, pair.r[a], gradient);
            }
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "corrected velocity gradient".into(),
            equation: "∇v = [Σⱼ Vⱼ (vⱼ − vᵢ) ⊗ ∇W] [−Σⱼ Vⱼ rᵢⱼ ⊗ ∇W]⁻¹",
            source: "Randles & Libersky 1996; Bonet & Lok 1999",
        }
    }
}

/// −Σⱼ Vⱼ rᵢⱼ ⊗ ∇W, whose inverse makes sums of gradients exact for linear fields.
#[derive(Clone, Copy, Debug)]
pub struct MomentMatrix;

impl<const D: usize> Term<D> for MomentMatrix {
    const NAME: &'static str = "meshfree::moment_matrix";
    const READS: Fields = Fields::of(&[Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[Output::MOMENT_MATRIX]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let factor = -pair.j(Field::MASS) / pair.j(Field::DENSITY) * pair.weight();
        for a in 0..D {
            for b in 0..D {
                let gradient = factor * pair.r[b];
                sums.add_product_at(Output::MOMENT_MATRIX, a * D + b, pair.r[a], gradient);
            }
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "correction of gradients".into(),
            equation: "L = [−Σⱼ Vⱼ rᵢⱼ ⊗ ∇W]⁻¹",
            source: "Randles & Libersky 1996; Bonet & Lok 1999",
        }
    }
}

/// Σⱼ Vⱼ (pⱼ − pᵢ) ∇W; times the inverse of the moment matrix it is the gradient of the pressure.
#[derive(Clone, Copy, Debug)]
pub struct PressureGradient;

impl<const D: usize> Term<D> for PressureGradient {
    const NAME: &'static str = "meshfree::pressure_gradient";
    const READS: Fields = Fields::of(&[Field::PRESSURE, Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[Output::PRESSURE_GRADIENT, Output::MOMENT_MATRIX]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        // The products of the moment matrix, which are made once for both.
        let factor = -pair.j(Field::MASS) / pair.j(Field::DENSITY) * pair.weight();
        let difference = pair.i(Field::PRESSURE) - pair.j(Field::PRESSURE);
        for a in 0..D {
            let gradient = factor * pair.r[a];
            sums.add_product_at(Output::PRESSURE_GRADIENT, a, difference, gradient);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "corrected pressure gradient".into(),
            equation: "∇p = [Σⱼ Vⱼ (pⱼ − pᵢ) ∇W] [−Σⱼ Vⱼ rᵢⱼ ⊗ ∇W]⁻¹",
            source: "Randles & Libersky 1996; Bonet & Lok 1999",
        }
    }
}

/// Σⱼ Vⱼ (ρⱼ − ρᵢ) ∇W with the moment matrix; together they are the gradient of the density.
#[derive(Clone, Copy, Debug)]
pub struct DensityGradient;

impl<const D: usize> Term<D> for DensityGradient {
    const NAME: &'static str = "meshfree::density_gradient";
    const READS: Fields = Fields::of(&[Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[Output::DENSITY_GRADIENT, Output::MOMENT_MATRIX]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let density = pair.j(Field::DENSITY);
        // The density of a wall does not follow from the flow.
        let factor = -pair.j(Field::MASS) / density * (pair.weight() * pair.mobile);
        let difference = pair.i(Field::DENSITY) - density;
        for b in 0..D {
            let gradient = factor * pair.r[b];
            sums.add_product_at(Output::DENSITY_GRADIENT, b, difference, gradient);
            for a in 0..D {
                sums.add_product_at(Output::MOMENT_MATRIX, a * D + b, pair.r[a], gradient);
            }
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "corrected density gradient".into(),
            equation: "∇ρ = [Σⱼ Vⱼ (ρⱼ − ρᵢ) ∇W] [−Σⱼ Vⱼ rᵢⱼ ⊗ ∇W]⁻¹",
            source: "Randles & Libersky 1996; Antuono et al. 2010",
        }
    }
}
