//! Penalty contact: springs between particles that are nearer than a mean spacing, with damping and friction.
//! The node form of what LS-DYNA does between surfaces (Hallquist, Goudreau & Benson 1985).

use super::friction::{Coulomb, Touch};
use super::spring::Spring;
use super::{CoupledPair, CoupledParticle, Coupling, PairForce};
use crate::scalar::Real;
use crate::term::TermDoc;

/// Pushes apart pairs that are nearer than the mean spacing s \[m\] of their bodies.
///
/// F = max(0, k (s − r) − c v_n),  k = M s^(D−2),  c = 2 ζ √(k m),  1/m = 1/mᵢ + 1/mⱼ
///
/// along the line of the pair, with r \[m\] its distance, v_n \[m/s\] the speed at which it parts, and M \[Pa\] the
/// harmonic mean of the ρc² of both bodies. A layer of such springs between two lattices that stand face to face is as
/// stiff as the spacing of material that it stands for, so it reflects no wave. ζ is zero and there is no friction
/// unless asked for.
///
/// Lattices that are out of step meet later, by 0.13 s in two dimensions, so a face that slides goes over bumps, which
/// [`ContactDensity`](super::ContactDensity) has not. Between particles that are single layers, as strips and wires, it
/// is the one that holds.
///
/// ```
/// use meshfree::coupling::Penalty;
/// use meshfree::prelude::*;
/// let block = |name: &str, low: f64| Body::block(name, catalogue::copper(), [low], [low + 0.01], 2e-4);
/// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
///     .body(block("left", 0.0).velocity([20.0]))
///     .body(block("right", 0.01))
///     .couple("left", "right", Penalty::new().damping(0.1))
///     .build()?;
/// simulation.run_until(1e-6)?;
/// assert!(simulation.contacts()[0].largest_penetration > 0.0);
/// # Ok::<(), Error>(())
/// ```
///
/// Source: Hallquist, Goudreau & Benson 1985 (Comput. Methods Appl. Mech. Eng. 51, 107), whose stiffness is a share of
/// K A²/V of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Penalty {
    stiffness: Spring,
    scale: f64,
    damping: f64,
    friction: Option<Coulomb>,
}

impl Default for Penalty {
    fn default() -> Self {
        Self {
            stiffness: Spring::default(),
            scale: 1.0,
            damping: 0.0,
            friction: None,
        }
    }
}

impl Penalty {
    /// By the stiffness of the bodies, without damping and friction.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
    /// The stiffness k \[N/m\] (N/m per metre in 2D, per m² in 1D) of a pair; by default that of the bodies.
    #[must_use]
    pub fn stiffness(self, stiffness: f64) -> Self {
        let stiffness = Spring(Some(stiffness));
        Self { stiffness, ..self }
    }
    /// Takes a share of the bodies' stiffness, k = f M s^(D−2), as the scale factor of a segment's stiffness in LS-DYNA, which is
    /// 0.1 there and one here if not given. What is softer sinks in deeper, by p/(f M) spacings under the pressure p.
    #[must_use]
    pub fn scale(self, scale: f64) -> Self {
        Self { scale, ..self }
    }
    /// Damping ζ as a share of the critical; zero if not given.
    #[must_use]
    pub fn damping(self, damping: f64) -> Self {
        Self { damping, ..self }
    }
    /// [Coulomb friction](Coulomb) with a coefficient μ, and k/2 as tangential stiffness.
    #[must_use]
    pub fn friction(self, mu: f64) -> Self {
        let friction = Some(Coulomb { mu });
        Self { friction, ..self }
    }
}

impl<T: Real, const D: usize> Coupling<T, D> for Penalty {
    fn name(&self) -> &'static str {
        "penalty"
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: Coupling::<T, D>::name(self).into(),
            equation: "F = max(0, k (s − r) − c v_n) r/|r|, k = M s^(D−2)",
            source: "Hallquist, Goudreau & Benson 1985",
        }
    }
    fn books_energy(&self) -> bool {
        true
    }
    fn reach(&self, spacings: [f64; 2]) -> f64 {
        0.5 * (spacings[0] + spacings[1])
    }
    fn act(&self, pair: &CoupledPair<T, D>) -> PairForce<T, D> {
        let (apart, spacing) = (pair.apart(), pair.spacing());
        let distance = apart.iter().fold(T::zero(), |sum, x| sum + *x * *x).sqrt();
        if distance == T::zero() {
            return PairForce::of([T::zero(); D]);
        }
        let normal = apart.map(|x| x / distance);
        let (k, depth) = (
            self.stiffness
                .of::<T, D>(self.scale, pair.on.stiffness, spacing),
            spacing - distance,
        );
        let mut pressing = k * depth;
        if self.damping > 0.0 {
            let c = T::from_f64(2.0 * self.damping) * (k * pair.reduced_mass()).sqrt();
            let part = |d: usize| (pair.on.velocity[d] - pair.from.velocity[d]) * normal[d];
            pressing -= c * (0..D).map(part).sum::<T>();
        }
        let pressing = pressing.max(T::zero());
        let slide = self.friction.filter(|_| pressing > T::zero()).map(|law| {
            law.act(&Touch {
                apart,
                normal,
                pressing,
                stiffness: T::from_f64(0.5) * k,
                anchor: pair.anchor,
            })
        });
        let slide = slide.unwrap_or(PairForce::of([T::zero(); D]));
        PairForce {
            force: core::array::from_fn(|d| pressing * normal[d] + slide.force[d]),
            stored: slide.stored + 0.5 * (k * depth * depth).to_f64(),
            ..slide
        }
    }
    fn step(&self, on: &CoupledParticle<T, D>, from: &CoupledParticle<T, D>) -> f64 {
        let spacing = T::from_f64(0.5) * (on.spacing + from.spacing);
        let mass = on.mass.min(from.mass);
        0.5 * (mass / self.stiffness.of::<T, D>(self.scale, on.stiffness, spacing))
            .sqrt()
            .to_f64()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = Coulomb::problems(self.friction);
        problems.extend(self.stiffness.problems());
        if !(self.scale.is_finite() && self.scale > 0.0) {
            problems.push((
                "scale of the stiffness",
                self.scale,
                "it must be finite and positive",
            ));
        }
        if !(self.damping.is_finite() && self.damping >= 0.0) {
            let must_be = "it must be a share of critical damping, not negative";
            problems.push(("damping", self.damping, must_be));
        }
        problems
    }
}
