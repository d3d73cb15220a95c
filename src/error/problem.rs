//! What may be wrong with a scene, or with an argument of a call.
//! A problem names what it is about, its value and what to do.

use core::fmt;
use thiserror::Error;

/// One thing that is wrong with a scene.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Problem {
    /// A parameter outside its range.
    #[error("{what} is {value}: {must_be}")]
    Parameter {
        /// The parameter, with the body or part it belongs to.
        what: String,
        /// The value given.
        value: f64,
        /// What it must be, and what to do.
        must_be: &'static str,
    },
    /// A body without particles.
    #[error(
        "body `{body}` has no particles: give it a shape at least one spacing large, or leave it out"
    )]
    EmptyBody {
        /// The body.
        body: String,
    },
    /// A scene without bodies.
    #[error("the scene has no bodies: add at least one with `Scene::body`")]
    EmptyScene,
    /// Two bodies share space.
    #[error(
        "bodies `{first}` and `{second}` overlap: two particles are {distance} m apart near {position:?}, \
         closer than lattices of spacing {spacing} m that only touch; move one of them, or cut the shape"
    )]
    Overlap {
        /// One body.
        first: String,
        /// The other.
        second: String,
        /// Smallest distance \[m\].
        distance: f64,
        /// Spacing \[m\].
        spacing: f64,
        /// Where \[m\].
        position: Vec<f64>,
    },
    /// A wall that is thinner than the kernel reaches.
    #[error(
        "wall `{wall}` is thinner than the kernel reaches ({reach} m): liquid would interact through it, and its \
         pressure would be too low; give it {layers} layers of particles"
    )]
    ThinWall {
        /// The wall.
        wall: String,
        /// Reach of the kernel \[m\].
        reach: f64,
        /// Layers that are enough.
        layers: usize,
    },
    /// A material that the catalogue does not have.
    #[error("no material is called `{name}`: the catalogue has {known}")]
    UnknownMaterial {
        /// The name asked for.
        name: String,
        /// The names that exist.
        known: String,
    },
    /// A ratio of smoothing length to spacing at which the kernel misbehaves.
    #[error(
        "h/dx is {ratio} with the {kernel} kernel, outside {lowest}..{highest}: below it neighbours are \
         lost, above it particles pair; take {recommended}"
    )]
    SmoothingRatio {
        /// The kernel.
        kernel: &'static str,
        /// The ratio given.
        ratio: f64,
        /// Lowest accepted.
        lowest: f64,
        /// Highest accepted.
        highest: f64,
        /// Recommended.
        recommended: f64,
    },
    /// A body that nothing is said of to a wall of particles.
    #[error(
        "body `{body}` of the scheme {scheme} can reach wall `{wall}`, which is made of particles, and the scene \
         names no contact between them: write `.couple(\"{body}\", \"{wall}\", ContactDensity::new())`, with \
         `.friction(mu)` after `new()` for friction (Penalty in place of ContactDensity for a body that is less \
         than two particles thick), or `.between(\"{body}\", \"{wall}\", Interaction::None)` if they never meet"
    )]
    ContactNotNamed {
        /// The body.
        body: String,
        /// Its scheme.
        scheme: String,
        /// The wall.
        wall: String,
    },
    /// A particle that a density relative to rest cannot measure.
    #[error(
        "particle {particle} of body `{body}` at {position:?} m has no neighbour within the kernel's reach \
         ({reach} m), and the density form needs neighbours: check that the spacing is that of the points, remove \
         the particle, or take a density form by summation"
    )]
    Isolated {
        /// The body.
        body: String,
        /// The particle's number in the body.
        particle: usize,
        /// Where \[m\].
        position: Vec<f64>,
        /// Reach of the kernel \[m\].
        reach: f64,
    },
    /// More particles than the memory holds.
    #[error(
        "{particles} particles take about {needed} bytes, {each} each, and {available} are available: take fewer \
         particles, `f32`, or another machine; Scene::memory_limit sets another limit"
    )]
    Memory {
        /// Particles of bodies and walls.
        particles: usize,
        /// Bytes a particle.
        each: usize,
        /// Bytes in all.
        needed: u64,
        /// Bytes that there are.
        available: u64,
    },
    /// A prescribed time step above the stability limit.
    #[error(
        "the time step is {step} s, above the stability limit of {limit} s ({criterion}): take a smaller \
         one, or leave the choice to the simulation"
    )]
    StepAboveLimit {
        /// The step asked for \[s\].
        step: f64,
        /// The limit \[s\].
        limit: f64,
        /// What sets the limit.
        criterion: &'static str,
    },
    /// Parts that do not fit together.
    #[error("{what}: {remedy}")]
    Incompatible {
        /// What does not fit.
        what: String,
        /// What to do.
        remedy: &'static str,
    },
    /// A part of a step that reads what nothing has written.
    #[error(
        "the scheme {scheme} cannot run: {reader} reads the {kind} {quantity} at the stage `{stage}`, and nothing \
         writes it before; add the effect that does, or move one of the two to another stage"
    )]
    NotWritten {
        /// The scheme.
        scheme: String,
        /// The term, law, rate or limit that reads.
        reader: String,
        /// Field or sum.
        kind: &'static str,
        /// What it reads.
        quantity: String,
        /// The stage in which it does.
        stage: &'static str,
    },
    /// Fields or sums of effects that cannot be together in a scheme: one full name is two things, or there are too many.
    #[error(
        "the {kind} of effects cannot be together in the scheme {scheme}: {fault}; rename one, or leave an effect out"
    )]
    Names {
        /// The scheme.
        scheme: String,
        /// Fields or sums.
        kind: &'static str,
        /// Which, and why.
        fault: String,
    },
    /// A name that the scene does not know.
    #[error("there is no {kind} called `{name}`: the scene has {}", or_none(.known))]
    UnknownName {
        /// Body, boundary or probe.
        kind: &'static str,
        /// The name asked for.
        name: String,
        /// The names that exist.
        known: String,
    },
    /// An index that the scene does not have.
    #[error("there is no {kind} with the index {index}: the scene has {}, counted from 0", or_none(.known))]
    UnknownIndex {
        /// Body, wall or boundary.
        kind: &'static str,
        /// The index asked for.
        index: usize,
        /// The names that exist, in order.
        known: String,
    },
}

/// Names that exist, in words.
fn or_none(known: &str) -> &str {
    if known.is_empty() { "none" } else { known }
}

/// Everything that is wrong with a scene.
#[derive(Clone, Debug, PartialEq, Error)]
pub struct BuildError {
    /// The problems, in the order of the scene.
    pub problems: Vec<Problem>,
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.problems.as_slice() {
            [one] => write!(f, "the scene cannot be built: {one}"),
            many => {
                write!(f, "the scene cannot be built; {} problems:", many.len())?;
                many.iter()
                    .try_for_each(|problem| write!(f, "\n  - {problem}"))
            }
        }
    }
}
