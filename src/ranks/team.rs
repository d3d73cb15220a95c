//! What ranks say to each other: parts of sums and lists, whether all is well, and where they are.
//! Each gathering begins with a header of every rank, so an error or another program on one of them reaches all.

use super::traffic::{Given, Letters, Traffic};
use super::{Offer, Ranks, Taken};
use crate::clock::Instant;
use crate::error::{Error, Failure};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// What a gathering is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum What {
    /// The end of a call, with how it ended.
    End,
    /// The instructions of the loops over pairs.
    Instructions,
    /// Sums of a sweep.
    Sums,
    /// Lists of neighbours.
    Lists,
    /// What the first rank decides for all.
    Decision,
    /// Numbers that are joined.
    Numbers,
    /// Particles of all ranks.
    State,
    /// Particles near those of another rank.
    Ghosts,
    /// The end of an offer.
    Offer,
}

impl What {
    /// Whether what ranks give are parts of one whole, and otherwise as much from each.
    fn is_parts(self) -> bool {
        matches!(self, Self::Sums | Self::Lists | Self::State)
    }
}

/// A rank that has failed says so in the place of what the others gather.
const FAILED: u64 = u64::MAX;

/// Numbers of a header: what is gathered, and how many bytes of it.
const HEADER: usize = 2;

/// Where a simulation is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stamp {
    /// Steps taken.
    pub steps: u64,
    /// The time \[s\].
    pub time: f64,
    /// Particles.
    pub particles: usize,
    /// A number that follows from their velocities, or from how they start.
    pub motion: u64,
}

impl Stamp {
    /// The sum of the last digits of some numbers, few enough that no sum of those of all particles is too large: of other numbers it
    /// is another.
    pub fn digits(numbers: impl IntoIterator<Item = f64>) -> u64 {
        let digits = |own: f64| (own.to_bits() ^ own.to_bits() >> 32) & 0xffff;
        numbers.into_iter().map(digits).sum()
    }
}

/// The ranks of a simulation, as one of them sees them.
#[derive(Debug)]
pub(crate) struct Team {
    ranks: Arc<dyn Ranks>,
    /// The first error of a rank, after which nothing is gathered.
    broken: Mutex<Option<Broken>>,
    buffers: Mutex<Buffers>,
}

/// What has gone wrong, on which rank.
#[derive(Clone, Debug)]
struct Broken {
    rank: usize,
    cause: String,
    /// Whether this rank has told it.
    told: bool,
}

/// That of a rank.
fn broken(rank: usize, cause: impl Into<String>) -> Broken {
    Broken {
        rank,
        cause: cause.into(),
        told: false,
    }
}

/// Memory for messages.
#[derive(Debug, Default)]
struct Buffers {
    own: Vec<u8>,
    counts: Vec<usize>,
    headers: Vec<u8>,
    all: Vec<u8>,
    traffic: Traffic,
    given: Given,
}

impl Buffers {
    /// Gives what is in `own`, and gets `counts` bytes of each.
    fn gather(&mut self, ranks: &dyn Ranks) -> Result<(), Failure> {
        self.all.resize(self.counts.iter().sum(), 0);
        self.count(self.own.len(), self.all.len());
        ranks.gather(&self.own, &self.counts, &mut self.all)
    }

    fn count(&mut self, own: usize, all: usize) {
        self.traffic.gathered += 1;
        self.traffic.sent += own as u64;
        self.traffic.received += (all - own) as u64;
    }

    /// Number `k` of the header of a rank.
    fn header(&self, rank: usize, k: usize) -> u64 {
        let at = 8 * (HEADER * rank + k);
        let bytes = self
            .headers
            .get(at..at + 8)
            .and_then(|own| own.try_into().ok());
        bytes.map_or(FAILED, u64::from_ne_bytes)
    }
}

impl Team {
    pub fn new(ranks: Arc<dyn Ranks>) -> Self {
        Self {
            ranks,
            broken: Mutex::default(),
            buffers: Mutex::default(),
        }
    }

    /// The number of this rank.
    pub fn rank(&self) -> usize {
        self.ranks.rank()
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.ranks.count()
    }

    /// Whether nothing is gathered any more.
    pub fn is_broken(&self) -> bool {
        self.broken().is_some()
    }

    /// What was said until now.
    pub fn traffic(&self) -> Traffic {
        self.buffers().traffic
    }

    /// The same by kind.
    pub fn given(&self) -> Given {
        self.buffers().given
    }

    /// Counts that particles go to other ranks.
    pub fn count_travel(&self) {
        self.buffers().traffic.travelled += 1;
    }

    fn buffers(&self) -> MutexGuard<'_, Buffers> {
        self.buffers.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn broken(&self) -> MutexGuard<'_, Option<Broken>> {
        self.broken.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Gathers what each rank puts, and shows it rank by rank. Where a rank has failed, or what it put is not what it must be,
    /// nothing is shown any more, and [`agree`](Self::agree) returns the error.
    pub fn gather(
        &self,
        what: What,
        put: impl FnOnce(&mut Vec<u8>),
        mut take: impl FnMut(usize, &[u8]) -> Option<()>,
    ) {
        if self.broken().is_some() {
            return;
        }
        let start = Instant::now();
        let mut buffers = self.buffers();
        buffers.own.clear();
        put(&mut buffers.own);
        let length = buffers.own.len() as u64;
        if what.is_parts() {
            buffers.given.parts += length;
        } else {
            buffers.given.each += length;
        }
        let gathered = self.gather_put(what as u64, &mut buffers);
        let (mut at, is_heard) = (0, gathered.is_ok());
        let taken = gathered.and_then(|()| {
            for rank in 0..self.count() {
                let own = &buffers.all[at..at + buffers.counts[rank]];
                at += own.len();
                if take(rank, own).is_none() {
                    let cause = format!("its message ({what:?}) is not that of the same scene");
                    return Err(broken(rank, cause));
                }
            }
            Ok(())
        });
        if let (Err(own), true) = (&taken, is_heard) {
            // Those who could take it hear of it in their next gathering.
            buffers.own = own.cause.clone().into_bytes();
            let _ = self.gather_put(FAILED, &mut buffers);
        }
        buffers.traffic.waited += start.elapsed();
        if let Err(own) = taken {
            *self.broken() = Some(own);
        }
    }

    fn unreachable(&self, why: &Failure) -> Broken {
        broken(self.rank(), format!("it cannot reach the others: {why}"))
    }

    /// Headers, and then what they announce.
    fn gather_put(&self, what: u64, buffers: &mut Buffers) -> Result<(), Broken> {
        let failed = self.gather_headers(what, buffers)?;
        self.gather_announced(failed, buffers)
    }

    /// The headers; the first rank that has failed, if one has.
    fn gather_headers(&self, what: u64, buffers: &mut Buffers) -> Result<Option<usize>, Broken> {
        let count = self.count();
        let own = [what, buffers.own.len() as u64];
        let own: Vec<u8> = own.iter().flat_map(|number| number.to_ne_bytes()).collect();
        buffers.headers.resize(own.len() * count, 0);
        buffers.counts.clear();
        buffers.counts.resize(count, own.len());
        let Buffers {
            counts, headers, ..
        } = buffers;
        let headed = self.ranks.gather(&own, counts, headers);
        buffers.count(own.len(), own.len() * count);
        buffers.given.each += own.len() as u64;
        headed.map_err(|why| self.unreachable(&why))?;
        let failed = (0..count).find(|&rank| buffers.header(rank, 0) == FAILED);
        let other = (0..count).find(|&rank| buffers.header(rank, 0) != buffers.header(0, 0));
        if let (None, Some(rank)) = (failed, other) {
            let cause = "it calls other methods than rank 0: all ranks must run the same program";
            return Err(broken(rank, cause));
        }
        if failed.is_some() && what != FAILED {
            buffers.own.clear();
        }
        for rank in 0..count {
            let speaks = failed.is_none() || buffers.header(rank, 0) == FAILED;
            buffers.counts[rank] = if speaks {
                buffers.header(rank, 1) as usize
            } else {
                0
            };
        }
        Ok(failed)
    }

    /// What headers have announced.
    fn gather_announced(&self, failed: Option<usize>, buffers: &mut Buffers) -> Result<(), Broken> {
        buffers
            .gather(&*self.ranks)
            .map_err(|why| self.unreachable(&why))?;
        let Some(rank) = failed else {
            return Ok(());
        };
        let said = &buffers.all[..buffers.counts[rank]];
        Err(broken(rank, String::from_utf8_lossy(said)))
    }

    /// Gives each rank what is meant for it, as [`Ranks::exchange`] does, and whether it came: where a rank has failed it does not.
    pub fn exchange(
        &self,
        letters: Letters,
        own: (&[u8], &[usize]),
        all: (&mut [u8], &[usize]),
    ) -> bool {
        self.exchange_beside(letters, own, all, &mut || {})
    }

    /// The same beside what needs nothing of it, which is done once unless a rank has failed.
    pub fn exchange_beside(
        &self,
        letters: Letters,
        (own, to): (&[u8], &[usize]),
        (all, from): (&mut [u8], &[usize]),
        meanwhile: &mut dyn FnMut(),
    ) -> bool {
        if self.broken().is_some() {
            return false;
        }
        let mut buffers = self.buffers();
        let (start, mut worked) = (Instant::now(), Duration::ZERO);
        buffers.own.clear();
        // A rank that has failed says so here, or the others would wait for its letter.
        let headed = self.gather_headers(What::Ghosts as u64, &mut buffers);
        let come = headed.and_then(|failed| {
            if failed.is_some() {
                return self.gather_announced(failed, &mut buffers);
            }
            match letters {
                Letters::Each(bytes) => buffers.given.to_each += bytes as u64,
                Letters::Ghosts(bytes) => buffers.given.of_ghost += bytes as u64,
                Letters::Moved => {}
            }
            buffers.traffic.exchanged += 1;
            buffers.traffic.sent += own.len() as u64;
            buffers.traffic.received += all.len() as u64;
            let mut beside = || {
                let begun = Instant::now();
                meanwhile();
                worked = begun.elapsed();
            };
            let come = (self.ranks).exchange_beside((own, to), (all, from), &mut beside);
            come.map_err(|why| self.unreachable(&why))
        });
        buffers.traffic.waited += start.elapsed().saturating_sub(worked);
        let Err(own) = come else {
            return true;
        };
        *self.broken() = Some(own);
        false
    }

    /// Makes an offer, and returns its number, which is the same on all ranks; none if these ranks make none.
    pub fn offer(&self, offer: Offer) -> Option<u64> {
        self.ranks.offer(offer)
    }

    /// Withdraws an offer once all ranks do so; until then others may ask for it.
    pub fn withdraw(&self, number: u64) {
        // The end of a rank that panics reaches the others by other means.
        if !std::thread::panicking() {
            self.gather(What::Offer, |_| {}, |_, _| Some(()));
        }
        self.ranks.withdraw(number);
    }

    /// Asks each other rank for a part of its offer, and gives it to `take`.
    pub fn ask(
        &self,
        number: u64,
        part: usize,
        mut take: impl FnMut(usize, &mut Taken<'_>) -> Option<()>,
    ) {
        let start = Instant::now();
        for rank in (0..self.count()).filter(|rank| *rank != self.rank()) {
            if self.is_broken() {
                return;
            }
            let asked = self.ranks.ask(rank, number, part);
            let taken = asked.map_err(|why| self.unreachable(&why)).and_then(|own| {
                self.buffers().traffic.received += own.len() as u64;
                let mut from = Taken(&own);
                take(rank, &mut from)
                    .filter(|()| from.0.is_empty())
                    .ok_or_else(|| broken(rank, "its offer is not that of the same scene"))
            });
            if let Err(own) = taken {
                *self.broken() = Some(own);
            }
        }
        self.buffers().traffic.waited += start.elapsed();
    }

    /// Ends a call on all ranks: as it did on this one if it did so on all, and with an error if it failed on another, or if
    /// others are elsewhere.
    ///
    /// # Errors
    /// That of the call, or [`Error::Rank`].
    pub fn agree<V>(&self, stamp: Option<Stamp>, outcome: Result<V, Error>) -> Result<V, Error> {
        if self.broken().is_none() {
            match (&outcome, stamp) {
                (Ok(_), Some(stamp)) => self.compare(stamp),
                (Ok(_), None) => self.gather(What::End, |_| {}, |_, _| Some(())),
                (Err(error), _) => return self.fail(&error.to_string(), outcome),
            }
        }
        match &*self.broken() {
            None => outcome,
            // Its own error says more.
            Some(own) if own.told && outcome.is_err() => outcome,
            Some(_) if matches!(outcome, Err(Error::Failed { .. })) => outcome,
            Some(own) => Err(Error::Rank {
                rank: own.rank,
                cause: own.cause.clone(),
            }),
        }
    }

    /// Whether all ranks are where this one is.
    fn compare(&self, stamp: Stamp) {
        let numbers = |own: &Stamp| {
            [
                own.steps,
                own.time.to_bits(),
                own.particles as u64,
                own.motion,
            ]
        };
        let put = |to: &mut Vec<u8>| {
            to.extend(
                numbers(&stamp)
                    .iter()
                    .flat_map(|number| number.to_ne_bytes()),
            );
        };
        let mut first = None;
        let mut differs = None;
        self.gather(What::End, put, |rank, own| {
            let own: [u8; 32] = own.try_into().ok()?;
            let first = first.get_or_insert(own);
            if *first != own {
                differs.get_or_insert(rank);
            }
            Some(())
        });
        if let Some(rank) = differs {
            let cause = "its time, its number of particles, or how these move or start, are not those of rank 0: all ranks must \
                         build the same scene, of the same functions, with one build of the program";
            self.broken().get_or_insert(broken(rank, cause));
        }
    }

    /// Tells the others. What has failed on all ranks alike is no failure of ranks.
    fn fail<V>(&self, cause: &str, outcome: Result<V, Error>) -> Result<V, Error> {
        let mut buffers = self.buffers();
        buffers.own.clear();
        buffers.own.extend_from_slice(cause.as_bytes());
        let told = self.gather_put(FAILED, &mut buffers);
        let all = (0..self.count()).all(|rank| buffers.header(rank, 0) == FAILED);
        if let (Err(first), false) = (told, all) {
            *self.broken() = Some(Broken {
                told: true,
                ..first
            });
        }
        outcome
    }
}

#[cfg(test)]
mod tests;
