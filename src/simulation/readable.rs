//! The state of a run where it is read: between calls each rank may have its own particles alone, and shows them to the others.
//! Who looks at the state finds all particles, and asks the other ranks for theirs where it must.

use super::own_group::Lists;
use super::run_state::State;
use crate::parallel::apart;
use crate::ranks::{Asked, Team};
use crate::scalar::Real;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, OnceLock};

/// A state of which other ranks may be shown what this one has.
#[derive(Debug)]
pub(super) struct Readable<T: Real, const D: usize> {
    own: Arc<State<T, D>>,
    offer: Option<Standing>,
    /// That of all particles, once it was looked at.
    all: OnceLock<Box<State<T, D>>>,
}

/// An offer of all ranks.
#[derive(Debug)]
struct Standing {
    team: Arc<Team>,
    number: u64,
}

impl Standing {
    /// A copy of what this rank has, with what the others show.
    fn ask<T: Real, const D: usize>(&self, own: &State<T, D>, lists: Lists) -> State<T, D> {
        let mut all = own.clone();
        all.bring_together(lists, Some(&Asked::new(&self.team, self.number)));
        all
    }
}

impl<T: Real, const D: usize> Readable<T, D> {
    pub fn new(own: State<T, D>) -> Self {
        Self {
            own: Arc::new(own),
            offer: None,
            all: OnceLock::new(),
        }
    }

    /// What this rank has, which need not be all.
    pub fn own(&self) -> &State<T, D> {
        &self.own
    }

    /// Whether this rank has its own particles alone, and does not show them.
    pub fn is_hidden(&self) -> bool {
        self.offer.is_none() && self.own.is_parted()
    }

    /// Shows the others what this rank has, all of which do so at once; where they cannot, all particles come together.
    pub fn offer(&mut self, team: &Arc<Team>) {
        if self.offer.is_some() || !self.own.is_parted() {
            return;
        }
        if team.count() > 1 && !team.is_broken() {
            let own = self.own.clone();
            self.offer = team
                .offer(Arc::new(move |part| own.part(part)))
                .map(|number| Standing {
                    team: team.clone(),
                    number,
                });
        }
        if self.offer.is_none() {
            self.bring_together();
        }
    }

    /// Goes on with what this rank has, which is shown no more; whether it was. All ranks do so at once.
    pub fn withdraw(&mut self) -> bool {
        self.all.take();
        let Some(offer) = self.offer.take() else {
            return false;
        };
        offer.team.withdraw(offer.number);
        true
    }

    /// Goes on with all particles, which all ranks give each other at once.
    pub fn bring_together(&mut self) {
        self.withdraw();
        if self.own.is_parted() {
            Arc::make_mut(&mut self.own).bring_together(Lists::Kept, None);
        }
    }
}

impl<T: Real, const D: usize> Deref for Readable<T, D> {
    type Target = State<T, D>;

    fn deref(&self) -> &State<T, D> {
        let Some(offer) = &self.offer else {
            return &self.own;
        };
        self.all.get_or_init(|| {
            let mut all = None;
            // Nothing goes on from it, so lists may stay where they are. Not by threads that may be asked for something that waits for it.
            apart(|| all = Some(offer.ask(&self.own, Lists::Elsewhere)));
            Box::new(all.expect("it was made"))
        })
    }
}

/// What is done to all particles.
impl<T: Real, const D: usize> DerefMut for Readable<T, D> {
    fn deref_mut(&mut self) -> &mut State<T, D> {
        if self.offer.is_some() {
            self.bring_together();
        }
        Arc::make_mut(&mut self.own)
    }
}

/// A copy that no other rank is shown.
impl<T: Real, const D: usize> Clone for Readable<T, D> {
    fn clone(&self) -> Self {
        Self::new(match &self.offer {
            Some(offer) => offer.ask(&self.own, Lists::Kept),
            None => State::clone(&self.own),
        })
    }
}

/// The others may still ask for what it shows.
impl<T: Real, const D: usize> Drop for Readable<T, D> {
    fn drop(&mut self) {
        self.withdraw();
    }
}

#[cfg(test)]
mod tests {
    use crate::collective::over;
    use crate::prelude::{Body, Scene, Wall, catalogue, schemes};
    use crate::ranks::in_threads;

    #[test]
    fn between_calls_a_rank_has_its_own_alone_until_it_reads() {
        let all = in_threads(3, 2, |ranks| {
            let (rank, open) = (ranks.rank(), [[true; 2], [true, false]]);
            let water = catalogue::weakly_compressible_water(4.0);
            let mut now = Scene::<f64, 2>::new(schemes::weakly_compressible())
                .body(Body::block("water", water, [0.0; 2], [0.4, 0.4], 0.01))
                .wall(Wall::around("tank", [0.0; 2], [0.8, 0.6], 0.01, 4, open))
                .acceleration(|_| [0.0, -9.81])
                .on_ranks(ranks)
                .build()
                .expect("the scene");
            now.run_until(0.01).expect("a run");
            let slots = |own: &super::State<f64, 2>| own.groups[0].particles.columns.slots();
            let (own, before) = (slots(now.state.own()), now.traffic());
            // Counts and times are known to all.
            let known = (now.particles(), now.time(), now.steps(), now.list_builds());
            assert!(now.state.all.get().is_none() && now.traffic() == before);
            // By all threads at once.
            let count = || over(0..64, |_| now.all().count() as u64) as usize / 64;
            let read = (rank == 1).then(count);
            assert_eq!(now.state.all.get().is_some(), rank == 1);
            assert_eq!(slots(now.state.own()), own);
            now.run_until(0.02).expect("a run");
            assert!(now.state.all.get().is_none());
            (own, known, read, slots(&now.state))
        });
        let all = all.expect("threads");
        let sum: usize = all.iter().map(|own| own.0).sum();
        for (rank, (own, known, read, slots)) in all.iter().enumerate() {
            assert!(2 * own < sum, "{own} of {sum}");
            assert_eq!((slots, known), (&sum, &all[0].1));
            assert_eq!(*read, (rank == 1).then_some(known.0));
        }
    }
}
