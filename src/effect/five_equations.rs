//! Two fluids that share the particles of a lattice, which stays: the five-equation model with its diffuse interface.
//! Allaire, Clerc & Kokh 2002 (J. Comput. Phys. 181, 577); Johnsen & Colonius 2006 (J. Comput. Phys. 219, 715).

use super::{
    Around, CONSTANTS, DensityForm, Effect, LedgerColumn, Point, PointLaw, PointLimit, Reach, Rung,
    SceneFacts, Setting, StepProgram,
};
use crate::error::Problem;
use crate::material::Material;
use crate::material::eos::{EquationOfState, IdealGas, StiffenedGas};
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::tensor::Square;
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// A fluid of [`FiveEquations`]: ρ e = (p + γ p∞)/(γ − 1) − ρ e∞, with e \[J/kg\] counted as its
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
    fn slope(self) -> f64 {
        1.0 / (self.gamma - 1.0)
    }
    /// Energy over volume \[J/m³\] at zero pressure, γ p∞/(γ − 1), before that of the state of rest is taken off.
    fn stored(self) -> f64 {
        self.gamma * self.stiffness * self.slope()
    }
    /// That of the state of rest over mass \[J/kg\].
    fn at_rest(self) -> f64 {
        self.stored() / self.reference_density
    }
    /// Pressure at a density and an energy.
    fn pressure(self, density: f64, energy: f64) -> f64 {
        (density * (energy + self.at_rest()) - self.stored()) / self.slope()
    }
    /// Whether a material obeys it: at rest, compressed, and warm.
    fn is<T: Real>(self, material: &Material<T>) -> bool {
        let rest = self.reference_density;
        let warm = (self.stiffness + 1e5) / rest;
        [(1.0, warm), (1.02, 0.5 * warm), (1.02, 2.0 * warm)]
            .into_iter()
            .all(|(share, energy)| {
                let (density, wanted) = (share * rest, self.pressure(share * rest, energy));
                let (own, _) = material.state(density, energy);
                let size = self.stiffness + density * energy;
                (own - wanted).abs() < 1e-4 * size
            })
    }
    fn problems(self) -> [(&'static str, f64, &'static str); 3] {
        [
            ("gamma", self.gamma, "above 1"),
            ("stiffness", self.stiffness, "zero or more"),
            ("reference_density", self.reference_density, "above zero"),
        ]
    }
}

/// Two fluids, as water and air, on particles that stay where they are: mass, momentum and energy pass between them as an approximate
/// solution of the Riemann problem at the middle of each pair says, and an interface is where the volume fraction α of the
/// liquid falls from one to zero.
///
#[doc = include_str!("../../docs/equations/five_equations.html")]
///
/// with the volume V \[m³\] of a particle, its fluids' densities ρ₁, ρ₂ \[kg/m³\], velocity u \[m/s\], pressure p \[Pa\], energy E \[J/m³\], and fluxes G of
/// HLLC (Toro, Spruce & Speares 1994). Densities, velocity and pressure at the middle are reconstructed from both sides with gradients that
/// are exact for linear fields, limited as van Leer (1979) does; the fraction is that of downwind, as far as the upwind side has it (Després &
/// Lagoutière 2001). Both fluids have one pressure, so an interface that is carried along leaves pressure and velocity as they are.
///
/// **Where to take it**: sloshing, impact of liquids and shocks on a lattice between walls or across periods that fluids fill, and where breaking and
/// merging matter more than the last drop. Each side of a bubble is two spacings wide after it has moved a hundred. It is of second
/// order in space and of first in time. Air is compressed, so steps are those of its sound.
///
/// | it adds | as |
/// |---|---|
/// | [`FRACTION`](Self::FRACTION) | volume fraction α of the liquid |
/// | [`LIQUID`](Self::LIQUID) | mass of the liquid \[kg\]; in the ledger as `liquid mass` |
/// | limit of the step | 0.2 h/(c + \|u\|) |
///
/// It is the list of effects of [`SchemeBuilder::five_equations`](crate::scheme::SchemeBuilder::five_equations). Bodies are of one of the two fluids each, by the equations of state of their
/// materials; a scene with a third one is refused.
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
/// By how much the fraction of a neighbour is larger, and smaller, at most.
const ROOM: [Field; 2] = [
    Field::scalar(name!("largest_rise_of_volume_fraction", "1")),
    Field::scalar(name!("largest_fall_of_volume_fraction", "1")),
];
const MOST: [Output; 2] = [
    Output::scalar(name!("largest_rise_of_volume_fraction", "1")),
    Output::scalar(name!("largest_fall_of_volume_fraction", "1")),
];
/// What is reconstructed by gradients: densities and pressure.
const SCALARS: [Field; 3] = [DENSITIES[0], DENSITIES[1], Field::PRESSURE];
const SLOPES: [Field; 3] = [
    Field::vector(name!("gradient_of_density_of_liquid", "kg/m⁴")),
    Field::vector(name!("gradient_of_density_of_gas", "kg/m⁴")),
    Field::vector(name!("gradient_of_pressure_of_fluids", "Pa/m")),
];
const TURNING: Field = Field::matrix(name!("velocity_gradient_of_fluids", "1/s"));
/// Their sums before they are corrected.
const RISES: [Output; 3] = [
    Output::vector(name!("rise_of_density_of_liquid", "kg/m⁴")),
    Output::vector(name!("rise_of_density_of_gas", "kg/m⁴")),
    Output::vector(name!("rise_of_pressure", "Pa/m")),
];
const SHEAR: Output = Output::matrix(name!("rise_of_velocity", "1/s"));
const MOMENTS: Output = Output::matrix(name!("moments_of_fluids", "1"));
/// Rates of a particle: mass and that of its liquid \[kg/s\], momentum over that of the mass \[N\], total energy over that of the
/// mass \[W\], volume fraction \[1/s\].
const MASS: Output = Output::scalar(name!("mass_of_fluids", "kg/s"));
const LIQUID_MASS: Output = Output::scalar(name!("mass_of_liquid", "kg/s"));
const MOMENTUM: Output = Output::vector(name!("momentum_of_fluids", "N"));
const ENERGY: Output = Output::scalar(name!("energy_of_fluids", "W"));
const CARRIED: Output = Output::scalar(name!("carried_volume_fraction", "1/s"));

/// Volume fraction below which the density of a fluid is that at rest: of less the quotient of mass and volume is noise.
const TRACE: f64 = 1e-3;

impl FiveEquations {
    /// Volume fraction α of the liquid, from 0 to 1.
    pub const FRACTION: Field = FRACTION;
    /// Mass of the liquid in a particle \[kg\].
    pub const LIQUID: Field = LIQUID;

    /// A liquid and a gas, by the equations of state of their materials: [`StiffenedGas`] and [`IdealGas`], or two of a kind.
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
        In<stage::Gradients, Rises>,
        In<stage::Continuity, FluidFluxes>,
    );
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(Rises), In::new(FluidFluxes(*self)))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let own = *self;
        program.declare(FRACTION, 0.0);
        program.declare(LIQUID, 0.0);
        for field in SLOPES.into_iter().chain(ROOM) {
            program.declare(field, 0.0);
        }
        program.declare(TURNING, 0.0);
        program.stay();
        program.give_state();
        program.law(Stage::Reference, Filled(own));
        program.law(Stage::State, MixtureState(own));
        program.law(Stage::Gradients, Slopes);
        program.law(Stage::Continuity, Passed);
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
        program.require(move |scene| own.stranger(scene));
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
    /// Why a scene cannot have it: a body of neither fluid.
    fn stranger<T: Real>(&self, scene: &SceneFacts<'_, T>) -> Option<Problem> {
        let mut bodies = scene.bodies.iter();
        let (body, material) = bodies.find(|(_, own)| !self.liquid.is(own) && !self.gas.is(own))?;
        Some(Problem::Incompatible {
            what: format!(
                "the equation of state of body `{body}`, of {}, is that of neither fluid of FiveEquations",
                material.name
            ),
            remedy: "give the material the StiffenedGas or IdealGas that FiveEquations::new was given",
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
        let squared = self.0.squared_speed(mixed, pressure, density);
        at.set(Field::SOUND_SPEED, squared.sqrt());
        let parts = [(fraction, liquid), (L::one() - fraction, gas)];
        let fluids = [self.0.liquid, self.0.gas];
        for ((field, fluid), (fraction, partial)) in DENSITIES.into_iter().zip(fluids).zip(parts) {
            let there = fraction.gt(L::of(TRACE));
            let own = partial / L::select(there, fraction, L::one());
            at.set(field, L::select(there, own, L::of(fluid.reference_density)));
        }
    }
}

/// Differences to neighbours along the gradient of the kernel, of what is reconstructed.
#[derive(Clone, Copy, Debug)]
pub struct Rises;

impl<const D: usize> Term<D> for Rises {
    const NAME: &'static str = "meshfree::rises_of_two_fluids";
    const READS: Fields = Fields::of(&[
        Field::WEIGHT,
        Field::VELOCITY,
        SCALARS[0],
        SCALARS[1],
        SCALARS[2],
        FRACTION,
    ]);
    const WRITES: Outputs = Outputs::of(&[
        RISES[0], RISES[1], RISES[2], SHEAR, MOMENTS, MOST[0], MOST[1],
    ]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        // Walls have none of it but a pressure, of which gradients do without them.
        let both = pair.mobile * pair.mobile_i;
        let weight = -both * pair.j(Field::WEIGHT) * pair.f;
        let near = L::select(pair.w.gt(L::zero()), both, L::zero());
        let rise = near * (pair.j(FRACTION) - pair.i(FRACTION));
        sums.raise(MOST[0], rise);
        sums.raise(MOST[1], -rise);
        for (field, sum) in SCALARS.into_iter().zip(RISES) {
            let rise = weight * (pair.i(field) - pair.j(field));
            for d in 0..D {
                sums.add_product_at(sum, d, rise, pair.r[d]);
            }
        }
        for a in 0..D {
            let (rise, along) = (weight * pair.v[a], weight * pair.r[a]);
            for b in 0..D {
                sums.add_product_at(SHEAR, a * D + b, rise, pair.r[b]);
                sums.add_product_at(MOMENTS, a * D + b, along, pair.r[b]);
            }
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "rises of two fluids".into(),
            equation: "Σⱼ Vⱼ (qⱼ − qᵢ) ∇W, Σⱼ Vⱼ rⱼᵢ ⊗ ∇W",
            source: "Randles & Libersky 1996",
        }
    }
}

/// Gradients from the rises.
#[derive(Clone, Copy, Debug)]
struct Slopes;

impl<const D: usize> PointLaw<D> for Slopes {
    const NAME: &'static str = "gradients of two fluids";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields =
        Fields::of(&[SLOPES[0], SLOPES[1], SLOPES[2], TURNING, ROOM[0], ROOM[1]]);
    const SUMS: Outputs = <Rises as Term<D>>::WRITES;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let correction: Square<L, D> = at.sum_matrix(MOMENTS).inverse(super::gradients::SINGULAR).0;
        let velocities = at.sum_matrix(SHEAR).times(&correction);
        at.set_matrix(TURNING, &velocities);
        for (field, sum) in ROOM.into_iter().zip(MOST) {
            at.set(field, at.sum(sum).positive_part());
        }
        for (field, sum) in SLOPES.into_iter().zip(RISES) {
            for b in 0..D {
                let mut total = L::zero();
                for a in 0..D {
                    total += at.sum_at(sum, a) * correction.0[a][b];
                }
                at.set_at(field, b, total);
            }
        }
    }
}

/// What the slopes on both sides of a particle leave of half the difference to a neighbour, with the slope ahead and behind: van Leer's harmonic mean.
#[inline(always)]
fn half_of<L: Lane>(ahead: L, twice: L) -> L {
    let behind = twice - ahead;
    let product = ahead * behind;
    let alike = product.gt(L::zero());
    let sum = L::select(alike, twice, L::one());
    L::select(alike, product, L::zero()) / sum
}

/// What of the difference to a neighbour the fraction at the middle takes: all of it, as far as the other neighbours show that the upwind side has
/// it (Després & Lagoutière 2001). Without a limit it would be the downwind fraction, which keeps interfaces sharp.
#[inline(always)]
fn sharp_part_of<L: Lane>(ahead: L, above: L, below: L) -> L {
    let rises = ahead.gt(L::zero());
    let part = ahead.abs().min(L::select(rises, below, above));
    L::select(rises, part, -part)
}

/// What a pair of particles passes to each other.
#[derive(Clone, Copy, Debug)]
pub struct FluidFluxes(FiveEquations);

/// One side of the Riemann problem at the middle of a pair.
#[derive(Clone, Copy)]
struct Side<L, const D: usize> {
    fraction: L,
    liquid: L,
    density: L,
    pressure: L,
    velocity: [L; D],
    along: L,
    sound: L,
    slope: L,
    stored: L,
}

impl FluidFluxes {
    #[inline(always)]
    fn side<L: Lane, const D: usize>(
        &self,
        fraction: L,
        [liquid, gas, pressure]: [L; 3],
        velocity: [L; D],
        normal: &[L; D],
    ) -> Side<L, D> {
        let partial = fraction * liquid;
        let density = (L::one() - fraction).mul_add(gas, partial);
        let mixed = self.0.mixed(fraction);
        let squared = self.0.squared_speed(mixed, pressure, density);
        let mut along = L::zero();
        for d in 0..D {
            along = velocity[d].mul_add(normal[d], along);
        }
        Side {
            fraction,
            liquid: partial,
            density,
            pressure,
            velocity,
            along,
            sound: squared.positive_part().sqrt(),
            slope: mixed[0],
            stored: mixed[1],
        }
    }
}

impl<const D: usize> Term<D> for FluidFluxes {
    const NAME: &'static str = "meshfree::fluxes_of_two_fluids";
    const READS: Fields = Fields::of(&[
        Field::WEIGHT,
        Field::VELOCITY,
        Field::ENERGY,
        SCALARS[0],
        SCALARS[1],
        SCALARS[2],
        SLOPES[0],
        SLOPES[1],
        SLOPES[2],
        TURNING,
        FRACTION,
        ROOM[0],
        ROOM[1],
    ]);
    const WRITES: Outputs = Outputs::of(&[MASS, LIQUID_MASS, MOMENTUM, ENERGY, CARRIED]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let apart = pair.r2.gt(L::zero());
        let distance = L::select(apart, pair.r2, L::one()).sqrt();
        let mut normal = [L::zero(); D];
        for d in 0..D {
            normal[d] = -pair.r[d] / distance;
        }
        let (mut at_i, mut at_j) = ([L::zero(); 3], [L::zero(); 3]);
        for k in 0..3 {
            let (mut twice_i, mut twice_j) = (L::zero(), L::zero());
            for d in 0..D {
                twice_i = pair.i_at(SLOPES[k], d).mul_add(pair.r[d], twice_i);
                twice_j = pair.j_at(SLOPES[k], d).mul_add(pair.r[d], twice_j);
            }
            let (own, other) = (pair.i(SCALARS[k]), pair.j(SCALARS[k]));
            let ahead = other - own;
            at_i[k] = own + half_of(ahead, L::of(-2.0) * twice_i);
            at_j[k] = other - half_of(ahead, L::of(-2.0) * twice_j);
        }
        let (own, other) = (pair.i(FRACTION), pair.j(FRACTION));
        let ahead = other - own;
        let from_i = own + sharp_part_of(ahead, pair.i(ROOM[0]), pair.i(ROOM[1]));
        let from_j = other + sharp_part_of(-ahead, pair.j(ROOM[0]), pair.j(ROOM[1]));
        let (mut u_i, mut u_j) = ([L::zero(); D], [L::zero(); D]);
        for a in 0..D {
            let (mut twice_i, mut twice_j) = (L::zero(), L::zero());
            for b in 0..D {
                twice_i = pair.i_at(TURNING, a * D + b).mul_add(pair.r[b], twice_i);
                twice_j = pair.j_at(TURNING, a * D + b).mul_add(pair.r[b], twice_j);
            }
            let ahead = -pair.v[a];
            u_i[a] = pair.i_at(Field::VELOCITY, a) + half_of(ahead, L::of(-2.0) * twice_i);
            u_j[a] = pair.j_at(Field::VELOCITY, a) - half_of(ahead, L::of(-2.0) * twice_j);
        }
        let left = self.side(from_i, at_i, u_i, &normal);
        let right = self.side(from_j, at_j, u_j, &normal);
        // Waves to both sides, no faster than they are and none that runs away from the middle.
        let slowest = (left.along - left.sound)
            .min(right.along - right.sound)
            .min(L::zero());
        let fastest = (left.along + left.sound)
            .max(right.along + right.sound)
            .max(L::zero());
        let (from_left, from_right) = (
            left.density * (slowest - left.along),
            right.density * (fastest - right.along),
        );
        let contact = (right.pressure - left.pressure + from_left * left.along
            - from_right * right.along)
            / (from_left - from_right);
        let ahead = contact.gt(L::zero());
        let take = |a: L, b: L| L::select(ahead, a, b);
        let wave = take(slowest, fastest);
        let along = take(left.along, right.along);
        let density = take(left.density, right.density);
        let pressure = take(left.pressure, right.pressure);
        let liquid = take(left.liquid, right.liquid);
        let fraction = take(left.fraction, right.fraction);
        // The velocity with which what is upwind passes the middle, and the pressure there.
        let jump = contact - along;
        let ratio = (wave - along) / (wave - contact);
        let passing = contact * ratio;
        let behind = wave * density * ratio * jump;
        let wall = pair.mobile.lt(L::of(0.5));
        // At a wall the pressure that stops what comes: a Riemann problem with the image of i.
        let stopped = at_i[2] + left.density * left.sound * left.along;
        let passing = L::select(wall, L::zero(), passing);
        let pushing = L::select(wall, stopped, pressure + behind);
        let area = L::of(-2.0)
            * pair.mobile_i
            * pair.i(Field::WEIGHT)
            * pair.j(Field::WEIGHT)
            * pair.f
            * L::select(apart, distance, L::zero())
            / pair.lattice_consistency_factor;
        let flow = area * passing;
        let mass = flow * density;
        sums.add(MASS, -mass);
        sums.add(LIQUID_MASS, -(flow * liquid));
        let (mut square, mut own_square) = (L::zero(), L::zero());
        for d in 0..D {
            let (velocity, own) = (
                take(left.velocity[d], right.velocity[d]),
                pair.i_at(Field::VELOCITY, d),
            );
            square += velocity * velocity;
            own_square += own * own;
            let momentum = mass * (velocity - own) + area * pushing * normal[d];
            sums.add_at(MOMENTUM, d, -momentum);
        }
        let (slope, stored) = (
            take(left.slope, right.slope),
            take(left.stored, right.stored),
        );
        let internal = pressure * slope + stored - self.0.at_rest(liquid, density - liquid);
        let half = L::of(0.5);
        let enthalpy = internal + half * density * square + pressure;
        let energy = flow * enthalpy + area * L::select(wall, L::zero(), behind * contact);
        let own = pair.i(Field::ENERGY) + half * own_square;
        sums.add(ENERGY, mass * own - energy);
        let carried = flow * (fraction - pair.i(FRACTION)) / pair.i(Field::WEIGHT);
        sums.add(CARRIED, -carried);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "fluxes of two fluids".into(),
            equation: "d(V U)ᵢ/dt = −Σⱼ 2 Vᵢ Vⱼ G(Uᵢ, Uⱼ)·∇W/s, dαᵢ/dt = −Σⱼ 2 Vⱼ (α − αᵢ) u*·∇W/s",
            source: "Vila 1999; Johnsen & Colonius 2006; Toro et al. 1994",
        }
    }
}

/// Gives each particle what the others have passed to it.
#[derive(Clone, Copy, Debug)]
struct Passed;

impl<const D: usize> PointLaw<D> for Passed {
    const NAME: &'static str = "exchange of two fluids";
    const READS: Fields = Fields::of(&[
        Field::WEIGHT,
        Field::MASS,
        Field::VELOCITY,
        Field::ENERGY,
        FRACTION,
        LIQUID,
    ]);
    const WRITES: Fields = Fields::of(&[
        Field::MASS,
        Field::DENSITY,
        Field::VELOCITY,
        Field::ENERGY,
        FRACTION,
        LIQUID,
    ]);
    const SUMS: Outputs = Outputs::of(&[MASS, LIQUID_MASS, MOMENTUM, ENERGY, CARRIED]);
    const RUNG: Option<Rung> = Some(Rung::Flow);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let mass = at.get(Field::MASS) + at.dt() * at.sum(MASS);
        let (step, half) = (at.dt() / mass, L::of(0.5));
        let (mut before, mut after) = (L::zero(), L::zero());
        for d in 0..D {
            let own = at.get_at(Field::VELOCITY, d);
            let velocity = own + step * at.sum_at(MOMENTUM, d);
            before += own * own;
            after += velocity * velocity;
            at.set_at(Field::VELOCITY, d, velocity);
        }
        let energy = at.get(Field::ENERGY) + step * at.sum(ENERGY) + half * (before - after);
        at.set(Field::ENERGY, energy);
        at.set(Field::MASS, mass);
        at.set(Field::DENSITY, mass / at.get(Field::WEIGHT));
        let liquid = at.get(LIQUID) + at.dt() * at.sum(LIQUID_MASS);
        at.set(LIQUID, liquid);
        let fraction = at.get(FRACTION) + at.dt() * at.sum(CARRIED);
        at.set(FRACTION, fraction.max(L::zero()).min(L::one()));
    }
}

impl<const D: usize> PointLimit<D> for FiveEquations {
    const NAME: &'static str = "sound and flow of two fluids: 0.2 h/(c + |u|)";
    const READS: Fields = Fields::of(&[Field::SOUND_SPEED, Field::VELOCITY]);
    #[inline(always)]
    fn step<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>) -> L {
        let mut square = L::zero();
        for u in at.vector(Field::VELOCITY) {
            square += u * u;
        }
        L::of(0.2 * at.around.smoothing_length) / (at.get(Field::SOUND_SPEED) + square.sqrt())
    }
}
