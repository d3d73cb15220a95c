//! Penalty contact: springs between particles that are nearer than a mean spacing, with damping and friction.
//! The node form of what LS-DYNA does between surfaces (Hallquist, Goudreau & Benson 1985).

#[cfg(feature = "devices")]
use super::CouplingRecord;
use super::friction::{Coulomb, Touch};
use super::spring::Spring;
use super::{CoupledPair, CoupledParticle, Coupling, PairForce, length, spacing};
use crate::scalar::{Lane, Real};
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

/// A pair that presses: the unit normal, its stiffness, the normal force, and the energy stored; no force where both are in one
/// place.
struct Pressed<L, const D: usize> {
    normal: [L; D],
    stiffness: L,
    pressing: L,
    stored: L,
}

impl<L: Lane, const D: usize> Pressed<L, D> {
    fn force(&self) -> [L; D] {
        self.normal.map(|n| self.pressing * n)
    }
}

impl Penalty {
    fn press<L: Lane, const D: usize>(&self, pair: &CoupledPair<L, D>) -> Pressed<L, D> {
        let (apart, spacing) = (pair.apart(), pair.spacing());
        let distance = length(&apart);
        let (there, none) = (distance.gt(L::zero()), L::zero());
        let normal = apart.map(|x| L::select(there, x / distance, none));
        let own = self.stiffness;
        let k = own.of::<L, D>(self.scale, pair.on.stiffness, spacing);
        let depth = spacing - distance;
        let mut pressing = k * depth;
        if self.damping > 0.0 {
            let c = L::of(2.0 * self.damping) * (k * pair.reduced_mass()).sqrt();
            let part = |d: usize| (pair.on.velocity[d] - pair.from.velocity[d]) * normal[d];
            pressing -= c * (0..D).map(part).fold(none, |sum, x| sum + x);
        }
        Pressed {
            normal,
            stiffness: k,
            pressing: L::select(there, pressing.max(none), none),
            stored: L::select(there, L::of(0.5) * (k * depth * depth), none),
        }
    }

    /// The largest stable step of a pair.
    fn stable<L: Lane, const D: usize>(
        &self,
        on: &CoupledParticle<L, D>,
        from: &CoupledParticle<L, D>,
    ) -> L {
        let spacing = spacing(on, from);
        let k = self.stiffness.of::<L, D>(self.scale, on.stiffness, spacing);
        L::of(0.5) * (on.mass.min(from.mass) / k).sqrt()
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
        let own = self.press(pair);
        let slide = self.friction.filter(|_| own.pressing > T::zero());
        let slide = slide.map(|law| {
            law.act(&Touch {
                apart: pair.apart(),
                normal: own.normal,
                pressing: own.pressing,
                stiffness: T::from_f64(0.5) * own.stiffness,
                anchor: pair.anchor,
            })
        });
        let slide = slide.unwrap_or(PairForce::of([T::zero(); D]));
        let force = own.force();
        PairForce {
            force: core::array::from_fn(|d| force[d] + slide.force[d]),
            stored: slide.stored + own.stored.to_f64(),
            ..slide
        }
    }
    fn step(&self, on: &CoupledParticle<T, D>, from: &CoupledParticle<T, D>) -> f64 {
        self.stable(on, from).to_f64()
    }
    #[cfg(feature = "devices")]
    fn record(&self) -> Option<CouplingRecord> {
        let act = |pair: &_| {
            let own = self.press(pair);
            (own.force(), own.stored)
        };
        let record = CouplingRecord::of::<D>(act, |on, from| self.stable(on, from));
        record.ok().filter(|_| self.friction.is_none())
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
