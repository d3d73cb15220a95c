//! Two liquids, or a liquid and a gas, of unlike density in one scheme: what keeps their interface sharp.
//! Grenier, Antuono, Colagrossi, Le Touzé & Alessandrini 2009 (J. Comput. Phys. 228, 8380).

use super::{
    Around, CONSTANTS, DensityForm, Effect, Point, PointLaw, Reach, Setting, StepProgram,
    not_negative,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// Two liquids, or a liquid and a gas, whose densities may differ a thousandfold: bodies of one scheme, bonded.
///
/// Continuity and pressure force by volume need no change for that: dρ/dt = ρ Σ V v·∇W and −Vᵢ Vⱼ (pᵢ + pⱼ) ∇W count the volumes of
/// neighbours and not their masses (Colagrossi & Landrini 2003). What they lack is something against single particles that cross the
/// interface, a repulsion between particles of different liquids:
///
#[doc = include_str!("../../docs/equations/two_phase.html")]
///
/// with the first moment s of the lattice (Grenier et al. 2009). It is central and opposite: momentum and angular momentum stay.
/// Walls do not feel it.
///
/// Density diffusion must not look across the interface: [`WithinPhase`] confines it. A closed tank has no surface, so pressures
/// may be negative: let the walls show them, with a [floor](super::ExtrapolatedPressure::floor) to match the
/// cut-off. The step follows the larger sound speed: air whose ρc² is a tenth of water's has ten times its sound speed. Softer air is thrown
/// about by what the water's pressures err at the interface: with a two-hundredth, as true air has, a tank at 30 g breaks at once.
///
/// The pressure between two particles weighted by their densities, (ρⱼ pᵢ + ρᵢ pⱼ)/(ρᵢ + ρⱼ) (Hu & Adams 2006), was tried in the place of
/// the mean: with densities by continuity it drives water and air at rest at 1000:1 apart within half of √(H/g).
///
/// ```
/// use meshfree::effect::{TwoPhase, WithinPhase};
/// use meshfree::prelude::*;
/// use meshfree::material::eos::Tait;
/// use meshfree::sweep::Interaction;
/// use meshfree::term::Fourtakas;
///
/// let water = Material::new("water", Tait::new(1000.0, 10.0));
/// let air = Material::new("air", Tait::new(1.0, 100.0).with_gamma(1.4));
/// let scheme = schemes::weakly_compressible()
///     .density_diffusion(WithinPhase(Fourtakas::default()))
///     .with(TwoPhase::default())
///     .between_bodies(Interaction::Bonded);
/// let tank = Scene::<f64, 2>::new(scheme)
///     .body(Body::block("water", water, [0.0; 2], [0.1, 0.1], 0.01))
///     .body(Body::block("air", air, [0.0, 0.1], [0.1, 0.2], 0.01))
///     .wall(Wall::around("tank", [0.0; 2], [0.1, 0.2], 0.01, 3, [[true; 2]; 2]))
///     .build()?;
/// assert!(tank.scheme().to_string().contains("two phases"));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct TwoPhase {
    /// Share ε of the repulsion; 0.02. Grenier et al. take 0.01 to 0.1. Zero is none.
    pub sharpness: f64,
}

impl Default for TwoPhase {
    fn default() -> Self {
        Self { sharpness: 0.02 }
    }
}

/// Density at rest of the liquid that a particle belongs to \[kg/m³\].
const PHASE: Field = Field::scalar(name!("phase", "kg/m³"));

impl TwoPhase {
    /// Density at rest of the liquid that a particle belongs to \[kg/m³\], by which liquids are distinguished.
    pub const PHASE: Field = PHASE;
}

impl<const D: usize> Effect<D> for TwoPhase {
    type Terms = (In<stage::Rates, Self>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let by_volume = program.setting().density == DensityForm::Continuity;
        program.declare(PHASE, 0.0);
        program.law(Stage::State, Phases);
        program.require(move |_| {
            (!by_volume).then(|| Problem::Incompatible {
                what: "TwoPhase needs densities and pressure forces by volume, which this density form does not have".into(),
                remedy: "take DensityForm::Continuity, as schemes::weakly_compressible has",
            })
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[("sharpness of the interface", self.sharpness)])
    }
}

/// Writes which liquid particles belong to.
#[derive(Clone, Copy, Debug)]
struct Phases;

impl<const D: usize> PointLaw<D> for Phases {
    const NAME: &'static str = "phases";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[PHASE]);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        constants[0] = around.material.reference_density();
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        at.set(PHASE, at.constant(0));
    }
}

/// Whether both particles are of one liquid.
#[inline(always)]
fn alike<L: Lane, const D: usize, P: Layout>(pair: &Pair<'_, L, D, P>) -> L::Mask {
    let (one, other) = (pair.i(PHASE), pair.j(PHASE));
    one.le(other) & other.le(one)
}

impl<const D: usize> Term<D> for TwoPhase {
    const NAME: &'static str = "meshfree::two_phase";
    const READS: Fields = Fields::of(&[Field::WEIGHT, Field::PRESSURE, PHASE]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        // The same for all neighbours of a row.
        let share =
            L::of(self.sharpness) * (pair.mobile * pair.mobile_i) / pair.lattice_consistency_factor;
        let pressures = pair.i(Field::PRESSURE).abs() + pair.j(Field::PRESSURE).abs();
        let stress = L::select(alike(pair), L::zero(), pressures * share);
        let volumes = pair.i(Field::WEIGHT) * pair.j(Field::WEIGHT);
        sums.gradient.add_product(-volumes, stress);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("two phases, ε = {}", self.sharpness),
            equation: "mᵢ dvᵢ/dt −= ε Σⱼ Vᵢ Vⱼ (|pᵢ| + |pⱼ|)/s ∇W between different liquids",
            source: "Grenier et al. 2009",
        }
    }
}

/// A term of one liquid, such as a density diffusion, that does not look across the interface of [`TwoPhase`]: particles
/// of another liquid are to it as walls are.
#[derive(Clone, Copy, Debug, Default)]
pub struct WithinPhase<X>(pub X);

impl<const D: usize, X: Term<D>> Term<D> for WithinPhase<X> {
    const NAME: &'static str = X::NAME;
    const READS: Fields = X::READS.union(Fields::of(&[PHASE]));
    const WRITES: Outputs = X::WRITES;
    const TENSILE: Fields = X::TENSILE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let within = Pair {
            mobile: L::select(alike(pair), pair.mobile, L::zero()),
            ..*pair
        };
        self.0.pair(&within, sums);
    }
    fn document(&self) -> TermDoc {
        let own = self.0.document();
        TermDoc {
            name: format!("{} within a liquid", own.name),
            ..own
        }
    }
}
