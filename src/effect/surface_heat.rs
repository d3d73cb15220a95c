//! Heat through free surfaces: convection and radiation, over the area that each particle has of the surface.
//! Newton's law of cooling and the law of Stefan and Boltzmann.

use super::heat_conduction::SPECIFIC_HEAT;
use super::surface_area::{GRADIENT, VolumeGradient, area_of_surface};
use super::{
    Around, CONSTANTS, Effect, Evolved, HeatConduction, LedgerColumn, Point, PointLaw, PointLimit,
    PointRate, Reach, Setting, StepProgram, not_negative,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Stage, TermDoc, stage};

/// Stefan–Boltzmann constant σ \[W/(m² K⁴)\], exact in the SI (CODATA 2018).
pub const STEFAN_BOLTZMANN: f64 = 5.670374419e-8;

/// Convection and radiation at free surfaces of bodies with [`HeatConduction`].
///
#[doc = include_str!("../../docs/equations/surface_heat.html")]
///
/// with the heat Q \[W\] that enters, the coefficient h \[W/(m² K)\] of convection, the emissivity ε, the temperature T∞ \[K\] of the
/// surroundings, [σ](STEFAN_BOLTZMANN), the volume V \[m³\] and the kernel's gradient factor F. The area A \[m²\] is per metre in two
/// dimensions, and a number of ends in one. The ramp f goes from 0 at |G| h = 0.05 to 1 at 0.15, so that the disorder of particles
/// within a body is no surface. The factor N, about 2, is one number of kernel and h/dx, by which a flat surface along a lattice has
/// its area. Walls and other bodies of the scheme that touch cover a surface.
///
/// **Accuracy** of Σ A: smoothing rounds edges. Errors of bodies on a lattice, with n particles across:
///
/// | body | n = 20 | n = 40 |
/// |---|---|---|
/// | disc | −4 to 3 % | −2 to 4 % |
/// | square | −8 to −3 % | −4 to −2 % |
/// | ball | −4 to −2 % | |
/// | cube | −10 to −7 % | |
///
/// Where edges matter, [`set_area`](Self::set_area) gives a body its true area. The sum is in the
/// [ledger](crate::simulation::Budget::totals) as `area of the surface`.
///
/// The step is limited to a quarter of the time in which a particle comes to T∞. The heat that entered is in the
/// [ledger](crate::simulation::Budget::totals) as `heat through surfaces` \[J\]. In a total-Lagrangian scheme areas are those of the
/// body as built, to first order in the strain.
///
/// ```
/// use meshfree::effect::{HeatConduction, SurfaceHeat};
/// use meshfree::prelude::*;
/// // A slab of 0.2 m that conducts well cools by 50 W/(m² K) on both sides: T − T∞ falls as exp(−2 h t/(ρ c L)).
/// let conduction = HeatConduction { conductivity: 1000.0, specific_heat: 1.0, temperature: 400.0 };
/// let cooling = SurfaceHeat::convection(50.0, 300.0);
/// let mut slab = Scene::<f64, 1>::new(schemes::weakly_compressible().with(conduction).with(cooling))
///     .body(Body::block("slab", catalogue::weakly_compressible_water(1.0), [0.0], [0.2], 0.01))
///     .build()?;
/// slab.run_until(1.0)?;
/// let mean: f64 = slab.all().filter_map(|own| own.scalar(HeatConduction::TEMPERATURE)).sum::<f64>() / 20.0;
/// let lumped = 300.0 + 100.0 * (-2.0 * 50.0 * 1.0_f64 / (1000.0 * 1.0 * 0.2)).exp();
/// assert!((mean - lumped).abs() < 0.5, "{mean} K, {lumped} K");
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceHeat {
    exchanges: Vec<Exchange>,
}

/// What a surface exchanges heat with.
#[derive(Clone, Debug, PartialEq)]
struct Exchange {
    /// Coefficient of convection and emissivity.
    coefficients: [f64; 2],
    ambient: f64,
    /// The material to which it is limited.
    material: Option<String>,
}

impl SurfaceHeat {
    /// The area \[mᴰ⁻¹\] that a particle has of the free surface.
    pub const AREA: Field = Field::scalar(name!("surface_area", "mᴰ⁻¹"));
    /// What the area of a particle is multiplied with \[1\]: 1 by default, and what [`set_area`](Self::set_area) or `Body::field` gives.
    pub const AREA_FACTOR: Field = Field::scalar(name!("surface_area_factor", "1"));
    /// Heat that has entered a particle through its surface so far, over its mass \[J/kg\].
    pub const RECEIVED: Field = Field::scalar(name!("surface_heat", "J/kg"));

    /// Convection with coefficient h \[W/(m² K)\] to surroundings at T∞ \[K\].
    #[must_use]
    pub fn convection(coefficient: f64, ambient: f64) -> Self {
        Self::exchange([coefficient, 0.0], ambient)
    }

    /// Radiation of a grey surface with emissivity ε to large surroundings at T∞ \[K\].
    #[must_use]
    pub fn radiation(emissivity: f64, ambient: f64) -> Self {
        Self::exchange([0.0, emissivity], ambient)
    }

    fn exchange(coefficients: [f64; 2], ambient: f64) -> Self {
        let exchange = Exchange {
            coefficients,
            ambient,
            material: None,
        };
        Self {
            exchanges: vec![exchange],
        }
    }

    /// Limits the last exchange to the bodies of a material, by its name; it acts on all bodies if not given.
    #[must_use]
    pub fn of(mut self, material: &str) -> Self {
        if let Some(own) = self.exchanges.last_mut() {
            own.material = Some(material.into());
        }
        self
    }

    /// Adds another exchange, as radiation to convection.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.exchanges.extend(other.exchanges);
        self
    }

    /// Of all exchanges of a material: Σ h, Σ h T∞, Σ ε σ and Σ ε σ T∞⁴.
    fn sums(&self, material: &str) -> [f64; CONSTANTS] {
        let of = |own: &&Exchange| own.material.as_ref().is_none_or(|name| name == material);
        let mut sums = [0.0; CONSTANTS];
        for own in self.exchanges.iter().filter(of) {
            let [h, emissivity] = own.coefficients;
            let grey = emissivity * STEFAN_BOLTZMANN;
            let all = [h, h * own.ambient, grey, grey * own.ambient.powi(4)];
            for (sum, value) in sums.iter_mut().zip(all) {
                *sum += value;
            }
        }
        sums
    }
}

const AREA: Field = SurfaceHeat::AREA;
const AREA_FACTOR: Field = SurfaceHeat::AREA_FACTOR;
/// Σ A in the ledger.
pub(crate) const TOTAL_AREA: &str = "area of the surface";
const RECEIVED: Field = SurfaceHeat::RECEIVED;
const TEMPERATURE: Field = HeatConduction::TEMPERATURE;
/// Heat through the surface over mass and time \[W/kg\].
const HEATING: Field = Field::scalar(name!("heating_through_surface", "W/kg"));
/// Rate \[1/s\] at which a particle alone would come to T∞.
const COOLING: Field = Field::scalar(name!("cooling_rate", "1/s"));
impl<const D: usize> Effect<D> for SurfaceHeat {
    type Terms = (In<stage::Rates, VolumeGradient>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(VolumeGradient),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(AREA, 0.0);
        program.declare(AREA_FACTOR, 1.0);
        program.declare(RECEIVED, 0.0);
        let factor = program.setting().area_factor;
        program.law(
            Stage::Rates,
            Exchanged {
                exchanges: self.clone(),
                factor,
            },
        );
        program.heat(HEATING);
        program.contribute(TEMPERATURE, Warming);
        program.evolve(Evolved::kicked(RECEIVED).by(Booked));
        program.limit(Cooling);
        program.ledger(LedgerColumn {
            name: "heat through surfaces",
            unit: "J",
            field: RECEIVED,
            times_mass: true,
            factor: 1.0,
        });
        program.ledger(LedgerColumn {
            name: TOTAL_AREA,
            unit: "mᴰ⁻¹",
            field: AREA,
            times_mass: false,
            factor: 1.0,
        });
        for own in &self.exchanges {
            let [h, emissivity] = own.coefficients;
            let of = own.material.as_deref().unwrap_or("all materials");
            let ambient = own.ambient;
            program.document(TermDoc {
                name: format!("heat through surfaces of {of}, h = {h} W/(m² K), ε = {emissivity}, T∞ = {ambient} K"),
                equation: "m c dT/dt = … + A (h (T∞ − T) + ε σ (T∞⁴ − T⁴)), A = N V f(|G| h) |G|, G = Σⱼ Vⱼ ∇W",
                source: "Newton; Stefan & Boltzmann; area: Brackbill, Kothe & Zemach 1992",
            });
            let Some(own) = own.material.clone() else {
                continue;
            };
            program.require(move |scene| {
                let there = scene.bodies.iter().any(|(_, body)| body.name == own);
                (!there).then(|| Problem::Incompatible {
                    what: format!("SurfaceHeat is of the material `{own}`, and no body has it"),
                    remedy: "name a material as in Material::new",
                })
            });
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = Vec::new();
        for own in &self.exchanges {
            let [h, emissivity] = own.coefficients;
            problems.extend(not_negative(&[
                ("coefficient of convection", h),
                ("temperature of the surroundings", own.ambient),
            ]));
            if !(0.0..=1.0).contains(&emissivity) {
                problems.push(("emissivity", emissivity, "it must be between 0 and 1"));
            }
        }
        problems
    }
}

/// Writes areas and what passes through them.
#[derive(Clone, Debug)]
struct Exchanged {
    exchanges: SurfaceHeat,
    factor: f64,
}

impl<const D: usize> PointLaw<D> for Exchanged {
    const NAME: &'static str = "heat through surfaces";
    const READS: Fields = Fields::of(&[
        TEMPERATURE,
        SPECIFIC_HEAT,
        AREA_FACTOR,
        Field::MASS,
        Field::DENSITY,
        Field::SMOOTHING_LENGTH,
    ]);
    const WRITES: Fields = Fields::of(&[AREA, HEATING, COOLING]);
    const SUMS: Outputs = Outputs::of(&[GRADIENT]);
    const OPTIONAL: Fields = Fields::of(&[Field::SMOOTHING_LENGTH]);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        *constants = self.exchanges.sums(&around.material.name);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let mass = at.get(Field::MASS);
        let area = at.get(AREA_FACTOR) * area_of_surface(at, self.factor);
        let temperature = at.get(TEMPERATURE);
        let cube = temperature * temperature * temperature;
        let convected = at.constant(1) - at.constant(0) * temperature;
        let radiated = at.constant(3) - at.constant(2) * cube * temperature;
        let slope = L::of(4.0) * at.constant(2) * cube + at.constant(0);
        let over_mass = area / mass;
        at.set(AREA, area);
        at.set(HEATING, over_mass * (convected + radiated));
        at.set(COOLING, over_mass * slope / at.get(SPECIFIC_HEAT));
    }
}

/// The temperature that heat through the surface gives.
#[derive(Clone, Copy, Debug)]
struct Warming;

impl<const D: usize> PointRate<D> for Warming {
    const READS: Fields = Fields::of(&[HEATING, SPECIFIC_HEAT]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, _: L, rate: &mut [L]) {
        rate[0] += at.get(HEATING) / at.get(SPECIFIC_HEAT);
    }
}

/// What the ledger has of it.
#[derive(Clone, Copy, Debug)]
struct Booked;

impl<const D: usize> PointRate<D> for Booked {
    const READS: Fields = Fields::of(&[HEATING]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, _: L, rate: &mut [L]) {
        rate[0] += at.get(HEATING);
    }
}

/// A quarter of the time in which a particle comes to T∞.
#[derive(Clone, Copy, Debug)]
struct Cooling;

impl<const D: usize> PointLimit<D> for Cooling {
    const NAME: &'static str = "heat through surfaces: 0.25 m c/(A (h + 4 ε σ T³))";
    const READS: Fields = Fields::of(&[COOLING]);
    #[inline(always)]
    fn step<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>) -> L {
        // Infinite within bodies.
        L::of(0.25) / at.get(COOLING)
    }
}
