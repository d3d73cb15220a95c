//! The area that a particle has of a free surface, by the gradient of a smoothed volume.
//! After Brackbill, Kothe & Zemach 1992 (J. Comput. Phys. 100, 335); the ramp and the factor are of this crate.

use super::shifting::{length, share};
use super::{Point, Reach};
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;
use crate::term::{Layout, Pair, Sums, Term, TermDoc};

/// Σⱼ Vⱼ ∇W.
pub(super) const GRADIENT: Output = Output::vector(name!("gradient of the volume", "1/m"));
/// |G| h at and below which a particle is within a body, and from which on it counts in full. Disorder makes about 0.05; the first
/// row at a flat surface has 0.3 to 0.65.
const SURFACE: [f64; 2] = [0.05, 0.15];

/// N, by which a flat surface along the lattice has its area. Row k has Gₖ = Σ of the layers that it lacks.
pub(super) fn area_factor(gradients: &[f64], h_over_dx: f64) -> f64 {
    let rows = gradients.iter();
    let counted = rows.map(|&own| own * share(SURFACE, own * h_over_dx));
    1.0 / counted.sum::<f64>()
}

/// A = N V f(|G| h) |G| \[mᴰ⁻¹\] with the factor N.
#[inline(always)]
pub(super) fn area_of_surface<L: Lane, const D: usize, P: Reach>(
    at: &Point<'_, L, D, P>,
    factor: f64,
) -> L {
    let size = length(&at.sum_vector(GRADIENT));
    let counted = share(SURFACE, size * at.smoothing_length());
    let volume = at.get(Field::MASS) / at.get(Field::DENSITY);
    L::of(factor) * volume * counted * size
}

/// Gᵢ = Σⱼ Vⱼ ∇W, for [`SurfaceHeat`](super::SurfaceHeat).
#[derive(Clone, Copy, Debug)]
pub struct VolumeGradient;

impl<const D: usize> Term<D> for VolumeGradient {
    const NAME: &'static str = "meshfree::volume_gradient";
    const READS: Fields = Fields::of(&[Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[GRADIENT]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let factor = pair.j(Field::MASS) / pair.j(Field::DENSITY) * pair.f_i;
        for d in 0..D {
            sums.add_product_at(GRADIENT, d, factor, pair.r[d]);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "gradient of the smoothed volume".into(),
            equation: "Gᵢ = Σⱼ Vⱼ ∇W",
            source: "Brackbill, Kothe & Zemach 1992",
        }
    }
}
