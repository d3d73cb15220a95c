//! Contact by density: what kernel sums over the other body find beyond a face that only touches makes a pressure.
//! After Wu, Zhang, Kong & Hu 2026 and the contact forces of SPHinXsys, in a form that derives from an energy.

#[cfg(feature = "devices")]
use super::CouplingRecord;
use super::friction::{Coulomb, Touch};
use super::{CoupledPair, CoupledParticle, Coupling, PairForce, length, link, spacing};
use crate::kernel::{Kernel, WendlandC2};
#[cfg(feature = "devices")]
use crate::scalar::Traced;
use crate::scalar::{Lane, Real};
use crate::term::TermDoc;

/// Smoothing length over mean spacing: lattices that slide over each other feel bumps of 0.0007 spacings in 2D and
/// 0.002 in 3D, and two layers of particles make a face.
const H_OVER_DX: f64 = 1.3;
/// Layers of a half space that the kernel reaches.
const LAYERS: i32 = 3;

/// Presses bodies apart by the density of one that particles of the other see.
///
/// σᵢ = Σⱼ Vⱼ Wᵢⱼ,  pᵢ = K max(0, σᵢ − θᵢ),  Fᵢⱼ = −(pᵢ + pⱼ) Vᵢ Vⱼ ∇Wᵢⱼ
///
/// with V = s^D \[m^D\] the volume of a particle as built and W the Wendland C2 kernel of 1.3 mean spacings. θ is the sum
/// that a flat face gives at the distance at which it only touches, half a spacing of each side; it is a number of the
/// kernel, so there is nothing to choose. The forces are −∇E of E = ½ Σ pᵢ² Vᵢ/K over the particles of both sides, so a
/// contact gives back what it has stored, and they are zero until faces touch and never pull.
///
/// K = M/(2 g²), with g = −s ∂σ/∂n of that face and M \[Pa\] the harmonic mean of the ρc² of both bodies, makes the contact
/// as stiff as the spacing of material that lies between the particles of its two sides: waves go through it as through
/// the bodies.
///
/// Bodies should be two particles thick; what is thinner sinks in. Of a body that meets itself, name it by
/// [`Scene::couple_self`](crate::scene::Scene::couple_self).
///
/// ```
/// use meshfree::coupling::ContactDensity;
/// use meshfree::prelude::*;
/// // Two copper rods at 20 m/s: the pressure of the contact is that of theory, ρ c v/2.
/// let rod = |name: &str, low: f64| Body::block(name, catalogue::copper(), [low], [low + 0.01], 2e-4);
/// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
///     .body(rod("left", 0.0).velocity([20.0]))
///     .body(rod("right", 0.01))
///     .couple("left", "right", ContactDensity::new())
///     .build()?;
/// simulation.run_until(1.5e-6)?;
/// let felt = simulation.force_between("right", "left")?[0];
/// assert!((felt / 353e6 - 1.0).abs() < 0.03, "{felt:e}");
/// # Ok::<(), Error>(())
/// ```
///
/// Source: Wu, Zhang, Kong & Hu 2026 (arXiv 2602.19429): a contact density, and forces in analogy to a fluid's. The
/// threshold by a flat face, and K, are this crate's.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct ContactDensity {
    factor: f64,
    friction: Option<Coulomb>,
    /// θ and g of lattices in each dimension, which follow from the kernel.
    #[cfg_attr(feature = "serde", serde(skip))]
    faces: [[f64; 2]; 3],
}

impl Default for ContactDensity {
    fn default() -> Self {
        Self::new()
    }
}

impl ContactDensity {
    /// By the stiffness of the bodies, without friction.
    #[must_use]
    pub fn new() -> Self {
        Self {
            factor: 1.0,
            friction: None,
            faces: [face::<1>(), face::<2>(), face::<3>()],
        }
    }
    /// How many times stiffer than the material the contact is; one if not given. Stiffer contacts let less through,
    /// ring, and shorten the step.
    #[must_use]
    pub fn stiffness_factor(self, factor: f64) -> Self {
        Self { factor, ..self }
    }
    /// [Coulomb friction](Coulomb) with a coefficient μ, and a tangential stiffness of about half the normal one.
    #[must_use]
    pub fn friction(self, mu: f64) -> Self {
        let friction = Some(Coulomb { mu });
        Self { friction, ..self }
    }
}

/// W h^D and its slope over q h^(D+2) at q.
fn kernel<L: Lane, const D: usize>(q: L) -> (L, L) {
    let (shape, slope, norm) = match D {
        1 => (
            Kernel::<1>::shape(&WendlandC2, q),
            Kernel::<1>::slope_over_q(&WendlandC2, q),
            Kernel::<1>::normalisation(&WendlandC2),
        ),
        2 => (
            Kernel::<2>::shape(&WendlandC2, q),
            Kernel::<2>::slope_over_q(&WendlandC2, q),
            Kernel::<2>::normalisation(&WendlandC2),
        ),
        _ => (
            Kernel::<3>::shape(&WendlandC2, q),
            Kernel::<3>::slope_over_q(&WendlandC2, q),
            Kernel::<3>::normalisation(&WendlandC2),
        ),
    };
    let norm = L::of(norm);
    (norm * shape, norm * slope)
}

/// The sum over a half space whose first layer is a spacing away, and its slope times the spacing.
fn face<const D: usize>() -> [f64; 2] {
    let across = |d: usize| if d < D { -LAYERS..=LAYERS } else { 0..=0 };
    let (mut sum, mut slope) = (0.0, 0.0);
    for z in 1..=LAYERS {
        for x in across(1) {
            for y in across(2) {
                let r = f64::from(z * z + x * x + y * y).sqrt();
                let (w, dw) = kernel::<f64, D>(r / H_OVER_DX);
                sum += w / H_OVER_DX.powi(D as i32);
                slope -= dw * f64::from(z) / H_OVER_DX.powi(D as i32 + 2);
            }
        }
    }
    [sum, slope]
}

/// h \[m\] of a pair, its distance over that, and the product of h^−D.
fn scaled<L: Lane, const D: usize>(apart: &[L; D], spacing: L) -> (L, L, L) {
    let h = L::of(H_OVER_DX) * spacing;
    (h, length(apart) / h, L::one() / h.powi(D as u32))
}

/// What a particle adds to the sum of one of the other side, and to its gradient.
fn seen<L: Lane, const D: usize>(
    on: &CoupledParticle<L, D>,
    from: &CoupledParticle<L, D>,
) -> (L, [L; D]) {
    let apart: [L; D] = core::array::from_fn(|d| on.position[d] - from.position[d]);
    let (h, q, per_volume) = scaled(&apart, spacing(on, from));
    let (w, slope) = kernel::<L, D>(q);
    let volume = from.spacing.powi(D as u32) * per_volume;
    (volume * w, apart.map(|x| volume * slope * x / (h * h)))
}

/// The force that presses a pair apart.
fn pressed<L: Lane, const D: usize>(pair: &CoupledPair<L, D>) -> [L; D] {
    let (on, from) = (&pair.on, &pair.from);
    let (apart, pressure) = (pair.apart(), on.pressure + from.pressure);
    let (h, q, per_volume) = scaled(&apart, pair.spacing());
    let (_, slope) = kernel::<L, D>(q);
    let volumes = (on.spacing * from.spacing).powi(D as u32) * per_volume;
    let scale = -pressure * volumes * slope / (h * h);
    apart.map(|x| scale * x)
}

impl ContactDensity {
    /// The pressure of a particle by its sum, and the energy that it stores.
    fn beyond<L: Lane, const D: usize>(&self, on: &CoupledParticle<L, D>, spacing: L) -> (L, L) {
        let [theta, slope] = self.faces[D - 1].map(L::of);
        // A side of smaller particles reaches closer to the face, half of its spacing.
        let nearer = (spacing - on.spacing) / (spacing + spacing);
        let beyond = (on.sum - theta - slope * nearer).positive_part();
        let stiffness = L::of(0.5 * self.factor) * on.stiffness / (slope * slope);
        let volume = on.spacing.powi(D as u32);
        let stored = L::of(0.5) * stiffness * beyond * beyond * volume;
        (stiffness * beyond, stored)
    }

    /// The largest stable step of a pair.
    fn stable<L: Lane, const D: usize>(
        &self,
        on: &CoupledParticle<L, D>,
        from: &CoupledParticle<L, D>,
    ) -> L {
        let k = L::of(self.factor) * link::<L, D>(on.stiffness, spacing(on, from));
        L::of(0.5) * (on.mass.min(from.mass) / k).sqrt()
    }
}

impl<T: Real, const D: usize> Coupling<T, D> for ContactDensity {
    fn name(&self) -> &'static str {
        "contact density"
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: Coupling::<T, D>::name(self).into(),
            equation: "F = −(pᵢ + pⱼ) Vᵢ Vⱼ ∇W, p = K max(0, Σ V W − θ)",
            source: "after Wu, Zhang, Kong & Hu 2026",
        }
    }
    fn books_energy(&self) -> bool {
        true
    }
    fn reach(&self, spacings: [f64; 2]) -> f64 {
        H_OVER_DX * (spacings[0] + spacings[1])
    }
    fn gathers(&self) -> bool {
        true
    }
    fn gather(&self, on: &CoupledParticle<T, D>, from: &CoupledParticle<T, D>) -> (T, [T; D]) {
        seen(on, from)
    }
    fn pressure(&self, on: &CoupledParticle<T, D>, spacing: T) -> (T, f64) {
        let (pressure, stored) = self.beyond(on, spacing);
        (pressure, stored.to_f64())
    }
    fn act(&self, pair: &CoupledPair<T, D>) -> PairForce<T, D> {
        let (on, from) = (&pair.on, &pair.from);
        let pressure = on.pressure + from.pressure;
        if pressure == T::zero() {
            return PairForce::of([T::zero(); D]);
        }
        let force = pressed(pair);
        let Some(law) = self.friction else {
            return PairForce::of(force);
        };
        // The other body is where the sum grows.
        let normal: [T; D] = core::array::from_fn(|d| from.gradient[d] - on.gradient[d]);
        let size = length(&normal);
        if size == T::zero() {
            return PairForce::of(force);
        }
        let normal = normal.map(|n| n / size);
        let pressing = (0..D).map(|d| force[d] * normal[d]).sum::<T>();
        if pressing <= T::zero() {
            return PairForce::of(force);
        }
        // In proportion to what the pair bears of the pressure, so that all of a contact slide together.
        let [_, face] = self.faces[D - 1].map(T::from_f64);
        let share = T::from_f64(0.25) * on.stiffness / (face * pair.spacing());
        let slide = law.act(&Touch {
            apart: pair.apart(),
            normal,
            pressing,
            stiffness: share * pressing / pressure,
            anchor: pair.anchor,
        });
        PairForce {
            force: core::array::from_fn(|d| force[d] + slide.force[d]),
            ..slide
        }
    }
    fn step(&self, on: &CoupledParticle<T, D>, from: &CoupledParticle<T, D>) -> f64 {
        self.stable(on, from).to_f64()
    }
    #[cfg(feature = "devices")]
    fn record(&self) -> Option<CouplingRecord> {
        let act = |pair: &_| (pressed(pair), Traced::of(0.0));
        let record = CouplingRecord::of::<D>(act, |on, from| self.stable(on, from));
        let record = record.and_then(|own| own.gathering::<D>(seen, |on, s| self.beyond(on, s)));
        record.ok().filter(|_| self.friction.is_none())
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = Coulomb::problems(self.friction);
        if !(self.factor.is_finite() && self.factor > 0.0) {
            let must_be = "it must be finite and positive";
            problems.push(("stiffness factor", self.factor, must_be));
        }
        problems
    }
}
