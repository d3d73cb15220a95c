//! Density forms, each with the pressure form that belongs to it.
//! One choice gives both: a mixed pair loses energy in silence (Bonet & Lok 1999).

use crate::particles::{Field, Fields};
use crate::scalar::Lane;
use core::fmt;
use core::str::FromStr;

/// How density follows from the particles, and with it the form of the pressure force.
///
/// | form | density | weight B | pressure coefficient X |
/// |---|---|---|---|
/// | `Summation` | ρ = Σ m W | m | p/(Ω ρ²) |
/// | `Normalised` | ρ = Σ m W / Σ (m/ρ) W | m | p/ρ² |
/// | `NumberDensity` | ρ = ρ₀ (1 + (S − S₀)/M), S = Σ V₀ W | V₀ | p (ρ₀/ρ)²/M |
/// | `Continuity` | dρ/dt = ρ Σ V v·∇W / s | V | p/s |
/// | `ContinuityByMass` | dρ/dt = Σ m v·∇W | m | p/ρ² |
/// | `Deformation` | ρ = ρ₀/det F | V₀ | – |
/// | `Lam` | ρ = Σ m W against its own first value, normalised at ends | m | p/ρ² |
///
/// S₀, M and s are taken at rest: S₀ makes a body at rest free of stress at ends and joints, and the
/// first moments M = −Σ V₀ r·∇W/D and s make waves run at the sound speed of the material instead of
/// s times it (1.0205 for the cubic spline at h/dx 1.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum DensityForm {
    /// Summation: gases, and shocks in one material.
    ///
    #[doc = include_str!("../../docs/equations/density_summation.html")]
    #[default]
    Summation,
    /// Summation over the partition of unity (Randles & Libersky 1996), everywhere. On a lattice it
    /// returns the density that was put in, whatever the compression: for comparison only.
    ///
    #[doc = include_str!("../../docs/equations/density_normalised.html")]
    Normalised,
    /// Number density relative to its value at rest: solids in their first shape, joints, and contact.
    ///
    #[doc = include_str!("../../docs/equations/density_number.html")]
    ///
    /// Across a contact the sum enters only as far as it exceeds its threshold, so a contact
    /// compresses and never pulls ([`Interaction::Unilateral`](crate::sweep::Interaction)).
    NumberDensity,
    /// Continuity in volume form: large motion, and density ratios at joints.
    ///
    #[doc = include_str!("../../docs/equations/density_continuity.html")]
    Continuity,
    /// Continuity in mass form with the matching σ/ρ² force (Monaghan 1992; the default formulation of
    /// LS-DYNA): bodies of one density.
    ///
    /// dρᵢ/dt = Σⱼ mⱼ vᵢⱼ·∇W
    ContinuityByMass,
    /// Lam, Shen & Gong (2002): summation, first smoothed and then measured against the smoothed
    /// value, with the normalisation of equation 25 at end particles.
    Lam,
    /// ρ = ρ₀/det F with the deformation gradient F of a total-Lagrangian body: of
    /// [`SchemeBuilder::total_lagrangian`](crate::scheme::SchemeBuilder::total_lagrangian) alone.
    Deformation,
}

impl DensityForm {
    /// Every form that a scheme may choose.
    pub const ALL: [Self; 6] = [
        Self::Summation,
        Self::Normalised,
        Self::NumberDensity,
        Self::Continuity,
        Self::ContinuityByMass,
        Self::Lam,
    ];

    /// The name on command lines and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Summation => "summation",
            Self::Normalised => "normalised",
            Self::NumberDensity => "number-density",
            Self::Continuity => "continuity",
            Self::ContinuityByMass => "continuity-by-mass",
            Self::Lam => "lam",
            Self::Deformation => "deformation",
        }
    }

    /// Whether density is integrated in time; if not, it follows from positions.
    #[must_use]
    pub fn is_integrated(self) -> bool {
        matches!(self, Self::Continuity | Self::ContinuityByMass)
    }

    /// Whether neighbours are those of the reference configuration for ever.
    #[must_use]
    pub fn keeps_neighbors(self) -> bool {
        self == Self::Deformation
    }

    /// Whether sums are taken relative to their values at rest.
    #[must_use]
    pub fn has_reference(self) -> bool {
        matches!(self, Self::NumberDensity | Self::Continuity | Self::Lam)
    }

    /// The fields from which that weight follows.
    pub(crate) const fn reads_of_weight(self) -> Fields {
        match self {
            Self::Summation | Self::Normalised | Self::ContinuityByMass | Self::Lam => {
                Fields::of(&[Field::MASS])
            }
            Self::NumberDensity | Self::Deformation => {
                Fields::of(&[Field::MASS, Field::REFERENCE_DENSITY])
            }
            Self::Continuity => Fields::of(&[Field::MASS, Field::DENSITY]),
        }
    }

    /// Weight B of a particle in pair sums.
    #[inline]
    pub(crate) fn weight<L: Lane>(self, mass: L, density: L, rest_density: L) -> L {
        match self {
            Self::Summation | Self::Normalised | Self::ContinuityByMass | Self::Lam => mass,
            Self::NumberDensity | Self::Deformation => mass / rest_density,
            Self::Continuity => mass / density,
        }
    }

    /// Rate of compression (1/ρ) dρ/dt from the sum Σ B v·∇W.
    #[inline(always)]
    pub(crate) fn compression<L: Lane>(self, sum: L, density: L, rest: L, moment: L) -> L {
        match self {
            Self::Summation | Self::Normalised | Self::ContinuityByMass | Self::Lam => {
                sum / density
            }
            Self::NumberDensity | Self::Deformation => sum * (rest / density) / moment,
            Self::Continuity => sum / moment,
        }
    }

    /// Pressure coefficient X.
    #[inline]
    pub(crate) fn coefficient<L: Lane>(self, p: L, density: L, rest: L, moment: L) -> L {
        match self {
            Self::Summation | Self::Normalised | Self::ContinuityByMass | Self::Lam => {
                p / (density * density)
            }
            Self::NumberDensity | Self::Deformation => {
                p * (rest / density) * (rest / density) / moment
            }
            Self::Continuity => p / moment,
        }
    }
}

impl fmt::Display for DensityForm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for DensityForm {
    type Err = String;
    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|form| form.name() == name)
            .ok_or_else(|| {
                format!(
                    "no density form is called `{name}`: there are {}",
                    Self::ALL.map(Self::name).join(", ")
                )
            })
    }
}
