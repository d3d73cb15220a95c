//! Physical viscosity: the two pair forms of the Laplacian of the velocity.
//! Morris, Fox & Zhu 1997; Cleary 1998 and Monaghan 2005.

use super::{Layout, Pair, Sums, Term, TermDoc};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

/// Laminar viscosity by central differences of the velocity along the pair.
///
#[doc = include_str!("../../docs/equations/laminar_viscosity.html")]
///
/// (Morris, Fox & Zhu 1997, eq. 22, with the harmonic mean of Hu & Adams 2006 for unlike viscosities).
/// F is their (r·∇W)/(r² + 0.01 h²) without the 0.01 h²: it is finite by itself, and the addend
/// takes from the viscosity.
/// It conserves linear momentum and not angular momentum, and is exact for shear between walls: the
/// default of channels. A wall with free slip has no viscosity, so the mean vanishes there.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LaminarViscosity;

/// Laminar viscosity along the line of centres.
///
#[doc = include_str!("../../docs/equations/central_viscosity.html")]
///
/// (Cleary 1998; Monaghan 2005, eq. 4.29 in the form for D dimensions; instead of their 0.01 h² a mere
/// 10⁻⁶ h² keeps the fraction finite). It conserves linear and
/// angular momentum: the choice for rotating flow and free surfaces.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CentralViscosity;

/// 2 Vᵢ Vⱼ μ̄ F, over the first moment of the lattice.
#[inline(always)]
fn factor<L: Lane, const D: usize, P: Layout>(pair: &Pair<'_, L, D, P>) -> L {
    let (mu_i, mu_j) = (
        pair.i(Field::DYNAMIC_VISCOSITY),
        pair.j(Field::DYNAMIC_VISCOSITY),
    );
    // Two inviscid sides have no mean, and no viscosity; the smallest number keeps it finite.
    let sum = mu_i + mu_j + L::of(f64::from(f32::MIN_POSITIVE));
    let mu = (mu_i + mu_i) * mu_j / sum;
    let volumes = pair.volumes() * pair.lattice_consistency_factor.recip();
    (volumes + volumes) * mu * pair.f
}

const READS: Fields = Fields::of(&[
    Field::VELOCITY,
    Field::MASS,
    Field::DENSITY,
    Field::DYNAMIC_VISCOSITY,
]);

impl<const D: usize> Term<D> for LaminarViscosity {
    const NAME: &'static str = "meshfree::laminar_viscosity";
    const READS: Fields = READS;
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        sums.shear += factor(pair);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "laminar viscosity".into(),
            equation: "mᵢ dvᵢ/dt = Σⱼ Vᵢ Vⱼ 2 μ̄ F vᵢⱼ",
            source: "Morris, Fox & Zhu 1997, eq. 22",
        }
    }
}

impl<const D: usize> Term<D> for CentralViscosity {
    const NAME: &'static str = "meshfree::central_viscosity";
    const READS: Fields = READS;
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let r2 = pair.h.mul_add(pair.h * L::of(1e-6), pair.r2);
        sums.radial += factor(pair) * pair.v_dot_r * L::of(D as f64 + 2.0) / r2;
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "laminar viscosity along the line of centres".into(),
            equation: "mᵢ dvᵢ/dt = Σⱼ Vᵢ Vⱼ 2 (D + 2) μ̄ (v·r)/r² ∇W",
            source: "Cleary 1998; Monaghan 2005",
        }
    }
}
