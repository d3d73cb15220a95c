//! Conduction of heat: a temperature of each particle, how heat flows between neighbours, and what heat sources do to it.
//! Cleary & Monaghan 1999 (J. Comput. Phys. 148, 227).

use super::{
    Effect, Evolved, LedgerColumn, Point, PointLaw, PointLimit, PointRate, Reach, Setting,
    StepProgram,
};
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// Temperature T \[K\] and its conduction, with conductivity k \[W/(m K)\] and specific heat c \[J/(kg K)\].
///
#[doc = include_str!("../../docs/equations/heat_conduction.html")]
///
/// with volumes V \[m³\], the kernel's gradient factor F, the first moment s of the lattice, the heat q \[W/kg\] of
/// [loads](crate::simulation::Load::heating) and Q \[W\] of [`SurfaceHeat`](super::SurfaceHeat). The harmonic mean of the conductivities
/// makes the flow continuous where two materials meet. What one particle gives the other gets, so heat is conserved to rounding. Free
/// surfaces, walls and structures in a liquid pass no heat.
///
/// The three values are those of bodies that give no others by [`Body::field`](crate::scene::Body::field) of
/// [`TEMPERATURE`](Self::TEMPERATURE), [`CONDUCTIVITY`](Self::CONDUCTIVITY) or [`SPECIFIC_HEAT`](Self::SPECIFIC_HEAT).
///
/// **Mechanics.** Where the scheme carries internal energy, conducted heat joins it: by an equation of state that knows energy, as
/// [`MieGruneisen`](crate::material::eos::MieGruneisen), what is heated expands. The temperature follows heat alone: work of pressure,
/// viscosity and plastic flow does not change it.
///
/// | it adds | as |
/// |---|---|
/// | `heat conduction` \[J\] in the [ledger](crate::simulation::Budget::totals) | heat that a body has got from others: zero over all |
/// | limit of the step | 0.08 h² ρ c/k |
///
/// ```
/// use meshfree::effect::HeatConduction;
/// use meshfree::prelude::*;
/// // Two halves of a bar, at 400 K and 300 K. The diffusivity is 1 m²/s.
/// let conduction = HeatConduction { conductivity: 1000.0, specific_heat: 1.0, temperature: 300.0 };
/// let water = || catalogue::weakly_compressible_water(1.0);
/// let hot = Body::block("hot", water(), [0.0], [0.5], 0.02).field(HeatConduction::TEMPERATURE, |_| [400.0]);
/// let mut bar = Scene::<f64, 1>::new(schemes::weakly_compressible().with(conduction))
///     .body(hot)
///     .body(Body::block("cold", water(), [0.5], [1.0], 0.02))
///     .build()?;
/// bar.run_until(0.05)?;
/// // cos(π x) is what is left of the step: 350 + 200/π exp(−π² t) cos(π x).
/// let end = bar.body("hot")?.next().and_then(|own| own.scalar(HeatConduction::TEMPERATURE));
/// assert!(end.is_some_and(|end| (end - 388.6).abs() < 0.4), "{end:?} K");
/// let given = bar.ledger().bodies[0].1.total("heat conduction");
/// assert!(given.is_some_and(|given| given < -10_000.0), "{given:?} J");
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct HeatConduction {
    /// Thermal conductivity k \[W/(m K)\]; zero conducts nothing.
    pub conductivity: f64,
    /// Specific heat c \[J/(kg K)\].
    pub specific_heat: f64,
    /// Temperature T \[K\] at the start.
    pub temperature: f64,
}

impl HeatConduction {
    /// Temperature T \[K\].
    pub const TEMPERATURE: Field = Field::scalar(name!("temperature", "K"));
    /// Thermal conductivity k \[W/(m K)\].
    pub const CONDUCTIVITY: Field = Field::scalar(name!("conductivity", "W/(m K)"));
    /// Specific heat c \[J/(kg K)\].
    pub const SPECIFIC_HEAT: Field = Field::scalar(name!("specific_heat", "J/(kg K)"));
    /// Heat that conduction has given a particle so far, over its mass \[J/kg\].
    pub const CONDUCTED: Field = Field::scalar(name!("conducted_heat", "J/kg"));
}

const TEMPERATURE: Field = HeatConduction::TEMPERATURE;
const CONDUCTIVITY: Field = HeatConduction::CONDUCTIVITY;
pub(super) const SPECIFIC_HEAT: Field = HeatConduction::SPECIFIC_HEAT;
const CONDUCTED: Field = HeatConduction::CONDUCTED;
/// Heat of conduction over mass and time \[W/kg\].
const CONDUCTION: Field = Field::scalar(name!("heating_by_conduction", "W/kg"));
/// Heat of conduction over time \[W\].
const FLOW: Output = Output::scalar(name!("heat_flow", "W"));

impl<const D: usize> Effect<D> for HeatConduction {
    type Terms = (In<stage::Rates, HeatFlow>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, setting: &Setting) -> Self::Terms {
        let moment = setting.lattice_consistency_factor;
        (In::new(HeatFlow { moment }),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(TEMPERATURE, self.temperature);
        program.declare(CONDUCTIVITY, self.conductivity);
        program.declare(SPECIFIC_HEAT, self.specific_heat);
        program.declare(CONDUCTED, 0.0);
        program.law(Stage::Rates, Conducted);
        program.heat(CONDUCTION);
        program.evolve(Evolved::kicked(TEMPERATURE).by(Warming).by(Loaded));
        program.evolve(Evolved::kicked(CONDUCTED).by(Booked));
        let h_over_dx = program.setting().h_over_dx;
        program.limit(Diffusion { h_over_dx });
        program.ledger(LedgerColumn {
            name: "heat conduction",
            unit: "J",
            field: CONDUCTED,
            times_mass: true,
            factor: 1.0,
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = super::not_negative(&[("conductivity", self.conductivity)]);
        let positive = [
            ("specific heat", self.specific_heat),
            ("temperature", self.temperature),
        ];
        for (what, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                problems.push((what, value, "it must be finite and positive"));
            }
        }
        problems
    }
}

/// Σⱼ Vᵢ Vⱼ 4 kᵢkⱼ/(kᵢ + kⱼ) (Tᵢ − Tⱼ) F/s \[W\], for [`HeatConduction`].
#[derive(Clone, Copy, Debug)]
pub struct HeatFlow {
    /// First moment s of the lattice, without which heat spreads 1 to 3 % too fast.
    pub moment: f64,
}

impl<const D: usize> Term<D> for HeatFlow {
    const NAME: &'static str = "meshfree::heat_flow";
    const READS: Fields = Fields::of(&[TEMPERATURE, CONDUCTIVITY, Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[FLOW]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let (k_i, k_j) = (pair.i(CONDUCTIVITY), pair.j(CONDUCTIVITY));
        // Two that conduct nothing have a mean of zero.
        let both = (k_i + k_j).max(L::of(1e-30));
        let mean = k_i * k_j / both * (pair.mobile * pair.mobile_i);
        let jump = pair.i(TEMPERATURE) - pair.j(TEMPERATURE);
        let factor = L::of(4.0 / self.moment) * pair.volumes() * mean * pair.f;
        sums.add_product(FLOW, factor, jump);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "heat conduction".into(),
            equation: "mᵢ cᵢ dTᵢ/dt = Σⱼ Vᵢ Vⱼ 4 kᵢkⱼ/(kᵢ + kⱼ) (Tᵢ − Tⱼ) F/s",
            source: "Cleary & Monaghan 1999, eq. 28",
        }
    }
}

/// Writes the heat of conduction over mass.
#[derive(Clone, Copy, Debug)]
struct Conducted;

impl<const D: usize> PointLaw<D> for Conducted {
    const NAME: &'static str = "heat of conduction";
    const READS: Fields = Fields::of(&[Field::MASS]);
    const WRITES: Fields = Fields::of(&[CONDUCTION]);
    const SUMS: Outputs = Outputs::of(&[FLOW]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        at.set(CONDUCTION, at.sum(FLOW) / at.get(Field::MASS));
    }
}

/// q/c of the heat of conduction.
#[derive(Clone, Copy, Debug)]
struct Warming;

impl<const D: usize> PointRate<D> for Warming {
    const READS: Fields = Fields::of(&[CONDUCTION, SPECIFIC_HEAT]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, _: L, rate: &mut [L]) {
        rate[0] += at.get(CONDUCTION) / at.get(SPECIFIC_HEAT);
    }
}

/// What the ledger has of it.
#[derive(Clone, Copy, Debug)]
struct Booked;

impl<const D: usize> PointRate<D> for Booked {
    const READS: Fields = Fields::of(&[CONDUCTION]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, _: L, rate: &mut [L]) {
        rate[0] += at.get(CONDUCTION);
    }
}

/// q/c of the heat sources among the loads.
#[derive(Clone, Copy, Debug)]
struct Loaded;

impl<const D: usize> PointRate<D> for Loaded {
    const READS: Fields = Fields::of(&[Field::LOAD_HEATING, SPECIFIC_HEAT]);
    const OPTIONAL: Fields = Fields::of(&[Field::LOAD_HEATING]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, _: L, rate: &mut [L]) {
        rate[0] += at.get(Field::LOAD_HEATING) / at.get(SPECIFIC_HEAT);
    }
}

/// The longest explicit step of the conduction, with the smoothing length of the particle's volume.
#[derive(Clone, Copy, Debug)]
struct Diffusion {
    h_over_dx: f64,
}

impl<const D: usize> PointLimit<D> for Diffusion {
    const NAME: &'static str = "heat conduction: 0.08 h² ρ c/k";
    const READS: Fields = Fields::of(&[CONDUCTIVITY, SPECIFIC_HEAT, Field::DENSITY, Field::MASS]);
    #[inline(always)]
    fn step<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>) -> L {
        let density = at.get(Field::DENSITY);
        let volume = at.get(Field::MASS) / density;
        let spacing = match D {
            1 => volume,
            2 => volume.sqrt(),
            _ => volume.cbrt(),
        };
        let h = L::of(self.h_over_dx) * spacing;
        // Infinite where nothing is conducted. Kick–drift–kick is stable below 1/λ, and λ = Σ 2κVF, in units of κ/h², is 7 with
        // Wendland's C2 in space, 9 with C4 and 11 with C6; half as much again where a good conductor is next to a poor one.
        L::of(0.08) * h * h * density * at.get(SPECIFIC_HEAT) / at.get(CONDUCTIVITY)
    }
}
