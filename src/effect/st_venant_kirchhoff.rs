//! The law of St Venant and Kirchhoff: Hooke's law between Green's strain and its stress.
//! As Bonet & Wood 2008 (Nonlinear Continuum Mechanics for Finite Element Analysis, chapter 6) have it.

use super::hyperelastic::{self, Response, StoredEnergy};
use super::{Effect, Setting, StepProgram};
use crate::scalar::{Lane, Real};
use crate::tensor::Square;
use crate::term::TermDoc;

/// The stress of a [total-Lagrangian](super::TotalLagrangian) solid by Hooke's law in Green's strain E = ½ (FᵀF − 1).
///
#[doc = include_str!("../../docs/equations/st_venant_kirchhoff.html")]
///
/// with μ the [shear modulus](crate::material::Material::with_shear_modulus) and λ = K − 2μ/3 by the
/// [bulk modulus](crate::material::Material::bulk_modulus) at rest. For large rotations and moderate strains: it softens
/// in compression, and has no strength left at a stretch of 0.58. Rubber is [`NeoHookean`](super::NeoHookean). In two
/// dimensions it is in plane strain, and [in plane stress](Self::plane_stress) on demand; in one in uniaxial strain.
///
/// | it adds | as |
/// |---|---|
/// | [`TotalLagrangian::PIOLA`](super::TotalLagrangian::PIOLA) | P \[Pa\] |
/// | elastic energy | ψ/ρ₀ \[J/kg\], in the ledger as `elastic energy` |
/// | pressure | −tr σ/3, in place of that of the equation of state |
///
/// ```
/// use meshfree::effect::StVenantKirchhoff;
/// use meshfree::prelude::*;
///
/// // A soft bar that is thrown out of its shape rings, and keeps its energy.
/// let soft = Material::new("soft", meshfree::material::eos::Linear::new(1000.0, 50.0)).with_shear_modulus(1e6);
/// let thrown = |[x, _]: [f64; 2], start| meshfree::scheme::Start { velocity: [0.0, 5.0 * x], ..start };
/// let mut bar = Scene::<f64, 2>::new(schemes::total_lagrangian().with(StVenantKirchhoff))
///     .body(Body::block("bar", soft, [0.0; 2], [0.2, 0.04], 0.01).start(thrown))
///     .build()?;
/// bar.run_until(2e-3)?;
/// let whole = bar.ledger().whole;
/// assert!(whole.total("elastic energy").unwrap_or(0.0) > 0.0);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct StVenantKirchhoff;

impl<const D: usize> Effect<D> for StVenantKirchhoff {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let document = TermDoc {
            name: "St Venant–Kirchhoff".into(),
            equation: "P = F (λ tr E + 2 μ E), E = ½ (FᵀF − 1)",
            source: "Bonet & Wood 2008, chapter 6",
        };
        hyperelastic::register(program, *self, document);
    }
}

impl StoredEnergy for StVenantKirchhoff {
    const NAME: &'static str = "St Venant–Kirchhoff";
    #[inline(always)]
    fn respond<L: Lane, const D: usize>(
        &self,
        [lambda, mu]: [L; 2],
        gradient: &Square<L, D>,
        volume: L,
        _back: &Square<L, D>,
        [squared, _]: [L; 2],
    ) -> Response<L, D> {
        let (half, one) = (L::of(0.5), Square::identity());
        let right = gradient.transposed().times(gradient);
        let green = right.plus(-L::one(), &one).scaled(half);
        let trace = green.trace();
        let second = one.scaled(lambda * trace).plus(mu + mu, &green);
        let piola = gradient.times(&second);
        // Out of the plane, where nothing is stretched, σ is λ tr E/J.
        let in_plane = piola.times(&gradient.transposed()).trace();
        let outside = lambda * trace * L::of((3 - D) as f64);
        let three = L::of(3.0);
        // dP = dF S + F dS, of which the first counts where it pulls.
        let pulls = (lambda * trace + mu * (squared - L::one())).max(L::zero());
        Response {
            piola,
            pressure: -(in_plane + outside) / (three * volume),
            energy: half * lambda * trace * trace + mu * green.square(),
            stiffness: (lambda + mu + mu) * squared + pulls,
        }
    }
}
