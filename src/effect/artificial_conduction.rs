//! Artificial conduction: jumps of internal energy are smoothed over the kernel, as viscosity smooths jumps of velocity.
//! Price 2008 (J. Comput. Phys. 227, 10040); Wadsley, Veeravalli & Couchman 2008 for gas under gravity.

use super::{BySum, Effect, Evolved, LedgerColumn, Setting, StepProgram, not_negative};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Sums, Term, TermDoc, stage};

/// The speed v by which [`ArtificialConduction`] evens out energy between two particles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ConductionSignal {
    /// v = √(|pᵢ − pⱼ|/ρ̄) (Price 2008): none where pressures are even, so a contact that has come to rest is not
    /// smeared further. Under gravity the hydrostatic difference counts as a jump.
    #[default]
    Pressure,
    /// v = |vᵢⱼ·rᵢⱼ|/|rᵢⱼ| (Wadsley et al. 2008): for gas at rest in a gravity field.
    Velocity,
}

/// Artificial conduction of internal energy e \[J/kg\].
///
#[doc = include_str!("../../docs/equations/artificial_conduction.html")]
///
/// with the mean density ρ̄ \[kg/m³\] and a [speed](ConductionSignal) v \[m/s\]. A density that is a kernel sum is smooth where
/// gas of one energy meets gas of another, and the energy of particles is not, so their product, the pressure, has a
/// jump of its own: it parts gases that should mix, turns neighbours at strong contacts, and where
/// gas is stopped at once (Noh 1987) all heat stays in the particles that were stopped first. The conduction
/// gives energy the width that density has.
///
/// What one particle gives, the other gets, so the sum of energies stays to rounding, with
/// [compatible](crate::scheme::EnergyForm::Compatible) energy and in the presence of any force. What a body has been given is in
/// the ledger as `artificial conduction`: zero over all bodies.
///
/// Energies are compared and not temperatures, so both sides must be one gas, or of equal specific heat. True contacts widen to
/// about four spacings. Not for solids: their energy is small and their contacts are sharp. The diffusivity is
/// about α v h/2, with v below the sound speed: the acoustic step covers it for α up to 1.
///
/// ```
/// use meshfree::effect::ArtificialConduction;
/// use meshfree::prelude::*;
///
/// // Hot gas beside cold gas in a closed tube.
/// let gas = Material::new("gas", meshfree::material::eos::IdealGas::new(1.4, 1.0));
/// let start = |[x]: [f64; 1], own| meshfree::scheme::Start {
///     energy: if x < 0.5 { 2.5 } else { 0.25 },
///     ..own
/// };
/// let mut tube = Scene::<f64, 1>::new(schemes::gas().with(ArtificialConduction::default()))
///     .body(Body::block("gas", gas, [0.0], [1.0], 0.01).start(start))
///     .boundary(MirrorPlane::symmetry([0.0], [-1.0]))
///     .boundary(MirrorPlane::symmetry([1.0], [1.0]))
///     .build()?;
/// let before = tube.ledger().whole.total_energy();
/// tube.run_until(0.1)?;
/// let after = tube.ledger().whole;
/// assert!((after.total_energy() / before - 1.0).abs() < 1e-12);
/// assert!(after.total("artificial conduction").is_some_and(|sum| sum.abs() < 1e-12));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArtificialConduction {
    /// Strength α; 0.5. Price (2008) has 1, which smears more and turns no fewer neighbours ([defaults](crate#pages)). Zero is none.
    pub strength: f64,
    /// The speed; that of the pressures by default.
    pub signal: ConductionSignal,
}

impl Default for ArtificialConduction {
    fn default() -> Self {
        Self {
            strength: 0.5,
            signal: ConductionSignal::Pressure,
        }
    }
}

impl ArtificialConduction {
    /// Energy that conduction has given a particle so far, over its mass \[J/kg\].
    pub const CONDUCTED: Field = Field::scalar(name!("conducted_energy", "J/kg"));
}

const CONDUCTED: Field = ArtificialConduction::CONDUCTED;
/// Power of the conduction \[W\].
const FLOW: Output = Output::scalar(name!("artificial_conduction", "W"));

impl<const D: usize> Effect<D> for ArtificialConduction {
    type Terms = (In<stage::Rates, Self>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(CONDUCTED, 0.0);
        program.evolve(Evolved::kicked(CONDUCTED).by(BySum::over_mass(FLOW)));
        program.ledger(LedgerColumn {
            name: "artificial conduction",
            unit: "J",
            field: CONDUCTED,
            times_mass: true,
            factor: 1.0,
        });
        program.require(|scene| {
            (!scene.integrated.contains(Field::ENERGY)).then(|| Problem::Incompatible {
                what: "ArtificialConduction conducts internal energy, which this scheme does not carry".into(),
                remedy: "start from schemes::gas, take EnergyForm::Compatible, or leave it out",
            })
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[("strength of the artificial conduction", self.strength)])
    }
}

impl<const D: usize> Term<D> for ArtificialConduction {
    const NAME: &'static str = "meshfree::artificial_conduction";
    const READS: Fields = Fields::of(&[
        Field::VELOCITY,
        Field::MASS,
        Field::DENSITY,
        Field::PRESSURE,
        Field::ENERGY,
    ]);
    const WRITES: Outputs = Outputs::of(&[Output::POWER, FLOW]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let over_densities = (pair.i(Field::DENSITY) + pair.j(Field::DENSITY)).recip();
        // v |r|, which both forms have without the distance in a denominator.
        let speed = match self.signal {
            ConductionSignal::Pressure => {
                let jump = (pair.i(Field::PRESSURE) - pair.j(Field::PRESSURE)).abs();
                ((jump + jump) * pair.r2 * over_densities).root()
            }
            ConductionSignal::Velocity => pair.v_dot_r.abs(),
        };
        let masses = pair.i(Field::MASS) * (pair.mobile * pair.mobile_i) * pair.j(Field::MASS);
        let rate = masses * speed * pair.f * L::of(2.0 * self.strength) * over_densities;
        let flow = rate * (pair.i(Field::ENERGY) - pair.j(Field::ENERGY));
        sums.add(Output::POWER, flow);
        sums.add(FLOW, flow);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("artificial conduction, α = {}", self.strength),
            equation: match self.signal {
                ConductionSignal::Pressure => {
                    "mᵢ deᵢ/dt += Σⱼ mᵢ mⱼ α v (eᵢ − eⱼ)/ρ̄ r̂·∇W, v = √(|pᵢ − pⱼ|/ρ̄)"
                }
                ConductionSignal::Velocity => {
                    "mᵢ deᵢ/dt += Σⱼ mᵢ mⱼ α v (eᵢ − eⱼ)/ρ̄ r̂·∇W, v = |v·r|/|r|"
                }
            },
            source: match self.signal {
                ConductionSignal::Pressure => "Price 2008",
                ConductionSignal::Velocity => "Wadsley et al. 2008",
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::{Kernel, WendlandC4};
    use crate::material::eos::IdealGas;
    use crate::prelude::*;
    use crate::scheme::Start;

    /// v = −a x and e = e₀ + ½ k x² with the signal of the velocities: the sum is odd in the distance but for
    /// ½ k s², so de/dt = −½ α k a ∫ |s|³ W′ ds = 3/2 α k a ∫ s² W ds.
    #[test]
    fn a_parabola_of_energy_is_conducted_as_the_second_moment_of_the_kernel_says() {
        const A: f64 = 0.1;
        const K: f64 = 0.01;
        let scheme = schemes::gas()
            .with_viscosity(crate::term::viscosity::Inviscid)
            .with(ArtificialConduction {
                strength: 0.5,
                signal: ConductionSignal::Velocity,
            });
        let law = IdealGas::new(1.4, 1.0);
        let start = |[x]: [f64; 1], own| Start {
            velocity: [-A * x],
            energy: 1e-3 + 0.5 * K * x * x,
            ..own
        };
        let body = Body::block("gas", Material::new("gas", law), [-1.0], [1.0], 0.01).start(start);
        let mut gas = Scene::<f64, 1>::new(scheme).body(body).build().unwrap();
        let h = gas.smoothing_length();
        let dt = gas.step_at_most(1e-4).unwrap();
        let middle = gas.body(0).unwrap().nth(100).unwrap();
        let found = middle.scalar(ArtificialConduction::CONDUCTED).unwrap() / dt;
        let norm = Kernel::<1>::normalisation(&WendlandC4);
        let pieces = 2000;
        let second: f64 = (0..pieces)
            .map(|k| {
                let q = 2.0 * (f64::from(k) + 0.5) / f64::from(pieces);
                2.0 * norm * q * q * Kernel::<1>::shape(&WendlandC4, q) * 2.0 / f64::from(pieces)
            })
            .sum();
        let exact = 1.5 * 0.5 * K * A * second * h * h;
        assert!((found / exact - 1.0).abs() < 0.02, "{found} {exact}");
    }

    #[test]
    fn what_carries_no_energy_conducts_none() {
        let water = Body::block(
            "water",
            catalogue::weakly_compressible_water(1.0),
            [0.0],
            [1.0],
            0.1,
        );
        let scheme = SchemeBuilder::new(WendlandC4, crate::term::viscosity::Inviscid)
            .density(DensityForm::Continuity)
            .energy(EnergyForm::None)
            .with(ArtificialConduction::default());
        let problems = Scene::<f64, 1>::new(scheme).body(water).problems();
        let told = problems
            .iter()
            .any(|own| own.to_string().contains("internal energy"));
        assert!(told, "{problems:?}");
    }
}
