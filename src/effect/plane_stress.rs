//! Plane stress: sheets in two dimensions that are free to thin, the strain by which stress across them is zero.
//! Without it a plane of particles is a slice of a long body, in plane strain.

use super::{
    Around, CONSTANTS, Effect, Evolved, Hypoelastic, Point, PointLaw, PointRate, Reach, Setting,
    StepProgram, When,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real, iterate};
use crate::tensor::Symmetric;
use crate::term::{Stage, TermDoc};

/// Plane stress, for [`Hypoelastic`] solids in two dimensions: thin sheets, whose longitudinal waves run at
/// √(E/ρ(1 − ν²)).
///
#[doc = include_str!("../../docs/equations/plane_stress.html")]
///
/// with Poisson's ratio ν of the material at rest. Where [`Plasticity`](super::Plasticity) lets a particle flow, what
/// ε_zz changes beyond that follows from the return itself: δ solves
///
#[doc = include_str!("../../docs/equations/plane_stress_return.html")]
///
/// with the stress σ of von Mises of S(δ), its yield stress Y after flow, and bulk modulus K (the condition of Simo &
/// Taylor 1986, solved by the strain and not by their projection). The pressure of the equation of state does not act.
/// Strains are small, as in [`UniaxialStress`](super::UniaxialStress): the force is that on the thickness at rest, and
/// density is that of the plane. The step, and viscosity, take the speed of longitudinal waves in the bulk, which is
/// above that of the sheet.
///
/// | it adds | as |
/// |---|---|
/// | [`THICKNESS_STRAIN`](Self::THICKNESS_STRAIN) | ε_zz, positive where the sheet is thicker |
///
/// ```
/// use meshfree::effect::{Hypoelastic, PlaneStress};
/// use meshfree::prelude::*;
///
/// // A steel sheet that is pulled gets thinner.
/// let pulled = |[x, _]: [f64; 2], start| meshfree::scheme::Start { velocity: [200.0 * x, 0.0], ..start };
/// let scheme = schemes::impact_by_continuity().with(Hypoelastic).with(PlaneStress);
/// let mut sheet = Scene::<f64, 2>::new(scheme)
///     .body(Body::block("sheet", catalogue::steel_4340(), [0.0; 2], [0.02, 0.01], 1e-3).start(pulled))
///     .build()?;
/// sheet.run_until(1e-6)?;
/// let strains = sheet.all().filter_map(|p| p.scalar(PlaneStress::THICKNESS_STRAIN));
/// assert!(strains.fold(0.0, f64::min) < -1e-5);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct PlaneStress;

impl PlaneStress {
    /// Strain ε_zz of the thickness.
    pub const THICKNESS_STRAIN: Field = Field::scalar(name!("thickness_strain", "1"));
}

const STRESS: Field = Hypoelastic::STRESS;
const THICKNESS_STRAIN: Field = PlaneStress::THICKNESS_STRAIN;
const GRADIENT: Outputs = Outputs::of(&[Output::VELOCITY_GRADIENT, Output::MOMENT_MATRIX]);

impl Effect<2> for PlaneStress {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, 2>) {
        program.declare(THICKNESS_STRAIN, 0.0);
        let strain = Evolved::kicked(THICKNESS_STRAIN).at(When::Drift);
        program.evolve(strain.by(*self));
        program.contribute(STRESS, ThinningStress);
        program.law(Stage::State, *self);
        program.document(TermDoc {
            name: "plane stress".into(),
            equation: "D_zz = −ν/(1 − ν) (D_xx + D_yy), p = S_zz",
            source: "Hooke's law with σ_zz = 0; Simo & Taylor 1986 where it flows",
        });
        program.require(|scene| {
            (!scene.integrated.contains(STRESS)).then(|| Problem::Incompatible {
                what:
                    "PlaneStress needs a deviatoric stress, which nothing in the scheme integrates"
                        .into(),
                remedy: "add the elastic solid as well: .with(Hypoelastic)",
            })
        });
    }
}

/// −ν/(1 − ν) of the material, and twice its shear modulus.
fn constants<T: Real>(around: &Around<'_, T, 2>) -> [f64; CONSTANTS] {
    let poisson = around.material.poisson_ratio().unwrap_or(0.0);
    let shear = around.material.shear_modulus.unwrap_or(0.0);
    [-poisson / (1.0 - poisson), 2.0 * shear, 0.0, 0.0]
}

/// −ν/(1 − ν) ∇·v of each particle.
#[inline(always)]
fn thinning<L: Lane, P: Reach>(at: &Point<'_, L, 2, P>) -> L {
    at.velocity_gradient().trace() * at.constant(0)
}

impl PointRate<2> for PlaneStress {
    const SUMS: Outputs = GRADIENT;
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, 2>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        *constants = self::constants(around);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, 2, P>, _present: L, rate: &mut [L]) {
        rate[0] += thinning(at);
    }
}

/// What thinning adds to the rate of S, 2 G (D − tr D/3) of its one component.
#[derive(Clone, Copy, Debug)]
struct ThinningStress;

impl PointRate<2> for ThinningStress {
    const SUMS: Outputs = GRADIENT;
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, 2>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        *constants = self::constants(around);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, 2, P>, _present: L, rate: &mut [L]) {
        let strain = Symmetric::diagonal([L::zero(), L::zero(), thinning(at)]);
        for (rate, own) in rate.iter_mut().zip(strain.deviator().components()) {
            *rate += at.constant(1) * *own;
        }
    }
}

impl PointLaw<2> for PlaneStress {
    const NAME: &'static str = "pressure of plane stress";
    const READS: Fields = Fields::of(&[STRESS]);
    const WRITES: Fields = Fields::of(&[Field::PRESSURE]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, 2, P>) {
        at.set(Field::PRESSURE, at.get_at(STRESS, 2));
    }
}

/// The strain δ across a sheet, beyond the elastic one, at which a return to the yield surface leaves no stress there.
///
/// `trial` is S \[Pa\] after the elastic change, its zz component the pressure; `asked` says where δ is asked for, and `left` gives
/// Y/σ for a stress of von Mises \[Pa\], one where it does not yield.
#[inline(always)]
pub(super) fn strain_across<L: Lane>(
    trial: &Symmetric<L>,
    [bulk, shear]: [f64; 2],
    asked: L::Mask,
    left: impl Fn(L) -> L,
) -> L {
    let (pressure, bulk) = (trial.at(2, 2), L::of(bulk));
    // The elastic slope K + 4G/3 is an upper bound for a law that hardens, and K a lower one for any share that falls
    // while σ grows: Newton with what lies between, kept within its bracket by halving.
    let endless = L::of(f64::INFINITY);
    let least = L::of(1e-14) * trial.von_mises().max(L::of(f64::MIN_POSITIVE));
    let [strain, _, _] = iterate!(L, MOST_TRIALS, [L::zero(), -endless, endless], |[
        strain,
        low,
        high,
    ]| {
        let changed = with_strain_across(trial, shear, strain);
        let share = left(changed.von_mises());
        let residual = share.fused(changed.at(2, 2), bulk.fused(strain, -pressure));
        let above = residual.gt(L::zero());
        let (low, high) = (
            L::select(above, low, strain),
            L::select(above, strain, high),
        );
        let next = strain - residual / L::of(4.0 / 3.0 * shear).fused(share, bulk);
        let outside = next.le(low) | next.ge(high);
        let next = L::select(outside, L::of(0.5) * (low + high), next);
        let stays = (next.le(strain) & next.ge(strain)) | !next.abs().lt(endless);
        let done = !asked | residual.abs().le(least) | stays;
        ([L::select(done, strain, next), low, high], done)
    });
    strain
}

/// Most trials of a return; some ten are enough, because the slope is at most 1 + 4G/3K from the one taken.
const MOST_TRIALS: usize = 40;

/// S with the elastic change by a strain across the sheet.
#[inline(always)]
pub(super) fn with_strain_across<L: Lane>(
    stress: &Symmetric<L>,
    shear: f64,
    strain: L,
) -> Symmetric<L> {
    let change = Symmetric::diagonal([-1.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0].map(L::of));
    stress.plus(L::of(2.0 * shear) * strain, &change)
}
