//! The state of a run as methods read it. On ranks it may have the particles of this rank only, and offers them to the other ranks.
//! A reference to it has all particles: it asks the other ranks for theirs. `own` has those of this rank.

use super::own_group::Lists;
use super::run_state::State;
use crate::parallel::apart;
use crate::ranks::{Asked, Team};
use crate::scalar::Real;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, OnceLock};

/// A state that may be offered to other ranks.
#[derive(Debug)]
pub(super) struct Readable<T: Real, const D: usize> {
    own: Arc<State<T, D>>,
    offer: Option<Standing>,
    /// The state of all particles, once it was read while the offer stands.
    all: OnceLock<Box<State<T, D>>>,
}

/// An offer that all ranks have made.
#[derive(Debug)]
struct Standing {
    team: Arc<Team>,
    number: u64,
}

impl Standing {
    /// A copy of the state of this rank with the particles of all ranks.
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

    /// The state of this rank, which need not have all particles.
    pub fn own(&self) -> &State<T, D> {
        &self.own
    }

    /// Whether this rank has its own particles only, and does not offer them.
    pub fn is_hidden(&self) -> bool {
        self.offer.is_none() && self.own.is_parted()
    }

    /// Offers the particles of this rank, as all ranks do at once. Ranks without offers gather all particles instead.
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

    /// Withdraws the offer, as all ranks do at once. The state has the particles of this rank then.
    pub fn withdraw(&mut self) {
        self.all.take();
        if let Some(offer) = self.offer.take() {
            offer.team.withdraw(offer.number);
        }
    }

    /// Gathers all particles, as all ranks do at once.
    pub fn bring_together(&mut self) {
        self.withdraw();
        if self.own.is_parted() {
            Arc::make_mut(&mut self.own).bring_together(Lists::Made, None);
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
            // No step starts from it, so it needs no lists. Other threads make it: this one would take up tasks that wait for it.
            apart(|| all = Some(offer.ask(&self.own, Lists::None)));
            Box::new(all.expect("it was made"))
        })
    }
}

/// A change acts on all particles, which all ranks gather first.
impl<T: Real, const D: usize> DerefMut for Readable<T, D> {
    fn deref_mut(&mut self) -> &mut State<T, D> {
        if self.offer.is_some() {
            self.bring_together();
        }
        Arc::make_mut(&mut self.own)
    }
}

/// The copy has all particles, and is not offered.
impl<T: Real, const D: usize> Clone for Readable<T, D> {
    fn clone(&self) -> Self {
        Self::new(match &self.offer {
            Some(offer) => offer.ask(&self.own, Lists::Made),
            None => State::clone(&self.own),
        })
    }
}

/// Other ranks may ask until they drop theirs, too.
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
        let folder = std::env::temp_dir().join(format!("meshfree-own-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
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
            #[cfg(feature = "checkpoint")]
            {
                now.save(folder.join("file")).expect("a file");
                assert!(now.state.all.get().is_none(), "each rank writes its rows");
            }
            // All threads read at once.
            let count = || over(0..64, |_| now.all().count() as u64) as usize / 64;
            let read = (rank == 1).then(count);
            assert_eq!(now.state.all.get().is_some(), rank == 1);
            assert_eq!(slots(now.state.own()), own);
            now.run_until(0.02).expect("a run");
            assert!(now.state.all.get().is_none());
            (own, known, read, slots(&now.state))
        });
        let all = all.expect("threads");
        let _ = std::fs::remove_dir_all(folder);
        let sum: usize = all.iter().map(|own| own.0).sum();
        for (rank, (own, known, read, slots)) in all.iter().enumerate() {
            assert!(2 * own < sum, "{own} of {sum}");
            assert_eq!((slots, known), (&sum, &all[0].1));
            assert_eq!(*read, (rank == 1).then_some(known.0));
        }
    }
}
