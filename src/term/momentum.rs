//! The pressure force between particles, and the energy it costs.
//! One pair law serves every density form: the form sets weights and coefficients (Bonet & Lok 1999).

use super::{Layout, Pair, Sums, Term, TermDoc};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

/// The pressure force of a pair, for every density form.
///
#[doc = include_str!("../../docs/equations/pressure_force.html")]
///
/// | density form | B | X | becomes |
/// |---|---|---|---|
/// | summation | m | p/ρ² | −mᵢmⱼ (pᵢ/ρᵢ² + pⱼ/ρⱼ²) ∇W |
/// | number density | V₀ | p (ρ₀/ρ)²/M | pV² form, normalised |
/// | continuity | V | p/s | −VᵢVⱼ (pᵢ + pⱼ) ∇W, normalised |
///
/// It is the derivative of the internal energy with respect to positions under the matching density,
/// so energy is conserved by the pair, and linear and angular momentum by symmetry.
#[derive(Clone, Copy, Debug)]
pub struct PressureForce;

impl<const D: usize> Term<D> for PressureForce {
    const NAME: &'static str = "meshfree::pressure_force";
    const READS: Fields = Fields::of(&[Field::WEIGHT, Field::PRESSURE_COEFFICIENT]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let weights = pair.i(Field::WEIGHT) * pair.j(Field::WEIGHT);
        let [x_i, x_j] = [
            pair.i(Field::PRESSURE_COEFFICIENT),
            pair.j(Field::PRESSURE_COEFFICIENT),
        ];
        sums.add_along_gradients(pair, -weights, x_i, x_j);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "pressure force".into(),
            equation: "mᵢ dvᵢ/dt = −Σⱼ Bᵢ Bⱼ (Xᵢ + Xⱼ) ∇Wᵢⱼ",
            source: "Bonet & Lok 1999; Lam, Shen & Gong 2002, eq. 20",
        }
    }
}

/// Pressure reconstructed at the middle of a pair from both sides, which removes the leading
/// dispersion of the pair form.
///
#[doc = include_str!("../../docs/equations/midpoint_reconstruction.html")]
///
/// On a lattice the uncorrected pair moves a wave of wavenumber k too slowly, by moments of the
/// gradient factor F:
///
#[doc = include_str!("../../docs/equations/dispersion.html")]
///
/// That is 0.4 % at fifty spacings a wavelength, and the source of the ringing behind a front. The
/// density and the pressure force each lose the share β k² dx², and the curvature adds 6χ β k² dx² to
/// the force: χ = 1/3 makes up for both, for every kernel. The force stays antisymmetric, but derives
/// from no energy: pair it with the compatible energy form.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct MidpointReconstruction {
    /// Strength χ; 1/3 cancels the leading dispersion.
    pub strength: f64,
}

impl MidpointReconstruction {
    /// χ = 1/3.
    pub const STANDARD: Self = Self {
        strength: 1.0 / 3.0,
    };
}

impl<const D: usize> Term<D> for MidpointReconstruction {
    const NAME: &'static str = "meshfree::midpoint_reconstruction";
    const READS: Fields = Fields::of(&[
        Field::MASS,
        Field::DENSITY,
        Field::PRESSURE_GRADIENT,
        Field::CONSISTENCY_FACTOR,
    ]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let mut bend = L::zero();
        for d in 0..D {
            let gradient = Field::PRESSURE_GRADIENT;
            bend += (pair.i_at(gradient, d) - pair.j_at(gradient, d)) * pair.r[d];
        }
        let volumes = pair.volumes();
        let consistency = pair.i(Field::CONSISTENCY_FACTOR) + pair.j(Field::CONSISTENCY_FACTOR);
        sums.radial += L::of(4.0 * self.strength) * volumes * bend * pair.f / consistency;
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("midpoint reconstruction, strength {}", self.strength),
            equation: "mᵢ dvᵢ/dt = Σⱼ 2χ Vᵢ Vⱼ (∇pᵢ − ∇pⱼ)·rᵢⱼ ∇Wᵢⱼ / s̄ᵢⱼ",
            source: "linear reconstruction after van Leer 1979, applied to the pair pressure",
        }
    }
}

/// Internal energy: each side of a pair takes half the work of all its forces.
///
#[doc = include_str!("../../docs/equations/energy_symmetric.html")]
///
/// The term names the sum; the sweep fills it from whatever forces the other terms set, so total
/// energy is conserved in continuous time for any list of terms.
#[derive(Clone, Copy, Debug)]
pub struct InternalEnergy;

impl<const D: usize> Term<D> for InternalEnergy {
    const NAME: &'static str = "meshfree::internal_energy";
    const READS: Fields = Fields::of(&[Field::VELOCITY]);
    const WRITES: Outputs = Outputs::of(&[Output::POWER]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, _pair: &Pair<'_, L, D, P>, _sums: &mut Sums<L, D, P>) {}
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "internal energy".into(),
            equation: "mᵢ deᵢ/dt = −½ Σⱼ Fᵢⱼ·vᵢⱼ",
            source: "Monaghan & Gingold 1983; Lam, Shen & Gong 2002, eq. 21",
        }
    }
}
