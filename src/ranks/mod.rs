//! Ranks: one scene on several processes, or on several machines, to the bits of one.
//! The trait by which ranks reach each other, and ranks that are threads of one process; MPI is a crate of its own.
//!
//! Every rank builds the same scene with [`Scene::on_ranks`](crate::scene::Scene::on_ranks) and calls the same methods of its
//! [`Simulation`](crate::simulation::Simulation) in the same order. Each rank has a run of chunks of 64 clusters that are consecutive on
//! the space-filling curve, cut by the entries of their lists, and cut anew where the slowest would be a tenth above the mean. In
//! [`run_until`](crate::simulation::Simulation::run_until) and [`Run`](crate::run::Run) it steps the particles of these:
//!
//! | part of a step | on ranks |
//! |---|---|
//! | sums over pairs, laws, equations of state, kicks, drifts | each rank has its own particles, and before each sweep gets the packed records of others that its lists name; it sums over those with neighbours of its own alone meanwhile |
//! | votes on the step, validity of lists, impulses | each rank finds them for its own particles; then all ranks join them |
//! | search for neighbours | all ranks get all places, and each lists the neighbours of its chunks; then particles go to their new ranks |
//!
//! Scenes of which a step looks at more than neighbours (couplings, contact, joints, rigid bodies, clamps, loads by particle, events,
//! inlets and outlets), and calls that show every step, have another form of it: each rank sums over the pairs of its chunks, then all get
//! the sums of all, and all else is done on every rank of all particles.
//!
//! What a rank sums for a particle is what one process sums, in the same order, so bits depend on neither the number of ranks
//! nor the threads of each, nor on how chunks are cut, nor on the form of a step. Any method that reads a simulation gives the same values
//! on all of them.
//!
//! A rank may read alone: where a call has left each with its own particles, who reads asks the others for theirs, once until the next call,
//! and they answer in whatever they call next, or where they drop the simulation. What all know already, as times, counts of
//! steps and numbers of particles, needs no message.
//!
//! Lists are divided, and between list builds so is all else. A rank holds all particles where it builds the scene, in the other form
//! of a step, and where it reads, but for the lists of others, which a reading that needs them makes. Where lists are built it holds the
//! places of all, and with boundaries that turn what crosses them, as mirror planes, all of their columns.
//!
//! ```
//! use meshfree::prelude::*;
//! use meshfree::ranks;
//! let scene = || {
//!     let water = catalogue::weakly_compressible_water(20.0);
//!     Scene::<f64, 2>::new(schemes::weakly_compressible())
//!         .body(Body::block("water", water, [0.0; 2], [0.4, 0.4], 0.01))
//!         .boundary(MirrorPlane::wall([0.0; 2], [0.0, -1.0]))
//!         .acceleration(|_| [0.0, -9.81])
//! };
//! let mut one = scene().build()?;
//! one.run_until(0.002)?;
//! let fronts = ranks::in_threads(2, 1, |ranks| -> Result<f64, Error> {
//!     let mut simulation = scene().on_ranks(ranks).build()?;
//!     simulation.run_until(0.002)?;
//!     Ok(simulation.all().map(|particle| particle.position()[0]).fold(0.0, f64::max))
//! })?;
//! let front = one.all().map(|particle| particle.position()[0]).fold(0.0, f64::max);
//! for other in fronts {
//!     assert_eq!(other?, front);
//! }
//! # Ok::<(), Error>(())
//! ```
//!
//! # Files
//!
//! Every rank runs the same program, so what writes a file belongs under
//! [`Simulation::is_first_rank`](crate::simulation::Simulation::is_first_rank). `Simulation::save` is called on all ranks: each writes
//! a part of its own, and the first one the manifest of them. It resumes on any number of ranks, and without any, to the same bits, as long
//! as all files are in one folder. [`Run::paraview_in_pieces`](crate::run::Run::paraview_in_pieces) is called on all ranks too, of which
//! each writes its own particles.
//!
//! # Cost
//!
//! [`Simulation::cost`](crate::simulation::Simulation::cost) lists the messages of a run, and
//! [`Simulation::rank_model`](crate::simulation::Simulation::rank_model) predicts them, the time of a step and the memory of a rank for
//! any number of ranks and any [`Network`]. What limits first is memory, and then the gathering of all particles at list builds.
//!
//! # Errors
//!
//! An error on one rank ends the call on all of them, at the latest at the end of the step: the rank itself returns its error,
//! and the others [`Error::Rank`](crate::error::Error::Rank) with its number and text. Ranks whose times differ after a step, as
//! those of different scenes, end with that error too.

mod bytes;
mod division;
mod joined;
mod model;
mod team;
mod threads;
mod traffic;

pub(crate) use bytes::{Taken, put_number, put_numbers, put_words};
pub(crate) use division::{Division, even};
pub(crate) use joined::{Asked, Source};
pub use model::{Network, RankCost, RankCostLine, RankModel, RankParts, RankPrice};
pub(crate) use team::{Stamp, Team, What};
pub use threads::in_threads;
pub(crate) use traffic::Letters;
pub use traffic::Traffic;

use crate::error::Failure;
use std::sync::Arc;

/// What a rank shows others between calls: each part of it, by its number.
pub type Offer = Arc<dyn Fn(usize) -> Vec<u8> + Send + Sync>;

/// How a rank reaches the others.
///
/// All ranks call [`gather`](Self::gather), [`exchange`](Self::exchange) and [`exchange_beside`](Self::exchange_beside) in the same order, one
/// call at a time, from any thread.
pub trait Ranks: core::fmt::Debug + Send + Sync {
    /// The number of this rank, below [`count`](Self::count).
    fn rank(&self) -> usize;

    /// How many ranks there are: one or more.
    fn count(&self) -> usize;

    /// Gives `own` to all ranks, and puts what each of them gives into `all`, one after another in the order of the ranks:
    /// `counts[r]` bytes of rank `r`. All ranks know the counts.
    ///
    /// # Errors
    /// If a rank cannot be reached any more. No rank calls it after that.
    fn gather(&self, own: &[u8], counts: &[usize], all: &mut [u8]) -> Result<(), Failure>;

    /// Gives each rank what is meant for it: `own` has `to[r]` bytes for rank `r`, one after another in the order of the ranks, and
    /// `all` gets `from[r]` bytes of rank `r` in that order. A rank knows its own counts alone; most of them are zero, and nothing
    /// needs to travel for these.
    ///
    /// # Errors
    /// If a rank cannot be reached any more. No rank calls it after that.
    fn exchange(
        &self,
        own: &[u8],
        to: &[usize],
        all: &mut [u8],
        from: &[usize],
    ) -> Result<(), Failure>;

    /// The same, while `meanwhile` is done once, which needs nothing of what comes and calls no rank. If it is not written, the exchange
    /// comes first.
    ///
    /// # Errors
    /// As [`exchange`](Self::exchange).
    fn exchange_beside(
        &self,
        own: (&[u8], &[usize]),
        all: (&mut [u8], &[usize]),
        meanwhile: &mut dyn FnMut(),
    ) -> Result<(), Failure> {
        self.exchange(own.0, own.1, all.0, all.1)?;
        meanwhile();
        Ok(())
    }

    /// Shows the other ranks `own` on request, until it is withdrawn, while this rank is in any method of this trait, and returns the
    /// number of the offer: how many this rank has made before. All ranks make one at once, which is no message. If it is not written,
    /// all ranks get all where a call ends.
    fn offer(&self, own: Offer) -> Option<u64> {
        let _ = own;
        None
    }

    /// Shows it no more. All ranks have gathered since they made the offer, so none asks for it now.
    fn withdraw(&self, number: u64) {
        let _ = number;
    }

    /// A part of what another rank offers under this number, or is about to. One rank may ask while others do something else.
    ///
    /// # Errors
    /// If the rank cannot be reached any more, or has withdrawn it.
    fn ask(&self, rank: usize, number: u64, part: usize) -> Result<Vec<u8>, Failure> {
        let _ = (rank, number, part);
        Err("these ranks make no offers".into())
    }
}
