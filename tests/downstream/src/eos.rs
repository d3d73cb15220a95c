//! An equation of state: the isothermal gas, p = c² ρ, of molecular clouds and other gas that radiates at once.
//! F. H. Shu, The Physics of Astrophysics II (1992), chapter 15, for its shocks.

use meshfree::material::eos::{EosState, EquationOfState, Guards};
use meshfree::scalar::Lane;

/// Isothermal gas.
#[derive(Clone, Copy, Debug)]
pub struct Isothermal {
    /// Density that it starts with \[kg/m³\].
    pub density: f64,
    /// Sound speed c \[m/s\].
    pub sound_speed: f64,
}

impl EquationOfState for Isothermal {
    fn name(&self) -> &'static str {
        "isothermal gas"
    }
    fn reference_density(&self) -> f64 {
        self.density
    }
    fn uses_energy(&self) -> bool {
        false
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, _energy: L) -> EosState<L> {
        let c = L::of(self.sound_speed);
        EosState {
            pressure: density * c * c,
            sound_speed: c,
            guards: Guards::none(),
        }
    }
}
