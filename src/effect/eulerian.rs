//! The Eulerian form of a liquid: particles stay where they are, and what flows passes between them.
//! Oger, Marrone, Le Touzé & de Leffe 2016, with w = 0.

use super::mass_exchange::{Exchange, Exchanged, problem};
use super::{Effect, Setting, StepProgram};
use crate::scalar::Real;
use crate::term::{In, Stage, TermDoc, stage};

/// Holds particles of a liquid in their places, and lets mass, momentum and energy pass between them: the form of
/// [`ArbitraryLagrangian`](super::ArbitraryLagrangian) with w = 0.
///
#[doc = include_str!("../../docs/equations/eulerian.html")]
///
/// with the symbols of that effect. Volumes stay as they are built, to rounding. The fluxes are central and keep kinetic energy, so sharp jumps need
/// a viscosity.
///
/// **For a lattice that fills its room**, between walls or across periods, where it is of second order. Between uneven places what an even flow
/// carries in and out does not cancel, and a free surface would have to pass from particle to particle.
///
/// `HEAT = true` where the scheme carries [energy](crate::scheme::SchemeBuilder::energy).
///
/// ```
/// use meshfree::effect::Eulerian;
/// use meshfree::prelude::*;
/// let still: Scheme<f64, 2> = schemes::weakly_compressible().with(Eulerian::<false>).compose();
/// assert!(still.to_string().contains("Eulerian"));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Eulerian<const HEAT: bool = false>;

impl<const D: usize, const HEAT: bool> Effect<D> for Eulerian<HEAT> {
    type Terms = (In<stage::Continuity, Exchange<true, HEAT>>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(Exchange),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::Continuity, Exchanged::<true, HEAT>);
        program.stay();
        program.document(TermDoc {
            name: "Eulerian form".into(),
            equation: "dx/dt = 0, dm/dt = Σⱼ F, d(m u)/dt += Σⱼ F (uᵢ + uⱼ)/2",
            source: "Oger et al. 2016",
        });
        let setting = *program.setting();
        program.require(move |scene| problem::<_, HEAT>("Eulerian", &setting, scene));
    }
}
