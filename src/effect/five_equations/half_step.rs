//! Fluids half a step ahead, from which fluxes are taken, so that a step is of second order in time.
//! van Leer 1984 (SIAM J. Sci. Stat. Comput. 5, 1), after Hancock; rates of the model of Allaire, Clerc & Kokh 2002 in these quantities.

use super::super::{Point, PointLaw, Reach, Rung};
use super::gradients::{GRADIENTS, SCALARS, VELOCITY_GRADIENT};
use crate::name;
use crate::particles::{Field, Fields};
use crate::scalar::Lane;

/// Velocity half a step ahead \[m/s\].
pub(super) const HALF_STEP_VELOCITY: Field =
    Field::vector(name!("velocity_half_a_step_ahead", "m/s"));

/// Carries densities, pressure and velocity half a step on by their gradients:
/// dρₖ/dt = −ρₖ ∇·u, dp/dt = −ρ c² ∇·u, du/dt = −∇p/ρ along the flow.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct HalfStep;

impl<const D: usize> PointLaw<D> for HalfStep {
    const NAME: &'static str = "two fluids half a step ahead";
    const READS: Fields = Fields::of(&[
        Field::VELOCITY,
        Field::DENSITY,
        Field::SOUND_SPEED,
        SCALARS[0],
        SCALARS[1],
        SCALARS[2],
        GRADIENTS[0],
        GRADIENTS[1],
        GRADIENTS[2],
        VELOCITY_GRADIENT,
    ]);
    const WRITES: Fields = Fields::of(&[SCALARS[0], SCALARS[1], SCALARS[2], HALF_STEP_VELOCITY]);
    const RUNG: Option<Rung> = Some(Rung::Flow);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (half, velocity) = (L::of(0.5) * at.dt(), at.vector(Field::VELOCITY));
        let (density, sound) = (at.get(Field::DENSITY), at.get(Field::SOUND_SPEED));
        let mut divergence = L::zero();
        for d in 0..D {
            divergence += at.get_at(VELOCITY_GRADIENT, d * D + d);
        }
        for a in 0..D {
            let mut rate = at.get_at(GRADIENTS[2], a) / density;
            for b in 0..D {
                rate += velocity[b] * at.get_at(VELOCITY_GRADIENT, a * D + b);
            }
            at.set_at(HALF_STEP_VELOCITY, a, velocity[a] - half * rate);
        }
        let stiffness = [
            at.get(SCALARS[0]),
            at.get(SCALARS[1]),
            density * sound * sound,
        ];
        for ((field, gradient), stiffness) in SCALARS.into_iter().zip(GRADIENTS).zip(stiffness) {
            let mut rate = stiffness * divergence;
            for d in 0..D {
                rate += velocity[d] * at.get_at(gradient, d);
            }
            at.set(field, at.get(field) - half * rate);
        }
    }
}
