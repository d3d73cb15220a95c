//! Exact linear-acoustic waves in a chain of rods, free of any grid.
//! The solution is carried by steps in the characteristic variables and advanced from event to event.
//!
//! In each segment, with density ρ₀ \[kg/m³\], sound speed c₀ \[m/s\], impedance Z = ρ₀c₀
//! \[kg/(m²s)\], stress σ \[Pa\] (tension positive) and velocity v \[m/s\],
//!
#![doc = include_str!("../../docs/equations/acoustic_waves.html")]
//!
#![doc = include_str!("../../docs/equations/acoustic_joint.html")]
//!
//! (J. A. Zukas et al., *Impact Dynamics*, 1982, pp. 29–53.) R and L leave the joints as step
//! functions of time, so stress and velocity anywhere follow from two look-ups. A unilateral joint
//! opens at the arrival that would bring tension, and closes when its gap is used up. Energy is
//! conserved exactly, and so is momentum but for the impulse of walls. Positions are those of the
//! undeformed chain.
//!
//! ```
//! use meshfree::study::{Contact, Joint, acoustic_rods::{AcousticRods, RodSegment}};
//! let copper = |length, velocity| RodSegment { length, density: 8930.0, sound_speed: 3940.0, velocity };
//! let waves = AcousticRods::new()
//!     .segment(copper(0.010, 20.0))
//!     .contact(Contact::Unilateral)
//!     .segment(copper(0.040, 0.0))
//!     .solve(30e-6)?;
//! assert!((waves.stress(0.005, 2e-6)? + 351.842e6).abs() < 1e3);
//! let opened = waves.contact_intervals(Joint::Between(0))?[0].until;
//! assert!((opened.unwrap_or(0.0) - 20.305e-6).abs() < 1e-9);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::chain::chain_of_rods;
use super::{Contact, End, StudyError, finite, positive};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

mod march;
mod solution;
#[cfg(test)]
mod tests;

use march::March;
pub use solution::{AcousticSolution, Arrival, JointState, Piece};

/// More steps than this and [`AcousticRods::solve`] gives up.
const STEP_LIMIT: usize = 4_000_000;

/// A piece of rod of one material that starts stress-free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodSegment {
    /// Length \[m\].
    pub length: f64,
    /// Density ρ₀ \[kg/m³\].
    pub density: f64,
    /// Speed of elastic waves c₀ \[m/s\].
    pub sound_speed: f64,
    /// Velocity at time zero \[m/s\].
    pub velocity: f64,
}

impl RodSegment {
    fn impedance(&self) -> f64 {
        self.density * self.sound_speed
    }
    fn transit(&self) -> f64 {
        self.length / self.sound_speed
    }
}

/// A chain of rod segments, to be solved exactly in the acoustic limit.
///
/// Segments follow each other from left to right. They are bonded unless
/// [`contact`](AcousticRods::contact) is called between them; both ends are free and the left end is
/// at x = 0 unless said otherwise.
#[derive(Clone, Debug)]
pub struct AcousticRods {
    start: f64,
    segments: Vec<RodSegment>,
    contacts: Vec<Contact>,
    next: Contact,
    ends: [End; 2],
}

impl Default for AcousticRods {
    fn default() -> Self {
        Self::new()
    }
}

impl AcousticRods {
    /// An empty chain with free ends whose left end is at x = 0.
    #[must_use]
    pub fn new() -> Self {
        Self {
            start: 0.0,
            segments: Vec::new(),
            contacts: Vec::new(),
            next: Contact::Bonded,
            ends: [End::Free; 2],
        }
    }
    chain_of_rods!();

    /// Follows the waves until the time `until` \[s\].
    ///
    /// Arrivals closer than 10⁻¹⁰ of the shortest transit are one event, and steps below 10⁻¹² of
    /// the largest impact stress ρ₀c₀|v| are dropped: both are rounding.
    ///
    /// # Errors
    /// If there is no segment, a parameter is out of range, or the waves split into millions of steps.
    pub fn solve(&self, until: f64) -> Result<AcousticSolution, StudyError> {
        positive("the end time [s]", until)?;
        self.check_chain()?;
        for segment in &self.segments {
            positive("length of a segment [m]", segment.length)?;
            positive("density of a segment [kg/m³]", segment.density)?;
            positive("sound speed of a segment [m/s]", segment.sound_speed)?;
            finite("velocity of a segment [m/s]", segment.velocity)?;
        }
        let mut march = March::new(self, until);
        march.run()?;
        Ok(march.solution)
    }
}

/// A joint that has something to do at a time; the earliest is the greatest.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Event {
    time: f64,
    joint: usize,
}

impl Eq for Event {}
impl Ord for Event {
    fn cmp(&self, other: &Self) -> Ordering {
        other
            .time
            .total_cmp(&self.time)
            .then(other.joint.cmp(&self.joint))
    }
}
impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Events in the order of time.
type Agenda = BinaryHeap<Event>;
