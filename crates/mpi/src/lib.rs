//! Scenes of [meshfree] on many processes, and on many machines, by MPI: to the bits of one process.
//!
//! A program starts MPI with [`World::init`] and gives [`World::ranks`] to its scene; all else stays as it is. It is started with
//! `mpirun -n 4 program`, and every process runs all of it. What is divided, and what is not, is in [`meshfree::ranks`].
//!
//! ```no_run
//! use meshfree::prelude::*;
//! use meshfree_mpi::World;
//! let world = World::init()?;
//! let water = catalogue::weakly_compressible_water(20.0);
//! let mut simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
//!     .body(Body::block("water", water, [0.0; 2], [0.4, 0.4], 0.01))
//!     .boundary(MirrorPlane::wall([0.0; 2], [0.0, -1.0]))
//!     .acceleration(|_| [0.0, -9.81])
//!     .on_ranks(world.ranks())
//!     .build()?;
//! simulation.run_until(0.1)?;
//! if simulation.is_first_rank() {
//!     println!("{} steps", simulation.steps());
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! To compile it takes a C compiler, `pkg-config` and an MPI: on Debian `apt-get install mpich libmpich-dev`.

mod post;

use ferrompi::{Communicator, ThreadLevel};
use meshfree::error::Failure;
use meshfree::ranks::{Offer, Ranks};
use post::PostOffice;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use thiserror::Error;

/// Why there is no MPI to run on.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// MPI has said so.
    #[error("MPI does not start: {0}")]
    Start(ferrompi::Error),
    /// It may be called by one thread alone.
    #[error(
        "this MPI gives the thread level {0:?}, and MPI_THREAD_SERIALIZED is needed: loops run on a pool of threads, any of which \
         may call it; take an MPI that was built with threads"
    )]
    Threads(ThreadLevel),
}

/// MPI, from its start to its end, where it is dropped. A process has one at a time.
///
/// Where a process panics MPI ends all others too.
pub struct World {
    mpi: ferrompi::Mpi,
    ranks: Arc<Processes>,
}

impl World {
    /// Starts MPI.
    ///
    /// # Errors
    /// If MPI does not start, or may not be called by any thread.
    pub fn init() -> Result<Self, Error> {
        let mpi = ferrompi::Mpi::init_thread(ThreadLevel::Serialized).map_err(Error::Start)?;
        if mpi.thread_level() < ThreadLevel::Serialized {
            return Err(Error::Threads(mpi.thread_level()));
        }
        let ranks = Arc::new(Processes {
            world: mpi.world(),
            most: MOST,
            post: PostOffice::default(),
            has_ended: AtomicBool::new(false),
        });
        Ok(Self { mpi, ranks })
    }

    /// The processes, for [`Scene::on_ranks`](meshfree::scene::Scene::on_ranks).
    #[must_use]
    pub fn ranks(&self) -> Arc<dyn Ranks> {
        self.ranks.clone()
    }
}

impl core::fmt::Debug for World {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("World")
            .field("rank", &self.ranks.rank())
            .field("count", &self.ranks.count())
            .finish_non_exhaustive()
    }
}

impl Drop for World {
    fn drop(&mut self) {
        self.ranks.has_ended.store(true, Ordering::Relaxed);
        if std::thread::panicking() {
            // The others may wait for this process, and MPI would wait for them.
            self.mpi.world().abort(1);
        }
    }
}

/// Bytes of all processes together that MPI takes at once: it counts them in 32 bits.
const MOST: usize = i32::MAX as usize;

/// The processes of `MPI_COMM_WORLD`.
struct Processes {
    world: Communicator,
    /// Bytes of all that are gathered at once.
    most: usize,
    post: PostOffice,
    /// Whether MPI has ended, after which no call of it is allowed.
    has_ended: AtomicBool,
}

impl core::fmt::Debug for Processes {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "rank {} of {} by MPI", self.rank(), self.count())
    }
}

impl Ranks for Processes {
    fn rank(&self) -> usize {
        self.world.rank() as usize
    }

    fn count(&self) -> usize {
        self.world.size() as usize
    }

    fn gather(&self, own: &[u8], counts: &[usize], all: &mut [u8]) -> Result<(), Failure> {
        if all.len() <= self.most {
            return self.gather_at_once(own, counts, all);
        }
        // In pieces that all processes know.
        let piece = (self.most / counts.len()).max(1);
        let largest = counts.iter().copied().max().unwrap_or(0);
        let mut buffer = Vec::new();
        for begin in (0..largest).step_by(piece) {
            let run = |count: usize| begin.min(count)..(begin + piece).min(count);
            let lengths: Vec<usize> = counts.iter().map(|&count| run(count).len()).collect();
            buffer.resize(lengths.iter().sum(), 0);
            self.gather_at_once(&own[run(own.len())], &lengths, &mut buffer)?;
            let (mut at, mut first) = (0, 0);
            for (&count, length) in counts.iter().zip(lengths) {
                let to = first + run(count).start;
                all[to..to + length].copy_from_slice(&buffer[at..at + length]);
                at += length;
                first += count;
            }
        }
        Ok(())
    }

    fn exchange(
        &self,
        own: &[u8],
        to: &[usize],
        all: &mut [u8],
        from: &[usize],
    ) -> Result<(), Failure> {
        self.exchange_beside((own, to), (all, from), &mut || {})
    }

    fn exchange_beside(
        &self,
        (own, to): (&[u8], &[usize]),
        (all, from): (&mut [u8], &[usize]),
        meanwhile: &mut dyn FnMut(),
    ) -> Result<(), Failure> {
        self.check()?;
        let (sent, sent_from) = lengths_and_begins(to)?;
        let (got, got_from) = lengths_and_begins(from)?;
        ferrompi::scope(|scope| {
            let world = &self.world;
            let come = world.ialltoallv(scope, own, &sent, &sent_from, all, &got, &got_from)?;
            meanwhile();
            if self.post.has_offers() {
                self.post.wait(world, come)
            } else {
                come.wait().map(|_| ())
            }
        })?;
        Ok(())
    }

    fn offer(&self, offer: Offer) -> Option<u64> {
        Some(self.post.make(offer))
    }

    fn withdraw(&self, number: u64) {
        self.post.withdraw(number);
    }

    fn ask(&self, rank: usize, number: u64, part: usize) -> Result<Vec<u8>, Failure> {
        self.check()?;
        let question = [number, part as u64];
        self.post.ask(&self.world, i32::try_from(rank)?, question)
    }
}

/// Counts of bytes as MPI takes them, and where those of each process begin.
fn lengths_and_begins(counts: &[usize]) -> Result<(Vec<i32>, Vec<i32>), Failure> {
    let mut end = 0_usize;
    let mut begins = Vec::with_capacity(counts.len());
    for count in counts {
        begins.push(i32::try_from(end)?);
        end += count;
    }
    i32::try_from(end)?;
    Ok((counts.iter().map(|&count| count as i32).collect(), begins))
}

impl Processes {
    /// Refuses calls after the end of MPI.
    fn check(&self) -> Result<(), Failure> {
        if self.has_ended.load(Ordering::Relaxed) {
            return Err(
                "MPI has ended: keep the `World` until all simulations on it are dropped".into(),
            );
        }
        Ok(())
    }

    fn gather_at_once(&self, own: &[u8], counts: &[usize], all: &mut [u8]) -> Result<(), Failure> {
        self.check()?;
        let (lengths, begins) = lengths_and_begins(counts)?;
        if !self.post.has_offers() {
            return Ok(self.world.allgatherv(own, all, &lengths, &begins)?);
        }
        ferrompi::scope(|scope| {
            let world = &self.world;
            let come = world.iallgatherv(scope, own, all, &lengths, &begins)?;
            self.post.wait(world, come)
        })?;
        Ok(())
    }
}

/// The processes of a world that gather at most so many bytes at once, for the test of messages longer than MPI takes.
#[doc(hidden)]
#[must_use]
pub fn in_pieces(world: &World, most: usize) -> Arc<dyn Ranks> {
    Arc::new(Processes {
        world: world.mpi.world(),
        most,
        post: PostOffice::default(),
        has_ended: AtomicBool::new(false),
    })
}
