//! The indicators of a state: median, worst and where, of all particles whose support is whole.
//! What limits accuracy follows from them.

use super::super::stability::Extreme;
use core::fmt;

/// The values of an indicator over particles.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Spread {
    /// Half of the particles have less.
    pub median: f64,
    /// The worst, and where.
    pub worst: Extreme,
}

/// How far the sums of a state are from those of a continuum, and how well it resolves what is in it. What could not be
/// measured is `None`.
///
/// V = m/ρ is the volume of a particle, W the kernel that the scheme sums with, r = xⱼ − xᵢ and dx the local spacing
/// V^(1/D). In total-Lagrangian bodies the sums are those of the reference configuration.
///
/// The measures of consistency are those of Quinlan, Basa & Lastiwka (2006, 10.1002/nme.1617); the cone that finds surfaces is
/// after Marrone, Colagrossi, Le Touzé & Graziani (2010, 10.1016/j.jcp.2010.01.019).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Indicators {
    /// The time \[s\].
    pub time: f64,
    /// Particles that were looked at.
    pub particles: usize,
    /// Those whose support no free surface cuts: what all but `thickness` is of.
    pub inside: usize,
    /// Unity defect |1 − Σ V W|: by how much the volumes of neighbours fail to fill space. On a square lattice 0.5 % of
    /// Wendland's C2 at h/dx 1.5.
    pub unity: Option<Spread>,
    /// Gradient defect ‖Σ V r⊗∇W − 1‖/√D: the relative error of the gradient of a linear field, before what the scheme
    /// corrects.
    pub gradient: Option<Spread>,
    /// The same with the scheme's own consistency factor divided out: what it leaves of it.
    pub left: Option<Spread>,
    /// Disorder h |Σ V ∇W|: the gradient that a constant field shows, in units of that field over h. Zero on lattices.
    pub disorder: Option<Spread>,
    /// |ρ₀ Σ V₀ W/(ρ U) − 1|: density by the sum, with that of the lattice U divided out, against the density carried.
    pub density: Option<Spread>,
    /// The mean of the same with its sign: what volume has drifted by, where the noise of an arrangement cancels.
    pub drift: Option<f64>,
    /// dx |∇p|/Δp with the range Δp of pressure in the group: the spacing over the width of a front of pressure. The worst is
    /// the steepest front; one over it is how many particles it is wide.
    pub fronts: Option<Spread>,
    /// dx ‖∇v‖/Δv, the same of velocity: shear layers and boundary layers.
    pub layers: Option<Spread>,
    /// Particles across each body, from its faces inwards, 32 at most: walls and films. The worst is the thinnest place. A
    /// liquid between walls counts as what is between them; what images continue does not count.
    pub thickness: Vec<Spread>,
    /// What limits accuracy, the most limiting first.
    pub limits: Vec<Limit>,
}

impl Indicators {
    /// What limits accuracy most here; `None` if nothing that is measured does, as in a lattice at rest.
    #[must_use]
    pub fn limit(&self) -> Option<&Limit> {
        self.limits.first()
    }
}

/// What can limit accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum LimitedBy {
    /// The kernel smooths what is narrower than it: fronts, waves, layers. The remedy is a finer spacing.
    Smoothing,
    /// Sums over neighbours are not those of a continuum, whatever the spacing: the floor. The remedy is a larger h/dx.
    Sums,
    /// Neighbours that lie unevenly push where nothing should. The remedy is a larger h/dx, or shifting.
    Disorder,
    /// The density carried has drifted from the volume that particles have.
    Drift,
    /// Too few particles across a wall or film.
    Thickness,
}

impl fmt::Display for LimitedBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Smoothing => "spacing: smoothing",
            Self::Sums => "floor: sums over neighbours",
            Self::Disorder => "floor: disorder",
            Self::Drift => "drift of density",
            Self::Thickness => "spacing: thickness",
        })
    }
}

/// A limit of accuracy, and what one step better costs. Printed it is a sentence.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Limit {
    /// What limits.
    pub by: LimitedBy,
    /// The relative error that it leaves, to its order of magnitude.
    ///
    /// | limit | estimate | of |
    /// |---|---|---|
    /// | smoothing | 2 σ² (h/w)², one at most | σ² h² the second moment of the kernel along an axis, w the width of the steepest front; that of the gradient of a wave with the same range and slope |
    /// | sums | median of [`Indicators::left`] | the gradient of a linear field |
    /// | disorder | 2 p̄/Δp · w/h · median disorder | the force of a uniform pressure p̄ (median) over that of the front |
    /// | drift | [`Indicators::drift`] | volume |
    /// | thickness | 1/N below four particles N (median) across a body | the width of a film by whole particles |
    pub error: f64,
    /// Where it is worst, if that is one place.
    pub at: Option<Extreme>,
    /// One step better, in words.
    pub remedy: String,
    /// Time of a run with it over that of the present one, by particles, pairs and steps; where it is known.
    pub cost: Option<f64>,
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = crate::output::table::significant(100.0 * self.error, 2);
        write!(f, "{}, about {percent} %; {}", self.by, self.remedy)?;
        match self.cost {
            Some(cost) => write!(f, " costs {cost:.1}x"),
            None => Ok(()),
        }
    }
}

/// The median of some numbers.
pub(super) fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
