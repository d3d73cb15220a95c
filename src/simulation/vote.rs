//! A vote on the time step: the step that a criterion asks for, and of which particle.
//! What votes is in the files of the criteria.

use crate::collective::Join;

/// What limits the step of a particle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Criterion {
    /// h/(c + signal): sound, with what the viscosity adds.
    Acoustic,
    /// √(h/|a|): forces.
    Force,
    /// h² ρ/μ: physical viscosity.
    Viscous,
    /// |rᵢⱼ|/u: particles that move towards each other.
    Approach,
    /// A limit of an effect, by the [name](crate::effect::Limit::name) that it has in reports.
    Effect(&'static str),
    /// The step before, times [`StepControl::growth`](crate::simulation::StepControl::growth).
    Growth,
    /// The step was given.
    Fixed,
    /// The scene asked for a step that [ends](crate::scene::Scene::step_ends_at) there.
    SceneTime,
    /// The step was cut by [`Simulation::step_at_most`](crate::simulation::Simulation::step_at_most).
    End,
}

impl Criterion {
    /// All of them, which a checkpoint knows by their names.
    #[cfg(feature = "checkpoint")]
    pub(super) const ALL: [Self; 8] = [
        Self::Acoustic,
        Self::Force,
        Self::Viscous,
        Self::Approach,
        Self::Growth,
        Self::Fixed,
        Self::SceneTime,
        Self::End,
    ];

    /// Its name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Acoustic => "acoustic: h/(c + viscous signal)",
            Self::Force => "force: sqrt(h/|a|)",
            Self::Viscous => "viscous: h² ρ/mu",
            Self::Approach => "approach: distance of a pair over its closing speed",
            Self::Effect(name) => name,
            Self::Growth => "growth: the step before times a factor",
            Self::Fixed => "fixed",
            Self::SceneTime => "time at which the scene asks for the end of a step",
            Self::End => "limit asked for",
        }
    }
}

/// A vote on the time step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Vote {
    /// The step \[s\].
    pub step: f64,
    /// What set it.
    pub criterion: Criterion,
    /// The particle that set it, by its number in the whole simulation.
    pub particle: usize,
}

/// What nothing limits.
pub(super) const NO_VOTE: Vote = Vote {
    step: f64::INFINITY,
    criterion: Criterion::Acoustic,
    particle: usize::MAX,
};

/// The shorter step; the lower slot wins a tie.
impl Join for Vote {
    const NONE: Self = NO_VOTE;
    fn and(self, other: Self) -> Self {
        let later = other.step == self.step && other.particle < self.particle;
        if other.step < self.step || later {
            other
        } else {
            self
        }
    }
}

/// More than what `f32` rounds of products, a quotient and a sum: what is within it is looked at in full.
pub(super) const ROUNDED: f64 = 1e-5;
