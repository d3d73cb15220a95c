//! What a run must keep to be called stable.
//! Thresholds are those of the crate's hard cases, for a case to override.

/// What a run must keep to be called stable. A threshold at infinity (or zero, where the least counts) asks for nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Thresholds {
    /// Least and largest density over that at rest of the material; 0 and infinity. One over it is the Jacobian.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub density: [f64; 2],
    /// Largest ρ/ρ₀ − 1 of a liquid whose scheme carries no energy; 0.03. It is left where more than one in a hundred
    /// particles of a body exceed it for longer than sound takes to cross the body. Pressure of the flow does that where
    /// the sound speed is too low for it; a wave of an impact passes, and surfaces and cavities, which expand, do not count.
    /// Liquids that are meant to be compressed so need more.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub compression: f64,
    /// Largest share of particle steps in which a limit or a guard of an equation of state acted; 10⁻⁴.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub limited: f64,
    /// Largest residual of momentum over Σ m |v|; 10⁻¹⁰, or a thousand roundings of the scalar. Forces that are no pair
    /// forces (renormalised gradients) need more.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub momentum: f64,
    /// Largest share of the energy that the time integration may create; 10⁻³.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub energy_gain: f64,
    /// Largest change of the energy of a closed scene whose bodies carry internal energy, over it; 1 %. 10⁻¹⁰ can be asked of
    /// compatible energy.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub energy_closure: f64,
    /// Largest gain of [stored energy](crate::simulation::Simulation::stored_energy) beyond the work that went into it, over the largest energy
    /// supplied; 1 %. What is 50 % stops the run.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub stored_energy: f64,
    /// Least distance of two particles in local spacings; 0.2.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub nearest: f64,
    /// Least distance of nearest neighbours that one in a thousand particles may be below; 0.5.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub quantile: f64,
    /// Largest 1 − mean distance of nearest neighbours; 0.2. An even liquid has 0.05, one that flows 0.1, pairs 0.3 to 0.7.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub clumping: f64,
    /// Radius of the largest enclosed void in spacings; 1.5. Of gas, which expands, it says nothing.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub voids: f64,
    /// Least step over the median step; 0.05.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub step: f64,
    /// Largest λ T of the growth of noise; infinity. It means something where a flow should come to rest: 1 then.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub growth: f64,
    /// Particles that may be outside of the walls; 0.
    pub leaked: u64,
    /// Particles that may be without neighbours; no limit, since spray is liquid too.
    pub ejected: u64,
    /// Steps between two looks at the arrangement; 500. One look takes two to six steps, the more the more neighbours: at 500
    /// the watch costs about a per cent of a run, at 25 eight and more.
    pub every: u64,
}

impl Default for Thresholds {
    fn default() -> Self {
        Self {
            density: [0.0, f64::INFINITY],
            compression: 0.03,
            limited: 1e-4,
            momentum: 1e-10,
            energy_gain: 1e-3,
            energy_closure: 0.01,
            stored_energy: 0.01,
            nearest: 0.2,
            quantile: 0.5,
            clumping: 0.2,
            voids: 1.5,
            step: 0.05,
            growth: f64::INFINITY,
            leaked: 0,
            ejected: u64::MAX,
            every: 500,
        }
    }
}
