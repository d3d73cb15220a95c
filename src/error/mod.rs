//! Errors for the person who reads them: what happened, where, the likely cause, and what to try.
//! Building a scene reports every problem that it finds, not the first.

mod checkpoint;
mod problem;

pub use checkpoint::CheckpointProblem;
pub use problem::{BuildError, Problem};

use std::path::PathBuf;
use thiserror::Error;

/// What the law of a material has made of a density and an energy that are numbers.
pub(crate) const LAW_PRESSURE: &str = "pressure by the law of the material";
pub(crate) const LAW_SOUND_SPEED: &str = "sound speed by the law of the material";

/// Why a number is none: what no step has changed is as the scene gives it.
fn cause(quantity: &str, step: u64) -> &'static str {
    if [LAW_PRESSURE, LAW_SOUND_SPEED].contains(&quantity) {
        "density and energy are finite there, and the law of the material gives no finite value: it must give one \
         for every state that a run reaches"
    } else if step == 0 {
        "the value is wrong from the start: check what the scene gives to that particle, its neighbours, its \
         material and its loads"
    } else {
        "the run has become unstable: try a smaller step factor, more artificial viscosity, or a finer spacing. \
         Files written so far stay readable"
    }
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
        "`{part}` stores {gain} J more than the work that went into it, above {limit} of the {supplied} J \
         supplied so far, at t = {time} s, step {step}, most of it at particle {particle} of body `{body}` at \
         {position:?} m: the time integration creates energy; take a smaller step factor, steps without a \
         repeated pattern, or some damping (a viscosity, AcousticDamping). Simulation::limit_stored_energy sets \
         the limit"
    )]
    StoredEnergy {
        /// The bodies that share the energy, or the coupling.
        part: String,
        /// Energy created by the time integration \[J\].
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
        "the load ({load}) gave {value} to particle {particle} of body `{body}` at {position:?} m, t = {time} s: \
         its function must give finite numbers wherever a particle can be, in m/s² with squares that are finite \
         in the scalar type, or in W/kg"
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
        "particle {particle} of body `{body}` closes on a neighbour at {speed} m/s, with a sound speed of \
         {sound_speed} m/s, at {position:?} m, t = {time} s: the (artificial) sound speed is too low, and the \
         liquid would pass through the neighbour; take at least {wanted} m/s, ten times the fastest flow",
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
        "between t = {time} s and t = {end} s the displacement of wall `{wall}` differs by {distance} m from the \
         integral of its velocity, more than half a spacing, and the wall would pass the liquid: displacement and \
         velocity of its motion must be finite and without jumps, and the velocity the rate of the displacement"
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
    /// A joint of rigid bodies that cannot be held.
    #[error(
        "the joint {joint} cannot be held at t = {time} s: {cause}; take smaller steps (a lower StepControl::courant), a spring in place of \
         one joint, or end the run before"
    )]
    Joint {
        /// The joint, with its bodies.
        joint: String,
        /// When \[s\].
        time: f64,
        /// Why.
        cause: &'static str,
    },
    /// The simulation has failed before.
    #[error("the simulation has failed and takes no further step; the first error was: {cause}")]
    Failed {
        /// The first error, in words.
        cause: String,
    },
    /// The time step collapsed.
    #[error(
        "the time step fell to {step} s at t = {time} s (criterion: {criterion}, particle {particle} of body \
         `{body}`): the solution is about to fail there; check that particle, or set a smallest step"
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
    /// An observer or a criterion of a [run](crate::run) failed.
    #[error("{observer} failed at t = {time} s: {cause}")]
    Observer {
        /// Which.
        observer: String,
        /// When \[s\].
        time: f64,
        /// Why. It is part of the error's text, and so no [`source`](std::error::Error::source) of it.
        cause: Failure,
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
    /// Another [rank](crate::ranks) has failed, or is elsewhere.
    #[error("rank {rank} has failed, and with it the run on all ranks: {cause}")]
    Rank {
        /// The number of the rank.
        rank: usize,
        /// Its error, in words.
        cause: String,
    },
    /// An argument of a call after building makes no sense.
    #[error(transparent)]
    Argument(#[from] Problem),
}

/// Why an observer or a criterion of a run fails: any error, for `?`.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;

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
            Error::Joint {
                joint: "hinge of `flap` and the ground".into(),
                time: 1.0,
                cause: "no",
            },
            Error::Argument(Problem::EmptyScene),
            Error::Rank {
                rank: 2,
                cause: "the disk is full".into(),
            },
            Error::Observer {
                observer: "the observer every 0.1 s".into(),
                time: 1.0,
                cause: "the disk is full".into(),
            },
        ];
        let mut seen = [false; 15];
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
                Error::Joint { .. } => 12,
                Error::Observer { .. } => 13,
                Error::Rank { .. } => 14,
            };
            seen[variant] = true;
        }
        assert_eq!(seen, [true; 15]);
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
