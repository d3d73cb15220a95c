//! Artificial conduction: jumps of internal energy are smoothed over the kernel, as viscosity smooths jumps of velocity.
//! Price 2008 (J. Comput. Phys. 227, 10040); Wadsley, Veeravalli & Couchman 2008; on what reconstruction leaves, Rosswog 2020.

use super::{
    BySum, Effect, Evolved, LedgerColumn, Point, PointLaw, Reach, Setting, StepProgram,
    not_negative,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, left_of_jump, stage};

/// The speed v by which [`ArtificialConduction`] evens out energy between two particles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
/// with the mean density ρ̄ \[kg/m³\] and a [speed](ConductionSignal) v \[m/s\]. The jump Δe is what linear reconstruction from both
/// sides leaves of eᵢ − eⱼ, by the limiter φ of
/// [`LimitedMonaghanGingold`](crate::term::viscosity::LimitedMonaghanGingold) and gradients that are exact for linear fields: where the energy is
/// smooth nothing is conducted. A density that is a kernel sum is smooth where
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
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
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
/// Gradient of the internal energy \[m/s²\], and the sum of it before it is corrected.
const SLOPE: Field = Field::vector(name!("energy_gradient", "m/s²"));
const SUMMED_SLOPE: Output = Output::vector(name!("sum_of_energy_gradient", "m/s²"));
/// Power of the conduction \[W\].
const FLOW: Output = Output::scalar(name!("artificial_conduction", "W"));

impl<const D: usize> Effect<D> for ArtificialConduction {
    type Terms = (In<stage::Gradients, EnergyGradient>, In<stage::Rates, Self>);
    const NEEDS: Fields = Fields::of(&[Field::CORRECTION]);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(EnergyGradient), In::new(*self))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::Gradients, CorrectedSlope);
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

/// Σⱼ Vⱼ (eⱼ − eᵢ) g r, the sum of the energy's gradient, for [`ArtificialConduction`].
#[derive(Clone, Copy, Debug)]
pub struct EnergyGradient;

impl<const D: usize> Term<D> for EnergyGradient {
    const NAME: &'static str = "meshfree::energy_gradient";
    const READS: Fields = Fields::of(&[Field::ENERGY, Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[SUMMED_SLOPE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let factor = -pair.j(Field::MASS) / pair.j(Field::DENSITY) * pair.weight();
        let difference = pair.i(Field::ENERGY) - pair.j(Field::ENERGY);
        for a in 0..D {
            let gradient = factor * pair.r[a];
            sums.add_product_at(SUMMED_SLOPE, a, difference, gradient);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "gradient of internal energy".into(),
            equation: "∇e = C Σⱼ Vⱼ (eⱼ − eᵢ) g r",
            source: "Randles & Libersky 1996; García-Senz, Cabezón & Escartín 2012",
        }
    }
}

/// Corrects the gradient of the energy.
#[derive(Clone, Copy, Debug)]
struct CorrectedSlope;

impl<const D: usize> PointLaw<D> for CorrectedSlope {
    const NAME: &'static str = "corrected gradient of internal energy";
    const READS: Fields = Fields::of(&[Field::CORRECTION]);
    const WRITES: Fields = Fields::of(&[SLOPE]);
    const SUMS: Outputs = Outputs::of(&[SUMMED_SLOPE]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (summed, correction) = (at.sum_vector(SUMMED_SLOPE), at.matrix(Field::CORRECTION));
        for b in 0..D {
            let mut slope = L::zero();
            for a in 0..D {
                slope += summed[a] * correction.0[a][b];
            }
            at.set_at(SLOPE, b, slope);
        }
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
        SLOPE,
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
        let (mut at_i, mut at_j) = (L::zero(), L::zero());
        for a in 0..D {
            at_i += pair.i_at(SLOPE, a) * pair.r[a];
            at_j += pair.j_at(SLOPE, a) * pair.r[a];
        }
        let whole = pair.i(Field::ENERGY) - pair.j(Field::ENERGY);
        let flow = rate * left_of_jump(whole, at_i, at_j);
        sums.add(Output::POWER, flow);
        sums.add(FLOW, flow);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("artificial conduction, α = {}", self.strength),
            equation: match self.signal {
                ConductionSignal::Pressure => {
                    "mᵢ deᵢ/dt += Σⱼ mᵢ mⱼ α v [eᵢ − eⱼ]/ρ̄ r̂·∇W, v = √(|pᵢ − pⱼ|/ρ̄), [eᵢ − eⱼ] after reconstruction"
                }
                ConductionSignal::Velocity => {
                    "mᵢ deᵢ/dt += Σⱼ mᵢ mⱼ α v [eᵢ − eⱼ]/ρ̄ r̂·∇W, v = |v·r|/|r|, [eᵢ − eⱼ] after reconstruction"
                }
            },
            source: match self.signal {
                ConductionSignal::Pressure => {
                    "Price 2008; jump after reconstruction: Rosswog 2020, eq. 24"
                }
                ConductionSignal::Velocity => {
                    "Wadsley et al. 2008; jump after reconstruction: Rosswog 2020, eq. 24"
                }
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

    /// Power over mass by conduction at the middle of a bar, of an energy e(x) and with the signal of the velocities v = −a x.
    fn conducted(energy: impl Fn(f64) -> f64 + Send + Sync + 'static) -> (f64, f64) {
        let scheme = schemes::gas()
            .with_viscosity(crate::term::viscosity::Inviscid)
            .with(ArtificialConduction {
                strength: 0.5,
                signal: ConductionSignal::Velocity,
            });
        let law = IdealGas::new(1.4, 1.0);
        let start = move |[x]: [f64; 1], own| Start {
            velocity: [-A * x],
            energy: energy(x),
            ..own
        };
        let body = Body::block("gas", Material::new("gas", law), [-1.0], [1.0], 0.01).start(start);
        let mut gas = Scene::<f64, 1>::new(scheme).body(body).build().unwrap();
        let h = gas.smoothing_length();
        let dt = gas.step_at_most(1e-4).unwrap();
        let middle = gas.body(0).unwrap().nth(100).unwrap();
        (
            middle.scalar(ArtificialConduction::CONDUCTED).unwrap() / dt,
            h,
        )
    }

    const A: f64 = 0.1;

    /// At a corner e = e₀ + k |x − x₀| the slope is zero and reconstruction takes nothing, so all of e is conducted:
    /// de/dt = α k a ∫ s² |W′| ds = 4 α k a ∫₀ s W ds.
    #[test]
    fn a_corner_of_energy_is_conducted_as_the_first_moment_of_the_kernel_says() {
        const K: f64 = 0.01;
        let corner = 0.005;
        let (found, h) = conducted(move |x| 1e-3 + K * (x - corner).abs());
        let norm = Kernel::<1>::normalisation(&WendlandC4);
        let pieces = 2000;
        let first: f64 = (0..pieces)
            .map(|k| {
                let q = 2.0 * (f64::from(k) + 0.5) / f64::from(pieces);
                norm * q * Kernel::<1>::shape(&WendlandC4, q) * 2.0 / f64::from(pieces)
            })
            .sum();
        let exact = 4.0 * 0.5 * K * A * first * h;
        assert!((found / exact - 1.0).abs() < 0.02, "{found} {exact}");
        // Away from a corner, where the slope is one and the same, nothing.
        let (none, _) = conducted(move |x| 1e-2 + K * x);
        assert!(none.abs() < 1e-9 * exact, "{none} {exact}");
        // Nor of a parabola, whose slopes on two sides have the difference as their mean.
        let (little, _) = conducted(move |x| 1e-2 + 0.5 * K * (x + 0.5) * (x + 0.5));
        assert!(little.abs() < 1e-6 * exact, "{little} {exact}");
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
