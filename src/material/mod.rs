//! Materials: equations of state, viscosity laws and the catalogue of named materials.
//! A material is evaluated once per particle and step, never inside the pair loop.
//!
//! A [`Material`] is a name, a source, an equation of state and what else is known of it. The
//! law's type is erased, so one scene holds copper, water and air; each block of particles is still
//! evaluated by code compiled for its law.
//!
//! Materials of the [`catalogue`] carry the source of their constants, and can be had
//! [by name](catalogue::by_name). Where a law leaves the range in which it is valid a guard steps in, and
//! every such evaluation is counted ([`GuardCounts`](eos::GuardCounts)).
//!
//! A [`Liquid`] becomes a material at its physical [`SoundSpeed`] or at an artificial one, which costs
//! fewer steps; [`rheology`] holds viscosities that follow from the shear rate.
//!
//! [`strength`] holds the yield stresses of solids. Shear and strength act under schemes with the effects
//! [`Hypoelastic`](crate::effect::Hypoelastic) and [`Plasticity`](crate::effect::Plasticity); without them a solid is
//! a fluid with its equation of state. [`failure`] holds what ends them, under [`Damage`](crate::effect::Damage).
//!
//! ```
//! use meshfree::material::{Material, catalogue, eos::{MieGruneisen, TensionCutOff}};
//! let copper: Material<f64> = catalogue::copper();
//! let (p, c) = copper.state(8930.0 * 1.0025, 0.0);
//! assert!((p / 348e6 - 1.0).abs() < 0.01 && c > 3940.0);
//!
//! // Another law, or a material of your own.
//! let spalling = copper.with_eos(TensionCutOff::new(
//!     MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02), -1.2e9));
//! assert_eq!(spalling.state(8000.0, 0.0).0, -1.2e9);
//! ```

pub mod catalogue;
mod cold;
pub mod eos;
mod erased;
pub mod failure;
mod liquid;
mod objects;
#[cfg(test)]
mod recorded;
pub mod rheology;
mod solid;
pub mod strength;

pub use erased::EosObject;
use erased::Erased;
pub use liquid::{Liquid, SoundSpeed};
pub use objects::{FailureObject, RheologyObject, StrengthObject};

use crate::scalar::Real;
use core::fmt::Debug;
use eos::EquationOfState;
use rheology::ViscosityLaw;
use std::sync::Arc;
use strength::PlasticHeating;

/// Whether a constant of a material, in SI units, is not negative and so small that its products are numbers.
fn is_size(value: f64) -> bool {
    (0.0..1e100).contains(&value)
}

/// A material: an equation of state, its name and source, and constants that models may ask for.
/// Cloning is cheap: clones share the law.
#[derive(Clone, Debug)]
pub struct Material<T: Real> {
    /// The name in reports.
    pub name: String,
    /// Where the constants come from.
    pub source: String,
    /// Yield stress Y₀ \[Pa\] in simple tension, if known; a [law of strength](Self::with_strength) goes before it.
    pub yield_stress: Option<f64>,
    /// Shear modulus G \[Pa\], if known.
    pub shear_modulus: Option<f64>,
    /// Dynamic viscosity μ \[Pa s\], if known; a [rheology](Self::with_rheology) goes before it.
    pub dynamic_viscosity: Option<f64>,
    rheology: Option<Arc<dyn RheologyObject>>,
    strength: Option<Arc<dyn StrengthObject>>,
    plastic_heating: Option<PlasticHeating>,
    failure: Option<Arc<dyn FailureObject>>,
    sound_speed: SoundSpeed,
    eos: Arc<dyn EosObject<T>>,
}

impl<T: Real> Material<T> {
    /// A name and an equation of state; the other constants are unknown until set.
    #[must_use]
    pub fn new(name: impl Into<String>, eos: impl EquationOfState) -> Self {
        Self {
            name: name.into(),
            source: String::new(),
            yield_stress: None,
            shear_modulus: None,
            dynamic_viscosity: None,
            rheology: None,
            strength: None,
            plastic_heating: None,
            failure: None,
            sound_speed: SoundSpeed::Physical,
            eos: Arc::new(Erased {
                law: eos,
                cut_off: None,
            }),
        }
    }

    /// The same material with another equation of state; a pressure cut-off stays.
    #[must_use]
    pub fn with_eos(mut self, eos: impl EquationOfState) -> Self {
        self.eos = Arc::new(Erased {
            law: eos,
            cut_off: self.eos.pressure_cut_off(),
        });
        self.sound_speed = SoundSpeed::Physical;
        self
    }
    /// A least pressure \[Pa\], zero or negative: p = max(p_law, p_min), each cut counted under
    /// [`cut_off`](eos::GuardCounts::cut_off). A liquid with a free surface takes 0, one that cavitates
    /// about −101 kPa (absolute zero below the atmosphere), degassed water down to −1 MPa.
    /// [`TensionCutOff`](eos::TensionCutOff) is the same as a law.
    ///
    /// ```
    /// use meshfree::material::{Material, catalogue};
    /// let water: Material<f64> = catalogue::water().with_pressure_cut_off(0.0);
    /// assert_eq!(water.state(990.0, 0.0).0, 0.0);
    /// assert!(water.state(1001.0, 0.0).0 > 2e6);
    /// ```
    #[must_use]
    pub fn with_pressure_cut_off(mut self, pressure: f64) -> Self {
        self.eos = self.eos.cut_at(pressure);
        self
    }
    /// Where the constants come from.
    #[must_use]
    pub fn with_source(mut self, source: impl Into<String>) -> Self {
        self.source = source.into();
        self
    }
    /// A constant dynamic viscosity μ \[Pa s\], in place of any [rheology](Self::with_rheology).
    #[must_use]
    pub fn with_dynamic_viscosity(mut self, dynamic_viscosity: f64) -> Self {
        self.dynamic_viscosity = Some(dynamic_viscosity);
        self.rheology = None;
        self
    }
    /// A viscosity that follows from the shear rate, in place of a constant one.
    #[must_use]
    pub fn with_rheology(mut self, law: impl ViscosityLaw) -> Self {
        self.dynamic_viscosity = None;
        self.rheology = Some(Arc::new(law));
        self
    }

    /// The equation of state.
    #[must_use]
    pub fn eos(&self) -> &dyn EosObject<T> {
        &*self.eos
    }
    /// The viscosity law: the [one given](Self::with_rheology), or the Newtonian of the constant
    /// [`dynamic_viscosity`](Self::dynamic_viscosity); `None` for what has no viscosity.
    #[must_use]
    pub fn rheology(&self) -> Option<&dyn RheologyObject> {
        let constant = self.dynamic_viscosity.as_ref();
        self.rheology
            .as_deref()
            .or(constant.map(|viscosity| viscosity as &dyn RheologyObject))
    }
    /// How the sound speed of a [`Liquid`] was chosen; [`Physical`](SoundSpeed::Physical) for all else.
    #[must_use]
    pub const fn sound_speed(&self) -> SoundSpeed {
        self.sound_speed
    }
    /// Density ρ₀ \[kg/m³\] of the law at rest.
    #[must_use]
    pub fn reference_density(&self) -> f64 {
        self.eos.reference_density()
    }
    /// Whether the pressure depends on internal energy.
    #[must_use]
    pub fn uses_energy(&self) -> bool {
        self.eos.uses_energy()
    }
    /// Pressure \[Pa\] and sound speed \[m/s\] at one density \[kg/m³\] and energy \[J/kg\].
    #[must_use]
    pub fn state(&self, density: f64, energy: f64) -> (f64, f64) {
        self.eos.state(density, energy)
    }
    /// Whether pressure follows from energy alone, so that twice the cold density has no more than a few times the
    /// pressure: the density of a gas at rest is only what it starts with, and its energy is never negative.
    pub(crate) fn is_gas(&self) -> bool {
        let rest = self.reference_density();
        let [once, twice] = [rest, 2.0 * rest].map(|density| self.state(density, 0.0).0);
        twice.abs() <= 4.0 * once.abs()
    }
    /// Acoustic impedance ρ₀ c \[kg/(m² s)\] at rest.
    #[must_use]
    pub fn impedance(&self) -> f64 {
        let density = self.reference_density();
        density * self.state(density, 0.0).1
    }
    /// Bulk modulus K = ρ₀ c² \[Pa\] at rest.
    #[must_use]
    pub fn bulk_modulus(&self) -> f64 {
        let density = self.reference_density();
        density * self.state(density, 0.0).1.powi(2)
    }
    /// Constants that are numbers, and whose products are none: what a law makes of them must be finite.
    fn problems_of_size(&self) -> Vec<(&'static str, f64, &'static str)> {
        let rest = self.reference_density();
        let far = self.state(1.1 * rest, self.state(rest, 0.0).1.powi(2));
        let all = [
            ("reference_density", rest),
            ("sound_speed", self.state(rest, 0.0).1),
            ("bulk_modulus", self.bulk_modulus()),
            ("pressure at 1.1 of the density", far.0.abs()),
            ("sound_speed at 1.1 of the density", far.1),
        ];
        let wrong = all.into_iter().filter(|own| !is_size(own.1));
        wrong
            .map(|(what, value)| (what, value, "finite and below 1e100 in SI units"))
            .collect()
    }
    /// What is wrong with the constants, as `(field, value, what it must be)`; empty if nothing.
    #[must_use]
    pub fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = self.eos.problems();
        if problems.is_empty() {
            problems.extend(self.problems_of_size());
        }
        let constants = [
            ("yield_stress", self.yield_stress),
            ("shear_modulus", self.shear_modulus),
            ("dynamic_viscosity", self.dynamic_viscosity),
        ];
        for (field, value) in constants {
            if let Some(value) = value.filter(|value| !(value.is_finite() && *value >= 0.0)) {
                let must_be = if field == "shear_modulus" {
                    "finite and not negative; of elastic constants: a positive modulus and a Poisson ratio above -1"
                } else {
                    "finite and not negative"
                };
                problems.push((field, value, must_be));
            }
        }
        if let Some(law) = &self.rheology {
            problems.extend(law.problems());
        }
        problems.extend(self.problems_of_solids());
        problems.extend(self.sound_speed.problems());
        problems
    }
}

#[cfg(test)]
mod tests {
    use super::eos::{MieGruneisen, TensionCutOff};
    use super::*;

    #[test]
    fn problems_are_named() {
        let law = TensionCutOff::new(MieGruneisen::new(-1.0, 3940.0, 1.49, 2.02), 5e9);
        let material = Material::<f64>::new("wrong", law).with_yield_stress(f64::NAN);
        let fields: Vec<_> = material
            .problems()
            .iter()
            .map(|problem| problem.0)
            .collect();
        assert_eq!(
            fields,
            ["reference_density", "minimum_pressure", "yield_stress"]
        );
        for wrong in [1.0, f64::NAN, f64::NEG_INFINITY] {
            let law = MieGruneisen::new(1000.0, 1480.0, 1.92, 0.1);
            let problems = Material::<f64>::new("water", law)
                .with_pressure_cut_off(wrong)
                .problems();
            assert!(problems.len() == 1 && problems[0].0 == "pressure_cut_off");
        }
    }
}
