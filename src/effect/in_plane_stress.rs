//! Plane stress of total-Lagrangian sheets: the stretch across the sheet is the one that leaves no stress there.
//! In closed form for St Venant–Kirchhoff, by Newton's method for neo-Hookean sheets.

use super::hyperelastic::{self, ELASTIC, Response, StoredEnergy};
use super::total_lagrangian::stretches_of;
use super::{
    Around, CONSTANTS, Effect, NeoHookean, Point, PointLaw, Reach, Setting, StVenantKirchhoff,
    StepProgram, TotalLagrangian,
};
use crate::name;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real, iterate};
use crate::tensor::Square;
use crate::term::{Stage, TermDoc};

/// A hyperelastic law of [total-Lagrangian](TotalLagrangian) solids in plane stress, in two dimensions: sheets that are free to
/// thin, whose longitudinal waves run at √(E/ρ(1 − ν²)).
///
/// With F of the plane and the stretch λ₃ across it,
///
#[doc = include_str!("../../docs/equations/in_plane_stress.html")]
///
/// λ₃² = 1 − 2λ/(λ + 2μ) (E₁₁ + E₂₂) for [`StVenantKirchhoff`], and μ (λ₃² − 1) + λ ln(J λ₃) = 0 for [`NeoHookean`] (with
/// J = det F of the plane), to rounding. The stored energy is that of the sheet, so it is kept as in plane strain. A St
/// Venant–Kirchhoff sheet has no thickness left where E₁₁ + E₂₂ = (λ + 2μ)/2λ, and ends the run there; a neo-Hookean one
/// always has. Density is that of the plane, and [`HourglassControl`](super::HourglassControl) acts as ever.
///
/// Without it a plane of particles is a slice of a long body, in plane strain. Sheets of updated-Lagrangian solids are
/// [`PlaneStress`](super::PlaneStress).
///
/// | it adds | as |
/// |---|---|
/// | [`THICKNESS`](InPlaneStress::THICKNESS) | λ₃ |
/// | all that the law adds | as in plane strain |
///
/// ```
/// use meshfree::effect::{NeoHookean, InPlaneStress};
/// use meshfree::prelude::*;
///
/// // A rubber sheet that is pulled gets thinner.
/// let rubber = Material::new("rubber", meshfree::material::eos::Linear::new(1010.0, 54.0)).with_shear_modulus(7e5);
/// let pulled = |[x, _]: [f64; 2], start| meshfree::scheme::Start { velocity: [100.0 * (x - 0.05), 0.0], ..start };
/// let mut sheet = Scene::<f64, 2>::new(schemes::total_lagrangian().with(NeoHookean.plane_stress()))
///     .body(Body::block("sheet", rubber, [0.0; 2], [0.1, 0.05], 0.005).start(pulled))
///     .build()?;
/// sheet.run_until(1e-3)?;
/// let thinnest = sheet.all().filter_map(|p| p.scalar(InPlaneStress::<NeoHookean>::THICKNESS)).fold(1.0, f64::min);
/// assert!(thinnest < 0.97);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct InPlaneStress<E>(E);

impl<E> InPlaneStress<E> {
    /// Stretch λ₃ across the sheet.
    pub const THICKNESS: Field = THICKNESS;
}

impl StVenantKirchhoff {
    /// The law for sheets, in plane stress.
    #[must_use]
    pub const fn plane_stress(self) -> InPlaneStress<Self> {
        InPlaneStress(self)
    }
}

impl NeoHookean {
    /// The law for sheets, in plane stress.
    #[must_use]
    pub const fn plane_stress(self) -> InPlaneStress<Self> {
        InPlaneStress(self)
    }
}

const THICKNESS: Field = Field::scalar(name!("thickness", "1"));
const F: Field = TotalLagrangian::DEFORMATION;
const PIOLA: Field = TotalLagrangian::PIOLA;

fn register<T: Real, E: Sheet>(law: InPlaneStress<E>, program: &mut StepProgram<T, 2>) {
    program.declare(THICKNESS, 1.0);
    let document = TermDoc {
        name: format!("{} in plane stress", E::NAME),
        equation: E::EQUATION,
        source: "the law with P₃₃ = 0",
    };
    hyperelastic::declare(program, document);
    program.law(Stage::State, law);
}

impl Effect<2> for InPlaneStress<StVenantKirchhoff> {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, 2>) {
        register(*self, program);
    }
}

impl Effect<2> for InPlaneStress<NeoHookean> {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, 2>) {
        register(*self, program);
    }
}

/// A law whose sheets are known.
trait Sheet: StoredEnergy {
    const EQUATION: &'static str;
    /// λ₃ of no stress across, of Lamé's constants \[Pa\] and F of the plane.
    fn thickness<L: Lane>(lame: [L; 2], gradient: &Square<L, 2>) -> L;
}

impl Sheet for StVenantKirchhoff {
    const EQUATION: &'static str = "P = F (λ tr E + 2 μ E), λ tr E + 2 μ E₃₃ = 0";
    #[inline(always)]
    fn thickness<L: Lane>([lambda, mu]: [L; 2], gradient: &Square<L, 2>) -> L {
        let right = gradient.transposed().times(gradient);
        let green = right
            .plus(-L::one(), &Square::identity())
            .scaled(L::of(0.5));
        let two = L::of(2.0);
        (L::one() - two * lambda / (lambda + two * mu) * green.trace()).sqrt()
    }
}

impl Sheet for NeoHookean {
    const EQUATION: &'static str = "P = μ (F − F⁻ᵀ) + λ ln(J λ₃) F⁻ᵀ, μ (λ₃² − 1) + λ ln(J λ₃) = 0";
    #[inline(always)]
    fn thickness<L: Lane>([lambda, mu]: [L; 2], gradient: &Square<L, 2>) -> L {
        // In s = ln λ₃ the condition is rising and convex for λ ≥ 0: Newton's method comes down to the root.
        let (area, two) = (gradient.determinant().ln(), L::of(2.0));
        let first = -lambda * area / (lambda + two * mu);
        let [s] = iterate!(L, MOST_TRIALS, [first], |[s]| {
            let squared = (two * s).exp();
            let excess = lambda.fused(area + s, mu * (squared - L::one()));
            let change = excess / (two * mu).fused(squared, lambda);
            let next = s - change;
            // NaN stays NaN, and ends the run.
            let least = L::of(f64::EPSILON) * next.abs().max(L::of(f64::MIN_POSITIVE));
            ([next], !change.abs().gt(least))
        });
        s.exp()
    }
}

/// More than Newton's method takes, which is three to six.
const MOST_TRIALS: usize = 30;

impl<E: Sheet> PointLaw<2> for InPlaneStress<E> {
    const NAME: &'static str = E::NAME;
    const READS: Fields = Fields::of(&[F, Field::REFERENCE_DENSITY]);
    const WRITES: Fields = Fields::of(&[
        PIOLA,
        ELASTIC,
        THICKNESS,
        Field::PRESSURE,
        Field::SOUND_SPEED,
    ]);
    const DOUBLE: bool = true;
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, 2>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        [constants[0], constants[1]] = hyperelastic::lame(around);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, 2, P>) {
        let (plane, rest) = (at.matrix(F), at.get(Field::REFERENCE_DENSITY));
        let lame = [at.constant(0), at.constant(1)];
        let across = E::thickness(lame, &plane);
        let own = respond(self.0, lame, &plane, across);
        for k in 0..4 {
            at.set_at(PIOLA, k, own.piola.0[k / 2][k % 2]);
        }
        at.set(ELASTIC, own.energy / rest);
        at.set(THICKNESS, across);
        at.set(Field::PRESSURE, own.pressure);
        // Stiffness against F of the plane is at most that at constant thickness.
        at.set(Field::SOUND_SPEED, (own.stiffness / rest).sqrt());
    }
}

/// The response of a sheet to F of the plane and the stretch across it.
#[inline(always)]
fn respond<L: Lane, E: Sheet>(
    law: E,
    lame: [L; 2],
    plane: &Square<L, 2>,
    across: L,
) -> Response<L, 3> {
    let mut gradient = Square::<L, 3>::zero();
    for a in 0..2 {
        for b in 0..2 {
            gradient.0[a][b] = plane.0[a][b];
        }
    }
    gradient.0[2][2] = across;
    let (volume, back) = (gradient.determinant(), gradient.inverse(0.0).0);
    let bounds = stretches_of(&gradient, &back);
    law.respond(lame, &gradient, volume, &back, bounds)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAME: [f64; 2] = [3.0, 2.0];

    fn sheet<E: Sheet>(law: E, plane: &Square<f64, 2>) -> (Response<f64, 3>, f64) {
        let across = E::thickness(LAME, plane);
        (respond(law, LAME, plane, across), across)
    }

    /// No stress across, and the stress of the plane is the slope of the sheet's own energy.
    fn relaxes<E: Sheet>(law: E) {
        let plane = Square([[1.12, 0.07], [-0.05, 0.91]]);
        let (own, across) = sheet(law, &plane);
        assert!(own.piola.0[2][2].abs() < 1e-14, "{}", own.piola.0[2][2]);
        assert!((across - 1.0).abs() > 1e-3);
        for a in 0..2 {
            for b in 0..2 {
                let energy = |by: f64| {
                    let mut moved = plane;
                    moved.0[a][b] += by;
                    sheet(law, &moved).0.energy
                };
                let slope = (energy(1e-5) - energy(-1e-5)) / 2e-5;
                assert!((slope - own.piola.0[a][b]).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn sheets_bear_no_stress_across() {
        relaxes(StVenantKirchhoff);
        relaxes(NeoHookean);
    }

    /// Simple tension to a stretch of 1.3 and to 0.8: sides and thickness narrow alike, P₁₁ = E λ₁ E₁₁ and E₂₂ = −ν E₁₁ by
    /// the law of St Venant and Kirchhoff; for the neo-Hookean one the lateral stretch is bisected.
    #[test]
    fn simple_tension_by_closed_forms() {
        let [lambda, mu] = LAME;
        let young = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
        let poisson = lambda / (2.0 * (lambda + mu));
        for stretch in [1.3, 0.8] {
            let green = 0.5 * (stretch * stretch - 1.0_f64);
            let lateral = (1.0 - 2.0 * poisson * green).sqrt();
            let (own, across) = sheet(StVenantKirchhoff, &Square([[stretch, 0.0], [0.0, lateral]]));
            assert!((across - lateral).abs() < 1e-14 && own.piola.0[1][1].abs() < 1e-13);
            assert!((own.piola.0[0][0] - young * stretch * green).abs() < 1e-13);

            let excess = |y: f64| mu * (y * y - 1.0) + lambda * (stretch * y * y).ln();
            let (mut low, mut high) = (0.1, 10.0);
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if excess(middle) > 0.0 {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            let (own, across) = sheet(NeoHookean, &Square([[stretch, 0.0], [0.0, low]]));
            assert!((across - low).abs() < 1e-14 && own.piola.0[1][1].abs() < 1e-13);
            // The Kirchhoff stress μ (λ₁² − 1) + λ ln J, less that of the sides, which is zero.
            let kirchhoff = mu * (stretch * stretch - low * low);
            assert!((own.piola.0[0][0] - kirchhoff / stretch).abs() < 1e-13);
        }
    }
}
