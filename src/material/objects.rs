//! Laws of strength, failure and viscosity without their types: what a material holds of them.
//! A row of particles calls the text that is compiled for the law behind an object.

use super::failure::{Failure, FailureState};
use super::rheology::ViscosityLaw;
use super::strength::{PlasticState, Strength};
use crate::scalar::{Function, Lane, OfLanes, call};
use core::fmt::Debug;

type Problems = Vec<(&'static str, f64, &'static str)>;

/// The trait of objects of a law, and its methods without lanes.
macro_rules! object {
    ($(#[$doc:meta])* $Object:ident of $Law:ident and $count:literal numbers: $($method:ident $Value:ty),*) => {
        $(#[$doc])*
        pub trait $Object: Function<$count> + Debug + Send + Sync + 'static {
            $(
                #[doc = concat!("See [`", stringify!($Law), "::", stringify!($method), "`].")]
                fn $method(&self) -> $Value;
            )*
        }
        impl<X: $Law> $Object for X {
            $(
                fn $method(&self) -> $Value {
                    $Law::$method(self)
                }
            )*
        }
    };
}

object!(
    /// A law of strength whose type is erased: what a [`Material`](super::Material) holds.
    ///
    /// Sealed; [`Material::with_strength`](super::Material::with_strength) makes one from any [`Strength`].
    StrengthObject of Strength and 5 numbers:
    name &'static str, source &'static str, uses_temperature bool, problems Problems
);
object!(
    /// A law of failure whose type is erased: what a [`Material`](super::Material) holds.
    ///
    /// Sealed; [`Material::with_failure`](super::Material::with_failure) makes one from any [`Failure`].
    FailureObject of Failure and 7 numbers:
    name &'static str, source &'static str, uses_plastic_strain bool, uses_temperature bool,
    pressure_at_failure Option<f64>, problems Problems
);
object!(
    /// A viscosity law whose type is erased: what a [`Material`](super::Material) holds.
    ///
    /// Sealed; [`Material::with_rheology`](super::Material::with_rheology) makes one from any [`ViscosityLaw`].
    RheologyObject of ViscosityLaw and 1 numbers:
    name &'static str, greatest_viscosity f64, problems Problems
);

impl dyn StrengthObject + '_ {
    /// Yield stress Y \[Pa\].
    #[inline(always)]
    #[must_use]
    pub fn yield_stress<L: Lane>(&self, state: &PlasticState<L>) -> L {
        call(self, &state.numbers())
    }
}

impl<S: Strength> OfLanes<5> for S {
    #[inline(always)]
    fn of<L: Lane>(&self, numbers: [L; 5]) -> L {
        self.yield_stress(&PlasticState::of(numbers))
    }
}

impl dyn FailureObject + '_ {
    /// What the step adds to the damage D.
    #[inline(always)]
    #[must_use]
    pub fn damage<L: Lane>(&self, state: &FailureState<L>) -> L {
        call(self, &state.numbers())
    }
}

impl<F: Failure> OfLanes<7> for F {
    #[inline(always)]
    fn of<L: Lane>(&self, numbers: [L; 7]) -> L {
        self.damage(&FailureState::of(numbers))
    }
}

impl dyn RheologyObject + '_ {
    /// Dynamic viscosity μ \[Pa s\] at a shear rate \[1/s\].
    #[inline(always)]
    #[must_use]
    pub fn viscosity<L: Lane>(&self, shear_rate: L) -> L {
        call(self, &[shear_rate])
    }
}

impl<V: ViscosityLaw> OfLanes<1> for V {
    #[inline(always)]
    fn of<L: Lane>(&self, [shear_rate]: [L; 1]) -> L {
        self.viscosity(shear_rate)
    }
}
