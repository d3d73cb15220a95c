//! The fluids of the five-equation model, by their equations of state.
//! Stiffened gases of Harlow & Amsden 1971, with ideal gases among them.

use crate::material::Material;
use crate::material::eos::{EquationOfState, IdealGas, StiffenedGas};
use crate::scalar::Real;

/// A fluid of [`FiveEquations`](super::FiveEquations): ρ e = (p + γ p∞)/(γ − 1) − ρ e∞, with e \[J/kg\] counted as its
/// [equation of state](crate::material::eos) does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Fluid {
    /// Exponent γ \[1\], above 1.
    pub gamma: f64,
    /// Internal pressure p∞ \[Pa\]; zero for a gas.
    pub stiffness: f64,
    /// Density ρ₀ \[kg/m³\] at rest, from which the energy of a liquid counts.
    pub reference_density: f64,
}

impl From<StiffenedGas> for Fluid {
    fn from(law: StiffenedGas) -> Self {
        Self {
            gamma: law.gamma,
            stiffness: law.stiffness,
            reference_density: law.reference_density,
        }
    }
}

impl From<IdealGas> for Fluid {
    fn from(law: IdealGas) -> Self {
        Self {
            gamma: law.gamma,
            stiffness: 0.0,
            reference_density: law.reference_density(),
        }
    }
}

impl Fluid {
    /// ∂(ρe)/∂p, 1/(γ − 1).
    pub(super) fn slope(self) -> f64 {
        1.0 / (self.gamma - 1.0)
    }
    /// Energy over volume \[J/m³\] at zero pressure, γ p∞/(γ − 1), before that of the state of rest is taken off.
    pub(super) fn stored(self) -> f64 {
        self.gamma * self.stiffness * self.slope()
    }
    /// That of the state of rest over mass \[J/kg\].
    pub(super) fn at_rest(self) -> f64 {
        self.stored() / self.reference_density
    }
    /// Pressure at a density and an energy.
    fn pressure(self, density: f64, energy: f64) -> f64 {
        (density * (energy + self.at_rest()) - self.stored()) / self.slope()
    }
    /// Whether a material obeys it: at rest, compressed, warm, and in tension, which a cut-off would not allow.
    pub(super) fn is<T: Real>(self, material: &Material<T>) -> bool {
        let rest = self.reference_density;
        let warm = (self.stiffness + 1e5) / rest;
        // A gas bears none.
        let tension = if self.stiffness > 0.0 {
            -0.5 * self.stiffness * self.slope() / rest
        } else {
            warm
        };
        [
            (1.0, warm),
            (1.02, 0.5 * warm),
            (1.02, 2.0 * warm),
            (1.0, tension),
        ]
        .into_iter()
        .all(|(share, energy)| {
            let (density, wanted) = (share * rest, self.pressure(share * rest, energy));
            let (own, _) = material.state(density, energy);
            let size = self.stiffness + density * energy.abs();
            (own - wanted).abs() < 1e-4 * size
        })
    }
    pub(super) fn problems(self) -> [(&'static str, f64, &'static str); 3] {
        [
            ("gamma", self.gamma, "above 1"),
            ("stiffness", self.stiffness, "zero or more"),
            ("reference_density", self.reference_density, "above zero"),
        ]
    }
}
