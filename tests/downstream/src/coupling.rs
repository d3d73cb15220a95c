//! A coupling: elastic bands between every two particles of two bodies, which pull them together.
//! It says what it stores, so that the ledger closes energy with it.

use meshfree::coupling::{CoupledPair, CoupledParticle, Coupling, PairForce};
use meshfree::scalar::Real;
use meshfree::term::TermDoc;

/// F = −k r for pairs that are nearer than a length.
#[derive(Clone, Copy, Debug)]
pub struct Bands {
    /// k of a pair \[N/m\].
    pub stiffness: f64,
    /// How far bands reach \[m\].
    pub length: f64,
}

impl<T: Real, const D: usize> Coupling<T, D> for Bands {
    fn name(&self) -> &'static str {
        "bands"
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("bands of {} N/m", self.stiffness),
            equation: "F = −k r, stored k r²/2",
            source: "Hooke 1678",
        }
    }
    fn reach(&self, _spacings: [f64; 2]) -> f64 {
        self.length
    }
    fn act(&self, pair: &CoupledPair<T, D>) -> PairForce<T, D> {
        let apart = pair.apart();
        let squared: f64 = apart.iter().map(|x| x.to_f64() * x.to_f64()).sum();
        PairForce {
            stored: 0.5 * self.stiffness * squared,
            ..PairForce::of(apart.map(|x| -(T::from_f64(self.stiffness) * x)))
        }
    }
    fn books_energy(&self) -> bool {
        true
    }
    fn step(&self, on: &CoupledParticle<T, D>, from: &CoupledParticle<T, D>) -> f64 {
        let mass = on.mass.to_f64().min(from.mass.to_f64());
        0.1 * (mass / self.stiffness).sqrt()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let fine = self.stiffness > 0.0;
        let must_be = "it must be positive, in N/m";
        (!fine)
            .then_some(("stiffness of the bands", self.stiffness, must_be))
            .into_iter()
            .collect()
    }
}
