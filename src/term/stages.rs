//! The stages of a step, in which sweeps over pairs and laws of single particles run.
//! Order among effects is the stage that each names, and within it the names of terms and what laws declare; never a list.

/// A stage of a step: a sweep over pairs, if any term names the stage, and then the laws that name it, in the order that
/// follows from [what they declare](crate::effect::Law).
///
/// | stage | when | sweep over |
/// |---|---|---|
/// | [`Reference`](Self::Reference) | once, when the scene is built | particles of bodies |
/// | [`Contacts`](Self::Contacts) | as the next, where density is integrated and bodies of the group may touch | particles of bodies |
/// | [`Density`](Self::Density) | positions are known and lists are good | particles of bodies |
/// | [`State`](Self::State) | equations of state have given pressure and sound speed | – |
/// | [`Walls`](Self::Walls) | before pair forces | particles of walls |
/// | [`Gradients`](Self::Gradients) | pressures are known, of walls too | particles of bodies |
/// | [`Flow`](Self::Flow) | gradients are known | particles of bodies |
/// | [`Rates`](Self::Rates) | everything that a rate reads is known | particles of bodies |
/// | [`Continuity`](Self::Continuity) | in the middle of a drift | particles of bodies |
/// | [`Bounds`](Self::Bounds) | after a kick or drift has changed evolved fields | – |
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Stage {
    /// What follows from the places of particles as built.
    Reference,
    /// Which contacts are active; where density follows from sums, these show it.
    Contacts,
    /// Sums that follow from positions alone, and the densities that follow from them.
    Density,
    /// What changes pressure or sound speed of a material: damping, strength, phase change.
    State,
    /// What walls take from the liquid before them.
    Walls,
    /// Gradients, exact for linear fields.
    Gradients,
    /// What follows from gradients: viscosities that follow the shear, stresses.
    Flow,
    /// Forces and rates.
    Rates,
    /// States half a drift ahead, from which the next stage sums.
    HalfStep,
    /// The rate of density, and what is summed with it.
    Continuity,
    /// Limits of evolved fields.
    Bounds,
}

impl Stage {
    /// How many there are.
    pub const COUNT: usize = Self::ALL.len();
    /// All, in the order of a step.
    pub const ALL: [Self; 11] = [
        Self::Reference,
        Self::Contacts,
        Self::Density,
        Self::State,
        Self::Walls,
        Self::Gradients,
        Self::Flow,
        Self::Rates,
        Self::HalfStep,
        Self::Continuity,
        Self::Bounds,
    ];

    /// Its name where a scheme prints its step.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reference => "reference",
            Self::Contacts => "contacts",
            Self::Density => "density",
            Self::State => "state",
            Self::Walls => "walls",
            Self::Gradients => "gradients",
            Self::Flow => "flow",
            Self::Rates => "rates",
            Self::HalfStep => "half step",
            Self::Continuity => "continuity",
            Self::Bounds => "bounds",
        }
    }

    /// Its number.
    #[must_use]
    #[inline(always)]
    pub const fn number(self) -> usize {
        self as usize
    }
}
