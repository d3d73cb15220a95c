//! Electrons that conduct heat by themselves: an effect of a second crate, with the field and sum names of the first.
//! Its field and sum have other full names, so both effects stand in one scheme.

use meshfree::effect::{BySum, Effect, Evolved, Setting, StepProgram};
use meshfree::name;
use meshfree::particles::{Field, Fields, Output, Outputs};
use meshfree::scalar::{Lane, Real};
use meshfree::term::{In, Layout, Pair, Sums, Term, TermDoc, stage};

/// Temperature \[K\] of the electrons, zero unless a body gives it.
pub const TEMPERATURE: Field = Field::scalar(name!("temperature", "K"));
/// m dT/dt \[K kg/s\].
const FLOW: Output = Output::scalar(name!("heat_flow_over_specific_heat", "K kg/s"));

/// dT/dt = a ∇²T of the electrons.
#[derive(Clone, Copy, Debug)]
pub struct Electrons {
    /// Thermal diffusivity a \[m²/s\].
    pub diffusivity: f64,
}

impl<const D: usize> Effect<D> for Electrons {
    type Terms = (In<stage::Rates, Self>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(TEMPERATURE, 0.0);
        program.evolve(Evolved::kicked(TEMPERATURE).by(BySum::over_mass(FLOW)));
    }
}

impl<const D: usize> Term<D> for Electrons {
    const NAME: &'static str = "electrons::electrons";
    const READS: Fields = Fields::of(&[TEMPERATURE, Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[FLOW]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let masses = pair.i(Field::MASS) * pair.j(Field::MASS);
        let density = (pair.i(Field::DENSITY) + pair.j(Field::DENSITY)) * L::of(0.5);
        let jump = pair.i(TEMPERATURE) - pair.j(TEMPERATURE);
        sums.add(
            FLOW,
            L::of(2.0 * self.diffusivity) * masses * jump * pair.f / density,
        );
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "conduction by electrons".into(),
            equation: "dTᵢ/dt = Σⱼ 2a mⱼ (Tᵢ − Tⱼ) F/ρ",
            source: "Brookshaw 1985",
        }
    }
}
