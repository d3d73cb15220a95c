//! What makes a material a solid: elastic constants, strength, the heat of plastic work, and failure.
//! They act under schemes with the effects that take them, and are known to reports without.

use super::failure::Failure;
use super::strength::{PlasticHeating, PlasticState, Strength};
use super::{FailureObject, Material, StrengthObject};
use crate::scalar::Real;
use std::sync::Arc;

impl<T: Real> Material<T> {
    /// Yield stress Y₀ \[Pa\] in simple tension.
    #[must_use]
    pub const fn with_yield_stress(mut self, yield_stress: f64) -> Self {
        self.yield_stress = Some(yield_stress);
        self
    }
    /// Shear modulus G \[Pa\].
    #[must_use]
    pub const fn with_shear_modulus(mut self, shear_modulus: f64) -> Self {
        self.shear_modulus = Some(shear_modulus);
        self
    }
    /// A yield stress that follows from plastic strain, rate, temperature and pressure; the constant
    /// [`yield_stress`](Self::yield_stress) stays what it is in reports.
    #[must_use]
    pub fn with_strength(mut self, law: impl Strength) -> Self {
        self.strength = Some(Arc::new(law));
        self
    }
    /// The temperature that plastic work gives it, for laws of strength that follow from temperature.
    #[must_use]
    pub const fn with_plastic_heating(mut self, heating: PlasticHeating) -> Self {
        self.plastic_heating = Some(heating);
        self
    }

    /// What ends it, under schemes with [`Damage`](crate::effect::Damage).
    ///
    /// ```
    /// use meshfree::material::{Material, catalogue, failure::PlasticStrainLimit};
    /// let copper: Material<f64> = catalogue::copper().with_failure(PlasticStrainLimit::new(0.5));
    /// assert_eq!(copper.failure().map(|law| law.name()), Some("limit of plastic strain"));
    /// ```
    #[must_use]
    pub fn with_failure(mut self, law: impl Failure) -> Self {
        self.failure = Some(Arc::new(law));
        self
    }

    /// The law of strength: the [one given](Self::with_strength), or perfect plasticity at the constant
    /// [`yield_stress`](Self::yield_stress); `None` for what has neither.
    #[must_use]
    pub fn strength(&self) -> Option<&dyn StrengthObject> {
        let constant = self.yield_stress.as_ref();
        self.strength
            .as_deref()
            .or(constant.map(|stress| stress as &dyn StrengthObject))
    }
    /// The temperature that plastic work gives it, if [known](Self::with_plastic_heating).
    #[must_use]
    pub const fn plastic_heating(&self) -> Option<PlasticHeating> {
        self.plastic_heating
    }
    /// The law of failure, if it [has one](Self::with_failure).
    #[must_use]
    pub fn failure(&self) -> Option<&dyn FailureObject> {
        self.failure.as_deref()
    }
    /// Poisson's ratio ν = (3K − 2G)/(6K + 2G) at rest, of what has a
    /// [shear modulus](Self::with_shear_modulus).
    #[must_use]
    pub fn poisson_ratio(&self) -> Option<f64> {
        let bulk = self.bulk_modulus();
        self.shear_modulus
            .map(|shear| (3.0 * bulk - 2.0 * shear) / (6.0 * bulk + 2.0 * shear))
    }
    /// Young's modulus E = 9KG/(3K + G) \[Pa\] at rest, of what has a
    /// [shear modulus](Self::with_shear_modulus).
    #[must_use]
    pub fn youngs_modulus(&self) -> Option<f64> {
        let bulk = self.bulk_modulus();
        self.shear_modulus
            .map(|shear| 9.0 * bulk * shear / (3.0 * bulk + shear))
    }

    /// What is wrong with its strength, its failure and the heat of plastic work.
    pub(super) fn problems_of_solids(&self) -> Vec<(&'static str, f64, &'static str)> {
        let strength = self.strength.iter().flat_map(|law| {
            let mut problems = law.problems();
            if problems.is_empty() {
                problems.extend(problem_of_size(&**law));
            }
            problems
        });
        let heating = self.plastic_heating.iter().flat_map(|own| own.problems());
        let failure = self.failure.iter().flat_map(|law| law.problems());
        strength.chain(heating).chain(failure).collect()
    }
}

/// A law whose constants are numbers, and whose yield stress is none at a strain and rate that a run may reach.
fn problem_of_size(law: &dyn StrengthObject) -> Option<(&'static str, f64, &'static str)> {
    let far = PlasticState {
        strain: 10.0,
        rate: 1e9,
        pressure: 1e9,
        ..PlasticState::default()
    };
    let yields = law.yield_stress(&far);
    let what = "yield_stress at a strain of 10 and a rate of 1e9 1/s";
    let must_be = "finite, not negative and below 1e100 Pa";
    (!super::is_size(yields)).then_some((what, yields, must_be))
}
