//! Hourglass control: a force against motions of neighbours that the deformation gradient does not see.
//! Ganzenmüller 2015 (Comput. Methods Appl. Mech. Engrg. 286, 87).

use super::{
    Around, BySum, CONSTANTS, Effect, Evolved, LedgerColumn, Point, PointLaw, Reach, Setting,
    StepProgram, TotalLagrangian,
};
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// Hourglass control of [total-Lagrangian](TotalLagrangian) solids: a pair whose distance differs from what the mean of
/// the two deformation gradients makes of it is pulled or pushed back.
///
#[doc = include_str!("../../docs/equations/hourglass_control.html")]
///
/// with x = xᵢⱼ, X = Xᵢⱼ and Ē the mean of Young's moduli (Ganzenmüller 2015), of a [liquid](super::LagrangianLiquid) that of its
/// bulk modulus. It is exactly zero under any linear
/// deformation, and lies along x, so it keeps momentum and angular momentum.
///
/// Its work is in the internal energy and, by itself, in the ledger as `hourglass energy`: it should be a few per cent
/// of the elastic energy.
///
/// It is an elastic spring of the body as built: across plastic folds it resists what is meant to stay.
/// [`YieldingHourglass`](super::YieldingHourglass) cuts it there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct HourglassControl {
    /// Strength α; 0.1 by default, ten times less than what begins to stiffen bending ([defaults](crate#pages)).
    pub strength: f64,
}

impl Default for HourglassControl {
    fn default() -> Self {
        Self { strength: 0.1 }
    }
}

impl HourglassControl {
    /// Work of the control so far, over mass \[J/kg\].
    pub const ENERGY: Field = Field::scalar(name!("hourglass_energy", "J/kg"));
}

const F: Field = TotalLagrangian::DEFORMATION;
const ENERGY: Field = HourglassControl::ENERGY;
/// Stiffness \[Pa\] of the forces that hold an hourglass control: here Young's modulus, or the bulk modulus of a liquid.
pub(super) const STIFFNESS: Field = Field::scalar(name!("hourglass_stiffness", "Pa"));
/// −½ Σⱼ fᵢⱼ·vᵢⱼ \[W\].
const POWER: Output = Output::scalar(name!("hourglass_power", "W"));

impl<const D: usize> Effect<D> for HourglassControl {
    type Terms = (In<stage::Rates, Self>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(ENERGY, 0.0);
        program.declare(STIFFNESS, 0.0);
        program.law(Stage::Reference, Stiffness);
        program.evolve(Evolved::kicked(ENERGY).by(BySum::over_mass(POWER)));
        program.ledger(LedgerColumn {
            name: "hourglass energy",
            unit: "J",
            field: ENERGY,
            times_mass: true,
            factor: 1.0,
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        super::not_negative(&[("strength of the hourglass control", self.strength)])
    }
}

impl<const D: usize> Term<D> for HourglassControl {
    const NAME: &'static str = "meshfree::hourglass_control";
    const READS: Fields = Fields::of(&[
        Field::POSITION_RESIDUAL,
        Field::VELOCITY,
        Field::REFERENCE_POSITION,
        Field::WEIGHT,
        F,
        STIFFNESS,
    ]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE, POWER]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let apart = pair.reference();
        // (Fᵢ + Fⱼ) X·x less twice x²: both errors at once, times |x|.
        let (mut error, mut length2) = (L::zero(), L::zero());
        for a in 0..D {
            let mut image = -(pair.r[a] + pair.r[a]);
            for b in 0..D {
                let gradient = pair.i_at(F, a * D + b) + pair.j_at(F, a * D + b);
                image = gradient.mul_add(apart[b], image);
            }
            error = image.mul_add(pair.r[a], error);
            length2 = apart[a].mul_add(apart[a], length2);
        }
        // The particle itself has no distance, and no error.
        let nothing = L::of(f64::from(f32::MIN_POSITIVE));
        let volumes = pair.i(Field::WEIGHT) * pair.j(Field::WEIGHT) * pair.w;
        let modulus = (pair.i(STIFFNESS) + pair.j(STIFFNESS)) * L::of(0.25 * self.strength);
        let distances = (length2 * pair.r2).max(nothing);
        let force = modulus * volumes * error / distances;
        sums.radial += force;
        sums.add(POWER, force * pair.v_dot_r * L::of(-0.5));
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("hourglass control, α = {}", self.strength),
            equation: "fᵢⱼ = ½ α Ē V₀ᵢ V₀ⱼ W/|X|² (δᵢ + δⱼ) x/|x|, δᵢ = (Fᵢ X − x)·x/|x|",
            source: "Ganzenmüller 2015",
        }
    }
}

/// Young's modulus, or the bulk modulus of a liquid, once.
#[derive(Clone, Copy, Debug)]
struct Stiffness;

impl<const D: usize> PointLaw<D> for Stiffness {
    const NAME: &'static str = "stiffness of the hourglass control";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[STIFFNESS]);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        let material = around.material;
        let firm = material.youngs_modulus();
        constants[0] = firm.unwrap_or_else(|| material.bulk_modulus());
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        at.set(STIFFNESS, at.constant(0));
    }
}
