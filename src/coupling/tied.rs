//! Tied bodies: springs between the particles of two bodies that are near each other as built, without a limit.
//! The simplest of tied contacts (LS-DYNA, tied interfaces, in the form of springs).

use super::spring::Spring;
use super::{CoupledPair, CoupledParticle, Coupling, PairForce};
use crate::scalar::Real;
use crate::term::TermDoc;

/// Ties pairs that are nearer than 1.6 mean spacings as built to their distance L \[m\] then.
///
/// F = −k (r − L) r/|r|,  k = M s^(D−2)/D
///
/// with M \[Pa\] the harmonic mean of the ρc² of both bodies and s \[m\] their mean spacing. The reach takes the neighbours
/// along the faces of a cube with it, whose springs stand askew and carry shear; two lattices that stand face to face
/// are then tied as stiffly as a spacing of material, so waves go through. There is no limit of tension. The forces are
/// central: linear and angular momentum stay, and what is tied may turn.
///
/// It is for bodies of different schemes. Of bodies of one scheme, [`Interaction::Bonded`](crate::sweep::Interaction)
/// makes one neighbourhood, which is more accurate. Within a body it makes a lattice of springs.
///
/// Source: central-force lattices, as Hrennikoff 1941 (J. Appl. Mech. 8, A169) has them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Tied {
    stiffness: Spring,
}

/// Reach in spacings: beyond √2, and short of √3.
const REACH: f64 = 1.6;

impl Tied {
    /// By the stiffness of the bodies.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
    /// The stiffness k \[N/m\] (N/m per metre in 2D, per m² in 1D) of a pair; by default that of the bodies.
    #[must_use]
    pub fn stiffness(self, stiffness: f64) -> Self {
        let stiffness = Spring(Some(stiffness));
        Self { stiffness }
    }

    fn spring<T: Real, const D: usize>(self, stiffness: T, spacing: T) -> T {
        self.stiffness
            .of::<T, D>(1.0 / D as f64, stiffness, spacing)
    }
}

impl<T: Real, const D: usize> Coupling<T, D> for Tied {
    fn name(&self) -> &'static str {
        "tied"
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: Coupling::<T, D>::name(self).into(),
            equation: "F = −k (r − L) r/|r|, k = M s^(D−2)/D",
            source: "Hrennikoff 1941",
        }
    }
    fn books_energy(&self) -> bool {
        true
    }
    fn reach(&self, spacings: [f64; 2]) -> f64 {
        0.5 * REACH * (spacings[0] + spacings[1])
    }
    fn as_built(&self) -> bool {
        true
    }
    fn act(&self, pair: &CoupledPair<T, D>) -> PairForce<T, D> {
        let apart = pair.apart();
        let distance = apart.iter().fold(T::zero(), |sum, x| sum + *x * *x).sqrt();
        if distance == T::zero() {
            return PairForce::of([T::zero(); D]);
        }
        let k = self.spring::<T, D>(pair.on.stiffness, pair.spacing());
        let longer = distance - pair.rest;
        PairForce {
            stored: 0.5 * (k * longer * longer).to_f64(),
            ..PairForce::of(apart.map(|x| -k * longer * x / distance))
        }
    }
    fn step(&self, on: &CoupledParticle<T, D>, from: &CoupledParticle<T, D>) -> f64 {
        let spacing = T::from_f64(0.5) * (on.spacing + from.spacing);
        // All springs of a particle together, as many as bear along an axis.
        let k = self.spring::<T, D>(on.stiffness, spacing) * T::from_f64(D as f64);
        0.5 * (on.mass.min(from.mass) / k).sqrt().to_f64()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        self.stiffness.problems()
    }
}
