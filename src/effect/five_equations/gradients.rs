//! Gradients of what the five-equation model reconstructs, and how far the volume fraction goes up and down around a particle.
//! Randles & Libersky 1996.

use super::super::gradients::SINGULAR;
use super::super::{Point, PointLaw, Reach};
use super::{DENSITIES, FRACTION};
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;
use crate::tensor::Square;
use crate::term::{Layout, Pair, Sums, Term, TermDoc};

/// By how much the fraction of a neighbour is larger, and smaller, at most.
pub(super) const EXTREMES: [Field; 2] = [
    Field::scalar(name!("largest_rise_of_volume_fraction", "1")),
    Field::scalar(name!("largest_fall_of_volume_fraction", "1")),
];
const EXTREME_SUMS: [Output; 2] = [
    Output::scalar(name!("largest_rise_of_volume_fraction", "1")),
    Output::scalar(name!("largest_fall_of_volume_fraction", "1")),
];
/// What is reconstructed by gradients: densities and pressure.
pub(super) const SCALARS: [Field; 3] = [DENSITIES[0], DENSITIES[1], Field::PRESSURE];
pub(super) const GRADIENTS: [Field; 3] = [
    Field::vector(name!("gradient_of_density_of_liquid", "kg/m⁴")),
    Field::vector(name!("gradient_of_density_of_gas", "kg/m⁴")),
    Field::vector(name!("gradient_of_pressure_of_fluids", "Pa/m")),
];
pub(super) const VELOCITY_GRADIENT: Field =
    Field::matrix(name!("velocity_gradient_of_fluids", "1/s"));
/// Their sums before they are corrected.
const GRADIENT_SUMS: [Output; 3] = [
    Output::vector(name!("sum_of_gradient_of_density_of_liquid", "kg/m⁴")),
    Output::vector(name!("sum_of_gradient_of_density_of_gas", "kg/m⁴")),
    Output::PRESSURE_GRADIENT,
];
const VELOCITY_SUM: Output = Output::VELOCITY_GRADIENT;
const MOMENTS: Output = Output::MOMENT_MATRIX;

/// Sums of the gradients of what is reconstructed, over particles that are not of walls, and the extremes of the volume fraction.
#[derive(Clone, Copy, Debug)]
pub struct FluidGradients;

impl<const D: usize> Term<D> for FluidGradients {
    const NAME: &'static str = "meshfree::gradients_of_two_fluids";
    const READS: Fields = Fields::of(&[
        Field::WEIGHT,
        Field::VELOCITY,
        SCALARS[0],
        SCALARS[1],
        SCALARS[2],
        FRACTION,
    ]);
    const WRITES: Outputs = Outputs::of(&[
        GRADIENT_SUMS[0],
        GRADIENT_SUMS[1],
        GRADIENT_SUMS[2],
        VELOCITY_SUM,
        MOMENTS,
        EXTREME_SUMS[0],
        EXTREME_SUMS[1],
    ]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        // What walls have of it, a pressure and their own velocity, is not that of a fluid.
        let both = pair.mobile * pair.mobile_i;
        let weight = -both * pair.j(Field::WEIGHT) * pair.f;
        let near = L::select(pair.w.gt(L::zero()), both, L::zero());
        let rise = near * (pair.j(FRACTION) - pair.i(FRACTION));
        sums.raise(EXTREME_SUMS[0], rise);
        sums.raise(EXTREME_SUMS[1], -rise);
        for (field, sum) in SCALARS.into_iter().zip(GRADIENT_SUMS) {
            let rise = weight * (pair.i(field) - pair.j(field));
            for d in 0..D {
                sums.add_product_at(sum, d, rise, pair.r[d]);
            }
        }
        for a in 0..D {
            let (rise, along) = (weight * pair.v[a], weight * pair.r[a]);
            for b in 0..D {
                sums.add_product_at(VELOCITY_SUM, a * D + b, rise, pair.r[b]);
                sums.add_product_at(MOMENTS, a * D + b, along, pair.r[b]);
            }
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "sums of gradients of two fluids".into(),
            equation: "Σⱼ Vⱼ (qⱼ − qᵢ) ∇W, Σⱼ Vⱼ rⱼᵢ ⊗ ∇W",
            source: "Randles & Libersky 1996",
        }
    }
}

/// Gradients that are exact for linear fields, from their sums.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct CorrectedFluidGradients;

impl<const D: usize> PointLaw<D> for CorrectedFluidGradients {
    const NAME: &'static str = "gradients of two fluids";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[
        GRADIENTS[0],
        GRADIENTS[1],
        GRADIENTS[2],
        VELOCITY_GRADIENT,
        EXTREMES[0],
        EXTREMES[1],
    ]);
    const SUMS: Outputs = <FluidGradients as Term<D>>::WRITES;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let correction: Square<L, D> = at.sum_matrix(MOMENTS).inverse(SINGULAR).0;
        let velocities = at.sum_matrix(VELOCITY_SUM).times(&correction);
        at.set_matrix(VELOCITY_GRADIENT, &velocities);
        for (field, sum) in EXTREMES.into_iter().zip(EXTREME_SUMS) {
            at.set(field, at.sum(sum).positive_part());
        }
        for (field, sum) in GRADIENTS.into_iter().zip(GRADIENT_SUMS) {
            for b in 0..D {
                let mut total = L::zero();
                for a in 0..D {
                    total += at.sum_at(sum, a) * correction.0[a][b];
                }
                at.set_at(field, b, total);
            }
        }
    }
}
