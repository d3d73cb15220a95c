//! The compressible neo-Hookean law: rubber, and any elastic solid under large strain.
//! As Bonet & Wood 2008 (Nonlinear Continuum Mechanics for Finite Element Analysis, chapter 6) have it.

use super::hyperelastic::{self, Response, StoredEnergy};
use super::{Effect, Setting, StepProgram};
use crate::scalar::{Lane, Real};
use crate::tensor::Square;
use crate::term::TermDoc;

/// The stress of a [total-Lagrangian](super::TotalLagrangian) solid by the compressible neo-Hookean law.
///
#[doc = include_str!("../../docs/equations/neo_hookean.html")]
///
/// with J = det F, μ the [shear modulus](crate::material::Material::with_shear_modulus) and λ = K − 2μ/3 by the
/// [bulk modulus](crate::material::Material::bulk_modulus) at rest. It stiffens without bound as a volume vanishes. In two
/// dimensions it is in plane strain, and [in plane stress](Self::plane_stress) on demand; in one in uniaxial strain. Energy and pressure are as for
/// [`StVenantKirchhoff`](super::StVenantKirchhoff).
///
/// ```
/// use meshfree::effect::NeoHookean;
/// use meshfree::prelude::*;
///
/// // Rubber blocks stay rubber blocks: 5 % of their sound speed apart.
/// let rubber = || Material::new("rubber", meshfree::material::eos::Linear::new(1010.0, 54.0)).with_shear_modulus(7e5);
/// let pulled = |[x, _]: [f64; 2], start| meshfree::scheme::Start { velocity: [100.0 * (x - 0.05), 0.0], ..start };
/// let mut block = Scene::<f64, 2>::new(schemes::total_lagrangian().with(NeoHookean))
///     .body(Body::block("block", rubber(), [0.0; 2], [0.1, 0.05], 0.005).start(pulled))
///     .build()?;
/// block.run_until(1e-3)?;
/// let whole = block.ledger().whole;
/// assert!(whole.momentum[0].abs() < 1e-12 && whole.total("elastic energy").unwrap_or(0.0) > 0.0);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct NeoHookean;

impl<const D: usize> Effect<D> for NeoHookean {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let document = TermDoc {
            name: "neo-Hookean".into(),
            equation: "P = μ (F − F⁻ᵀ) + λ ln J F⁻ᵀ",
            source: "Bonet & Wood 2008, chapter 6",
        };
        hyperelastic::register(program, *self, document);
    }
}

impl StoredEnergy for NeoHookean {
    const NAME: &'static str = "neo-Hookean";
    #[inline(always)]
    fn respond<L: Lane, const D: usize>(
        &self,
        [lambda, mu]: [L; 2],
        gradient: &Square<L, D>,
        volume: L,
        back: &Square<L, D>,
        [_, inverse_squared]: [L; 2],
    ) -> Response<L, D> {
        let half = L::of(0.5);
        // What has no volume left has no logarithm either, and ends the run.
        let logarithm = volume.ln();
        let back = back.transposed();
        let strained = gradient.plus(-L::one(), &back).scaled(mu);
        let piola = strained.plus(lambda * logarithm, &back);
        let in_plane = piola.times(&gradient.transposed()).trace();
        let outside = lambda * logarithm * L::of((3 - D) as f64);
        let stretched = gradient.square() - L::of(D as f64);
        // dP = μ dF + (μ − λ ln J) F⁻ᵀ dFᵀ F⁻ᵀ + λ (F⁻ᵀ:dF) F⁻ᵀ.
        let firm = (mu - lambda * logarithm).abs() + lambda;
        Response {
            piola,
            pressure: -(in_plane + outside) / (L::of(3.0) * volume),
            energy: half * mu * (stretched - logarithm - logarithm)
                + half * lambda * logarithm * logarithm,
            stiffness: mu + firm * inverse_squared,
        }
    }
}
