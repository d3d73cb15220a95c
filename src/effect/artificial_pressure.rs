//! Artificial pressure: a repulsion of near particles where a liquid is in tension, so that it does not clump.
//! The remedy of the tensile instability by Monaghan 2000, for liquids.

use super::{Effect, Setting, StepProgram, not_negative};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Sums, Term, TermDoc, stage};

/// The artificial pressure of Monaghan (2000) for liquids in tension.
///
#[doc = include_str!("../../docs/equations/artificial_pressure.html")]
///
/// with the volumes V, the pressure p \[Pa\] and the first moment s of the lattice, as in the pressure force. Particles in
/// tension attract each other the more the nearer they are, up to where the gradient of the kernel is largest, and a
/// liquid breaks up into clumps (Swegle, Hicks & Attaway 1995). fⁿ grows from one at the spacing to 22 at no distance
/// (Wendland C2 at h/dx 1.5, n = 4), so from ε = 0.2 on near pairs repel. Forces are central and opposite: linear and angular
/// momentum stay. They derive from no energy, and ε = 0.5 drives a liquid apart ([hard cases](crate#pages)).
///
/// The paper has p/ρ² and masses, and a hundredth of positive pressures as well; that is left out. Solids have
/// [`ArtificialStress`](super::ArtificialStress). A liquid with a
/// [cut-off](crate::material::Material::with_pressure_cut_off) at zero pressure has no tension, and this does nothing in it.
///
/// Alone it leaves pairs at a free surface; [`PairingControl`](super::PairingControl) with
/// [`Shifting`](super::Shifting) takes them apart:
///
/// ```
/// use meshfree::effect::{ArtificialPressure, PairingControl, Shifting};
/// use meshfree::prelude::*;
///
/// // A patch that spins, and is in tension inside.
/// let water = catalogue::weakly_compressible_water(1.0);
/// let scheme = schemes::weakly_compressible()
///     .with(Shifting::STANDARD)
///     .with(ArtificialPressure::default())
///     .with(PairingControl::default());
/// let spin = |[x, y]: [f64; 2], start| meshfree::scheme::Start { velocity: [y, -x], ..start };
/// let mut patch = Scene::<f64, 2>::new(scheme)
///     .body(Body::block("patch", water, [-0.5; 2], [0.5; 2], 0.1).start(spin))
///     .build()?;
/// patch.run_until(0.2)?;
/// let middle = patch.all().find(|p| p.position().iter().all(|x| x.abs() < 0.1));
/// assert!(middle.is_some_and(|p| p.pressure() < 0.0));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ArtificialPressure {
    /// Share ε of the tension; 0.3: with the 0.2 of the paper voids open in a spinning patch that starts off the lattice, and 0.5
    /// is too much ([hard cases](crate#pages)).
    pub share: f64,
    /// Exponent n of the kernel ratio; 4 as in the paper. Larger ones act nearer alone.
    pub exponent: u32,
}

impl Default for ArtificialPressure {
    fn default() -> Self {
        Self {
            share: 0.3,
            exponent: 4,
        }
    }
}

/// The force of the artificial pressure.
#[derive(Clone, Copy, Debug)]
pub struct TensionRepulsion {
    /// Share and exponent.
    pub of: ArtificialPressure,
    /// One over hᴰ W of the spacing.
    pub over_kernel_at_spacing: f64,
}

impl<const D: usize> Effect<D> for ArtificialPressure {
    type Terms = (In<stage::Rates, TensionRepulsion>,);
    fn terms(&self, setting: &Setting) -> Self::Terms {
        (In::new(TensionRepulsion {
            of: *self,
            over_kernel_at_spacing: 1.0 / setting.kernel_at_spacing,
        }),)
    }
    fn register<T: Real>(&self, _program: &mut StepProgram<T, D>) {}
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[("share of the artificial pressure", self.share)])
    }
}

impl<const D: usize> Term<D> for TensionRepulsion {
    const NAME: &'static str = "meshfree::tension_repulsion";
    const READS: Fields = Fields::of(&[Field::WEIGHT, Field::PRESSURE]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        // What all pairs share comes first, once.
        let ratio = pair.w * (pair.h.powi(D as u32) * L::of(self.over_kernel_at_spacing));
        let tension =
            (-pair.i(Field::PRESSURE)).positive_part() + (-pair.j(Field::PRESSURE)).positive_part();
        let stress = L::of(self.of.share) / pair.lattice_consistency_factor * tension;
        let volumes = pair.i(Field::WEIGHT) * pair.j(Field::WEIGHT);
        sums.gradient
            .add_product(-(volumes * stress), ratio.powi(self.of.exponent));
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!(
                "artificial pressure, ε = {}, n = {}",
                self.of.share, self.of.exponent
            ),
            equation: "mᵢ dvᵢ/dt = −Σⱼ Vᵢ Vⱼ (Rᵢ + Rⱼ)/s ∇W (W/W(Δx))ⁿ, R = ε max(−p, 0)",
            source: "Monaghan 2000",
        }
    }
}
