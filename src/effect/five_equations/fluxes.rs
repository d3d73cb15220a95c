//! What particles of the five-equation model pass to each other, and what they make of it.
//! Toro, Spruce & Speares 1994; Vila 1999; Johnsen & Colonius 2006.

use super::super::{Point, PointLaw, Reach, Rung};
use super::gradients::{EXTREMES, GRADIENTS, SCALARS, VELOCITY_GRADIENT};
use super::half_step::HALF_STEP_VELOCITY;
use super::{FRACTION, FiveEquations, LIQUID};
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;
use crate::term::{Layout, Pair, Sums, Term, TermDoc};

/// Rates of a particle: mass and that of its liquid \[kg/s\], momentum over that of the mass \[N\], total energy over that of the
/// mass \[W\], volume fraction \[1/s\].
const MASS: Output = Output::scalar(name!("mass_of_fluids", "kg/s"));
const LIQUID_MASS: Output = Output::scalar(name!("mass_of_liquid", "kg/s"));
const MOMENTUM: Output = Output::vector(name!("momentum_of_fluids", "N"));
const ENERGY: Output = Output::scalar(name!("energy_of_fluids", "W"));
const CARRIED: Output = Output::scalar(name!("carried_volume_fraction", "1/s"));

/// Half the slope at a particle towards a neighbour: half the harmonic mean of the difference `ahead` and of that behind, which with it makes `twice` the
/// slope of the gradient (van Leer 1979).
#[inline(always)]
fn half_by_van_leer<L: Lane>(ahead: L, twice: L) -> L {
    let behind = twice - ahead;
    let product = ahead * behind;
    let alike = product.gt(L::zero());
    let sum = L::select(alike, twice, L::one());
    L::select(alike, product, L::zero()) / sum
}

/// What of the difference to a neighbour the fraction at the middle takes: all of it, which makes it that of downwind and keeps interfaces sharp, but no
/// more than by which the fraction changes on the other side, so that no particle gives what it does not have (Després & Lagoutière 2001).
#[inline(always)]
fn limited_downwind<L: Lane>(ahead: L, above: L, below: L) -> L {
    let rises = ahead.gt(L::zero());
    let part = ahead.abs().min(L::select(rises, below, above));
    L::select(rises, part, -part)
}

/// Mass, momentum, energy and volume fraction that a pair of particles of [`FiveEquations`] passes to each other.
#[derive(Clone, Copy, Debug)]
pub struct FluidFluxes(pub FiveEquations);

/// One side of the Riemann problem at the middle of a pair.
#[derive(Clone, Copy)]
struct Side<L, const D: usize> {
    fraction: L,
    liquid: L,
    density: L,
    pressure: L,
    velocity: [L; D],
    along: L,
    sound: L,
    slope: L,
    stored: L,
}

impl FluidFluxes {
    #[inline(always)]
    fn side<L: Lane, const D: usize>(
        &self,
        fraction: L,
        [liquid, gas, pressure]: [L; 3],
        velocity: [L; D],
        normal: &[L; D],
    ) -> Side<L, D> {
        let fraction = fraction.max(L::zero());
        let partial = fraction * liquid;
        let density = (L::one() - fraction).mul_add(gas, partial);
        let mixed = self.0.mixed(fraction);
        let squared = self.0.squared_speed(mixed, pressure, density);
        let mut along = L::zero();
        for d in 0..D {
            along = velocity[d].mul_add(normal[d], along);
        }
        Side {
            fraction,
            liquid: partial,
            density,
            pressure,
            velocity,
            along,
            sound: squared.max(L::of(self.0.slowest())).sqrt(),
            slope: mixed[0],
            stored: mixed[1],
        }
    }
}

impl<const D: usize> Term<D> for FluidFluxes {
    const NAME: &'static str = "meshfree::fluxes_of_two_fluids";
    const READS: Fields = Fields::of(&[
        Field::WEIGHT,
        Field::VELOCITY,
        Field::ENERGY,
        SCALARS[0],
        SCALARS[1],
        SCALARS[2],
        GRADIENTS[0],
        GRADIENTS[1],
        GRADIENTS[2],
        VELOCITY_GRADIENT,
        HALF_STEP_VELOCITY,
        FRACTION,
        EXTREMES[0],
        EXTREMES[1],
    ]);
    const WRITES: Outputs = Outputs::of(&[MASS, LIQUID_MASS, MOMENTUM, ENERGY, CARRIED]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let apart = pair.r2.gt(L::zero());
        let distance = L::select(apart, pair.r2, L::one()).sqrt();
        let mut normal = [L::zero(); D];
        for d in 0..D {
            normal[d] = -pair.r[d] / distance;
        }
        let (mut at_i, mut at_j) = ([L::zero(); 3], [L::zero(); 3]);
        for k in 0..3 {
            let (mut twice_i, mut twice_j) = (L::zero(), L::zero());
            for d in 0..D {
                twice_i = pair.i_at(GRADIENTS[k], d).mul_add(pair.r[d], twice_i);
                twice_j = pair.j_at(GRADIENTS[k], d).mul_add(pair.r[d], twice_j);
            }
            let (own, other) = (pair.i(SCALARS[k]), pair.j(SCALARS[k]));
            let ahead = other - own;
            at_i[k] = own + half_by_van_leer(ahead, L::of(-2.0) * twice_i);
            at_j[k] = other - half_by_van_leer(ahead, L::of(-2.0) * twice_j);
        }
        let (own, other) = (pair.i(FRACTION), pair.j(FRACTION));
        let ahead = other - own;
        let from_i = own + limited_downwind(ahead, pair.i(EXTREMES[0]), pair.i(EXTREMES[1]));
        let from_j = other + limited_downwind(-ahead, pair.j(EXTREMES[0]), pair.j(EXTREMES[1]));
        let (mut u_i, mut u_j) = ([L::zero(); D], [L::zero(); D]);
        for a in 0..D {
            let (mut twice_i, mut twice_j) = (L::zero(), L::zero());
            for b in 0..D {
                twice_i = pair
                    .i_at(VELOCITY_GRADIENT, a * D + b)
                    .mul_add(pair.r[b], twice_i);
                twice_j = pair
                    .j_at(VELOCITY_GRADIENT, a * D + b)
                    .mul_add(pair.r[b], twice_j);
            }
            let (own, other) = (
                pair.i_at(HALF_STEP_VELOCITY, a),
                pair.j_at(HALF_STEP_VELOCITY, a),
            );
            let ahead = other - own;
            u_i[a] = own + half_by_van_leer(ahead, L::of(-2.0) * twice_i);
            u_j[a] = other - half_by_van_leer(ahead, L::of(-2.0) * twice_j);
        }
        let left = self.side(from_i, at_i, u_i, &normal);
        let right = self.side(from_j, at_j, u_j, &normal);
        // Waves to both sides, no faster than they are and none that runs away from the middle.
        let slowest = (left.along - left.sound)
            .min(right.along - right.sound)
            .min(L::zero());
        let fastest = (left.along + left.sound)
            .max(right.along + right.sound)
            .max(L::zero());
        let (from_left, from_right) = (
            left.density * (slowest - left.along),
            right.density * (fastest - right.along),
        );
        let contact = (right.pressure - left.pressure + from_left * left.along
            - from_right * right.along)
            / (from_left - from_right);
        let ahead = contact.gt(L::zero());
        let take = |a: L, b: L| L::select(ahead, a, b);
        let wave = take(slowest, fastest);
        let along = take(left.along, right.along);
        let density = take(left.density, right.density);
        let pressure = take(left.pressure, right.pressure);
        let liquid = take(left.liquid, right.liquid);
        let fraction = take(left.fraction, right.fraction);
        // The velocity with which what is upwind passes the middle, and the pressure there.
        let jump = contact - along;
        let ratio = (wave - along) / (wave - contact);
        let passing = contact * ratio;
        let behind = wave * density * ratio * jump;
        let wall = pair.mobile.lt(L::of(0.5));
        // At a wall the pressure that stops what comes: a Riemann problem with the image of i.
        let stopped = at_i[2] + left.density * left.sound * left.along;
        let passing = L::select(wall, L::zero(), passing);
        let pushing = L::select(wall, stopped, pressure + behind);
        let area = L::of(-2.0)
            * pair.mobile_i
            * pair.i(Field::WEIGHT)
            * pair.j(Field::WEIGHT)
            * pair.f
            * L::select(apart, distance, L::zero())
            / pair.lattice_consistency_factor;
        let flow = area * passing;
        let mass = flow * density;
        sums.add(MASS, -mass);
        sums.add(LIQUID_MASS, -(flow * liquid));
        let (mut square, mut own_square) = (L::zero(), L::zero());
        for d in 0..D {
            let (velocity, own) = (
                take(left.velocity[d], right.velocity[d]),
                pair.i_at(Field::VELOCITY, d),
            );
            square += velocity * velocity;
            own_square += own * own;
            let momentum = mass * (velocity - own) + area * pushing * normal[d];
            sums.add_at(MOMENTUM, d, -momentum);
        }
        let (slope, stored) = (
            take(left.slope, right.slope),
            take(left.stored, right.stored),
        );
        let internal = pressure * slope + stored - self.0.at_rest(liquid, density - liquid);
        let half = L::of(0.5);
        let enthalpy = internal + half * density * square + pressure;
        let energy = flow * enthalpy + area * L::select(wall, L::zero(), behind * contact);
        let own = pair.i(Field::ENERGY) + half * own_square;
        sums.add(ENERGY, mass * own - energy);
        let carried = flow * (fraction - pair.i(FRACTION)) / pair.i(Field::WEIGHT);
        sums.add(CARRIED, -carried);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "fluxes of two fluids".into(),
            equation: "d(V U)ᵢ/dt = −Σⱼ 2 Vᵢ Vⱼ G(Uᵢ, Uⱼ)·∇W/s, dαᵢ/dt = −Σⱼ 2 Vⱼ (α − αᵢ) u*·∇W/s",
            source: "Vila 1999; Johnsen & Colonius 2006; Toro et al. 1994",
        }
    }
}

/// Gives each particle what the others have passed to it, and holds fractions between zero and one.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct FluidExchange;

impl<const D: usize> PointLaw<D> for FluidExchange {
    const NAME: &'static str = "exchange of two fluids";
    const READS: Fields = Fields::of(&[
        Field::WEIGHT,
        Field::MASS,
        Field::VELOCITY,
        Field::ENERGY,
        FRACTION,
        LIQUID,
    ]);
    const WRITES: Fields = Fields::of(&[
        Field::MASS,
        Field::DENSITY,
        Field::VELOCITY,
        Field::ENERGY,
        FRACTION,
        LIQUID,
    ]);
    const SUMS: Outputs = Outputs::of(&[MASS, LIQUID_MASS, MOMENTUM, ENERGY, CARRIED]);
    const RUNG: Option<Rung> = Some(Rung::Flow);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let mass = at.get(Field::MASS) + at.dt() * at.sum(MASS);
        let (step, half) = (at.dt() / mass, L::of(0.5));
        let (mut before, mut after) = (L::zero(), L::zero());
        for d in 0..D {
            let own = at.get_at(Field::VELOCITY, d);
            let velocity = own + step * at.sum_at(MOMENTUM, d);
            before += own * own;
            after += velocity * velocity;
            at.set_at(Field::VELOCITY, d, velocity);
        }
        let energy = at.get(Field::ENERGY) + step * at.sum(ENERGY) + half * (before - after);
        at.set(Field::ENERGY, energy);
        at.set(Field::MASS, mass);
        at.set(Field::DENSITY, mass / at.get(Field::WEIGHT));
        let liquid = at.get(LIQUID) + at.dt() * at.sum(LIQUID_MASS);
        at.set(LIQUID, liquid);
        let fraction = at.get(FRACTION) + at.dt() * at.sum(CARRIED);
        // A millionth beyond is rounding, and more is counted.
        let (least, most) = (L::of(-1e-6), L::of(1.0 + 1e-6));
        at.limited(fraction.lt(least) | fraction.gt(most));
        at.set(FRACTION, fraction.max(L::zero()).min(L::one()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_field_is_met_in_the_middle_and_an_extreme_is_left() {
        // Differences of 2 on both sides, of 2 and 6, and of 2 and −2.
        approx::assert_relative_eq!(half_by_van_leer(2.0, 4.0), 1.0);
        approx::assert_relative_eq!(half_by_van_leer(2.0, 8.0), 1.5);
        assert_eq!(half_by_van_leer(2.0, 0.0), 0.0);
        assert_eq!(half_by_van_leer(0.0, 0.0), 0.0);
    }

    #[test]
    fn the_fraction_is_that_of_downwind_as_far_as_it_is_there() {
        assert_eq!(limited_downwind(0.5, 0.5, 0.7), 0.5);
        assert_eq!(limited_downwind(0.5, 0.5, 0.1), 0.1);
        assert_eq!(limited_downwind(-0.5, 0.2, 0.5), -0.2);
        // A particle without liquid gives none.
        assert_eq!(limited_downwind(1.0, 1.0, 0.0), 0.0);
    }
}
