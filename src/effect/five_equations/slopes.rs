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
pub(super) const ROOM: [Field; 2] = [
    Field::scalar(name!("largest_rise_of_volume_fraction", "1")),
    Field::scalar(name!("largest_fall_of_volume_fraction", "1")),
];
const MOST: [Output; 2] = [
    Output::scalar(name!("largest_rise_of_volume_fraction", "1")),
    Output::scalar(name!("largest_fall_of_volume_fraction", "1")),
];
/// What is reconstructed by gradients: densities and pressure.
pub(super) const SCALARS: [Field; 3] = [DENSITIES[0], DENSITIES[1], Field::PRESSURE];
pub(super) const SLOPES: [Field; 3] = [
    Field::vector(name!("gradient_of_density_of_liquid", "kg/m⁴")),
    Field::vector(name!("gradient_of_density_of_gas", "kg/m⁴")),
    Field::vector(name!("gradient_of_pressure_of_fluids", "Pa/m")),
];
pub(super) const TURNING: Field = Field::matrix(name!("velocity_gradient_of_fluids", "1/s"));
/// Their sums before they are corrected.
const RISES: [Output; 3] = [
    Output::vector(name!("rise_of_density_of_liquid", "kg/m⁴")),
    Output::vector(name!("rise_of_density_of_gas", "kg/m⁴")),
    Output::PRESSURE_GRADIENT,
];
const SHEAR: Output = Output::VELOCITY_GRADIENT;
const MOMENTS: Output = Output::MOMENT_MATRIX;
/// Differences to neighbours along the gradient of the kernel, of what is reconstructed.
#[derive(Clone, Copy, Debug)]
pub struct Rises;

impl<const D: usize> Term<D> for Rises {
    const NAME: &'static str = "meshfree::rises_of_two_fluids";
    const READS: Fields = Fields::of(&[
        Field::WEIGHT,
        Field::VELOCITY,
        SCALARS[0],
        SCALARS[1],
        SCALARS[2],
        FRACTION,
    ]);
    const WRITES: Outputs = Outputs::of(&[
        RISES[0], RISES[1], RISES[2], SHEAR, MOMENTS, MOST[0], MOST[1],
    ]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        // Walls have none of it but a pressure, of which gradients do without them.
        let both = pair.mobile * pair.mobile_i;
        let weight = -both * pair.j(Field::WEIGHT) * pair.f;
        let near = L::select(pair.w.gt(L::zero()), both, L::zero());
        let rise = near * (pair.j(FRACTION) - pair.i(FRACTION));
        sums.raise(MOST[0], rise);
        sums.raise(MOST[1], -rise);
        for (field, sum) in SCALARS.into_iter().zip(RISES) {
            let rise = weight * (pair.i(field) - pair.j(field));
            for d in 0..D {
                sums.add_product_at(sum, d, rise, pair.r[d]);
            }
        }
        for a in 0..D {
            let (rise, along) = (weight * pair.v[a], weight * pair.r[a]);
            for b in 0..D {
                sums.add_product_at(SHEAR, a * D + b, rise, pair.r[b]);
                sums.add_product_at(MOMENTS, a * D + b, along, pair.r[b]);
            }
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "rises of two fluids".into(),
            equation: "Σⱼ Vⱼ (qⱼ − qᵢ) ∇W, Σⱼ Vⱼ rⱼᵢ ⊗ ∇W",
            source: "Randles & Libersky 1996",
        }
    }
}

/// Gradients from the rises.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Slopes;

impl<const D: usize> PointLaw<D> for Slopes {
    const NAME: &'static str = "gradients of two fluids";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields =
        Fields::of(&[SLOPES[0], SLOPES[1], SLOPES[2], TURNING, ROOM[0], ROOM[1]]);
    const SUMS: Outputs = <Rises as Term<D>>::WRITES;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let correction: Square<L, D> = at.sum_matrix(MOMENTS).inverse(SINGULAR).0;
        let velocities = at.sum_matrix(SHEAR).times(&correction);
        at.set_matrix(TURNING, &velocities);
        for (field, sum) in ROOM.into_iter().zip(MOST) {
            at.set(field, at.sum(sum).positive_part());
        }
        for (field, sum) in SLOPES.into_iter().zip(RISES) {
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
