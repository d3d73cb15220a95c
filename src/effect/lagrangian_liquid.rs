//! The Lagrangian form of a liquid: neighbours as built, and a pressure by the equation of state of the deformed volume.
//! Bonet & Kulasegaram 2001; Vesenjak & Ren 2007 compare it with forms that flow.

use super::total_lagrangian::stretches_of;
use super::{Effect, Point, PointLaw, Reach, Rung, Setting, StepProgram, TotalLagrangian};
use crate::error::Problem;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::term::{Stage, TermDoc};

/// The stress of a liquid in a [total-Lagrangian](TotalLagrangian) scheme: pressure alone, by its equation of state.
///
#[doc = include_str!("../../docs/equations/lagrangian_liquid.html")]
///
/// with the deformation gradient F, J = det F, the density ρ₀ \[kg/m³\] as built and the pressure p \[Pa\], cut off where the
/// [material](crate::material::Material::with_pressure_cut_off) says so. Free surfaces and interfaces are sharp, masses stay, and what
/// opens below the cut-off closes where it opened. Work of the pressure is in the internal energy; shear costs nothing, but for the artificial
/// viscosity and the [hourglass control](super::HourglassControl) of the scheme.
///
/// **For the first part of an impact**, as long as neighbours stay neighbours: a liquid flows on without resistance, and its
/// stretches grow. [`Conversion::distortion`](crate::scene::Conversion::distortion) says when and where it has gone too far.
///
/// Errors: a material with a shear modulus is refused, and a scheme that is not total Lagrangian.
///
/// ```
/// use meshfree::effect::LagrangianLiquid;
/// use meshfree::material::{Liquid, SoundSpeed};
/// use meshfree::prelude::*;
/// use meshfree::scene::Conversion;
///
/// // A block of water that is sheared at 20/s is turned into a long strip, until its neighbours are no longer near.
/// let water = Liquid::water().material("water", SoundSpeed::Chosen(50.0)).with_pressure_cut_off(0.0);
/// let sheared = |[_, y]: [f64; 2], start| meshfree::scene::Start { velocity: [20.0 * y, 0.0], ..start };
/// let mut block = Scene::<f64, 2>::new(schemes::total_lagrangian().with(LagrangianLiquid))
///     .body(Body::block("block", water, [0.0; 2], [0.2, 0.1], 0.01).start(sheared))
///     .build()?;
/// let monitor = Conversion::default();
/// let reason = loop {
///     block.step()?;
///     if let Some(distortion) = monitor.distortion(&block, "block")? {
///         break distortion;
///     }
/// };
/// assert_eq!(reason.quantity, "largest stretch");
/// assert!(block.time() > 0.05);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LagrangianLiquid;

const F: Field = TotalLagrangian::DEFORMATION;
const PIOLA: Field = TotalLagrangian::PIOLA;

impl<const D: usize> Effect<D> for LagrangianLiquid {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(PIOLA, 0.0);
        program.law(Stage::State, *self);
        program.document(TermDoc {
            name: "Lagrangian liquid".into(),
            equation: "P = −J p(ρ₀/J) F⁻ᵀ",
            source: "Bonet & Kulasegaram 2001",
        });
        program.require(|scene| {
            let mut bodies = scene.bodies.iter();
            let (body, material) = bodies.find(|(_, own)| own.shear_modulus.is_some())?;
            Some(Problem::Incompatible {
                what: format!(
                    "LagrangianLiquid has no resistance to shear, and body `{body}`, of {}, has a shear modulus",
                    material.name
                ),
                remedy: "leave out Material::with_shear_modulus, or take the stress of a solid, as NeoHookean",
            })
        });
    }
}

impl<const D: usize> PointLaw<D> for LagrangianLiquid {
    const NAME: &'static str = "pressure of the deformed volume";
    const READS: Fields = Fields::of(&[F, Field::PRESSURE, Field::SOUND_SPEED]);
    const WRITES: Fields = Fields::of(&[PIOLA, Field::SOUND_SPEED]);
    const RUNG: Option<Rung> = Some(Rung::Flow);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let gradient = at.matrix(F);
        let (volume, back) = (gradient.determinant(), gradient.inverse(0.0).0);
        let factor = -volume * at.get(Field::PRESSURE);
        at.set_matrix(PIOLA, &back.transposed().scaled(factor));
        // Along X: the speed of sound over the smallest stretch.
        let [_, over] = stretches_of(&gradient, &back);
        at.set(Field::SOUND_SPEED, at.get(Field::SOUND_SPEED) * over.sqrt());
    }
}
