//! Tied bodies: springs between the particles of two bodies that are near each other as built, without a limit.
//! The simplest of tied contacts (LS-DYNA, tied interfaces, in the form of springs).

#[cfg(feature = "devices")]
use super::CouplingRecord;
use super::spring::Spring;
use super::{CoupledPair, CoupledParticle, Coupling, PairForce, length, spacing};
use crate::scalar::{Lane, Real};
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

    fn spring<L: Lane, const D: usize>(self, stiffness: L, spacing: L) -> L {
        self.stiffness
            .of::<L, D>(1.0 / D as f64, stiffness, spacing)
    }

    /// The force of a pair, and the energy that it stores; none where both are in one place.
    fn pull<L: Lane, const D: usize>(self, pair: &CoupledPair<L, D>) -> ([L; D], L) {
        let apart = pair.apart();
        let distance = length(&apart);
        let (there, none) = (distance.gt(L::zero()), L::zero());
        let k = self.spring::<L, D>(pair.on.stiffness, pair.spacing());
        let longer = distance - pair.rest;
        let force = apart.map(|x| L::select(there, -k * longer * x / distance, none));
        let stored = L::of(0.5) * (k * longer * longer);
        (force, L::select(there, stored, none))
    }

    /// The largest stable step of a pair.
    fn stable<L: Lane, const D: usize>(
        self,
        on: &CoupledParticle<L, D>,
        from: &CoupledParticle<L, D>,
    ) -> L {
        // All springs of a particle together, as many as bear along an axis.
        let k = self.spring::<L, D>(on.stiffness, spacing(on, from)) * L::of(D as f64);
        L::of(0.5) * (on.mass.min(from.mass) / k).sqrt()
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
        let (force, stored) = self.pull(pair);
        PairForce {
            stored: stored.to_f64(),
            ..PairForce::of(force)
        }
    }
    fn step(&self, on: &CoupledParticle<T, D>, from: &CoupledParticle<T, D>) -> f64 {
        self.stable(on, from).to_f64()
    }
    #[cfg(feature = "devices")]
    fn record(&self) -> Option<CouplingRecord> {
        CouplingRecord::of::<D>(|pair| self.pull(pair), |on, from| self.stable(on, from)).ok()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        self.stiffness.problems()
    }
}
