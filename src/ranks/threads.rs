//! Ranks as threads of one process: each has a pool of threads of its own, and they meet in memory.
//! So that what runs on a cluster is tested on one machine, without MPI.

use super::{Offer, Offers, Ranks};
use crate::error::{Error, Failure, Problem};
use crate::parallel::Pool;
use std::panic::resume_unwind;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, RwLock};

/// Runs a program on so many ranks, each with so many threads, and returns what each rank returns.
///
/// A rank that ends before the others ends what they wait for with [`Error::Rank`]; nothing hangs.
///
/// See [`ranks`](crate::ranks) for an example.
///
/// # Errors
/// [`Error::Argument`] if there is no rank or no thread, or if the system gives no threads.
///
/// # Panics
/// If the program does on a rank, after all ranks have ended.
pub fn in_threads<V: Send>(
    count: usize,
    threads: usize,
    program: impl Fn(Arc<dyn Ranks>) -> V + Sync,
) -> Result<Vec<V>, Error> {
    for (what, value) in [("number of ranks", count), ("threads of a rank", threads)] {
        if value == 0 {
            return Err(Error::Argument(Problem::Parameter {
                what: what.into(),
                value: 0.0,
                must_be: "must be one or more",
            }));
        }
    }
    let pools: Result<Vec<_>, String> = (0..count).map(|_| Pool::new(threads)).collect();
    let Ok(pools) = pools else {
        return Err(Error::Argument(Problem::Parameter {
            what: "threads of a rank".into(),
            value: threads as f64,
            must_be: "must be as many as the system gives, and one without the feature `parallel`",
        }));
    };
    let hall = Arc::new(Hall {
        parts: (0..count).map(|_| RwLock::default()).collect(),
        letters: (0..count).map(|_| RwLock::default()).collect(),
        meeting: Mutex::new(Meeting {
            offers: vec![Offers::default(); count],
            ..Meeting::default()
        }),
        met: Condvar::new(),
    });
    let program = &program;
    let ended: Vec<_> = std::thread::scope(|scope| {
        let begun: Vec<_> = pools
            .iter()
            .enumerate()
            .map(|(rank, pool)| {
                let hall = hall.clone();
                scope.spawn(move || {
                    let _end = End(rank, hall.clone());
                    let own: Arc<dyn Ranks> = Arc::new(Thread { rank, hall });
                    pool.install(|| program(own))
                })
            })
            .collect();
        begun.into_iter().map(|rank| rank.join()).collect()
    });
    let unwound = |panicked| resume_unwind(panicked);
    Ok(ended
        .into_iter()
        .map(|own| own.unwrap_or_else(unwound))
        .collect())
}

/// Where ranks meet.
#[derive(Debug)]
struct Hall {
    /// What each rank gives.
    parts: Vec<RwLock<Vec<u8>>>,
    /// What each has for each of the others, one after another, and how many bytes of it.
    letters: Vec<RwLock<(Vec<u8>, Vec<usize>)>>,
    meeting: Mutex<Meeting>,
    met: Condvar,
}

#[derive(Debug, Default)]
struct Meeting {
    arrived: usize,
    /// Meetings that all have come to.
    number: u64,
    /// A rank that has ended.
    gone: Option<usize>,
    /// What each rank offers.
    offers: Vec<Offers>,
    /// Ranks that have withdrawn an offer after a rank had ended, and the number of the offer.
    withdrawn: Vec<(usize, u64)>,
}

impl Hall {
    fn meeting(&self) -> MutexGuard<'_, Meeting> {
        self.meeting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until all ranks are here.
    fn meet(&self) -> Result<(), Failure> {
        let mut own = self.meeting();
        let number = own.number;
        own.arrived += 1;
        if own.arrived == self.parts.len() {
            own.arrived = 0;
            own.number += 1;
            self.met.notify_all();
            return Ok(());
        }
        while own.number == number {
            own = self.wait(own)?;
        }
        Ok(())
    }

    /// Waits until something has changed.
    fn wait<'a>(&self, own: MutexGuard<'a, Meeting>) -> Result<MutexGuard<'a, Meeting>, Failure> {
        if let Some(rank) = own.gone {
            return Err(format!("rank {rank} has ended").into());
        }
        Ok(self.met.wait(own).unwrap_or_else(PoisonError::into_inner))
    }
}

/// Says that a rank has ended, also where it panics.
struct End(usize, Arc<Hall>);

impl Drop for End {
    fn drop(&mut self) {
        self.1.meeting().gone.get_or_insert(self.0);
        self.1.met.notify_all();
    }
}

#[derive(Debug)]
struct Thread {
    rank: usize,
    hall: Arc<Hall>,
}

impl Ranks for Thread {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.hall.parts.len()
    }

    fn gather(&self, own: &[u8], counts: &[usize], all: &mut [u8]) -> Result<(), Failure> {
        {
            let part = &self.hall.parts[self.rank];
            let mut part = part.write().unwrap_or_else(PoisonError::into_inner);
            part.clear();
            part.extend_from_slice(own);
        }
        self.hall.meet()?;
        let mut rest = all;
        for (part, &count) in self.hall.parts.iter().zip(counts) {
            let part = part.read().unwrap_or_else(PoisonError::into_inner);
            let (to, behind) = rest.split_at_mut(count);
            to.copy_from_slice(&part);
            rest = behind;
        }
        // Nobody writes before all have read.
        self.hall.meet()
    }

    fn exchange(
        &self,
        own: &[u8],
        to: &[usize],
        all: &mut [u8],
        from: &[usize],
    ) -> Result<(), Failure> {
        {
            let letters = &self.hall.letters[self.rank];
            let mut letters = letters.write().unwrap_or_else(PoisonError::into_inner);
            letters.0.clear();
            letters.0.extend_from_slice(own);
            letters.1.clear();
            letters.1.extend_from_slice(to);
        }
        self.hall.meet()?;
        let mut rest = all;
        for (letters, &count) in self.hall.letters.iter().zip(from) {
            let letters = letters.read().unwrap_or_else(PoisonError::into_inner);
            let (bytes, lengths) = &*letters;
            let start: usize = lengths[..self.rank].iter().sum();
            let sent = bytes.get(start..start + lengths[self.rank]);
            let sent = sent.filter(|sent| sent.len() == count);
            let (to, behind) = rest.split_at_mut(count);
            to.copy_from_slice(sent.ok_or("a rank has sent more or less than was expected")?);
            rest = behind;
        }
        self.hall.meet()
    }

    fn offer(&self, offer: Offer) -> Option<u64> {
        let number = self.hall.meeting().offers[self.rank].make(offer);
        self.hall.met.notify_all();
        Some(number)
    }

    fn withdraw(&self, number: u64) {
        let mut meeting = self.hall.meeting();
        let Meeting {
            gone,
            offers,
            withdrawn,
            ..
        } = &mut *meeting;
        if gone.is_none() {
            return offers[self.rank].withdraw(number);
        }
        // Simulations that ranks have returned are read and dropped one after another.
        withdrawn.push((self.rank, number));
        let is_withdrawn = |(rank, offers): (usize, &Offers)| {
            offers.find(number).is_none() || withdrawn.contains(&(rank, number))
        };
        if offers.iter().enumerate().all(is_withdrawn) {
            for offers in offers {
                offers.withdraw(number);
            }
            withdrawn.retain(|own| own.1 != number);
        }
    }

    fn ask(&self, rank: usize, number: u64, part: usize) -> Result<Vec<u8>, Failure> {
        let mut meeting = self.hall.meeting();
        let offer = loop {
            let offers = &meeting.offers[rank];
            if let Some(offer) = offers.find(number) {
                break offer.clone();
            }
            if offers.was_made(number) {
                return Err(format!("rank {rank} has withdrawn what it has offered").into());
            }
            meeting = self.hall.wait(meeting)?;
        };
        drop(meeting);
        Ok(offer(part))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_get_what_each_gives() {
        let all = in_threads(3, 1, |ranks| {
            let own = vec![ranks.rank() as u8; ranks.rank() + 1];
            (0..100).fold(Vec::new(), |_, _| {
                let mut all = vec![9; 6];
                ranks
                    .gather(&own, &[1, 2, 3], &mut all)
                    .expect("three ranks");
                all
            })
        })
        .expect("threads");
        assert_eq!(all, vec![vec![0, 1, 1, 2, 2, 2]; 3]);
    }

    #[test]
    fn each_gets_what_is_meant_for_it() {
        let all = in_threads(3, 1, |ranks| {
            // Rank r has r + 1 times the digits r and q for rank q, and nothing for itself.
            let rank = ranks.rank();
            let to: Vec<usize> = (0..3)
                .map(|q| if q == rank { 0 } else { 2 * (rank + 1) })
                .collect();
            let from: Vec<usize> = (0..3)
                .map(|q| if q == rank { 0 } else { 2 * (q + 1) })
                .collect();
            let own: Vec<u8> = (0..3)
                .flat_map(|q| [rank as u8, q as u8].repeat(to[q] / 2))
                .collect();
            let mut all = vec![9; from.iter().sum()];
            for _ in 0..50 {
                ranks
                    .exchange(&own, &to, &mut all, &from)
                    .expect("three ranks");
            }
            all
        })
        .expect("threads");
        assert_eq!(all[0], [1, 0, 1, 0, 2, 0, 2, 0, 2, 0]);
        assert_eq!(all[1], [0, 1, 2, 1, 2, 1, 2, 1]);
        assert_eq!(all[2], [0, 2, 1, 2, 1, 2]);
    }

    #[test]
    fn a_rank_that_ends_ends_the_wait_of_others() {
        let all = in_threads(3, 1, |ranks| {
            if ranks.rank() == 1 {
                return String::new();
            }
            let failed = ranks.gather(&[1], &[1; 3], &mut [0; 3]);
            failed.map_or_else(|why| why.to_string(), |()| "met".into())
        })
        .expect("threads");
        assert_eq!(all, ["rank 1 has ended", "", "rank 1 has ended"]);
        assert!(in_threads(0, 1, |_| ()).is_err());
        assert!(in_threads(1, 0, |_| ()).is_err());
    }
}
