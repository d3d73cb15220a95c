//! Sponge layers: zones in which waves fade, as velocities relax towards those of still or streaming liquid.
//! Larsen & Dancy 1983 (Coastal Engineering 7, 341); the quadratic ramp of Altomare et al. 2017 (Coastal Engineering 127, 37).

use super::plane::{Layer, padded};
use super::{Effect, Point, PointLaw, PointLimit, Reach, Setting, StepProgram};
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::term::{Stage, TermDoc};

/// A layer that absorbs waves: velocities relax towards a given one, zero by default, at a rate that grows from a plane on.
///
#[doc = include_str!("../../docs/equations/sponge.html")]
///
/// with the force F \[N\] on a particle of mass m \[kg\] and velocity v \[m/s\], the velocity u \[m/s\] towards which it relaxes, the distance
/// d \[m\] beyond the plane, the thickness L \[m\] of the layer and the rate R \[1/s\] at its far side and behind it.
///
/// A flume ends in such a layer, with a wall behind it. A wave that passes it to the wall and back keeps exp(−∫ r dx/c_g) of its
/// amplitude with the group velocity c_g \[m/s\], which is exp(−R L/(3 c_g)) and needs a large R; a rate that grows within a small part of
/// a wave reflects. L of one wave length λ and R of its frequency ω reflect 3 % of waves in water of depth d at 2π d/λ = 1.5
/// (`tests/liquids`), L = λ/2 14 %: long waves need long layers. Sponges damp mean flows too: give a current as the velocity.
///
/// The force joins those of laws: its impulse is [`Ledger::law_impulse`](crate::simulation::Ledger::law_impulse), and its work that of
/// `work of laws` and [`EnergyLedger::law_work`](crate::simulation::EnergyLedger::law_work), negative where waves are absorbed. That is no
/// heat. The step is limited to a quarter of 1/r, so that the relaxation is stable with every integrator whatever R is; a rate that is
/// large enough for the limit to count reflects as a wall does. Particles that are clamped do not follow it.
///
/// ```
/// use meshfree::effect::Sponge;
/// use meshfree::prelude::*;
/// // Water that streams at 1 m/s through a layer at rest, in one dimension.
/// let water = catalogue::weakly_compressible_water(1.0);
/// let sponge = Sponge::beyond([0.0], [1.0], 0.1, 20.0).and(Sponge::beyond([1.0], [1.0], 0.1, 5.0));
/// let mut simulation = Scene::<f64, 1>::new(schemes::weakly_compressible().with(sponge))
///     .body(Body::block("water", water, [0.2], [0.4], 0.01).velocity([1.0]))
///     .build()?;
/// simulation.run_until(0.05)?;
/// let left = simulation.ledger().whole.momentum[0] / 200.0;
/// assert!((left - (-1.0_f64).exp()).abs() < 1e-3, "20 1/s for 0.05 s: {left}");
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Sponge {
    zones: Vec<Zone>,
}

/// A layer.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Zone {
    layer: Layer,
    rate: f64,
    velocity: [f64; 3],
}

impl Sponge {
    /// A layer beyond the plane through `place` \[m\], on the side to which `normal`, of any length, points. The rate grows to `rate`
    /// \[1/s\] over `thickness` \[m\], and stays behind.
    #[must_use]
    pub fn beyond<const D: usize>(
        place: [f64; D],
        normal: [f64; D],
        thickness: f64,
        rate: f64,
    ) -> Self {
        let zone = Zone {
            layer: Layer::new(place, normal, thickness),
            rate,
            velocity: [0.0; 3],
        };
        Self { zones: vec![zone] }
    }

    /// Sets the velocity \[m/s\] towards which that of particles relaxes; zero by default.
    #[must_use]
    pub fn velocity<const D: usize>(mut self, velocity: [f64; D]) -> Self {
        if let Some(own) = self.zones.last_mut() {
            own.velocity = padded(velocity);
        }
        self
    }

    /// Adds another layer, as at the other end. Where layers overlap their forces add.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.zones.extend(other.zones);
        self
    }
}

impl Zone {
    /// r \[1/s\] at a place that counts from an origin.
    #[inline(always)]
    fn rate<L: Lane, const D: usize>(&self, x: &[L; D], origin: &[f64; D]) -> L {
        self.layer.ramp(x, origin) * L::of(self.rate)
    }
}

impl<const D: usize> Effect<D> for Sponge {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::Rates, self.clone());
        program.limit(self.clone());
        for own in &self.zones {
            program.document(TermDoc {
                name: format!("sponge, {} m to {} 1/s", own.layer.thickness, own.rate),
                equation: "m dv/dt = … + m r (u − v), r = R min(max(d/L, 0), 1)²",
                source: "Larsen & Dancy 1983; Altomare et al. 2017",
            });
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = Vec::new();
        for own in &self.zones {
            problems.extend(own.layer.problems(D, "thickness of a sponge"));
            if !(own.rate.is_finite() && own.rate >= 0.0) {
                let must_be = "it must be finite and not negative, in 1/s";
                problems.push(("rate of a sponge", own.rate, must_be));
            }
            if let Some(bad) = own.velocity.into_iter().find(|v| !v.is_finite()) {
                let what = "velocity towards which a sponge relaxes";
                problems.push((what, bad, "it must be finite, in m/s"));
            }
        }
        problems
    }
}

impl<const D: usize> PointLaw<D> for Sponge {
    const NAME: &'static str = "sponge";
    const READS: Fields = Fields::of(&[Field::POSITION, Field::VELOCITY, Field::MASS]);
    const WRITES: Fields = Fields::of(&[Field::FORCE]);
    const ADDS: Fields = Fields::of(&[Field::FORCE]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (x, v) = (at.vector(Field::POSITION), at.vector(Field::VELOCITY));
        let mass = at.get(Field::MASS);
        for own in &self.zones {
            let rate = mass * own.rate(&x, &at.around.origin);
            for d in 0..D {
                at.add_at(Field::FORCE, d, rate * (L::of(own.velocity[d]) - v[d]));
            }
        }
    }
}

impl<const D: usize> PointLimit<D> for Sponge {
    const NAME: &'static str = "sponge: 0.25/r";
    const READS: Fields = Fields::of(&[Field::POSITION]);
    #[inline(always)]
    fn step<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>) -> L {
        let x = at.vector(Field::POSITION);
        let mut rate = L::zero();
        for own in &self.zones {
            rate += own.rate(&x, &at.around.origin);
        }
        // Infinite where nothing is damped.
        L::of(0.25) / rate
    }
}
