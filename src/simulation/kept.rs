//! The state of a simulation, kept while it rehearses steps, and put back.
//! The simulation is taken apart whole here, so a new part of it does not compile before it is said what becomes of it.

use super::contact::Couple;
use super::event::{Event, Happened};
use super::group::Group;
use super::ledger::Impulses;
use super::{SetAside, Simulation, Vote, energy, stability, stored};
use crate::scalar::Real;

/// What steps change.
pub(super) struct Kept<T: Real, const D: usize> {
    groups: Vec<Group<T, D>>,
    couples: Vec<Couple<T, D>>,
    time: f64,
    steps: u64,
    evaluations: u64,
    rates_at_hand: bool,
    first_step: Option<f64>,
    last_vote: Option<Vote>,
    votes: Vec<(&'static str, u64)>,
    impulses: Impulses,
    work: Option<energy::Work>,
    evaluated: f64,
    impulses_of_states: Vec<Impulses>,
    aside: Option<SetAside<T, D>>,
    due: f64,
    watch: Option<Box<stability::Watch<D>>>,
    stores: stored::Stores<D>,
    events: Vec<Event<T, D>>,
    happened: Happened,
    /// Layers that inlets have handed over, group by group.
    handed_over: Vec<u64>,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Keeps the state, of which copies take the place: they go on from it, unwatched and without events.
    pub(super) fn keep(&mut self) -> Kept<T, D> {
        let handed_over = self.emitters().map(|own| own.handed_over()).collect();
        let Self {
            groups,
            couples,
            domain: _,
            integrator: _,
            control: _,
            accelerations: _,
            loads: _,
            #[cfg(feature = "checkpoint")]
                scene: _,
            time,
            steps,
            evaluations,
            rates_at_hand,
            first_step,
            last_vote,
            votes,
            impulses,
            work,
            evaluated,
            kept_impulses,
            aside,
            due,
            failed: _,
            watch,
            stores,
            events,
            happened,
            awake: _,
        } = self;
        Kept {
            groups: swapped(groups),
            couples: swapped(couples),
            time: *time,
            steps: *steps,
            evaluations: *evaluations,
            rates_at_hand: *rates_at_hand,
            first_step: *first_step,
            last_vote: *last_vote,
            votes: votes.clone(),
            impulses: impulses.clone(),
            work: *work,
            evaluated: *evaluated,
            impulses_of_states: kept_impulses.clone(),
            aside: aside.clone(),
            due: *due,
            watch: watch.take(),
            stores: stores.clone(),
            events: core::mem::take(events),
            happened: happened.clone(),
            handed_over,
        }
    }

    /// Puts back what was kept; a step that has failed since has not.
    pub(super) fn put_back(&mut self, kept: Kept<T, D>) {
        self.groups = kept.groups;
        self.couples = kept.couples;
        self.time = kept.time;
        self.steps = kept.steps;
        self.evaluations = kept.evaluations;
        self.rates_at_hand = kept.rates_at_hand;
        self.first_step = kept.first_step;
        self.last_vote = kept.last_vote;
        self.votes = kept.votes;
        self.impulses = kept.impulses;
        self.work = kept.work;
        self.evaluated = kept.evaluated;
        self.kept_impulses = kept.impulses_of_states;
        self.aside = kept.aside;
        self.due = kept.due;
        self.failed = None;
        self.watch = kept.watch;
        self.stores = kept.stores;
        self.events = kept.events;
        self.happened = kept.happened;
        for (own, layers) in self.emitters().zip(kept.handed_over) {
            own.set_handed_over(layers);
        }
    }

    fn emitters(&self) -> impl Iterator<Item = &crate::boundary::Emitter<D>> {
        let groups = self.groups.iter();
        groups.flat_map(|group| group.emitters.iter().map(|(_, own)| own))
    }
}

/// What was there; a copy of it takes its place.
fn swapped<V: Clone>(place: &mut V) -> V {
    let copy = place.clone();
    core::mem::replace(place, copy)
}

#[cfg(test)]
mod tests {
    use crate::material::{Material, eos::IdealGas};
    use crate::prelude::*;
    use crate::simulation::ParticleView;

    /// Two rods of gas that meet, with lists that are built in every step and an event on the way.
    fn gases() -> Simulation<f64, 1> {
        let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
        let body = |name, x| Body::block(name, gas.clone(), [x], [x + 1.0], 0.02).energy(1.0);
        Scene::new(schemes::gas())
            .body(body("left", 0.0).velocity([0.5]))
            .body(body("right", 1.0))
            .boundary(MirrorPlane::wall([0.0], [-1.0]))
            .event("late", |now: &Simulation<f64, 1>| now.time() > 0.2)
            .build()
            .unwrap()
    }

    #[test]
    fn a_rehearsal_leaves_no_trace() {
        let (mut plain, mut looked) = (gases(), gases());
        for end in [0.1, 0.3, 0.5] {
            let before = looked.work();
            let expected = looked.expected_work(2.0).unwrap();
            assert!(expected.steps > 20 && expected.pairs > 0, "{expected:?}");
            assert_eq!(looked.work(), before);
            assert_eq!(looked.event("late").unwrap(), plain.event("late").unwrap());
            plain.run_until(end).unwrap();
            looked.run_until(end).unwrap();
            let state = |now: &Simulation<f64, 1>| -> Vec<[u64; 3]> {
                let of = |own: ParticleView<'_, f64, 1>| {
                    [own.position()[0], own.velocity()[0], own.energy()].map(f64::to_bits)
                };
                now.all().map(of).collect()
            };
            assert_eq!(state(&plain), state(&looked));
            assert_eq!(plain.steps(), looked.steps());
            assert_eq!(plain.list_builds(), looked.list_builds());
        }
    }
}
