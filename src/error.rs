//! Errors for the person who reads them: what happened, where, the likely cause, and what to try.
//! Building a scene reports every problem that it finds, not the first.

use core::fmt;
use std::path::PathBuf;
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
    /// A wall that the kernel looks through.
    #[error(
        "wall `{wall}` is thinner than the kernel reaches ({reach} m): liquid behind it would be felt, and its \
         pressure is too low; give it {layers} layers of particles"
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
        "body `{body}` of the scheme {scheme} meets wall `{wall}`, which is made of particles, by contact only, and the scene does \
         not say which: write `.couple(\"{body}\", \"{wall}\", ContactDensity::new())`, with `.friction(mu)` behind `new()` where \
         it rubs (Penalty in place of ContactDensity for a body that is less than two particles thick), or \
         `.between(\"{body}\", \"{wall}\", Interaction::None)` if they never meet"
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
        "particle {particle} of body `{body}` at {position:?} m has no neighbour that the kernel reaches ({reach} m), \
         and the density form measures compression by neighbours: is the spacing that of the points? Take the \
         particle out, or a density form by summation"
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
        "{particles} particles take about {needed} bytes, {each} each, and there are {available}: take fewer \
         particles, `f32`, or another machine; a limit of one's own is set by Scene::memory_limit"
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
    /// A number of a field or sum of its own that two effects claim.
    #[error(
        "the scheme {scheme} has two effects that claim the {kind} {number}, one for `{first}` and one for `{second}`: \
         give one of them another number"
    )]
    ClaimedTwice {
        /// The scheme.
        scheme: String,
        /// Field or sum.
        kind: &'static str,
        /// Its shape and number.
        number: String,
        /// One name.
        first: &'static str,
        /// The other.
        second: &'static str,
    },
    /// A field or sum of an effect's own that has no name.
    #[error(
        "the scheme {scheme} uses the {kind} {number}, which no effect declares: say what it is with \
         `StepProgram::{call}`, so that no other effect takes its number"
    )]
    NotDeclared {
        /// The scheme.
        scheme: String,
        /// Field or sum.
        kind: &'static str,
        /// Its shape and number.
        number: String,
        /// The call that declares it.
        call: &'static str,
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

/// What is told beside something else.
fn in_brackets(values: &[String]) -> String {
    if values.is_empty() {
        return String::new();
    }
    format!(" ({})", values.join("; "))
}

/// What the law of a material has made of a density and an energy that are numbers.
pub(crate) const LAW_PRESSURE: &str = "pressure by the law of the material";
pub(crate) const LAW_SOUND_SPEED: &str = "sound speed by the law of the material";

/// Why a number is none: what no step has changed is as the scene gives it.
fn cause(quantity: &str, step: u64) -> &'static str {
    if [LAW_PRESSURE, LAW_SOUND_SPEED].contains(&quantity) {
        "density and energy are numbers there, of which the law makes none: it must give finite ones for all that a run \
         comes to"
    } else if step == 0 {
        "the scene starts so: look at what is given to that particle, its neighbours, its material, and what acts on it"
    } else {
        "the run has lost stability; try a smaller step factor, more artificial viscosity, or a finer spacing. What was \
         written before stays readable"
    }
}

/// Why a simulation cannot go on from a checkpoint.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum CheckpointProblem {
    /// The file is not what was written.
    #[error("it is cut short or altered ({detail}): take an older checkpoint, or start anew")]
    Damaged {
        /// Where it shows.
        detail: String,
    },
    /// Another version of the crate wrote it, which held another state.
    #[error(
        "its state is of version {found}, and this crate reads version {known}: resume with the version of the \
         crate that wrote it"
    )]
    Version {
        /// The version of the file.
        found: String,
        /// The version that this crate reads.
        known: &'static str,
    },
    /// Simulations of another type: another scalar, dimension, or width of lanes.
    #[error(
        "its {what} is {found}, and that of the scene is {own}: resume with the {what} that it was written with"
    )]
    Kind {
        /// Scalar, dimension or lane width.
        what: &'static str,
        /// That of the file.
        found: String,
        /// That of the scene.
        own: String,
    },
    /// It is of another scene.
    #[error(
        "it was written by another scene, which differs in {}{}: resume with the scene that wrote it",
        parts.join(", "), in_brackets(.values)
    )]
    Scene {
        /// What differs.
        parts: Vec<&'static str>,
        /// Values of it, as far as they have names: which, and what it is in the file and in the scene.
        values: Vec<String>,
    },
    /// The machine cannot run the loops that it was written by.
    #[error(
        "its pair loops ran on {found}, which this machine or this build lacks, and other instructions round otherwise: resume on \
         a machine that has it, or run on `InstructionSet::Baseline` from the start"
    )]
    Instructions {
        /// The instruction set of the file.
        found: String,
    },
}

/// What can go wrong while a simulation is built, run, written or resumed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene does not make sense.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A number became infinite or undefined.
    #[error(
        "{quantity} of particle {particle} of body `{body}` is {value} at {position:?} m, t = {time} s, step \
         {step}: {}", cause(quantity, *.step)
    )]
    NotFinite {
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// The body.
        body: String,
        /// The particle's number in the body.
        particle: usize,
        /// Where \[m\].
        position: Vec<f64>,
        /// When \[s\].
        time: f64,
        /// In which step.
        step: u64,
    },
    /// More energy is stored than went in.
    #[error(
        "`{part}` stores {gain} J more than the work that went into it, above {limit} of the {supplied} J supplied so far, at \
         t = {time} s, step {step}, most of it at particle {particle} of body `{body}` at {position:?} m: the integration in \
         time gains energy from nowhere; take a smaller step factor, steps that repeat no pattern, or some damping \
         (a viscosity, AcousticDamping). Simulation::limit_stored_energy moves the limit"
    )]
    StoredEnergy {
        /// The bodies that share the energy, or the coupling.
        part: String,
        /// Energy from nowhere \[J\].
        gain: f64,
        /// The largest energy supplied so far \[J\].
        supplied: f64,
        /// The largest share of it that may be gained.
        limit: f64,
        /// The body of the particle that has gained most.
        body: String,
        /// The particle's number in the body.
        particle: usize,
        /// Where \[m\].
        position: Vec<f64>,
        /// When \[s\].
        time: f64,
        /// In which step.
        step: u64,
    },
    /// A load gave no number to go on with.
    #[error(
        "the load ({load}) gave {value} to particle {particle} of body `{body}` at {position:?} m, t = {time} s: its \
         function must give finite numbers of the scalar wherever a particle comes, in m/s², whose squares are finite too, \
         or in W/kg"
    )]
    Load {
        /// What it is, and on which body.
        load: String,
        /// The value.
        value: f64,
        /// The body.
        body: String,
        /// The particle's number in the body.
        particle: usize,
        /// Where \[m\].
        position: Vec<f64>,
        /// When \[s\].
        time: f64,
    },
    /// A function of time gave no number to go on with.
    #[error("the {what} gave {value} at t = {time} s: {must_be}")]
    Function {
        /// Which function of the scene, and what of it.
        what: String,
        /// The value.
        value: f64,
        /// When \[s\].
        time: f64,
        /// What it must give.
        must_be: &'static str,
    },
    /// A liquid meets something faster than its sound runs.
    #[error(
        "particle {particle} of body `{body}` meets what is before it at {speed} m/s, and its sound runs at \
         {sound_speed} m/s, at {position:?} m, t = {time} s: the (artificial) sound speed is too low, and the liquid \
         would go through what it meets; take at least {wanted} m/s, ten times the fastest flow",
        wanted = 10.0 * .speed
    )]
    SoundSpeedTooLow {
        /// The body.
        body: String,
        /// The particle's number in the body.
        particle: usize,
        /// Closing speed of the pair \[m/s\].
        speed: f64,
        /// Its mean sound speed \[m/s\].
        sound_speed: f64,
        /// Where \[m\].
        position: Vec<f64>,
        /// When \[s\].
        time: f64,
    },
    /// A wall does not move as a wall can.
    #[error(
        "between t = {time} s and t = {end} s wall `{wall}` moves by {distance} m beside what its velocity gives, more \
         than half a spacing, and would pass the liquid: displacement and velocity of its motion must be finite \
         numbers, the one the rate of the other, without jumps"
    )]
    WallJump {
        /// The wall.
        wall: String,
        /// How far \[m\].
        distance: f64,
        /// From when \[s\].
        time: f64,
        /// To when \[s\].
        end: f64,
    },
    /// The simulation has failed before.
    #[error("the simulation has failed and takes no further step; what happened first: {cause}")]
    Failed {
        /// The first error, in words.
        cause: String,
    },
    /// The time step collapsed.
    #[error(
        "the time step fell to {step} s at t = {time} s (criterion: {criterion}, particle {particle} of body \
         `{body}`): something is about to break there; look at that particle, or set a smallest step"
    )]
    StepCollapsed {
        /// The step \[s\].
        step: f64,
        /// When \[s\].
        time: f64,
        /// The criterion that set it.
        criterion: &'static str,
        /// The body.
        body: String,
        /// The particle's number in the body.
        particle: usize,
    },
    /// A file could not be written or read.
    #[error("cannot {action} {}: {cause}", path.display())]
    File {
        /// Read or write.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Why. It is part of the error's text, and so no [`source`](std::error::Error::source) of it.
        cause: std::io::Error,
    },
    /// A checkpoint that cannot be resumed from.
    #[error("cannot resume from {}: {problem}", path.display())]
    Checkpoint {
        /// The file.
        path: PathBuf,
        /// What differs, and what to do.
        problem: CheckpointProblem,
    },
    /// An argument of a call after building makes no sense.
    #[error(transparent)]
    Argument(#[from] Problem),
}

/// The crate's result.
pub type Result<T> = core::result::Result<T, Error>;

#[cfg(test)]
mod tests {
    use super::*;

    fn build() -> BuildError {
        BuildError {
            problems: vec![Problem::EmptyScene],
        }
    }

    /// One error of each variant. The match makes a new variant a new line here.
    fn each() -> Vec<Error> {
        let (body, position) = (|| "rod".to_string(), || vec![0.5]);
        let all = vec![
            Error::Build(build()),
            Error::NotFinite {
                quantity: "velocity",
                value: f64::NAN,
                body: body(),
                particle: 3,
                position: position(),
                time: 1.0,
                step: 7,
            },
            Error::Load {
                load: "gravity".into(),
                value: f64::NAN,
                body: body(),
                particle: 3,
                position: position(),
                time: 1.0,
            },
            Error::SoundSpeedTooLow {
                body: body(),
                particle: 3,
                speed: 4.0,
                sound_speed: 2.0,
                position: position(),
                time: 1.0,
            },
            Error::WallJump {
                wall: "piston".into(),
                distance: 0.1,
                time: 1.0,
                end: 2.0,
            },
            Error::Failed {
                cause: build().to_string(),
            },
            Error::StepCollapsed {
                step: 1e-20,
                time: 1.0,
                criterion: "sound",
                body: body(),
                particle: 3,
            },
            Error::File {
                action: "read",
                path: "pulse.csv".into(),
                cause: std::io::Error::other("line 3 is not a number"),
            },
            Error::Checkpoint {
                path: "run.meshfree".into(),
                problem: CheckpointProblem::Damaged {
                    detail: "its end is missing".into(),
                },
            },
            Error::StoredEnergy {
                part: "plate".into(),
                gain: 2.0,
                supplied: 1.0,
                limit: 0.5,
                body: body(),
                particle: 3,
                position: vec![0.1],
                time: 1.0,
                step: 32,
            },
            Error::Function {
                what: "acceleration 0".into(),
                value: f64::NAN,
                time: 1.0,
                must_be: "it must be finite",
            },
            Error::Argument(Problem::EmptyScene),
        ];
        let mut seen = [false; 12];
        for error in &all {
            let variant = match error {
                Error::Build(_) => 0,
                Error::NotFinite { .. } => 1,
                Error::Load { .. } => 2,
                Error::SoundSpeedTooLow { .. } => 3,
                Error::WallJump { .. } => 4,
                Error::Failed { .. } => 5,
                Error::StepCollapsed { .. } => 6,
                Error::File { .. } => 7,
                Error::Checkpoint { .. } => 8,
                Error::Argument(_) => 9,
                Error::StoredEnergy { .. } => 10,
                Error::Function { .. } => 11,
            };
            seen[variant] = true;
        }
        assert_eq!(seen, [true; 12]);
        all
    }

    #[test]
    fn each_text_appears_once_along_the_chain_of_sources() {
        for error in each() {
            let mut texts = vec![error.to_string()];
            let mut source = std::error::Error::source(&error);
            while let Some(error) = source {
                texts.push(error.to_string());
                source = error.source();
            }
            for (place, text) in texts.iter().enumerate() {
                let repeated = texts[..place].iter().any(|above| above.contains(text));
                assert!(!repeated, "`{text}` stands twice in {texts:#?}");
            }
        }
    }

    #[test]
    fn the_text_of_a_file_error_says_why() {
        let cause = std::io::Error::other("the disk is full");
        let (action, path) = ("write", "out/run.vtu".into());
        let error = Error::File {
            action,
            path,
            cause,
        };
        assert_eq!(
            error.to_string(),
            "cannot write out/run.vtu: the disk is full"
        );
    }
}
