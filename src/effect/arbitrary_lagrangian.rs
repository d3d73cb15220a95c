//! The arbitrary Lagrangian–Eulerian form of a liquid: particles follow a smoothed flow, and exchange mass on their way.
//! Oger, Marrone, Le Touzé & de Leffe 2016; Antuono, Sun, Marrone & Colagrossi 2021.

use super::consistent_shifting::{Displace, SHIFT};
use super::mass_exchange::{Exchange, Exchanged, RATE, problem};
use super::{BySum, ConsistentShifting, Crowding, Effect, Setting, StepProgram};
use crate::particles::Field;
use crate::scalar::Real;
use crate::term::{In, Stage, TermDoc, stage};

/// Largest strength: δu evens out explicitly, as a diffusion with the coefficient a h c.
const MOST: f64 = 0.7;

/// Moves particles of a liquid with w = u + δu, and lets the mass, momentum and energy pass between them that the flow carries across their
/// moving faces.
///
#[doc = include_str!("../../docs/equations/arbitrary_lagrangian.html")]
///
/// with the mass m \[kg\], volume V = m/ρ \[m³\], density ρ \[kg/m³\], velocity u \[m/s\] and internal energy e \[J/kg\] of a particle,
/// the flux F \[kg/s\] of a pair and the first moment s of the lattice (Oger et al. 2016; Antuono et al. 2021, the fluxes of shifting).
/// δu is that of [`ConsistentShifting`], which keeps particles evenly spread and leaves a free surface alone.
///
/// F changes its sign with i and j, so mass and momentum are kept to rounding, and what passes carries the mean velocity of the pair,
/// which keeps kinetic energy too (a mean of the momenta, as in Antuono et al., does not). What a step of finite size adds to it comes
/// out of the heat, where the scheme carries [energy](crate::scheme::SchemeBuilder::energy): say `HEAT = true` then. Nothing passes
/// through walls.
///
/// Volumes follow w alone. Under [`ConsistentShifting`] masses stay and volumes take what should have passed; under
/// [`Shifting`](super::Shifting) both stay, and density is wrong by what passed. Masses drift apart in long flows: a body is then no longer
/// made of equal particles.
///
/// All bodies of the scheme must be of one material.
///
/// It costs what [`ConsistentShifting`] costs, and a velocity and two sums more in its sweep.
///
/// ```
/// use meshfree::effect::{ArbitraryLagrangian, ExpansionMemory};
/// use meshfree::prelude::*;
/// let tank: Scheme<f64, 3> = schemes::weakly_compressible()
///     .with(ExpansionMemory)
///     .with(ArbitraryLagrangian::<false>::default())
///     .compose();
/// assert!(tank.to_string().contains("arbitrary Lagrangian"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ArbitraryLagrangian<const HEAT: bool = false> {
    /// How particles leave the flow: δu, with its strength 0.1 by default. At zero they follow the flow, and nothing is exchanged.
    pub shifting: ConsistentShifting,
}

impl<const HEAT: bool> Default for ArbitraryLagrangian<HEAT> {
    fn default() -> Self {
        Self {
            shifting: ConsistentShifting::default(),
        }
    }
}

impl<const D: usize, const HEAT: bool> Effect<D> for ArbitraryLagrangian<HEAT> {
    type Terms = (
        In<stage::Flow, Crowding>,
        In<stage::Continuity, Exchange<false, HEAT>>,
    );
    fn terms(&self, setting: &Setting) -> Self::Terms {
        let over_kernel_at_spacing = 1.0 / setting.kernel_at_spacing;
        (
            In::new(Crowding {
                over_kernel_at_spacing,
            }),
            In::new(Exchange),
        )
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(SHIFT, 0.0);
        program.law(Stage::Flow, self.shifting);
        program.law(Stage::Continuity, Displace);
        program.law(Stage::Continuity, Exchanged::<false, HEAT>);
        program.contribute(
            Field::DENSITY,
            BySum {
                sum: RATE,
                over: None,
            },
        );
        program.document(TermDoc {
            name: format!(
                "arbitrary Lagrangian–Eulerian form, a = {}",
                self.shifting.strength
            ),
            equation: "dx/dt = u + δu, dm/dt = Σⱼ F, d(m u)/dt += Σⱼ F (uᵢ + uⱼ)/2",
            source: "Oger et al. 2016; Antuono et al. 2021",
        });
        let setting = *program.setting();
        program.require(move |scene| problem::<_, HEAT>("ArbitraryLagrangian", &setting, scene));
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let strength = self.shifting.strength;
        let must_be = "it must be from 0 to 0.7: beyond, shifts overshoot";
        let within = (0.0..=MOST).contains(&strength);
        Vec::from_iter((!within).then_some(("strength of the shifting", strength, must_be)))
    }
}
