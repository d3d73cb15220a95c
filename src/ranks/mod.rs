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
//! | search for neighbours | particles that are sorted go to their next ranks; then each rank gets the places of those within reach of boxes around its own, and lists the neighbours of its chunks |
//!
//! Scenes of which a step looks at more than neighbours (couplings, contact, joints, rigid bodies, clamps, loads by particle, events,
//! inlets and outlets), and calls that show every step, have another form of it: each rank sums over the pairs of its chunks, then all get
//! the sums of all, and all else is done on every rank of all particles.
//!
//! What a rank sums for a particle is what one process sums, in the same order, so bits depend on neither the number of ranks
//! nor the threads of each, nor on how chunks are cut, nor on the form of a step. Any method that reads a simulation gives the same values
//! on all of them.
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
//! # Reading
//!
//! After [`run_until`](crate::simulation::Simulation::run_until) each rank has its own particles. The first method that reads particles asks the
//! other ranks for theirs and saves them until the next call. One rank may read alone: the other ranks answer during their next call on any
//! simulation of these ranks. A rank that drops its simulation first waits until the other ranks drop theirs or call a method that steps.
//! Time, numbers of steps, particles and list builds are known on every rank without a message.
//!
//! # Memory
//!
//! A rank has its own particles, their lists, and ghosts: particles of others that these name. Of all others it has while it builds the
//! scene the places that bodies have, one column at a time while a checkpoint is written or read, and all particles in the second form of
//! a step and after it has read. A scene of which the part of a rank is predicted not to fit is refused on all of them.
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
//! any number of ranks and any [`Network`]. What limits large scenes first are the places of all particles, which every rank has while
//! it builds the scene.
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
mod offers;
mod post;
mod team;
mod threads;
mod traffic;

pub(crate) use bytes::{Plain, Taken, put_number, put_numbers};
pub(crate) use division::{Division, even};
pub(crate) use joined::{Asked, Source};
pub use model::{Network, RankCost, RankCostLine, RankModel, RankParts, RankPrice};
pub use offers::{Offer, Offers};
pub(crate) use team::{Stamp, Team, What};
pub use threads::in_threads;
pub(crate) use traffic::Letters;
pub use traffic::Traffic;

use crate::error::Failure;

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

    /// Makes an offer: other ranks may [ask](Self::ask) for its parts until it is withdrawn. Returns its number, which
    /// [`Offers`] gives. All ranks make their offers in the same order, without a message. While an offer stands, this rank answers in every
    /// method of this trait.
    ///
    /// The default makes none. Ranks without offers gather all particles at the end of every call.
    fn offer(&self, offer: Offer) -> Option<u64> {
        let _ = offer;
        None
    }

    /// Withdraws the offer with a number. All ranks have gathered since it was made, so no rank asks for it any more, unless a rank has ended:
    /// then its offers stand until all others have withdrawn theirs.
    fn withdraw(&self, number: u64) {
        let _ = number;
    }

    /// Asks a rank for a part of the offer with a number, and waits until the rank makes that offer. The other ranks need not ask.
    ///
    /// # Errors
    /// If the rank cannot be reached any more, or if the offer is withdrawn.
    fn ask(&self, rank: usize, number: u64, part: usize) -> Result<Vec<u8>, Failure> {
        let _ = (rank, number, part);
        Err("these ranks make no offers".into())
    }
}
