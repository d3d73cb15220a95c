//! A simulation whose steps run on a device: its step program recorded, and its state handed out and taken back.
//! A device evaluates, kicks and drifts, and lists neighbours; time, votes, ledger, walls that move and images stay here.
//!
//! [`Simulation::offload`] makes an [`Offloaded`] of a simulation, or says which of its parts do not run on a device. The package
//! [`meshfree-gpu`](crate#pages) drives it; a program that only runs scenes needs nothing of this module.

mod check;
mod clamps;
mod clock;
mod contacts;
mod evolved;
mod given;
mod images;
mod laws;
mod lengths;
mod lists;
mod motion;
mod partners;
mod program;
mod record;
mod state;
mod states;
mod structures;
mod transfer;
mod travel;
mod vote;

pub use clock::{Advance, Moment};
pub use contacts::{ContactSide, ContactStep, PairStep, Summed};
pub use images::ReEntries;
pub use lists::{Bounds, CellGrid, Search};
pub use partners::Partners;
pub use program::{
    Action, Counted, FollowStep, Given, KeepStep, Made, PointStep, Program, RepeatStep, StateStep,
    SweepStep,
};
pub use state::{Forces, Moved};
pub use transfer::{Array, Layout, Numbers};
pub use vote::{Approaching, Found};

use super::Simulation;
use super::control::StepControl;
use super::run_state::State;
use super::vote::Vote;
use crate::error::{BuildError, Error, Result};
use crate::integrator::Integrator;
use crate::particles::Fields;
use crate::scalar::Real;
use laws::Timed;
use record::Recorder;
use std::sync::Arc;
use travel::{Travel, is_bounded};

/// A simulation whose steps run on a device.
///
/// ```
/// use meshfree::prelude::*;
/// let water = catalogue::weakly_compressible_water(2.0);
/// let tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
///     .body(Body::block("water", water, [0.0; 2], [0.3, 0.2], 0.02))
///     .wall(Wall::around("tank", [0.0; 2], [0.3, 0.3], 0.02, 3, [[true, true], [true, false]]))
///     .build()?;
/// let tank = tank.offload()?;
/// assert!(!tank.program(0).evaluation.is_empty());
/// # Ok::<(), Error>(())
/// ```
pub struct Offloaded<T: Real, const D: usize> {
    simulation: Simulation<T, D>,
    /// What is known of each group.
    recorded: Vec<Recorded>,
    contacts: Vec<ContactStep>,
    /// What the last vote asks for.
    last_vote: Option<Vote>,
    /// Whether a prediction is under way, and whether an integrator keeps states in this step.
    is_predicted: bool,
    keeps_states: bool,
    /// The step under way, and the one that it is cut from.
    under_way: Option<[Vote; 2]>,
    /// The state after the last step while a copy steps for a reading, and its vote.
    last_step: Option<(State<T, D>, Option<Vote>)>,
}

/// A group of bodies under one scheme, recorded.
#[derive(Debug)]
struct Recorded {
    program: Arc<Program>,
    timed: Vec<Timed>,
    /// The least and the largest component of velocities, as the last vote found them, and the least smoothing length.
    range: Vec<f64>,
    /// The time \[s\] since smoothing lengths were found, its inverse, both zero where they never were, and one if there is any.
    since_lengths: [f64; 3],
    layout: Layout,
    /// What records that are kept have.
    kept: Fields,
    /// Counts that the host has had, of the columns on the device.
    counted: Vec<u64>,
    /// Entries of the lists of the device, and whether the host has others.
    entries: usize,
    is_listed_there: bool,
    /// The acceleration that pairs on the device were told of; none if not yet.
    body_force: Vec<f64>,
    /// How far particles have gone at most, and whether that can be told.
    travel: Travel,
    is_bounded: bool,
}

impl<T: Real, const D: usize> core::fmt::Debug for Offloaded<T, D> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_tuple("Offloaded").field(&self.simulation).finish()
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Lets steps run on a device, from the state after the last step on. Rates that are not at hand are evaluated here.
    ///
    /// # Errors
    /// [`Error::Build`] with all parts of the scene that do not run there, each with what to do about it, and [`Error::Failed`] after a
    /// step that has failed.
    pub fn offload(mut self) -> Result<Offloaded<T, D>> {
        self.check_failure()?;
        self.return_to_last_step();
        let mut problems = self.not_on_device();
        let mut own = Offloaded {
            simulation: self,
            recorded: Vec::new(),
            contacts: Vec::new(),
            last_vote: None,
            is_predicted: false,
            keeps_states: false,
            under_way: None,
            last_step: None,
        };
        if problems.is_empty() {
            // Of a state that was changed from outside.
            let changed = !own.simulation.state.rates_at_hand;
            if changed {
                own.simulation.evaluate_together()?;
            }
            own.simulation.begin_stores(changed);
            let mut sides = Vec::new();
            for number in 0..own.groups() {
                let control: StepControl = own.control_of_vote(number);
                let groups = &own.simulation.state.groups;
                let is_pushed = contacts::push(&own.simulation, number);
                let states = own.simulation.integrator.slots();
                let mut recorder = Recorder::new(&groups[number], is_pushed, states);
                recorder.all(&control);
                recorder.book_laws();
                recorder.keep_states();
                sides.extend(contacts::sides_of(&own.simulation, &mut recorder, number));
                recorder.clamps();
                recorder.structures(groups);
                let Recorder {
                    program,
                    timed,
                    problems: found,
                    ..
                } = recorder;
                let columns = &groups[number].particles.columns;
                let kept = program.actions().find_map(|action| match action {
                    Action::Keep(keep) => Some(keep.reads),
                    _ => None,
                });
                let recorded = Recorded {
                    timed,
                    range: vec![0.0; 2 * D + 1],
                    layout: Layout {
                        fields: columns.fields(),
                        dimensions: D,
                        slots: columns.slots(),
                        mobile: groups[number].particles.mobile,
                        saved: program.saved.clone(),
                        counts: program.counts.len(),
                    },
                    kept: kept.unwrap_or(Fields::NONE),
                    counted: vec![0; program.counts.len()],
                    is_bounded: is_bounded(&groups[number], &program),
                    travel: Travel::unknown(D),
                    program: Arc::new(program),
                    since_lengths: [0.0; 3],
                    entries: 0,
                    is_listed_there: false,
                    body_force: Vec::new(),
                };
                own.recorded.push(recorded);
                problems.extend(found);
            }
            match contacts::all(&own.simulation, sides) {
                Ok(all) => own.contacts = all,
                Err(problem) => problems.push(problem),
            }
        }
        if problems.is_empty() {
            return Ok(own);
        }
        Err(Error::Build(BuildError { problems }))
    }
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// How many groups there are: bodies that obey one scheme together, with the walls that they meet. What other methods take as a
    /// group is its number.
    #[must_use]
    pub fn groups(&self) -> usize {
        self.simulation.state.groups.len()
    }

    /// The step program of a group.
    #[must_use]
    pub fn program(&self, group: usize) -> Arc<Program> {
        self.recorded[group].program.clone()
    }

    /// The order of the operations of a step.
    #[must_use]
    pub fn integrator(&self) -> Arc<dyn Integrator> {
        self.simulation.integrator.clone()
    }

    /// The simulation as it was last taken back.
    #[must_use]
    pub fn simulation(&self) -> &Simulation<T, D> {
        &self.simulation
    }

    /// The same, which steps on the host again.
    #[must_use]
    pub fn into_simulation(self) -> Simulation<T, D> {
        self.simulation
    }
}
