//! Exact and reference solutions, and the norms that measure a result against them.
//! None of it uses particles but [`work_precision`], [`cost_model`] and [`ablation`], which count what runs cost; all of it is `f64` in
//! SI units (or in any consistent set of units).
//!
//! To judge a result, take the simplest solution that covers it: [`hugoniot`] for the height of a first
//! plateau, [`acoustic_rods`] for when and where waves arrive in the limit of weak impact,
//! [`godunov_rods`] for both with the equation of state in use, and refine its cells until it no longer
//! changes. [`norms`] then turns the difference into numbers and the numbers of several spacings into an
//! order of convergence. The references know walls, contacts that open and close, and bonded joints.
//!
//! | module | what it gives |
//! |---|---|
//! | [`acoustic_rods`] | exact linear-acoustic waves in chains of rods with contacts that open and close |
//! | [`godunov_rods`] | the same chains with any equation of state, second-order Godunov in mass coordinates |
//! | [`riemann`] | exact Riemann problem of ideal and stiffened gases, vacuum included |
//! | [`hugoniot`] | plateau of an impact by matching shock Hugoniots |
//! | [`sod`], [`noh`], [`sedov`] | the standard shock problems |
//! | [`taylor_green`], [`channel`] | viscous flows: decaying vortices; Couette, Poiseuille, power law |
//! | [`standing_wave`] | period, velocities and decay of a wave in a tank |
//! | [`impulsive_tank`] | pressure in a tank that is accelerated suddenly |
//! | [`jet_on_step`] | pressures of a jet along a floor that strikes a step |
//! | [`dam_break`] | units of dam-break experiments, Ritter's flow on a dry bed |
//! | [`free_beam`] | period of a free beam that bends |
//! | [`ghia`] | centre-line velocities of the lid-driven cavity |
//! | [`records`] | files of measured and published curves |
//! | [`work_precision`] | what accuracy costs in time: sweeps, fits of error and cost, and the questions that they answer |
//! | [`with_error_bar`] | a result with the interval that its spacing leaves, from coarser companions |
//! | [`cost_model`] | what a run will cost, before it and from its first steps |
//! | [`ablation`] | what each effect changes and costs, by runs without it |
//! | [`norms`] | differences of profiles, plateau, rise time, overshoot, arrival, observed order |
//!
//! ```
//! use meshfree::study::hugoniot::{Hugoniot, impact};
//! let copper = Hugoniot { density: 8930.0, sound_speed: 3940.0, slope: 1.49 };
//! let plateau = impact(&copper, 20.0, &copper, 0.0)?;
//! assert!((plateau.pressure - 353.17e6).abs() < 0.01e6);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

pub mod ablation;
pub mod acoustic_rods;
mod chain;
pub mod channel;
#[cfg(test)]
mod check;
pub mod cost_model;
pub mod dam_break;
mod error_bars;
pub mod free_beam;
pub mod ghia;
pub mod godunov_rods;
pub mod hugoniot;
pub mod impulsive_tank;
pub mod jet_on_step;
pub mod noh;
pub mod norms;
pub mod records;
pub mod riemann;
pub mod sedov;
pub mod sod;
pub mod standing_wave;
pub mod taylor_green;
pub mod work_precision;

pub use error_bars::{ErrorBar, NoErrorBar, with_error_bar};

/// What a reference solution could not do, and what to change.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A parameter has a value for which the problem has no solution.
    #[error("{quantity} is {value} but must be {requirement}; change it")]
    Parameter {
        /// The parameter's name, with its unit.
        quantity: &'static str,
        /// The value that was given.
        value: f64,
        /// What the value must be.
        requirement: &'static str,
    },
    /// A question about a place or a time that the solution does not cover.
    #[error("{quantity} {value} is outside the solution; ask within {from} to {to}")]
    OutOfRange {
        /// The requested quantity, with its unit.
        quantity: &'static str,
        /// The requested value.
        value: f64,
        /// The smallest value that has an answer.
        from: f64,
        /// The largest value that has an answer.
        to: f64,
    },
    /// A count or an index that does not fit what is there.
    #[error("{quantity} is {value} but {available} are there; {action}")]
    Count {
        /// What was counted or indexed.
        quantity: &'static str,
        /// The number that was given.
        value: usize,
        /// The number that there are.
        available: usize,
        /// What to do about it.
        action: &'static str,
    },
    /// The numbers of two lists that belong together differ.
    #[error("{first} has {first_count} entries and {second} has {second_count}; make them equal")]
    Lengths {
        /// The first list.
        first: &'static str,
        /// Its number of entries.
        first_count: usize,
        /// The second list.
        second: &'static str,
        /// Its number of entries.
        second_count: usize,
    },
    /// The waves of a chain of rods have split into more steps than allowed.
    #[error(
        "the waves had split into {limit} steps at {time} s; solve until an earlier time or use fewer segments"
    )]
    TooManyEvents {
        /// The largest number of steps.
        limit: usize,
        /// The time \[s\] at which it was reached.
        time: f64,
    },
    /// A cell has left the range in which its pressure law gives a finite state.
    #[error(
        "cell {cell} at {time} s has density {density} and energy {energy}: the pressure law gives no finite state there; lower the impact speed or the Courant number"
    )]
    State {
        /// The cell, counted from the left end of the chain.
        cell: usize,
        /// The time \[s\].
        time: f64,
        /// Density \[kg/m³\].
        density: f64,
        /// Specific internal energy \[J/kg\].
        energy: f64,
    },
    /// A profile lacks the feature that was to be measured.
    #[error("no {feature} in the samples; {action}")]
    Missing {
        /// What was sought.
        feature: &'static str,
        /// What to do about it.
        action: &'static str,
    },
}

/// How two neighbouring segments of a rod touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// Transmits tension, never opens.
    Bonded,
    /// Transmits compression only: opens when tension arrives and closes when the gap is used up.
    Unilateral,
}

/// What is at an end of a chain of rods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Nothing: the stress is zero.
    Free,
    /// A rigid wall at rest that can push but not pull; the rod may leave it and come back.
    Wall,
    /// A rigid wall at rest to which the rod is bonded.
    Bonded,
}

/// A place where segments meet, or an end of the chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joint {
    /// The end with the smallest coordinate.
    Left,
    /// Between segment `k` and segment `k + 1`.
    Between(usize),
    /// The end with the largest coordinate.
    Right,
}

impl Joint {
    /// The joint's number, counted from the left end, in a chain of `segments` segments.
    pub(crate) fn number(self, segments: usize) -> Result<usize, StudyError> {
        match self {
            Joint::Left => Ok(0),
            Joint::Right => Ok(segments),
            Joint::Between(k) if k + 1 < segments => Ok(k + 1),
            Joint::Between(k) => Err(StudyError::Count {
                quantity: "the left segment of Joint::Between",
                value: k,
                available: segments,
                action: "name a segment that has one on its right",
            }),
        }
    }
}

/// A time during which a contact was closed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ContactInterval {
    /// When the contact closed \[s\].
    pub from: f64,
    /// When it opened \[s\]; `None` if it was still closed at the end of the solution.
    pub until: Option<f64>,
}

/// An error unless the value is finite and larger than zero.
pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<f64, StudyError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(StudyError::Parameter {
            quantity,
            value,
            requirement: "finite and larger than 0",
        })
    }
}

/// An error unless the value is finite.
pub(crate) fn finite(quantity: &'static str, value: f64) -> Result<f64, StudyError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(StudyError::Parameter {
            quantity,
            value,
            requirement: "finite",
        })
    }
}

/// An error unless the value lies between `from` and `to`, both included.
pub(crate) fn within(
    quantity: &'static str,
    value: f64,
    from: f64,
    to: f64,
) -> Result<(), StudyError> {
    if (from..=to).contains(&value) {
        return Ok(());
    }
    Err(StudyError::OutOfRange {
        quantity,
        value,
        from,
        to,
    })
}
