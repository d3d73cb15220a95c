//! The simulation: steps in time, keeps the ledger, and answers questions about its particles.
//! It is made by [`Scene::build`](crate::scene::Scene::build) and is one nameable type.
//!
//! # A step
//!
//! [`Simulation::step`] asks every particle for its largest stable step, takes the smallest, and
//! lets the integrator advance. Two criteria vote:
//!
#![doc = include_str!("../../docs/equations/time_step.html")]
//!
//! and pairs that close faster than these see: none may close by more than half of its distance. A liquid that meets
//! something faster than its own sound is refused ([`Error::SoundSpeedTooLow`]).
//! The first contains the signal sᵢⱼ that the viscosity in use adds to the sound speed, so a larger
//! coefficient shortens the step by itself. [`Simulation::last_vote`] names the criterion and the
//! particle that set the step. [`StepControl`] holds the factors; a fixed step is checked against the
//! limit in every step, and a step that falls below a millionth of the first ends the run with
//! [`Error::StepCollapsed`]. After every step, the last included, all of the state is looked at: a number that is not
//! finite is an [`Error::NotFinite`]. In every 32nd step stored energy is compared with the work done on it
//! ([`StoredEnergy`]), and a run that creates half of its energy by the time integration ends with [`Error::StoredEnergy`]. A simulation
//! that has failed takes no further step ([`Error::Failed`]).
//!
//! # Readings
//!
//! Steps follow from the state alone: what is observed, how often and when changes no bit of a run. Where the end of
//! [`Simulation::run_until`] or [`Simulation::run_with`] falls between two steps, what they show is the state after a
//! shortened step that is taken on a copy; the next step starts from where the last one ended. A reading costs a step
//! and a copy of the state, which is held twice meanwhile. [`Simulation::steps`] and the other counts of work are those
//! of the run; times of [`Simulation::phases`] and [`Simulation::cost`] contain readings.
//!
//! To act on the shown state makes it the state of the run: [`Simulation::set_velocities`], [`Simulation::set_field`],
//! [`Simulation::step_at_most`], and [`Simulation::accept`] where another program acts, such as one that exchanges
//! forces with it. [`Simulation::step_at_most`] cuts a step of the run. Where a load or a motion has a kink, the scene
//! may ask for a step that ends there: [`Scene::step_ends_at`](crate::scene::Scene::step_ends_at).
//!
//! Loads, motions and conditions must be functions of what they are given: a reading asks loads and motions for times after which
//! the next step begins. [Events](crate::scene::Scene::event) are looked at after steps alone.
//!
//! # What is counted
//!
//! | what | where |
//! |---|---|
//! | steps, evaluations, builds of neighbour lists | [`Simulation::steps`], [`Simulation::evaluations`], [`Simulation::list_builds`] |
//! | evaluations in which an equation of state left its range | [`Simulation::guard_counts`] |
//! | smoothing lengths held at a limit | [`Simulation::limited_smoothing_lengths`] |
//! | mass, momentum, kinetic and internal energy of every body, impulse of boundaries | [`Simulation::ledger`] |
//! | force between two bodies, or a body and a boundary | [`Simulation::force_between`] |
//! | force, impulse and work of clamps | [`Simulation::clamps`] |
//! | place, motion, inertia and forces of a rigid body | [`Simulation::rigid_body`] |
//! | coordinates, forces, impulse and work of joints | [`Simulation::joints`] |
//! | work, stored energy, heat and penetration of couplings | [`Simulation::contacts`], [`Simulation::largest_penetration`] |
//! | force and impulse on a wall | [`Simulation::wall_force`], [`Simulation::wall_impulse`] |
//! | energy of a liquid, work on it, dissipation | [`Simulation::energy`] |
//! | stored energy, as a function of the state, and the work that went into it | [`Simulation::stored_energy`] |
//! | what entered, what left through outlets and drains | [`Simulation::entered`], [`Simulation::removed`] |
//! | memory | [`Simulation::bytes`] |
//! | all of these as counts that no machine changes | [`Simulation::work`], and [`Simulation::expected_work`] of what is to come |
//! | whether the run is sound: bounds, limits, residuals, arrangement, steps, with a verdict | [`Simulation::keep_stability`], [`Simulation::stability`] |
//! | how far sums are from a continuum, fronts and films are resolved, and what limits accuracy most | [`Simulation::indicators`] |
//! | time, by phase of a step, and by effect with bytes and criteria | [`Simulation::phases`], [`Simulation::cost`] |
//!
//! # Questions about particles
//!
//! [`Simulation::body`] runs over the particles of a body in the order in which the scene placed them,
//! although they are sorted in memory, so the n-th is the same particle throughout. Bodies and walls are asked for by
//! name or by index ([`Which`]), and one that the scene does not have is an error.
//! [`Simulation::column`] gives a field as it lies in memory, without a copy.
//! [`ParticleView::for_each_neighbor`] shows the neighbours of a particle, with images behind planes and across periods.
//! [`Simulation::run_with`] shows the simulation to a closure after every step, and at the end:
//!
//! ```
//! use meshfree::prelude::*;
//! let mut simulation = Scene::<f64, 1>::new(schemes::impact())
//!     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
//!     .boundary(MirrorPlane::wall([0.01], [1.0]))
//!     .build()?;
//! let mut history = Vec::new();
//! simulation.run_with(1e-6, |now| {
//!     let pressure = now.all().last().map_or(0.0, |particle| particle.pressure());
//!     history.push((now.time(), pressure));
//! })?;
//! let (_, pressure) = history[history.len() - 1];
//! assert!((pressure / 709e6 - 1.0).abs() < 0.02, "{pressure}");
//! assert!(simulation.ledger().boundary_impulse[0] < 0.0);
//! # Ok::<(), Error>(())
//! ```
//!
//! # Checkpoint and restart
//!
//! With the feature `checkpoint`, `Simulation::save` writes the state to a file, and `Scene::resume` goes on from it:
//! every number then is, to the bit, what it had been without the stop. The file appears at once and whole, so a
//! program that is killed while it writes leaves the file before:
//!
//! ```
//! use meshfree::prelude::*;
//! # #[cfg(feature = "checkpoint")] {
//! # let folder = std::env::temp_dir().join(format!("meshfree-restart-{}", std::process::id()));
//! # let file = folder.join("rods.safetensors");
//! # let rods = || Scene::<f64, 1>::new(schemes::impact())
//! #     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
//! #     .boundary(MirrorPlane::wall([0.01], [1.0]));
//! # /*
//! let file = std::path::Path::new("rods.safetensors");
//! let rods = || Scene::<f64, 1>::new(schemes::impact()) /* and the rest of the scene */;
//! # */
//! # for _ in 0..2 {
//! let mut simulation = if file.exists() { rods().resume(&file)? } else { rods().build()? };
//! # let begun = simulation.steps();
//! let mut saved = Ok(());
//! simulation.run_with(1e-6, |now| {
//!     if now.steps() % 10 == 0 {
//!         saved = now.save(&file);
//!     }
//! })?;
//! saved?;
//! # assert!(begun == 0 || (begun % 10 == 0 && simulation.steps() - begun < 10));
//! # }
//! # let _ = std::fs::remove_dir_all(folder);
//! # }
//! # Ok::<(), Error>(())
//! ```
//!
//! | in the file | supplied by the scene, which must be the same | not kept |
//! |---|---|---|
//! | time, counts, ledgers, what left through outlets | bodies, materials, schemes, walls and their motions, boundaries | [`phases`](Simulation::phases), [`keep_stability`](Simulation::keep_stability) |
//! | every column of every particle, of walls too; fields that effects declare by their names | loads and other closures | what observers have gathered, and files that they write |
//! | rates at hand, what integrators keep, the state of inlets | the integrator, and how steps are chosen | what an integrator or an effect of your own keeps outside of fields |
//! | the positions that neighbour lists were built from, not the lists | | |
//!
//! `Scene::resume_with` takes a scene that differs in parts that it names, such as the integrator, viscosities, walls or
//! loads (`Change`), and `Scene::differences` lists in what a file and a scene differ, with both values.
//!
//! A file knows its scene by hashes of all that can be hashed; of a load its presence, kind and body, and of a motion its
//! name. It is refused with an [`Error::Checkpoint`] that says why if it is cut short or altered, of another scene, scalar,
//! dimension or lane width, or if its loops ran on instructions that the machine lacks; where the machine has
//! them, the run goes on with those that it began with. A program that was built with other versions of the crate or of
//! the compiler may round otherwise.
//!
//! The format is [safetensors](https://github.com/huggingface/safetensors). In Python,
//! `safetensors.numpy.load_file("rods.safetensors")["group0/particles/position"]` has a row for each slot; `group0/ids`
//! says which particle is in it, and slots from `group0/body_ends` on repeat the last of a body. Positions count from
//! `origin`. On ranks long columns are in their parts, one after another: `numpy.concatenate` of those of `run.a0`, `run.a1` and so on.

mod advance;
mod approach;
mod by_parts;
#[cfg(feature = "checkpoint")]
mod checkpoint;
mod column;
mod contact;
mod control;
mod cost;
mod couplings;
#[cfg(feature = "devices")]
#[doc(hidden)]
pub mod device;
mod divided;
mod energy;
mod evaluate;
mod event;
mod evolve;
mod exchange;
mod fields;
mod forces;
mod group;
mod held;
mod images;
mod impulses;
mod indicators;
mod joint_forces;
mod joint_rows;
mod joint_system;
mod joints;
mod ledger;
mod limits;
mod load;
mod loads;
mod migration;
mod neighbor;
mod neighborhood;
mod observed;
mod outflow;
mod outlook;
mod own_counts;
mod own_group;
mod own_order;
mod own_parts;
mod own_search;
mod own_work;
mod pair_list;
mod part;
mod phases;
mod pieces;
mod population;
mod query;
mod rank_model;
mod readable;
mod reference;
mod rigid;
mod rigid_body;
mod run;
mod run_state;
mod settle;
mod side;
mod snapshot;
mod soundness;
mod sources;
mod spin;
mod stability;
mod stages;
mod state;
mod stored;
mod sub_cycle;
mod view;
mod vote;
mod walls;
mod which;
mod work;
mod workspace;

#[cfg(feature = "checkpoint")]
pub use checkpoint::{Change, Difference};
#[cfg(feature = "checkpoint")]
pub(crate) use checkpoint::{Changes, RARE, differences, saved_groups};
pub use column::Column;
pub use control::StepControl;
pub use cost::{Cost, CostLine, Messages};
pub use couplings::Contact;
pub use energy::EnergyLedger;
pub use held::Clamped;
pub use indicators::{Indicators, Limit, LimitedBy, Spread};
pub use ledger::{Budget, Ledger, Total};
pub use load::{Load, LoadPoint};
pub use neighbor::Neighbor;
pub use phases::Phases;
pub use query::{ParticleView, ParticleViews};
pub use rigid_body::{Jointed, RigidBody};
pub use stability::{
    Arrangement, Breach, Extreme, StabilityReport, StepHistory, Thresholds, Verdict,
};
pub use stored::{StoredBalance, StoredEnergy, StoredPart};
pub use vote::{Criterion, Vote};
pub use which::Which;
pub(crate) use which::find;
pub use work::Work;

pub(crate) use contact::{Acting, Couple};
pub(crate) use event::Event;
pub(crate) use exchange::Exchange;
pub(crate) use group::Group;
pub(crate) use held::Clamp;
pub(crate) use joint_rows::{Frame, Geometry};
pub(crate) use joints::Jointing;
pub(crate) use loads::{ACCELERATION, is_square_finite};
pub(crate) use pair_list::PairList;
pub use population::Passed;
pub(crate) use population::{BodyState, Particles};
pub(crate) use rigid::Rigid;
pub(crate) use run::check_end;
pub(crate) use side::{MetWall, Side};
pub(crate) use sources::{DrainState, SourceState};
pub(crate) use spin::Spins;
pub(crate) use sub_cycle::SubCycle;
pub(crate) use view::rounding;
pub(crate) use walls::{Structure, WallState};

use crate::error::{Error, Result};
use crate::integrator::Integrator;
use crate::once::once;
#[cfg(feature = "checkpoint")]
use crate::output::checkpoint::Hashes;
use crate::ranks::Team;
use crate::scalar::Real;
#[cfg(feature = "checkpoint")]
use crate::scene::Described;
use impulses::PairForces;
use readable::Readable;
use run_state::State;
use std::sync::Arc;
use view::Reading;

/// An acceleration \[m/s²\] that acts on all particles as a function of time \[s\].
pub(crate) type UniformLoad<const D: usize> = Arc<dyn Fn(f64) -> [f64; D] + Send + Sync>;

/// A simulation in `D` dimensions with scalar `T`.
///
/// See the [crate page](crate) for a first program.
///
/// A clone goes on by itself, to the same bits, from the state that the original had. Functions that the scene was given (loads,
/// motions, events) are shared by both.
///
/// ```
/// use meshfree::prelude::*;
/// let water = catalogue::weakly_compressible_water(2.0);
/// let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
///     .body(Body::block("water", water, [0.0; 2], [0.2, 0.2], 0.02))
///     .wall(Wall::around("tank", [0.0; 2], [0.4, 0.3], 0.02, 3, [[true, true], [true, false]]))
///     .acceleration(|_| [0.0, -9.81])
///     .build()?;
/// tank.run_until(0.05)?;
/// let mut struck = tank.clone();
/// struck.set_velocities(|_, [u, v]| [u + 1.0, v]);
/// struck.run_until(0.1)?;
/// let mut copy = tank.clone();
/// tank.run_until(0.1)?;
/// copy.run_until(0.1)?;
/// assert_eq!(tank.bits_hash(), copy.bits_hash());
/// assert_ne!(tank.bits_hash(), struck.bits_hash());
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone)]
pub struct Simulation<T: Real, const D: usize> {
    /// What steps change.
    state: Readable<T, D>,
    /// The box around bodies and walls as built \[m\], where walls alone bound the scene.
    pub(crate) domain: Option<[[f64; D]; 2]>,
    pub(crate) integrator: Arc<dyn Integrator>,
    pub(crate) control: StepControl,
    /// Uniform accelerations, which walls know.
    pub(crate) accelerations: Vec<UniformLoad<D>>,
    /// Loads that depend on the particle.
    pub(crate) loads: Vec<Load<D>>,
    /// Times \[s\] at which steps end, in their order.
    step_ends: Vec<f64>,
    /// Where particles were as built \[m\], group by group and by identity, if a load may ask.
    pub(crate) built: Vec<Vec<Option<[f64; D]>>>,
    /// Hashes of the scene that it was built from, by what was hashed.
    #[cfg(feature = "checkpoint")]
    pub(crate) scene: Hashes,
    /// Values of that scene by name.
    #[cfg(feature = "checkpoint")]
    pub(crate) described: Described,
    /// The state before an evaluation between steps.
    aside: Option<Box<State<T, D>>>,
    /// What readings are shown.
    shown: Reading<T, D>,
    /// What ended it, in words.
    failed: Option<String>,
    /// What is looked at after every step.
    events: Vec<Event<T, D>>,
    /// Memory for the forces of a kick.
    pair_forces: PairForces<D>,
    /// The ranks that it runs on, if it runs on ranks.
    team: Option<Arc<Team>>,
    /// Whether ranks may step their own particles alone.
    steps_parts: bool,
}

impl<T: Real, const D: usize> core::fmt::Debug for Simulation<T, D> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Simulation")
            .field("time", &self.state.time)
            .field("steps", &self.steps())
            .field("particles", &self.particles())
            .finish_non_exhaustive()
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    pub(crate) fn new(
        mut groups: Vec<Group<T, D>>,
        couples: Vec<Couple<T, D>>,
        domain: Option<[[f64; D]; 2]>,
        integrator: Arc<dyn Integrator>,
        control: StepControl,
        accelerations: Vec<UniformLoad<D>>,
        loads: Vec<Load<D>>,
    ) -> Self {
        let mut slots = 0;
        for group in &mut groups {
            group.particles.first_id = slots;
            slots += group.particles.columns.slots();
        }
        let walls = groups.iter().flat_map(|group| &group.walls);
        let met: Vec<usize> = walls
            .filter_map(|wall| Some(wall.structure.as_ref()?.group))
            .collect();
        for group in met {
            groups[group].is_met = true;
        }
        Self {
            state: Readable::new(State::new(groups, couples)),
            domain,
            integrator,
            control,
            accelerations,
            loads,
            step_ends: Vec::new(),
            built: Vec::new(),
            #[cfg(feature = "checkpoint")]
            scene: Hashes::new(),
            #[cfg(feature = "checkpoint")]
            described: Described::new(),
            aside: None,
            shown: Reading::LastStep,
            failed: None,
            events: Vec::new(),
            pair_forces: PairForces::default(),
            team: None,
            steps_parts: false,
        }
    }

    /// The same, of steps that end at these times \[s\].
    pub(crate) fn with_step_ends(mut self, mut times: Vec<f64>) -> Self {
        times.sort_by(f64::total_cmp);
        self.step_ends = times;
        self
    }

    /// Time \[s\].
    ///
    /// After [`run_until`](Self::run_until) this is the requested end.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.state.own().time
    }

    /// The body that a particle belongs to, and its number there.
    fn locate(&self, id: usize) -> (String, usize) {
        let of = |(group, body): (&Group<T, D>, &BodyState<T>)| {
            let own = id.checked_sub(group.particles.first_id)?;
            let inside = body.ids.contains(&own);
            inside.then(|| (body.name.clone(), own - body.ids.start))
        };
        self.all_bodies().find_map(of).unwrap_or_default()
    }

    /// Evaluates all rates at the present state, so that pressures and forces can be asked for.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if a number is no longer finite, [`Error::Load`] if one of a load is not,
    /// [`Error::SoundSpeedTooLow`] if a liquid is faster than its sound, and [`Error::Failed`] after a step that has
    /// failed.
    ///
    /// Between steps it changes nothing of what comes: the next step starts from the rates that the step before has
    /// left, which belong to predicted velocities. The state is held twice until then.
    pub fn evaluate(&mut self) -> Result<()> {
        once!(self => &mut Simulation, |own| -> Result<()> {
            own.check_failure()?;
            if own.state.rates_at_hand && own.aside.is_none() {
                own.aside = Some(Box::new(own.keep()));
            }
            let evaluated = own.evaluate_together();
            let voted = evaluated.and_then(|()| own.found(Simulation::vote).map(|_| ()));
            own.agree(voted)
        })
    }

    /// Refuses to go on after a failure.
    fn check_failure(&self) -> Result<()> {
        match &self.failed {
            Some(cause) => Err(Error::Failed {
                cause: cause.clone(),
            }),
            None => Ok(()),
        }
    }
}
