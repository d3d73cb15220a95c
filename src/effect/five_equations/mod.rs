//! Two fluids that share the particles of a lattice, which stays: the five-equation model with its diffuse interface.
//! Allaire, Clerc & Kokh 2002 (J. Comput. Phys. 181, 577); Johnsen & Colonius 2006 (J. Comput. Phys. 219, 715).

mod fluid;
mod fluxes;
mod gradients;
mod half_step;

pub use fluid::Fluid;
pub use fluxes::FluidFluxes;
pub use gradients::FluidGradients;

use super::{
    Around, CONSTANTS, DensityForm, Effect, LedgerColumn, Point, PointLaw, PointLimit, Reach, Rung,
    SceneFacts, Setting, StepProgram,
};
use crate::error::Problem;
use crate::integrator::{DriftKickDrift, Integrator};
use crate::name;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::term::{In, Stage, TermDoc, stage};
use fluxes::FluidExchange;
use gradients::{CorrectedFluidGradients, EXTREMES, GRADIENTS, VELOCITY_GRADIENT};
use half_step::{HALF_STEP_VELOCITY, HalfStep};

/// Two fluids, as water and air, on particles that stay where they are: mass, momentum and energy pass between them as an approximate
/// solution of the Riemann problem at the middle of each pair says, and an interface is where the volume fraction α of the
/// liquid falls from one to zero.
///
#[doc = include_str!("../../../docs/equations/five_equations.html")]
///
/// with the volume V \[m³\] of a particle, its fluids' densities ρ₁, ρ₂ \[kg/m³\], velocity u \[m/s\], pressure p \[Pa\], energy E \[J/m³\], and fluxes G of
/// HLLC (Toro, Spruce & Speares 1994). Densities, velocity and pressure at the middle are reconstructed from both sides with gradients that
/// are exact for linear fields, limited as van Leer (1979) does, half a step ahead (Hancock; van Leer 1984); the fraction is that of downwind, as far as the upwind side has it (Després &
/// Lagoutière 2001). Both fluids have one pressure, so an interface that is carried along leaves pressure and velocity as they are.
///
/// **Where to take it**: sloshing, impact of liquids and shocks on a lattice between walls or across periods that fluids fill, and where breaking and
/// merging matter more than the last drop. Each side of a bubble is two spacings wide after it has moved a hundred. It is of second
/// order in space and time. Air is compressed, so steps are those of its sound.
///
/// | it adds | as |
/// |---|---|
/// | [`FRACTION`](Self::FRACTION) | volume fraction α of the liquid |
/// | [`LIQUID`](Self::LIQUID) | mass of the liquid \[kg\]; in the ledger as `liquid mass` |
/// | limit of the step | 0.4 h/(c + \|u\|) |
/// | [limits](crate::simulation::Simulation::limits) | pressures without a sound speed, as below zero in air, as `state of two fluids`; fractions that a step takes beyond zero or one, as `exchange of two fluids` |
///
/// It is the list of effects of [`SchemeBuilder::five_equations`](crate::scheme::SchemeBuilder::five_equations). Bodies are of one of the two fluids each, by the equations of state of their
/// materials; a scene with a third one is refused.
/// Work that other forces dissipate, as that of a viscosity, is not kept as heat.
/// Walls must not move in the frame of the scene: let the container [be the frame](crate::boundary::Wall::container_frame). Forces on walls are not
/// summed: take pressures of the particles before them, or [sample](crate::simulation::Simulation::sample) them, since a
/// [probe](crate::observe::PressureProbe) counts from the pressure of a dry wall, zero.
///
/// ```
/// use meshfree::effect::FiveEquations;
/// use meshfree::kernel::WendlandC2;
/// use meshfree::material::eos::{IdealGas, StiffenedGas};
/// use meshfree::prelude::*;
///
/// // A bubble of air is carried along by water: pressure and velocity stay what they are.
/// let (water, air) = (StiffenedGas::new(4.4, 1e6, 1000.0), IdealGas::new(1.4, 1.2));
/// let at = |gamma: f64, density: f64| 1e5 / ((gamma - 1.0) * density);
/// let carried = |name, fluid: Material<f64>, low, high, energy| {
///     Body::block(name, fluid, [low], [high], 0.02).energy(energy).velocity([10.0])
/// };
/// let (liquid, gas) = (Material::new("water", water), Material::new("air", air));
/// let scheme = SchemeBuilder::five_equations(WendlandC2, FiveEquations::new(water, air));
/// let mut tube = Scene::<f64, 1>::new(scheme)
///     .body(carried("left", liquid.clone(), 0.0, 0.4, at(4.4, 1000.0)))
///     .body(carried("bubble", gas, 0.4, 0.6, at(1.4, 1.2)))
///     .body(carried("right", liquid, 0.6, 1.0, at(4.4, 1000.0)))
///     .boundary(Periodic::along(0, 0.0, 1.0))
///     .build()?;
/// tube.run_until(0.01)?;
/// assert!(tube.all().all(|p| (p.velocity()[0] - 10.0).abs() < 1e-6 && (p.pressure() - 1e5).abs() < 1.0));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FiveEquations {
    /// The fluid whose volume fraction is carried.
    pub liquid: Fluid,
    /// The other.
    pub gas: Fluid,
}

/// Volume fraction of the liquid.
const FRACTION: Field = Field::scalar(name!("volume_fraction", "1"));
/// Mass of the liquid \[kg\].
const LIQUID: Field = Field::scalar(name!("liquid_mass", "kg"));
/// Densities of the fluids by themselves \[kg/m³\], of liquid and gas.
const DENSITIES: [Field; 2] = [
    Field::scalar(name!("density_of_liquid", "kg/m³")),
    Field::scalar(name!("density_of_gas", "kg/m³")),
];
/// Volume fraction below which the density of a fluid is that at rest: of less the quotient of mass and volume is noise.
const TRACE: f64 = 1e-3;

impl FiveEquations {
    /// Volume fraction α of the liquid, from 0 to 1.
    pub const FRACTION: Field = FRACTION;
    /// Mass of the liquid in a particle \[kg\].
    pub const LIQUID: Field = LIQUID;

    /// A liquid and a gas, by the equations of state of their materials: [`StiffenedGas`](crate::material::eos::StiffenedGas) and
    /// [`IdealGas`](crate::material::eos::IdealGas), or two of a kind.
    #[must_use]
    pub fn new(liquid: impl Into<Fluid>, gas: impl Into<Fluid>) -> Self {
        Self {
            liquid: liquid.into(),
            gas: gas.into(),
        }
    }

    /// ∂(ρe)/∂p and the energy over volume \[J/m³\] at zero pressure of a mixture.
    #[inline(always)]
    fn mixed<L: Lane>(&self, fraction: L) -> [L; 2] {
        let mean = |liquid: f64, gas: f64| fraction.mul_add(L::of(liquid - gas), L::of(gas));
        [
            mean(self.liquid.slope(), self.gas.slope()),
            mean(self.liquid.stored(), self.gas.stored()),
        ]
    }

    /// The energy of the states of rest over volume \[J/m³\] from the partial densities.
    #[inline(always)]
    fn at_rest<L: Lane>(&self, liquid: L, gas: L) -> L {
        liquid.mul_add(
            L::of(self.liquid.at_rest()),
            gas * L::of(self.gas.at_rest()),
        )
    }

    /// Squared sound speed \[m²/s²\] of a mixture of one pressure, in which the fractions are carried along (Allaire et al. 2002, eq. 21).
    #[inline(always)]
    fn squared_speed<L: Lane>(&self, [slope, stored]: [L; 2], pressure: L, density: L) -> L {
        (pressure * (slope + L::one()) + stored) / (slope * density)
    }
}

impl<const D: usize> Effect<D> for FiveEquations {
    type Terms = (
        In<stage::Gradients, FluidGradients>,
        In<stage::Continuity, FluidFluxes>,
    );
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(FluidGradients), In::new(FluidFluxes(*self)))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let own = *self;
        program.declare(FRACTION, 0.0);
        program.declare(LIQUID, 0.0);
        for field in GRADIENTS.into_iter().chain(EXTREMES) {
            program.declare(field, 0.0);
        }
        program.declare(VELOCITY_GRADIENT, 0.0);
        program.declare(HALF_STEP_VELOCITY, 0.0);
        program.stay();
        program.give_state();
        program.law(Stage::Reference, Filled(own));
        program.law(Stage::State, MixtureState(own));
        program.law(Stage::Gradients, CorrectedFluidGradients);
        program.law(Stage::HalfStep, HalfStep);
        program.law(Stage::Continuity, FluidExchange);
        program.limit(own);
        program.ledger(LedgerColumn {
            name: "liquid mass",
            unit: "kg",
            field: LIQUID,
            times_mass: false,
            factor: 1.0,
        });
        program.document(TermDoc {
            name: "five equations of two fluids".into(),
            equation: "dx/dt = 0, p from ρe = Σ αₖ (p + γₖ p∞ₖ)/(γₖ − 1) − Σ αₖ ρₖ e∞ₖ",
            source: "Allaire, Clerc & Kokh 2002",
        });
        let by_volume = program.setting().density == DensityForm::Continuity;
        program.require(move |_| {
            (!by_volume).then(|| Problem::Incompatible {
                what: "FiveEquations passes mass between fixed volumes, which this density form does not have".into(),
                remedy: "take SchemeBuilder::five_equations",
            })
        });
        program.require(|scene| {
            let summed = [Field::VELOCITY_GRADIENT, Field::PRESSURE_GRADIENT, Field::CORRECTION];
            let twice = summed.iter().any(|own| scene.written.contains(*own));
            twice.then(|| Problem::Incompatible {
                what: "FiveEquations makes gradients of its own, beside those that another part of the scheme asks for".into(),
                remedy: "leave out the viscosity or effect that reads gradients: fluxes of FiveEquations dissipate by themselves",
            })
        });
        program.require(move |_| {
            (own.liquid == own.gas).then(|| Problem::Incompatible {
                what: "the two fluids of FiveEquations are the same".into(),
                remedy: "give it a liquid and a gas, or take Eulerian for one liquid",
            })
        });
        program.require(|scene| {
            let late = scene.integrator == DriftKickDrift.name();
            late.then(|| Problem::Incompatible {
                what: "FiveEquations passes on what the last evaluation found, which drift-kick-drift leaves half a step behind".into(),
                remedy: "take KickDriftKick, whose drift begins where it was evaluated",
            })
        });
        program.require(move |scene| own.unknown_fluid(scene));
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let fluids = [self.liquid, self.gas].into_iter();
        let all = fluids.flat_map(Fluid::problems);
        all.filter(|(name, value, _)| {
            let good = match *name {
                "gamma" => *value > 1.0,
                "stiffness" => *value >= 0.0,
                _ => *value > 0.0,
            };
            !(good && value.is_finite())
        })
        .collect()
    }
}

impl FiveEquations {
    /// The smallest squared sound speed \[m²/s²\]: 10⁻⁸ of that of the liquid at rest, against pressures that no gas can have.
    fn slowest(&self) -> f64 {
        let liquid = self.liquid;
        (1e-8 * liquid.gamma * liquid.stiffness / liquid.reference_density).max(1e-30)
    }

    /// Why a scene cannot have it: a body of neither fluid.
    fn unknown_fluid<T: Real>(&self, scene: &SceneFacts<'_, T>) -> Option<Problem> {
        let mut bodies = scene.bodies.iter();
        let (body, material) = bodies.find(|(_, own)| !self.liquid.is(own) && !self.gas.is(own))?;
        Some(Problem::Incompatible {
            what: format!(
                "the equation of state of body `{body}`, of {}, is that of neither fluid of FiveEquations",
                material.name
            ),
            remedy: "give the material the StiffenedGas or IdealGas that FiveEquations::new was given, without a cut-off",
        })
    }
}

/// Fills particles with the fluid of their body.
#[derive(Clone, Copy, Debug)]
struct Filled(FiveEquations);

impl<const D: usize> PointLaw<D> for Filled {
    const NAME: &'static str = "first volume fractions";
    const READS: Fields = Fields::of(&[Field::MASS]);
    const WRITES: Fields = Fields::of(&[FRACTION, LIQUID]);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        constants[0] = f64::from(u8::from(self.0.liquid.is(around.material)));
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let fraction = at.constant(0);
        at.set(FRACTION, fraction);
        at.set(LIQUID, fraction * at.get(Field::MASS));
    }
}

/// Pressure, sound speed and the densities of both fluids.
#[derive(Clone, Copy, Debug)]
struct MixtureState(FiveEquations);

impl<const D: usize> PointLaw<D> for MixtureState {
    const NAME: &'static str = "state of two fluids";
    const READS: Fields =
        Fields::of(&[Field::MASS, Field::DENSITY, Field::ENERGY, FRACTION, LIQUID]);
    const WRITES: Fields = Fields::of(&[
        Field::PRESSURE,
        Field::SOUND_SPEED,
        DENSITIES[0],
        DENSITIES[1],
    ]);
    const RUNG: Option<Rung> = Some(Rung::Trial);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (density, fraction) = (at.get(Field::DENSITY), at.get(FRACTION));
        let liquid = density * at.get(LIQUID) / at.get(Field::MASS);
        let gas = density - liquid;
        let mixed = self.0.mixed(fraction);
        let [slope, stored] = mixed;
        let energy = density * at.get(Field::ENERGY) + self.0.at_rest(liquid, gas);
        let pressure = (energy - stored) / slope;
        at.set(Field::PRESSURE, pressure);
        let (squared, slowest) = (
            self.0.squared_speed(mixed, pressure, density),
            L::of(self.0.slowest()),
        );
        at.limited(squared.lt(slowest));
        at.set(Field::SOUND_SPEED, squared.max(slowest).sqrt());
        let parts = [(fraction, liquid), (L::one() - fraction, gas)];
        let fluids = [self.0.liquid, self.0.gas];
        for ((field, fluid), (fraction, partial)) in DENSITIES.into_iter().zip(fluids).zip(parts) {
            let there = fraction.gt(L::of(TRACE));
            let own = partial / L::select(there, fraction, L::one());
            at.set(field, L::select(there, own, L::of(fluid.reference_density)));
        }
    }
}

impl<const D: usize> PointLimit<D> for FiveEquations {
    const NAME: &'static str = "sound and flow of two fluids: 0.4 h/(c + |u|)";
    const READS: Fields = Fields::of(&[Field::SOUND_SPEED, Field::VELOCITY]);
    #[inline(always)]
    fn step<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>) -> L {
        let mut square = L::zero();
        for u in at.vector(Field::VELOCITY) {
            square += u * u;
        }
        L::of(0.4 * at.around.smoothing_length) / (at.get(Field::SOUND_SPEED) + square.sqrt())
    }
}
